"""ArduPilot: AP_GPS's hunt for the speed and the steps of AP_GPS_UBLOX, old and key by key; its NMEA reader.

Specification 6.2 and 11. 1200 ms at each speed, a u-blox is recognised only at 230400; then a request every 300 ms,
every rate read back until it is as wanted; the settings saved after 5 s; solutions more than 245 ms apart are late.
"""
import collections
import struct
import time

import nmea
import receiver
import solutions
import ubx
from dialogue import Client

SPEEDS = (9600, 115200, 4800, 19200, 38400, 57600, 230400, 460800)
SLOT = 1.2
TARGET = 230400
STEP = 0.3
BLOB = (ubx.cfg_msg("NAV-SOL", 1) + nmea.sentence("PUBX,41,1,0023,0001,230400,0") +
        b"$PSRF100,0,38400,8,1,0*3C\r\n" + b"CONFIG COM1 230400 8 n 1\r\nGNGGA 0.2\r\n")
PERIOD = 200
HEALTHY = 10.0
LATE = 245
UART1 = 1
RATES = {"NAV-PVT": 1, "NAV-POSLLH": 0, "NAV-STATUS": 0, "NAV-SOL": 0, "NAV-VELNED": 0, "NAV-TIMEGPS": 5, "NAV-DOP": 1,
         "MON-HW": 5, "MON-HW2": 5, 0x0210: 0, "RXM-RAWX": 0}
TMODE = 0x20030001
RAWX = 0x209102A5  # CFG-MSGOUT-UBX_RXM_RAWX_UART1
M10_KEYS = [(0x10310022, 1), (0x1031000D, 0), (0x1031000F, 1), (0x10310025, 0), (0x10310024, 1), (0x10310012, 1),
            (0x10310014, 1), (0x20110021, 8)]


class Detector:
    """AP_GPS_UBLOX's detector: it keeps the low byte of a length and needs a payload that is not empty."""

    def __init__(self):
        self.step = self.length = self.count = self.a = self.b = 0

    def feed(self, value):
        """True at the end of a valid frame."""
        if self.step == 1:
            self.step = 2 if value == 0x62 else 0
        if self.step == 0 and value == 0xB5:
            self.step = 1
        elif self.step == 2 and value == 0x62:
            self.step, self.a, self.b = 3, 0, 0
        elif 3 <= self.step <= 6:
            self.sum(value)
            if self.step == 5:
                self.length = value
            self.step, self.count = self.step + 1, 0
        elif self.step == 7:
            self.sum(value)
            self.count += 1
            self.step += self.count == self.length
        elif self.step == 8:
            self.step = 9 if value == self.a else 0
        elif self.step == 9:
            self.step = 0
            return value == self.b
        return False

    def sum(self, value):
        self.a = (self.a + value) & 0xFF
        self.b = (self.b + self.a) & 0xFF


class ArduPilot(Client):
    """The steps of messages, which ArduPilot takes with every generation; M10 gets its signals by keys besides."""

    name = "ArduPilot"
    after_power_on = 0.0
    rounds = 3

    def run(self):
        self.find()
        self.configure()
        self.save()
        self.fly()

    # --- detection ---

    def find(self):
        for number in range(self.rounds):
            for speed in SPEEDS:
                self.step(f"round {number + 1}: {speed} baud")
                self.speed(speed)
                self.send(BLOB, "the strings of all receivers")
                if self.listen(speed):
                    return
        self.fail(f"a valid UBX frame in the {TARGET} slot of {self.rounds} rounds")

    def listen(self, speed):
        """One slot of the hunt; True when it ended with a recognised receiver."""
        detector, found, end = Detector(), False, time.monotonic() + SLOT
        while time.monotonic() < end and not found:
            data, at = self.wire.read(0.05)
            if data:
                self.take(data, at)
                found = any([detector.feed(value) for value in data]) and speed == TARGET
        return found

    # --- configuration ---

    def configure(self):
        self.strict_acks = False
        self.step("CFG-MSG NAV-PVT, CFG-PRT")
        self.rate_step("NAV-PVT")
        port = self.answer(ubx.frame("CFG-PRT"), "CFG-PRT")
        self.check(len(port.payload) == 20 and port.payload[0] == UART1, "CFG-PRT of UART1 in 20 bytes",
                   port.payload.hex(" "))
        self.check(struct.unpack_from("<I", port.payload, 8)[0] == TARGET, f"CFG-PRT at {TARGET} baud",
                   struct.unpack_from("<I", port.payload, 8)[0])
        in_mask, out_mask = struct.unpack_from("<HH", port.payload, 12)
        self.check(out_mask == 0x0001, "UBX alone going out ($PUBX,41 with mask 0001)", f"{out_mask:04X}")
        self.check(in_mask & 0x0003 == 0x0003, "UBX and NMEA coming in ($PUBX,41 with mask 0023)", f"{in_mask:04X}")
        self.rate()
        self.answer(ubx.frame("NAV-SVINFO"), "NAV-SVINFO", is_config=False, may_be_silent=True)
        for message in list(RATES)[1:]:
            self.rate_step(message)
        self.navigation()
        version = self.answer(ubx.frame("MON-VER"), "MON-VER", is_config=False)
        self.check_version(ubx.mon_ver(version.payload))
        if self.board.is_f9p or self.board.generation == 10:
            self.key_step(TMODE, None, nak_is_good=not self.board.is_f9p)
        if self.board.generation == 10:
            for key, value in M10_KEYS:
                self.key_step(key, value)

    def answer(self, request, message, is_config=True, may_be_silent=False, nak_is_good=False):
        """One step: the request and then what came within 300 ms; asked again, as the driver does, up to four times."""
        number = ubx.number(message)
        for _ in range(4):
            self.forget()
            self.send(request)
            end = time.monotonic() + STEP
            self.pump(STEP)
            found = self.matching(number)
            if found is not None and (is_config and self.rejected(number)) and not nak_is_good:
                self.fail(f"{ubx.name(number)}", "an ACK-NAK besides")
            if found is not None or may_be_silent or (is_config and nak_is_good and self.rejected(number)):
                self.pump(max(0.0, end - time.monotonic()))
                return found
        self.fail(f"{ubx.name(number)} within {STEP * 1000:.0f} ms of one of four requests")

    def matching(self, number):
        for item in self.pending:
            if isinstance(item, ubx.Frame) and item.message == number:
                return item
        return None

    def rejected(self, number):
        wanted = bytes((number >> 8, number & 0xFF))
        return any(isinstance(i, ubx.Frame) and i.message == 0x0500 and i.payload == wanted for i in self.pending)

    def rate_step(self, message):
        """CFG-MSG polled, set where it differs, and polled again until it is as wanted."""
        wanted, number = RATES[message], ubx.number(message)
        for _ in range(4):
            self.step(f"CFG-MSG {ubx.name(number)}")
            found = self.answer(ubx.cfg_msg_poll(number), "CFG-MSG", nak_is_good=True)
            if found is None:
                # Only a rate that is told ends these steps of the driver (_verify_rate()).
                self.check(message not in ("NAV-PVT", "MON-HW", "MON-HW2"), f"a rate of {ubx.name(number)}", "ACK-NAK")
                return
            self.check(len(found.payload) == 8 and found.payload[:2] == bytes((number >> 8, number & 0xFF)),
                       f"CFG-MSG of {ubx.name(number)} with six rates", found.payload.hex(" "))
            if found.payload[2 + UART1] == wanted:
                return
            self.send(ubx.cfg_msg(number, wanted))
            self.pump(STEP)
        self.fail(f"CFG-MSG {ubx.name(number)} to read back rate {wanted}", found.payload.hex(" "))

    def rate(self):
        self.step("CFG-RATE")
        for _ in range(4):
            found = self.answer(ubx.frame("CFG-RATE"), "CFG-RATE")
            if found.payload == struct.pack("<HHH", PERIOD, 1, 0):
                return
            self.send(ubx.cfg_rate(PERIOD, 1, 0))
            self.pump(STEP)
        self.fail(f"CFG-RATE to read back {PERIOD}, 1, 0", found.payload.hex(" "))

    def navigation(self):
        """CFG-SBAS and CFG-GNSS are only looked at; the dynamic model is set to airborne 4 g and read back."""
        old = self.board.generation < 10
        self.step("CFG-SBAS")
        self.answer(ubx.frame("CFG-SBAS"), "CFG-SBAS", nak_is_good=not old)
        self.step("CFG-NAV5")
        for _ in range(4):
            found = self.answer(ubx.frame("CFG-NAV5"), "CFG-NAV5", nak_is_good=not old)
            if found is None or found.payload[2] == 8:
                break
            self.send(ubx.frame("CFG-NAV5", struct.pack("<HB", 1, 8) + found.payload[3:]))
            self.pump(STEP)
        self.check(found is None or found.payload[2] == 8, "CFG-NAV5 to read back dynModel 8",
                   found and found.payload.hex(" "))
        self.step("CFG-GNSS")
        found = self.answer(ubx.frame("CFG-GNSS"), "CFG-GNSS", nak_is_good=not old)
        self.check(found is None or len(found.payload) == 4 + 8 * found.payload[3], "blocks of CFG-GNSS as counted",
                   found and found.payload.hex(" "))
        self.step("CFG-TP5")
        self.answer(ubx.frame("CFG-TP5"), "CFG-TP5", nak_is_good=not old)

    def check_version(self, version):
        """The driver tells the generations apart by these texts."""
        self.step("MON-VER")
        wanted = {"ublox-m8": ("00080000", ""), "ublox-m9": ("00190000", "EXT CORE 4"),
                  "ublox-m10": ("000A0000", ""), "ublox-f10": ("000A0000", ""), "ublox-f9p": ("00190000", "EXT CORE 1")}[self.board.name]
        self.check(version.hardware == wanted[0] and version.software.startswith(wanted[1]),
                   f"hardware {wanted[0]}, software {wanted[1]}…", f"{version.hardware}, {version.software}")

    def key_step(self, key, wanted, nak_is_good=False):
        """CFG-VALGET of one key, CFG-VALSET to RAM and BBR where it differs, and CFG-VALGET again."""
        self.step(f"key {key:08X}")
        for _ in range(4):
            found = self.answer(ubx.valget([key]), "CFG-VALGET", nak_is_good=nak_is_good)
            if found is None:
                return
            pairs = ubx.valget_pairs(found.payload)
            self.check([pair[0] for pair in pairs] == [key], f"one pair of key {key:08X}", pairs)
            if wanted is None or pairs[0][1] == wanted:
                return
            self.send(ubx.valset([(key, wanted)], ubx.RAM | ubx.BBR))
            self.pump(STEP)
        self.fail(f"key {key:08X} to read back {wanted}", pairs)

    def save(self):
        self.step("CFG-CFG save after 5 s of solutions")
        self.pump(5.0)
        self.set(ubx.frame("CFG-CFG", struct.pack("<III", 0, 0x61F, 0)), "CFG-CFG", 1000)

    # --- flight ---

    def fly(self):
        """No solution late on average, times of week that are multiples of 50 ms, nothing but what was enabled."""
        self.step("solutions")
        self.asked.clear()
        self.strict_acks = True
        items = self.collect(HEALTHY)
        solutions.check_kinds(self, items, ["NAV-PVT", "NAV-TIMEGPS", "NAV-DOP", "MON-HW", "MON-HW2"] + self.also)
        frames, found = solutions.check_solutions(self, items, PERIOD, 4000, HEALTHY)
        intervals = [(b.time - a.time) * 1000 for a, b in zip(frames, frames[1:])]
        late = collections.Counter(interval > LATE for interval in intervals)[True]
        self.check(late <= 2, f"no solution more than {LATE} ms after the last (2 are forgiven to a busy machine)",
                   f"{late} of {len(intervals)}, the longest {max(intervals):.0f} ms")
        self.check(sum(intervals) / len(intervals) < 215, "a mean interval below 215 ms", intervals)
        self.check(all(pvt["itow"] % 50 == 0 for pvt in found), "times of week in multiples of 50 ms",
                   [pvt["itow"] for pvt in found])
        solutions.check_each_epoch(self, items, ["NAV-DOP"])
        weeks = solutions.of(items, "NAV-TIMEGPS")
        self.check(8 <= len(weeks) <= 12, "NAV-TIMEGPS every fifth epoch", f"{len(weeks)} in {HEALTHY:g} s")

    also = []


class ArduPilotKeys(ArduPilot):
    """The configuration by keys alone: identity, a group of keys, the port, then compare and set in batches."""

    name = "ArduPilot by keys"
    wanted = [(0x30210001, PERIOD), (0x30210002, 1), (0x20910007, 1), (0x20910039, 1), (0x20910048, 5),
              (0x2091035A, 5), (0x20110021, 8)]
    also = ["MON-RF"]

    def configure(self):
        if self.board.name == "ublox-f10":
            # The driver asks every receiver with one UART for it; M10 is driven by messages, where it may be refused.
            self.wanted = self.wanted + [(RAWX, 0)]
        self.step("MON-VER every 200 ms")
        version = self.every(0.2, ubx.frame("MON-VER"), "MON-VER")
        version = ubx.mon_ver(version.payload)
        self.check(version.protocol == self.board.protocol, f"PROTVER={self.board.protocol}", version.extensions)
        self.step("CFG-VALGET of the group of signals every 550 ms")
        found = ubx.valget_pairs(self.every(0.55, ubx.valget([0x1031FFFF]), "CFG-VALGET").payload)
        self.check(found and all(key >> 16 & 0xFF == 0x31 for key, _ in found), "keys of group 31", found)
        self.check([k for k, _ in found] == sorted((k for k, _ in found), key=lambda k: k & 0xFFFFFFF),
                   "keys in ascending order", [f"{key:08X}" for key, _ in found])
        self.step("CFG-PRT and MON-COMMS every 250 ms")
        legacy = self.board.protocol < (40, 0)
        if legacy:
            port = self.every(0.25, ubx.frame("CFG-PRT"), "CFG-PRT")
            self.check(port.payload[0] == UART1, "port 1", port.payload.hex(" "))
        comms = self.every(0.25, ubx.frame("MON-COMMS"), "MON-COMMS").payload
        ports = [struct.unpack_from("<H", comms, 8 + 40 * n)[0] for n in range(comms[1])]
        self.check(len(comms) == 8 + 40 * comms[1] and 0x0100 in ports, "MON-COMMS with a block of port 0100",
                   comms.hex(" "))
        told = (comms[2] >> 2 & 7) - 1
        self.check(legacy or told == UART1, "port 1 in bits 2 to 4 of txErrors, where CFG-PRT is not answered", told)
        self.batches()
        self.page_layers()

    def every(self, period, request, message):
        """Polls every `period` seconds until the answer comes."""
        for _ in range(6):
            self.forget()
            self.send(request)
            found = self.wait_frame(message, period * 1000)
            if found:
                self.pump(0.1)  # its acknowledgement
                return found
        self.fail(f"{message} within {period * 1000:.0f} ms of one of six requests")

    def batches(self):
        """CFG-VALGET, compare, CFG-VALSET of what differs to all layers (of an M10 not to flash), until nothing does."""
        self.step("CFG-VALGET, compare, CFG-VALSET")
        self.changed = []
        for _ in range(4):
            answer = self.every(0.2, ubx.valget([key for key, _ in self.wanted]), "CFG-VALGET")
            found = dict(ubx.valget_pairs(answer.payload))
            different = [(key, value) for key, value in self.wanted if found.get(key) != value]
            if not different:
                return
            self.changed += different
            layers = ubx.RAM | ubx.BBR | (ubx.FLASH if self.board.has_flash else 0)
            self.set(ubx.valset(different, layers), "CFG-VALSET", 500)
        self.fail("all keys to read back as set", [f"{key:08X}" for key, _ in different])

    def page_layers(self):
        """What was set is what BBR and flash hold, page by page with the wildcard 0FFF0000."""
        layers = (ubx.READ_BBR, ubx.READ_FLASH) if self.board.has_flash else (ubx.READ_BBR,)
        for layer in layers if self.changed else ():
            self.step(f"CFG-VALGET of everything in layer {layer}")
            pairs, position = [], 0
            while True:
                answer = self.poll(ubx.valget([0x0FFF0000], layer, position), "CFG-VALGET", 1000)
                page = ubx.valget_pairs(answer.payload)
                pairs += page
                position += ubx.PAGE
                if len(page) < ubx.PAGE:
                    break
            for pair in self.changed:
                self.check(pair in pairs, f"key {pair[0]:08X} = {pair[1]} in layer {layer}", f"{len(pairs)} others")


class ArduPilotNmea(Client):
    """AP_GPS_NMEA: GGA and RMC of an epoch within 150 ms, terms shorter than 30 characters."""

    name = "ArduPilot NMEA"

    def run(self):
        self.step("sentences at the receiver's speed")
        self.speed(self.board.speed)
        self.pump(1.5)
        if self.board.name == "mtk3339":
            # At 9600 baud its GSV stands between GGA and RMC for too long; flight controllers run it at 38400.
            self.send(nmea.sentence("PMTK251,38400"))
            self.pump(0.2)
            self.speed(38400)
            self.pump(1.5)
        if self.board.name == "airoha-ag33xx":
            # So does its GSV of four systems and two bands at 115200 baud.
            self.send(nmea.sentence("PAIR062,3,0"))
            self.pump(1.5)
            self.forget()
        sentences = [i for i in self.collect(HEALTHY) if isinstance(i, ubx.Sentence)]
        for sentence in sentences:
            self.check(all(len(term) < 30 for term in sentence.fields), "terms of less than 30 characters", sentence)
        arrivals = collections.defaultdict(dict)
        for sentence in sentences:
            kind = sentence.fields[0][2:]
            if kind in ("GGA", "RMC"):
                arrivals[sentence.fields[1]][kind] = sentence.time
        whole = [a for a in list(arrivals.values())[1:-1]]
        self.check(len(whole) >= HEALTHY - 3, "GGA and RMC of every second", len(whole))
        for epoch in whole:
            self.check(len(epoch) == 2, "both GGA and RMC of an epoch", epoch)
            apart = abs(epoch["GGA"] - epoch["RMC"]) * 1000
            self.check(apart <= 150, "GGA and RMC within 150 ms", f"{apart:.0f} ms apart")
        last = [s for s in sentences if s.fields[0][2:] == "GGA"][-1].fields
        apart = receiver.metres_apart(nmea.degrees(last[2], last[3]), nmea.degrees(last[4], last[5]))
        self.check(last[6] != "0" and apart < 20, "a fix within 20 m of the scenario's place", f"{apart:.1f} m")
