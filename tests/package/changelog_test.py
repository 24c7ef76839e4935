"""Debian's changelog is made from CHANGELOG.md: whole, the same each time, and read by Debian's own parser."""
import pathlib
import re
import shutil
import tempfile
import unittest

from packages import ROOT, run, version

MAKE = ROOT / "tools/debian/make_changelog.py"
WHO = "skyloop developers <skyloop@packages.skyloop.example>"


def make(path, check=True, epoch="1795370000"):
    return run("python3", "-B", MAKE, path, f"{version()}-1", WHO, epoch, check=check)


class Changelog(unittest.TestCase):
    def written(self, text):
        folder = tempfile.TemporaryDirectory(prefix="skyloop-changelog-")
        self.addCleanup(folder.cleanup)
        path = pathlib.Path(folder.name) / "CHANGELOG.md"
        path.write_text(text)
        return path

    def test_every_entry_is_there(self):
        ours = (ROOT / "CHANGELOG.md").read_text()
        made = make(ROOT / "CHANGELOG.md").stdout
        self.assertEqual(made.count("\n  * "), len(re.findall(r"^- ", ours, re.MULTILINE)))
        self.assertNotIn("](", made)
        self.assertLessEqual(max(len(line) for line in made.splitlines() if " " in line.strip() and line[:4] != " -- "), 80)
        self.assertEqual(made, make(ROOT / "CHANGELOG.md").stdout)

    def test_no_word_stands_twice(self):
        """lintian takes that for a slip, which only the tests of packages would tell."""
        made = make(ROOT / "CHANGELOG.md").stdout
        self.assertEqual([found[0] for found in re.finditer(r"\b(\w+)\s+\1\b", made)], [])

    def test_debian_reads_it(self):
        if shutil.which("dpkg-parsechangelog") is None:
            self.skipTest("dpkg-dev is not installed")
        path = self.written(make(ROOT / "CHANGELOG.md").stdout)
        told = run("dpkg-parsechangelog", "-l", path)
        self.assertEqual(told.stderr, "")
        for line in ("Source: skyloop", f"Version: {version()}-1", "Timestamp: 1795370000", f"Maintainer: {WHO}"):
            self.assertIn(line + "\n", told.stdout)

    def test_releases_have_their_own_dates(self):
        made = make(self.written("# C\n\n## Unreleased\n\n### Added\n\n- new `x|y` ([page](a.md))\n  and more\n\n## 0.0.9 - 2026-01-31\n\n"
                                 "### Fixed\n\n- old\n")).stdout
        self.assertEqual(made, f"skyloop ({version()}-1) unstable; urgency=medium\n\n  [ Added ]\n  * new x|y (page) and more\n\n"
                               f" -- {WHO}  Sun, 22 Nov 2026 17:53:20 +0000\n\nskyloop (0.0.9-1) unstable; urgency=medium\n\n"
                               f"  [ Fixed ]\n  * old\n\n -- {WHO}  Sat, 31 Jan 2026 12:00:00 +0000\n")

    def test_what_is_no_changelog_is_refused_in_one_line(self):
        for text, told in (("", "no section"), ("## soon\n", "'## soon'"), ("## Unreleased\n- lost\n", "stands in no group"),
                           ("## 1.0.0 - 2026-02-31\n### Added\n- x\n", "day")):
            done = make(self.written(text), check=False)
            self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (1, "", 1), text)
            self.assertIn(told, done.stderr)
        self.assertEqual(make(self.written("## Unreleased\n"), check=False, epoch="now").returncode, 2)


class Copyright(unittest.TestCase):
    def test_is_the_licence_of_the_project(self):
        licence = (ROOT / "LICENSE").read_text().split("\n\n", 2)
        told = (ROOT / "tools/debian/copyright").read_text()
        self.assertIn(licence[1].strip().removeprefix("Copyright (c) "), told)
        said = "\n".join(line[1:] if line != " ." else "" for line in told.splitlines() if line.startswith(" "))
        self.assertIn(licence[2].strip(), said)


if __name__ == "__main__":
    unittest.main()
