"""The drivers of Septentrio receivers: ArduPilot's AP_GPS_SBF, PX4's septentrio and ROS's septentrio_gnss_driver.

ArduPilot waits for the prompt before each command, and for the first line of its answer; while nothing goes on it asks
for the port every 2 s. PX4 wants the same line, to the letter, within 200 ms, after it has hunted for the speed. ROS's
driver ends its commands with CR alone, waits for the prompt at first and then for an answer to each of them, as long as it
takes (communication_core.cpp, async_manager.hpp and telegram_handler.cpp): it gets 1 s here.
"""
import math
import struct
import time

import receiver
import sbf
from dialogue import Client

ATTENTION = b"SSSSSSSSSS\n"
PVT, DOP, STATUS, BASE, VELOCITY, END, ATTITUDE, ATTITUDE_COV = 4007, 4001, 4014, 4028, 5908, 5921, 5938, 5939
AUTHENTICATION, RADIO, QUALITY = 4245, 4092, 4082
DISK = 1 << 7 | 1 << 9
WHEN_SET = 1 << 4 | 1 << 5
HEALTHY = 8.0


class Septentrio(Client):
    """What both have in common."""

    after_power_on = 1.0

    def __init__(self, wire, board):
        super().__init__(wire, board)
        self.parser = sbf.Parser()

    def prompt(self, milliseconds):
        return self.wait(lambda item: isinstance(item, sbf.Answer) and not item.text, milliseconds)

    def command(self, line, milliseconds):
        """Sends a command; its answer must repeat it to the letter."""
        self.step(line)
        self.forget()
        self.send(line.encode() + b"\n")
        answer = self.need(lambda item: isinstance(item, sbf.Answer) and item.text, milliseconds, f"$R: {line}")
        self.check(answer.text.split("\r\n")[0] == f"$R: {line}", f"$R: {line}", answer)
        return answer

    def watch(self, numbers, period_ms):
        """Blocks of so many seconds: those that were asked for, each at every epoch, and nothing else."""
        self.step("the blocks that were asked for")
        self.pump(0.5)
        blocks = [item for item in self.collect(HEALTHY) if isinstance(item, sbf.Block)]
        self.check(not self.parser.noise, "blocks and answers alone", bytes(self.parser.noise[:60]))
        self.check({b.number for b in blocks} == set(numbers), sorted(numbers), sorted({b.number for b in blocks}))
        for number in numbers:
            times = [b.tow_ms for b in blocks if b.number == number]
            self.check(all(b - a == period_ms for a, b in zip(times, times[1:])), f"{number} every {period_ms} ms", times)
            self.check(len(times) >= (HEALTHY - 1) * 1000 / period_ms, f"{number} for {HEALTHY:g} s", len(times))
        return blocks

    def check_solution(self, blocks):
        last = [b for b in blocks if b.number == PVT][-1].body
        mode, error, latitude, longitude, height, undulation = struct.unpack_from("<BBdddf", last, 6)
        self.check(mode & 15 in (1, 2, 4, 5, 6) and error == 0, "a solution", (mode, error))
        apart = receiver.metres_apart(math.degrees(latitude), math.degrees(longitude))
        self.check(apart < 20, "a position within 20 m of the scenario's", f"one {apart:.1f} m away")
        self.check(abs(height - receiver.PLACE[2]) < 40 and 30 < undulation < 60, "its height", (height, undulation))
        deviations = struct.unpack_from("<fff", [b for b in blocks if b.number == VELOCITY][-1].body, 8)
        self.check(all(0 < d < 4 for d in deviations), "variances of the velocity", deviations)

    def check_state(self, blocks):
        state = struct.unpack_from("<I", [b for b in blocks if b.number == STATUS][-1].body, 12)[0]
        self.check(state & WHEN_SET == WHEN_SET, "week and time of week set", hex(state))
        return state


class ArduPilotSbf(Septentrio):
    """GPS type SBF on a port of 230400 baud, as its makers advise, with automatic configuration and logging."""

    name = "ArduPilot SBF"
    speeds = (115200, 230400)
    lines = ("sso,Stream1,COM1,PVTGeodetic+DOP+ReceiverStatus+VelCovGeodetic+BaseVectorGeod,msec100", "srd,Moderate,UAV",
             "sem,PVT,5", "spm,Rover,all", "sso,Stream2,Dsk1,postprocess+event+comment+ReceiverStatus,msec100",
             "snt,+GEOL1+GEOL5", "sst,+SBAS", "ssbc,auto,Operational,MixedSystems,auto", "sga, none")

    def run(self):
        self.step("the prompt")
        baud = "scs,COM1,baud230400,bits8,No,bit1,none"
        for speed in self.speeds:
            self.speed(speed)
            self.send(b"\n" + ATTENTION)
            if self.prompt(2000) is None:
                continue  # the receiver has its new speed from an earlier dialogue
            if speed != self.speeds[-1]:
                self.send(baud.encode() + b"\n")  # the answer comes at the new speed, which ArduPilot does not have
                self.pump(0.5)
        self.command(baud, 1000)
        for line in self.lines:
            self.command(line, 1000)
        self.pump(3)  # other systems begin to be tracked
        blocks = self.watch({PVT, DOP, STATUS, VELOCITY, BASE}, 100)
        self.check_solution(blocks)
        state = self.check_state(blocks)
        self.check(state & DISK == DISK, "a disk that is mounted and written", hex(state))
        self.step("a command that there is not")
        self.forget()
        self.send(b"sxyz,1\n")
        answer = self.need(lambda item: isinstance(item, sbf.Answer) and item.text, 500, "$R?")
        self.check(answer.text.startswith("$R?"), "$R?", answer)


class Px4Septentrio(Septentrio):
    """PX4's driver with a chosen speed, logging and both antennas, and its watch over the blocks that it needs."""

    name = "PX4 septentrio"
    hunt = (230400, 115200, 230400, 57600, 460800)
    fast = 200
    blocks = (PVT, VELOCITY, DOP, ATTITUDE, ATTITUDE_COV, END, STATUS, AUTHENTICATION, RADIO, QUALITY)

    def run(self):
        self.find()
        self.step("the name of the port")
        self.forget()
        self.send(b"gecm\n")
        answer = self.need(lambda item: isinstance(item, sbf.Answer), 5 * self.fast, "a prompt")
        self.check(answer.prompt == "COM1", "COM1>", answer)
        self.send(b"scs,COM1,baud230400\n")
        self.pump(2.0)
        self.speed(230400)
        for line in ("gecm", "sso,Stream1,COM1,none,off", "ssu,GPS+GLONASS+GALILEO+SBAS+BEIDOU",
                     "sso,Stream2,DSK1,+Comment+ReceiverStatus+PostProcess+Event+Support,sec1", "sdio,COM1,Auto,SBF",
                     "sto,0.000,0.000", "srd,high,UAV",
                     "sso,Stream1,COM1,PVTGeodetic+VelCovGeodetic+DOP+AttEuler+AttCovEuler+EndOfPVT+ReceiverStatus+"
                     "GALAuthStatus+RFStatus+QualityInd,msec200", "sga,MultiAntenna"):
            self.command(line, 1000 if line.startswith("ssu") else self.fast)
            if line == "gecm":
                self.parser.noise.clear()  # the rest of a block that the change of speed has cut
        self.pump(3)
        blocks = self.watch(self.blocks, 200)
        self.check_solution(blocks)
        self.check_state(blocks)
        order = [b.number for b in blocks if b.tow_ms == blocks[len(blocks) // 2].tow_ms]
        self.check(order.index(END) > max(order.index(n) for n in (PVT, VELOCITY, DOP, ATTITUDE, ATTITUDE_COV)),
                   "EndOfPVT behind what it ends", order)
        self.command("erst,soft,none", self.fast)

    def find(self):
        for speed in self.hunt:
            self.step(f"an answer at {speed} baud")
            self.speed(speed)
            self.send(ATTENTION)
            self.pump(0.01)
            self.send(b"\n")
            self.send(b"gecm\n")
            if self.wait(lambda item: isinstance(item, sbf.Answer) and item.text.startswith("$R: gecm"), self.fast):
                return
        self.fail("$R: gecm at one of the speeds")


class Px4GpsSbf(Septentrio):
    """PX4's older driver (GPSDriverSBF, of the module gps): all that it reads is text to it, in which it searches for the
    prompt; the name of its port are the first four characters after a line of its own. One pass."""

    name = "PX4 gps, SBF"
    scenario = ""
    blocks = (PVT, VELOCITY, DOP, ATTITUDE, ATTITUDE_COV)

    def run(self):
        self.speed(115200)
        self.send(ATTENTION)
        for port in ("COM1", "COM2", "USB1", "USB2", "USB3", "USB4"):
            self.told(f"setDataInOut,{port},,-RTCMv3-RTCMv2-CMRv2", needed=False)
        self.step("the name of the port")
        self.send(b"\n\r")
        text = self.text(b">")
        port = text[:4].decode("latin-1")
        self.check(port == "COM1", "COM1>", text[:60])
        for line in (f"setSBFOutput, Stream1, {port}, none, off", f"setCOMSettings, {port}, baud115200",
                     f"setDataInOut, {port}, Auto, SBF", "setAttitudeOffset, 0.000, 0.000", "setReceiverDynamics, high, UAV",
                     f"setSBFOutput, Stream1, {port}, PVTGeodetic+VelCovGeodetic+DOP+AttEuler+AttCovEuler, msec100"):
            self.told(line)
        self.parser.clear()
        self.pump(0.2)
        self.parser.noise.clear()  # the rest of a block that the end of the last second has cut
        self.forget()
        blocks = self.watch(self.blocks, 100)
        self.check_solution(blocks)

    def text(self, end, seconds=1.0):
        """What comes until `end` is in it, as a string of C has it."""
        text, until = b"", time.monotonic() + seconds
        while end not in text.split(b"\0")[0] and time.monotonic() < until:
            text += self.wire.read(0.05)[0]
        return text.split(b"\0")[0]

    def told(self, line, needed=True):
        """The driver reads for a whole second, whatever comes."""
        self.step(line)
        self.send(line.encode() + b"\n")
        heard, until = b"", time.monotonic() + 1
        while time.monotonic() < until:
            heard += self.wire.read(0.05)[0]
        self.check(b"$R: " in heard.split(b"\0")[0] or not needed, "$R: ", heard[:80])


class Px4GpsSbfMoving(Px4GpsSbf):
    """The same while the vehicle is on its way."""

    name = "PX4 gps, SBF, in motion"
    scenario = ('[trajectory]\nkind = "circle"\ncentre = [47.397742, 8.545594, 488]\nradius_m = 10\n'
                'speed_mps = 3\n')


class RosSeptentrio(Septentrio):
    """ROS's septentrio_gnss_driver with a GNSS receiver: what it configures when it publishes all that such one has."""

    name = "ROS septentrio_gnss_driver"
    cartesian, covariances, measurements = 4006, (5905, 5906, 5907, 5908), 4027
    setup = 5902
    each_half = (5914, 4006, 4007, 4043, 4028, 5905, 5906, 5907, 5908, 5938, 5939, 4027, 4013, 4001)
    blocks = ("+ReceiverTime +PVTCartesian +PVTGeodetic +BaseVectorCart +BaseVectorGeod +PosCovCartesian +PosCovGeodetic "
              "+VelCovCartesian +VelCovGeodetic +AttEuler +AttCovEuler +MeasEpoch +ChannelStatus +DOP")
    lines = ("sso, all, none, none, off ", "sno, all, none, none, off ", "grc ", "sgd, Default",
             'sao, Main, 0, 0, 0, "Unknown", Unknown', 'sao, Aux1, 0, 0, 0, "Unknown", Unknown', "sga, none ",
             "sto, 0, 0 ", "sso, Stream1, COM1, +ReceiverStatus +QualityInd +ReceiverSetup, sec1", "snti, GP",
             "sno, Stream2, COM1, +GGA +RMC +GSA +GSV, msec500", f"sso, Stream3, COM1, {blocks}, msec500")

    def run(self):
        self.speed(115200)
        self.step("the connection's name")
        self.send(b"\rSSSSSSSSSS\r\r")
        descriptor = self.need(lambda item: isinstance(item, sbf.Answer), 2000, "a prompt")
        self.check(descriptor.prompt == "COM1", "COM1>", descriptor)
        for line in self.lines:
            answer = self.said(line)
            if line == "grc ":
                self.check("ReceiverCapabilities" in answer.text and "Heading" not in answer.text,
                           "abilities, by which it knows that there is one antenna", answer)
        self.pump(2)
        self.follow()
        for line in ("sdio, COM1, auto, none", "logout "):
            self.said(line)

    def said(self, line):
        self.step(line)
        self.forget()
        self.send(line.encode() + b"\r")
        answer = self.need(lambda item: isinstance(item, sbf.Answer) and item.text, 1000, "$R:")
        self.check(answer.text.startswith(("$R:", "$R!")), "$R: or $R!", answer)
        return answer

    def follow(self):
        self.step("blocks and sentences that were asked for")
        items = self.collect(HEALTHY)
        self.check(not self.parser.noise, "blocks, answers and sentences alone", bytes(self.parser.noise[:60]))
        blocks = [item for item in items if isinstance(item, sbf.Block)]
        wanted = set(self.each_half) | {STATUS, QUALITY, self.setup}
        self.check({b.number for b in blocks} == wanted, sorted(wanted), sorted({b.number for b in blocks}))
        for number in wanted:
            times = [b.tow_ms for b in blocks if b.number == number]
            period = 500 if number in self.each_half else 1000
            self.check(all(b - a == period for a, b in zip(times, times[1:])), f"{number} every {period} ms", times)
        sentences = {item.text[:6] for item in items if isinstance(item, sbf.Sentence)}
        self.check({"$GPGGA", "$GPRMC", "$GPGSA", "$GPGSV"} <= sentences, "sentences of talker GP", sentences)
        self.check_solution(blocks)
        self.check_state(blocks)
        self.check_fields({b.number: b.body for b in blocks})

    def check_fields(self, last):
        x, y, z = struct.unpack_from("<ddd", last[self.cartesian], 8)
        self.check(abs(math.hypot(x, y, z) - 6367e3) < 5e3, "a place on the Earth", (x, y, z))
        for number in self.covariances:
            variances = struct.unpack_from("<fff", last[number], 8)
            self.check(all(0 < v < 100 for v in variances), f"variances in {number}", variances)
        count, first, other = struct.unpack_from("<BBB", last[self.measurements], 6)
        self.check(count >= 6 and (first, other) == (20, 12), "six satellites measured", (count, first, other))
        version = last[self.setup][8 + 60 + 20 + 20 + 40 + 20 + 20:][:20].rstrip(b"\0").decode("ascii")
        self.check(tuple(map(int, version.split("."))) >= (4, 10, 0), "firmware 4.10.0 or later, as it demands", version)
