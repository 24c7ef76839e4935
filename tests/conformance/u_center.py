"""u-center's habits, as far as they can be seen from outside: it polls every message whose window is open.

Specification 6.8, 2.3, 4.1, 4.2 and 4.8: what a board has is answered, what it has not is met with silence (or an
ACK-NAK, class CFG alone), on a quiet line within 50 ms; its buttons restart the receiver.
"""
import struct

import solutions
import ubx
from dialogue import Client

SPEED = 115200
QUICK = 50
SLACK = 100  # what a busy machine may add
BUTTON = 6.0
ALL = ("ublox-m8", "ublox-m9", "ublox-m10", "ublox-f9p")
KEYED = ALL[1:]
M8, M9, M10, F9P = ((board,) for board in ALL)
# Polled by an empty payload and answered once, without an acknowledgement: message, and the boards that have it.
POLLED = (
    (0x0101, ALL), (0x0102, ALL), (0x0103, ALL), (0x0104, ALL), (0x0106, M8), (0x0107, ALL), (0x0109, ALL),
    (0x0111, ALL), (0x0112, ALL), (0x0113, F9P), (0x0114, F9P), (0x0120, ALL), (0x0121, ALL), (0x0122, ALL),
    (0x0123, ALL),
    (0x0124, ALL), (0x0125, ALL), (0x0126, ALL), (0x0130, M8), (0x0132, ALL), (0x0134, ALL), (0x0135, ALL),
    (0x0136, KEYED), (0x013B, F9P), (0x013C, F9P), (0x0143, KEYED), (0x0161, ALL), (0x0A04, ALL), (0x0A28, ALL),
    (0x0A36, KEYED), (0x0A38, KEYED), (0x2703, ALL))
# Legacy settings: the data, then ACK-ACK; or ACK-NAK alone where the board has them not.
SETTINGS = ((0x0600, ALL), (0x0608, ALL), (0x0616, M8 + M9 + F9P), (0x0624, ALL), (0x0631, ALL),
            (0x063E, M8 + M9 + F9P))
UNKNOWN = (0x0177, 0x0A77, 0x0277)
UNKNOWN_SETTING = 0x0677


class UCenter(Client):
    name = "u-center"

    def run(self):
        self.connect()
        self.strict_acks = True
        self.asked.clear()
        self.settings()
        self.messages()
        self.strangers()
        self.restart()

    def connect(self):
        self.step(f"{SPEED} baud and a quiet line")
        self.speed(self.board.speed)
        self.pump(1.0)
        self.send(ubx.cfg_prt((1, 0x8D0, SPEED, 0x03, 0x01)))
        self.pump(0.4)
        self.speed(SPEED)
        self.pump(1.0)
        self.check(self.version(1000) is not None, "MON-VER at the new speed", None)

    def settings(self):
        for message, boards in SETTINGS:
            self.step(f"{ubx.name(message)} poll")
            self.forget()
            began = self.items
            has = self.board.name in boards
            answer = self.poll(ubx.frame(message), message, QUICK + SLACK, nak_is_good=not has)
            self.check((answer is not None) == has, f"{'its data' if has else 'ACK-NAK'}", answer)
            self.pump(0.1)
            self.check(self.items - began <= 2, "one answer and one acknowledgement", f"{self.items - began} items")

    def messages(self):
        for message, boards in POLLED:
            self.step(f"{ubx.name(message)} poll")
            self.pump(0.02)
            self.forget()
            self.send(ubx.frame(message))
            if self.board.name in boards:
                # A NAV message may wait for the end of the next epoch.
                self.need_frame(message, 1200 if message >> 8 == 1 else QUICK + SLACK)
            self.pump(0.12)
            rest = [item for item in self.pending if isinstance(item, ubx.Frame)]
            self.check(not rest, "no acknowledgement and no second answer", " ".join(map(str, rest)))

    def strangers(self):
        """Unknown messages, broken frames, and good ones right behind them."""
        for message in UNKNOWN:
            self.step(f"unknown message {ubx.name(message)}")
            self.forget()
            self.send(ubx.frame(message))
            self.pump(0.2)
            self.check(not self.pending, "silence", " ".join(map(str, self.pending)))
        self.step("unknown setting")
        self.send(ubx.frame(UNKNOWN_SETTING))
        self.check(self.wait_ack(UNKNOWN_SETTING, QUICK + SLACK) is False, "ACK-NAK of 06-77", None)
        self.step("a frame with a wrong checksum and a good one")
        self.forget()
        self.send(ubx.frame("CFG-RATE")[:-1] + b"\x00" + ubx.frame("MON-VER"), "CFG-RATE broken, MON-VER")
        self.need_frame("MON-VER", QUICK + SLACK)
        self.check(not self.pending, "no answer to the broken one", " ".join(map(str, self.pending)))
        self.step("B5 before a good frame; a length that is too long before six good ones")
        self.send(b"\xb5" + ubx.frame("MON-VER"), "B5, MON-VER")
        self.need_frame("MON-VER", QUICK + SLACK)
        wrong = ubx.SYNC + b"\x0a\x04\x1e\x00"
        self.send(wrong + 6 * ubx.frame("MON-VER"), "a length of 30, six MON-VER")
        for _ in range(6):
            self.need_frame("MON-VER", 6 * QUICK + SLACK)

    def restart(self):
        """The cold start button: nothing was saved, so the receiver is back at its first speed, with its sentences."""
        self.step("CFG-RST: cold, controlled; no answer")
        self.forget()
        self.send(ubx.frame("CFG-RST", struct.pack("<HBB", 0xFFFF, 1, 0)))
        self.pump(0.2)
        acks = [item for item in self.pending if isinstance(item, ubx.Frame) and item.message >> 8 == 5]
        self.check(not acks, "no acknowledgement of CFG-RST", " ".join(map(str, acks)))
        self.speed(self.board.speed)
        self.step(f"banner and sentences at {self.board.speed} baud")
        items = self.collect(BUTTON)
        texts = [i.fields[-1] for i in items if isinstance(i, ubx.Sentence) and i.fields[0][2:] == "TXT"]
        self.check(any("u-blox AG" in text for text in texts), "the banner", texts or solutions.kinds(items))
        version = f"PROTVER={self.board.protocol[0]}.{self.board.protocol[1]:02}"
        self.check(version in texts, version, texts)
        kinds = {i.fields[0][2:] for i in items if isinstance(i, ubx.Sentence)}
        self.check({"GGA", "RMC", "GSV"} <= kinds, "the sentences of the factory", solutions.kinds(items))
        last = [i for i in items if isinstance(i, ubx.Sentence) and i.fields[0][2:] == "RMC"][-1]
        self.check(last.fields[2] == "V", "no fix so soon after a cold start", last)
