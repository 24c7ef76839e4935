"""gpsd from Debian reads our pty: a 3D fix at the right place and time, and the satellites of `skyloop sky`."""
import datetime
import json
import math
import os
import shutil
import unittest

from gpsd_process import Gpsd
from session import SHARED, Emulator, open_folder, skip, skyloop

PLACE = (46.4775, 30.7326, 77.0)
START = "2010-07-01T12:00:00Z"


def unrolled(text):
    """gpsd takes dates before its own release for a week rollover and adds 1024 weeks; this takes them off again."""
    time_utc = datetime.datetime.strptime(text, "%Y-%m-%dT%H:%M:%S.%fZ")
    if time_utc > datetime.datetime(2028, 1, 1):
        time_utc -= datetime.timedelta(weeks=1024)
    return time_utc.strftime("%Y-%m-%dT%H:%M:%S.%f")[:-3] + "Z"


def metres_apart(latitude, longitude):
    """Horizontal distance from PLACE."""
    north = (latitude - PLACE[0]) * 111_200
    east = (longitude - PLACE[1]) * 111_200 * math.cos(math.radians(PLACE[0]))
    return math.hypot(north, east)


class GpsdTest(unittest.TestCase):
    def read_fix_and_sky(self, *arguments, model="baseline"):
        """The first 3D TPV and a SKY with satellites that follows it."""
        with open_folder() as folder, Emulator(*arguments, "--at", ",".join(map(str, PLACE)), "--model", model,
                                               "--port", f"pty:{folder}/gps0", "--quiet") as emulator:
            gpsd = Gpsd(emulator.tty, "-b")
            fix = sky = None
            try:
                for report in gpsd.reports(60):
                    if report["class"] == "TPV" and report.get("mode") == 3:
                        fix = report
                    if fix and report["class"] == "SKY" and report.get("satellites"):
                        sky = report
                        break
            finally:
                log = gpsd.stop()
            self.assertEqual(emulator.stop(), 0, emulator.log)
            self.assertIsNotNone(fix, f"no 3D fix; gpsd said: {log}")
            self.assertIsNotNone(sky, f"no satellites; gpsd said: {log}")
            return fix, sky

    def assert_same_satellites(self, sky, time_utc, *navigation):
        """SKY lists the satellites that `skyloop sky` has at that time, with their directions."""
        listing = json.loads(skyloop("sky", *navigation, "--at", ",".join(map(str, PLACE)), "--start", time_utc, "--model",
                                     "baseline", "--format", "json").stdout)
        ours = {int(s["satellite"][1:]): s for s in listing["satellites"] if s["satellite"][0] == "G"}
        theirs = {s["PRN"]: s for s in sky["satellites"]}
        self.assertEqual(sorted(theirs), sorted(ours))
        for prn, satellite in theirs.items():
            self.assertAlmostEqual(satellite["el"], ours[prn]["elevation_deg"], delta=1)
            turn = abs((satellite["az"] - ours[prn]["azimuth_deg"] + 180) % 360 - 180)
            self.assertLess(turn, 1.01)
            self.assertAlmostEqual(satellite["ss"], ours[prn]["cn0_dbhz"], delta=1)
            self.assertEqual(bool(satellite["used"]), bool(ours[prn]["used"]), f"G{prn:02}")

    def test_real_navigation_data(self):
        navigation = SHARED / "nav/brdc1820.10n"
        if not navigation.exists():
            self.skipTest(f"shared data absent: {navigation}")
        fix, sky = self.read_fix_and_sky("--nav", navigation, "--start", START)
        time_utc = unrolled(fix["time"])
        self.assertTrue(time_utc.startswith("2010-07-01T12:0"), fix["time"])
        self.assertLess(metres_apart(fix["lat"], fix["lon"]), 60)
        self.assertAlmostEqual(fix.get("altHAE", PLACE[2]), PLACE[2], delta=60)
        self.assert_same_satellites(sky, time_utc, "--nav", navigation)

    def test_embedded_constellation(self):
        fix, sky = self.read_fix_and_sky("--start", "2026-03-01T00:00:00Z")
        self.assertLess(metres_apart(fix["lat"], fix["lon"]), 60)
        self.assert_same_satellites(sky, fix["time"])

    def test_a_receiver_that_measures(self):
        fix, sky = self.read_fix_and_sky("--start", "2026-03-01T00:00:00Z", model="modern")
        self.assertLess(metres_apart(fix["lat"], fix["lon"]), 25)
        self.assertAlmostEqual(fix.get("altHAE", PLACE[2]), PLACE[2], delta=40)
        used = [s for s in sky["satellites"] if s["used"]]
        self.assertGreaterEqual(len(used), 5)
        for satellite in used:
            self.assertGreater(satellite["ss"], 20)
            self.assertLess(satellite["ss"], 60)
            self.assertGreaterEqual(satellite["el"], 4)


if __name__ == "__main__":
    if not shutil.which("gpsd"):
        skip("gpsd is not installed; apt-get install gpsd")
    os.environ["PYTHONUNBUFFERED"] = "1"
    unittest.main(verbosity=2)
