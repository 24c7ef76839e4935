"""tools/validate: the presets lie within the bands of the real receivers that they stand for."""
import os
import pathlib
import subprocess
import sys

from session import SHARED, skip

TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "validate"

if not (pathlib.Path(SHARED) / "receivers").is_dir():
    skip("no folder of real receivers' records")
result = subprocess.run([sys.executable, TOOL, "--program", os.environ["SKYLOOP"], "--data", SHARED, "--seeds", "5"],
                        check=False)
sys.exit(result.returncode)
