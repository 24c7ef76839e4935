"""A client's end of a serial line: any speed, raw bytes with the time of their arrival, four manners of writing."""
import errno
import fcntl
import os
import random
import select
import struct
import termios
import time

# Linux, asm-generic/ioctls.h and termbits.h: struct termios2, which alone can carry a speed that has no name.
TCGETS2 = 0x802C542A
TCSETS2 = 0x402C542B
TERMIOS2 = struct.Struct("=4IB19s2I")
CBAUD = 0o010017
BOTHER = 0o010000
IBSHIFT = 16

WRITES = ("whole", "bytes", "bursts", "garbage")

# Line noise that no receiver may answer, and that hides no good frame behind it: padding, a lone sync byte, a sentence
# that breaks off, a frame with a wrong checksum.
NOISE = (b"\xff", b"\x00\x00", b"\x55" * 16, b"\xb5", b"$GPGG\x80",
         b"\xb5\x62\x0a\x04\x00\x00\xff\xff", b"\xfe\x81\x90\xa5")


def take_priority():
    """A flight controller does not share its processor with what else runs here; without the right to it we do."""
    try:
        os.sched_setscheduler(0, os.SCHED_RR | os.SCHED_RESET_ON_FORK, os.sched_param(1))
    except PermissionError:
        pass


class Wire:
    """One open tty. Times are those of time.monotonic()."""

    def __init__(self, path, speed=9600, writes="whole", seed=1):
        if writes not in WRITES:
            raise ValueError(f"writes is '{writes}', expected one of {' '.join(WRITES)}")
        self.path = str(path)
        self.writes = writes
        self.random = random.Random(seed)
        self.speed = None
        self.written_until = 0.0
        self.descriptor = os.open(self.path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        self.set_speed(speed)

    def set_speed(self, speed):
        """Sets raw mode and the speed once the last byte written has left; drops what was received but not read."""
        self.drain()
        flags = list(TERMIOS2.unpack(fcntl.ioctl(self.descriptor, TCGETS2, bytes(TERMIOS2.size))))
        control = flags[2] & ~(CBAUD | (CBAUD << IBSHIFT) | termios.CSIZE | termios.PARENB | termios.CSTOPB)
        flags[0] = flags[1] = flags[3] = 0
        flags[2] = control | BOTHER | termios.CS8 | termios.CREAD | termios.CLOCAL
        flags[6] = flags[7] = speed
        fcntl.ioctl(self.descriptor, TCSETS2, TERMIOS2.pack(*flags))
        self.flush()
        self.speed = speed

    def read_speed(self):
        """The speed that the tty says it has."""
        return TERMIOS2.unpack(fcntl.ioctl(self.descriptor, TCGETS2, bytes(TERMIOS2.size)))[7]

    def flush(self):
        """Forgets what waits in either direction (TCFLSH)."""
        termios.tcflush(self.descriptor, termios.TCIOFLUSH)

    def seconds(self, count):
        """How long so many bytes of ten bits take."""
        return count * 10 / self.speed

    def drain(self):
        """Waits until the last byte written has left, as a UART takes its time for it."""
        left = self.written_until - time.monotonic()
        if left > 0:
            time.sleep(left)

    def write(self, data):
        """Writes in the manner of this wire; gives the time when the last byte has left."""
        if self.writes == "bytes":
            for value in data:
                self._put(bytes([value]))
                self.drain()
        elif self.writes == "bursts":
            while data:
                count = self.random.randint(3, 16)
                self._put(data[:count])
                data = data[count:]
                self.drain()
                time.sleep(0.003)
        elif self.writes == "garbage":
            self._put(b"".join(self.random.choices(NOISE, k=3)) + data)
        else:
            self._put(data)
        return self.written_until

    def _put(self, data):
        self.written_until = max(self.written_until, time.monotonic()) + self.seconds(len(data))
        while data:
            try:
                data = data[os.write(self.descriptor, data):]
            except BlockingIOError:
                select.select([], [self.descriptor], [], 0.5)

    def read(self, patience):
        """Bytes and the time of their arrival; no bytes when none came within `patience` seconds."""
        if not select.select([self.descriptor], [], [], max(0.0, patience))[0]:
            return b"", time.monotonic()
        try:
            return os.read(self.descriptor, 65536), time.monotonic()
        except BlockingIOError:
            return b"", time.monotonic()
        except OSError as error:
            if error.errno == errno.EIO:
                raise ConnectionError(f"{self.path}: the receiver has gone") from None
            raise

    def close(self):
        os.close(self.descriptor)
