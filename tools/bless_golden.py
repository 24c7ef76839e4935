#!/usr/bin/env python3
"""Writes tests/golden/runs/*.csv anew from what the built program computes.

Run by hand, after a change that is meant to change fixes; read the difference before committing it:

    tools/bless_golden.py [--program build/release/bin/skyloop] [NAME ...]
"""

import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
RUNS = ROOT / "tests" / "golden" / "runs"


def fixes_of(program: pathlib.Path, scenario: pathlib.Path, folder: pathlib.Path) -> pathlib.Path:
    """Simulates a scenario; gives its table of fixes."""
    subprocess.run([program, "simulate", scenario, "--out", folder, "--quiet"], check=True)
    return folder / "fixes.csv"


def bless(program: pathlib.Path, scenario: pathlib.Path) -> str:
    """Replaces the table of one scenario; says what became of it."""
    expected = scenario.with_suffix(".csv")
    before = expected.read_bytes() if expected.exists() else None
    with tempfile.TemporaryDirectory() as folder:
        shutil.copyfile(fixes_of(program, scenario, pathlib.Path(folder) / "run"), expected)
    if before is None:
        return "new"
    return "the same" if before == expected.read_bytes() else "changed"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build" / "dev" / "bin" / "skyloop")
    parser.add_argument("names", nargs="*", metavar="NAME", help="of runs; without any, all")
    options = parser.parse_args()
    if not options.program.exists():
        print(f"{options.program}: no such program; build it first or name it with --program", file=sys.stderr)
        return 1
    known = {path.stem: path for path in sorted(RUNS.glob("*.toml"))}
    for name in options.names or known:
        if name not in known:
            print(f"{name}: no such run; expected some of {' '.join(known)}", file=sys.stderr)
            return 2
        print(f"{name}: {bless(options.program, known[name])}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
