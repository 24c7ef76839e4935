#!/usr/bin/env python3
"""check_layers.py [ROOT]: holds every #include of the program against tools/layers.txt and the fences of foreign packages.

A room includes only what its row and its district allow, and reaches what its row must not see on no way round either.
Headers in a room's folder `detail` are for that room alone. A foreign package stays behind its fence. Other headers show
only the standard library, Eigen and tl::expected.
"""

import re
import sys
from pathlib import Path

import source_tree

# The one header that shows a foreign package: to sources and private headers alone.
JSON = "src/base/core/json.hpp"

# Package, how its includes begin, and the folders or files that may have them; None: all. This is the only place where
# fences are written.
FENCES = [
    ("Eigen", ("Eigen/", "unsupported/Eigen/"), None),
    ("tl::expected", ("tl/",), None),
    ("fmt", ("fmt/",), None),
    ("zlib", ("zlib.h", "zconf.h"), {"core"}),
    ("GeographicLib", ("GeographicLib/",), {"geo"}),
    ("toml++", ("toml++/", "toml.hpp"), {"scenario"}),
    ("nlohmann/json", ("nlohmann/",), {JSON}),
    ("pugixml", ("pugixml",), {"city", "tracks", "src/run/verdict/reports.cpp"}),
    ("libarchive", ("archive.h", "archive_entry.h"), {"core"}),
    ("PROJ", ("proj.h", "proj/"), {"src/world/city/earth_map.cpp", "src/run/fault/terrestrial_frame.cpp"}),
    ("libtiff and libgeotiff", ("tiffio.h", "xtiffio.h", "geotiff.h", "geovalues.h", "geo_normalize.h"), {"src/world/city/geotiff_file.cpp"}),
    ("libosmium", ("osmium/", "protozero/"), {"city"}),
    ("CLI11", ("CLI/", "CLI11"), {"host"}),
    ("GoogleTest", ("gtest/", "gmock/"), set()),
    ("Google Benchmark", ("benchmark/",), set()),
    ("Embree", ("embree",), {"src/world/scene/triangle_tree.cpp"}),
    ("libusb", ("libusb",), {"usb"}),
    ("hidapi", ("hidapi",), {"hid"}),
    ("Boost", ("boost/",), {"control", "ntrip", "src/receiver/pvt/integrity.cpp", "src/world/propagation/surroundings_stretch.cpp", "src/campaigns/campaign/campaign_design.cpp", "src/campaigns/campaign_report/statistical_tests.cpp"}),
    ("libcurl", ("curl/",), {"fetch"}),
    ("OpenSSL", ("openssl/",), {"src/world/osnma/cryptography.cpp"}),
    ("libmd", ("sha2.h", "sha256.h"), {"src/campaigns/campaign/sha256.cpp"}),
    ("SQLite", ("sqlite3",), {"src/campaigns/campaign/campaign_database.cpp", "campaign_report"}),
    ("the C library", ("stddef.h", "stdint.h"), {"include/skyloop.h"}),
    # What talks to the kernel is a wire, a file, a terminal or a program that is run; all else is arithmetic.
    ("the operating system",
     ("sys/", "asm/", "linux/", "net/", "netinet/", "arpa/", "fcntl.h", "unistd.h", "termios.h", "poll.h", "pty.h",
      "pthread.h", "signal.h", "netdb.h", "sched.h", "dirent.h", "csignal", "spawn.h", "dlfcn.h", "grp.h", "pwd.h"),
     {"actuator", "can", "core", "campaign", "devices", "hid", "transport", "emulator", "host", "src/run/api/data_place.cpp",
      "src/run/feed/mavlink_endpoint.cpp", "src/run/feed/detail/feed_link.hpp", "src/run/feed/feed_link.cpp", "src/run/feed/stream_link.cpp",
      "src/run/feed/truth_feed.cpp"}),
]
PUBLIC = {"Eigen", "tl::expected", "the C library"}

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)


NAMESPACE = re.compile(r"^namespace (skyloop\b[^{\n]*?) *\{", re.MULTILINE)
DISTRICT = re.compile(r"\[([\w-]+) :((?: [\w-]+)*)\](?:\s*#.*)?")
ROOM = re.compile(r"(\w+)\s*:([\w\s]*)((?:![\w/]+\s*)*)")


class Row:
    def __init__(self, name, district, allowed, unseen):
        self.name, self.district, self.allowed, self.unseen = name, district, allowed, unseen


def read_rows(path):
    """The table as {room: Row}; districts and rooms name only what stands above them."""
    rows, errors, districts, district, below = {}, [], set(), None, set()
    for number, line in enumerate(path.read_text().splitlines(), 1):
        def complain(text):
            errors.append(f"{path}:{number}: {text}")
        if not line.strip() or line.startswith("#"):
            continue
        if match := DISTRICT.fullmatch(line):
            district, below = match[1], set(match[2].split())
            for name in sorted(below - districts):
                complain(f"{district} names {name}, which is no district above it")
            districts.add(district)
            continue
        match = ROOM.fullmatch(line)
        if not match or match[1] in rows or district is None:
            complain("expected '[district : districts]' or 'room : rooms !unseen/header', once for each room")
            continue
        allowed = match[2].split()
        for name in allowed:
            if name not in rows:
                complain(f"{match[1]} names {name}, which has no row above it")
            elif rows[name].district not in below | {district}:
                complain(f"{match[1]} names {name} of {rows[name].district}, which {district} does not name")
        rows[match[1]] = Row(match[1], district, set(allowed), set(match[3].replace("!", "").split()))
    return rows, errors


def place_of(relative):
    """District and room of a file of the program, or None."""
    parts = relative.parts
    if parts == ("include", "skyloop.h"):
        return "run", "api"
    if parts[0] == "src" and len(parts) > 3:
        return parts[1:3]
    return parts[:2] if parts[0] == "firmware-host" and len(parts) > 2 else None


def is_public(relative):
    return relative.suffix in (".hpp", ".h") and "detail" not in relative.parts


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
        district, layer = place_of(relative) or (None, None)
        self.edges[relative] = []
        if layer not in self.rows or self.rows[layer].district != district:
            self.complain(relative, 1, "belongs to no row of tools/layers.txt")
            return
        text = source_tree.without_comments((self.root / relative).read_text(errors="replace"))
        self.check_namespaces(relative, text)
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

    def check_namespaces(self, relative, text):
        """Names say where they live: skyloop::inline DISTRICT in src, skyloop::ROOM in firmware-host."""
        district, layer = place_of(relative)
        expected = f"skyloop::{layer}" if district == "firmware-host" else f"skyloop::inline {district}"
        for match in NAMESPACE.finditer(text):
            if match[1] != expected and not match[1].startswith(expected + "::"):
                line = text.count("\n", 0, match.start()) + 1
                self.complain(relative, line, f"namespace {match[1]}: expected {expected}")

    def own_header(self, relative, name):
        """The file of the project that an include names, or None."""
        beside = Path("/".join(p for p in (*relative.parts[:-1], name)))
        for candidate in (Path("include") / name, Path("src") / name, Path("firmware-host") / name, beside):
            if ".." not in candidate.parts and (self.root / candidate).is_file():
                return candidate
        return None

    def check_own(self, relative, layer, line, own):
        if own.as_posix() == JSON and is_public(relative) and layer != "host":
            self.complain(relative, line, "a public header shows no JSON")
        _, target = place_of(own)
        if target == layer:
            return
        if target not in self.rows[layer].allowed:
            self.complain(relative, line, f"{layer} may not include {target} (tools/layers.txt)")
        elif not is_public(own):
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
        elif is_public(relative) and layer != "host" and title not in PUBLIC and relative.as_posix() != JSON:
            self.complain(relative, line, f"<{name}>: a public header shows only the standard library, Eigen and tl::expected")

    def check_unseen(self, start):
        _, layer = place_of(start) or (None, None)
        row = self.rows.get(layer)
        if row is None or not row.unseen:
            return
        unseen = {}
        for name in row.unseen:
            room = self.rows.get(name.split("/")[0])
            unseen[Path("src") / (room.district if room else "") / (name + ".hpp")] = name
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
