#!/usr/bin/env python3
"""check_format.py [--fix] [ROOT]: holds every C++ file against .clang-format; with --fix, lays it out so.

Leaves with 77 (skipped) where clang-format 14, the version of Debian 12, is not installed: others lay out differently.
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import source_tree

VERSION = "14"
SKIPPED = 77
FOLDERS = ["include", "src", "firmware-host", "boards", "tests", "tools"]


def clang_format():
    """The program of the right version, or None."""
    for name in (f"clang-format-{VERSION}", "clang-format"):
        program = shutil.which(name)
        if program:
            told = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
            if re.search(rf"version {VERSION}\.", told):
                return program
    return None


def main(arguments):
    fix = "--fix" in arguments
    places = [a for a in arguments[1:] if a != "--fix"]
    root = Path(places[0] if places else Path(__file__).parent.parent).resolve()
    program = clang_format()
    if program is None:
        print(f"skipped: no clang-format {VERSION} (apt-get install clang-format-{VERSION})")
        return SKIPPED
    paths = [str(path) for path in source_tree.cpp_files(root, FOLDERS)]
    if not paths:
        print(f"{root}: no sources to check")
        return 1
    mode = ["-i"] if fix else ["--dry-run", "-Werror", "-ferror-limit=1"]
    result = subprocess.run([program, "--style=file", *mode, *paths], capture_output=True, text=True, check=False)
    wrong = sorted(set(re.findall(r"^(\S+?):\d+:\d+: error", result.stderr, re.MULTILINE)))
    for path in wrong:
        print(f"{Path(path).relative_to(root)}: not laid out as .clang-format says (tools/check_format.py --fix)")
    if result.returncode != 0 and not wrong:
        print(result.stderr)
    print(f"check_format: {len(paths)} files, {len(wrong)} violations")
    return 1 if result.returncode else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
