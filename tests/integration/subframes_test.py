"""RTKLIB's convbin reads the subframes that we send and finds the records that they were made from."""
import math
import os
import pathlib
import shutil
import subprocess
import unittest

from session import ROOT, SHARED, open_folder, skip, skyloop

# Half a step of each field, with a digit of RINEX: line and column of the record -> tolerance.
SEMICIRCLE = math.pi
KEPLER = {
    (0, 1): 2.0**-32 + 1e-15, (0, 2): 2.0**-44 + 1e-20, (1, 1): 2.0**-6 + 1e-9, (1, 2): SEMICIRCLE * 2.0**-44,
    (1, 3): SEMICIRCLE * 2.0**-31, (2, 0): 2.0**-30 + 1e-16, (2, 1): 2.0**-34 + 1e-13, (2, 2): 2.0**-30,
    (2, 3): 2.0**-20 + 1e-8, (3, 0): 1e-6, (3, 1): 2.0**-30 + 1e-16, (3, 2): SEMICIRCLE * 2.0**-31,
    (3, 3): 2.0**-30 + 1e-16, (4, 0): SEMICIRCLE * 2.0**-31, (4, 1): 2.0**-6 + 1e-9, (4, 2): SEMICIRCLE * 2.0**-31,
    (4, 3): SEMICIRCLE * 2.0**-44 + 1e-19, (5, 0): SEMICIRCLE * 2.0**-44 + 1e-19, (5, 2): 0, (6, 1): 0,
    (6, 2): 2.0**-32 + 1e-16,
}
ANGLES = {(1, 3), (3, 2), (4, 0), (4, 2)}
# Kilometres, km/s, km/s².
STATE = {(line, column): tolerance for line in (1, 2, 3)
         for column, tolerance in ((0, 2.0**-12 + 1e-8), (1, 2.0**-21 + 1e-12), (2, 2.0**-31 + 1e-15))}
STATE.update({(0, 1): 2.0**-31 + 1e-15, (0, 2): 2.0**-41 + 1e-18, (1, 3): 0, (2, 3): 0})


def records(path):
    """Satellite -> epoch and rows of four numbers, of a RINEX 3 navigation file."""
    lines = path.read_text().splitlines()
    body = lines[next(i for i, line in enumerate(lines) if "END OF HEADER" in line) + 1:]
    result, rows = {}, None

    def numbers(line, first=4):
        cells = [line[at:at + 19].replace("D", "E").strip() for at in range(first, 80, 19)]
        return [float(cell) if cell else 0.0 for cell in cells]

    for line in body:
        if line[0] != " ":
            rows = [[0.0] + numbers(line, first=23)]
            result[line[:3].replace(" ", "0")] = (line[4:23].split(), rows)
        else:
            rows.append(numbers(line))
    return result


def difference(place, a, b):
    if place in ANGLES:
        return abs(math.remainder(a - b, 2 * math.pi))
    return abs(a - b)


SCENARIO = """[run]
start = 2023-01-01T12:00:00Z
duration_s = 75
[sky]
navigation = "{navigation}"
[trajectory]
kind = "fixed"
at = [48.1, 11.5, 600]
[[receiver]]
board = "{board}"
baud = 460800
[receiver.config]
CFG-UART1-BAUDRATE = 460800
CFG-MSGOUT-UBX_RXM_RAWX_UART1 = 1
CFG-MSGOUT-UBX_RXM_SFRBX_UART1 = 1
"""


def found_by_convbin(folder, log):
    """The records that convbin finds in a log of UBX."""
    subprocess.run(["convbin", "-r", "ubx", "-v", "3.04", "-n", folder / "found.rnx", "-o", folder / "found.obs", log],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=60)
    return records(folder / "found.rnx")


class Subframes(unittest.TestCase):
    def satellites_found(self, board):
        """By system, in what a receiver sends in a run over Munich."""
        navigation = SHARED / "nav/BRDC00IGS_R_20230010000_01D_MN.rnx.gz"
        if not navigation.exists():
            self.skipTest(f"shared data absent: {navigation}")
        temporary = open_folder()
        self.addCleanup(temporary.cleanup)
        folder = pathlib.Path(temporary.name)
        (folder / "board.toml").write_text(board, encoding="utf-8")
        (folder / "s.toml").write_text(SCENARIO.format(navigation=navigation, board=folder / "board.toml"), encoding="utf-8")
        skyloop("simulate", folder / "s.toml", "--out", folder / "run", "--quiet")
        shutil.copy(folder / "run/port0.out", folder / "heard.ubx")
        systems = [name[0] for name in found_by_convbin(folder, folder / "heard.ubx")]
        return {system: systems.count(system) for system in "GREC"}

    def test_records_of_all_systems_come_from_a_receiver_with_the_ninth_word_of_older_firmware(self):
        board = (ROOT / "boards/receivers/ublox-f9p.toml").read_text(encoding="utf-8")
        found = self.satellites_found(board.replace("[ubx]\n", "[ubx]\ngalileo_words = 9\n"))
        self.assertGreaterEqual(min(found.values()), 4, found)

    def test_records_come_back(self):
        temporary = open_folder()
        self.addCleanup(temporary.cleanup)
        folder = pathlib.Path(temporary.name)
        subprocess.run([os.environ["SKYLOOP_SUBFRAME_LOG"], folder / "sent.rnx", folder / "heard.ubx"], check=True)
        # convbin 2.4.3 reads no Galileo pages of eight words, of real receivers neither; unit tests compare those with real ones.
        sent = {name: record for name, record in records(folder / "sent.rnx").items() if name[0] != "E"}
        found = found_by_convbin(folder, folder / "heard.ubx")
        self.assertEqual(sorted(found), sorted(sent))
        self.assertEqual(len(sent), 74)
        for satellite, (epoch, rows) in sent.items():
            self.assertEqual([int(x) for x in found[satellite][0]], [int(x) for x in epoch], satellite)
            for place, tolerance in (STATE if satellite[0] == "R" else KEPLER).items():
                there, ours = found[satellite][1][place[0]][place[1]], rows[place[0]][place[1]]
                # BeiDou's group delays have steps of 0.1 ns.
                allowed = 0.051e-9 if satellite[0] == "C" and place == (6, 2) else tolerance
                self.assertLessEqual(difference(place, there, ours), allowed, (satellite, place, there, ours))


if __name__ == "__main__":
    if shutil.which("convbin") is None:
        skip("convbin of RTKLIB is absent: apt-get install rtklib")
    unittest.main()
