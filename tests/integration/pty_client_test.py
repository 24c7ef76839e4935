"""A plain client on the pty: it comes, goes and comes back, sets a wrong speed, reads slowly or not at all."""
import os
import pathlib
import re
import select
import signal
import stat
import termios
import time
import tty as terminal
import unittest

from session import Emulator, open_folder

SENTENCE = re.compile(rb"^\$G[NPL][A-Z]{3},[\x20-\x7e]*\*[0-9A-F]{2}$")


def open_client(path, speed=None):
    """Opens the tty as a serial program does."""
    descriptor = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    terminal.setraw(descriptor)
    if speed is not None:
        attributes = termios.tcgetattr(descriptor)
        attributes[4] = attributes[5] = speed
        termios.tcsetattr(descriptor, termios.TCSANOW, attributes)
    return descriptor


def read_for(descriptor, seconds):
    """All bytes of some seconds."""
    data = b""
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0:
        if select.select([descriptor], [], [], left)[0]:
            data += os.read(descriptor, 65536)
    return data


def good_share(data):
    """The share of lines that are whole sentences."""
    lines = data.split(b"\r\n")[1:-1]
    return sum(bool(SENTENCE.match(line)) for line in lines) / max(1, len(lines))


class PtyClientTest(unittest.TestCase):
    def setUp(self):
        self.folder = open_folder()
        self.link = pathlib.Path(self.folder.name, "gps0")

    def tearDown(self):
        self.folder.cleanup()

    def emulator(self, *arguments):
        return Emulator("--port", f"pty:{self.link}", "--start", "2026-03-01T00:00:00Z", *arguments)

    def test_stable_path_appears_and_is_removed(self):
        with self.emulator() as emulator:
            self.assertEqual(emulator.tty, str(self.link))
            self.assertTrue(self.link.is_symlink())
            self.assertTrue(stat.S_ISCHR(os.stat(self.link).st_mode))
            self.assertEqual(emulator.stop(signal.SIGINT), 0, emulator.log)
        self.assertFalse(os.path.lexists(self.link))

    def test_client_comes_back_to_fresh_bytes(self):
        with self.emulator() as emulator:
            first = open_client(emulator.tty)
            self.assertGreater(good_share(read_for(first, 2.5)), 0.99)
            os.close(first)
            time.sleep(3)
            second = open_client(emulator.tty)
            data = read_for(second, 2.5)
            os.close(second)
            self.assertGreater(good_share(data), 0.99)
            # Three seconds passed unheard: the first time of day must be later than what was sent to nobody.
            times = [int(t) for t in re.findall(rb"GGA,(\d{6})\.", data)]
            self.assertGreaterEqual(times[0], 4)
            self.assertEqual(emulator.stop(), 0, emulator.log)
            unheard = int(re.search(r"(\d+) while nobody listened", emulator.log).group(1))
            self.assertGreater(unheard, 500)

    def test_wrong_speed_garbles_and_right_speed_heals(self):
        with self.emulator() as emulator:
            client = open_client(emulator.tty, termios.B38400)
            self.assertLess(good_share(read_for(client, 2.5)), 0.1)
            attributes = termios.tcgetattr(client)
            attributes[4] = attributes[5] = termios.B9600
            termios.tcsetattr(client, termios.TCSAFLUSH, attributes)
            read_for(client, 1.2)
            self.assertGreater(good_share(read_for(client, 2.5)), 0.99)
            os.close(client)
            self.assertEqual(emulator.stop(), 0, emulator.log)
            self.assertRegex(emulator.log, r"\d+ bytes went out garbled: the client's line speed was not the receiver's\n",
                             "whose speed may have been several")

    def test_bytes_keep_the_pace_of_the_line(self):
        with self.emulator() as emulator:
            client = open_client(emulator.tty)
            read_for(client, 1.0)
            # At 9600 baud a burst of some 500 bytes takes half a second: no quarter of a second may hold more than 240
            # bytes and what a late wake-up lets through.
            counts = [len(read_for(client, 0.25)) for _ in range(12)]
            os.close(client)
            self.assertLess(max(counts), 480)
            self.assertGreater(sum(counts), 900)

    def test_client_that_never_reads_stalls_nothing(self):
        with self.emulator("--duration", 8, "--speed", 8, "--rate", 5) as emulator:
            client = open_client(emulator.tty)
            began = time.monotonic()
            while emulator.process.poll() is None and time.monotonic() - began < 15:
                time.sleep(0.1)
            os.close(client)
            self.assertEqual(emulator.stop(), 0, emulator.log)
            self.assertIn("40 epochs", emulator.log)


if __name__ == "__main__":
    unittest.main(verbosity=2)
