"""Faults, verdicts and control as a user meets them: files, exit codes, a live run that is steered and then repeated."""
import json
import os
import pathlib
import signal
import socket
import time
import unittest
import xml.etree.ElementTree

from pty_client_test import open_client, read_for
from session import ROOT, Emulator, open_folder
from session import skyloop as run_to_end

SCENARIO = """[run]
start = 2024-03-05T12:00:00Z
duration_s = 60
[model]
name = "ideal"
[[fault]]
kind = "receiver_silent"
name = "quiet"
at_s = 20
for_s = 5
[[expect]]
what = "receiver silent from 1 s to 4 s after quiet"
[[expect]]
what = "fix within 3 s of the end of quiet"
"""
POLL_MON_VER = bytes.fromhex("b5620a0400000e34")


def skyloop(*arguments):
    return run_to_end(*arguments, check=False)


def is_running(process):
    try:
        state = pathlib.Path("/proc", str(process), "stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state not in "ZX"


class VerdictsTest(unittest.TestCase):
    def setUp(self):
        self.folder = open_folder()
        self.scenario = pathlib.Path(self.folder.name, "quiet.toml")
        self.out = pathlib.Path(self.folder.name, "out")

    def tearDown(self):
        self.folder.cleanup()

    def simulate(self, text):
        self.scenario.write_text(text)
        return skyloop("simulate", self.scenario, "--out", self.out)

    def test_what_is_met_ends_well(self):
        done = self.simulate(SCENARIO)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("2 of 2 expectations met", done.stdout)
        suite = xml.etree.ElementTree.parse(self.out / "junit.xml").getroot()
        self.assertEqual((suite.get("tests"), suite.get("failures")), ("2", "0"))
        self.assertTrue(json.loads((self.out / "verdicts.json").read_text())["met"])
        events = [json.loads(line) for line in (self.out / "commands.jsonl").read_text().splitlines()]
        self.assertEqual([(e["event"], e["name"], e["time_s"]) for e in events],
                         [("fault_begins", "quiet", 20.0), ("fault_ends", "quiet", 25.0)])

    def test_what_is_not_met_ends_with_three(self):
        done = self.simulate(SCENARIO + '[[expect]]\nwhat = "client reconfigures within 5 s of quiet"\n')
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        self.assertIn("FAILED", done.stdout)
        failure = xml.etree.ElementTree.parse(self.out / "junit.xml").getroot().find(".//failure")
        self.assertIsNotNone(failure)

    def test_a_pause_without_anybody_who_could_end_it_is_none(self):
        done = self.simulate(SCENARIO + '[[command]]\nkind = "pause"\nat_s = 10\n[[command]]\nkind = "step"\nseconds = 1\nat_s = 12\n')
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("2 of 2 expectations met", done.stdout)
        self.assertIn("[[command]] 'pause' will do nothing: skyloop run does it", done.stderr)
        events = [json.loads(line) for line in (self.out / "commands.jsonl").read_text().splitlines()]
        self.assertEqual([e["ignored"] for e in events if e["event"] == "command"],
                         ["time is virtual, and waits for nobody"] * 2)
        done = skyloop("check", self.scenario)
        self.assertIn("[[command]] 'pause', 'step' stops time in skyloop run", done.stderr)

    def test_verdicts_are_no_bytes_of_a_receiver(self):
        self.scenario.write_text(SCENARIO)
        for word, option, value in (("simulate", "--port", "-"), ("simulate", "--output", "json-file:-"),
                                    ("run", "--port", "-"), ("run", "--output", "json-file:-")):
            with self.subTest(word + option):
                live = ["--speed", "max"] if word == "run" else ["--out", self.out]
                done = skyloop(word, self.scenario, option, value, *live)
                self.assertNotIn("PASSED", done.stdout)
                self.assertGreater(len(done.stdout), 1000)
                self.assertIn("2 of 2 expectations met", done.stderr)

    def test_a_client_that_the_scenario_plugs_in_is_there(self):
        port = '[[receiver]]\nboard = "ublox-m8"\nport = ["{}", "uart2=pty:/no/such/folder/gps0"]\n'
        done = self.simulate(SCENARIO + port.format("client:careful-ubx") + '[[expect]]\nwhat = "client trusts at 59 s"\n')
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("3 of 3 expectations met", done.stdout)
        self.assertGreater((self.out / "port0.in").stat().st_size, 0)

    def test_mistakes_are_told_by_line_and_column(self):
        cases = {
            '[[fault]]\nkind = "outtage"\n': r"quiet.toml:2:\d+: fault.kind: is 'outtage'; did you mean 'outage'",
            '[[fault]]\nkind = "outage"\natt_s = 5\n': r"quiet.toml:3:\d+: fault.att_s: unknown key; did you mean 'at_s'",
            '[[fault]]\nkind = "outage"\nat_s = -5\n': r"quiet.toml:3:\d+: fault.at_s: is -5; expected a number",
            '[[fault]]\nkind = "outage"\nat_s = nan\n': r"quiet.toml:3:\d+: fault.at_s: is nan; expected a number",
            '[[fault]]\nkind = "outage"\nafter = "x"\n': r"fault.after: is 'x'; no entry has this name",
            '[[fault]]\nat_s = 5\n': r"quiet.toml:1:\d+: .*has no kind; expected one of outage",
            '[[fault]]\nkind = "outage"\nreceiver = "x"\n': r"'x' is no receiver of this scenario; expected some of receiver0",
            '[[command]]\nkind = "set_baud"\n': r"command.baud: is missing; expected bit/s",
            '[[command]]\nkind = "start_fault"\nfault = "x"\n': r"command.fault: is 'x'; no fault of this scenario",
            '[[expect]]\nwhat = "fixx"\n': r"quiet.toml:2:\d+: expect.what: at character 1: 'fixx'",
            '[[expect]]\nwhat = "fix after outtage"\n': r"outtage",
            '[[expect]]\nwhat = "C/N0 of G99 below 30 dBHz"\n': r"quiet.toml:2:\d+: expect.what: 'G99' is no satellite; expected G01 to G63",
            '[[expect]]\nwhat = "client sends MON-VRE"\n': r"expect.what: 'MON-VRE' is no message; did you mean 'MON-VER'",
            '[[fault]]\nkind = "outage"\nsatellites = ["G99"]\n': r"satellites: 'G99' is no satellite; expected G01 to G63 of GPS",
            '[[fault]]\nkind = "outage"\nwhen_client_sends = "NONSENSE"\n': r"quiet.toml:3:\d+: fault.when_client_sends: 'NONSENSE' is no message",
            '[run]\nstart = 2024-03-05T12:00:00Z\n[[fault]]\nkind = "outage"\nat_utc = 2024-03-05T11:00:00Z\n':
                r"'outage': at_utc is 2024-03-05T11:00:00.000Z, before the start of the run; expected 2024-03-05T12:00:00.000Z",
            '[model]\nname = "baseline"\n[[fault]]\nkind = "cycle_slips"\n':
                r"'cycle_slips': kind = \"cycle_slips\" spoils measurements, and model.name = \"baseline\" makes none",
        }
        for text, expected in cases.items():
            with self.subTest(text):
                self.scenario.write_text(text)
                done = skyloop("check", self.scenario)
                self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                self.assertRegex(done.stderr, expected)

    def test_what_comes_after_the_end_is_warned_of(self):
        text = SCENARIO + '[[fault]]\nkind = "outage"\nname = "late"\nat_s = 90\n'
        warning = "[[fault]] 'late' will not begin: it is due 90 s after the start of the run, which ends after 60 s"
        done = self.simulate(text)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn(warning, done.stderr)
        self.assertIn(warning, skyloop("check", self.scenario).stderr)

    def test_a_run_that_judged_nothing_is_no_success(self):
        done = self.simulate('[run]\nstart = 2024-03-05T12:00:00Z\nduration_s = 5\n[model]\nname = "ideal"\n'
                             '[[expect]]\ncommand = ["false"]\n')
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        self.assertIn("1 not run: nothing was judged, so the run is no success", done.stdout)
        self.assertIsNone(json.loads((self.out / "verdicts.json").read_text())["met"])
        suite = xml.etree.ElementTree.parse(self.out / "junit.xml").getroot()
        self.assertEqual((suite.get("tests"), suite.get("skipped")), ("1", "1"))

    def test_what_was_not_run_is_not_met_beside_what_passed(self):
        done = self.simulate(SCENARIO + '[[expect]]\ncommand = ["false"]\n')
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("2 of 3 expectations met", done.stdout)
        self.assertIsNone(json.loads((self.out / "verdicts.json").read_text())["met"])

    def test_occurrences_are_counted_as_they_begin(self):
        done = self.simulate(SCENARIO + '[[command]]\nkind = "start_fault"\nfault = "quiet"\nfor_s = 1\nat_s = 8\n'
                             '[[command]]\nkind = "start_fault"\nfault = "quiet"\nat_s = 22\n'
                             '[[expect]]\nwhat = "receiver silent throughout quiet#2"\n')
        self.assertEqual(done.returncode, 3, "quiet#1 lasts a second alone: " + done.stdout + done.stderr)
        events = [json.loads(line) for line in (self.out / "commands.jsonl").read_text().splitlines()]
        self.assertEqual([(e["occurrence"], e["time_s"]) for e in events if e["event"] == "fault_begins"],
                         [(1, 8.0), (2, 20.0)])
        self.assertEqual([e.get("ignored") for e in events if e["event"] == "command"], [None, "quiet is under way"])

    def test_what_a_command_does_not_tell_of_the_vehicle_stays(self):
        done = self.simulate('[run]\nstart = 2024-03-05T12:00:00Z\nduration_s = 20\n[model]\nname = "ideal"\n'
                             '[[command]]\nkind = "vehicle_state"\nmode = "AUTO"\nat_s = 5\n'
                             '[[command]]\nkind = "vehicle_state"\narmed = true\nat_s = 8\n'
                             '[[fault]]\nkind = "receiver_silent"\nwhen_mavlink_mode = "AUTO"\nwhen_armed = true\n'
                             '[[expect]]\nwhat = "receiver silent within 5 s of receiver_silent"\n')
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_check_prints_the_timeline(self):
        self.scenario.write_text(SCENARIO)
        done = skyloop("check", self.scenario)
        self.assertRegex(done.stdout, r"20\.000 s +quiet begins\n +25\.000 s +quiet ends")


class CatalogueTest(unittest.TestCase):
    def test_the_page_is_what_the_program_tells(self):
        page = (ROOT / "docs/faults.md").read_text()
        self.assertEqual(skyloop("faults", "--format", "markdown").stdout, page,
                         "docs/faults.md is old: skyloop faults --format markdown > docs/faults.md")

    def test_every_kind_has_an_effect_and_a_cause(self):
        kinds = json.loads(skyloop("faults", "--format", "json").stdout)
        self.assertGreater(len(kinds), 50)
        for kind in kinds:
            with self.subTest(kind["name"]):
                self.assertRegex(kind["effect"], r"\w.*\.$")
                self.assertRegex(kind["cause"], r"\w.*\.$")
                self.assertIn(kind["name"], skyloop("faults", kind["name"]).stdout)

    def test_an_unknown_kind_suggests_the_nearest(self):
        done = skyloop("faults", "jaming")
        self.assertEqual(done.returncode, 2)
        self.assertIn("did you mean 'jamming'", done.stderr)


class LiveTest(unittest.TestCase):
    def setUp(self):
        self.folder = open_folder()
        self.path = pathlib.Path(self.folder.name)
        self.scenario = self.path / "live.toml"
        self.scenario.write_text('[run]\nstart = 2024-03-05T12:00:00.5Z\n[model]\nname = "baseline"\n')

    def tearDown(self):
        self.folder.cleanup()

    def await_truth(self, asked, patience=20):
        end = time.monotonic() + patience
        while not asked() and time.monotonic() < end:
            time.sleep(0.02)
        self.assertTrue(asked())

    def ctl(self, port, *arguments):
        done = skyloop("ctl", port, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_commands_for_nobody_are_refused(self):
        with Emulator(str(self.scenario), "--port", "pty", "--control", "0", "--duration", "20") as emulator:
            port = emulator.said(r"^control: http://127\.0\.0\.1:(\d+)/")
            for words in (("fault", "outage", "receiver=nosuch"), ("restart", "receiver=nosuch"),
                          ("fault", "position_step", "north_m=5", "receiver=a,b")):
                with self.subTest(words):
                    done = skyloop("ctl", port, *words)
                    self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                    self.assertIn("expected receiver0, or none for all of them", done.stderr)
            self.assertNotIn("fault outage", self.ctl(port, "status"))
            self.ctl(port, "fault", "outage", "receiver=receiver0")

    def test_a_live_fault_is_stopped_by_the_name_it_was_asked_for_by(self):
        self.scenario.write_text(self.scenario.read_text() + '[[fault]]\nkind = "outage"\nat_s = 900\n')
        with Emulator(str(self.scenario), "--port", "pty", "--control", "0", "--record", str(self.path / "out"),
                      "--duration", "20") as emulator:
            port = emulator.said(r"^control: http://127\.0\.0\.1:(\d+)/")
            self.assertEqual(self.ctl(port, "fault", "outage"), "accepted as outage 2\n")
            for _ in range(2):
                self.assertEqual(self.ctl(port, "stop", "outage"), "accepted\n")
            self.ctl(port, "end")
            self.assertEqual(emulator.finish(), 0, emulator.log)
        events = [json.loads(line) for line in (self.path / "out/commands.jsonl").read_text().splitlines()]
        self.assertEqual([(e["event"], e["name"]) for e in events if e["event"].startswith("fault")],
                         [("fault_begins", "outage 2"), ("fault_ends", "outage 2")])
        self.assertEqual([e.get("ignored") for e in events if e["name"] == "stop_fault"],
                         [None, "outage is not under way"])

    def test_ctl_tells_its_own_words_of_a_refusal(self):
        with Emulator(str(self.scenario), "--port", "pty", "--control", "0", "--token", "secret",
                      "--duration", "20") as emulator:
            port = emulator.said(r"^control: http://127\.0\.0\.1:(\d+)/")
            for words in (("status",), ("--token", "wrong", "status"), ("watch",)):
                done = skyloop("ctl", port, *words)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn("expected --token TOKEN, or SKYLOOP_TOKEN", done.stderr)
            done = skyloop("ctl", "--token", "secret", port, "stop", "nothing")
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(f"no fault is called 'nothing'; skyloop ctl {port} status tells those under way", done.stderr)

    def test_what_a_live_source_asks_of_nobody_is_told(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        self.scenario.write_text('[run]\nstart = 2024-03-05T12:00:00Z\n[model]\nname = "baseline"\n[trajectory]\n'
                                 f'kind = "live"\nsource = "udp-json:{port}"\nat = [47, 8, 500]\n')
        with Emulator(str(self.scenario), "--port", "pty", "--record", str(self.path / "out"),
                      "--duration", "20") as emulator:
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as source:
                for receiver in ("nosuch", "receiver0"):
                    event = {"type": "event", "name": "outage", "args": {"receiver": receiver}}
                    source.sendto(json.dumps(event).encode(), ("127.0.0.1", port))
            emulator.said(r"(start_fault is not done: 'receiver' is 'nosuch'; expected receiver0)")
            emulator.stop()
        events = [json.loads(line) for line in (self.path / "out/commands.jsonl").read_text().splitlines()]
        self.assertEqual([e["name"] for e in events if e["event"] == "fault_begins"], ["outage"])

    def test_ctl_tells_what_it_expects_behind_a_word(self):
        for words, expected in {("stop",): "'stop' has 0 words behind it; expected: stop NAME",
                                ("status", "extra"): "'status' has 1 word behind it; expected: status",
                                ("watch", "a"): "'watch' has 1 word behind it; expected: watch",
                                ("stopp",): "unknown command 'stopp'; did you mean 'stop'"}.items():
            with self.subTest(words):
                done = skyloop("ctl", "1", *words)
                self.assertEqual(done.returncode, 2)
                self.assertIn(expected, done.stderr)

    def test_a_live_run_is_steered_and_repeated_byte_by_byte(self):
        first = self.path / "first"
        with Emulator(str(self.scenario), "--port", "pty", "--record", str(first), "--control", "0",
                      "--duration", "9") as emulator:
            port = emulator.said(r"^control: http://127\.0\.0\.1:(\d+)/")
            client = open_client(emulator.tty)
            read_for(client, 1.5)
            os.write(client, POLL_MON_VER)
            self.assertIn(b"\xb5\x62\x0a\x04", read_for(client, 0.6))
            self.ctl(port, "fault", "receiver_silent", "for_s=2")
            read_for(client, 0.6)
            self.assertIn("receiver_silent", self.ctl(port, "status"))
            self.assertEqual(read_for(client, 0.8), b"")
            self.ctl(port, "move", "46,8,500")
            read_for(client, 6)
            os.close(client)
            self.assertEqual(emulator.finish(), 0, emulator.log)
        again = self.path / "again"
        done = skyloop("simulate", self.scenario, "--duration", 9, "--repeat", first, "--out", again)
        self.assertEqual(done.returncode, 0, done.stderr)
        for name in ("port0.out", "port0.in", "fixes.csv"):
            self.assertEqual((again / name).read_bytes(), (first / name).read_bytes(), name)
        self.assertIn(b"\xb5\x62\x0a\x04", (again / "port0.out").read_bytes())

    def test_what_expectations_ask_does_not_outlive_a_run_that_is_killed(self):
        begun = [pathlib.Path(self.folder.name, name) for name in ("begun", "beside")]
        probes = "".join(f"""[[expect]]
command = ["sh", "-c", "echo $$ >'{path}'; sleep 100"]
timeout_s = 100
""" for path in begun)
        self.scenario.write_text(SCENARIO + probes)
        with Emulator(self.scenario) as emulator:
            self.await_truth(lambda: all(path.exists() and path.read_text().strip() for path in begun))
            programs = [int(path.read_text()) for path in begun]
            self.assertTrue(all(map(is_running, programs)))
            self.assertEqual(emulator.stop(signal.SIGKILL), -signal.SIGKILL)
            self.await_truth(lambda: not any(map(is_running, programs)))

    def test_a_scripted_client_is_heard_once_in_a_repeat(self):
        first, again = self.path / "first", self.path / "again"
        self.scenario.write_text(self.scenario.read_text() + '[[receiver]]\nport = "client:careful-ubx"\n')
        arguments = ["simulate", self.scenario, "--duration", 12]
        skyloop(*arguments, "--out", first)
        skyloop(*arguments, "--repeat", first, "--out", again)
        skyloop(*arguments, "--repeat", first, "--out", self.path / "third", "--port", "client:careful-ubx")
        self.assertGreater((first / "port0.in").stat().st_size, 100)
        for folder in (again, self.path / "third"):
            for name in ("port0.out", "port0.in", "port0.in_times", "fixes.csv"):
                self.assertEqual((folder / name).read_bytes(), (first / name).read_bytes(), name)

    def test_a_live_run_with_a_scripted_client_is_repeated(self):
        first, again = self.path / "first", self.path / "again"
        self.scenario.write_text(self.scenario.read_text() + '[[receiver]]\nport = ["uart1=pty", "client:careful-ubx"]\n')
        skyloop("run", self.scenario, "--duration", 12, "--speed", "max", "--record", first)
        skyloop("simulate", self.scenario, "--duration", 12, "--repeat", first, "--out", again)
        self.assertGreater((first / "port1.in").stat().st_size, 100)
        for name in ("port0.out", "port1.out", "port1.in", "port1.in_times", "fixes.csv"):
            self.assertEqual((again / name).read_bytes(), (first / name).read_bytes(), name)

    def test_a_repeat_begins_when_the_run_did_whatever_now_is(self):
        first, again = self.path / "first", self.path / "again"
        skyloop("simulate", self.scenario, "--start", "now", "--duration", 3, "--out", first)
        time.sleep(0.01)
        done = skyloop("simulate", self.scenario, "--start", "now", "--duration", 3, "--repeat", first, "--out", again)
        self.assertEqual(done.returncode, 0, done.stderr)
        for name in ("port0.out", "fixes.csv"):
            self.assertEqual((again / name).read_bytes(), (first / name).read_bytes(), name)
        done = skyloop("simulate", self.scenario, "--start", "2024-03-05T13:00:00Z", "--duration", 3, "--repeat", first,
                       "--out", again)
        self.assertEqual(done.returncode, 2)
        self.assertIn("began at another time", done.stderr)

    def test_what_another_program_led_is_not_repeated(self):
        folder = self.path / "led"
        skyloop("simulate", self.scenario, "--duration", 2, "--out", folder)
        (folder / "commands.jsonl").unlink()
        done = skyloop("simulate", self.scenario, "--duration", 2, "--repeat", folder, "--out", self.path / "again")
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
        self.assertIn("has no commands.jsonl, as a run that another program led", done.stderr)

    def test_a_repeat_does_not_write_over_what_it_repeats(self):
        first, link = self.path / "first", self.path / "link"
        skyloop("simulate", self.scenario, "--duration", 3, "--out", first)
        link.symlink_to(first)
        kept = (first / "port0.out").read_bytes()
        for command, option in (("simulate", "--out"), ("run", "--record")):
            for folder in (first, link, self.path / "first" / ".." / "first"):
                done = skyloop(command, self.scenario, "--duration", 1, "--repeat", first, option, folder)
                self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
                self.assertIn("--repeat", done.stderr)
        done = skyloop("simulate", self.scenario, "--duration", 1, "--repeat", first, "--out", self.path / "again", "--output",
                       f"json-file:{first / 'port0.in'}")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("this file is read, too, and would be lost", done.stderr)
        self.assertEqual((first / "port0.out").read_bytes(), kept)


if __name__ == "__main__":
    unittest.main()
