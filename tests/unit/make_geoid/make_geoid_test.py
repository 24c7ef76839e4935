"""make_geoid_test.py PROGRAM [EGM96_GTX]: what the program makes of good and bad grids."""

import math
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = ""
EGM96 = None


def gtx(west=-180.0, south=-90.0, rows=5, columns=8, height=lambda row, column: 10.0 * row - 2.5 * column):
    """A small grid; rows from the south, one cell more than goes around."""
    header = struct.pack(">4d2i", south, west, 180 / (rows - 1), 360 / columns, rows, columns + 1)
    return header + b"".join(struct.pack(">f", height(r, c % columns)) for r in range(rows) for c in range(columns + 1))


class MakeGeoid(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.output = self.folder / "out.pgm"

    def run_on(self, content):
        source = self.folder / "in.gtx"
        source.write_bytes(content)
        return subprocess.run([PROGRAM, str(source), str(self.output)], capture_output=True, text=True, check=False)

    def made(self, content):
        """The comment lines, and the pixels as heights in rows from the north."""
        result = self.run_on(content)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.read(self.output)

    def read(self, path):
        lines = path.read_bytes().split(b"\n", 15)
        comments = [line.decode() for line in lines if line.startswith(b"# ")]
        start = next(i for i, line in enumerate(lines) if line == b"65535")
        width, height = map(int, lines[start - 1].split())
        pixels = b"\n".join(lines[start + 1:])
        self.assertEqual(lines[0], b"P5")
        self.assertEqual(len(pixels), 2 * width * height)
        values = [value * 0.003 - 108 for value in struct.unpack(f">{width * height}H", pixels)]
        return comments, [values[i:i + width] for i in range(0, len(values), width)]

    def test_starts_in_the_north_and_at_greenwich(self):
        comments, rows = self.made(gtx())
        self.assertIn("# Offset -108", comments)
        self.assertIn("# Scale 3e-3", comments)
        self.assertIn("# Origin 90N 0E", comments)
        self.assertEqual(len(rows), 721)
        # Nodes of the grid, 45 degrees apart: from the north, and from the column of longitude 0, the fifth from -180.
        for index, row in enumerate(rows[::180]):
            for value, column in zip(row[::180], (4, 5, 6, 7, 0, 1, 2, 3)):
                self.assertAlmostEqual(value, 10 * (4 - index) - 2.5 * column, delta=0.0015001)

    def test_same_input_same_bytes(self):
        self.made(gtx())
        first = self.output.read_bytes()
        self.made(gtx())
        self.assertEqual(self.output.read_bytes(), first)

    def test_refuses_bad_grids_in_one_line_and_leaves_nothing(self):
        cases = {
            "empty": b"", "header only": gtx()[:40], "cut": gtx()[:-1], "cut header": gtx()[:39],
            "not from the pole": gtx(south=-80.0), "height is no number": gtx(height=lambda r, c: math.nan),
            "too high": gtx(height=lambda r, c: 1e4), "infinite": gtx(height=lambda r, c: -math.inf),
            "noise": bytes(range(256)) * 4,
            "huge header": struct.pack(">4d2I", -90, -180, 1e-9, 1e-9, 0xffffffff, 0xffffffff),
        }
        for name, content in cases.items():
            with self.subTest(name):
                result = self.run_on(content)
                self.assertEqual(result.returncode, 1)
                self.assertRegex(result.stderr, r"^make_geoid: [^\n]+\n$")
                self.assertEqual([p.name for p in self.folder.iterdir()], ["in.gtx"])

    def test_says_what_it_cannot_read_or_write(self):
        for arguments, part in (([str(self.folder), str(self.output)], "no such file"),
                                (["/nowhere.gtx", str(self.output)], "/nowhere.gtx")):
            result = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False)
            self.assertEqual(result.returncode, 1)
            self.assertIn(part, result.stderr)
        self.output = self.folder / "no folder" / "out.pgm"
        result = self.run_on(gtx())
        self.assertEqual(result.returncode, 1)
        self.assertIn("cannot be written", result.stderr)
        self.assertEqual(subprocess.run([PROGRAM], capture_output=True, check=False).returncode, 2)

    def test_egm96_of_proj_data(self):
        if not EGM96:
            self.skipTest("no egm96_15.gtx: the package proj-data is not installed")
        result = subprocess.run([PROGRAM, EGM96, str(self.output)], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        comments, rows = self.read(self.output)
        self.assertIn("# Description WGS84 EGM96, 15-minute grid", comments)
        self.assertEqual((len(rows), len(rows[0])), (721, 1440))
        self.assertEqual((len(set(rows[0])), len(set(rows[720]))), (1, 1))  # a pole is one place
        self.assertAlmostEqual(rows[0][0], 13.606, delta=0.002)
        self.assertAlmostEqual(rows[160][0], 45.038, delta=0.002)  # 50° N 0° E, geoid_egm96.csv, pU07
        self.assertAlmostEqual(rows[360][720], 21.153, delta=0.002)  # 0° N 180° E, pU06


if __name__ == "__main__":
    PROGRAM = sys.argv[1]
    EGM96 = sys.argv[2] if len(sys.argv) > 2 and sys.argv[2] else None
    unittest.main(argv=sys.argv[:1])
