"""What CALM says, as a fragment of HTML for a notebook."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from typing import TYPE_CHECKING

from calm.checks.finding import State
from calm.report.blocks import Block, Cell, Column, Line, Note, Prose, ReportPart, Table
from calm.report.sheet import result_part

if TYPE_CHECKING:
    from calm.case import Result, TowResult


def to_html(result: Result | TowResult) -> str:
    """A result as a notebook shows it."""
    return fragment(result_part(result))


def fragment(part: ReportPart) -> str:
    """A part of tables and sentences, every text escaped."""
    return f"<div><p><b>{escape(part.title)}</b></p>{''.join(map(_block, part.blocks))}</div>"


def _block(block: Block) -> str:
    if isinstance(block, Table):
        return _table(block)
    if isinstance(block, Prose):
        return "".join(f"<p>{_line(line, block.state)}</p>" for line in block.lines)
    if isinstance(block, Note):
        return f"<p><small>{escape(' '.join(block.lines))}</small></p>"
    raise TypeError(f"a notebook shows no {type(block).__name__}")


def _table(block: Table) -> str:
    chosen = [number for number, column in enumerate(block.columns) if column.narrow]
    heads = "".join(f"<th>{_heading(block.columns[number])}</th>" for number in chosen)
    rows = "".join(_row([row[number] for number in chosen]) for row in block.rows)
    return f"<table><thead><tr>{heads}</tr></thead><tbody>{rows}</tbody></table>"


def _heading(column: Column) -> str:
    if column.short == "":
        return ""
    return escape(f"{column.heading} [{column.unit}]" if column.unit else column.heading)


def _row(cells: list[Cell]) -> str:
    first, *others = cells
    indent = "&emsp;" if first.indented else ""
    named = f'<th style="text-align:left">{indent}{escape(first.text)}</th>'
    return f"<tr>{named}{''.join(f'<td>{_cell(cell)}</td>' for cell in others)}</tr>"


def _cell(cell: Cell) -> str:
    text = escape(cell.text)
    return f"<b>{text} {cell.mark}</b>" if cell.mark else text


def _line(line: Line, state: State | None) -> str:
    if isinstance(line, str):
        return f"<b>! {escape(line)}</b>" if state is State.WARN else escape(line)
    return "".join(_spans(line))


def _spans(line: Line) -> Iterator[str]:
    for span in line:
        text = escape(span if isinstance(span, str) else span.text)
        yield text if isinstance(span, str) or span.state is None else f"<b>{text}</b>"
