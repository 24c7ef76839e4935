"""PX4: GPSDriverUBX as `gps start` runs it with automatic speed, and its NMEA reader.

Specification 6.1 and 11. Deadlines: 2 s for the first VALSET, 250 ms for every later acknowledgement, 500 ms for a
solution, 8 ms of silence end a burst.
"""
import nmea
import receiver
import solutions
import ubx
from dialogue import Client

SPEEDS = (38400, 57600, 9600, 115200, 230400, 460800, 921600)
ACK = 250
FIRST_ACK = 2000
HEALTHY = 10.0
UART1_FIRST = [(0x20520002, 1), (0x20520003, 0), (0x20520004, 0), (0x10730001, 1), (0x10730002, 0), (0x10740001, 1),
               (0x10740002, 0)]
MODE_8N1 = 0x8D0


class Px4(Client):
    name = "PX4"
    after_power_on = 0.0
    passes = 3
    speeds = SPEEDS
    by_keys = False

    def run(self):
        for number in range(self.passes):
            self.step(f"pass {number + 1}: hunt for the speed")
            if self.find_speed() and self.identify() and self.configure():
                self.fly()
                return
        self.fail(f"a configured receiver after {self.passes} passes over all speeds")

    def find_speed(self):
        """One round over the speeds; True once the receiver acknowledged and both ends have the new speed."""
        for speed in self.speeds:
            self.speed(speed)
            self.pump(0.02)
            self.forget()
            self.send(ubx.valset(UART1_FIRST))
            answer = self.wait_ack("CFG-VALSET", FIRST_ACK)
            self.check(answer is None or answer == self.board.has_keys,
                       f"{'ACK-ACK' if self.board.has_keys else 'ACK-NAK'} of the first CFG-VALSET", "the other one")
            self.by_keys = bool(answer)
            if answer:
                self.set_speed_by_key()
                return True
            self.send(self.ports(speed))
            if self.wait_ack("CFG-PRT", ACK):
                self.send(self.ports(38400))
                self.wait_ack("CFG-PRT", ACK)
                self.speed(38400)
                self.pump(0.02)
                return True
        return False

    def set_speed_by_key(self):
        self.step("CFG-VALSET of the new speed; no acknowledgement is needed")
        self.send(ubx.valset([(0x40520001, 115200)]))
        self.wait_ack("CFG-VALSET", ACK)
        self.speed(115200)
        self.pump(0.02)

    @staticmethod
    def ports(speed):
        """One CFG-PRT of 40 bytes: UART1 and USB, in UBX and RTCM3, out UBX."""
        return ubx.cfg_prt((1, MODE_8N1, speed, 0x21, 0x01), (3, MODE_8N1, speed, 0x21, 0x01))

    def identify(self):
        self.step("MON-VER")
        version = self.version(ACK)
        if version is None:
            self.note("no MON-VER: this pass has failed")
            return False
        hardware = {8: "00080000", 9: "00190000", 10: "000A0000", 20: "000B0000"}[self.board.generation]
        self.check(version.hardware == hardware, f"hardware {hardware}", version.hardware)
        self.check(bool(version.value_of("FWVER")), "an extension FWVER=", version.extensions)
        self.check(version.protocol == self.board.protocol, f"PROTVER={self.board.protocol}", version.protocol)
        if self.board.is_f9p:
            self.check(version.value_of("MOD") == "ZED-F9P", "MOD=ZED-F9P", version.extensions)
        return True

    def configure(self):
        """True when all was acknowledged; False when this pass took the wrong path, and the next one must succeed."""
        self.strict_acks = True
        self.asked.clear()
        if self.by_keys:
            self.configure_by_keys()
        elif self.board.has_keys:
            # The first CFG-VALSET was lost while the receiver started. The old path ends at a message it has not.
            self.step("the old path with a receiver of the new one: CFG-MSG NAV-SVINFO")
            self.send(ubx.cfg_msg("NAV-SVINFO", 5))
            self.check(self.wait_ack("CFG-MSG", ACK) is False, "ACK-NAK of CFG-MSG for NAV-SVINFO", None)
            self.strict_acks = False
            return False
        else:
            self.configure_by_messages()
        return True

    def configure_by_messages(self):
        self.step("CFG-PRT to 115200; no acknowledgement is needed")
        self.send(self.ports(115200))
        self.wait_ack("CFG-PRT", ACK)
        self.speed(115200)
        self.asked.clear()
        self.strict_acks = False  # the acknowledgement of the change may still come, at either speed
        self.step("CFG-RATE")
        self.set(ubx.cfg_rate(200, 1, 0), "CFG-RATE", ACK)
        self.strict_acks = True
        self.step("CFG-NAV5")
        self.set(ubx.cfg_nav5(0x0005, 7, 2), "CFG-NAV5", ACK)
        for message, rate in (("NAV-PVT", 1), ("NAV-STATUS", 1), ("NAV-DOP", 1), ("NAV-SVINFO", 5), ("MON-HW", 1)):
            self.step(f"CFG-MSG {message}")
            self.set(ubx.cfg_msg(message, rate), "CFG-MSG", ACK)

    def configure_by_keys(self):
        m10, f9p = self.board.generation == 10, self.board.is_f9p
        x20 = self.board.generation == 20
        # PX4 sends items of USB to an X20P, too, whose interface description has none (UBXDOC-304424225-19888): what the
        # module says to them is not known, and they are left out.
        usb = not m10 and not x20
        if x20:
            self.keys("protocols of UART1", [(0x10730004, 1)])
        if usb:
            self.keys("protocols of UART1 and USB", [(0x10730004, 1), (0x10770001, 1), (0x10770004, 1), (0x10770002, 0),
                                                     (0x10780001, 1), (0x10780002, 0)])
        self.keys("navigation and rate", [
            (0x20110011, 3), (0x2011001C, 3), (0x20110021, 7), (0x10220001, 0), (0x10220002, 0), (0x10220003, 0),
            (0x10220004, 0), (0x30210001, self.period), (0x30210002, 1), (0x20210003, 0)])
        self.keys("RTK mode", [(0x20140011, 3)], nak_is_good=not f9p)
        self.keys("jamming monitor", [(0x1041000D, 1)], nak_is_good=True)
        self.keys("jamming sensitivity", [(0x10F60051, 1)], nak_is_good=True)
        rates = [(0x20910006, 1), (0x20910038, 1), (0x20910015, 10), (0x2091001A, 1), (0x20910359, 1)]
        if f9p or x20:
            rates += [(0x20910033, 1), (0x2091008D, 1)]
        if usb:
            rates += [(0x20910268, 1)]
        ports = (1, 3) if usb else (1,)
        self.keys("rates of messages", [(key + port, rate) for key, rate in rates for port in ports])
        protocols = [(0x10710001, 1), (0x10710002, 0), (0x10720001, 1), (0x10720002, 0)]
        if not m10:
            protocols += [(0x10710004, 1)]
        if f9p:
            protocols += [(0x10720004, 0)]
        self.keys("protocols of I2C", protocols)

    def keys(self, what, pairs, nak_is_good=False):
        self.step(f"CFG-VALSET: {what}")
        self.set(ubx.valset(pairs), "CFG-VALSET", ACK, nak_is_good)

    @property
    def period(self):
        if not self.board.has_keys or self.board.is_f9p:
            return 200
        return 100 if self.board.generation >= 10 else 125

    def fly(self):
        """Ten seconds of solutions, none more than 500 ms after the last."""
        self.step("solutions")
        self.pump(1.0)
        items = self.collect(HEALTHY)
        wanted = ["NAV-STATUS", "NAV-DOP"]
        if self.board.has_keys:
            allowed = wanted + ["NAV-PVT", "NAV-SAT", "MON-RF", "RXM-RTCM", "NAV-HPPOSLLH", "NAV-RELPOSNED"]
        else:
            allowed = wanted + ["NAV-PVT", "NAV-SVINFO", "MON-HW"]
        solutions.check_kinds(self, items, allowed)
        frames, _ = solutions.check_solutions(self, items, self.period, 500, HEALTHY)
        self.check(all(len(frame.payload) == 92 for frame in frames), "NAV-PVT of 92 bytes", len(frames[0].payload))
        solutions.check_each_epoch(self, items, wanted)
        solutions.check_bursts(self, items, 8, 0.1)


class Px4At9600(Px4):
    """A receiver at 9600 baud that sends the factory's sentences about four systems: found in the first pass."""

    name = "PX4 at 9600 baud"
    after_power_on = 8.0  # the line has become as busy as it gets
    passes = 1
    speeds = SPEEDS[2:] + SPEEDS[:2]
    scenario = '[sky]\nconstellations = ["gps", "glonass", "galileo", "beidou"]\n[[receiver]]\nbaud = 9600\n'
    orbits = "BRDC00IGS_R_20240010000_01D_MN.rnx.gz"


class Px4Systems(Px4):
    """With GPS_1_GNSS: all systems in one message, with QZSS L1S wherever GPS is on, SBAS in another one
    (GPSDriverUBX::configureDevice); CFG-GNSS of seven blocks for receivers without keys (configureDevicePreV27)."""

    name = "PX4 with GPS_1_GNSS"
    gps, sbas, galileo, beidou, glonass, navic = 1, 2, 4, 8, 16, 32
    l1s = 0x10310014  # CFG-SIGNAL-QZSS_L1S_ENA
    masks = (gps, gps | galileo, gps | sbas | galileo, 31, galileo | beidou)
    health = 0x10320001  # CFG-SIGNAL-HEALTH_L5: that L5 of GPS is as healthy as its L1
    qzss = 64  # no bit of the parameter: the second bands that go on, and never off, with GPS
    # CFG-SIGNAL of further bands, by receivers: GPS with the health of L5, QZSS, Galileo, BeiDou, GLONASS, NavIC.
    l1_l2 = {gps: (0x10310003,), qzss: (0x10310015,), galileo: (0x1031000A,), beidou: (0x1031000E,),
             glonass: (0x1031001A,)}
    l1_l5 = {gps: (0x10310004, health), qzss: (0x10310017,), galileo: (0x10310009,), beidou: (0x10310028,),
             navic: (0x10310026, 0x1031001D)}
    all_bands = {gps: (0x10310003, 0x10310004, health), qzss: (0x10310015, 0x10310017), galileo: (0x10310009, 0x1031000B),
                 beidou: (0x1031000F, 0x10310028, 0x10310010), navic: (0x10310026, 0x1031001D)}
    bands = {"ublox-f9p-15b": l1_l5, "ublox-f10": l1_l5, "ublox-x20p": all_bands}
    # gnssId, channels and signal of CFG-GNSS; QZSS goes with GPS, IMES is always off.
    blocks = ((0, gps, 8, 16), (5, gps, 0, 3), (1, sbas, 1, 3), (2, galileo, 4, 8), (3, beidou, 8, 16), (6, glonass, 8, 14),
              (4, 0, 0, 0))

    def configure_by_keys(self):
        super().configure_by_keys()
        for mask in self.masks:
            self.step(f"CFG-VALSET of the systems, mask {mask}")
            self.send(ubx.valset(self.systems(mask)))
            wanted = self.is_possible(mask)
            self.check(self.wait_ack("CFG-VALSET", ACK) is wanted, "ACK-ACK" if wanted else "ACK-NAK", "the other one")
            self.pump(0.6)
            on = int(bool(mask & self.sbas))
            self.keys("SBAS", [(0x10310020, on)] + ([(0x10310005, 1)] if on else []))
            self.pump(0.6)
        common = [(key, value) for key, value in self.systems(self.gps | self.galileo) if key not in (self.l1s, self.health)]
        self.set(ubx.valset(common), "CFG-VALSET", ACK)
        self.pump(3)

    def configure_by_messages(self):
        super().configure_by_messages()
        for mask in (self.gps, self.gps | self.sbas | self.galileo, 31):
            self.step(f"CFG-GNSS, mask {mask}")
            payload = bytes((0, 0, 0xFF, len(self.blocks)))
            for number, system, least, most in self.blocks:
                on = bool(mask & system)
                payload += bytes((number, least, most, 0, 1, 0, 1, 0) if on else (number, 0, 0, 0, 0, 0, 0, 0))
            self.send(ubx.frame("CFG-GNSS", payload))
            wanted = mask != 31  # GLONASS and BeiDou are one front end of the M8 (data sheet, concurrent GNSS)
            self.check(self.wait_ack("CFG-GNSS", ACK) is wanted, "ACK-ACK" if wanted else "ACK-NAK", "the other one")
            self.pump(0.6)
        self.pump(3)

    def is_possible(self, mask):
        """A NEO-M9N has no L1S: it refuses the whole message, and PX4 gives up (PX4-GPSDrivers, pull request 225). An M10
        has BeiDou's B1I on, which excludes GLONASS (MAX-M10S integration manual UBX-20053088, 2.1.1.3). A DAN-F10N takes
        the health of L5 by version 1 of CFG-VALSET alone, and PX4 sends version 0 (pull request 181)."""
        if self.board.name == "ublox-f10":
            return False
        if self.board.generation == 10:
            return not (mask & self.beidou and mask & self.glonass)
        return not (self.board.name.startswith("ublox-m9") and mask & self.gps)

    def systems(self, mask):
        bands = self.bands.get(self.board.name, self.l1_l2 if self.board.is_f9p else {})
        gps = int(bool(mask & self.gps))
        pairs = [(0x1031001F, gps), (0x10310024, gps)]
        if gps:
            pairs += [(key, 1) for key in (0x10310012, self.l1s, *bands.get(self.qzss, ()))]
        enables = {self.galileo: 0x10310021, self.beidou: 0x10310022}
        if self.board.name not in ("ublox-f10", "ublox-x20p"):
            enables[self.glonass] = 0x10310025
            pairs += [(0x10310018, 1)] if mask & self.glonass else []
        pairs += [(enable, int(bool(mask & system))) for system, enable in enables.items()]
        return pairs + [(item, int(bool(mask & system))) for system, items in bands.items() if system != self.qzss
                        for item in items]


class Px4Ublox6(Px4):
    """PX4 with a u-blox 6, which knows no NAV-PVT: four older messages instead, at 38400 baud."""

    name = "PX4"
    older = (("NAV-TIMEUTC", 5), ("NAV-POSLLH", 1), ("NAV-SOL", 1), ("NAV-VELNED", 1))

    def identify(self):
        self.step("MON-VER")
        version = self.version(ACK)
        self.check(version is None or version.hardware == "00040007", "hardware 00040007", version)
        return version is not None

    def configure(self):
        self.strict_acks = True
        self.asked.clear()
        self.step("CFG-RATE")
        self.set(ubx.cfg_rate(200, 1, 0), "CFG-RATE", ACK)
        self.step("CFG-NAV5")
        self.set(ubx.cfg_nav5(0x0005, 7, 2), "CFG-NAV5", ACK)
        self.step("CFG-MSG NAV-PVT")
        self.send(ubx.cfg_msg("NAV-PVT", 1))
        self.check(self.wait_ack("CFG-MSG", ACK) is False, "ACK-NAK of CFG-MSG for NAV-PVT", None)
        for message, rate in self.older + (("NAV-STATUS", 1), ("NAV-DOP", 1), ("NAV-SVINFO", 5), ("MON-HW", 1)):
            self.step(f"CFG-MSG {message}")
            self.set(ubx.cfg_msg(message, rate), "CFG-MSG", ACK)
        return True

    def fly(self):
        """NAV-POSLLH and NAV-VELNED of one time within 500 ms of the last pair, and a fix in NAV-SOL."""
        self.step("solutions")
        self.pump(1.0)
        items = self.collect(HEALTHY)
        solutions.check_kinds(self, items, [message for message, _ in self.older] + [
            "NAV-STATUS", "NAV-DOP", "NAV-SVINFO", "MON-HW"])
        positions = {i.payload[:4]: i.time for i in solutions.of(items, "NAV-POSLLH")}
        velocities = {i.payload[:4]: i.time for i in solutions.of(items, "NAV-VELNED")}
        times = [max(at, velocities[tow]) for tow, at in positions.items() if tow in velocities]
        self.check(len(times) >= 45, "at least 45 pairs of NAV-POSLLH and NAV-VELNED in 10 s", solutions.kinds(items))
        longest = max(b - a for a, b in zip(times, times[1:])) * 1000
        self.check(longest <= 500, "a pair at least every 500 ms", f"a gap of {longest:.0f} ms")
        last = solutions.of(items, "NAV-SOL")[-1].payload
        self.check(len(last) == 52 and last[10] == 3 and last[11] & 1, "NAV-SOL of 52 bytes with a valid 3D fix",
                   last.hex(" "))


class Px4Nmea(Client):
    """PX4's reader of NMEA: GGA and RMC of every epoch, upper-case sums, times that only rise."""

    name = "PX4 NMEA"
    commas = {"GST": 8, "ZDA": 6, "HDT": 2}

    def run(self):
        self.step("sentences at the receiver's speed")
        self.speed(self.board.speed)
        self.pump(1.5)
        items = self.collect(HEALTHY)
        sentences = [i for i in items if isinstance(i, ubx.Sentence)]
        self.check(len(sentences) == len(items), "sentences only", solutions.kinds(items))
        self.check(not self.parser.noise, "no byte outside of a sentence", bytes(self.parser.noise[-40:]))
        for sentence in sentences:
            wanted = self.commas.get(sentence.fields[0][2:])
            if wanted is not None:
                self.check(len(sentence.fields) - 1 == wanted, f"{wanted} commas", sentence)
        for kind in ("GGA", "RMC"):
            self.check_times([s for s in sentences if s.fields[0][2:] == kind], kind)
        last = [s for s in sentences if s.fields[0][2:] == "GGA"][-1].fields
        self.check(last[6] in "12345", "a fix in GGA", last[6])
        apart = receiver.metres_apart(nmea.degrees(last[2], last[3]), nmea.degrees(last[4], last[5]))
        self.check(apart < 20, "a position within 20 m of the scenario's", f"one {apart:.1f} m away")

    def check_times(self, sentences, kind):
        self.check(len(sentences) >= HEALTHY - 2, f"{kind} every second for {HEALTHY:g} s", len(sentences))
        times = [nmea.time_of_day(s.fields[1]) for s in sentences]
        self.check(all(a < b for a, b in zip(times, times[1:])), f"times of {kind} that rise", times)
        if kind == "RMC":
            date = sentences[-1].fields[9]
            self.check(date == "010326" and sentences[-1].fields[2] == "A", "RMC valid on 010326", sentences[-1])
