"""Failsafes on numSV, HDOP, C/N0 and hAcc without a scripted fault: they fire in a canyon and in a forest, and never in the open.

`skyloop campaign tools/scenarios/failsafes/…` does it with twenty seeds; here are three of them.
"""
import pathlib
import unittest

from session import ROOT, open_folder, skyloop

DRIVES = ROOT / "tools/scenarios/failsafes"
SEEDS = (1, 7, 20)


class FailsafeDrivesTest(unittest.TestCase):
    def test_each_drive_meets_its_expectations(self):
        for drive in sorted(DRIVES.glob("*.toml")):
            for seed in SEEDS:
                with self.subTest(drive.name, seed=seed), open_folder() as folder:
                    run = skyloop("simulate", drive, "--seed", seed, "--out", pathlib.Path(folder, "run"))
                    self.assertIn("4 of 4 expectations met", run.stdout)


if __name__ == "__main__":
    unittest.main()
