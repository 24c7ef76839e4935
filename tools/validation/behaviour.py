"""Behaviours of boards that no record holds as a series: a table of its own, each with the band that it has to keep.

A behaviour is measured in parts, each of one run or a few, that processes share; what the parts of a seed give is put
together to the values of its rows. A row holds one number or several, and counts by the medians of the seeds.
"""

import concurrent.futures
import json
import os
import pathlib
import sys
import time

from . import behaviours_raw, behaviours_rest, behaviours_starts, behaviours_turns, runs
from .row_bands import Row

FOLDER = pathlib.Path(__file__).parent
SEEDS, SHORT_SEEDS = 3, 1  # with fewer than these nothing is expected
BEHAVIOURS = (*behaviours_rest.BEHAVIOURS, *behaviours_starts.BEHAVIOURS, *behaviours_raw.BEHAVIOURS,
              *behaviours_turns.BEHAVIOURS)


def measured(name, bench, part, seed):
    """The values of a part; none at all where a run left too little, such as no fix. In a process of its own."""
    behaviour = next(behaviour for behaviour in BEHAVIOURS if behaviour.name == name)
    try:
        return behaviour.measure(bench, part, seed)
    except (ArithmeticError, ValueError, LookupError) as error:
        print(f"{name}, {part}, seed {seed}: nothing could be measured: {error!r}", file=sys.stderr)
        return {}


def all_measured(bench, behaviours, seeds, short):
    """{behaviour: [{part: values} of each seed]}, and seconds of computing that each took."""
    results = {behaviour.name: [{} for _ in range(min(seeds, behaviour.most_seeds))] for behaviour in behaviours}
    with concurrent.futures.ProcessPoolExecutor(os.cpu_count()) as pool:
        jobs = {pool.submit(timed, behaviour.name, bench, part, seed): (behaviour.name, part, seed)
                for behaviour in behaviours for part in behaviour.chosen(short)
                for seed in range(1, len(results[behaviour.name]) + 1)}
        seconds = dict.fromkeys(results, 0.0)
        for job in concurrent.futures.as_completed(jobs):
            name, part, seed = jobs[job]
            results[name][seed - 1][part], took = job.result()
            seconds[name] += took
    return results, seconds


def timed(name, bench, part, seed):
    began = time.monotonic()
    return measured(name, bench, part, seed), time.monotonic() - began


def rows_of(bench, behaviour, of_seeds):
    """A row for each name of its bands, though nothing was measured of it."""
    gathered = [behaviour.gather(parts) for parts in of_seeds]
    return [Row(name, band, [values[name] for values in gathered if name in values])
            for name, band in behaviour.bands(bench).items()]


def markdown(rows):
    lines = ["### Behaviours of boards", "", "| behaviour | band | measured | inside |", "|---|---|---|---|"]
    for row in rows:
        inside = ("yes" if row.inside else "no") if row.band.judged else "–"
        lines.append(f"| {row.name} | {row.band.text} | {row.text} | {inside} |")
    return "\n".join(lines)


def total(rows):
    judged = [row for row in rows if row.band.judged]
    return f"behaviours: {sum(row.inside for row in judged)} of {len(judged)} inside"


def expectation_file(short):
    return FOLDER / ("behaviour_inside_short.txt" if short else "behaviour_inside.txt")


def expected(short):
    path = expectation_file(short)
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    return {line for line in lines if line and not line.startswith("#")}


def bless(short, rows):
    """Keeps what is inside; what was kept of behaviours that were not looked at stays."""
    head = "# Behaviours in their bands: tools/validate --behaviour fails when one has left it; --bless rewrites.\n"
    kept = expected(short) - {row.name for row in rows}
    kept |= {row.name for row in rows if row.inside and row.band.judged}
    expectation_file(short).write_text(head + "".join(f"{name}\n" for name in sorted(kept)), encoding="utf-8")


def lost(short, rows):
    """Those that should be inside and are not."""
    there = {row.name: row for row in rows}
    return [there[name] for name in sorted(expected(short)) if name in there and not there[name].inside]


def write_json(path, rows, seconds):
    """null is a time that never came."""
    text = json.dumps({"behaviours": [row.as_json() for row in rows],
                       "seconds": {name: round(value, 1) for name, value in seconds.items()}}, indent=1)
    path.write_text(text.replace("NaN", "null").replace("Infinity", "null") + "\n", encoding="utf-8")


def validate(arguments):
    """Prints the table; gives the status of the program."""
    if arguments.pictures:
        behaviours_starts.draw(arguments.program, arguments.data, arguments.pictures)
        return 0
    short = arguments.short
    bench = runs.Bench(arguments.program, arguments.data)
    seeds = SHORT_SEEDS if short else arguments.seeds
    behaviours = [behaviour for behaviour in BEHAVIOURS
                  if behaviour.chosen(short) and (not arguments.behaviour or behaviour.name in arguments.behaviour)]
    results, seconds = all_measured(bench, behaviours, seeds, short)
    rows = [row for behaviour in behaviours for row in rows_of(bench, behaviour, results[behaviour.name])]
    looked_at = [row for row in rows if row.values or not short]
    if not arguments.quiet:
        print(markdown(looked_at) + "\n")
    print(total(looked_at))
    if arguments.json:
        write_json(arguments.json, looked_at, seconds)
    if arguments.bless:
        bless(short, rows)
    left = lost(short, rows) if short or seeds >= SEEDS else []
    for row in left:
        print(f"outside: {row.name}: {row.text}, {row.band.text}", file=sys.stderr)
    return 1 if left else 0
