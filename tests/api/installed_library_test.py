"""The library as other programs have it: installed under another prefix, moved, and used from another directory; in C, in
C++ and in Python, by pkg-config and by find_package."""
import json
import os
import pathlib
import re
import shlex
import shutil
import tempfile
import unittest

from installed import EXAMPLES, ROOT, Installation, need, run

need("cc", "c++", "cmake", "nm", "readelf")
STRICT = ["-Wall", "-Wextra", "-pedantic", "-Werror"]


# A host that traps what Embree does, and lets go of the library while a worker of Embree's may still be at rest in it.
HOST = r"""
#include <dlfcn.h>
#include <fenv.h>
#include <skyloop.h>
#include <stdio.h>
#include <unistd.h>

int main(int count, char** words) {
    const int traps = FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW;
    if (count != 3) return 9;
    feenableexcept(traps);
    for (int round = 0; round < 3; ++round) {
        void* library = dlopen(words[1], RTLD_NOW);
        sky_status (*create)(const sky_create_info*, sky_emulator**);
        sky_status (*advance)(sky_emulator*, int64_t, sky_progress*);
        void (*destroy)(sky_emulator*);
        sky_emulator* emulator = NULL;
        sky_create_info info = {0};
        if (library == NULL) return 2;
        *(void**)&create = dlsym(library, "sky_create");
        *(void**)&advance = dlsym(library, "sky_advance");
        *(void**)&destroy = dlsym(library, "sky_destroy");
        info.struct_size = sizeof info;
        info.abi_major = SKY_ABI_MAJOR;
        info.scenario_file = words[2];
        if (create(&info, &emulator) != SKY_OK) return 3;
        if (advance(emulator, 3000000000, NULL) != SKY_OK) return 4;
        destroy(emulator);
        dlclose(library);
        usleep(300000);
    }
    puts(fegetexcept() == traps ? "traps are as they were" : "traps were changed");
    return 0;
}
"""


def setUpModule():
    global INSTALLED
    INSTALLED = Installation()
    unittest.addModuleCleanup(INSTALLED.folder.cleanup)


def declared():
    """The functions of the header."""
    header = (ROOT / "include/skyloop.h").read_text(encoding="utf-8")
    return set(re.findall(r"^SKY_API[^;]*?(sky_\w+)\s*\(", header, re.MULTILINE))


class Binary(unittest.TestCase):
    def test_shows_exactly_the_functions_of_the_header(self):
        listed = run("nm", "-D", "--defined-only", INSTALLED.library).stdout.decode().split("\n")
        shown = {line.split()[-1] for line in listed if line and " A " not in line}
        self.assertEqual(shown, {f"{name}@@SKYLOOP_0" for name in declared()})
        self.assertGreater(len(shown), 12)

    def test_is_called_by_its_abi(self):
        told = run("readelf", "-d", INSTALLED.library).stdout.decode()
        self.assertIn("soname: [libskyloop.so.0]", told)
        self.assertNotIn("RUNPATH", told)
        self.assertNotIn("TEXTREL", told)
        self.assertTrue(INSTALLED.one("lib*/**/libskyloop.so").is_symlink())

    def test_the_header_is_clean_in_both_languages(self):
        header = INSTALLED.prefix / "include/skyloop.h"
        for compiler, words in (("cc", ["-x", "c", "-std=c99"]), ("c++", ["-x", "c++", "-std=c++20"]),
                                ("c++", ["-x", "c++", "-std=c++11"])):
            run(compiler, *words, *STRICT, "-fsyntax-only", header)


class Programs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="skyloop-client-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def fly(self, program):
        """Flies the C example; gives its bytes."""
        done = run(program, "6", folder=self.folder, env=INSTALLED.environment())
        self.assertIn(b"7 epochs, fix 3", done.stderr)
        self.assertGreaterEqual(done.stdout.count(b"$GNRMC,"), 6)
        self.assertNotIn(b"ellipsoid", done.stderr)  # the geoid was found
        return done.stdout

    def build(self, example):
        """Builds an example with CMake against the installed package; gives the folder of its programs."""
        build = self.folder / f"build_{example}"
        run("cmake", "-S", EXAMPLES / example, "-B", build, f"-DCMAKE_PREFIX_PATH={INSTALLED.prefix}",
            f"-DCMAKE_C_FLAGS={' '.join(STRICT)}", f"-DCMAKE_CXX_FLAGS={' '.join(STRICT)}", folder=self.folder)
        run("cmake", "--build", build, folder=self.folder)
        return build

    def test_c_by_pkg_config_and_by_find_package(self):
        need("pkg-config")
        environment = INSTALLED.environment()
        told = run("pkg-config", "--cflags", "--libs", "skyloop", env=environment).stdout.decode()
        version = run("pkg-config", "--modversion", "skyloop", env=environment).stdout.decode().strip()
        self.assertRegex(version, r"^\d+\.\d+\.\d+$")
        run("cc", "-std=c11", *STRICT, EXAMPLES / "c/fly.c", *shlex.split(told), "-lm", "-o", "fly", folder=self.folder)
        by_pkg_config = self.fly(self.folder / "fly")
        by_package = self.fly(self.build("c") / "fly")
        self.assertEqual(by_pkg_config, by_package)

    def test_the_lines_of_the_page_start_what_they_build(self):
        need("pkg-config")
        page = (ROOT / "docs/c_api.md").read_text(encoding="utf-8")
        lines = re.search(r"api/installed_library runs these lines -->\n```sh\n(.*?)```", page, re.DOTALL)[1]
        for example in ("c/fly.c", "python/skyloop_ctypes.py"):
            shutil.copy(EXAMPLES / example, self.folder)
        place = self.folder / "opt"
        place.symlink_to(INSTALLED.prefix)
        libraries = INSTALLED.library.parent.relative_to(INSTALLED.prefix)
        told = lines.replace("/opt/skyloop/lib/", f"{place}/{libraries}/")
        self.assertNotIn("/opt/skyloop", told)
        done = run("sh", "-e", "-c", told, folder=self.folder, env={"SKYLOOP_DATA_DIR": "", "PYTHONDONTWRITEBYTECODE": "1"})
        self.assertIn(b"11 epochs, fix 3", done.stderr)
        self.assertEqual(json.loads(done.stdout)["epochs"], 11)
        self.assertGreater((self.folder / "port0.ubx").stat().st_size, 1000)

    def test_a_plugin_in_cpp(self):
        done = run(self.build("engine") / "engine_demo", folder=self.folder, env=INSTALLED.environment())
        words = re.fullmatch(r"(\d+) bytes, fix (\d) with (\d+) satellites, (\d+) hidden by the wall\n",
                             done.stdout.decode())
        self.assertIsNotNone(words, done.stdout)
        self.assertGreater(int(words[4]), 2)

    def test_python(self):
        told = [run("python3", EXAMPLES / "python/skyloop_ctypes.py", "5", folder=self.folder,
                    env={**INSTALLED.environment(), "SKYLOOP_LIBRARY": str(INSTALLED.library),
                         "PYTHONDONTWRITEBYTECODE": "1"}).stdout for _ in range(2)]
        self.assertEqual(told[0], told[1])
        flown = json.loads(told[0])
        self.assertEqual(flown["epochs"], 6)
        self.assertEqual(flown["fix"]["type"], "3d")
        self.assertGreater(flown["bytes"], 1000)

    def test_a_program_may_unload_it_after_a_city_and_trap_divisions_by_zero(self):
        (self.folder / "host.c").write_text(HOST, encoding="utf-8")
        run("cc", *STRICT, "-D_GNU_SOURCE", "-I", INSTALLED.prefix / "include", "host.c", "-o", "host", "-lm", folder=self.folder)
        city = INSTALLED.one("share/**/demo_city.toml")
        done = run(self.folder / "host", INSTALLED.library, city, env=INSTALLED.environment())
        self.assertEqual(done.stdout.decode(), "traps are as they were\n")

    def test_says_what_is_wrong_with_a_scenario(self):
        build = self.build("c")
        (self.folder / "bad.toml").write_text("[run]\nsped = 3\n")
        done = run(build / "fly", "1", "bad.toml", folder=self.folder, env=INSTALLED.environment(), code=1)
        self.assertIn(b"bad.toml:2:1", done.stderr)
        self.assertEqual(done.stderr.count(b"\n"), 1)


class Staged(unittest.TestCase):
    def test_destdir_is_only_where_it_is_put(self):
        with tempfile.TemporaryDirectory(prefix="skyloop-staged-") as folder:
            run("cmake", "--install", os.environ.get("SKYLOOP_BUILD", ROOT / "build/dev"), "--prefix", "/opt/skyloop",
                "--component", "development", env={"DESTDIR": folder})
            staged = pathlib.Path(folder) / "opt/skyloop"
            for name in ("skyloop.pc", "skyloopTargets.cmake", "skyloopConfig.cmake"):
                found = list(staged.rglob(name))
                self.assertEqual(len(found), 1, name)
                self.assertNotIn(folder, found[0].read_text(encoding="utf-8"), name)


if __name__ == "__main__":
    unittest.main()
