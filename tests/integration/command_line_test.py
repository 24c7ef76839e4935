"""What a user may type wrongly: one clear line, the right exit code, never a crash or silence."""
import json
import os
import pathlib
import signal
import subprocess
import unittest

from session import SHARED, SKYLOOP, Emulator, open_folder, skyloop

# Arguments, exit code, words that the line must hold.
MISUSES = [
    (["fly"], 2, ["fly", "expected one of"]),
    (["siumlate"], 2, ["did you mean 'simulate'"]),
    (["campaign"], 2, ["expected skyloop campaign SCENARIO --out DIR"]),
    (["decode", "/no/such/file.log"], 1, ["/no/such/file.log"]),
    (["decode", "/"], 1, ["/"]),
    (["decode", "/dev/null", "--format", "xml"], 2, ["--format", "json"]),
    (["decode", "/dev/null", "--protocol", "ubx,nmae"], 2, ["--protocol", "nmae"]),
    (["run", "--at", "91,0"], 2, ["--at 91,0", "latitude is 91", "-90 to 90"]),
    (["run", "--at", "46"], 2, ["--at 46", "LAT,LON"]),
    (["run", "--at", "nan,0"], 2, ["--at nan,0"]),
    (["run", "--at", "46,30,"], 2, ["--at 46,30,"]),
    (["run", "--model", "basline"], 2, ["did you mean 'baseline'"]),
    (["run", "--scene", "/no/such/x.obj"], 1, ["/no/such/x.obj"]),
    (["run", "--scene", "x.doc"], 2, ["x.doc", "ending"]),
    (["scene", "/no/such/x.obj"], 1, ["/no/such/x.obj"]),
    (["scene", "demo", "--axes", "x,y"], 2, ["--axes x,y"]),
    (["scene", "demo", "--file-crs", "EPSG:99999"], 2, ["--file-crs: 'EPSG:99999' is no reference system", "EPSG:25832"]),
    (["scene", "demo", "--origin", "91,0"], 2, ["--origin 91,0", "latitude is 91"]),
    (["scene", "demo", "--sky-svg", "x.svg"], 2, ["--sky-svg", "--at"]),
    (["run", "--control", "nowhere"], 2, ["nowhere"]),
    (["run", "--trajectory", "x.gpx"], 1, ["x.gpx", "No such file"]),
    (["run", "--port", "serial:"], 2, ["serial:", "a device is missing"]),
    (["run", "--port", "pyt:x"], 2, ["did you mean 'pty'"]),
    (["run", "--port", "pty:/no/such/folder/gps0"], 1, ["/no/such/folder/gps0"]),
    (["run", "--board", "ublox-m88"], 2, ["ublox-m88", "did you mean"]),
    (["run", "--nav", "/no/such/file.21n"], 1, ["/no/such/file.21n"]),
    (["run", "--start", "yesterday"], 2, ["--start", "yesterday"]),
    (["run", "--start", "2017-06-30T23:59:60Z"], 2, ["--start: '2017-06-30T23:59:60Z' is not a UTC time"]),
    (["run", "--start", "2024-02-30T00:00:00Z"], 2, ["2024-02-30"]),
    (["run", "--duration", "-1"], 2, ["--duration: is -1; expected a number above 0"]),
    (["run", "--duration", "nan"], 2, ["--duration"]),
    (["run", "--duration", "1e20"], 2, ["--duration: is 1e+20; expected a number above 0, up to 3162240000"]),
    (["check", "--duration", "3162240001"], 2, ["--duration: is 3162240001; expected a number above 0, up to 3162240000"]),
    (["check", "--start", "2199-12-31T00:00:00Z", "--duration", "3e9"], 2, ["2199-12-31", "2269"]),
    (["run", "--rate", "0"], 2, ["--rate: is 0; expected a number from 0.01 to 100"]),
    (["run", "--speed", "fast"], 2, ["--speed: is a text; expected a number from 0.001 to 1000000"]),
    (["run", "--rebase-nav"], 2, ["--rebase-nav", "--nav"]),
    (["run", "--sede", "1"], 2, ["--sede"]),
    (["run", "--set", "run.seed"], 2, ["--set 'run.seed': expected KEY=VALUE"]),
    (["check", "--set", "run.seed=1,2"], 2, ["--set run.seed: '1,2' is 2 values"]),
    (["check", "--set", "run.duratoin_s=5"], 2, ["run.duratoin_s: unknown key", "did you mean 'duration_s'"]),
    (["check", "--set", "receiver.0.rate_hz=1000"], 2, ["rate_hz", "1000", "0.01 to 100"]),
    (["check", "--set", "receiver.0.rate_hz=often"], 2, ["rate_hz: is a text"]),
    (["check", "--set", "receiver.1.rate_hz=5"], 2, ["the scenario has no receiver.1"]),
    (["trajectory", "track.gpx", "--set", "run.seed=1"], 2, ["--set is for scenarios"]),
    (["simulate", "--out", "x"], 2, ["--duration"]),
    (["simulate", "--duration", "1"], 2, ["--out"]),
    (["check", "/no/such/scenario.toml"], 1, ["/no/such/scenario.toml"]),
    (["sky", "--format", "png"], 2, ["--format", "svg"]),
    (["sky", "--height", "3"], 2, ["--height", "--grid"]),
    (["sky", "--duration", "3", "--tracks", "2", "--format", "csv"], 2, ["--duration", "--grid"]),
    (["sky", "--step", "60"], 2, ["--step", "--tracks or --grid"]),
    (["boards", "nothing"], 2, ["nothing"]),
    (["compare", "/no/a.csv", "/no/b.csv"], 1, ["/no/a.csv"]),
    (["run", "--scene", "demo", "--time-scale", "2"], 2, ["--time-scale: expected --trajectory TRACK"]),
    (["check", "--output", "json-udp:nowhere"], 2, ["--output: "]),
    (["check", "--board", "\udcff"], 2, ["--board: is no text in UTF-8"]),
    (["check", "--set", "run.seed=[1]"], 2, ["--set run.seed: is a list; expected a whole number"]),
    (["check", "--set", "sky.constellations=gps"], 2, ["--set sky.constellations: is a text; expected a list"]),
    (["run", "--seed", "-1"], 2, ["--seed: '-1'; expected a whole number from 0 to 18446744073709551615"]),
    (["run", "--seed", "0x10"], 2, ["--seed: '0x10'; expected a whole number"]),
    (["run", "--seed", "18446744073709551616"], 2, ["--seed: '18446744073709551616'; expected a whole number"]),
    (["run", "--seed", ""], 2, ["--seed: ''; expected a whole number"]),
    (["run", "--seed="], 2, ["--seed"]),
    (["run", "--seed", " 1"], 2, ["--seed: ' 1'; expected a whole number"]),
    (["run", "--seed", "1.5"], 2, ["--seed: '1.5'; expected a whole number"]),
    (["run", "--rate", ""], 2, ["--rate: ''; expected a number"]),
    (["run", "--rate", "0x10"], 2, ["--rate: '0x10'; expected a number"]),
    (["run", "--time-scale", "inf"], 2, ["--time-scale: 'inf'; expected a number"]),
    (["sky", "--mask", "nan"], 2, ["--mask: 'nan'; expected a number"]),
    (["sky", "--grid-size", "-4"], 2, ["--grid-size: '-4'; expected a whole number from 1 to 1000"]),
    (["sky", "--threads", "0"], 2, ["--threads: '0'; expected a whole number from 1 to 256"]),
    (["compare", "a", "b", "--reference", "47,8"], 2, ["--reference 47,8: expected LAT,LON,HEIGHT"]),
    (["compare", "a", "b", "--window", "-4"], 2, ["--window: '-4'; expected a whole number from 0 to"]),
    (["compare", "a", "b", "--window", "5", "--format", "svg"], 2, ["--window", "expected --format text or json"]),
    (["compare", "a", "b", "--skip-a", "0x10"], 2, ["--skip-a: '0x10'; expected a whole number"]),
    (["compare", "a", "b", "--every-b", "0"], 2, ["--every-b: '0'; expected a whole number from 1 to 1000000"]),
    (["campaign", "x.toml", "--run-limit", "nan"], 2, ["--run-limit: 'nan'; expected a number from 0.1 to 1e+09"]),
    (["campaign", "x.toml", "--jobs", "-1"], 2, ["--jobs: '-1'; expected a whole number from 1 to 1024"]),
    (["campaign", "replay", "x.toml", "--number", "-1"], 2, ["--number: '-1'; expected a whole number from 0 to"]),
    (["campaign", "report", "x", "--worst", "-1"], 2, ["--worst: '-1'; expected a whole number from 0 to 10000"]),
    (["replay", "/dev/null", "--baud", "-1"], 2, ["--baud: '-1'; expected a whole number from 110 to"]),
    (["trajectory", "x.csv", "--origin", "46,nan,3"], 2, ["--origin 46,nan,3: expected LAT,LON"]),
    (["ctl", "1", "step", "nan"], 2, ["step: 'nan' is no number"]),
    (["power", "line:/dev/no-such-tty/rts", "state"], 2, ["the state of a modem line cannot be asked", "expected on or off"]),
]

SCENARIO_MISTAKES = [
    ("[run]\nsede = 3\n", ["s.toml:2:1", "run.sede", "did you mean 'seed'"]),
    ("[model.modern]\npreset = \"consumr\"\n", ["s.toml:2", "model.modern.preset", "did you mean 'consumer'"]),
    ("[trajectory]\nkind = \"fixed\"\nat = [91, 0, 0]\n", ["s.toml:3", "latitude is 91"]),
    ("[trajectory]\nkind = \"fixed\"\nat_level = [1, 2, 3]\n", ["s.toml:3", "[frame]"]),
    ("[[atmosphere.cloud]]\nkind = \"thunderstrom\"\n", ["s.toml:2", "did you mean 'thunderstorm'"]),
    ("[sky]\nelevation_mask_deg = \"five\"\n", ["s.toml:2", "is a text", "number"]),
    ("[sky]\nelevation_mask_deg = nan\n", ["s.toml:2", "nan"]),
    ("[[fault]]\nkind = \"outtage\"\n", ["s.toml:2", "fault.kind", "did you mean 'outage'"]),
    ("[run\n", ["s.toml:1"]),
    ("[model.baseline]\nstatistic = \"mean\"\n", ["sample_std rms"]),
    ("[run]\nduration_s = 1e300\n", ["run.duration_s"]),
    ("[frame]\norigin = [46, 30, 0]\n[trajectory]\nkind = \"fixed\"\nat_level = [0, 0, 1e300]\n", ["s.toml:5", "at_level"]),
    ("[[receiver]]\nname = \"a\"\n[[receiver]]\nname = \"a\"\n", ["s.toml:3:1", "second receiver called 'a'"]),
    ("[[receiver]]\nboard = \"nmea-generic\"\n[receiver.config]\nCFG-RATE-MEAS = 200\n",
     ["s.toml:3:1: receiver.config: nmea-generic is no u-blox receiver"]),
    ("[[receiver]]\nbase = \"nobody\"\n", ["s.toml:2:8", "receiver.base", "'nobody'"]),
]


class CommandLineTest(unittest.TestCase):
    def assert_refused(self, arguments, code, words):
        done = skyloop(*arguments, check=False)
        self.assertEqual(done.returncode, code, f"{arguments}: {done.stderr}")
        for word in words:
            self.assertIn(word, done.stderr, arguments)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)

    def test_misuses_are_told_in_one_line(self):
        for arguments, code, words in MISUSES:
            with self.subTest(" ".join(arguments)):
                self.assert_refused(arguments, code, words)

    def test_leading_zeros_are_decimal(self):
        for text, seed in (("010", 10), ("08", 8), ("18446744073709551615", 2**64 - 1)):
            self.assertIn(f"seed        {seed}\n", skyloop("check", "--seed", text).stdout)

    def test_scenario_mistakes_name_line_and_key(self):
        with open_folder() as folder:
            path = pathlib.Path(folder, "s.toml")
            for text, words in SCENARIO_MISTAKES:
                with self.subTest(text):
                    path.write_text(text, encoding="utf-8")
                    self.assert_refused(["check", path], 2, words)

    def test_every_mistake_of_a_scenario_is_told(self):
        with open_folder() as folder:
            path = pathlib.Path(folder, "s.toml")
            path.write_text("[run]\nsede = 1\n[sky]\nmask = 3\n", encoding="utf-8")
            done = skyloop("check", path, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertEqual(len(done.stderr.splitlines()), 2, done.stderr)

    def test_broken_navigation_files_are_refused_in_one_line(self):
        broken = {"empty.10n": b"", "binary.10n": bytes(range(256)) * 64, "text.10n": b"hello\nworld\n" * 100,
                  "damaged.10n.gz": b"\x1f\x8b\x08\x00" + b"\x55" * 200}
        with open_folder() as folder:
            for name, content in broken.items():
                path = pathlib.Path(folder, name)
                path.write_bytes(content)
                with self.subTest(name):
                    self.assert_refused(["check", "--nav", path], 2, [name])

    def test_start_outside_the_data_is_one_warning_and_no_fix(self):
        navigation = SHARED / "nav/brdc1820.10n"
        if not navigation.exists():
            self.skipTest(f"shared data absent: {navigation}")
        with open_folder() as folder:
            done = skyloop("simulate", "--nav", navigation, "--start", "2020-01-01T00:00:00Z", "--duration", 5, "--out", folder)
            warnings = [line for line in done.stderr.splitlines() if "starts outside" in line]
            self.assertEqual(len(warnings), 1, done.stderr)
            self.assertIn("2010-06-30", warnings[0])
            rows = pathlib.Path(folder, "fixes.csv").read_text(encoding="ascii").splitlines()[1:]
            self.assertEqual(len(rows), 5)
            for row in rows:
                self.assertEqual(row.split(",")[17], "none")
                self.assertEqual(row.split(",")[6], "")
            rebased = skyloop("simulate", "--nav", navigation, "--start", "2020-01-01T12:00:00Z", "--duration", 5,
                              "--out", folder, "--rebase-nav")
            self.assertIn("5 with a fix", rebased.stderr)

    def test_foreign_record_is_dropped_with_a_warning(self):
        navigation = SHARED / "nav/brdc1820.10n"
        if not navigation.exists():
            self.skipTest(f"shared data absent: {navigation}")
        done = skyloop("check", "--nav", navigation)
        told = [line for line in done.stderr.splitlines() if "G01" in line and "dropped" in line]
        self.assertEqual(len(told), 1, done.stderr)

    def test_fewer_than_four_satellites_give_no_fix_and_the_run_goes_on(self):
        with open_folder() as folder:
            skyloop("simulate", "--duration", 5, "--start", "2026-01-01T00:00:00Z", "--out", folder, self.narrow_scenario(folder))
            rows = pathlib.Path(folder, "fixes.csv").read_text(encoding="ascii").splitlines()[1:]
            self.assertEqual([row.split(",")[17] for row in rows], ["none"] * 5)
            sent = pathlib.Path(folder, "port0.out").read_text(encoding="ascii")
            self.assertEqual(sent.count("GGA,"), 5)
            self.assertIn(",,,,,0,", sent)

    @staticmethod
    def narrow_scenario(folder):
        path = pathlib.Path(folder, "narrow.toml")
        path.write_text("[sky]\nelevation_mask_deg = 75\n", encoding="utf-8")
        return path

    def test_full_disk_is_told_and_ends_with_1(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("no /dev/full here")
        with open_folder() as folder:
            os.symlink("/dev/full", pathlib.Path(folder, "fixes.csv"))
            done = skyloop("simulate", "--duration", 7200, "--start", "2026-01-01T00:00:00Z", "--out", folder, check=False)
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertIn("fixes.csv", done.stderr)
            self.assertGreater(pathlib.Path(folder, "satellites.csv").stat().st_size, 1000)

    def test_full_wire_or_output_is_told_and_ends_with_1(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("no /dev/full here")
        with open_folder() as folder:
            done = skyloop("simulate", "--duration", 5, "--start", "2026-01-01T00:00:00Z", "--out", folder,
                           "--port", "file:/dev/full", check=False)
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertIn("/dev/full", done.stderr)
            port = json.loads(pathlib.Path(folder, "run.json").read_text(encoding="utf-8"))["ports"][0]
            self.assertEqual((port["bytes_out"], port["bytes_lost"]), (0, 0), port)
            self.assertGreater(port["bytes_unheard"], 0)
            done = skyloop("simulate", "--duration", 5, "--out", folder, "--output", "json-file:/dev/full", check=False)
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertIn("output 0 (json: /dev/full (file)): 0 messages, 0 bytes, 4 messages while", done.stderr)
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = subprocess.run([SKYLOOP, "sky", "--start", "2026-01-01T00:00:00Z"], stdout=full,
                                  stderr=subprocess.PIPE, text=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("standard output", done.stderr)

    def test_what_is_said_stays_out_of_files_where_streams_are_closed(self):
        def recorded(folder, streams):
            wire = pathlib.Path(folder, "wire.out")
            command = [SKYLOOP, "simulate", "--duration", "3", "--start", "2026-01-01T00:00:00Z", "--port", f"file:{wire}",
                       "--out", pathlib.Path(folder, "run")]
            subprocess.run(["sh", "-c", f'exec "$@" {streams}', "sh", *command], stderr=subprocess.DEVNULL, timeout=120,
                           check=True)
            files = [wire, *(pathlib.Path(folder, "run", name) for name in ("port0.out", "fixes.csv", "satellites.csv"))]
            return [file.read_bytes() for file in files]

        with open_folder() as folder:
            expected = recorded(folder, "")
            for streams in ("2>&-", "<&- 2>&-", "<&- >&- 2>&-"):
                with self.subTest(streams):
                    self.assertEqual(recorded(folder, streams), expected)
        for command, streams, said in (("sky", ">&-", "standard output: cannot be written: Bad file descriptor"),
                                       ("decode -", "<&-", "standard input: cannot be read: Bad file descriptor")):
            done = subprocess.run(["sh", "-c", f'exec "$0" {command} {streams}', SKYLOOP], stderr=subprocess.PIPE,
                                  stdout=subprocess.DEVNULL, text=True, timeout=120, check=False)
            self.assertEqual((done.returncode, said in done.stderr), (1, True), done.stderr)

    def test_a_run_that_nobody_hears_any_more_ends(self):
        def goes_on_without_reader(*options):
            command = [SKYLOOP, "run", "--model", "ideal", "--rate", "5", "--port", "-", *map(str, options)]
            with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
                process.stdout.read(100)
                process.stdout.close()
                try:
                    process.wait(timeout=5)
                    return False
                except subprocess.TimeoutExpired:
                    process.send_signal(signal.SIGTERM)
                    return True
                finally:
                    told = process.stderr.read().decode()
                    process.wait(timeout=20)
                    self.assertEqual(process.returncode, 1, told)
                    self.assertIn("standard output: writing failed: Broken pipe", told)

        self.assertFalse(goes_on_without_reader())
        with open_folder() as folder:
            for options in (("--record", folder), ("--control", 0), ("--port", "pty"), ("--output", f"json-file:{folder}/o.json")):
                self.assertTrue(goes_on_without_reader(*options), options)

    def test_simulated_bytes_wait_for_a_slow_reader(self):
        with open_folder() as folder:
            arguments = ["--duration", "1800", "--start", "2026-01-01T00:00:00Z", "--out", folder, "--port", "-"]
            with subprocess.Popen([SKYLOOP, "simulate", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
                with self.assertRaises(subprocess.TimeoutExpired):
                    process.wait(timeout=2)  # the pipe is full and nobody has read yet
                heard, told = process.communicate(timeout=120)
            self.assertEqual(process.returncode, 0, told)
            self.assertEqual(heard, pathlib.Path(folder, "port0.out").read_bytes())

    def test_a_run_that_does_not_end_leaves_no_summary_of_the_one_before(self):
        with open_folder() as folder:
            summary = pathlib.Path(folder, "run.json")
            summary.write_text("{}", encoding="utf-8")
            # A run that cannot begin leaves the former recording alone; one that begins and cannot end does not.
            skyloop("simulate", "--duration", 1, "--out", folder, "--port", "pty:/no/such/folder/gps0", check=False)
            self.assertTrue(summary.exists())
            with Emulator("--record", folder, "--port", f"pty:{folder}/gps0") as emulator:
                emulator.stop(signal.SIGKILL)
            self.assertFalse(json.loads(summary.read_text())["ended"], "a summary of an end that never came")

    def test_a_rate_that_no_receiver_can_do_is_told(self):
        self.assertIn("it runs at 0.01526 Hz", skyloop("check", "--rate", 0.01).stderr)
        self.assertNotIn("it runs at", skyloop("check", "--rate", 3).stderr)

    def test_the_digest_knows_what_the_trajectory_file_holds(self):
        digests = set()
        with open_folder() as folder:
            path = pathlib.Path(folder, "t.toml")
            for latitude in (46, 47):
                path.write_text(f"[trajectory]\nkind = \"fixed\"\nat = [{latitude}, 30, 0]\n", encoding="utf-8")
                skyloop("simulate", "--duration", 1, "--start", "2026-01-01T00:00:00Z", "--trajectory", path, "--out", folder)
                digests.add(json.loads(pathlib.Path(folder, "run.json").read_text(encoding="utf-8"))["scenario_digest"])
        self.assertEqual(len(digests), 2)

    def test_all_mistakes_are_reported_at_once(self):
        """In the file itself and in what it names: unknown keys, ranges, expectations, files, board and port."""
        text = """[run]
duratoin_s = 5
[sky]
navigation = "absent.rnx"
[trajectory]
kind = "file"
path = "absent.csv"
[model.modern.link]
antenna_table = "absent.atx"
[scene]
buildings = "absent.obj"
[[receiver]]
board = "m8"
port = "/dev/ttyUSB0"
rate_hz = 1000
[[expect]]
what = "the moon rises"
"""
        expected = [(2, "run.duratoin_s: unknown key; did you mean 'duration_s'?"),
                    (4, "sky.navigation: ", "absent.rnx: No such file or directory"),
                    (7, "trajectory.path: ", "absent.csv: No such file or directory"),
                    (9, "absent.atx: No such file or directory"),
                    (11, "scene.buildings: ", "absent.obj: No such file or directory"),
                    (13, "receiver.board: board 'm8' is not known; did you mean 'ublox-m8'?"),
                    (14, "receiver.port: port '/dev/ttyUSB0': no such kind of port; did you mean 'serial:/dev/ttyUSB0'?"),
                    (15, "receiver.rate_hz: is 1000; expected a number from 0.01 to 100"),
                    (17, "expect")]
        with open_folder() as name:
            path = pathlib.Path(name, "wrong.toml")
            path.write_text(text, encoding="utf-8")
            for command in (["check", path], ["simulate", path, "--duration", 1, "--out", f"{name}/out"], ["run", path]):
                with self.subTest(command[0]):
                    done = skyloop(*command, check=False)
                    self.assertEqual(done.returncode, 2, done.stderr)
                    lines = done.stderr.splitlines()
                    self.assertEqual(len(lines), len(expected), done.stderr)
                    for number, *words in expected:
                        line = next((one for one in lines if one.startswith(f"skyloop: {path}:{number}:")), None)
                        self.assertIsNotNone(line, f"nothing of line {number}: {done.stderr}")
                        for word in words:
                            self.assertIn(word, line)

    def test_a_key_that_is_set_is_the_same_as_in_the_file(self):
        scenario = "[run]\nstart = 2026-03-01T00:00:00Z\nduration_s = 30\n"
        key = "[model.modern.terms.multipath]\nscale = 2\n[[receiver]]\nrate_hz = 5\n"
        with open_folder() as name:
            folder = pathlib.Path(name)
            (folder / "plain.toml").write_text(scenario, encoding="utf-8")
            (folder / "key.toml").write_text(scenario + key, encoding="utf-8")
            skyloop("simulate", folder / "key.toml", "--out", folder / "key")
            skyloop("simulate", folder / "plain.toml", "--out", folder / "set", "--set",
                    "model.modern.terms.multipath.scale=2", "--set", "receiver.0.rate_hz=5")
            skyloop("simulate", folder / "plain.toml", "--out", folder / "plain")
            for file in ("port0.out", "fixes.csv", "satellites.csv", "observations.rnx"):
                by_key, by_option, without = ((folder / run / file).read_bytes() for run in ("key", "set", "plain"))
                self.assertEqual(by_key, by_option, file)
                self.assertNotEqual(by_key, without, file)

    def test_an_option_is_the_key_that_it_names(self):
        scenario = "[run]\nstart = 2026-03-01T00:00:00Z\n"
        options = ["--duration", "20", "--rate", "5", "--board", "ublox-m9", "--at", "047,.8e1,400", "--start", "2026-03-02"]
        keys = ["run.duration_s=20", "receiver.0.rate_hz=5", "receiver.0.board=ublox-m9", "trajectory.kind=fixed",
                "trajectory.at=[47, 8, 400]", "run.start=2026-03-02"]
        with open_folder() as name:
            folder = pathlib.Path(name)
            (folder / "s.toml").write_text(scenario, encoding="utf-8")
            skyloop("simulate", folder / "s.toml", "--out", folder / "option", *options)
            skyloop("simulate", folder / "s.toml", "--out", folder / "set", *(word for key in keys for word in ("--set", key)))
            skyloop("simulate", folder / "s.toml", "--out", folder / "plain", "--duration", "20")
            for file in ("port0.out", "fixes.csv", "satellites.csv", "observations.rnx"):
                by_option, by_key, without = ((folder / run / file).read_bytes() for run in ("option", "set", "plain"))
                self.assertEqual(by_option, by_key, file)
                self.assertNotEqual(by_option, without, file)

    def test_an_option_goes_before_set_and_a_relative_path_begins_here(self):
        with open_folder() as name:
            folder = pathlib.Path(name)
            (folder / "scenarios").mkdir()
            (folder / "scenarios" / "s.toml").write_text("[run]\nduration_s = 1\n", encoding="utf-8")
            (folder / "track.csv").write_text("t_s,lat_deg,lon_deg,h_ell_m\n0,47,8,400\n9,47.001,8,400\n", encoding="utf-8")
            before = os.getcwd()
            os.chdir(folder)
            try:
                done = skyloop("check", "scenarios/s.toml", "--set", "receiver.0.rate_hz=2", "--rate", "5",
                               "--trajectory", "track.csv", "--skip", "2")
                self.assertIn("5 Hz", done.stdout)
                self.assertIn("track.csv", done.stdout)
                done = skyloop("check", "scenarios/s.toml", "--trajectory", "track.csv", "--skip", "-1", check=False)
                self.assertEqual((done.returncode, done.stderr),
                                 (2, "skyloop: --skip: is -1; expected a number from 0 to 1000000000\n"))
            finally:
                os.chdir(before)

    def test_run_json_tells_what_ran(self):
        with open_folder() as folder:
            skyloop("simulate", "--duration", 10, "--start", "2026-01-01T00:00:00Z", "--seed", 5, "--out", folder)
            summary = json.loads(pathlib.Path(folder, "run.json").read_text(encoding="utf-8"))
        self.assertEqual(summary["seed"], 5)
        self.assertEqual(summary["epochs"], 10)
        self.assertEqual(summary["epochs_with_fix"], 10)
        self.assertRegex(summary["scenario_digest"], "^[0-9a-f]{16}$")

    def test_sky_formats(self):
        arguments = ["--at", "46.4775,30.7326,77", "--start", "2026-01-01T00:00:00Z"]
        listing = json.loads(skyloop("sky", *arguments, "--format", "json").stdout)
        self.assertGreaterEqual(len(listing["satellites"]), 6)
        csv = skyloop("sky", *arguments, "--format", "csv").stdout.splitlines()
        self.assertEqual(len(csv), len(listing["satellites"]) + 1)
        svg = skyloop("sky", *arguments, "--format", "svg").stdout
        for satellite in listing["satellites"]:
            self.assertIn(f">{satellite['satellite']}<", svg)
        tracks = skyloop("sky", *arguments, "--tracks", 46, "--step", 3600, "--format", "csv").stdout.splitlines()
        self.assertEqual(tracks[0], "time_utc,satellite,x_m,y_m,z_m")
        self.assertEqual(len(tracks), 1 + 146 * 47)


if __name__ == "__main__":
    unittest.main(verbosity=2)
