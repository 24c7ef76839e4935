"""skyloop and a real kernel's drivers: a serial adapter (ftdi_sio) on the pty, the adapter pulled and put back, skyloop inside
the machine with that adapter as its own wire, and a USB receiver (cdc_acm) over USB/IP. One machine serves all tests; its
transcript is printed and kept.
"""
import os
import pathlib
import re
import shutil
import socket
import sys
import tempfile
import time
import unittest

import kernel as kernels
import machine as machines
from machine import Initramfs, Machine

TESTS = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS / "integration"), str(TESTS / "conformance")]
import ubx  # noqa: E402
from serial_test import Autopilot, port_settings  # noqa: E402
from session import SKYLOOP, Emulator, skip, skyloop  # noqa: E402

ARTIFACTS = pathlib.Path(os.environ.get("SKYLOOP_ARTIFACTS", pathlib.Path(tempfile.gettempdir(), "skyloop-vm")))
LIFE = int(os.environ.get("SKYLOOP_VM_SECONDS", 175))  # of the machine
SPEED = int(os.environ.get("SKYLOOP_VM_SPEED", 60))  # of the hour over USB/IP
PLACES = ["1", "2", "4.1"]  # where each adapter is plugged in; 4 is the hub
START = ("--start", "2026-03-01T00:00:00Z", "--model", "ideal")


def probed(text):
    """What serial_probe told, as numbers where they are."""
    values = dict(re.findall(r"(\w+)=(\S+)", text))
    return {name: float(value) if re.fullmatch(r"-?[\d.]+", value) else value for name, value in values.items()}


def heard_sentences(data):
    """How many sentences are whole, and how many bytes between the first and the last of them belong to nothing."""
    parser = ubx.Parser()
    whole = [item for item in parser.feed(data[data.find(b"$"):]) if isinstance(item, ubx.Sentence)]
    return len(whole), len(parser.noise)


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class VirtualMachineTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.began = time.monotonic()
        cls.folder = tempfile.TemporaryDirectory(prefix="skyloop-vm-")
        cls.addClassCleanup(cls.folder.cleanup)
        initramfs = Initramfs(cls.folder.name, KERNEL)
        initramfs.compiled("serial_probe")
        initramfs.compiled("uhid_devices")
        initramfs.loaded("libhidapi-hidraw.so.0")
        initramfs.program(machines.kernels.tool("usbip"))
        initramfs.program(SKYLOOP, strip=True)
        shutil.copytree(pathlib.Path(SKYLOOP).parents[1] / "share/skyloop/boards", initramfs.root / "share/skyloop/boards")
        cls.gps = cls.enterClassContext(Emulator("--board", "ublox-m9", "--port", f"pty:{cls.folder.name}/gps0", *START))
        cls.autopilot = Autopilot(pathlib.Path(cls.folder.name, "autopilot"))
        cls.addClassCleanup(cls.autopilot.unplug)
        cls.machine = Machine(KERNEL, initramfs.archive(), cls.folder.name,
                              ["-chardev", f"serial,id=gps,path={cls.gps.tty}",
                               "-device", "usb-serial,id=adapter0,chardev=gps,bus=usb.0,port=1,serial=GPS0",
                               "-chardev", f"serial,id=autopilot,path={cls.autopilot.link}",
                               "-device", "usb-hub,id=hub0,bus=usb.0,port=4,port-power=on"], life=LIFE)
        cls.addClassCleanup(cls.tell)
        cls.ready = time.monotonic() - cls.began

    @classmethod
    def tell(cls):
        """Ends the machine and shows what happened in it."""
        on = cls.machine.close()
        ARTIFACTS.mkdir(parents=True, exist_ok=True)
        text = (f"Linux {cls.machine.release}, up and asked {cls.ready:.1f} s after the beginning, on for {on:.1f} s\n"
                f"{cls.machine.text()}")
        (ARTIFACTS / "transcript.txt").write_text(text)
        (ARTIFACTS / "console.txt").write_text(cls.machine.console_text())
        print(text)

    def setUp(self):
        self.machine.say(f"--- {self.id().rpartition('.')[2]}")

    def probe(self, device, speed, seconds, *epochs):
        text = self.machine.run(f"serial_probe {device} {speed} {seconds} {' '.join(map(str, epochs))}", patience=seconds * 3 + 20)
        return probed(text)

    def adapter(self, number, chardev):
        """Plugs a serial adapter (FT232) in; its tty appears under any name."""
        self.machine.monitor.command("device_add", driver="usb-serial", id=f"adapter{number}", chardev=chardev, bus="usb.0",
                                     port=PLACES[number], serial=f"GPS{number}")
        self.machine.say(f"(adapter {number} plugged in)")

    def pull(self, number):
        self.machine.monitor.command("device_del", id=f"adapter{number}")
        self.machine.say(f"(adapter {number} pulled)")

    def test_1_adapter_at_the_right_speed_and_at_a_wrong_one(self):
        self.machine.wait_for("test -c /dev/ttyUSB0")
        self.machine.run("cat /sys/bus/usb-serial/devices/ttyUSB0/latency_timer")
        self.probe("/dev/ttyUSB0", 38400, 2)  # what waited in QEMU from before
        right = self.probe("/dev/ttyUSB0", 38400, 8)
        self.assertGreater(right["sentences"], 30)
        self.assertEqual([right["broken"], right["gaps"], right["ended"]], [0, 0, "-"])
        self.assertGreaterEqual(right["answers"], 6)
        wrong = self.probe("/dev/ttyUSB0", 57600, 4)
        self.assertGreater(wrong["bytes"], 500)
        self.assertEqual([wrong["sentences"], wrong["answers"]], [0, 0])
        self.probe("/dev/ttyUSB0", 38400, 2)
        self.assertEqual(self.probe("/dev/ttyUSB0", 38400, 3)["broken"], 0)

    def test_1_adapter_is_known(self):
        self.machine.wait_for("test -c /dev/ttyUSB0")
        listed = self.machine.run("skyloop devices")
        self.assertRegex(listed, r"0403:6001 +bridge +/dev/ttyUSB0 +FTDI FT232R")
        self.assertIn("serial GPS0", listed)

    def test_2_adapter_pulled_and_put_back(self):
        probe = self.machine.start("serial_probe /dev/ttyUSB0 38400 30")
        time.sleep(2)
        self.pull(0)
        self.machine.wait_for(f"grep -q ended= {probe}")
        self.assertEqual(probed(self.machine.run(f"cat {probe}"))["ended"], "hung")
        self.machine.wait_for("test ! -e /dev/ttyUSB0")
        self.adapter(0, "gps")
        self.machine.wait_for("test -c /dev/ttyUSB0")
        self.probe("/dev/ttyUSB0", 38400, 2)
        again = self.probe("/dev/ttyUSB0", 38400, 4)
        self.assertGreater(again["sentences"], 10)
        self.assertEqual([again["broken"], again["gaps"]], [0, 0])

    def test_3_program_inside_follows_its_adapter(self):
        self.adapter(1, "autopilot")
        self.machine.wait_for("test -c /dev/ttyUSB1")
        run = self.machine.start("skyloop run --board ublox-m9 --port serial:/dev/ttyUSB1 --duration 60 " + " ".join(START))
        heard = self.autopilot.read_for(30, until=b"GGA")
        self.machine.run(f"cat {run}")
        self.assertIn(b"GGA", heard)
        self.assertEqual(self.autopilot.speed(), 38400)
        self.autopilot_hears_sentences()
        self.assertEqual(self.machine.run("cat /sys/bus/usb-serial/devices/ttyUSB1/latency_timer"), "1")
        self.autopilot.write(port_settings(115200))
        answered = self.autopilot.read_for(5, until=b"\xb5\x62\x05\x01\x02\x00\x06\x00")
        self.assertIn(b"\xb5\x62\x05\x01\x02\x00\x06\x00", answered)
        self.assertEqual(self.autopilot.speed(), 115200)
        self.pull(1)
        self.machine.wait_for(f"grep -q 'is gone' {run}")
        self.adapter(1, "autopilot")
        self.machine.wait_for(f"grep -q 'is back' {run}")
        self.autopilot.read_for(5, until=b"GGA")
        self.autopilot_hears_sentences()
        self.assertEqual(self.autopilot.speed(), 115200)
        said = self.machine.stop(run, by="INT")
        self.assertNotIn("did not send", said)
        self.pull(1)

    def autopilot_hears_sentences(self):
        whole, noise = heard_sentences(self.autopilot.read_for(4))
        self.machine.say(f"(the autopilot has heard {whole} sentences and {noise} other bytes)")
        self.assertGreater(whole, 20)
        self.assertEqual(noise, 0)

    def usbip_receiver(self, *arguments):
        """skyloop as a USB receiver for other machines, and the options by which `usbip` finds it."""
        port = free_port()
        emulator = self.enterContext(Emulator("--board", "ublox-m8", "--port", f"usb=usbip:127.0.0.1:{port}", *START, *arguments))
        return emulator, f"--tcp-port {port}"

    def attach(self, options):
        self.machine.run(f"timeout 20 usbip {options} attach -r {machines.HOST} -b 1-1")
        self.machine.wait_for("test -c /dev/ttyACM0")

    def test_4_usb_receiver_is_attached_detached_and_attached_again(self):
        emulator, options = self.usbip_receiver()
        self.assertIn("1546:01a8", self.machine.run(f"timeout 20 usbip {options} list -r {machines.HOST}"))
        for speed in (9600, 460800):
            self.attach(options)
            heard = self.probe("/dev/ttyACM0", speed, 5)
            self.assertGreaterEqual(heard["epochs"], 4)
            self.assertEqual([heard["broken"], heard["gaps"], heard["ended"]], [0, 0, "-"])
            self.assertEqual(heard["answers"], heard["asked"])
            self.machine.run("usbip detach -p 0")
            self.machine.wait_for("test ! -e /dev/ttyACM0")
        self.assertEqual(emulator.stop(), 0, emulator.log)
        self.assertEqual(len(re.findall("attached by", emulator.log)), 2)
        self.machine.say(f"(skyloop: {emulator.log.splitlines()[-2:]})")

    def test_5_usb_receiver_that_vanishes_hangs_up(self):
        emulator, options = self.usbip_receiver()
        self.attach(options)
        probe = self.machine.start("serial_probe /dev/ttyACM0 115200 30")
        self.machine.run("sleep 2")
        emulator.stop()
        self.machine.wait_for(f"grep -q ended= {probe}")
        heard = probed(self.machine.run(f"cat {probe}"))
        self.assertGreater(heard["sentences"], 5)
        self.assertNotEqual(heard["ended"], "-")
        self.machine.wait_for("test ! -e /dev/ttyACM0")

    def power(self, uri, order):
        """Runs `skyloop power`, where the program has it."""
        if not re.search(r"^ +power\b", skyloop("--help").stdout, re.MULTILINE):
            self.skipTest("this skyloop has no command `power`")
        return self.machine.run(f"skyloop power {uri} {order}", patience=40)

    def test_6_relay_of_a_hid_board(self):
        devices = self.machine.start("uhid_devices")
        self.machine.wait_for("test -c /dev/hidraw1")
        self.power("relay:16c0:05df/2", "off")
        self.assertIn("cut", self.power("relay:16c0:05df/2", "state"))
        self.power("relay:16c0:05df/2", "on")
        self.assertNotIn("cut", self.power("relay:16c0:05df/2", "state"))
        self.assertEqual(re.findall(r"relays (\d)", self.machine.stop(devices)), ["2", "0"])

    def test_7_power_of_a_hub_port(self):
        self.adapter(2, "autopilot")
        self.machine.wait_for("grep -qs GPS2 /sys/bus/usb/devices/*/serial")
        place = self.machine.run("cd /sys/bus/usb/devices && grep -ls GPS2 */serial").split("/")[0]
        # The hub of QEMU cuts the port and says so, but does not tell the kernel that what was there is gone, as a real one does.
        self.assertIn("cut", self.power(f"hub:{place}", "off"))
        self.assertIn("cut", self.power(f"hub:{place}", "state"))
        self.power(f"hub:{place}", "on")
        self.assertNotIn("cut", self.power(f"hub:{place}", "state"))
        self.pull(2)

    def test_8_bridge_of_hidraw_is_a_wire(self):
        """The bridge sends back each byte that it is given."""
        devices = self.machine.start("uhid_devices")
        self.machine.wait_for("test -c /dev/hidraw1")
        said = self.machine.run("skyloop run --board ublox-m9 --port hid:10c4:ea80 --duration 8 " + " ".join(START), patience=60)
        told = self.machine.stop(devices)
        self.assertIn("enabled 1", told)
        self.assertIn("uart 38400 parity 0 flow 0 data 3 stop 0", told)
        out, back = map(int, re.search(r"port 0: (\d+) bytes out, (\d+) in", said).groups())
        self.assertGreater(out, 2000)
        self.assertGreater(back, 0.8 * out)

    def test_9_as_much_of_an_hour_as_the_machine_has_time_for(self):
        emulator, options = self.usbip_receiver("--speed", str(SPEED), "--wait-for-client")
        seconds = int(min(3600 / SPEED + 30, self.machine.until - time.monotonic() - 15))
        self.assertGreater(seconds, 5, "the machine has taken its whole life for the other tests")
        self.attach(options)
        heard = self.probe("/dev/ttyACM0", 115200, seconds, 3600)
        self.machine.run("usbip detach -p 0")
        self.assertEqual(emulator.stop(), 0, emulator.log)
        lost = int((re.search(r"(\d+) bytes were lost", emulator.log) or [0, 0])[1])
        self.machine.say(f"({heard['epochs']:g} s of simulated time in {heard['seconds']:g} s; {lost} bytes were lost, as the machine "
                         "read too slowly)")
        self.assertGreaterEqual(heard["epochs"], min(3600, SPEED / 2 * (seconds - 3)))
        self.assertGreaterEqual(heard["answers"], heard["asked"] - (1 if lost == 0 else 5))
        if lost == 0:
            self.assertEqual([heard["broken"], heard["gaps"]], [0, 0])


if __name__ == "__main__":
    absent = machines.missing()
    if absent:
        skip(f"{absent} is not installed")
    KERNEL = kernels.find(ARTIFACTS.parent / "vm-kernel")
    if KERNEL is None:
        skip(f"no Debian kernel with its modules is installed, and no package lies in {kernels.CACHE}: tools/fetch_kernel")
    unittest.main(verbosity=2)
