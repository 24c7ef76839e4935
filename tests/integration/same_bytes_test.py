"""One scenario with faults gives the same bytes on a pty, a TCP port and in a file, live beside two busy neighbours, as
`simulate` gives; again and again.

SKYLOOP_SAME_BYTES_TIMES is how often, ten times unless it says otherwise.
"""
import os
import pathlib
import select
import subprocess
import sys
import threading
import unittest

from pty_client_test import open_client
from session import Emulator, open_folder, skyloop
from tcp_client_test import connect

TIMES = int(os.environ.get("SKYLOOP_SAME_BYTES_TIMES", "10"))
SIMULATED_S = 24
SPEED = 12

# Faults of all four layers, drawn times and drawn damage among them. The model measures, so that the noise counts too.
SCENARIO = f"""[run]
start = 2026-03-01T00:00:00Z
duration_s = {SIMULATED_S}
seed = 11
[[receiver]]
board = "ublox-m8"
rate_hz = 2
[[fault]]
kind = "outage"
at_s = 12
for_s = 3
[[fault]]
kind = "freeze"
between_s = [5, 8]
for_s = 2
[[fault]]
kind = "byte_loss"
at_s = 9
for_s = 6
probability = 0.02
[[fault]]
kind = "bit_flips"
between_s = [3, 6]
for_between_s = [2, 8]
probability = 0.001
[[fault]]
kind = "wire_jitter"
at_s = 15.5
for_s = 4
[[fault]]
kind = "duplicate_messages"
at_s = 16
for_s = 4
[[fault]]
kind = "stall"
at_s = 21
for_s = 1
[[fault]]
kind = "receiver_silent"
at_s = 18
for_s = 2
"""


class Reader(threading.Thread):
    """Reads a descriptor until its other end has closed."""

    def __init__(self, descriptor):
        super().__init__(daemon=True)
        self.descriptor, self.data = descriptor, b""
        self.start()

    def run(self):
        while True:
            select.select([self.descriptor], [], [], 60)
            try:
                piece = os.read(self.descriptor, 65536)
            except BlockingIOError:
                return  # a minute of nothing
            except OSError:
                return
            if not piece:
                return
            self.data += piece


class SameBytesTest(unittest.TestCase):
    def setUp(self):
        self.folder = open_folder()
        self.path = pathlib.Path(self.folder.name)
        (self.path / "faults.toml").write_text(SCENARIO)
        self.neighbours = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2)]

    def tearDown(self):
        for neighbour in self.neighbours:
            neighbour.kill()
            neighbour.wait(20)
        self.folder.cleanup()

    def emulator(self, port):
        return Emulator(self.path / "faults.toml", "--port", port, "--speed", SPEED, "--record", self.path / port.split(":")[0],
                        "--wait-for-client")

    def live(self):
        """The bytes of a live run on each wire, at the same time: read from the pty, from the TCP port and in the file."""
        out = self.path / "out"
        with self.emulator("pty") as on_pty, self.emulator("tcp:0") as on_tcp, self.emulator(f"file:{out}") as on_file:
            terminal = open_client(on_pty.tty)
            with connect(on_tcp.tty) as connection:
                readers = [Reader(terminal), Reader(connection.fileno())]
                for emulator in (on_pty, on_tcp, on_file):
                    self.assertEqual(emulator.finish(60), 0, emulator.log)
                    self.assertNotIn("lost", emulator.log)
                for reader in readers:
                    reader.join(20)
            os.close(terminal)
        return {"pty": readers[0].data, "tcp": readers[1].data, "file": out.read_bytes()}

    def test_everywhere_and_again(self):
        skyloop("simulate", self.path / "faults.toml", "--out", self.path / "simulated")
        expected = (self.path / "simulated/port0.out").read_bytes()
        for number in range(TIMES):
            with self.subTest(run=number):
                seen = self.live()
                for wire, data in seen.items():
                    self.assertEqual((self.path / wire / "port0.out").read_bytes(), expected, f"what was sent on {wire}")
                    # A terminal that is closed takes with it what its client has not read yet.
                    self.assertGreater(len(data), len(expected) - (4096 if wire == "pty" else 1), wire)
                    self.assertEqual(data, expected[:len(data)], wire)
        print(f"{TIMES} times {len(expected)} bytes, the same on pty, tcp and file")


if __name__ == "__main__":
    unittest.main(verbosity=2)
