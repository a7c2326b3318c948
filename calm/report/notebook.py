"""The table of a mooring for a notebook."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from typing import TYPE_CHECKING

from calm.quantities import QUANTITIES
from calm.report.rows import COLUMNS, NOTE, Phrase, convergence, rows, summary, title

if TYPE_CHECKING:
    from calm.case import Result


def to_html(result: Result) -> str:
    """The table of a result and the lines below it as an HTML fragment, every text escaped."""
    heads = "".join(f"<th>{escape(QUANTITIES[name].label)}</th>" for name in COLUMNS)
    body = "".join(_rows(result))
    paragraphs = "".join(f"<p>{_phrase(phrase)}</p>" for phrase in summary(result))
    paragraphs += "".join(f"<p><b>! {escape(warning)}</b></p>" for warning in result.warnings)
    return (
        f"<div><p><b>{escape(title(result))}</b></p>"
        f"<table><thead><tr><th></th>{heads}</tr></thead><tbody>{body}</tbody></table>"
        f"{paragraphs}<p><small>{escape(NOTE)} {escape(convergence(result))}</small></p></div>"
    )


def _rows(result: Result) -> Iterator[str]:
    for row in rows(result):
        indent = "&emsp;" if row.clamped else ""
        cells = "".join(f"<td>{_phrase(cell)}</td>" for cell in row.cells)
        yield f'<tr><th style="text-align:left">{indent}{escape(row.label)}</th>{cells}</tr>'


def _phrase(phrase: Phrase) -> str:
    text = escape(phrase.text)
    return f"<b>{text} {phrase.mark}</b>" if phrase.mark else text
