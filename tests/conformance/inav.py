"""INAV: gpsProtocolStateThread and gpsConfigure.

Specification 6.3 and 11. `$PUBX,41` at six speeds, 100 ms each; MON-VER twice and MON-GNSS twice, 500 ms each; every
setting acknowledged; MON-GNSS every 5 s in flight; lost after 1 s without a solution.
"""
import struct
import time

import nmea
import solutions
import ubx
from dialogue import Client

SPEEDS = (115200, 57600, 38400, 19200, 9600, 230400)
TARGET = 115200
COMMAND = 500
MUST = 1000
PERIOD = 100
CAPABILITIES = 5.0
HEALTHY = 10.0
SETTLING = 4.0
# Everything but dynamic and fix model as a receiver has it from the factory: CFG-NAV5 from offset 4.
NAV5_REST = bytes.fromhex("00000000 10270000 05 00 FA00 FA00 6400 2C01 00 3C 00 00 00000000 00 0000000000")
SENTENCES = (0xF000, 0xF001, 0xF002, 0xF003, 0xF004, 0xF005)


class Inav(Client):
    name = "INAV"
    after_power_on = 3.5
    rounds = 3
    # With all systems NAV-SIG of two bands at 10 Hz is as much as the line carries, and solutions are lost.
    scenario = '[sky]\nconstellations = ["gps"]\n'

    def run(self):
        for number in range(self.rounds):
            self.step(f"round {number + 1}: $PUBX,41 at six speeds")
            self.change_speed()
            version = self.find_version()
            if version:
                break
        else:
            self.fail(f"MON-VER at {TARGET} baud in {self.rounds} rounds")
        self.check(version.protocol == self.board.protocol, f"PROTVER={self.board.protocol}", version.extensions)
        self.asked.clear()
        self.strict_acks = True
        self.find_capabilities()
        self.configure()
        self.fly()

    def change_speed(self):
        for speed in SPEEDS:
            self.speed(speed)
            self.send(nmea.sentence(f"PUBX,41,1,0003,0001,{TARGET},0"), f"$PUBX,41 to {TARGET}")
            self.wire.drain()
            self.pump(0.1)
        self.speed(TARGET)

    def find_version(self):
        self.step("MON-VER, twice")
        for _ in range(2):
            version = self.version(COMMAND)
            if version:
                return version
        return None

    def find_capabilities(self):
        self.step("MON-GNSS, twice")
        for _ in range(2):
            self.forget()
            self.send(ubx.frame("MON-GNSS"))
            found = self.wait_frame("MON-GNSS", COMMAND)
            if found:
                self.check_capabilities(found)
                return
        self.fail(f"MON-GNSS within {COMMAND} ms of one of two requests")

    def check_capabilities(self, found):
        self.check(len(found.payload) == 8 and found.payload[0] == 0 and found.payload[4] > 0,
                   "MON-GNSS of 8 bytes, version 0, more than no system at a time", found.payload.hex(" "))

    def configure(self):
        keys = self.board.has_keys
        self.step("dynamic model")
        if keys:
            self.set(ubx.valset([(0x20110021, 7), (0x20110011, 3)]), "CFG-VALSET", MUST)
        else:
            self.set(ubx.cfg_nav5(0xFFFF, 7, 3, NAV5_REST), "CFG-NAV5", MUST)
        self.step("NMEA off")
        if keys:
            self.set(ubx.valset([(0x209100BB, 0), (0x209100CA, 0), (0x209100C0, 0), (0x209100C5, 0), (0x209100AC, 0),
                                 (0x209100B1, 0)]), "CFG-VALSET", COMMAND)
            self.step("rates of messages")
            self.set(ubx.valset([(0x2091002A, 0), (0x2091001B, 0), (0x20910043, 0), (0x2091005C, 0), (0x20910007, 1),
                                 (0x20910346, 1), (0x20910016, 0)]), "CFG-VALSET", COMMAND)
        else:
            for message in SENTENCES:
                self.set(ubx.cfg_msg(message, 0), "CFG-MSG", MUST)
            for message, rate in (("NAV-POSLLH", 0), ("NAV-STATUS", 0), ("NAV-SOL", 0), ("NAV-VELNED", 0),
                                  ("NAV-TIMEUTC", 0), ("NAV-SVINFO", 0), ("NAV-PVT", 1), ("NAV-SAT", 1)):
                self.step(f"CFG-MSG {message}")
                self.set(ubx.cfg_msg(message, rate), "CFG-MSG", MUST)
        self.step("rate")
        if keys:  # its constant for the time reference is the key of the cycles: one key twice
            self.set(ubx.valset([(0x30210001, PERIOD), (0x30210002, 1), (0x30210002, 1)]), "CFG-VALSET", MUST)
        else:
            self.set(ubx.cfg_rate(PERIOD, 1, 1), "CFG-RATE", MUST)
        self.systems()

    def systems(self):
        self.step("CFG-SBAS")
        self.set(ubx.frame("CFG-SBAS", struct.pack("<BBBBI", 3, 3, 3, 0, 0)), "CFG-SBAS", COMMAND, nak_is_good=True)
        self.step("systems")
        if self.board.generation == 10:
            self.set(ubx.valset([
                (0x10310020, 1), (0x10310005, 1), (0x10310021, 1), (0x10310007, 1), (0x10310022, 1), (0x1031000D, 1),
                (0x1031000F, 0), (0x10310024, 1), (0x10310012, 1), (0x10310014, 1), (0x10310025, 0), (0x10310018, 0),
            ]), "CFG-VALSET", COMMAND, nak_is_good=True)
            return
        blocks = [(1, 1, 3, 1), (2, 0, 8, 0), (3, 0, 8, 0), (6, 4, 8, 1)]
        payload = struct.pack("<BBBB", 0, 0, 0xFF, len(blocks))
        for system, reserved, most, enabled in blocks:
            payload += struct.pack("<BBBBI", system, reserved, most, 0, 1 << 16 | enabled)
        self.set(ubx.frame("CFG-GNSS", payload), "CFG-GNSS", COMMAND, nak_is_good=True)

    def fly(self):
        self.step("solutions, MON-GNSS every 5 s")
        self.forget()
        items, began, asked = [], time.monotonic(), 0
        while time.monotonic() - began < SETTLING + HEALTHY:
            self.pump(CAPABILITIES - 0.5)
            items += self.pending
            self.forget()
            self.send(ubx.frame("MON-GNSS"))
            asked += 1
            self.pump(0.5)
        items += self.pending
        answers = solutions.of(items, "MON-GNSS")
        self.check(len(answers) == asked, f"MON-GNSS to each of {asked} requests", len(answers))
        for answer in answers:
            self.check_capabilities(answer)
        satellites = "NAV-SIG" if self.board.has_keys else "NAV-SAT"
        solutions.check_kinds(self, items, ["NAV-PVT", satellites, "MON-GNSS"])
        solutions.check_alive(self, items, 1000)
        steady = [item for item in items if item.time > items[-1].time - HEALTHY]
        solutions.check_solutions(self, steady, PERIOD, 1000, HEALTHY)
        solutions.check_each_epoch(self, steady, [satellites])
        for frame in solutions.of(steady, "NAV-SIG"):
            self.check(frame.payload[4] == 0 and len(frame.payload) == 8 + 16 * frame.payload[5],
                       "NAV-SIG version 0 with the signals it counts", frame.payload[:8].hex(" "))
