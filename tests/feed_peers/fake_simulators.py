"""Simulators that fly a climbing circle and speak as the real ones do, from their descriptions (FEEDS.md 3.5 to 3.7).

They know nothing of the project's decoders. As programs: fake_simulators.py xplane|ardupilot|px4|airsim PORT SECONDS.
"""
import json
import math
import socket
import struct
import sys
import time

EARTH_M = 6371000.0


class Flight:
    """A circle of 200 m with 25 m/s and a climb of 2 m/s, banked into the turn. All of it from formulas."""

    LATITUDE, LONGITUDE, HEIGHT = 47.3977, 8.5456, 500.0
    RADIUS, SPEED, CLIMB = 200.0, 25.0, 2.0

    def __init__(self, seconds):
        turn = self.SPEED / self.RADIUS
        angle = turn * seconds
        self.seconds = seconds
        self.ned = (self.RADIUS * math.sin(angle), self.RADIUS * (1 - math.cos(angle)), -self.CLIMB * seconds)
        self.velocity = (self.SPEED * math.cos(angle), self.SPEED * math.sin(angle), -self.CLIMB)
        self.yaw = math.atan2(math.sin(angle), math.cos(angle))
        self.pitch = math.atan2(self.CLIMB, self.SPEED)
        self.roll = math.atan(self.SPEED * turn / 9.81)
        self.rates = (-turn * math.sin(self.pitch), turn * math.cos(self.pitch) * math.sin(self.roll),
                      turn * math.cos(self.pitch) * math.cos(self.roll))

    def quaternion(self):
        """Body (forward, right, down) to north, east, down; w first."""
        (sr, cr), (sp, cp), (sy, cy) = ((math.sin(a / 2), math.cos(a / 2)) for a in (self.roll, self.pitch, self.yaw))
        return (cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
                cr * cp * sy - sr * sp * cy)

    def place(self):
        """Latitude, longitude and height on the WGS-84 ellipsoid's radii of curvature at the circle's start."""
        e2, a = 0.00669437999014, 6378137.0
        sine = math.sin(math.radians(self.LATITUDE))
        prime = a / math.sqrt(1 - e2 * sine * sine)
        meridian = prime * (1 - e2) / (1 - e2 * sine * sine)
        latitude = self.LATITUDE + math.degrees(self.ned[0] / (meridian + self.HEIGHT))
        longitude = self.LONGITUDE + math.degrees(
            self.ned[1] / ((prime + self.HEIGHT) * math.cos(math.radians((self.LATITUDE + latitude) / 2))))
        return latitude, longitude, self.HEIGHT - self.ned[2]


class FakeXplane:
    """Answers subscriptions of RPOS and RREF with packets for each frame."""

    NAMES = ("sim/time/total_running_time_sec", "sim/time/paused")

    def __init__(self):
        self.rate = 0
        self.references = {}
        self.paused = False

    def hear(self, datagram):
        if datagram[:5] == b"RPOS\0":
            # As X-Plane 11 and 12: letters up to the first that is none; an integer of 50 is a "2", most others stop it.
            text = datagram[5:].split(b"\0")[0]
            self.rate = int(text) if text.isdigit() else 0
        elif datagram[:5] == b"RREF\0" and len(datagram) == 413:
            rate, index = struct.unpack_from("<ii", datagram, 5)
            name = datagram[13:].split(b"\0")[0].decode()
            if rate and name in self.NAMES:
                self.references[index] = name
            else:
                self.references.pop(index, None)

    def frame(self, flight):
        packets = []
        if self.references:
            values = {self.NAMES[0]: flight.seconds, self.NAMES[1]: float(self.paused)}
            packets.append(b"RREF," + b"".join(struct.pack("<if", index, values[name])
                                               for index, name in sorted(self.references.items())))
        if self.rate:
            latitude, longitude, height = flight.place()
            north, east, down = flight.velocity
            packets.append(b"RPOS4" + struct.pack("<3d10f", longitude, latitude, height, height - 400,
                                                  math.degrees(flight.pitch), math.degrees(flight.yaw) % 360,
                                                  math.degrees(flight.roll), east, -down, -north, *flight.rates))
        return packets


class FakePhysics:
    """What a program answers SITL's servo packets."""

    @staticmethod
    def answer(servos, flight):
        magic, rate, _ = struct.unpack_from("<HHI", servos)
        if (magic, len(servos)) not in ((18458, 40), (29569, 72)) or rate == 0:
            return b""
        state = {"timestamp": flight.seconds, "imu": {"gyro": flight.rates, "accel_body": [0, 0, -9.81 / math.cos(flight.roll)]},
                 "position": flight.ned, "quaternion": flight.quaternion(), "velocity": flight.velocity}
        return ("\n" + json.dumps(state, separators=(",", ":")) + "\n").encode()


def servo_packet(count):
    """SITL's side: sixteen servos in the middle."""
    return struct.pack("<HHI16H", 18458, 400, count, *[1500] * 16)


def crc_x25(data):
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ 0x8408 if crc & 1 else crc >> 1
    return crc


def mavlink(message, extra, payload, version=2):
    if version == 2:
        payload = payload.rstrip(b"\0") or b"\0"
        body = struct.pack("<BBBBBB", len(payload), 0, 0, 0, 1, 1) + message.to_bytes(3, "little") + payload
        return b"\xFD" + body + struct.pack("<H", crc_x25(body + bytes([extra])))
    body = struct.pack("<BBBBB", len(payload), 0, 1, 1, message) + payload
    return b"\xFE" + body + struct.pack("<H", crc_x25(body + bytes([extra])))


class FakePx4Simulator:
    """HIL_SENSOR of each step, HIL_STATE_QUATERNION with it, HIL_GPS now and then."""

    @staticmethod
    def step(flight, version=2):
        time_us = round(flight.seconds * 1e6) + 1
        latitude, longitude, height = flight.place()
        lat, lon, alt = round(latitude * 1e7), round(longitude * 1e7), round(height * 1e3)
        velocity = [round(v * 100) for v in flight.velocity]
        sensor = struct.pack("<Q13fI", time_us, 0, 0, -9.8, *flight.rates, 0.2, 0, 0.4, 950, 0, 500, 20, 0x1FFF)
        truth = struct.pack("<Q4f3f3i3h2H3h", time_us, *flight.quaternion(), *flight.rates, lat, lon, alt, *velocity, 2500,
                            2500, 0, 0, -1000)
        receiver = struct.pack("<Q3i3H3hHBB", time_us, lat + 99, lon, alt, 30, 40, 2500, *velocity, 0, 3, 10)
        return (mavlink(107, 108, sensor, version) + mavlink(115, 4, truth, version) + mavlink(113, 124, receiver, version))


class FakeAirsim:
    """The project's JSON lines, as the example for Unreal sends them."""

    @staticmethod
    def lines(flight):
        origin = {"type": "origin", "lla": [Flight.LATITUDE, Flight.LONGITUDE, Flight.HEIGHT], "h_ref": "ell"}
        truth = {"type": "truth", "v": 1, "t": round(flight.seconds, 6), "ned": flight.ned, "vel_ned": flight.velocity,
                 "q": flight.quaternion()}
        return "".join(json.dumps(line) + "\n" for line in (origin, truth)).encode()


def serve(what, port, seconds, rate=50):
    """One of them in real time. X-Plane and PX4's simulator and the physics are servers, AirSim sends."""
    start = time.monotonic()
    kind = socket.SOCK_STREAM if what == "px4" else socket.SOCK_DGRAM
    with socket.socket(socket.AF_INET, kind) as own:
        if what != "airsim":
            own.bind(("127.0.0.1", port))
        if what == "px4":
            own.listen(1)
            own.settimeout(seconds)
            own = own.accept()[0]
        xplane, peer = FakeXplane(), ("127.0.0.1", port)
        # X-Plane hears at one port and sends from another.
        sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM) if what == "xplane" else own
        while time.monotonic() - start < seconds:
            flight = Flight(time.monotonic() - start)
            if what == "ardupilot":
                own.settimeout(0.5)
                try:
                    servos, peer = own.recvfrom(2048)
                except socket.timeout:
                    continue
                own.sendto(FakePhysics.answer(servos, flight), peer)
                continue
            if what == "xplane":
                own.setblocking(False)
                try:
                    while True:
                        datagram, peer = own.recvfrom(2048)
                        xplane.hear(datagram)
                except BlockingIOError:
                    pass
                for packet in xplane.frame(flight):
                    sender.sendto(packet, peer)
            elif what == "px4":
                own.sendall(FakePx4Simulator.step(flight))
            else:
                own.sendto(FakeAirsim.lines(flight), peer)
            time.sleep(1 / rate)


if __name__ == "__main__":
    serve(sys.argv[1], int(sys.argv[2]), float(sys.argv[3]))
