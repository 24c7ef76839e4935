"""Every board that sends sentences, in every version of NMEA, with every sentence on: read without an error by pynmea2 (Debian's
python3-nmea2), gpsd (gpsdecode, of gpsd-clients), and npm's gps, nmea-simple and @signalk/nmea0183-signalk. The boards are those
that `skyloop boards` lists. A reader that is not installed is skipped by name.

All boards sail the same orbit in one simulation for each version, through a start, fixes and an outage, at a speed of the line that
loses nothing; headings are those of the boat.
"""
import collections
import json
import math
import os
import pathlib
import shutil
import subprocess
import unittest

from session import npm_packages, open_folder, skyloop

try:
    import pynmea2
except ImportError:
    pynmea2 = None

VERSIONS = ("2.1", "2.3", "3.0", "4.0", "4.10", "4.11")
WITHOUT_SENTENCES = ("msp", "msp-v1", "mavlink", "dronecan")
SENTENCES = ("RMC", "VTG", "GGA", "GNS", "GSA", "GSV", "GLL", "GST", "ZDA", "GBS", "DTM", "GRS", "VLW", "THS", "HDT", "HDG", "ROT")
PUBX = ("PUBX-00", "PUBX-03", "PUBX-04")
CENTRE = (54.5, 10.3)
SCENARIO = f"""
[run]
start = 2026-03-01T09:30:00Z
duration_s = 12
seed = 4
[trajectory]
kind = "orbit"
vehicle = "boat"
centre = [{CENTRE[0]}, {CENTRE[1]}, 45]
radius_m = 60
speed_mps = 4
[model]
name = "ideal"
[[fault]]
kind = "outage"
at_s = 7
for_s = 2
"""
# What a reader refuses though it is as the version has it, by reader, sentence and versions: it must go on refusing, or the row
# goes.
BEFORE_4_10 = ("2.1", "2.3", "3.0", "4.0")
REFUSED = {
    # Its parser wants the system and the signal, which came with 4.10.
    ("gps", "GRS"): BEFORE_4_10,
}


def personality(board):
    for line in skyloop("boards", board).stdout.splitlines():
        if line.split()[:1] == ["personality"]:
            return line.split()[1]
    raise AssertionError(f"skyloop boards {board} tells no personality")


def boards_with_sentences():
    names = [line.split()[0] for line in skyloop("boards").stdout.splitlines() if line and not line[0].isspace()]
    kinds = {name: personality(name) for name in names}
    return {name: kind for name, kind in kinds.items() if kind not in WITHOUT_SENTENCES}


def write_board(folder, name, kind, version):
    """The board with every sentence on, in that version, by a line that carries them all."""
    messages = list(SENTENCES) + (list(PUBX) if kind == "ublox" else [])
    text = f'extends = "{name}"\n[uart]\nbaud = 921600\nbauds = [9600, 38400, 115200, 921600]\ntransmit_buffer_bytes = 1000000\n'
    text += "generated_ahead_bytes = 1000000\n[timing]\nboot_s = 0\nfirst_epoch_s = 0\n"
    text += f'[ubx]\nmessages = {json.dumps(messages)}\n[nmea]\nversion = "{version}"\nheading = "attitude"\n'
    text += "magnetic_variation_deg = -3.5\n[nmea.sentences]\n" + "".join(f"{sentence} = 1\n" for sentence in SENTENCES)
    if kind == "ublox":
        text += "[config]\n" + "".join(f"CFG-MSGOUT-PUBX_ID_POLY{which}_UART1 = 1\n" for which in "PST")
    path = pathlib.Path(folder, f"{name}.toml")
    path.write_text(text, encoding="ascii")
    return path


def simulate(version, kinds):
    """The lines that each board sent."""
    with open_folder() as folder:
        names = [name for name, kind in kinds.items() if not (kind == "ublox" and version == "3.0")]
        text = SCENARIO
        for name in names:
            board = write_board(folder, name, kinds[name], version)
            text += f'[[receiver]]\nname = "{name}"\nboard = "{board}"\n'
        scenario = pathlib.Path(folder, "all.toml")
        scenario.write_text(text, encoding="ascii")
        skyloop("simulate", scenario, "--out", pathlib.Path(folder, "out"))
        lines = {}
        for i, name in enumerate(names):
            one = pathlib.Path(folder, "out", f"receiver{i}" if i else "", "port0.out").read_bytes()
            lines[name] = [line for line in one.decode("ascii", "replace").split("\r\n") if line]
        return lines


def formatter(line):
    return line[1:].split(",")[0][2:] if line[1] != "P" else line[1:].split(",")[0]


def bearing_of(sentence):
    """Of the boat's bow, which sails clockwise around the centre: a right angle from that of where it is."""
    north = sentence.latitude - CENTRE[0]
    east = (sentence.longitude - CENTRE[1]) * math.cos(math.radians(CENTRE[0]))
    return (math.degrees(math.atan2(east, north)) + 90) % 360


class NmeaReaders(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.kinds = boards_with_sentences()
        cls.sent = {version: simulate(version, cls.kinds) for version in VERSIONS}

    def each(self):
        for version, boards in self.sent.items():
            for board, lines in boards.items():
                yield version, board, lines

    def test_every_board_sends_them(self):
        self.assertGreaterEqual(len(self.kinds), 20)
        for version, board, lines in self.each():
            heard = {formatter(line) for line in lines}
            self.assertLessEqual({"GGA", "RMC", "HDT", "ROT"}, heard, f"{board} {version}")
            if self.kinds[board] == "mute":
                self.assertLessEqual(set(SENTENCES), heard, f"{board} {version}")
            self.assertTrue(all(line.startswith("$") and line.isascii() for line in lines), f"{board} {version}")

    @unittest.skipIf(pynmea2 is None, "pynmea2 is not installed; apt-get install python3-nmea2")
    def test_pynmea2(self):
        unknown = collections.Counter()
        for version, board, lines in self.each():
            for line in lines:
                try:
                    sentence = pynmea2.parse(line, check=True)
                except pynmea2.SentenceTypeError:
                    unknown[formatter(line)] += 1
                    continue
                except pynmea2.ParseError as error:
                    self.fail(f"{board} {version} {line}: {error}")
                for name in (field[1] for field in getattr(sentence, "fields", ())):
                    getattr(sentence, name)
                if getattr(sentence, "sentence_type", "") in ("GGA", "GNS", "RMC", "GLL"):
                    self.assertTrue(-90 <= sentence.latitude <= 90 and -180 <= sentence.longitude <= 180, line)
        # Those that it has no class for; of GRS and THS no more than their checksum is read.
        self.assertLessEqual(set(unknown), {"GRS", "THS"})

    @unittest.skipIf(pynmea2 is None, "pynmea2 is not installed; apt-get install python3-nmea2")
    def test_heading_of_the_boat(self):
        """HDT, HDG and ROT tell how the boat lies, by their own fields."""
        lines = [pynmea2.parse(line) for line in self.sent["4.10"]["nmea-generic"] if formatter(line) in ("GGA", "HDT", "HDG", "ROT")]
        place = before = first = heading = None
        compared = turns = 0
        for sentence in lines:
            kind = sentence.sentence_type
            if kind == "GGA":
                place = sentence if sentence.gps_qual else None
            elif kind == "HDT" and place:
                heading = float(sentence.heading)
                off = (heading - bearing_of(place) + 180) % 360 - 180
                self.assertLess(abs(off), 10, f"{sentence} at {place}")
                compared += 1
                first = first or heading
            elif kind == "HDT":
                heading = float(sentence.heading)
            elif kind == "HDG" and place:
                off = (float(sentence.heading) - 3.5 - heading + 180) % 360 - 180
                self.assertLess(abs(off), 0.02)
                self.assertEqual((float(sentence.variation), sentence.var_dir), (3.5, "W"))
            elif kind == "ROT" and before is not None:
                self.assertEqual(sentence.status, "A")
                self.assertAlmostEqual(float(sentence.rate_of_turn), (heading - before) * 60, delta=1.3)
                turns += 1
            if kind == "ROT":
                before = heading
        self.assertGreaterEqual(compared, 5)
        self.assertGreaterEqual(turns, 8)
        self.assertGreater(heading - first, 20, "the boat turns")

    @unittest.skipUnless(shutil.which("gpsdecode"), "gpsdecode is not installed; apt-get install gpsd-clients")
    def test_gpsd(self):
        """gpsd has a fix of three dimensions of each board, where the path leads."""
        for version, board, lines in self.each():
            data = "".join(line + "\r\n" for line in lines).encode("ascii")
            done = subprocess.run(["gpsdecode", "-j"], input=data, capture_output=True, timeout=60, check=False)
            self.assertEqual(done.returncode, 0, f"{board} {version}: {done.stderr.decode()}")
            said = [text for text in done.stdout.decode().splitlines() if text.startswith("{")]
            # gpsd 3.22 misplaces commas in its reports of class ATT, which tell the heading.
            headings = [text for text in said if text.startswith('{"class":"ATT"')]
            if any(line[1:6] in ("GPHDT", "GNHDT") for line in lines):  # it takes no talker HE
                self.assertTrue(any('"heading":9' in text for text in headings), f"{board} {version}: {headings[:1]}")
            reports = [json.loads(text) for text in said if text not in headings]
            fixes = [r for r in reports if r["class"] == "TPV" and r.get("mode") == 3]
            self.assertGreaterEqual(len({r.get("time") for r in fixes}), 5, f"{board} {version}")
            self.assertFalse([r for r in reports if r["class"] == "ERROR"], f"{board} {version}")
            for fix in fixes:
                off = math.hypot(fix["lat"] - CENTRE[0], (fix["lon"] - CENTRE[1]) * math.cos(math.radians(CENTRE[0])))
                self.assertAlmostEqual(off * 111_200, 60, delta=15, msg=f"{board} {version} {fix}")
                self.assertTrue(fix.get("time", "2026-03-01T09:30").startswith("2026-03-01T09:30"), f"{board} {version} {fix}")

    def test_npm(self):
        folder, lack = npm_packages("nmea_readers", "gps", "SKYLOOP_NMEA_READERS")
        if folder is None:
            self.skipTest(f"gps, nmea-simple and @signalk/nmea0183-signalk: {lack}")
        with open_folder() as work:
            said = pathlib.Path(work, "said.jsonl")
            with open(said, "w", encoding="ascii") as out:
                for version, board, lines in self.each():
                    for line in lines:
                        print(json.dumps([f"{board} {version}", line]), file=out)
            reader = pathlib.Path(__file__).resolve().parent / "nmea_readers/read.cjs"
            done = subprocess.run(["node", str(reader), str(said)], capture_output=True, text=True, timeout=120, check=False,
                                  env={**os.environ, "SKYLOOP_NODE_FOLDER": str(folder)})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.check_outcomes([json.loads(text) for text in done.stdout.splitlines()])

    def check_outcomes(self, outcomes):
        read, refused, wrong = collections.Counter(), collections.defaultdict(set), []
        for one in outcomes:
            version, kind = one["tag"].split()[1], formatter(one["line"])
            if "error" in one:
                if version in REFUSED.get((one["reader"], kind), ()):
                    refused[one["reader"], kind].add(version)
                else:
                    wrong.append(f"{one['reader']}: {one['tag']} {one['line']}: {one['error']}")
            elif one["read"] != "unknown":
                read[one["reader"], kind] += 1
        self.assertFalse(wrong, "\n".join(wrong[:20]))
        self.assertEqual({key: set(versions) for key, versions in REFUSED.items()}, dict(refused), "rows that no longer refuse")
        for reader in ("gps", "nmea-simple", "signalk"):
            for kind in ("GGA", "RMC", "VTG", "GLL", "GSV", "HDT"):
                self.assertGreater(read[reader, kind], 0, f"{reader} {kind}")


if __name__ == "__main__":
    unittest.main(verbosity=2)
