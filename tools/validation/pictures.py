"""Series of real and simulated receivers side by side, as SVG."""

import math
import pathlib
import statistics
import tempfile

from . import figures, geodesy, records, simulation, sites

WIDTH, HEIGHT, GAP, EDGE, TOP = 420, 220, 60, 50, 46
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7")
MOST_POINTS = 1300
SATELLITE = "G19"  # of the riverside: at 30°, the whole record


def enu(rows):
    return dict(zip(figures.AXES, geodesy.east_north_up(rows)))


def position(evidence):
    return enu(records.by_second(evidence.ubx.position))


def speed(evidence):
    return {"over ground": [value and value * 1000 for value in records.by_second(evidence.nmea.speed)]}


def code_minus_carrier(evidence):
    """Less the best quadratic of the longest stretch without a slip."""
    rows = evidence.rinex.code_rows(evidence.elevations)[SATELLITE]
    arc = max(figures.arcs(rows), key=len)
    return {SATELLITE: figures.without_quadratic([row[1] - row[2] for row in arc])}


def strength(evidence):
    """Three signals of GPS L1 that are seen nearly all the time, low, middle and high."""
    epochs = records.by_second(evidence.nmea.strengths)
    seen = {}
    for epoch in epochs:
        for name, (elevation, _) in (epoch or {}).items():
            if name[0] == "GP" and str(name[2]) == "1":
                seen.setdefault(name, []).append(elevation)
    longest = max(len(elevations) for elevations in seen.values())
    middle = {name: statistics.fmean(values) for name, values in seen.items() if len(values) > 0.8 * longest}
    chosen = dict.fromkeys(min(middle, key=lambda name: abs(middle[name] - wanted)) for wanted in (15, 30, 55))
    return {f"G{int(name[1]):02d}, {middle[name]:.0f}°":
            [epoch[name][1] if epoch and name in epoch else None for epoch in epochs] for name in chosen}


def tree_hour(evidence):
    """Of the record the hour whose height wanders as much as in most."""
    if isinstance(evidence, list):
        hours = sorted((enu(hour.rows) for hour in evidence), key=lambda hour: statistics.stdev(figures.known(hour["U"])))
        return hours[len(hours) // 2]
    return position(evidence)


PICTURES = (  # file, title, unit, site, series
    ("position_at_rest", "Position at rest, M8P in a garden", "m", "garden", position),
    ("velocity_at_rest", "Speed told at rest, M8P by a river", "mm/s", "riverside-nmea", speed),
    ("code_minus_carrier", "Code minus carrier, M8P by a river", "m", "riverside-raw", code_minus_carrier),
    ("strength_in_a_car", "C/N0 in a car", "dB-Hz", "car", strength),
    ("trees", "Position under trees, LEA-6, an hour", "m", "trees", tree_hour),
)


def thinned(series):
    return list(enumerate(series))[::max(1, math.ceil(len(series) / MOST_POINTS))]


def ticks(low, high):
    step = 10 ** math.floor(math.log10(high - low))
    step = next(step * factor for factor in (0.2, 0.5, 1, 2) if (high - low) / (step * factor) <= 6)
    first = math.ceil(low / step)
    return [index * step for index in range(first, math.floor(high / step) + 1)]


def limits(lines):
    """From the least to the greatest value and a little beyond."""
    values = [value for line in lines for value in line if value is not None]
    margin = (max(values) - min(values)) * 0.03 or 1
    return min(values) - margin, max(values) + margin


def panel(series, title, left, scale, seconds=None):
    """One diagram: its frame, scale from low to high and lines, a value each second where it is not told how long."""
    longest = max(len(values) for values in series.values())
    low, high = scale

    def across(index):
        return left + WIDTH * index / max(longest - 1, 1)

    def down(value):
        return TOP + HEIGHT * (high - value) / (high - low)

    parts = [f'<text x="{left}" y="{TOP - 8}" font-weight="bold">{title}</text>',
             f'<rect x="{left}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#888"/>',
             f'<text x="{left + WIDTH}" y="{TOP + HEIGHT + 16}" text-anchor="end">{seconds or longest} s</text>']
    for value in ticks(low, high):
        parts.append(f'<path d="M{left} {down(value):.1f}h{WIDTH}" stroke="#ddd"/>'
                     f'<text x="{left - 5}" y="{down(value) + 4:.1f}" text-anchor="end">{value:g}</text>')
    for place, ((name, values), colour) in enumerate(zip(series.items(), COLOURS)):
        path, pen_down = [], False
        for index, value in thinned(values):
            if value is not None:
                path.append(f"{'L' if pen_down else 'M'}{across(index):.1f} {down(value):.1f}")
            pen_down = value is not None
        parts.append(f'<path d="{"".join(path)}" fill="none" stroke="{colour}" stroke-width="0.8"/>'
                     f'<text x="{left + 8 + 90 * place}" y="{TOP + HEIGHT + 16}" fill="{colour}">{name}</text>')
    return "\n".join(parts)


def page(title, diagrams):
    """Two panels side by side."""
    width, height = EDGE + 2 * WIDTH + GAP + 10, TOP + HEIGHT + 26
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" '
            f'font-size="11">\n'
            f'<rect width="{width}" height="{height}" fill="white"/>\n'
            f'<text x="{EDGE}" y="18" font-size="14">{title}</text>\n' + "\n".join(diagrams) + "\n</svg>\n")


def svg(title, unit, real, simulated):
    """Both with one scale."""
    scale = limits([*real.values(), *simulated.values()])
    return page(f"{title}, {unit}", (panel(real, "real", EDGE, scale),
                                     panel(simulated, "simulated", EDGE + WIDTH + GAP, scale)))


def pair(title, panels, seconds):
    """Two (title, series) of so many seconds, each with a scale of its own."""
    return page(title, [panel(series, name, EDGE + place * (WIDTH + GAP), limits(series.values()), seconds)
                        for place, (name, series) in enumerate(panels)])


def draw(program, data, folder):
    """Writes all of them, of the first seed."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, title, unit, site_name, series in PICTURES:
        site = next(site for site in sites.SITES if site.name == site_name)
        setup = sites.SETUPS[site.setup]
        record = site.record(program, data, setup)
        with tempfile.TemporaryDirectory() as scratch:
            simulated = series(simulation.run(program, data, setup, 1, pathlib.Path(scratch)))
        real = series(record if isinstance(record[0], sites.Hours) else record[0])
        (folder / f"{name}.svg").write_text(svg(title, unit, real, simulated), encoding="utf-8")
        print(folder / f"{name}.svg")
