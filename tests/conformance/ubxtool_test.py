"""ubxtool of gpsd on the tty itself: ubxtool_test.py BOARD. Version, keys got, set and deleted on every layer."""
import os
import re
import shutil
import subprocess
import sys
import unittest

import receiver

ENABLED = "CFG-NAVSPG-DYNMODEL"


class Ubxtool(unittest.TestCase):
    board = None

    def setUp(self):
        folder = receiver.open_folder()
        self.addCleanup(folder.cleanup)
        self.emulator = receiver.start(self.board, folder.name)
        self.addCleanup(self.finish)
        receiver.wait_for_sentences(self.board, self.emulator.tty)

    def finish(self):
        code = self.emulator.stop()
        print(self.emulator.log, file=sys.stderr)
        self.assertEqual(code, 0)

    def ubxtool(self, *arguments, wait=2.5):
        """What ubxtool prints."""
        version = f"{self.board.protocol[0]}.{self.board.protocol[1]:02}"
        command = ["ubxtool", "-f", os.path.realpath(self.emulator.tty), "-s", str(self.board.speed), "-P", version,
                   "-v", "2", "-w", str(wait), *arguments]
        done = subprocess.run(command, capture_output=True, text=True, timeout=40)
        self.assertEqual(done.returncode, 0, f"{' '.join(command)}: {done.stderr or done.stdout}")
        return done.stdout

    def values(self, text, name=ENABLED):
        """The values of a key in the CFG-VALGET answers of a text."""
        answers = re.split(r"^(?=UBX-)", text, flags=re.MULTILINE)
        return [int(found) for answer in answers if answer.startswith("UBX-CFG-VALGET")
                for found in re.findall(rf"item {name}/\S* val (-?\d+)", answer)]

    def test_version(self):
        text = self.ubxtool("-p", "MON-VER")
        self.assertIn("UBX-MON-VER", text)
        self.assertIn({8: "00080000", 9: "00190000", 10: "000A0000"}[self.board.generation], text)
        self.assertIn("FWVER=", text)
        self.assertIn(f"PROTVER={self.board.protocol[0]}.{self.board.protocol[1]:02}", text)

    def test_each_layer(self):
        """4 to flash, 3 to BBR, 2 to RAM: each layer has its own, the default stays; deleted, only RAM has one."""
        flash = [(4, 2, 4)] if self.board.has_flash else []  # as a mask, as a number, its value
        layers = flash + [(2, 1, 3), (1, 0, 2)]
        for layer, _, value in layers:
            text = self.ubxtool("-z", f"{ENABLED},{value},{layer}")
            self.assertIn("UBX-ACK-ACK", text, f"layer {layer}")
        for layer, value in [(number, value) for _, number, value in layers] + [(7, 0)]:
            text = self.ubxtool("-g", f"{ENABLED},{layer}")
            self.assertEqual(self.values(text), [value], f"layer {layer}: {text}")
        if not flash:  # ubxtool deletes from battery and flash at once
            self.assertIn("UBX-ACK-NAK", self.ubxtool("-x", ENABLED))
            return
        self.assertIn("UBX-ACK-ACK", self.ubxtool("-x", ENABLED))
        for layer in (1, 2):
            text = self.ubxtool("-g", f"{ENABLED},{layer}")
            self.assertIn("UBX-ACK-NAK", text, f"layer {layer}")
            self.assertEqual(self.values(text), [])
        self.assertEqual(self.values(self.ubxtool("-g", f"{ENABLED},0")), [2])

    def test_group(self):
        """Of all layers, as ubxtool asks without one: RAM and the defaults have every item."""
        text = self.ubxtool("-g", "CFG-RATE")
        for name, value in (("CFG-RATE-MEAS", 1000), ("CFG-RATE-NAV", 1), ("CFG-RATE-TIMEREF", 1)):
            self.assertEqual(self.values(text, name), [value, value], text)


if __name__ == "__main__":
    if not shutil.which("ubxtool") or subprocess.run(["ubxtool", "-V"], capture_output=True, check=False).returncode:
        receiver.skip("ubxtool is not installed; apt-get install gpsd python3-gps")
    if subprocess.run(["/usr/bin/python3", "-c", "import serial"], capture_output=True, check=False).returncode:
        receiver.skip("ubxtool cannot open a tty; apt-get install python3-serial")
    Ubxtool.board = receiver.BOARDS[sys.argv.pop(1)]
    unittest.main(verbosity=2)
