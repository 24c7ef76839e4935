"""The Containerfile, as far as it can be held against the project without a container engine."""
import re
import subprocess
import unittest

from packages import ROOT


def instructions():
    """(name, rest) of each, continued lines joined."""
    text = re.sub(r"\\\n\s*", "", (ROOT / "Containerfile").read_text())
    return [tuple(line.split(" ", 1)) for line in text.splitlines() if line and not line.startswith("#")]


class Containerfile(unittest.TestCase):
    def test_only_known_instructions(self):
        self.assertLessEqual({name for name, _ in instructions()},
                             {"FROM", "ARG", "COPY", "RUN", "USER", "WORKDIR", "EXPOSE", "ENTRYPOINT", "CMD"})

    def test_stages_are_the_debian_of_the_packages(self):
        stages = [rest for name, rest in instructions() if name == "FROM"]
        self.assertEqual(len(stages), 2)
        for stage in stages:
            self.assertIn("debian:12-slim", stage)
        self.assertIn("release=bookworm\n", (ROOT / "tools/clean_root").read_text())

    def test_commands_are_shell_and_name_files_that_exist(self):
        for name, rest in instructions():
            if name == "RUN":
                command = re.sub(r"--mount=\S+ *", "", rest)
                subprocess.run(["sh", "-n", "-c", command], check=True, timeout=20)
                for path in re.findall(r"/src/(\S+)", command):
                    self.assertTrue((ROOT / path).exists(), path)

    def test_what_it_runs_takes_these_options(self):
        words = dict((name, rest) for name, rest in instructions() if name in ("ENTRYPOINT", "CMD", "USER", "EXPOSE"))
        self.assertEqual(words["ENTRYPOINT"], '["/usr/bin/skyloop"]')
        self.assertIn(f"tcp:0.0.0.0:{words['EXPOSE']}", words["CMD"])
        self.assertIn(f"u {words['USER']} ", (ROOT / "tools/service/skyloop.conf").read_text())

    def test_what_is_built_here_stays_outside(self):
        self.assertIn("build", (ROOT / ".containerignore").read_text().split())


if __name__ == "__main__":
    unittest.main()
