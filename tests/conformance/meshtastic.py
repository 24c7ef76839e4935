"""Meshtastic's GPS.cpp: how it hunts for the speed and the kind of its receiver, and sets up what it found.

Commands, their order, pauses and deadlines are those of meshtastic/firmware, src/gps/GPS.cpp (probe(), setup(),
getProbeResponse(), getACK(), getACKCas()). It reads bytes, not messages: a model's text may stand anywhere in a line.
"""
import struct

import nmea
import ubx
from dialogue import Client

SPEEDS, RARE_SPEEDS, TRIES = (9600, 115200, 38400), (4800, 57600), 2
QUIET = ("$PCAS03,0,0,0,0,0,0,0,0,0,0,,,0,0*02", "$PUBX,40,GLL,0,0,0,0,0,0*5C", "$PUBX,40,GSV,0,0,0,0,0,0*59",
         "$PUBX,40,VTG,0,0,0,0,0,0*5E", "$CFGMSG,0,1,0,1*1B", "$CFGMSG,0,2,0,1*18", "$CFGMSG,0,3,0,1*19")
MTK_MODELS = {"Quectel-L76B": "L76B", "1010D": "PA1010D", "1616S": "PA1616S", "MC-1513": "LS20031", "Quectel-L96": "L96",
              "_3337_": "L80-R", "_3339_": "L80"}
UBLOX_MODELS = {b"00040007": "u-blox 6", b"00070000": "u-blox 7", b"00080000": "u-blox 8", b"00190000": "u-blox 9",
                b"000A0000": "u-blox 10"}
# What each board is to be found as.
FOUND = {"casic-at6558": "ATGM336H", "quectel-l76k": "L76K", "unicore-uc6580": "UC6580", "airoha-ag33xx": "AG3335",
         "airoha-ag3335": "AG3335", "mtk3339": "L80", "ublox-6": "u-blox 6", "ublox-m8": "u-blox 8",
         "ublox-m9": "u-blox 9", "ublox-f9p": "u-blox 9", "ublox-m10": "u-blox 10"}
NAVX = bytes((3, 1, 0, 0, 3, 3, 0, 0, 0, 0, 0, 0, 0, 7)) + bytes(30)


def casic_frame(cls, number, payload):
    """A frame of CASIC, its sum computed as GPS.cpp's makeCASPacket() does."""
    total = number << 24 | cls << 16 | len(payload)
    for (word,) in struct.iter_unpack("<I", payload):
        total += word
    return struct.pack("<2sHBB", b"\xba\xce", len(payload), cls, number) + payload + struct.pack("<I", total & 0xFFFFFFFF)


class Raw:
    """Bytes as they came."""

    def __init__(self, data):
        self.data = data

    def __str__(self):
        return repr(self.data[:70])


class RawParser:
    """Hands on what comes."""

    def clear(self):
        """There is nothing to forget."""

    def feed(self, data, _=0.0):
        return [Raw(data)]


class Meshtastic(Client):
    """Finds the receiver, sets it up, and takes RMC and GGA."""

    name = "Meshtastic"
    patience = 80.0
    airoha = ""  # what wakes an Airoha's command processor, where the build is for one

    def __init__(self, wire, board):
        super().__init__(wire, board)
        self.parser = RawParser()

    def run(self):
        model = self.hunt()
        self.check(model == FOUND[self.board.name], f"a {FOUND[self.board.name]}", model)
        if not model.startswith("u-blox"):
            self.set_up(model)
            self.follow(model)

    def hunt(self):
        for speed in SPEEDS * TRIES + RARE_SPEEDS:
            model = self.probe(speed)
            if model:
                return model
            self.pump(2.0)
        self.fail("a known receiver at one of the speeds")
        return None

    # --- reading as the program does ---

    def say(self, line, pause=0.0):
        self.send(line.encode() + b"\r\n", line)
        self.pump(pause)

    def clear(self):
        self.pump(0)
        self.forget()

    def heard(self, milliseconds, found):
        """What `found` makes of all that came so far, asked with every byte within that time."""
        seen = bytearray()

        def look(item):
            for byte in item.data:
                seen.append(byte)
                result = found(seen)
                if result:
                    self.result = result
                    return True
            return False

        self.result = None
        self.wait(look, milliseconds)
        return self.result

    def family(self, command, models, milliseconds):
        """PROBE_FAMILY: a model's text within a line, looked for at each comma and line end."""
        self.step(f"{command} at {self.wire.speed} baud")
        self.clear()
        self.say(command)
        room = min(max(self.wire.speed * 256 // 9600, 128), 2048) - 1
        line = bytearray()

        def found(seen):
            if len(line) < room:
                line.append(seen[-1])
            end = line[-2:] == b"\r\n"
            if seen[-1] == ord(",") or end:
                for text, model in models.items():
                    if text.encode() in line:
                        return model
            if end:
                line.clear()
            return None

        return self.heard(milliseconds, found)

    def simple(self, command, text, model, milliseconds):
        """PROBE_SIMPLE: a text before a carriage return."""
        self.step(f"{command} at {self.wire.speed} baud")
        self.clear()
        self.say(command)
        begun = [0]

        def found(seen):
            if seen[-1] != 13:
                return None
            whole, begun[0] = text.encode() in seen[begun[0]:], len(seen)
            return model if whole else None

        return self.heard(milliseconds, found)

    # --- probe() ---

    def probe(self, speed):
        self.step(f"quiet at {speed} baud")
        self.speed(speed)
        self.pump(0.1)
        for line in QUIET:
            self.say(line, 0.02 if line.startswith("$PCAS03") or "VTG" in line or line is QUIET[-1] else 0)
        model = (self.family("$PDTINFO", {name: name for name in ("UC6580", "UM600", "CM121")}, 500)
                 or self.family("$PCAS06,1*1A", {"$GPTXT,01,01,02,HW=ATGM336H": "ATGM336H",
                                                 "$GPTXT,01,01,02,HW=ATGM332D": "ATGM332D"}, 500))
        if model:
            return model
        self.wake_airoha()
        for line in ("$PAIR062,2,0*3C", "$PAIR062,3,0*3D", "$PAIR513*3D"):
            self.say(line)
        model = (self.family("$PAIR021*39", {"$PAIR021,AG3335": "AG3335", "$PAIR021,AG3352": "AG3352"}, 1000)
                 or self.simple("$PQTMVERNO*58", "$PQTMVERNO,LC86", "LC86", 500)
                 or self.simple("$PCAS06,0*1B", "$GPTXT,01,01,02,SW=", "L76K", 500))
        if model:
            return model
        self.say("$PMTK514,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0*2E", 0.02)
        return self.family("$PMTK605*31", MTK_MODELS, 500) or self.probe_ublox()

    def wake_airoha(self):
        """Builds for an Airoha say this; that of Seeed's T1000-E for a second."""
        if self.airoha:
            for _ in range(25):
                self.say(self.airoha, 0.04)

    def probe_ublox(self):
        self.step(f"CFG-RATE at {self.wire.speed} baud")
        self.clear()
        self.send(ubx.frame("CFG-RATE"))
        verdicts = (b"\xb5\x62\x05\x01\x02\x00\x06\x08", b"\xb5\x62\x05\x00\x02\x00\x06\x08")
        if not self.heard(750, lambda seen: bytes(seen[-8:]) in verdicts):
            return None
        self.step(f"MON-VER at {self.wire.speed} baud")
        self.clear()
        self.send(ubx.frame("MON-VER"))
        head = b"\xb5\x62\x0a\x04"

        def version(seen):
            at = seen.find(head)
            if at < 0 or len(seen) < at + 6:
                return None
            size = seen[at + 4] | seen[at + 5] << 8
            return bytes(seen[at + 6:at + 6 + size]) if len(seen) >= at + 8 + size else None

        payload = self.heard(1200, version)
        return UBLOX_MODELS.get(payload[30:38]) if payload else None

    # --- setup() ---

    def acknowledged(self, item):
        """There are no items of u-blox's here."""

    def casic(self, cls, number, payload):
        self.step(f"CASIC {cls:02X}-{number:02X}")
        self.clear()
        self.send(casic_frame(cls, number, payload), self.step_name)
        wanted = casic_frame(5, 1, bytes((cls, number, 0, 0)))
        self.check(self.heard(250, lambda seen: wanted[:13] in seen), "ACK-ACK within 250 ms of the request", "nothing")

    def set_up(self, model):
        self.step(f"settings of a {model}")
        if model == "L76K":
            for line in ("$PCAS04,7*1E", "$PCAS03,1,0,0,0,1,0,0,0,0,0,,,0,0*02", "$PCAS11,3*1E"):
                self.say(line, 0.25)
        elif model.startswith("ATGM"):
            self.casic(6, 7, NAVX)
            self.casic(6, 4, struct.pack("<HH", 1000, 0))
            for sentence in (4, 0):
                self.casic(6, 1, struct.pack("<BBH", 0x4E, sentence, 1))
        elif model == "UC6580":
            self.say("$CFGSYS,h35155", 0.75)
            for line in ("$CFGMSG,0,3,0", "$CFGMSG,0,2,0", "$CFGMSG,6,0,0", "$CFGMSG,6,1,0"):
                self.say(line, 0.25)
        elif model == "AG3335":
            for line in ("$PAIR066,1,1,1,1,0,0*3A", "$PAIR062,0,1*3F", "$PAIR062,1,0*3F", "$PAIR062,2,0*3C",
                         "$PAIR062,3,0*3D", "$PAIR062,4,1*3B", "$PAIR062,5,0*3B", "$PAIR062,6,0*38"):
                self.say(line)
            self.pump(0.25)
            self.say("$PAIR513*3D")
        else:
            for line, pause in (("$PMTK353,1,1,0,0,0*2B", 1.0), ("$PMTK314,0,1,0,1,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0*28", 0.25),
                                ("$PMTK301,2*2E", 0.25), ("$PMTK285,3,100*3F", 0.25), ("$PMTK886,1*29", 0.25)):
                self.say(line, pause)

    def follow(self, model):
        """RMC and GGA with a fix, and of those that were told so no lists of satellites."""
        self.step("RMC and GGA")
        self.pump(3.0)
        data = b"".join(item.data for item in self.collect(5.0))
        lines = [nmea.fields(line.decode("latin-1")) for line in data.split(b"\r\n")]
        names = [fields[0][2:] for fields in lines if fields and fields[0][0] == "G"]
        self.check(names.count("RMC") >= 4 and names.count("GGA") >= 4, "RMC and GGA each second", names)
        self.check("GSV" not in names, "no lists of satellites", names)
        if model in ("L76K", "ATGM336H"):
            self.check(set(names) <= {"RMC", "GGA", "TXT"}, "RMC and GGA alone", sorted(set(names)))
        for fields in lines:
            if fields and fields[0].endswith("RMC"):
                self.check(fields[2] == "A", "a fix", ",".join(fields))


class MeshtasticAiroha(Meshtastic):
    """The build for Seeed's T1000-E, whose AG3335 sleeps after its start until PAIR382,1 is acknowledged."""

    name = "Meshtastic for the T1000-E"
    airoha = "$PAIR382,1*2E"
    after_power_on = 0.0
    scenario = "[[receiver]]\npower_up = true\n"
