"""Where a run with a navigation file and without a start begins: it has a fix within a minute, or a line says why not."""
import csv
import pathlib
import re
import unittest

from fetch_nav_test import DAY, navigation
from session import SHARED, open_folder, skyloop

# What a run of a minute says of a file that serves nobody at the place of the run.
REASONS = (r"no fix is to be expected: too few satellites of [a-z, ]+ (have orbits|with orbits stand above \d+ degrees at \S+ \S+) at any time of",
           r"^skyloop: --nav: \S+?:\d+(:\d+)?: found .*; ")


def ionosphere_maps(day, hours):
    """An IONEX file with a map of the globe at each of the hours."""
    def headed(text, label):
        return f"{text:60}{label}\n"

    text = (headed("     1.0            IONOSPHERE MAPS     GPS", "IONEX VERSION / TYPE") + headed("    60.0 -60.0 -60.0", "LAT1 / LAT2 / DLAT")
            + headed("  -180.0 180.0  60.0", "LON1 / LON2 / DLON") + headed("", "END OF HEADER"))
    for hour in hours:
        text += headed("     1", "START OF TEC MAP") + headed(f"{day:  %Y    %m    %d}{hour:6}     0     0", "EPOCH OF CURRENT MAP")
        for latitude in (60, 0, -60):
            text += headed(f"  {latitude:6.1f}-180.0 180.0  60.0 450.0", "LAT/LON1/LON2/DLON/H") + "  100" * 7 + "\n"
        text += headed("     1", "END OF TEC MAP")
    return text + headed("", "END OF FILE")


class NavigationStart(unittest.TestCase):
    def seconds_to_fix(self, path, *arguments):
        """From the start to the first fix, or nothing; and the lines that were said."""
        temporary = open_folder()
        self.addCleanup(temporary.cleanup)
        folder = pathlib.Path(temporary.name)
        done = skyloop("simulate", "--nav", path, "--duration", 60, "--out", folder, *arguments, check=False)
        if done.returncode:
            return None, done.stderr.splitlines()
        with open(folder / "fixes.csv", encoding="ascii") as file:
            fixes = [row["fix_type"] == "3d" for row in csv.DictReader(file)]
        return fixes.index(True) if True in fixes else None, done.stderr.splitlines()

    def check_folder(self, name, at_least):
        """How many files of the folder give a fix: at least so many."""
        folder = SHARED / "nav" / name
        if not folder.is_dir():
            self.skipTest(f"shared data absent: {folder}")
        fixed = 0
        for path in sorted(path for path in folder.iterdir() if path.is_file()):
            with self.subTest(path.name):
                seconds, lines = self.seconds_to_fix(path)
                reasons = [line for line in lines for reason in REASONS if re.search(reason, line)]
                fixed += seconds is not None
                self.assertEqual(len(reasons), 0 if seconds is not None else 1, lines)
        self.assertGreaterEqual(fixed, at_least)

    def test_files_of_days_and_stations(self):
        self.check_folder("", 11)

    def test_almanacs(self):
        self.check_folder("almanac", 3)

    def test_samples(self):
        self.check_folder("odd", 1)

    def test_maps_of_the_ionosphere_begin_later(self):
        temporary = open_folder()
        self.addCleanup(temporary.cleanup)
        folder = pathlib.Path(temporary.name)
        (folder / "day.rnx").write_text(navigation(DAY), encoding="ascii")
        (folder / "maps.24i").write_text(ionosphere_maps(DAY, range(6, 25)), encoding="ascii")
        ionosphere = ["--set", "model.modern.ionosphere.truth=ionex", "--set", f"model.modern.ionosphere.maps={folder / 'maps.24i'}"]

        def start(*arguments):
            return re.search(r"^start +(\S+)", skyloop("check", "--nav", folder / "day.rnx", *arguments).stdout, re.MULTILINE).group(1)

        self.assertEqual(start(), "2024-03-04T23:59:42Z")
        self.assertEqual(start(*ionosphere), "2024-03-05T06:00:00Z")


if __name__ == "__main__":
    unittest.main()
