"""What the integration tests share: the program under test and a running emulator with its tty."""
import os
import pathlib
import re
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKYLOOP = os.environ.get("SKYLOOP", str(ROOT / "build/dev/bin/skyloop"))
SHARED = pathlib.Path(os.environ.get("SKYLOOP_SHARED_DATA", ROOT / "../shared/data"))
SKIPPED = 77


def skip(reason):
    """Ends the whole test program as skipped."""
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def skyloop(*arguments, check=True, patience=120, env=None):
    """Runs the program to its end; gives the finished process with its text."""
    done = subprocess.run([SKYLOOP, *map(str, arguments)], capture_output=True, text=True, timeout=patience,
                          env=env)
    if check and done.returncode != 0:
        raise AssertionError(f"skyloop {' '.join(map(str, arguments))} ended {done.returncode}: {done.stderr}")
    return done


def held_by(pid):
    """Resident kB and open descriptors of a process; nothing of one that has ended."""
    try:
        pages = int(pathlib.Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[1])
        descriptors = len(os.listdir(f"/proc/{pid}/fd"))
    except (FileNotFoundError, ProcessLookupError):
        return None
    # A process that nobody has waited for has no memory left.
    return (pages * os.sysconf("SC_PAGE_SIZE") // 1024, descriptors) if pages > 0 else None


def open_folder():
    """A temporary folder that other users may enter: gpsd gives up root before it opens the tty."""
    folder = tempfile.TemporaryDirectory(prefix="skyloop-test-")
    os.chmod(folder.name, 0o755)
    return folder


def septentrio_that_sends(folder, *blocks):
    """A board file in the folder: septentrio-sbf, which sends these blocks from the factory on."""
    board = (ROOT / "boards/receivers/septentrio-sbf.toml").read_text(encoding="utf-8")
    path = pathlib.Path(folder, "board.toml")
    path.write_text(board + f"\n[sbf]\nblocks = {list(blocks)}\n", encoding="utf-8")
    return path


def npm_packages(folder, needed, environment="SKYLOOP_NODE_FOLDER"):
    """Where the packages of FOLDER's package.json are, fetched there when `needed`, one of them, is not; and why they cannot
    be, with None for a folder. `environment` names the variable that says where."""
    here = pathlib.Path(__file__).resolve().parent / folder
    where = pathlib.Path(os.environ.get(environment, ROOT / "build/dev/tests" / folder))
    if not shutil.which("node") or not shutil.which("npm"):
        return None, "there is no node or npm; apt-get install nodejs npm"
    where.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(here / "package.json", where / "package.json")
    if not (where / "node_modules" / needed / "package.json").exists():
        done = subprocess.run(["npm", "install", "--prefer-offline", "--no-audit", "--no-fund", "--no-package-lock",
                               "--ignore-scripts"], cwd=where, capture_output=True, text=True, timeout=90)
        if done.returncode != 0:
            return None, f"npm cannot install {needed}: {done.stderr.splitlines()[-1:]}"
    return where, ""


class Emulator:
    """`skyloop run`, or another command that has ports, in the background; `tty` is the path of its first port."""

    def __init__(self, *arguments, command="run", env=None):
        # Unbuffered: a line that waits in a buffer of ours is one that select() does not tell of.
        self.process = subprocess.Popen([SKYLOOP, command, *map(str, arguments)], stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, bufsize=0,
                                        env={**os.environ, **(env or {})})
        self.log = ""
        self.tty = None
        try:
            self.tty = self.port(0)
        finally:
            if self.tty is None:
                self.process.kill()
                self.process.wait(timeout=20)

    def port(self, number, receiver=""):
        """The path, or the address, of a port; of several receivers that of the first, or of the named one."""
        owner = f"{re.escape(receiver)}: " if receiver else r"(?:\S+: )?"
        return self.said(rf"^{owner}port {number}(?: \(\w+\))?: (\S+) \([a-z0-9-]+\)\n", patience=60)

    def said(self, pattern, patience=20):
        """Waits until stderr holds the pattern; gives its first group."""
        end = time.monotonic() + patience
        while time.monotonic() < end:
            if select.select([self.process.stderr], [], [], 0.2)[0]:
                self.log += os.read(self.process.stderr.fileno(), 4096).decode()
            found = re.search(pattern, self.log, re.MULTILINE)
            if found:
                return found.group(1)
            if self.process.poll() is not None:
                raise AssertionError(f"skyloop ended {self.process.returncode}: {self.log}")
        raise AssertionError(f"nothing like {pattern} within {patience} s: {self.log}")

    def listen(self):
        """Takes what has been said meanwhile: a pipe that is full holds the program up."""
        while select.select([self.process.stderr], [], [], 0)[0]:
            piece = os.read(self.process.stderr.fileno(), 65536)
            if not piece:
                return
            self.log += piece.decode()

    def finish(self, patience=30):
        """Waits for the run to end by itself; gives the exit code."""
        _, rest = self.process.communicate(timeout=patience)
        self.log += rest.decode()
        return self.process.returncode

    def stop(self, by=signal.SIGTERM):
        """Ends the run; gives the exit code and all that was said on stderr."""
        if self.process.poll() is None:
            self.process.send_signal(by)
        _, rest = self.process.communicate(timeout=20)
        self.log += rest.decode()
        return self.process.returncode

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.communicate(timeout=20)
