"""Betaflight: gpsConfigureUblox.

Specification 6.4 and 11. MON-VER three times at each speed, 330 ms apart; `$PUBX,41`, then two seconds; every setting
has 150 ms to be answered and steps are 110 ms apart at least; an answer that comes late would confirm the wrong step.
"""
import struct
import time

import nmea
import solutions
import ubx
from dialogue import Client

USER = 115200
SPEEDS = (115200, 230400, 57600, 38400, 19200, 9600)
HARDWARE = ("00040005", "00040007", "00070000", "00080000", "00190000", "000A0000")
POLL = 330
ANSWER = 150
APART = 0.11
PERIOD = 100
HEALTHY = 10.0
SETTLING = 4.0
SENTENCES = (0xF005, 0xF003, 0xF001, 0xF000, 0xF002, 0xF004)
SENTENCE_KEYS = (0x209100B0, 0x209100C4, 0x209100C9, 0x209100BA, 0x209100BF, 0x209100AB)  # I2C
NAV5_REST = bytes.fromhex("00000000 10270000 05 00 FA00 FA00 6400 2C01 00 3C 00 00 00000000 00 0000000000")


class Betaflight(Client):
    name = "Betaflight"
    after_power_on = 0.0
    rounds = 2

    def run(self):
        version = None
        for number in range(self.rounds):
            version = version or self.find(number)
        self.check(version is not None, f"MON-VER at one of {SPEEDS} in {self.rounds} rounds", None)
        self.check(version.hardware in HARDWARE, f"a hardware version of {HARDWARE}", version.hardware)
        self.raise_speed()
        self.asked.clear()
        self.strict_acks = True
        self.configure()
        self.fly()

    def find(self, number):
        for speed in SPEEDS:
            self.step(f"round {number + 1}: MON-VER at {speed} baud")
            self.speed(speed)
            for _ in range(3):
                version = self.version(POLL)
                if version:
                    return version
        return None

    def raise_speed(self):
        self.step(f"$PUBX,41 to {USER}")
        if self.wire.speed == USER:
            return
        self.send(nmea.sentence(f"PUBX,41,1,0003,0001,{USER},0"), f"$PUBX,41 to {USER}")
        self.pump(0.99)
        self.speed(USER)
        self.pump(1.0)
        self.step("MON-VER at the new speed")
        self.check(self.version(ANSWER) is not None, f"MON-VER within {ANSWER} ms", None)

    def ask(self, what, data, message):
        """One step: an answer of either kind within 150 ms, and 110 ms at least until the next."""
        self.step(what)
        began = time.monotonic()
        answer = self.set(data, message, ANSWER, nak_is_good=True)
        self.pump(max(0.0, APART - (time.monotonic() - began)))
        return answer

    def must(self, what, data, message):
        """As ask(), of a setting that every receiver of this kind has."""
        self.check(self.ask(what, data, message), "ACK-ACK", "ACK-NAK")

    def configure(self):
        keys, m10 = self.board.has_keys, self.board.generation == 10
        self.rate(1000)
        if keys:
            ports = (0, 1, 4)  # I2C, UART1, SPI
            pairs = [(key + port, 0) for key in SENTENCE_KEYS for port in ports]
            self.must("NMEA off", ubx.valset(pairs), "CFG-VALSET")
        else:
            for message in SENTENCES:
                self.must(f"sentence {message:04X} off", ubx.cfg_msg(message, 0), "CFG-MSG")
        if m10:
            self.must("dynamic model", ubx.valset([
                (0x20110011, 3), (0x2011001C, 0), (0x20110021, 8), (0x201100A4, 5), (0x301100B1, 250),
                (0x301100B2, 250), (0x301100B3, 100), (0x301100B4, 300), (0x401100C1, 0), (0x401100C2, 10000),
                (0x201100C4, 60), (0x20250038, 0)]), "CFG-VALSET")
            self.must("AssistNow Autonomous", ubx.valset([(0x10230001, 1)]), "CFG-VALSET")
        else:
            self.must("dynamic model", ubx.cfg_nav5(0xFFFF, 8, 3, NAV5_REST), "CFG-NAV5")
            self.ask("AssistNow Autonomous", ubx.frame("CFG-NAVX5", struct.pack("<HHI", 2, 0x4000, 0) + bytes(19) +
                                                       b"\x01" + bytes(12)), "CFG-NAVX5")
        if keys:
            self.must("SBAS", ubx.valset([(0x10360002, 0), (0x10360003, 1), (0x10360004, 1), (0x10360005, 0),
                                          (0x50360006, 0)]), "CFG-VALSET")
        else:
            self.must("SBAS", ubx.frame("CFG-SBAS", struct.pack("<BBBBI", 3, 3, 3, 0, 0)), "CFG-SBAS")
        if m10:
            self.must("full power", ubx.valset([(0x20D00001, 0)]), "CFG-VALSET")
        elif not keys:
            self.must("full power", ubx.frame("CFG-PMS", bytes(8)), "CFG-PMS")
        self.messages()
        self.rate(PERIOD)
        self.systems()

    def messages(self):
        """The old CFG-MSG is used for what is switched off, with every generation."""
        if self.board.has_keys:
            self.must("NAV-PVT", ubx.valset([(0x20910007, 1)]), "CFG-VALSET")
        else:
            self.must("NAV-PVT", ubx.cfg_msg("NAV-PVT", 1), "CFG-MSG")
            self.must("NAV-SOL off", ubx.cfg_msg("NAV-SOL", 0), "CFG-MSG")
        for message, rate in (("NAV-POSLLH", 0), ("NAV-STATUS", 0), ("NAV-VELNED", 0), ("NAV-DOP", 0), ("NAV-SAT", 5)):
            self.must(f"{message} at rate {rate}", ubx.cfg_msg(message, rate), "CFG-MSG")

    def rate(self, period):
        if self.board.has_keys:
            self.must(f"rate {period} ms", ubx.valset([(0x30210001, period), (0x30210002, 1), (0x20210003, 1)]),
                      "CFG-VALSET")
        else:
            self.must(f"rate {period} ms", ubx.cfg_rate(period, 1, 1), "CFG-RATE")

    def systems(self):
        """CFG-GNSS polled and written back with its own bytes, GPS and SBAS enabled."""
        self.step("CFG-GNSS")
        found = self.poll(ubx.frame("CFG-GNSS"), "CFG-GNSS", ANSWER, nak_is_good=self.board.generation == 10)
        if found is None:
            return
        payload = bytearray(found.payload)
        self.check(len(payload) == 4 + 8 * payload[3], "blocks of CFG-GNSS as counted", payload.hex(" "))
        for block in range(payload[3]):
            if payload[4 + 8 * block] in (0, 1):
                payload[8 + 8 * block] |= 1
        self.must("CFG-GNSS written back", ubx.frame("CFG-GNSS", bytes(payload)), "CFG-GNSS")

    def fly(self):
        self.step("solutions")
        items = self.collect(SETTLING + HEALTHY)
        solutions.check_kinds(self, items, ["NAV-PVT", "NAV-SAT"])
        solutions.check_alive(self, items, 2500)
        steady = [item for item in items if item.time > items[-1].time - HEALTHY]
        solutions.check_solutions(self, steady, PERIOD, 2500, HEALTHY)
        satellites = solutions.of(steady, "NAV-SAT")
        least = int(HEALTHY * 1000 / PERIOD / 5) - 2
        self.check(len(satellites) >= least, f"at least {least} NAV-SAT, one of five epochs", len(satellites))
        for frame in satellites:
            self.check(frame.size <= 776, "NAV-SAT that fits Betaflight's buffer of 776 bytes", frame.size)
            self.check(frame.payload[4] == 1 and len(frame.payload) == 8 + 12 * frame.payload[5],
                       "NAV-SAT version 1 with the satellites it counts", frame.payload[:8].hex(" "))
        self.step("at arming: flight model, NAV-SAT off")
        self.must("NAV-SAT off", ubx.cfg_msg("NAV-SAT", 0), "CFG-MSG")
        self.pump(0.5)
        later = self.collect(2.0)
        self.check(not solutions.of(later, "NAV-SAT"), "no NAV-SAT any more", solutions.kinds(later))
        solutions.check_alive(self, later, 2500)
