"""`skyloop decode` on what the emulator itself sends, on live streams and on damage."""
import bz2
import csv
import gzip
import json
import os
import pathlib
import pty
import signal
import subprocess
import time
import tty
import unittest
import zipfile

from session import SKYLOOP, open_folder, skyloop

GLL = b"$GNGLL,4628.65006,N,03043.95600,E,235959.00,A,A*75\r\n"
ACK = bytes.fromhex("b5620501020006010f38")


def decode(data, *arguments):
    return subprocess.run([SKYLOOP, "decode", *arguments], input=data, capture_output=True, timeout=60)


def read_line(process, patience=20):
    """One line, as soon as it comes."""
    os.set_blocking(process.stdout.fileno(), False)
    text, end = b"", time.monotonic() + patience
    while not text.endswith(b"\n") and time.monotonic() < end:
        text += process.stdout.read(1) or b""
        if not text:
            time.sleep(0.01)
    return text.decode()


class DecodeTest(unittest.TestCase):
    def test_a_run_decodes_to_its_fixes(self):
        with open_folder() as folder:
            skyloop("simulate", "--out", folder, "--duration", 30, "--at", "46.4775,30.7326,77", "--model", "baseline",
                    "--start", "2026-03-01T23:59:45Z")
            done = skyloop("decode", pathlib.Path(folder, "port0.out"), "--format", "json")
            with open(pathlib.Path(folder, "fixes.csv"), newline="", encoding="ascii") as table:
                fixes = list(csv.DictReader(table))
        lines = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual(lines[-1]["counts"]["nmea"]["bad"], 0)
        self.assertEqual(lines[-1]["counts"]["skipped_bytes"], 0)
        positions = [line["fields"] for line in lines[:-1] if line["id"].endswith("GGA")]
        self.assertEqual(len(positions), len(fixes))
        for fields, fix in zip(positions, fixes):
            self.assertEqual(fields["time"][:8], fix["time_utc"][11:19])
            self.assertAlmostEqual(fields["lat_deg"], float(fix["lat_deg"]), delta=1.1e-7)
            self.assertAlmostEqual(fields["lon_deg"], float(fix["lon_deg"]), delta=1.1e-7)

    def test_counts_stand_on_stderr_and_in_the_last_object(self):
        done = decode(b"junk" + ACK + b"\xb5" + GLL.replace(b"*75", b"*00") + ACK[:-1] + b"\0", "--format", "json")
        counts = json.loads(done.stdout.splitlines()[-1])["counts"]
        self.assertEqual(counts["ubx"], {"frames": 1, "bad": 1})
        self.assertEqual(counts["nmea"], {"frames": 0, "bad": 1})
        self.assertNotIn("mavlink", counts)
        self.assertIn(b"ubx 1 frames, 1 bad", done.stderr)
        self.assertEqual(done.returncode, 0)

    def test_only_what_was_asked_for(self):
        done = decode(ACK + b"$X<\0\x64\0\0\0\x8f", "--protocol", "msp", "--format", "json")
        lines = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual([line["protocol"] for line in lines[:-1]], ["msp"])
        self.assertEqual(set(lines[-1]["counts"]), {"bytes", "skipped_bytes", "msp"})

    def test_auto_stands_alone(self):
        for words in ("auto,ubx", "nmea,auto"):
            done = decode(ACK + GLL, "--protocol", words)
            self.assertEqual((done.returncode, done.stdout), (2, b""))
            self.assertIn(f"--protocol {words}: auto looks for all protocols; expected auto alone".encode(), done.stderr)
        self.assertEqual(decode(ACK + GLL, "--protocol", "auto").stdout, decode(ACK + GLL).stdout)

    def test_nothing_found_is_a_bad_file(self):
        done = decode(b"nothing in here\n")
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"no message", done.stderr)
        self.assertEqual(decode(b"").returncode, 0)

    def test_configuration_keys_have_names(self):
        payload = bytes.fromhex("068a0f00" "00010000" "01002130" "c800" "ffff7710" "01")
        first = second = 0
        for byte in payload:
            first = (first + byte) & 0xFF
            second = (second + first) & 0xFF
        done = decode(b"\xb5\x62" + payload + bytes([first, second]), "--format", "json")
        pairs = json.loads(done.stdout.splitlines()[0])["fields"]["pairs"]
        self.assertEqual(pairs, [{"key": 0x30210001, "name": "CFG-RATE-MEAS", "value": 200},
                                 {"key": 0x1077FFFF, "name": None, "value": 1}])

    def test_a_refusal_is_one_line(self):
        done = decode(b"nothing in here\n")
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)

    def test_packed_files(self):
        with open_folder() as folder:
            path = pathlib.Path(folder, "log.gz")
            path.write_bytes(gzip.compress(ACK * 3))
            self.assertEqual(skyloop("decode", path).stdout.splitlines(), ["UBX ACK-ACK class=6 id=1"] * 3)
            path.write_bytes(bz2.compress(ACK * 3))
            self.assertEqual(skyloop("decode", path).stdout.splitlines(), ["UBX ACK-ACK class=6 id=1"] * 3)
            with zipfile.ZipFile(path, "w") as archive:
                archive.writestr("log.ubx", ACK * 3)
            self.assertEqual(skyloop("decode", path).stdout.splitlines(), ["UBX ACK-ACK class=6 id=1"] * 3)
            path.write_bytes(gzip.compress(ACK * 300)[:-9])
            self.assertEqual(skyloop("decode", path, check=False).returncode, 2)

    def test_a_pipe_is_printed_as_it_arrives(self):
        with subprocess.Popen([SKYLOOP, "decode"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, bufsize=0) as process:
            for half in (ACK[:5], ACK[5:]):
                process.stdin.write(half)
            self.assertEqual(read_line(process), "UBX ACK-ACK class=6 id=1\n")
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(timeout=20), 0)
            self.assertIn(b"ubx 1 frames", process.stderr.read())

    def test_a_tty_is_read_raw_and_left_as_it_was(self):
        ours, theirs = pty.openpty()
        modes = tty.tcgetattr(theirs)
        with subprocess.Popen([SKYLOOP, "decode", os.ttyname(theirs)], stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, bufsize=0) as process:
            while tty.tcgetattr(theirs) == modes:
                time.sleep(0.01)
            os.write(ours, ACK + b"\x03\x04\x0d" + GLL)
            self.assertEqual(read_line(process), "UBX ACK-ACK class=6 id=1\n")
            self.assertTrue(read_line(process).startswith("NMEA GNGLL lat_deg=46.477501 lon_deg=30.7326 "))
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(timeout=20), 0)
        self.assertEqual(tty.tcgetattr(theirs), modes)
        os.close(ours)
        os.close(theirs)


if __name__ == "__main__":
    unittest.main(verbosity=2)
