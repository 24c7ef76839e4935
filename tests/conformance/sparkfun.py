"""SparkFun's u-blox library, version 3: begin(), setSerialRate() and what its first example asks for.

Specification 6.7. 1100 ms for every answer; the data of a poll come before its acknowledgement.
"""
import solutions
import ubx
from dialogue import Client

WAIT = 1100
HEALTHY = 10.0
PERIOD = 250
SPEEDS = (115200, 38400, 9600)


class SparkFun(Client):
    name = "SparkFun"

    def run(self):
        self.begin()
        self.raise_speed()
        self.protocols()
        self.identify()
        self.solutions()

    def connected(self):
        """Asks for CFG-UART1INPROT-UBX in RAM, three times."""
        for _ in range(3):
            self.forget()
            self.send(ubx.valget([0x10730001]))
            answer = self.wait_frame("CFG-VALGET", WAIT)
            if answer is None:
                continue
            self.check(ubx.valget_pairs(answer.payload) == [(0x10730001, 1)], "key 10730001 = 1",
                       ubx.valget_pairs(answer.payload))
            self.check(answer.payload[:4] == bytes((1, 0, 0, 0)), "version 1, layer 0, position 0",
                       answer.payload[:4].hex(" "))
            self.need_ack("CFG-VALGET", WAIT)
            return True
        return False

    def begin(self):
        for speed in SPEEDS:
            self.step(f"CFG-VALGET at {speed} baud, three times")
            self.speed(speed)
            if self.connected():
                return
        self.fail(f"an answer at one of {SPEEDS}")

    def raise_speed(self):
        self.step("CFG-VALSET of the speed; no acknowledgement is needed")
        if self.wire.speed == 115200:
            return
        self.send(ubx.valset([(0x40520001, 115200)], ubx.RAM | ubx.BBR))
        self.wait_ack("CFG-VALSET", 250)
        self.speed(115200)
        self.pump(0.1)
        self.step("CFG-VALGET at the new speed")
        self.check(self.connected(), "an answer at 115200 baud", None)

    def protocols(self):
        self.asked.clear()
        self.strict_acks = True
        self.step("UBX and no NMEA going out")
        self.set(ubx.valset([(0x10740001, 1), (0x10740002, 0)], ubx.RAM | ubx.BBR), "CFG-VALSET", WAIT)
        self.step("RTCM 3 going out")
        self.set(ubx.valset([(0x10740004, 0)], ubx.RAM | ubx.BBR), "CFG-VALSET", WAIT,
                 nak_is_good=not self.board.is_f9p)

    def identify(self):
        self.step("MON-VER")
        version = self.version(WAIT)
        self.check(version is not None, f"MON-VER within {WAIT} ms", None)
        self.check(bool(version.value_of("FWVER")) and version.protocol == self.board.protocol,
                   f"FWVER= and PROTVER={self.board.protocol}", version.extensions)

    def solutions(self):
        self.step("rate and NAV-PVT")
        self.set(ubx.valset([(0x30210001, PERIOD)], ubx.RAM | ubx.BBR), "CFG-VALSET", WAIT)
        self.set(ubx.valset([(0x20910007, 1)], ubx.RAM | ubx.BBR), "CFG-VALSET", WAIT)
        self.set(ubx.valset([(0x20110021, 4)], ubx.RAM), "CFG-VALSET", WAIT)
        self.step("the dynamic model read back")
        answer = self.poll(ubx.valget([0x20110021]), "CFG-VALGET", WAIT)
        self.check(ubx.valget_pairs(answer.payload) == [(0x20110021, 4)], "key 20110021 = 4",
                   ubx.valget_pairs(answer.payload))
        self.step("a polled NAV-PVT")
        self.set(ubx.valset([(0x20910007, 0)]), "CFG-VALSET", WAIT)
        self.pump(0.5)
        self.forget()
        self.send(ubx.frame("NAV-PVT"))
        self.need_frame("NAV-PVT", WAIT)
        self.set(ubx.valset([(0x20910007, 1)]), "CFG-VALSET", WAIT)
        self.step("solutions")
        self.pump(1.0)
        items = self.collect(HEALTHY)
        solutions.check_kinds(self, items, ["NAV-PVT"])
        solutions.check_solutions(self, items, PERIOD, 2 * PERIOD, HEALTHY)
