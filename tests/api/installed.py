"""An installation of the library for tests, and other programs built against it."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("SKYLOOP_BUILD", ROOT / "build/dev"))
EXAMPLES = ROOT / "examples"
SKIPPED = 77


def need(*programs):
    """Ends the whole test as skipped where one of them is not installed."""
    for program in programs:
        if shutil.which(program) is None:
            print(f"skipped: {program} is not installed")
            sys.exit(SKIPPED)


def run(*words, folder=None, env=None, code=0):
    """Runs a program to its end; gives what it printed. `code` is the exit code that is expected."""
    done = subprocess.run([str(word) for word in words], cwd=folder, env={**os.environ, **(env or {})},
                          capture_output=True, timeout=170)
    if done.returncode != code:
        raise AssertionError(f"{' '.join(map(str, words))} ended {done.returncode}:\n{done.stdout.decode(errors='replace')}"
                             f"\n{done.stderr.decode(errors='replace')}")
    return done


class Installation:
    """What `cmake --install` gives, in a folder of its own that was moved after the installation."""

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory(prefix="skyloop-installed-")
        first = pathlib.Path(self.folder.name) / "first"
        for component in ("library", "development", "data"):
            run("cmake", "--install", BUILD, "--prefix", first, "--component", component)
        self.prefix = pathlib.Path(self.folder.name) / "moved here"
        first.rename(self.prefix)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.folder.cleanup()

    def one(self, pattern):
        """The only file of the installation that fits."""
        found = sorted(self.prefix.glob(pattern))
        if len(found) != 1:
            raise AssertionError(f"{pattern}: {found}; expected one file")
        return found[0]

    @property
    def library(self):
        return self.one("lib*/**/libskyloop.so.0")

    def environment(self):
        """For pkg-config, and programs that find the library without help."""
        return {"SKYLOOP_DATA_DIR": "",
                "PKG_CONFIG_PATH": str(self.one("lib*/**/skyloop.pc").parent)}
