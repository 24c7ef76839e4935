"""Each board with each scripted client for a day of simulated time, with a jammer, a freeze, a silence and a lost configuration:
it ends as it should, its recording is whole, and neither memory nor open files grow.

SKYLOOP_SOAK_HOURS: simulated hours of each pair; a tenth of one by default."""
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import time
import unittest

from growth import SKYLOOP, Growth, open_folder, septentrio_that_sends, skyloop

HOURS = float(os.environ.get("SKYLOOP_SOAK_HOURS", "0.1"))
SCENARIO = pathlib.Path(__file__).with_name("day.toml")
CLIENTS = ("careful-ubx", "naive-ubx", "careful-nmea", "naive-nmea")
# Of these `decode` knows the bytes.
DECODED = ("ublox", "nmea", "mtk", "airoha")
BETWEEN_LOOKS_S = 0.01
SAVER = """[run]
start = 2026-03-01T00:00:00Z
duration_s = {duration}
[[receiver]]
board = "{board}"
[receiver.config]
CFG-PM-OPERATEMODE = 1
CFG-PM-POSUPDATEPERIOD = 30
CFG-PM-ONTIME = 2
CFG-PM-UPDATEEPH = false
"""


def boards():
    """Names of all."""
    return [line.split()[0] for line in skyloop("boards").stdout.splitlines()]


def watched(command, out):
    """Runs it to its end; gives its exit code, what it said and how it grew since its recording in `out` began."""
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
        growth = Growth(process.pid)
        pause = BETWEEN_LOOKS_S
        while process.poll() is None:
            if any(out.glob("*")):
                growth.look()
            time.sleep(pause)
            pause = min(pause * 1.01, 1)  # a long run is looked at less often
        return process.returncode, process.stderr.read(), growth


def times(path):
    """Seconds of the week, or of the run, in the order of the rows."""
    with open(path, encoding="ascii") as file:
        column = next(file).split(",").index("tow_s")
        return [float(line.split(",")[column]) for line in file]


def steps_back(path):
    """Epochs that do not come after the one before them; the week's end is one of the run's."""
    told = times(path)
    return sum(1 for before, after in zip(told, told[1:]) if after <= before and before - after < 604000), len(told)


def day(board, client):
    """What is wrong with one pair, and a line of what was seen."""
    with open_folder() as name:
        out = pathlib.Path(name, "out")
        profile = septentrio_that_sends(name, "PVTGeodetic", "DOP") if board == "septentrio-sbf" else board
        code, said, growth = watched([SKYLOOP, "simulate", str(SCENARIO), "--board", str(profile), "--port",
                                      f"client:{client}", "--duration", str(HOURS * 3600), "--out", str(out)], out)
        wrong = [] if code == 0 else [f"ended {code}: {said}"]
        if growth.fault():
            wrong.append(growth.fault())
        if code != 0:
            return wrong, said
        run = json.loads((out / "run.json").read_text())
        back, epochs = steps_back(out / "fixes.csv")
        if not run["ended"] or abs(run["simulated_s"] - HOURS * 3600) > 1 or epochs != run["epochs"]:
            wrong.append(f"run.json tells {run['simulated_s']} s and {run['epochs']} epochs, fixes.csv has {epochs}")
        if back:
            wrong.append(f"time ran backwards {back} times")
        # Unicore's with N4 chips are silent until they are asked in words of their own; a BS has nothing to say of a model that
        # measures nothing.
        if run["ports"][0]["bytes_out"] == 0 and not board.startswith(("unicore-um", "quectel-lc29h-bs")):
            wrong.append("not a byte was sent")
        if board.startswith(DECODED):
            told = skyloop("decode", out / "port0.out", patience=600).stderr
            if re.search(r"[1-9]\d* bad", told):
                wrong.append(told)
        return wrong, f"{epochs} epochs, {run['ports'][0]['bytes_out']} bytes out; {growth}"


def saving_day(board):
    """What is wrong with a day of a receiver that goes on and off twice a minute, and a line of what was seen."""
    with open_folder() as name:
        path = pathlib.Path(name, "saver.toml")
        path.write_text(SAVER.format(board=board, duration=HOURS * 3600))
        out = pathlib.Path(name, "out")
        code, said, growth = watched([SKYLOOP, "simulate", str(path), "--out", str(out)], out)
        wrong = [] if code == 0 else [f"ended {code}: {said}"]
        if growth.fault():
            wrong.append(growth.fault())
        starts = (out / "port0.out").read_bytes().count(b"PROTVER")
        if code == 0 and starts < HOURS * 3600 / 30 - 2:
            wrong.append(f"it came on {starts} times")
        return wrong, f"{starts} starts; {growth}"


class SimulatedDays(unittest.TestCase):
    def test_a_receiver_that_saves_power(self):
        for board in ("ublox-m8", "ublox-m10"):
            with self.subTest(board):
                wrong, seen = saving_day(board)
                print(f"{board:18} {'saves power':13} {seen}", flush=True)
                self.assertEqual(wrong, [])

    def test_each_board_with_each_client(self):
        pairs = [(board, client) for board in boards() for client in CLIENTS]
        self.assertGreaterEqual(len(pairs), 44)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            days = [(pair, pool.submit(day, *pair)) for pair in pairs]
            for pair, one in days:
                with self.subTest(" with ".join(pair)):
                    wrong, seen = one.result()
                    print(f"{pair[0]:18} {pair[1]:13} {seen}", flush=True)
                    self.assertEqual(wrong, [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
