"""A sizing as a person reads it: what to change, and the mooring before and after."""

from __future__ import annotations

from typing import TYPE_CHECKING

from calm.checks.finding import State
from calm.quantities import QUANTITIES
from calm.report.blocks import Cell, Column, Line, Prose, ReportPart, Span, Table
from calm.units import with_unit

if TYPE_CHECKING:
    from calm.case.size import Sizing, Trial

_ROWS = (
    ("depth", "depth", "depth of the top"),
    ("knockdown", "knockdown", "knockdown of the top"),
    ("excursion", "offset", "excursion of the top"),
    ("used_buoyancy", "used_buoyancy", "buoyancy used, of 1"),
    ("tension", "tension", "pull on the anchor"),
    ("vertical", "vertical", "  up"),
    ("horizontal", "horizontal", "  sideways"),
    ("required_weight", "required_weight", "anchor weight needed"),
)
"""Rows: name in `Figures`, quantity, words."""


def sizing_part(sizing: Sizing) -> ReportPart:
    """Return what to change so that the target is met, and what else that changes.

    Parameters
    ----------
    sizing : one whose target is met; of the others there is only a reason to tell
    """
    assert sizing.after is not None
    lines: list[Line] = []
    if sizing.before.failure is not None:
        lines.append((Span(f"As it is: {sizing.before.failure}", State.WARN),))
    lines += [(Span(f"! {text}", State.FAIL),) for text in _new_warnings(sizing)]
    lines += [*sizing.notes, (Span(_effort(sizing), quiet=True),)]
    table = _comparison(sizing, sizing.before, sizing.after)
    title = f"{sizing.change.file.name}: {sizing.target.text}"
    return ReportPart(title, (Prose((_answer(sizing),)), table, Prose(tuple(lines))))


def refusal(sizing: Sizing) -> str:
    """Return why a target is not met, and what to do, in a line."""
    return f"{sizing.target.text} is not met. {sizing.message} {sizing.advice}"


def _answer(sizing: Sizing) -> str:
    change, before, after = sizing.change, sizing.before, sizing.after
    assert after is not None
    if after.value == before.value:
        return f"Nothing to change: the target is met with {change.text} as it is."
    growth = after.value - before.value
    several = len(change.parts) > 1 and not change.whole
    each = f", each of {len(change.parts)}" if several else ""
    share = f" ({growth / abs(before.value):+.1%})".replace("%", " %") if before.value else ""
    return (
        f"{change.text}: {with_unit(before.value, change.unit)} → "
        f"{with_unit(after.value, change.unit)}, {growth:+.6g}{share}{each}"
    )


def _comparison(sizing: Sizing, before: Trial, after: Trial) -> Table:
    target, both = sizing.target, (before, after)
    words_of = {field: words for field, _, words in _ROWS}
    name = words_of.get(target.quantity, f"{target.quantity} of the top")
    if target.label is not None:
        name = f"{target.quantity} of {target.label}"
    measured = ("-" if one.measured is None else f"{one.measured:.6g}" for one in both)
    aimed = (name, target.unit.replace("deg", "°"), *measured)
    rows = [tuple(Cell(text, strong=True) for text in aimed)]
    afloat = after.result is not None and after.result.type == "surface"
    for field, quantity, words in _ROWS:
        if words == name or (field == "used_buoyancy" and not afloat):
            continue
        shown = QUANTITIES[quantity]
        figures = (getattr(one.figures, field, None) for one in both)
        rows.append((Cell(words), Cell(shown.display_unit), *map(Cell, map(shown.format, figures))))
    columns = (
        Column(""),
        Column("", share=0.0),
        Column("before", numeric=True),
        Column("after", numeric=True),
    )
    return Table("", columns, tuple(rows))


def _new_warnings(sizing: Sizing) -> list[str]:
    """Return those of the mooring after the change that it did not have before."""
    old = sizing.before.result.warnings if sizing.before.result is not None else ()
    new = sizing.after.result.warnings if sizing.after and sizing.after.result else ()
    return [warning for warning in new if warning not in old]


def _effort(sizing: Sizing) -> str:
    if sizing.solves == 1:
        return "Solved as it is."
    return f"Found by {sizing.solves} solves, with the settings of the file."
