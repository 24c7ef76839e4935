"""tools/validate: what lay within the bands of real receivers still does."""
import os
import pathlib
import shutil
import subprocess
import sys

from session import SHARED, skip

TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "validate"

if not (pathlib.Path(SHARED) / "receivers").is_dir():
    skip("no folder of real receivers' records")
if not all(shutil.which(tool) for tool in ("rnx2rtkp", "convbin")):
    skip("no rnx2rtkp and convbin")
result = subprocess.run([sys.executable, TOOL, "--program", os.environ["SKYLOOP"], "--data", SHARED, "--short"],
                        check=False)
sys.exit(result.returncode)
