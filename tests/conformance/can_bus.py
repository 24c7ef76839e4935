"""The bus of a DroneCAN node, by SLCAN on a tty: frames, transfers and messages, read from the layouts of the DSDL."""
import dataclasses
import math
import os
import select
import socket
import struct
import time

# Type: signature and layout. u, i, f with their bits, v void; [n a list of at most n with its count, (n one without.
MESSAGES = {
    1063: ("Fix2", 0xCA41E7000F37435F, "timestamp:u56 gnss_timestamp:u56 standard:u3 :v13 leap:u8 longitude:i37 latitude:i37 "
           "height:i27 msl:i27 north:f32 east:f32 down:f32 sats:u6 status:u2 mode:u4 sub_mode:u6 covariance:f16[36 pdop:f16 "
           "ecef:u8(99"),
    1061: ("Auxiliary", 0x9BE8BDC4C3DBBFD2,
           "gdop:f16 pdop:f16 hdop:f16 vdop:f16 tdop:f16 ndop:f16 edop:f16 visible:u7 used:u6"),
    1062: ("RTCMStream", 0x1F56030ECB171501, "protocol:u8 data:u8(128"),
    341: ("NodeStatus", 0x0F0868D0C1A7C6F1, "uptime:u32 health:u2 mode:u3 sub_mode:u3 vendor:u16"),
    1: ("Allocation", 0x0B2A812620A11D40, "node_id:u7 first:u1 unique_id:u8(16"),
    20003: ("Status", 0xBA3CB4ABBB007F69, "errors:u32 healthy:u1 status:u23"),
}
NUMBER = "{0}_kind:u2 {0}_integer?1:i64 {0}_real?2:f32"
VALUE = "{0}_kind:u3 {0}_integer?1:i64 {0}_real?2:f32 {0}_boolean?3:u8 {0}_text?4:u8[128"
SERVICES = {
    1: (0xEE468A8121C46A9E, "", "uptime:u32 health:u2 mode:u3 sub_mode:u3 vendor:u16 major:u8 minor:u8 flags:u8 commit:u32 "
        "crc:u64 hardware_major:u8 hardware_minor:u8 unique_id:u8*16 certificate:u8[255 name:u8(80"),
    5: (0x569E05394A3017F0, "magic:u40", "ok:u1"),
    10: (0x3B131AC5EB69D2CD, "opcode:u8 argument:i48", "argument:i48 ok:u1"),
    11: (0xA7B622F939D1A4D5, f"index:u13 {VALUE.format('value')} name:u8(92",
         f":v5 {VALUE.format('value')} :v5 {VALUE.format('default')} :v6 {NUMBER.format('most')} :v6 "
         f"{NUMBER.format('least')} name:u8(92"),
}


class Malformed(Exception):
    """Bytes that are not what their type says."""


def crc16(data, crc=0xFFFF):
    """CRC-16-CCITT-FALSE."""
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ (0x1021 if crc & 0x8000 else 0)) & 0xFFFF
    return crc


def parts(layout):
    """(name, condition, kind, bits, list mark, count) of each field."""
    for word in layout.split():
        name, text = word.split(":")
        name, _, condition = name.partition("?")
        mark = next((m for m in "[(*" if m in text), "")
        bits, _, most = text[1:].partition(mark) if mark else (text[1:], "", "1")
        yield name, condition, text[0], int(bits), mark, int(most)


class Bits:
    """Bits in the order of the bytes; a number has its lowest byte first, each byte its highest bit."""

    def __init__(self, data=b""):
        self.text = "".join(f"{byte:08b}" for byte in data)

    def take(self, count):
        if count > len(self.text):
            raise Malformed(f"{count} bits are wanted, {len(self.text)} are left")
        taken, self.text = self.text[:count], self.text[count:]
        value = 0
        for at in range(0, count, 8):
            value |= int(taken[at:at + 8], 2) << at
        return value

    def put(self, value, count):
        value &= (1 << count) - 1
        for at in range(0, count, 8):
            width = min(8, count - at)
            self.text += f"{value >> at & (1 << width) - 1:0{width}b}"

    def data(self):
        padded = self.text + "0" * (-len(self.text) % 8)
        return bytes(int(padded[at:at + 8], 2) for at in range(0, len(padded), 8))


def number(kind, bits, raw):
    if kind == "i" and raw >> (bits - 1):
        return raw - (1 << bits)
    if kind == "f":
        return struct.unpack("<e", raw.to_bytes(2, "little"))[0] if bits == 16 else \
            struct.unpack("<f", raw.to_bytes(4, "little"))[0]
    return raw


def decode(layout, payload):
    """The fields of a payload by their names."""
    bits, fields = Bits(payload), {}
    for name, condition, kind, width, mark, most in parts(layout):
        if condition and fields[f"{name.rsplit('_', 1)[0]}_kind"] != int(condition):
            continue
        count = most
        if mark == "[":
            count = bits.take(most.bit_length())
        elif mark == "(":
            count = len(bits.text) // width
        if count > most:
            raise Malformed(f"{name}: {count} items, at most {most}")
        values = [number(kind, width, bits.take(width)) for _ in range(count)]
        if kind != "v":
            fields[name] = values if mark else values[0]
    if len(bits.text) >= 8:
        raise Malformed(f"{len(bits.text)} bits too many")
    return fields


def encode(layout, **fields):
    """The payload of whole numbers and lists of them; what is not given is 0 or empty."""
    bits = Bits()
    for name, condition, _, width, mark, most in parts(layout):
        if condition and fields.get(f"{name.rsplit('_', 1)[0]}_kind", 0) != int(condition):
            continue
        values = fields.get(name, [] if mark in "[(" and mark else 0)
        values = list(values) if mark else [values]
        if mark == "[":
            bits.put(len(values), most.bit_length())
        for value in values:
            bits.put(value, width)
    return bits.data()


@dataclasses.dataclass
class Transfer:
    """One transfer as it came."""
    kind: str  # message, request, response
    type: int
    source: int
    destination: int
    id: int
    payload: bytes
    at: float

    def fields(self):
        if self.kind == "message":
            return decode(MESSAGES[self.type][2], self.payload)
        return decode(SERVICES[self.type][1 if self.kind == "request" else 2], self.payload)


def signature_of(kind, number_of_type):
    known = MESSAGES if kind == "message" else SERVICES
    if number_of_type not in known:
        return None
    return known[number_of_type][1 if kind == "message" else 0]


def seed(signature):
    return crc16(signature.to_bytes(8, "little"))


class Bus:
    """A host with an SLCAN adapter at a tty. `node` is its own node id."""

    def __init__(self, tty, node=127):
        self.descriptor = os.open(tty, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        self.node = node
        self.waiting = b""
        self.sessions = {}
        self.came = []
        self.bad = []
        self.ids = {}
        self.server = None  # (unique id so far, the id that is given)
        self.granted = []

    def close(self):
        os.close(self.descriptor)

    def command(self, text):
        """Writes a line; gives its answer up to CR or BEL."""
        os.write(self.descriptor, text.encode() + b"\r")
        answer, end = b"", time.monotonic() + 5
        while not answer.endswith((b"\r", b"\a")):
            if time.monotonic() > end:
                raise AssertionError(f"'{text}': no answer within 5 s, came {answer}")
            answer += self.read(0.1, 1)
        return answer

    def open(self):
        """As pydronecan opens an adapter (driver/slcan.py); what it says of each step."""
        answers = [self.command(text) for text in ("", "C", "S8", "O")]
        os.write(self.descriptor, b"F\r")
        return answers

    def read(self, patience, most=65536):
        if not select.select([self.descriptor], [], [], patience)[0]:
            return b""
        try:
            return os.read(self.descriptor, most)
        except BlockingIOError:
            return b""

    def run(self, seconds, until=lambda: False):
        """Takes what comes; ends early when `until` says so."""
        end = time.monotonic() + seconds
        while time.monotonic() < end and not until():
            for number_of_frame, data in self.frames(min(0.05, seconds)):
                self.frame(number_of_frame, data)

    def frames(self, patience):
        """Id and data of the frames that come."""
        self.waiting += self.read(patience)
        *lines, self.waiting = self.waiting.split(b"\r")
        for line in lines:
            line = line.replace(b"\a", b"")
            if line[:1] == b"T":
                yield int(line[1:9], 16), bytes.fromhex(line[10:10 + 2 * int(line[9:10])].decode())

    def put(self, number_of_frame, data):
        os.write(self.descriptor, f"T{number_of_frame:08X}{len(data)}{data.hex().upper()}\r".encode())

    def frame(self, number_of_frame, data):
        now = time.monotonic()
        source, tail = number_of_frame & 0x7F, data[-1]
        if number_of_frame & 0x80:
            kind = "request" if number_of_frame & 0x8000 else "response"
            kind_number, to = number_of_frame >> 16 & 0xFF, number_of_frame >> 8 & 0x7F
        else:
            kind, kind_number, to = "message", number_of_frame >> 8 & (0xFFFF if source else 3), 0
        signature = signature_of(kind, kind_number)
        start, end, toggle = tail & 0x80, tail & 0x40, bool(tail & 0x20)
        key = number_of_frame & 0xFFFFFF
        if start:
            if key in self.sessions:
                self.bad.append(f"{kind} {kind_number}: a transfer was not finished")
            self.sessions[key] = [b"", False, tail & 0x1F]
        session = self.sessions.get(key)
        if session is None or session[1] != toggle or session[2] != tail & 0x1F or (not end and len(data) != 8):
            self.bad.append(f"{kind} {kind_number}: frame {data.hex()} does not go on with what came")
            self.sessions.pop(key, None)
            return
        session[0] += data[:-1]
        session[1] = not toggle
        if not end:
            return
        del self.sessions[key]
        payload = session[0]
        if not start:
            said, payload = payload[0] | payload[1] << 8, payload[2:]
            if signature is None or crc16(payload, seed(signature)) != said:
                self.bad.append(f"{kind} {kind_number}: wrong CRC")
                return
        self.came.append(Transfer(kind, kind_number, source, to, tail & 0x1F, payload, now))
        self.allocate(self.came[-1])

    def allocate(self, transfer):
        """The server of ids: repeats what it has of the unique id, gives the id at the end."""
        if self.server is None or transfer.kind != "message" or transfer.type != 1 or transfer.source != 0:
            return
        asks = transfer.fields()
        so_far, given = self.server
        so_far = (b"" if asks["first"] else so_far) + bytes(asks["unique_id"])
        self.server = (so_far, given)
        whole = len(so_far) == 16
        if whole:
            self.granted.append(so_far)
        self.send("message", 1, encode(MESSAGES[1][2], node_id=given if whole else 0, unique_id=so_far))

    def send(self, kind, kind_number, payload, to=0):
        """A transfer of ours."""
        number_of_transfer = self.ids[(kind, kind_number, to)] = (self.ids.get((kind, kind_number, to), -1) + 1) % 32
        number_of_frame = 20 << 24 | kind_number << 8 | self.node if kind == "message" else \
            20 << 24 | kind_number << 16 | (1 << 15 if kind == "request" else 0) | to << 8 | 0x80 | self.node
        pieces = [payload]
        if len(payload) > 7:
            whole = crc16(payload, seed(signature_of(kind, kind_number))).to_bytes(2, "little") + payload
            pieces = [whole[at:at + 7] for at in range(0, len(whole), 7)]
        for i, piece in enumerate(pieces):
            tail = (0x80 if i == 0 else 0) | (0x40 if i == len(pieces) - 1 else 0) | (i & 1) << 5 | number_of_transfer
            self.put(number_of_frame, piece + bytes([tail]))

    def ask(self, service, to, patience=3, **fields):
        """The answer of a service; None where none came."""
        before = len(self.came)
        self.send("request", service, encode(SERVICES[service][1], **fields), to)

        def answers():
            return [t for t in self.came[before:] if t.kind == "response" and t.type == service and t.source == to]
        self.run(patience, answers)
        return answers()[0].fields() if answers() else None

    def all(self, kind_number):
        return [t for t in self.came if t.kind == "message" and t.type == kind_number]


class MulticastBus(Bus):
    """A bus of UDP multicast on the loopback interface, as ArduPilot's SITL has it (AP_HAL_SITL, CAN_Multicast.cpp)."""
    PORT, MAGIC = 57732, 0x2934

    def __init__(self, bus, node=127):
        super().__init__("/dev/null", node)
        group, here = f"239.65.82.{bus}", socket.inet_aton("127.0.0.1")
        self.receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.receiver.bind((group, self.PORT))
        self.receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(group) + here)
        self.sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, here)
        self.sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        self.sender.connect((group, self.PORT))

    def close(self):
        self.receiver.close()
        self.sender.close()
        super().close()

    def frames(self, patience):
        while select.select([self.receiver], [], [], patience)[0]:
            patience = 0
            datagram, sender = self.receiver.recvfrom(100)
            if sender == self.sender.getsockname():
                continue
            magic, crc, flags, number_of_frame = struct.unpack_from("<HHHI", datagram)
            if magic != self.MAGIC or crc16(datagram[4:]) != crc or flags or not number_of_frame >> 31:
                self.bad.append(f"datagram {datagram.hex()}")
                continue
            yield number_of_frame & 0x1FFFFFFF, datagram[10:]

    def put(self, number_of_frame, data):
        body = struct.pack("<HI", 0, 1 << 31 | number_of_frame) + data
        self.sender.send(struct.pack("<HH", self.MAGIC, crc16(body)) + body)


def lost(transfers):
    """How many transfers are missing between those of one type, by their ids."""
    return sum((after.id - before.id - 1) % 32 for before, after in zip(transfers, transfers[1:]))


def accuracy(covariance):
    """What ArduPilot reads of six covariances (AP_GPS_DroneCAN.cpp): horizontal, vertical, speed."""
    return math.sqrt(covariance[0]), math.sqrt(covariance[2]), math.sqrt(sum(covariance[3:]) / 3)
