"""UBX frames as clients send them."""
import struct


def ubx(number, payload=b""):
    """A frame of class and identity with its checksum (u-blox M8 protocol, section 32.4)."""
    body = bytes(number) + struct.pack("<H", len(payload)) + payload
    a = b = 0
    for byte in body:
        a = (a + byte) & 0xFF
        b = (b + a) & 0xFF
    return b"\xb5\x62" + body + bytes((a, b))


def valset(values, layers=1):
    """CFG-VALSET of RAM, or of other layers, from pairs of a key and its value (F9 HPG 1.32, section 3.10.26)."""
    sizes = {1: "B", 2: "B", 3: "H", 4: "I", 5: "Q"}
    items = b"".join(struct.pack("<I" + sizes[key >> 28 & 7], key, value) for key, value in values)
    return ubx((0x06, 0x8A), bytes((0, layers, 0, 0)) + items)
