"""Links of the pages lead somewhere: files exist, headings too, the index of docs names every page, and the faults that
tutorials name are there."""
import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)|(?:src|href)=\"([^\"]+)\"")
FENCED = re.compile(r"^ *```.*?^ *```", re.MULTILINE | re.DOTALL)


def pages():
    """The pages that people read, from the root and docs."""
    return sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), ROOT / "boards/README.md"])


def anchors(text):
    """The anchors that a page's headings have on a forge: small letters, spaces as hyphens, no other signs."""
    found = set()
    for heading in re.findall(r"^#+ (.*?)\s*$", FENCED.sub("", text), re.MULTILINE):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "")
        anchor = re.sub(r"[^\w\- ]", "", words.lower()).replace(" ", "-")
        number = sum(other == anchor or re.fullmatch(rf"{re.escape(anchor)}-\d+", other) is not None for other in found)
        found.add(f"{anchor}-{number}" if number else anchor)
    return found


def dead_links(path, text):
    """Links of a page whose file or heading is not there."""
    dead = []
    for plain, html in LINK.findall(FENCED.sub("", text)):
        target = plain or html
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        file = (path.parent / name).resolve() if name else path
        if not file.exists():
            dead.append(f"{target}: no such file")
        elif anchor and file.suffix == ".md" and anchor not in anchors(file.read_text(encoding="utf-8")):
            dead.append(f"{target}: no such heading")
    return dead


def fault_cells(text):
    """Cells of the columns headed `fault` of a page's tables."""
    cells, column = [], None
    for line in text.splitlines():
        row = [cell.strip() for cell in line.strip("|").split("|")] if line.startswith("|") else []
        if not row:
            column = None
        elif column is None:
            column = row.index("fault") if "fault" in row else -1
        elif column >= 0:
            cells.append(row[column])
    return cells


class Faults(unittest.TestCase):
    def test_cells(self):
        self.assertEqual(fault_cells("| a | fault |\n|---|---|\n| `x` | `y` |\n\n| a |\n| `z` |\n"), ["---", "`y`"])

    def test_faults_that_tutorials_name_exist(self):
        known = set(re.findall(r"^### (\w+)|^\| `(\w+)` \|", (ROOT / "docs/faults.md").read_text(encoding="utf-8"), re.MULTILINE))
        known = {name for pair in known for name in pair if name}
        named = {name for page in (ROOT / "docs/tutorials").glob("*.md")
                 for cell in fault_cells(page.read_text(encoding="utf-8")) for name in re.findall(r"`(\w+)", cell)}
        self.assertGreater(len(named), 10)
        self.assertEqual(sorted(named - known), [])


class Links(unittest.TestCase):
    def test_dead_ones_are_found(self):
        text = "[x](../README.md) [y](../README.md#a-b) [z](nothing.md) [w](https://host/x)\n```\n[q](gone.md)\n```\n"
        self.assertEqual(dead_links(ROOT / "docs/none.md", text),
                         ["../README.md#a-b: no such heading", "nothing.md: no such file"])
        self.assertEqual(anchors("# A `b` (c)\n## A b c\n```\n# no\n```\n"), {"a-b-c", "a-b-c-1"})

    def test_links_lead_somewhere(self):
        dead = [f"{page.relative_to(ROOT)}: {link}" for page in pages()
                for link in dead_links(page, page.read_text(encoding="utf-8"))]
        self.assertGreater(len(pages()), 25)
        self.assertEqual(dead, [])

    def test_the_index_names_every_page(self):
        index = (ROOT / "docs/README.md").read_text(encoding="utf-8")
        named = {(ROOT / "docs" / link.partition("#")[0]).resolve() for link, _ in LINK.findall(index)}
        missing = [str(page.relative_to(ROOT)) for page in sorted((ROOT / "docs").rglob("*.md"))
                   if page.name != "README.md" and page not in named]
        self.assertEqual(missing, [], "pages that docs/README.md does not name")


if __name__ == "__main__":
    unittest.main()
