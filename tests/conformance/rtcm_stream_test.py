"""convbin of RTKLIB turns --output rtcm-file into the observations and the orbits that the run has recorded."""
import math
import pathlib
import re
import shutil
import subprocess
import unittest

import receiver

LIGHT = 299792458.0
SEMICIRCLE = math.pi
# Steps of the fields of 1019 (RTCM 10403.3, table 3.5-21) in the order of a RINEX record: clock, orbit. Those of other
# systems are as fine or finer.
STEPS = [2**-31, 2**-43, 2**-55, 1, 2**-5, SEMICIRCLE * 2**-43, SEMICIRCLE * 2**-31, 2**-29, 2**-33, 2**-29, 2**-19, 1,
         2**-29, SEMICIRCLE * 2**-31, 2**-29, SEMICIRCLE * 2**-31, 2**-5, SEMICIRCLE * 2**-31, SEMICIRCLE * 2**-43,
         SEMICIRCLE * 2**-43]
# Of 1020, in kilometres (table 3.5-22): clock, rate, then not the frame's time; place, velocity, acceleration by axes.
GLONASS_STEPS = [2**-30, 2**-40, None] + 3 * [2**-11, 2**-20, 2**-30, None]


def numbers_of(line, first, count):
    texts = [line[at:at + 19].strip() for at in range(first, first + 19 * count, 19)]
    return [float(text.replace("D", "E").replace("d", "e")) if text else 0.0 for text in texts]


def navigation(path):
    """{(satellite, epoch of the clock, Galileo's sources): numbers} of a RINEX 3 navigation file."""
    lines, records = path.read_text(encoding="ascii").splitlines(), {}
    starts = [i for i, line in enumerate(lines) if re.match(r"[GREJCI]\d\d \d{4}", line)]
    for i in starts:
        glonass = lines[i][0] == "R"
        numbers = numbers_of(lines[i], 23, 3)
        for line in lines[i + 1:i + (4 if glonass else 8)]:
            numbers += numbers_of(line, 4, 4)
        sources = int(numbers[20]) if lines[i][0] == "E" else 0
        records[(lines[i][:3], lines[i][3:23], sources)] = numbers
    return records


def observations(path):
    """{(epoch, satellite, type): value} of a RINEX 3 observation file, and the epochs' seconds beyond whole hundredths."""
    types, found, epoch, beyond = {}, {}, None, {}
    for line in path.read_text(encoding="ascii").splitlines():
        if line[60:].startswith("SYS / # / OBS TYPES"):
            system = line[0] if line[0] != " " else system
            types.setdefault(system, []).extend(line[7:60].split())
        elif line.startswith(">"):
            seconds = float(line[18:29])
            epoch = (line[2:18], round(seconds, 2))
            beyond[epoch] = seconds - round(seconds, 2)
        elif epoch and line[:1] in types:
            for i, kind in enumerate(types[line[0]]):
                text = line[3 + 16 * i:17 + 16 * i].strip()
                if text:
                    found[(epoch, line[:3], kind)] = float(text)
    return found, beyond


class RtcmStream(unittest.TestCase):
    def run_of(self, folder):
        start = "2024-01-01T06:00:00Z"
        nav = receiver.SHARED / "nav/BRDC00IGS_R_20240010000_01D_MN.rnx.gz"
        data = ("--nav", nav) if nav.exists() else ()
        receiver.skyloop("simulate", "--board", "septentrio-sbf", "--start", start, "--duration", 70, "--at",
                         "46.5,30.7,80", *data, "--out", folder / "run", "--output",
                         f"rtcm-file:{folder}/sent.rtcm3,station=7")
        read = subprocess.run(["convbin", "-r", "rtcm3", "-tr", "2024/01/01", "06:00:00", "-od", "-os", "-v", "3.04",
                               "-o", folder / "sent.obs", "-n", folder / "sent.nav", folder / "sent.rtcm3"],
                              check=True, capture_output=True, timeout=60, text=True)
        self.assertNotRegex(read.stderr, r"\bE=[1-9]", "messages that it could not read")
        return folder / "run"

    def test_orbits_and_observations_survive(self):
        with receiver.open_folder() as name:
            folder = pathlib.Path(name)
            recorded = self.run_of(folder)
            self.check_orbits(navigation(folder / "sent.nav"), navigation(recorded / "navigation.rnx"))
            self.check_ranges(observations(folder / "sent.obs"), observations(recorded / "observations.rnx"))

    def check_orbits(self, sent, recorded):
        self.assertGreater(len(sent), 5)
        systems = {key[0][0] for key in sent}
        self.assertEqual(systems, {key[0][0] for key in recorded if key[0] in {other[0] for other in sent}})
        for key, numbers in sent.items():
            self.assertIn(key, recorded)
            expected = recorded[key]
            steps = GLONASS_STEPS if key[0][0] == "R" else STEPS
            for i, step in enumerate(steps):
                if step:
                    # Half a step, and the twelve digits of the files.
                    allowed = 0.5 * step + 1e-11 * abs(expected[i])
                    self.assertAlmostEqual(numbers[i], expected[i], delta=allowed, msg=(key, i))

    def check_ranges(self, sent, recorded):
        """RINEX tells the receiver's time to 0.1 us, 30 m: what is left over is one for all of an epoch."""
        (sent, _), (recorded, beyond) = sent, recorded
        left = {}
        for (epoch, satellite, kind), value in sent.items():
            if kind[0] == "C":
                expected = recorded[(epoch, satellite, kind)]
                left.setdefault(epoch, []).append(value - expected + LIGHT * beyond[epoch])
        self.assertGreater(len(left), 30)
        for epoch, offsets in left.items():
            self.assertGreater(len(offsets), 5)
            self.assertLess(max(offsets) - min(offsets), 0.004, epoch)


if __name__ == "__main__":
    if not shutil.which("convbin"):
        receiver.skip("convbin is not installed; apt-get install rtklib")
    unittest.main(verbosity=2)
