"""pyserial's own rfc2217:// client, and a plain server that is called: wires over the network."""
import socket
import sys
import time
import unittest

from pty_client_test import good_share
from session import Emulator, skip
from tcp_client_test import read_for

try:
    import serial
except ImportError:
    skip("python3-serial is not installed; apt-get install python3-serial")

START = "2026-03-01T00:00:00Z"
POLL_OF_MON_VER = bytes.fromhex("b5620a0400000e34")
BAUD_115200 = bytes.fromhex("b56206001400" "01000000d0080000" "00c20100" "0700" "0300" "0000" "0000" "c07e")


def read_serial(port, seconds):
    """All bytes of some seconds."""
    data = b""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        data += port.read(4096)
    return data


class Rfc2217Test(unittest.TestCase):
    def emulator(self, *arguments):
        return Emulator("--port", "rfc2217:0", "--start", START, "--model", "ideal", *arguments)

    def client(self, emulator, baud, **more):
        return serial.serial_for_url(f"rfc2217://{emulator.tty}", baudrate=baud, timeout=0.1, **more)

    def test_sentences_come_at_the_right_speed(self):
        with self.emulator() as emulator, self.client(emulator, 9600) as port:
            data = read_serial(port, 3)
            self.assertGreater(data.count(b"GGA"), 1)
            self.assertGreater(good_share(data), 0.99)
            self.assertEqual((port.cts, port.dsr, port.cd, port.ri), (True, True, True, False))

    def test_a_wrong_speed_garbles_and_the_right_one_mends(self):
        with self.emulator() as emulator, self.client(emulator, 38400) as port:
            self.assertLess(good_share(read_serial(port, 2.5)), 0.2)
            port.baudrate = 9600
            read_serial(port, 1.5)
            self.assertGreater(good_share(read_serial(port, 2.5)), 0.9)

    def test_a_poll_is_answered_and_the_speed_of_both_is_changed(self):
        with self.emulator() as emulator, self.client(emulator, 9600) as port:
            port.write(POLL_OF_MON_VER)
            self.assertIn(POLL_OF_MON_VER[:4], read_serial(port, 2))
            port.write(BAUD_115200)
            port.flush()
            time.sleep(0.3)
            port.baudrate = 115200
            read_serial(port, 1.2)
            data = read_serial(port, 2.5)
            self.assertGreater(data.count(b"GGA"), 1)
            self.assertGreater(good_share(data), 0.95)

    def test_lines_format_break_and_purge_are_taken(self):
        with self.emulator() as emulator, self.client(emulator, 9600, bytesize=7, parity="E", stopbits=2) as port:
            port.dtr, port.rts = False, True
            port.break_condition = True
            port.break_condition = False
            port.reset_input_buffer()
            port.reset_output_buffer()
            port.rtscts = True
            self.assertGreater(len(read_serial(port, 1.5)), 100, "and the run goes on")
            self.assertEqual(emulator.stop(), 0, emulator.log)

    def test_the_next_client_is_welcome(self):
        with self.emulator() as emulator:
            for _ in range(3):
                with self.client(emulator, 9600) as port:
                    self.assertGreater(len(read_serial(port, 1.3)), 100)
            self.assertEqual(emulator.stop(), 0, emulator.log)

    def test_hostile_option_text_breaks_nothing(self):
        with self.emulator() as emulator:
            host, number = emulator.tty.rsplit(":", 1)
            with socket.create_connection((host, int(number)), timeout=10) as client:
                for text in (b"\xff", b"\xff\xfa" + b"\x2c" * 5000, b"\xff\xfd\x63" * 20000, b"\xff\xf0\xff\xfa\xff\xf0",
                             bytes(range(256)) * 20):
                    client.sendall(text)
                self.assertFalse(read_for(client, 2)[1])
            with self.client(emulator, 9600) as port:
                self.assertGreater(good_share(read_serial(port, 3)), 0.9)
            self.assertEqual(emulator.stop(), 0, emulator.log)

    def test_off_loopback_is_told_of(self):
        with Emulator("--port", "rfc2217:0.0.0.0:0", "--start", START, "--model", "ideal") as emulator:
            emulator.said("(whoever reaches this machine can read and configure the receiver)")
            self.assertEqual(emulator.stop(), 0, emulator.log)


class TcpConnectTest(unittest.TestCase):
    def test_a_server_is_called_and_called_again(self):
        with socket.create_server(("127.0.0.1", 0)) as server:
            server.settimeout(10)
            address = f"127.0.0.1:{server.getsockname()[1]}"
            with Emulator("--port", f"tcp-connect:{address}", "--start", START, "--model", "ideal") as emulator:
                for _ in range(2):
                    with server.accept()[0] as client:
                        self.assertGreater(read_for(client, 2.5)[0].count(b"GGA"), 0)
                emulator.said("(connection lost; trying again)")
                with server.accept()[0] as client:
                    client.sendall(POLL_OF_MON_VER)
                    self.assertIn(POLL_OF_MON_VER[:4], read_for(client, 3)[0])
                self.assertEqual(emulator.stop(), 0, emulator.log)

    def test_a_server_that_comes_late(self):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            number = taken.getsockname()[1]
        with Emulator("--port", f"tcp-connect:127.0.0.1:{number}", "--start", START, "--model", "ideal") as emulator:
            emulator.said("(Connection refused; trying again)")
            with socket.create_server(("127.0.0.1", number)) as server:
                server.settimeout(10)
                with server.accept()[0] as client:
                    self.assertGreater(read_for(client, 2.5)[0].count(b"GGA"), 0)
            self.assertEqual(emulator.stop(), 0, emulator.log)


if __name__ == "__main__":
    unittest.main(verbosity=2, argv=sys.argv[:1])
