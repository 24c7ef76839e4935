"""A plain client on a TCP port: it reads at the receiver's pace, is killed, comes back, comes twice, or never reads."""
import os
import pathlib
import re
import select
import signal
import socket
import subprocess
import sys
import time
import unittest

from pty_client_test import good_share
from session import Emulator, open_folder, skyloop

START = "2026-03-01T00:00:00Z"
READER = """import socket, sys
s = socket.create_connection((sys.argv[1], int(sys.argv[2])))
while data := s.recv(4096):
    sys.stdout.buffer.write(data)
    sys.stdout.flush()
"""


def connect(address):
    """A connection to "host:port"."""
    host, port = address.rsplit(":", 1)
    return socket.create_connection((host.strip("[]"), int(port)), timeout=10)


def read_for(connection, seconds):
    """All bytes of some seconds, and whether the other end has closed."""
    data = b""
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0:
        if select.select([connection], [], [], left)[0]:
            try:
                piece = connection.recv(65536)
            except ConnectionResetError:
                piece = b""
            if not piece:
                return data, True
            data += piece
    return data, False


class TcpClientTest(unittest.TestCase):
    def emulator(self, *arguments):
        return Emulator("--port", "tcp:0", "--start", START, "--model", "ideal", *arguments)

    def test_client_is_killed_and_comes_back(self):
        with self.emulator() as emulator:
            host, port = emulator.tty.rsplit(":", 1)
            with subprocess.Popen([sys.executable, "-c", READER, host, port], stdout=subprocess.PIPE) as reader:
                first, _ = read_for_pipe(reader.stdout.fileno(), 3)
                reader.send_signal(signal.SIGKILL)
            self.assertGreater(first.count(b"GGA"), 0)
            time.sleep(1.5)
            with connect(emulator.tty) as client:
                data, closed = read_for(client, 3)
            self.assertFalse(closed)
            self.assertGreater(good_share(data), 0.99)
            later = [int(t) for t in re.findall(rb"GGA,(\d{6})\.", data)]
            self.assertGreater(later[0], int(re.findall(rb"GGA,(\d{6})\.", first)[-1]), "fresh bytes")
            self.assertEqual(emulator.stop(), 0, emulator.log)

    def test_bytes_keep_the_pace_of_the_uart(self):
        with self.emulator() as emulator, connect(emulator.tty) as client:
            read_for(client, 1.0)
            counts = [len(read_for(client, 0.25)[0]) for _ in range(12)]
            self.assertLess(max(counts), 480, "9600 baud: 240 bytes, and what a late wake-up lets through")
            self.assertGreater(sum(counts), 900)

    def test_commands_are_answered(self):
        with self.emulator() as emulator, connect(emulator.tty) as client:
            client.sendall(bytes.fromhex("b5620a0400000e34"))  # a poll of MON-VER
            self.assertIn(bytes.fromhex("b5620a04"), read_for(client, 3)[0])

    def test_time_waits_for_a_client(self):
        with self.emulator("--wait-for-client", "--duration", 2, "--speed", 2) as emulator:
            time.sleep(1.5)
            self.assertIsNone(emulator.process.poll(), "nobody has come yet")
            with connect(emulator.tty) as client:
                data, closed = read_for(client, 20)
            self.assertTrue(closed)
            self.assertIn(b"GGA,000000.", data, "the first epoch, though long ago")
            self.assertEqual(emulator.finish(), 0, emulator.log)
            self.assertIn(" 0 while nobody listened", emulator.log)

    def test_waiting_ends_with_a_signal(self):
        with self.emulator("--wait-for-client") as emulator:
            emulator.said(r"(waiting for a client)")
            self.assertEqual(emulator.stop(), 0, emulator.log)

    def test_a_second_client_is_closed_and_told_of(self):
        with self.emulator() as emulator, connect(emulator.tty) as first:
            self.assertFalse(read_for(first, 1.2)[1])
            with connect(emulator.tty) as second:
                self.assertEqual(read_for(second, 5), (b"", True))
            self.assertFalse(read_for(first, 1.2)[1])
            self.assertEqual(emulator.stop(), 0)
            self.assertIn("1 more client came while one was connected", emulator.log)

    def test_client_that_never_reads_stalls_nothing(self):
        with self.emulator("--duration", 8, "--speed", 8, "--rate", 5) as emulator, connect(emulator.tty):
            self.assertEqual(emulator.finish(15), 0, emulator.log)
            self.assertIn("40 epochs", emulator.log)

    def test_an_address_that_is_taken_is_one_line(self):
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            done = skyloop("run", "--port", f"tcp:{taken.getsockname()[1]}", check=False)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr.splitlines()[-1], r": cannot be listened at: Address already in use$")

    def test_a_full_disk_is_one_line_and_keeps_the_recording(self):
        with open_folder() as folder:
            done = skyloop("run", "--port", "file:/dev/full", "--record", folder, "--speed", "max", "--duration", 20, "--start",
                           START, "--model", "ideal", check=False)
            recorded = pathlib.Path(folder, "port0.out").read_bytes()
        self.assertEqual(recorded.count(b"GGA"), 20)
        self.assertEqual(done.returncode, 1)
        failures = [line for line in done.stderr.splitlines() if "No space left" in line]
        self.assertEqual(len(failures), 1, done.stderr)
        self.assertIn("20 epochs", done.stderr, "the run went on")


def read_for_pipe(descriptor, seconds):
    """As read_for(), of a pipe."""
    data = b""
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0:
        if select.select([descriptor], [], [], left)[0]:
            piece = os.read(descriptor, 65536)
            if not piece:
                return data, True
            data += piece
    return data, False


if __name__ == "__main__":
    unittest.main(verbosity=2)
