"""An F9P as the base of a ground station: it surveys in, stands where the survey ends, and tells rovers so."""
import json
import math
import pathlib
import select
import time
import unittest

from session import Emulator, open_folder, skyloop
from tcp_client_test import connect
from ubx_frames import ubx, valset

PLACE = (46.4775, 30.7326, 77.0)
RTCM_1005 = b"\xd3\x00\x13\x3e\xd0"  # its preamble, length and number (RTCM 10403.3, table 3.5-6)
# Of CFG-TMODE and CFG-MSGOUT, of UART1 (F9 HPG 1.32, section 6).
MODE, LEAST_S, LIMIT = 0x20030001, 0x40030010, 0x40030011
NAV_SVIN, TYPE_1005, TYPE_1077 = 0x20910089, 0x209102BE, 0x209102CD

SCENARIO = f"""[run]
start = 2026-03-01T00:00:00Z
seed = 3
[trajectory]
kind = "fixed"
at = [{PLACE[0]}, {PLACE[1]}, {PLACE[2]}]
[[receiver]]
board = "ublox-f9p"
port = "tcp:0"
"""


def earth_fixed(latitude_deg, longitude_deg, height_m):
    """WGS 84, metres."""
    latitude, longitude = math.radians(latitude_deg), math.radians(longitude_deg)
    squared = 6.69437999014e-3
    normal = 6378137.0 / math.sqrt(1 - squared * math.sin(latitude) ** 2)
    level = (normal + height_m) * math.cos(latitude)
    return (level * math.cos(longitude), level * math.sin(longitude),
            (normal * (1 - squared) + height_m) * math.sin(latitude))


def is_surveying(data):
    """Whether the last NAV-SVIN is of a survey that goes on: its field "active" (F9 HPG 1.32, section 3.15.22)."""
    at = data.rfind(b"\xb5\x62\x01\x3b\x28\x00")
    return at >= 0 and data[at + 6 + 37:at + 6 + 38] == b"\x01"


class Client:
    def __init__(self, connection):
        self.connection, self.data = connection, b""

    def hear_until(self, wanted, patience=40):
        end = time.monotonic() + patience
        while not wanted(self.data):
            if time.monotonic() > end:
                raise AssertionError("not heard what was waited for")
            if select.select([self.connection], [], [], 0.2)[0]:
                piece = self.connection.recv(65536)
                if not piece:
                    raise AssertionError("the run has ended")
                self.data += piece

    def messages(self, name):
        """What was heard of one message, by skyloop's own reading."""
        with open_folder() as folder:
            path = pathlib.Path(folder) / "heard"
            path.write_bytes(self.data)
            lines = skyloop("decode", "--format", "json", path).stdout.splitlines()
        return [message["fields"] for message in map(json.loads, lines) if message.get("name") == name]


class BaseStationTest(unittest.TestCase):
    def setUp(self):
        folder = open_folder()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name) / "base.toml"
        self.path.write_text(SCENARIO, encoding="utf-8")

    def test_surveys_in_and_tells_rovers_where_it_stands(self):
        with Emulator(self.path, "--speed", 20, "--wait-for-client", "--duration", 900) as emulator, connect(emulator.tty) as connection:
            client = Client(connection)
            connection.sendall(valset([(MODE, 1), (LEAST_S, 60), (LIMIT, 50000), (NAV_SVIN, 1), (TYPE_1005, 1), (TYPE_1077, 1)]))
            client.hear_until(lambda data: data.count(RTCM_1005) >= 3)
            surveys, stations = client.messages("NAV-SVIN"), client.messages("station position")
            # As ground stations begin anew: off, and on again at once.
            connection.sendall(valset([(MODE, 0)]) + valset([(MODE, 1), (LEAST_S, 40)]))
            client.data = b""
            client.hear_until(is_surveying)
            client.data = b""
            client.hear_until(lambda data: RTCM_1005 in data)
            again = client.messages("NAV-SVIN")
            connection.sendall(ubx((0x06, 0x71)))
            client.hear_until(lambda data: ubx((0x05, 0x01), b"\x06\x71") in data)
        surveys = [survey for survey in surveys if survey["active"] or survey["valid"]]  # not of the epoch before
        self.assertEqual([survey["active"] for survey in surveys[:60]], [1] * 60)
        self.assertEqual([survey["duration_s"] for survey in surveys[:60]], list(range(60)))
        last = surveys[-1]
        self.assertEqual((last["valid"], last["active"], last["duration_s"], last["observations"]), (1, 0, 60, 61))
        self.assertLess(last["mean_acc_m"], 5)
        accuracies = [survey["mean_acc_m"] for survey in surveys]
        self.assertEqual(accuracies, sorted(accuracies, reverse=True))
        mean = [whole + rest for whole, rest in zip(last["mean_ecef_m"], last["mean_ecef_hp_m"])]
        told = [stations[-1][f"ecef_{axis}_m"] for axis in "xyz"]
        self.assertLess(math.dist(mean, told), 1e-3)
        self.assertLess(math.dist(told, earth_fixed(*PLACE)), 6)
        self.assertTrue(all(station == stations[0] for station in stations), stations)
        self.assertEqual(again[-1]["valid"], 1)
        self.assertEqual(again[-1]["observations"], 41)


if __name__ == "__main__":
    unittest.main(verbosity=2)
