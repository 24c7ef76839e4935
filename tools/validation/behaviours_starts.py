"""Behaviours of receivers that begin or come back: outages, times to the first fix, the first accuracies, SBAS."""

import statistics

from . import pictures, runs
from .row_bands import NEVER, Behaviour, at_least, at_most, growing, never, reported, within

BOARDS = ("ublox-m8", "ublox-m9", "ublox-f9p")
BEFORE_S = 10          # of which the satellites before an outage are the median
BACK_SHARE = 0.9
EPOCH_S = 0.2          # of behaviour_outages.toml
LEVELS = (45, 38, 34, 30)
STARTING = ("ublox-m8", "ublox-m9")
AFTER_FIRST_S = (0, 10, 30)
DRAWN_BOARD, DRAWN_S, DRAWN_M = "ublox-m9", 12, 3
GGA_DIFFERENTIAL = 2


def first(times):
    return next(iter(times), NEVER)


def outages(outcome):
    """(length, end) of each, in seconds."""
    return [(fault["for_s"], fault["at_s"] + fault["for_s"]) for fault in outcome.scenario["fault"]]


def used_before(every, length, end):
    begin = end - length
    return statistics.median(told.sats for told in every if begin - BEFORE_S <= told.time < begin)


def return_times(every, length, end):
    """Seconds until the first fix, and until nearly all satellites are used again."""
    after = [told for told in every if told.time >= end]
    wanted = BACK_SHARE * used_before(every, length, end)
    return (first(round(told.time - end, 3) for told in after if told.fixed),
            first(round(told.time - end, 3) for told in after if told.fixed and told.sats >= wanted))


def returns(bench, _, seed):
    rows = {}
    with runs.run(bench, "behaviour_outages", seed) as outcome:
        for receiver, board in enumerate(BOARDS):
            every = outcome.told(receiver)
            fixes, full = zip(*(return_times(every, length, end) for length, end in outages(outcome)))
            rows[f"first fix after 5 / 20 / 60 / 180 s without signals, {board}"] = list(fixes)
            rows[f"90 % of the satellites again after 5 / 20 / 60 / 180 s, {board}"] = list(full)
            rows[f"90 % of the satellites again after 60 s, {board}"] = [full[2]]
    return rows


def return_bands(_):
    bands = {}
    for board in BOARDS:
        bands[f"first fix after 5 / 20 / 60 / 180 s without signals, {board}"] = growing("s", EPOCH_S)
        bands[f"90 % of the satellites again after 5 / 20 / 60 / 180 s, {board}"] = reported("s")
        bands[f"90 % of the satellites again after 60 s, {board}"] = within(1.5, 60, "s")
    return bands


def draw(program, data, folder):
    """The return of an M9 after outages of all lengths, the first seed."""
    satellites, accuracies = {}, {}
    with runs.run(runs.Bench(program, data), "behaviour_outages", 1) as outcome:
        every = outcome.told(BOARDS.index(DRAWN_BOARD))
        for length, end in outages(outcome):
            after = [told for told in every if end <= told.time <= end + DRAWN_S]
            satellites[f"after {length} s"] = [told.sats if told.fixed else 0 for told in after]
            accuracies[f"after {length} s"] = [min(told.h_acc, DRAWN_M) if told.fixed else None for told in after]
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "return_after_outage.svg"
    panels = (("satellites used", satellites), (f"hAcc, at most {DRAWN_M} m", accuracies))
    path.write_text(pictures.pair("Return of an M9 after outages", panels, DRAWN_S), encoding="utf-8")
    print(path)


def strength_of_sky(bench, seed):
    """Median C/N0 where nothing weakens the signals, which all are alike."""
    with runs.run(bench, "behaviour_starts", seed, (("run.duration_s", 5),)) as outcome:
        return statistics.median(float(row["cn0_dbhz"]) for row in outcome.table("satellites.csv") if row["cn0_dbhz"])


def first_fix(outcome, receiver):
    return first(told.time for told in outcome.told(receiver) if told.fixed)


def time_to_first_fix(bench, level, seed):
    rows = {}
    changes = (("fault.weak.attenuation_db", round(strength_of_sky(bench, 1) - level, 2)),)
    with runs.run(bench, "behaviour_starts", seed, changes) as outcome:
        for receiver, board in enumerate(STARTING):
            rows[level, board] = first_fix(outcome, receiver)
            rows[level, board, "hot"] = first_fix(outcome, receiver + len(STARTING))
    return rows


def start_rows(parts):
    """The levels side by side; those of a short validation alone where there are no others."""
    times = {key: value for part in parts.values() for key, value in part.items()}
    rows = {}
    for board in STARTING:
        by_level = [times[level, board] for level in LEVELS if (level, board) in times]
        if (LEVELS[0], board) in times:
            rows[f"cold start at 45 dB-Hz, {board}"] = by_level[:1]
            rows[f"hot start at 45 dB-Hz, {board}"] = [times[LEVELS[0], board, "hot"]]
        if len(by_level) == len(LEVELS):
            rows[f"cold start at 45 / 38 / 34 dB-Hz, {board}"] = by_level[:-1]
            rows[f"cold start at 30 dB-Hz, below the threshold, {board}"] = by_level[-1:]
    return rows


def start_bands(_):
    bands = {}
    for board in STARTING:
        bands[f"cold start at 45 dB-Hz, {board}"] = within(20, 40, "s")
        bands[f"cold start at 45 / 38 / 34 dB-Hz, {board}"] = growing("s")
        bands[f"cold start at 30 dB-Hz, below the threshold, {board}"] = never("s")
        bands[f"hot start at 45 dB-Hz, {board}"] = at_most(3, "s")
    return bands


def first_accuracies(bench, _, seed):
    rows = {}
    with runs.run(bench, "behaviour_cold", seed) as outcome:
        for receiver, board in enumerate(BOARDS):
            fixes = [told for told in outcome.told(receiver) if told.fixed]
            if not fixes or fixes[-1].time < fixes[0].time + AFTER_FIRST_S[-1]:
                continue
            later = [first(told for told in fixes if told.time >= fixes[0].time + after) for after in AFTER_FIRST_S]
            rows[f"hAcc at the first fix, 10 s and 30 s later, {board}"] = [told.h_acc for told in later]
            rows[f"satellites at the first fix, 10 s and 30 s later, {board}"] = [told.sats for told in later]
            rows[f"hAcc at the first fix over that 30 s later, {board}"] = [later[0].h_acc / later[2].h_acc]
    return rows


def accuracy_bands(_):
    bands = {}
    for board in BOARDS:
        bands[f"hAcc at the first fix, 10 s and 30 s later, {board}"] = reported("m")
        bands[f"satellites at the first fix, 10 s and 30 s later, {board}"] = reported("")
        bands[f"hAcc at the first fix over that 30 s later, {board}"] = at_least(2, "")
    return bands


def differential_fixes(bench, _, seed):
    """When NAV-PVT and GGA first say so, after a cold start; a GGA is of the epoch of the NAV-PVT before it."""
    rows = {}
    with runs.run(bench, "behaviour_sbas", seed) as outcome:
        for receiver, place in enumerate(("Munich", "La Paz")):
            pvt, gga, time = [], [], 0
            for name, fields in outcome.messages(receiver):
                if name == "NAV-PVT":
                    time = fields["tow_s"] - outcome.start_s
                    pvt += [time] if fields["flags"] & runs.DIFFERENTIAL else []
                elif name[2:] == "GGA" and fields["quality"] == GGA_DIFFERENTIAL:
                    gga.append(time)
            rows[f"SBAS after a cold start in {place}: diffSoln / GGA quality 2, ublox-m9"] = [first(pvt), first(gga)]
    return rows


BEHAVIOURS = (
    Behaviour("returns", returns, return_bands),
    Behaviour("first_fixes", time_to_first_fix, start_bands, LEVELS, gather=start_rows, short=LEVELS[:1]),
    Behaviour("first_accuracies", first_accuracies, accuracy_bands),
    Behaviour("sbas", differential_fixes,
              lambda _: {"SBAS after a cold start in Munich: diffSoln / GGA quality 2, ublox-m9": within(60, 120, "s"),
                         "SBAS after a cold start in La Paz: diffSoln / GGA quality 2, ublox-m9": never("s")}),
)
