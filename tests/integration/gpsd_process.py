"""gpsd on a tty of ours, for the tests that run it."""
import json
import shutil
import socket
import subprocess
import time


def free_port():
    """A port of the loopback address that nobody has."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Gpsd:
    """gpsd in the foreground on one tty, and a client of its JSON."""

    def __init__(self, tty, *options, port=None):
        self.port = port or free_port()
        self.process = subprocess.Popen([shutil.which("gpsd"), "-N", "-n", *options, "-S", str(self.port), tty],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.stream = None

    def reports(self, patience):
        """The JSON objects of gpsd for `patience` seconds."""
        end = time.monotonic() + patience
        while self.stream is None and time.monotonic() < end:
            try:
                self.socket = socket.create_connection(("127.0.0.1", self.port), timeout=1)
                self.stream = self.socket.makefile("r")
                self.socket.sendall(b'?WATCH={"enable":true,"json":true};\n')
            except OSError:
                time.sleep(0.2)
        while time.monotonic() < end:
            self.socket.settimeout(max(0.1, end - time.monotonic()))
            try:
                line = self.stream.readline()
            except OSError:
                return
            if line:
                yield json.loads(line)

    def stop(self):
        """Ends gpsd."""
        if self.stream:
            self.stream.close()
            self.socket.close()
        self.process.terminate()
        _, log = self.process.communicate(timeout=10)
        return log
