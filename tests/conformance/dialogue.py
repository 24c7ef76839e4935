"""What every scripted client shares: named steps, waiting with deadlines, and failures that tell what came instead."""
import collections
import time

import ubx

KEPT = 14  # lines of the log that a failure shows


class Failure(AssertionError):
    """A dialogue did not go as the specification of the client says."""


class Client:
    """A client on a wire. `name` is that of the program it stands for."""

    name = "client"
    patience = 70.0  # seconds that the whole dialogue may take
    after_power_on = 5.0  # seconds that its user leaves the receiver to start; a flight controller leaves none
    arguments = ()  # more arguments of `skyloop run`
    scenario = ""  # TOML that the arguments are laid over
    laid_to = ""  # of the board, "uart3"; empty: the first UART
    orbits = ""  # file below the shared navigation data that the run uses; the client is skipped without it

    def __init__(self, wire, board):
        self.wire = wire
        self.board = board
        self.parser = ubx.Parser()
        self.began = time.monotonic()
        self.step_name = "begin"
        self.log = collections.deque(maxlen=4000)
        self.pending = collections.deque()
        self.asked = collections.Counter()
        self.strict_acks = False
        self.items = 0

    # --- telling ---

    def note(self, text):
        self.log.append(f"{time.monotonic() - self.began:8.3f}  {text}")

    def step(self, text):
        """Begins a step; a failure names it."""
        self.step_name = text
        self.note(f"-- {text}")
        if time.monotonic() - self.began > self.patience:
            self.fail(f"the dialogue to be over within {self.patience:g} s")

    def fail(self, expected, came=None):
        lines = "\n    ".join(list(self.log)[-KEPT:])
        raise Failure(f"{self.name} on {self.board.name} at {self.wire.speed} baud, step '{self.step_name}':\n"
                      f"  expected {expected}\n  came     {came or 'nothing of it'}\n  last:\n    {lines}")

    def check(self, good, expected, came):
        if not good:
            self.fail(expected, came)

    # --- writing ---

    def speed(self, speed):
        """Changes the client's speed; what was received until then is lost."""
        self.wire.set_speed(speed)
        self.parser.clear()
        self.pending.clear()
        self.note(f"speed {speed}")

    def send(self, data, what=None):
        """Writes bytes; every CFG frame among them asks for an acknowledgement."""
        parts = ubx.Parser().feed(data)
        for item in parts:
            if isinstance(item, ubx.Frame) and item.message >> 8 == 0x06 and item.message != 0x0604:
                self.asked[item.message] += 1
        self.note(f"> {what or ' '.join(map(str, parts)) or f'{len(data)} bytes'}")
        self.wire.write(data)

    # --- reading ---

    def pump(self, seconds):
        """Reads for so long; what came waits in `pending`."""
        end = time.monotonic() + seconds
        while True:
            left = end - time.monotonic()
            data, at = self.wire.read(min(max(left, 0.0), 0.05))
            if data:
                self.take(data, at)
            elif left <= 0:
                return

    def take(self, data, at):
        for item in self.parser.feed(data, at):
            self.items += 1
            self.note(f"< {item}")
            if isinstance(item, ubx.Frame) and item.message in (0x0500, 0x0501) and len(item.payload) == 2:
                self.acknowledged(item)
            self.pending.append(item)

    def acknowledged(self, item):
        message = item.payload[0] << 8 | item.payload[1]
        self.asked[message] -= 1
        if self.asked[message] < 0:
            self.asked[message] = 0
            if self.strict_acks:
                self.fail("no acknowledgement that was not asked for", item)

    def forget(self):
        """Drops what came and was not looked at."""
        self.pending.clear()

    def wait(self, match, milliseconds):
        """The first item that `match` takes, within that time after the last byte written; None when none came."""
        end = max(self.wire.written_until, time.monotonic()) + milliseconds / 1000
        over = False
        while True:
            while self.pending:
                item = self.pending.popleft()
                if match(item):
                    return item
            if over:
                return None
            left = end - time.monotonic()
            # What came while this process had to wait for the processor has come in time: one look more.
            over = left <= 0
            data, at = self.wire.read(min(max(left, 0.0), 0.05))
            if data:
                self.take(data, at)

    def need(self, match, milliseconds, what):
        """As wait(), but its absence ends the dialogue."""
        item = self.wait(match, milliseconds)
        if item is None:
            self.fail(f"{what} within {milliseconds} ms of the request")
        return item

    def wait_frame(self, message, milliseconds):
        return self.wait(lambda item: isinstance(item, ubx.Frame) and item.is_a(message), milliseconds)

    def need_frame(self, message, milliseconds):
        return self.need(lambda item: isinstance(item, ubx.Frame) and item.is_a(message), milliseconds,
                         ubx.name(ubx.number(message)))

    def wait_ack(self, message, milliseconds):
        """True for an ACK-ACK of the message, False for an ACK-NAK, None when neither came in time."""
        message = ubx.number(message)
        wanted = bytes((message >> 8, message & 0xFF))
        item = self.wait(lambda i: isinstance(i, ubx.Frame) and i.message in (0x0500, 0x0501) and i.payload == wanted,
                         milliseconds)
        return None if item is None else item.message == 0x0501

    def need_ack(self, message, milliseconds, nak_is_good=False):
        """An ACK-ACK in time, or an ACK-NAK where the client takes it as well."""
        answer = self.wait_ack(message, milliseconds)
        if answer is None or not (answer or nak_is_good):
            wanted = "ACK-ACK or ACK-NAK" if nak_is_good else "ACK-ACK"
            self.fail(f"{wanted} of {ubx.name(ubx.number(message))} within {milliseconds} ms of the request",
                      None if answer is None else "ACK-NAK")
        return answer

    def set(self, data, message, milliseconds, nak_is_good=False):
        """Sends a setting and needs its acknowledgement."""
        self.forget()
        self.send(data)
        return self.need_ack(message, milliseconds, nak_is_good)

    def poll(self, data, message, milliseconds, nak_is_good=False):
        """Polls a configuration message: the answer and then its ACK-ACK. None after an ACK-NAK where that is good."""
        self.forget()
        self.send(data)
        number = ubx.number(message)
        wanted = bytes((number >> 8, number & 0xFF))
        first = self.need(lambda i: isinstance(i, ubx.Frame) and
                          (i.message == number or i.message in (0x0500, 0x0501) and i.payload == wanted),
                          milliseconds, f"{ubx.name(number)} and its ACK-ACK")
        if first.message == 0x0500 and nak_is_good:
            return None
        self.check(first.message == number, f"the data of {ubx.name(number)} before its acknowledgement", first)
        self.need_ack(number, milliseconds)
        return first

    def version(self, milliseconds):
        """Polls MON-VER; None when it did not come in time. No acknowledgement may follow it."""
        self.forget()
        self.send(ubx.frame("MON-VER"))
        item = self.wait_frame("MON-VER", milliseconds)
        return ubx.mon_ver(item.payload) if item else None

    # --- a dialogue ---

    def run(self):
        """The whole dialogue; raises Failure."""
        raise NotImplementedError

    def collect(self, seconds):
        """All items of so many seconds, and the last of the line before them forgotten."""
        self.forget()
        self.pump(seconds)
        found = list(self.pending)
        self.pending.clear()
        return found
