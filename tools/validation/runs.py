"""Runs of the behaviours' scenarios, and what each receiver of one told on its wire."""

import contextlib
import csv
import dataclasses
import pathlib
import subprocess
import tempfile
import tomllib

from . import records
from .simulation import SCENARIOS

NAVIGATION = "nav/BRDC00IGS_R_20240010000_01D_MN.rnx.gz"
WEEK_S = 604800
FIXED, DIFFERENTIAL = 1, 2  # of flags of NAV-PVT


@dataclasses.dataclass(frozen=True)
class Bench:
    program: pathlib.Path
    data: pathlib.Path


@dataclasses.dataclass(slots=True)
class Told:
    """A NAV-PVT: seconds since the start of the run by its iTOW; place, velocity east, north, up; accuracies."""

    time: float
    fixed: bool
    differential: bool
    sats: int
    place: tuple
    velocity: tuple
    h_acc: float
    v_acc: float
    s_acc: float


class Outcome:
    """A run's folder; receivers by their place in the scenario."""

    def __init__(self, bench, folder, scenario, start):
        self.bench, self.folder, self.scenario = bench, folder, scenario
        self.start_s = records.gps_from_iso(start) % WEEK_S

    def _folder(self, receiver):
        return self.folder / f"receiver{receiver}" if receiver else self.folder

    def messages(self, receiver):
        return records.messages(self.bench.program, self._folder(receiver) / "port0.out")

    def told(self, receiver):
        return [self._told(fields) for name, fields in self.messages(receiver) if name == "NAV-PVT"]

    def _told(self, f):
        return Told(round(f["tow_s"] - self.start_s, 3), f["fix_type"] in (2, 3) and bool(f["flags"] & FIXED),
                    bool(f["flags"] & DIFFERENTIAL), f["satellites"], (f["lat_deg"], f["lon_deg"], f["height_m"]),
                    (f["vel_east_mps"], f["vel_north_mps"], -f["vel_down_mps"]),
                    f["h_acc_m"], f["v_acc_m"], f["speed_acc_mps"])

    def table(self, name, receiver=0):
        """The rows of fixes.csv or satellites.csv."""
        with open(self._folder(receiver) / name, encoding="ascii") as file:
            return list(csv.DictReader(file))

    def truth(self, receiver):
        """(seconds since the start, latitude, longitude, height) of each epoch."""
        return [(float(row["tow_s"]) - self.start_s, float(row["true_lat_deg"]), float(row["true_lon_deg"]),
                 float(row["true_height_m"])) for row in self.table("fixes.csv", receiver)]


@contextlib.contextmanager
def run(bench, scenario, seed, changes=(), navigation=(NAVIGATION,)):
    """Simulates a scenario with changed keys, (key, value) each; the folder lives as long as the context."""
    path = SCENARIOS / "validation" / f"{scenario}.toml"
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    start = dict(changes).get("run.start") or table["run"]["start"].strftime("%Y-%m-%dT%H:%M:%SZ")
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        command = [bench.program, "simulate", path, "--out", folder, "--seed", str(seed), "--quiet"]
        for key, value in changes:
            command += ["--set", f"{key}={value}"]
        for name in navigation:
            command += ["--nav", bench.data / name]
        done = subprocess.run(command, check=False, capture_output=True, encoding="utf-8")
        if done.returncode:
            raise RuntimeError(f"{scenario}: {done.stderr.strip()}")
        yield Outcome(bench, folder, table, start)
