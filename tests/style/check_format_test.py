"""tools/check_format.py must take clang-format 14, or a later one that agrees with the tree, and else be skipped by name."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOL = Path(__file__).resolve().parents[2] / "tools/check_format.py"
SKIPPED = 77


class Versions(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="skyloop-format-")
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name).resolve()
        (self.root / "src").mkdir()
        (self.root / "src/a.cpp").write_text("int a;\n")
        self.programs = self.root / "bin"
        self.programs.mkdir()

    def install(self, name, version, agrees):
        """A program that says this version, and finds the file wrong or not."""
        complaint = "" if agrees else f"echo {self.root}/src/a.cpp:1:1: error: code should be clang-formatted >&2; exit 1"
        program = self.programs / name
        program.write_text(f'#!/bin/sh\nif [ "$1" = --version ]; then echo "Debian clang-format version {version}"; '
                           f"exit 0; fi\n{complaint}\n")
        program.chmod(0o755)

    def check(self, *words):
        done = subprocess.run([sys.executable, "-B", TOOL, *words, self.root], capture_output=True, text=True, check=False,
                              env={**os.environ, "PATH": f"{self.programs}:/nowhere"})
        self.assertEqual(done.stderr, "")
        return done.returncode, done.stdout

    def test_version_14_decides(self):
        self.install("clang-format-14", "14.0.6", True)
        self.install("clang-format", "19.1.7 (3+b1)", False)
        self.assertEqual(self.check(), (0, "check_format: 1 files, 0 violations\n"))
        self.install("clang-format-14", "14.0.6", False)
        code, told = self.check()
        self.assertEqual(code, 1)
        self.assertIn("src/a.cpp: not laid out as .clang-format says", told)

    def test_a_later_version_that_agrees_serves(self):
        self.install("clang-format", "19.1.7 (3+b1)", True)
        self.assertEqual(self.check(), (0, "check_format: 1 files, 0 violations\n"))

    def test_a_later_version_that_disagrees_is_skipped(self):
        self.install("clang-format", "19.1.7 (3+b1)", False)
        code, told = self.check()
        self.assertEqual(code, SKIPPED)
        self.assertIn("skipped: clang-format 19 would lay out 1 files otherwise, src/a.cpp first", told)

    def test_a_later_version_fixes_nothing(self):
        self.install("clang-format", "19.1.7 (3+b1)", False)
        self.assertEqual(self.check("--fix")[0], SKIPPED)
        self.assertEqual((self.root / "src/a.cpp").read_text(), "int a;\n")

    def test_without_any_or_with_an_older_one_it_is_skipped(self):
        self.assertEqual(self.check()[0], SKIPPED)
        self.install("clang-format", "13.0.1", False)
        self.assertEqual(self.check()[0], SKIPPED)


if __name__ == "__main__":
    unittest.main()
