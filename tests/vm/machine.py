"""A virtual machine with Debian's kernel, made for one test: initramfs, QEMU without hardware support, a shell on its second
serial port that the test speaks to, and QEMU's own monitor for cables that are pulled.
"""
import itertools
import json
import os
import pathlib
import re
import select
import shutil
import signal
import socket
import subprocess
import time

import kernel as kernels

HERE = pathlib.Path(__file__).resolve().parent
QEMU, BUSYBOX = "qemu-system-x86_64", "busybox"
HOST = "10.0.2.2"  # this machine, as QEMU's user network shows it
MODULES = ["virtio_pci", "virtio_net", "xhci_pci", "ftdi_sio", "cdc_acm", "vhci_hcd", "uhid", "hid_generic", "usbhid"]


def missing():
    """The name of a program that is not installed, or None."""
    for name in (QEMU, BUSYBOX, "cpio", "modprobe", "depmod", "dpkg-deb", "usbip", "gcc"):
        if not shutil.which(kernels.tool(name)):
            return name
    return None


def libraries(program):
    """The shared libraries that a program is started with."""
    done = subprocess.run(["ldd", program], capture_output=True, text=True, timeout=30)
    return [pathlib.Path(path) for path in re.findall(r"(/\S+) \(0x", done.stdout)]


class Initramfs:
    """The files of the machine, in a folder that becomes one archive."""

    def __init__(self, folder, kernel):
        self.root = pathlib.Path(folder, "root")
        for name in ("bin", "dev", "proc", "sys", "tmp", "run", "var/run"):
            (self.root / name).mkdir(parents=True)
        shutil.copy(shutil.which(BUSYBOX), self.root / "bin/busybox")
        names = subprocess.run([BUSYBOX, "--list"], capture_output=True, text=True, timeout=30, check=True).stdout.split()
        for name in names:
            if name != "busybox":
                (self.root / "bin" / name).symlink_to("busybox")
        self._modules(kernel)
        self.file(HERE / "guest/init", "init")

    def _modules(self, kernel):
        for path in kernel.with_dependencies(*MODULES):
            self.file(path, path.relative_to(kernel.root))
        subprocess.run([kernels.tool("depmod"), "-b", self.root, kernel.release], capture_output=True, timeout=60, check=True)

    def file(self, source, target):
        target = self.root / target
        target.parent.mkdir(parents=True, exist_ok=True)
        if not target.exists():
            shutil.copy(source, target)

    def program(self, path, strip=False):
        """A program of this machine with its libraries."""
        path = pathlib.Path(path)
        for library in libraries(path):
            self.file(library, str(library).lstrip("/"))
        target = self.root / "bin" / path.name
        target.unlink(missing_ok=True)  # busybox may have one of that name
        shutil.copy(path, target)
        if strip:
            subprocess.run(["strip", target], timeout=120, check=True)

    def loaded(self, name):
        """A library that a program loads by its name while it runs; left out where this machine does not have it."""
        found = re.search(rf"{re.escape(name)} .*x86-64.* => (\S+)",
                          subprocess.run([kernels.tool("ldconfig"), "-p"], capture_output=True, text=True, timeout=30).stdout)
        for library in [found.group(1), *libraries(found.group(1))] if found else []:
            self.file(library, str(library).lstrip("/"))

    def compiled(self, name):
        """A program of the folder `guest`."""
        command = ["gcc", "-static", "-O2", "-Wall", "-Wextra", "-Werror", HERE / f"guest/{name}.c", "-o",
                   self.root / "bin" / name]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120)
        if done.returncode != 0:
            raise AssertionError(f"gcc ended {done.returncode} on {name}.c: {done.stderr}")

    def archive(self):
        """Not compressed: this is quicker to make and to read."""
        target = self.root.parent / "initramfs.cpio"
        names = sorted(str(path.relative_to(self.root)) for path in self.root.rglob("*"))
        with open(target, "wb") as archive:
            subprocess.run(["cpio", "--create", "--format=newc", "--quiet"], cwd=self.root, input="\n".join(names).encode(),
                           stdout=archive, timeout=120, check=True)
        return target


class Machine:
    """The running machine. `lines` is its transcript: (seconds since the start, text)."""

    def __init__(self, kernel, initramfs, folder, devices=(), *, life):
        self.began = time.monotonic()
        self.until = self.began + life
        self.lines, self.rest, self.jobs = [], b"", itertools.count()
        self.console = pathlib.Path(folder, "console.txt")
        monitor = pathlib.Path(folder, "monitor")
        self.process = subprocess.Popen(
            ["timeout", "--signal=KILL", str(life), QEMU, "-machine", "q35,accel=tcg", "-cpu", "max", "-smp", "1", "-m", "768",
             "-nodefaults", "-display", "none", "-no-reboot", "-kernel", kernel.image, "-initrd", initramfs,
             "-append", "console=ttyS0 panic=-1 loglevel=6 mitigations=off cryptomgr.notests tsc=nowatchdog no_timer_check", "-serial", f"file:{self.console}", "-serial", "stdio",
             "-netdev", "user,id=net", "-device", "virtio-net-pci,netdev=net", "-qmp", f"unix:{monitor},server=on,wait=off",
             "-device", "qemu-xhci,id=usb", *devices],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, bufsize=0, start_new_session=True)
        try:
            self.release = self._until(r"@ready (\S+)", 90)[1].group(1)
            self.monitor = Monitor(monitor)
        except BaseException:
            self._end()
            raise

    def say(self, text):
        """A line of the transcript."""
        self.lines.append((time.monotonic() - self.began, text))

    def _until(self, pattern, patience):
        """Reads lines until one is the pattern; gives those before it, and the match."""
        before, end = [], min(time.monotonic() + patience, self.until)
        while True:
            while b"\n" in self.rest:
                line, self.rest = self.rest.split(b"\n", 1)
                text = line.decode("utf-8", "replace").rstrip("\r")
                found = re.fullmatch(pattern, text)
                if found:
                    return before, found
                self.say(text)
                before.append(text)
            left = end - time.monotonic()
            if left <= 0:
                raise AssertionError(f"nothing like {pattern} within {patience} s\n{self.text()[-4000:]}\n{self.console_text()[-3000:]}")
            if not select.select([self.process.stdout], [], [], left)[0]:
                continue
            data = os.read(self.process.stdout.fileno(), 65536)
            if not data:
                raise AssertionError(f"the machine has ended\n{self.text()[-2000:]}\n{self.console_text()[-2000:]}")
            self.rest += data

    def run(self, command, patience=30, check=True):
        """Runs one line of shell in the machine; gives what it printed."""
        self.say(f"$ {command}")
        self.process.stdin.write(command.encode() + b"\n")
        printed, ended = self._until(r"@ended (\d+)", patience)
        if check and ended.group(1) != "0":
            raise AssertionError(f"`{command}` ended {ended.group(1)}\n{self.text()[-4000:]}")
        return "\n".join(printed)

    def wait_for(self, condition, patience=15):
        """Waits in the machine until a test of its shell holds; gives whether it did."""
        self.run(f"for i in $(seq {int(patience * 10)}); do {condition} && exit 0; usleep 100000; done; {condition}",
                 patience=patience * 4 + 10)

    def start(self, command):
        """Runs something in the background; gives the name of the file of its output."""
        output = f"/tmp/job{next(self.jobs)}"
        self.run(f"({command}) >{output} 2>&1 & echo $! >{output}.pid")
        return output

    def stop(self, output, by="TERM"):
        """Ends what start() began; gives its output."""
        self.run(f"kill -{by} $(cat {output}.pid); for i in $(seq 50); do kill -0 $(cat {output}.pid) 2>/dev/null || break; "
                 "usleep 100000; done", check=False)
        return self.run(f"cat {output}")

    def console_text(self):
        return self.console.read_text(errors="replace") if self.console.exists() else ""

    def text(self):
        return "".join(f"[{at:8.3f}] {line}\n" for at, line in self.lines)

    def _end(self):
        # Both of them: QEMU, and the program that bounds its life should this test be killed.
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait(timeout=20)
        self.process.stdin.close()
        self.process.stdout.close()

    def close(self):
        """Switches the machine off, and gives the seconds that it was on."""
        self.monitor.command("quit")
        self.monitor.close()
        try:
            self.process.wait(timeout=10)
        finally:
            self._end()
        return time.monotonic() - self.began


class Monitor:
    """QEMU's machine protocol: one JSON object a line."""

    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.socket.settimeout(20)
        self.socket.connect(str(path))
        self.stream = self.socket.makefile("rb")
        self.stream.readline()  # the greeting
        self.command("qmp_capabilities")

    def command(self, name, **arguments):
        """Runs a command and gives its answer; events in between are passed over."""
        self.socket.sendall(json.dumps({"execute": name, "arguments": arguments}).encode() + b"\n")
        for line in self.stream:
            answer = json.loads(line)
            if "error" in answer:
                raise AssertionError(f"{name} {arguments}: {answer['error']['desc']}")
            if "return" in answer:
                return answer["return"]
        return None

    def close(self):
        self.stream.close()
        self.socket.close()
