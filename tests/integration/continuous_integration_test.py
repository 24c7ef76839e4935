"""The helpers for CI, run for real: the pytest fixture, the CMake function and the files for GitHub and GitLab."""
import os
import pathlib
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree

from session import ROOT, SKYLOOP, open_folder

MET = """[run]
start = 2026-03-01T00:00:00Z
duration_s = 9
[model]
name = "ideal"
[[expect]]
what = "fix within 8 s of the run"
"""
NOT_MET = MET + '[[expect]]\nwhat = "client sends CFG-VALSET within 5 s of the run"\n'
ANSWERED = MET + '[[expect]]\nwhat = "client sends MON-VER within 8 s of the run"\n'
# A client that polls MON-VER until it is answered.
CLIENT = """import os, select, sys, time, tty
port = os.open(sys.argv[1], os.O_RDWR | os.O_NOCTTY)
assert os.path.realpath(sys.argv[1]) == os.path.realpath(os.environ["SKYLOOP_PORT"])
tty.setraw(port)
while True:
    os.write(port, bytes.fromhex("b5620a0400000e34"))
    if select.select([port], [], [], 1)[0]:
        os.read(port, 4096)
    time.sleep(0.5)
"""
PYTEST = """import os, tty
import pytest
from skyloop_pytest import ExpectationsNotMet

OPTIONS = ("--speed", "9")

@pytest.mark.skyloop_scenario("met.toml", *OPTIONS)
def test_met(skyloop_run):
    port = os.open(skyloop_run.tty, os.O_RDWR | os.O_NOCTTY)
    assert os.read(port, 1)
    assert skyloop_run.wait() == 0
    skyloop_run.check()
    assert [v.outcome for v in skyloop_run.verdicts] == ["passed"]
    assert skyloop_run.summary["epochs"] == 9
    assert (skyloop_run.folder / "port0.out").stat().st_size > 0

@pytest.mark.skyloop_scenario("not_met.toml", *OPTIONS)
def test_evidence(skyloop_run):
    assert skyloop_run.wait() == 3
    with pytest.raises(ExpectationsNotMet, match="CFG-VALSET.*failed"):
        skyloop_run.check()

@pytest.mark.skyloop_scenario("not_met.toml", *OPTIONS)
def test_that_has_to_fail(skyloop_run):
    skyloop_run.wait()
    skyloop_run.check()

@pytest.mark.skyloop_scenario("met.toml", "--board", "ublox-f9p", "--port", "pty", "--port", "uart2=pty", ports=2)
def test_two_ports_and_an_early_end(skyloop_run):
    assert len(skyloop_run.ttys) == 2
    assert skyloop_run.stop() in (0, 3)

@pytest.mark.skyloop_scenario("met.toml", "--port", "rfc2217:0")
def test_a_port_whose_client_sets_the_line(skyloop_run):
    assert skyloop_run.tty.startswith("127.0.0.1:")
    assert skyloop_run.stop() in (0, 3)

@pytest.mark.skyloop_scenario("met.toml", "--port", "tcp-connect:127.0.0.1:9")
def test_a_port_that_calls_a_server(skyloop_run):
    assert skyloop_run.tty == "127.0.0.1:9"
    assert skyloop_run.stop() in (0, 3)

@pytest.mark.skyloop_scenario("no_such_file.toml")
def test_without_a_scenario(skyloop_run):
    pass

def test_without_a_mark(skyloop_run):
    pass
"""
CMAKE = """cmake_minimum_required(VERSION 3.20)
project(user NONE)
enable_testing()
include({root}/tools/cmake/SkyloopScenarioTest.cmake)
skyloop_scenario_test(met SCENARIO met.toml TIMEOUT 60)
skyloop_scenario_test(not_met SCENARIO not_met.toml TIMEOUT 60)
skyloop_scenario_test(live SCENARIO answered.toml OPTIONS --speed 4 CLIENT {python} {folder}/client.py {{port}} TIMEOUT 60)
skyloop_scenario_test(mute SCENARIO answered.toml OPTIONS --speed 6 CLIENT sleep 60 TIMEOUT 60)
skyloop_scenario_test(endless SCENARIO met.toml OPTIONS --speed 0.1 CLIENT sleep 60 TIMEOUT 3)
"""


def run_scripts(document):
    """The shell lines of a GitHub or GitLab file."""
    scripts = []
    for job in document.get("jobs", {}).values():
        scripts += [step["run"] for step in job["steps"] if "run" in step]
    for job in document.values():
        if isinstance(job, dict) and "script" in job:
            scripts.append("\n".join(job.get("before_script", []) + job["script"]))
    return scripts


class ContinuousIntegrationTest(unittest.TestCase):
    def setUp(self):
        self.folder = open_folder()
        self.path = pathlib.Path(self.folder.name)
        for name, text in (("met", MET), ("not_met", NOT_MET), ("answered", ANSWERED)):
            (self.path / f"{name}.toml").write_text(text)
        self.environment = {**os.environ, "SKYLOOP": SKYLOOP, "PYTHONPATH": str(ROOT / "tools/python")}

    def tearDown(self):
        self.folder.cleanup()

    def run_in_folder(self, *command, **options):
        return subprocess.run([*map(str, command)], cwd=self.path, env=self.environment, capture_output=True, text=True,
                              timeout=150, check=False, **options)

    def test_pytest_fixture(self):
        if subprocess.run([sys.executable, "-c", "import pytest"], capture_output=True, check=False).returncode:
            self.skipTest("pytest is not installed; apt-get install python3-pytest")
        (self.path / "conftest.py").write_text('pytest_plugins = ["skyloop_pytest"]\n')
        (self.path / "test_client.py").write_text(PYTEST)
        done = self.run_in_folder(sys.executable, "-m", "pytest", "-q", "--strict-markers", "-p", "no:cacheprovider",
                                  "--basetemp", self.path / "tmp", "--junit-xml", self.path / "pytest.xml")
        self.assertTrue((self.path / "pytest.xml").exists(), done.stdout + done.stderr)
        cases = xml.etree.ElementTree.parse(self.path / "pytest.xml").getroot().iter("testcase")
        seen = {case.get("name"): "".join(child.tag + (child.get("message") or "") for child in case) for case in cases}
        for name in ("test_met", "test_evidence", "test_two_ports_and_an_early_end",
                     "test_a_port_whose_client_sets_the_line", "test_a_port_that_calls_a_server"):
            self.assertEqual(seen[name], "", name + done.stdout)
        self.assertIn("failure", seen["test_that_has_to_fail"])
        self.assertIn("evidence:", seen["test_that_has_to_fail"])
        self.assertIn("no_such_file.toml", done.stdout)
        self.assertIn("error", seen["test_without_a_scenario"])
        self.assertIn("needs @pytest.mark.skyloop_scenario", seen["test_without_a_mark"])

    def test_cmake_function(self):
        if not shutil.which("cmake"):
            self.skipTest("cmake is not installed; apt-get install cmake")
        (self.path / "client.py").write_text(CLIENT)
        (self.path / "CMakeLists.txt").write_text(CMAKE.format(root=ROOT, python=sys.executable, folder=self.path))
        built = self.run_in_folder("cmake", "-S", ".", "-B", "build", f"-DSKYLOOP_PROGRAM={SKYLOOP}")
        self.assertEqual(built.returncode, 0, built.stdout + built.stderr)
        done = self.run_in_folder("ctest", "--test-dir", "build", "-j3", "--output-on-failure", "--output-junit", "ctest.xml")
        cases = xml.etree.ElementTree.parse(self.path / "build/ctest.xml").getroot().iter("testcase")
        seen = {case.get("name"): case.get("status") for case in cases}
        self.assertEqual(seen, {"met": "run", "not_met": "fail", "live": "run", "mute": "fail", "endless": "fail"},
                         done.stdout)
        self.assertIn("CFG-VALSET", done.stdout)
        self.assertIn("the run went on after 3 s; it was killed", done.stdout)
        self.assertTrue((self.path / "build/skyloop/live/junit.xml").exists())

    def test_cmake_misuse_is_told(self):
        if not shutil.which("cmake"):
            self.skipTest("cmake is not installed; apt-get install cmake")
        for line, words in (("skyloop_scenario_test(x)", "expected SCENARIO FILE"),
                            ("skyloop_scenario_test(x SCENARIO met.toml TIMOUT 3)", "is not understood")):
            (self.path / "misuse.cmake").write_text(f"include({ROOT}/tools/cmake/SkyloopScenarioTest.cmake)\n{line}\n")
            done = self.run_in_folder("cmake", "-P", "misuse.cmake")
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(words, " ".join(done.stderr.split()))

    def test_files_for_ci_services(self):
        try:
            import yaml
        except ImportError:
            self.skipTest("python3-yaml is not installed; apt-get install python3-yaml")
        binaries = self.path / "bin"
        binaries.mkdir()
        (binaries / "skyloop").symlink_to(SKYLOOP)
        self.environment["PATH"] = f"{binaries}:{os.environ['PATH']}"
        files = sorted((ROOT / "examples/ci").glob("*.yml"))
        self.assertEqual([file.name for file in files], ["github-actions.yml", "gitlab-ci.yml"])
        scenarios = self.path / "gnss"
        for file in files:
            scripts = run_scripts(yaml.safe_load(file.read_text()))
            self.assertEqual(len(scripts), 1, file)
            for bad in (False, True):
                with self.subTest(file=file.name, bad=bad):
                    shutil.rmtree(self.path / "results", ignore_errors=True)
                    shutil.rmtree(scenarios, ignore_errors=True)
                    scenarios.mkdir()
                    (scenarios / "b.toml").write_text(MET)
                    if bad:
                        (scenarios / "a.toml").write_text(NOT_MET)
                    # As both services run it: the shell stops at the first command that fails.
                    done = self.run_in_folder("bash", "-e", "-o", "pipefail", "-c", scripts[0])
                    self.assertEqual(done.returncode, int(bad), done.stdout + done.stderr)
                    left = sorted(str(found.relative_to(self.path)) for found in self.path.glob("results/*/junit.xml"))
                    self.assertEqual(left, ["results/a/junit.xml"] * bad + ["results/b/junit.xml"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
