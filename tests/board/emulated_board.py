"""The board of these tests: our driver, compiled for an STM32F405, on QEMU's netduinoplus2.

Its USART2 is joined to skyloop's pty, its USART1 to pipes. QEMU's USART takes a byte at once and does not hand its divider
on to the tty: the speed that the driver has written into BRR is set here, when it reports it.
"""
import os
import pathlib
import select
import shutil
import struct
import subprocess
import fcntl
import termios
import time

HERE = pathlib.Path(__file__).resolve().parent
COMPILER, QEMU = "arm-none-eabi-gcc", "qemu-system-arm"
APB1_HZ = 42_000_000  # firmware/stm32f405.h
# <asm-generic/ioctls.h>, <asm-generic/termbits.h>: a speed of any number.
TCGETS2, TCSETS2, BOTHER, CBAUD = 0x802C542A, 0x402C542B, 0o010000, 0o010017
TERMIOS2 = struct.Struct("IIIIB19sII")


def missing():
    """The name of a program that is not installed, or None."""
    return next((name for name in (COMPILER, QEMU) if shutil.which(name) is None), None)


def build(folder):
    """Compiles the driver; gives the path of the program."""
    program = pathlib.Path(folder, "driver.elf")
    sources = sorted((HERE / "firmware").glob("*.c"))
    command = [COMPILER, "-std=c11", "-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=soft", "-Os", "-g", "-ffreestanding",
               "-fno-tree-loop-distribute-patterns", "-nostdlib", "-Wall", "-Wextra", "-Wconversion", "-Werror",
               "-Wl,--fatal-warnings", "-T", HERE / "firmware/stm32f405.ld", *sources, "-lgcc", "-o", program]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=120)
    if done.returncode != 0:
        raise AssertionError(f"{COMPILER} ended {done.returncode}: {done.stderr}")
    return program


def set_speed(descriptor, baud):
    """Gives a tty any speed, 8N1."""
    raw = fcntl.ioctl(descriptor, TCGETS2, bytes(TERMIOS2.size))
    iflag, oflag, cflag, lflag, line, chars, _, _ = TERMIOS2.unpack(raw)
    cflag = cflag & ~CBAUD | BOTHER
    fcntl.ioctl(descriptor, TCSETS2, TERMIOS2.pack(iflag, oflag, cflag, lflag, line, chars, baud, baud))


class Board:
    """The running board; `reports` holds each line that it has told: (seconds since its start, words)."""

    def __init__(self, program, tty):
        # QEMU opens the tty raw at 115200, a while after this; from the first report on the speed is the board's.
        self.tty = os.open(tty, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        set_speed(self.tty, 115200)
        self.began = time.monotonic()
        self.process = subprocess.Popen(
            [QEMU, "-machine", "netduinoplus2", "-display", "none", "-monitor", "none", "-serial", "stdio",
             "-chardev", f"serial,id=receiver,path={tty}", "-serial", "chardev:receiver", "-kernel", str(program)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, bufsize=0)
        self.reports = []
        self.rest = b""

    def listen(self, seconds):
        """Takes what the board reports for some time; gives whether it is still running."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            if not select.select([self.process.stdout], [], [], left)[0]:
                continue
            data = os.read(self.process.stdout.fileno(), 65536)
            if not data:
                return False
            *lines, self.rest = (self.rest + data).split(b"\n")
            for line in lines:
                self._reported(line.decode("ascii", "replace").split())
        return True

    def _reported(self, words):
        self.reports.append((time.monotonic() - self.began, words))
        if words[:1] == ["line"]:
            set_speed(self.tty, round(APB1_HZ / int(words[2])))
            self.process.stdin.write(b".")

    def listen_for(self, word, patience, count=1):
        """Listens until a report has been heard so many times; gives its last words."""
        end = time.monotonic() + patience
        while time.monotonic() < end:
            found = self.all(word)
            if len(found) >= count:
                return found[count - 1]
            if not self.listen(0.1):
                raise AssertionError(f"{QEMU} ended {self.process.wait(timeout=5)}: {self.rest} {self.reports[-5:]}")
        raise AssertionError(f"no {count} × '{word}' within {patience} s: {self.reports[-20:]}")

    def all(self, word):
        """The numbers of every report of this kind."""
        return [list(map(int, words[1:])) for _, words in self.reports if words[:1] == [word]]

    def text(self):
        return "".join(f"{at:8.3f} {' '.join(words)}\n" for at, words in self.reports)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait(timeout=20)
        self.process.stdin.close()
        self.process.stdout.close()
        os.close(self.tty)
