"""Write `docs/reference/command-line.md` from the help of the commands themselves.

python docs/generate_command_line.py            # write it
python docs/generate_command_line.py --check    # exit 1 where it is out of date
"""

import contextlib
import io
import os
import sys
from collections.abc import Iterator
from pathlib import Path

from cyclopts import App

from calm.cli.main import app, main

PAGE = Path(__file__).parent / "reference" / "command-line.md"
HEAD = """# The command line

Printed by `python docs/generate_command_line.py`; do not edit.

Data goes to the standard output, narration to the standard error.
"""


def commands(parent: App, words: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """The words of every command, a group before its members."""
    yield words
    for name in parent:
        if not name.startswith("-"):
            yield from commands(parent[name], (*words, name))


def help_of(words: tuple[str, ...]) -> str:
    """What `calm WORDS --help` prints on a page of 80 columns."""
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


if __name__ == "__main__":
    if sys.argv[1:] == ["--check"]:
        if not PAGE.exists() or PAGE.read_text(encoding="utf-8") != page():
            sys.exit(f"{PAGE} is out of date; run python docs/generate_command_line.py")
    else:
        PAGE.write_text(page(), encoding="utf-8")
