"""What jclark's casictool, from which satpulse's support of CASIC came, and gpsd say to a receiver of CASIC's.

Frames and their sums are written here anew. Sources: jclark/casictool (casic.py, connection.py, spec/notes.md);
ntpsec/gpsd, drivers/driver_casic.c.
"""
import struct

import nmea
import receiver
from dialogue import Client
from meshtastic import casic_frame
from stream import StreamParser

NAMES = {0x0101: "NAV-DOP", 0x0102: "NAV-SOL", 0x0103: "NAV-PV", 0x0110: "NAV-TIMEUTC", 0x0500: "ACK-NAK",
         0x0501: "ACK-ACK", 0x0600: "CFG-PRT", 0x0601: "CFG-MSG", 0x0604: "CFG-RATE", 0x0605: "CFG-CFG", 0x0607: "CFG-NAVX"}


class CasicFrame:
    """A frame whose sum holds."""

    def __init__(self, data, at):
        self.number, self.payload, self.time = data[4] << 8 | data[5], data[6:-4], at

    def __str__(self):
        return f"{NAMES.get(self.number, f'{self.number:04X}')} {self.payload.hex()[:60]}"


class CasicLine:
    """A sentence whose checksum holds; its address and fields."""

    def __init__(self, text, fields, at):
        self.text, self.fields, self.time, self.number = text, fields, at, None

    def __str__(self):
        return self.text[:80]


class CasicParser(StreamParser):
    """Frames and sentences."""

    def take(self, at, items):
        data = self.buffer
        if data[0] == ord("$"):
            end = data.find(b"\n")
            if end < 0:
                return 0 if len(data) < 200 else 1
            text = data[:end].rstrip(b"\r").decode("latin-1")
            fields = nmea.fields(text)
            if fields:
                items.append(CasicLine(text, fields, at))
            return end + 1 if fields else 1
        if data[0] != 0xBA or (len(data) > 1 and data[1] != 0xCE):
            return 1
        if len(data) < 6:
            return 0
        size = 10 + (data[2] | data[3] << 8)
        if size > 2060:
            return 1
        if len(data) < size:
            return 0
        if casic_frame(data[4], data[5], data[6:size - 4]) != data[:size]:
            return 1
        items.append(CasicFrame(data[:size], at))
        return size


class CasicTool(Client):
    """casictool: it asks for the version, takes a refusal or silence, then reads and writes frame by frame."""

    name = "casictool"
    first_speed = 9600

    def __init__(self, wire, board):
        super().__init__(wire, board)
        self.parser = CasicParser()

    def acknowledged(self, item):
        """There are no items of u-blox's here."""

    def run(self):
        self.speed(self.first_speed)
        self.step("the line is made free")
        # "There needs to be some spare bandwidth": its user turns the lists off first.
        self.send(nmea.sentence("PCAS03,1,0,0,0,1,0,0,0"), "$PCAS03")
        self.pump(3)
        self.step("MON-VER, which version 5 does not answer")
        self.forget()
        self.send(casic_frame(0x0A, 0x04, b""), "MON-VER")
        self.check(self.wait(lambda item: item.number is not None, 1000) is None, "silence", "a frame")
        self.show()
        for message in (0x4E00, 0x4E04):
            self.set(0x01, struct.pack("<BBH", message >> 8, message & 0xFF, 0))
        for number in (0x02, 0x03, 0x10):
            self.set(0x01, struct.pack("<BBH", 1, number, 1))
        self.set(0x04, struct.pack("<HH", 1000, 0))
        self.follow(self.collect(6))
        self.step("what it does not know")
        for message, payload in ((0x01, bytes(8)), (0x33, bytes(4)), (0x04, struct.pack("<HH", 77, 0))):
            self.set(message, payload, 0x0500)
        self.set(0x05, struct.pack("<HBB", 0xFFFF, 1, 0))
        self.step("saved")
        self.send(casic_frame(6, 2, struct.pack("<HBB", 0, 1, 0)), "CFG-RST")
        self.need(lambda item: item.number is None and "MA=CASIC" in item.text, 4000, "the texts of a start")
        self.need(lambda item: item.number == 0x0103, 4000, "NAV-PV after the restart")

    def verdict(self, message, wanted, milliseconds=1000):
        return self.need(lambda item: item.number == wanted and item.payload[:2] == bytes((6, message)), milliseconds,
                         f"{NAMES[wanted]} of 06-{message:02X}")

    def set(self, message, payload, wanted=0x0501):
        self.step(f"06-{message:02X} {payload.hex()}")
        self.forget()
        self.send(casic_frame(6, message, payload), self.step_name)
        self.verdict(message, wanted)

    def poll(self, message, wanted=1):
        """All answers that come before the acknowledgement."""
        self.step(f"poll of 06-{message:02X}")
        self.forget()
        self.send(casic_frame(6, message, b""), self.step_name)
        answers = []
        while True:
            item = self.need(lambda i: i.number in (0x0600 | message, 0x0501, 0x0500), 2000, "answers and ACK-ACK")
            if item.number != 0x0600 | message:
                self.check(item.number == 0x0501, "ACK-ACK", item)
                self.check(len(answers) >= wanted, f"{wanted} answers", len(answers))
                return answers
            answers.append(item.payload)

    def show(self):
        port = struct.unpack("<BBHI", self.poll(0)[0])
        self.check(port == (0, 0x33, 0x08C0, self.first_speed), "the factory's port", port)
        rates = {payload[0] << 8 | payload[1]: payload[2] for payload in self.poll(1, 8)}
        self.check(rates[0x4E00] == 1 and rates[0x4E03] == 0 and rates[0x0103] == 0, "rates as they were set", rates)
        self.check(struct.unpack("<HH", self.poll(4)[0])[0] == 1000, "1 Hz", "another rate")
        navx = self.poll(7)[0]
        self.check(len(navx) == 44 and navx[13] == 3, "GPS and BeiDou", navx.hex())

    def follow(self, items):
        self.step("NAV-SOL, NAV-PV and NAV-TIMEUTC each second, no sentences")
        frames = [item for item in items if item.number]
        for number in (0x0102, 0x0103, 0x0110):
            self.check(5 <= sum(item.number == number for item in frames) <= 7, f"six {NAMES[number]}", len(frames))
        position = [item.payload for item in frames if item.number == 0x0103][-1]
        longitude, latitude, height, undulation, variance = struct.unpack_from("<ddfff", position, 16)
        self.check(position[4] == 7 and position[5] == 7, "a 3D fix", position[:12].hex())
        self.check(receiver.metres_apart(latitude, longitude) < 30, "a position within 30 m", (latitude, longitude))
        self.check(abs(height - undulation - receiver.PLACE[2]) < 60 or abs(height - receiver.PLACE[2]) < 60, "its height",
                   height)
        self.check(0 < variance < 400, "a variance in square metres", variance)
        clock = [item.payload for item in frames if item.number == 0x0110][-1]
        year, month, day = struct.unpack_from("<HBB", clock, 14)
        self.check((year, month, day) == receiver.START_DATE and clock[21] == 7, "the date", (year, month, day))
        self.check(not any(item.number is None and item.fields[0].endswith(("GGA", "RMC")) for item in items[3:]),
                   "no sentences", [str(item) for item in items[:6]])


class GpsdCasic(CasicTool):
    """gpsd's driver once it has seen a frame: MON-VER and CFG-PRT polls, binary alone, another speed and rate."""

    name = "gpsd's CASIC driver"

    def run(self):
        self.speed(self.first_speed)
        self.send(nmea.sentence("PCAS03,1,0,0,0,1,0,0,0"), "$PCAS03")
        self.pump(3)
        self.send(casic_frame(0x0A, 0x04, b""), "MON-VER")
        mask = self.poll(0)[0][1]
        self.set(0x01, struct.pack("<BBH", 1, 3, 1))
        self.set(0x00, struct.pack("<BBHI", 0xFF, mask & 0x03 | 0x10, 0x08C0, self.first_speed))
        self.step("binary alone")
        items = self.collect(5)[1:]
        self.check(items and all(item.number for item in items), "frames alone", [str(item) for item in items[:5]])
        self.send(nmea.sentence("PCAS01,5"), "$PCAS01,5")
        self.pump(0.1)
        self.speed(115200)
        self.send(casic_frame(6, 4, struct.pack("<HH", 200, 0)) + nmea.sentence("PCAS02,200"), "200 ms")
        self.pump(2)
        count = sum(item.number == 0x0103 for item in self.collect(4))
        self.check(17 <= count <= 22, "NAV-PV five times a second", count)
