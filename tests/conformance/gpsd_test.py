"""gpsd, free to configure the receiver: gpsd_test.py BOARD. Mode 3, the scenario's time and place, its satellites.

Specification 6.5 and 11: gpsd probes, sees UBX, sets CFG-PRT and the rates, and turns sentences off. Its own hunt for
the speed is short, so that it starts at the receiver's.
"""
import datetime
import json
import os
import shutil
import sys
import time
import unittest

import receiver
from gpsd_process import Gpsd

PATIENCE = 45


class GpsdConfigures(unittest.TestCase):
    board = None

    def setUp(self):
        folder = receiver.open_folder()
        self.addCleanup(folder.cleanup)
        emulator = receiver.start(self.board, folder.name)
        self.began = time.monotonic()
        self.addCleanup(self.finish, emulator)
        # gpsd gives up root before it opens the tty, and here it writes to it.
        os.chmod(os.path.realpath(emulator.tty), 0o666)
        self.gpsd = Gpsd(emulator.tty, "-s", str(self.board.speed), "-D", "2")

    def finish(self, emulator):
        log = self.gpsd.stop()
        code = emulator.stop()
        print(f"gpsd said: {log[-2000:]}\nskyloop said: {emulator.log}", file=sys.stderr)
        self.assertEqual(code, 0)

    def test_autoconfiguration_and_fix(self):
        device = fix = sky = None
        for report in self.gpsd.reports(PATIENCE):
            arrived = time.monotonic() - self.began
            if report["class"] in ("DEVICE", "DEVICES"):
                devices = report.get("devices", [report])
                device = next((d for d in devices if d.get("driver") == "u-blox"), device)
            if report["class"] == "TPV" and report.get("mode") == 3 and device:
                fix, fixed = report, arrived
            # Before gpsd has the receiver's NAV-SAT it makes a SKY of each group of GSV, the untracked satellites' too,
            # and each of one system.
            if report["class"] == "SKY" and any(s["used"] and s.get("gnssid") == 0 for s in report.get("satellites", [])):
                sky = report
            if device and device.get("subtype1") and fix and sky:
                break
        self.assertIsNotNone(device, "gpsd never saw a u-blox; expected its driver within 45 s")
        self.assertIsNotNone(fix, "no TPV of mode 3 after the u-blox driver took over")
        self.assertIsNotNone(sky, "no SKY with satellites")
        self.check_device(device)
        self.check_fix(fix, fixed)
        self.check_sky(sky)

    def check_device(self, device):
        self.assertEqual(device["bps"], self.board.speed)
        version = ".".join(f"{part:02}" if n else str(part) for n, part in enumerate(self.board.protocol))
        self.assertIn(f"PROTVER={version}", device.get("subtype1", ""))

    def check_fix(self, fix, fixed):
        told = datetime.datetime.strptime(fix["time"], "%Y-%m-%dT%H:%M:%S.%fZ")
        begun = datetime.datetime.strptime(receiver.START, "%Y-%m-%dT%H:%M:%SZ")
        self.assertAlmostEqual((told - begun).total_seconds(), fixed, delta=1.5,
                               msg="the time told, and seconds since the start: a report waits for its epoch's end")
        self.assertLess(receiver.metres_apart(fix["lat"], fix["lon"]), 20)
        self.assertAlmostEqual(fix["altHAE"], receiver.PLACE[2], delta=30)

    def check_sky(self, sky):
        satellites = sky["satellites"]
        used = [s for s in satellites if s["used"]]
        self.assertGreaterEqual(len(used), 5, satellites)
        for satellite in used:
            self.assertGreater(satellite["ss"], 15)
            self.assertGreaterEqual(satellite["el"], 0)
        known = {s["satellite"] for s in self.listing()}
        gps = {f"G{s['svid']:02}" for s in satellites if s.get("gnssid") == 0 and s["used"]}
        self.assertTrue(gps and gps <= known, f"{sorted(gps)} of {sorted(known)}")

    @staticmethod
    def listing():
        """The satellites that `skyloop sky` has above the place at the start."""
        return json.loads(receiver.skyloop("sky", "--at", ",".join(map(str, receiver.PLACE)), "--start", receiver.START,
                                           "--format", "json").stdout)["satellites"]


if __name__ == "__main__":
    if not shutil.which("gpsd"):
        receiver.skip("gpsd is not installed; apt-get install gpsd")
    GpsdConfigures.board = receiver.BOARDS[sys.argv.pop(1)]
    unittest.main(verbosity=2)
