"""ubloxcfg's cfgtool: its preamble, its hunt for the speed, and all keys of a layer page by page.

Specification 6.7, 4.4 and 11. 1500 ms at each speed; 1024 bytes 0x55 before the first request.
"""
import ubx
from dialogue import Client

SPEEDS = (9600, 38400, 115200, 230400, 460800, 921600)
WAIT = 1500
PREAMBLE = b"\x55" * 1024
EVERYTHING = 0x0FFFFFFF


class UbloxCfg(Client):
    name = "cfgtool"

    def run(self):
        self.connect()
        self.strict_acks = True
        self.asked.clear()
        if not self.board.has_keys:
            self.step("CFG-VALGET, which this receiver does not know")
            self.send(ubx.valget([0x30210001]))
            answer = self.wait_ack("CFG-VALGET", WAIT)
            self.check(answer is False, "ACK-NAK", "ACK-ACK" if answer else None)
            return
        ram = self.read_all(ubx.READ_RAM)
        defaults = self.read_all(ubx.READ_DEFAULT)
        self.check([k for k, _ in ram] == [k for k, _ in defaults], "the same keys in RAM and Default",
                   f"{len(ram)} and {len(defaults)}")
        self.check_known(dict(defaults))
        self.read_some(dict(ram))
        self.store()

    def connect(self):
        for speed in SPEEDS:
            self.step(f"1024 bytes 55 and MON-VER at {speed} baud")
            self.speed(speed)
            self.send(PREAMBLE, "1024 bytes 55")
            version = self.version(WAIT)
            if version:
                self.check(speed == self.board.speed, f"an answer at {self.board.speed} baud", f"one at {speed}")
                return
        self.fail(f"MON-VER at one of {SPEEDS}")

    def read_all(self, layer):
        """All pairs of a layer."""
        pairs, position = [], 0
        while True:
            self.step(f"CFG-VALGET of everything, layer {layer}, from {position}")
            answer = self.poll(ubx.valget([EVERYTHING], layer, position), "CFG-VALGET", WAIT)
            self.check(answer.payload[1] == layer and int.from_bytes(answer.payload[2:4], "little") == position,
                       f"layer {layer} and position {position} in the answer", answer.payload[:4].hex(" "))
            page = ubx.valget_pairs(answer.payload)
            self.check(len(page) <= ubx.PAGE, f"at most {ubx.PAGE} keys a page", len(page))
            pairs += page
            position += ubx.PAGE
            if len(page) < ubx.PAGE:
                break
        numbers = [key & 0x0FFFFFFF for key, _ in pairs]
        self.check(numbers == sorted(set(numbers)), "every key once, by rising group and item", len(numbers))
        self.check(len(pairs) > 150, "more than 150 keys", len(pairs))
        return pairs

    def check_known(self, defaults):
        """The defaults that every board has."""
        self.step("defaults")
        for key, value in ((0x30210001, 1000), (0x30210002, 1), (0x20210003, 1), (0x40520001, self.board.speed),
                           (0x20110011, 3), (0x20110021, 0), (0x209100AC, 1), (0x20910007, 0), (0x10730001, 1),
                           (0x10740002, 1)):
            self.check(defaults.get(key) == value, f"key {key:08X} = {value} by default", defaults.get(key))

    def read_some(self, ram):
        """Keys one does not ask for in order come in the order of the request."""
        keys = [0x40520001, 0x10740002, 0x30210001, 0x20110021]
        self.step("CFG-VALGET of four keys")
        answer = self.poll(ubx.valget(keys), "CFG-VALGET", WAIT)
        self.check(ubx.valget_pairs(answer.payload) == [(key, ram[key]) for key in keys], "the four in that order",
                   ubx.valget_pairs(answer.payload))
        self.step("CFG-VALGET of an unknown key among good ones")
        self.send(ubx.valget([0x30210001, 0x2099FFF0]))
        answer = self.wait_ack("CFG-VALGET", WAIT)
        self.check(answer is False, "ACK-NAK", "ACK-ACK" if answer else None)

    def store(self):
        """What is set in a layer is read from that layer alone."""
        key = 0x20110021
        kept = [(ubx.BBR, ubx.READ_BBR), (ubx.FLASH, ubx.READ_FLASH)]
        if not self.board.has_flash:
            self.step("CFG-VALSET to a flash that is not there")
            self.send(ubx.valset([(key, 4)], ubx.BBR | ubx.FLASH))
            answer = self.wait_ack("CFG-VALSET", WAIT)
            self.check(answer is False, "ACK-NAK", "ACK-ACK" if answer else None)
            kept.pop()
        layers = sum(bit for bit, _ in kept)
        self.step("CFG-VALSET to the layers that are kept; RAM stays")
        self.set(ubx.valset([(key, 4)], layers), "CFG-VALSET", WAIT)
        for layer, value in [(layer, 4) for _, layer in kept] + [(ubx.READ_RAM, 0), (ubx.READ_DEFAULT, 0)]:
            answer = self.poll(ubx.valget([key], layer), "CFG-VALGET", WAIT)
            self.check(ubx.valget_pairs(answer.payload) == [(key, value)], f"{value} in layer {layer}",
                       ubx.valget_pairs(answer.payload))
        self.step("CFG-VALDEL from them; then none has it")
        self.set(ubx.valdel([key], layers), "CFG-VALDEL", WAIT)
        for _, layer in kept:
            self.send(ubx.valget([key], layer))
            answer = self.wait_ack("CFG-VALGET", WAIT)
            self.check(answer is False, f"ACK-NAK: layer {layer} has no such key", "ACK-ACK" if answer else None)
        self.step("one unknown key spoils five")
        spoilt = [(0x30210001, 500), (0x30210002, 2), (0x2099FFF0, 1), (0x20110021, 7), (0x20110011, 2)]
        self.send(ubx.valset(spoilt))
        answer = self.wait_ack("CFG-VALSET", WAIT)
        self.check(answer is False, "ACK-NAK", "ACK-ACK" if answer else None)
        answer = self.poll(ubx.valget([0x30210001, 0x30210002, 0x20110021, 0x20110011]), "CFG-VALGET", WAIT)
        self.check([v for _, v in ubx.valget_pairs(answer.payload)] == [1000, 1, 0, 3], "none of them changed",
                   ubx.valget_pairs(answer.payload))
