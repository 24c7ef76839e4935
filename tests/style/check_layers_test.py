"""tools/check_layers.py must refuse each kind of bad tree, and take a good one."""

import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import check_layers  # noqa: E402

TABLE = """\
# comment
[base :]  # values
core     :
[world : base]
flow     : core
scene    : core
[motion : base]
tracks   : core
[firmware-host : base world]
firmware : core flow     !flow/truth !flow/all
[firmware-host : base world motion]
host     : core flow tracks firmware
"""
GOOD = {
    "tools/layers.txt": TABLE,
    "src/base/core/a.hpp": "#include <vector>\n#include <tl/expected.hpp>\n",
    "src/world/flow/truth.hpp": '#include "base/core/a.hpp"\n',
    "src/world/flow/all.hpp": '#include "world/flow/truth.hpp"\n',
    "src/world/flow/fix.hpp": "#include <Eigen/Core>\n",
    "src/base/core/detail/private.hpp": "",
    "src/base/core/a.cpp": '#include "base/core/a.hpp"\n#include <zlib.h>\n#include <fmt/format.h>\n#include "detail/private.hpp"\n',
    "firmware-host/firmware/core/receiver.hpp": '#include "world/flow/fix.hpp"\n',
    "firmware-host/host/main.cpp": '#include "firmware/core/receiver.hpp"\n#include <CLI/CLI.hpp>\n#include <sys/stat.h>\n',
}


class CheckLayers(unittest.TestCase):
    def errors(self, **changed):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for name, text in {**GOOD, **changed.pop("files", {})}.items():
                path = root / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            return [error.replace(folder, "") for error in check_layers.Checker(root).run()]

    def expect(self, part, files):
        errors = self.errors(files=files)
        self.assertEqual(len(errors), 1, errors)
        self.assertIn(part, errors[0])

    def test_a_good_tree_is_taken(self):
        self.assertEqual(self.errors(), [])

    def test_one_header_shows_json_to_sources_and_private_headers(self):
        header = {"src/base/core/json.hpp": "#include <nlohmann/json.hpp>\n"}
        include = '#include "base/core/json.hpp"\n'
        self.assertEqual(self.errors(files={**header, "src/world/flow/x.cpp": include, "src/world/flow/detail/x.hpp": include}), [])
        self.expect("a public header shows no JSON", {**header, "src/world/flow/x.hpp": include})

    def test_a_namespace_is_that_of_the_district_or_of_the_room_of_the_firmware(self):
        good = {"src/world/flow/x.cpp": "namespace skyloop::inline world {\nnamespace {\n}\n}\n",
                "src/world/flow/y.cpp": "namespace skyloop::inline world::rinex {\n}\n",
                "firmware-host/host/x.cpp": "namespace skyloop::host {\n}\n"}
        self.assertEqual(self.errors(files=good), [])
        for place, wrong, right in (("src/world/flow", "skyloop", "skyloop::inline world"),
                                    ("src/world/flow", "skyloop::inline worlds", "skyloop::inline world"),
                                    ("src/motion/tracks", "skyloop::inline world", "skyloop::inline motion"),
                                    ("firmware-host/firmware", "skyloop::host", "skyloop::firmware")):
            with self.subTest(wrong=wrong):
                self.expect(f"x.cpp:2: namespace {wrong}: expected {right}", {f"{place}/x.cpp": f"\nnamespace {wrong} {{\n}}\n"})

    def test_a_layer_that_the_row_does_not_name(self):
        self.expect("src/world/flow/x.cpp:2: flow may not include tracks",
                    {"src/world/flow/x.cpp": '\n#include "motion/tracks/w.hpp"\n', "src/motion/tracks/w.hpp": ""})

    def test_angle_brackets_are_no_way_round(self):
        self.expect("core may not include flow", {"src/base/core/x.cpp": "#include <world/flow/fix.hpp>\n"})

    def test_the_truth_is_not_seen_directly(self):
        self.expect("firmware must not see flow/truth", {
            "firmware-host/firmware/x.cpp": '#include "world/flow/truth.hpp"\n'})

    def test_the_truth_is_not_seen_through_another_header(self):
        self.expect("by src/world/flow/peek.hpp > src/world/flow/truth.hpp", {
            "src/world/flow/peek.hpp": '#include "world/flow/truth.hpp"\n',
            "firmware-host/firmware/x.cpp": '#include <vector>\n#include "world/flow/peek.hpp"\n'})

    def test_every_way_to_the_unseen_is_told(self):
        errors = self.errors(files={"firmware-host/firmware/x.cpp": '#include "world/flow/all.hpp"\n'})
        self.assertEqual(len(errors), 2)

    def test_fences(self):
        for include, place in (("GeographicLib/Geoid.hpp", "base/core"), ("toml++/toml.h", "world/flow"), ("CLI/CLI.hpp", "motion/tracks"),
                               ("archive.h", "world/flow"), ("zlib.h", "world/flow"), ("nlohmann/json.hpp", "base/core"),
                               ("boost/beast.hpp", "base/core"), ("libusb-1.0/libusb.h", "world/flow"), ("gtest/gtest.h", "base/core"),
                               ("termios.h", "world/flow"), ("embree4/rtcore.h", "world/flow"), ("hidapi/hidapi.h", "world/flow")):
            with self.subTest(include):
                self.expect(f"<{include}>", {f"src/{place}/x.cpp": f"#include <{include}>\n"})

    def test_a_fence_around_one_file(self):
        include = {"src/world/scene/other.cpp": "#include <embree3/rtcore.h>\n"}
        self.expect("only in src/world/scene/triangle_tree.cpp", include)
        self.assertEqual(self.errors(files={"src/world/scene/triangle_tree.cpp": "#include <embree3/rtcore.h>\n"}), [])

    def test_an_unknown_package(self):
        self.expect("of no package", {"src/base/core/x.cpp": "#include <gdal/gdal.h>\n"})
        self.expect("of no package", {"src/base/core/x.cpp": "#include <stdlib.h>\n"})

    def test_public_headers_show_little(self):
        self.expect("a public header shows only", {"src/base/core/x.hpp": "#include <fmt/format.h>\n"})
        self.expect("a public header shows only", {"src/base/core/x.hpp": "#include <zlib.h>\n"})

    def test_private_headers_stay_private(self):
        self.expect("no header of the project", {"src/world/flow/x.cpp": '#include "private.hpp"\n'})
        self.expect("no header of the project", {"src/world/flow/x.cpp": '#include "../base/private.hpp"\n'})
        self.expect("is private to core", {"src/world/flow/x.cpp": '#include "base/core/detail/private.hpp"\n'})

    def test_a_header_that_is_not_there(self):
        self.expect("no header of the project", {"src/world/flow/x.cpp": '#include "world/flow/nowhere.hpp"\n'})

    def test_a_folder_without_a_row(self):
        for place in ("src/base/other", "src/other", "src", "src/world/core"):
            self.expect("belongs to no row", {f"{place}/x.cpp": ""})

    def test_comments_are_not_includes_and_oddly_spelled_ones_are(self):
        self.assertEqual(self.errors(files={
            "src/base/core/x.cpp": '// #include <boost/a.hpp>\n/*\n#include <boost/b.hpp>\n*/\n'}), [])
        self.expect("x.cpp:2", {"src/base/core/x.cpp": '\n  #  include\t"world/flow/fix.hpp" // why\n'})

    def test_the_table_itself(self):
        for row in ("[a :]\nbase : flow\nflow : base\n", "[a :]\nbase base\n", "[a :]\nbase :\nbase :\n", "base :\n", "[a : b]\n",
                    "[a :]\nx :\n[b :]\ny : x\n"):
            with self.subTest(row):
                with tempfile.TemporaryDirectory() as folder:
                    path = Path(folder) / "layers.txt"
                    path.write_text(row)
                    self.assertEqual(len(check_layers.read_rows(path)[1]), 1)

    def test_an_empty_tree_is_not_good(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "tools").mkdir()
            (Path(folder) / "tools/layers.txt").write_text(TABLE)
            self.assertEqual(check_layers.main(["", folder]), 1)


if __name__ == "__main__":
    unittest.main()
