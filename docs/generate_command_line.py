"""Write `docs/reference/command-line.md` and `docs/calm.1`, the manual page, from the help.

python docs/generate_command_line.py            # write them
python docs/generate_command_line.py --check    # exit 1 if one is out of date
"""

import contextlib
import io
import os
import sys
from collections.abc import Iterator
from pathlib import Path

from cyclopts import App

from calm.cli.main import app, main
from calm.version import __version__

PAGE = Path(__file__).parent / "reference" / "command-line.md"
MAN = Path(__file__).with_name("calm.1")
HEAD = """# The command line

Printed by `python docs/generate_command_line.py`; do not edit.

Results go to standard output, messages to standard error.
"""


def commands(parent: App, words: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """The words of every command, a group before its members; of several names the first."""
    yield words
    named = {id(parent[name]): name for name in reversed([*parent]) if not name.startswith("-")}
    for name in parent:
        if name in named.values() and parent[name].show:
            yield from commands(parent[name], (*words, name))


def help_of(words: tuple[str, ...]) -> str:
    """Output of `calm WORDS --help` on a page of 80 columns."""
    os.environ.update(COLUMNS="80", NO_COLOR="1", TERM="dumb")
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        main([*words, "--help"])
    return "\n".join(line.rstrip() for line in printed.getvalue().strip("\n").splitlines())


def page() -> str:
    """The text of the page."""
    sections = [
        f"## {' '.join(('calm', *words))}\n\n```text\n{help_of(words)}\n```\n"
        for words in commands(app)
    ]
    return "\n".join([HEAD, *sections])


def manual() -> str:
    """The text of the manual page, in the macros of man."""
    parts = [
        f'.TH CALM 1 "" "calm {__version__}" "User Commands"',
        ".SH NAME",
        "calm \\- statics of oceanographic moorings and tows",
        ".SH SYNOPSIS",
        ".B calm",
        ".I COMMAND",
        "[\\fIOPTIONS\\fR] [\\fIFILE\\fR...]",
    ]
    for words in commands(app):
        parts += [f".SH {' '.join(('calm', *words)).upper()}", ".nf", roff(help_of(words)), ".fi"]
    parts += [
        ".SH SEE ALSO",
        "\\fBcalm docs\\fR prints where the manual is on this machine; "
        "\\fBcalm docs \\-\\-open\\fR shows it in a browser.",
    ]
    return "\n".join(parts) + "\n"


def roff(text: str) -> str:
    """Escape text for man: no frames, hyphens as typed, no line read as a request."""
    lines = (line.strip("│╭╮╰╯─").rstrip() for line in text.splitlines())
    escaped = (line.replace("\\", "\\e").replace("-", "\\-") for line in lines)
    return "\n".join(f"\\&{line}" if line[:1] in (".", "'") else line for line in escaped)


if __name__ == "__main__":
    files = {PAGE: page(), MAN: manual()}
    if sys.argv[1:] == ["--check"]:
        for path, text in files.items():
            if not path.exists() or path.read_text(encoding="utf-8") != text:
                sys.exit(f"{path} is out of date; run python docs/generate_command_line.py")
    else:
        for path, text in files.items():
            path.write_text(text, encoding="utf-8")
