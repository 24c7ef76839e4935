#!/usr/bin/env python3
"""A campaign by GNU parallel, stopped in the middle and called again: each result is there exactly once, and the database has the
bytes that one machine's has. The hosts are this machine, twice; with SKYLOOP_SSH_HOST that one, by ssh, as well.
"""
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import campaign_rig

RUNS = 60


class ParallelCampaign(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="skyloop-parallel-")
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.scenario = self.root / "it's a \"night\".toml"
        self.scenario.write_text(campaign_rig.SCENARIO)
        self.hosts = self.root / "hosts"
        self.hosts.write_text("".join(f"1/{host}\n" for host in (":", os.environ.get("SKYLOOP_SSH_HOST")) if host)
                              if "SKYLOOP_SSH_HOST" in os.environ else "2/:\n")
        # parallel keeps its own files at home.
        self.environment = {**os.environ, "HOME": str(self.root)}

    def parallel(self, out, *options):
        return campaign_rig.command(self.scenario, out, RUNS, "--engine", "parallel", "--hosts", self.hosts, "--shards", 12,
                                    *options)

    def stop_in_the_middle(self, out):
        """Gives the exit code and how many results there were."""
        with subprocess.Popen(self.parallel(out, "--submit"), env=self.environment, stdin=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True) as process:
            try:
                end = time.monotonic() + 120
                while campaign_rig.count_results(out) < RUNS // 4:
                    self.assertLess(time.monotonic(), end, "a quarter of the results takes too long")
                    self.assertIsNone(process.poll(), "it ended early")
                    time.sleep(0.02)
                os.killpg(process.pid, signal.SIGTERM)  # as a session ends
                code = process.wait(timeout=60)
            finally:
                try:
                    os.killpg(process.pid, signal.SIGKILL)
                except ProcessLookupError:
                    pass
        return code, campaign_rig.count_results(out)

    def test_stopped_and_called_again(self):
        one, many = self.root / "one machine", self.root / "many hosts' work #2 at 100%"
        began = time.monotonic()
        alone = campaign_rig.run(self.scenario, one, RUNS)
        self.assertEqual(alone.returncode, 0, alone.stderr)
        alone_s = time.monotonic() - began
        code, before = self.stop_in_the_middle(many)
        self.assertNotEqual(code, 0)
        self.assertLess(before, RUNS)
        again = subprocess.run(self.parallel(many, "--submit"), env=self.environment, stdin=subprocess.DEVNULL, capture_output=True,
                               text=True, timeout=300, check=False)
        self.assertEqual(again.returncode, 0, again.stderr)
        campaign_rig.expect_same(self, one, many, RUNS)
        # A third call finds nothing to do but gather.
        began = time.monotonic()
        third = subprocess.run(["sh", many / "parallel/campaign.sh"], env=self.environment, stdin=subprocess.DEVNULL,
                               capture_output=True, text=True, timeout=300, check=False)
        self.assertEqual(third.returncode, 0, third.stderr)
        campaign_rig.expect_same(self, one, many, RUNS)
        print(f"{RUNS} runs: {alone_s:.1f} s on one machine; stopped with {before} results, code {code}, and finished; a call with "
              f"nothing to do: {time.monotonic() - began:.1f} s")


if __name__ == "__main__":
    if not shutil.which("parallel"):
        campaign_rig.skip("GNU parallel is absent: apt-get install parallel")
    unittest.main(verbosity=2)
