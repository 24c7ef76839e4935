"""Manual pages, completions and the page of options are what the commands declare, and man, bash and zsh understand them."""
import os
import pathlib
import re
import select
import shutil
import subprocess
import tempfile
import time
import unittest

from session import ROOT, SKYLOOP
from session import skyloop as run_to_end

HIDDEN = {"help-pages"}


def commands():
    """The commands that `skyloop --help` lists."""
    shown = run_to_end("--help").stdout.split("Subcommands:")[1]
    return re.findall(r"^  ([a-z-]+) ", shown, re.MULTILINE)


def options(command):
    """The options that `skyloop COMMAND --help` lists."""
    return set(re.findall(r"^  (?:-\w,)?(--[a-z0-9-]+)", run_to_end(*command.split(), "--help").stdout, re.MULTILINE))


def subcommands():
    """What stands behind a command, such as `campaign plan`, as `skyloop COMMAND --help` lists it."""
    found = []
    for command in commands():
        behind = run_to_end(command, "--help").stdout.split("Subcommands:")[1:]
        found += [f"{command} {name}" for name in re.findall(r"^  ([a-z-]+) ", "".join(behind), re.MULTILINE)]
    return found


def need(program):
    if shutil.which(program) is None:
        raise unittest.SkipTest(f"skipped: {program} is not installed")


class ManualPages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="skyloop-pages-")
        cls.addClassCleanup(cls.folder.cleanup)
        cls.man = pathlib.Path(cls.folder.name) / "man"
        run_to_end("help-pages", "--format", "man", "--out", cls.man)

    def test_each_command_has_a_page_with_all_its_options(self):
        self.assertGreater(len(commands()), 15)
        for command in commands():
            with self.subTest(command):
                page = (self.man / f"skyloop-{command}.1").read_text().replace("\\-", "-")
                for option in options(command):
                    self.assertIn(f"\\fB{option}\\fR", page)
        self.assertEqual({path.stem.removeprefix("skyloop-") for path in self.man.iterdir()}, set(commands()) | HIDDEN)

    def test_a_page_lists_its_subcommands_with_all_their_options(self):
        self.assertEqual(set(subcommands()), {f"campaign {name}" for name in ("plan", "replay", "gather", "report")})
        for name in subcommands():
            page = (self.man / f"skyloop-{name.split()[0]}.1").read_text().replace("\\-", "-")
            section = page.split(f".SS \\fBskyloop {name}\\fR")[1].split(".SS")[0]
            for option in options(name):
                with self.subTest(name, option=option):
                    self.assertIn(f"\\fB{option}\\fR", section)

    def test_a_synopsis_has_the_subcommands(self):
        for name in subcommands():
            page = (self.man / f"skyloop-{name.split()[0]}.1").read_text()
            synopsis = page.split(".SH SYNOPSIS")[1].split(".SH")[0]
            self.assertIn(f".br\n\\fBskyloop {name}\\fR ", synopsis, name)

    def test_groff_has_nothing_to_say(self):
        need("groff")
        for page in [*sorted(self.man.iterdir()), *sorted((ROOT / "tools/man").glob("*.1"))]:
            with self.subTest(page.name):
                done = subprocess.run(["groff", "-ww", "-man", "-Tutf8", "-z", page], capture_output=True, timeout=60)
                self.assertEqual((done.returncode, done.stderr), (0, b""))

    def test_man_shows_the_name_and_every_word_of_a_meaning(self):
        need("man")
        done = subprocess.run(["man", "--warnings", "-l", self.man / "skyloop-run.1"], capture_output=True, timeout=60,
                              env={**os.environ, "MANWIDTH": "200", "LC_ALL": "C.UTF-8", "MANPAGER": "cat"})
        self.assertEqual(done.stderr, b"")
        text = re.sub(r".\x08", "", done.stdout.decode())
        self.assertIn("skyloop-run - Stream in real time until stopped", text)
        self.assertIn("--at LAT,LON[,HEIGHT]", text)
        self.assertIn(".csv, .gpx, …", text)

    def test_needs_a_folder(self):
        done = run_to_end("help-pages", "--format", "man", check=False)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1))
        self.assertIn("--out DIR", done.stderr)

    def test_says_what_cannot_be_written(self):
        for arguments in (("man", "/dev/null/pages"), ("bash", "/dev/null/x")):
            done = run_to_end("help-pages", "--format", arguments[0], "--out", arguments[1], check=False)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)
            self.assertIn("/dev/null/", done.stderr)


class ReferencePage(unittest.TestCase):
    def test_is_what_the_program_tells(self):
        self.assertEqual(run_to_end("help-pages").stdout, (ROOT / "docs/commands.md").read_text(),
                         "docs/commands.md is old: skyloop help-pages --format markdown > docs/commands.md")

    def test_has_the_subcommands(self):
        page = run_to_end("help-pages").stdout
        for name in subcommands():
            section = page.split(f"## skyloop {name}\n")[1].split("\n## ")[0]
            for option in options(name) - {"--help"}:
                self.assertIn(f"`{option}", section, name)


class Rules(unittest.TestCase):
    def test_what_is_known_of_values_is_of_options_that_exist(self):
        source = (ROOT / "firmware-host/host/option_table.cpp").read_text()
        rules = re.findall(r'^        \{"([^"]+)", "([^"]*)", "', source, re.MULTILINE)
        self.assertGreater(len(rules), 30)
        told = {command: run_to_end(*command.split(), "--help").stdout for command in commands() + subcommands()}
        for option, command in rules:
            with self.subTest(option=option, command=command):
                listed = re.compile(rf"^  (?:-\w,)?{re.escape(option)} ", re.MULTILINE)
                self.assertTrue(any(listed.search(told[name]) for name in ([command] if command else told)))


class Bash(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        need("bash")
        cls.folder = tempfile.TemporaryDirectory(prefix="skyloop-shell-")
        cls.addClassCleanup(cls.folder.cleanup)
        cls.place = pathlib.Path(cls.folder.name)
        run_to_end("help-pages", "--format", "bash", "--out", cls.place / "completion")
        for name in ("flight.toml", "two words.toml"):
            (cls.place / name).touch()
        (cls.place / "sub").mkdir()

    def complete(self, line, breaks=None):
        """What bash would offer for `line`, whose cursor is at its end."""
        script = 'source ./completion; COMP_LINE=$1 COMP_POINT=${#1}; COMPREPLY=(); '
        if breaks is not None:
            script += f"COMP_WORDBREAKS='{breaks}'; "
        script += '_skyloop 2>&1; printf "%s\\n" "${COMPREPLY[@]}"'
        done = subprocess.run(["bash", "-c", script, "bash", line], cwd=self.place, capture_output=True, text=True, timeout=60,
                              env={**os.environ, "PATH": f"{pathlib.Path(SKYLOOP).parent}:{os.environ['PATH']}"})
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return [word for word in done.stdout.split("\n") if word]

    def test_is_bash_and_clean(self):
        script = self.place / "completion"
        subprocess.run(["bash", "-n", script], check=True, timeout=60)
        if shutil.which("shellcheck"):
            done = subprocess.run(["shellcheck", "--shell=bash", script], capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, 0, done.stdout)

    def test_commands(self):
        self.assertEqual(self.complete("skyloop sch"), ["schema"])
        self.assertEqual(set(self.complete("skyloop ")), set(commands()) | {"--help", "--version"})

    def test_options_of_each_command(self):
        for command in commands() + subcommands():
            with self.subTest(command):
                self.assertEqual(set(self.complete(f"skyloop {command} --")), options(command))

    def test_words_of_an_enumeration(self):
        self.assertEqual(self.complete("skyloop schema --format "), ["json", "markdown"])
        self.assertEqual(self.complete("skyloop schema --format=ma"), ["markdown"])
        self.assertEqual(self.complete("skyloop schema --format=ma", breaks=" "), ["--format=markdown"])
        self.assertIn("baseline", self.complete("skyloop run --model "))
        self.assertEqual(self.complete("skyloop power relay:1:2/1 o"), ["on", "off"])

    def test_boards_and_faults(self):
        self.assertEqual(self.complete("skyloop run --board ublox-f1"), ["ublox-f10"])
        self.assertEqual(set(self.complete("skyloop run --board NEO-M8")), {"NEO-M8N", "NEO-M8P", "NEO-M8P-2", "NEO-M8Q"})
        self.assertIn("jamming", self.complete("skyloop faults ja"))
        self.assertEqual(self.complete("skyloop boards sept"), ["septentrio-sbf"])

    def test_files_and_folders(self):
        self.assertEqual(self.complete("skyloop run fl"), ["flight.toml"])
        self.assertEqual(self.complete("skyloop check --quiet tw"), ["two words.toml"])
        for begun in (r"two\ ", r"two\ w", "'two w", '"two w', "--quiet 'two w"):
            self.assertEqual(self.complete(f"skyloop check {begun}"), ["two words.toml"], begun)
        self.assertEqual(self.complete(r"skyloop check two\ words.toml --mod"), ["--model"])
        self.assertEqual(self.complete("skyloop simulate --out s"), ["sub"])
        self.assertEqual(self.complete("skyloop run --scene de"), ["demo"])
        self.assertEqual(self.complete("skyloop run --at fl"), [])

    def test_subcommands(self):
        self.assertEqual(self.complete("skyloop campaign re"), ["replay", "report"])
        self.assertEqual(self.complete("skyloop campaign plan fl"), ["flight.toml"])
        self.assertEqual(self.complete("skyloop campaign report s"), ["sub"])
        self.assertEqual(self.complete("skyloop campaign report sub --out fl"), ["flight.toml"])
        self.assertEqual(self.complete("skyloop campaign replay flight.toml --nu"), ["--number"])

    def test_ports(self):
        self.assertEqual(self.complete("skyloop run --port se"), ["serial:"])
        self.assertEqual(self.complete("skyloop run --port uart2=pt"), ["pty", "pty:"])
        self.assertEqual(self.complete("skyloop run --port file:fl"), ["flight.toml"])
        self.assertEqual(self.complete("skyloop run --port uart2=file:fl", breaks=" "), ["uart2=file:flight.toml"])
        self.assertIn("json-udp:", self.complete("skyloop run --output "))
        # The program itself says which there are.
        refused = run_to_end("check", "--port", "nonsense:1", check=False).stderr
        schemes = set(re.findall(r"([a-z0-9-]+)(?::|\[:)[A-Z\[]", refused.split("expected")[-1]))
        self.assertGreater(len(schemes), 7)
        self.assertEqual({word.rstrip(":") for word in self.complete("skyloop run --port ")}, schemes)

    def test_what_is_no_command_offers_files_alone(self):
        self.assertEqual(self.complete("skyloop nonsense --"), [])


class Zsh(unittest.TestCase):
    """In a real zsh at a terminal: what the tab key makes of a line."""

    @classmethod
    def setUpClass(cls):
        need("zsh")
        cls.folder = tempfile.TemporaryDirectory(prefix="skyloop-shell-")
        cls.addClassCleanup(cls.folder.cleanup)
        cls.place = pathlib.Path(cls.folder.name)
        run_to_end("help-pages", "--format", "zsh", "--out", cls.place / "_skyloop")
        (cls.place / "flight.toml").touch()

    def setUp(self):
        import pty
        self.pid, self.terminal = pty.fork()
        if self.pid == 0:
            os.chdir(self.place)
            os.environ.update(TERM="dumb", LC_ALL="C.UTF-8", HOME=str(self.place),
                              PATH=f"{pathlib.Path(SKYLOOP).parent}:{os.environ['PATH']}")
            os.execvp("zsh", ["zsh", "-f", "-i"])
        self.addCleanup(self.end)
        self.seen = ""
        self.send("PS1='READY> '; unsetopt prompt_sp; unset zle_bracketed_paste; fpath=($PWD $fpath); autoload -U compinit; compinit -D -u\n")
        self.until("\nREADY> ")

    def end(self):
        os.close(self.terminal)
        os.kill(self.pid, 9)
        os.waitpid(self.pid, 0)

    def send(self, text):
        os.write(self.terminal, text.encode())

    def until(self, wanted, patience=30):
        deadline = time.monotonic() + patience
        while wanted not in self.seen.replace("\r", "\n"):
            left = deadline - time.monotonic()
            if left <= 0 or not select.select([self.terminal], [], [], left)[0]:
                self.fail(f"no {wanted!r} in {self.seen!r}")
            self.seen += os.read(self.terminal, 65536).decode(errors="replace")

    def becomes(self, typed, line):
        """Types, presses tab, and has zsh print the line that is there."""
        self.seen = ""
        # ^A begins the line, so that print shows what stands behind it.
        self.send(f"{typed}\t\x01print -r -- '\x05'\n")
        self.until(f"\n{line}")

    def test_is_zsh(self):
        subprocess.run(["zsh", "-n", self.place / "_skyloop"], check=True, timeout=60)

    def test_commands(self):
        self.becomes("skyloop sch", "skyloop schema\n")

    def test_options_and_their_words(self):
        self.becomes("skyloop run --rebas", "skyloop run --rebase-nav\n")
        self.becomes("skyloop schema --format mark", "skyloop schema --format markdown\n")
        self.becomes("skyloop run --model whole", "skyloop run --model whole-path\n")
        self.becomes("skyloop run --model=whole", "skyloop run --model=whole-path\n")
        self.becomes("skyloop run --board=ublox-f1", "skyloop run --board=ublox-f10\n")

    def test_subcommands(self):
        self.becomes("skyloop campaign gath", "skyloop campaign gather\n")
        self.becomes("skyloop campaign replay flight.toml --numb", "skyloop campaign replay flight.toml --number\n")
        self.becomes("skyloop campaign plan fli", "skyloop campaign plan flight.toml\n")
        self.becomes("skyloop campaign report --wor", "skyloop campaign report --worst\n")

    def test_boards_faults_files_and_ports(self):
        self.becomes("skyloop run --board ublox-f1", "skyloop run --board ublox-f10\n")
        self.becomes("skyloop run --board ZED-X", "skyloop run --board ZED-X20P\n")
        self.becomes("skyloop faults jammi", "skyloop faults jamming\n")
        self.becomes("skyloop check fli", "skyloop check flight.toml\n")
        self.becomes("skyloop run --port ser", "skyloop run --port serial:\n")
        self.becomes("skyloop run --port uart2=file:fl", "skyloop run --port uart2=file:flight.toml\n")


if __name__ == "__main__":
    unittest.main()
