"""tools/validate --behaviour: what boards did as real ones do they still do."""
import os
import pathlib
import subprocess
import sys

from session import SHARED, skip

TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "validate"
NEEDED = ("receivers/bend_f9t", "receivers/galway_20181004_m8p_riverside",
          "nav/BRDC00IGS_R_20240010000_01D_MN.rnx.gz")

for name in NEEDED:
    if not (pathlib.Path(SHARED) / name).exists():
        skip(f"no {name}")
result = subprocess.run([sys.executable, TOOL, "--program", os.environ["SKYLOOP"], "--data", SHARED, "--behaviour",
                         "--short"], check=False)
sys.exit(result.returncode)
