"""rnx2rtkp of RTKLIB solves our observations with our navigation records and finds the antenna where it is."""
import csv
import math
import pathlib
import shutil
import subprocess
import unittest

from session import SHARED, open_folder, skip, skyloop

LARGEST_ERROR_M = 2e-3
OUR_LARGEST_ERROR_M = 1e-3
SYSTEMS = {"gps": 1, "glonass": 4, "galileo": 8, "qzss": 16, "beidou": 32}
PLACE = (46.4775, 30.7326, 77.0)

OPTIONS = """pos1-posmode =single
pos1-frequency =l1
pos1-elmask =5
pos1-snrmask_r =off
pos1-ionoopt ={iono}
pos1-tropopt ={tropo}
pos1-sateph =brdc
pos1-navsys ={systems}
pos1-posopt5 =off
out-solformat =xyz
out-timesys =gpst
out-timeform =tow
out-outhead =off
out-outvel =off
"""


def to_ecef(latitude_deg, longitude_deg, height):
    """WGS-84."""
    a, f = 6378137.0, 1 / 298.257223563
    e2 = f * (2 - f)
    lat, lon = math.radians(latitude_deg), math.radians(longitude_deg)
    n = a / math.sqrt(1 - e2 * math.sin(lat) ** 2)
    return ((n + height) * math.cos(lat) * math.cos(lon), (n + height) * math.cos(lat) * math.sin(lon),
            (n * (1 - e2) + height) * math.sin(lat))


def up_of(latitude_deg, longitude_deg):
    """The direction away from the ellipsoid."""
    lat, lon = math.radians(latitude_deg), math.radians(longitude_deg)
    return (math.cos(lat) * math.cos(lon), math.cos(lat) * math.sin(lon), math.sin(lat))


def solved(folder, systems, iono="off", tropo="off"):
    """rnx2rtkp's positions by seconds of the week, of an epoch's nominal time."""
    options = pathlib.Path(folder, "options.conf")
    options.write_text(OPTIONS.format(iono=iono, tropo=tropo, systems=sum(SYSTEMS[s] for s in systems)), encoding="ascii")
    done = subprocess.run(["rnx2rtkp", "-k", options, pathlib.Path(folder, "observations.rnx"),
                           pathlib.Path(folder, "navigation.rnx")], capture_output=True, text=True, timeout=120, check=True)
    positions = {}
    for line in done.stdout.splitlines():
        fields = line.split()
        if line.startswith("%") or len(fields) < 7:
            continue
        positions[(int(fields[0]), round(float(fields[1]) * 1000))] = tuple(map(float, fields[2:5]))
    return positions


def truths(folder):
    """Rows of fixes.csv by week and milliseconds of the week."""
    with open(pathlib.Path(folder, "fixes.csv"), encoding="ascii", newline="") as file:
        return {(int(row["gps_week"]), round(float(row["tow_s"]) * 1000)): row for row in csv.DictReader(file)}


def true_position(row):
    return to_ecef(float(row["true_lat_deg"]), float(row["true_lon_deg"]), float(row["true_height_m"]))


def scenario(**parts):
    """A minute without errors over one place; `parts` replaces any of it."""
    values = {"duration": 60, "sky": "", "model": 'errors = "none"', "receiver": "",
              "trajectory": f'kind = "fixed"\nat = [{PLACE[0]}, {PLACE[1]}, {PLACE[2]}]'} | parts
    return """[run]
start = {start}
duration_s = {duration}
[sky]
navigation = {navigation}
{sky}
[trajectory]
{trajectory}
[model]
name = "modern"
{model}
[[receiver]]
constellations = {constellations}
{receiver}
""".format(**values)


class Rnx2rtkpTest(unittest.TestCase):
    def simulate(self, folder, *files, systems, **parts):
        """Runs a scenario on navigation files of the shared data."""
        for file in files:
            if not (SHARED / file).exists():
                self.skipTest(f"shared data absent: {SHARED / file}")
        path = pathlib.Path(folder, "s.toml")
        path.write_text(scenario(navigation=[str(SHARED / f) for f in files], constellations=list(systems), **parts),
                        encoding="utf-8")
        skyloop("simulate", path, "--out", folder, "--quiet")

    def assert_truth(self, folder, systems, clock_m=0.0, **corrections):
        """Every epoch of the run has a solution that is the truth: theirs and ours."""
        rows = truths(folder)
        positions = solved(folder, systems, **corrections)
        self.assertEqual(sorted(positions), sorted(rows), "a solution at every epoch")
        worst = 0.0
        for time, row in rows.items():
            truth = true_position(row)
            error = math.dist(positions[time], truth)
            worst = max(worst, error)
            self.assertLessEqual(error, LARGEST_ERROR_M, f"{systems} at {time}")
            ours = [float(row[name]) for name in ("east_error_m", "north_error_m", "up_error_m")]
            self.assertLessEqual(math.hypot(*ours), OUR_LARGEST_ERROR_M, f"{systems} at {time}: our own fix")
        print(f"  {'+'.join(systems)}: {len(rows)} epochs, worst {worst * 1000:.2f} mm")


if __name__ == "__main__":
    if not shutil.which("rnx2rtkp"):
        skip("rnx2rtkp is not installed; apt-get install rtklib")
    unittest.main(verbosity=2)
