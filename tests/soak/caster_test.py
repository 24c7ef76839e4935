"""A base's caster with two hundred clients that come and go, among them some that do not read, that know no password, that ask for
nothing that there is, or say anything at all: whoever reads hears whole messages, and neither memory nor open files grow.

SKYLOOP_SOAK_SECONDS: how long; 30 by default."""
import base64
import json
import os
import pathlib
import random
import selectors
import socket
import time
import unittest

from growth import Growth, open_folder, skyloop
from session import Emulator

SECONDS = int(os.environ.get("SKYLOOP_SOAK_SECONDS", "30"))
READERS, SLOW = 180, 15  # fewer than the caster takes
BASE = pathlib.Path(__file__).with_name("caster.toml")
BASIC = base64.b64encode(b"rover:secret").decode()
NONSENSE = (b"GET /base HTTP/1.1\r\nAuthorization: Basic cm92ZXI6d3Jvbmc=\r\n\r\n", b"GET /nothing HTTP/1.0\r\n\r\n", b"\x00" * 100,
            b"SOURCE secret /base\r\n\r\n", b"GET /base HTTP/1.1\r\nA: " + b"a" * 9000, b"GET / HTTP/1.0\r\n\r\n", b"G")
POSITION = b"$GPGGA,092725.00,4717.11399,N,00833.91590,E,1,08,1.01,499.6,M,48.0,M,,*5B\r\n"


def request(version):
    more = "Host: a\r\nNtrip-Version: Ntrip/2.0\r\n" if version == 2 else ""
    return f"GET /base HTTP/1.{version - 1}\r\n{more}Authorization: Basic {BASIC}\r\n\r\n".encode()


class Reader:
    """Stays for some seconds, and may tell where it is."""

    def __init__(self, port, draw):
        self.port, self.draw, self.total, self.visits, self.kept = port, draw, 0, 0, b""
        self.come()

    def come(self):
        self.version, self.heard, self.keeps = self.draw.choice((1, 2)), b"", self.draw.random() < 0.05
        self.socket = socket.create_connection(("127.0.0.1", self.port), timeout=20)
        self.socket.sendall(request(self.version))
        self.socket.setblocking(False)
        self.visits += 1
        self.until = time.monotonic() + self.draw.uniform(3, 15)

    def take(self):
        piece = self.socket.recv(65536)
        if not piece:
            raise AssertionError(f"the caster hung up on a client that reads: {self.heard[-200:]!r}")
        self.total += len(piece)
        if self.keeps or len(self.heard) < 100:
            self.heard += piece
        if self.draw.random() < 0.01:
            self.socket.send(POSITION)

    def leave(self):
        self.socket.close()
        if self.keeps and self.version == 1:
            self.kept = self.heard.split(b"\r\n\r\n", 1)[-1]


class Caster(unittest.TestCase):
    def nonsense(self, port, draw):
        with socket.create_connection(("127.0.0.1", port), timeout=20) as stranger:
            stranger.sendall(draw.choice(NONSENSE))
            if draw.random() < 0.5:
                stranger.settimeout(0.05)
                try:
                    stranger.recv(4096)
                except OSError:
                    pass

    def slow_ones(self, port):
        slow = []
        for _ in range(SLOW):
            one = socket.socket()
            one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            one.connect(("127.0.0.1", port))
            one.sendall(request(2))
            slow.append(one)
        return slow

    def visit(self, emulator, port, readers, watch):
        draw, end, look_at = random.Random(2), time.monotonic() + SECONDS, 0.0
        chosen = selectors.DefaultSelector()
        for reader in readers:
            chosen.register(reader.socket, selectors.EVENT_READ, reader)
        slow, renew_at = self.slow_ones(port), time.monotonic() + 60
        while time.monotonic() < end:
            for key, _ in chosen.select(0.05):
                key.data.take()
            now = time.monotonic()
            if now >= look_at:
                watch.look()
                emulator.listen()
                look_at = now + SECONDS / 500
                self.nonsense(port, draw)
            if now >= renew_at:
                for one in slow:
                    one.close()
                slow, renew_at = self.slow_ones(port), now + 60
            for reader in readers:
                if now >= reader.until:
                    chosen.unregister(reader.socket)
                    reader.leave()
                    reader.come()
                    chosen.register(reader.socket, selectors.EVENT_READ, reader)
        for one in slow:
            one.close()

    def test_clients_come_and_go(self):
        draw = random.Random(1)
        with open_folder() as folder:
            with Emulator(BASE, "--record", pathlib.Path(folder, "run")) as emulator:
                port = int(emulator.said(r"^caster: 127\.0\.0\.1:(\d+) \("))
                readers = [Reader(port, draw) for _ in range(READERS)]
                watch = Growth(emulator.process.pid)
                self.visit(emulator, port, readers, watch)
                for reader in readers:
                    reader.leave()
                self.assertEqual(emulator.stop(), 0, emulator.log)
            run = json.loads(pathlib.Path(folder, "run", "run.json").read_text(encoding="ascii"))
            caster = run["caster"]
            print(f"{SECONDS} s, {sum(r.visits for r in readers)} visits, {sum(r.total for r in readers)} bytes heard; {caster}; "
                  f"{watch}; lateness {run['lateness']['mean_ms']:.3f} ms on average, "
                  f"{run['lateness']['largest_ms']:.1f} ms at worst", flush=True)
            self.assertEqual(watch.fault(), "")
            self.assertGreaterEqual(caster["served"], READERS + SLOW)
            self.assertGreater(caster["refused"], 10)
            self.assertTrue(all(reader.total > 0 for reader in readers))
            kept = [reader.kept for reader in readers if len(reader.kept) > 2000]
            self.assertTrue(kept)
            for heard in kept:
                self.whole(heard, folder)

    def whole(self, heard, folder):
        """Nothing but messages: the last one may be cut."""
        path = pathlib.Path(folder, "heard.rtcm")
        path.write_bytes(heard)
        lines = [json.loads(line) for line in skyloop("decode", "--format", "json", path).stdout.splitlines()]
        noise = [line for line in lines if line.get("protocol", "rtcm3") != "rtcm3"]
        self.assertLessEqual(len(noise), 1, noise)


if __name__ == "__main__":
    unittest.main(verbosity=2)
