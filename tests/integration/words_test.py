"""The words of a command line: values that are missing, empty or out of range, options at the wrong place, and help."""
import fcntl
import json
import os
import pathlib
import pty
import re
import signal
import struct
import subprocess
import termios
import unittest

from session import SKYLOOP, open_folder, skyloop

# Arguments, and what the one line says.
MISUSES = [
    # A variable of a script that is not set leaves nothing behind; nobody means the default by it.
    (["check", "--at", ""], "skyloop: --at: ''; expected LAT,LON[,HEIGHT]; see skyloop check --help"),
    (["check", "--start", ""], "skyloop: --start: ''; expected TIME; see skyloop check --help"),
    (["check", "--nav", ""], "skyloop: --nav: ''; expected FILE; see skyloop check --help"),
    (["check", "--model", ""], "skyloop: --model: ''; expected one of modern ideal constant-sigma satellite-count whole-path refraction baseline; "
     "see skyloop check --help"),
    (["check", "--state", ""], "skyloop: --state: ''; expected FILE; see skyloop check --help"),
    # Standard output is where a command says what it has to say.
    (["scene", "demo", "--svg", "-"],
     "skyloop: --svg: '-' is not standard output here; expected FILE, or ./- for that name; see skyloop scene --help"),
    (["simulate", "--duration", "1", "--out", "-"],
     "skyloop: --out: '-' is not standard output here; expected DIR, or ./- for that name; see skyloop simulate --help"),
    (["check", "--state", "-"],
     "skyloop: --state: '-' is not standard output here; expected FILE, or ./- for that name; see skyloop check --help"),
    (["check", ""], "skyloop: SCENARIO: ''; expected SCENARIO; see skyloop check --help"),
    (["simulate", "--duration", "1", "--out", ""], "skyloop: --out: ''; expected DIR; see skyloop simulate --help"),
    (["run", "--scene=", "s.toml"], "skyloop: --scene: a value is missing behind '='"),
    (["run", "--seed=", "--quiet"], "skyloop: --seed: a value is missing behind '='"),
    # What follows an option without its value is no value.
    (["simulate", "s.toml", "--out", "--quiet"],
     "skyloop: --out: '--quiet' is an option; expected DIR; see skyloop simulate --help"),
    (["simulate", "s.toml", "--out"], "skyloop: --out: a value is missing; expected DIR; see skyloop simulate --help"),
    (["campaign", "report", "c", "--out"],
     "skyloop: --out: a value is missing; expected FILE; see skyloop campaign report --help"),
    (["check", "--seed", "1", "--seed", "2", "--seed", "3"],
     "skyloop: --seed: is there 3 times; expected it once; see skyloop check --help"),
    (["sky", "--mask", "95"], "skyloop: --mask: is 95; expected a number from 0 to 90"),
    (["replay", "r", "--speed", "0"], "skyloop: --speed: '0'; expected a number from 0.001 to 1000; see skyloop replay --help"),
    (["sky", "--format", "jsn"],
     "skyloop: --format: 'jsn'; expected one of text json csv svg; did you mean 'json'?; see skyloop sky --help"),
    (["solve", "o", "--systems", "gsp"],
     "skyloop: --systems: 'gsp'; expected one of gps sbas galileo beidou qzss glonass navic; did you mean 'gps'?; "
     "see skyloop solve --help"),
    # Options that the command does not have.
    (["run", "--durration", "5"], "skyloop: run has no option --durration; did you mean '--duration'?; see skyloop run --help"),
    (["run", "--out", "x"], "skyloop: run has no option --out; did you mean '--record'?; see skyloop run --help"),
    (["simulate", "--record=x", "--out", "y"],
     "skyloop: simulate has no option --record; did you mean '--out'?; see skyloop simulate --help"),
    (["check", "--speed", "3"],
     "skyloop: check has no option --speed, which is one of run, replay, trajectory; see skyloop check --help"),
    (["--seed", "3", "run"],
     "skyloop: '--seed' stands before the command; expected skyloop COMMAND, then its options; see skyloop --help"),
    (["check", "--start", "2026-03-01", "s.toml", "12:00:00"],
     "skyloop: '12:00:00' is one word too many; see skyloop check --help"),
    (["replay"], "skyloop: RECORDING is required; see skyloop replay --help"),
    (["run", "--token", "x"], "skyloop: --token requires --control; see skyloop run --help"),
    (["power"], "skyloop: URI is required; see skyloop power --help"),
    (["faults", "jamming", "--format", "markdown"],
     "skyloop: faults: --format markdown lists all of them; expected text or json beside a NAME"),
    (["boards", "ublox-m88"],
     "skyloop: board 'ublox-m88' is not known; did you mean 'ublox-m8'?"),
    (["boards", "MAX-M8"], "skyloop: board 'MAX-M8' is not known; did you mean 'ublox-m8'?"),
    (["check", "--board", "m8"], "skyloop: --board: board 'm8' is not known; did you mean 'ublox-m8'?"),
    (["run", "--port", "/dev/ttyUSB0"],
     "skyloop: --port: port '/dev/ttyUSB0': no such kind of port; did you mean 'serial:/dev/ttyUSB0'?"),
    (["run", "--port", "2000"], "skyloop: --port: port '2000': no such kind of port; did you mean 'tcp:2000'?"),
    (["run", "--port", "gps0"], "skyloop: --port: port 'gps0': no such kind of port; did you mean 'pty:gps0'?"),
]


class WordsTest(unittest.TestCase):
    def test_misuses_are_told_in_one_line(self):
        with open_folder() as folder:
            before = os.getcwd()
            os.chdir(folder)
            try:
                for arguments, line in MISUSES:
                    with self.subTest(" ".join(arguments)):
                        done = skyloop(*arguments, check=False)
                        self.assertEqual((done.returncode, done.stderr), (2, line + "\n"))
                self.assertEqual(os.listdir("."), [])
            finally:
                os.chdir(before)

    def test_an_option_for_another_program_may_look_like_one(self):
        done = skyloop("campaign", "/no/such.toml", "--out", "x", "--engine", "slurm", "--sbatch-option=--account=lab", check=False)
        self.assertEqual((done.returncode, done.stderr), (1, "skyloop: /no/such.toml: No such file or directory\n"))

    def test_help_is_a_command_too(self):
        self.assertEqual(skyloop("help").stdout, skyloop("--help").stdout)
        self.assertEqual(skyloop("help", "sky").stdout, skyloop("sky", "--help").stdout)
        self.assertEqual(skyloop("help", "campaign", "plan").stdout, skyloop("campaign", "plan", "--help").stdout)
        done = skyloop("help", "siumlate", check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("did you mean 'simulate'?", done.stderr)

    def test_help_names_values_and_fits(self):
        for command in re.findall(r"^  ([a-z-]+) ", skyloop("--help").stdout.split("Subcommands:")[1], re.MULTILINE):
            shown = skyloop(command, "--help").stdout
            self.assertNotRegex(shown, "TEXT:|FLOAT|UINT|INT in", command)
            for line in shown.split("Options:")[1].split("\n\n")[0].splitlines():
                self.assertTrue(len(line) <= 100 or " " not in line.strip(), line)
        shown = skyloop("sky", "--help").stdout
        self.assertIn("Usage: skyloop sky [OPTIONS] [SCENARIO]\n", shown)
        self.assertRegex(shown, r"\n  --mask N +Elevation mask: a satellite exactly at it is used, °;\s+0\s+to\s+90;\s+default\s+the\s+board's")
        self.assertIn("\n  --at LAT,LON[,HEIGHT]       Stand still there:", shown)
        self.assertRegex(shown, r"--height N +Of the map's .*\n.*; with --grid\n")

    def test_boards_are_a_table(self):
        lines = skyloop("boards").stdout.splitlines()
        self.assertGreater(len(lines), 10)
        self.assertEqual(len({re.match(r"\S+ +", line).end() for line in lines}), 1, lines)

    def test_one_fault_as_json(self):
        one = json.loads(skyloop("faults", "jamming", "--format", "json").stdout)
        self.assertEqual(one, next(kind for kind in json.loads(skyloop("faults", "--format", "json").stdout)
                                   if kind["name"] == "jamming"))

    def test_files_that_do_not_fit_are_told(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("no /dev/full here")
        full = "/dev/full: cannot be written: No space left on device; what was written before is kept\n"
        done = skyloop("scene", "demo", "--at", "46,30", "--svg", "/dev/full", check=False)
        self.assertEqual((done.returncode, done.stderr), (1, f"skyloop: {full}"))
        done = skyloop("scene", "demo", "--at", "46,30", "--svg", "/no/such/x.svg", check=False)
        self.assertEqual((done.returncode, done.stderr),
                         (1, "skyloop: /no/such/x.svg: cannot be written: No such file or directory\n"))
        with open_folder() as folder:
            skyloop("simulate", "--start", "2026-01-01T00:00:00Z", "--duration", 60, "--out", folder)
            for name in ("scenario.toml", "track.csv"):
                out = pathlib.Path(folder, name.split(".")[0])
                out.mkdir()
                os.symlink("/dev/full", out / name)
                done = skyloop("scenario-from", f"{folder}/port0.out", "--out", out, check=False)
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertIn(f"{out / name}: cannot be written: No space left on device", done.stderr)

    def test_a_figure_of_errors_about_different_places_says_so(self):
        with open_folder() as folder:
            skyloop("simulate", "--start", "2026-01-01T00:00:00Z", "--duration", 60, "--out", folder)
            told = skyloop("compare", f"{folder}/fixes.csv", f"{folder}/port0.out", "--format", "svg")
            self.assertIn("warning: ", told.stderr)
            self.assertIn("errors are about the mean of the file itself", told.stderr)

    def test_the_folder_of_a_run_stands_for_its_fixes(self):
        with open_folder() as folder:
            skyloop("simulate", "--start", "2026-01-01T00:00:00Z", "--duration", 60, "--out", folder)
            self.assertEqual(skyloop("compare", folder, f"{folder}/port0.out").stdout,
                             skyloop("compare", f"{folder}/fixes.csv", f"{folder}/port0.out").stdout)
        with open_folder() as empty:
            done = skyloop("compare", empty, empty, check=False)
            self.assertEqual((done.returncode, done.stderr), (1, f"skyloop: {empty}/fixes.csv: No such file or directory\n"))

    def test_progress_stays_on_its_line(self):
        for columns in (80, 40):
            leader, terminal = pty.openpty()
            fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
            with open_folder() as folder:
                command = [SKYLOOP, "run", "--start", "2026-01-01T00:00:00Z", "--duration", "2", "--port", f"pty:{folder}/gps0"]
                with subprocess.Popen(command, stderr=terminal, stdin=subprocess.DEVNULL) as process:
                    os.close(terminal)
                    shown = b""
                    try:
                        while piece := os.read(leader, 4096):
                            shown += piece
                    except OSError:  # as a terminal ends
                        pass
                self.assertEqual(process.returncode, 0, shown)
            os.close(leader)
            lines = [line.split(b"\r")[0] for line in shown.split(b"\r\x1b[K")[1:]]
            self.assertIn(b"fix 3d", lines[0])
            for line in lines[:-1]:
                self.assertLess(len(line), columns, line)

    def test_a_listing_that_nobody_reads_on_ends_quietly(self):
        with open_folder() as folder:
            skyloop("simulate", "--start", "2026-01-01T00:00:00Z", "--duration", 600, "--out", folder)
            for arguments in (["decode", f"{folder}/port0.out"], ["schema"]):
                with subprocess.Popen([SKYLOOP, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
                    process.stdout.read(10)
                    process.stdout.close()
                    self.assertEqual((process.stderr.read(), process.wait(timeout=60)), (b"", -signal.SIGPIPE))

    def test_words_that_nobody_reads_end_no_run(self):
        with open_folder() as folder:
            command = [SKYLOOP, "simulate", "--start", "2026-01-01T00:00:00Z", "--duration", "5", "--out", f"{folder}/out"]
            reader, writer = os.pipe()
            os.close(reader)
            with open("/dev/full", "wb") as full, open(writer, "wb") as broken:
                for unheard in (full, broken):
                    run = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=unheard, timeout=60, check=False)
                    self.assertEqual(run.returncode, 0)
                run = subprocess.run([SKYLOOP, "boards"], stdout=full, stderr=full, timeout=60, check=False)
                self.assertEqual(run.returncode, 1, "its output was not written")

    def test_a_simulation_that_is_stopped_ends_in_order_and_says_so(self):
        with open_folder() as folder:
            command = [SKYLOOP, "simulate", "--start", "2026-01-01T00:00:00Z", "--duration", "1e7", "--out", folder]
            with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
                fixes = pathlib.Path(folder, "fixes.csv")
                while process.poll() is None and not (fixes.exists() and fixes.stat().st_size > 0):
                    pass
                process.send_signal(signal.SIGINT)
                told = process.communicate(timeout=60)[1]
            self.assertEqual(process.returncode, 0, told)
            self.assertRegex(told, r"skyloop: warning: stopped by a signal after \d+\.\d{3} s of the run: what is recorded ends there")
            summary = json.loads(pathlib.Path(folder, "run.json").read_text(encoding="utf-8"))
            self.assertEqual((summary["ended"], summary["cut"]), (True, True))
            self.assertEqual(summary["epochs"], len(fixes.read_text(encoding="ascii").splitlines()) - 1)


if __name__ == "__main__":
    unittest.main(verbosity=2)
