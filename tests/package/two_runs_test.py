"""Two runs of cpack over one build give the same bytes, though folders and times differ; and each package holds what it should."""
import os
import pathlib
import shutil
import tempfile
import unittest

from packages import BUILD, NAMES, need, run, version

need("cpack", "dpkg-shlibdeps", "dpkg-deb", "file")
EPOCH = "1795370000"


def pack(folder):
    """All packages of the build, made in `folder`; uncompressed and unstripped: it is quick, and order and times show all the same."""
    run("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", folder, "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=none",
        "-D", "CPACK_STRIP_FILES=OFF", "-D", "CPACK_DEBIAN_PACKAGE_SHLIBDEPS=OFF", "-D", "CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS=OFF",
        "-D", "CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS=OFF", env={**os.environ, "SOURCE_DATE_EPOCH": EPOCH}, cwd=folder)
    return {path.name.split("_")[0]: path for path in folder.glob("*.deb")}


class TwoRuns(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="skyloop-packed-")
        cls.addClassCleanup(cls.folder.cleanup)
        first, second = pathlib.Path(cls.folder.name) / "a", pathlib.Path(cls.folder.name) / "second/one"
        for folder in (first, second):
            folder.mkdir(parents=True)
        cls.made = [pack(first), pack(second)]
        shutil.rmtree(first / "_CPack_Packages")
        shutil.rmtree(second / "_CPack_Packages")

    def contents(self, package):
        listed = run("dpkg-deb", "--contents", self.made[0][package]).stdout.splitlines()
        self.assertTrue(all(line.split()[1] == "root/root" for line in listed), listed[:3])
        return {line.split(" ./", 1)[1].split(" -> ")[0] for line in listed if " ./" in line and not line.endswith("/")}

    def test_same_bytes(self):
        self.assertEqual(set(self.made[0]), set(NAMES))
        for name in NAMES:
            with self.subTest(name):
                first, second = (made[name].read_bytes() for made in self.made)
                self.assertGreater(len(first), 1000)
                self.assertTrue(first == second)

    def test_versions_and_architectures(self):
        for name in NAMES:
            told = run("dpkg-deb", "--field", self.made[0][name], "Version", "Architecture", "Source").stdout
            own = run("dpkg", "--print-architecture").stdout.strip()
            architecture = "all" if name in ("skyloop-data", "skyloop-doc") else own
            self.assertEqual(told, f"Version: {version()}-1\nArchitecture: {architecture}\nSource: skyloop\n")

    def test_each_file_is_in_its_package(self):
        wanted = {"skyloop": ("bin/skyloop", "bin/skyloop-gadget", "bash-completion/completions/skyloop", "vendor-completions/_skyloop",
                              "man1/skyloop-run.1", "man1/skyloop.1", "systemd/system/skyloop@.service", "sysusers.d/skyloop.conf",
                              "udev/rules.d/70-skyloop.rules", "etc/skyloop/demo.toml"),
                  "skyloop-data": ("boards/receivers/ublox-m8.toml", "geoids/egm96-15.pgm", "nequick_g/ccir11.asc", "scenarios/flight.toml"),
                  "libskyloop0": ("libskyloop.so.0", "libskyloop.so.0.1"),
                  "libskyloop-dev": ("include/skyloop.h", "libskyloop.so", "pkgconfig/skyloop.pc", "cmake/skyloop/skyloopConfig.cmake"),
                  "skyloop-doc": ("docs/receiver.md", "docs/commands.md", "examples/c/fly.c", "boards/README.md")}
        everything = [self.contents(name) for name in NAMES]
        self.assertEqual(sum(map(len, everything)), len(set().union(*everything)), "a file is in two packages")
        for name, files in wanted.items():
            held = self.contents(name)
            for file in files:
                self.assertTrue(any(path.endswith("/" + file) or path == file for path in held), f"{file} in {name}")
        self.assertFalse([path for held in everything for path in held if "__pycache__" in path or "CMakeLists" in path
                          and "examples" not in path])


if __name__ == "__main__":
    unittest.main()
