#!/usr/bin/env python3
"""check_format.py [--fix] [ROOT]: holds every C++ file against .clang-format; with --fix, lays it out so.

The tree is laid out by clang-format 14, the version of Debian 12. Another version serves where it agrees with the whole
tree; where it does not, nobody can tell whose fault that is, and this leaves with 77 (skipped), as where there is none.
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import source_tree

VERSION = 14
SKIPPED = 77
FOLDERS = ["include", "src", "firmware-host", "boards", "tests", "tools", "examples"]


def clang_format():
    """The program and its version: of VERSION where that is installed, else of any later one; nothing without."""
    later = None
    for name in (f"clang-format-{VERSION}", "clang-format"):
        program = shutil.which(name)
        if not program:
            continue
        told = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
        version = int(re.search(r"version (\d+)\.", told)[1])
        if version == VERSION:
            return program, version
        if version > VERSION:
            later = later or (program, version)
    return later


def wrong_files(result, root):
    """The files that a run of clang-format calls laid out otherwise."""
    paths = set(re.findall(r"^(\S+?):\d+:\d+: error", result.stderr, re.MULTILINE))
    return sorted(Path(path).relative_to(root) for path in paths)


def main(arguments):
    fix = "--fix" in arguments
    places = [a for a in arguments[1:] if a != "--fix"]
    root = Path(places[0] if places else Path(__file__).parent.parent).resolve()
    found = clang_format()
    if found is None or (fix and found[1] != VERSION):
        print(f"skipped: no clang-format {VERSION} (apt-get install clang-format-{VERSION})")
        return SKIPPED
    program, version = found
    paths = [str(path) for path in source_tree.cpp_files(root, FOLDERS)]
    if not paths:
        print(f"{root}: no sources to check")
        return 1
    mode = ["-i"] if fix else ["--dry-run", "-Werror", "-ferror-limit=1"]
    result = subprocess.run([program, "--style=file", *mode, *paths], capture_output=True, text=True, check=False)
    wrong = wrong_files(result, root)
    if wrong and version != VERSION:
        print(f"skipped: clang-format {version} would lay out {len(wrong)} files otherwise, {wrong[0]} first; "
              f"expected clang-format {VERSION}, by which they are laid out")
        return SKIPPED
    for path in wrong:
        print(f"{path}: not laid out as .clang-format says (tools/check_format.py --fix)")
    if result.returncode != 0 and not wrong:
        print(result.stderr)
    print(f"check_format: {len(paths)} files, {len(wrong)} violations")
    return 1 if result.returncode else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
