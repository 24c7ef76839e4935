"""Runs an incident scenario with a careful and with a naive client: incident_test.py SKYLOOP SCENARIO FOLDER

The scenario's head names its clients. The careful one has to meet all that the scenario expects (exit code 0); the naive
one has to fail (exit code 3), but with the sound receivers of this folder; the same run twice has to give the same bytes.
"""

import hashlib
import pathlib
import re
import subprocess
import sys

MET, NOT_MET = 0, 3


def clients_of(scenario: pathlib.Path) -> tuple[str, str, int]:
    text = scenario.read_text()
    if scenario.parent.name == "incidents" and "[[fault]]" in text and not re.search(r"\w/[\w.-]+#\d+", text):
        sys.exit(f"{scenario.name}: names no public thread (owner/repository#number)")
    found = re.search(r"client:(careful-\w+) passes, client:(naive-\w+) (passes|fails)", " ".join(text.split("\n# ")))
    if not found:
        sys.exit(f"{scenario.name}: its head does not say whether its clients pass or fail")
    return found.group(1), found.group(2), MET if found.group(3) == "passes" else NOT_MET


def run(skyloop: str, scenario: pathlib.Path, folder: pathlib.Path, client: str, expected: int) -> None:
    out = folder / client
    done = subprocess.run([skyloop, "simulate", scenario, "--out", out, "--port", f"client:{client}"],
                          capture_output=True, text=True, timeout=250)
    if done.returncode != expected:
        sys.exit(f"{scenario.name} with client:{client}: exit code {done.returncode}, expected {expected}\n"
                 f"{done.stdout}{done.stderr}")


def digest(folder: pathlib.Path) -> str:
    sums = hashlib.sha256()
    for file in sorted(folder.rglob("port0.*")):
        sums.update(file.name.encode() + file.read_bytes())
    return sums.hexdigest()


def main() -> None:
    skyloop, scenario, folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    careful, naive, of_naive = clients_of(scenario)
    run(skyloop, scenario, folder, careful, MET)
    run(skyloop, scenario, folder, naive, of_naive)
    run(skyloop, scenario, folder / "again", careful, MET)
    if digest(folder / careful) != digest(folder / "again" / careful):
        sys.exit(f"{scenario.name}: two runs gave different bytes")


if __name__ == "__main__":
    main()
