"""The whole program, in real time, whose wire is pulled a thousand times: no epoch is lost, and nothing grows."""
import csv
import os
import pathlib
import select
import socket
import struct
import time
import unittest

from session import Emulator, held_by, open_folder

PULLS = 1000
RATE_HZ = 10
RUN = ("--board", "ublox-m9", "--rate", RATE_HZ, "--model", "ideal", "--start", "2026-03-01T00:00:00Z")
RESET = struct.pack("ii", 1, 0)  # SO_LINGER: closes with a reset


def first_bytes(readable, take):
    """Waits until something has come, or the other end has closed; gives it."""
    if not select.select([readable], [], [], 10)[0]:
        raise AssertionError("no byte within 10 s")
    return take()


def pull_pty(path):
    """A client that hears something and is gone."""
    descriptor = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    try:
        if not first_bytes(descriptor, lambda: os.read(descriptor, 65536)):
            raise AssertionError("the terminal has hung up")
    finally:
        os.close(descriptor)


def pull_tcp(address):
    """A connection that hears something and is reset."""
    host, port = address.rsplit(":", 1)
    with socket.create_connection((host, int(port)), timeout=10) as client:
        if not first_bytes(client, lambda: client.recv(65536)):
            raise AssertionError("turned away")
        client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, RESET)


def used(pid):
    """Resident kB and open descriptors of a process whose last client has gone: the fewest of a second."""
    resident, fewest = held_by(pid)
    for _ in range(20):
        time.sleep(0.05)
        fewest = min(fewest, held_by(pid)[1])
    return resident, fewest


class WireEnduranceTest(unittest.TestCase):
    def pulled(self, port, pull):
        with open_folder() as folder, Emulator("--port", port, "--record", folder, *RUN) as emulator:
            for i in range(PULLS):
                pull(emulator.tty)
                if i == PULLS // 10:
                    early, before = used(emulator.process.pid), time.monotonic()
            late, seconds = used(emulator.process.pid), time.monotonic() - before
            self.assertEqual(late[1], early[1], "descriptors")
            self.assertLess(late[0], early[0] + 4096, "resident kB")
            self.assertEqual(emulator.stop(), 0, emulator.log)
            with open(pathlib.Path(folder, "fixes.csv"), encoding="ascii") as file:
                times = [float(row["tow_s"]) for row in csv.DictReader(file)]
        self.assertGreater(len(times), seconds * RATE_HZ * 0.9)
        steps = {round((b - a) * RATE_HZ) for a, b in zip(times, times[1:])}
        self.assertEqual(steps, {1}, "an epoch is missing")

    def test_pty_client_is_gone_a_thousand_times(self):
        self.pulled("pty", pull_pty)

    def test_tcp_connection_is_reset_a_thousand_times(self):
        self.pulled("tcp:0", pull_tcp)


if __name__ == "__main__":
    unittest.main(verbosity=2)
