"""A live run and the vehicle beside it: heartbeats, injected failures, faults that wait for a mode, and the run once more."""
import json
import pathlib
import re
import resource
import socket
import struct
import time
import unittest

from pty_client_test import open_client, read_for
from session import Emulator, open_folder
from session import skyloop as run_to_end

SCENARIO = """[run]
start = 2024-03-05T12:00:00.5Z
[model]
name = "baseline"
[[fault]]
kind = "position_step"
name = "mission"
when_mavlink_mode = "AUTO"
when_armed = true
for_s = 3
"""
# CRC_EXTRA of common.xml.
HEARTBEAT, COMMAND_LONG, COMMAND_ACK = 0, 76, 77
EXTRAS = {HEARTBEAT: 50, COMMAND_LONG: 152, COMMAND_ACK: 143}
ACCEPTED, TEMPORARILY_REJECTED, DENIED, UNSUPPORTED = range(4)
OK, OFF = 0, 1
GYRO, GPS = 0, 4
LOITER, AUTO = 5, 3  # of ArduCopter


def crc_x25(data):
    """The developer guide's checksum, bit by bit."""
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ 0x8408 if crc & 1 else crc >> 1
    return crc


def frame(message, payload, system=1, component=1):
    payload = payload.rstrip(b"\0") or b"\0"
    body = struct.pack("<BBBBBB", len(payload), 0, 0, 0, system, component) + message.to_bytes(3, "little") + payload
    return b"\xFD" + body + struct.pack("<H", crc_x25(body + bytes([EXTRAS[message]])))


def heartbeat(mode, armed):
    base = 1 | (128 if armed else 0)
    return frame(HEARTBEAT, struct.pack("<IBBBBB", mode, 2, 3, base, 4, 3))


def injection(unit, failure, instance=0):
    payload = struct.pack("<7fHBBB", unit, failure, instance, 0, 0, 0, 0, 420, 245, 191, 0)
    return frame(COMMAND_LONG, payload, 255, 190)


class Peer:
    """A vehicle or a ground station on a UDP socket."""

    def __init__(self, port=None):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.to = ("127.0.0.1", port)
        self.own_port = self.socket.getsockname()[1]

    def send(self, data):
        self.socket.sendto(data, self.to)

    def next(self, message, patience=5):
        """The payload of the next such frame from skyloop, with its sender's address."""
        end = time.monotonic() + patience
        while time.monotonic() < end:
            self.socket.settimeout(max(end - time.monotonic(), 0.01))
            try:
                data, sender = self.socket.recvfrom(4096)
            except (socket.timeout, ConnectionRefusedError):
                continue
            size, found = data[1], int.from_bytes(data[7:10], "little")
            assert data[0] == 0xFD and (data[5], data[6]) == (245, 191), data.hex()
            assert struct.unpack_from("<H", data, 10 + size)[0] == crc_x25(data[1:10 + size] + bytes([EXTRAS[found]]))
            if found == message:
                return data[10:10 + size], sender
        raise AssertionError(f"no message {message} within {patience} s")

    def ask(self, *what):
        """Injects a failure; gives the result that is acknowledged."""
        self.send(injection(*what))
        command, result = struct.unpack_from("<HB", self.next(COMMAND_ACK)[0].ljust(10, b"\0"))
        assert command == 420
        return result

    def close(self):
        self.socket.close()


class MavlinkTest(unittest.TestCase):
    def setUp(self):
        folder = open_folder()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        self.scenario = self.path / "vehicle.toml"
        self.scenario.write_text(SCENARIO)

    def run_with(self, *options):
        emulator = Emulator(self.scenario, "--port", "pty", *options)
        self.addCleanup(emulator.__exit__)
        return emulator

    def peer_of(self, emulator):
        port = emulator.said(r"^mavlink: udp:127.0.0.1:(\d+) \(system 245, component 191\)$")
        peer = Peer(int(port))
        self.addCleanup(peer.close)
        return peer

    def events(self, folder):
        return [json.loads(line) for line in (folder / "commands.jsonl").read_text().splitlines()]

    def test_a_vehicle_steers_a_run_that_is_repeated_byte_by_byte(self):
        first, again = self.path / "first", self.path / "again"
        emulator = self.run_with("--mavlink", "udp:0", "--record", first, "--duration", 14)
        peer = self.peer_of(emulator)
        client = open_client(emulator.tty)
        peer.send(heartbeat(LOITER, True))
        alive = struct.unpack("<IBBBBB", peer.next(HEARTBEAT)[0].ljust(9, b"\0"))
        self.assertEqual(alive[1:3], (18, 8), "an onboard controller that is no autopilot")
        self.assertTrue(read_for(client, 1.5))
        self.assertEqual(peer.ask(GPS, OFF), ACCEPTED)
        self.assertEqual(peer.ask(GPS, OFF), ACCEPTED)
        read_for(client, 1)  # what has left the receiver before is still on the line
        self.assertEqual(read_for(client, 1.5), b"", "the port is silent")
        self.assertEqual(peer.ask(GYRO, OFF), UNSUPPORTED)
        self.assertEqual(peer.ask(GPS, OFF, 2), DENIED)
        self.assertEqual(peer.ask(GPS, OK), ACCEPTED)
        self.assertTrue(read_for(client, 1.5), "it speaks again")
        peer.send(heartbeat(AUTO, True))
        read_for(client, 4.5)
        self.assertEqual(emulator.finish(), 0, emulator.log)

        happened = [(e["event"], e["name"], e.get("source")) for e in self.events(first)]
        started = ("command", "start_fault", "mavlink")
        self.assertEqual(happened.count(started), 2)
        happened.reverse()
        happened.remove(started)  # the same again: written down, and of no effect
        happened.reverse()
        self.assertEqual(happened, [("command", "vehicle_state", "mavlink"), started,
                                    ("fault_begins", "mavlink off 1", None), ("command", "stop_fault", "mavlink"),
                                    ("fault_ends", "mavlink off 1", None), ("command", "vehicle_state", "mavlink"),
                                    ("fault_begins", "mission", None), ("fault_ends", "mission", None)])
        run_to_end("simulate", self.scenario, "--repeat", first, "--duration", 14, "--out", again)
        for name in ("port0.out", "port0.in", "fixes.csv"):
            self.assertEqual((again / name).read_bytes(), (first / name).read_bytes(), name)
        times = [[(e["event"], e.get("name"), e["gps_ns"]) for e in self.events(folder) if e["event"] != "command"]
                 for folder in (first, again)]
        self.assertEqual(*times)

    def test_what_is_no_mavlink_harms_nobody(self):
        emulator = self.run_with("--mavlink", "udp:0", "--record", self.path / "out")
        peer, wild = self.peer_of(emulator), None
        peer.send(heartbeat(LOITER, False))
        peer.next(HEARTBEAT)
        wild = Peer(peer.to[1])
        self.addCleanup(wild.close)
        before = self.memory(emulator)
        broken = bytearray(injection(GPS, OFF))
        broken[12] ^= 1
        for data in (b"", b"\xFD", b"\xFE\xFF", injection(GPS, OFF)[:-1], bytes(broken), bytes(60_000),
                     b"\xFD" * 2048, b"\xFE" * 2048, heartbeat(AUTO, True) * 100):
            wild.send(data)
        end, sent = time.monotonic() + 3, 0
        while time.monotonic() < end:
            for _ in range(100):
                wild.send(injection(GPS, 1 + sent % 7) if sent % 2 else bytes(broken))
                sent += 1
            time.sleep(0.002)
        print(f"{sent / 3:.0f} datagrams a second were sent")
        # Its own socket's queue is full of what came before.
        time.sleep(0.5)
        quiet = Peer(peer.to[1])
        self.addCleanup(quiet.close)
        quiet.send(heartbeat(LOITER, False))
        quiet.next(HEARTBEAT)
        self.assertIn(quiet.ask(GPS, OK), (ACCEPTED, TEMPORARILY_REJECTED))
        self.assertLess(self.memory(emulator) - before, 32 << 20)
        self.assertEqual(emulator.stop(), 0, emulator.log)
        commands = [e for e in self.events(self.path / "out") if e["event"] == "command"]
        self.assertLess(len(commands), 300, "a few seconds of at most 20 failures a second, each with its end")

    def memory(self, emulator):
        status = pathlib.Path(f"/proc/{emulator.process.pid}/statm").read_text().split()
        return int(status[1]) * resource.getpagesize()

    def test_it_speaks_first_where_it_is_told_to(self):
        vehicle = Peer()
        self.addCleanup(vehicle.close)
        emulator = self.run_with("--mavlink", f"udpout:127.0.0.1:{vehicle.own_port}")
        _, vehicle.to = vehicle.next(HEARTBEAT)
        self.assertEqual(vehicle.ask(GPS, OFF), ACCEPTED)
        self.assertEqual(emulator.stop(), 0, emulator.log)

    def test_who_waits_for_a_vehicle_is_told_when_there_is_none(self):
        for command in (("check",), ("simulate", "--duration", 1, "--out", self.path / "x")):
            done = run_to_end(*command, self.scenario)
            self.assertRegex(done.stderr, r"'mission' will not begin: .*expected skyloop run --mavlink")
        check = run_to_end("check", self.scenario)
        self.assertRegex(check.stdout, r"mission: the vehicle's mode is AUTO and the vehicle is armed")
        emulator = self.run_with("--duration", 1)
        emulator.finish()
        self.assertEqual(len(re.findall("'mission' will not begin", emulator.log)), 1)

    def test_mistakes_are_told(self):
        for address in ("udp:x", "tcp:1", "udpout:14550"):
            done = run_to_end("run", self.scenario, "--port", "-", "--mavlink", address, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertRegex(done.stderr, r"no MAVLink address; expected udp:\[HOST:\]PORT or udpout:HOST:PORT")
        self.scenario.write_text(SCENARIO.replace('"AUTO"', '"AUTOO"'))
        done = run_to_end("check", self.scenario, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"vehicle.toml:8:\d+: fault.when_mavlink_mode: is 'AUTOO'.*did you mean 'AUTO'")


if __name__ == "__main__":
    unittest.main()
