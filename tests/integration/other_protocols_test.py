"""MSP, MAVLink and SBF boards: what they send, read by decoders of its own, and by `skyloop decode`, is fixes.csv."""
import csv
import datetime
import json
import math
import pathlib
import re
import struct
import unittest
from collections import namedtuple

from session import open_folder, septentrio_that_sends, skyloop

PLACE = (-33.45, -70.66, 520)
CIRCLE = f"""[trajectory]
kind = "circle"
centre = [{PLACE[0]}, {PLACE[1]}, {PLACE[2]}]
radius_m = 500
speed_mps = 30
"""
COLD = '[[receiver]]\nstart = "cold"\npower_up = true\n'
START = "2026-03-01T23:59:55Z"
LIGHT = 299792458.0
NOTHING = -2e10  # Septentrio's number for a value that is not there

Msp = namedtuple("Msp", "instance week tow fix_type satellites h_acc v_acc s_acc dop lon lat msl north east down course yaw "
                 "year month day hour minute second")
GpsInput = namedtuple("GpsInput", "time tow lat lon alt hdop vdop north east down s_acc h_acc v_acc ignore week gps_id "
                      "fix_type satellites yaw")
Pvt = namedtuple("Pvt", "tow week mode error lat lon height undulation north east up course bias drift time_system datum "
                 "satellites wa_corr reference age signals alert bases ppp latency h_acc v_acc misc")
SBF_BLOCKS = ("PVTGeodetic", "PosCovGeodetic", "VelCovGeodetic", "DOP", "AttEuler", "AuxAntPositions", "EndOfPVT",
              "ChannelStatus", "ReceiverStatus")
SBF_ORDER = [4007, 5906, 5908, 4001, 5938, 5942, 5921, 4013, 4014]


def crc_bits(data, polynomial, width, start=0):
    """A checksum whose most significant bit goes first."""
    crc, top, mask = start, 1 << (width - 1), (1 << width) - 1
    for byte in data:
        crc ^= byte << (width - 8)
        for _ in range(8):
            crc = ((crc << 1) ^ (polynomial if crc & top else 0)) & mask
    return crc


def crc_x25(data):
    """MAVLink's checksum: the least significant bit goes first."""
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x8408 if crc & 1 else 0)
    return crc


def require(condition, what, at):
    if not condition:
        raise AssertionError(f"{what} at byte {at}")


def msp_messages(data):
    """Version 2 frames back to back: (function, payload)."""
    at, found = 0, []
    while at < len(data):
        require(data[at:at + 3] == b"$X<", "no MSP frame", at)
        flag, function, size = struct.unpack_from("<BHH", data, at + 3)
        end = at + 8 + size
        require(end < len(data) and flag == 0, "cut frame", at)
        require(data[end] == crc_bits(data[at + 3:end], 0xD5, 8), "checksum", at)
        found.append((function, data[at + 8:end]))
        at = end + 1
    return found


def mavlink_messages(data, extras={0: 50, 232: 151}, sender=(1, 220)):
    """Version 2 frames back to back: (sequence, message, payload)."""
    at, found = 0, []
    while at < len(data):
        start, size, incompatible, _, sequence, system, component = struct.unpack_from("<7B", data, at)
        require(start == 0xFD and incompatible == 0 and (system, component) == sender, "no MAVLink frame", at)
        message = int.from_bytes(data[at + 7:at + 10], "little")
        end = at + 10 + size
        require(end + 2 <= len(data), "cut frame", at)
        checksum = struct.unpack_from("<H", data, end)[0]
        require(checksum == crc_x25(data[at + 1:end] + bytes([extras[message]])), "checksum", at)
        found.append((sequence, message, data[at + 10:end]))
        at = end + 2
    return found


def sbf_blocks(data):
    """Blocks back to back: (number, revision, body)."""
    at, found = 0, []
    while at < len(data):
        require(data[at:at + 2] == b"$@", "no SBF block", at)
        checksum, name, size = struct.unpack_from("<HHH", data, at + 2)
        require(size % 4 == 0 and at + size <= len(data), "cut block", at)
        require(checksum == crc_bits(data[at + 4:at + size], 0x1021, 16), "checksum", at)
        found.append((name & 0x1FFF, name >> 13, data[at + 8:at + size]))
        at += size
    return found


def read_msp(data):
    return [Msp(*struct.unpack("<BHIBBHHHHiiiiiiHHHBBBBB", payload)) for _, payload in msp_messages(data)]


def read_gps_input(data):
    return [GpsInput(*struct.unpack("<QIii9fHHBBBH", payload.ljust(65, b"\0")))
            for _, message, payload in mavlink_messages(data) if message == 232]


def read_pvt(data):
    return [Pvt(*struct.unpack_from("<IHBBdddfffffdfBBBBHHIBBHHHHB", body)) for number, _, body in sbf_blocks(data)
            if number == 4007]


def simulate(board, scenario, duration, *arguments):
    """Bytes, fixes and the objects of `skyloop decode` of a run."""
    with open_folder() as folder:
        path = pathlib.Path(folder, "s.toml")
        path.write_text(scenario, encoding="utf-8")
        if board == "septentrio-sbf":
            board = septentrio_that_sends(folder, *SBF_BLOCKS)
        skyloop("simulate", path, "--board", board, "--out", folder, "--duration", duration, "--start", START, *arguments)
        data = pathlib.Path(folder, "port0.out").read_bytes()
        with open(pathlib.Path(folder, "fixes.csv"), newline="", encoding="ascii") as table:
            fixes = list(csv.DictReader(table))
        done = skyloop("decode", pathlib.Path(folder, "port0.out"), "--format", "json")
    objects = [json.loads(line) for line in done.stdout.splitlines()]
    return data, fixes, objects


def undulation():
    """The geoid's height above the ellipsoid at the place, m, to 0.1 m: what an NMEA receiver there says."""
    with open_folder() as folder:
        skyloop("simulate", "--board", "nmea-generic", "--at", ",".join(map(str, PLACE)), "--out", folder,
                "--duration", 2, "--start", START)
        sentences = pathlib.Path(folder, "port0.out").read_text(encoding="ascii")
    return float(re.search(r"GGA,.*?,M,(-?[\d.]+),M,", sentences).group(1))


def with_fix(fixes):
    return [fix for fix in fixes if fix["lat_deg"]]


def utc_of(fix):
    return datetime.datetime.fromisoformat(fix["time_utc"].replace("Z", "+00:00"))


def at_clock_instant(fix):
    """The row of fixes.csv where the receiver's own clock shows the whole millisecond, for which a position is told."""
    ahead_s = math.remainder(float(fix["clock_bias_m"]) / LIGHT, 1e-3)
    metres_per_degree = math.radians(6.37e6)
    east = metres_per_degree * math.cos(math.radians(float(fix["lat_deg"])))
    moved = {"lat_deg": float(fix["vel_north_mps"]) / metres_per_degree, "lon_deg": float(fix["vel_east_mps"]) / east,
             "height_m": -float(fix["vel_down_mps"])}
    return {**fix, **{key: float(fix[key]) - rate * ahead_s for key, rate in moved.items()}}


class OtherProtocolsTest(unittest.TestCase):
    def near(self, value, fix, key, delta):
        self.assertAlmostEqual(value, float(fix[key]), delta=delta, msg=f"{key} at {fix['time_utc']}")

    def check_decoded(self, objects, protocol, frames):
        """All of the stream was read, and nothing skipped; gives the messages."""
        counts = objects[-1]["counts"]
        self.assertEqual(counts[protocol], {"frames": frames, "bad": 0})
        self.assertEqual(counts["skipped_bytes"], 0)
        self.assertEqual({line["protocol"] for line in objects[:-1]}, {protocol})
        for line in objects[:-1]:
            self.assertIn("fields", line)
        return objects[:-1]

    def check_times(self, messages, fixes):
        self.assertEqual(len(messages), len(fixes))
        self.assertEqual(len(fixes), 50)
        for message, fix in zip(messages, fixes):
            self.assertEqual(message.tow, round(float(fix["tow_s"]) * 1000))
            self.assertEqual(message.week, int(fix["gps_week"]))
            self.assertEqual(message.satellites, int(fix["satellites_used"]))

    def test_msp_tells_every_fix(self):
        data, fixes, objects = simulate("msp-gps", CIRCLE, 10)
        self.assertEqual({function for function, _ in msp_messages(data)}, {0x1F03})
        messages, geoid = read_msp(data), undulation()
        self.check_times(messages, fixes)
        for m, fix in zip(messages, fixes):
            self.assertEqual(m.fix_type, 3)
            self.near(m.lat / 1e7, fix, "lat_deg", 5.6e-8)
            self.near(m.lon / 1e7, fix, "lon_deg", 5.6e-8)
            self.near(m.msl / 100 + geoid, fix, "height_m", 0.12)
            for value, key in ((m.north, "vel_north_mps"), (m.east, "vel_east_mps"), (m.down, "vel_down_mps"),
                               (m.h_acc, "h_acc_m"), (m.v_acc, "v_acc_m"), (m.s_acc, "s_acc_mps"), (m.dop, "hdop")):
                self.near(value / 100, fix, key, 0.0056)
            self.near(m.course / 100, fix, "course_deg", 0.0056)
            self.assertEqual(m.yaw, 0xFFFF)
            self.assertEqual((m.year, m.month, m.day, m.hour, m.minute, m.second), utc_of(fix).timetuple()[:6])
        self.assertGreater(max(math.hypot(m.north, m.east) for m in messages), 2900)
        decoded = self.check_decoded(objects, "msp", len(messages))
        for line, m in zip(decoded, messages):
            self.assertEqual(line["name"], "MSP2_SENSOR_GPS")
            self.assertEqual(line["fields"]["lat_deg"], m.lat / 1e7)
            self.assertEqual(line["fields"]["vel_north_mps"], m.north / 100)
            self.assertEqual(line["fields"]["tow_s"], m.tow / 1000)
            self.assertIsNone(line["fields"]["yaw_deg"])

    def test_mavlink_tells_every_fix(self):
        data, fixes, objects = simulate("mavlink-gps-input", CIRCLE, 10)
        frames = mavlink_messages(data)
        seconds = [math.floor(float(fix["tow_s"]) - float(fixes[0]["tow_s"]) + 1e-6) for fix in fixes]
        expected = []
        for before, second in zip([None] + seconds, seconds):
            expected += [232] if second == before else [0, 232]
        self.assertEqual([message for _, message, _ in frames], expected)
        self.assertEqual([(frame[0] - frames[0][0]) % 256 for frame in frames], list(range(len(frames))))
        messages, geoid = read_gps_input(data), undulation()
        self.check_times(messages, fixes)
        for m, fix in zip(messages, fixes):
            self.assertEqual((m.fix_type, m.ignore, m.yaw), (3, 0, 0))
            self.assertEqual(m.time, round(utc_of(fix).timestamp() * 1000) * 1000)
            self.near(m.lat / 1e7, fix, "lat_deg", 5.6e-8)
            self.near(m.lon / 1e7, fix, "lon_deg", 5.6e-8)
            self.near(m.alt + geoid, fix, "height_m", 0.12)
            for value, key in ((m.north, "vel_north_mps"), (m.east, "vel_east_mps"), (m.down, "vel_down_mps"),
                               (m.h_acc, "h_acc_m"), (m.v_acc, "v_acc_m"), (m.s_acc, "s_acc_mps"), (m.hdop, "hdop"),
                               (m.vdop, "vdop")):
                self.near(value, fix, key, 0.00051)
        decoded = self.check_decoded(objects, "mavlink", len(frames))
        inputs = [line["fields"] for line in decoded if line["name"] == "GPS_INPUT"]
        for fields, m in zip(inputs, messages):
            self.assertEqual(fields["lon_deg"], m.lon / 1e7)
            self.assertAlmostEqual(fields["vel_down_mps"], m.down, delta=1e-6)
            self.assertEqual(fields["unix_time_s"], m.time / 1e6)
            self.assertEqual(fields["satellites"], m.satellites)

    def test_sbf_tells_every_fix(self):
        data, fixes, objects = simulate("septentrio-sbf", CIRCLE, 10)
        blocks = sbf_blocks(data)
        self.assertEqual([number for number, _, _ in blocks], SBF_ORDER * len(fixes))
        for i, (_, _, body) in enumerate(blocks):
            stamp = struct.unpack_from("<IH", body)
            self.assertEqual(stamp[0], round(float(fixes[i // len(SBF_ORDER)]["tow_s"]) * 1000))
        messages, geoid = read_pvt(data), undulation()
        self.check_times(messages, fixes)
        for m, fix in zip(messages, fixes):
            self.assertEqual((m.mode, m.error, m.time_system, m.datum), (1, 0, 0, 0))
            there = at_clock_instant(fix)
            self.near(math.degrees(m.lat), there, "lat_deg", 6e-10)
            self.near(math.degrees(m.lon), there, "lon_deg", 6e-10)
            self.near(m.height, there, "height_m", 6e-5)
            self.assertAlmostEqual(m.undulation, geoid, delta=0.11)
            for value, key in ((m.north, "vel_north_mps"), (m.east, "vel_east_mps"), (-m.up, "vel_down_mps")):
                self.near(value, fix, key, 6e-5)
            self.near(m.course, fix, "course_deg", 6e-5)
            self.near(m.bias / 1000 * LIGHT, fix, "clock_bias_m", 6e-5)
            self.assertAlmostEqual(m.h_acc / 100, 2 * float(fix["h_acc_m"]), delta=0.0061)
            self.assertAlmostEqual(m.v_acc / 100, 2 * float(fix["v_acc_m"]), delta=0.0061)
            self.assertEqual(m.latency, 500)
        self.check_accuracy_of(blocks, fixes)
        decoded = self.check_decoded(objects, "sbf", len(blocks))
        solutions = [line["fields"] for line in decoded if line["name"] == "PVTGeodetic"]
        for fields, m in zip(solutions, messages):
            self.assertEqual((fields["latitude_rad"], fields["height_m"]), (m.lat, m.height))
            self.assertAlmostEqual(fields["vel_up_mps"], m.up, delta=1e-6)
            self.assertIsNone(fields["reference_id"])

    def check_accuracy_of(self, blocks, fixes):
        """Variances of the position are those of the accuracies, DOP those of the table."""
        covariances = [struct.unpack_from("<IHBB10f", body)[4:] for number, _, body in blocks if number == 5906]
        dops = [struct.unpack_from("<IHBBHHHH", body)[4:] for number, _, body in blocks if number == 4001]
        for variances, fix in zip(covariances, fixes):
            self.near(math.sqrt(variances[0] + variances[1]), fix, "h_acc_m", 0.0011)
            self.near(math.sqrt(variances[2]), fix, "v_acc_m", 0.0011)
        for dop, fix in zip(dops, fixes):
            for value, key in zip(dop, ("pdop", "tdop", "hdop", "vdop")):
                self.near(value / 100, fix, key, 0.0056)

    def test_a_cold_start_tells_that_there_is_no_fix_until_there_is_one(self):
        """The first message knows neither time nor place; the first fix told is the first of fixes.csv."""
        for board, read in (("msp-gps", read_msp), ("mavlink-gps-input", read_gps_input), ("septentrio-sbf", read_pvt)):
            with self.subTest(board):
                data, fixes, _ = simulate(board, CIRCLE + COLD, 60)
                messages, solved = read(data), with_fix(fixes)
                # Nothing leaves while the receiver starts.
                self.assertLess(len(messages), len(fixes))
                self.assertGreater(len(messages), len(fixes) - 20)
                self.assertGreater(len(messages) - len(solved), 50)
                self.assertGreater(len(solved), 50)
                for message in messages[:-len(solved)]:
                    self.check_no_fix(message)
                for message, fix in zip(messages[-len(solved):], solved):
                    self.assertEqual(message.tow, round(float(fix["tow_s"]) * 1000))
                    self.assertEqual(message.satellites, int(fix["satellites_used"]))
                self.check_unknown_time(messages[0])

    def check_no_fix(self, m):
        if isinstance(m, Msp):
            self.assertEqual((m.fix_type, m.satellites, m.lat, m.lon, m.north, m.h_acc, m.dop),
                             (0, 0, 0, 0, 0, 0xFFFF, 9999))
        elif isinstance(m, GpsInput):
            self.assertEqual((m.fix_type, m.satellites, m.lat, m.lon, m.north, m.ignore, m.hdop), (1, 0, 0, 0, 0, 0xFF, 65535))
        else:
            self.assertEqual(m.mode, 0)
            self.assertNotEqual(m.error, 0)
            for value in (m.lat, m.lon, m.height, m.north, m.east, m.up, m.course, m.bias):
                self.assertEqual(value, NOTHING)
            self.assertEqual((m.h_acc, m.v_acc), (0xFFFF, 0xFFFF))

    def check_unknown_time(self, m):
        if isinstance(m, Msp):
            self.assertEqual((m.week, m.tow, m.year), (0xFFFF, 0, 0))
        elif isinstance(m, GpsInput):
            self.assertEqual((m.week, m.tow, m.time), (0, 0, 0))
        else:
            self.assertEqual((m.week, m.tow), (0xFFFF, 0xFFFFFFFF))


if __name__ == "__main__":
    unittest.main(verbosity=2)
