"""A tracker on a battery: it lets its receiver sleep and wakes it.

The steps and waits are those of Meshtastic's driver (a setup saved for after each sleep, RXM-PMREQ of 8 bytes, on M10 of 16, one
byte FF to wake it, half a second before the next command); for on and off they are those of u-blox's integration manuals.
"""
import struct
import time

import ubx
from dialogue import Client

WAIT = 1000
AWAKE = 12.0  # s from waking to a position, of a receiver that starts hot
BACKUP, FORCE, BY_UART = 2, 4, 8
OFF = {"M8": (0xF001, 0xF002, 0xF003, 0xF005), "keys": (0x209100CA, 0x209100C0, 0x209100C5, 0x209100B1)}  # GLL GSA GSV VTG


class Tracker(Client):
    name = "tracker"
    patience = 110.0

    def run(self):
        self.step("MON-VER at the speed of the factory")
        self.speed(self.board.speed)
        self.check(self.version(WAIT) is not None, "MON-VER", None)
        self.quieten()
        self.step("a position")
        self.pump(1.0)  # sentences of the epoch that is on its way
        self.forget()
        self.position(15)
        self.sleep_for(6)
        self.sleep_until_woken()
        self.go_on_and_off()
        self.stay_on()

    # --- what it says ---

    def apply(self, pairs):
        """In RAM and for after a sleep."""
        self.set(ubx.valset(pairs, ubx.RAM | ubx.BBR), "CFG-VALSET", WAIT)

    def save(self):
        devices = 0x17 if self.board.has_flash else 0x01
        self.set(ubx.frame("CFG-CFG", struct.pack("<IIIB", 0, 0xFFFF, 0, devices)), "CFG-CFG", WAIT)

    def quieten(self):
        self.step("fewer sentences, NAV-PVT, saved")
        if self.board.has_keys:
            self.apply([(key, 0) for key in OFF["keys"]] + [(0x20910007, 1)])
            return
        for message in OFF["M8"]:
            self.set(ubx.cfg_msg(message, 0), "CFG-MSG", WAIT)
        self.set(ubx.cfg_msg("NAV-PVT", 1), "CFG-MSG", WAIT)
        self.save()

    def request(self, milliseconds):
        """RXM-PMREQ; nothing answers it."""
        if self.board.generation == 10:
            payload = struct.pack("<B3xIII", 0, milliseconds, BACKUP | FORCE, BY_UART)
        else:
            payload = struct.pack("<II", milliseconds, BACKUP)
        self.forget()
        self.send(ubx.frame(0x0241, payload))

    def wake(self):
        """A byte that is not heard, and half a second."""
        self.send(b"\xff", "FF")
        self.pump(0.5)
        self.forget()

    # --- what it hears ---

    def position(self, seconds):
        """NAV-PVT with a fix within so long; sentences that were switched off have not come back."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            item = self.wait(lambda i: isinstance(i, ubx.Frame) and i.is_a("NAV-PVT") or isinstance(i, ubx.Sentence), 500)
            if isinstance(item, ubx.Sentence):
                self.check(item.fields[0][2:] not in ("GLL", "GSV", "VTG", "GSA"), "the saved setup", item)
            elif item is not None:
                solution = ubx.nav_pvt(item.payload)
                if solution["flags"] & 1:
                    return solution
        self.fail(f"a fix within {seconds} s")
        return None

    def silence(self, seconds, what):
        """The line is quiet for so long, once what was on its way has come."""
        self.pump(1.0)
        self.forget()
        self.pump(seconds)
        self.check(not self.pending, what, self.pending and self.pending[0])

    # --- what it does ---

    def sleep_for(self, seconds):
        self.step(f"asleep for {seconds} s")
        self.request(seconds * 1000)
        asked = time.monotonic()
        self.silence(seconds - 1.5, f"silence for {seconds} s")
        self.step("awake by itself")
        self.position(AWAKE)
        self.check(time.monotonic() - asked >= seconds, f"nothing before {seconds} s were over", None)

    def sleep_until_woken(self):
        self.step("asleep until it is woken")
        self.wake()
        self.request(0)
        self.silence(5, "silence until it is woken")
        self.step("woken by a byte; the poll after it is answered")
        self.wake()
        self.check(self.version(WAIT) is not None, "MON-VER half a second after it was woken", None)
        self.position(AWAKE)

    def go_on_and_off(self):
        """Every ten seconds a fix, and off again: psmState tells how far it is."""
        self.step("on and off every 10 s")
        if self.board.generation == 8:
            self.set(ubx.frame("CFG-PMS", struct.pack("<BBHHH", 0, 2, 10, 1, 0)), "CFG-PMS", WAIT)
            self.save()
        elif self.board.generation == 10 or self.board.name == "ublox-m9":
            self.apply([(0x40D00002, 10), (0x40D00003, 10), (0x30D00005, 1), (0x20D00001, 1)])
        else:
            return
        states, gaps, last = set(), 0, None
        end = time.monotonic() + 27
        while time.monotonic() < end:
            item = self.wait_frame("NAV-PVT", 500)
            if item is None:
                continue
            states.add(ubx.nav_pvt(item.payload)["flags"] >> 2 & 7)
            gaps += last is not None and item.time - last > 3
            last = item.time
        self.check(gaps >= 1, "more than 3 s of silence between two times on", f"{gaps} of them")
        self.check({2, 3} <= states <= {1, 2, 3}, "psmState acquisition and tracking", states)

    def stay_on(self):
        self.step("full power again")
        if self.board.is_f9p:
            return
        self.wake()
        if self.board.generation == 8:
            self.set(ubx.frame("CFG-PMS", bytes(8)), "CFG-PMS", WAIT)
            self.save()
        else:
            self.apply([(0x20D00001, 0)])
        solution = self.position(AWAKE)
        self.pump(3)
        self.forget()
        solution = self.position(3)
        self.check(solution["flags"] >> 2 & 7 == 0, "psmState 0", solution["flags"])
