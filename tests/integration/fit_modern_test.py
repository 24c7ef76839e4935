"""skyloop fit --model modern: surroundings and scales with which the modern model errs as a receiver at rest did."""
import pathlib
import re
import unittest

from session import open_folder
from session import skyloop as run_to_end

START = "2024-03-05T12:00:00Z"
SCENARIO = f"""[run]
start = {START}
duration_s = 721
seed = 9
[sky]
constellations = ["gps"]
[model.modern.terms]
multipath = {{ scale = 4 }}
[[receiver]]
constellations = ["gps"]
rate_hz = 1
"""
KNOWN = ("--model", "modern", "--surroundings", "open-sky", "--constellations", "gps")


def skyloop(*arguments):
    return run_to_end(*arguments, check=False)


def misfit(text, row):
    return float(re.search(rf"^{row} .*misfit ([0-9.]+)$", text, re.MULTILINE)[1])


def figures(text, name):
    """Of the log, before and fitted."""
    return [float(value) for value in re.search(rf"^ *{name} +(\S+) +(\S+) +(\S+)$", text, re.MULTILINE).groups()]


class FitModernTest(unittest.TestCase):
    def setUp(self):
        self.temporary = open_folder()
        self.folder = pathlib.Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def fit(self, log, *arguments):
        done = skyloop("fit", log, *KNOWN, *arguments, "--out", self.folder / "fit")
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    # The receiver is the model itself with four times its multipath and another seed.
    def test_finds_the_cause_that_was_enlarged(self):
        (self.folder / "real.toml").write_text(SCENARIO, encoding="utf-8")
        made = skyloop("simulate", self.folder / "real.toml", "--out", self.folder / "real")
        self.assertEqual(made.returncode, 0, made.stderr)
        told = self.fit(self.folder / "real" / "fixes.csv", "--skip", 60)
        self.assertLess(misfit(told, "fitted"), 0.5 * misfit(told, "before"))
        log, before, fitted = figures(told, "horizontal deviation, m")
        self.assertGreater(log, 1.5 * before)
        self.assertLess(abs(fitted - log) / log, 0.25)
        scales = {name: float(value) for name, value in
                  re.findall(r"(\w+) = \{ scale = (\S+) \}", (self.folder / "fit" / "fit.toml").read_text())}
        self.assertGreater(scales["multipath"], 1.5, scales)
        # What is written runs to the first of the two runs that were told of.
        again = skyloop("simulate", self.folder / "fit" / "fit.toml", "--out", self.folder / "again")
        self.assertEqual(again.returncode, 0, again.stderr)
        figure = (self.folder / "fit" / "fit.svg").read_text(encoding="utf-8")
        self.assertIn("modern, fitted", figure)

    def test_refusals(self):
        log = self.folder / "log.csv"
        log.write_text("".join(f"{46.4774 + 1e-4 * s:.7f},30.7326,77\n" for s in range(700)), encoding="utf-8")
        dated = ("--start", START, "--interval", 1)
        done = skyloop("fit", log, *KNOWN, *dated)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("log.csv: moves: ", done.stderr)
        for option, value in (("--board", "ublox-6"), ("--surroundings", "forest"), ("--constellations", "gps")):
            done = skyloop("fit", log, *dated, option, value)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(f"{option}: is of the modern model; expected --model modern, too", done.stderr)
        done = skyloop("fit", log, *dated, "--model", "modern", "--surroundings", "moon")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("moon", done.stderr)


if __name__ == "__main__":
    unittest.main()
