"""The packages of tools/package in a clean Debian 12: lintian has nothing to say, apt finds what they need, an ordinary user runs
the program, and after a purge nothing is left."""
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from packages import BUILD, NAMES, ROOT, made_packages, need, run, skip, version

need("debootstrap", "lintian", "unshare", "chroot")
PACKAGES = made_packages()
if os.geteuid() != 0:
    skip("a chroot needs root")

# What apt and dpkg keep about themselves, and what changes whenever any package comes or goes.
VOLATILE = re.compile(r"^(dev|proc|sys|run|tmp|packages|var/(cache|log|tmp)|var/lib/(apt|dpkg)|etc/ld\.so\.cache)(/|$)")
MOUNTS = ('mount -t proc proc "$0/proc"; mount -t tmpfs tmpfs "$0/dev/shm"; mount -t devpts -o newinstance,ptmxmode=0666,mode=0620,gid=5 '
          'devpts "$0/dev/pts"; rm -f "$0/dev/ptmx"; ln -s pts/ptmx "$0/dev/ptmx"; exec chroot "$0" "$@"')
RUN = r"""
cd /tmp
skyloop run --duration 5 --wait-for-client --at 46.4775,30.7326,77 --port pty:/tmp/gps0 2>/tmp/said &
for i in $(seq 100); do [ -e /tmp/gps0 ] && break; sleep 0.1; done
stty -F /tmp/gps0 raw -echo
timeout 30 cat /tmp/gps0 >/tmp/heard 2>/dev/null &
wait %1
"""


def mirror():
    """The mirror that this machine's own apt uses for Debian 12; none: debootstrap's."""
    told = run("apt-get", "indextargets", "--format", "$(RELEASE) $(COMPONENT) $(SITE)", "Created-By: Packages", check=False).stdout
    return [line.split()[2] for line in told.splitlines() if line.startswith("bookworm main ")][:1]


def clean_root(target):
    """A minimal Debian 12; kept as an archive in the build's folder."""
    kept = BUILD / "test-artifacts/bookworm-minbase.tar"
    if not kept.exists():
        kept.parent.mkdir(parents=True, exist_ok=True)
        done = run("debootstrap", "--variant=minbase", "bookworm", target, *mirror(), check=False, timeout=900)
        if done.returncode != 0:
            if re.search(r"Failed getting release file|Couldn't (retrieve|download)|Couldn't resolve|unreachable", done.stdout + done.stderr):
                skip("no mirror of Debian can be reached")
            raise AssertionError(done.stdout[-3000:] + done.stderr[-3000:])
        run("tar", "--numeric-owner", "--exclude=./dev/*", "--exclude=./var/cache/apt/archives/*.deb", "-C", target, "-cf",
            f"{kept}.part", ".")
        os.rename(f"{kept}.part", kept)
    else:
        run("tar", "--numeric-owner", "-C", target, "-xpf", kept)
    for name in ("shm", "pts"):
        (target / "dev" / name).mkdir(exist_ok=True)
    for name, minor in (("null", 3), ("zero", 5), ("urandom", 9)):
        if not (target / "dev" / name).exists():
            os.mknod(target / "dev" / name, 0o020666, os.makedev(1, minor))
        os.chmod(target / "dev" / name, 0o666)
    (target / "etc/apt/sources.list").unlink(missing_ok=True)
    for part in ("sources.list", "sources.list.d", "apt.conf", "apt.conf.d", "preferences", "preferences.d", "trusted.gpg.d", "keyrings"):
        if pathlib.Path("/etc/apt", part).exists():
            run("cp", "-a", f"/etc/apt/{part}", target / "etc/apt/")
    for name in ("resolv.conf", "hosts"):
        shutil.copy(pathlib.Path("/etc", name).resolve(), target / "etc" / name)


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
        cls.root.mkdir()
        clean_root(cls.root)
        cls.inside("apt-get", "update", "-q")
        cls.inside("useradd", "--create-home", "--groups", "dialout", "tester")
        cls.before = cls.listing()
        (cls.root / "packages").mkdir()
        for path in PACKAGES.values():
            shutil.copy(path, cls.root / "packages")

    @classmethod
    def inside(cls, *words, check=True):
        """Runs a command in the clean Debian; its mounts are gone with it."""
        environment = {key: value for key, value in os.environ.items() if key.endswith("_proxy")}
        environment.update(PATH="/usr/sbin:/usr/bin:/sbin:/bin", LC_ALL="C.UTF-8", DEBIAN_FRONTEND="noninteractive", HOME="/root")
        return run("unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-e", "-c", MOUNTS, cls.root, *words, check=check,
                   env=environment, timeout=900)

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
        run("cc", "-std=c11", ROOT / "tools/examples/c/fly.c", *words.stdout.split(), "-lm", "-o", self.root / "tmp/fly")
        done = self.inside("/tmp/fly", "6")
        self.assertIn("7 epochs, fix 3", done.stderr)

    def test_installed_run_and_purged(self):
        self.inside("sh", "-c", "apt-get install -q -y --no-install-recommends /packages/*.deb")
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
