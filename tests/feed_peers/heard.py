"""Bytes of a real program, and what the dialects read from them."""
import json
import os
import struct
import subprocess
import tempfile
import time


class Recording:
    """The pieces that came, with when they came."""

    def __init__(self):
        self.pieces = []

    def add(self, piece, received_ns=None):
        self.pieces.append((time.monotonic_ns() if received_ns is None else received_ns, piece))

    def read_by(self, dialect, origin=()):
        """The objects that feed_peer prints: samples and refusals. Of local metres: latitude, longitude, height."""
        with tempfile.NamedTemporaryFile() as file:
            for received_ns, piece in self.pieces:
                file.write(struct.pack("<qI", received_ns, len(piece)) + piece)
            file.flush()
            done = subprocess.run([os.environ["SKYLOOP_FEED_PEER"], "hear", dialect, file.name, *map(str, origin)],
                                  capture_output=True, text=True, timeout=30)
        assert done.returncode == 0, done.stderr
        return [json.loads(line) for line in done.stdout.splitlines()]


def words_of(dialect):
    """What a dialect says at first."""
    with tempfile.NamedTemporaryFile() as file:
        subprocess.run([os.environ["SKYLOOP_FEED_PEER"], "say", dialect, file.name], check=True, timeout=10)
        return file.read()
