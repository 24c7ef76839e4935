"""Three incidents live against gpsd, with the verdict by what gpsd tells its clients: gpspipe as the probe of [[expect]].

Each incident runs as its scenario tells it, but for its times and its expectations. The run ends with exit code 0 when gpsd
shows what the incident makes of it, and with 3 when it is expected to show something else.
"""
import concurrent.futures
import json
import pathlib
import re
import shutil
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/integration"))

from gpsd_process import Gpsd, free_port  # noqa: E402
from session import Emulator, open_folder, skip  # noqa: E402

MET, NOT_MET = 0, 3
BEFORE_S, BEGINS_S, DURING_S, LASTS_S, AFTER_S, ENDS_S = 5, 12, 15, 9, 22, 30  # probes, the fault, the end of the run
SPEED = 1.5

FIX = "tpv.mode == 3"
# Incident, then what gpsd shows before, during and after it, and what it does not show during it. A condition of one line,
# or None: no TPV comes for two seconds.
INCIDENTS = {
    # gpsd believes the fix at 0, 0.
    "zero_position_with_fix": ("tpv.lat > 47", "tpv.lat == 0", "tpv.lat > 47", "tpv.lat > 47"),
    "intermittent_outages": (FIX, "tpv.mode == 1", FIX, FIX),
    "silent_in_flight": (FIX, None, FIX, FIX),
}


def expectation(name, at_s, port, condition):
    """An [[expect]] that asks the gpsd at a port of the loopback address, again for 4 s until it is fulfilled."""
    pipe = f"timeout 2 gpspipe -w -n 40 127.0.0.1:{port}"
    probe = f'command = ["sh", "-c", "{pipe}"]\njson = "{condition}"' if condition else \
        f'command = ["sh", "-c", "! {pipe} | grep -q TPV"]'
    return f'[[expect]]\nname = "{name}"\n{probe}\nat_s = {at_s}\nwithin_s = 4\ntimeout_s = 4\n'


def live_variant(incident, expectations):
    """The text of an incident with its fault in the tenth second, once, and other expectations."""
    text = (ROOT / "tools/scenarios/incidents" / f"{incident}.toml").read_text()
    head, fault = re.split(r"^\[\[fault\]\]\n", text, flags=re.MULTILINE)
    fault = fault.split("[[expect]]")[0]
    fault = re.sub(r"^(every_s|times) = .*\n", "", fault, flags=re.MULTILINE)
    fault, times = re.subn(r"^at_s = .*", f"at_s = {BEGINS_S}", fault, flags=re.MULTILINE)
    fault, lengths = re.subn(r"^for_s = .*", f"for_s = {LASTS_S}", fault, flags=re.MULTILINE)
    head, durations = re.subn(r"^duration_s = .*", f"duration_s = {ENDS_S}", head, flags=re.MULTILINE)
    assert (times, lengths, durations) == (1, 1, 1), incident
    return f"{head}[[fault]]\n{fault}\n" + "\n".join(expectations)


def run_beside_gpsd(incident, conditions):
    """The exit code of the incident with what is expected before, during and after it, and all that was said."""
    port = free_port()
    times = zip(("before", "during", "after"), (BEFORE_S, DURING_S, AFTER_S), conditions)
    text = live_variant(incident, [expectation(name, at_s, port, condition) for name, at_s, condition in times])
    with open_folder() as folder:
        scenario = pathlib.Path(folder, f"{incident}.toml")
        scenario.write_text(text)
        with Emulator(scenario, "--port", f"pty:{folder}/gps0", "--record", f"{folder}/out", "--speed", SPEED) as emulator:
            gpsd = Gpsd(emulator.tty, "-b", port=port)
            try:
                code = emulator.finish(60)
            finally:
                log = gpsd.stop()
        verdicts = pathlib.Path(folder, "out/verdicts.json").read_text()
    return code, f"{emulator.log}\ngpsd: {log}\n{verdicts}"


class LiveGpsdTest(unittest.TestCase):
    def test_verdicts_by_what_gpsd_shows(self):
        with concurrent.futures.ThreadPoolExecutor(2 * len(INCIDENTS)) as together:
            runs = {}
            for incident, (before, during, after, never) in INCIDENTS.items():
                runs[incident, MET] = together.submit(run_beside_gpsd, incident, (before, during, after))
                runs[incident, NOT_MET] = together.submit(run_beside_gpsd, incident, (before, never, after))
        for (incident, expected), run in runs.items():
            with self.subTest(incident=incident, expected=expected):
                code, said = run.result()
                self.assertEqual(code, expected, said)
                outcomes = [verdict["outcome"] for verdict in json.loads(said[said.rindex("\n{"):])["verdicts"]]
                self.assertEqual(outcomes, ["passed", "passed" if expected == MET else "failed", "passed"], said)


if __name__ == "__main__":
    for program in ("gpsd", "gpspipe"):
        if not shutil.which(program):
            skip(f"{program} is not installed; apt-get install gpsd gpsd-clients")
    unittest.main(verbosity=2)
