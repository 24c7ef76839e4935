"""The unit, the user and the rules that come with an installation, as systemd and udev read them."""
import pathlib
import re
import tempfile
import unittest

from packages import BUILD, ROOT, SKYLOOP, need, run

need("systemd-analyze")


class Unit(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="skyloop-unit-")
        self.addCleanup(folder.cleanup)
        text = (BUILD / "tools/skyloop@.service").read_text()
        self.program = re.search(r"^ExecStart=(\S+) run (\S+)/%i.toml$", text, re.MULTILINE)[1]
        self.text = text
        # Where it is not installed, another program stands for it, and its manual for those.
        self.unit = pathlib.Path(folder.name) / "skyloop@.service"
        self.unit.write_text(re.sub(r"^Documentation=.*\n", "", text, flags=re.MULTILINE).replace(self.program, SKYLOOP))

    def test_systemd_has_nothing_to_say(self):
        done = run("systemd-analyze", "verify", self.unit)
        self.assertEqual((done.stdout, done.stderr), ("", ""))

    def test_it_is_shut_to_the_rest(self):
        told = run("systemd-analyze", "security", "--offline=true", "--threshold=20", self.unit)
        exposure = float(re.search(r"Overall exposure level for \S+: ([0-9.]+) ", told.stdout)[1])
        self.assertLess(exposure, 2.0)

    def test_it_can_do_what_a_live_run_needs(self):
        def value(key):
            return re.findall(rf"^{key}=(.*)$", self.text, re.MULTILINE)

        self.assertEqual((value("PrivateDevices"), value("RestrictRealtime")), (["no"], ["no"]))
        self.assertGreaterEqual(int(value("LimitRTPRIO")[0]), 10)  # src/run/emulator/real_time.cpp asks for 10
        self.assertEqual(value("LimitMEMLOCK"), ["infinity"])
        for device in ("char-ttyS", "char-ttyUSB", "char-ttyACM", "char-ttyTHS", "char-ttymxc", "char-rfcomm", "char-pts",
                       "/dev/ptmx", "char-hidraw", "char-usb_device"):
            self.assertIn(f"{device} rw", value("DeviceAllow"))
        # A run that restores the power by a command gives it 10 s, three times.
        self.assertGreater(int(value("TimeoutStopSec")[0]), 30)
        self.assertEqual(value("SupplementaryGroups"), ["dialout plugdev"])
        self.assertNotIn("@", self.text.replace("@system-service", "").replace("@privileged", ""))  # all names were filled in

    def test_its_demonstration_is_a_scenario(self):
        run(SKYLOOP, "check", ROOT / "tools/service/demo.toml")


class User(unittest.TestCase):
    def test_sysusers_makes_it(self):
        need("systemd-sysusers")
        with tempfile.TemporaryDirectory(prefix="skyloop-users-") as folder:
            etc = pathlib.Path(folder) / "etc"
            etc.mkdir()
            (etc / "passwd").write_text("root:x:0:0:root:/root:/bin/sh\n")
            (etc / "group").write_text("root:x:0:\ndialout:x:20:\nplugdev:x:46:\n")
            run("systemd-sysusers", f"--root={folder}", ROOT / "tools/service/skyloop.conf")
            self.assertRegex((etc / "passwd").read_text(), r"\nskyloop:x:\d+:\d+:[^:]*:/var/lib/skyloop:/usr/sbin/nologin\n")
            self.assertIn("dialout:x:20:skyloop\n", (etc / "group").read_text())


class Rules(unittest.TestCase):
    def test_are_those_of_the_devices_that_are_known(self):
        rules = (BUILD / "help_pages/70-skyloop.rules").read_text()
        self.assertEqual(rules, run(SKYLOOP, "devices", "--udev-rules").stdout)
        for word in ('TAG+="uaccess"', 'GROUP="dialout"', 'GROUP="plugdev"', 'ENV{ID_MM_DEVICE_IGNORE}="1"'):
            self.assertIn(word, rules)


if __name__ == "__main__":
    unittest.main()
