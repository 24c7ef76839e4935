"""A small receiver in Python that answers as the specification says: it tries the scripted clients, never skyloop.

It knows no more than what the clients look at. `faults` names what it shall do wrong, so that a test can show that a
client notices: late_acks, twice_acked, wrong_date, dropped_epochs, stray_nmea, forgets_rates,
version_late, answers_binary, acks_polls; deaf_at_first is no fault but a start.
"""
import fcntl
import os
import select
import struct
import threading
import time
import tty

import nmea
import receiver
import u_center
import ubx
import wire

RATE_KEYS = {0x0102: 0x20910029, 0x0103: 0x2091001A, 0x0104: 0x20910038, 0x0107: 0x20910006, 0x0112: 0x20910042,
             0x0114: 0x20910033, 0x0120: 0x20910047, 0x0121: 0x2091005B, 0x0135: 0x20910015, 0x013C: 0x2091008D,
             0x0143: 0x20910345, 0x0232: 0x20910268, 0x0A09: 0x209101B4, 0x0A0B: 0x209101B9,
             0x0A38: 0x20910359,
             0xF000: 0x209100BA, 0xF001: 0x209100C9, 0xF002: 0x209100BF, 0xF003: 0x209100C4, 0xF004: 0x209100AB,
             0xF005: 0x209100B0}
OLD_RATES = {0x0106: 0x7F910001, 0x0130: 0x7F910011}  # messages of the M8 that have no key
PLAIN_KEYS = {0x30210001: 1000, 0x30210002: 1, 0x20210003: 1, 0x20110011: 3, 0x20110021: 0, 0x10730001: 1,
              0x10730002: 1,
              0x10740001: 1, 0x10740002: 1, 0x2011001C: 0, 0x1041000D: 0, 0x10230001: 1, 0x50360006: 0, 0x20D00001: 0}
MORE_KEYS = ([0x20520002, 0x20520003, 0x20520004, 0x10730004, 0x10770001, 0x10770002, 0x10770004, 0x10780001,
              0x10780002,
              0x10710001, 0x10710002, 0x10710004, 0x10720001, 0x10720002, 0x10720004, 0x10740004, 0x20030001,
              0x20140011, 0x201100A4, 0x301100B1, 0x301100B2, 0x301100B3, 0x301100B4, 0x401100C1, 0x401100C2,
              0x201100C4,
              0x20250038] + [0x10220000 + i for i in range(1, 5)] + [0x10360000 + i for i in range(2, 6)] +
             [0x10310000 + i for i in range(1, 0x27)] + [0x20910400 + i for i in range(200)])
SBAS = struct.pack("<BBBBI", 1, 3, 3, 0, 0)
GNSS = bytes.fromhex("00202007 0008100001000101 0101030001000101 0204080000000101 0308100000000101 0400080000000103"
                     "0500030001000105 06080E0001000101")
VERSIONS = {
    "ublox-m8": ("ROM CORE 3.01 (107888)", "00080000", ["FWVER=SPG 3.01", "PROTVER=18.00"]),
    "ublox-m9": ("EXT CORE 4.04 (7f89f7)", "00190000", ["FWVER=SPG 4.04", "PROTVER=32.01", "MOD=NEO-M9N"]),
    "ublox-m10": ("ROM SPG 5.10 (7b202e)", "000A0000", ["FWVER=SPG 5.10", "PROTVER=34.10"]),
    "ublox-f9p": ("EXT CORE 1.00 (0fa0ae)", "00190000", ["FWVER=HPG 1.32", "PROTVER=27.31", "MOD=ZED-F9P"]),
}


class ModelReceiver(threading.Thread):
    def __init__(self, board, faults=()):
        super().__init__(daemon=True)
        self.board, self.faults = board, set(faults)
        self.master, slave = os.openpty()
        tty.setraw(slave)
        self.path, self.slave = os.ttyname(slave), slave
        os.set_blocking(self.master, False)
        self.speed = board.speed
        self.parser, self.queue, self.free_at, self.done = ubx.Parser(), [], 0.0, False
        self.out_mask = 3
        self.defaults = {**PLAIN_KEYS, 0x40520001: board.speed, **dict.fromkeys(MORE_KEYS, 0)}
        for message, key in {**RATE_KEYS, **OLD_RATES}.items():
            for port in range(5):
                self.defaults[key + port] = int(message >> 8 == 0xF0)
        self.layers = {0: dict(self.defaults), 1: {}, 2: {}}
        self.gnss, self.stopped, self.fixed_at = GNSS, False, 0.0
        self.polled = {message for message, boards in u_center.POLLED if board.name in boards}
        self.next_epoch = time.monotonic()
        self.hears_from = time.monotonic() + 1.5 * ("deaf_at_first" in self.faults)
        self.epochs = self.itow = 0

    # --- the line ---

    def run(self):
        wire.take_priority()
        while not self.done:
            data = self.read()
            if data:
                for item in self.parser.feed(data):
                    self.handle(item)
            now = time.monotonic()
            if now >= self.next_epoch:
                period = self.layers[0][0x30210001] / 1000
                self.next_epoch += period
                if self.stopped or ("dropped_epochs" in self.faults and self.epochs % 29 == 28):
                    self.itow += round(period * 1000)
                else:
                    self.epoch()
                self.epochs += 1
            self.transmit(now)

    def client_speed(self):
        return wire.TERMIOS2.unpack(fcntl.ioctl(self.master, wire.TCGETS2, bytes(wire.TERMIOS2.size)))[7]

    def patience(self):
        """Seconds until something is to be done that no byte tells of."""
        due = min([self.next_epoch] + [max(at, self.free_at - 0.002) for at, _ in self.queue[:1]])
        return min(max(due - time.monotonic(), 0.0), 0.05)

    def read(self):
        if not select.select([self.master], [], [], self.patience())[0]:
            return b""
        data = os.read(self.master, 4096)
        if self.client_speed() != self.speed or time.monotonic() < self.hears_from:
            self.parser.clear()
            return b""
        return data

    def put(self, data, delay=0.002):
        self.queue.append((time.monotonic() + delay, data))

    def transmit(self, now):
        while self.queue and self.queue[0][0] <= now and self.free_at <= now + 0.002:
            data = self.queue.pop(0)[1]
            self.free_at = max(self.free_at, now) + len(data) * 10 / self.speed
            if self.client_speed() == self.speed:
                os.write(self.master, data)

    def stop(self):
        self.done = True
        self.join()
        os.close(self.slave)
        os.close(self.master)

    # --- requests ---

    def send(self, message, payload=b"", delay=0.002):
        if self.out_mask & 1 and self.board.generation or "answers_binary" in self.faults:
            self.put(ubx.frame(message, payload), delay)

    def ack(self, frame, good=True):
        payload = bytes((frame.message >> 8, frame.message & 0xFF))
        for _ in range(2 if "twice_acked" in self.faults else 1):
            self.send(0x0501 if good else 0x0500, payload, 0.3 if "late_acks" in self.faults else 0.002)

    def handle(self, item):
        if isinstance(item, ubx.Sentence):
            self.sentence(item.fields)
            return
        if not isinstance(item, ubx.Frame) or not (self.board.generation or "answers_binary" in self.faults):
            return
        handler = {0x0600: self.prt, 0x0601: self.msg, 0x0608: self.rate, 0x0624: self.nav5, 0x063E: self.cfg_gnss,
                   0x0616: self.sbas, 0x0631: lambda f: self.block(f, bytes(32)),
                   0x068A: self.valset, 0x068B: self.valget, 0x068C: self.valdel, 0x0604: self.reset}.get(item.message)
        if handler:
            handler(item)
        elif item.message == 0x0A04:
            self.version()
        elif item.message == 0x0A28:
            self.send(0x0A28, bytes((0, 15, 15, 15, 3, 0, 0, 0)))
        elif item.message == 0x0A36 and self.board.has_keys:
            self.send(0x0A36, bytes((0, 1, 0, 0, 0, 1, 255, 255)) + struct.pack("<H", 0x0100) + bytes(38))
        elif item.message >> 8 == 6:
            self.ack(item, item.message in ubx.NAMES)
        elif item.message in self.polled and not item.payload:
            self.send(item.message, self.message(item.message))
            if "acks_polls" in self.faults:
                self.ack(item)

    def sentence(self, fields):
        if fields[0] == "PUBX" and fields[1] == "41" and self.board.generation:
            self.set_port(int(fields[5]), int(fields[4], 16))
        elif fields[0][0] == "P" and self.board.generation == 8:
            self.put(nmea.sentence(f"GNTXT,01,01,01,{fields[0][:4]} inv format"))
        elif fields[0] == "PMTK605" and self.board.name == "mtk3339":
            self.put(nmea.sentence("PMTK705,AXN_2.51_3339_19071200,0002,QUECTEL-L70,1.0"))

    def version(self):
        software, hardware, lines = VERSIONS.get(self.board.name, VERSIONS["ublox-m8"])
        payload = software.encode().ljust(30, b"\0") + hardware.encode().ljust(10, b"\0")
        for line in lines + ["GPS;GLO;GAL;BDS", "SBAS;QZSS"]:
            payload += line.encode().ljust(30, b"\0")
        self.send(0x0A04, payload, 0.4 if "version_late" in self.faults else 0.002)

    def prt(self, frame):
        if len(frame.payload) < 2:
            self.send(0x0600, struct.pack("<BBHIIHHHH", 1, 0, 0, 0x8D0, self.speed, 0x23, self.out_mask, 0, 0))
            self.ack(frame)
            return
        self.set_port(struct.unpack_from("<I", frame.payload, 8)[0], struct.unpack_from("<H", frame.payload, 14)[0])
        self.ack(frame)

    def set_port(self, speed, out_mask):
        self.speed, self.out_mask = speed, out_mask
        self.layers[0].update({0x40520001: speed, 0x10740001: out_mask & 1, 0x10740002: out_mask >> 1 & 1})

    def msg(self, frame):
        message = frame.payload[0] << 8 | frame.payload[1]
        key = RATE_KEYS.get(message) or (OLD_RATES.get(message) if self.board.generation == 8 else None)
        if key is None:
            self.ack(frame, False)
        elif len(frame.payload) == 2:
            rates = bytes(self.layers[0][key + port] for port in range(5))
            self.send(0x0601, frame.payload + rates + b"\0")
            self.ack(frame)
        else:
            if "forgets_rates" not in self.faults:
                self.layers[0][key + 1] = frame.payload[2]
            self.ack(frame)

    def rate(self, frame):
        keys = (0x30210001, 0x30210002, 0x20210003)
        if frame.payload:
            self.apply(dict(zip(keys, struct.unpack("<HHH", frame.payload))))
        else:
            self.send(0x0608, struct.pack("<HHH", *(self.layers[0][key] for key in keys)))
        self.ack(frame)

    def nav5(self, frame):
        if frame.payload:
            self.layers[0][0x20110021] = frame.payload[2]
        else:
            self.send(0x0624, struct.pack("<HBB", 0xFFFF, self.layers[0][0x20110021], 3) + bytes(32))
        self.ack(frame)

    def cfg_gnss(self, frame):
        if self.board.generation == 10:
            self.ack(frame, False)
            return
        if frame.payload:
            self.gnss = frame.payload if frame.payload[3] >= 5 else self.gnss
            self.next_epoch = max(self.next_epoch, time.monotonic() + 0.5)
        else:
            self.send(0x063E, self.gnss)
        self.ack(frame)

    def block(self, frame, payload):
        if not frame.payload:
            self.send(frame.message, payload)
        self.ack(frame)

    def sbas(self, frame):
        if self.board.generation == 10:
            self.ack(frame, False)
        else:
            self.block(frame, SBAS)

    def reset(self, frame):
        self.stopped = frame.payload[2] == 8
        if frame.payload[2] < 2:
            self.layers[0] = dict(self.defaults)
            self.set_port(self.board.speed, 3)
            version = VERSIONS[self.board.name][2]
            for text in ["u-blox AG - www.u-blox.com"] + version:
                self.put(nmea.sentence(f"GNTXT,01,01,02,{text}"), 0.8)
            self.fixed_at = time.monotonic() + 30
        if frame.payload[2] == 2:
            self.fixed_at = time.monotonic() + 30

    def apply(self, values):
        if 0x30210001 in values and values[0x30210001] != self.layers[0][0x30210001]:
            self.next_epoch = time.monotonic() + 0.05
        self.layers[0].update(values)
        self.speed = self.layers[0][0x40520001] if 0x40520001 in values else self.speed

    def valset(self, frame):
        try:
            pairs = ubx.valget_pairs(b"\1" + frame.payload[1:])
        except ValueError:
            pairs = [(0, 0)]
        good = self.board.has_keys and all(key in self.defaults for key, _ in pairs)
        if good:
            values = dict(pairs)
            if frame.payload[1] & 1:
                self.apply(values)
                self.out_mask = self.layers[0][0x10740001] | self.layers[0][0x10740002] << 1
            for bit, layer in ((2, 1), (4, 2)):
                if frame.payload[1] & bit:
                    self.layers[layer].update(values)
        self.ack(frame, good)

    def valget(self, frame):
        layer, position = frame.payload[1], int.from_bytes(frame.payload[2:4], "little")
        store = self.defaults if layer == 7 else self.layers[layer]
        store = {key: value for key, value in store.items() if key >> 28 < 6}
        keys = [int.from_bytes(frame.payload[i:i + 4], "little") for i in range(4, len(frame.payload), 4)]
        wanted = []
        for key in keys:
            if key & 0x0FFF0000 == 0x0FFF0000:
                wanted += sorted(store, key=lambda k: k & 0x0FFFFFFF)
            elif key & 0xFFFF == 0xFFFF:
                wanted += sorted((k for k in store if k >> 16 & 0xFF == key >> 16 & 0xFF), key=lambda k: k & 0x0FFFFFFF)
            else:
                wanted.append(key)
        if not self.board.has_keys or not wanted or any(key not in store for key in wanted):
            self.ack(frame, False)
            return
        payload = b"\1" + frame.payload[1:4]
        for key in wanted[position:position + 64]:
            payload += struct.pack("<I", key) + store[key].to_bytes(ubx.value_size(key), "little")
        self.send(0x068B, payload)
        self.ack(frame)

    def valdel(self, frame):
        for i in range(4, len(frame.payload), 4):
            for layer in (1, 2):
                self.layers[layer].pop(int.from_bytes(frame.payload[i:i + 4], "little"), None)
        self.ack(frame)

    # --- output ---

    def epoch(self):
        period = self.layers[0][0x30210001]
        self.itow = (self.itow // period + 1) * period
        for message in (0x0107, 0x0103, 0x0104, 0x0114, 0x0135, 0x0143, 0x0120, 0x0A09, 0x0A0B, 0x0A38):
            key = RATE_KEYS.get(message) or OLD_RATES[message]
            rate = self.layers[0][key + 1]
            if self.out_mask & 1 and rate and self.epochs % rate == 0 and self.board.generation:
                self.put(ubx.frame(message, self.message(message)), 0.03)
        if self.out_mask & 2 or "stray_nmea" in self.faults:
            self.sentences()

    def message(self, message):
        itow = struct.pack("<I", self.itow)
        if message == 0x0107:
            return self.pvt()
        if message == 0x0135:
            return itow + bytes((1, 0, 0, 0))
        if message == 0x0A09:
            return bytes(60)
        size = {0x0103: 16, 0x0104: 18, 0x0114: 36, 0x0120: 16, 0x0143: 8, 0x0A0B: 28}.get(message, 28)
        return itow + bytes(size - 4)

    def pvt(self):
        latitude, longitude, height = receiver.PLACE
        fixed = time.monotonic() > self.fixed_at
        year, month, day = receiver.START_DATE
        if "wrong_date" in self.faults:
            year -= 20
        second = self.itow // 1000 % 60
        return ubx.PVT.pack(self.itow, year, month, day, 0, 0, second, 7, 20, 0, 3 * fixed, fixed, 0xEA, 12,
                            round(longitude * 1e7), round(latitude * 1e7), round(height * 1000), 0, 2000, 3000,
                            0, 0, 0, 0, 0, 100, 18000000, 120, 0) + bytes(12)

    def sentences(self):
        latitude, longitude, _ = receiver.PLACE
        clock = f"{self.itow // 3600000:02}{self.itow // 60000 % 60:02}{self.itow / 1000 % 60:05.2f}"
        place = f"{int(latitude):02}{latitude % 1 * 60:08.5f},N,{int(longitude):03}{longitude % 1 * 60:08.5f},E"
        if self.layers[0][0x209100AC] or "stray_nmea" in self.faults:
            status = "A" if time.monotonic() > self.fixed_at else "V"
            self.put(nmea.sentence(f"GNRMC,{clock},{status},{place},0.0,,010326,,,A,V"), 0.03)
        if self.layers[0][0x209100C5]:
            self.put(nmea.sentence("GPGSV,1,1,00,0"), 0.03)
        if self.layers[0][0x209100BB]:
            self.put(nmea.sentence(f"GNGGA,{clock},{place},1,12,0.9,488.0,M,48.0,M,,"), 0.03)
