"""Every example of a generated path runs, is finite and moves without a knock; `--svg FILE` draws their plan views."""
import csv
import json
import math
import pathlib
import re
import sys
import unittest

from session import ROOT, open_folder, skyloop

EXAMPLES = sorted((ROOT / "tools/scenarios/paths").glob("*.toml"))
METRES_PER_DEGREE = 111_195


def truth_of(example, folder, *arguments):
    done = skyloop("simulate", example, "--out", folder, *arguments)
    with open(pathlib.Path(folder, "fixes.csv"), encoding="ascii") as file:
        return list(csv.DictReader(file)), done.stderr


def plan_of(rows):
    """East and north of the first place, m; good enough for a picture."""
    lat, lon = float(rows[0]["true_lat_deg"]), float(rows[0]["true_lon_deg"])
    return [((float(row["true_lon_deg"]) - lon) * METRES_PER_DEGREE * math.cos(math.radians(lat)),
             (float(row["true_lat_deg"]) - lat) * METRES_PER_DEGREE) for row in rows]


class PathsTest(unittest.TestCase):
    def test_every_example_runs(self):
        self.assertGreaterEqual(len(EXAMPLES), 12)
        for example in EXAMPLES:
            with self.subTest(example.name), open_folder() as folder:
                rows, said = truth_of(example, folder, "--model", "ideal", "--duration", "100")
                self.assertNotIn("error:", said)
                points = plan_of(rows)
                self.assertTrue(all(math.isfinite(value) for point in points for value in point))
                steps = [math.dist(a, b) for a, b in zip(points, points[1:])]
                changes = [abs(b - a) for a, b in zip(steps, steps[1:])]
                self.assertLess(max(changes), 12, "m/s within a second, over ground")

    def test_check_tells_the_path(self):
        done = skyloop("check", ROOT / "tools/scenarios/paths/sequence.toml")
        self.assertIn("joined by a curve of", done.stdout + done.stderr)

    def test_all_of_it_is_looked_at(self):
        for example in EXAMPLES:
            with self.subTest(example.name):
                listing = json.loads(skyloop("trajectory", example, "--format", "json").stdout)
                told = re.search(r", ([0-9.]+) s$", listing["description"])
                if told:
                    delay = re.search(r"^start_delay_s = ([0-9.]+)", example.read_text(encoding="utf-8"), re.M)
                    whole = float(told.group(1)) + (float(delay.group(1)) if delay else 0)
                    self.assertAlmostEqual(listing["duration_s"], whole, delta=0.06)
                    self.assertNotIn("no end of its own", str(listing))

    def test_another_seed_is_another_drive(self):
        example = ROOT / "tools/scenarios/paths/drive.toml"
        ends = []
        for seed in ("1", "1", "2"):
            with open_folder() as folder:
                rows, _ = truth_of(example, folder, "--model", "ideal", "--duration", "120", "--seed", seed)
                ends.append((rows[-1]["true_lat_deg"], rows[-1]["true_lon_deg"]))
        self.assertEqual(ends[0], ends[1])
        self.assertNotEqual(ends[0], ends[2])


def plan_view(name, points, left, top, size):
    """One example as a part of an SVG, fitted into a square."""
    east, north = zip(*points)
    reach = max(max(east) - min(east), max(north) - min(north), 0.1)
    scale = (size - 40) / reach
    middle = (max(east) + min(east)) / 2, (max(north) + min(north)) / 2
    drawn = []
    for x, y in points:
        dot = left + size / 2 + (x - middle[0]) * scale, top + size / 2 - (y - middle[1]) * scale
        if not drawn or math.dist(dot, drawn[-1]) > 0.8:
            drawn.append(dot)
    dots = " ".join(f"{x:.1f},{y:.1f}" for x, y in drawn)
    width = f"{reach / 1000:.1f} km" if reach >= 1000 else f"{reach:.3g} m"
    return (f'<polyline points="{dots}" fill="none" stroke="#1f6f8b" stroke-width="1.2"/>'
            f'<text x="{left + 6}" y="{top + 14}">{name}, {width}</text>')


def draw(target):
    size, columns, views = 220, 4, []
    # Rockets go straight up: from above they are a dot.
    shown = [example for example in EXAMPLES if not example.stem.startswith("rocket")]
    for index, example in enumerate(shown):
        with open_folder() as folder:
            slow = example.stem == "balloon"
            rows, _ = truth_of(example, folder, "--model", "ideal", *([] if slow else ["--rate", "5"]))
        column, row = index % columns, index // columns
        views.append(plan_view(example.stem, plan_of(rows), column * size, row * size, size))
    height = -(-len(shown) // columns) * size
    text = "\n".join(views)
    pathlib.Path(target).write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {columns * size} {height}" font-family="sans-serif" '
        f'font-size="11"><rect width="100%" height="100%" fill="white"/>\n{text}\n</svg>\n', encoding="utf-8")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--svg"]:
        draw(sys.argv[2])
    else:
        unittest.main()
