"""The formulas of the figures: positions, velocities, counts, C/N0, raw code and Doppler. All of the standard library.

A series is a list with a row for each second; None where the receiver told nothing.
"""

import math
import statistics

from . import geodesy

AXES = ("E", "N", "U")
SPEED_OF_LIGHT = 299792458.0
CODE_WINDOW_S = 240      # out of which a quadratic is taken from code minus carrier
SHORTEST_WINDOW_S = 120  # of an arc that still counts
LEAST_OF_BIN = 30        # values that a bin of elevation needs


def known(series):
    return [value for value in series if value is not None]


def percentile(values, share):
    """Linear between the ranks."""
    ordered = sorted(values)
    place = share * (len(ordered) - 1)
    low = int(place)
    high = min(low + 1, len(ordered) - 1)
    return ordered[low] + (ordered[high] - ordered[low]) * (place - low)


def robust_sigma(values):
    """1.4826 times the median distance from the median."""
    middle = statistics.median(values)
    return 1.4826 * statistics.median(abs(value - middle) for value in values)


def autocorrelation(series, lag):
    """About the mean of the whole series: the mean product of the pairs that there are, over the variance."""
    there = known(series)
    mean = math.fsum(there) / len(there)
    centred = [None if value is None else value - mean for value in series]
    products = [a * b for a, b in zip(centred, centred[lag:]) if a is not None and b is not None]
    variance = math.fsum((value - mean) ** 2 for value in there) / len(there)
    if not products or variance == 0:
        return math.nan
    return math.fsum(products) / len(there) / variance


def differences(series):
    return [None if a is None or b is None else b - a for a, b in zip(series, series[1:])]


def kurtosis(values):
    """3 of a normal distribution."""
    mean = math.fsum(values) / len(values)
    second = math.fsum((value - mean) ** 2 for value in values) / len(values)
    return math.fsum((value - mean) ** 4 for value in values) / len(values) / second ** 2 if second else math.nan


def of_position(rows, lags):
    """std, r…, d1 … of rows of latitude, longitude, height (None: no fix), about their mean."""
    figures = {}
    for axis, series in zip(AXES, geodesy.east_north_up(rows)):
        steps = differences(series)
        figures[f"std {axis}"] = statistics.stdev(known(series))
        for lag in lags:
            figures[f"r{lag} {axis}"] = autocorrelation(series, lag)
        figures[f"d1 std {axis}"] = statistics.stdev(known(steps))
        figures[f"d1 r1 {axis}"] = autocorrelation(steps, 1)
        figures[f"d1 kurt {axis}"] = kurtosis(known(steps))
    return figures


def of_errors(errors, shares=(50, 95, 99)):
    """Of rows of east, north, up against the truth (None: no fix): the share of fixes, and percentiles of the horizontal
    error and of its change from one epoch to the next."""
    steps = [[b - a for a, b in zip(before, after)] for before, after in zip(errors, errors[1:]) if before and after]
    figures = {"fixes": len(known(errors)) / len(errors)}
    for name, rows in (("error", known(errors)), ("d1 error", steps)):
        for share in shares if rows else ():
            figures[f"{name} p{share}"] = percentile([math.hypot(*row[:2]) for row in rows], share / 100)
    return figures


def of_speed(speeds):
    """Of a receiver that stands; m/s."""
    return {"speed at rest p50": percentile(speeds, 0.5), "speed at rest p95": percentile(speeds, 0.95)}


def of_counts(counts, kind="sats"):
    """Mean of the satellites used (or of another kind), and how often their number differs from the epoch before."""
    pairs = [(a, b) for a, b in zip(counts, counts[1:]) if a is not None and b is not None]
    return {kind: statistics.fmean(known(counts)),
            f"{kind.removesuffix('s')} changes": sum(a != b for a, b in pairs) / len(pairs) if pairs else math.nan}


def of_strength(epochs):
    """Mean and spread of C/N0 by tens of degrees of elevation; an epoch is {satellite: (elevation, C/N0)}."""
    bins = {}
    for epoch in epochs:
        for elevation, strength in epoch.values():
            bins.setdefault(tens(elevation), []).append(strength)
    figures = {}
    for low, values in sorted(bins.items()):
        if len(values) >= LEAST_OF_BIN:
            figures[f"C/N0 el {low}"] = statistics.fmean(values)
            figures[f"C/N0 sd el {low}"] = statistics.pstdev(values)
    return figures


def of_satellites(epochs):
    """C/N0 of all satellites together, and its standard deviation for one of them (the median)."""
    series = {}
    for epoch in epochs:
        for satellite, (_, strength) in epoch.items():
            series.setdefault(satellite, []).append(strength)
    every = [strength for values in series.values() for strength in values]
    figures = {f"C/N0 p{share}": percentile(every, share / 100) for share in (5, 50, 95)}
    figures["C/N0 sd of a satellite"] = statistics.median(
        statistics.pstdev(values) for values in series.values() if len(values) >= LEAST_OF_BIN)
    return figures


def of_strength_steps(epochs, width=20):
    """Change of C/N0 from epoch to epoch by elevation: its standard deviation, and the share of 5 dB and more."""
    bins = {}
    for before, after in zip(epochs, epochs[1:]):
        for satellite, (elevation, strength) in after.items():
            if satellite in before:
                bins.setdefault(tens(elevation, width), []).append(strength - before[satellite][1])
    figures = {}
    for low, steps in sorted(bins.items()):
        if len(steps) >= LEAST_OF_BIN:
            figures[f"C/N0 change per epoch sd el {low}"] = statistics.pstdev(steps)
            figures[f"share of C/N0 changes of 5 dB el {low}"] = sum(abs(step) >= 5 for step in steps) / len(steps)
    return figures


def tens(elevation, width=10):
    """The lower edge of its bin; the zenith belongs to the last one."""
    return min(int(max(elevation, 0) // width) * width, 80)


def arcs(rows, jump_m=5.0):
    """Stretches of one satellite without a gap or slip; a row is (second, code, carrier in m, slipped, …)."""
    arc = []
    for row in rows:
        if arc and (row[0] != arc[-1][0] + 1 or row[3] or
                    abs((row[1] - row[2]) - (arc[-1][1] - arc[-1][2])) > jump_m):
            yield arc
            arc = []
        arc.append(row)
    if arc:
        yield arc


def without_quadratic(values):
    """The residuals of the best quadratic through equidistant values."""
    count = len(values)
    times = [2 * index / (count - 1) - 1 for index in range(count)]
    sums = [math.fsum(t ** power for t in times) for power in range(5)]
    right = [math.fsum(v * t ** power for v, t in zip(values, times)) for power in range(3)]
    c = geodesy.solve([[sums[i + j] for j in range(3)] for i in range(3)], right)
    return [v - (c[0] + c[1] * t + c[2] * t * t) for v, t in zip(values, times)]


def code_windows(satellites):
    """(mean elevation, mean C/N0, residuals of code minus carrier) of each window; satellites: {name: rows of
    (second, code m, carrier m, slipped, C/N0, elevation)}."""
    for rows in satellites.values():
        for arc in arcs(rows):
            for start in range(0, len(arc), CODE_WINDOW_S):
                window = arc[start:start + CODE_WINDOW_S]
                if len(window) >= SHORTEST_WINDOW_S:
                    yield (statistics.fmean(row[5] for row in window), statistics.fmean(row[4] for row in window),
                           without_quadratic([row[1] - row[2] for row in window]))


def of_code(satellites):
    """code noise white, code MP std and r1, C/N0 by tens of degrees: medians of the windows."""
    bins = {}
    for elevation, strength, residuals in code_windows(satellites):
        white = statistics.pstdev(known(differences(residuals))) / math.sqrt(2)
        bins.setdefault(tens(elevation), []).append(
            (white, statistics.pstdev(residuals), autocorrelation(residuals, 1), strength))
    figures = {}
    for low, windows in sorted(bins.items()):
        names = ("code noise white", "code MP std", "code MP r1", "C/N0")
        for name, values in zip(names, zip(*windows)):
            figures[f"{name} el {low}"] = statistics.median(values)
    return figures


def doppler_residuals(satellites):
    """(elevation, m/s) of each satellite and epoch; satellites: {name: rows of (second, carrier m, slipped, range rate
    m/s, elevation)}. The mean of two Dopplers minus the carrier's change, less the median of the epoch."""
    epochs = {}
    for rows in satellites.values():
        for before, after in zip(rows, rows[1:]):
            if after[0] == before[0] + 1 and not after[2]:
                value = (before[3] + after[3]) / 2 - (after[1] - before[1])
                epochs.setdefault(after[0], []).append((after[4], value))
    for values in epochs.values():
        if len(values) >= 4:
            middle = statistics.median(value for _, value in values)
            yield from ((elevation, value - middle) for elevation, value in values)


def of_doppler(satellites):
    """Doppler noise by tens of degrees, mm/s; satellites as above."""
    bins = {}
    for elevation, value in doppler_residuals(satellites):
        bins.setdefault(tens(elevation), []).append(value)
    return {f"Doppler noise mm/s el {low}": 1000 * robust_sigma(values) for low, values in sorted(bins.items())
            if len(values) >= LEAST_OF_BIN}
