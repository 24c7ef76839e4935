"""The files of the project, and C++ text without what a compiler does not read. Shared by the checks beside it."""

import os
import re
from pathlib import Path

CPP = {".cpp", ".hpp", ".h"}
TEXT = CPP | {".py", ".cmake", ".md", ".toml", ".txt", ".json", ".sh", ".in", ".1", ".csv"}


def files(root, folders=None):
    """All files under the given folders of `root` (all folders by default), sorted; no hidden, built or cached ones."""
    found = []
    for start in ([root] if folders is None else [root / folder for folder in folders]):
        for place, names, leaves in os.walk(start):
            names[:] = sorted(n for n in names if n != "__pycache__" and (n == ".ci" or not n.startswith(".")))
            if Path(place) == root and "build" in names:
                names.remove("build")
            found += [Path(place) / leaf for leaf in sorted(leaves)]
    return found


def cpp_files(root, folders=None):
    return [path for path in files(root, folders) if path.suffix in CPP]


def report(program, arguments, check):
    """Tells what `check(root)`, which gives a count of files and the errors in them, found; gives the exit code."""
    root = Path(arguments[1] if len(arguments) > 1 else Path(__file__).parent.parent).resolve()
    count, errors = check(root)
    for error in errors:
        print(error)
    if count == 0:
        print(f"{root}: no sources to check")
        return 1
    print(f"{program}: {count} files, {len(errors)} violations")
    return 1 if errors else 0


TOKENS = re.compile(
    r'(?P<comment>//[^\n]*|/\*.*?\*/)'
    r'|(?P<raw>R"(?P<mark>[^()\\\s]{0,16})\(.*?\)(?P=mark)")'
    r'|(?P<string>"(?:\\.|[^"\\\n])*")'
    r"|(?P<number>\b\d[\w.']*)"
    r"|(?P<character>'(?:\\.|[^'\\\n])+')",
    re.DOTALL)


def _blank(text):
    return re.sub(r"[^\n]", " ", text)


def without_comments(text):
    """`text` with comments blanked; lines and columns stay where they are."""
    return TOKENS.sub(lambda m: _blank(m.group()) if m.group("comment") else m.group(), text)


def bare_code(text):
    """`text` with comments, strings, characters and preprocessor lines blanked; lines and columns stay."""
    text = TOKENS.sub(lambda m: m.group() if m.group("number") else _blank(m.group()), text)
    return re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", lambda m: _blank(m.group()), text, flags=re.MULTILINE)
