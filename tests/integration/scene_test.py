"""Buildings in a run: satellites are blocked and reflected, and the same run gives the same bytes."""
import csv
import json
import os
import pathlib
import time
import unittest

from session import SHARED, open_folder, skyloop

RUN = ["simulate", "--scene", "demo", "--start", "2026-03-01T09:00:00Z", "--duration", 10, "--out"]


def rows(folder):
    with open(pathlib.Path(folder, "satellites.csv"), encoding="ascii") as file:
        return list(csv.DictReader(file))


class SceneTest(unittest.TestCase):
    def test_buildings_block_and_reflect(self):
        for model in ("modern", "baseline"):
            with self.subTest(model), open_folder() as folder:
                skyloop(*RUN, folder, "--model", model)
                found = rows(folder)
                self.assertTrue(any(row["line_of_sight"] == "0" for row in found))
                self.assertTrue(any(row["line_of_sight"] == "1" for row in found))
                for row in found:
                    if model == "baseline" and row["line_of_sight"] == "1":
                        self.assertEqual(float(row["excess_path_m"]), 0)
                    if row["paths"] == "0":
                        self.assertEqual(row["used"], "0")
                summary = json.loads(pathlib.Path(folder, "run.json").read_text(encoding="utf-8"))
                self.assertGreater(summary["scene"]["triangles"], 100)
                self.assertEqual(summary["path_search"]["epochs"], 10)

    def test_the_same_run_gives_the_same_bytes(self):
        with open_folder() as first, open_folder() as second:
            for folder in (first, second):
                skyloop(*RUN, folder)
            for name in ("satellites.csv", "fixes.csv", "port0.out"):
                self.assertEqual(pathlib.Path(first, name).read_bytes(), pathlib.Path(second, name).read_bytes(), name)

    def test_scene_tells_what_the_model_holds(self):
        with open_folder() as folder:
            top, sky = pathlib.Path(folder, "top.svg"), pathlib.Path(folder, "sky.svg")
            told = json.loads(skyloop("scene", "demo", "--at", "46.4774,30.7326", "--svg", top, "--sky-svg", sky, "--json").stdout)
            self.assertGreater(told["wall_triangles"], 100)
            self.assertFalse(told["at"]["enclosed"])
            self.assertTrue(0 < told["at"]["open_sky"] < 1)
            for picture in (top, sky):
                self.assertIn("<svg", picture.read_text(encoding="utf-8"))
            first = sky.read_bytes()
            time.sleep(1)
            skyloop("scene", "demo", "--at", "46.4774,30.7326", "--sky-svg", sky)
            self.assertEqual(sky.read_bytes(), first)

    def test_without_ground_a_place_is_above_the_foot_of_the_buildings(self):
        with open_folder() as folder:
            walls = pathlib.Path(folder, "walls.obj")
            walls.write_text("v 0 0 503\nv 50 0 503\nv 50 0 523\nv 0 0 523\nf 1 2 3 4\n", encoding="ascii")
            told = json.loads(skyloop("scene", walls, "--origin", "48,11,0", "--at", "47.9999,11.0002", "--json").stdout)
            self.assertAlmostEqual(told["at"]["up_m"], 504.5, delta=0.01)
            self.assertLess(told["at"]["open_sky"], 0.8)

    def test_a_place_counts_in_a_model_that_lies_on_the_earth(self):
        corners = ((46.4775, 30.7328), (46.4775, 30.7331), (46.4779, 30.7331), (46.4779, 30.7328))
        nodes = "".join(f'<node id="{k}" lat="{lat}" lon="{lon}"/>' for k, (lat, lon) in enumerate(corners, 1))
        way = "".join(f'<nd ref="{k}"/>' for k in (1, 2, 3, 4, 1)) + '<tag k="building" v="yes"/><tag k="height" v="20"/>'
        with open_folder() as folder:
            town = pathlib.Path(folder, "town.osm")
            town.write_text(f'<osm version="0.6">{nodes}<way id="9">{way}</way></osm>', encoding="ascii")

            def told(*more):
                answer = skyloop("scene", town, "--json", *more)
                return json.loads(answer.stdout), answer.stderr
            on_roof, warned = told("--at", "46.4777,30.73295,25")
            self.assertAlmostEqual(on_roof["at"]["up_m"], 25, delta=0.01)
            self.assertAlmostEqual(on_roof["at"]["east_m"], 0, delta=0.1)
            self.assertEqual(on_roof["at"]["open_sky"], 1)
            self.assertIn("does not say how high its ground lies", warned)
            street, warned = told("--at", "46.4777,30.7326")
            self.assertAlmostEqual(street["at"]["up_m"], 1.5, delta=0.01)
            self.assertAlmostEqual(street["at"]["east_m"], -26.9, delta=0.1)
            self.assertEqual(warned, "")
            ran = skyloop("simulate", "--scene", town, "--at", "46.4777,30.7326,600", "--start", "2026-03-01T09:00:00Z",
                          "--duration", 1, "--out", pathlib.Path(folder, "run"))
            self.assertIn("town.osm does not say how high its ground lies", ran.stderr)

    def test_a_model_in_local_coordinates_is_taken_to_the_place(self):
        with open_folder() as folder:
            walls = pathlib.Path(folder, "walls.obj")
            walls.write_text("v 0 10 0\nv 50 10 0\nv 50 10 20\nv 0 10 20\nf 1 2 3 4\n", encoding="ascii")
            answer = skyloop("scene", walls, "--at", "46,30,100", "--json")
            told = json.loads(answer.stdout)
            self.assertAlmostEqual(told["at"]["up_m"], 1.5, delta=0.01)
            self.assertAlmostEqual(told["origin"][2], 98.5, delta=0.01)
            self.assertIn("walls.obj does not say where it lies", answer.stderr)

    def test_a_model_in_the_coordinates_of_a_map_lies_by_its_own_origin(self):
        with open_folder() as folder:
            walls = pathlib.Path(folder, "walls.obj")
            walls.write_text("v 392118 5820074 35\nv 392168 5820074 35\nv 392168 5820074 55\nv 392118 5820074 55\nf 1 2 3 4\n",
                             encoding="ascii")
            answer = skyloop("scene", walls, "--origin", "52.52,13.41,74.5", "--file-origin", "392118,5820064,35", "--json")
            told = json.loads(answer.stdout)
            self.assertAlmostEqual(told["lowest_m"][1], 10, delta=0.001)
            self.assertAlmostEqual(told["highest_m"][2], 20, delta=0.001)
            self.assertEqual(answer.stderr, "")
            wrong = skyloop("scene", walls, "--file-origin", "392118,5820064", check=False)
            self.assertEqual(wrong.returncode, 2)
            self.assertIn("expected X,Y,Z of the file", wrong.stderr)

    def test_a_model_in_the_coordinates_of_a_map_that_is_named_lies_there(self):
        with open_folder() as folder:
            walls = pathlib.Path(folder, "walls.obj")
            walls.write_text("v 84868 447577 1\nv 84888 447597 1\nv 84888 447597 9\nv 84868 447577 9\nf 1 2 3 4\n", encoding="ascii")
            named = ["scene", walls, "--file-crs", "EPSG:28992", "--json"]
            told = json.loads(skyloop(*named).stdout)
            # echo 84878 447587 | PROJ_NETWORK=OFF cs2cs -f %.7f EPSG:28992 EPSG:4326
            self.assertAlmostEqual(told["origin"][0], 52.0122091, delta=1e-5)
            self.assertAlmostEqual(told["origin"][1], 4.3657866, delta=1e-5)
            missing = skyloop(*named, check=False, env={**os.environ, "PROJ_DATA": folder, "PROJ_LIB": folder, "HOME": folder})
            self.assertIn(missing.returncode, (1, 2))
            self.assertIn("PROJ's database proj.db is missing: install the package proj-data", missing.stderr)
            self.assertEqual(missing.stderr.count("\n"), 1, missing.stderr)

    def test_what_was_read_without_a_grid_is_read_anew_with_it(self):
        city = SHARED / "city/delft.json"
        if not city.exists():
            self.skipTest(f"no {city}")
        with open_folder() as folder:
            home = {**os.environ, "HOME": folder, "XDG_CACHE_HOME": folder, "XDG_DATA_HOME": folder}
            for _ in range(2):  # the second may come from the cache
                first = skyloop("scene", city, env=home).stdout
            grids = pathlib.Path(folder, "proj")
            grids.mkdir()
            (grids / "of_ours.tif").write_bytes(b"")
            again = skyloop("scene", city, env=home).stdout
            self.assertNotIn("from the cache", again)
            self.assertEqual(first.replace(", from the cache", ""), again)

    def test_check_reads_the_scene(self):
        self.assertIn("scene       demo, ", skyloop("check", "--scene", "demo").stdout)


if __name__ == "__main__":
    unittest.main()
