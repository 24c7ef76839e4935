"""skyloop fit: a scenario whose errors are those of a receiver at rest, and why some logs are refused."""
import errno
import math
import os
import pathlib
import pty
import random
import re
import signal
import subprocess
import unittest

from session import SKYLOOP, open_folder
from session import skyloop as run_to_end

ROOF = "46.4774,30.7326,77"
START = "2024-03-05T12:00:00Z"
BASELINE = """[run]
start = {start}
duration_s = {duration}
seed = 9
[model]
name = "baseline"
[model.baseline]
iono_fraction = {iono}
tropo_fraction = {tropo}
"""


def skyloop(*arguments):
    return run_to_end(*arguments, check=False)


def difference(text, row):
    """The percentage in the line of the output that begins so."""
    return float(re.search(rf"^{row} .*difference ([0-9.]+) %", text, re.MULTILINE)[1])


def rows(seconds, path, sigma=1.5, seed=4):
    """Fixes about a roof in Odessa, a second each: latitude, longitude, height; `path` gives metres east and north."""
    draw = random.Random(seed)
    lines = []
    for second in range(seconds):
        east, north = path(second)
        lines.append(f"{46.4774 + (north + draw.gauss(0, sigma)) / 111_170:.8f},"
                     f"{30.7326 + (east + draw.gauss(0, sigma)) / 76_740:.8f},{77 + draw.gauss(0, 2):.3f}\n")
    return lines


def at_rest(_):
    return 0, 0


class FitTest(unittest.TestCase):
    def setUp(self):
        self.temporary = open_folder()
        self.folder = pathlib.Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def write(self, name, lines):
        path = self.folder / name
        path.write_text("".join(lines), encoding="utf-8")
        return path

    def simulated(self, name, **settings):
        scenario = self.write(f"{name}.toml", [BASELINE.format(start=START, duration=1200, **settings)])
        self.run_well("simulate", scenario, "--out", self.folder / name)
        return self.folder / name / "fixes.csv"

    def run_well(self, *arguments):
        done = skyloop(*arguments)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def refused(self, *arguments, code=2):
        """The one line that it says; nothing is written."""
        out = self.folder / "refused"
        done = skyloop("fit", *arguments, "--out", out)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertFalse(out.exists())
        return done.stderr

    # The receiver is the model itself with another seed.
    def test_scenario_does_what_was_said(self):
        log = self.simulated("real", iono=0.8, tropo=0.25)
        told = self.run_well("fit", log, "--out", self.folder / "fit")
        self.assertIn(f"1200 fixes in 1200 s from {START}, at rest at 46.4774000, 30.7326000, 77.00 m", told)
        self.assertIn("about its own truth", told)
        self.assertLess(difference(told, "fitted"), 5)
        self.assertGreater(difference(told, "calibrated"), 10)
        self.run_well("simulate", self.folder / "fit" / "fit.toml", "--out", self.folder / "again")
        compared = self.run_well("compare", self.folder / "again", log)
        self.assertIn(f"\ndifference {difference(told, 'fitted'):.1f} %, agreement", compared)
        strict = self.simulated("strict", iono=1, tropo=1)
        text = (self.folder / "strict.toml").read_text(encoding="utf-8").replace("seed = 9", "seed = 1")
        self.run_well("simulate", self.write("strict.toml", [text]), "--out", self.folder / "strict")
        compared = self.run_well("compare", strict, log)
        self.assertIn(f"\ndifference {difference(told, 'strict'):.1f} %", compared)
        figure = (self.folder / "fit" / "fit.svg").read_text(encoding="utf-8")
        self.assertIn("baseline, fitted", figure)
        self.assertIn("real/fixes.csv", figure)

    def test_same_bytes_every_time(self):
        log = self.write("log.csv", rows(700, at_rest))
        said = []
        for _ in range(2):
            said.append(self.run_well("fit", log, "--start", START, "--interval", 1, "--out", self.folder / "fit"))
            said.append((self.folder / "fit" / "fit.toml").read_bytes() + (self.folder / "fit" / "fit.svg").read_bytes())
        self.assertEqual(said[:2], said[2:])

    def test_other_logs_and_the_rest(self):
        log = self.write("log.csv", rows(2000, at_rest))
        other = self.write("other.csv", rows(650, at_rest, sigma=3))
        told = self.run_well("fit", log, "--start", START, "--interval", 1, "--reference", ROOF, "--skip", 50, "--count",
                             620, "--check-rest", "--check", other, "--out", self.folder / "fit")
        self.assertIn("about the reference", told)
        checks = re.findall(r"^check       (.*?): mean ([0-9.]+) m", told, re.MULTILINE)
        self.assertEqual([pathlib.Path(name).name for name, _ in checks],
                         ["log.csv, fixes 671 to 1290 (2024-03-05T12:11:10Z)",
                          "log.csv, fixes 1291 to 1910 (2024-03-05T12:21:30Z)", "other.csv (2024-03-05T12:00:00Z)"])
        self.assertGreater(float(checks[2][1]), 1.7 * float(checks[0][1]))
        self.assertIn('start = 2024-03-05T12:00:50.000Z\nduration_s = 620\n',
                      (self.folder / "fit" / "fit.toml").read_text(encoding="utf-8"))

    # Of a receiver's own bytes, which are dated, with the orbits that it had.
    def test_receiver_output(self):
        self.run_well("simulate", "--start", START, "--duration", 900, "--out", self.folder / "run")
        bytes_of = self.folder / "run" / "port0.out"
        orbits = self.folder / "run" / "navigation.rnx"
        told = self.run_well("fit", bytes_of, "--nav", orbits, "--out", self.folder / "fit")
        self.assertIn("about its own mean", told)
        self.assertIn("orbits      navigation.rnx", told)
        self.assertIn(f'navigation = ["{orbits}"]', (self.folder / "fit" / "fit.toml").read_text(encoding="utf-8"))

    def test_what_cannot_be_fitted_is_refused(self):
        dated = ("--start", START, "--interval", 1)
        rest = rows(900, at_rest)
        short = self.write("short.csv", rest[:300])
        self.assertIn("short.csv: is 300 s long, of 300 fixes; expected 600 s or more", self.refused(short, *dated))
        drive = self.write("drive.csv", rows(900, lambda s: (12 * s, 0)))
        self.assertIn("drive.csv: moves: in minute 1 it is ", self.refused(drive, *dated))
        circle = self.write("circle.csv", rows(900, lambda s: (25 * math.cos(s / 5), 25 * math.sin(s / 5))))
        self.assertIn("circle.csv: moves: in ", self.refused(circle, *dated))
        held = self.write("held.csv", rest[:1] * 900)
        self.assertIn("held.csv: all fixes are at one place", self.refused(held, *dated))
        log = self.write("log.csv", rest)
        self.assertIn("log.csv: has no times; expected --interval", self.refused(log, "--start", START))
        self.assertIn("log.csv: tells no date; expected --start", self.refused(log, "--interval", 1))
        self.assertIn("--start: ", self.refused(log, "--interval", 1, "--start", "soon"))
        self.assertIn("--reference 46,30: expected LAT,LON,HEIGHT", self.refused(log, *dated, "--reference", "46,30"))
        self.assertIn("--skip 900: ", self.refused(log, *dated, "--skip", 900))
        self.assertIn("--check-rest: ", self.refused(log, *dated, "--check-rest"))
        self.assertIn("short.csv: is 300 s long", self.refused(log, *dated, "--check", short))
        self.assertIn("no.csv: No such file", self.refused(self.folder / "no.csv", *dated, code=1))
        self.assertIn("no.nav: No such file", self.refused(log, *dated, "--nav", self.folder / "no.nav", code=1))

    def test_a_gap_is_refused_with_its_time(self):
        log = self.simulated("real", iono=0.8, tropo=0.25)
        lines = log.read_text(encoding="utf-8").splitlines(keepends=True)
        gap = self.write("gap.csv", lines[:701] + lines[731:])
        self.assertIn("gap.csv: has no fix for 31.0 s after 2024-03-05T12:11:39Z; expected gaps of at most 10 s",
                      self.refused(gap))
        self.run_well("fit", gap, "--count", 700, "--out", self.folder / "fit")

    def test_what_somebody_wrote_is_kept(self):
        log = self.write("log.csv", rows(700, at_rest))
        mine = self.write("fit.toml", ["[run]\nseed = 1\n"])
        done = skyloop("fit", log, "--start", START, "--interval", 1, "--out", self.folder)
        self.assertEqual(done.returncode, 2)
        self.assertIn("fit.toml: is there already, and not by fit; expected --out with another folder", done.stderr)
        self.assertEqual(mine.read_text(encoding="utf-8"), "[run]\nseed = 1\n")

    def test_ctrl_c_leaves_nothing(self):
        log = self.write("log.csv", rows(40_000, at_rest))
        leader, terminal = pty.openpty()
        command = [SKYLOOP, "fit", log, "--start", START, "--interval", "1", "--out", self.folder / "fit"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=terminal, stdin=subprocess.DEVNULL) as process:
            os.close(terminal)
            shown = b""
            try:
                while piece := os.read(leader, 4096):
                    if b"running the model: " in (shown := shown + piece) and process.poll() is None:
                        process.send_signal(signal.SIGINT)
            except OSError as ended:  # as a terminal ends
                self.assertEqual(ended.errno, errno.EIO)
            os.close(leader)
            self.assertEqual(process.stdout.read(), b"")
        self.assertEqual(process.returncode, 1, shown)
        self.assertIn(b"fit was stopped by a signal; nothing is written", shown)
        self.assertFalse((self.folder / "fit").exists())


if __name__ == "__main__":
    unittest.main()
