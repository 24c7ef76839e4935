"""skyloop devices: what it knows is what its page tells, its rules are rules, and its JSON has the keys that the page names."""

import json
import os
import pathlib
import re
import subprocess
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MATCH = r'(SUBSYSTEM|ACTION|DRIVER|ENV\{\w+\}|ATTRS?\{\w+\})=="[\w-]+"'
ASSIGNMENT = r'((GROUP|MODE|ENV\{\w+\}|ATTR\{\w+\})="[\w-]+"|TAG\+="uaccess")'
RULE = re.compile(rf"{MATCH}(, {MATCH})*(, {ASSIGNMENT})+")


def devices(*arguments, environment=None):
    return subprocess.run([os.environ["SKYLOOP"], "devices", *arguments], capture_output=True, text=True, timeout=60,
                          env={**os.environ, **(environment or {})})


def keys_of_table(page):
    """Keys that docs/devices.md tells of a device."""
    table = page[page.index("| key | meaning |"):]
    rows = [line.split("|")[1] for line in table.splitlines()[2:] if line.startswith("|")]
    return {name for row in rows for name in re.findall(r"`(\w+)`", row)}


class Known(unittest.TestCase):
    def test_the_page_is_what_the_program_tells(self):
        page = (ROOT / "docs/known_devices.md").read_text()
        self.assertEqual(devices("--known").stdout, page,
                         "docs/known_devices.md is old: skyloop devices --known > docs/known_devices.md")

    def test_every_device_says_what_it_is(self):
        known = json.loads(devices("--known", "--json").stdout)["known"]
        self.assertGreater(len(known), 40)
        for device in known:
            with self.subTest(device["name"]):
                self.assertRegex(device["title"], r"\w")
                self.assertRegex(device["good_for"], r"\w")

    def test_rules_are_rules_for_every_id(self):
        rules = devices("--udev-rules").stdout
        for line in rules.splitlines():
            if line and not line.startswith("#"):
                self.assertTrue(RULE.fullmatch(line), line)
        for device in json.loads(devices("--known", "--json").stdout)["known"]:
            for ids in device["usb"] + device["bootloader_usb"]:
                vendor, product = ids.split(":")
                for where in ("ATTR", "ATTRS"):
                    self.assertIn(f'{where}{{idVendor}}=="{vendor}", {where}{{idProduct}}=="{product}"', rules)

    def test_mistakes_in_a_file_are_told(self):
        with tempfile.TemporaryDirectory() as folder:
            adapters = pathlib.Path(folder) / "boards/adapters"
            adapters.mkdir(parents=True)
            (adapters / "mine.toml").write_text('[[device]]\nname = "mine"\nkind = "bridge"\nusb = "1546:zz"\n')
            done = devices(environment={"SKYLOOP_DATA_DIR": folder})
        self.assertEqual(done.returncode, 2)
        self.assertIn("mine.toml:4:7: device.usb: is '1546:zz'", done.stderr)


class Plugged(unittest.TestCase):
    def test_json_has_the_keys_of_the_page(self):
        done = devices("--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        told = keys_of_table((ROOT / "docs/devices.md").read_text())
        for device in json.loads(done.stdout)["devices"]:
            self.assertEqual(set(device), told)

    def test_the_table(self):
        done = devices()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout + done.stderr, r"PORT +USB +KIND|no USB device is plugged in")

    def test_a_watch_ends_in_time(self):
        start = time.monotonic()
        done = devices("--watch", "--duration", "1.2", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreaterEqual(time.monotonic() - start, 1.1)
        for line in done.stdout.splitlines():
            self.assertIn(json.loads(line)["event"], ("arrived", "left"))

    def test_a_watch_begins_with_the_lines_of_the_machine(self):
        own = [device for device in json.loads(devices("--json").stdout)["devices"] if device["usb"] is None]
        lines = [json.loads(line) for line in devices("--watch", "--duration", "0.3", "--json").stdout.splitlines()]
        self.assertEqual([line["device"] for line in lines if line["device"]["usb"] is None], own)

    def test_misuse(self):
        for arguments, words in ((["--duration", "3"], "--watch"), (["--watch", "--udev-rules"], "--udev-rules"),
                                 (["--watch", "--duration", "-1"], "--duration")):
            with self.subTest(arguments):
                done = devices(*arguments)
                self.assertEqual(done.returncode, 2)
                self.assertIn(words, done.stderr)


if __name__ == "__main__":
    unittest.main()
