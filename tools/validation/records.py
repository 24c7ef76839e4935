"""Readers of what receivers leave: streams of UBX and NMEA, RINEX, RTKLIB's positions, GnssLogger, tables of positions."""

import csv
import datetime
import gzip
import json
import pathlib
import re
import statistics
import subprocess
import tempfile

from . import geodesy

GLITCH_M = 1000  # a height that far off is the logger's
L1, FREQUENCIES = 1575.42e6, {"C": 1561.098e6}  # Hz
GPS_EPOCH = datetime.datetime(1980, 1, 6)


def text(path):
    data = path.read_bytes()
    return (gzip.decompress(data) if path.suffix == ".gz" else data).decode("ascii", "replace")


def gps_seconds(year, month, day, hour, minute, second):
    moment = datetime.datetime(year, month, day, hour, minute) - GPS_EPOCH
    return moment.days * 86400 + moment.seconds + second


def by_second(items):
    """{second: value} as a list from the first to the last second, None where there is none."""
    if not items:
        return []
    return [items.get(second) for second in range(min(items), max(items) + 1)]


def position_table(path, step):
    """Rows of latitude, longitude, height, every step-th; None for a glitch."""
    rows = [[float(cell) for cell in line.split(",")] for line in text(path).splitlines() if line.count(",") == 2][::step]
    middle = statistics.median(row[2] for row in rows)
    return [row if abs(row[2] - middle) < GLITCH_M else None for row in rows]


def hours_of(rows):
    return [rows[start:start + 3600] for start in range(0, len(rows) - 3599, 3600)]


def messages(program, path):
    """(name, fields) of the stream, by `skyloop decode`."""
    lines = subprocess.run([program, "decode", path, "--format", "json", "--quiet"], check=True, capture_output=True,
                           encoding="utf-8").stdout.splitlines()
    for line in lines:
        message = json.loads(line)
        if "fields" in message:
            yield message["name"], message["fields"]


class Told:
    """What a receiver told, series by second."""

    def __init__(self):
        self.position, self.velocity, self.speed, self.sats = {}, {}, {}, {}
        self.told = {}       # h_acc, v_acc, s_acc, p_acc, hdop …: {second: value}
        self.strengths = {}  # {second: {satellite: (elevation, C/N0)}}

    def tell(self, name, second, value):
        if value is not None:
            self.told.setdefault(name, {})[second] = value

    def values(self, name):
        return list(self.told.get(name, {}).values())


def from_ubx(stream):
    """NAV-SOL while it has a 3D fix of its own, NAV-PVT, NAV-POSLLH, NAV-DOP."""
    result = Told()
    for name, f in stream:
        if not name.startswith("NAV-"):
            continue
        second = round(f["tow_s"])
        if name == "NAV-SOL" and f["fix_type"] == 3:
            place = geodesy.to_geodetic(*f["ecef_m"])
            result.position[second] = place
            result.velocity[second] = geodesy.local(f["ecef_v_mps"], *place[:2])
            result.sats[second] = f["satellites"]
            result.tell("p_acc", second, f["p_acc_m"])
            result.tell("s_acc", second, f["speed_acc_mps"])
        elif name == "NAV-POSLLH":
            result.position[second] = [f["lat_deg"], f["lon_deg"], f["height_m"]]
        elif name == "NAV-PVT" and f["fix_type"] == 3:
            result.position[second] = [f["lat_deg"], f["lon_deg"], f["height_m"]]
            result.speed[second] = f["speed_mps"]
            result.velocity[second] = [f["vel_east_mps"], f["vel_north_mps"], -f["vel_down_mps"]]
            result.sats[second] = f["satellites"]
            for short, key in (("h_acc", "h_acc_m"), ("v_acc", "v_acc_m"), ("s_acc", "speed_acc_mps")):
                result.tell(short, second, f[key])
        elif name == "NAV-DOP":
            result.tell("hdop", second, f["hdop"])
    for second, (east, north, _) in result.velocity.items():
        result.speed.setdefault(second, (east * east + north * north) ** 0.5)
    return result


def clock_second(time):
    hours, minutes, seconds = time.split(":")
    return round(int(hours) * 3600 + int(minutes) * 60 + float(seconds))


def from_nmea(stream):
    """RMC begins an epoch: speed of it, place and HDOP of GGA, satellites of GSA, C/N0 of GSV, of every signal that is
    told apart."""
    result, second = Told(), None
    for name, f in stream:
        kind = name[2:] if len(name) == 5 else ""
        if kind == "RMC":
            second = clock_second(f["time"]) if f.get("time") else None
            if second is not None and f.get("status") == "A":
                result.speed[second] = f["speed_mps"]
        elif second is None:
            continue
        elif kind == "GGA" and f.get("lat_deg") is not None and f.get("quality"):
            height = (f["msl_m"] or 0) + (f["geoid_separation_m"] or 0)
            result.position[second] = [f["lat_deg"], f["lon_deg"], height]
            result.tell("hdop", second, f["hdop"])
        elif kind == "GSA" and f.get("fix_mode", 0) > 1:
            result.sats[second] = result.sats.get(second, 0) + len(f["satellites"])
        elif kind == "GSV":
            for satellite in f["satellites"]:
                if satellite.get("cno_dbhz") and satellite.get("elevation_deg") is not None:
                    result.strengths.setdefault(second, {})[name[:2], satellite["number"], f.get("signal_id")] = (
                        satellite["elevation_deg"], satellite["cno_dbhz"])
    return result


def from_fixes(path):
    """A fixes.csv of the program."""
    result = Told()
    with open(path, encoding="ascii") as file:
        for row in csv.DictReader(file):
            second = round(float(row["tow_s"]))
            if row["lat_deg"]:
                result.position[second] = [float(row[name]) for name in ("lat_deg", "lon_deg", "height_m")]
                result.speed[second] = float(row["speed_mps"])
                result.sats[second] = int(row["satellites_used"])
                result.tell("h_acc", second, float(row["h_acc_m"]))
    return result


class Rinex:
    """Observations of the first band of RINEX 3: {satellite: {second: (code m, carrier m, slipped, Doppler Hz or None,
    C/N0, wavelength m)}}."""

    def __init__(self, path, systems):
        self.satellites, self.columns, self.channels = {}, {}, {}
        self.strengths = {}  # {second: {satellite: dB-Hz}}, of all that has a code
        lines = iter(text(path).splitlines())
        self._header(lines)
        second = None
        for line in lines:
            if line.startswith(">"):
                year, month, day, hour, minute = (int(word) for word in line[1:19].split())
                second = round(gps_seconds(year, month, day, hour, minute, float(line[18:30])))
            elif line[:1] in systems and line[:1] in self.columns:
                self._satellite(line, second)

    def _header(self, lines):
        system = None
        for line in lines:
            if line[60:].startswith("SYS / # / OBS"):
                if line[0] != " ":
                    system = line[0]
                    self.columns[system] = []
                self.columns[system] += line[6:60].split()
            elif line[60:].startswith("GLONASS SLOT"):
                words = line[4:60].split()
                self.channels.update({name: int(number) for name, number in zip(words[::2], words[1::2])})
            elif line[60:].startswith("END OF HEADER"):
                return

    def _satellite(self, line, second):
        names = self.columns[line[0]]
        bands = ("C1", "C2") if line[0] == "C" else ("C1",)  # B1I is C1I or C2I
        band = next((name[1:] for name in names if name[:2] in bands), None)
        cells = {}
        for index, name in enumerate(names):
            if name[1:] == band:
                cell = line[3 + 16 * index:19 + 16 * index]
                cells[name[0]] = (float(cell[:14]) if cell[:14].strip() else None, cell[14:15])
        satellite, code, (carrier, slip) = line[:3].replace(" ", "0"), cells["C"][0], cells["L"]
        strength = cells.get("S", (None, ""))[0]
        if code is not None and strength is not None:
            self.strengths.setdefault(second, {})[satellite] = strength
        if code is None or carrier is None or satellite not in self.channels and line[0] == "R":
            return
        frequency = 1602e6 + 562500 * self.channels[satellite] if line[0] == "R" else FREQUENCIES.get(line[0], L1)
        wavelength = 299792458.0 / frequency
        self.satellites.setdefault(satellite, {})[second] = (
            code, carrier * wavelength, slip.strip() not in ("", "0") and int(slip) & 1 == 1,
            cells.get("D", (None, ""))[0], strength, wavelength)

    def code_rows(self, elevations):
        """For figures.of_code; a satellite without an elevation is left out."""
        return {name: [(second, row[0], row[1], row[2], row[4], elevations(name, second))
                       for second, row in sorted(rows.items())]
                for name, rows in self.satellites.items() if elevations(name, None) is not None}

    def doppler_rows(self, elevations):
        """For figures.of_doppler."""
        return {name: [(second, row[1], row[2], -row[3] * row[5], elevations(name, second))
                       for second, row in sorted(rows.items()) if row[3] is not None]
                for name, rows in self.satellites.items() if elevations(name, None) is not None}


class Elevations:
    """Elevation of a satellite at a second, from the tracks of `skyloop sky`."""

    STEP_S = 30

    def __init__(self, program, place, start, duration, navigation):
        command = [program, "sky", "--quiet", "--at", ",".join(str(value) for value in place), "--start", start,
                   "--tracks", f"{duration / 3600 + 0.05:.3f}", "--step", str(self.STEP_S), "--format", "csv"]
        for path in navigation:
            command += ["--nav", path]
        out = subprocess.run(command, check=True, capture_output=True, encoding="ascii").stdout
        self.first, self.tracks = gps_from_iso(start), {}
        for line in out.splitlines()[1:]:
            _, name, x, y, z = line.split(",")
            self.tracks.setdefault(name, []).append(geodesy.elevation([float(x), float(y), float(z)], place))

    def __call__(self, name, second):
        track = self.tracks.get(name)
        if track is None or second is None:
            return None if track is None else track[0]
        where = max(0.0, (second - self.first) / self.STEP_S)
        low = min(int(where), len(track) - 2)
        return track[low] + (track[low + 1] - track[low]) * min(where - low, 1)


LEAP_SECONDS = ((2012, 16), (2015.5, 17), (2017, 18))


def gps_from_iso(moment):
    """GPS seconds of an ISO time in UTC."""
    fields = [int(word) for word in re.findall(r"\d+", moment)[:6]]
    leap = 15
    for year, count in LEAP_SECONDS:
        if fields[0] + (fields[1] - 1) / 12 >= year:
            leap = count
    return gps_seconds(*fields) + leap


def solved(path):
    """({second: latitude, longitude, height}, {second: satellites}) of a .pos of rnx2rtkp."""
    places, counts = {}, {}
    for line in text(path).splitlines():
        if line.startswith("%") or not line.strip():
            continue
        words = line.split()
        numbers = [int(word) for word in words[0].split("/")] + [int(word) for word in words[1].split(":")[:2]]
        second = round(gps_seconds(*numbers, float(words[1].split(":")[2])))
        places[second], counts[second] = [float(word) for word in words[2:5]], int(words[6])
    return places, counts


def write_track(path, places):
    """A trajectory of {second: latitude, longitude, height} from its first second on."""
    first = min(places)
    rows = [f"{second - first},{place[0]:.9f},{place[1]:.9f},{place[2]:.3f}" for second, place in sorted(places.items())]
    path.write_text("\n".join(["t_s,lat_deg,lon_deg,h_ell_m", *rows]) + "\n", encoding="ascii")


def solved_by(program, observations, orbits):
    """Rows of latitude, longitude, height by `skyloop solve` with precise orbits, mask 10°."""
    with tempfile.TemporaryDirectory() as scratch:
        out = pathlib.Path(scratch) / "fixes.csv"
        subprocess.run([program, "solve", observations, "--sp3", orbits, "--mask", "10", "--out", out, "--quiet"],
                       check=True, capture_output=True)
        with open(out, encoding="ascii") as file:
            return [[float(row[name]) for name in ("lat_deg", "lon_deg", "height_m")] for row in csv.DictReader(file)
                    if row["lat_deg"]]
