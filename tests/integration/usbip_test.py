"""A receiver on USB/IP: listed, attached, configured and unplugged by a client of the tests' own and by the usbip tool."""
import json
import os
import pathlib
import re
import shutil
import socket
import struct
import subprocess
import time
import unittest

import usbip_client
from pty_client_test import good_share
from session import Emulator, open_folder, skyloop
from ubx_frames import ubx, valset
from usbip_client import DATA_IN, NOTIFY, STALLED, UNLINKED, Host, ImportRefused, listed

START = "2026-03-01T00:00:00Z"
SCENARIO = """[run]
start = 2026-03-01T00:00:00Z
duration_s = {duration}
[[receiver]]
board = "{board}"
port = "usbip:0"
{rest}"""


class UsbipTest(unittest.TestCase):
    def emulator(self, *arguments):
        return Emulator("--port", "usbip:0", "--start", START, "--model", "ideal", *arguments)

    def test_is_listed_before_and_while_it_is_attached(self):
        with self.emulator() as emulator:
            (device,) = listed(emulator.tty)
            self.assertEqual((device["vendor"], device["product"], device["release"]), (0x1546, 0x01A8, 0x0301))
            self.assertEqual((device["bus_id"], device["speed"], device["configurations"]), ("1-1", 2, 1))
            self.assertEqual(device["classes"], [(2, 2, 1), (10, 0, 0)])
            with Host(emulator.tty) as host:
                host.enumerate()
                self.assertEqual(listed(emulator.tty)[0]["configuration"], 1)
                with self.assertRaises(ImportRefused) as refused:
                    Host(emulator.tty)
                self.assertEqual(refused.exception.args, (2,), "busy")
            with self.assertRaises(ImportRefused) as refused:
                Host(emulator.tty, "1-2")
            self.assertEqual(refused.exception.args, (4,), "no such device")
            self.assertEqual(emulator.stop(), 0, emulator.log)

    @unittest.skipUnless(shutil.which("usbip", path="/usr/sbin:/usr/bin:/sbin:/bin"), "usbip is not installed")
    def test_the_usbip_tool_lists_it(self):
        tool = shutil.which("usbip", path="/usr/sbin:/usr/bin:/sbin:/bin")
        with self.emulator("--board", "ublox-f9p") as emulator:
            host, port = emulator.tty.rsplit(":", 1)
            done = subprocess.run([tool, "--tcp-port", port, "list", "-r", host], capture_output=True, text=True, timeout=30)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertRegex(done.stdout, r"1-1: .*\(1546:01a9\)")
            self.assertIn("/sys/devices/skyloop/usb1/1-1", done.stdout)
            self.assertRegex(done.stdout, r"0 - .*\(02/02/01\)")
            self.assertEqual(emulator.stop(), 0, emulator.log)

    def test_enumerates_as_a_kernel_does(self):
        with self.emulator() as emulator, Host(emulator.tty) as host:
            device, configuration, texts = host.enumerate()
            self.assertEqual(device.hex(), "12011001020000404615a801010301020001")
            self.assertEqual(struct.unpack("<H", configuration[2:4])[0], len(configuration))
            self.assertEqual(texts, ["u-blox AG - www.u-blox.com", "u-blox GNSS receiver"])
            self.assertEqual(host.read_descriptor(6), (STALLED, b""), "no qualifier: full speed alone")
            self.assertEqual(host.control(0x80, 8, length=1), (0, b"\x01"))
            notification = host.wait_for(host.submit(NOTIFY, True, 64))
            self.assertEqual(notification[2].hex(), "a1200000000002000300", "carrier and DSR")
            self.assertEqual(host.wait_for(host.submit(5, True, 64))[0], STALLED, "no such endpoint")
            self.assertEqual(emulator.stop(), 0, emulator.log)

    def test_speaks_while_the_terminal_is_open(self):
        with self.emulator() as emulator, Host(emulator.tty) as host:
            host.enumerate()
            time.sleep(1.2)
            host.open()
            data = host.read_for(3)
            self.assertGreaterEqual(data.count(b"GGA"), 2)
            self.assertEqual(good_share(data), 1.0, "from the first byte on")
            host.close_terminal()
            time.sleep(1.5)
            host.open()
            later = host.read_for(2)
            self.assertGreater(int(re.findall(rb"GGA,(\d{6})", later)[0]), int(re.findall(rb"GGA,(\d{6})", data)[-1]) + 1,
                               "what was said to nobody is lost")
            self.assertEqual(emulator.stop(), 0, emulator.log)

    def test_is_configured_by_ubx(self):
        with self.emulator("--board", "ublox-f9p") as emulator, Host(emulator.tty) as host:
            host.enumerate()
            host.open()
            host.write(ubx((0x0A, 0x04)))
            self.assertIn(b"\xb5\x62\x0a\x04", host.read_for(1))
            # CFG-MSGOUT-UBX_NAV_PVT_USB, CFG-USBOUTPROT-NMEA off
            host.write(valset([(0x20910009, 1), (0x10780002, 0)]))
            answer = host.read_for(1.5)
            self.assertIn(ubx((0x05, 0x01), b"\x06\x8a"), answer)
            data = host.read_for(2.2)
            self.assertGreaterEqual(data.count(b"\xb5\x62\x01\x07\x5c\x00"), 2)
            self.assertNotIn(b"$G", data)
            host.write(ubx((0x06, 0x1B)))  # CFG-USB
            told = host.read_for(1)
            told = told[told.index(b"\xb5\x62\x06\x1b"):]
            self.assertEqual(struct.unpack("<HH", told[6:10]), (0x1546, 0x01A9))
            self.assertEqual(told[50:82].rstrip(b"\0"), b"u-blox GNSS receiver")
            host.write(ubx((0x06, 0x00), b"\x03"))  # CFG-PRT of port 3
            self.assertIn(b"\xb5\x62\x06\x00\x14\x00\x03", host.read_for(1))
            self.assertEqual(emulator.stop(), 0, emulator.log)

    def test_tells_of_break_and_lines(self):
        with self.emulator("--duration", 60) as emulator, Host(emulator.tty) as host:
            host.enumerate()
            host.set_line(115200, stop=2, parity=2, bits=7)
            self.assertEqual(host.control(0xA1, 0x21, length=7), (0, struct.pack("<IBBB", 115200, 2, 2, 7)))
            self.assertEqual(host.control(0x21, 0x23, 250), (0, b""))
            host.open()
            host.read_for(2)
            emulator.said(r"(sends a break of 250 ms)")
            self.assertEqual(emulator.stop(), 0, emulator.log)

    def test_cancels_transfers(self):
        with self.emulator() as emulator, Host(emulator.tty) as host:
            host.enumerate()
            waiting = host.submit(NOTIFY, True, 64)
            host.wait_for(waiting)
            waiting = host.submit(NOTIFY, True, 64)
            self.assertEqual(host.unlink(waiting), UNLINKED)
            self.assertEqual(host.unlink(waiting), 0, "it is over")
            poll = host.submit(DATA_IN, True, 128)
            host.wait_for(poll)
            self.assertEqual(host.unlink(poll), 0)
            self.assertEqual(emulator.stop(), 0, emulator.log)

    def test_a_generic_adapter_has_the_speed_of_its_line(self):
        with self.emulator("--board", "ublox-m10") as emulator, Host(emulator.tty) as host:
            emulator.said(r"(ublox-m10 has no USB of its own)")
            device, _, _ = host.enumerate()
            self.assertEqual(device[8:12].hex(), "2505a7a4")
            host.set_line(9600)
            host.open()
            self.assertNotIn(b"$GNGGA", host.read_for(2.5), "the receiver speaks at 38400")
            host.set_line(38400)
            host.read_for(1.5)
            self.assertIn(b"$GNGGA", host.read_for(2.5))
            self.assertEqual(emulator.stop(), 0, emulator.log)

    def test_is_unplugged_by_a_fault_and_attached_again(self):
        with open_folder() as folder:
            scenario = pathlib.Path(folder, "unplug.toml")
            scenario.write_text(SCENARIO.format(duration=30, board="ublox-m8",
                                                rest='[[fault]]\nkind = "unplugged"\nat_s = 4\nfor_s = 3\n'))
            with Emulator(scenario, "--model", "ideal") as emulator:
                with Host(emulator.tty) as host:
                    host.enumerate()
                    host.open()
                    begun = time.monotonic()
                    host.read_for(20)
                    self.assertLess(time.monotonic() - begun, 15, "the server pulls the plug")
                self.assertEqual(listed(emulator.tty), [])
                with self.assertRaises(ImportRefused):
                    Host(emulator.tty)
                end = time.monotonic() + 20
                while not listed(emulator.tty):
                    self.assertLess(time.monotonic(), end)
                    time.sleep(0.2)
                with Host(emulator.tty) as host:
                    host.enumerate()
                    host.open()
                    self.assertIn(b"GGA", host.read_for(2.5))
                self.assertEqual(emulator.stop(), 0, emulator.log)
                self.assertIn("has lost the receiver: it is unplugged", emulator.log)

    def test_rule_breakers_are_closed_and_told_of(self):
        with self.emulator() as emulator:
            breaches = [b"GET / HTTP/1.1\r\n\r\n", struct.pack(">HHI", 0x0111, 0x8001, 0)]
            for breach in breaches:
                with usbip_client.connect(emulator.tty) as connection:
                    connection.sendall(breach)
                    self.assertEqual(self.rest_of(connection), b"")
            inside = [struct.pack(">10I8x", 1, 1, 1 << 16 | 2, 0, 1, 0, 0x7FFFFFFF, 0, 0xFFFFFFFF, 0),
                      struct.pack(">10I8x", 1, 1, 1 << 16 | 2, 1, 2, 0, 64, 0, 1000000, 0),
                      struct.pack(">10I8x", 1, 1, 1 << 16 | 3, 1, 2, 0, 64, 0, 0, 0), b"\xff" * 48]
            for breach in inside:
                with Host(emulator.tty) as host:
                    host.connection.sendall(breach)
                    self.assertEqual(self.rest_of(host.connection), b"")
            with Host(emulator.tty) as host:
                host.connection.sendall(struct.pack(">III", 1, 1, 1 << 16 | 2))
            time.sleep(1.2)
            with Host(emulator.tty) as host:
                host.enumerate()
                host.open()
                self.assertIn(b"GGA", host.read_for(2.5), "the run goes on")
            self.assertEqual(emulator.stop(), 0)
            for told in ("version 0x4745; expected 0x0111", "request 0x8001", "a transfer of 2147483647 bytes",
                         "1000000 isochronous packets", "a command for device 0x10003", "command 0xffffffff",
                         "in the middle of a message"):
                self.assertEqual(emulator.log.count(told), 1, f"{told}: {emulator.log}")

    @staticmethod
    def rest_of(connection):
        """All until the server closes."""
        data = b""
        try:
            while piece := connection.recv(4096):
                data += piece
        except ConnectionResetError:
            pass
        return data

    @staticmethod
    def imported(address):
        """The device. Its import may have overtaken the reset that ends the one before, and be answered "busy"."""
        for _ in range(100):
            try:
                return Host(address)
            except ImportRefused:
                time.sleep(0.01)
        return Host(address)

    def test_a_thousand_pulled_plugs(self):
        with open_folder() as folder:
            with self.emulator("--record", folder, "--duration", 600, "--speed", 5) as emulator:
                process = pathlib.Path("/proc", str(emulator.process.pid))
                measured = []
                for count in range(1000):
                    host = self.imported(emulator.tty)
                    if count % 4 == 0:
                        host.enumerate()
                        host.open()
                        host.heard.clear()
                    else:
                        host.connection.sendall(bytes(count % 47 + 1))
                    # As when the cable is pulled: a reset, not an orderly end.
                    host.connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
                    host.detach()
                    emulator.listen()
                    if count % 100 == 99:
                        measured.append((len(os.listdir(process / "fd")), resident_kb(process)))
                with Host(emulator.tty) as host:
                    host.enumerate()
                    host.open()
                    self.assertIn(b"GGA", host.read_for(2))
                self.assertEqual(emulator.stop(), 0, emulator.log[-1000:])
            epochs = pathlib.Path(folder, "fixes.csv").read_text().splitlines()
            summary = json.loads(pathlib.Path(folder, "run.json").read_text())
        descriptors, memory = zip(*measured)
        self.assertLessEqual(max(descriptors) - min(descriptors), 3, measured)
        self.assertLess(memory[-1] - memory[1], 2048, measured)
        self.assertEqual(len(epochs) - 1, summary["epochs"])
        times = [float(line.split(",")[2]) for line in epochs[1:]]
        self.assertGreater(len(times), 10)
        self.assertEqual([later - earlier for earlier, later in zip(times, times[1:])], [1.0] * (len(times) - 1), "no gap")

    def test_an_hour_of_simulated_data(self):
        # 45 kB/s: a host that does not come to its turn for a third of a second, beside compilers, loses none of them.
        with open_folder() as folder:
            with self.emulator("--record", folder, "--duration", 3600, "--speed", 80, "--wait-for-client") as emulator:
                with Host(emulator.tty) as host:
                    host.enumerate()
                    host.open()
                    data = host.read_for(120)
                    self.assertEqual(emulator.finish(30), 0, emulator.log)
            recorded = pathlib.Path(folder, "port0.out").read_bytes()
            port = json.loads(pathlib.Path(folder, "run.json").read_text())["ports"][0]
        self.assertEqual(recorded.count(b"GGA"), 3600)
        self.assertEqual(port["bytes_out"] + port["bytes_unheard"] + port["bytes_lost"], len(recorded))
        self.assertEqual(port["bytes_lost"], 0)
        self.assertEqual(port["bytes_unheard"], 0)
        # What the last look left on its way is lost with the run's end.
        self.assertGreater(len(data), len(recorded) - 16384)
        self.assertEqual(data, recorded[:len(data)], "every byte")


def resident_kb(process):
    """Resident memory of a process."""
    return int(re.search(r"VmRSS:\s+(\d+)", (process / "status").read_text()).group(1))


if __name__ == "__main__":
    unittest.main(verbosity=2)
