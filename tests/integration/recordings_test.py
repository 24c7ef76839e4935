"""What a run does to the folder that it records into, and to what lies there already."""
import json
import pathlib
import signal
import socket
import unittest

from session import Emulator, open_folder, skyloop


def files_of(folder):
    return {path.name: path.read_bytes() for path in pathlib.Path(folder).iterdir() if path.is_file()}


class RecordingsTest(unittest.TestCase):
    def setUp(self):
        folder = open_folder()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        self.out = self.path / "out"

    def scenario(self, text, name="s.toml"):
        path = self.path / name
        path.write_text("[run]\nstart = 2024-03-05T12:00:00Z\nduration_s = 5\n[model]\nname = \"ideal\"\n" + text, encoding="utf-8")
        return path

    def simulate(self, *arguments, check=True):
        return skyloop("simulate", *arguments, "--out", self.out, check=check)

    def test_a_run_that_is_refused_leaves_the_recording_as_it_was(self):
        scenario = self.scenario("")
        self.simulate(scenario)
        before = files_of(self.out)
        taken = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(taken.close)
        port = taken.getsockname()[1]
        for options in (("--control", port), ("--control", 0, "--token", "a b"), ("--mavlink", "udp:nosuch.invalid:1"),
                        ("--output", f"json-tcp:{port}"), ("--port", "pigeon:1"), ("--port", f"tcp:{port}")):
            done = skyloop("run", scenario, "--record", self.out, *options, check=False)
            self.assertIn(done.returncode, (1, 2), done.stderr)
            self.assertEqual(files_of(self.out), before, options)
        self.assertEqual(self.simulate(scenario, "--output", f"json-tcp:{port}", check=False).returncode, 1)
        self.assertEqual(files_of(self.out), before)

    def test_a_run_that_is_refused_leaves_the_files_of_its_wires_as_they_were(self):
        names = ("wire.ubx", "epochs.json")
        for name in names:
            (self.path / name).write_text("of a former run")
        wires = [argument for name in ("wire.ubx", "new.ubx") for argument in ("--port", f"file:{self.path / name}")]
        outputs = ("--output", f"json-file:{self.path / 'epochs.json'}", "--output", f"json-file:{self.path / 'new.json'}")
        before = files_of(self.path)
        done = skyloop("run", "--model", "ideal", *wires, *outputs, "--control", 0, "--token", "a b", "--duration", 2, check=False)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(files_of(self.path), before)
        skyloop("run", "--model", "ideal", *wires, *outputs, "--duration", 2)
        for name in (*names, "new.ubx", "new.json"):
            data = (self.path / name).read_bytes()
            self.assertNotIn(b"former", data)
            self.assertGreater(len(data), 100, name)

    def test_two_runs_do_not_record_into_one_folder(self):
        with Emulator("--model", "ideal", "--port", "pty", "--record", self.out, "--duration", 4) as first:
            for second in (skyloop("run", "--record", self.out, check=False), self.simulate("--duration", 9, check=False)):
                self.assertEqual(second.returncode, 1, second.stderr)
                self.assertIn("out: another run is recording there; expected another folder", second.stderr)
            self.assertEqual(first.finish(), 0, first.log)
        files = files_of(self.out)
        self.assertEqual(len(files["fixes.csv"].splitlines()), 5)
        self.assertNotIn(b"\0", files["fixes.csv"])
        self.simulate("--duration", 9)

    def test_files_of_the_user_stay(self):
        self.simulate(self.scenario(""), "--model", "modern")
        own = self.path / "own"
        own.mkdir()
        for name in ("navigation.rnx", "observations.rnx", "fixes.csv"):
            (own / name).write_bytes((self.out / name).read_bytes())
        before = files_of(own)
        for options in (("--nav", own / "navigation.rnx"), ("--trajectory", own / "fixes.csv")):
            done = skyloop("simulate", *options, "--duration", 3, "--model", "ideal", "--out", own, check=False)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(f"{options[1]}: the run reads this file", done.stderr)
            self.assertEqual(files_of(own), before)
        skyloop("simulate", "--nav", self.out / "navigation.rnx", "--model", "ideal", "--duration", 3, "--out", own)
        self.assertEqual({**files_of(own), **{name: before[name] for name in ("navigation.rnx", "observations.rnx")}}, files_of(own))
        skyloop("simulate", "--model", "ideal", "--duration", 3, "--out", self.out)
        self.assertFalse((self.out / "navigation.rnx").exists(), "that of a former run")

    def test_the_verdicts_of_a_former_run_do_not_stay(self):
        expecting = self.scenario("[[expect]]\nwhat = \"fix within 3 s of the run\"\n", "expecting.toml")
        self.simulate(expecting)
        self.assertTrue((self.out / "junit.xml").exists())
        self.simulate(self.scenario(""))
        self.assertFalse((self.out / "junit.xml").exists())
        self.assertFalse((self.out / "verdicts.json").exists())
        self.simulate(expecting)
        with Emulator(expecting, "--port", "pty", "--record", self.out) as killed:
            killed.stop(signal.SIGKILL)
        self.assertFalse(json.loads((self.out / "run.json").read_text(encoding="utf-8"))["ended"])
        self.assertFalse((self.out / "junit.xml").exists(), "a run that was killed has not passed")

    def test_receivers_of_a_former_run_do_not_stay(self):
        receiver = "[[receiver]]\nboard = \"ublox-m8\"\n"
        self.simulate(self.scenario(3 * receiver))
        (self.out / "receiver2/notes.txt").write_text("of the user", encoding="utf-8")
        self.simulate(self.scenario(2 * receiver))
        self.assertTrue((self.out / "receiver1/fixes.csv").exists())
        self.assertEqual(list(files_of(self.out / "receiver2")), ["notes.txt"])
        self.simulate(self.scenario(""))
        self.assertFalse((self.out / "receiver1").exists())
        (self.out / "run.json").unlink()
        (self.out / "receiver1").mkdir()
        (self.out / "receiver1/fixes.csv").write_text("of the user", encoding="utf-8")
        self.simulate(self.scenario(""))
        self.assertTrue((self.out / "receiver1/fixes.csv").exists(), "no run has left it")


if __name__ == "__main__":
    unittest.main(verbosity=2)
