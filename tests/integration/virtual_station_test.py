"""Virtual reference stations of a run's caster: for a rover of another run, and for clients by hand."""
import csv
import json
import math
import re
import socket
import time
import unittest

from ntrip_test import FolderTest, Heard, answer_to, messages_in, request, unchunked
from session import Emulator, skyloop
from tcp_client_test import connect

PLACE = (46.4775, 30.7326, 77.0)
GPS_ALONE = '[sky]\nconstellations = ["gps"]\n'
SKY = "[run]\nsky_seed = 3\nreceiver_seed = {}\n" + GPS_ALONE
# The run that has the caster is 40 km away, and its receiver could not send RTCM.
NETWORK = SKY.format(1) + """[trajectory]
kind = "fixed"
at = [46.8, 30.9, 12.0]
[[receiver]]
board = "ublox-m8"
port = "tcp:0"
[caster]
listen = "127.0.0.1:0"
[[caster.mount]]
name = "VRS"
virtual = true
"""
ROVER = SKY.format(2) + f"""[trajectory]
kind = "fixed"
at = [{PLACE[0]}, {PLACE[1]}, {PLACE[2]}]
[[receiver]]
board = "ublox-f9p"
port = "tcp:0"
baud = 460800
corrections_position_s = 1
[receiver.config]
CFG-MSGOUT-UBX_NAV_RELPOSNED_UART1 = 1
"""
QUALITY = re.compile(rb"\$GNGGA,[^,]*,[^,]*,N,[^,]*,E,(\d),")


def gga(latitude, longitude, msl_m, quality=1):
    """As a rover tells it."""
    def minutes(angle, digits):
        return f"{int(abs(angle)):0{digits}d}{abs(angle) % 1 * 60:010.7f}"

    body = (f"GPGGA,120000.00,{minutes(latitude, 2)},{'NS'[latitude < 0]},{minutes(longitude, 3)},{'EW'[longitude < 0]},"
            f"{quality},12,0.8,{msl_m:.1f},M,30.0,M,,")
    checksum = 0
    for letter in body.encode():
        checksum ^= letter
    return f"${body}*{checksum:02X}"


class VirtualStationTest(FolderTest):
    def network(self, text=NETWORK):
        network = Emulator(self.scenario("network.toml", text))
        self.addCleanup(network.__exit__)
        return network, int(network.said(r"^caster: 127\.0\.0\.1:(\d+) \(VRS\)"))

    def connection(self, port, text):
        connection = socket.create_connection(("127.0.0.1", port), timeout=20)
        self.addCleanup(connection.close)
        connection.sendall(text)
        return Heard(connection)

    def test_a_rover_is_fixed_to_centimetres(self):
        # The live sky is that of now: some hours of GPS alone would not do.
        _, port = self.network(NETWORK.replace(GPS_ALONE, ""))
        run = self.folder / "run"
        rover = Emulator(self.scenario("rover.toml", ROVER.replace(GPS_ALONE, "")),
                         "--corrections", f"ntrip://127.0.0.1:{port}/VRS", "--record", run)
        self.addCleanup(rover.__exit__)
        with connect(rover.tty) as connection:
            Heard(connection).until(lambda data: QUALITY.findall(data).count(b"4") >= 10, 90)
        self.assertEqual(rover.stop(), 0)
        with open(run / "fixes.csv", encoding="utf-8", newline="") as file:
            fixed = [row for row in csv.DictReader(file) if row["fix_type"] == "rtk_fixed"]
        self.assertGreaterEqual(len(fixed), 10)
        for row in fixed:
            east, north, up = (float(row[f"{axis}_error_m"]) for axis in ("east", "north", "up"))
            self.assertLess(math.hypot(east, north), 0.04, row["time_utc"])
            self.assertLess(abs(up), 0.08, row["time_utc"])
        told = skyloop("decode", "--format", "json", run / "port0.out").stdout.splitlines()
        lengths = [line["fields"]["length_m"] for line in map(json.loads, told) if line.get("id") == "01-3C"]
        lengths = [length for length in lengths if length > 0]
        self.assertTrue(lengths)
        for length in lengths:
            self.assertGreater(length, 3.4)
            self.assertLess(length, 30)

    def test_nothing_comes_before_a_place(self):
        _, port = self.network()
        for version in (1, 2):
            client = self.connection(port, request("VRS", version))
            client.until(lambda data: b"\r\n\r\n" in data)
            head = len(client.data)
            for silent in (gga(*PLACE, quality=0), gga(*PLACE[:2], 1e6), "nonsense"):
                client.connection.sendall(silent.encode() + b"\r\n")
            time.sleep(2.5)
            client.connection.sendall(gga(*PLACE).encode() + b"\r\n")
            data = client.until(lambda data: len(data) > head + 1500)
            numbers, _ = messages_in(unchunked(data) if version == 2 else data[head:])
            # Had anything come before, it would be an epoch more.
            self.assertEqual(numbers[:4], [1006, 1008, 1033, 1077])

    def test_the_place_may_come_with_the_request(self):
        _, port = self.network()
        client = self.connection(port, request("VRS", 2, None, f"Ntrip-GGA: {gga(*PLACE)}\r\n"))
        numbers, skipped = messages_in(unchunked(client.until(lambda data: len(data) > 4000)))
        self.assertEqual(skipped, 0)
        self.assertGreater(numbers.count(1077), 2)

    def test_the_source_table_tells_a_network_that_wants_positions(self):
        _, port = self.network()
        table = answer_to(port, request("", 2)).split(b"\r\n\r\n")[1].decode()
        fields = table.split("\r\n")[0].split(";")
        self.assertEqual(fields[:4], ["STR", "VRS", "VRS (virtual reference stations)", "RTCM 3.3"])
        self.assertEqual(fields[4], "1006(10),1008(10),1033(10),1077(1)")
        self.assertEqual(fields[5:7], ["2", "GPS"])
        self.assertEqual(fields[11:13], ["1", "1"])

    def test_there_is_room_for_sixteen(self):
        network, port = self.network()
        clients = [self.connection(port, request("VRS", 1 + i % 2, None, "")) for i in range(16)]
        for i, client in enumerate(clients):
            client.until(lambda data: b"\r\n\r\n" in data)
            client.connection.sendall(gga(PLACE[0] + i / 100, PLACE[1], 47).encode() + b"\r\n")
        for version in (1, 2):
            self.assertIn(b" 503 Service Unavailable\r\n", answer_to(port, request("VRS", version)))
        for client in clients:
            client.until(lambda data: len(data) > 1500)
        clients[0].connection.close()
        end = time.monotonic() + 20
        while True:
            late = self.connection(port, request("VRS", 1))
            if late.until(lambda data: b"\r\n" in data).startswith(b"ICY 200 OK"):
                break
            self.assertLess(time.monotonic(), end)
            time.sleep(0.2)
        self.assertEqual(network.stop(), 0)

    def test_what_cannot_be_is_refused(self):
        path = self.scenario("network.toml", NETWORK)
        refused = skyloop("check", path, "--model", "baseline", check=False)
        self.assertEqual(refused.returncode, 2)
        self.assertRegex(refused.stderr, r"network\.toml:\d+:\d+: .*virtual stations measure, and a sensor model does not")
        self.assertEqual(skyloop("check", path).returncode, 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
