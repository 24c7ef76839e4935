"""NMEA 0183 sentences as a strict client reads and writes them."""
import re

FORM = re.compile(r"^\$([^*$]*)\*([0-9A-F]{2})$")


def checksum(body):
    """Two upper-case digits: the exclusive or of the characters between `$` and `*`."""
    value = 0
    for char in body:
        value ^= ord(char)
    return f"{value:02X}"


def sentence(body):
    """The bytes of a sentence from what stands between `$` and `*`."""
    return f"${body}*{checksum(body)}\r\n".encode("ascii")


def fields(text):
    """The fields of a sentence without its line end, address first; None when form or checksum is wrong.

    Lower-case digits are wrong: PX4 and ArduPilot compare with upper-case ones.
    """
    match = FORM.match(text)
    if not match or checksum(match[1]) != match[2]:
        return None
    return match[1].split(",")


def degrees(value, hemisphere):
    """ddmm.mmmm or dddmm.mmmm and its letter as signed degrees."""
    whole, minutes = divmod(float(value), 100)
    return (whole + minutes / 60) * (-1 if hemisphere in "SW" else 1)


def time_of_day(value):
    """hhmmss.ss as seconds."""
    return int(value[:2]) * 3600 + int(value[2:4]) * 60 + float(value[4:])
