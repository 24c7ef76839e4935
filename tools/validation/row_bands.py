"""Behaviours, their rows, and bands that judge the medians of a row's numbers."""

import dataclasses
import math
import statistics

NEVER = math.inf  # of a time


def number(value):
    if math.isinf(value):
        return "never"
    return "–" if math.isnan(value) else f"{value:.3g}"


@dataclasses.dataclass(frozen=True)
class Band:
    text: str
    unit: str
    holds: object           # the row's numbers → whether they are as they should be
    judged: bool = True     # else it is there to be read


def within(low, high, unit):
    return Band(f"{number(low)} … {number(high)} {unit}".strip(), unit,
                lambda values: all(low <= value <= high for value in values))


def at_least(low, unit):
    return Band(f"≥ {number(low)} {unit}".strip(), unit, lambda values: all(value >= low for value in values))


def at_most(high, unit):
    return Band(f"≤ {number(high)} {unit}".strip(), unit, lambda values: all(value <= high for value in values))


def exactly(wanted, unit):
    return Band(f"{number(wanted)} {unit}".strip(), unit, lambda values: all(value == wanted for value in values))


def never(unit):
    return Band("never", unit, lambda values: all(value == NEVER for value in values))


def growing(unit, slack=0.0):
    """Each number at least the one before, but for the slack, and none that never came."""
    return Band("none less than the one before", unit,
                lambda values: values[-1] < NEVER and all(later >= earlier - slack
                                                          for earlier, later in zip(values, values[1:])))


def reported(unit):
    return Band("–", unit, lambda values: True, judged=False)


@dataclasses.dataclass
class Row:
    name: str
    band: Band
    values: list  # of the seeds, each a list of numbers

    @property
    def medians(self):
        return [statistics.median(column) for column in zip(*self.values)]

    @property
    def inside(self):
        medians = self.medians
        return bool(medians) and not any(map(math.isnan, medians)) and self.band.holds(medians)

    @property
    def text(self):
        return f"{' / '.join(map(number, self.medians)) or '–'} {self.band.unit}".strip()

    def as_json(self):
        return {"behaviour": self.name, "band": self.band.text, "unit": self.band.unit, "values": self.values,
                "median": self.medians, "inside": self.inside if self.band.judged else None}


def union(parts):
    """{part: values} as the values of all parts."""
    return {name: value for values in parts.values() for name, value in values.items()}


@dataclasses.dataclass(frozen=True)
class Behaviour:
    name: str
    measure: object            # (bench, part, seed) → {row: numbers}
    bands: object              # bench → {row: band}, in the order of the table
    parts: tuple = ("",)       # what it is measured in
    short: tuple = None        # of these in a short validation; else all
    gather: object = union     # {part: values} of a seed → {row: numbers}
    most_seeds: int = 1000     # 1 where the parts have seeds of their own, and are many enough

    def chosen(self, short):
        return self.short if short and self.short is not None else self.parts
