"""Starts `skyloop run` for a test: as a pytest fixture, or by hand.

    pytest_plugins = ["skyloop_pytest"]          # in conftest.py, with this folder in PYTHONPATH

    @pytest.mark.skyloop_scenario("outage.toml", "--duration", "60")
    def test_the_client_notices(skyloop_run):
        client = MyClient(skyloop_run.tty)       # the path of the first port
        …
        skyloop_run.wait()                       # to the end of the scenario
        skyloop_run.check()                      # fails with the evidence of what was expected and not met

The program is $SKYLOOP, or `skyloop` of $PATH. Its files (junit.xml, run.json, the bytes of both directions) lie in
`skyloop_run.folder`, which is pytest's own temporary folder of the test.
"""
import json
import os
import pathlib
import re
import signal
import subprocess
import threading
import time
import xml.etree.ElementTree

# "port 0: /tmp/gps0 (pty)", "rover: port 1 (uart2): 127.0.0.1:2000 (tcp)", "port 0: 127.0.0.1:2000 (rfc2217)"
PORT_LINE = re.compile(r"^(?:.+: )?port \d+(?: \(\w+\))?: (.+) \((?:pty|tcp|tcp-connect|rfc2217)\)$", re.MULTILINE)
MET, NOT_MET, REFUSED = 0, 3, 2  # exit codes


class ExpectationsNotMet(AssertionError):
    """The run did not do what its scenario expects."""


class Verdict:
    """One test case of junit.xml."""

    def __init__(self, node):
        results = {"failure": "failed", "error": "undecided", "skipped": "not run"}
        found = next((child for child in node if child.tag in results), None)
        self.name = node.get("name")
        self.outcome = "passed" if found is None else results[found.tag]
        self.evidence = "" if found is None else (found.get("message") or found.text or "")

    def __repr__(self):
        return f"{self.name}: {self.outcome} {self.evidence}".rstrip()


def read_verdicts(path):
    """The verdicts of a junit.xml, or none where there is no such file: the scenario then expects nothing."""
    path = pathlib.Path(path)
    if not path.exists():
        return []
    return [Verdict(node) for node in xml.etree.ElementTree.parse(path).getroot().iter("testcase")]


class SkyloopRun:
    """A running emulator; `ttys` are its ports in order, each the path of a pty, the address of a server (tcp, rfc2217) or
    that which skyloop calls (tcp-connect); `tty` the first."""

    def __init__(self, scenario, folder, *options, ports=1, patience=60):
        self.folder = pathlib.Path(folder)
        command = [os.environ.get("SKYLOOP", "skyloop"), "run", str(scenario), "--record", str(self.folder)]
        self.process = subprocess.Popen([*command, *map(str, options)], stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self._log, self._lock = [], threading.Lock()
        # Read all along, so that a full pipe never stops the emulator.
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        try:
            self.ttys = self._wait_for_ports(ports, patience)
        except BaseException:
            self.kill()
            raise
        self.tty = self.ttys[0] if self.ttys else None

    def _read(self):
        while chunk := os.read(self.process.stderr.fileno(), 4096):
            with self._lock:
                self._log.append(chunk)

    @property
    def log(self):
        """What it has said so far."""
        with self._lock:
            return b"".join(self._log).decode(errors="replace")

    def _wait_for_ports(self, ports, patience):
        end = time.monotonic() + patience
        while time.monotonic() < end:
            over = self.process.poll() is not None
            if over:
                self._reader.join(timeout=5)
            found = PORT_LINE.findall(self.log)
            if len(found) >= ports:
                return found
            if over:
                raise RuntimeError(f"skyloop ended with exit code {self.process.returncode}: {self.log}")
            time.sleep(0.02)
        raise TimeoutError(f"expected {ports} port(s) within {patience} s, found {len(found)}: {self.log}")

    def wait(self, timeout=600):
        """Waits for the end of the scenario; gives the exit code."""
        self.process.wait(timeout)
        return self._close()

    def stop(self, timeout=20):
        """Ends the run now, cleanly; gives the exit code."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        return self.wait(timeout)

    def kill(self):
        """Ends the run without asking."""
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait(20)
        return self._close()

    def _close(self):
        self._reader.join(timeout=20)
        if not self._reader.is_alive():
            self.process.stderr.close()
        return self.process.returncode

    @property
    def verdicts(self):
        """What became of each expectation, once the run is over."""
        return read_verdicts(self.folder / "junit.xml")

    @property
    def summary(self):
        """run.json as a dictionary, once the run is over."""
        return json.loads((self.folder / "run.json").read_text())

    def check(self):
        """Raises ExpectationsNotMet with the evidence unless the run is over and met what was expected."""
        if self.process.poll() is None:
            raise ExpectationsNotMet("the run still goes on; wait() for its end or stop() it first")
        bad = [repr(v) for v in self.verdicts if v.outcome in ("failed", "undecided")]
        if bad:
            raise ExpectationsNotMet("\n".join([*bad, f"evidence: {self.folder}"]))
        if self.process.returncode != MET:
            raise ExpectationsNotMet(f"skyloop ended with exit code {self.process.returncode}: {self.log}")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.kill()


try:
    import pytest
except ImportError:  # the class above needs none
    pytest = None

if pytest is not None:

    def pytest_configure(config):
        config.addinivalue_line("markers", "skyloop_scenario(file, *options, ports=1): what skyloop_run runs")

    @pytest.fixture
    def skyloop_run(request, tmp_path):
        """The scenario of the test's skyloop_scenario mark, running; it is ended with the test."""
        mark = request.node.get_closest_marker("skyloop_scenario")
        if mark is None or not mark.args:
            pytest.fail("skyloop_run needs @pytest.mark.skyloop_scenario(FILE, …) at the test")
        scenario, *options = mark.args
        folder = request.path.parent / scenario
        with SkyloopRun(folder, tmp_path / "skyloop", *options, **mark.kwargs) as run:
            yield run
