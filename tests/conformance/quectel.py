"""SparkFun's LG290P library and RTK Everywhere: how they find the receiver, and set it up as a rover and as a base.

Source: sparkfun/SparkFun_LG290P_GNSS_Arduino_Library (src/SparkFun_LG290P_GNSS.cpp) and SparkFun_RTK_Everywhere.
"""
import re

import nmea
import receiver
import ubx
from dialogue import Client

ANSWER_MS = 1500


class SparkFunLg290p(Client):
    """Autobaud with PQTMUNIQID, the firmware's name, all rates read, then rates, SAVEPAR, SRR and the sentences."""

    name = "SparkFun LG290P"
    patience = 90.0
    speeds = (460800, 921600, 230400, 115200, 9600)

    def run(self):
        self.detect()
        self.version()
        self.check(self.ask("PQTMCFGRCVRMODE,R")[2] in "12", "a mode", "another")
        for name in ("GGA", "RMC", "PQTMEPE,2", "PQTMPVT,1", "PQTMPL,1", "GSV"):
            fields = self.ask(f"PQTMCFGMSGRATE,R,{name}")
            self.check(fields[2] == name.split(",")[0] and fields[3].isdigit(), f"the rate of {name}", fields)
        self.rover()
        self.base()

    def detect(self):
        for speed in self.speeds:
            self.speed(speed)
            for _ in range(3):
                self.step(f"PQTMUNIQID at {speed} baud")
                self.forget()
                self.send(nmea.sentence("PQTMUNIQID"), "$PQTMUNIQID")
                if self.wait(lambda item: isinstance(item, ubx.Sentence) and item.fields[:2] == ["PQTMUNIQID", "OK"], ANSWER_MS):
                    return
        self.fail("$PQTMUNIQID,OK at one of the speeds")

    def ask(self, body, milliseconds=ANSWER_MS):
        """A command, and the fields of its answer, which must not be a refusal."""
        self.step(body)
        self.forget()
        self.send(nmea.sentence(body), f"${body}")
        name = body.split(",")[0]
        fields = self.need(lambda item: isinstance(item, ubx.Sentence) and item.fields[0] == name, milliseconds,
                           f"${name}").fields
        self.check(fields[1] != "ERROR", "no refusal", fields)
        return fields

    def ok(self, body):
        self.check(self.ask(body)[1] == "OK", "OK", "something else")

    def version(self):
        found = re.fullmatch(r"LG290P03AANR(\d\d)A(\d\d)S?", self.ask("PQTMVERNO")[1])
        self.check(found and int(found[1]) > 0 and int(found[2]) > 0, "LG290P03AANR and two numbers above 0", found)

    def restart(self):
        """Polled until it answers again."""
        self.ok("PQTMSAVEPAR")
        self.step("PQTMSRR")
        self.send(nmea.sentence("PQTMSRR"), "$PQTMSRR")
        for _ in range(16):
            self.forget()
            self.send(nmea.sentence("PQTMUNIQID"), "$PQTMUNIQID")
            if self.wait(lambda item: isinstance(item, ubx.Sentence) and item.fields[:2] == ["PQTMUNIQID", "OK"], ANSWER_MS):
                return
        self.fail("an answer after the restart")

    def rover(self):
        self.ok("PQTMCFGRCVRMODE,W,1")
        self.ok("PQTMCFGCNST,W,1,1,1,1,1,1")
        self.ok("PQTMCFGFIXRATE,W,500")
        for name, rate in (("GGA", "1"), ("RMC", "1"), ("GST", "1"), ("GSA", "1"), ("GSV", "2"), ("PQTMEPE", "1,2"),
                           ("PQTMPVT", "1,1")):
            self.ok(f"PQTMCFGMSGRATE,W,1,1,{name},{rate}")
        self.ok("PQTMCFGRTCM,W,4,0,-90,07,06,1,0")
        self.restart()
        self.step("a rover at 2 Hz")
        self.need(lambda item: isinstance(item, ubx.Sentence) and item.fields[0] == "GNGGA" and item.fields[6] != "0", 25000,
                  "GGA with a fix")
        items = [item.fields for item in self.collect(5) if isinstance(item, ubx.Sentence)]
        for name in ("GNGGA", "GNRMC", "GNGST", "PQTMEPE", "PQTMPVT"):
            count = sum(fields[0] == name for fields in items)
            self.check(8 <= count <= 12, f"{name} twice a second", count)
        pvt = [fields for fields in items if fields[0] == "PQTMPVT"][-1]
        self.check(len(pvt) == 20 and pvt[6] == "3", "20 fields, a 3D fix", pvt)
        self.check(receiver.metres_apart(float(pvt[9]), float(pvt[10])) < 20, "a position within 20 m", pvt)
        epe = [fields for fields in items if fields[0] == "PQTMEPE"][-1]
        self.check(len(epe) == 7 and all(0 < float(field) < 30 for field in epe[2:]), "five accuracies", epe)

    def base(self):
        self.ok("PQTMCFGRCVRMODE,W,2")
        self.ok("PQTMCFGSVIN,W,1,5,0.0,0.00,0.00,0.00")
        self.ok("PQTMCFGFIXRATE,W,1000")
        self.restart()
        self.ok("PQTMCFGMSGRATE,W,PQTMSVINSTATUS,1,1")
        self.step("a survey, and corrections")
        self.need(lambda item: isinstance(item, ubx.Sentence) and item.fields[0] == "PQTMSVINSTATUS" and item.fields[3] == "2",
                  40000, "a survey that is done")
        numbers = {item.kind for item in self.collect(4) if isinstance(item, ubx.Correction)}
        self.check({1005, 1033, 1074, 1094, 1124} <= numbers, "RTCM 1005, 1033 and MSM4", sorted(numbers))
