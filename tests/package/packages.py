"""What the tests of packages share."""
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("SKYLOOP_BUILD", ROOT / "build/dev"))
SKYLOOP = os.environ.get("SKYLOOP", str(BUILD / "bin/skyloop"))
NAMES = ("skyloop", "skyloop-data", "libskyloop0", "libskyloop-dev", "skyloop-doc")


def skip(reason):
    """Ends the whole test program as skipped."""
    print(f"skipped: {reason}")
    sys.exit(77)


def need(*programs):
    """Skips where one of them is not installed."""
    for program in programs:
        if shutil.which(program) is None:
            skip(f"{program} is not installed")


def run(*words, check=True, **more):
    """Runs a program to its end; gives what it printed, as text."""
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=more.pop("timeout", 600),
                          stdin=subprocess.DEVNULL, **more)
    if check and done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, words))} ended {done.returncode}:\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
    return done


def made_packages():
    """The packages that tools/package made, by name."""
    folder = pathlib.Path(os.environ.get("SKYLOOP_PACKAGES", ROOT / "build/packages"))
    found = {name: sorted(folder.glob(f"{name}_*.deb")) for name in NAMES}
    if any(len(files) != 1 for files in found.values()):
        skip(f"no packages in {folder}; tools/package makes them")
    return {name: files[0] for name, files in found.items()}


def version():
    """The version, from its one place."""
    import re
    return re.search(r"^project\(skyloop VERSION (\d+\.\d+\.\d+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)[1]
