"""Databases as `skyloop campaign gather` writes them, made here from drawn numbers."""
import math
import random
import sqlite3

SCHEMA = """
CREATE TABLE meta(name TEXT PRIMARY KEY, value TEXT);
CREATE TABLE run(key TEXT PRIMARY KEY, number INTEGER, seed INTEGER, status TEXT);
CREATE TABLE parameter(key TEXT, name TEXT, value TEXT);
CREATE TABLE metric(key TEXT, name TEXT, value REAL);
CREATE TABLE verdict(key TEXT, name TEXT, passed INTEGER, detail TEXT);
"""
MODELS = ["m8", "m9", "f9p"]


def write(path, runs, planned=None, name="canyon sweep", scenario="canyon.toml"):
    """`runs`: dictionaries with number, seed, status, parameters, metrics and verdicts (name: (passed, detail))."""
    path.unlink(missing_ok=True)
    with sqlite3.connect(path) as database:
        database.executescript(SCHEMA)
        meta = {"name": name, "program_version": "0.1.0", "scenario": scenario, "scenario_digest": "3f" * 32,
                "planned": str(len(runs) if planned is None else planned), "campaign_file": "campaign.json"}
        database.executemany("INSERT INTO meta VALUES (?, ?)", meta.items())
        for run in runs:
            key = f"{run['number']:064x}"
            database.execute("INSERT INTO run VALUES (?, ?, ?, ?)", (key, run["number"], run["seed"], run["status"]))
            database.executemany("INSERT INTO parameter VALUES (?, ?, ?)",
                                 [(key, n, v) for n, v in run.get("parameters", {}).items()])
            database.executemany("INSERT INTO metric VALUES (?, ?, ?)",
                                 [(key, n, v) for n, v in run.get("metrics", {}).items()])
            database.executemany("INSERT INTO verdict VALUES (?, ?, ?, ?)",
                                 [(key, n, int(p), d) for n, (p, d) in run.get("verdicts", {}).items()])
    database.close()


def drawn_run(number, draw):
    """One run of a made-up campaign: the error grows with the noise and the mask, and differs between receivers."""
    mask = [5, 10, 15, 20, 25][number % 5]
    model = MODELS[number // 5 % 3]
    noise = round(draw.uniform(0.2, 2.0), 6)
    run = {"number": number, "seed": 1000 + number, "status": "passed",
           "parameters": {"receiver.model": model, "receiver.mask_deg": str(mask), "noise.code_m": repr(noise)}}
    if draw.random() < 0.002:
        run["status"] = "error"
        return run
    scale = noise * (1 + mask / 12) * (1.5 if model == "m8" else 1)
    error = scale * math.sqrt(-2 * math.log(1 - draw.random()))
    if draw.random() < 0.001:
        error *= 300  # a wild fix
    first_fix = 24 + draw.gammavariate(2, 3) + mask / 3 if draw.random() > 0.01 else None
    satellites = max(3, round(14 - mask / 3 + draw.gauss(0, 1.3)))
    run["metrics"] = {"horizontal_error_p95_m": error, "time_to_first_fix_s": first_fix,
                      "satellites_mean": satellites, "fix_share_percent": 100 - draw.expovariate(2) * mask / 10,
                      "temperature_k": 290.0}
    run["verdicts"] = {"horizontal error below 8 m": (error < 8, f"largest {error:.2f} m"),
                       "fix within 60 s": (first_fix is not None and first_fix < 60, "" if first_fix else "no fix"),
                       "no reset": (True, "")}
    if not all(passed for passed, _ in run["verdicts"].values()):
        run["status"] = "failed"
    return run


def drawn_runs(count, seed=7):
    draw = random.Random(seed)
    return [drawn_run(number, draw) for number in range(count)]
