"""Logs of Android's GnssLogger: fixes, and the raw measurements of GPS as RINEX."""

import datetime

from . import records

SPEED_OF_LIGHT = 299792458.0
WAVELENGTH = SPEED_OF_LIGHT / 1575.42e6
WEEK_NS = 604800 * 10**9
GPS = 1
CODE_LOCK, TIME_DECODED = 1, 8          # of State: the pseudorange is whole
VALID, RESET, SLIP = 1, 2, 4            # of AccumulatedDeltaRangeState
WORST_TIME_NS = 500                     # of the satellite's time: what lies above is no measurement


class Log:
    """`fixes`: (accuracy m, speed m/s) a second; `epochs`: {second: {satellite: (code, carrier or None, slipped,
    Doppler Hz, C/N0)}}, metres."""

    def __init__(self, path):
        self.fixes, self.epochs, self.times = [], {}, {}
        self.bias = None
        for line in records.text(path).splitlines():
            words = line.split(",")
            if words[0] == "Fix":
                self.fixes.append((float(words[6]), float(words[5])))
            elif words[0] == "Raw" and int(words[28]) == GPS:
                self._measurement(words)

    def _measurement(self, words):
        state, slips = int(words[13]), int(words[19])
        whole = CODE_LOCK | TIME_DECODED
        if self.bias is None:
            self.bias = int(words[5])
        if state & whole != whole or int(words[15]) > WORST_TIME_NS:
            return
        received = int(words[2]) - self.bias          # GPS time, ns; whole numbers, or the metres are lost
        code = ((received - int(words[14])) % WEEK_NS + float(words[12]) - float(words[6])) * 1e-9 * SPEED_OF_LIGHT
        second = round(received / 1e9)
        self.times[second] = received
        self.epochs.setdefault(second, {})[f"G{int(words[11]):02d}"] = (
            code, float(words[20]) if slips & VALID else None, bool(slips & (RESET | SLIP)),
            -float(words[17]) / WAVELENGTH, float(words[16]))

    def write_rinex(self, path):
        lines = ["     3.04           OBSERVATION DATA    G                   RINEX VERSION / TYPE",
                 "G    4 C1C L1C D1C S1C".ljust(60) + "SYS / # / OBS TYPES", " " * 60 + "END OF HEADER"]
        for second, satellites in sorted(self.epochs.items()):
            whole, rest = divmod(self.times[second], 10**9)
            moment = records.GPS_EPOCH + datetime.timedelta(seconds=whole)
            lines.append(f"> {moment:%Y %m %d %H %M} {moment.second + rest * 1e-9:10.7f}  0{len(satellites):3d}")
            for name, (code, carrier, slipped, doppler, strength) in sorted(satellites.items()):
                phase = " " * 14 if carrier is None else f"{carrier / WAVELENGTH:14.3f}"
                lines.append(f"{name}{code:14.3f}  {phase}{'1' if slipped else ' '} {doppler:14.3f}  {strength:14.3f}")
        path.write_text("\n".join(lines) + "\n", encoding="ascii")

    def rinex_in(self, folder):
        path = folder / "log.obs"
        self.write_rinex(path)
        return path
