"""Every key that a board file may hold, and every column of the output tables, stands in its page, and no page names one that
is not there. The keys of scenarios have a page of their own, and tests/unit/scenario/scenario_documentation_test.cpp."""

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
READERS = ("number|degrees|file_path|boolean|text|texts|text_or_texts|integer|numbers|whole_numbers|place|utc|choice|choices|word|quantity|"
           "table|tables|named_values")
COMMENT = re.compile(r"//[^\n]*")
CODE_SPAN = re.compile(r"`([^`]*)`")
NAME = re.compile(r"[A-Za-z0-9_]+(?:-[A-Za-z0-9_]+)*")


def keys_read(source):
    """Names of the keys that this C++ text reads: literals passed to a TableReader, and lists of systems."""
    code = COMMENT.sub("", source)
    keys = set(re.findall(rf'\.(?:{READERS})\(\s*"([^"]+)"', code))
    keys |= set(re.findall(r'\bread_constellation_list\(\s*\w+\s*,\s*"([^"]+)"', code))
    return keys


def words_read(source):
    """Words that a key may take and names of error terms: the first literal of each brace of a table of theirs."""
    return set(re.findall(r'\{\s*"([a-z0-9][a-z0-9_-]*)"\s*,\s*[A-Za-z&]', COMMENT.sub("", source)))


def names_told(page):
    """Names in the code spans and the headings of tables of a page."""
    headings = re.findall(r"^##+ (.*\[.*)$", page, re.MULTILINE)
    return {name for span in CODE_SPAN.findall(page) + headings for name in NAME.findall(span)}


def names_of_rows(page):
    """Names in the first column of tables headed `key` or `column`: those that the page claims to exist."""
    names, inside = set(), False
    for line in page.splitlines():
        if not line.startswith("|"):
            inside = False
        elif re.match(r"\| (key|column)s? \|", line):
            inside = True
        elif inside and not line.startswith("|---"):
            names |= {name for span in CODE_SPAN.findall(line.split("|")[1]) for name in NAME.findall(span)}
    return names


def read(name):
    return (ROOT / name).read_text(encoding="utf-8")


def board_sources():
    return [path.read_text(encoding="utf-8") for path in sorted((ROOT / "src/run/scenario").glob("board_*.cpp"))]


def columns(header):
    """Columns of a table whose header line is the C++ constant `header`."""
    text = re.search(rf"\b{header} =((?:\s*\"[^\"]*\")+);", read("src/run/emulator/detail/recording_formats.hpp")).group(1)
    return "".join(re.findall(r'"([^"]*)"', text)).removesuffix("\\n").split(",")


class Extraction(unittest.TestCase):
    CODE = '''
        table.number("wide", x);  // table.number("comment", x);
        run.quantity(
            "long_line_m", y, {0, 1});
        model.table("layers", [&](TableReader& t) { t.boolean("on", b); });
        read_constellation_list(t, "systems", s);
        static constexpr std::array<Word<Kind>, 1> kinds{{{"narrow-band", Kind::narrow}}};
        return {{"rain", &p.rain}};'''

    def test_keys(self):
        self.assertEqual(keys_read(self.CODE), {"wide", "long_line_m", "layers", "on", "systems"})

    def test_words(self):
        self.assertEqual(words_read(self.CODE), {"narrow-band", "rain"})

    def test_what_a_page_tells(self):
        page = "## [model.sky]\nplain word `start`, `model.errors`\n| key | x |\n|---|---|\n| `a_m`, `b-c` | `d` |\n\n| `e` |\n"
        self.assertEqual(names_told(page), {"sky", "start", "model", "errors", "a_m", "b-c", "d", "e"})
        self.assertEqual(names_of_rows(page), {"a_m", "b-c"})


class Pages(unittest.TestCase):
    def expect_all(self, names, page):
        self.assertGreater(len(names), 15)  # or the extraction has gone blind
        self.assertEqual(sorted(names - names_told(read(page))), [], f"read by the program, not told in {page}")

    def test_presets_are_told(self):
        sources = [read("src/run/scenario/modern_settings.hpp"), read("src/world/propagation/surroundings.hpp")]
        names = re.findall(r"_names\[\] = \{([^}]*)\}", "".join(sources))
        words = set(re.findall(r'"([^"]+)"', ",".join(names)))
        self.assertGreater(len(words), 12)
        self.assertEqual(sorted(words - names_told(read("docs/scenario.md"))), [])

    def test_board_keys_are_told(self):
        self.expect_all(set().union(*map(keys_read, board_sources())), "boards/README.md")

    def test_board_words_are_told(self):
        words = set().union(*map(words_read, board_sources()))
        self.assertGreater(len(words), 10)
        self.assertEqual(sorted(words - names_told(read("boards/README.md"))), [])

    def test_columns_are_told(self):
        names = set(columns("fixes_header")) | set(columns("satellites_header"))
        names |= set(columns("precise_satellites_header")[1:])
        self.expect_all(names, "docs/output.md")
        self.assertEqual(sorted(names_of_rows(read("docs/output.md")) - names), [], "told, but never written")


class LinesForOtherPrograms(unittest.TestCase):
    """What no test can run, since the programs are not here: forms of it that cannot work."""

    pages = [*sorted((ROOT / "docs").rglob("*.md")), ROOT / "README.md", ROOT / "tools/man/skyloop.1"]

    def test_the_line_of_a_sitl_has_no_speed(self):
        for page in self.pages:  # ArduPilot, AP_HAL_SITL/UARTDriver.cpp: it holds the line at a speed that stands there
            self.assertEqual(re.findall(r"uart:/[^\s`\"]*:\d+", page.read_text(encoding="utf-8")), [], page.name)

    def test_betaflights_ports_have_both_forms(self):
        for page in self.pages:  # betaflight #15573: from 2026.12 on "serial" is read only
            text = page.read_text(encoding="utf-8")
            if re.search(r"^serial \d", text, re.MULTILINE) and "Betaflight" in text:
                self.assertIn("set gps_uart = UART3\nset gps_baud = 115200\n", text, page.name)
                self.assertIn("set msp_uart_2 = UART2", text, page.name)

    def test_betaflight_listens_at_its_own_port(self):
        for page in self.pages:  # Betaflight's sitl.c: PORT_STATE is 9003, on all addresses of the machine
            for to in re.findall(r"betaflight:\d+,127\.0\.0\.1:(\d+)", page.read_text(encoding="utf-8")):
                self.assertEqual(to, "9003", page.name)


if __name__ == "__main__":
    unittest.main()
