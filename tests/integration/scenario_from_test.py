"""A recording turned into a scenario again: the outage is at the same epochs, the track is the same."""
import csv
import os
import pathlib
import unittest

from session import open_folder
from session import skyloop as run_to_end

SCENARIO = """[run]
start = 2024-03-05T12:00:00Z
duration_s = 120
seed = 5
[trajectory]
kind = "circle"
centre = [47.0, 8.0, 500]
radius_m = 200
speed_mps = 15
[model]
errors = "none"
[[receiver]]
board = "ublox-m10"
[[fault]]
kind = "outage"
at_s = 30
for_s = 10
[[fault]]
kind = "cn0_drop"
attenuation_db = 12
at_s = 80
for_s = 15
"""
METRES_PER_DEGREE = 111_200


def skyloop(*arguments):
    return run_to_end(*arguments, check=False)


def rows(folder):
    with open(folder / "fixes.csv", newline="") as file:
        return list(csv.DictReader(file))


class ScenarioFromTest(unittest.TestCase):
    def setUp(self):
        self.temporary = open_folder()
        self.folder = pathlib.Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def simulate(self, scenario, name):
        out = self.folder / name
        done = skyloop("simulate", scenario, "--out", out)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return out

    def test_round_trip(self):
        scenario = self.folder / "first.toml"
        scenario.write_text(SCENARIO)
        first = self.simulate(scenario, "first")
        made = self.folder / "made"
        done = skyloop("scenario-from", first / "port0.out", "--out", made)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("1 outages, 10 s together", done.stdout)
        self.assertIn("1 C/N0 drops, 15 s together", done.stdout)
        text = (made / "scenario.toml").read_text()
        self.assertIn('start = "2024-03-05T12:00:00.000000000Z"\nduration_s = 120\n', text)
        self.assertIn('kind = "outage"\nat_s = 30\nfor_s = 10\n', text)
        self.assertIn('kind = "cn0_drop"\nattenuation_db = 12\nat_s = 80\nfor_s = 15\n', text)
        checked = skyloop("check", made / "scenario.toml")
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
        self.assertRegex(checked.stdout, r"trajectory  \S+track.csv, \d+ rows in 119.000 s")
        # The faults are the same, the sky and the board too: only the model's errors are not taken over.
        text = text.replace("[trajectory]", '[model]\nerrors = "none"\n[trajectory]')
        text = text.replace('board = "nmea-generic"', 'board = "ublox-m10"')
        (made / "same.toml").write_text(text)
        second = self.simulate(made / "same.toml", "second")
        before, after = rows(first), rows(second)
        self.assertEqual([(r["time_utc"], r["fix_type"]) for r in before], [(r["time_utc"], r["fix_type"]) for r in after])
        worst = 0
        for a, b in zip(before, after):
            if a["fix_type"] in ("none", "dead_reckoning"):
                continue
            north = (float(a["true_lat_deg"]) - float(b["true_lat_deg"])) * METRES_PER_DEGREE
            east = (float(a["true_lon_deg"]) - float(b["true_lon_deg"])) * METRES_PER_DEGREE * 0.68
            worst = max(worst, abs(north), abs(east))
        self.assertLess(worst, 0.05)  # 1e-5 minutes are 1.9 cm

    def test_what_others_wrote_is_left(self):
        scenario = self.folder / "first.toml"
        scenario.write_text(SCENARIO)
        log = self.simulate(scenario, "first") / "port0.out"
        for name in ("scenario.toml", "track.csv"):
            out = self.folder / name.split(".")[0]
            out.mkdir()
            (out / name).write_text("mine\n")
            done = skyloop("scenario-from", log, "--out", out)
            self.assertEqual((done.returncode, done.stderr), (
                2, f"skyloop: {out / name}: is there already, and not by scenario-from; expected --out with another folder\n"))
            self.assertEqual([(path.name, path.read_text()) for path in out.iterdir()], [(name, "mine\n")])
        for _ in range(2):  # its own files are made anew
            self.assertEqual(skyloop("scenario-from", log, "--out", self.folder / "made").returncode, 0)

    def test_what_is_no_log_is_refused_in_one_line(self):
        cases = {"empty": (b"", "is empty"), "text": (b"hello\n", "expected a UBX, NMEA, SBF, ULog or DataFlash log"),
                 "ulog": (b"ULog\x01\x12\x35", "header of 7 bytes"),
                 "zeros": (bytes(1 << 20), "0 UBX messages and 0 NMEA sentences")}
        for name, (content, expected) in cases.items():
            with self.subTest(name):
                (self.folder / name).write_bytes(content)
                done = skyloop("scenario-from", self.folder / name, "--out", self.folder / "out")
                self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                errors = [line for line in done.stderr.splitlines() if "warning" not in line]
                self.assertEqual(len(errors), 1, done.stderr)
                self.assertIn(expected, errors[0])
        done = skyloop("scenario-from", self.folder / "absent", "--out", self.folder / "out")
        self.assertEqual(done.returncode, 1, done.stderr)

    def test_track_on_the_command_line(self):
        track = self.folder / "track.csv"
        track.write_text("t_s,lat_deg,lon_deg,h_ell_m\n0,47,8,500\n1,47.0001,8,500\n2,47.0002,8,500\n20,47.002,8,500\n")
        done = skyloop("simulate", "--trajectory", track, "--start", "2024-03-05T12:00:00Z", "--duration", "30",
                       "--out", self.folder / "run")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("no row between 2.000 s and 20.000 s of the track", done.stderr)
        truth = [float(row["true_lat_deg"]) for row in rows(self.folder / "run")]
        self.assertAlmostEqual(truth[2], 47.0002, places=8)
        self.assertAlmostEqual(truth[25], 47.002, places=8)
        track.write_text("t_s,lat_deg,lon_deg,h_ell_m\n0,47,8,500\n1,47.0001,eight,500\n")
        done = skyloop("check", "--trajectory", track)
        self.assertEqual(done.returncode, 2)
        self.assertIn("track.csv:3: lon_deg is 'eight'", done.stderr)

    def test_real_logs(self):
        data = pathlib.Path(os.environ.get("SKYLOOP_SHARED_DATA", ""))
        logs = [data / "receivers/besancon_20250425_ublox/16dBatt_no_interference_coldstart.ubx.gz",
                data / "receivers/indoor_neo6m_20240726/gps_data_20240726_122435.log.gz",
                data / "receivers/bend_f9t/F9T-L2-5min.ubx.gz"]
        logs = [log for log in logs if log.exists()]
        if not logs:
            self.skipTest("no real logs")
        for log in logs:
            with self.subTest(log.name):
                made = self.folder / log.stem
                done = skyloop("scenario-from", log, "--out", made)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                done = skyloop("check", made / "scenario.toml")
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
