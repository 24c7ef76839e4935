"""tools/check_sizes.py must refuse what is too long, too wide, unfinished or badly named, and nothing else."""

import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import check_sizes  # noqa: E402
import source_tree  # noqa: E402


def body(lines):
    return "    x();\n" * lines


class Files(unittest.TestCase):
    def errors(self, name, text):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
            return check_sizes.Checker(Path(folder)).run()

    def expect(self, part, name, text):
        errors = self.errors(name, text)
        self.assertEqual(len(errors), 1, errors)
        self.assertIn(part, errors[0])

    def test_lengths_of_files(self):
        self.assertEqual(self.errors("src/base/a.cpp", "\n" * 400), [])
        self.expect("401 lines, at most 400", "src/base/a.cpp", "\n" * 401)
        self.assertEqual(self.errors("src/gnss/slot_table.cpp", "\n" * 600), [])
        self.expect("601 lines, at most 600", "src/gnss/slot_table.cpp", "\n" * 601)
        self.assertEqual(self.errors("tests/unit/base/a_test.cpp", "\n" * 600), [])
        self.expect("at most 400", "tools/check.py", "\n" * 401)
        self.expect("at most 400", "tools/start", "\n" * 401)
        self.assertEqual(self.errors("README.md", "\n" * 2000), [])

    def test_unfinished_marks(self):
        for mark in ("TO" + "DO", "FIX" + "ME", "HA" + "CK"):
            self.expect("src/base/a.cpp:2: an unfinished mark", "src/base/a.cpp", f"\n// {mark}: later\n")
            self.expect("unfinished", "tools/x.py", f"# {mark}\n")
        self.assertEqual(self.errors("src/base/a.cpp", "// mastodons and hacksaws\n"), [])

    def test_names_that_say_nothing(self):
        for name in ("util.hpp", "string_utils.cpp", "helpers.py", "test_helper.cpp", "common.cmake", "misc.md",
                     "link_manager.cpp"):
            self.expect("a file's name says what is in it", f"src/base/{name}", "")
        for name in ("commonality.hpp", "utilisation.cpp", "permission.cpp"):
            self.assertEqual(self.errors(f"src/base/{name}", ""), [])

    def test_long_functions(self):
        self.assertEqual(self.errors("src/base/a.cpp", f"void f() {{\n{body(40)}}}\n"), [])
        self.expect("src/base/a.cpp:1: f has 41 lines", "src/base/a.cpp", f"void f() {{\n{body(41)}}}\n")
        self.assertEqual(self.errors("tests/a.cpp", f"TEST(A, B) {{\n{body(80)}}}\n"), [])

    def test_wide_parameter_lists(self):
        self.assertEqual(self.errors("src/base/a.hpp", "void f(int a, int b, int c, int d, int e);\n"), [])
        self.expect("f has 6 parameters", "src/base/a.hpp", "void f(int a, int b, int c, int d, int e, int g);\n")


class Functions(unittest.TestCase):
    def found(self, text):
        return [(f.name, f.lines, f.parameters) for f in check_sizes.functions(source_tree.bare_code(text))]

    def test_inside_namespaces_and_classes(self):
        self.assertEqual(self.found("""
namespace a { namespace {
class B final : public C {
public:
    explicit B(int x) : x_(x) {}
    int y() const { return x_; }
    virtual void z() = 0;
    ~B() override = default;
private:
    int x_{4};
    std::vector<int> v_ = {1, 2};
};
} }
"""), [("B", -1, 1), ("y", -1, 0), ("z", None, 0), ("~B", None, 0)])

    def test_initialisers_in_braces(self):
        self.assertEqual(self.found("B::B(int x) : a_{x}, b_{f(x)} {\n one();\n}\nB::B() noexcept : a_{} {\n}\n"),
                         [("B", 1, 1), ("B", 0, 0)])

    def test_templates_count_as_one_parameter(self):
        self.assertEqual(self.found("std::map<int, int> f(std::map<int, std::pair<int, int>> a = {{1, {2, 3}}}, int b) {\n}\n"),
                         [("f", 0, 2)])

    def test_braces_that_are_not_code(self):
        self.assertEqual(self.found("""
#define OPEN {
void f() {  // {
    const char* a = "{"; char b = '{'; auto c = R"x({ " )x";  /* { */
    const int million = 1'000'000;
}
void g() {
}
"""), [("f", 2, 0), ("g", 0, 0)])

    def test_tables_and_lambdas_are_no_functions_of_their_own(self):
        self.assertEqual(self.found("const std::map<int, int> table = {\n {1, f(2)},\n};\nvoid f() {\n auto g = [](int) {\n };\n}\n"),
                         [("f", 2, 0)])

    def test_operators(self):
        self.assertEqual(self.found("bool operator==(const A& a, const A& b) {\n return true;\n}\n"), [("operator==", 1, 2)])


if __name__ == "__main__":
    unittest.main()
