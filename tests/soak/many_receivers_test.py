"""Sixteen receivers in real time, whose clients leave and come back again and again: all they hear is whole, every epoch is there,
and neither memory nor open files grow.

SKYLOOP_SOAK_SECONDS: how long; 30 by default."""
import csv
import json
import os
import pathlib
import random
import re
import select
import socket
import termios
import time
import tty
import unittest

from growth import Growth, open_folder, skyloop
from session import Emulator

SECONDS = int(os.environ.get("SKYLOOP_SOAK_SECONDS", "30"))
RECEIVERS, ON_TCP = 16, 4  # the last ones
BOARDS = ("ublox-m8", "ublox-m9", "ublox-m10", "ublox-f9p", "nmea-generic", "mtk3339", "airoha-ag33xx", "ublox-6")
RATES_HZ = (5, 10, 10, 10, 1, 1, 5, 5)  # what the lines can carry
BAUD = 230400
LONGEST_MESSAGE = 2000  # bytes


def scenario():
    """What happens to them, and the receivers."""
    text = pathlib.Path(__file__).with_name("many.toml").read_text(encoding="ascii")
    for i in range(RECEIVERS):
        port = "tcp:127.0.0.1:0" if i >= RECEIVERS - ON_TCP else "pty"
        text += f'\n[[receiver]]\nname = "r{i}"\nboard = "{BOARDS[i % len(BOARDS)]}"\n'
        text += f'rate_hz = {RATES_HZ[i % len(BOARDS)]}\nbaud = {BAUD}\nport = "{port}"\n'
    return text


class Client:
    """Stays for some seconds, leaves, and is back at once."""

    def __init__(self, address, draw):
        self.address, self.draw = address, draw
        self.visits, self.total, self.longest_silence = 0, 0, 0.0
        self.come()

    def come(self):
        self.heard, self.visits = b"", self.visits + 1
        if self.address.startswith("/"):
            self.line = os.open(self.address, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
            tty.setraw(self.line)
            flags = termios.tcgetattr(self.line)
            flags[4] = flags[5] = getattr(termios, f"B{BAUD}")
            termios.tcsetattr(self.line, termios.TCSANOW, flags)
        else:
            host, port = self.address.rsplit(":", 1)
            self.line = socket.create_connection((host, int(port)), timeout=10).detach()
        self.last = time.monotonic()
        self.until = self.last + self.draw.uniform(2, 20)

    def take(self):
        """Hears what is there."""
        piece, now = os.read(self.line, 65536), time.monotonic()
        if not piece:
            raise AssertionError(f"{self.address} hung up")
        self.longest_silence = max(self.longest_silence, now - self.last)
        self.heard, self.total, self.last = self.heard + piece, self.total + len(piece), now

    def leave(self):
        """Gives what this visit heard."""
        os.close(self.line)
        return self.heard


def wrong_in(heard, folder):
    """What `decode` finds wrong with what one visit heard: its first and its last message may be cut, and no more."""
    path = pathlib.Path(folder, "heard.bin")
    path.write_bytes(heard)
    told = skyloop("decode", path).stderr
    frames = sum(map(int, re.findall(r"(\d+) frames", told)))
    bad = sum(map(int, re.findall(r"(\d+) bad", told)))
    skipped = int(re.search(r"(\d+) of \d+ bytes skipped", told)[1])
    return told if frames < 2 or bad > 1 or skipped > LONGEST_MESSAGE else ""


class ManyReceivers(unittest.TestCase):
    def visit(self, emulator, clients, watch, folder):
        """Until the time is over: clients come and go, one visit in ten is decoded."""
        end, next_look, decoded = time.monotonic() + SECONDS, 0.0, 0
        while time.monotonic() < end:
            for line in select.select([client.line for client in clients], [], [], 0.1)[0]:
                next(client for client in clients if client.line == line).take()
            now = time.monotonic()
            if now >= next_look:
                watch.look()
                emulator.listen()
                next_look = now + SECONDS / 500
            for client in clients:
                if now < client.until:
                    continue
                heard = client.leave()
                if client.draw.random() < 0.1:
                    self.assertEqual(wrong_in(heard, folder), "", client.address)
                    decoded += 1
                client.come()
        return decoded

    def test_clients_come_and_go(self):
        draw = random.Random(1)
        with open_folder() as folder:
            path = pathlib.Path(folder, "many.toml")
            path.write_text(scenario(), encoding="ascii")
            with Emulator(path, "--record", pathlib.Path(folder, "run")) as emulator:
                clients = [Client(emulator.port(0, f"r{i}"), draw) for i in range(RECEIVERS)]
                watch = Growth(emulator.process.pid)
                decoded = self.visit(emulator, clients, watch, folder)
                for client in clients:
                    client.leave()
                self.assertEqual(emulator.stop(), 0, emulator.log)
            run = json.loads(pathlib.Path(folder, "run", "run.json").read_text())
            print(f"{SECONDS} s, {sum(c.visits for c in clients)} visits, {decoded} of them decoded, "
                  f"{sum(c.total for c in clients)} bytes heard; longest silence "
                  f"{max(c.longest_silence for c in clients):.1f} s; {watch}; lateness {run['lateness']['mean_ms']:.3f} ms "
                  f"on average, {run['lateness']['largest_ms']:.1f} ms at worst", flush=True)
            self.assertEqual(watch.fault(), "")
            self.whole(pathlib.Path(folder, "run"))

    def whole(self, folder):
        """No receiver misses an epoch."""
        tables = sorted(folder.rglob("fixes*.csv"))
        self.assertEqual(len(tables), RECEIVERS)
        for table in tables:
            with open(table, encoding="ascii") as file:
                times = [float(row["tow_s"]) for row in csv.DictReader(file)]
            self.assertGreater(len(times), SECONDS // 2)
            steps = sorted(b - a for a, b in zip(times, times[1:]) if b > a)
            self.assertLess(steps[-1], 1.5 * steps[0], f"{table}: an epoch is missing")


if __name__ == "__main__":
    unittest.main(verbosity=2)
