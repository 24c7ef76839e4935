"""What programs are told beside the wires: GPS_INPUT, HIL_GPS, MSP and JSON, read by decoders of others and of its own, and
other ends that refuse, stop to read or go away."""
import csv
import json
import os
import pathlib
import socket
import struct
import subprocess
import time
import unittest

from other_protocols_test import GpsInput, Msp, mavlink_messages, msp_messages
from session import Emulator, npm_packages, open_folder, skyloop

START = "2024-03-05T12:00:00Z"
CIRCLE = """[run]
start = 2024-03-05T12:00:00Z
[trajectory]
kind = "circle"
centre = [47.3977, 8.5456, 488]
radius_m = 200
speed_mps = 20
[[receiver]]
rate_hz = 5
"""
EXTRAS = {0: 50, 113: 124, 232: 151}
EPOCH_KEYS = ["schema", "receiver", "epoch", "time_utc", "gps_week", "tow_s", "truth", "latency_s", "fix", "error", "satellites"]


def free_udp():
    """A socket on loopback that waits at most 5 s."""
    one = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    one.bind(("127.0.0.1", 0))
    one.settimeout(5)
    return one


def connect(port, receive_buffer=None):
    one = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    if receive_buffer:
        one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
    one.settimeout(10)
    one.connect(("127.0.0.1", port))
    return one


def read_all(connection):
    """Until the other end closes."""
    data = bytearray()  # grows in place: a copy of all for each piece would read too slowly itself
    while True:
        piece = connection.recv(65536)
        if not piece:
            return bytes(data)
        data += piece


def node_folder():
    """Where node-mavlink is, and the decoder that takes it; None and why there is none."""
    folder, lack = npm_packages("mavlink_decoder", "node-mavlink")
    return folder, lack or str(pathlib.Path(__file__).resolve().parent / "mavlink_decoder/decode.cjs")


class OutputsTest(unittest.TestCase):
    def setUp(self):
        folder = open_folder()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)

    def scenario(self, text=CIRCLE):
        path = self.path / "s.toml"
        path.write_text(text, encoding="utf-8")
        return path

    def simulate(self, *outputs, text=CIRCLE, duration=4):
        done = skyloop("simulate", self.scenario(text), "--duration", duration, "--out", self.path / "out",
                       *[part for uri in outputs for part in ("--output", uri)])
        with open(self.path / "out/fixes.csv", newline="", encoding="ascii") as table:
            return done, list(csv.DictReader(table))

    def live(self, *arguments, text=CIRCLE):
        emulator = Emulator(self.scenario(text), "--port", "pty", *arguments)
        self.addCleanup(emulator.__exit__)
        return emulator

    def near(self, value, fix, key, delta):
        self.assertAlmostEqual(value, float(fix[key]), delta=delta, msg=f"{key} at {fix['time_utc']}")

    def test_gps_input_arrives_when_the_receiver_reports_and_tells_every_fix(self):
        peer = free_udp()
        self.addCleanup(peer.close)
        emulator = self.live("--duration", 4, "--record", self.path / "out", "--output",
                             f"gps-input:127.0.0.1:{peer.getsockname()[1]},system=3,id=1")
        emulator.said(r"^output 0: (gps-input: 127.0.0.1:\d+ \(udp\))$")
        frames, arrived = [], []
        while len(frames) < 4 + 4 * 5:
            data = peer.recv(2048)
            arrived.append(time.monotonic())
            frames += mavlink_messages(data, EXTRAS, (3, 220))
        self.assertEqual(emulator.finish(), 0, emulator.log)
        self.assertEqual([sequence for sequence, _, _ in frames], list(range(len(frames))))
        self.assertEqual([message for _, message, _ in frames], ([0] + [232] * 5) * 4)
        with open(self.path / "out/fixes.csv", newline="", encoding="ascii") as table:
            fixes = list(csv.DictReader(table))
        told = [GpsInput(*struct.unpack("<QIii9fHHBBBH", payload.ljust(65, b"\0"))) for _, m, payload in frames if m == 232]
        self.assertEqual(len(told), len(fixes))
        for m, fix in zip(told, fixes):
            self.assertEqual((m.tow, m.week), (round(float(fix["tow_s"]) * 1000), int(fix["gps_week"])))
            self.assertEqual((m.gps_id, m.fix_type, m.ignore), (1, 3, 0))
            self.near(m.lat / 1e7, fix, "lat_deg", 5.6e-8)
            self.near(m.north, fix, "vel_north_mps", 0.00051)
            self.near(m.h_acc, fix, "h_acc_m", 0.00051)
        # On the whole at the rate of the epochs, whatever single ones met on their way.
        self.assertAlmostEqual(arrived[-1] - arrived[0], 3.8, delta=0.3)
        summary = json.loads((self.path / "out/run.json").read_text())
        self.assertEqual(summary["outputs"][0]["messages"], len(frames))
        self.assertEqual(summary["outputs"][0]["lost"], 0)

    def test_another_implementation_of_mavlink_writes_the_same_bytes(self):
        folder, decoder = node_folder()
        if folder is None:
            self.skipTest(decoder)
        _, fixes = self.simulate(f"gps-input-file:{self.path}/input", f"hil-gps-file:{self.path}/hil,system=9,component=7,id=2",
                                 f"hil-gps-file:{self.path}/dop,eph=dop100")
        told = {}
        for name in ("input", "hil", "dop"):
            done = subprocess.run(["node", decoder], input=(self.path / name).read_bytes(), capture_output=True, timeout=60,
                                  env={**os.environ, "SKYLOOP_NODE_FOLDER": str(folder)})
            lines = [json.loads(line) for line in done.stdout.splitlines()]
            self.assertEqual(len(lines), 24, done.stderr)
            for number, line in enumerate(lines):
                self.assertTrue(line["same"], line)
                self.assertEqual(line["seq"], number)
            told[name] = [line for line in lines if line["name"] != "HEARTBEAT"]
        for line, fix in zip(told["input"], fixes):
            self.assertEqual(line["name"], "GPS_INPUT")
            self.near(line["fields"]["lon"] / 1e7, fix, "lon_deg", 5.6e-8)
            self.near(line["fields"]["vdop"], fix, "vdop", 0.00051)
            self.assertEqual(line["fields"]["satellitesVisible"], int(fix["satellites_used"]))
        for line, dop, fix in zip(told["hil"], told["dop"], fixes):
            self.assertEqual((line["name"], line["sysid"], line["compid"], line["fields"]["id"]), ("HIL_GPS", 9, 7, 2))
            self.near(line["fields"]["eph"] / 100, fix, "h_acc_m", 0.0056)
            self.near(dop["fields"]["epv"] / 100, fix, "vdop", 0.0056)
            self.near(line["fields"]["ve"] / 100, fix, "vel_east_mps", 0.0056)
            self.near(line["fields"]["vel"] / 100, fix, "speed_mps", 0.0056)

    def test_json_is_the_same_live_and_simulated_and_is_fixes_csv(self):
        _, fixes = self.simulate(f"json-file:{self.path}/a.jsonl")
        self.simulate(f"json-file:{self.path}/b.jsonl")
        self.assertEqual(self.live("--duration", 4, "--output", f"json-file:{self.path}/live.jsonl").finish(), 0)
        first = (self.path / "a.jsonl").read_bytes()
        self.assertEqual((self.path / "b.jsonl").read_bytes(), first)
        self.assertEqual((self.path / "live.jsonl").read_bytes(), first)
        lines = [json.loads(line) for line in first.splitlines()]
        self.assertEqual(len(lines), len(fixes))
        for number, (line, fix) in enumerate(zip(lines, fixes)):
            self.assertEqual(list(line), EPOCH_KEYS)
            self.assertEqual((line["schema"], line["receiver"], line["epoch"]), ("skyloop-epoch/1", "receiver0", number))
            self.assertEqual(line["tow_s"], float(fix["tow_s"]))
            self.near(line["truth"]["lat_deg"], fix, "true_lat_deg", 1e-8)
            self.near(line["fix"]["height_m"], fix, "height_m", 0.0011)
            self.near(line["error"]["north_m"], fix, "north_error_m", 0.0011)
            self.assertEqual(sum(s["used"] for s in line["satellites"]), int(fix["satellites_used"]))
            self.assertEqual(len(line["satellites"]), int(fix["satellites_visible"]))
            self.assertGreater(line["latency_s"], 0)

    def test_msp_reaches_every_client_of_the_server_and_a_server_that_it_calls(self):
        with socket.create_server(("127.0.0.1", 0)) as server:
            server.settimeout(10)
            emulator = self.live("--output", "msp-tcp:0", "--output", f"msp-tcp-to:127.0.0.1:{server.getsockname()[1]}")
            port = int(emulator.said(r"^output 0: msp: 127.0.0.1:(\d+) \(tcp\)$"))
            called = server.accept()[0]
            clients = [connect(port), connect(port)]
            for client in (*clients, called):
                client.settimeout(10)
                data = b""
                while len(data) < 5 * 61:
                    data += client.recv(4096)
                frames = msp_messages(data[:len(data) // 61 * 61])
                self.assertEqual({function for function, _ in frames}, {0x1F03})
                told = [Msp(*struct.unpack("<BHIBBHHHHiiiiiiHHHBBBBB", payload)) for _, payload in frames]
                for m in told:
                    self.assertEqual((m.fix_type, m.week, m.yaw), (3, 2304, 0xFFFF))
                    self.assertAlmostEqual(m.lat / 1e7, 47.3977, delta=0.003)
                self.assertEqual([b.tow - a.tow for a, b in zip(told, told[1:])], [200] * (len(told) - 1))
            # The one it calls goes, and is found again.
            called.close()
            again = server.accept()[0]
            again.settimeout(10)
            self.assertEqual(again.recv(3), b"$X<")
            for one in (*clients, again):
                one.close()
        code = emulator.stop()
        self.assertEqual(code, 0, emulator.log)
        self.assertIn("connection lost; trying again", emulator.log)

    def test_a_client_that_stops_to_read_disturbs_neither_the_run_nor_another(self):
        emulator = self.live("--speed", 60, "--duration", 600, "--output", "json-tcp:0")
        port = int(emulator.said(r"^output 0: json: 127.0.0.1:(\d+) \(tcp\)$"))
        lazy, diligent = connect(port, 4096), connect(port)
        self.addCleanup(lazy.close)
        self.addCleanup(diligent.close)
        data = read_all(diligent)
        self.assertEqual(emulator.finish(), 0, emulator.log)
        lines = [json.loads(line) for line in data.splitlines()]
        numbers = [line["epoch"] for line in lines]
        self.assertEqual(numbers, list(range(numbers[0], 3000)), "no line is missing")
        self.assertEqual(emulator.log.count("reads too slowly; it gets no message until it has read"), 1)
        self.assertIn("messages were lost", emulator.log)
        for line in read_all(lazy).splitlines()[:-1]:
            json.loads(line)  # whole, as far as they came

    def test_an_end_that_refuses_is_told_once(self):
        peer = free_udp()
        port = peer.getsockname()[1]
        peer.close()
        emulator = self.live("--duration", 2, "--output", f"gps-input:127.0.0.1:{port}", "--output", f"json-udp:127.0.0.1:{port}")
        self.assertEqual(emulator.finish(), 0, emulator.log)
        self.assertEqual(emulator.log.count("Connection refused"), 2, emulator.log)

    def test_a_silent_receiver_tells_nothing(self):
        text = CIRCLE + '[[fault]]\nkind = "receiver_silent"\nat_s = 1\nfor_s = 2\n'
        self.simulate(f"gps-input-file:{self.path}/input", f"json-file:{self.path}/lines", text=text)
        frames = mavlink_messages((self.path / "input").read_bytes(), EXTRAS)
        self.assertEqual([message for _, message, _ in frames], [0] + [232] * 5 + [0, 0, 0] + [232] * 5)
        lines = [json.loads(line) for line in (self.path / "lines").read_text().splitlines()]
        self.assertEqual([line["fix"] is None for line in lines], [False] * 5 + [True] * 10 + [False] * 5)

    def test_a_scenario_names_its_outputs_and_simulate_reaches_nobody(self):
        peer = free_udp()
        peer.settimeout(0.2)
        self.addCleanup(peer.close)
        text = CIRCLE + f"""name = "rear"
[[output]]
to = "gps-input:127.0.0.1:{peer.getsockname()[1]}"
[[output]]
to = "json-file:{self.path}/lines"
receiver = "rear"
"""
        done, _ = self.simulate(text=text, duration=1)
        self.assertIn("output 0 (json:", done.stderr)
        self.assertNotIn("gps-input", done.stderr)
        self.assertEqual(len((self.path / "lines").read_text().splitlines()), 5)
        with self.assertRaises(TimeoutError):
            peer.recv(100)
        done = skyloop("check", self.scenario(text.replace('"rear"\n[[', '"front"\n[[')), check=False)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"s\.toml:\d+:\d+: output\.receiver: 'rear' is no receiver of this scenario")
        for uri, said in (("gps-input:14550", "the host is missing"), ("json-tcp:1,receiver=x", "'x' is no receiver")):
            done = skyloop("run", "--output", uri, check=False)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(said, done.stderr)
        done = skyloop("run", "--output", "json-file:/no/such/folder/x", check=False)
        self.assertEqual(done.returncode, 1, done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
