"""The fenced blocks of a Markdown page, with the marks that stand above them as comments."""
import dataclasses
import re

FENCE = re.compile(r"^(\s*)(`{3,})\s*(\S*)\s*$")
MARK = re.compile(r"^\s*<!-- ([a-z ]+?)(?:: (.+?))? -->\s*$")
COMMENT = re.compile(r"^\s*<!-- .* -->\s*$")
RUN = {"sh", "console"}
LOOKED_AT = {"toml", "python", "json", "xml", "yaml", "c", "cmake"}
# What a mark says: `not run: REASON`; `file: NAME` (the block is this file); `given: NAME = PATH` (a file of the repository
# under another name, or the block of that name in another page); `needs: PROGRAM` (left out where it is not installed);
# `before: COMMAND` (what a reader has done already); `stays` (it runs on while the rest of the page is
# read; `stays: beside` together with what runs already); `numbers vary` (the output has the same words, not the same
# numbers); `refused` (a scenario that `skyloop check` has to refuse); `context: CODE` (declarations around a piece of C).
MARKS = {"not run": True, "file": True, "given": True, "needs": True, "before": True, "stays": None,
         "numbers vary": False, "refused": False, "context": True}


class PageError(Exception):
    """A page breaks a rule of blocks; the text names page and line."""


@dataclasses.dataclass
class Block:
    """One fenced block: where it begins, its language, its text, its marks."""
    page: str
    line: int
    tag: str
    text: str
    marks: list

    def __str__(self):
        return f"{self.page}:{self.line} [{self.tag}]"

    def all(self, name):
        """What each mark of this name says."""
        return [value for mark, value in self.marks if mark == name]

    def has(self, name):
        return any(mark == name for mark, _ in self.marks)


def marks_above(page, lines, index):
    """The marks in the lines directly above line `index`, from top to bottom."""
    marks = []
    while index > 0 and COMMENT.match(lines[index - 1]):
        index -= 1
        found = MARK.match(lines[index])
        name, value = found.groups() if found else (None, None)
        if name not in MARKS or MARKS[name] not in (None, value is not None):
            raise PageError(f"{page}:{index + 1}: no mark of a block: {lines[index].strip()}; expected one of {sorted(MARKS)}")
        marks.insert(0, (name, value))
    return marks


def check_rules(block):
    if not block.tag:
        raise PageError(f"{block}: no language behind the fence")
    if block.tag not in RUN | LOOKED_AT and not block.has("not run") and not block.has("file"):
        raise PageError(f"{block}: nobody can tell whether this is right; mark it <!-- not run: REASON -->, or make it "
                        f"one of {sorted(RUN | LOOKED_AT)}")
    if block.has("stays") and block.tag not in RUN:
        raise PageError(f"{block}: only commands can stay")


def blocks_of(page, text):
    """The blocks of a page in their order. PageError: a rule is broken."""
    lines, blocks, index, before = text.splitlines(), [], 0, ""
    while index < len(lines):
        opened = FENCE.match(lines[index])
        if not opened:
            if re.match(r"^(    |\t)\S", lines[index]) and not before.strip():
                raise PageError(f"{page}:{index + 1}: a block without a fence: {lines[index].strip()}")
            before = "" if re.match(r"^(    |\t)\S", lines[index]) and not before.strip() else lines[index]
            index += 1
            continue
        end = next((i for i in range(index + 1, len(lines)) if lines[i].strip() == opened.group(2)), None)
        if end is None:
            raise PageError(f"{page}:{index + 1}: a fence that is not closed")
        indent = len(opened.group(1))
        body = "".join(line[indent:] + "\n" for line in lines[index + 1:end])
        blocks.append(Block(page, index + 1, opened.group(3), body, marks_above(page, lines, index)))
        check_rules(blocks[-1])
        index, before = end + 1, "```"
    return blocks


def steps_of(block):
    """Commands of a console block with the lines shown behind each. PageError: it does not begin with a prompt."""
    steps = []
    for line in block.text.splitlines():
        if line.startswith("$ "):
            steps.append((line[2:], []))
        elif steps and steps[-1][0].endswith("\\") and not steps[-1][1]:
            steps[-1] = (steps[-1][0] + "\n" + line, [])
        elif steps:
            steps[-1][1].append(line.rstrip())
        else:
            raise PageError(f"{block}: a console block begins with `$ `, found: {line}")
    return steps


def pattern_of(line, numbers_vary):
    """A shown line as an expression: `…` stands for anything, a number for any when numbers vary."""
    def piece(text):
        if not numbers_vary:
            return re.escape(text)
        words = re.split(r"(\bx[0-9a-f]+\b|-?(?<![\w.])\d+(?:\.\d+)?)", text)
        return "".join(re.escape(word) if i % 2 == 0 else "x[0-9a-f]+" if word[0] == "x" else r"-?\d+(?:\.\d+)?"
                       for i, word in enumerate(words))

    pattern = ".*".join(piece(text) for text in re.split(r"\s*…\s*", line))
    return re.compile(rf"\s*{pattern}\s*")


def first_missing(shown, said, numbers_vary=False):
    """The first of the shown lines that was not said after those before it; None when all were."""
    rest = iter(said.splitlines())
    for line in shown:
        if line.strip() in ("", "…"):
            continue
        pattern = pattern_of(line.strip(), numbers_vary)
        if not any(pattern.fullmatch(candidate) for candidate in rest):
            return line
    return None
