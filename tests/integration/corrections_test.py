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


def station(name, latitude, told_latitude, config=""):
    """A base with its place, and the latitude that it sends."""
    return f"""[[receiver]]
name = "{name}"
board = "ublox-f9p"
baud = 460800
[receiver.config]
CFG-TMODE-MODE = 2
CFG-TMODE-POS_TYPE = 1
CFG-TMODE-LAT = {round(told_latitude * 1e7)}
CFG-TMODE-LON = {round(BASE[1] * 1e7)}
CFG-TMODE-HEIGHT = {round(HEIGHT * 100)}
CFG-UART1OUTPROT-NMEA = false
CFG-UART1OUTPROT-RTCM3X = true
{config}
{MESSAGES}
[receiver.trajectory]
kind = "fixed"
at = [{latitude}, {BASE[1]}, {HEIGHT}]
"""


def scenario(*, told_north_m=0.0, seconds=150, faults=""):
    """A base that sends a latitude so far north of its place, and a rover a kilometre east of that; GPS alone."""
    north, east = metres_per_degree()
    return f"""[run]
start = 2026-03-01T00:00:00Z
duration_s = {seconds}
seed = 4
[sky]
constellations = ["gps"]
{station("base", BASE[0], BASE[0] + told_north_m / north)}
[[receiver]]
name = "rover"
board = "ublox-f9p"
baud = 460800
corrections_from = "base"
[receiver.trajectory]
kind = "fixed"
at = [{BASE[0]}, {BASE[1] + EAST_M / east}, 90.0]
{faults}
"""


def fault(kind, receiver="rover", more="", for_s=60):
    """One that begins after a minute."""
    return f'[[fault]]\nkind = "{kind}"\nreceiver = "{receiver}"\nat_s = 60\nfor_s = {for_s}\n{more}\n'


# A second base, of another number, 36 km north.
FAR_BASE = station("far", 46.8, 46.8, "CFG-RTCM-DF003_OUT = 9")


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

    def test_a_base_that_jumps_takes_its_rover_along(self):
        """Nobody tells it, and nothing in the data contradicts it: fixed, and 10 m off the other way."""
        rows = self.rover(seconds=120, faults=fault("antenna_moved", "base", "east_m = 10.0", for_s=30))
        for second, east_m in ((59, 0), (62, -10), (85, -10), (95, 0)):
            self.assertEqual(rows[second]["fix_type"], "rtk_fixed", second)
            self.assertAlmostEqual(float(rows[second]["east_error_m"]), east_m, delta=0.05, msg=second)
            self.assertLess(float(rows[second]["h_acc_m"]), 0.05)

    def test_a_place_in_a_national_frame_is_off_by_what_lies_between(self):
        """ETRF2000 of Europe's plate against ITRF2014, 2026: 0.6 m north, 0.9 m east less."""
        rows = self.rover(seconds=90, faults=fault("base_in_other_frame"))
        self.assertEqual(rows[80]["fix_type"], "rtk_fixed")
        self.assertAlmostEqual(float(rows[80]["east_error_m"]), -0.88, delta=0.05)
        self.assertAlmostEqual(float(rows[80]["north_error_m"]), -0.57, delta=0.05)

    def test_a_wrong_mount_point_of_another_station_counts_after_ten_seconds(self):
        far = FAR_BASE + fault("wrong_mount_point", "rover", 'of_receiver = "far"', for_s=60)
        rows = self.rover(seconds=150, faults=far)
        kinds = [row["fix_type"] for row in rows]
        self.assertEqual(set(kinds[50:70]), {"rtk_fixed"})
        self.assertTrue(all(kind != "rtk_fixed" for kind in kinds[73:120]), kinds[73:120])
        self.assertEqual(kinds[149], "rtk_fixed")
        for row in rows[73:]:
            self.assertLess(math.hypot(float(row["east_error_m"]), float(row["north_error_m"])),
                            4 * float(row["h_acc_m"]) + 0.05, row["time_utc"])

    def test_one_of_the_same_number_is_found_out(self):
        far = FAR_BASE.replace("CFG-RTCM-DF003_OUT = 9\n", "")
        rows = self.rover(seconds=90, faults=far + fault("wrong_mount_point", "rover", 'of_receiver = "far"'))
        for row in rows[61:]:
            self.assertLess(math.hypot(float(row["east_error_m"]), float(row["north_error_m"])),
                            4 * float(row["h_acc_m"]) + 0.05, row["time_utc"])

    def test_bit_errors_make_holes_and_no_wrong_places(self):
        rows = self.rover(seconds=120, faults=fault("bit_flips", "rover",
                                                    'direction = "to_receiver"\nprobability = 0.0005'))
        for row in rows[30:]:
            self.assertEqual(row["fix_type"], "rtk_fixed")
            self.assertLess(math.hypot(float(row["east_error_m"]), float(row["north_error_m"])), 0.05)
        self.assertGreater(max(float(row["h_acc_m"]) for row in rows[61:]),
                           max(float(row["h_acc_m"]) for row in rows[30:60]))


if __name__ == "__main__":
    unittest.main(verbosity=2)
