#!/usr/bin/env python3
"""make_changelog.py CHANGELOG.md VERSION MAINTAINER EPOCH: Debian's changelog (deb-changelog(5)) made from ours.

"Unreleased" is VERSION at EPOCH, seconds since 1970; a released section, "## 1.2.3 - 2027-01-31", has its own. The same
inputs give the same bytes."""
import datetime
import re
import sys
import textwrap

LINK = re.compile(r"\[([^\]]*)\]\([^)]*\)")


def plain(text):
    """Markdown without its links and code marks."""
    return LINK.sub(r"\1", text).replace("`", "").replace("\\|", "|")


def sections(markdown):
    """(heading, [(group, [entry])]) of each release, newest first."""
    found = []
    for line in markdown.splitlines():
        if line.startswith("## "):
            found.append((line[3:].strip(), []))
        elif not found:
            continue
        elif line.startswith("### "):
            found[-1][1].append((line[4:].strip(), []))
        elif line.startswith("- "):
            if not found[-1][1]:
                raise ValueError(f"'{line}' stands in no group; expected '### Added' or the like before it")
            found[-1][1][-1][1].append(line[2:].strip())
        elif line.startswith("  ") and line.strip() and found[-1][1] and found[-1][1][-1][1]:
            found[-1][1][-1][1][-1] += " " + line.strip()
    return found


def release(heading, version, epoch):
    """Version and date of a section."""
    if heading.lower().strip("[]") == "unreleased":
        return version, datetime.datetime.fromtimestamp(epoch, datetime.timezone.utc)
    named = re.fullmatch(r"\[?(\d+\.\d+\.\d+)\]? - (\d{4})-(\d\d)-(\d\d)", heading)
    if named is None:
        raise ValueError(f"'## {heading}': expected '## Unreleased' or '## 1.2.3 - 2027-01-31'")
    return named[1] + "-1", datetime.datetime(*map(int, named.groups()[1:]), 12, tzinfo=datetime.timezone.utc)


def debian(markdown, version, maintainer, epoch):
    """The whole changelog."""
    text = ""
    for heading, groups in sections(markdown):
        number, date = release(heading, version, epoch)
        text += f"{'' if not text else chr(10)}skyloop ({number}) unstable; urgency=medium\n"
        for group, entries in groups:
            text += f"\n  [ {group} ]\n"
            for entry in entries:
                text += textwrap.fill(plain(entry), 78, initial_indent="  * ", subsequent_indent="    ",
                                      break_long_words=False, break_on_hyphens=False) + "\n"
        # RFC 5322's names of days and months, whatever the locale is.
        day = ("Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun")[date.weekday()]
        month = "Jan Feb Mar Apr May Jun Jul Aug Sep Oct Nov Dec".split()[date.month - 1]
        text += f"\n -- {maintainer}  {day}, {date.day:02} {month} {date.year} {date:%H:%M:%S} +0000\n"
    if not text:
        raise ValueError("no section; expected '## Unreleased' or '## 1.2.3 - 2027-01-31'")
    return text


def main(arguments):
    if len(arguments) != 4 or not arguments[3].isdigit():
        print(f"usage: {__doc__.splitlines()[0].split(':')[0]}", file=sys.stderr)
        return 2
    path, version, maintainer, epoch = arguments
    try:
        with open(path, encoding="utf-8") as file:
            sys.stdout.buffer.write(debian(file.read(), version, maintainer, int(epoch)).encode())
    except (OSError, ValueError) as wrong:
        print(f"make_changelog: {path}: {wrong}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
