"""No command writes over a file that it reads: that is refused, and the file is what it was."""
import pathlib
import unittest

from session import open_folder, skyloop

BOX = """v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nv 0 0 8\nv 10 0 8\nv 10 10 8\nv 0 10 8
f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 5 6 7 8\n"""
SCENARIO = """[run]
start = 2026-03-01T12:00:00Z
duration_s = 3
[[receiver]]
name = "front"
state_file = "front.st"
"""


class SparedFiles(unittest.TestCase):
    def setUp(self):
        held = open_folder()
        self.addCleanup(held.cleanup)
        self.folder = pathlib.Path(held.name)
        self.scenario = self.folder / "run.toml"
        self.scenario.write_text(SCENARIO)

    def spares(self, file, says, *arguments):
        """The command ends with 2 and one line that has these words; the file keeps its bytes."""
        before = file.read_bytes() if file.exists() else None
        done = skyloop(*arguments, check=False)
        self.assertEqual(done.returncode, 2, (arguments, done.stderr))
        self.assertIn(says, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertEqual(file.read_bytes() if file.exists() else None, before)

    def recorded(self):
        """A recording of three seconds."""
        out = self.folder / "recorded"
        skyloop("simulate", self.scenario, "--out", out)
        return out

    def test_solutions(self):
        out = self.recorded()
        observations, navigation = out / "observations.rnx", out / "navigation.rnx"
        link = self.folder / "link.rnx"
        link.symlink_to(observations)
        for target in (observations, navigation, link):
            self.spares(target, "would be lost", "solve", observations, "--nav", navigation, "--out", target)
        skyloop("solve", observations, "--nav", navigation, "--out", self.folder / "fixes.csv")

    def test_ports_and_outputs_of_a_run(self):
        out = self.folder / "out"
        navigation = self.recorded() / "navigation.rnx"
        run = ["simulate", self.scenario, "--nav", navigation, "--out", out]
        for file in (self.scenario, navigation):
            self.spares(file, "would be lost", *run, "--port", f"file:{file}")
            self.spares(file, "would be lost", *run, "--output", f"json-file:{file}")
        self.spares(self.scenario, "would be lost", "run", self.scenario, "--port", f"file:{self.scenario}")
        for name in ("fixes.csv", "port0.out"):
            self.spares(out / name, "belongs to the recording", *run, "--port", f"file:{out / name}")
            self.spares(out / name, "belongs to the recording", *run, "--output", f"json-file:{out / name}")
        skyloop(*run, "--port", f"file:{out / 'beside.ubx'}", "--output", f"json-file:{out / 'beside.json'}")

    def test_what_receivers_save(self):
        state = self.folder / "front.st"
        self.spares(state, "is where", "simulate", self.scenario, "--out", self.folder / "out", "--port", f"file:{state}")
        self.scenario.write_text(SCENARIO + '[[receiver]]\nname = "rear"\nstate_file = "front.st"\n')
        self.spares(state, "state_file of 'rear'", "simulate", self.scenario, "--out", self.folder / "out")

    def test_recordings_that_are_played(self):
        out = self.recorded()
        self.spares(out / "port0.out", "would be lost", "replay", out, "--port", f"file:{out / 'port0.out'}", "--no-wait")
        log = self.folder / "log.ubx"
        log.write_bytes((out / "port0.out").read_bytes())
        self.spares(log, "would be lost", "replay", log, "--baud", "38400", "--port", f"file:{log}", "--no-wait")

    def test_cities(self):
        box = self.folder / "box.obj"
        box.write_text(BOX)
        self.spares(box, "would be lost", "scene", box, "--svg", box)
        picture = self.folder / "picture.svg"
        self.spares(picture, "is where --svg goes", "scene", box, "--origin", "46,7,0", "--at", "46.001,7.001",
                    "--svg", picture, "--sky-svg", picture)


if __name__ == "__main__":
    unittest.main()
