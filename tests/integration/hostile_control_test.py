"""A live run whose control port is attacked from its first second to its last: each attack is refused in one clear line
or bounded, and no epoch is missing at the end."""
import base64
import csv
import json
import os
import pathlib
import random
import socket
import struct
import threading
import time
import unittest

from session import Emulator, open_folder
from session import skyloop as run_to_end

RATE_HZ = 10
TOKEN = "open-sesame"
SCENARIO = f"""[run]
start = 2024-03-05T12:00:00Z
[model]
name = "baseline"
[[receiver]]
rate_hz = {RATE_HZ}
"""
FIN, TEXT, CONTINUATION = 0x80, 0x1, 0x0


def frame(opcode, payload=b"", mask=True, length=None):
    """A WebSocket frame (RFC 6455, section 5.2); `length` is what its header claims."""
    claimed = len(payload) if length is None else length
    bit = 0x80 if mask else 0
    head = bytes([opcode])
    if claimed < 126:
        head += bytes([bit | claimed])
    elif claimed < 65536:
        head += bytes([bit | 126]) + struct.pack(">H", claimed)
    else:
        head += bytes([bit | 127]) + struct.pack(">Q", claimed)
    return head + (b"\0\0\0\0" if mask else b"") + payload  # a mask of zeros leaves the payload as it is


class HostileControlTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = open_folder()
        path = pathlib.Path(cls.folder.name)
        scenario = path / "run.toml"
        scenario.write_text(SCENARIO)
        cls.recording = path / "recording"
        # Off loopback, where a token is wanted.
        cls.run_under_attack = Emulator(scenario, "--port", "pty", "--record", cls.recording, "--control", "0.0.0.0:0",
                                        "--token", TOKEN)
        cls.port = int(cls.run_under_attack.said(r"^control: http://0\.0\.0\.0:(\d+)/"))
        cls.started = time.monotonic()
        cls.loris = threading.Thread(target=cls.dawdle)
        cls.loris_s = None
        cls.loris.start()

    @classmethod
    def dawdle(cls):
        """A request that never ends, a line now and then, until the server hangs up."""
        with socket.create_connection(("127.0.0.1", cls.port), timeout=5) as client:
            begun = time.monotonic()
            try:
                client.sendall(b"GET /api/status HTTP/1.1\r\n")
                while time.monotonic() < begun + 30:
                    client.sendall(b"X: y\r\n")
                    time.sleep(0.2)
            except ConnectionError:
                cls.loris_s = time.monotonic() - begun

    @classmethod
    def tearDownClass(cls):
        cls.run_under_attack.__exit__()
        cls.loris.join(40)
        cls.folder.cleanup()

    def connect(self):
        client = socket.create_connection(("127.0.0.1", self.port), timeout=5)
        self.addCleanup(client.close)
        return client

    def hear(self, client, patience=5.0):
        """All that comes until the server hangs up; whether it did."""
        heard, end = b"", time.monotonic() + patience
        while time.monotonic() < end:
            client.settimeout(max(end - time.monotonic(), 0.01))
            try:
                piece = client.recv(65536)
            except TimeoutError:
                break
            except ConnectionError:
                return heard, True
            if not piece:
                return heard, True
            heard += piece
        return heard, False

    def request(self, head, body=b""):
        client = self.connect()
        try:
            client.sendall(head.replace("\n", "\r\n").encode() + b"\r\n" + body)
        except ConnectionError:
            pass  # it has heard enough; what it says comes yet
        return self.hear(client)[0]

    def assert_refused(self, answer, status, words):
        head, _, body = answer.partition(b"\r\n\r\n")
        self.assertTrue(head.startswith(b"HTTP/1.1 %d " % status), answer[:300])
        told = json.loads(body)
        self.assertEqual(list(told), ["error"])
        self.assertNotIn("\n", told["error"])
        self.assertIn(words, told["error"])

    def upgrade(self, rest="", path="/api/stream?rate=10", host="127.0.0.1"):
        client = self.connect()
        key = base64.b64encode(os.urandom(16)).decode()
        client.sendall(f"GET {path} HTTP/1.1\nHost: {host}\nConnection: Upgrade\nUpgrade: websocket\n"
                       f"Sec-WebSocket-Version: 13\nSec-WebSocket-Key: {key}\n{rest}\n".replace("\n", "\r\n").encode())
        return client

    def stream(self):
        """An accepted WebSocket."""
        client = self.upgrade(f"Authorization: Bearer {TOKEN}\n")
        head = b""
        while b"\r\n\r\n" not in head:
            piece = client.recv(1)
            self.assertTrue(piece, head)
            head += piece
        self.assertTrue(head.startswith(b"HTTP/1.1 101 "), head)
        return client

    def assert_hangs_up(self, client, patience=8.0):
        _, hung_up = self.hear(client, patience)
        self.assertTrue(hung_up, "the server goes on listening")

    def assert_answers(self):
        """A client of good manners is served, within the time in which the places of others become free."""
        for _ in range(40):
            done = run_to_end("ctl", "--token", TOKEN, f"127.0.0.1:{self.port}", "status", check=False)
            if done.returncode == 0:
                return
            time.sleep(0.1)
        self.fail(done.stderr)

    def test_1_strangers(self):
        self.assert_refused(self.request("GET /api/status HTTP/1.1\nHost: evil.example\nConnection: close\n"), 421,
                            "evil.example")
        self.assert_refused(self.request("POST /api/commands HTTP/1.1\nHost: 127.0.0.1\nConnection: close\n"
                                         "Authorization: Bearer open-sesamf\nContent-Length: 18\n", b'{"command":"stop"}'),
                            401, "no token, or a wrong one")
        site = f"Authorization: Bearer {TOKEN}\nOrigin: http://evil.example\n"
        self.assert_refused(self.hear(self.upgrade(site))[0], 403, "http://evil.example")
        self.assert_refused(self.hear(self.upgrade("Sec-WebSocket-Protocol: bearer.wrong\n"))[0], 401, "no token")
        self.assert_refused(self.hear(self.upgrade(site, host="rebound.example"))[0], 403, "http://evil.example")
        self.assert_refused(self.hear(self.upgrade(host="rebound.example"))[0], 421, "rebound.example")
        self.assert_answers()

    def test_2_requests_too_large_and_none_at_all(self):
        ten_megabytes = b'{"command":"note","text":"' + b"x" * 10_000_000 + b'"}'
        head = f"POST /api/commands HTTP/1.1\nHost: 127.0.0.1\nAuthorization: Bearer {TOKEN}\n"
        self.assert_refused(self.request(head + f"Content-Length: {len(ten_megabytes)}\n", ten_megabytes), 413,
                            "65536 bytes")
        self.assert_refused(self.request("GET / HTTP/1.1\nHost: 127.0.0.1\nContent-Length: -1\n"), 400, "no HTTP request")
        deep = b"[" * 60_000
        self.assert_refused(self.request(head + f"Connection: close\nContent-Type: application/json\n"
                                                f"Content-Length: {len(deep)}\n", deep), 422, "")
        for garbage in (b"\x16\x03\x01\x02\x00\x01\x00" * 40, b"\0" * 5000, b"GET " + b"/" * 20_000, random.Random(1).randbytes(5000)):
            client = self.connect()
            client.sendall(garbage + b"\r\n\r\n")
            client.shutdown(socket.SHUT_WR)
            answer, hung_up = self.hear(client)
            self.assertTrue(hung_up)
            self.assertRegex(answer, rb"^(HTTP/1\.1 4\d\d |$)")
        self.assert_answers()

    def test_3_frames_that_no_client_sends(self):
        cases = {
            "too long": frame(FIN | TEXT, b"x" * 2000),
            "longer than memory": frame(FIN | TEXT, b"x" * 10, length=(1 << 63) - 1),
            "not masked": frame(FIN | TEXT, b"hello", mask=False),
            "of a reserved kind": frame(FIN | 0x7, b"x"),
            "a continuation of nothing": frame(FIN | CONTINUATION, b"x"),
            "no text": frame(FIN | TEXT, b"\xff\xfe"),
            "a ping too long": frame(FIN | 0x9, b"x" * 200),
        }
        for name, sent in cases.items():
            with self.subTest(name):
                client = self.stream()
                client.sendall(sent)
                self.assert_hangs_up(client)
        endless = self.stream()
        with self.subTest("fragmented for ever"), self.assertRaises(ConnectionError):
            endless.sendall(frame(TEXT, b"x"))
            for _ in range(2000):
                endless.sendall(frame(CONTINUATION, b"x" * 10))
                time.sleep(0.001)
        self.assert_answers()

    def test_4_a_flood_of_requests(self):
        ask = (f"GET /api/timeline HTTP/1.1\r\nHost: 127.0.0.1\r\nAuthorization: Bearer {TOKEN}\r\n\r\n").encode()
        counts = []

        def flood():
            with socket.create_connection(("127.0.0.1", self.port), timeout=5) as client:
                sender = threading.Thread(target=client.sendall, args=(ask * 1000,))
                sender.start()
                heard = b""
                while heard.count(b"HTTP/1.1 200 ") < 1000:
                    heard += client.recv(1 << 20)
                sender.join()
                counts.append(1000)

        floods = [threading.Thread(target=flood) for _ in range(4)]
        for thread in floods:
            thread.start()
        for thread in floods:
            thread.join(15)
        self.assertEqual(counts, [1000] * 4)
        self.assert_answers()

    def test_5_two_hundred_connections_and_half_of_each(self):
        clients = [self.connect() for _ in range(200)]
        time.sleep(0.3)
        told = [client for client in clients[16:] if self.hear(client, 0.02)[0].startswith(b"HTTP/1.1 503 ")]
        self.assertGreaterEqual(len(told), 20, "those that there is no room for are told so")
        for client in clients:
            try:
                client.shutdown(socket.SHUT_WR)  # and never read
            except OSError:
                pass  # hung up on already
        self.assert_answers()

    def test_6_clients_that_take_their_time(self):
        slow_readers = [self.stream() for _ in range(3)]  # that do not read a byte from here on
        self.loris.join(40)
        self.assertIsNotNone(self.loris_s, "it is still listened to")
        self.assertGreater(self.loris_s, 8)
        self.assertLess(self.loris_s, 20, "a request has ten seconds to come")
        self.assert_answers()
        self.assertEqual(len(slow_readers), 3)

    def test_7_the_run_has_not_noticed(self):
        self.assertIsNone(self.run_under_attack.process.poll(), self.run_under_attack.log)
        wall_s = time.monotonic() - self.started
        self.assertEqual(self.run_under_attack.stop(), 0, self.run_under_attack.log)
        with open(self.recording / "fixes.csv", newline="") as file:
            times = [float(row["tow_s"]) for row in csv.DictReader(file)]
        steps = {round((later - earlier) * RATE_HZ, 3) for earlier, later in zip(times, times[1:])}
        self.assertEqual(steps, {1.0}, "no epoch is missing")
        self.assertGreater(len(times), (wall_s - 2) * RATE_HZ, "it has kept the pace of the clock")
        events = (self.recording / "commands.jsonl").read_text()
        self.assertNotIn('"command"', events, "nothing of it was obeyed")


if __name__ == "__main__":
    unittest.main()
