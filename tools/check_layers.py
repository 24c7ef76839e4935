#!/usr/bin/env python3
"""check_layers.py [ROOT]: holds every #include of the program against tools/layers.txt and the fences of foreign packages.

A folder includes only what its row allows, and reaches what its row must not see on no way round either. A foreign
package stays behind its fence. Public headers show only the standard library, Eigen and tl::expected.
"""

import re
import sys
from pathlib import Path

import source_tree

# Package, how its includes begin, and the folders or files that may have them; None: all. This is the only place where
# fences are written.
FENCES = [
    ("Eigen", ("Eigen/",), None),
    ("tl::expected", ("tl/",), None),
    ("fmt", ("fmt/",), None),
    ("zlib", ("zlib.h", "zconf.h"), {"base"}),
    ("GeographicLib", ("GeographicLib/",), {"geo"}),
    ("toml++", ("toml++/", "toml.hpp"), {"scenario"}),
    ("nlohmann/json", ("nlohmann/",), {"city", "verdict", "emulator", "analysis", "campaign", "campaign_report", "api", "feed", "output",
                                       "control", "scenario", "tracks", "host"}),
    ("pugixml", ("pugixml",), {"city", "tracks", "src/verdict/reports.cpp"}),
    ("libzip", ("zip.h",), {"src/tracks/kmz_track.cpp"}),
    ("libosmium", ("osmium/", "protozero/"), {"city"}),
    ("CLI11", ("CLI/", "CLI11"), {"host"}),
    ("spdlog", ("spdlog/",), {"host"}),
    ("GoogleTest", ("gtest/", "gmock/"), set()),
    ("Google Benchmark", ("benchmark/",), set()),
    ("Embree", ("embree",), {"src/scene/triangle_tree.cpp"}),
    ("libusb", ("libusb",), {"usb"}),
    ("hidapi", ("hidapi",), {"hid"}),
    ("Boost", ("boost/",), {"control", "src/campaign_report/intervals.cpp", "src/campaign_report/rank_tests.cpp"}),
    ("OpenSSL", ("openssl/",), {"src/campaign/sha256.cpp"}),
    ("SQLite", ("sqlite3",), {"src/campaign/campaign_database.cpp", "campaign_report"}),
    ("the C library", ("stddef.h", "stdint.h"), {"include/skyloop.h"}),
    # What talks to the kernel is a wire, a file, a terminal or a program that is run; all else is arithmetic.
    ("the operating system",
     ("sys/", "asm/", "linux/", "net/", "netinet/", "arpa/", "fcntl.h", "unistd.h", "termios.h", "poll.h", "pty.h",
      "pthread.h", "signal.h", "netdb.h", "sched.h", "dirent.h", "csignal", "spawn.h", "dlfcn.h", "grp.h", "pwd.h"),
     {"actuator", "base", "campaign", "devices", "hid", "transport", "emulator", "host", "src/api/data_place.cpp",
      "src/feed/mavlink_endpoint.cpp", "src/feed/feed_link.hpp", "src/feed/feed_socket.cpp", "src/feed/feed_socket.hpp",
      "src/feed/feed_stream.cpp", "src/feed/feed_worker.cpp", "src/feed/stream_link.cpp"}),
]
PUBLIC = {"Eigen", "tl::expected", "the C library"}

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)


class Row:
    def __init__(self, name, allowed, unseen):
        self.name, self.allowed, self.unseen = name, allowed, unseen


def read_rows(path):
    """The table as {name: Row}; a row may name only rows above it."""
    rows, errors = {}, []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        match = re.fullmatch(r"(\w+)\s*:([\w\s]*)((?:![\w/]+\s*)*)", line)
        if not match or match[1] in rows:
            errors.append(f"{path}:{number}: expected 'folder : folders !unseen/header', once for each folder")
            continue
        allowed = match[2].split()
        for name in allowed:
            if name not in rows:
                errors.append(f"{path}:{number}: {match[1]} names {name}, which has no row above it")
        rows[match[1]] = Row(match[1], set(allowed), set(match[3].replace("!", "").split()))
    return rows, errors


def layer_of(relative):
    """The row that a file of the program belongs to, or None."""
    parts = relative.parts
    if parts[0] == "src" and len(parts) > 2:
        return parts[1]
    if parts[:2] == ("include", "skyloop") and len(parts) > 3:
        return parts[2]
    if parts[0] == "firmware-host" and len(parts) > 2:
        return parts[1]
    if parts == ("include", "skyloop.h"):
        return "api"
    return None


def is_public(relative):
    return relative.suffix in (".hpp", ".h") and relative.parts[0] in ("include", "firmware-host")


class Checker:
    def __init__(self, root):
        self.root = root
        self.rows, self.errors = read_rows(root / "tools" / "layers.txt")
        self.edges = {}  # file: [(line, file)], the includes inside the project

    def run(self):
        for path in source_tree.cpp_files(self.root, ["include", "src", "firmware-host"]):
            self.check_file(path.relative_to(self.root))
        for relative in self.edges:
            self.check_unseen(relative)
        return self.errors

    def complain(self, relative, line, message):
        self.errors.append(f"{relative}:{line}: {message}")

    def check_file(self, relative):
        layer = layer_of(relative)
        self.edges[relative] = []
        if layer not in self.rows:
            self.complain(relative, 1, "belongs to no row of tools/layers.txt")
            return
        text = source_tree.without_comments((self.root / relative).read_text(errors="replace"))
        for match in INCLUDE.finditer(text):
            line = text.count("\n", 0, match.start()) + 1
            name = match[1] or match[2]
            own = self.own_header(relative, name)
            if own:
                self.edges[relative].append((line, own))
                self.check_own(relative, layer, line, own)
            elif match[1]:
                self.complain(relative, line, f'"{name}" is no header of the project')
            else:
                self.check_foreign(relative, layer, line, name)

    def own_header(self, relative, name):
        """The file of the project that an include names, or None."""
        beside = Path("/".join(p for p in (*relative.parts[:-1], name)))
        for candidate in (Path("include") / name, Path("firmware-host") / name, beside):
            if ".." not in candidate.parts and (self.root / candidate).is_file():
                return candidate
        return None

    def check_own(self, relative, layer, line, own):
        target = layer_of(own)
        if target == layer:
            return
        if target not in self.rows[layer].allowed:
            self.complain(relative, line, f"{layer} may not include {target} (tools/layers.txt)")
        elif own.parts[0] == "src":
            self.complain(relative, line, f"{own} is private to {target}")

    def check_foreign(self, relative, layer, line, name):
        package = next((f for f in FENCES if name.startswith(f[1])), None)
        if package is None:
            if "/" in name or "." in name:
                self.complain(relative, line, f"<{name}> is of no package named in tools/check_layers.py")
            return
        title, _, folders = package
        if folders is not None and not {layer, relative.as_posix()} & folders:
            place = "in " + ", ".join(sorted(folders)) if folders else "not in the program"
            self.complain(relative, line, f"<{name}>: {title} may be used only {place}" if folders
                          else f"<{name}>: {title} is {place}")
        elif is_public(relative) and layer != "host" and title not in PUBLIC:
            self.complain(relative, line, f"<{name}>: a public header shows only the standard library, Eigen and tl::expected")

    def check_unseen(self, start):
        row = self.rows.get(layer_of(start))
        if row is None or not row.unseen:
            return
        unseen = {Path("include/skyloop") / (name + ".hpp"): name for name in row.unseen}
        ways, queue = {start: [start]}, [start]
        while queue:
            here = queue.pop(0)
            for line, target in self.edges.get(here, []):
                if target in ways:
                    continue
                ways[target] = ways[here] + [target]
                queue.append(target)
                if target in unseen:
                    first = next(n for n, t in self.edges[start] if t == ways[target][1])
                    way = " > ".join(str(p) for p in ways[target][1:])
                    self.complain(start, first, f"{row.name} must not see {unseen[target]} (by {way})")


def check(root):
    checker = Checker(root)
    errors = checker.run()
    return len(checker.edges), errors


def main(arguments):
    return source_tree.report("check_layers", arguments, check)


if __name__ == "__main__":
    sys.exit(main(sys.argv))
