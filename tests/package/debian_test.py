"""The packages of tools/package in a clean Debian 12: lintian has nothing to say, apt finds what they need, an ordinary user runs
the program, and after a purge nothing is left."""
import os
import pathlib
import re
import shutil
import tempfile
import unittest

import clean_debian
from packages import NAMES, ROOT, made_packages, need, run, skip, version

need("debootstrap", "lintian", "unshare", "chroot")
PACKAGES = made_packages()
if os.geteuid() != 0:
    skip("a chroot needs root")

# What apt and dpkg keep about themselves, and what changes whenever any package comes or goes.
VOLATILE = re.compile(r"^(dev|proc|sys|run|tmp|packages|var/(cache|log|tmp)|var/lib/(apt|dpkg)|etc/ld\.so\.cache)(/|$)")
RUN = r"""
cd /tmp
skyloop run --duration 5 --wait-for-client --at 46.4775,30.7326,77 --port pty:/tmp/gps0 2>/tmp/said &
for i in $(seq 100); do [ -e /tmp/gps0 ] && break; sleep 0.1; done
stty -F /tmp/gps0 raw -echo
timeout 30 cat /tmp/gps0 >/tmp/heard 2>/dev/null &
wait %1
"""


class Lintian(unittest.TestCase):
    def test_has_nothing_to_say(self):
        done = run("lintian", "--allow-root", "--fail-on", "error,warning", *PACKAGES.values(), check=False)
        told = [line for line in done.stdout.splitlines() if line[:2] in ("E:", "W:")]
        self.assertEqual((told, done.returncode), ([], 0), done.stderr)


class CleanDebian(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="skyloop-debian-", dir="/var/tmp")
        cls.addClassCleanup(folder.cleanup)
        cls.root = pathlib.Path(folder.name) / "root"
        clean_debian.make(cls.root)
        cls.inside("apt-get", "update", "-q")
        cls.inside("useradd", "--create-home", "--groups", "dialout", "tester")
        cls.before = cls.listing()

    @classmethod
    def inside(cls, *words, check=True):
        return clean_debian.inside(cls.root, *words, check=check)

    @classmethod
    def listing(cls):
        """Every file with its kind and mode; of those that list users, what they hold."""
        found = {}
        for folder, folders, files in os.walk(cls.root):
            for name in (*folders, *files):
                path = pathlib.Path(folder, name)
                inner = str(path.relative_to(cls.root))
                if not VOLATILE.match(inner):
                    held = path.read_text() if inner in ("etc/passwd", "etc/group", "etc/shadow", "etc/gshadow") else ""
                    found[inner] = (path.lstat().st_mode, held)
        return found

    def check_installation(self):
        self.assertEqual(self.inside("skyloop", "--version").stdout, f"skyloop {version()}\n")
        self.assertIn("ublox-m8 ", self.inside("skyloop", "boards").stdout)
        groups = self.inside("id", "-nG", "skyloop").stdout.split()
        self.assertEqual(sorted(groups), ["dialout", "plugdev", "skyloop"])
        self.assertTrue((self.root / "etc/skyloop/demo.toml").exists())
        self.assertEqual(self.inside("skyloop", "check", "/etc/skyloop/demo.toml").returncode, 0)
        self.inside("ldconfig", "-p")
        for name in NAMES:
            self.assertEqual(self.inside("dpkg", "--verify", name).stdout, "")

    def check_run(self):
        """As an ordinary user: five seconds of a receiver on a pty, heard by another program."""
        done = self.inside("runuser", "-u", "tester", "--", "sh", "-e", "-c", RUN, check=False)
        said = (self.root / "tmp/said").read_text()
        self.assertEqual(done.returncode, 0, said + done.stderr)
        heard = (self.root / "tmp/heard").read_bytes()
        sentences = re.findall(rb"\$(G[A-Z]{4}[^*]*)\*([0-9A-F]{2})\r\n", heard)
        self.assertGreaterEqual(len([s for s, _ in sentences if s[2:5] == b"RMC"]), 4, said)
        for text, told in sentences:
            value = 0
            for byte in text:
                value ^= byte
            self.assertEqual(value, int(told, 16), text)
        self.assertNotIn("geoid", said)

    def check_library(self):
        """A stranger's program by pkg-config, against the installed files; compiled outside, for this Debian is minimal."""
        if shutil.which("cc") is None or shutil.which("pkg-config") is None:
            return
        found = list((self.root / "usr/lib").rglob("skyloop.pc"))
        self.assertEqual(len(found), 1)
        words = run("pkg-config", "--cflags", "--libs", "skyloop", env={**os.environ, "PKG_CONFIG_PATH": str(found[0].parent)})
        run("cc", "-std=c11", ROOT / "examples/c/fly.c", *words.stdout.split(), "-lm", "-o", self.root / "tmp/fly")
        done = self.inside("/tmp/fly", "6")
        self.assertIn("7 epochs, fix 3", done.stderr)

    def test_installed_run_and_purged(self):
        clean_debian.add_packages(self.root, PACKAGES.values())
        self.check_installation()
        self.check_run()
        self.check_library()
        self.inside("apt-get", "purge", "-q", "-y", "--auto-remove", *NAMES)
        shutil.rmtree(self.root / "packages")
        after = self.listing()
        self.assertEqual(sorted(set(after) ^ set(self.before)), [], "left or lost")
        self.assertEqual([path for path in after if after[path] != self.before[path]], [], "changed")


if __name__ == "__main__":
    unittest.main()
