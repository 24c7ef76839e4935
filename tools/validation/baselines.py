"""Rovers at distances from a base, by skyloop's own RTK and by RTKLIB's (tools/baselines)."""

import csv
import dataclasses
import datetime
import math
import pathlib
import subprocess

from validation import geodesy

LATITUDE, LONGITUDE, HEIGHT = 46.4775, 30.7326, 77.0
START = datetime.datetime(2023, 1, 1, 6)
METRES_PER_DEGREE = 111194.93
WRONG_M, WRONG_UP_M = 0.1, 0.25

CORRECTIONS_FROM_S = 60  # rover and base have been tracking then, as where people begin
OUTAGE_S = 10

HEADER = ("| surroundings | motion | km | fixed | first fix, s | again, s | error 68 %, mm | told, mm | within | wrong | "
          "RTKLIB fixed | first fix, s | again, s | error 68 %, mm | wrong |\n" + "|---" * 15 + "|")

RTKLIB = """pos1-posmode=kinematic
pos1-frequency=l1+2
pos1-elmask=10
pos1-ionoopt=brdc
pos1-tropopt=saas
pos1-navsys=45
pos2-armode=continuous
pos2-gloarmode=off
pos2-arthres=3
pos2-arlockcnt=5
pos2-arelmask=12
pos2-maxage=30
stats-eratio1=300
stats-eratio2=300
out-solformat=llh
out-timesys=gpst
out-timeform=tow
ant2-postype=llh
"""

MESSAGES = ("1005", "1077", "1087", "1097", "1127", "1230")


@dataclasses.dataclass
class Setup:
    surroundings: str
    moving: bool
    distances_km: list
    seconds: float
    navigation: pathlib.Path  # RINEX

    @property
    def outage_at_s(self):
        """Of the rovers."""
        return self.seconds // 2


@dataclasses.dataclass
class Epoch:
    at_s: int  # since both receivers were started
    fixed: bool
    level_m: float  # error
    up_m: float
    told_m: float


def scenario(setup, seed):
    base = "\n".join(f"CFG-MSGOUT-RTCM_3X_TYPE{number}_UART1 = 1" for number in MESSAGES)
    text = f"""[run]
start = {START:%Y-%m-%dT%H:%M:%S}Z
duration_s = {setup.seconds:g}
seed = {seed}
[sky]
navigation = "{setup.navigation}"
constellations = ["gps", "galileo", "beidou", "glonass"]
[trajectory]
kind = "fixed"
at = [{LATITUDE}, {LONGITUDE}, {HEIGHT}]
[model.modern]
surroundings = "{setup.surroundings}"
[[receiver]]
name = "base"
board = "ublox-f9p"
baud = 460800
[receiver.config]
CFG-TMODE-MODE = 2
CFG-TMODE-POS_TYPE = 1
CFG-TMODE-LAT = {round(LATITUDE * 1e7)}
CFG-TMODE-LON = {round(LONGITUDE * 1e7)}
CFG-TMODE-HEIGHT = {round(HEIGHT * 100)}
CFG-UART1OUTPROT-NMEA = false
CFG-UART1OUTPROT-RTCM3X = true
{base}
"""
    for km in setup.distances_km:
        longitude = LONGITUDE + 1000 * km / METRES_PER_DEGREE / math.cos(math.radians(LATITUDE))
        path = (f'kind = "circle"\ncentre = [{LATITUDE}, {longitude}, 90]\nradius_m = 200\nspeed_mps = 8\n' if setup.moving
                else f'kind = "fixed"\nat = [{LATITUDE}, {longitude}, 90]\n')
        text += (f'[[receiver]]\nname = "rover{km:g}"\nboard = "ublox-f9p"\nbaud = 460800\ncorrections_from = "base"\n'
                 f"[receiver.trajectory]\n{path}")
    rovers = ", ".join(f'"rover{km:g}"' for km in setup.distances_km)
    text += f'[[fault]]\nkind = "corrections_lost"\nreceiver = [{rovers}]\nat_s = 0\nfor_s = {CORRECTIONS_FROM_S}\n'
    return text + (f'[[fault]]\nkind = "outage"\nreceiver = [{rovers}]\nat_s = {setup.outage_at_s:g}\nfor_s = {OUTAGE_S}\n')


def level_and_up(place, truth):
    """Of the difference, metres; both latitude, longitude (degrees), height (m)."""
    east, north, up = geodesy.offset(place, truth)
    return math.hypot(east, north), up


def rover_epochs(path):
    """The rover's own since corrections came, and {time of week, s: truth}."""
    epochs, truths = [], {}
    with open(path, encoding="utf-8", newline="") as file:
        for line in csv.DictReader(file):
            second = round(float(line["tow_s"]))
            truths[second] = tuple(float(line[f"true_{name}"]) for name in ("lat_deg", "lon_deg", "height_m"))
            at_s = second - min(truths)
            if line["lat_deg"] and at_s >= CORRECTIONS_FROM_S:
                level = math.hypot(float(line["east_error_m"]), float(line["north_error_m"]))
                epochs.append(Epoch(at_s, line["fix_type"] == "rtk_fixed", level, float(line["up_error_m"]),
                                    float(line["h_acc_m"])))
    return epochs, truths


def rtklib_epochs(setup, base, rover, truths):
    settings, positions = rover.parent / "rtklib.conf", rover.parent / "rtklib.pos"
    settings.write_text(RTKLIB + f"ant2-pos1={LATITUDE}\nant2-pos2={LONGITUDE}\nant2-pos3={HEIGHT}\n", encoding="ascii")
    begin = START + datetime.timedelta(seconds=CORRECTIONS_FROM_S)
    subprocess.run(["rnx2rtkp", "-k", settings, "-ts", f"{begin:%Y/%m/%d}", f"{begin:%H:%M:%S}", "-o", positions,
                    rover, base, setup.navigation], check=True, capture_output=True)
    epochs = []
    for line in positions.read_text(encoding="ascii").splitlines():
        words = line.split()
        if line.startswith("%") or (second := round(float(words[1]))) not in truths:
            continue
        level, up = level_and_up([float(word) for word in words[2:5]], truths[second])
        epochs.append(Epoch(second - min(truths), words[5] == "1", level, up, math.hypot(float(words[7]), float(words[8]))))
    return epochs


def run(program, setup, seed, folder):
    """For each distance the rover's own epochs and RTKLIB's."""
    folder.mkdir(parents=True)
    path = folder / "scenario.toml"
    path.write_text(scenario(setup, seed), encoding="utf-8")
    out = folder / "out"
    subprocess.run([program, "simulate", path, "--out", out, "--quiet"], check=True, capture_output=True)
    results = []
    for index in range(len(setup.distances_km)):
        rover = out / f"receiver{index + 1}"
        own, truths = rover_epochs(rover / "fixes.csv")
        results.append((own, rtklib_epochs(setup, out / "observations.rnx", rover / "observations.rnx", truths)))
    return results


def first_fixes(series, after_s):
    """The median and the last of some runs, seconds; – for never."""
    waits = sorted(next((epoch.at_s - after_s for epoch in epochs if epoch.fixed and epoch.at_s >= after_s), math.inf)
                   for epochs in series)
    return " … ".join("–" if math.isinf(wait) else f"{wait:g}" for wait in (waits[len(waits) // 2], waits[-1]))


def summary(series, setup):
    """Share fixed, first fixes, those after the outage, error, told, within, wrong, of the epochs of some runs."""
    every = [epoch for epochs in series for epoch in epochs]
    fixed = [epoch for epoch in every if epoch.fixed]
    firsts = first_fixes(series, CORRECTIONS_FROM_S)
    again = first_fixes(series, setup.outage_at_s + OUTAGE_S)
    if not fixed:
        return 0.0, firsts, again, None
    errors = sorted(epoch.level_m for epoch in fixed)
    wrong = sum(epoch.level_m > WRONG_M or abs(epoch.up_m) > WRONG_UP_M for epoch in fixed) / len(fixed)
    within = sum(epoch.level_m <= epoch.told_m for epoch in fixed) / len(fixed)
    told = sum(epoch.told_m for epoch in fixed) / len(fixed)
    return len(fixed) / len(every), firsts, again, (errors[int(0.68 * (len(errors) - 1))], told, within, wrong)


def row(setup, km, runs):
    own_share, own_first, own_again, own = summary([one[0] for one in runs], setup)
    share, first, again, other = summary([one[1] for one in runs], setup)
    cells = [setup.surroundings, "circle, 8 m/s" if setup.moving else "at rest", f"{km:g}", f"{own_share:.2f}", own_first, own_again]
    cells += [f"{1000 * own[0]:.1f}", f"{1000 * own[1]:.1f}", f"{own[2]:.2f}", f"{own[3]:.3f}"] if own else ["", "", "", ""]
    cells += [f"{share:.2f}", first, again] + ([f"{1000 * other[0]:.1f}", f"{other[3]:.3f}"] if other else ["", ""])
    return "| " + " | ".join(cells) + " |"
