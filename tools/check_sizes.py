#!/usr/bin/env python3
"""check_sizes.py [ROOT]: holds the size and word rules of CONTRIBUTING.md.

Files have at most 400 lines, tests and tables of numbers 600; functions at most 40 lines between their braces, tests
80; parameter lists at most 5. No unfinished marks, no file whose name says nothing. Functions are found by their braces,
not by a compiler: good enough for code that clang-format has laid out.
"""

import re
import sys
from pathlib import Path

import source_tree

FOLDERS = ["include", "src", "firmware-host", "boards", "tests", "tools", "examples", ".ci"]
FILE_LINES, LONG_FILE_LINES = 400, 600
FUNCTION_LINES, TEST_FUNCTION_LINES = 40, 80
PARAMETERS = 5
SIX_NUMBERS = {"gps_calendar_time"}  # a calendar and a clock are six numbers
SOURCES = source_tree.CPP | {".py", ".cmake", ".txt", ".sh", ""}
TABLE = re.compile(r"_tables?\.(cpp|hpp)$")
# Written apart, so that this file does not find itself.
MARKS = re.compile(r"\b(?:TO" r"DO|FIX" r"ME|HA" r"CK)\b")
EMPTY_NAMES = re.compile(r"(?:^|_)(?:utils?|utility|utilities|helpers?|common|misc|managers?)(?:_|\.|$)", re.IGNORECASE)
CONTROL = {"if", "for", "while", "switch", "catch", "do", "else", "try", "return"}


def top_level(text):
    """`text` with everything inside brackets of any kind blanked."""
    depth, out = 0, []
    for index, char in enumerate(text):
        closing = char in ")]}" or (char == ">" and depth and text[index - 1] not in "-=")
        if closing and depth:
            depth -= 1
        out.append(char if depth == 0 else " ")
        if char in "([{" or (char == "<" and re.search(r"\w\s*$", text[:index]) and text[index + 1:index + 2] not in "=<"):
            depth += 1
    return "".join(out)


def parameter_list(header):
    """The name before the first parenthesis at the top of a declaration, and the text inside it, or None."""
    flat = top_level(re.sub(r"\[\[.*?\]\]", lambda m: " " * len(m.group()), header))
    match = re.search(r"([\w~]+|operator\s*\S+)\s*\(", flat)
    if not match or match[1] in CONTROL:
        return None
    depth = 0
    for index in range(match.end() - 1, len(header)):
        depth += {"(": 1, ")": -1}.get(header[index], 0)
        if depth == 0:
            return match[1], header[match.end():index]
    return None


def parameter_count(parameters):
    if parameters.strip() in ("", "void"):
        return 0
    return top_level(parameters).count(",") + 1


class Function:
    def __init__(self, name, line, parameters):
        self.name, self.line, self.parameters = name, line, parameters
        self.lines = None  # None: only declared


def kind_of_brace(header):
    """What an opening brace after `header` begins, outside of functions."""
    flat = top_level(header).strip()
    if re.search(r"\bnamespace\b", flat) or re.match(r'extern\s*$', flat):
        return "scope"
    if flat.endswith("="):
        return "value"
    if re.search(r"\)\s*(?:noexcept\s*)?:[^:]", flat) and re.search(r"[\w>]$", header.rstrip()):
        return "value"  # a member in a constructor's list of initialisers
    if re.search(r"\b(?:class|struct|union|enum)\b", flat) and "(" not in flat:
        return "scope"
    return "function" if parameter_list(header) else "value"


def functions(code):
    """The functions of bare C++ text: those defined with their length, those declared with their parameters."""
    found, line, header, header_line, depth, body = [], 1, "", 1, 0, None
    values = 0
    for char in code:
        if char == "\n":
            line += 1
        if body or values:
            depth += {"{": 1, "}": -1}.get(char, 0)
            if values:
                header += char
            if depth == 0 and body:
                body.lines = line - body.first_line - 1
                body, header = None, ""
            elif depth == 0:
                values = 0
            continue
        if char == "{":
            kind = kind_of_brace(header)
            if kind == "scope":
                header = ""
            else:
                depth = 1
                if kind == "value":
                    values, header = 1, header + char
                else:
                    name, parameters = parameter_list(header)
                    body = Function(name, header_line, parameter_count(parameters))
                    body.first_line = line
                    found.append(body)
        elif char in ";}":
            declared = parameter_list(header) if char == ";" and "=" not in top_level(header).split("(")[0] else None
            if declared:
                found.append(Function(declared[0], header_line, parameter_count(declared[1])))
            header = ""
        else:
            if not header.strip():
                header_line = line
                header = ""
            header += char
            header = re.sub(r"^\s*(?:public|private|protected)\s*:(?!:)", "", header)
    return found


class Checker:
    def __init__(self, root):
        self.root, self.errors, self.count = root, [], 0

    def run(self):
        for path in source_tree.files(self.root, FOLDERS) + [p for p in self.root.iterdir() if p.is_file()]:
            self.check_file(path.relative_to(self.root), path)
        return self.errors

    def check_file(self, relative, path):
        self.count += 1
        if EMPTY_NAMES.search(relative.name):
            self.errors.append(f"{relative}:1: a file's name says what is in it; '{relative.name}' does not")
        if path.suffix not in source_tree.TEXT and path.suffix != "":
            return
        raw = path.read_bytes()
        if b"\0" in raw:
            return
        text = raw.decode(errors="replace")
        if "oracles" not in relative.parts and "corpus" not in relative.parts:
            self.check_text(relative, text)

    def check_text(self, relative, text):
        in_tests = relative.parts[0] == "tests"
        for number, line in enumerate(text.splitlines(), 1):
            if MARKS.search(line):
                self.errors.append(f"{relative}:{number}: an unfinished mark: {line.strip()[:80]}")
        limit = LONG_FILE_LINES if in_tests or TABLE.search(relative.name) else FILE_LINES
        lines = text.count("\n")
        if relative.suffix in SOURCES and len(relative.parts) > 1 and lines > limit:
            self.errors.append(f"{relative}:{limit + 1}: {lines} lines, at most {limit}")
        if relative.suffix in source_tree.CPP:
            self.check_functions(relative, source_tree.bare_code(text), TEST_FUNCTION_LINES if in_tests else FUNCTION_LINES)

    def check_functions(self, relative, code, limit):
        for function in functions(code):
            if function.lines is not None and function.lines > limit:
                self.errors.append(f"{relative}:{function.line}: {function.name} has {function.lines} lines, at most {limit}")
            if function.parameters > PARAMETERS and function.name not in SIX_NUMBERS:
                self.errors.append(f"{relative}:{function.line}: {function.name} has {function.parameters} parameters, "
                                   f"at most {PARAMETERS}")


def check(root):
    checker = Checker(root)
    errors = checker.run()
    return checker.count, errors


def main(arguments):
    return source_tree.report("check_sizes", arguments, check)


if __name__ == "__main__":
    sys.exit(main(sys.argv))
