"""The strings that gpsd sends to a receiver it does not know yet, without gpsd.

Specification 6.5, 1.4, 5.8 and 11: an M8 answers proprietary sentences by `inv format`, every u-blox the UBX polls; a
receiver of NMEA alone is mute to UBX, and nothing breaks the sentences that it sends.
"""
import nmea
import solutions
import ubx
from dialogue import Client

PROPRIETARY = ("PGRMCE", "PSRF100,0,38400,8,1,0", "PFEC,GPint", "PTNLSNM,0139,01", "PFEC,GPsrq", "PASHQ,RID")
OTHERS = (bytes.fromhex("10 1f 10 03"),  # TSIP, a request for the software version
          b"%dm%dm@51\r\n", b"@@Cj)\r\n",
          bytes.fromhex("10 02 04 8d 80 00 10 03"),  # Evermore
          bytes.fromhex("a0 a2 00 02 84 00 00 84 b0 b3"),  # SiRF, a request for the software version
          bytes.fromhex("ba ce 00 00 0a 04 0a 04 00 00"),  # CASIC
          bytes.fromhex("f1 d9 0a 04 00 00 0e 34"))  # Allystar
WAIT = 2000


class GpsdProbes(Client):
    name = "gpsd's probes"

    def run(self):
        self.step("sentences at the receiver's speed")
        self.speed(self.board.speed)
        self.need(lambda i: isinstance(i, ubx.Sentence), 2500, "a sentence")
        for body in PROPRIETARY:
            self.probe(body)
        for data in OTHERS:
            self.step(f"probe {data.hex(' ')}")
            self.send(data, repr(data))
            self.pump(0.3)
        self.mediatek()
        self.binary()
        self.check_sentences()

    def probe(self, body):
        self.step(f"probe ${body}")
        self.forget()
        self.send(nmea.sentence(body), f"${body}")
        if self.board.generation == 8:
            wanted = f"{body[:4]} inv format"
            self.need(lambda i: isinstance(i, ubx.Sentence) and i.fields[0][2:] == "TXT" and wanted in i.fields[-1],
                      WAIT, f"$GNTXT …{wanted}")
        else:
            self.pump(0.3)

    def mediatek(self):
        self.step("probe $PMTK605")
        self.forget()
        self.send(nmea.sentence("PMTK605"))
        is_answer = lambda i: isinstance(i, ubx.Sentence) and i.fields[0] == "PMTK705"  # noqa: E731
        if self.board.name == "mtk3339":
            self.need(is_answer, WAIT, "$PMTK705")
        else:
            self.check(self.wait(is_answer, 1000) is None, "no $PMTK705", "one")

    def binary(self):
        self.step("MON-VER and CFG-PRT polls")
        self.forget()
        self.send(ubx.frame("MON-VER") + ubx.frame("CFG-PRT"))
        if self.board.generation:
            self.need_frame("MON-VER", WAIT)
            self.need_frame("CFG-PRT", WAIT)
            self.need_ack("CFG-PRT", WAIT)
        else:
            answer = self.wait(lambda i: not isinstance(i, ubx.Sentence), WAIT)
            self.check(answer is None, "not a byte of UBX from a receiver that speaks NMEA alone", answer)

    def check_sentences(self):
        """Still the sentences of the factory, whole, and not one byte between them."""
        self.step("sentences after all probes")
        self.pump(1.0)
        self.parser.noise.clear()
        items = self.collect(3.5)
        kinds = {i.fields[0][2:] for i in items if isinstance(i, ubx.Sentence)}
        self.check({"GGA", "RMC"} <= kinds, "GGA and RMC", solutions.kinds(items))
        self.check(all(isinstance(i, ubx.Sentence) for i in items) and not self.parser.noise, "sentences only",
                   solutions.kinds(items) + " and " + bytes(self.parser.noise[:40]).hex(" "))
