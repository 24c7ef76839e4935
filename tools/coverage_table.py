#!/usr/bin/env python3
"""Lines and branches reached, by folder, from gcovr's summary: coverage_table.py SUMMARY.json --least PERCENT."""

import argparse
import collections
import json
import pathlib
import sys

FIELDS = ("line_covered", "line_total", "branch_covered", "branch_total")


def folder_of(path: str) -> str:
    """src/receiver/pvt, firmware-host."""
    parts = pathlib.PurePosixPath(path).parts
    return "/".join(parts[:3]) if parts[0] == "src" else parts[0]


def percent(covered: int, total: int) -> str:
    return f"{100 * covered / total:5.1f}" if total else "    -"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("summary", type=pathlib.Path)
    parser.add_argument("--least", type=float, default=0, help="%% of lines")
    options = parser.parse_args()
    folders = collections.defaultdict(lambda: [0] * len(FIELDS))
    for file in json.loads(options.summary.read_text())["files"]:
        for i, field in enumerate(FIELDS):
            folders[folder_of(file["filename"])][i] += file[field]
    print(f"{'folder':24} {'lines':>7} {'%':>5} {'branches':>9} {'%':>5}")
    whole = [sum(column) for column in zip(*folders.values())]
    for name, counts in [*sorted(folders.items()), ("all", whole)]:
        print(f"{name:24} {counts[1]:7} {percent(*counts[:2])} {counts[3]:9} {percent(*counts[2:])}")
    if 100 * whole[0] < options.least * whole[1]:
        print(f"coverage: {percent(*whole[:2]).strip()} % of lines; expected {options.least:g} or more", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
