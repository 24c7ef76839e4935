"""RTKLIB's convbin reads the SBF that we send: its RINEX is the run's own, and rnx2rtkp finds the antenna with it."""
import math
import pathlib
import re
import shutil
import struct
import subprocess
import unittest

from session import SHARED, open_folder, septentrio_that_sends, skip, skyloop
from rnx2rtkp_test import only_terms, solved, to_ecef
from subframes_test import KEPLER, STATE, difference, records

NAVIGATION = SHARED / "nav/BRDC00IGS_R_20230010000_01D_MN.rnx.gz"
PLACE = (48.1, 11.5, 600.0)
LIGHT = 299792458.0
OBSERVED = ("Measurements", "PVTGeod", "ReceiverSetup")
# convbin 2.4.3 b34 reads no BeiDou and no GPS subframes, and turns the halves of Galileo's pages round by a bit of their data.
BY_BITS, DECODED = ("GLORawCA",), ("GPS", "GLO", "GAL", "BDS", "QZS")
CARRIERS = {"G1": 1575.42e6, "G2": 1227.60e6, "E1": 1575.42e6, "E7": 1207.14e6, "C2": 1561.098e6, "C7": 1207.14e6}
# The run writes 0.001 m, cycles and Hz; the blocks have 0.001 m and cycles, twice for a further signal, and 0.0001 Hz.
LARGEST_ERROR_M = 0.02
RANGE_M, PHASE_CYCLES, DOPPLER_HZ = 0.0021, 0.0041, 0.0013

SCENARIO = """[run]
start = 2023-01-01T12:00:00Z
duration_s = 80
[sky]
navigation = "{navigation}"
[trajectory]
kind = "fixed"
at = [{place}]
[[receiver]]
board = "{board}"
baud = 921600
dual_frequency = true
{model}
"""


def observations(path):
    """Second of the day -> satellite -> code -> number, and codes by system, of a RINEX 3 observation file."""
    lines = path.read_text().splitlines()
    codes, system, channels = {}, None, {}
    end = next(i for i, line in enumerate(lines) if "END OF HEADER" in line)
    for line in lines[:end]:
        if "SYS / # / OBS TYPES" in line:
            system = line[0] if line[0] != " " else system
            codes.setdefault(system, []).extend(line[7:58].split())
        if "GLONASS SLOT" in line:
            words = line[4:60].split()
            channels.update({words[i]: int(words[i + 1]) for i in range(0, len(words), 2)})
    epochs, now = {}, None
    for line in lines[end + 1:]:
        if line[0] == ">":
            words = line[1:].split()
            now = epochs.setdefault(int(words[3]) * 3600 + int(words[4]) * 60 + float(words[5]), {})
            continue
        satellite = line[:3].replace(" ", "0")
        cells = [line[3 + 16 * i:17 + 16 * i].strip() for i in range(len(codes[satellite[0]]))]
        now[satellite] = {code: float(cell) for code, cell in zip(codes[satellite[0]], cells) if cell and float(cell)}
    return epochs, channels


def wavelength(satellite, band, channels):
    if satellite[0] == "R":
        first, step = (1602e6, 562500) if band == "1" else (1246e6, 437500)
        return LIGHT / (first + channels[satellite] * step)
    return LIGHT / CARRIERS.get(satellite[0] + band, CARRIERS["G1"])


def converted(folder, blocks, model=""):
    """A run whose receiver sends those blocks, and RINEX of them in the folder `found`."""
    board = septentrio_that_sends(folder, *blocks)
    (folder / "s.toml").write_text(SCENARIO.format(navigation=NAVIGATION, board=board, model=model,
                                                   place=", ".join(map(str, PLACE))), encoding="utf-8")
    skyloop("simulate", folder / "s.toml", "--out", folder / "run", "--quiet")
    (folder / "found").mkdir()
    shutil.copy(folder / "run/port0.out", folder / "heard.sbf")
    subprocess.run(["convbin", "-r", "sbf", "-v", "3.04", "-od", "-os", "-o", folder / "found/observations.rnx", "-n",
                    folder / "found/navigation.rnx", folder / "heard.sbf"], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL, timeout=120)


class SbfRinex(unittest.TestCase):
    def folder(self, *arguments):
        if not NAVIGATION.exists():
            self.skipTest(f"shared data absent: {NAVIGATION}")
        temporary = open_folder()
        self.addCleanup(temporary.cleanup)
        folder = pathlib.Path(temporary.name)
        converted(folder, *arguments)
        return folder

    def test_observations_are_those_of_the_run(self):
        """Measured beside the whole millisecond; told for it, by the Doppler."""
        folder = self.folder(OBSERVED)
        ours, channels = observations(folder / "run/observations.rnx")
        theirs, _ = observations(folder / "found/observations.rnx")
        self.assertGreater(len(theirs), 0.9 * len(ours))
        compared = {}
        for second, satellites in ours.items():
            whole = round(second, 2)
            if whole not in theirs:
                continue
            for satellite, measured in satellites.items():
                for code, phase in measured.items():
                    if code[0] != "L" or "D" + code[1:] not in measured or satellite[0] not in "GREC":
                        continue
                    found = theirs[whole].get(satellite, {})
                    length = wavelength(satellite, code[1], channels)
                    doppler, later = measured["D" + code[1:]], second - whole
                    if "C" + code[1:] not in found:
                        continue
                    where = f"{satellite} {code} at {second}"
                    self.assertAlmostEqual(found["C" + code[1:]], measured["C" + code[1:]] + later * doppler * length,
                                           delta=RANGE_M, msg=where)
                    self.assertAlmostEqual(found[code], phase + later * doppler, delta=PHASE_CYCLES, msg=where)
                    self.assertAlmostEqual(found["D" + code[1:]], doppler, delta=DOPPLER_HZ, msg=where)
                    # convbin 2.4.3 b34 writes quarters of dB-Hz as thousandths.
                    self.assertAlmostEqual(found["S" + code[1:]] * 250, measured["S" + code[1:]], delta=0.26, msg=where)
                    compared[satellite[0] + code[1]] = compared.get(satellite[0] + code[1], 0) + 1
        print(f"  compared: {compared}")
        for signal in ("G1", "G2", "R1", "R2", "E1", "E7", "C2", "C7"):
            self.assertGreater(compared.get(signal, 0), 300, signal)

    def check_records(self, blocks, systems):
        folder = self.folder(blocks)
        broadcast = every_record(folder / "run/navigation.rnx")
        counts = {}
        for satellite, (epoch, rows) in records(folder / "found/navigation.rnx").items():
            candidates = [other for at, other in broadcast[satellite] if satellite[0] == "R" or at == epoch]
            self.assertTrue(any(is_same(satellite, rows, other) for other in candidates),
                            f"{satellite} of {epoch}: {rows}\n{candidates}")
            counts[satellite[0]] = counts.get(satellite[0], 0) + 1
        print(f"  records: {counts}")
        self.assertEqual(sorted(counts), sorted(systems))
        self.assertGreaterEqual(min(counts.values()), 3, counts)

    def test_records_by_their_bits_are_those_that_were_broadcast(self):
        self.check_records(OBSERVED + BY_BITS, "R")

    def test_decoded_records_are_those_that_were_broadcast(self):
        self.check_records(OBSERVED + DECODED, "GRE")

    def test_bits_are_those_of_the_records(self):
        """GPS subframes with their parity (IS-GPS-200, table 20-XIV), I/NAV pages with their CRC, against the blocks decoded."""
        folder = self.folder(("RawNavBits", "GPS", "GAL"))
        blocks = list(blocks_of((folder / "heard.sbf").read_bytes()))
        records_told = {struct.unpack_from("<B", body, 6)[0]: body for number, body in blocks if number in (5891, 4002)}
        compared = {"gps": 0, "galileo": 0}
        for number, body in blocks:
            if number not in (4017, 4023):
                continue
            words, told = struct.unpack_from(f"<{10 if number == 4017 else 8}I", body, 12), records_told.get(body[6])
            self.assertEqual(body[7], 1)
            if number == 4017:
                d29 = d30 = 0
                for word in words:
                    parity = [bin(word >> 6 & mask).count("1") & 1 ^ (d30 if last else d29) for mask, last in PARITY]
                    self.assertEqual([word >> bit & 1 ^ d30 for bit in range(5, -1, -1)], parity)
                    d29, d30 = parity[4], parity[5]
                self.assertEqual(words[0] >> 22, 0x8B)
                if told and words[1] >> 8 & 7 == 2:
                    eccentricity = (words[5] >> 6 & 0xFF) << 24 | words[6] >> 6 & 0xFFFFFF
                    self.assertAlmostEqual(eccentricity * 2.0**-33, struct.unpack_from("<d", told, 60)[0], delta=2.0**-34)
                    compared["gps"] += 1
            else:
                bits = int.from_bytes(b"".join(word.to_bytes(4, "big") for word in words), "big") >> 22
                self.assertEqual(crc24q(bits >> 38), bits >> 14 & 0xFFFFFF)
                if told and bits >> 226 & 63 == 1:
                    word = (bits >> 120 & (1 << 112) - 1) << 16 | bits >> 102 & 0xFFFF
                    self.assertEqual((word & (1 << 34) - 1) >> 2, round(struct.unpack_from("<d", told, 8)[0] * 2**19))
                    compared["galileo"] += 1
        print(f"  bits: {compared}")
        self.assertGreater(min(compared.values()), 10)

    def test_rnx2rtkp_finds_the_antenna(self):
        """Without any cause of an error, to what a millimetre in the ranges leaves."""
        folder = self.folder(OBSERVED + DECODED, only_terms())
        truth = to_ecef(*PLACE)
        for systems in (("gps",), ("gps", "galileo")):
            errors = [math.dist(truth, place) for place in solved(folder / "found", systems).values()]
            print(f"  {'+'.join(systems)}: {len(errors)} epochs, largest error {max(errors):.4f} m")
            self.assertGreater(len(errors), 150)
            self.assertLess(max(errors), LARGEST_ERROR_M)


PARITY = ((0xEC7CD2, False), (0x763E69, True), (0xBB1F34, False), (0x5D8F9A, True), (0xAEC7CD, True), (0x2DEA27, False))


def blocks_of(data):
    """Numbers and bodies of a stream of nothing else."""
    at = 0
    while at + 8 <= len(data):
        number, length = struct.unpack_from("<HH", data, at + 4)
        yield number & 0x1FFF, data[at + 8:at + length]
        at += length


def crc24q(bits):
    """Of the 196 bits of a pair of pages."""
    remainder = bits << 24
    for bit in range(219, 23, -1):
        if remainder >> bit & 1:
            remainder ^= 0x1864CFB << (bit - 24)
    return remainder


def every_record(path):
    """Satellite -> epochs and rows of all its records; Galileo's come by two messages with two clocks."""
    head, _, body = path.read_text().partition("END OF HEADER")
    found = {}
    with open_folder() as folder:
        one = pathlib.Path(folder, "one.rnx")
        for record in re.split(r"\n(?=[A-Z]\d\d )", body)[1:]:
            one.write_text(f"{head}END OF HEADER\n{record.rstrip()}\n", encoding="ascii")
            for satellite, epoch_and_rows in records(one).items():
                found.setdefault(satellite, []).append(epoch_and_rows)
    return found


def is_same(satellite, rows, other):
    """Within half a step of each field; the group delays of Galileo and BeiDou are told otherwise."""
    places = STATE if satellite[0] == "R" else KEPLER
    return all(difference((line, column), rows[line][column], other[line][column]) <= tolerance
               for (line, column), tolerance in places.items() if satellite[0] in "GR" or line != 6)


if __name__ == "__main__":
    if not shutil.which("convbin") or not shutil.which("rnx2rtkp"):
        skip("convbin and rnx2rtkp of RTKLIB are not here")
    unittest.main(verbosity=2)
