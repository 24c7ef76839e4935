"""Every block of code in README.md and docs is what it claims to be: commands run and say what is shown, scenarios pass
`skyloop check`, code is read by its compiler or parser. What needs hardware, a network or a program that is not here is
marked in the page and listed.

    command_blocks_test.py             the rules themselves, and that each page can be read
    command_blocks_test.py PAGE …      these pages, such as docs/failsafe.md
"""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "integration"))
from blocks import PageError, blocks_of, first_missing  # noqa: E402
from page_run import PageRun, report  # noqa: E402
from session import ROOT  # noqa: E402


def pages():
    """README.md and all pages of docs, as paths from the root."""
    return ["README.md", *sorted(str(path.relative_to(ROOT)) for path in (ROOT / "docs").rglob("*.md"))]


def page(*lines):
    return "\n".join(lines) + "\n"


class Rules(unittest.TestCase):
    def refused(self, text, why):
        with self.assertRaisesRegex(PageError, why):
            blocks_of("page.md", text)

    def test_a_page_that_breaks_a_rule_is_refused(self):
        self.refused(page("```", "x", "```"), "page.md:1 .*no language")
        self.refused(page("a", "```text", "x", "```"), r"page.md:2 .*not run: REASON")
        self.refused(page("```sh", "true"), "page.md:1: a fence that is not closed")
        self.refused(page("a:", "", "    skyloop run"), "page.md:3: a block without a fence: skyloop run")
        self.refused(page("<!-- not run -->", "```sh", "true", "```"), "page.md:1: no mark of a block")
        self.refused(page("<!-- notrun: x -->", "```sh", "true", "```"), "page.md:1: no mark of a block")
        self.refused(page("<!-- stays -->", "```toml", "```"), "only commands can stay")

    def test_blocks_and_marks(self):
        found = blocks_of("page.md", page("<!-- not run: no board -->", "<!-- file: a.txt -->", "```text", "  x", "```",
                                          "* item", "  ```sh", "  true", "  ```"))
        self.assertEqual([(b.line, b.tag, b.text) for b in found], [(3, "text", "  x\n"), (7, "sh", "true\n")])
        self.assertEqual(found[0].marks, [("not run", "no board"), ("file", "a.txt")])

    def test_shown_lines(self):
        said = "a 1\nprogress\nb x 2.50 m (7)\n"
        self.assertIsNone(first_missing(["a 1", "b … (7)", ""], said))
        self.assertEqual(first_missing(["a 2"], said), "a 2")
        self.assertEqual(first_missing(["b … (7)", "a 1"], said), "a 1")
        self.assertEqual(first_missing(["b x 2.51 m (7)"], said), "b x 2.51 m (7)")
        self.assertIsNone(first_missing(["b x -9 m (123)"], said, numbers_vary=True))
        self.assertEqual(first_missing(["b y 9 m (123)"], said, numbers_vary=True), "b y 9 m (123)")
        self.assertIsNone(first_missing(["valid x37 t -4"], "valid xea t 12.5", numbers_vary=True))


class Runs(unittest.TestCase):
    """Pages that are wrong are found to be so."""

    def wrong(self, why, *lines):
        with PageRun("page.md", page(*lines)) as done, self.assertRaisesRegex(AssertionError, why):
            done.run()

    def test_wrong_pages(self):
        self.wrong("`false` ended 1", "```console", "$ true", "$ false", "```")
        self.wrong("ended 3", "```sh", "exit 3", "true", "```")
        self.wrong("did not say", "```console", "$ echo 41", "42", "```")
        self.wrong("unknown key|not known|wrong_key", "```toml", "[run]", "wrong_key = 1", "```")
        self.wrong("error", "```c", "#include <skyloop.h>", "sky_no_such_function();", "```")
        self.wrong("expected skyloop", "```cmake", "find_package(skyloop 99.0 REQUIRED)", "```")
        self.wrong("ended 0 by itself", "<!-- stays -->", "```sh", "true", "```")

    def test_wrong_texts(self):
        for tag, text in (("python", "def"), ("json", "{"), ("xml", "<a>")):
            with PageRun("page.md", page(f"```{tag}", text, "```")) as done, self.assertRaises(Exception):
                done.run()

    def test_a_right_page(self):
        with PageRun("page.md", page("<!-- file: a.toml -->", "```toml", "[run]", "duration_s = 2", "```",
                                     "<!-- not run: needs a board -->", "```sh", "false", "```",
                                     "```console", "$ cat a.toml", "[run]", "$ echo /tmp/x", "/tmp/x", "```")) as done:
            done.run()
            self.assertEqual(done.counts, {"run": 1, "looked at": 1})
            self.assertEqual(done.left_out, ["page.md:7 [sh]: needs a board"])


class Pages(unittest.TestCase):
    def test_each_page_can_be_read(self):
        names = pages()
        self.assertGreater(len(names), 20)
        left_out = 0
        for name in names:
            with self.subTest(name):
                left_out += sum(block.has("not run") for block in blocks_of(name, (ROOT / name).read_text(encoding="utf-8")))
        print(f"{len(names)} pages, {left_out} blocks marked as not run")


def run_pages(names):
    """Runs these pages; gives the count of those that are wrong."""
    wrong = 0
    for name in names:
        try:
            with PageRun(name, (ROOT / name).read_text(encoding="utf-8")) as done:
                done.run()
                report(name, done)
        except Exception as error:  # Whatever it is, the next pages are read too, and the name stands before it.
            wrong += 1
            print(f"FAILED {name}: {type(error).__name__}: {error}")
    return wrong


if __name__ == "__main__":
    if sys.argv[1:] and not sys.argv[1].startswith("-"):
        sys.exit(1 if run_pages(sys.argv[1:]) else 0)
    unittest.main()
