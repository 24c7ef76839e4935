"""One page, done as its reader would do it: in a folder of its own, block after block."""
import ast
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
import xml.etree.ElementTree

from blocks import RUN, blocks_of, first_missing, steps_of
from session import ROOT, SKYLOOP, open_folder

# Ports that pages name: each run of a page takes free ones in their place, so that pages can be run side by side.
PORTS = re.compile(r"(?<![\d.,])(2000|2101|2217|2948|3240|5000|5503|5561|8080|9000|14550|14551|14560|29990)(?![\d.])")
PATIENCE_S = 200


def free_port():
    """A port of the loopback address that nobody has, by TCP and UDP."""
    while True:
        with socket.socket() as stream, socket.socket(type=socket.SOCK_DGRAM) as datagram:
            stream.bind(("127.0.0.1", 0))
            try:
                datagram.bind(stream.getsockname())
            except OSError:
                continue
            return str(stream.getsockname()[1])


class PageRun:
    """Runs the blocks of a page; counts what was run, looked at and left out."""

    def __init__(self, page, text):
        self.blocks = blocks_of(page, text)
        self.temporary = open_folder()
        self.folder = pathlib.Path(self.temporary.name) / "work"
        self.staying, self.ports, self.counts, self.left_out = [], {}, {"run": 0, "looked at": 0}, []
        for name in ("work", "bin", "tmp", "cache"):
            (self.folder.parent / name).mkdir(mode=0o755)
        (self.folder.parent / "bin/skyloop").symlink_to(SKYLOOP)
        for entry in ("tools", "examples", "docs", "boards", "data", "tests"):
            (self.folder / entry).symlink_to(ROOT / entry)
        self.environment = dict(os.environ, PATH=f"{self.folder.parent}/bin:{os.environ['PATH']}:/usr/sbin", LC_ALL="C.UTF-8",
                                XDG_CACHE_HOME=str(self.folder.parent / "cache"), TZ="UTC")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            for process in self.staying:
                self.end(process, by=signal.SIGKILL)
        finally:
            self.temporary.cleanup()

    def here(self, text):
        """The text with this run's ports and its own folder for /tmp."""
        text = PORTS.sub(lambda found: self.taken(found.group()), text)
        return re.sub(r"(?<![\w/])/tmp/", f"{self.folder.parent}/tmp/", text)

    def taken(self, port):
        if port not in self.ports:
            self.ports[port] = free_port()
        return self.ports[port]

    def there(self, text):
        """What was said, with the ports and paths of the page again."""
        text = text.replace(f"{self.folder.parent}/tmp/", "/tmp/")
        for shown, taken in self.ports.items():
            text = re.sub(rf"(?<!\d){taken}(?!\d)", shown, text)
        return text

    def run(self):
        """All blocks; AssertionError names the first that is not as the page says."""
        for block in self.blocks:
            if block.has("not run"):
                self.left_out.append(f"{block}: {block.all('not run')[0]}")
                continue
            absent = [program for program in block.all("needs") if not self.found(program)]
            if absent:
                self.left_out.append(f"{block}: {', '.join(absent)} is not installed here")
                continue
            self.prepare(block)
            if block.tag in RUN:
                self.counts["run"] += 1
                self.run_commands(block)
            else:
                self.counts["looked at"] += 1
                getattr(self, f"look_at_{block.tag}", lambda _: None)(block)
        for process in list(self.staying):
            self.end(process)

    def prepare(self, block):
        for given in block.all("given"):
            name, path = given.split(" = ")
            if path.endswith(".md"):
                block_there = next(b for b in blocks_of(path, (ROOT / path).read_text(encoding="utf-8")) if name in b.all("file"))
                (self.folder / name).write_text(self.here(block_there.text), encoding="utf-8")
            else:
                shutil.copy(ROOT / path, self.folder / name)
        for name in block.all("file"):
            (self.folder / name).parent.mkdir(exist_ok=True)
            (self.folder / name).write_text(self.here(block.text), encoding="utf-8")
        for command in block.all("before"):
            self.shell(block, command)

    def found(self, program):
        return shutil.which(program, path=self.environment["PATH"] + ":/usr/sbin:/sbin")

    # Commands

    def shell(self, block, command):
        """Runs one command, or in sh blocks one after the other, to its end; gives all that it said."""
        return "".join(self.streams(block, command))

    def streams(self, block, command, expected_code=0):
        """The same, standard output and standard error each by itself."""
        options = "-ec" if block.tag == "sh" else "-c"
        try:
            done = subprocess.run(["bash", options, self.here(command)], cwd=self.folder, env=self.environment, text=True,
                                  stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  timeout=PATIENCE_S, errors="replace")
        except subprocess.TimeoutExpired as late:
            raise AssertionError(f"{block}: did not end within {PATIENCE_S} s: {command}\n{late.stderr}") from late
        said = self.there(done.stdout), self.there(done.stderr)
        assert done.returncode == expected_code, f"{block}: `{command}` ended {done.returncode}:\n{''.join(said)}"
        return said

    def run_commands(self, block):
        steps = steps_of(block) if block.tag == "console" else [(block.text, [])]
        if block.has("stays"):
            assert len(steps) == 1, f"{block}: only one command of a block can stay"
            self.stay(block, *steps[0])
            return
        for command, shown in steps:
            output, errors = self.streams(block, command)
            said = output + errors
            vary = block.has("numbers vary")
            missing = first_missing(shown, said, vary) and first_missing(shown, errors + output, vary)
            assert missing is None, f"{block}: `{command}` did not say, where it is shown:\n{missing}\nIt said:\n{said}"

    def stay(self, block, command, shown):
        """Starts a command that runs on, and waits until it has said what is shown, or which port it has."""
        if block.all("stays") != ["beside"]:
            for process in list(self.staying):
                self.end(process)
        log = self.folder.parent / f"log{block.line}"
        with open(log, "wb") as output:
            process = subprocess.Popen(["bash", "-ec", self.here(command)], cwd=self.folder, env=self.environment,
                                       stdin=subprocess.DEVNULL, stdout=output, stderr=output, start_new_session=True)
        process.block, process.log = block, log
        self.staying.append(process)
        expected = shown or (["port 0…"] if re.search(r"skyloop (run|replay)", command) else [])
        begun = time.monotonic()
        while True:
            said = self.there(log.read_text(errors="replace"))
            missing = first_missing(expected, said, block.has("numbers vary"))
            assert process.poll() is None, f"{block}: ended {process.returncode} by itself:\n{said}"
            if missing is None and time.monotonic() - begun > (0 if expected else 1):
                return
            assert time.monotonic() - begun < 40, f"{block}: did not say:\n{missing}\nIt said:\n{said}"
            time.sleep(0.05)

    def end(self, process, by=signal.SIGTERM):
        """Ends what stayed, with all that it started; a run of ours has to end cleanly."""
        self.staying.remove(process) if by == signal.SIGTERM else None
        alive = process.poll() is None
        try:
            os.killpg(process.pid, by)
        except ProcessLookupError:
            pass
        try:
            process.wait(timeout=20)
        finally:
            if process.returncode is None:
                os.killpg(process.pid, signal.SIGKILL)
        said = process.log.read_text(errors="replace")
        assert alive or by == signal.SIGKILL, f"{process.block}: ended {process.returncode} by itself:\n{said}"
        assert "Sanitizer" not in said and "terminate called" not in said, f"{process.block}:\n{said}"

    # Languages

    def look_at_toml(self, block):
        name = (block.all("file") or [f"block{block.line}.toml"])[0]
        (self.folder / name).write_text(self.here(block.text), encoding="utf-8")
        what = "boards ./" if any(line.startswith("extends = ") for line in block.text.splitlines()) else "check "
        self.streams(block, f"skyloop {what}{name}", expected_code=2 if block.has("refused") else 0)

    def look_at_python(self, block):
        ast.parse(block.text, str(block))

    def look_at_json(self, block):
        """One value, or one a line."""
        try:
            json.loads(block.text)
        except json.JSONDecodeError:
            for line in block.text.splitlines():
                json.loads(line)

    def look_at_xml(self, block):
        xml.etree.ElementTree.fromstring(block.text)

    def look_at_yaml(self, block):
        try:
            import yaml
        except ImportError:
            self.left_out.append(f"{block}: no python3-yaml here")
            return
        assert yaml.safe_load(block.text), f"{block}: empty"

    def look_at_c(self, block):
        """Compiled against skyloop.h inside of a function, `…` being what the reader fills in."""
        text = re.sub(r"^….*$", "", block.text, flags=re.MULTILINE).replace("…", "return;")
        includes = "\n".join(re.findall(r"^#include .*$", text, re.MULTILINE))
        body = re.sub(r"^#include .*$", "", text, flags=re.MULTILINE)
        source = self.folder / f"block{block.line}.c"
        around = "\n".join(block.all("context"))
        source.write_text(f"{includes}\n{around}\nvoid block(void);\nvoid block(void) {{\n{body}\n}}\n",
                          encoding="utf-8")
        self.shell(block, f"cc -std=c11 -fsyntax-only -Wall -Werror -I{ROOT}/include {source.name}")

    def look_at_cmake(self, block):
        """Read by cmake, with its commands about packages and targets looking at what they are given."""
        version = re.search(r"project\(skyloop VERSION (\d+\.\d+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
        script = self.folder / f"block{block.line}.cmake"
        script.write_text(f"""cmake_policy(VERSION 3.20)
function(find_package name version)
  if(NOT name STREQUAL skyloop OR NOT version STREQUAL "{version}")
    message(FATAL_ERROR "find_package(${{ARGV}}): expected skyloop {version}")
  endif()
endfunction()
function(target_link_libraries target)
  if(NOT "skyloop::skyloop" IN_LIST ARGN)
    message(FATAL_ERROR "target_link_libraries(${{ARGV}}): expected skyloop::skyloop")
  endif()
endfunction()
function(skyloop_scenario_test)
endfunction()
{block.text}""", encoding="utf-8")
        self.shell(block, f"cmake -P {script.name}")


def report(page, done, file=sys.stdout):
    """The counts of a page, and by name what was left out."""
    print(f"{page}: {len(done.blocks)} blocks: {done.counts['run']} run, {done.counts['looked at']} read by their programs, "
          f"{len(done.left_out)} left out", file=file)
    for line in done.left_out:
        print(f"  not run: {line}", file=file)
