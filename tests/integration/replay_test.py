"""`skyloop replay`: a recording comes out of a pty, a TCP port and a file with its bytes and its gaps."""
import os
import pathlib
import select
import time
import unittest

from pty_client_test import open_client
from session import Emulator, open_folder, skyloop
from tcp_client_test import connect

SECONDS = 5


def read_to_end(descriptor, expected, patience=40):
    """[(time, bytes)] until so many bytes have come or the other end has closed."""
    pieces, count = [], 0
    end = time.monotonic() + patience
    while count < expected and (left := end - time.monotonic()) > 0:
        if not select.select([descriptor], [], [], left)[0]:
            break
        try:
            piece = os.read(descriptor, 65536)
        except OSError:
            break
        if not piece:
            break
        pieces.append((time.monotonic(), piece))
        count += len(piece)
    return pieces


class ReplayTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = open_folder()
        cls.recording = pathlib.Path(cls.folder.name, "recording")
        skyloop("simulate", "--out", cls.recording, "--duration", SECONDS, "--start", "2026-03-01T00:00:00Z", "--model",
                "ideal")
        cls.bytes = (cls.recording / "port0.out").read_bytes()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def check(self, pieces, speed):
        self.assertEqual(b"".join(piece for _, piece in pieces), self.bytes)
        lines = [list(map(int, line.split())) for line in (self.recording / "port0.times").read_text().splitlines()]
        recorded = (lines[-1][0] - lines[0][0]) * 1e-9
        played = pieces[-1][0] - pieces[0][0]
        self.assertGreater(played, 0.8 * recorded / speed, "not all at once")
        self.assertLess(played, 1.5 * recorded / speed + 1)
        # Bursts, with silence between: most pauses of the reader are the recorded ones.
        silences = sum(later[0] - earlier[0] > 0.1 / speed for earlier, later in zip(pieces, pieces[1:]))
        recorded_silences = sum(later[0] - earlier[0] > 1e8 for earlier, later in zip(lines, lines[1:]))
        self.assertGreaterEqual(silences, recorded_silences - 2)

    def test_a_pty(self):
        with Emulator(self.recording, "--speed", 2, command="replay") as replay:
            time.sleep(0.7)
            client = open_client(replay.tty)
            self.check(read_to_end(client, len(self.bytes)), 2)
            os.close(client)
            self.assertEqual(replay.finish(), 0, replay.log)
            self.assertIn(f"{len(self.bytes)} bytes out, 0 in, 0 while nobody listened", replay.log)
            self.assertRegex(replay.log, r"writes left \d+\.\d+ ms late on average")

    def test_a_tcp_port(self):
        with Emulator(self.recording, "--port", "tcp:0", "--speed", 2, command="replay") as replay:
            with connect(replay.tty) as client:
                client.sendall(b"nobody hears this")
                self.check(read_to_end(client.fileno(), len(self.bytes)), 2)
            self.assertEqual(replay.finish(), 0, replay.log)

    def test_a_file_and_a_part(self):
        out = pathlib.Path(self.folder.name, "again")
        skyloop("replay", self.recording, "--port", f"file:{out}", "--speed", 50)
        self.assertEqual(out.read_bytes(), self.bytes)
        skyloop("replay", self.recording, "--port", f"file:{out}", "--speed", 50, "--from", 2, "--duration", 2)
        part = out.read_bytes()
        self.assertIn(part, self.bytes)
        self.assertEqual(part.count(b"GGA"), 2)

    def test_bytes_without_times(self):
        raw = pathlib.Path(self.folder.name, "raw.nmea")
        raw.write_bytes(self.bytes)
        with Emulator(raw, "--baud", 19200, command="replay") as replay:
            client = open_client(replay.tty)
            pieces = read_to_end(client, len(self.bytes))
            os.close(client)
            self.assertEqual(replay.finish(), 0, replay.log)
        self.assertEqual(b"".join(piece for _, piece in pieces), self.bytes)
        expected = len(self.bytes) / 1920
        self.assertGreater(pieces[-1][0] - pieces[0][0], 0.8 * expected)
        self.assertLess(pieces[-1][0] - pieces[0][0], 1.5 * expected + 1)

    def refused(self, *arguments):
        done = skyloop("replay", *arguments, check=False)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        return done.returncode, done.stderr

    def test_bad_recordings_are_one_line(self):
        bad = pathlib.Path(self.folder.name, "bad")
        bad.mkdir()
        code, line = self.refused(bad)
        self.assertEqual(code, 1)
        self.assertIn("port0.times", line)
        (bad / "port0.out").write_bytes(b"abc")
        for times, words in (("1 1 0 4\n", "port0.times:1: tells of bytes up to 4"), ("1 1 1 1\n", "found offset 1"),
                             ("x\n", "port0.times:1: expected monotonic nanoseconds")):
            (bad / "port0.times").write_text(times)
            code, line = self.refused(bad)
            self.assertEqual(code, 2, line)
            self.assertIn(words, line)
        (bad / "port0.times").write_text("")
        (bad / "port0.out").write_bytes(b"")
        code, line = self.refused(bad)
        self.assertEqual((code, "nothing was sent in this recording" in line), (2, True), line)
        for arguments, words in (([self.recording / "port0.out"], "expected --baud"),
                                 ([self.recording, "--from", 1000], "nothing was sent from 1000.000 s on"),
                                 ([self.recording, "--speed", 0], "--speed"),
                                 ([self.recording, "--port", "pty", "--port", "pty"], "--port is there 2 times")):
            code, line = self.refused(*arguments)
            self.assertEqual(code, 2, line)
            self.assertIn(words, line)


if __name__ == "__main__":
    unittest.main(verbosity=2)
