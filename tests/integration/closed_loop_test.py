"""A simulator flies on the position that it decodes from our port: in lock-step to the bit, in real time without swinging."""
import math
import os
import pathlib
import socket
import sys
import termios
import tty
import unittest

from session import ROOT, Emulator, open_folder

sys.path.insert(0, str(ROOT / "examples/python"))
import point_mass  # noqa: E402

# Of the truth's square 60 m wide, with 5 m given away at its corners and a receiver that is some metres off.
FARTHEST_FROM_MIDDLE = math.hypot(30, 30) + 20


def free_port(kind):
    with socket.socket(socket.AF_INET, kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def scenario(folder, source, clock, link):
    path = pathlib.Path(folder) / "loop.toml"
    path.write_text(f"""[run]
start = 2024-03-05T12:00:00Z
seed = 5
[trajectory]
kind = "live"
source = "{source}"
clock = "{clock}"
when_lost = "stop"
lost_after_s = 5
[[receiver]]
board = "ublox-m8"
rate_hz = 5
baud = 115200
port = "pty:{link}"
""")
    return path


def open_tty(path):
    fd = os.open(path, os.O_RDWR | os.O_NOCTTY)
    tty.setraw(fd)
    settings = termios.tcgetattr(fd)
    settings[4] = settings[5] = termios.B115200
    termios.tcsetattr(fd, termios.TCSANOW, settings)
    return fd


class ClosedLoop(unittest.TestCase):
    def fly_in_steps(self, steps):
        port = free_port(socket.SOCK_STREAM)
        with open_folder() as folder:
            link = pathlib.Path(folder) / "gps"
            with Emulator(scenario(folder, f"tcp-json:{port}", "lock_step", link)) as emulator:
                fd = open_tty(emulator.tty)
                try:
                    flown = point_mass.fly_in_steps(("127.0.0.1", port), fd, steps)
                    self.assertEqual(emulator.finish(patience=30), 0, emulator.log)
                finally:
                    os.close(fd)
        return flown

    def test_in_lock_step_every_run_is_the_same_to_the_bit(self):
        path, heard, ears, mass = self.fly_in_steps(1500)
        again, heard_again, _, _ = self.fly_in_steps(1500)
        self.assertGreater(ears.fixes, 100)
        self.assertGreaterEqual(mass.corner + 4 * mass.laps, 2, "it got somewhere")
        self.assertEqual(path, again)
        self.assertEqual(heard, heard_again)
        self.assertLess(max(math.hypot(n - 30, e - 30) for n, e in path), FARTHEST_FROM_MIDDLE)

    def test_in_real_time_it_stays_on_its_square(self):
        seconds = float(os.environ.get("SKYLOOP_LOOP_SECONDS", "25"))
        port = free_port(socket.SOCK_DGRAM)
        with open_folder() as folder:
            link = pathlib.Path(folder) / "gps"
            with Emulator(scenario(folder, f"udp-json:{port}", "realtime", link)) as emulator:
                fd = open_tty(emulator.tty)
                try:
                    path, ears, mass = point_mass.fly_in_real_time(("127.0.0.1", port), fd, seconds)
                    self.assertEqual(emulator.stop(), 0, emulator.log)
                finally:
                    os.close(fd)
        print(emulator.log[-600:], f"fixes {ears.fixes}, laps {mass.laps}")
        self.assertGreater(ears.fixes, seconds * 3)
        self.assertGreaterEqual(mass.corner + 4 * mass.laps, 2, "it got somewhere")
        self.assertLess(max(math.hypot(n - 30, e - 30) for n, e in path), FARTHEST_FROM_MIDDLE)


if __name__ == "__main__":
    unittest.main()
