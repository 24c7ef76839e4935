"""The scenarios that stand for the records, and what a run of one leaves."""

import dataclasses
import functools
import pathlib
import subprocess
import tempfile
import tomllib

from . import records, single_point

SCENARIOS = pathlib.Path(__file__).resolve().parents[1] / "scenarios"


@dataclasses.dataclass(frozen=True)
class Setup:
    """A scenario, the navigation files that it is given (below the folder of the data), and the way of a vehicle."""

    scenario: str
    navigation: tuple = ()
    rebase: bool = False
    systems: str = "G"
    way: object = None  # a function of the data's folder and the file that it writes a track into

    def table(self):
        return tomllib.loads((SCENARIOS / self.scenario).read_text(encoding="utf-8"))

    def files(self, data):
        return [data / path for path in self.navigation]


class Evidence:
    """A stream of messages and a RINEX file, real or simulated, read when first asked for."""

    def __init__(self, program, stream=None, observations=None, navigation=(), setup=None, data=None):
        self.program, self.stream, self.navigation = program, stream, list(navigation)
        self.setup, self.data, self._observations = setup, data, observations
        self.folder, self.log = None, None

    @functools.cached_property
    def scratch(self):
        self._scratch = tempfile.TemporaryDirectory()
        return pathlib.Path(self._scratch.name)

    @functools.cached_property
    def _messages(self):
        return list(records.messages(self.program, self.stream))

    @functools.cached_property
    def ubx(self):
        return records.from_ubx(self._messages)

    @functools.cached_property
    def nmea(self):
        return records.from_nmea(self._messages)

    @functools.cached_property
    def fixes(self):
        return records.from_fixes(self.folder / "fixes.csv")

    @functools.cached_property
    def observations(self):
        """A file; a function of a folder, where it is made first."""
        return self._observations(self.scratch) if callable(self._observations) else self._observations

    @functools.cached_property
    def rinex(self):
        return records.Rinex(self.observations, "G")

    @functools.cached_property
    def strengths(self):
        """{second: {satellite: (elevation, C/N0)}} of the first band of all systems."""
        return {second: {name: (self.elevations(name, second), strength) for name, strength in epoch.items()
                         if self.elevations(name, second) is not None}
                for second, epoch in records.Rinex(self.observations, self.setup.systems).strengths.items()}

    def single_from(self, mask, *more):
        """Single points above an elevation in degrees, by more settings: ({second: place}, {second: satellites})."""
        settings = single_point.settings(self.setup.systems, mask) + list(more)
        return single_point.solve(self.observations, self.navigation, settings, self.scratch)

    @functools.cached_property
    def elevations(self):
        return elevations(self.program, self.setup, self.data)


@functools.lru_cache(maxsize=None)
def elevations(program, setup, data):
    table = setup.table()
    start = table["run"]["start"].strftime("%Y-%m-%dT%H:%M:%SZ")
    return records.Elevations(program, table["trajectory"]["at"], start, table["run"]["duration_s"], setup.files(data))


def run(program, data, setup, seed, folder):
    """Simulates into the folder; gives the evidence."""
    command = [program, "simulate", SCENARIOS / setup.scenario, "--out", folder, "--seed", str(seed), "--quiet"]
    for path in setup.files(data):
        command += ["--nav", path]
    if setup.rebase:
        command.append("--rebase-nav")
    with tempfile.TemporaryDirectory() as scratch:
        if setup.way:
            track = pathlib.Path(scratch) / "way.csv"
            setup.way(data, track)
            command += ["--trajectory", track]
        done = subprocess.run(command, check=False, capture_output=True, encoding="utf-8")
    if done.returncode:
        raise RuntimeError(f"{setup.scenario}: {done.stderr.strip()}")
    # As the record is solved: with all that was sent that day, not with what the run used of it.
    navigation = [folder / "navigation.rnx"] if setup.rebase else setup.files(data)
    evidence = Evidence(program, folder / "port0.out", folder / "observations.rnx", navigation, setup, data)
    evidence.folder = folder
    return evidence
