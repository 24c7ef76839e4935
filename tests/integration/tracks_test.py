"""A walk written by Python in every common format of tracks is a trajectory: checked, told, and flown."""
import csv
import math
import pathlib
import unittest
import zipfile

from session import open_folder, skyloop

ROWS = 30
LATITUDE, LONGITUDE, HEIGHT_M = 47.5, 8.25, 500.0  # above sea level
STEP_DEG = 2e-5  # eastwards in a second: 1.5 m


def longitude(row):
    return LONGITUDE + row * STEP_DEG


def clock(row):
    return f"12:00:{row:02}"


def gpx():
    points = "".join(f'<trkpt lat="{LATITUDE}" lon="{longitude(i):.7f}"><ele>{HEIGHT_M}</ele>'
                     f"<time>2024-03-05T{clock(i)}Z</time></trkpt>" for i in range(ROWS))
    return f'<gpx version="1.1"><trk><trkseg>{points}</trkseg></trk></gpx>'


def kml():
    pairs = "".join(f"<when>2024-03-05T{clock(i)}Z</when><gx:coord>{longitude(i):.7f} {LATITUDE} {HEIGHT_M}</gx:coord>"
                    for i in range(ROWS))
    return (f'<kml xmlns:gx="http://www.google.com/kml/ext/2.2"><Placemark><gx:Track><altitudeMode>absolute</altitudeMode>{pairs}'
            "</gx:Track></Placemark></kml>")


def minutes(degrees, width):
    return f"{int(degrees):0{width}}{(degrees % 1) * 60:08.5f}"


def igc():
    fixes = []
    for i in range(ROWS):
        east = minutes(longitude(i), 3).replace(".", "")
        fixes.append(f"B1200{i:02}4730000N{east[:8]}EA{HEIGHT_M:05.0f}{HEIGHT_M:05.0f}{east[8:]}\r\n")
    return "AXXX\r\nHFDTE050324\r\nHFALGALTGPS:GEO\r\nI013637LOD\r\n" + "".join(fixes)


def sentence(body):
    total = 0
    for letter in body:
        total ^= ord(letter)
    return f"${body}*{total:02X}\r\n"


def nmea():
    lines = []
    for i in range(ROWS):
        place = f"4730.00000,N,{minutes(longitude(i), 3)},E"
        lines.append(sentence(f"GPRMC,1200{i:02}.00,A,{place},2.93,90.0,050324,,"))
        lines.append(sentence(f"GPGGA,1200{i:02}.00,{place},1,09,0.9,{HEIGHT_M},M,,M,,"))
    return "".join(lines)


def unicsv():
    return "No,Latitude,Longitude,Altitude,Date,Time\n" + "".join(
        f"{i},{LATITUDE},{longitude(i):.7f},{HEIGHT_M},2024/03/05,{clock(i)}\n" for i in range(ROWS))


def write_kmz(path):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("doc.kml", kml())


class Tracks(unittest.TestCase):
    FORMATS = {"walk.gpx": gpx, "walk.kml": kml, "walk.igc": igc, "walk.nmea": nmea, "walk.csv": unicsv, "walk.kmz": None}

    def scenario(self, folder, name):
        path = pathlib.Path(folder, name)
        if self.FORMATS[name]:
            path.write_bytes(self.FORMATS[name]().encode())
        else:
            write_kmz(path)
        scenario = pathlib.Path(folder, "scenario.toml")
        scenario.write_text('[run]\nstart = 2024-03-05T12:00:00Z\nduration_s = 20\n'
                            f'[trajectory]\nkind = "file"\npath = "{name}"\ntime = "recorded"\n', encoding="utf-8")
        return scenario

    def test_every_format_is_checked_and_told(self):
        for name in self.FORMATS:
            with self.subTest(name=name), open_folder() as folder:
                done = skyloop("check", self.scenario(folder, name))
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn(f"{ROWS} rows in 29.000 s", done.stdout + done.stderr)

    def test_every_format_is_flown_where_it_went(self):
        heights = []
        for name in self.FORMATS:
            with self.subTest(name=name), open_folder() as folder:
                out = pathlib.Path(folder, "out")
                done = skyloop("simulate", self.scenario(folder, name), "--out", out)
                self.assertEqual(done.returncode, 0, done.stderr)
                with open(out / "fixes.csv", encoding="ascii") as file:
                    rows = list(csv.DictReader(file))
                row = next(row for row in rows if row["time_utc"].startswith("2024-03-05T12:00:10.000"))
                self.assertAlmostEqual(float(row["true_lat_deg"]), LATITUDE, delta=2e-7)
                self.assertAlmostEqual(float(row["true_lon_deg"]), longitude(10), delta=3e-7)
                heights.append(float(row["true_height_m"]))
        self.assertEqual(len(heights), len(self.FORMATS))
        self.assertTrue(all(math.isclose(h, heights[0], abs_tol=0.01) for h in heights), heights)

    def test_a_track_without_times_is_refused_in_one_line(self):
        with open_folder() as folder:
            scenario = self.scenario(folder, "walk.gpx")
            track = pathlib.Path(folder, "walk.gpx")
            track.write_text('<gpx><trk><trkseg><trkpt lat="1" lon="2"/></trkseg></trk></gpx>', encoding="ascii")
            done = skyloop("check", scenario, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn("walk.gpx: 1 track points and no time in them", done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1)


if __name__ == "__main__":
    unittest.main()
