"""tools/check_layers.py must refuse each kind of bad tree, and take a good one."""

import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import check_layers  # noqa: E402

TABLE = """\
# comment
base     :
flow     : base
scene    : base
world    : base flow
firmware : base flow     !flow/truth !flow/all
host     : base flow world firmware
"""
GOOD = {
    "tools/layers.txt": TABLE,
    "include/skyloop/base/a.hpp": "#include <vector>\n#include <tl/expected.hpp>\n",
    "include/skyloop/flow/truth.hpp": '#include "skyloop/base/a.hpp"\n',
    "include/skyloop/flow/all.hpp": '#include "skyloop/flow/truth.hpp"\n',
    "include/skyloop/flow/fix.hpp": "#include <Eigen/Core>\n",
    "src/base/private.hpp": "",
    "src/base/a.cpp": '#include "skyloop/base/a.hpp"\n#include <zlib.h>\n#include <fmt/format.h>\n#include "private.hpp"\n',
    "firmware-host/firmware/receiver.hpp": '#include "skyloop/flow/fix.hpp"\n',
    "firmware-host/host/main.cpp": '#include "firmware/receiver.hpp"\n#include <CLI/CLI.hpp>\n#include <sys/stat.h>\n',
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

    def test_a_layer_that_the_row_does_not_name(self):
        self.expect("src/flow/x.cpp:2: flow may not include world",
                    {"src/flow/x.cpp": '\n#include "skyloop/world/w.hpp"\n', "include/skyloop/world/w.hpp": ""})

    def test_angle_brackets_are_no_way_round(self):
        self.expect("base may not include flow", {"src/base/x.cpp": "#include <skyloop/flow/fix.hpp>\n"})

    def test_the_truth_is_not_seen_directly(self):
        self.expect("firmware must not see flow/truth", {
            "firmware-host/firmware/x.cpp": '#include "skyloop/flow/truth.hpp"\n'})

    def test_the_truth_is_not_seen_through_another_header(self):
        self.expect("by include/skyloop/flow/peek.hpp > include/skyloop/flow/truth.hpp", {
            "include/skyloop/flow/peek.hpp": '#include "skyloop/flow/truth.hpp"\n',
            "firmware-host/firmware/x.cpp": '#include <vector>\n#include "skyloop/flow/peek.hpp"\n'})

    def test_every_way_to_the_unseen_is_told(self):
        errors = self.errors(files={"firmware-host/firmware/x.cpp": '#include "skyloop/flow/all.hpp"\n'})
        self.assertEqual(len(errors), 2)

    def test_fences(self):
        for include, place in (("GeographicLib/Geoid.hpp", "base"), ("toml++/toml.h", "flow"), ("CLI/CLI.hpp", "world"),
                               ("spdlog/spdlog.h", "base"), ("zlib.h", "flow"), ("nlohmann/json.hpp", "base"),
                               ("boost/beast.hpp", "base"), ("libusb-1.0/libusb.h", "world"), ("gtest/gtest.h", "base"),
                               ("termios.h", "flow"), ("embree4/rtcore.h", "world"), ("hidapi/hidapi.h", "world")):
            with self.subTest(include):
                self.expect(f"<{include}>", {f"src/{place}/x.cpp": f"#include <{include}>\n"})

    def test_a_fence_around_one_file(self):
        include = {"src/scene/other.cpp": "#include <embree3/rtcore.h>\n"}
        self.expect("only in src/scene/triangle_tree.cpp", include)
        self.assertEqual(self.errors(files={"src/scene/triangle_tree.cpp": "#include <embree3/rtcore.h>\n"}), [])

    def test_an_unknown_package(self):
        self.expect("of no package", {"src/base/x.cpp": "#include <curl/curl.h>\n"})
        self.expect("of no package", {"src/base/x.cpp": "#include <stdlib.h>\n"})

    def test_public_headers_show_little(self):
        self.expect("a public header shows only", {"include/skyloop/base/x.hpp": "#include <fmt/format.h>\n"})
        self.expect("a public header shows only", {"include/skyloop/base/x.hpp": "#include <zlib.h>\n"})

    def test_private_headers_stay_private(self):
        self.expect("no header of the project", {"src/flow/x.cpp": '#include "private.hpp"\n'})
        self.expect("no header of the project", {"src/flow/x.cpp": '#include "../base/private.hpp"\n'})

    def test_a_header_that_is_not_there(self):
        self.expect("no header of the project", {"src/flow/x.cpp": '#include "skyloop/flow/nowhere.hpp"\n'})

    def test_a_folder_without_a_row(self):
        self.expect("belongs to no row", {"src/other/x.cpp": ""})
        self.expect("belongs to no row", {"src/x.cpp": ""})

    def test_comments_are_not_includes_and_oddly_spelled_ones_are(self):
        self.assertEqual(self.errors(files={
            "src/base/x.cpp": '// #include <boost/a.hpp>\n/*\n#include <boost/b.hpp>\n*/\n'}), [])
        self.expect("x.cpp:2", {"src/base/x.cpp": '\n  #  include\t"skyloop/flow/fix.hpp" // why\n'})

    def test_the_table_itself(self):
        for row in ("base : flow\nflow : base\n", "base base\n", "base :\nbase :\n"):
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
