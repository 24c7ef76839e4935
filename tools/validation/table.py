"""Rows of figures, the markdown of a site, and the list of what was inside when it was last looked at."""

import dataclasses
import math
import pathlib
import statistics

FOLDER = pathlib.Path(__file__).parent


@dataclasses.dataclass
class Row:
    site: str
    figure: str
    band: tuple
    values: list          # of the seeds
    from_record: bool     # the band is of the record as read now; else of bands.csv

    @property
    def known(self):
        """The seeds that gave a value."""
        return [value for value in self.values if not math.isnan(value)]

    @property
    def median(self):
        return statistics.median(self.known) if self.known else math.nan

    @property
    def inside(self):
        return self.band[0] <= self.median <= self.band[1]

    @property
    def firmly_inside(self):
        return all(self.band[0] <= value <= self.band[1] for value in self.values)

    def as_json(self):
        return {"figure": self.figure, "band": list(self.band), "values": self.values, "median": self.median,
                "inside": self.inside, "band_from": "record" if self.from_record else "table"}


def number(value):
    return "–" if math.isnan(value) else f"{value:.3g}"


def markdown(title, rows):
    lines = [f"### {title}", "", "| figure | band | median | range | inside |", "|---|---|---|---|---|"]
    for row in rows:
        band = f"{number(row.band[0])} … {number(row.band[1])}" + ("" if row.from_record else " (of the table)")
        span = f"{number(min(row.known))} … {number(max(row.known))}" if row.known else "–"
        lines.append(f"| {row.figure} | {band} | {number(row.median)} | {span} | {'yes' if row.inside else 'no'} |")
    return "\n".join(lines)


def total(rows):
    return f"{sum(row.inside for row in rows)} of {len(rows)} inside"


def expectation_file(short):
    return FOLDER / ("inside_short.txt" if short else "inside.txt")


def expected(short):
    """{(site, figure)}."""
    path = expectation_file(short)
    if not path.exists():
        return set()
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    return {tuple(line.split(": ", 1)) for line in lines}


def bless(short, rows):
    """Keeps what is inside; what was kept of sites that were not looked at stays. Two seeds tell little: of a short
    validation all of them must be inside."""
    seen = {row.site for row in rows}
    kept = {entry for entry in expected(short) if entry[0] not in seen}
    kept |= {(row.site, row.figure) for row in rows if row.inside and (row.firmly_inside or not short)}
    head = "# Figures in the band of the real receivers: tools/validate fails when one has left it; --bless rewrites.\n"
    expectation_file(short).write_text(head + "".join(f"{site}: {figure}\n" for site, figure in sorted(kept)),
                                       encoding="utf-8")


def lost(short, rows):
    """Those that should be inside and are not."""
    names = expected(short)
    return [row for row in rows if (row.site, row.figure) in names and not row.inside]
