"""The Containerfile, built by podman from a clean clone on a Debian made here, and what its image does for those who run it."""
import os
import pathlib
import socket
import subprocess
import tempfile
import time
import unittest

import clean_debian
from packages import ROOT, need, run, skip, version

need("podman", "runc", "debootstrap", "git")
if os.geteuid() != 0:
    skip("needs to be root, to make a Debian")

SCENARIO = '[run]\nstart = 2024-03-05T12:00:00Z\nduration_s = 100\n[model]\nname = "baseline"\n'
PORT = 20043


class Container(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # Images of its own: what this machine calls debian:12-slim stays what it is.
        cls.folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="skyloop-container-", dir="/var/tmp")))
        cls.addClassCleanup(cls.podman, "system", "reset", "--force", check=False)
        base = cls.folder / "debian"
        clean_debian.make(base)
        run("tar", "--numeric-owner", "--exclude=./dev/*", "-C", base, "-cf", cls.folder / "debian.tar", ".")
        cls.podman("import", cls.folder / "debian.tar", "docker.io/library/debian:12-slim")
        clone = cls.folder / "clone"
        run("git", "clone", "--quiet", "--no-hardlinks", ROOT, clone)
        time_of_commit = run("git", "-C", clone, "log", "-1", "--format=%ct").stdout.strip()
        # Isolated by chroot alone, which asks nothing of the machine's control groups.
        cls.podman("build", "--isolation=chroot", "--tag", "skyloop", "--build-arg", f"SOURCE_DATE_EPOCH={time_of_commit}", clone,
                   timeout=5000)

    @classmethod
    def podman(cls, *words, **more):
        return run(*cls.podman_words(*words), **more)

    @classmethod
    def podman_words(cls, *words):
        return ["podman", "--root", str(cls.folder / "images"), "--runroot", str(cls.folder / "run"), "--runtime", "runc", *words]

    @classmethod
    def image_words(cls, *options, arguments=()):
        limits = ("--ulimit", "nofile=1024:1024", "--ulimit", "nproc=4096:4096")
        return cls.podman_words("run", "--rm", "--network", "host", *limits, *options, "skyloop", *arguments)

    def test_it_is_this_version(self):
        self.assertEqual(run(*self.image_words(arguments=["--version"])).stdout.strip(), f"skyloop {version()}")

    def test_it_runs_as_a_user_who_may_open_serial_lines(self):
        told = run(*self.image_words("--entrypoint", "/usr/bin/id")).stdout
        self.assertIn("(skyloop)", told.split()[0])
        self.assertIn("(dialout)", told)

    def test_a_scenario_of_the_host_is_heard_on_a_port_and_ends_in_order(self):
        work = self.folder / "work"
        work.mkdir()
        work.chmod(0o755)
        (work / "scenario.toml").write_text(SCENARIO)
        words = self.image_words("--name", "heard", "--volume", f"{work}:/work:ro",
                                 arguments=["run", "/work/scenario.toml", "--port", f"tcp:127.0.0.1:{PORT}"])
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        try:
            heard = self.hear(b"$GNGGA,", patience=60)
            self.assertRegex(heard, rb"\$GNGGA,1200\d\d\.\d\d,4628\.\d+,N,")
            self.podman("stop", "--time", "20", "heard")
            said = process.communicate(timeout=30)[0]
        finally:
            process.kill()
            process.wait()
        self.assertEqual(process.returncode, 0, said)
        self.assertRegex(said, r"\d+ epochs, \d+ with a fix")

    @staticmethod
    def hear(wanted, patience):
        """What the receiver says up to the end of the first line that begins so."""
        end = time.monotonic() + patience
        heard = b""
        while time.monotonic() < end:
            try:
                with socket.create_connection(("127.0.0.1", PORT), timeout=2) as line:
                    while time.monotonic() < end and not (wanted in heard and heard.endswith(b"\r\n")):
                        heard += line.recv(4096)
                return heard
            except OSError:
                time.sleep(0.2)
        raise AssertionError(f"nothing like {wanted} within {patience} s: {heard[-200:]}")


if __name__ == "__main__":
    unittest.main()
