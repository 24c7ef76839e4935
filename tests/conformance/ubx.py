"""UBX as a client needs it: frames out, a parser with resynchronisation in, the messages that clients look into.

Layouts: u-blox 8 / M8 Receiver Description (UBX-13003221), F9 HPG 1.32 (UBX-22008968) and M10 SPG 5.10 (UBX-21035062)
interface descriptions.
"""
import dataclasses
import struct

import nmea

SYNC = b"\xb5\x62"
NAMES = {
    0x0101: "NAV-POSECEF", 0x0102: "NAV-POSLLH", 0x0103: "NAV-STATUS", 0x0104: "NAV-DOP", 0x0106: "NAV-SOL",
    0x0107: "NAV-PVT", 0x0111: "NAV-VELECEF", 0x0112: "NAV-VELNED", 0x0114: "NAV-HPPOSLLH", 0x0120: "NAV-TIMEGPS",
    0x0121: "NAV-TIMEUTC", 0x0122: "NAV-CLOCK", 0x0126: "NAV-TIMELS", 0x0130: "NAV-SVINFO", 0x0135: "NAV-SAT",
    0x013C: "NAV-RELPOSNED", 0x0143: "NAV-SIG", 0x0161: "NAV-EOE", 0x0215: "RXM-RAWX", 0x0232: "RXM-RTCM",
    0x0500: "ACK-NAK", 0x0501: "ACK-ACK", 0x0600: "CFG-PRT", 0x0601: "CFG-MSG", 0x0602: "CFG-INF", 0x0604: "CFG-RST",
    0x0608: "CFG-RATE", 0x0609: "CFG-CFG", 0x0616: "CFG-SBAS", 0x0623: "CFG-NAVX5", 0x0624: "CFG-NAV5",
    0x0631: "CFG-TP5", 0x063E: "CFG-GNSS", 0x0686: "CFG-PMS", 0x068A: "CFG-VALSET", 0x068B: "CFG-VALGET",
    0x068C: "CFG-VALDEL", 0x0A04: "MON-VER", 0x0A09: "MON-HW", 0x0A0B: "MON-HW2", 0x0A28: "MON-GNSS",
    0x0A36: "MON-COMMS", 0x0A38: "MON-RF", 0x2703: "SEC-UNIQID",
}
IDS = {name: number for number, name in NAMES.items()}
LONGEST = 4096


def number(message):
    """Class and id as one number, from the name of a message or the number itself."""
    return IDS[message] if isinstance(message, str) else message


def name(message):
    return NAMES.get(message, f"{message >> 8:02X}-{message & 0xFF:02X}")


def checksum(data):
    """The 8-bit Fletcher sum over class, id, length and payload."""
    a = b = 0
    for value in data:
        a = (a + value) & 0xFF
        b = (b + a) & 0xFF
    return bytes((a, b))


def frame(message, payload=b""):
    """The bytes of one frame."""
    message = number(message)
    body = struct.pack("<BBH", message >> 8, message & 0xFF, len(payload)) + payload
    return SYNC + body + checksum(body)


@dataclasses.dataclass
class Frame:
    """A UBX frame that was received."""
    message: int
    payload: bytes
    time: float = 0.0

    @property
    def size(self):
        return len(self.payload) + 8

    def is_a(self, message):
        return self.message == number(message)

    def __str__(self):
        if self.message in (0x0500, 0x0501) and len(self.payload) == 2:
            return f"{name(self.message)}({name(self.payload[0] << 8 | self.payload[1])})"
        return f"{name(self.message)}[{len(self.payload)}]"


@dataclasses.dataclass
class Sentence:
    """An NMEA sentence that was received; `fields` begins with the address."""
    fields: list
    text: str
    time: float = 0.0

    @property
    def size(self):
        return len(self.text) + 2

    def __str__(self):
        return self.text


@dataclasses.dataclass
class Correction:
    """An RTCM3 frame that was received."""
    kind: int
    data: bytes
    time: float = 0.0

    @property
    def size(self):
        return len(self.data)

    def __str__(self):
        return f"RTCM {self.kind}[{len(self.data)}]"


def crc24q(data):
    """The checksum of RTCM 3, polynomial 0x1864CFB."""
    crc = 0
    for value in data:
        crc ^= value << 16
        for _ in range(8):
            crc <<= 1
            if crc & 0x1000000:
                crc ^= 0x1864CFB
    return crc


class Parser:
    """Finds frames, sentences and corrections in a stream. After a wrong checksum it looks again from the next byte."""

    def __init__(self):
        self.buffer = bytearray()
        self.noise = bytearray()

    def feed(self, data, at=0.0):
        """All that is complete with these bytes, in order. `noise` keeps the bytes that belong to nothing."""
        self.buffer += data
        found = []
        while self.buffer:
            kind = self.buffer[0]
            take = {0xB5: self._frame, 0x24: self._sentence, 0xD3: self._correction}.get(kind)
            if take is None:
                self.noise.append(self.buffer.pop(0))
                continue
            count, item = take()
            if count == 0:
                break
            if item is None:
                self.noise += self.buffer[:count]
            else:
                item.time = at
                found.append(item)
            del self.buffer[:count]
        return found

    def clear(self):
        self.buffer.clear()
        self.noise.clear()

    def _frame(self):
        buffer = self.buffer
        if len(buffer) < 2:
            return 0, None
        if buffer[1] != 0x62:
            return 1, None
        if len(buffer) < 6:
            return 0, None
        length = buffer[4] | buffer[5] << 8
        if length > LONGEST:
            return 1, None
        if len(buffer) < length + 8:
            return 0, None
        if checksum(buffer[2:6 + length]) != buffer[6 + length:8 + length]:
            return 1, None
        return length + 8, Frame(buffer[2] << 8 | buffer[3], bytes(buffer[6:6 + length]))

    def _sentence(self):
        for index, value in enumerate(self.buffer[1:], 1):
            if value in (0x0D, 0x0A):
                if value == 0x0D and index + 1 == len(self.buffer):
                    return 0, None
                text = bytes(self.buffer[:index]).decode("ascii")
                fields = nmea.fields(text)
                count = index + (2 if self.buffer[index:index + 2] == b"\r\n" else 1)
                return (count, Sentence(fields, text)) if fields else (1, None)
            if not 0x20 <= value < 0x7F or index > 255:
                return 1, None
        return 0, None

    def _correction(self):
        buffer = self.buffer
        if len(buffer) < 3:
            return 0, None
        if buffer[1] & 0xFC:
            return 1, None
        length = (buffer[1] & 3) << 8 | buffer[2]
        if len(buffer) < length + 6:
            return 0, None
        data = bytes(buffer[:length + 6])
        if crc24q(data[:-3]) != int.from_bytes(data[-3:], "big"):
            return 1, None
        return length + 6, Correction(data[3] << 4 | data[4] >> 4 if length > 1 else 0, data)


# --- configuration by key ---------------------------------------------------------------------------------------------

RAM, BBR, FLASH = 1, 2, 4  # layers of CFG-VALSET, a mask
READ_RAM, READ_BBR, READ_FLASH, READ_DEFAULT = 0, 1, 2, 7  # layers of CFG-VALGET
PAGE = 64  # most keys of one message


def value_size(key):
    """Bytes that the value of a key takes: bits 28 to 30 of its id."""
    sizes = {1: 1, 2: 1, 3: 2, 4: 4, 5: 8}
    code = key >> 28 & 7
    if code not in sizes:
        raise ValueError(f"key {key:08X} has size code {code}, expected 1 to 5")
    return sizes[code]


def valset(pairs, layers=RAM, version=0, transaction=0):
    """A CFG-VALSET frame; `pairs` is a list of (key, value), in which a key may come twice."""
    payload = struct.pack("<BBBB", version, layers, transaction, 0)
    for key, value in pairs:
        size = value_size(key)
        payload += struct.pack("<I", key) + (value & (1 << 8 * size) - 1).to_bytes(size, "little")
    return frame("CFG-VALSET", payload)


def valget(keys, layer=READ_RAM, position=0):
    """A CFG-VALGET poll."""
    return frame("CFG-VALGET", struct.pack("<BBH", 0, layer, position) + b"".join(struct.pack("<I", k) for k in keys))


def valdel(keys, layers, transaction=0):
    """A CFG-VALDEL frame."""
    return frame("CFG-VALDEL", struct.pack("<BBBB", 0, layers, transaction, 0) +
                 b"".join(struct.pack("<I", k) for k in keys))


def valget_pairs(payload):
    """The (key, value) pairs of a CFG-VALGET answer, in its order."""
    if len(payload) < 4 or payload[0] != 1:
        raise ValueError(f"no CFG-VALGET answer: version {payload[:1].hex() or 'absent'}, expected 01")
    pairs, offset = [], 4
    while offset < len(payload):
        if offset + 4 > len(payload):
            raise ValueError(f"CFG-VALGET answer: {len(payload) - offset} bytes left, a key takes 4")
        key = struct.unpack_from("<I", payload, offset)[0]
        size = value_size(key)
        if offset + 4 + size > len(payload):
            raise ValueError(f"CFG-VALGET answer: the value of key {key:08X} breaks off")
        pairs.append((key, int.from_bytes(payload[offset + 4:offset + 4 + size], "little")))
        offset += 4 + size
    return pairs


# --- messages ---------------------------------------------------------------------------------------------------------


def cfg_msg(message, rate):
    """CFG-MSG, three bytes: the rate of a message on the port it arrives on."""
    message = number(message)
    return frame("CFG-MSG", bytes((message >> 8, message & 0xFF, rate)))


def cfg_msg_poll(message):
    message = number(message)
    return frame("CFG-MSG", bytes((message >> 8, message & 0xFF)))


def cfg_prt(*ports):
    """CFG-PRT with one block for each (port, mode, baud, in mask, out mask)."""
    return frame("CFG-PRT", b"".join(struct.pack("<BBHIIHHHH", port, 0, 0, mode, baud, in_mask, out_mask, 0, 0)
                                     for port, mode, baud, in_mask, out_mask in ports))


def cfg_rate(measurement_ms, cycles, reference):
    return frame("CFG-RATE", struct.pack("<HHH", measurement_ms, cycles, reference))


def cfg_nav5(mask, dynamic_model, fix_mode, rest=bytes(32)):
    return frame("CFG-NAV5", struct.pack("<HBB", mask, dynamic_model, fix_mode) + rest)


def text(data):
    return data.split(b"\0")[0].decode("ascii", "replace")


@dataclasses.dataclass
class Version:
    """MON-VER."""
    software: str
    hardware: str
    extensions: list

    def value_of(self, key):
        """What follows `key` and `=` or a space in the extension that begins with it, or None."""
        for line in self.extensions:
            if line.startswith(key) and line[len(key):len(key) + 1] in ("=", " "):
                return line[len(key) + 1:]
        return None

    @property
    def protocol(self):
        """The protocol version as a pair of numbers."""
        found = self.value_of("PROTVER")
        return tuple(int(part) for part in found.split(".")) if found else None


def mon_ver(payload):
    if len(payload) < 40 or (len(payload) - 40) % 30:
        raise ValueError(f"MON-VER has {len(payload)} bytes, expected 40 and a multiple of 30")
    return Version(text(payload[:30]), text(payload[30:40]),
                   [text(payload[i:i + 30]) for i in range(40, len(payload), 30)])


PVT = struct.Struct("<IHBBBBBBIiBBBBiiiiIIiiiiiIIHH")
PVT_FIELDS = ("itow year month day hour minute second valid time_accuracy nano fix_type flags flags2 satellites "
              "longitude latitude height height_msl horizontal_accuracy vertical_accuracy north east down ground_speed "
              "heading speed_accuracy heading_accuracy pdop flags3").split()


def nav_pvt(payload):
    """The fields of NAV-PVT, raw."""
    if len(payload) not in (84, 92):
        raise ValueError(f"NAV-PVT has {len(payload)} bytes, expected 92 (84 before u-blox 8)")
    return dict(zip(PVT_FIELDS, PVT.unpack_from(payload)))
