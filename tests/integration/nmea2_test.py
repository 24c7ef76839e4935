"""A second, independent parser (python3-nmea2) reads what a simulation sent and finds the fixes of fixes.csv."""
import csv
import pathlib
import unittest

from session import open_folder, skip, skyloop

try:
    import pynmea2
except ImportError:
    skip("the parser is not installed; apt-get install python3-nmea2")


def simulate(folder, *arguments):
    """Sentences and fixes of a short run."""
    skyloop("simulate", "--out", folder, "--duration", 120, "--start", "2026-03-01T23:59:00Z", *arguments)
    data = pathlib.Path(folder, "port0.out").read_bytes()
    lines = data.decode("ascii").split("\r\n")
    with open(pathlib.Path(folder, "fixes.csv"), newline="", encoding="ascii") as table:
        return lines[:-1], list(csv.DictReader(table))


class Nmea2Test(unittest.TestCase):
    def check(self, board, place, most=12):
        """`most` are the satellites that GGA tells: u-blox keeps to NMEA's 12."""
        with open_folder() as folder:
            lines, fixes = simulate(folder, "--board", board, "--at", place)
        sentences = [pynmea2.parse(line, check=True) for line in lines]
        for line in lines:
            self.assertLessEqual(len(line) + 2, 82, line)
        positions = [s for s in sentences if s.sentence_type == "GGA"]
        self.assertEqual(len(positions), len(fixes))
        for gga, fix in zip(positions, fixes):
            self.assertEqual(gga.timestamp.strftime("%H:%M:%S"), fix["time_utc"][11:19])
            self.assertAlmostEqual(gga.latitude, float(fix["lat_deg"]), delta=1.1e-7)
            self.assertAlmostEqual(gga.longitude, float(fix["lon_deg"]), delta=1.1e-7)
            height = float(gga.altitude) + float(gga.geo_sep)
            self.assertAlmostEqual(height, float(fix["height_m"]), delta=0.11)
            self.assertEqual(int(gga.num_sats), min(most, int(fix["satellites_used"])))
        recommended = [s for s in sentences if s.sentence_type == "RMC"]
        self.assertEqual(len(recommended), len(fixes))
        for rmc, fix in zip(recommended, fixes):
            self.assertEqual(rmc.datestamp.isoformat(), fix["time_utc"][:10])
            self.assertAlmostEqual(float(rmc.spd_over_grnd), float(fix["speed_mps"]) * 3600 / 1852, delta=0.0011)

    def test_m8_in_the_north_east(self):
        self.check("ublox-m8", "46.4775,30.7326,77")

    def test_generic_in_the_south_west(self):
        self.check("nmea-generic", "-33.45,-70.66,520", most=99)

    def test_m10_on_the_date_line(self):
        self.check("ublox-m10", "-16.5,179.9999,10")


if __name__ == "__main__":
    unittest.main(verbosity=2)
