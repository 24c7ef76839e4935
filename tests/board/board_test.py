"""A driver on a microcontroller, joined to the receiver by its UART: it finds the speed, configures, follows every epoch,
sees outages and silence, and says so when nobody answers. The numbers that it reports are those of fixes.csv.
"""
import csv
import os
import pathlib
import statistics
import sys
import tempfile
import unittest

import emulated_board
from emulated_board import Board

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "integration"))
from session import Emulator, skip  # noqa: E402

ARTIFACTS = pathlib.Path(os.environ.get("SKYLOOP_ARTIFACTS", tempfile.gettempdir()))
SCENARIO = """
[run]
start = 2026-03-01T09:30:00Z
duration_s = {seconds}
seed = 3

[trajectory]
kind = "circle"
centre = [47.3978, -8.5456, 540]
radius_m = 80
speed_mps = 8

[[receiver]]
board = "{board}"
{receiver}
{faults}
"""
# Units of fixes.csv in one of NAV-PVT's; half a unit is its resolution, the rest fixes.csv's last digit.
RESOLUTION = {"lon_deg": (4, 1e7, 0.51), "lat_deg": (5, 1e7, 0.51), "height_m": (6, 1e3, 0.56),
              "vel_north_mps": (10, 1e3, 0.56), "vel_east_mps": (11, 1e3, 0.56), "vel_down_mps": (12, 1e3, 0.56)}
FIX_TYPES = {"none": (0, False), "dead_reckoning": (1, None), "2d": (2, True), "3d": (3, True)}
ITOW, FIX_TYPE, FLAGS, HEIGHT_MSL = 0, 1, 2, 7


def fault(kind, at, seconds):
    return f'[[fault]]\nkind = "{kind}"\nat_s = {at}\nfor_s = {seconds}\n'


class BoardTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="skyloop-board-")
        cls.program = emulated_board.build(cls.folder.name)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        self.out = pathlib.Path(self.folder.name, self.id().rpartition(".")[2])
        self.out.mkdir()

    def emulator(self, board, seconds, receiver="", faults=""):
        scenario = self.out / "scenario.toml"
        scenario.write_text(SCENARIO.format(board=board, seconds=seconds, receiver=receiver, faults=faults))
        return Emulator(scenario, "--port", f"pty:{self.out}/gps0", "--wait-for-client", "--record", self.out / "record")

    def finish(self, emulator, board):
        """Ends the run, keeps what the board told, gives the epochs of fixes.csv by their time of week in ms."""
        self.assertEqual(emulator.stop(), 0, emulator.log)
        ARTIFACTS.mkdir(parents=True, exist_ok=True)
        (ARTIFACTS / f"{self.out.name}.txt").write_text(board.text())
        with open(self.out / "record/fixes.csv", newline="") as rows:
            return {round(float(row["tow_s"]) * 1000): row for row in csv.DictReader(rows)}

    def settings_are_acknowledged(self, board, message, count):
        answers = board.all("ack")
        self.assertEqual(len(answers), count, board.text())
        self.assertTrue(all(answer[0] == message or answer[0] == 0x0608 for answer in answers), answers)
        self.assertEqual(board.all("nak"), [])
        times = [answer[1] for answer in answers]
        print(f"  {self.out.name}: {count} settings acknowledged after {min(times)} to {max(times)} ms, median "
              f"{statistics.median(times):g} ms; {sum(answer[2] > 1 for answer in answers)} asked again")

    def solutions_are_those_of(self, board, epochs):
        """Holds every solution against its epoch; gives their times of week."""
        compared = 0
        for pvt in board.all("pvt"):
            self.assertIn(pvt[ITOW], epochs)
            epoch = epochs[pvt[ITOW]]
            fix_type, good = FIX_TYPES[epoch["fix_type"]]
            if epoch["fix_type"] == "none":
                # For a while the board itself reckons on.
                self.assertIn(pvt[FIX_TYPE], (0, 1), pvt)
                self.assertLessEqual(pvt[FLAGS] & 1, pvt[FIX_TYPE], pvt)
                continue
            self.assertEqual(pvt[FIX_TYPE], fix_type, (pvt, epoch))
            if good is not None:
                self.assertEqual(bool(pvt[FLAGS] & 1), good, pvt)
            for column, (index, scale, within) in RESOLUTION.items():
                self.assertLessEqual(abs(pvt[index] - float(epoch[column]) * scale), within, (column, pvt, epoch))
            compared += 1
        return compared

    def sentences_are_those_of(self, board, epochs):
        """GGA and NAV-PVT of one epoch tell the same position; gives how many pairs there were."""
        heights = {pvt[ITOW]: pvt[HEIGHT_MSL] for pvt in board.all("pvt")}
        by_utc = {round(sum(float(part) * unit for part, unit in zip(epoch["time_utc"][11:-1].split(":"), (3600, 60, 1))) * 100):
                  (tow, epoch) for tow, epoch in epochs.items()}
        pairs = 0
        for utc, latitude, longitude, quality, _, height in board.all("gga"):
            self.assertIn(utc, by_utc)
            tow, epoch = by_utc[utc]
            if epoch["fix_type"] != "3d":
                continue
            self.assertEqual(quality, 1)
            self.assertLessEqual(abs(latitude - float(epoch["lat_deg"]) * 60e5), 0.51, epoch)
            self.assertLessEqual(abs(longitude - float(epoch["lon_deg"]) * 60e5), 0.51, epoch)
            if tow in heights:
                self.assertLessEqual(abs(height - heights[tow]), 51)
                pairs += 1
        return pairs

    def no_epoch_is_missing(self, epochs, times):
        """Of those between the first and the last of `times`."""
        self.assertEqual([tow for tow in sorted(epochs) if times[0] <= tow <= times[-1]], times)

    def nothing_was_damaged(self, board):
        frames, bad_frames, sentences, bad_sentences, _, lost = board.all("counts")[-1]
        self.assertGreater(frames, 20)
        self.assertGreater(sentences, 20)
        self.assertEqual(lost, 0)
        # While it hunts it hears other speeds; from then on no counter may move.
        self.assertEqual([bad_frames, bad_sentences], board.all("counts")[0][1:4:2], board.text())

    def test_outage_and_recovery_configured_by_keys(self):
        with self.emulator("ublox-f9p", 60, faults=fault("outage", 16, 5)) as emulator:
            with Board(self.program, emulator.tty) as board:
                board.listen_for("ready", 20)
                board.listen_for("no_fix", 30)
                board.listen_for("fix", 20, count=2)
                board.listen(6)
                epochs = self.finish(emulator, board)
        self.assertEqual(board.all("found"), [[38400, 2731]])
        self.assertEqual(board.all("speed"), [[115200]])
        self.settings_are_acknowledged(board, 0x068A, 2)
        times = [pvt[ITOW] for pvt in board.all("pvt")]
        self.no_epoch_is_missing(epochs, times)
        self.assertEqual(set(b - a for a, b in zip(times[5:], times[6:])), {200})
        compared, pairs = self.solutions_are_those_of(board, epochs), self.sentences_are_those_of(board, epochs)
        self.assertGreater(compared, 50)
        self.assertGreater(pairs, 50)
        self.nothing_was_damaged(board)
        print(f"  {self.out.name}: {compared} of {len(times)} solutions and {pairs} sentences are those of fixes.csv")

    def test_silence_makes_the_driver_begin_anew(self):
        with self.emulator("ublox-m8", 70, faults=fault("receiver_silent", 16, 6)) as emulator:
            with Board(self.program, emulator.tty) as board:
                board.listen_for("ready", 20)
                board.listen_for("lost", 30)
                board.listen_for("ready", 30, count=2)
                board.listen(4)
                epochs = self.finish(emulator, board)
        # The receiver keeps its speed, so that the second hunt ends at the first guess or, still silent, a round later.
        self.assertEqual([found[0] for found in board.all("found")], [9600, 115200])
        self.settings_are_acknowledged(board, 0x0601, 16)
        self.assertGreater(self.solutions_are_those_of(board, epochs), 30)
        self.assertGreater(self.sentences_are_those_of(board, epochs), 30)

    def test_receiver_that_never_answers_is_noticed(self):
        with self.emulator("ublox-m9", 60, faults=fault("never_answers", 0, 60)) as emulator:
            with Board(self.program, emulator.tty) as board:
                board.listen_for("nobody", 30)
                self.finish(emulator, board)
        self.assertEqual([mute[0] for mute in board.all("mute")], [38400], board.text())
        self.assertEqual(board.all("found"), [])

    def test_speed_that_nobody_tries_is_noticed(self):
        with self.emulator("ublox-m9", 60, receiver="baud = 460800") as emulator:
            with Board(self.program, emulator.tty) as board:
                heard, = board.listen_for("nobody", 30)
                self.finish(emulator, board)
        self.assertGreater(heard, 500)
        self.assertEqual([board.all("mute"), board.all("found"), board.all("gga")], [[], [], []])


if __name__ == "__main__":
    absent = emulated_board.missing()
    if absent:
        skip(f"{absent} is not installed")
    unittest.main(verbosity=2)
