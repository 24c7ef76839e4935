"""What a run does when it is killed, stopped by the system, starved of time or of disk: what it recorded can be read."""
import csv
import datetime
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import time
import unittest

from session import ROOT, SKYLOOP, Emulator, open_folder, skyloop

KILLS = int(os.environ.get("SKYLOOP_KILLS", "6"))
PLACE = ("--at", "46.4775,30.7326,77", "--start", "2026-03-01T12:00:00Z")
RATE_HZ = 10
RUN = ("--board", "ublox-m9", "--rate", RATE_HZ, *PLACE)


def rows(path):
    """Rows of a table, without a last one that has been cut."""
    text = path.read_text(encoding="ascii")
    whole = text[:text.rfind("\n") + 1]
    return list(csv.DictReader(whole.splitlines()))


class KilledTest(unittest.TestCase):
    def read_back(self, folder, out):
        """What is left is a recording: its rows are whole, and replay, decode, compare and --repeat take it."""
        summary = json.loads((folder / "run.json").read_text())
        self.assertFalse(summary["ended"])
        fixes = rows(folder / "fixes.csv")
        times = [float(row["tow_s"]) for row in fixes]
        self.assertEqual({round((b - a) * RATE_HZ) for a, b in zip(times, times[1:])} - {1}, set(), "an epoch is missing")
        sent, written = (folder / "port0.out").read_bytes(), out.read_bytes()
        self.assertTrue(written.startswith(sent) or sent.startswith(written), "recorded other bytes than were sent")
        if sent:
            again = folder / "again.bin"
            skyloop("replay", folder, "--port", f"file:{again}", "--speed", 1000, "--duration", 1000)
            replayed = again.read_bytes()
            self.assertTrue(sent.startswith(replayed), "replays other bytes than were recorded")
            self.assertGreater(len(replayed), len(sent) - 5000)
            self.assertIn(" 0 bad", skyloop("decode", folder / "port0.out").stderr)
        if len(fixes) > 1:
            skyloop("compare", folder / "fixes.csv", folder / "fixes.csv")
        skyloop("simulate", "--repeat", folder, *RUN, "--duration", 1, "--out", folder / "repeated")
        return len(fixes)

    def test_at_any_instant_the_recording_stays_readable(self):
        draw = random.Random(1)
        epochs = 0
        for kill in range(KILLS):
            with open_folder() as name, self.subTest(kill=kill):
                folder = pathlib.Path(name)
                with Emulator("--port", f"file:{folder / 'out.bin'}", *RUN, "--speed", 5, "--record", folder / "run") as emulator:
                    time.sleep(draw.uniform(0, 2.5))
                    emulator.process.send_signal(signal.SIGKILL)
                    emulator.finish()
                epochs += self.read_back(folder / "run", folder / "out.bin")
        self.assertGreater(epochs, 0)

    def test_a_killed_simulation_leaves_no_summary_of_an_end(self):
        with open_folder() as name:
            folder = pathlib.Path(name, "run")
            skyloop("simulate", *RUN, "--duration", 5, "--out", folder)
            self.assertTrue(json.loads((folder / "run.json").read_text())["ended"])
            process = subprocess.Popen([SKYLOOP, "simulate", *map(str, RUN), "--duration", "1000000",
                                        "--out", str(folder)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            try:
                end = time.monotonic() + 30
                while not (folder / "fixes.csv").stat().st_size > 100000 and time.monotonic() < end:
                    time.sleep(0.02)
            finally:
                process.kill()
                process.wait(timeout=20)
            self.assertFalse(json.loads((folder / "run.json").read_text())["ended"])
            self.assertGreater(len(rows(folder / "fixes.csv")), 100)


class StarvedTest(unittest.TestCase):
    def lateness(self, folder):
        return json.loads((folder / "run.json").read_text())["lateness"]

    def check_epochs(self, folder, least):
        times = [float(row["tow_s"]) for row in rows(folder / "fixes.csv")]
        self.assertGreater(len(times), least)
        self.assertEqual({round((b - a) * RATE_HZ) for a, b in zip(times, times[1:])}, {1}, "order or an epoch is lost")

    def test_a_stopped_process_goes_on_late_whole_and_in_order(self):
        with open_folder() as name:
            folder = pathlib.Path(name)
            with Emulator("--port", "pty", *RUN, "--record", folder) as emulator:
                time.sleep(1)
                emulator.process.send_signal(signal.SIGSTOP)
                time.sleep(1.5)
                emulator.process.send_signal(signal.SIGCONT)
                time.sleep(1.5)
                self.assertEqual(emulator.stop(), 0, emulator.log)
            self.check_epochs(folder, 25)
            self.assertGreater(self.lateness(folder)["largest_ms"], 1000)
            times = [line.split() for line in (folder / "port0.times").read_text().splitlines()]
            # Monotonic and simulated time of the last bytes run side by side again: the lag has been made up for.
            lags = [(int(row[0]) - int(times[0][0])) - (int(row[1]) - int(times[0][1])) for row in times]
            self.assertLess(abs(lags[-1]), 0.3e9)

    def test_beside_ten_greedy_processes_order_is_kept_and_lateness_told(self):
        with open_folder() as name:
            folder = pathlib.Path(name)
            greedy = [subprocess.Popen(["sh", "-c", "while :; do :; done"]) for _ in range(10 * (os.cpu_count() or 1))]
            try:
                with Emulator("--port", "pty", *RUN, "--record", folder) as emulator:
                    time.sleep(4)
                    self.assertEqual(emulator.stop(), 0, emulator.log)
            finally:
                for process in greedy:
                    process.kill()
                    process.wait(timeout=20)
            self.check_epochs(folder, 20)
            self.assertIn("largest_ms", self.lateness(folder))


class ClockTest(unittest.TestCase):
    def test_a_step_of_the_systems_clock_moves_nothing(self):
        compiler = shutil.which("cc") or self.skipTest("there is no C compiler for the clock that is stepped")
        with open_folder() as name:
            folder, step, library = pathlib.Path(name), pathlib.Path(name, "step"), pathlib.Path(name, "clock.so")
            subprocess.run([compiler, "-shared", "-fPIC", "-o", library, ROOT / "tests/support/stepped_clock.c", "-ldl"], check=True)
            command = [SKYLOOP, "run", "--port", "pty", "--board", "ublox-m9", "--rate", "10", "--at", "46.4775,30.7326,77", "--start",
                       "now", "--duration", "4", "--record", str(folder / "run"), "--quiet"]
            stepped = {**os.environ, "LD_PRELOAD": str(library), "SKYLOOP_CLOCK_STEP": str(step)}
            dated = datetime.datetime.now(datetime.timezone.utc) + datetime.timedelta(hours=1)
            step.write_text("3600")
            began = time.monotonic()
            process = subprocess.Popen(command, env=stepped, stderr=subprocess.DEVNULL)
            for pause, seconds in ((1.5, "86400"), (1, "-86400")):
                time.sleep(pause)
                step.write_text(seconds)
            self.assertEqual(process.wait(timeout=60), 0)
            self.assertGreater(time.monotonic() - began, 3.9)
            start = datetime.datetime.fromisoformat(json.loads((folder / "run/run.json").read_text())["start_utc"].replace("Z", "+00:00"))
            self.assertLess(abs((start - dated).total_seconds()), 20, "the clock that is stepped is not the one it reads")
            times = [float(row["tow_s"]) for row in rows(folder / "run/fixes.csv")]
            self.assertEqual(len(times), 40)
            self.assertEqual({round((b - a) * RATE_HZ) for a, b in zip(times, times[1:])}, {1})
            left = [int(line.split()[0]) for line in (folder / "run/port0.times").read_text().splitlines()]
            self.assertEqual(left, sorted(left))


class DiskTest(unittest.TestCase):
    def test_a_disk_that_fills_up_ends_the_run_with_a_sentence_and_keeps_what_came_before(self):
        if os.geteuid() != 0:
            self.skipTest("only root may mount a small disk")
        with open_folder() as name:
            folder = pathlib.Path(name)
            mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", folder], capture_output=True, text=True)
            if mounted.returncode != 0:
                self.skipTest(f"no small disk can be mounted: {mounted.stderr.strip()}")
            try:
                done = skyloop("simulate", *RUN, "--duration", 600, "--out", folder / "run", check=False)
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertRegex(done.stderr, r"cannot be written: No space left on device; what was written before is kept")
                self.assertGreater(len(rows(folder / "run" / "satellites.csv")), 100)
                self.assertFalse(json.loads((folder / "run" / "run.json").read_text())["ended"])
                subprocess.run(["mount", "-o", "remount,ro", folder], check=True)
                done = skyloop("simulate", *RUN, "--duration", 5, "--out", folder / "other", check=False)
                self.assertEqual(done.returncode, 1)
                self.assertRegex(done.stderr, "Read-only file system")
            finally:
                subprocess.run(["umount", folder], check=True)


if __name__ == "__main__":
    unittest.main(verbosity=2)
