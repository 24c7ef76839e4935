"""A climbing circle, flown by fakes of X-Plane, ArduPilot's physics and PX4's simulator, as the dialects read it."""
import math
import unittest

from fake_simulators import FakePhysics, FakePx4Simulator, FakeXplane, Flight, servo_packet
from heard import Recording, words_of

STEP, COUNT = 0.02, 1000
ORIGIN = (Flight.LATITUDE, Flight.LONGITUDE, Flight.HEIGHT)


def metres(degrees, latitude=0.0):
    return math.radians(degrees) * 6371000 * math.cos(math.radians(latitude))


class FakeSimulators(unittest.TestCase):
    def check(self, heard, place_m, speed_mps, time_s=1e-9, skipped=0):
        """Every sample against the flight's formulas at its own time."""
        self.assertEqual([line for line in heard if "refused" in line], [])
        self.assertEqual(len(heard), COUNT)
        for index, sample in list(enumerate(heard))[skipped:]:
            flight = Flight(index * STEP)
            self.assertAlmostEqual(sample["time"] / 1e9, flight.seconds, delta=time_s)
            latitude, longitude, height = flight.place()
            self.assertLess(abs(metres(sample["place"][0] - latitude)), place_m)
            self.assertLess(abs(metres(sample["place"][1] - longitude, latitude)), place_m)
            self.assertLess(abs(sample["place"][2] - height), place_m)
            for found, wanted in zip(sample["ned"], flight.velocity):
                self.assertAlmostEqual(found, wanted, delta=speed_mps)
            for found, wanted in zip(sample["angles"], (flight.roll, flight.pitch, flight.yaw)):
                turn = (found - math.degrees(wanted) + 180) % 360 - 180
                self.assertAlmostEqual(turn, 0, delta=1e-3)

    def test_xplane(self):
        simulator, recording = FakeXplane(), Recording()
        words, at = words_of("xplane"), 0
        for size in (413, 413, 9, 8):  # as feed_peer writes them, one after the other
            simulator.hear(words[at:at + size])
            at += size
        self.assertEqual((at, simulator.rate, len(simulator.references)), (len(words), 50, 2))
        for index in range(COUNT):
            for packet in simulator.frame(Flight(index * STEP)):
                recording.add(packet, round(index * STEP * 1e9))
        # Its time is a float: 1 us at 16 s.
        self.check(recording.read_by("xplane"), 1e-3, 1e-4, time_s=2e-6)

    def test_ardupilot(self):
        recording = Recording()
        for index in range(COUNT):
            recording.add(FakePhysics.answer(servo_packet(index), Flight(index * STEP)), round(index * STEP * 1e9))
        # ArduPilot's degree of 111 318.845 m is off by up to 0.2 % of 400 m.
        self.check(recording.read_by("ardupilot-json", ORIGIN), 0.9, 1e-4)

    def test_px4(self):
        for version in (1, 2):
            stream = b"".join(FakePx4Simulator.step(Flight(index * STEP), version) for index in range(COUNT))
            recording = Recording()
            for at in range(0, len(stream), 1448):
                recording.add(stream[at:at + 1448], at)
            self.check(recording.read_by("px4"), 0.02, 0.006, time_s=1.1e-6)


if __name__ == "__main__":
    unittest.main()
