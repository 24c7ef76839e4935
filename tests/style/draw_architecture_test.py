"""The picture of the layers says what tools/layers.txt says."""
import pathlib
import sys
import unittest
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import draw_architecture  # noqa: E402

LAYERS = "# comment\n[base :]  # values\ncore :\ntime : core  !core/x\ngeo : core\n[world : base]\nflow : core time geo\n"


class Picture(unittest.TestCase):
    def test_rows(self):
        layers, districts = draw_architecture.read_layers(LAYERS)
        self.assertEqual(layers, {"core": [], "time": ["core"], "geo": ["core"], "flow": ["core", "time", "geo"]})
        self.assertEqual(districts, {"core": "base", "time": "base", "geo": "base", "flow": "world"})
        self.assertEqual(draw_architecture.rows_of(layers), [["core"], ["time", "geo"], ["flow"]])

    def test_each_folder_is_drawn_above_what_it_includes(self):
        layers, districts = draw_architecture.read_layers((ROOT / "tools/layers.txt").read_text(encoding="utf-8"))
        svg = xml.etree.ElementTree.fromstring(draw_architecture.picture(layers, districts))
        height = {node.text: float(node.get("y")) for node in svg.iter("{http://www.w3.org/2000/svg}text")
                  if node.text in layers and float(node.get("y")) > draw_architecture.TOP}
        self.assertEqual(set(height), set(layers))
        for folder, below in layers.items():
            for other in below:
                self.assertLess(height[folder], height[other], f"{folder} includes {other}")

    def test_another_layer_is_another_picture(self):
        draw = draw_architecture.picture
        self.assertNotEqual(draw(*draw_architecture.read_layers(LAYERS)),
                            draw(*draw_architecture.read_layers(LAYERS + "new : flow\n")))


if __name__ == "__main__":
    unittest.main()
