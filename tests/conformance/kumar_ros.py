"""KumarRobotics ublox: the ublox_gps node, whose settings are each acknowledged within a second or the node ends.

Specification 6.6. The node climbs its ladder of speeds without asking, up to the speed that its user told it.
"""
import struct

import solutions
import ubx
from dialogue import Client

SPEEDS = (4800, 9600, 19200, 38400, 57600, 115200, 230400, 460800)
REST = 0.5
ACK = 1000
REOPEN = 15.0
HEALTHY = 10.0
PERIOD = 250


class KumarRos(Client):
    name = "ublox_gps node"
    target = 115200

    def run(self):
        self.open_port()
        version = self.identify()
        self.configure(version)
        self.fly()
        self.shut_down()

    def open_port(self):
        """The ladder, then CFG-PRT: whoever keeps the receiver's speed is answered at that speed."""
        for speed in SPEEDS:
            self.step(f"ladder: {speed} baud")
            self.speed(speed)
            self.pump(REST)
            if speed == self.board.speed and self.try_port(speed):
                break
            if speed == self.target and self.try_port(speed):
                return
        else:
            self.fail("CFG-PRT acknowledged at the receiver's speed or at the wanted one")
        self.step(f"CFG-PRT to {self.target}; its acknowledgement may be lost")
        self.send(self.port(self.target))
        self.pump(REST)
        self.speed(self.target)
        self.step("CFG-PRT at the wanted speed")
        self.set(self.port(self.target), "CFG-PRT", ACK)

    @staticmethod
    def port(speed):
        return ubx.cfg_prt((1, 0x8D0, speed, 0x07, 0x01))

    def try_port(self, speed):
        self.forget()
        self.send(self.port(speed))
        return self.wait_ack("CFG-PRT", ACK)

    def identify(self):
        self.step("MON-VER")
        version = self.version(ACK)
        self.check(version is not None, f"MON-VER within {ACK} ms", None)
        systems = [line for line in version.extensions[-2:] if "SBAS" in line]
        self.check(bool(systems), "SBAS in one of the last two extensions", version.extensions)
        self.check(any("GPS" in line.split(";") for line in version.extensions[-2:]),
                   "GPS among systems split at semicolons", version.extensions)
        return version

    def configure(self, version):
        m10 = self.board.generation == 10
        for what, data, message, nak_is_good in (
                ("CFG-RATE", ubx.cfg_rate(PERIOD, 1, 1), "CFG-RATE", False),
                ("CFG-SBAS", ubx.frame("CFG-SBAS", struct.pack("<BBBBI", 1, 3, 3, 0, 0)), "CFG-SBAS", m10),
                ("CFG-NAVX5", ubx.frame("CFG-NAVX5", struct.pack("<HHI", 2, 0x2000, 0) + bytes(32)), "CFG-NAVX5", m10),
                ("CFG-NAV5 dynModel", ubx.cfg_nav5(0x0001, 0, 0), "CFG-NAV5", False),
                ("CFG-NAV5 fixMode", ubx.cfg_nav5(0x0004, 0, 3), "CFG-NAV5", False),
                ("CFG-NAV5 drLimit", ubx.cfg_nav5(0x0008, 0, 0), "CFG-NAV5", False)):
            self.step(what)
            self.set(data, message, ACK, nak_is_good)
        if self.board.generation == 8:
            self.systems()
        for message, rate in (("NAV-PVT", 1), ("NAV-SAT", 4), ("MON-HW", 4)):
            self.step(f"CFG-MSG {message}")
            # M10 documents no MON-HW; there the node goes on without it.
            self.set(ubx.cfg_msg(message, rate), "CFG-MSG", ACK, nak_is_good=m10 and message == "MON-HW")
        self.step("CFG-INF")
        self.set(ubx.frame("CFG-INF", bytes((0, 0, 0, 0)) + b"\x07" * 6), "CFG-INF", ACK)
        self.check(version.value_of("PROTVER") is not None, "a protocol version", version.extensions)

    def systems(self):
        """Firmware 8: CFG-GNSS polled, changed, and the receiver's navigation started anew."""
        self.step("CFG-GNSS poll")
        found = self.poll(ubx.frame("CFG-GNSS"), "CFG-GNSS", ACK)
        payload = bytearray(found.payload)
        self.check(payload[3] == (len(payload) - 4) // 8 and payload[3] >= 5, "at least 5 blocks", payload.hex(" "))
        for block in range(payload[3]):
            if payload[4 + 8 * block] == 6:  # GLONASS
                payload[8 + 8 * block] ^= 1
        self.step("CFG-GNSS changed")
        self.set(ubx.frame("CFG-GNSS", bytes(payload)), "CFG-GNSS", ACK)
        self.step("CFG-RST: cold, navigation alone; no answer")
        self.send(ubx.frame("CFG-RST", struct.pack("<HBB", 0xFFFF, 2, 0)))
        self.pump(1.0)
        self.step(f"any answer within {REOPEN:g} s after it")
        for _ in range(int(REOPEN)):
            if self.version(ACK):
                return
        self.fail(f"MON-VER within {REOPEN:g} s of the restart")

    def fly(self):
        """A cold start has no fix for half a minute: the node publishes what comes."""
        self.step("solutions")
        items = self.collect(HEALTHY)
        solutions.check_alive(self, items, 3 * PERIOD)
        count = len(solutions.of(items, "NAV-PVT"))
        self.check(count >= 0.9 * HEALTHY * 1000 / PERIOD, f"NAV-PVT every {PERIOD} ms", count)
        if self.board.generation == 8:
            first = ubx.nav_pvt(solutions.of(items, "NAV-PVT")[0].payload)
            self.check(first["fix_type"] == 0, "no fix so soon after a cold start", first["fix_type"])
        else:
            solutions.check_fix(self, ubx.nav_pvt(solutions.of(items, "NAV-PVT")[-1].payload))
        self.check(len(solutions.of(items, "NAV-SAT")) >= count // 4 - 2, "NAV-SAT of every fourth epoch",
                   solutions.kinds(items))

    def shut_down(self):
        self.step("CFG-RST: navigation stopped; real receivers do not acknowledge it")
        self.send(ubx.frame("CFG-RST", struct.pack("<HBB", 0, 8, 0)))
        self.pump(1.0)
        later = self.collect(2.0)
        self.check(not solutions.of(later, "NAV-PVT"), "no NAV-PVT once navigation is stopped", solutions.kinds(later))
        self.step("CFG-CFG save")
        self.set(ubx.frame("CFG-CFG", struct.pack("<IIIB", 0, 0x1F1F, 0, 0x17)), "CFG-CFG", ACK)
        self.send(ubx.frame("CFG-RST", struct.pack("<HBB", 0, 9, 0)))
        self.step("navigation started again")
        self.pump(2.0)
        solutions.check_alive(self, self.collect(2.0), 3 * PERIOD)
