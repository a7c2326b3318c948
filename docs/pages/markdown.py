"""Markdown of the generated pages: tables and literal text."""

from collections.abc import Iterable, Sequence

_SIGNS = str.maketrans({sign: f"\\{sign}" for sign in "\\`*_[]<>|#$"})


def plain(text: str) -> str:
    """Text for a cell or a sentence, with no sign that Markdown reads."""
    return " ".join(text.translate(_SIGNS).split())


def code(text: str) -> str:
    """Format literal text for a table cell; empty without text."""
    return f"`{text.replace('|', '∣')}`" if text else ""


def table(heads: Sequence[str], rows: Iterable[Sequence[str]], numeric: Sequence[int] = ()) -> str:
    """A table; its cells are Markdown. The columns `numeric` are set to the right."""
    rules = ["---:" if column in numeric else "---" for column in range(len(heads))]
    return "\n".join(f"| {' | '.join(row)} |" for row in (heads, rules, *rows)) + "\n"
