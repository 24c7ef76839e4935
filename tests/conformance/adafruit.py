"""Adafruit's GPS library for Arduino (Adafruit_GPS 1.7) on an MT3339: its sketches' settings, standby and waking.

The library finds its answers among the sentences that come, and gives up after ten of them. Its parser takes the
minutes' first four decimals and needs a point in the time.
"""
import re

import nmea
import ubx
from dialogue import Client

SENTENCES_LOOKED_AT = 10
WAIT = 2000


class Adafruit(Client):
    name = "Adafruit_GPS"

    def run(self):
        self.speed(9600)
        self.configure()
        self.check_sentences(5)
        self.stand_by()
        self.wake()
        self.check_sentences(1)

    def configure(self):
        # Sketches wait for no answer. The antenna's command is GlobalTop's own; its sentence, PGTOP, is not missed.
        self.step("settings of the sketches")
        for body in ("PMTK314,0,1,0,1,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0", "PMTK220,1000", "PGCMD,33,1"):
            self.send(nmea.sentence(body), f"${body}")
        self.pump(1.0)
        self.step("PMTK605")
        self.forget()
        self.send(nmea.sentence("PMTK605"))
        self.need(lambda i: isinstance(i, ubx.Sentence) and i.fields[0] == "PMTK705", WAIT, "$PMTK705")
        self.send(nmea.sentence("PMTK220,200"))
        self.pump(1.0)

    def check_sentences(self, seconds):
        """RMC and GGA alone, five times a second, as the parser wants them."""
        self.step("RMC and GGA")
        items = [i for i in self.collect(seconds + 1.0) if isinstance(i, ubx.Sentence) and i.fields[0][0] == "G"]
        kinds = [i.fields[0][2:] for i in items]
        self.check(set(kinds) == {"RMC", "GGA"}, "RMC and GGA alone", sorted(set(kinds)))
        self.check(kinds.count("RMC") >= 4 * seconds, f"at least {4 * seconds} RMC", kinds.count("RMC"))
        last = next(i for i in reversed(items) if i.fields[0].endswith("RMC"))
        self.check(re.fullmatch(r"\d{6}\.\d+", last.fields[1]), "a time with a point", last)
        self.check(last.fields[2] == "A", "a fix", last)
        self.check(re.fullmatch(r"\d{4}\.\d{4,}", last.fields[3]) and re.fullmatch(r"\d{5}\.\d{4,}", last.fields[5]),
                   "minutes with four decimals", last)

    def stand_by(self):
        self.step("standby")
        self.forget()
        self.send(nmea.sentence("PMTK161,0"))
        self.need(lambda i: isinstance(i, ubx.Sentence) and i.fields == ["PMTK001", "161", "3"], WAIT,
                  "$PMTK001,161,3")
        self.pump(1.0)
        self.forget()
        self.check(not self.collect(5.0), "silence in standby", "sentences")

    def wake(self):
        self.step("wake up")
        self.forget()
        self.send(b"\r\n", "an empty line")
        seen = []
        while len(seen) < SENTENCES_LOOKED_AT:
            seen.append(self.need(lambda i: isinstance(i, ubx.Sentence), 5000, "a sentence").fields)
            if seen[-1] == ["PMTK010", "002"]:
                break
        self.check(seen[-1] == ["PMTK010", "002"], "$PMTK010,002 among the first ten sentences", seen)
        self.need(lambda i: isinstance(i, ubx.Sentence) and i.fields[0].endswith("RMC") and i.fields[2] == "A", 10000,
                  "a fix after a hot start")
