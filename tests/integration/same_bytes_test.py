"""One scenario with faults gives the same bytes on a pty, a TCP port and in a file, live beside two busy neighbours, as
`simulate` gives; again and again. With a scripted client it does so on every board, at any speed of the run.

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
from session import SKYLOOP, Emulator, open_folder, skyloop
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


# A client that hunts the speed, configures and answers, and faults that make it begin anew.
CLIENT_SCENARIO = """[run]
start = 2026-03-01T00:00:00.003Z
duration_s = 16
seed = 11
[model]
name = "ideal"
[[receiver]]
board = "{board}"
port = "client:{client}"
[[fault]]
kind = "reboots"
start = "cold"
at_s = 8.0125
[[fault]]
kind = "bit_flips"
at_s = 5
for_s = 2
probability = 0.001
"""
CLIENTS = ("careful-ubx", "naive-ubx", "careful-nmea", "naive-nmea")


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


class ScriptedClientTest(unittest.TestCase):
    def setUp(self):
        self.folder = open_folder()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def bytes_of(self, name, out):
        return [(self.path / f"{name}-{out}/port0.{way}").read_bytes() for way in ("in", "out")]

    def compare(self, names, speed):
        """Live runs, a dozen at a time, against those in virtual time."""
        runs = [subprocess.Popen([SKYLOOP, "run", self.path / f"{name}.toml", "--speed", str(speed), "--record",
                                  self.path / f"{name}-{speed}"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                 stderr=subprocess.PIPE, text=True) for name in names]
        for name, run in zip(names, runs):
            _, log = run.communicate(timeout=60)
            with self.subTest(name, speed=speed):
                self.assertEqual(run.returncode, 0, log)
                self.assertEqual(self.bytes_of(name, speed), self.bytes_of(name, "simulated"))

    def test_every_board_at_any_speed(self):
        """What both ends send is the same in virtual time, at twenty times and at one and a half times the clock's pace."""
        boards = [line.split()[0] for line in skyloop("boards").stdout.splitlines() if line and line[0] != " "]
        self.assertGreaterEqual(len(boards), 12)
        names = []
        for board in boards:
            for client in CLIENTS:
                name = f"{board}-{client}"
                (self.path / f"{name}.toml").write_text(CLIENT_SCENARIO.format(board=board, client=client))
                names.append(name)
        for name in names:
            skyloop("simulate", self.path / f"{name}.toml", "--out", self.path / f"{name}-simulated", "--quiet")
        for speed, some in ((20, names), (1.5, names[::5])):
            for first in range(0, len(some), 12):
                self.compare(some[first:first + 12], speed)
        talked = [name for name in names if self.bytes_of(name, "simulated")[0]]
        self.assertGreaterEqual(len(talked), len(boards) * 2, "the two clients that speak, on each board")


if __name__ == "__main__":
    unittest.main(verbosity=2)
