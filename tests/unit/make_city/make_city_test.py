"""make_city_test.py PROGRAM: what the program writes, and what it refuses."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = ""


class MakeCity(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.output = Path(folder.name) / "city.obj"

    def run_with(self, *options):
        return subprocess.run([PROGRAM, "--output", str(self.output), *options], capture_output=True, text=True,
                              check=False)

    def made(self, *options):
        result = self.run_with(*options)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([self.output], list(self.output.parent.iterdir()))
        return self.output.read_text()

    def test_faces_name_vertices_and_are_as_many_as_asked_for(self):
        for options in [("--triangles", "2000"), ("--triangles", "20000", "--windows")]:
            vertices, faces = 0, []
            for line in self.made(*options).splitlines():
                word, *rest = line.split()
                if word == "v":
                    vertices += 1
                    self.assertEqual(3, len([float(x) for x in rest]))
                elif word == "f":
                    faces.append([int(x) for x in rest])
                else:
                    self.assertIn(word, ["#", "g", "usemtl"])
            wanted = int(options[1])
            self.assertLess(abs(len(faces) - wanted), 11 if len(options) == 2 else wanted / 2)
            for face in faces:
                self.assertEqual(3, len(set(face)))
                self.assertTrue(all(1 <= corner <= vertices for corner in face))

    def test_the_same_seed_gives_the_same_bytes_and_another_others(self):
        first = self.made("--triangles", "1000", "--seed", "5")
        self.assertEqual(first, self.made("--triangles", "1000", "--seed", "5"))
        self.assertNotEqual(first, self.made("--triangles", "1000", "--seed", "6"))

    def test_ground_can_be_left_out(self):
        self.assertIn("\ng ground\n", self.made("--triangles", "100"))
        self.assertNotIn("\ng ground\n", self.made("--triangles", "100", "--no-ground"))

    def test_bad_options_and_places_are_refused_in_a_line(self):
        for options in [("--triangles", "many"), ("--triangles", "-5"), ("--height", "3"), ("--turned-blocks", "2")]:
            result = self.run_with(*options)
            self.assertEqual(result.returncode, 2, options)
            self.assertIn(options[0].lstrip("-"), result.stderr)
        result = subprocess.run([PROGRAM, "--output", "/nowhere/at/all.obj"], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 1)
        self.assertIn("/nowhere/at/all.obj", result.stderr)
        self.assertEqual([], list(self.output.parent.iterdir()))


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
