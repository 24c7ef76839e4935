"""A campaign of short runs, and what it left: the same wherever it was run."""
import csv
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKYLOOP = os.environ.get("SKYLOOP", str(ROOT / "build/dev/bin/skyloop"))
SKIPPED = 77

# A run takes some hundredths of a second, so that a part has some when it is stopped.
SCENARIO = """\
[run]
start = 2024-06-01T12:00:00Z
duration_s = 120

[trajectory]
kind = "fixed"
at = [48.1, 11.6, 520.0]

[campaign]
"""


def skip(reason):
    """Ends the whole test program as skipped."""
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def command(scenario, out, runs, *options):
    return [SKYLOOP, "campaign", str(scenario), "--out", str(out), "--seeds", str(runs), *map(str, options)]


def run(scenario, out, runs, *options, environment=None, timeout=600):
    """A campaign to its end; gives the finished process."""
    return subprocess.run(command(scenario, out, runs, *options), capture_output=True, text=True, timeout=timeout,
                          env=environment, stdin=subprocess.DEVNULL, check=False)


def result_files(out, shard="*"):
    return [path for path in pathlib.Path(out, "shards").glob(f"{shard}-of-*.csv") if not path.name.endswith(".log.csv")]


def results(out):
    """All rows of all shards, as they are: {key: [row…]}."""
    rows = {}
    for path in result_files(out):
        with open(path, newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                rows.setdefault(row["key"], []).append(row)
    return rows


def count_results(out, shard="*"):
    """How many there are now, while others write; of one shard or of all."""
    return sum(max(0, path.read_bytes().count(b"\n") - 1) for path in result_files(out, shard))


def report(out):
    """The page and the numbers of a campaign's report."""
    subprocess.run([SKYLOOP, "campaign", "report", str(out)], check=True, capture_output=True, timeout=120)
    return [pathlib.Path(out, name).read_bytes() for name in ("report.html", "report.json")]


def expect_same(case, one, other, runs):
    """Every run's result exactly once in both, and the same, to the bytes of the database and of the report."""
    ours, theirs = results(one), results(other)
    case.assertEqual(len(ours), runs)
    case.assertEqual({key: len(rows) for key, rows in ours.items() if len(rows) != 1}, {})
    case.assertEqual(ours, theirs)
    case.assertEqual((pathlib.Path(one) / "campaign.sqlite").read_bytes(),
                     (pathlib.Path(other) / "campaign.sqlite").read_bytes())
    case.assertEqual(report(one), report(other))
