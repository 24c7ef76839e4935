"""Behaviours at rest: speed, how much of the errors the accuracies cover, what a second band is worth."""

import math
import statistics

from . import geodesy, runs
from .row_bands import Behaviour, reported, within

SETTLED_S = 60  # what is before is left out
BOARDS = ("ublox-m8", "ublox-m9", "ublox-f9p")
RESTING = (*BOARDS, "ublox-m10")
SURROUNDINGS = ("open-sky", "residential")
PLACES = (  # latitude, longitude, hour of 1 January 2024 in UTC
    (-50.0, -70.0, 3), (-45.9, 170.5, 22), (-34.6, -58.4, 15), (-33.9, 18.4, 10), (-33.9, 151.2, 1),
    (-23.5, -46.6, 18), (-12.0, -77.0, 17), (-6.2, 106.8, 5), (-1.3, 36.8, 12), (1.35, 103.8, 8),
    (6.5, 3.4, 13), (13.1, 80.3, 7), (19.4, -99.1, 20), (25.3, 51.5, 9), (30.0, 31.2, 6),
    (35.7, 139.7, 2), (40.7, -74.0, 16), (46.5, 30.7, 11), (52.5, 13.4, 14), (60.0, 24.9, 21))
HEIGHT_M = 50
ACCURACIES = ("hAcc", "vAcc", "sAcc")
AVERAGED_FROM_S = 600


def settled(outcome, receiver, since=SETTLED_S):
    return [told for told in outcome.told(receiver) if told.fixed and told.time >= since]


def speed_at_rest(bench, _, seed):
    rows = {}
    with runs.run(bench, "behaviour_rest", seed) as outcome:
        for receiver, board in enumerate(RESTING):
            speeds = [math.hypot(*told.velocity[:2]) for told in settled(outcome, receiver)]
            rows[f"speed at rest p50, {board}"] = [1000 * statistics.median(speeds)]
    return rows


def errors(told, place):
    """(error, accuracy) in plan, height and velocity."""
    east, north, up = geodesy.local([a - b for a, b in zip(geodesy.to_ecef(*told.place), geodesy.to_ecef(*place))],
                                    place[0], place[1])
    return ((math.hypot(east, north), told.h_acc), (abs(up), told.v_acc), (math.hypot(*told.velocity), told.s_acc))


def coverage_row(board, surroundings, accuracy, times):
    return f"error within {'2 ' if times == 2 else ''}{accuracy}, {board}, {surroundings}"


def coverage_of_place(bench, part, _):
    """{row: (epochs within, epochs)}; each place has its seed."""
    place, surroundings = part
    latitude, longitude, hour = PLACES[place]
    changes = (("run.start", f"2024-01-01T{hour:02d}:00:00Z"), ("model.modern.surroundings", surroundings),
               ("trajectory.at", f"[{latitude}, {longitude}, {HEIGHT_M}]"))
    counts = {}
    with runs.run(bench, "behaviour_places", place + 1, changes) as outcome:
        for receiver, board in enumerate(BOARDS):
            every = [errors(told, (latitude, longitude, HEIGHT_M)) for told in settled(outcome, receiver)]
            for accuracy, pairs in zip(ACCURACIES, zip(*every)):
                for times in (1, 2):
                    counts[coverage_row(board, surroundings, accuracy, times)] = (
                        sum(error <= times * promised for error, promised in pairs), len(pairs))
    return counts


def pooled(parts):
    rows = {}
    for counts in parts.values():
        for name, (within_it, epochs) in counts.items():
            before = rows.get(name, (0, 0))
            rows[name] = (before[0] + within_it, before[1] + epochs)
    return {name: [within_it / epochs] for name, (within_it, epochs) in rows.items()}


def coverage_bands(_):
    return {coverage_row(board, surroundings, accuracy, times): within(*((0.9, 0.99) if times == 2 else (0.5, 0.8)), "")
            for surroundings in SURROUNDINGS for board in BOARDS for accuracy in ACCURACIES for times in (1, 2)}


def height_errors(bench, _, seed):
    """Mean error of the height after ten minutes, where the ionosphere is twice what is broadcast."""
    rows = {}
    with runs.run(bench, "behaviour_bands", seed) as outcome:
        height = outcome.scenario["trajectory"]["at"][2]
        for receiver, board in enumerate(("ublox-m9", "ublox-f9p")):
            rows[f"mean height error at noon near the equator, {board}"] = [
                statistics.fmean(told.place[2] - height for told in settled(outcome, receiver, AVERAGED_FROM_S))]
    return rows


BEHAVIOURS = (
    Behaviour("speed", speed_at_rest,
              lambda _: {f"speed at rest p50, {board}": within(2, 12, "mm/s") for board in RESTING}),
    Behaviour("coverage", coverage_of_place, coverage_bands,
              tuple((place, surroundings) for place in range(len(PLACES)) for surroundings in SURROUNDINGS),
              gather=pooled, most_seeds=1, short=tuple((place, "open-sky") for place in range(1, len(PLACES), 5))),
    Behaviour("bands", height_errors,
              lambda _: {"mean height error at noon near the equator, ublox-f9p": within(-1.5, 1.5, "m"),
                         "mean height error at noon near the equator, ublox-m9": reported("m")}),
)
