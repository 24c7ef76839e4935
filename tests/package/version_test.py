"""The version stands in one place, the project() of CMakeLists.txt, and all that tell one take it from there."""
import pathlib
import re
import tempfile
import unittest

from packages import BUILD, ROOT, SKYLOOP, run, version

LOOKED_AT = ("*.cpp", "*.hpp", "*.h", "*.py", "*.cmake", "CMakeLists.txt", "*.in", "*.1", "*.toml", "*.service", "*.md")


class Version(unittest.TestCase):
    def test_the_program_tells_it(self):
        self.assertEqual(run(SKYLOOP, "--version").stdout, f"skyloop {version()}\n")

    def test_manual_pages_tell_it(self):
        with tempfile.TemporaryDirectory(prefix="skyloop-pages-") as folder:
            run(SKYLOOP, "help-pages", "--format", "man", "--out", folder)
            for page in pathlib.Path(folder).iterdir():
                self.assertIn(f'"skyloop {version()}"', page.read_text().splitlines()[1], page.name)

    def test_the_library_tells_it(self):
        self.assertIn(f"\nVersion: {version()}\n", (BUILD / "src/run/api/skyloop.pc").read_text())
        self.assertIn(f'set(PACKAGE_VERSION "{version()}")', (BUILD / "src/run/api/skyloopConfigVersion.cmake").read_text())

    def test_packages_tell_it(self):
        told = (BUILD / "CPackConfig.cmake").read_text()
        self.assertIn(f'set(CPACK_PACKAGE_VERSION "{version()}")', told)
        self.assertIn(f'"libskyloop0 (= {version()}-1)"', told)

    def test_it_stands_nowhere_else(self):
        mark = re.compile(r"(?<![\d.])" + re.escape(version()) + r"(?![\d.])")
        found = []
        for folder in ("", "src", "include", "firmware-host", "tools", "boards", "docs", "data"):
            for pattern in LOOKED_AT:
                base = ROOT / folder
                for path in base.glob(pattern) if not folder else base.rglob(pattern):
                    if path.name == "CHANGELOG.md":
                        continue
                    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                        if mark.search(line) and not line.startswith("project(skyloop VERSION"):
                            found.append(f"{path.relative_to(ROOT)}:{number}: {line.strip()}")
        self.assertEqual(found, [])


if __name__ == "__main__":
    unittest.main()
