"""A fault that cuts real power: the actuator follows the scenario, and the power is on again however the run ends."""
import json
import os
import pathlib
import signal
import subprocess
import time
import unittest

from session import SKYLOOP, Emulator, open_folder, skyloop

SCENARIO = """[run]
start = 2026-03-01T00:00:00Z
duration_s = {duration}
[model]
name = "ideal"
[[receiver]]
port = "pty"
power = {power}
[[fault]]
kind = "power_cut"
name = "outage"
at_s = {at}
for_s = {lasts}
"""


class PowerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        signal.signal(signal.SIGHUP, signal.SIG_DFL)  # whatever started the tests; programs inherit it

    def setUp(self):
        self.folder = open_folder()
        self.states = pathlib.Path(self.folder.name, "states")
        self.scenario = pathlib.Path(self.folder.name, "outage.toml")
        self.out = pathlib.Path(self.folder.name, "out")

    def tearDown(self):
        self.folder.cleanup()

    def actuator(self, cut="cut", restore="on"):
        """Commands that add a line each to a file."""
        def told(state):
            return f"sh -c 'date +%s.%N >>\"$1.times\"; echo {state} >>\"$1\"' - '{self.states}'"
        return f"command:{told(cut)}|{told(restore)}"

    def write(self, power, at=1, lasts=1, duration=4):
        self.scenario.write_text(SCENARIO.format(power=json.dumps(power), at=at, lasts=lasts, duration=duration))
        return self.scenario

    def seen(self):
        return self.states.read_text().split() if self.states.exists() else []

    def await_states(self, states, patience=20):
        end = time.monotonic() + patience
        while self.seen() != states and time.monotonic() < end:
            time.sleep(0.02)
        self.assertEqual(self.seen(), states)

    def test_the_actuator_follows_the_scenario(self):
        with Emulator(self.write(self.actuator()), "--record", self.out) as emulator:
            self.assertEqual(emulator.finish(), 0, emulator.log)
            self.assertEqual(self.seen(), ["on", "cut", "on"], "a run begins with the power on")
            times = [float(line) for line in pathlib.Path(f"{self.states}.times").read_text().split()]
            self.assertAlmostEqual(times[2] - times[1], 1, delta=0.5)
            self.assertRegex(emulator.log, r"power command:.*: 1 times cut, 1 times restored, 0 failures")
        power = json.loads((self.out / "run.json").read_text())["power"]
        self.assertEqual((power["cuts"], power["restores"], power["failures"]), (1, 1, 0))
        self.assertGreater(power["slowest_ms"], 0)

    def test_interrupted_or_ended_it_restores(self):
        for by in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(by=by), Emulator(self.write(self.actuator(), at=0.2, lasts=60, duration=100)) as emulator:
                self.await_states(["on", "cut"])
                self.assertEqual(emulator.stop(by), 0, emulator.log)
                self.assertEqual(self.seen(), ["on", "cut", "on"])
                self.states.unlink()

    def test_a_hang_up_that_is_ignored_ends_nothing(self):
        signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup does
        try:
            with Emulator(self.write(self.actuator(), at=0.2, lasts=60, duration=100)) as emulator:
                self.await_states(["on", "cut"])
                emulator.process.send_signal(signal.SIGHUP)
                time.sleep(0.5)
                self.assertIsNone(emulator.process.poll())
                self.assertEqual(emulator.stop(signal.SIGTERM), 0, emulator.log)
        finally:
            signal.signal(signal.SIGHUP, signal.SIG_DFL)

    def test_killed_in_the_middle_of_a_cut_the_watchdog_ends_the_cut_first(self):
        cut = f"sh -c 'echo begun >>\"$1\"; sleep 1; echo cut >>\"$1\"' - '{self.states}'"
        power = f"command:{cut}|" + self.actuator().split("|")[1]
        with Emulator(self.write(power, at=0.2, lasts=60, duration=100)) as emulator:
            self.await_states(["on", "begun"])
            self.assertEqual(emulator.stop(signal.SIGKILL), -signal.SIGKILL)
            time.sleep(1.2)  # longer than the cut takes
            self.assertEqual(self.seen(), ["on", "begun", "on"])

    def test_killed_the_watchdog_restores(self):
        with Emulator(self.write(self.actuator(), at=0.2, lasts=60, duration=100)) as emulator:
            self.await_states(["on", "cut"])
            self.assertEqual(emulator.stop(signal.SIGKILL), -signal.SIGKILL)
            # stderr has been read to its end, which is the watchdog's own.
            self.assertEqual(self.seen(), ["on", "cut", "on"])
            self.assertRegex(emulator.log, r"power command:.*: restored, as the run had not done so")

    def test_killed_with_its_whole_group_the_watchdog_restores(self):
        scenario = self.write(self.actuator(), at=0.2, lasts=60, duration=100)
        process = subprocess.Popen([SKYLOOP, "run", str(scenario)], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, start_new_session=True)
        try:
            self.await_states(["on", "cut"])
        finally:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait(timeout=20)
        self.await_states(["on", "cut", "on"])

    def test_what_was_not_cut_is_told_and_fails_the_run(self):
        broken = "command:sh -c 'echo no relay >&2; exit 1'|true"
        with Emulator(self.write(broken, at=0.5, lasts=1, duration=3), "--record", self.out) as emulator:
            self.assertEqual(emulator.finish(), 1, emulator.log)
            self.assertRegex(emulator.log, r"the power was not cut: 'sh' ended with exit code 1: no relay")
        self.assertEqual(json.loads((self.out / "run.json").read_text())["power"]["failures"], 1)

    def test_an_actuator_that_cannot_be_used_is_one_line(self):
        for power, code, text in (("relay:16c0:05df", 2, r"power 'relay:16c0:05df' is not understood"),
                                  ("command:true|false", 1, r"power command:true\|false: 'false' ended with exit code 1$"),
                                  ("line:/dev/no-such-tty/rts", 1, r"/dev/no-such-tty: No such file or directory$")):
            done = skyloop("run", self.write(power), check=False)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertRegex(done.stderr.splitlines()[-1], text)
        twice = self.write("command:true|true").read_text() + '[[receiver]]\nname = "b"\npower = "command:true|true"\n'
        self.scenario.write_text(twice)
        self.assertIn("is that of receiver0 too", skyloop("run", self.scenario, check=False).stderr)

    def test_virtual_time_leaves_it_alone(self):
        checked = skyloop("check", self.write(self.actuator()))
        self.assertRegex(checked.stdout, r"power +command:")
        self.assertRegex(checked.stderr, r"in virtual time nothing does")
        skyloop("simulate", self.scenario, "--out", self.out)
        skyloop("run", self.scenario, "--speed", "max")
        self.assertEqual(self.seen(), [])

    def test_by_hand(self):
        power = self.actuator() + f"|tail -n 1 '{self.states}'"
        for what, state in (("off", "cut"), ("state", "cut"), ("on", "on"), ("state", "on")):
            done = skyloop("power", power, what)
            self.assertEqual(done.stdout, f"command sh: {state}\n")
        self.assertEqual(self.seen(), ["cut", "on"])
        self.assertEqual(skyloop("power", "command:true|true", "state").stdout, "command true: it does not tell\n")
        refused = skyloop("power", "hub:99-1", "off", check=False)
        self.assertEqual(refused.returncode, 1)
        self.assertRegex(refused.stderr, r"there is no hub at usb99$|cannot use USB")


if __name__ == "__main__":
    unittest.main(verbosity=2)
