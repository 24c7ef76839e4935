"""A real gpsd as a source: it reads sentences from a tty of ours, its socket is what the dialect hears."""
import os
import pathlib
import shutil
import socket
import sys
import threading
import time
import tty
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "integration"))
from gpsd_process import Gpsd
from heard import Recording, words_of

EPOCHS, RATE = 40, 5
NORTH_MPS, CLIMB_MPS = 20.0, 1.0
LATITUDE, LONGITUDE, ALTITUDE, SEPARATION = 47.3977, 8.5456, 462.5, 47.5


def sentence(body):
    total = 0
    for byte in body.encode():
        total ^= byte
    return f"${body}*{total:02X}\r\n".encode()


def degrees_minutes(degrees, digits):
    whole = int(degrees)
    return f"{whole:0{digits}d}{(degrees - whole) * 60:010.7f}"


def latitude_at(seconds):
    return LATITUDE + NORTH_MPS * seconds / 111183


def epoch(number):
    """RMC, GSA and GGA of one fifth of a second: due north, climbing."""
    seconds = number / RATE
    clock = f"1234{seconds + 10:05.2f}"
    place = f"{degrees_minutes(latitude_at(seconds), 2)},N,{degrees_minutes(LONGITUDE, 3)},E"
    altitude = ALTITUDE + CLIMB_MPS * seconds
    return (sentence(f"GPRMC,{clock},A,{place},{NORTH_MPS / 0.514444:.3f},0.000,010626,,,A") +
            sentence("GPGSA,A,3,01,02,03,04,05,06,07,08,,,,,1.5,0.9,1.2") +
            sentence(f"GPGGA,{clock},{place},1,08,0.9,{altitude:.3f},M,{SEPARATION:.3f},M,,"))


class GpsdSource(unittest.TestCase):
    def record(self):
        master, slave = os.openpty()
        tty.setraw(slave)
        gpsd = Gpsd(os.ttyname(slave), "-b")
        recording = Recording()

        def speak():
            for number in range(EPOCHS):
                os.write(master, epoch(number))
                time.sleep(1 / RATE)

        try:
            stream = self.connect(gpsd.port)
            stream.sendall(words_of("gpsd"))
            speaker = threading.Thread(target=speak)
            speaker.start()
            end = time.monotonic() + EPOCHS / RATE + 2
            stream.settimeout(0.2)
            while time.monotonic() < end:
                try:
                    recording.add(stream.recv(4096))
                except socket.timeout:
                    continue
            speaker.join()
            stream.close()
        finally:
            gpsd.stop()
            os.close(master)
            os.close(slave)
        return recording

    def connect(self, port):
        for _ in range(50):
            try:
                return socket.create_connection(("127.0.0.1", port), timeout=1)
            except OSError:
                time.sleep(0.1)
        raise AssertionError("gpsd does not listen")

    def test_every_epoch_is_read_as_it_was_said(self):
        heard = self.record().read_by("gpsd")
        samples = [line for line in heard if "place" in line]
        # The first second is gpsd's, which finds out what it hears.
        self.assertGreater(len(samples), EPOCHS - 2 * RATE, heard[:5])
        start = samples[-1]["time"] - (EPOCHS - 1) * 10**9 // RATE
        for sample in samples:
            seconds = (sample["time"] - start) / 1e9
            self.assertAlmostEqual(sample["place"][0], latitude_at(seconds), delta=2e-9)
            self.assertAlmostEqual(sample["place"][1], LONGITUDE, delta=2e-9)
            self.assertAlmostEqual(sample["place"][2], ALTITUDE + SEPARATION + CLIMB_MPS * seconds, delta=0.01)
        self.assertEqual(len({sample["time"] for sample in samples}), len(samples))
        for sample in samples[2:]:
            self.assertAlmostEqual(sample["ned"][0], NORTH_MPS, delta=0.01)
            self.assertAlmostEqual(sample["ned"][1], 0, delta=0.01)
            self.assertAlmostEqual(sample["ned"][2], -CLIMB_MPS, delta=0.05)


if __name__ == "__main__":
    if not shutil.which("gpsd"):
        print("integration/gpsd_source is skipped: there is no gpsd; apt-get install gpsd")
        sys.exit(77)
    unittest.main()
