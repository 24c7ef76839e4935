"""A drive through Munich: satellites turn blocked and reflected as streets turn, and the fix suffers where they do."""
import csv
import pathlib
import statistics
import unittest

from session import SHARED, open_folder, skip, skyloop

CITY = SHARED / "city/munich.tar.gz"
DRIVE = pathlib.Path(__file__).with_name("munich_drive.toml")


def rows(path):
    with open(path, encoding="ascii") as file:
        return list(csv.DictReader(file))


class MunichDriveTest(unittest.TestCase):
    def drive(self, folder, *arguments):
        skyloop("simulate", DRIVE, "--scene", CITY, "--out", folder, *arguments)
        return rows(pathlib.Path(folder, "satellites.csv")), rows(pathlib.Path(folder, "fixes.csv"))

    def test_satellites_turn_blocked_and_reflected(self):
        with open_folder() as folder:
            satellites, fixes = self.drive(folder)
            picture = skyloop("sky", DRIVE, "--scene", CITY, "--run", folder, "--format", "svg").stdout
        self.assertIn("</svg>", picture)
        direct = [row for row in satellites if row["line_of_sight"] == "1"]
        reflected = [row for row in satellites if row["line_of_sight"] == "0" and row["paths"] != "0"]
        hidden = [row for row in satellites if row["paths"] == "0"]
        for found in (direct, reflected, hidden):
            self.assertGreater(len(found), 0.03 * len(satellites))
        # Low satellites hide first.
        elevation = lambda found: statistics.mean(float(row["elevation_deg"]) for row in found)
        self.assertGreater(elevation(direct), elevation(reflected) + 5)
        # A detour in a street is some metres to some hundred.
        detours = [float(row["excess_path_m"]) for row in reflected]
        self.assertTrue(all(0 <= detour < 1500 for detour in detours))
        self.assertTrue(2 < statistics.median(detours) < 100)
        self.worse_where_fewer_stand_in_sight(direct, fixes)

    def worse_where_fewer_stand_in_sight(self, direct, fixes):
        in_sight = {}
        for row in direct:
            in_sight[row["time_utc"]] = in_sight.get(row["time_utc"], 0) + 1
        errors = {True: [], False: []}
        for fix in fixes:
            if fix["east_error_m"]:
                error = (float(fix["east_error_m"]) ** 2 + float(fix["north_error_m"]) ** 2) ** 0.5
                errors[in_sight.get(fix["time_utc"], 0) >= 6].append(error)
        self.assertGreater(min(map(len, errors.values())), 30)
        self.assertGreater(statistics.median(errors[False]), 2 * statistics.median(errors[True]))

    def test_the_number_of_threads_changes_no_byte(self):
        text = DRIVE.read_text(encoding="utf-8").replace("duration_s = 300", "duration_s = 40")
        kept = None
        for threads in (0, 1, 2, 4):
            with self.subTest(threads), open_folder() as folder:
                scenario = pathlib.Path(folder, "drive.toml")
                scenario.write_text(text.replace("[scene]\n", f"[scene]\nthreads = {threads}\n"), encoding="utf-8")
                out = pathlib.Path(folder, "out")
                skyloop("simulate", scenario, "--scene", CITY, "--out", out)
                found = [pathlib.Path(out, name).read_bytes() for name in ("satellites.csv", "fixes.csv", "port0.out")]
                self.assertEqual(kept or found, found)
                kept = found


if __name__ == "__main__":
    if not CITY.exists():
        skip(f"{CITY} is absent")
    unittest.main()
