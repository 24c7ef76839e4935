"""A receiver that saves power goes on and off by its grid, finds nothing under a roof and tries again; its bytes are the same
in simulated and in real time, recorded or not."""
import pathlib
import struct
import unittest

from session import open_folder, skyloop

MIDNIGHT_LEAP = 18  # s that GPS time is ahead of UTC

SCENARIO = """[run]
start = 2026-03-01T00:00:00Z
duration_s = {duration}
seed = 4
[[receiver]]
board = "{board}"
port = "{port}"
[receiver.config]
CFG-PM-OPERATEMODE = {mode}
CFG-PM-POSUPDATEPERIOD = {update}
CFG-PM-ACQPERIOD = {search}
CFG-PM-ONTIME = 3
CFG-PM-UPDATEEPH = {ephemerides}
CFG-UART1-BAUDRATE = 115200
CFG-UART1OUTPROT-NMEA = false
CFG-MSGOUT-UBX_NAV_PVT_UART1 = 1
[model]
name = "{model}"
{more}
"""

ROOF = """[[fault]]
kind = "outage"
at_s = 600
for_s = 600
"""


def scenario(folder, port="", board="ublox-m9", model="modern", mode=1, **values):
    values = {"duration": 1800, "update": 60, "search": 120, "ephemerides": "false", "more": ""} | values
    path = pathlib.Path(folder, "saver.toml")
    text = SCENARIO.format(board=board, model=model, mode=mode, port=port, **values)
    path.write_text(text if port else text.replace('port = ""\n', ""))
    return path


def solutions(data):
    """Seconds since the start, psmState and gnssFixOK of each NAV-PVT."""
    found, at = [], 0
    while (at := data.find(b"\xb5\x62\x01\x07\x5c\x00", at)) >= 0:
        tow, flags = struct.unpack_from("<I", data, at + 6)[0], data[at + 27]
        found.append((tow / 1000 - MIDNIGHT_LEAP, flags >> 2 & 7, flags & 1))
        at += 100
    return found


def times_on(told):
    """The solutions, where they are more than 3 s apart."""
    on = [[told[0]]]
    for one in told[1:]:
        if one[0] - on[-1][-1][0] > 3:
            on.append([])
        on[-1].append(one)
    return on


def recorded(**values):
    with open_folder() as folder:
        skyloop("simulate", scenario(folder, **values), "--out", f"{folder}/run")
        return pathlib.Path(folder, "run/port0.out").read_bytes()


class PowerSave(unittest.TestCase):
    def check_grid(self, **values):
        on = times_on(solutions(recorded(**values)))
        self.assertEqual(len(on), 30, [o[0] for o in on])
        for minute, one in enumerate(on[1:], 1):
            self.assertGreater(one[0][0], 60 * minute)
            self.assertLess(one[0][0], 60 * minute + 3)
            self.assertEqual(one[-1][1:], (3, 1), "it leaves with a fix")
            self.assertLess(one[-1][0], 60 * minute + 20)
            states = [state for _, state, _ in one]
            self.assertEqual(states, sorted(states), "enabled, acquisition, tracking")
        return on

    def test_every_minute(self):
        self.check_grid()
        self.check_grid(board="ublox-m8")
        self.check_grid(board="ublox-m10", model="baseline")

    def test_under_a_roof(self):
        on = times_on(solutions(recorded(more=ROOF)))
        vain = [one for one in on if not any(fix for _, _, fix in one)]
        self.assertGreaterEqual(len(vain), 4)
        for one in vain:
            self.assertLess(one[-1][0] - one[0][0], 16, "15 s without a satellite")
        for before, after in zip(vain[1:], vain[2:]):  # the first began by the update period
            self.assertEqual(after[0][0] - before[0][0], 120, "the search period")
        self.assertEqual(len([one for one in on if one[0][0] > 1330 and one[-1][2]]), 7, "every minute again")

    def test_ephemerides(self):
        on = times_on(solutions(recorded(update=7200, ephemerides="true", duration=4000)))
        self.assertEqual([round(one[0][0] + MIDNIGHT_LEAP) // 60 for one in on], [0, 30, 60])
        for one in on[1:]:
            self.assertTrue(30 < one[-1][0] - one[0][0] < 45, one[-1][0] - one[0][0])

    def test_cycles(self):
        told = solutions(recorded(board="ublox-m8", mode=2, update=5, duration=120))
        steady = [tow for tow, state, fix in told if state == 4]
        self.assertGreater(len(steady), 15)
        self.assertEqual({b - a for a, b in zip(steady[1:], steady[2:])}, {5}, "on a grid of its own")

    def test_the_same_bytes(self):
        first = recorded(more=ROOF)
        self.assertEqual(first, recorded(more=ROOF))
        with open_folder() as folder:
            skyloop("run", scenario(folder, port=f"file:{folder}/bytes", more=ROOF), "--speed", 300)
            self.assertEqual(first, pathlib.Path(folder, "bytes").read_bytes(), "not recorded, and looked at at other times")

    def test_in_real_time(self):
        short = {"update": 10, "duration": 25}
        simulated = recorded(**short)
        with open_folder() as folder:
            skyloop("run", scenario(folder, port=f"file:{folder}/bytes", **short))
            self.assertEqual(pathlib.Path(folder, "bytes").read_bytes(), simulated)
        self.assertEqual(len(times_on(solutions(simulated))), 3)


if __name__ == "__main__":
    unittest.main()
