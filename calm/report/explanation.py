"""What a line weighs, what causes its knockdown, what would change it, and what a change does.

The facts of a result, an explanation, a sizing and a comparison of two designs, as a person reads
them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from math import floor, hypot, log10
from typing import TYPE_CHECKING

from calm.case import Result
from calm.case.net_result import NetResult
from calm.case.parts import parts_of
from calm.checks.finding import State
from calm.checks.inventory import inventory_of
from calm.checks.recovery import recovery_of
from calm.errors import NoEquilibrium
from calm.quantities import QUANTITIES, Quantity, duration, say
from calm.report.blocks import Block, Cell, Column, Line, Prose, ReportPart, Span, Table
from calm.units import with_unit

if TYPE_CHECKING:
    from calm.case.explain import Causes, Explanation
    from calm.case.size import Sizing, Trial
    from calm.case.targets import Figures
    from calm.checks.comparison import Compared, Comparison
    from calm.files.file_differences import Change

SMALLEST_SHARE = 0.005
"""Of every whole; drags that cause less of all of them are summed up in one row."""

_SHARES = (
    "Shares: all drags grow together from zero to their full value, and each is charged with the "
    "change that its own growth causes. Drag: the horizontal force of the water."
)
_CHANGES = "Buoyancy is changed for everything buoyant, drag for everything; lengths are not."


def line_facts(result: Result) -> tuple[str, ...]:
    """The weights of a mooring, its length and watch circle, and how it rises when freed."""
    items = inventory_of(result.mooring)
    masses = [one.dry_mass for one in items if one.role != "anchor"]
    weights = [one.wet_weight or 0.0 for one in items if one.role != "anchor"]
    unknown = masses.count(None)
    mass = f"{say('dry_mass', sum(filter(None, masses)))} in air"
    if unknown:
        mass = f"at least {mass} ({unknown} not known)"
    if unknown == len(masses):
        mass = "no mass in air is known"
    floats = -sum(weight for weight in weights if weight < 0.0)
    length = float(result.components.cut_length.sum())
    depth = result.mooring.water.depth
    rises = []
    with suppress(NoEquilibrium):
        rise = recovery_of(result.mooring, result, first_only=True)
        if rise.time_to_surface is None:
            rises = ["Once released, it does not rise by itself"]
        elif rise.time_to_surface > 0.0:
            up = duration(rise.time_to_surface)
            rises = [
                f"Once released, it rises at {say('speed', rise.rise_speed)}: the top surfaces in "
                f"{up}"
            ]
    return (
        f"Without the anchor {mass}; what floats lifts {say('wet_weight', floats)}, net "
        f"{say('wet_weight', -sum(weights))}",
        f"Line of {say('length', length)}, scope {length / depth:.3f}; watch circle of "
        f"{say('offset', hypot(result.top.x, result.top.y))} in this current",
        *rises,
    )


@dataclass(frozen=True)
class _Column:
    """A figure to show: its name in `Figures`, how it is headed, its quantity and unit."""

    name: str
    heading: str
    quantity: str
    unit: str
    scale: float = 1.0


_COLUMNS = {
    column.name: column
    for column in (
        _Column("knockdown", "knock-\ndown", "knockdown", "m"),
        _Column("excursion", "excur-\nsion", "offset", "m"),
        _Column("used_buoyancy", "buoyancy\nused", "used_buoyancy", "%", 100.0),
        _Column("tension", "anchor\npull", "tension", "N"),
        _Column("vertical", "\nup", "vertical", "N"),
        _Column("horizontal", "\nsideways", "horizontal", "N"),
        _Column("required_weight", "weight\nneeded", "required_weight", "N"),
    )
}
_ANCHOR = ("tension", "vertical", "horizontal", "required_weight")


def explanation_part(explanation: Explanation) -> ReportPart:
    """The shares of the drags and what a change would do.

    Drags that cause next to nothing share a row; a JSON document has each of them. It fits 80
    columns.
    """
    wholes = [
        f"{name} {_figure_text(_COLUMNS[name], explanation.figures)} m"
        for name in explanation.quantities
        if name != "used_buoyancy"
    ]
    title = f"What causes the {' and '.join(wholes)} of {explanation.label}"
    blocks: list[Block] = [Prose(explanation.notes)] if explanation.notes else []
    if explanation.causes is not None and len(explanation.causes):
        blocks.append(_causes(explanation, explanation.causes))
    blocks.append(_changes(explanation))
    failures = [change for change in explanation.changes if change.failure is not None]
    if failures:
        told = tuple(f"{change.name}: {change.failure}" for change in failures)
        blocks.append(Prose(told, State.WARN))
    lines = (_SHARES, _CHANGES) if explanation.causes is not None else (_CHANGES,)
    return ReportPart(title, (*blocks, Prose(tuple((Span(line, quiet=True),) for line in lines))))


def _causes(explanation: Explanation, causes: Causes) -> Table:
    columns = [_COLUMNS[name] for name in explanation.quantities]
    wholes = [getattr(explanation.figures, column.name) for column in columns]
    start = [explanation.without_drag[column.name] for column in columns]
    rows = [
        (row.label, row.drag, [getattr(row, column.name) for column in columns]) for row in causes
    ]
    largest = sorted(rows, key=lambda row: -abs(row[2][0]))
    told = [row for row in largest if _matters(row[2], wholes)]
    rest = [row for row in largest if not _matters(row[2], wholes)]
    heads = [Column(""), Column("drag", "N", numeric=True)]
    for column in columns:
        heads.append(Column(column.heading, column.unit, numeric=True))
        if column.unit != "%":
            heads.append(Column("\n", "%", numeric=True))
    lines = [("without drag", "", start)] if any(start) else []
    lines += [(label, f"{drag:.0f}", shares) for label, drag, shares in told]
    if rest:
        sums = [sum(row[2][i] for row in rest) for i in range(len(columns))]
        lines.append((rest[0][0] if len(rest) == 1 else f"{len(rest)} others", "", sums))
    lines.append(("all", "", wholes))
    cells = tuple(
        (Cell(label), Cell(drag), *map(Cell, _cells(columns, shares, wholes)))
        for label, drag, shares in lines
    )
    return Table("", tuple(heads), cells, totals=1)


def _matters(shares: list[float], wholes: list[float]) -> bool:
    pairs = zip(shares, wholes, strict=True)
    return any(abs(share) >= SMALLEST_SHARE * abs(whole) for share, whole in pairs)


def _cells(columns: list[_Column], shares: list[float], wholes: list[float]) -> list[str]:
    cells = []
    for column, share, whole in zip(columns, shares, wholes, strict=True):
        cells.append(f"{share * column.scale:z.{_decimals(column, whole)}f}")
        if column.unit != "%":
            cells.append(f"{100.0 * share / whole:z.1f}" if whole else "-")
    return cells


def _changes(explanation: Explanation) -> Table:
    anchor = _ANCHOR if explanation.figures.tension is not None else ()
    columns = [_COLUMNS[name] for name in (*explanation.quantities, *anchor)]
    heads = (Column(""), *(Column(each.heading, each.unit, numeric=True) for each in columns))
    now = explanation.figures
    as_it_is = (Cell(_figure_text(column, now), strong=True) for column in columns)
    rows = [(Cell("as it is", strong=True), *as_it_is)]
    for change in explanation.changes:
        if change.figures is None:
            assert change.failure is not None
            nothing = (Cell() for _ in columns[1:])
            rows.append((Cell(change.name), Cell(change.failure.status), *nothing))
        else:
            growths = (_growth(each, now, change.figures) for each in columns)
            rows.append((Cell(change.name), *map(Cell, growths)))
    return Table("", heads, tuple(rows))


def _figure_text(column: _Column, figures: Figures) -> str:
    value = getattr(figures, column.name)
    return f"{value * column.scale:z.{_decimals(column, value)}f}"


def _growth(column: _Column, now: Figures, then: Figures) -> str:
    before, after = getattr(now, column.name), getattr(then, column.name)
    if after is None:
        return "-"
    growth = f"{(after - before) * column.scale:+z.{_decimals(column, before)}f}"
    return growth if growth.strip("+0.") else growth.removeprefix("+")


def _decimals(column: _Column, whole: float) -> int:
    """Return those of the quantity, more where three digits of the whole need them."""
    usual = QUANTITIES[column.quantity].decimals if column.scale == 1.0 else 1
    if whole == 0.0:
        return usual
    return max(usual, min(2 - floor(log10(abs(whole * column.scale))), 4))


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
    """Return what to change so that a target that can be met is met, and what else that changes."""
    assert sizing.after is not None
    lines: list[Line] = []
    if sizing.before.failure is not None:
        lines.append((Span(f"As it is: {sizing.before.failure}", State.WARN),))
    lines += [(Span(f"! {text}", State.FAIL),) for text in _new_warnings(sizing)]
    effort = f"Found by {sizing.solves} solves, with the settings of the file."
    effort = "Solved as it is." if sizing.solves == 1 else effort
    lines += [*sizing.notes, (Span(effort, quiet=True),)]
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
    net = isinstance(after.result, NetResult)
    for field, quantity, told in _ROWS:
        words = told.replace("the top", _place_told(after)) if net else told
        if words == name or (field == "used_buoyancy" and not afloat):
            continue
        shown = QUANTITIES[quantity]
        figures = (getattr(one.figures, field, None) for one in both)
        rows.append((Cell(words), Cell(shown.display_unit), *map(Cell, map(shown.format, figures))))
    heads = (Column(name, numeric=True) for name in _SHORT)
    return Table("", (Column(""), Column("", share=0.0), *heads), tuple(rows))


def _place_told(trial: Trial) -> str:
    """The label of the part of a net whose depth and excursion are told."""
    assert trial.result is not None
    parts = parts_of(trial.result.file.pieces)
    return next((part.label for part in parts if part.place == trial.place), parts[0].label)


def _new_warnings(sizing: Sizing) -> list[str]:
    """Return those of the mooring after the change that it did not have before."""
    old = sizing.before.result.warnings if sizing.before.result is not None else ()
    new = sizing.after.result.warnings if sizing.after and sizing.after.result else ()
    return [warning for warning in new if warning not in old]


def comparison_part(comparison: Comparison) -> ReportPart:
    """The differences, then the figures side by side."""
    before, after = comparison.names
    return ReportPart(f"{before} → {after}", tuple(_blocks(comparison)))


def _blocks(comparison: Comparison) -> Iterator[Block]:
    found, (before, after) = comparison.differences, comparison.names
    if not found.any:
        yield Prose(("Nothing differs.",))
    else:
        rows = [
            *(_row("changed", one) for one in found.changed),
            *(_row("moved", one) for one in found.moved),
            *((Cell("removed"), Cell(label), Cell(), Cell()) for label in found.removed),
            *((Cell("added"), Cell(label), Cell(), Cell()) for label in found.added),
        ]
        columns = (Column("", share=0.0), Column("what"), Column(before), Column(after))
        yield Table("What differs", columns, tuple(rows))
    if comparison.notes:
        yield Prose(comparison.notes, State.FAIL)
    whole = [one for one in comparison.figures if not one.of_a_part and one.states is None]
    yield _figures("What it does", comparison.names, whole, all_rows=True)
    parts = [one for one in comparison.figures if one.of_a_part]
    yield _figures("Pieces and instruments", comparison.names, parts)
    margins = [one for one in comparison.figures if one.states is not None]
    yield _figures("Margins of the design check", comparison.names, margins, all_rows=True)


def _row(kind: str, change: Change) -> tuple[Cell, ...]:
    return Cell(kind), Cell(change.where), Cell(change.before.text), Cell(change.after.text)


def _figures(
    title: str, names: tuple[str, str], figures: Sequence[Compared], *, all_rows: bool = False
) -> Table:
    """Figures side by side; of those that are not shown, how many stay as they are."""
    rows = [_figure(one) for one in figures]
    shown = [row for row in rows if all_rows or row[2].text != row[3].text]
    same = len(rows) - len(shown)
    columns = (
        Column(""),
        Column("", share=0.0),
        *(Column(name, numeric=True, short=_SHORT[n]) for n, name in enumerate(names)),
        Column("change", numeric=True),
    )
    return Table(title, columns, tuple(shown), f"The other {same} do not change." if same else "")


_SHORT = "before", "after"


def _figure(one: Compared) -> tuple[Cell, ...]:
    from calm.report.check_summary import SIGNS

    quantity = QUANTITIES.get(one.quantity)
    states, both = one.states or (None, None), (one.before, one.after)
    texts = [_text(value, quantity, state) for value, state in zip(both, states, strict=True)]
    values = [
        Cell(text, state=state, mark="" if state is None or value is None else SIGNS[state])
        for text, value, state in zip(texts, both, states, strict=True)
    ]
    change = ""
    if isinstance(one.before, float) and isinstance(one.after, float) and texts[0] != texts[1]:
        assert quantity is not None
        text = quantity.format(one.after - one.before)
        change = text if text.startswith("-") else f"+{text}"
    unit = quantity.display_unit if quantity else ""
    return Cell(one.title), Cell(unit), *values, Cell(change)


def _text(value: float | str | None, quantity: Quantity | None, state: State | None) -> str:
    """A figure; of a margin that is not known, how its rule judges."""
    if isinstance(value, str):
        return value
    if value is None or quantity is None:
        return "-" if state is None else state.value
    return quantity.format(value)
