"""Septentrio's stream: blocks and the answers of the command line."""
import dataclasses
import functools
import operator
import re
import struct

ANSWER_END = re.compile(rb"\r\n[A-Z-][A-Z0-9-]{3}>")
PROMPT = re.compile(rb"[A-Z][A-Z0-9]{3}>")
NOTHING = -2e10


def crc(data):
    """CRC-16, polynomial 0x1021, start 0."""
    value = 0
    for byte in data:
        value ^= byte << 8
        for _ in range(8):
            value = value << 1 ^ 0x1021 if value & 0x8000 else value << 1
        value &= 0xFFFF
    return value


@dataclasses.dataclass(frozen=True)
class Block:
    number: int
    body: bytes
    at: float

    @property
    def tow_ms(self):
        return struct.unpack_from("<I", self.body)[0]

    def __str__(self):
        return f"block {self.number}, {len(self.body)} bytes, tow {self.tow_ms}"


@dataclasses.dataclass(frozen=True)
class Answer:
    """From $R to the prompt; a prompt alone has no text."""
    text: str
    prompt: str
    at: float

    def __str__(self):
        return f"{self.text!r} {self.prompt}"


@dataclasses.dataclass(frozen=True)
class Sentence:
    """A line of NMEA with a right checksum."""
    text: str
    at: float

    def __str__(self):
        return self.text


class Parser:
    """Everything must be a block, an answer or a sentence: other bytes are noise."""

    def __init__(self):
        self.clear()

    def clear(self):
        self.buffer, self.noise = b"", bytearray()

    def feed(self, data, at):
        self.buffer += data
        while self.buffer:
            item, used = self.first(at)
            if used == 0:
                return
            self.buffer = self.buffer[used:]
            if item:
                yield item

    def first(self, at):
        """The item at the front and its bytes; 0 bytes while it is not whole."""
        data = self.buffer
        if data.startswith(b"$@"):
            if len(data) < 8:
                return None, 0
            checksum, number, length = struct.unpack_from("<HHH", data, 2)
            if length % 4 == 0 and 8 <= length <= 8192:
                if len(data) < length:
                    return None, 0
                if crc(data[4:length]) == checksum:
                    return Block(number & 0x1FFF, data[8:length], at), length
        elif data.startswith(b"$R") or data == b"$":
            end = ANSWER_END.search(data)
            if not end and len(data) < 2000:
                return None, 0
            if end:
                return Answer(data[:end.start()].decode("ascii"), data[end.end() - 5:end.end() - 1].decode(), at), end.end()
        elif data.startswith(b"$G"):
            end = data.find(b"\r\n")
            if end < 0 and len(data) < 90:
                return None, 0
            body, _, checksum = data[1:end].partition(b"*")
            if checksum == b"%02X" % functools.reduce(operator.xor, body, 0):
                return Sentence(data[:end].decode("ascii"), at), end + 2
        elif PROMPT.match(data):
            return Answer("", data[:4].decode(), at), 5
        elif len(data) < 5 and re.match(rb"[A-Z][A-Z0-9]*$", data):
            return None, 0
        self.noise += data[:1]
        return None, 1
