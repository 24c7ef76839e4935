"""The unit under a systemd that really booted: the packages of tools/package in a clean Debian, started by systemd-nspawn. The
receiver comes up in real time and without a capability, is read by a client, comes back after a kill, stays
down after a bad scenario, and leaves nothing when it is stopped."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import clean_debian
from packages import made_packages, need, run, skip

need("debootstrap", "systemd-nspawn", "unshare", "chroot")
PACKAGES = made_packages()
if os.geteuid() != 0:
    skip("a container needs root")

PROBE_UNIT = """
[Unit]
After=multi-user.target
[Service]
Type=oneshot
ExecStart=/bin/sh /probe/probe.sh
ExecStopPost=systemctl poweroff
TimeoutStartSec=100
[Install]
WantedBy=multi-user.target
"""
CAP_SYS_RESOURCE = 24
# What is found out lies in /probe, a file each.
PROBE = r"""
cd /probe
echo yes >booted
alive() { for i in $(seq 100); do [ -e /run/skyloop/demo/gps0 ] && return; sleep 0.1; done; echo "no port: $1" >>missing; }
of() { systemctl show "$1" --property "$2" --value; }
systemctl start skyloop@demo
alive start
timeout 6 cat /run/skyloop/demo/gps0 >heard
pid=$(of skyloop@demo MainPID)
cat /proc/$pid/status >status
cat /proc/$pid/limits >limits
for task in /proc/$pid/task/*; do cut -d' ' -f41 $task/stat; done >policies
kill -9 $pid
sleep 3
alive restart
of skyloop@demo NRestarts >restarts
timeout 3 cat /run/skyloop/demo/gps0 >heard_again
echo '[run' >/etc/skyloop/bad.toml
systemctl start skyloop@bad
sleep 4
of skyloop@bad NRestarts >bad_restarts
of skyloop@bad ExecMainStatus >bad_code
systemctl stop skyloop@demo
of skyloop@demo Result >result
ls -A /run/skyloop >left
pgrep skyloop >>left
journalctl --no-pager -o cat -u skyloop@demo >journal
journalctl --no-pager -o cat -u skyloop@bad >bad_journal
"""


class BootedService(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="skyloop-booted-", dir="/var/tmp")
        cls.addClassCleanup(folder.cleanup)
        root = pathlib.Path(folder.name) / "root"
        clean_debian.make(root)
        clean_debian.inside(root, "apt-get", "update", "-q")
        clean_debian.add_packages(root, (PACKAGES[name] for name in ("skyloop", "skyloop-data", "libskyloop0")),
                                  "systemd", "systemd-sysv", "dbus", "procps")
        cls.probe = root / "probe"
        cls.probe.mkdir()
        (cls.probe / "probe.sh").write_text(PROBE)
        (root / "etc/systemd/system/probe.service").write_text(PROBE_UNIT)
        clean_debian.inside(root, "systemctl", "enable", "probe.service")
        try:
            # Without these nspawn itself forbids mlockall(2), and limits above those of a kernel that has just begun.
            as_a_machine = ("--capability=CAP_IPC_LOCK", "--rlimit=RTPRIO=99", "--rlimit=MEMLOCK=infinity")
            done = run("systemd-nspawn", "--quiet", "--register=no", "--keep-unit", *as_a_machine, "--directory", root, "--boot",
                       check=False, timeout=180)
            said = done.stdout + done.stderr
        except subprocess.TimeoutExpired as late:
            said = f"{late.stdout}\n{late.stderr}"
        if not (cls.probe / "booted").exists():
            skip(f"no systemd boots in a container here: {said[-500:]}")

    def told(self, name):
        return (self.probe / name).read_bytes().decode(errors="replace")

    def test_a_client_hears_it(self):
        self.assertFalse((self.probe / "missing").exists())
        for name, least in (("heard", 3), ("heard_again", 1)):
            self.assertGreaterEqual(len(re.findall(r"\$GNRMC,[^*]*\*[0-9A-F]{2}\r\n", self.told(name))), least, self.told("journal"))

    def test_it_has_no_capability(self):
        status = self.told("status")
        for kind in ("CapPrm", "CapEff", "CapBnd", "CapAmb"):
            self.assertRegex(status, rf"{kind}:\t0+\n")
        self.assertRegex(status, r"NoNewPrivs:\t1\n")
        self.assertRegex(status, r"Seccomp:\t2\n")
        self.assertNotRegex(status, r"Uid:\t0\t")

    def test_it_is_real_time(self):
        if not int(re.search(r"CapEff:\t(\w+)", pathlib.Path("/proc/self/status").read_text())[1], 16) >> CAP_SYS_RESOURCE & 1:
            self.skipTest("root may not raise limits here")
        self.assertGreater(int(re.search(r"VmLck:\s+(\d+) kB", self.told("status"))[1]), 1000, "its memory is locked")
        self.assertRegex(self.told("limits"), r"Max realtime priority +20 ")
        self.assertIn("1", self.told("policies").split(), "a thread is SCHED_FIFO")

    def test_it_comes_back_after_a_kill_and_not_after_a_bad_scenario(self):
        self.assertEqual(self.told("restarts"), "1\n")
        self.assertEqual((self.told("bad_restarts"), self.told("bad_code")), ("0\n", "2\n"))
        self.assertIn("/etc/skyloop/bad.toml:1:", self.told("bad_journal"))

    def test_it_stops_and_leaves_nothing(self):
        self.assertEqual(self.told("result"), "success\n", self.told("journal"))
        self.assertEqual(self.told("left"), "")


if __name__ == "__main__":
    unittest.main()
