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

    def test_a_track_without_times_keeps_none(self):
        with open_folder() as folder:
            scenario = self.scenario(folder, "walk.gpx")
            track = pathlib.Path(folder, "walk.gpx")
            track.write_text('<gpx><trk><trkseg><trkpt lat="1" lon="2"/></trkseg></trk></gpx>', encoding="ascii")
            done = skyloop("check", scenario, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn('walk.gpx: no times in it, and trajectory.time = "recorded" asks for times', done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1)

    def fly(self, name, content, keys=""):
        """The fixes of a run along a file without times, and what is said of it."""
        with open_folder() as folder:
            pathlib.Path(folder, name).write_text(content, encoding="ascii")
            scenario = pathlib.Path(folder, "scenario.toml")
            scenario.write_text('[run]\nstart = 2024-03-05T12:00:00Z\nduration_s = 40\n[model]\nname = "ideal"\n'
                                f'[trajectory]\nkind = "file"\npath = "{name}"\n{keys}\n', encoding="utf-8")
            done = skyloop("simulate", scenario, "--out", pathlib.Path(folder, "out"))
            self.assertEqual(done.returncode, 0, done.stderr)
            with open(pathlib.Path(folder, "out", "fixes.csv"), encoding="ascii") as file:
                return list(csv.DictReader(file)), done.stdout + done.stderr

    def test_a_route_is_flown_at_its_speed(self):
        places = "".join(f"{LATITUDE + i * 1e-5:.7f},{LONGITUDE},{HEIGHT_M}\n" for i in range(20))
        rows, said = self.fly("way.csv", "lat_deg,lon_deg,h_ell_m\n" + places, 'vehicle = "rover"\nspeed_mps = 0.5\n')
        self.assertIn("flown as a route of 20 points at 0.5 m/s, as a rover", said)
        metres = (float(rows[30]["true_lat_deg"]) - float(rows[10]["true_lat_deg"])) * 111_180
        self.assertAlmostEqual(metres, 20 * 0.5, delta=0.05)

    def test_plans_are_flown(self):
        item = '{{"type": "SimpleItem", "command": {}, "frame": 3, "params": [0, 0, 0, null, {}, {}, {}]}}'
        items = ",".join((item.format(22, LATITUDE, LONGITUDE, 20), item.format(16, LATITUDE + 1e-3, LONGITUDE, 20)))
        plan = ('{"fileType": "Plan", "mission": {"vehicleType": 2, "hoverSpeed": 4, "cruiseSpeed": 15, '
                f'"plannedHomePosition": [{LATITUDE}, {LONGITUDE}, 0], "items": [{items}]}}}}')
        mission = (f"QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t{LATITUDE}\t{LONGITUDE}\t0\t1\n"
                   f"1\t0\t3\t22\t0\t0\t0\t0\t0\t0\t20\t1\n"
                   f"2\t0\t3\t16\t0\t0\t0\t0\t{LATITUDE + 1e-3}\t{LONGITUDE}\t20\t1\n")
        for name, content, keys in (("a.plan", plan, ""), ("a.waypoints", mission, "speed_mps = 4")):
            with self.subTest(name=name):
                rows, said = self.fly(name, content, keys)
                self.assertIn("at 4 m/s, as a multirotor", said)
                heights = [float(row["true_height_m"]) for row in rows]
                self.assertAlmostEqual(max(heights) - heights[0], 20, delta=0.01)
                self.assertGreater(float(rows[-1]["true_lat_deg"]), LATITUDE + 5e-4)


if __name__ == "__main__":
    unittest.main()
