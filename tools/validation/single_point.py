"""Single-point positions of a RINEX file by RTKLIB: L1, Klobuchar, Saastamoinen."""

import gzip
import pathlib
import subprocess

from . import records

SYSTEMS = {"G": 1, "R": 4, "E": 8, "J": 16, "C": 32}
SETTINGS = ["pos1-posmode=single", "pos1-frequency=l1", "pos1-ionoopt=brdc", "pos1-tropopt=saas",
            "out-solformat=llh", "out-timesys=gpst", "out-timeform=hms"]


def plain(path, folder):
    """The file itself, or what is in the packed one: RTKLIB reads no .gz."""
    if path.suffix != ".gz":
        return path
    out = folder / path.stem
    out.write_bytes(gzip.decompress(path.read_bytes()))
    return out


def settings(systems, mask):
    """The lines of a configuration file; systems as in RINEX, mask in degrees."""
    return SETTINGS + [f"pos1-elmask={mask}", f"pos1-navsys={sum(SYSTEMS[system] for system in systems)}"]


def solve(observations, navigation, lines, folder):
    """({second: place}, {second: satellites})."""
    folder = pathlib.Path(folder)
    configuration, out = folder / "single.conf", folder / "single.pos"
    configuration.write_text("\n".join(lines) + "\n", encoding="ascii")
    files = [plain(pathlib.Path(path), folder) for path in (observations, *navigation)]
    subprocess.run(["rnx2rtkp", "-k", configuration, "-o", out, *files], check=True, capture_output=True)
    return records.solved(out)


def convert(ubx, folder):
    """RINEX observations of a UBX log by convbin."""
    folder = pathlib.Path(folder)
    out = folder / "converted.obs"
    subprocess.run(["convbin", "-r", "ubx", "-v", "3.04", "-od", "-os", "-o", out, "-n", folder / "converted.nav",
                    plain(pathlib.Path(ubx), folder)], check=True, capture_output=True)
    return out
