"""RTKLIB's rtkrcv in real time: the raw measurements of a rover, and the corrections of its base by the run's caster.

Debian's rtkrcv 2.4.3 b34 opens what it calls ntripcli as an FTP client: str2str fetches the corrections for it."""
import shutil
import socket
import subprocess
import time
import unittest

from ntrip_test import BASE, ROVER, FolderTest, free_port
from session import Emulator, skip

PLACE = "at = [46.4775, 30.7326, 77.0]"
AWAY = "at = [46.4865, 30.7326, 77.0]"  # a kilometre north
LATITUDE, LONGITUDE = 46.4865, 30.7326

OPTIONS = """inpstr1-type=tcpcli
inpstr1-path={raw}
inpstr1-format=ubx
inpstr2-type=tcpcli
inpstr2-path=127.0.0.1:{relay}
inpstr2-format=rtcm3
inpstr3-type=off
outstr1-type=file
outstr1-path={solution}
outstr1-format=llh
outstr2-type=off
pos1-posmode=kinematic
pos1-frequency=l1+2
pos1-elmask=10
pos1-ionoopt=brdc
pos1-tropopt=saas
pos1-navsys=9
pos2-armode=continuous
pos2-arthres=3
pos2-arelmask=12
stats-eratio1=300
stats-eratio2=300
ant2-postype=rtcm
"""


class Rtkrcv:
    """Started by its console: with -s Debian's 2.4.3 b34 ends before it has begun."""

    def __init__(self, options):
        port, self.console = free_port(), None
        self.process = subprocess.Popen(["rtkrcv", "-p", str(port), "-o", options.name], cwd=options.parent,
                                        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        end = time.monotonic() + 10
        while True:
            try:
                self.console = socket.create_connection(("127.0.0.1", port))
                break
            except OSError:
                if time.monotonic() > end:
                    self.stop()
                    raise
                time.sleep(0.1)
        for line in (b"admin\r\n", b"start\r\n"):
            time.sleep(1)
            self.console.sendall(line)

    def stop(self):
        if self.console:
            self.console.close()
        self.process.terminate()
        self.process.wait(20)


class RtkrcvTest(FolderTest):
    def test_it_fixes_our_rover_by_our_caster(self):
        base = self.emulator("base.toml", BASE.replace("1074_UART1", "1077_UART1").replace("1094_UART1", "1097_UART1"))
        raw = "[receiver.config]\n" + "".join(f"CFG-MSGOUT-UBX_RXM_{name}_UART1 = 1\n" for name in ("RAWX", "SFRBX"))
        # RTKLIB 2.4.3 finds Galileo's records in pages of nine words alone. With GPS alone some hours would not do.
        board = self.folder / "nine_words.toml"
        board.write_text('extends = "ublox-f9p"\n[ubx]\ngalileo_words = 9\n', encoding="utf-8")
        rover = self.emulator("rover.toml", ROVER.replace(PLACE, AWAY).replace("ublox-f9p", str(board)) + raw)
        caster = base.said(r"^caster: 127\.0\.0\.1:(\d+) \(")
        solution, options = self.folder / "solution.pos", self.folder / "options.conf"
        relay = free_port()
        options.write_text(OPTIONS.format(raw=rover.tty, relay=relay, solution=solution), encoding="utf-8")
        fetcher = subprocess.Popen(["str2str", "-in", f"ntrip://127.0.0.1:{caster}/base", "-out", f"tcpsvr://:{relay}"],
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(fetcher.wait, 20)
        self.addCleanup(fetcher.terminate)
        peer = Rtkrcv(options)
        self.addCleanup(peer.stop)
        fixed = self.first_fixed(solution)
        metres = 111194.93
        self.assertAlmostEqual((float(fixed[2]) - LATITUDE) * metres, 0, delta=0.1)
        self.assertAlmostEqual((float(fixed[3]) - LONGITUDE) * metres * 0.688, 0, delta=0.1)

    def emulator(self, name, text):
        emulator = Emulator(self.scenario(name, text))
        self.addCleanup(emulator.__exit__)
        return emulator

    def first_fixed(self, solution, patience=90):
        end = time.monotonic() + patience
        while time.monotonic() < end:
            lines = solution.read_text(encoding="ascii").splitlines() if solution.exists() else []
            for cells in (line.split() for line in lines if line[:1].isdigit()):
                if len(cells) > 6 and cells[5] == "1":
                    return cells
            time.sleep(0.5)
        raise AssertionError(f"no fixed solution within {patience} s; the last lines: {lines[-3:]}")


if __name__ == "__main__":
    for program in ("rtkrcv", "str2str"):
        if not shutil.which(program):
            skip(f"{program} is not installed")
    unittest.main(verbosity=2)
