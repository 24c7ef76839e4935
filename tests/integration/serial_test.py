"""A serial line: an autopilot on the far side of a pseudo-terminal pair reads, configures, is unplugged and comes back."""
import fcntl
import os
import pathlib
import pty
import select
import struct
import termios
import time
import unittest

from pty_client_test import good_share
from session import Emulator, open_folder, skyloop
from ubx_frames import ubx

START = "2026-03-01T00:00:00Z"
TCGETS2 = 0x802C542A  # <asm-generic/ioctls.h>; struct termios2: four words, line, 19 characters, two speeds


def port_settings(baud):
    """CFG-PRT of UART1: 8N1, UBX and NMEA both ways."""
    return ubx((0x06, 0x00), struct.pack("<BBHIIHHHH", 1, 0, 0, 0x8D0, baud, 3, 3, 0, 0))


class Autopilot:
    """Holds the master side; the terminal side, under a link, is the device that the emulator opens."""

    def __init__(self, link):
        self.link = link
        self.plug_in()

    def plug_in(self):
        self.master, self.device = pty.openpty()
        os.symlink(os.ttyname(self.device), self.link)

    def unplug(self):
        os.unlink(self.link)
        os.close(self.device)
        os.close(self.master)

    def speed(self):
        settings = fcntl.ioctl(self.master, TCGETS2, bytes(44))
        return struct.unpack("<I", settings[40:44])[0]

    def write(self, data):
        os.write(self.master, data)

    def read_for(self, seconds, until=None):
        """All bytes of some seconds, or up to a sign."""
        data = b""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0 and (until is None or until not in data):
            if select.select([self.master], [], [], left)[0]:
                data += os.read(self.master, 65536)
        return data


class SerialTest(unittest.TestCase):
    def setUp(self):
        self.folder = open_folder()
        self.autopilot = Autopilot(pathlib.Path(self.folder.name, "autopilot"))

    def tearDown(self):
        self.autopilot.unplug()
        self.folder.cleanup()

    def emulator(self, options="", *arguments):
        return Emulator("--port", f"serial:{self.autopilot.link}{options}", "--start", START, "--model", "ideal", *arguments)

    def test_the_line_has_the_speed_that_the_client_configures(self):
        with self.emulator() as emulator:
            self.assertEqual(emulator.tty, str(self.autopilot.link))
            self.assertIn(b"GGA", self.autopilot.read_for(10, b"GGA"))
            self.assertEqual(self.autopilot.speed(), 9600, "the receiver's own")
            self.autopilot.write(port_settings(115200))
            self.assertIn(bytes.fromhex("b56205010200"), self.autopilot.read_for(5, bytes.fromhex("b56205010200")))
            self.autopilot.read_for(0.2)
            self.assertEqual(self.autopilot.speed(), 115200)
            self.assertGreater(good_share(self.autopilot.read_for(2.2)), 0.9)
            self.assertEqual(emulator.stop(), 0, emulator.log)

    def test_unplugged_and_back(self):
        with self.emulator("@57600") as emulator:
            self.assertIn(b"GGA", self.autopilot.read_for(10, b"GGA"))
            self.assertEqual(self.autopilot.speed(), 57600)
            self.autopilot.unplug()
            emulator.said(r"(autopilot is gone; it is looked for)")
            self.autopilot.plug_in()
            emulator.said(r"(autopilot is back, as )")
            self.assertIn(b"GGA", self.autopilot.read_for(10, b"GGA"))
            self.assertEqual(self.autopilot.speed(), 57600)
            self.assertEqual(emulator.stop(), 0, emulator.log)
            for told in ("is gone", "is back"):
                self.assertEqual(emulator.log.count(told), 1, emulator.log)

    def test_old_settings_are_put_back(self):
        before = termios.tcgetattr(self.autopilot.device)
        with self.emulator() as emulator:
            self.autopilot.read_for(10, b"GGA")
            self.assertNotEqual(termios.tcgetattr(self.autopilot.device), before)
            self.assertEqual(emulator.stop(), 0, emulator.log)
        self.assertEqual(termios.tcgetattr(self.autopilot.device), before)

    def test_what_is_held_or_wrong_is_one_line(self):
        fcntl.flock(self.autopilot.device, fcntl.LOCK_EX)
        for port, code, text in ((self.autopilot.link, 1, r"another program holds it \(flock\)$"),
                                 ("/dev/no-such-tty", 1, "No such file or directory$"), ("/dev/null", 1, "is no serial line"),
                                 ("/dev/null@fast", 2, "the speed 'fast' is not understood")):
            done = skyloop("run", "--port", f"serial:{port}", "--duration", 1, check=False)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertRegex(done.stderr.splitlines()[-1], text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
