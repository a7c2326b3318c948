"""The look of what a terminal shows: tables without rules, and warnings that need no colour."""

from __future__ import annotations

from rich.table import Table
from rich.text import Text

WARNED = "bold red"
"""The style of what a person must not overlook."""


def plain_table(*, gap: int = 2, header: bool = True) -> Table:
    """A table without rules, `gap` blanks between its columns."""
    return Table(box=None, show_header=header, padding=(0, 0, 0, gap), pad_edge=False)


def warning(text: str) -> Text:
    """A line that begins with ``!``, so that nothing hangs on its colour."""
    return Text(f"! {text}", style=WARNED)
