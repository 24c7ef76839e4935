"""Where a run with a navigation file and without a start begins: it has a fix within a minute, or a line says why not."""
import csv
import pathlib
import re
import unittest

from session import SHARED, open_folder, skyloop

# What a run of a minute says of a file that serves nobody at the place of the run.
REASONS = (r"no fix is to be expected at the start, \S+: of [a-z, ]+, too few satellites (have orbits then|with orbits stand above \d+ degrees)",
           r"^skyloop: --nav: \S+?:\d+(:\d+)?: found .*; ")


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
        self.check_folder("odd", 0)


if __name__ == "__main__":
    unittest.main()
