"""The sky in a city: what `sky --scene` tells of each satellite, and maps over an area."""
import csv
import io
import json
import pathlib
import unittest
import xml.etree.ElementTree as xml

from session import SHARED, open_folder, skyloop

PLACE = ["--at", "46.4775,30.7326", "--start", "2026-01-01T00:00:00Z", "--scene", "demo"]
GRID = ["--grid", "30.7318,46.4770,30.7334,46.4780", "--scene", "demo", "--start", "2026-01-01T00:00:00Z"]


class SkyInACity(unittest.TestCase):
    def test_formats_tell_the_same(self):
        listing = json.loads(skyloop("sky", *PLACE, "--format", "json").stdout)
        rows = list(csv.DictReader(io.StringIO(skyloop("sky", *PLACE, "--format", "csv").stdout)))
        svg = skyloop("sky", *PLACE, "--format", "svg").stdout
        text = skyloop("sky", *PLACE).stdout
        xml.fromstring(svg)
        self.assertIn("of the sky is open", svg)
        self.assertGreaterEqual(len(rows), 6)
        self.assertEqual(len(rows), len(listing["satellites"]))
        receptions = set()
        for row, satellite in zip(rows, listing["satellites"]):
            self.assertEqual(row["satellite"], satellite["satellite"])
            self.assertIn(f">{row['satellite']}<", svg)
            self.assertEqual(row["line_of_sight"] == "1", satellite["line_of_sight"])
            self.assertEqual(int(row["paths"]), len(satellite["paths"]))
            receptions.add(satellite["reception"])
            self.assertIn(satellite["reception"], text)
            if satellite["line_of_sight"]:
                self.assertEqual(satellite["paths"], [])
            elif satellite["paths"]:
                first = satellite["paths"][0]
                self.assertEqual(int(row["reflections"]), first["reflections"])
                self.assertAlmostEqual(float(row["excess_m"]), first["excess_m"], delta=1e-4)
            for path in satellite["paths"]:
                self.assertEqual(len(path["points"]), path["reflections"])
                self.assertAlmostEqual(path["loss_db"], 3.0103 * path["reflections"], delta=1e-3)
                self.assertTrue(all(point["surface"] == "wall" for point in path["points"]))
                self.assertGreater(path["excess_m"], 0)
        self.assertIn("line_of_sight", receptions)
        self.assertGreater(len(receptions), 1, "a city without effect")

    def test_without_a_scene_the_columns_stay_empty(self):
        rows = list(csv.DictReader(io.StringIO(
            skyloop("sky", "--start", "2026-01-01T00:00:00Z", "--format", "csv").stdout)))
        self.assertTrue(all(row["line_of_sight"] == "" and row["excess_m"] == "" for row in rows))

    def test_all_paths_adds_to_the_usual_ones(self):
        usual = json.loads(skyloop("sky", *PLACE, "--format", "json").stdout)
        every = json.loads(skyloop("sky", *PLACE, "--format", "json", "--all-paths").stdout)
        count = lambda listing: sum(len(s["paths"]) for s in listing["satellites"])
        self.assertGreater(count(every), count(usual))

    def test_the_plan_shows_the_ways_of_signals(self):
        svg = skyloop("sky", *PLACE, "--format", "svg", "--view", "plan").stdout
        xml.fromstring(svg)
        self.assertIn(": line of sight<", svg)


class Maps(unittest.TestCase):
    def test_are_the_same_with_any_number_of_threads(self):
        arguments = [*GRID, "--grid-size", 8, "--duration", 120, "--format", "csv"]
        maps = {skyloop("sky", *arguments, "--threads", threads).stdout for threads in (1, 2, 4)}
        self.assertEqual(len(maps), 1)
        rows = list(csv.DictReader(io.StringIO(maps.pop())))
        self.assertEqual(len(rows), 8 * 7)
        full = [row for row in rows if row["satellites"]]
        self.assertGreater(len(full), 10)
        for row in full:
            self.assertAlmostEqual(float(row["satellites"]), float(row["line_of_sight"]) + float(row["reflected"]),
                                   delta=0.002)
        self.assertGreater(len({row["line_of_sight"] for row in full}), 1, "the same everywhere in a city")

    def test_come_as_pictures(self):
        for show in ("los", "satellites", "hdop", "fix", "error"):
            xml.fromstring(skyloop("sky", *GRID, "--grid-size", 6, "--format", "svg", "--show", show).stdout)

    def test_have_no_antenna_at_a_doubtful_height(self):
        with open_folder() as folder:
            walls = pathlib.Path(folder, "walls.obj")
            walls.write_text("v 0 10 503\nv 50 10 503\nv 50 10 523\nv 0 10 523\nf 1 2 3 4\n", encoding="ascii")
            doubt = "below the lowest point of the scene"
            here = ["--scene", walls, *GRID[4:], "--format", "csv"]
            self.assertIn(doubt, skyloop("sky", "--at", "46.4775,30.7326,0", *here).stderr)
            self.assertNotIn(doubt, skyloop("sky", *GRID[:2], "--grid-size", 3, *here).stderr)

    def test_refuse_what_cannot_be(self):
        for arguments, word in [(["--grid", "1,2,3"], "found 3 values"),
                                (["--grid", "0,0,1,1", "--step", 0.5], "at most 100 km"),
                                (["--grid", "0,0,.5,.5", "--step", 1], "cells"),
                                (["--grid", "0,0,.1,.1", "--step", 9, "--grid-size", 9], "expected one of them"),
                                (["--grid", "0,0,.1,.1", "--format", "json"], "csv or svg"),
                                (["--grid", "0,0,.1,.1", "--duration", 1e6, "--interval", 1], "epochs"),
                                (["--view", "plan", "--format", "svg"], "--scene"),
                                (["--all-paths"], "--all-paths shows reflections off buildings: expected --scene"),
                                (["--run", "/no/such/folder", "--format", "svg"], "/no/such/folder")]:
            done = skyloop("sky", *arguments, check=False)
            self.assertIn(done.returncode, (1, 2), arguments)
            self.assertIn(word, done.stderr)
            self.assertEqual(done.stdout, "")


class TheReceiverOfAScenario(unittest.TestCase):
    """What `sky` says is used is what its receiver uses."""

    def scenario(self, folder, receiver):
        navigation = SHARED / "nav/BRDC00IGS_R_20240010000_01D_MN.rnx.gz"
        if not navigation.exists():
            self.skipTest(f"shared data absent: {navigation}")
        path = pathlib.Path(folder, "s.toml")
        path.write_text(f'[run]\nstart = 2024-01-01T12:00:00Z\n[sky]\nnavigation = "{navigation}"\n'
                        f'[[receiver]]\n{receiver}\n', encoding="utf-8")
        return path

    def used(self, path, *options):
        """Rows of the satellites that are used, of more that are there."""
        satellites = json.loads(skyloop("sky", path, *options, "--format", "json").stdout)["satellites"]
        used = [s for s in satellites if s["used"]]
        self.assertLess(len(used), len(satellites))
        return used

    def check_against_run(self, path, used):
        skyloop("simulate", path, "--duration", 1, "--out", path.parent)
        with open(path.parent / "satellites.csv", encoding="ascii") as table:
            simulated = {row["satellite"] for row in csv.DictReader(table) if row["used"] == "1"}
        self.assertEqual({s["satellite"] for s in used}, simulated)

    def test_says_what_is_used(self):
        with open_folder() as folder:
            path = self.scenario(folder, 'board = "ublox-f9p"\nconstellations = ["gps", "galileo"]')
            used = self.used(path)
            # The mask of the board: ublox-f9p, 10 degrees.
            self.assertTrue(all(s["elevation_deg"] >= 10 for s in used))
            self.check_against_run(path, used)
            self.assertLess(len(self.used(path, "--mask", 40)), len(used))

    def test_has_no_time_to_acquire(self):
        with open_folder() as folder:
            used = self.used(self.scenario(folder, 'constellations = ["gps"]\nstart = "cold"'))
            self.assertEqual({s["satellite"][0] for s in used}, {"G"})

    def test_takes_as_many_as_its_configuration_says(self):
        with open_folder() as folder:
            path = self.scenario(folder, 'board = "ublox-m9"')  # an F9P leaves weaker ones out
            used = self.used(path)
            self.assertEqual(len(used), 32)
            self.check_against_run(path, used)


class Runs(unittest.TestCase):
    def test_are_drawn_over_the_city(self):
        with open_folder() as folder:
            skyloop("simulate", *PLACE, "--duration", 10, "--out", folder)
            svg = skyloop("sky", "--scene", "demo", "--run", folder, "--format", "svg").stdout
            xml.fromstring(svg)
            self.assertIn("Horizontal error", svg)
            self.assertIn("A run through the city", svg)
            self.assertIn("<title>A run</title>", skyloop("sky", "--run", folder, "--format", "svg").stdout)
            pathlib.Path(folder, "satellites.csv").write_text("nothing\n", encoding="utf-8")
            broken = skyloop("sky", "--scene", "demo", "--run", folder, "--format", "svg", check=False)
            self.assertEqual(broken.returncode, 2)
            self.assertIn("satellites.csv:1", broken.stderr)

    def test_take_no_options_of_another_sky(self):
        with open_folder() as folder:
            skyloop("simulate", *PLACE, "--duration", 2, "--out", folder)
            for arguments in (["--at", "1,2"], ["--nav", "/no/such/file"], ["--rebase-nav"], ["--start", "now"], ["--tracks", 1],
                              ["--view", "plan", "--scene", "demo"], ["--all-paths"], ["--model", "ideal"], GRID[:2]):
                done = skyloop("sky", "--run", folder, "--format", "svg", *arguments, check=False)
                self.assertEqual((done.returncode, done.stdout), (2, ""), arguments)
                self.assertIn(f"--run draws what was recorded; expected it without {arguments[0]}", done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
