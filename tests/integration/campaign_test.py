"""skyloop campaign: exactly one result a run, whatever is killed, and the same database from any way of running it."""
import csv
import hashlib
import json
import os
import pathlib
import random
import signal
import sqlite3
import subprocess
import sys
import time

from session import SKYLOOP, open_folder, skyloop

SCENARIO = """
[run]
start = 2024-03-05T12:00:00Z
duration_s = {duration}
[model]
name = "baseline"
[[fault]]
name = "gap"
kind = "outage"
at_s = 10
for_s = 5
[[expect]]
name = "back soon"
what = "fix within 3 s of the end of gap"
[[expect]]
name = "never lost"
what = "fix at 22 s"
[campaign]
seeds = 50
[[campaign.parameter]]
key = "fault.gap.for_s"
values = [1, 14]
[[campaign.parameter]]
key = "sky.elevation_mask_deg"
values = [5, 30]
"""
RUNS = 200


def write_scenario(folder, name="campaign.toml", duration=30):
    path = folder / name
    path.write_text(SCENARIO.format(duration=duration))
    return path


def campaign(*arguments, expected=(0,)):
    done = subprocess.run([SKYLOOP, "campaign", *map(str, arguments)], capture_output=True, text=True, timeout=150)
    assert done.returncode in expected, f"campaign {arguments} ended {done.returncode}: {done.stderr}"
    return done


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def keys_in(out):
    """Of all whole rows."""
    keys = []
    for path in sorted((out / "shards").glob("*-of-*.csv")):
        if not path.name.endswith(".log.csv"):
            whole = path.read_text().rpartition("\n")[0].splitlines()
            keys += [row[0] for row in csv.reader(whole[1:])]
    return keys


def children_of(process):
    found = []
    for status in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = status.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[1]) == process:
            found.append(int(status.parent.name))
    return found


def test_plan(folder):
    rows = list(csv.DictReader(campaign("plan", write_scenario(folder)).stdout.splitlines()))
    assert len(rows) == RUNS and len({row["key"] for row in rows}) == RUNS
    assert [row["number"] for row in rows] == [str(i) for i in range(RUNS)]
    assert [row["seed"] for row in rows[:50]] == [str(i + 1) for i in range(50)]
    # What the campaign would refuse before its first run, the plan does, too, in the words of the option.
    for key, words in (("run.foo", "--vary run.foo: run.foo: unknown key"),
                       ("fault.0.foo", "--vary fault.0.foo: fault.0.foo: unknown key"),
                       ("output.0.to", "the scenario has no output.0")):
        refused = campaign("plan", folder / "campaign.toml", "--vary", f"{key}=1", expected=(2,))
        assert words in refused.stderr and not refused.stdout, refused.stderr


def test_same_bytes(folder):
    scenario = write_scenario(folder)
    campaign(scenario, "--out", folder / "undisturbed", "--jobs", 1, "--quiet", expected=(3,))
    campaign(scenario, "--out", folder / "two", "--jobs", 2, "--quiet", expected=(3,))
    assert len(keys_in(folder / "undisturbed")) == RUNS
    assert digest(folder / "undisturbed/campaign.sqlite") == digest(folder / "two/campaign.sqlite")
    # What is there is not run again.
    before = (folder / "two/shards/0-of-1.log.csv").read_bytes()
    campaign(scenario, "--out", folder / "two", "--quiet", expected=(3,))
    assert (folder / "two/shards/0-of-1.log.csv").read_bytes() == before


def test_database(folder):
    """The figures are those of the runs, and the verdicts those of the expectations."""
    with sqlite3.connect(folder / "undisturbed/campaign.sqlite") as database:
        assert database.execute("select count(*) from run").fetchone() == (RUNS,)
        assert dict(database.execute("select name, value from meta"))["planned"] == str(RUNS)
        by_length = dict(database.execute(
            "select value, avg(passed) from verdict join parameter using (key) where verdict.name = 'never lost' "
            "and parameter.name = 'fault.gap.for_s' group by value"))
        assert by_length == {"1": 1.0, "14": 0.0}, by_length
        shares = dict(database.execute(
            "select p.value, max(m.value) from metric m join parameter p using (key) where m.name = 'fix_share' "
            "and p.name = 'fault.gap.for_s' group by p.value"))
        assert abs(shares["14"] - 16 / 30) < 0.05 and abs(shares["1"] - 29 / 30) < 0.05, shares


def test_replay(folder):
    """A run done again by itself has the figures that the campaign kept."""
    scenario = write_scenario(folder)
    campaign("replay", scenario, "--number", 60, "--out", folder / "again", "--quiet", expected=(0, 3))
    with open(folder / "again/fixes.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    errors = sorted((float(r["east_error_m"]) ** 2 + float(r["north_error_m"]) ** 2) ** 0.5
                    for r in rows if r["fix_type"] != "none")
    with sqlite3.connect(folder / "undisturbed/campaign.sqlite") as database:
        kept = dict(database.execute("select name, value from metric join run using (key) where number = 60"))
    assert kept["epochs"] == len(rows)
    assert abs(kept["fix_share"] - len(errors) / len(rows)) < 1e-6
    assert abs(kept["horizontal_error_max_m"] - errors[-1]) < 1e-3


def test_shards(folder):
    """Three parts, one of them missing; then five: the same database."""
    scenario = write_scenario(folder)
    for part in ("0/3", "2/3"):
        campaign(scenario, "--out", folder / "parts", "--shard", part, "--quiet", expected=(3,))
    campaign(scenario, "--out", folder / "parts", "--shard", "0/3", "--quiet", expected=(3,))  # nothing is left to do
    said = campaign("gather", folder / "parts", expected=(1,)).stdout
    assert "missing      67: runs 1 4 7" in said, said
    for part in range(5):
        campaign(scenario, "--out", folder / "parts", "--shard", f"{part}/5", "--quiet", expected=(0, 3))
    assert "missing      0" in campaign("gather", folder / "parts", expected=(3,)).stdout
    assert len(keys_in(folder / "parts")) == RUNS, "each run once"
    assert digest(folder / "parts/campaign.sqlite") == digest(folder / "undisturbed/campaign.sqlite")
    only = campaign(scenario, "--out", folder / "only", "--seeds", 1, "--shard", "0/1", "--quiet", expected=(3,))
    assert not only.stdout and not (folder / "only/campaign.sqlite").exists(), "the only part is one, too"


def start(scenario, out):
    return subprocess.Popen([SKYLOOP, "campaign", scenario, "--out", out, "--jobs", "2", "--quiet"],
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def some_runs_later(leader, out, before, chance):
    """A random instant, counted in runs, so that a fast machine is disturbed as often as a slow one."""
    runs = before + chance.randint(0, 20)
    while leader.poll() is None and len(keys_in(out)) < runs:
        time.sleep(0.001)
    time.sleep(chance.uniform(0, 0.03))


def test_kills(folder):
    """Workers and their leader die at random instants."""
    scenario = write_scenario(folder)
    out = folder / "killed"
    chance = random.Random(5)
    kills = {"worker": 0, "leader": 0}
    for attempt in range(60):
        before = len(keys_in(out))
        leader = start(scenario, out)
        try:
            if attempt < 40:
                some_runs_later(leader, out, before, chance)
                workers = children_of(leader.pid)
                if attempt % 2 == 0 and workers and leader.poll() is None:
                    os.kill(chance.choice(workers), signal.SIGKILL)
                    kills["worker"] += 1
                    some_runs_later(leader, out, len(keys_in(out)), chance)
                if leader.poll() is None:
                    leader.kill()
                    kills["leader"] += 1
                    leader.wait(timeout=20)
                    # Workers live no longer than their leader.
                    end = time.monotonic() + 5
                    while any(pathlib.Path(f"/proc/{worker}").exists() for worker in workers):
                        assert time.monotonic() < end, "a worker outlives its leader"
                        time.sleep(0.01)
                    continue
            if leader.wait(timeout=150) in (0, 3):
                break
        finally:
            if leader.poll() is None:
                leader.kill()
                leader.wait(timeout=20)
    print(f"kills: {kills}")
    assert kills["leader"] > 3 and kills["worker"] > 0, "too few to show anything"
    keys = keys_in(out)
    assert len(keys) == RUNS and len(set(keys)) == RUNS, "each run exactly once"
    campaign("gather", out, expected=(3,))
    assert digest(out / "campaign.sqlite") == digest(folder / "undisturbed/campaign.sqlite")


def test_stop(folder):
    """SIGTERM: exit 75, and the same command goes on."""
    scenario = write_scenario(folder, "long.toml", duration=20000)
    out = folder / "stopped"
    leader = start(scenario, out)
    time.sleep(1.5)
    assert leader.poll() is None
    leader.send_signal(signal.SIGTERM)
    assert leader.wait(timeout=20) == 75


def test_mistakes(folder):
    scenario = write_scenario(folder)
    out = folder / "none"
    for options, words in [
            (["--vary", "run.duratoin_s=1"], "did you mean 'duration_s'"),
            (["--vary", "fault.gap.for_s=1,-1"], "fault.gap.for_s: is -1"),
            (["--seeds", "x"], "--seeds x: expected"),
            (["--vary", "run.speed=1", "--vary", "run.speed=2"], "--vary run.speed: is given twice"),
            (["--shard", "3/3"], "--shard 3/3: expected I/N"),
            (["--vary", "trajectory.kind=file"], "trajectory"),
            (["--engine", "slurm", "--shard", "0/3"], "--shard excludes --engine"),
            (["--engine", "slurm", "--image", "x"], "--image: an option of --engine kubernetes; this is --engine slurm"),
            (["--image", "x"], "--image: an option of --engine kubernetes; expected that, too"),
            (["--engine", "kubernetes", "--jobs", 4], "a shard does one run at a time; expected --parallelism"),
            (["--partition", "x", "--engine", "parallel"], "--partition: an option of --engine slurm; this is"),
    ]:
        said = campaign(scenario, "--out", out, *options, expected=(2,)).stderr
        assert words in said, (options, said)
        assert not out.exists(), "nothing was begun"
    now = folder / "now.toml"
    now.write_text("[run]\nduration_s = 3\n")
    assert "begin now" in campaign(now, "--out", out, expected=(2,)).stderr
    assert "No such file" in campaign(folder / "absent.toml", "--out", out, expected=(1,)).stderr
    other = campaign(scenario, "--out", folder / "undisturbed", "--vary", "run.speed=1", expected=(2,)).stderr
    assert "other columns" in other, other


def test_titles_are_shown_and_not_obeyed(folder):
    path = folder / "titles.toml"
    path.write_text("""
[run]
start = 2024-03-05T12:00:00Z
duration_s = 5
[campaign]
seeds = 1
[[expect]]
name = "a\\u001b[31mred\\u0007"
what = "horizontal error below 0.0001 m always"
""")
    checked = subprocess.run([SKYLOOP, "check", path], capture_output=True, text=True, timeout=60, check=True)
    done = campaign(path, "--out", folder / "titles", expected=(3,))
    for said in (checked.stdout, done.stdout, done.stderr):
        assert "\x1b" not in said and "\x07" not in said and "a\\u001b[31mred\\u0007" in said, said


def write_vehicle_scenario(path, seeds, command):
    """Runs of 20 s, each with a program of its own."""
    path.write_text(f"""
[run]
start = 2024-03-05T12:00:00Z
duration_s = 20
[model]
name = "ideal"
[campaign]
seeds = {seeds}
[campaign.vehicle]
command = {json.dumps(command)}
""")
    return path


def test_a_killed_worker_takes_its_vehicle_along(folder):
    path = write_vehicle_scenario(folder / "left.toml", 1, f"touch '{folder}/begun.'$$; sleep 4; touch '{folder}/late.'$$")
    process = subprocess.Popen([SKYLOOP, "campaign", path, "--out", folder / "left", "--jobs", "1"],
                               stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    end = time.monotonic() + 30
    while not list(folder.glob("begun.*")) and time.monotonic() < end:
        time.sleep(0.05)
    workers = children_of(process.pid)
    assert len(workers) == 1, workers
    os.kill(workers[0], signal.SIGKILL)
    assert process.wait(timeout=60) == 0, "the run is tried once more"
    assert len(list(folder.glob("begun.*"))) == 2
    assert len(list(folder.glob("late.*"))) == 1, "the first vehicle went on"


def test_vehicle(folder):
    """A program with a pty of its own, in real time: its exit code is a verdict."""
    path = write_vehicle_scenario(
        folder / "vehicle.toml", 2,
        'timeout 10 head -c 200 "$SKYLOOP_PTY" | grep -q GGA && test {pty} = "$SKYLOOP_PTY" && exit $(({seed} - 1))')
    began = time.monotonic()
    said = campaign(path, "--out", folder / "vehicle", "--jobs", 2, expected=(3,)).stdout
    assert time.monotonic() - began < 15, "a run ends with its vehicle"
    assert "1 passed, 1 failed" in said and "not met      1 of 2 runs: vehicle" in said, said


def test_a_folder_that_is_in_use(folder):
    """Another campaign is refused while one runs; its own parts and gathering are not."""
    path = write_vehicle_scenario(folder / "held.toml", 2,
                                  f"cd '{folder}'; touch held.begun; until test -e held.over; do sleep 0.1; done; false")
    other = write_vehicle_scenario(folder / "other.toml", 1, "true")
    out = folder / "held"

    def begin(*options):
        return subprocess.Popen([SKYLOOP, "campaign", path, "--out", out, "--jobs", "2", "--quiet", *options],
                                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def wait_for(file):
        end = time.monotonic() + 30
        while not file.exists():
            assert time.monotonic() < end, f"{file} is not there"
            time.sleep(0.05)

    leader = begin()
    try:
        wait_for(folder / "held.begun")
        said = campaign(other, "--out", out, expected=(2,)).stderr
        assert "campaign.json: a campaign with another plan is running there" in said, said
        assert "missing      2" in campaign("gather", out, expected=(1,)).stdout
        part = begin("--shard", "1/2")
        wait_for(out / "shards/1-of-2.csv")
        assert leader.poll() is None, "it was over before the part began"
    finally:
        (folder / "held.over").touch()
        code = leader.wait(timeout=60)
    assert (code, part.wait(timeout=60)) == (3, 3)
    assert "1 passed" in campaign(other, "--out", out).stdout


def test_a_file_that_changes_meanwhile(folder):
    """The vehicle writes the track in run 1: what was done before stays, and no row is of another track."""
    track = folder / "track.csv"
    track.write_text("time_s,lat_deg,lon_deg,height_m\n0,47,8,400\n30,47.001,8,400\n")

    def write(name, command):
        path = write_vehicle_scenario(folder / f"{name}.toml", 3, f"cd '{folder}' && {command}")
        path.write_text(path.read_text() + '[trajectory]\nkind = "file"\npath = "track.csv"\n')
        return path

    touched = write("touched", "test $SKYLOOP_RUN != 1 || test -e once || touch once track.csv")
    assert "3 passed" in campaign(touched, "--out", folder / "touched", "--jobs", 1).stdout
    with open(folder / "touched/shards/0-of-1.log.csv", encoding="utf-8") as file:
        rows = [(row["number"], row["outcome"]) for row in csv.DictReader(file)]
    assert rows == [("0", "passed"), ("1", "lost"), ("2", "passed"), ("1", "passed")], rows
    changed = write("changed", "test $SKYLOOP_RUN != 1 || test -e twice || { touch twice; echo 40,47.002,8,400 >>track.csv; }")
    said = campaign(changed, "--out", folder / "changed", "--jobs", 1, expected=(1,)).stderr
    assert f"{track}: has changed since the campaign began; what was done before is kept" in said, said
    assert len(keys_in(folder / "changed")) == 1
    assert "of other plans 1" in campaign(changed, "--out", folder / "changed").stdout


def test_a_probe_beside_a_vehicle_finds_the_port(folder):
    path = write_vehicle_scenario(folder / "probe.toml", 1, "sleep 4")
    probe = json.dumps(["sh", "-c", 'test -c "$SKYLOOP_PORT"'])
    path.write_text(path.read_text() + f"[[expect]]\ncommand = {probe}\nat_s = 1\n")
    assert "1 passed" in campaign(path, "--out", folder / "probe").stdout


def main():
    with open_folder() as name:
        folder = pathlib.Path(name)
        for test in (test_plan, test_same_bytes, test_database, test_replay, test_shards, test_kills, test_stop,
                     test_mistakes, test_titles_are_shown_and_not_obeyed, test_vehicle, test_a_folder_that_is_in_use, test_a_file_that_changes_meanwhile,
                     test_a_probe_beside_a_vehicle_finds_the_port, test_a_killed_worker_takes_its_vehicle_along):
            began = time.monotonic()
            test(folder)
            print(f"{test.__name__}: {time.monotonic() - began:.1f} s")
    skyloop("--version")


if __name__ == "__main__":
    sys.exit(main())
