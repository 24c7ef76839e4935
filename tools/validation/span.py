"""The reference of the car in Mountain View: NMEA of an integrated receiver, with the place to a centimetre."""

from . import records

FOLDER = "receivers/mtv_20200207_f9k_car"
START_S = 2 * 3600 + 14 * 60 + 17  # of the day: when the record of the module begins
KNOT = 1852 / 3600


def degrees(word, hemisphere):
    point = word.index(".")
    value = float(word[:point - 2]) + float(word[point - 2:]) / 60
    return -value if hemisphere in "SW" else value


def read(data):
    """({second of the day: latitude, longitude, height}, {second: speed m/s})."""
    places, speeds = {}, {}
    for line in records.text(data / FOLDER / "SPAN.gga.gz").splitlines():
        words = line.split(",")
        if len(words) < 10 or not words[1]:
            continue
        second = round(int(words[1][:2]) * 3600 + int(words[1][2:4]) * 60 + float(words[1][4:]))
        if words[0].endswith("GGA") and words[2]:
            places[second] = [degrees(words[2], words[3]), degrees(words[4], words[5]),
                              float(words[9]) + float(words[11])]
        elif words[0].endswith("RMC") and words[7]:
            speeds[second] = float(words[7]) * KNOT
    return places, speeds


def write_track(data, path):
    """From the first second of the record; a place that is missing is left to the interpolation."""
    records.write_track(path, {second: place for second, place in read(data)[0].items() if second >= START_S})
