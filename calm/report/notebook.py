"""The table of a result for a notebook."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from typing import TYPE_CHECKING

from calm.quantities import QUANTITIES
from calm.report.rows import Phrase, Sheet
from calm.report.sheet import sheet

if TYPE_CHECKING:
    from calm.case import Result, TowResult


def to_html(result: Result | TowResult) -> str:
    """The table of a result and the lines below it as an HTML fragment, every text escaped."""
    said = sheet(result)
    heads = "".join(f"<th>{escape(QUANTITIES[name].label)}</th>" for name in said.columns)
    body = "".join(_rows(said))
    paragraphs = "".join(f"<p>{_phrase(phrase)}</p>" for phrase in said.summary)
    paragraphs += "".join(f"<p><b>! {escape(warning)}</b></p>" for warning in said.warnings)
    return (
        f"<div><p><b>{escape(said.title)}</b></p>"
        f"<table><thead><tr><th></th>{heads}</tr></thead><tbody>{body}</tbody></table>"
        f"{paragraphs}<p><small>{escape(said.note)} {escape(said.convergence)}</small></p></div>"
    )


def _rows(said: Sheet) -> Iterator[str]:
    for row in said.rows:
        indent = "&emsp;" if row.clamped else ""
        cells = "".join(f"<td>{_phrase(cell)}</td>" for cell in row.cells)
        yield f'<tr><th style="text-align:left">{indent}{escape(row.label)}</th>{cells}</tr>'


def _phrase(phrase: Phrase) -> str:
    text = escape(phrase.text)
    return f"<b>{text} {phrase.mark}</b>" if phrase.mark else text
