"""The real band of a figure: how far a simulated median may lie from what was measured.

Several hours or receivers give their least to greatest, correlations at least ± 0.15 about the median. Around one record
alone the band is as wide as receivers of a kind and hours of one receiver differ. Where a figure cannot be computed from
the record again, bands.csv beside this file has the band that was computed once.
"""

import csv
import math
import pathlib
import re
import statistics

GIVEN = pathlib.Path(__file__).with_name("bands.csv")
CORRELATION = re.compile(r"(^|\s)r\d+\b")
# Of a single record: (figures, share below and above, or a factor, or metres, dB …). The first that fits counts.
SINGLE = (
    (r"(^| )r1( |$)", "add", 0.15),
    (r"^r\d+ ", "add", 0.3),
    (r"^(d1 )?std ", "share", 0.3),
    (r"^C/N0 (el |mean|p\d)", "add", 2),
    (r"^sats|^tracked$", "add", 1),
    (r"^[hp]dop", "share", 0.2),
    (r"^speed|^vel up|^share| changes$|^sAcc", "factor", 2),
    (r"", "factor", 1.5),
)


def of_single(name, value):
    kind, width = next((kind, width) for pattern, kind, width in SINGLE if re.search(pattern, name))
    if kind == "add":
        high = value + width
        return value - width, min(high, 1) if CORRELATION.search(name) else high
    if kind == "share":
        return value * (1 - width), value * (1 + width)
    return value / width, value * width


def of_several(name, values):
    low, high = min(values), max(values)
    if CORRELATION.search(name):
        middle = statistics.median(values)
        low, high = min(low, middle - 0.15), min(1, max(high, middle + 0.15))
    return low, high


def of_record(name, values):
    """(low, high) of the figure in each hour or receiver."""
    values = [value for value in values if value is not None and not math.isnan(value)]
    if not values or not any(values):  # around nothing no band can be laid
        return None
    return of_single(name, values[0]) if len(values) == 1 else of_several(name, values)


def given():
    """{(site, figure): (low, high) or None}, in the order of the tables."""
    with open(GIVEN, encoding="ascii") as file:
        return {(row["site"], row["figure"]): (float(row["low"]), float(row["high"])) if row["low"] else None
                for row in csv.DictReader(file)}
