"""Behaviours in motion: how late position and velocity are in turns, what a dynamic model bears, and the same causes of
error at two rates."""

import math
import statistics

from . import geodesy, runs
from .row_bands import Behaviour, at_least, exactly, within

BOARDS = ("ublox-m8", "ublox-m9", "ublox-f9p")
SETTLED_S = 60
LAG_STEPS, LAG_STEPS_S = 5, (0.12, 0.03)  # shifts that are tried, either way, about nothing and about the best of these
RATES = (1, 10)
SAME_CAUSES = "errors at 1 and 10 Hz, correlation east / north / up, ublox-m9"
LEAST_USED = 4


class Curve:
    """Vectors at even times, and between them along the cubic through four of them."""

    def __init__(self, times, values):
        self.first, self.step = times[0], (times[-1] - times[0]) / (len(times) - 1)
        self.values = values

    def __call__(self, time):
        where = (time - self.first) / self.step
        low = min(max(int(where), 1), len(self.values) - 3)
        u = where - low
        weights = (-u * (u - 1) * (u - 2) / 6, (u + 1) * (u - 1) * (u - 2) / 2, -(u + 1) * u * (u - 2) / 2,
                   (u + 1) * u * (u - 1) / 6)
        around = self.values[low - 1:low + 3]
        return [math.fsum(w * value[axis] for w, value in zip(weights, around)) for axis in range(len(around[0]))]


def rates(step, values):
    """The derivative of even values by five of them; two fewer at either end."""
    return [[(a - 8 * b + 8 * d - e) / (12 * step) for a, b, d, e in zip(*around)]
            for around in zip(values, values[1:], values[3:], values[4:])]


def local(place, origin):
    """East and north in metres."""
    return geodesy.local([a - b for a, b in zip(geodesy.to_ecef(*place), geodesy.to_ecef(*origin))], *origin[:2])[:2]


def scatter(curve, reported, shift):
    """Mean square of what is reported less the curve so much before, about the mean."""
    rest = [[a - b for a, b in zip(value, curve(time - shift))] for time, value in reported]
    return math.fsum(statistics.pvariance(axis) for axis in zip(*rest))


def lag(curve, reported):
    """Milliseconds by which the curve has to be shifted to lie best on what is reported: the lowest point of the
    parabola through the best of the shifts that are tried and its neighbours."""
    best = 0.0
    for step in LAG_STEPS_S:
        shifts = [best + index * step for index in range(-LAG_STEPS, LAG_STEPS + 1)]
        sums = [scatter(curve, reported, shift) for shift in shifts]
        place = min(max(sums.index(min(sums)), 1), len(sums) - 2)
        before, here, after = sums[place - 1:place + 2]
        best = shifts[place] + step * (before - after) / (2 * (before - 2 * here + after))
    return 1000 * best


def lags(bench, _, seed):
    rows = {}
    with runs.run(bench, "behaviour_turns", seed) as outcome:
        truth = outcome.truth(0)
        origin = outcome.scenario["trajectory"]["centre"]
        times, places = [row[0] for row in truth], [local(row[1:], origin) for row in truth]
        way = Curve(times, places)
        speed = Curve(times[2:-2], rates(way.step, places))
        for receiver, board in enumerate(BOARDS):
            fixes = [told for told in outcome.told(receiver) if told.fixed and SETTLED_S <= told.time < times[-1] - 2]
            rows[f"velocity late in turns, {board}"] = [lag(speed, [(told.time, told.velocity[:2]) for told in fixes])]
            rows[f"position late in turns, {board}"] = [
                lag(way, [(told.time, local(told.place, origin)) for told in fixes])]
    return rows


def lag_bands(_):
    return {f"{what} late in turns, {board}": within(low, 150, "ms")
            for board in BOARDS for what, low in (("velocity", 30), ("position", 0))}


def errors_by_second(bench, rate, seed):
    """{second: east, north, up} of single epochs."""
    with runs.run(bench, "behaviour_rate", seed, (("receiver.0.rate_hz", rate),)) as outcome:
        place = outcome.scenario["trajectory"]["at"]
        site = geodesy.to_ecef(*place)
        return {round(told.time): geodesy.local([a - b for a, b in zip(geodesy.to_ecef(*told.place), site)], *place[:2])
                for told in outcome.told(0) if told.fixed and abs(told.time - round(told.time)) < 0.01}


def same_causes(bench, _, seed):
    slow, fast = (errors_by_second(bench, rate, seed) for rate in RATES)
    common = sorted(slow.keys() & fast.keys())
    axes = zip(zip(*(slow[second] for second in common)), zip(*(fast[second] for second in common)))
    return {SAME_CAUSES: [statistics.correlation(*axis) for axis in axes]}


def climb(bench, _, seed):
    """Fewest satellites used while the motor burns and in the second after it."""
    rows = {}
    with runs.run(bench, "behaviour_climb", seed) as outcome:
        path = outcome.scenario["trajectory"]
        begin, end = path["start_delay_s"], path["start_delay_s"] + path["burn_s"] + 1
        for receiver, model in enumerate(("AIRBORNE_1G", "AIRBORNE_4G")):
            rows[f"satellites used in a climb of 2.5 g, {model}, ublox-m10"] = [
                min(told.sats for told in outcome.told(receiver) if begin <= told.time <= end)]
    return rows


BEHAVIOURS = (
    Behaviour("turns", lags, lag_bands),
    Behaviour("rates", same_causes, lambda _: {SAME_CAUSES: at_least(0.8, "")}),
    Behaviour("climb", climb,
              lambda _: {"satellites used in a climb of 2.5 g, AIRBORNE_1G, ublox-m10": exactly(0, ""),
                         "satellites used in a climb of 2.5 g, AIRBORNE_4G, ublox-m10": at_least(LEAST_USED, "")}),
)
