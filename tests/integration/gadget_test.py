"""tools/gadget on a played configfs: what it writes, and one line for each thing that is missing."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

GADGET = pathlib.Path(__file__).resolve().parents[2] / "tools/gadget"


class GadgetTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="skyloop-test-")
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)
        self.configfs, self.controllers = self.root / "config", self.root / "udc"
        (self.configfs / "usb_gadget").mkdir(parents=True)
        (self.controllers / "fe980000.usb").mkdir(parents=True)
        self.gadget = self.configfs / "usb_gadget/skyloop"

    def run_gadget(self, *arguments, before_making="true"):
        # The kernel makes these folders with each gadget and each configuration.
        environment = os.environ | {"SKYLOOP_CONFIGFS": str(self.configfs), "SKYLOOP_UDC_CLASS": str(self.controllers),
                                    "PATH": f"{self.root}:{os.environ['PATH']}"}
        played = self.root / "mkdir"
        played.write_text(f'#!/bin/sh\n/bin/mkdir -p "$@"\n{before_making}\n')
        played.chmod(0o755)
        return subprocess.run([GADGET, *arguments], capture_output=True, text=True, timeout=20, env=environment)

    def refused(self, *arguments, **played):
        done = self.run_gadget(*arguments, **played)
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(done.stdout, "")
        return done.stderr

    def refused_in_a_line(self, *arguments):
        said = self.refused(*arguments)
        self.assertEqual(len(said.splitlines()), 1, said)
        return said

    def test_makes_a_serial_device(self):
        done = self.run_gadget("create", "1546:01a8", "u-blox GNSS receiver", "A1")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "/dev/ttyGS0\n", ""))

        def written(path):
            return (self.gadget / path).read_text().strip()
        self.assertEqual((written("idVendor"), written("idProduct")), ("0x1546", "0x01a8"))
        self.assertEqual(written("strings/0x409/product"), "u-blox GNSS receiver")
        self.assertEqual(written("strings/0x409/serialnumber"), "A1")
        self.assertEqual(written("UDC"), "fe980000.usb")
        self.assertEqual((self.gadget / "configs/c.1/acm.0").resolve(), self.gadget / "functions/acm.0")
        (self.controllers / "fe980000.usb/state").write_text("configured\n")
        self.assertEqual(self.run_gadget("status").stdout, "/dev/ttyGS0 on fe980000.usb: configured\n")
        self.assertIn("is there already", self.refused_in_a_line("create"))

    def test_says_what_is_missing(self):
        self.assertIn("there is no gadget", self.refused_in_a_line("remove"))
        self.assertIn("there is no gadget", self.refused_in_a_line("status"))
        for ids in ("1546", "1546:1a8", "1546:01ag", "x"):
            self.assertIn(f"ids '{ids}': expected VENDOR:PRODUCT", self.refused_in_a_line("create", ids))
        (self.controllers / "fe980000.usb").rmdir()
        self.assertIn("no USB device controller", self.refused_in_a_line("create"))
        self.controllers.rmdir()
        self.assertIn("dtoverlay=dwc2", self.refused_in_a_line("create"))

    def test_a_step_that_fails_is_the_failure_of_all(self):
        for step in ("idVendor", "strings/0x409/product", "configs/c.1/strings/0x409/configuration", "configs/c.1/acm.0"):
            with self.subTest(step=step):
                # A folder cannot be written to, and is no link.
                blocked = f'/bin/mkdir -p "{self.gadget / step}/acm.0"'
                self.assertIn("the kernel refused the gadget", self.refused("create", before_making=blocked))
                shutil.rmtree(self.gadget, ignore_errors=True)
        self.assertEqual(self.run_gadget("create").returncode, 0)

    def test_unknown_words_are_answered_with_the_usage(self):
        done = self.run_gadget("destroy")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("gadget create", done.stderr)
        self.assertEqual(self.run_gadget("--help").returncode, 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
