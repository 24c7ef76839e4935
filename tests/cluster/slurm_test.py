#!/usr/bin/env python3
"""A campaign on a Slurm with two nodes, of which one dies in the middle: each result is there exactly once, and the database has
the bytes that one machine's has.

SKYLOOP_CLUSTER_RUNS: how many runs, 200 unless told otherwise. Skipped where Slurm is absent, or without root.
"""
import os
import pathlib
import subprocess
import tempfile
import threading
import time
import unittest

import campaign_rig
import slurm_cluster

RUNS = int(os.environ.get("SKYLOOP_CLUSTER_RUNS", "200"))
LONG = 200  # runs that last some seconds


class Said:
    """What a program says, taken as it comes, so that a full pipe never holds it up."""

    def __init__(self, process):
        self.text = ""
        self.thread = threading.Thread(target=self.listen, args=(process.stderr,), daemon=True)
        self.thread.start()

    def listen(self, stream):
        for line in stream:
            self.text += line


class SlurmCampaign(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="skyloop-cluster-")
        self.addCleanup(self.folder.cleanup)
        os.chmod(self.folder.name, 0o755)
        self.root = pathlib.Path(self.folder.name)
        self.scenario = self.root / "it's a \"night\".toml"
        self.scenario.write_text(campaign_rig.SCENARIO)

    def cluster(self):
        home = self.root / "slurm"
        home.mkdir()
        return slurm_cluster.Cluster(home)

    def lose_a_node(self, cluster, process, out, said):
        """In the middle of the campaign, when the node is at work; gives how many results there were."""
        end = time.monotonic() + 300
        while campaign_rig.count_results(out) < RUNS // 4:
            self.assertLess(time.monotonic(), end, f"a quarter of the results takes too long; {said.text}{cluster.logs()}")
            self.assertIsNone(process.poll(), f"it ended early: {said.text}")
            time.sleep(0.02)
        while not self.works(cluster, "n1"):
            self.assertLess(time.monotonic(), end, f"n1 does nothing; {said.text}")
            time.sleep(0.02)
        cluster.kill_node("n1")
        return campaign_rig.count_results(out)

    @staticmethod
    def works(cluster, name):
        inside = slurm_cluster.processes_below([cluster.daemons[name].pid])
        for number in inside:
            try:
                if b"--shard" in pathlib.Path(f"/proc/{number}/cmdline").read_bytes():
                    return True
            except OSError:
                pass
        return False

    def test_a_lost_node_costs_no_result(self):
        one, two = self.root / "one machine", self.root / "two nodes' work #2 at 100%"
        began = time.monotonic()
        alone = campaign_rig.run(self.scenario, one, RUNS)
        self.assertEqual(alone.returncode, 0, alone.stderr)
        alone_s = time.monotonic() - began
        with self.cluster() as cluster:
            began = time.monotonic()
            with subprocess.Popen(
                    campaign_rig.command(self.scenario, two, RUNS, "--engine", "slurm", "--shards", max(2, RUNS // 10),
                                         "--submit", "--follow"),
                    env=cluster.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                    text=True) as process:
                said = Said(process)
                try:
                    before = self.lose_a_node(cluster, process, two, said)
                    lost_at_s = time.monotonic() - began
                    code = process.wait(timeout=600)
                finally:
                    process.kill()
                said.thread.join(timeout=10)
            cluster_s = time.monotonic() - began
            states = cluster.states()
            self.assertEqual(code, 0, said.text + cluster.logs())
        self.assertTrue(states["n1"].startswith("down"), states)
        self.assertLess(before, RUNS)
        campaign_rig.expect_same(self, one, two, RUNS)
        starts = [path.read_text().count(", start ") for path in (two / "slurm/log").glob("[0-9]*.txt")]
        self.assertGreater(max(starts), 1, "no shard was started again")
        print(f"{RUNS} runs: {alone_s:.1f} s on one machine; {cluster_s:.1f} s on two nodes, of which one was lost after "
              f"{lost_at_s:.1f} s and {before} results; {sum(starts)} starts of {len(starts)} shards")

    def test_a_bad_campaign_is_told_and_not_tried_again(self):
        self.scenario.write_text(campaign_rig.SCENARIO)
        out = self.root / "bad"
        with self.cluster() as cluster:
            written = campaign_rig.run(self.scenario, out, 4, "--engine", "slurm", "--shards", 2, "--dry-run",
                                       environment=cluster.environment)
            self.assertEqual(written.returncode, 0, written.stderr)
            self.assertEqual(cluster.jobs(), {})
            # What was good when it was planned need not be so when it is run.
            self.scenario.write_text("[run]\nduration_s = -1\n")
            subprocess.run(["sbatch", out / "slurm/campaign.sbatch"], env=cluster.environment, check=True,
                           stdout=subprocess.DEVNULL)
            cluster.wait_for(lambda: set(cluster.jobs().values()) == {"FAILED"}, "failed tasks", patience=60)
        for shard in (0, 1):
            self.assertEqual((out / f"slurm/exit/{shard}").read_text(), "2\n")
            log = (out / f"slurm/log/{shard}.txt").read_text()
            self.assertIn("duration_s", log)
            self.assertEqual(log.count(", start "), 1, log)

    def test_a_shard_whose_time_is_over_goes_on_in_another_job(self):
        out = self.root / "in two goes"
        with self.cluster() as cluster:
            submitted = campaign_rig.run(self.scenario, out, LONG, "--engine", "slurm", "--shards", 2, "--submit",
                                         environment=cluster.environment)
            self.assertEqual(submitted.returncode, 0, submitted.stderr)
            cluster.wait_for(lambda: all(campaign_rig.count_results(out, shard) > 2 for shard in (0, 1)), "results")
            # Twice the same campaign at the same time is refused.
            twice = campaign_rig.run(self.scenario, out, LONG, "--engine", "slurm", "--shards", 2, "--submit",
                                     environment=cluster.environment)
            self.assertEqual(twice.returncode, 1, twice.stderr)
            self.assertIn("still in the queue", twice.stderr)
            # What Slurm says to a batch script whose time is nearly over.
            job = (out / "slurm/jobs").read_text().split()[0]
            subprocess.run(["scancel", "--batch", "--signal=USR1", f"{job}_0", f"{job}_1"], env=cluster.environment, check=True)
            self.assertLess(campaign_rig.count_results(out), LONG, "it ended before it could be asked to")
            followed = campaign_rig.run(self.scenario, out, LONG, "--engine", "slurm", "--shards", 2, "--follow",
                                        environment=cluster.environment)
            self.assertEqual(followed.returncode, 0, followed.stderr + cluster.logs())
        found = campaign_rig.results(out)
        self.assertEqual((len(found), {len(rows) for rows in found.values()}), (LONG, {1}))
        for shard in (0, 1):
            log = (out / f"slurm/log/{shard}.txt").read_text()
            # The shard's last line may get lost in the end of its job; srun's is of the step, which ended before.
            self.assertRegex(log, "ended with code 75: back into the queue|Exited with exit code 75")
            self.assertIn(", start 2", log)
        self.assertTrue((out / "campaign.sqlite").exists())


if __name__ == "__main__":
    REASON = slurm_cluster.missing()
    if REASON:
        campaign_rig.skip(REASON)
    unittest.main(verbosity=2)
