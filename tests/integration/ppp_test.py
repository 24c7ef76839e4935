"""rnx2rtkp of RTKLIB solves two hours of our observations by precise point positioning, with the products that were the
truth of the run, and finds the antenna within centimetres; with a switch of its own off it does not."""
import gzip
import math
import pathlib
import shutil
import subprocess
import unittest

from rnx2rtkp_test import to_ecef
from session import SHARED, open_folder, skip, skyloop

NAVIGATION = SHARED / "nav/BRDC00IGS_R_20230010000_01D_MN.rnx.gz"
ORBITS = SHARED / "precise/COD0MGXFIN_20230010000_01D_05M_ORB.SP3.gz"
PLACE = (46.4774, 30.7326, 77.0)
ANTENNA = "SKYLOOP_TEST    NONE"

SCENARIO = """[run]
start = 2023-01-01T09:00:00Z
duration_s = 7200
seed = 3
[sky]
navigation = "{navigation}"
orbits = "{orbits}"
antennas = "antennas.atx"
constellations = ["gps", "glonass"]
[trajectory]
kind = "fixed"
at = [{place[0]}, {place[1]}, {place[2]}]
[model]
name = "modern"
[model.modern]
preset = "survey"
{model}
[[receiver]]
board = "septentrio-sbf"
constellations = ["gps", "glonass"]
dual_frequency = true
rate_hz = 0.0333333333333
antenna_type = "{antenna}"
"""

# Between epochs of 30 s travelling waves of the ionosphere pass the 5 cm from which RTKLIB suspects a slip.
OPTIONS = """pos1-posmode =ppp-static
pos1-frequency =l1+2
pos1-soltype =forward
pos1-elmask =7
pos1-snrmask_r =off
pos1-tidecorr ={tide}
pos1-ionoopt =dual-freq
pos1-tropopt =est-ztd
pos1-sateph =precise
pos1-posopt1 ={satellite_variations}
pos1-posopt2 ={receiver_variations}
pos1-posopt3 ={wind_up}
pos1-posopt4 =off
pos1-posopt5 =off
pos1-navsys ={systems}
out-solformat =xyz
out-timesys =gpst
out-timeform =tow
out-outhead =off
out-outvel =off
ant1-anttype ={antenna}
pos2-slipthres =0.5
file-satantfile ={antennas}
file-rcvantfile ={antennas}
"""
SWITCHES = {"tide": "on", "satellite_variations": "on", "receiver_variations": "on", "wind_up": "on"}
GPS, GPS_AND_GLONASS = 1, 5
# Beside orbits, clocks, antennas, wind-up, tides and the mean air.
NOISE = ("ionosphere", "ionosphere_residual", "troposphere_residual", "scintillation", "code_noise", "phase_noise",
         "multipath", "receiver_clock", "cycle_slips")


def labelled(text, label):
    return f"{text:<60}{label}\n"


def frequency(name, offset, variations):
    values = "".join(f"{v:8.2f}" for v in variations)
    return (labelled(f"   {name}", "START OF FREQUENCY") +
            labelled("{:10.2f}{:10.2f}{:10.2f}".format(*offset), "NORTH / EAST / UP") + f"   NOAZI{values}\n" +
            labelled(f"   {name}", "END OF FREQUENCY"))


def antenna(kind, serial, angles, frequencies):
    return (labelled("", "START OF ANTENNA") + labelled(f"{kind:<20}{serial:<20}", "TYPE / SERIAL NO") +
            labelled("     0.0", "DAZI") + labelled("  {:6.1f}{:6.1f}{:6.1f}".format(*angles), "ZEN1 / ZEN2 / DZEN") +
            labelled(f"{len(frequencies):6d}", "# OF FREQUENCIES") +
            labelled("  2000     1     1     0     0    0.0000000", "VALID FROM") +
            "".join(frequency(*f) for f in frequencies) + labelled("", "END OF ANTENNA"))


def antennas():
    """Phase centres like those of real satellites, and an antenna that is worse than those that one would buy."""
    text = (labelled("     1.4            M", "ANTEX VERSION / SYST") + labelled("A", "PCV TYPE / REFANT") +
            labelled("", "END OF HEADER"))
    nadir = [12 * math.cos(n / 14 * math.pi) for n in range(18)]
    for system, satellites in (("G", 32), ("R", 24)):
        for number in range(1, satellites + 1):
            offset = (394.0 if system == "G" else -545.0, 0.0, 700.0 + 50 * number)
            bands = [(f"{system}{band:02d}", offset, nadir) for band in (1, 2)]
            text += antenna("BLOCK TEST", f"{system}{number:02d}", (0, 17, 1), bands)
    zenith = [25 * (1 - math.cos(math.radians(5 * n))) for n in range(19)]
    text += antenna(ANTENNA, "", (0, 90, 5), [("G01", (1.2, -0.8, 90.0), zenith), ("G02", (0.5, 0.4, 120.0), zenith)])
    return text


def east_north_up(position):
    """From the place of the scenario, m."""
    lat, lon = (math.radians(a) for a in PLACE[:2])
    x, y, z = (a - b for a, b in zip(position, to_ecef(*PLACE)))
    east = -math.sin(lon) * x + math.cos(lon) * y
    north = -math.sin(lat) * (math.cos(lon) * x + math.sin(lon) * y) + math.cos(lat) * z
    return east, north, math.cos(lat) * (math.cos(lon) * x + math.sin(lon) * y) + math.sin(lat) * z


def orbits_for_rtklib():
    """The products' rows of GPS and GLONASS: RTKLIB reads numbers of satellites of two digits, in five lines."""
    lines = gzip.decompress(ORBITS.read_bytes()).decode("ascii").splitlines()
    rows = [line for line in lines if line[0] == "*" or line[:2] in ("PG", "PR")]
    satellites = sorted({line[1:4] for line in rows if line[0] == "P"})
    names = "".join(satellites) + "  0" * (85 - len(satellites))
    head = ["#c" + lines[0][2:], lines[1], f"+   {len(satellites):2d}   {names[:51]}"]
    head += ["+        " + names[at:at + 51] for at in range(51, 255, 51)] + ["++       " + "  0" * 17] * 5
    head += ["%c M  cc GPS ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc"] * 2
    head += ["%f  1.2500000  1.025000000  0.00000000000  0.000000000000000"] * 2
    head += ["%i    0    0    0    0      0      0      0      0         0"] * 2 + ["/* "] * 4
    return "\n".join(head + rows + ["EOF", ""])


class PppTest(unittest.TestCase):
    def simulate(self, folder, switched_off=()):
        """Two hours every 30 s."""
        (folder / "antennas.atx").write_text(antennas(), encoding="ascii")
        (folder / "orbits.sp3").write_text(orbits_for_rtklib(), encoding="ascii")
        off = "\n".join(f"[model.modern.terms.{term}]\nenabled = false" for term in switched_off)
        (folder / "s.toml").write_text(SCENARIO.format(navigation=NAVIGATION, orbits=ORBITS, place=PLACE,
                                                       antenna=ANTENNA, model=off), encoding="utf-8")
        skyloop("simulate", folder / "s.toml", "--out", folder, "--quiet")

    def solved(self, folder, systems, **switches):
        """East, north and up of the last position, after 2 h, m."""
        options = folder / "options.conf"
        options.write_text(OPTIONS.format(antenna=ANTENNA, antennas=folder / "antennas.atx", systems=systems,
                                          **SWITCHES | switches), encoding="ascii")
        done = subprocess.run(["rnx2rtkp", "-k", options, folder / "observations.rnx", folder / "navigation.rnx",
                               folder / "orbits.sp3"], capture_output=True, text=True, timeout=120, check=True)
        lines = [line.split() for line in done.stdout.splitlines() if not line.startswith("%")]
        self.assertGreater(len(lines), 200, done.stderr)
        error = east_north_up([float(field) for field in lines[-1][2:5]])
        told = ", ".join(f"{name} {value}" for name, value in switches.items()) or "everything on"
        print("  {}: east {:.1f} north {:.1f} up {:.1f} mm".format(told, *(1000 * part for part in error)))
        return error

    def test_finds_the_antenna(self):
        with open_folder() as name:
            folder = pathlib.Path(name)
            self.simulate(folder)
            east, north, up = self.solved(folder, GPS_AND_GLONASS)
            self.assertLessEqual(math.hypot(east, north), 0.03)
            self.assertLessEqual(abs(up), 0.06)

    def test_each_cause_is_the_one_that_a_switch_of_its_own_takes_off(self):
        with open_folder() as name:
            folder = pathlib.Path(name)
            self.simulate(folder, NOISE)
            self.assertLessEqual(math.hypot(*self.solved(folder, GPS)), 0.003)
            for switch in SWITCHES:
                self.assertGreaterEqual(math.hypot(*self.solved(folder, GPS, **{switch: "off"})), 0.01, switch)


if __name__ == "__main__":
    if not shutil.which("rnx2rtkp"):
        skip("rnx2rtkp is not installed; apt-get install rtklib")
    for file in (NAVIGATION, ORBITS):
        if not file.exists():
            skip(f"shared data absent: {file}")
    unittest.main(verbosity=2)
