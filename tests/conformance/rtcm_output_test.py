"""convbin of RTKLIB turns the RTCM 3 that an F9P sends into the observations that the run has recorded."""
import datetime
import pathlib
import shutil
import subprocess
import time
import unittest

import receiver
import ubx
import wire

LIGHT = 299792458.0
WAVELENGTH = {"1": LIGHT / 1575.42e6, "2": LIGHT / 1227.60e6}
OBSERVATIONS = (0x209102CC, 0x209102D1, 0x20910318, 0x209102D6)  # 1077, 1087, 1097, 1127 on I2C


def read_rinex(path):
    """{(whole second, satellite, type): (value, seconds beyond)} of a RINEX 3 observation file, GPS alone."""
    types, found, second, beyond = [], {}, None, 0.0
    for line in path.read_text(encoding="ascii").splitlines():
        if line[60:].startswith("SYS / # / OBS TYPES") and line[0] == "G":
            types = line[7:60].split()
        elif line.startswith(">"):
            stamp = datetime.datetime(*map(int, line[1:18].split()))
            whole = round(float(line[18:29]))
            second, beyond = stamp + datetime.timedelta(seconds=whole), float(line[18:29]) - whole
        elif second and line[:1] == "G":
            for i, kind in enumerate(types):
                text = line[3 + 16 * i:17 + 16 * i].strip()
                if text:
                    found[(second, line[:3], kind)] = (float(text), beyond)
    return found


class RtcmOutput(unittest.TestCase):
    def record(self, folder):
        board = receiver.BOARDS["ublox-f9p"]
        with receiver.start(board, folder, "--record", folder) as emulator:
            receiver.wait_for_sentences(board, emulator.tty)
            line = wire.Wire(emulator.tty, board.speed)
            for sentence in range(6):
                line.write(ubx.cfg_msg(0xF000 + sentence, 0))
            line.write(ubx.valset([(0x10740004, 1)] + [(key + 1, 1) for key in OBSERVATIONS]))
            line.drain()
            time.sleep(1.5)
            line.flush()
            data, end = b"", time.monotonic() + 6
            while time.monotonic() < end:
                data += line.read(0.2)[0]
            line.close()
            self.assertEqual(emulator.stop(), 0, emulator.log)
        return data

    def test_observations_survive(self):
        with receiver.open_folder() as name:
            folder = pathlib.Path(name)
            (folder / "sent.rtcm3").write_bytes(self.record(name))
            subprocess.run(["convbin", "-r", "rtcm3", "-tr", "2026/03/01", "00:00:00", "-od", "-os", "-v", "3.03", "-o",
                            folder / "sent.obs", folder / "sent.rtcm3"], check=True, capture_output=True, timeout=60)
            sent, measured = read_rinex(folder / "sent.obs"), read_rinex(folder / "observations.rnx")
        self.assertGreaterEqual(len({key[0] for key in sent}), 4)
        self.assertGreater(len(sent), 100)
        cycles, drifts = {}, {}
        for key, (value, _) in sent.items():
            second, satellite, kind = key
            expected, beyond = measured[key]
            wavelength = WAVELENGTH[kind[1]]
            if kind[0] == "C":
                self.assertAlmostEqual(value, expected - LIGHT * beyond, delta=16, msg=key)
            elif kind[0] == "D":
                drifts.setdefault((second, beyond), []).append((value - expected) * wavelength)
            elif kind[0] == "S":
                self.assertAlmostEqual(value, expected, delta=0.51, msg=key)
            else:
                cycles.setdefault((satellite, kind), []).append(
                    (second, value - expected + LIGHT * beyond / wavelength))
        self.check_ranges_and_phases(sent, measured, cycles)
        self.check_rates(drifts)

    def check_rates(self, drifts):
        """Rates are without the drift of the clock, as phases are: one for all of an epoch, and that of the stamps."""
        for stamp, of_signals in drifts.items():
            self.assertLess(max(of_signals) - min(of_signals), 0.002, stamp)
        (first, early), (last, late) = min(drifts), max(drifts)
        passed = (last - first).total_seconds()
        self.assertGreater(passed, 2)
        drift, rounding = LIGHT * (late - early) / passed, LIGHT * 1e-7 / passed
        for stamp, of_signals in drifts.items():
            self.assertAlmostEqual(of_signals[0], drift, delta=1 + rounding, msg=stamp)

    def check_ranges_and_phases(self, sent, measured, cycles):
        """RINEX tells the receiver's time to 0.1 us, 30 m: what is left over is one for all of an epoch."""
        left = {}
        for key, (value, _) in sent.items():
            if key[2][0] == "C":
                expected, beyond = measured[key]
                left.setdefault(key[0], []).append(value - expected + LIGHT * beyond)
        for second, offsets in left.items():
            self.assertLess(max(offsets) - min(offsets), 0.003, second)
        common = {second: sum(offsets) / len(offsets) for second, offsets in left.items()}
        for key, offsets in cycles.items():
            wavelength = WAVELENGTH[key[1][1]]
            kept = [cycle - common[second] / wavelength for second, cycle in offsets]
            self.assertLess((max(kept) - min(kept)) * wavelength, 0.005, key)
            # The signals of one carrier may stand quarters of a cycle apart (RINEX 3.03, 5.12).
            self.assertAlmostEqual(kept[0] * 4, round(kept[0] * 4), delta=0.05, msg=key)


if __name__ == "__main__":
    if not shutil.which("convbin"):
        receiver.skip("convbin is not installed; apt-get install rtklib")
    unittest.main(verbosity=2)
