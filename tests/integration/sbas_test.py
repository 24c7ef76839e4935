"""RTKLIB reads the SBAS messages that our receivers send and corrects with them; our receivers do so by themselves.

Nothing but what an SBAS corrects is wrong here: orbits, clocks and the ionosphere. convbin makes of RXM-SFRBX (or GEORawL1) a
log of messages, which rnx2rtkp takes in the place of broadcast ionosphere and beside broadcast orbits.
"""
import csv
import math
import pathlib
import shutil
import subprocess
import unittest

from session import SHARED, open_folder, septentrio_that_sends, skip, skyloop
from rnx2rtkp_test import TERMS, to_ecef

NAVIGATION = SHARED / "nav/BRDC00IGS_R_20230010000_01D_MN.rnx.gz"
PLACES = {"Munich": (48.1, 11.5, 600.0), "Athens": (38.0, 23.7, 100.0)}
KEPT = ("signal_in_space", "ionosphere", "ionosphere_residual")

SCENARIO = """[run]
start = 2023-01-01T12:00:00Z
duration_s = 240
seed = {seed}
[sky]
navigation = "{navigation}"
constellations = ["gps", "sbas"]
[trajectory]
kind = "fixed"
at = [{place}]
[model.modern.ionosphere]
truth = "klobuchar"
residual = "on"
[model.modern.solution]
troposphere_correction = "none"
filter = "none"
[[receiver]]
board = "{board}"
constellations = ["gps", "sbas"]
{receiver}
{terms}
"""
UBX = """baud = 460800
[receiver.config]
CFG-UART1-BAUDRATE = 460800
CFG-MSGOUT-UBX_RXM_RAWX_UART1 = 1
CFG-MSGOUT-UBX_RXM_SFRBX_UART1 = 1
CFG-MSGOUT-UBX_NAV_SBAS_UART1 = 1
CFG-MSGOUT-UBX_NAV_SAT_UART1 = 1"""
OPTIONS = """pos1-posmode =single
pos1-frequency =l1
pos1-elmask =10
pos1-snrmask_r =off
pos1-ionoopt ={iono}
pos1-tropopt =off
pos1-sateph ={orbits}
pos1-navsys =1
pos1-posopt5 =off
misc-sbasatsel ={prn}
out-solformat =xyz
out-timesys =gpst
out-timeform =tow
out-outhead =off
out-outvel =off
"""


def median(values):
    return sorted(values)[len(values) // 2]


class Sbas(unittest.TestCase):
    def heard(self, place, seed, kind="ubx"):
        """A folder with a run and what RTKLIB's convbin makes of what its receiver sent."""
        if not NAVIGATION.exists():
            self.skipTest(f"shared data absent: {NAVIGATION}")
        temporary = open_folder()
        self.addCleanup(temporary.cleanup)
        folder = pathlib.Path(temporary.name)
        board = "ublox-f9p" if kind == "ubx" else septentrio_that_sends(folder, "Measurements", "RawNavBits", "PVTGeod", "GPS")
        terms = "\n".join(f"[model.modern.terms.{term}]\nenabled = false" for term in TERMS if term not in KEPT)
        (folder / "s.toml").write_text(
            SCENARIO.format(navigation=NAVIGATION, place=", ".join(map(str, place)), seed=seed, board=board, terms=terms,
                            receiver=UBX if kind == "ubx" else "baud = 921600"), encoding="utf-8")
        skyloop("simulate", folder / "s.toml", "--out", folder / "run", "--quiet")
        shutil.copy(folder / "run/port0.out", folder / f"heard.{kind}")
        subprocess.run(["convbin", "-r", kind, "-v", "3.04", "-oi", "-o", folder / "found.obs", "-n", folder / "found.nav",
                        "-s", folder / "found.sbs", folder / f"heard.{kind}"], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL, timeout=120)
        return folder

    def errors(self, folder, place, **options):
        """rnx2rtkp's, m, of each epoch of the second half of what it solves, which with SBAS begins after a minute."""
        (folder / "options.conf").write_text(OPTIONS.format(**options), encoding="ascii")
        done = subprocess.run(["rnx2rtkp", "-k", folder / "options.conf", folder / "run/observations.rnx",
                               folder / "run/navigation.rnx", folder / "found.sbs"], capture_output=True, text=True,
                              timeout=120, check=True)
        lines = [line.split() for line in done.stdout.splitlines() if not line.startswith("%") and len(line.split()) > 7]
        solved = [math.dist(to_ecef(*place), tuple(map(float, fields[2:5]))) for fields in lines]
        quality = {fields[5] for fields in lines[len(lines) // 2:]}
        return solved[len(solved) // 2:], quality

    def test_rtklib_corrects_with_our_messages(self):
        for name, place in PLACES.items():
            broadcast, corrected = [], []
            for seed in (1, 2, 3):
                folder = self.heard(place, seed)
                alone, _ = self.errors(folder, place, iono="brdc", orbits="brdc", prn=0)
                with_sbas, _ = self.errors(folder, place, iono="sbas", orbits="brdc+sbas", prn=136)
                self.assertGreater(len(with_sbas), 60, "epochs that RTKLIB solves with our messages")
                broadcast.append(median(alone))
                corrected.append(median(with_sbas))
            print(f"  {name}: broadcast {broadcast}, with SBAS {corrected} m")
            self.assertLess(sum(corrected), 0.75 * sum(broadcast), name)

    def test_every_message_is_known(self):
        """Of convbin's log: one message a second of each satellite, of the types that a service has."""
        folder = self.heard(PLACES["Munich"], 1)
        types = {}
        for line in (folder / "found.sbs").read_text().splitlines():
            week, tow, prn, kind, rest = line.split(None, 4)
            types.setdefault(prn, []).append(int(kind))
        print("  messages: " + ", ".join(f"PRN {prn}: {len(kinds)}" for prn, kinds in types.items()))
        self.assertIn("136", types)
        for prn in ("123", "136"):
            self.assertGreater(len(types[prn]), 200, prn)
            self.assertLessEqual({1, 2, 3, 6, 7, 9, 10, 17, 18, 24, 25, 26, 27}, set(types[prn]), prn)

    def test_sbf_tells_the_same_messages(self):
        messages = {}
        for kind in ("ubx", "sbf"):
            folder = self.heard(PLACES["Munich"], 1, kind)
            for line in (folder / "found.sbs").read_text().splitlines():
                head, bits = line.split(":")
                messages.setdefault(kind, {})[tuple(head.split())] = bits.strip()
        same = set(messages["ubx"]) & set(messages["sbf"])
        print(f"  messages by UBX and SBF: {len(same)}")
        self.assertGreater(len(same), 200)
        for key in same:
            self.assertEqual(messages["ubx"][key], messages["sbf"][key], key)

    def test_our_receiver_corrects_itself(self):
        """Differential within a minute of the start, and nearer then."""
        for name, place in PLACES.items():
            before, after = [], []
            for seed in (1, 2, 3):
                folder = self.heard(place, seed)
                with open(folder / "run/fixes.csv", encoding="ascii", newline="") as file:
                    rows = list(csv.DictReader(file))
                kinds = [row["fix_type"] for row in rows]
                self.assertIn("dgnss", kinds, name)
                first = kinds.index("dgnss")
                seconds = float(rows[first]["tow_s"]) - float(rows[0]["tow_s"])
                self.assertLess(seconds, 60, name)
                self.assertEqual(set(kinds[first:]), {"dgnss"})

                def error(row):
                    return math.hypot(*(float(row[f"{axis}_error_m"]) for axis in ("east", "north", "up")))
                alone = [error(row) for row, kind in zip(rows, kinds) if kind == "3d"]
                before.append(median(alone))
                after.append(median([error(row) for row in rows[first:]]))
            print(f"  {name}: before {before}, corrected {after} m, the last after {seconds:.0f} s")
            self.assertLess(sum(after), 0.75 * sum(before), name)  # of noise there is as much before as after


if __name__ == "__main__":
    if shutil.which("convbin") is None or shutil.which("rnx2rtkp") is None:
        skip("convbin and rnx2rtkp of RTKLIB are not installed")
    unittest.main()
