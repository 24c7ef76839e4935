"""The receivers that the dialogues meet, and a running emulator of one of them."""
import dataclasses
import math
import pathlib
import sys
import time

import wire

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "integration"))
from session import SHARED, SKIPPED, Emulator, open_folder, skip, skyloop  # noqa: E402,F401  (for those who import us)

PLACE = (47.397742, 8.545594, 488.0)
START = "2026-03-01T00:00:00Z"
START_DATE = (2026, 3, 1)


@dataclasses.dataclass(frozen=True)
class Board:
    """What a client may know of a board beforehand: only what decides how it is talked to."""
    name: str
    speed: int  # as it leaves the factory
    generation: int = 0  # u-blox; 0: no u-blox
    protocol: tuple = ()

    @property
    def has_keys(self):
        return self.protocol > (23, 1)

    @property
    def has_flash(self):
        """M10 is the bare chip, with its firmware in ROM."""
        return self.generation != 10 or self.name == "ublox-f10"

    @property
    def is_f9p(self):
        return self.name.startswith("ublox-f9p")


BOARDS = {board.name: board for board in (
    Board("ublox-m8", 9600, 8, (18, 0)),
    Board("ublox-m9", 38400, 9, (32, 1)),
    Board("ublox-m10", 38400, 10, (34, 10)),
    Board("ublox-f10", 38400, 10, (40, 0)),
    Board("ublox-f9p", 38400, 9, (27, 31)),
    Board("ublox-m8p", 9600, 8, (20, 30)),
    Board("ublox-m9-spg450", 38400, 9, (32, 50)),
    Board("ublox-max-m10s", 9600, 10, (34, 10)),
    Board("ublox-m10-spg530", 38400, 10, (34, 30)),
    Board("ublox-f9p-hpg113", 38400, 9, (27, 12)),
    Board("ublox-f9p-hpg150", 38400, 9, (27, 50)),
    Board("ublox-f9p-15b", 38400, 9, (27, 40)),
    Board("ublox-x20p", 38400, 20, (50, 2)),
    Board("nmea-generic", 9600),
    Board("mtk3339", 9600),
    Board("airoha-ag33xx", 115200),
    Board("ublox-6", 9600, 6),
    Board("septentrio-sbf", 115200),
    Board("unicore-um980", 115200),
    Board("unicore-um982", 115200),
    Board("unicore-uc6580", 115200),
    Board("airoha-ag3335", 115200),
    Board("casic-at6558", 9600),
    Board("quectel-l76k", 9600),
    Board("quectel-lg290p", 460800),
)}


def start(board, folder, *arguments, duration=170, moving=False, port=""):
    """`skyloop run` of a board on a pty in `folder`, at rest at PLACE unless a scenario among the arguments moves it.

    `port` is the board's port that the pty is laid to, "uart3"; without one the first UART."""
    place = () if moving else ("--at", ",".join(map(str, PLACE)))
    return Emulator("--board", board.name, *place, "--start", START, "--duration", duration, "--port",
                    f"{port + '=' if port else ''}pty:{folder}/gps0", *arguments)


def wait_for_sentences(board, tty):
    """Until the receiver has started: a client at its first speed has heard GGA."""
    line = wire.Wire(tty, board.speed)
    heard, end = b"", time.monotonic() + 15
    while b"GGA," not in heard:
        if time.monotonic() > end:
            raise AssertionError(f"{board.name}: no GGA at {board.speed} baud within 15 s; came {heard[-200:]}")
        heard += line.read(0.2)[0]
    line.close()


def metres_apart(latitude, longitude, place=PLACE):
    """Horizontal distance from a place."""
    north = (latitude - place[0]) * 111_200
    east = (longitude - place[1]) * 111_320 * math.cos(math.radians(place[0]))
    return math.hypot(north, east)
