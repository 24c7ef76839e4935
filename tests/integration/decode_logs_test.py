"""Counts the frames of real receivers' logs with code of its own and compares with `skyloop decode`."""
import concurrent.futures
import json
import re
import subprocess
import unittest

from session import SHARED, SKYLOOP, skip

try:
    import pynmea2
except ImportError:
    pynmea2 = None

LOGS = SHARED / "serial"
if not LOGS.is_dir():
    skip(f"{LOGS} is absent")

SENTENCE = re.compile(rb"[$!]([\x20-\x23\x25-\x29\x2b-\x7e]*)\*([0-9A-Fa-f]{2})\r{0,2}\n")
# Whatever looks like a line of NMEA: from the mark to the end of the line, without another mark of a sentence's start.
LINE = re.compile(rb"[$!][\x20-\x23\x25-\x7e]*\r{0,2}\n")
LONGEST_LINE = 256


def crc24q_table():
    table = []
    for byte in range(256):
        crc = byte << 16
        for _ in range(8):
            crc = (crc << 1) ^ (0x1864CFB if crc & 0x800000 else 0)
        table.append(crc & 0xFFFFFF)
    return table


TABLE = crc24q_table()


def crc24q(data):
    crc = 0
    for byte in data:
        crc = ((crc << 8) & 0xFFFFFF) ^ TABLE[(crc >> 16) ^ byte]
    return crc


def ubx_at(data, at):
    """Length of the valid UBX frame that begins there, or 0."""
    if data[at:at + 2] != b"\xb5\x62" or len(data) < at + 8:
        return 0
    length = int.from_bytes(data[at + 4:at + 6], "little")
    end = at + 8 + length
    if length > 8192 or end > len(data):
        return 0
    a = b = 0
    for byte in data[at + 2:end - 2]:
        a = (a + byte) & 255
        b = (b + a) & 255
    return end - at if data[end - 2:end] == bytes([a, b]) else 0


def rtcm_at(data, at):
    """Length of the valid RTCM 3 frame that begins there, or 0."""
    if data[at] != 0xD3 or len(data) < at + 6 or data[at + 1] & 0xFC:
        return 0
    end = at + 6 + ((data[at + 1] & 3) << 8 | data[at + 2])
    if end > len(data):
        return 0
    return end - at if crc24q(data[at:end - 3]) == int.from_bytes(data[end - 3:end], "big") else 0


def nmea_at(data, at):
    """Length of the sentence with a right checksum that begins there, or 0; and whether a line without one does."""
    if data[at:at + 1] not in (b"$", b"!"):
        return 0, False
    line = LINE.match(data, at, at + LONGEST_LINE)
    if not line:
        return 0, False
    found = SENTENCE.fullmatch(line.group())
    if not found:
        return 0, True
    total = 0
    for byte in found.group(1):
        total ^= byte
    return (line.end() - at, False) if total == int(found.group(2), 16) else (0, True)


def count(data):
    """Frames by protocol, bad sentences, and bytes in no frame."""
    frames = {"ubx": 0, "nmea": 0, "rtcm3": 0}
    bad_lines = skipped = at = 0
    while at < len(data):
        kind, length = "ubx", ubx_at(data, at)
        if not length:
            kind, length = "rtcm3", rtcm_at(data, at)
        if not length:
            kind = "nmea"
            length, bad = nmea_at(data, at)
            bad_lines += bad
        if length:
            frames[kind] += 1
        else:
            skipped += 1
        at += length or 1
    return frames, bad_lines, skipped


def decode(path):
    """Messages and counts as the program sees them."""
    done = subprocess.run([SKYLOOP, "decode", str(path), "--format", "json", "--protocol", "ubx,nmea,rtcm3"],
                          capture_output=True, timeout=120)
    lines = [json.loads(line) for line in done.stdout.decode("ascii").splitlines()]
    return done, lines[:-1], lines[-1]["counts"] if lines else None


class DecodeLogsTest(unittest.TestCase):
    def check(self, path):
        data = path.read_bytes()
        done, messages, counts = decode(path)
        frames, bad_lines, skipped = count(data)
        self.assertEqual(done.returncode, 0 if sum(frames.values()) else 2, f"{path}: {done.stderr}")
        self.assertEqual({kind: counts[kind]["frames"] for kind in frames}, frames, path)
        self.assertEqual(counts["nmea"]["bad"], bad_lines, path)
        self.assertEqual(counts["skipped_bytes"], skipped, path)
        self.assertEqual(counts["bytes"], len(data), path)
        self.assertEqual(len(messages), sum(frames.values()), path)
        for message in messages:
            start = data[message["offset"]:message["offset"] + 1]
            self.assertIn(start, {"ubx": (b"\xb5",), "nmea": (b"$", b"!"), "rtcm3": (b"\xd3",)}[message["protocol"]])

    def test_every_log_has_the_frames_that_a_second_counter_finds(self):
        paths = sorted(path for path in LOGS.iterdir() if path.is_file())
        self.assertGreaterEqual(len(paths), 150)
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            for path, result in [(path, pool.submit(self.check, path)) for path in paths]:
                with self.subTest(path.name):
                    result.result()

    @unittest.skipIf(pynmea2 is None, "the parser is not installed; apt-get install python3-nmea2")
    def test_positions_are_those_of_another_parser(self):
        compared = 0
        for path in sorted(path for path in LOGS.iterdir() if path.is_file()):
            data = path.read_bytes()
            for message in decode(path)[1]:
                if message["protocol"] != "nmea" or not message["id"].endswith("GGA"):
                    continue
                raw = data[message["offset"]:message["offset"] + message["bytes"]].decode("ascii").strip()
                try:
                    other = pynmea2.parse(raw, check=True)
                    place = (other.latitude, other.longitude)
                except (pynmea2.ParseError, ValueError, AttributeError):
                    continue  # what that parser does not understand
                fields = message["fields"]
                if not other.lat or not other.lon or not isinstance(fields["lat_deg"], (int, float)):
                    continue
                self.assertAlmostEqual(fields["lat_deg"], place[0], delta=1e-9, msg=raw)
                self.assertAlmostEqual(fields["lon_deg"], place[1], delta=1e-9, msg=raw)
                if other.num_sats.isdigit():
                    self.assertEqual(fields["satellites"], int(other.num_sats), raw)
                compared += 1
        self.assertGreater(compared, 500)


if __name__ == "__main__":
    unittest.main(verbosity=2)
