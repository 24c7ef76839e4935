"""`skyloop trajectory`, the options of recorded paths in a run, and the way round: track, receiver, log, track."""
import csv
import io
import json
import math
import pathlib
import re
import unittest
import xml.etree.ElementTree

from session import ROOT, open_folder
from session import skyloop as run_to_end

LATITUDE, LONGITUDE, HEIGHT = 47.0, 8.0, 500.0
NORTH_M = 111_176.0  # of a degree at this latitude, on the ellipsoid
EAST_M = 76_178.0
RADIUS, SPEED = 300.0, 20.0


def place(t):
    """A circle with a swell, metres north, east and up of the middle."""
    angle = SPEED * t / RADIUS
    return RADIUS * math.cos(angle), RADIUS * math.sin(angle), 10 * math.sin(t / 9)


def degrees(t):
    north, east, up = place(t)
    return LATITUDE + north / NORTH_M, LONGITUDE + east / EAST_M, HEIGHT + up


def track_text(seconds, step=0.5):
    lines = ["t_s,lat_deg,lon_deg,h_ell_m"]
    for i in range(int(seconds / step) + 1):
        lines.append("%.3f,%.10f,%.10f,%.4f" % (i * step, *degrees(i * step)))
    return "\n".join(lines) + "\n"


def metres(row, t):
    """Between a row of a table and the law, metres north, east and up."""
    latitude, longitude, height = degrees(t)
    return ((float(row["lat_deg"]) - latitude) * NORTH_M, (float(row["lon_deg"]) - longitude) * EAST_M,
            float(row["h_ell_m"]) - height)


def skyloop(*arguments):
    return run_to_end(*arguments, check=False)


def table(text):
    return list(csv.DictReader(io.StringIO(text)))


class TrajectoryTest(unittest.TestCase):
    def setUp(self):
        self.temporary = open_folder()
        self.folder = pathlib.Path(self.temporary.name)
        self.track = self.folder / "circle.csv"
        self.track.write_text(track_text(100))

    def tearDown(self):
        self.temporary.cleanup()

    def listing(self, *arguments):
        done = skyloop("trajectory", *arguments, "--format", "json")
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def refused(self, *arguments, says):
        done = skyloop(*arguments)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertIn(says, done.stderr)

    def test_listing(self):
        found = self.listing(self.track)
        self.assertAlmostEqual(found["duration_s"], 100)
        self.assertAlmostEqual(found["extent"]["north_south_m"], 2 * RADIUS, delta=2)
        self.assertAlmostEqual(found["speed_over_ground_mps"]["value"], SPEED, delta=0.2)
        self.assertAlmostEqual(found["acceleration_mps2"]["value"], SPEED**2 / RADIUS, delta=0.1)
        self.assertAlmostEqual(found["length_m"], 100 * SPEED, delta=10)
        self.assertEqual((found["jumps"]["count"], found["velocity_steps"]["count"]), (0, 0))
        self.assertEqual(found["exceeded"], [])
        text = skyloop("trajectory", self.track).stdout
        self.assertIn("201 rows in 100.000 s", text)
        self.assertIn("kept: receiver", text)

    def test_limits_of_a_vehicle(self):
        exceeded = self.listing(self.track, "--vehicle", "pedestrian")["exceeded"]
        self.assertEqual([(limit["of"], limit["what"]) for limit in exceeded], [("pedestrian", "speed")])
        self.refused("trajectory", self.track, "--vehicle", "plan", says="did you mean")
        told = skyloop("trajectory", "--help").stdout
        for vehicle in ("balloon", "rocket"):
            self.refused("trajectory", self.track, "--vehicle", vehicle, says="expected one of fixed pedestrian car")
            self.assertNotIn(vehicle, told)

    def test_options_of_which_nothing_comes_are_refused(self):
        self.refused("trajectory", self.track, "--speed", "10", says="--speed: ")
        self.refused("trajectory", self.track, "--origin", "46,30,5", says="--origin")
        route = self.folder / "route.csv"
        route.write_text("".join(",".join(line.split(",")[1:]) + "\n" for line in track_text(20).splitlines()))
        self.assertAlmostEqual(self.listing(route, "--speed", "5")["speed_over_ground_mps"]["value"], 5, delta=0.5)
        local = self.folder / "local.csv"
        local.write_text("".join(f"{t}.0 {t} 0 0 0 0 0 1\n" for t in range(20)))
        self.assertEqual(self.listing(local, "--origin", "46,30,5")["duration_s"], 19)

    def test_csv_is_a_track_again(self):
        text = skyloop("trajectory", self.track, "--format", "csv", "--rate", "4", "--vehicle", "plane").stdout
        rows = table(text)
        self.assertEqual(len(rows), 401)
        for row in rows[8:-8]:
            t = float(row["t_s"])
            self.assertLess(math.dist(metres(row, t), (0, 0, 0)), 0.01, t)
            self.assertAlmostEqual(math.hypot(float(row["vn_mps"]), float(row["ve_mps"])), SPEED, delta=0.1)
            # tan φ = v²/(R g); the swell lifts by up to 0.12 m/s².
            self.assertAlmostEqual(float(row["roll_deg"]),
                                   math.degrees(math.atan(SPEED**2 / RADIUS / 9.80665)), delta=0.5)
        again = self.folder / "again.csv"
        again.write_text(text)
        self.assertAlmostEqual(self.listing(again)["length_m"], self.listing(self.track)["length_m"], delta=0.01)

    def test_picture(self):
        picture = skyloop("trajectory", self.track, "--format", "svg").stdout
        root = xml.etree.ElementTree.fromstring(picture)
        self.assertTrue(root.tag.endswith("svg"))
        for word in ("height", "speed", "way", "north"):
            self.assertIn(word, picture)

    def test_scenarios_of_every_kind(self):
        file = self.folder / "way.toml"
        for kind, duration in (('kind = "circle"\ncentre = [47, 8, 500]\nradius_m = 100\nspeed_mps = 10', 62.83),
                               ('kind = "fixed"\nat = [47, 8, 500]', 1),
                               ('kind = "file"\npath = "circle.csv"\nskip_s = 20\ntime_scale = 2', 40)):
            file.write_text(f"[trajectory]\n{kind}\n")
            self.assertAlmostEqual(self.listing(file)["duration_s"], duration, delta=0.01)
        file.write_text('[trajectory]\nkind = "waypoints"\n' + "".join(
            f"[[trajectory.waypoint]]\nat = [{at}, 500]\n" for at in ("47, 8", "47.001, 8", "47.001, 8.001")))
        found = self.listing(file, "--vehicle", "car")
        self.assertEqual(found["velocity_steps"]["count"], 1, "a corner")
        self.assertAlmostEqual(found["velocity_steps"]["largest_mps"]["value"], 10 * math.sqrt(2), delta=0.1)

    def test_pages_of_live_sources_name_keys_that_there_are(self):
        keys = set(re.findall(r"^\| `([a-z_]+)` \|", (ROOT / "docs/scenario_keys.md").read_text(encoding="utf-8"), re.M))
        for page in ("docs/feeds.md", "docs/feed_sources.md"):
            text = (ROOT / page).read_text(encoding="utf-8")
            named = re.findall(r"`([a-z_]+) = |scenario's `([a-z_]+)`", text)
            self.assertTrue(named)
            for words in named:
                self.assertIn("".join(words), keys, page)

    def test_bad_files(self):
        for name, content in (("empty.csv", b""), ("noise.csv", bytes(range(256)) * 40),
                              ("cut.csv", track_text(10).encode()[:-300] + b"\n1,2"), ("words.csv", b"t_s,lat_deg\nx,y\n")):
            file = self.folder / name
            file.write_bytes(content)
            done = skyloop("trajectory", file)
            self.assertIn(done.returncode, (0, 2, 3), done.stderr)
            if done.returncode:
                self.assertIn(name, done.stderr)
        self.assertNotEqual(skyloop("trajectory", self.folder / "absent.gpx").returncode, 0)
        self.refused("trajectory", self.track, "--rate", "5", says="--rate is for")
        self.refused("trajectory", self.track, "--format", "csv", "--rate", "10000", "--duration", "1e6",
                     says="ten million")

    def simulate(self, name, scenario, *arguments):
        file = self.folder / (name + ".toml")
        file.write_text('[run]\nstart = 2024-03-05T12:00:00Z\n[model]\nname = "ideal"\n' + scenario)
        out = self.folder / name
        done = skyloop("simulate", file, "--out", out, *arguments)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        with open(out / "fixes.csv", newline="") as fixes:
            return out, list(csv.DictReader(fixes)), done

    def test_options_of_a_run(self):
        way = '[trajectory]\nkind = "file"\npath = "circle.csv"\n'
        truth = lambda row: {"lat_deg": row["true_lat_deg"], "lon_deg": row["true_lon_deg"],
                             "h_ell_m": row["true_height_m"]}
        _, rows, _ = self.simulate("stop", way + 'end = "stop"\nskip_s = 70\ntime_scale = 2\nstart_delay_s = 3\n')
        self.assertEqual(len(rows), 18, "3 s and 30 s at double speed")
        for second, row in enumerate(rows):
            t = 70 + 2 * max(0, second - 3)
            self.assertLess(math.dist(metres(truth(row), t), (0, 0, 0)), 0.05, second)
        _, rows, done = self.simulate("loop", way, "--loop", "--skip", "90", "--duration", "15")
        self.assertIn("each round begins with a jump", done.stdout + done.stderr)
        self.assertLess(math.dist(metres(truth(rows[13]), 3), (0, 0, 0)), 0.05)
        self.refused("simulate", "--at", "47,8", "--loop", "--duration", "5", "--out", self.folder / "x",
                     says="--loop: expected --trajectory")
        self.refused("simulate", "--trajectory", self.track, "--skip", "500", "--duration", "5", "--out",
                     self.folder / "x", says="the track lasts 100 s")

    def test_gap_becomes_an_outage(self):
        kept = [line for line in track_text(60).splitlines() if not line[0].isdigit() or not 20 < float(line.split(",")[0]) < 40]
        (self.folder / "gap.csv").write_text("\n".join(kept) + "\n")
        way = '[trajectory]\nkind = "file"\npath = "gap.csv"\nend = "stop"\n'
        _, rows, _ = self.simulate("outage", way + 'gap = "outage"\n')
        silent = [second for second, row in enumerate(rows) if row["fix_type"] == "none"]
        self.assertTrue(silent and min(silent) >= 20 and max(silent) >= 38, silent)
        _, rows, _ = self.simulate("compress", way + 'gap = "compress"\n')
        self.assertLess(len(rows), 60)

    def test_check_tells_what_was_found(self):
        text = skyloop("check", "--trajectory", self.track, "--duration", "10").stdout
        for found in ("201 rows in 100.000 s", "steps of 0.5 s", "velocity: by the places", "attitude: upright"):
            self.assertIn(found, text)

    def test_a_file_of_a_trajectory_warns_as_a_scenario_does(self):
        way = '[frame]\norigin = [47, 8, 500]\n[trajectory]\nkind = "fixed"\nat_level = [10000, 0, 0]\n'
        file = self.folder / "far.toml"
        file.write_text(way)
        for arguments in (("--trajectory", file), (file,)):
            done = skyloop("check", *arguments)
            self.assertIn("anchor the frame nearer", done.stdout + done.stderr, arguments)

    def test_there_and_back(self):
        """Track, ideal receiver, bytes, log, track: each format within the steps of its numbers."""
        way = '[trajectory]\nkind = "file"\npath = "circle.csv"\nend = "stop"\n[[receiver]]\nboard = "ublox-m10"\n'
        # UBX-NAV-PVT: 1e-7 degrees, 1 mm. NMEA: 1e-5 minutes, 0.1 m, and as much of the undulation.
        for name, port, level, upright in (("ubx", ["--port", "client:careful-ubx"], 0.02, 0.01), ("nmea", [], 0.03, 0.15)):
            out, rows, _ = self.simulate(name, way + "rate_hz = 5\nbaud = 115200\n", *port)
            made = self.folder / (name + "-made")
            done = skyloop("scenario-from", out / "port0.out", "--out", made)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertIn(name.upper() + ",", done.stdout)
            with open(made / "track.csv", newline="") as file:
                heard = list(csv.DictReader(file))
            self.assertGreater(len(heard), 0.9 * len(rows))
            begins = float(heard[0]["tow_s"]) - 216018
            back = table(skyloop("trajectory", made / "scenario.toml", "--format", "csv", "--rate", "20").stdout)
            self.assertGreater(len(back), 1800)
            for row in back[40:-40]:
                north, east, up = metres(row, begins + float(row["t_s"]))
                self.assertLess(math.hypot(north, east), level, (name, row))
                self.assertLess(abs(up), upright, (name, row))


if __name__ == "__main__":
    unittest.main()
