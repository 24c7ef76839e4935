"""gpsdecode reads what a client has recorded: gpsdecode_test.py BOARD. NAV messages, and of the F9P RTCM 3 too.

The program comes with gpsd-clients, which draws in a desktop: where it is absent the test is skipped. GPSDECODE names
one that lies elsewhere.
"""
import json
import os
import shutil
import subprocess
import sys
import time
import unittest

import receiver
import ubx
import wire

PROGRAM = os.environ.get("GPSDECODE") or shutil.which("gpsdecode")
MESSAGES = ("NAV-PVT", "NAV-SAT", "NAV-DOP", "NAV-TIMEGPS", "NAV-CLOCK", "NAV-STATUS", "NAV-EOE")
CORRECTIONS = (0x209102BD, 0x209102CC, 0x209102D1, 0x20910303)  # 1005, 1077, 1087, 1230 on I2C


class Gpsdecode(unittest.TestCase):
    board = None

    def record(self):
        """The bytes of ten seconds with navigation messages on and sentences off."""
        with receiver.open_folder() as folder, receiver.start(self.board, folder) as emulator:
            receiver.wait_for_sentences(self.board, emulator.tty)
            line = wire.Wire(emulator.tty, self.board.speed)
            for sentence in range(6):
                line.write(ubx.cfg_msg(0xF000 + sentence, 0))
            for message in MESSAGES:
                line.write(ubx.cfg_msg(message, 1))
            if self.board.is_f9p:
                line.write(ubx.valset([(0x10740004, 1)] + [(key + 1, 1) for key in CORRECTIONS]))
            line.drain()
            time.sleep(1.5)
            line.flush()
            data, end = b"", time.monotonic() + 10
            while time.monotonic() < end:
                data += line.read(0.2)[0]
            line.close()
            self.assertEqual(emulator.stop(), 0, emulator.log)
        return data

    def decode(self, data):
        done = subprocess.run([PROGRAM, "-j"], input=data, capture_output=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        return [json.loads(text) for text in done.stdout.decode().splitlines() if text.startswith("{")]

    def test_navigation(self):
        data = self.record()
        kinds = [i.message for i in ubx.Parser().feed(data) if isinstance(i, ubx.Frame)]
        self.assertGreaterEqual(kinds.count(0x0107), 8, "NAV-PVT in what was recorded")
        reports = self.decode(data)
        fixes = [r for r in reports if r["class"] == "TPV" and r.get("mode") == 3]
        skies = [r for r in reports if r["class"] == "SKY" and r.get("satellites")]
        self.assertGreaterEqual(len({fix["time"] for fix in fixes}), 7)
        self.assertGreaterEqual(len(skies), 7)
        for fix in fixes:
            self.assertTrue(fix["time"].startswith("2026-03-01T00:0"), fix["time"])
            self.assertLess(receiver.metres_apart(fix["lat"], fix["lon"]), 20)
            self.assertAlmostEqual(fix["altHAE"], receiver.PLACE[2], delta=30)
        self.assertGreaterEqual(skies[-1]["uSat"], 5)
        self.assertTrue(0.3 < skies[-1]["hdop"] < 5)
        if self.board.is_f9p:
            types = {r["type"] for r in reports if r["class"] == "RTCM3"}
            self.assertTrue({1077, 1230} <= types, f"RTCM types {types}, expected 1077 and 1230 among them")


if __name__ == "__main__":
    if not PROGRAM:
        receiver.skip("gpsdecode is not installed; apt-get install gpsd-clients")
    Gpsdecode.board = receiver.BOARDS[sys.argv.pop(1)]
    unittest.main(verbosity=2)
