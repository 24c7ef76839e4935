"""Drivers of Unicore receivers: ArduPilot's types 24 and 25, PX4's UnicoreParser, rtkbase and SparkFun's RTK Everywhere.

Sums are computed here: those of answers cover their first character, CRC-32 is that of the logs.
"""
import math
import struct
import time

import nmea
import receiver
from dialogue import Client
from stream import StreamParser

HEALTHY = 6.0
PAIR = ('[[receiver]]\nname = "um982"\nbase = "slave"\n'
        '[[receiver]]\nname = "slave"\nboard = "unicore-um982"\nrate_hz = 10\nantenna_offset_m = [0.8, 0.6, 0]\n')
BASELINE, HEADING = 1.0, math.degrees(math.atan2(0.6, 0.8))  # of PAIR: the vehicle looks north

CRC_TABLE = []
for index in range(256):
    value = index
    for _ in range(8):
        value = value >> 1 ^ (0xEDB88320 if value & 1 else 0)
    CRC_TABLE.append(value)


def crc32(data):
    """Unicore's: as that of Ethernet, from 0 and without the last inversion."""
    crc = 0
    for byte in data:
        crc = crc >> 8 ^ CRC_TABLE[(crc ^ byte) & 0xFF]
    return crc


def xor(text):
    value = 0
    for char in text:
        value ^= ord(char)
    return f"{value:02X}"


class Line:
    """A line of text, with what its check makes of it: `sentence`, `answer`, `log` or `other`."""

    def __init__(self, text, at):
        self.text, self.time, self.kind, self.fields = text, at, "other", []
        body, _, said = text.rpartition("*")
        if nmea.fields(text):
            self.kind, self.fields = "sentence", nmea.fields(text)
        elif len(said) == 2 and xor(body) == said:
            self.kind, self.fields = "answer", body[1:].split(",")
        elif text.startswith("#") and len(said) == 8 and f"{crc32(body[1:].encode()):08x}" == said:
            self.kind, self.fields = "log", body[body.index(";") + 1:].split(",")

    @property
    def name(self):
        return self.text[1:].split(",")[0]

    def __str__(self):
        return self.text[:110]


class Frame:
    """A binary log whose CRC holds."""

    def __init__(self, data, at):
        self.id, self.payload, self.time = struct.unpack_from("<H", data, 4)[0], data[24:-4], at
        self.name = f"frame {self.id}"
        self.kind = "frame"

    def __str__(self):
        return f"{self.name}, {len(self.payload)} bytes"


class Parser(StreamParser):
    """Lines, binary logs and frames of RTCM 3 (as Frame with the message's number) from a stream."""

    def take(self, at, items):
        data = self.buffer
        if data[0] == 0xAA:
            return self.binary(data, at, items)
        if data[0] == 0xD3:
            return self.rtcm(data, at, items)
        if data[0] not in b"$#<":
            return 1
        end = data.find(b"\n")
        if end < 0:
            return 1 if len(data) > 20000 else 0
        items.append(Line(data[:end].rstrip(b"\r").decode("latin-1"), at))
        return end + 1

    @staticmethod
    def binary(data, at, items):
        if len(data) < 24:
            return 0 if b"\xaa\x44\xb5".startswith(data[:3]) else 1
        size = 28 + struct.unpack_from("<H", data, 6)[0]
        if data[:3] != b"\xaa\x44\xb5":
            return 1
        if len(data) < size:
            return 0
        if crc32(data[:size - 4]) != struct.unpack_from("<I", data, size - 4)[0]:
            return 1
        items.append(Frame(data[:size], at))
        return size

    @staticmethod
    def rtcm(data, at, items):
        if len(data) < 3:
            return 0
        size = 6 + ((data[1] & 3) << 8 | data[2])
        if len(data) < size:
            return 0
        item = Frame(b"\0" * 24 + data[3:size] + b"\0", at)
        item.id, item.kind = data[3] << 4 | data[4] >> 4, "rtcm"
        item.name = f"RTCM {item.id}"
        items.append(item)
        return size


class Unicore(Client):
    """What the drivers have in common."""

    after_power_on = 1.0

    def __init__(self, wire, board):
        super().__init__(wire, board)
        self.parser = Parser()

    def say(self, line):
        self.send(line.encode() + b"\r\n", line)

    def command(self, line, milliseconds=1500, verdict="OK"):
        """A command and its OK, to the letter."""
        self.step(line)
        self.forget()
        self.say(line)
        text = f"$command,{line},response: {verdict}"
        return self.need(lambda item: isinstance(item, Line) and item.text == f"{text}*{xor(text)}", milliseconds, text)

    def logged(self, name, milliseconds=1500):
        return self.need(lambda item: item.kind == "log" and item.name == name, milliseconds, f"#{name}")

    def check_agrica(self, line):
        fields = line.fields
        self.check(len(fields) == 57 and fields[0] == "GNSS" and "" not in fields, "57 fields, none of them empty", line)
        apart = receiver.metres_apart(float(fields[29]), float(fields[30]))
        self.check(apart < 20, "a position within 20 m of the scenario's", f"{apart:.1f} m")
        self.check(abs(float(fields[31]) + float(fields[50]) - receiver.PLACE[2]) < 40, "its height", fields[31])

    def check_heading(self, item):
        fields = item.fields
        self.check(len(fields) == 17 and "" not in fields, "17 fields, none of them empty", item)
        length, heading = float(fields[2]), float(fields[3])
        wrong = (heading - HEADING + 180) % 360 - 180
        self.check(abs(length - BASELINE) < 0.2 * BASELINE, f"a baseline within 20 % of {BASELINE} m", item)
        self.check(abs(wrong) < 0.5, f"a heading within 0.5 degrees of {HEADING:.2f}", item)


class ArduPilotUnicore(Unicore):
    """AP_GPS_NMEA of type 24: it hunts for the speed with the strings that set 230400 on all ports, then asks every 15 s for
    AGRICA, GGA and RMC, which must come together; AGRICA must never be missing for 500 ms."""

    name = "ArduPilot Unicore"
    speeds = (9600, 115200, 4800, 19200, 38400, 57600, 230400, 460800)
    setup = "\r\nCONFIG COM1 230400 8 n 1\r\nCONFIG COM2 230400 8 n 1\r\nCONFIG COM3 230400 8 n 1\r\nGPGGA 0.2\r\n"
    moving = ()

    def run(self):
        self.detect()
        for line in self.moving + ("AGRICA 0.200", "MODE MOVINGBASE", "GNGGA 0.200", "GNRMC 0.200"):
            self.say(line)
        self.forget()
        self.say("VERSIONA")
        fields = self.logged("VERSIONA", 5000).fields
        model = self.board.name[-5:].upper()
        self.check(fields[0] == f'"{model}"' and len(fields) == 6, f"the version of a {model}", fields)
        self.settle()
        self.follow(self.collect(HEALTHY))

    def detect(self):
        """1.2 s at each speed, until a sentence with NMEA's own sum comes."""
        for speed in self.speeds:
            self.step(f"a sentence at {speed} baud")
            self.speed(speed)
            self.send(b"\xb5\x62\x06\x01\x03\x00\x01\x07\x01\x13\x51" + self.setup.encode(), "blobs")
            if self.wait(lambda item: item.kind == "sentence", 1200):
                self.check(speed == 230400, "the speed that it has set", speed)
                return
        self.fail("a sentence at one of the speeds")

    def settle(self):
        self.pump(3)

    def follow(self, items):
        self.step("AGRICA, GGA and RMC")
        times = [item.time for item in items if item.kind == "log" and item.name == "AGRICA"]
        self.check(len(times) > 4.5 * HEALTHY, "AGRICA at 5 Hz", len(times))
        self.check(max(b - a for a, b in zip(times, times[1:])) < 0.5, "no 500 ms without AGRICA", times)
        pairs = {}
        for item in items:
            if item.kind == "sentence" and item.name in ("GNGGA", "GNRMC"):
                pairs.setdefault(item.fields[1], {})[item.name] = item
        whole = list(pairs.values())[1:-1]
        self.check(len(whole) > 4.5 * HEALTHY, "GGA and RMC at 5 Hz", len(whole))
        for pair in whole:
            self.check(len(pair) == 2 and abs(pair["GNGGA"].time - pair["GNRMC"].time) < 0.15,
                       "GGA and RMC within 150 ms", [str(item) for item in pair.values()])
            self.check(pair["GNGGA"].fields[6] in "1245" and pair["GNRMC"].fields[2] == "A", "a fix", pair["GNGGA"])
        for item in items:
            if item.kind == "log" and item.name == "AGRICA":
                self.check_agrica(item)


class ArduPilotUnicoreMoving(ArduPilotUnicore):
    """Type 25: yaw of heading status 4 and UNIHEADINGA, which may not be missing for 300 ms."""

    name = "ArduPilot Unicore, moving baseline"
    scenario = PAIR
    moving = ("CONFIG HEADING FIXLENGTH", "CONFIG UNDULATION AUTO", "CONFIG", "UNIHEADINGA 0.200")

    def settle(self):
        self.step("a heading whose ambiguities are whole")
        self.need(lambda item: item.kind == "log" and item.name == "AGRICA" and item.fields[9] == "4", 40000,
                  "AGRICA with heading status 4")

    def follow(self, items):
        super().follow(items)
        self.step("UNIHEADINGA")
        headings = [item for item in items if item.kind == "log" and item.name == "UNIHEADINGA"]
        times = [item.time for item in headings]
        self.check(len(times) > 4.5 * HEALTHY and max(b - a for a, b in zip(times, times[1:])) < 0.3,
                   "UNIHEADINGA at 5 Hz, never missing for 300 ms", len(times))
        for item in headings:
            self.check(item.fields[1] == "NARROW_INT", "whole ambiguities", item)
            self.check_heading(item)


class Px4Unicore(Unicore):
    """GPSDriverUnicore says nothing until AGRICA comes unasked, as its user has stored it; then it asks for what it misses.
    Its tokens swallow empty fields."""

    name = "PX4 Unicore"
    scenario = PAIR
    speeds = (9600, 19200, 38400, 57600, 115200, 230400)

    def run(self):
        self.speed(115200)
        for line in ("AGRICA COM1 0.2", "SAVECONFIG", "RESET"):
            self.command(line)
        self.pump(5)
        self.detect()
        for line in ("GPGGA COM1 0.2", "UNIAGRICA COM1 0.2", "UNIHEADINGA COM1 0.2", "GPGST COM1 1.0", "GPGSA COM1 1.0",
                     "GPRMC COM1 1.0"):
            self.command(line)
        self.step("a heading")
        self.need(lambda item: item.kind == "log" and item.name == "UNIHEADINGA" and item.fields[1] == "NARROW_INT", 40000,
                  "UNIHEADINGA with whole ambiguities")
        items = self.collect(HEALTHY)
        self.step("AGRICA and UNIHEADINGA")
        names = {item.name for item in items}
        self.check({"AGRICA", "UNIHEADINGA", "GNGGA", "GNGST", "GNGSA", "GNRMC"} <= names, "all that was asked for", names)
        for item in items:
            if item.name == "AGRICA":
                self.check_agrica(item)
            elif item.name == "UNIHEADINGA":
                self.check(float(item.fields[6]) > 0, "a standard deviation above 0", item)
                self.check_heading(item)

    def detect(self):
        for speed in self.speeds:
            self.step(f"AGRICA at {speed} baud")
            self.speed(speed)
            if self.wait(lambda item: item.kind == "log" and item.name == "AGRICA", 1500):
                return
        self.fail("AGRICA at one of the speeds")


class RtkBase(Unicore):
    """rtkbase's detection, and its setup of a base station: an exact OK within 2 s, in upper-case digits."""

    name = "rtkbase"
    lines = ("CONFIG SBAS ENABLE AUTO", "MODE BASE 1 TIME 60 1", "rtcm1006 10", "rtcm1033 10", "rtcm1077 1", "rtcm1087 1",
             "rtcm1097 1", "rtcm1127 1", "MASK 0", "SAVECONFIG")

    def run(self):
        self.detect()
        self.restarted("FRESET")
        self.restarted("CONFIG SIGNALGROUP 7 0" if self.board.name.endswith("982") else "CONFIG SIGNALGROUP 2")
        for line in self.lines:
            self.command(line, 2000)
        self.step("corrections")
        for number in (1077, 1087, 1097, 1127):
            self.need(lambda item, number=number: item.kind == "rtcm" and item.id == number, 30000, f"RTCM {number}")
        items = [item for item in self.collect(HEALTHY) if item.kind == "rtcm"]
        numbers = {item.id for item in items}
        self.check({1077, 1087, 1097, 1127} <= numbers, "RTCM 1077, 1087, 1097, 1127", numbers)
        self.check(1006 not in numbers, "no place before the survey of 60 s is over", numbers)
        for number in (1077, 1127):
            count = sum(item.id == number for item in items)
            self.check(abs(count - HEALTHY) <= 1, f"{number} each second", count)

    def detect(self):
        for speed in (115200, 57600, 38400, 19200, 9600):
            self.step(f"$VERSIONA at {speed} baud")
            self.speed(speed)
            self.send(b"\r\n")
            self.forget()
            self.send(b"$VERSIONA*1B\r\n")
            if self.wait(lambda item: getattr(item, "text", "") == "$command,VERSIONA,response: OK*45", 2000):
                fields = self.logged("VERSIONA", 2000).fields
                self.check(fields[0] in ('"UM980"', '"UM981"', '"UM982"'), "a known model", fields)
                return
        self.fail("$command,VERSIONA,response: OK*45 at one of the speeds")

    def restarted(self, line):
        self.command(line, 2000)
        self.need(lambda item: getattr(item, "text", "").startswith("$devicename,COM"), 10000, "$devicename")
        self.pump(2.5)


class SparkFunUnicore(Unicore):
    """SparkFun's library and RTK Everywhere at COM3: MODE three times, VERSIONB, CONFIG, then a rover."""

    name = "SparkFun RTK Everywhere, UM980"
    laid_to = "uart3"
    after_power_on = 3.0
    lines = ("MODE ROVER SURVEY", "GPGGA COM3 0.5", "GPGSA COM3 0.5", "GPGST COM3 0.5", "GPGSV COM3 1", "GPRMC COM3 0.5",
             "BESTNAVB 0.20")

    def run(self):
        self.speed(115200)
        for _ in range(3):
            self.command("MODE")
            answer = self.need(lambda item: isinstance(item, Line) and item.text.startswith("#MODE,"), 1500, "#MODE")
            self.check(answer.kind == "answer" and "MODE ROVER SURVEY," in answer.text, "MODE ROVER SURVEY", answer)
        self.command("VERSIONB", 1000)
        version = self.need(lambda item: item.kind == "frame" and item.id == 37, 1000, "VERSIONB").payload
        self.check(version[0] == 18 and version[4:9] == b"11833", "a UM980 with firmware 11833", version[:12])
        self.configuration()
        self.command("UNLOG")
        for line in self.lines:
            self.command(line)
        self.step("a fix in GGA")
        self.need(lambda item: item.name == "GNGGA" and item.fields[6] != "0", 5000, "GGA with a fix")
        self.command("RECTIMEB 0.20")
        self.command("SAVECONFIG")
        self.pump(1)
        self.follow(self.collect(HEALTHY))
        self.step("a command that there is not")
        self.command("badResponse", verdict="PARSING FAILD NO MATCHING FUNC  BADRESPONSE")

    def configuration(self):
        self.command("CONFIG")
        lines = [item.text for item in self.collect(1.0) if isinstance(item, Line)]
        for text in ("CONFIG SIGNALGROUP 2", "CONFIG COM3 115200", "CONFIG RTK TIMEOUT 120"):
            self.check(any(text in line for line in lines), text, lines)
        self.command("MASK")
        self.need(lambda item: getattr(item, "text", "") == "$CONFIG,MASK,MASK 5.0*25", 1000, "$CONFIG,MASK")

    def follow(self, items):
        self.step("BESTNAVB, RECTIMEB and sentences")
        counts = {}
        for item in items:
            counts[item.name] = counts.get(item.name, 0) + 1
        for name, each_second in (("frame 2118", 5), ("frame 102", 5), ("GNGGA", 2), ("GNRMC", 2)):
            self.check(abs(counts.get(name, 0) - each_second * HEALTHY) <= 2, f"{name} {each_second} times a second", counts)
        best = [item.payload for item in items if item.name == "frame 2118"][-1]
        status, kind, latitude, longitude, height, undulation = struct.unpack_from("<IIdddf", best)
        self.check(status == 0 and kind in (16, 17, 18), "a solution", (status, kind))
        self.check(receiver.metres_apart(latitude, longitude) < 20, "a position within 20 m", (latitude, longitude))
        self.check(abs(height + undulation - receiver.PLACE[2]) < 40 and 30 < undulation < 60, "its height", (height, undulation))
        deviations = struct.unpack_from("<fff", best, 40)
        self.check(all(0 < d < 20 for d in deviations) and best[65] >= 6, "deviations and satellites", deviations)
        clock = [item.payload for item in items if item.name == "frame 102"][-1]
        year, month, day = struct.unpack_from("<IBB", clock, 28)
        self.check((year, month, day) == receiver.START_DATE or day in (1, 28), "the date", (year, month, day))
        self.check(clock[0] == 0 and clock[40] == 1, "valid clock and UTC", (clock[0], clock[40]))
