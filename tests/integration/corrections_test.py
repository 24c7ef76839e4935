"""A base and its rovers in one run: RTK is solved from what the base measures and says of itself."""
import csv
import math
import pathlib
import unittest

from session import open_folder, skyloop

BASE, HEIGHT = (46.4775, 30.7326), 77.0
EAST_M = 1000.0  # of the rover, from the base

MESSAGES = "\n".join(f"CFG-MSGOUT-RTCM_3X_TYPE{number}_UART1 = 1" for number in ("1005", "1077", "1230"))


def metres_per_degree():
    """Of latitude and of longitude at the base, WGS 84."""
    sine, squared = math.sin(math.radians(BASE[0])), 6.69437999014e-3
    normal = 6378137.0 / math.sqrt(1 - squared * sine * sine)
    meridian = normal * (1 - squared) / (1 - squared * sine * sine)
    return math.radians(meridian), math.radians(normal) * math.sqrt(1 - sine * sine)


def scenario(*, told_north_m=0.0, seconds=150, faults=""):
    """A base that says it stands so far north of its place, and a rover a kilometre east of that; GPS alone."""
    north, east = metres_per_degree()
    latitude, longitude = BASE[0] + told_north_m / north, BASE[1] + EAST_M / east
    return f"""[run]
start = 2026-03-01T00:00:00Z
duration_s = {seconds}
seed = 4
[trajectory]
kind = "fixed"
at = [{BASE[0]}, {BASE[1]}, {HEIGHT}]
[[receiver]]
name = "base"
board = "ublox-f9p"
baud = 460800
[receiver.config]
CFG-TMODE-MODE = 2
CFG-TMODE-POS_TYPE = 1
CFG-TMODE-LAT = {round(latitude * 1e7)}
CFG-TMODE-LON = {round(BASE[1] * 1e7)}
CFG-TMODE-HEIGHT = {round(HEIGHT * 100)}
CFG-UART1OUTPROT-NMEA = false
CFG-UART1OUTPROT-RTCM3X = true
{MESSAGES}
[[receiver]]
name = "rover"
board = "ublox-f9p"
baud = 460800
corrections_from = "base"
[receiver.trajectory]
kind = "fixed"
at = [{BASE[0]}, {longitude}, 90.0]
{faults}
"""


class CorrectionsTest(unittest.TestCase):
    def setUp(self):
        folder = open_folder()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def rover(self, **settings):
        """Rows of the rover's fixes."""
        path, out = self.folder / "scenario.toml", self.folder / "out"
        path.write_text(scenario(**settings), encoding="utf-8")
        skyloop("simulate", path, "--out", out)
        with open(out / "receiver1" / "fixes.csv", encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def test_the_rover_is_fixed_to_centimetres(self):
        rows = self.rover()
        self.assertEqual(rows[0]["fix_type"], "3d")
        self.assertEqual(rows[2]["fix_type"], "rtk_float")
        fixed = [row for row in rows if row["fix_type"] == "rtk_fixed"]
        self.assertGreater(len(fixed), 30)
        for row in fixed:
            self.assertLess(math.hypot(float(row["east_error_m"]), float(row["north_error_m"])), 0.05, row["time_utc"])
            self.assertLess(float(row["h_acc_m"]), 0.05)

    def test_it_stands_where_the_base_is_told_to_stand(self):
        last = self.rover(told_north_m=111.0)[-1]
        self.assertEqual(last["fix_type"], "rtk_fixed")
        self.assertAlmostEqual(float(last["north_error_m"]), 111.0, delta=0.05)
        self.assertLess(abs(float(last["east_error_m"])), 0.05)

    def test_without_corrections_it_grows_old_step_by_step(self):
        silent = '[[fault]]\nkind = "receiver_silent"\nreceiver = "base"\nat_s = 60\n'
        rows = self.rover(seconds=140, faults=silent)
        kinds = [row["fix_type"] for row in rows]
        self.assertEqual(kinds[60], "rtk_fixed")
        order = ["rtk_fixed", "rtk_float", "dgnss", "3d"]
        after = [order.index(kind) for kind in kinds[60:]]
        self.assertEqual(after, sorted(after), kinds[60:])
        # The limits of the board (boards/README.md, corrections) and of CFG-NAVSPG-CONSTR_DGNSSTO, 60 s.
        for kind, age in (("rtk_fixed", 15), ("rtk_float", 30), ("dgnss", 60)):
            self.assertAlmostEqual(max(i for i, one in enumerate(kinds) if one == kind) - 60, age, delta=2, msg=kind)
        accuracies = [float(row["h_acc_m"]) for row in rows[60:74]]
        self.assertEqual(accuracies, sorted(accuracies))


if __name__ == "__main__":
    unittest.main(verbosity=2)
