"""Reports that explain a mooring.

The reports are on mass and ascent, the causes of knockdown, the change that meets a target, and the
comparison of two designs.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from math import floor, inf, isfinite, log10
from typing import TYPE_CHECKING, NamedTuple

from calm.case import Result
from calm.case.leg_result import LegResult
from calm.checks.finding import State
from calm.checks.inventory import inventory_of
from calm.checks.recovery import recovery_of
from calm.errors import NoEquilibrium
from calm.files.pieces import parts_of
from calm.quantities import QUANTITIES, Quantity, duration, say
from calm.report import blocks
from calm.report.blocks import Block, Cell, Prose, ReportPart, Span, Table, number, table_of, words
from calm.units import with_unit

if TYPE_CHECKING:
    from calm.case.explain import Causes, Explanation
    from calm.case.size import Sizing, Trial
    from calm.case.targets import Figures
    from calm.checks.comparison import Compared, Comparison

SMALLEST_SHARE = 0.005
"""Fraction of a total below which drag forces are summed in one row."""

_SHARES = (
    "Shares: CALM increases all drag forces together from zero to their full values. The share "
    "of a force is the part of the total change that this force causes. Drag is the horizontal "
    "force of the water."
)
_CHANGES = (
    "A change of buoyancy applies to all buoyant parts, and a change of drag to all parts; "
    "lengths are unchanged."
)


def line_facts(result: Result) -> tuple[tuple[str, str], ...]:
    """Return named texts on the ascent of a mooring after release, and on its mass."""
    if result.several or result.towed:
        return ()
    items = inventory_of(result.leg.leg)
    masses = [one.dry_mass for one in items if one.role != "anchor"]
    unknown = masses.count(None)
    mass = f"{say('dry_mass', sum(filter(None, masses)))} in air without the anchor"
    if unknown:
        parts = "1 part" if unknown == 1 else f"{unknown} parts"
        mass = f"at least {mass} (the mass of {parts} is unknown)"
    if unknown == len(masses):
        mass = "unknown, because the mass in air is not set for any part"
    rise = (("Recovery", text),) if (text := _ascent_text(result.leg)) else ()
    return (*rise, ("Mass", mass))


def _ascent_text(result: LegResult) -> str:
    """Describe the ascent of a line; "" for a surface mooring, or without a solution."""
    with suppress(NoEquilibrium):
        rise = recovery_of(result.leg, result)
        if rise.time_to_surface is None:
            return "does not rise after release"
        if rise.time_to_surface > 0.0:
            return (
                f"rises at {say('speed', rise.rise_speed)}, top at the surface after "
                f"{duration(rise.time_to_surface)}"
            )
    return ""


class _PrintedValue(NamedTuple):
    """A value to print: its name in `Figures`, and its heading, quantity, unit and scale."""

    name: str
    heading: str
    quantity: str
    unit: str
    scale: float = 1.0

    def decimals(self, whole: float) -> int:
        """Return the number of decimals with which the total `whole` has three digits.

        The number is at most four, but not less than the usual number for the quantity.
        """
        usual = QUANTITIES[self.quantity].decimals if self.scale == 1.0 else 1
        if whole == 0.0:
            return usual
        return max(usual, min(2 - floor(log10(abs(whole * self.scale))), 4))

    def text(self, figures: Figures) -> str:
        value = getattr(figures, self.name)
        return f"{value * self.scale:z.{self.decimals(value)}f}"

    def growth(self, now: Figures, then: Figures | None) -> str:
        before, after = getattr(now, self.name), then and getattr(then, self.name)
        if after is None:
            return "-"
        growth = f"{(after - before) * self.scale:+z.{self.decimals(before)}f}"
        return growth if growth.strip("+0.") else growth.removeprefix("+")


_COLUMNS = {
    name: _PrintedValue(name, *more)
    for name, *more in (
        ("knockdown", "knock-\ndown", "knockdown", "m"),
        ("excursion", "excur-\nsion", "offset", "m"),
        ("used_buoyancy", "buoyancy\nused", "used_buoyancy", "%", 100.0),
        ("tension", "anchor\nload", "tension", "N"),
        ("vertical", "\nvertical", "vertical", "N"),
        ("horizontal", "\nhorizontal", "horizontal", "N"),
        ("required_weight", "weight\nrequired", "required_weight", "N"),
    )
}
_ANCHOR = ("tension", "vertical", "horizontal", "required_weight")


def explanation_part(explanation: Explanation) -> ReportPart:
    """Report the contribution of each drag force, and the effects of changed inputs.

    The report fits 80 columns. Drag forces with very small shares are combined in one row, but
    listed separately in the JSON document.
    """
    wholes = [
        f"{name} ({_COLUMNS[name].text(explanation.figures)} m)"
        for name in explanation.quantities
        if name != "used_buoyancy"
    ]
    title = f"Causes of the {' and '.join(wholes)} of {explanation.label}"
    causes, changes = explanation.causes, explanation.changes
    failures = (f"{one.name}: {one.failure}" for one in changes if one.failure is not None)
    shown: tuple[Block, ...] = (
        *([Prose(explanation.notes)] if explanation.notes else []),
        *([_causes_table(explanation, causes)] if causes is not None and len(causes) else []),
        _changes_table(explanation),
        *blocks.warned(failures),
        blocks.quiet(*([_SHARES] if causes is not None else []), _CHANGES),
    )
    return ReportPart(title, shown)


def _causes_table(explanation: Explanation, causes: Causes) -> Table:
    columns = [_COLUMNS[name] for name in explanation.quantities]
    wholes = [getattr(explanation.figures, column.name) for column in columns]
    start = [explanation.without_drag[column.name] for column in columns]
    rows = [
        (row.label, row.drag, [getattr(row, column.name) for column in columns]) for row in causes
    ]
    rows.sort(key=lambda row: -abs(row[2][0]))

    def matters(shares: list[float]) -> bool:
        pairs = zip(shares, wholes, strict=True)
        return any(abs(share) >= SMALLEST_SHARE * abs(whole) for share, whole in pairs)

    rest = [(label, shares) for label, _, shares in rows if not matters(shares)]
    lines = [("without drag", "", start)] if any(start) else []
    lines += [(label, f"{drag:.0f}", shares) for label, drag, shares in rows if matters(shares)]
    if rest:
        sums = [sum(each) for each in zip(*(shares for _, shares in rest), strict=True)]
        lines.append((rest[0][0] if len(rest) == 1 else f"{len(rest)} others", "", sums))

    def figure(at: int, column: _PrintedValue) -> Iterator[blocks.Field]:
        digits, whole = column.decimals(wholes[at]), wholes[at]
        yield number(
            column.heading, lambda row: f"{row[2][at] * column.scale:z.{digits}f}", column.unit
        )
        if column.unit != "%":
            yield number(
                "\n", lambda row: f"{100.0 * row[2][at] / whole:z.1f}" if whole else "-", "%"
            )

    fields = [field for at, column in enumerate(columns) for field in figure(at, column)]
    total = ("all", "", wholes)
    return table_of("", lines, words("", 0), number("drag", 1, "N"), *fields, sums=[total])


def _changes_table(explanation: Explanation) -> Table:
    anchor = _ANCHOR if explanation.figures.tension is not None else ()
    columns = [_COLUMNS[name] for name in (*explanation.quantities, *anchor)]
    now = explanation.figures
    present = ("present design", *(column.text(now) for column in columns))
    rows: list[Sequence[Cell | str]] = [[Cell(text, strong=True) for text in present]]
    for change in explanation.changes:
        if change.failure is not None:
            rows.append((change.name, change.failure.status, *([""] * (len(columns) - 1))))
        else:
            growths = (column.growth(now, change.figures) for column in columns)
            rows.append((change.name, *growths))
    fields = (number(each.heading, at, each.unit) for at, each in enumerate(columns, 1))
    return table_of("", rows, words("", 0), *fields)


_ROWS = (
    ("depth", "depth", "depth of the top"),
    ("knockdown", "knockdown", "knockdown of the top"),
    ("excursion", "offset", "excursion of the top"),
    ("used_buoyancy", "used_buoyancy", "buoyancy used, of 1"),
    ("tension", "tension", "anchor load"),
    ("vertical", "vertical", "  vertical"),
    ("horizontal", "horizontal", "  horizontal"),
    ("required_weight", "required_weight", "anchor weight required"),
)
"""Rows of the table: name in `Figures`, quantity, printed name."""


def sizing_part(sizing: Sizing) -> ReportPart:
    """Report the change that meets a target, and all other effects of the change."""
    assert sizing.after is not None
    lines: list[blocks.Line] = []
    if sizing.before.failure is not None:
        lines.append((Span(f"Present design: {sizing.before.failure}", State.WARN),))
    old = sizing.before.result.warnings if sizing.before.result is not None else ()
    new = sizing.after.result.warnings if sizing.after.result is not None else ()
    lines += [(Span(f"! {text}", State.FAIL),) for text in new if text not in old]
    effort = f"Solved {sizing.solves} times with the solver settings of the file."
    effort = "Solved once." if sizing.solves == 1 else effort
    lines += [*sizing.notes, (Span(effort, quiet=True),)]
    table = _sizing_table(sizing, sizing.before, sizing.after)
    title = f"{sizing.change.file.name}: {sizing.target.text}"
    return ReportPart(title, (Prose((_sizing_sentence(sizing),)), table, Prose(tuple(lines))))


def refusal(sizing: Sizing) -> str:
    """Return one line that explains why a target is not met, and advises what to change."""
    return f"{sizing.target.text} is not met. {sizing.message} {sizing.advice}"


def _sizing_sentence(sizing: Sizing) -> str:
    change, before, after = sizing.change, sizing.before, sizing.after
    assert after is not None
    if after.value == before.value:
        return f"No change needed: the present {change.text} meets the target."
    growth = after.value - before.value
    several = len(change.parts) > 1 and not change.whole
    each = f", each of {len(change.parts)}" if several else ""
    sign = "+" if growth > 0.0 else ""
    share = f" ({growth / abs(before.value):+.1%})".replace("%", " %") if before.value else ""
    return (
        f"{change.text}: {with_unit(before.value, change.unit)} → "
        f"{with_unit(after.value, change.unit)}, "
        f"{sign}{with_unit(growth, change.unit)}{share}{each}"
    )


def _sizing_table(sizing: Sizing, before: Trial, after: Trial) -> Table:
    target, both = sizing.target, (before, after)
    titles = {field: title for field, _, title in _ROWS}
    name = titles.get(target.quantity, f"{target.quantity} of the top")
    if target.label is not None:
        name = f"{target.quantity} of {target.label}"
    measured = ("-" if one.measured is None else f"{one.measured:.6g}" for one in both)
    aimed = (name, target.unit.replace("deg", "°"), *measured)
    rows: list[Sequence[Cell | str]] = [[Cell(text, strong=True) for text in aimed]]
    afloat = after.result is not None and after.result.type == "surface"
    net = after.result is not None and after.result.several
    for field, quantity, title in _ROWS:
        head = title.replace("the top", _shown_part(after)) if net else title
        if head == name or (field == "used_buoyancy" and not afloat):
            continue
        shown = QUANTITIES[quantity]
        figures = (getattr(one.figures, field, None) for one in both)
        rows.append((head, shown.display_unit, *map(shown.format, figures)))
    fields = words("", 0), words("", 1, 0.0), number("before", 2), number("after", 3)
    return table_of("", rows, *fields)


def _shown_part(trial: Trial) -> str:
    assert trial.result is not None
    parts = parts_of(trial.result.file.pieces)
    return next((part.label for part in parts if part.place == trial.place), parts[0].label)


def comparison_part(comparison: Comparison) -> ReportPart:
    """Report the differences between two designs, and the values of each design side by side."""
    return ReportPart(" → ".join(comparison.names), tuple(_comparison_blocks(comparison)))


def _comparison_blocks(comparison: Comparison) -> Iterator[Block]:
    found, (before, after) = comparison.differences, comparison.names
    if found.any:
        changes = [("changed", each) for each in found.changed]
        changes += [("moved", each) for each in found.moved]
        rows = [(kind, one.where, one.before.text, one.after.text) for kind, one in changes]
        rows += [("removed", label, "", "") for label in found.removed]
        rows += [("added", label, "", "") for label in found.added]
        fields = words("", 0, 0.0), words("what", 1), words(before, 2), words(after, 3)
        yield table_of("Differences", rows, *fields)
    else:
        yield Prose(("The designs are identical.",))
    yield from blocks.warned(comparison.notes, State.FAIL)
    whole = [one for one in comparison.figures if not one.of_a_part and one.states is None]
    yield _values_table("Results", comparison.names, whole, all_rows=True)
    parts = [one for one in comparison.figures if one.of_a_part]
    yield _values_table("Pieces and instruments", comparison.names, parts)
    margins = [one for one in comparison.figures if one.states is not None]
    if margins:
        yield _values_table("Governing checks", comparison.names, margins, all_rows=True)


def _values_table(
    title: str, names: tuple[str, str], figures: Sequence[Compared], *, all_rows: bool = False
) -> Table:
    rows = [_values_row(one) for one in figures]
    shown = [row for row in rows if all_rows or row[2].text != row[3].text]
    same = len(rows) - len(shown)
    return table_of(
        title,
        shown,
        words("", 0),
        words("", 1, 0.0),
        number(names[0], 2, short="before"),
        number(names[1], 3, short="after"),
        number("change", 4),
        note=f"{same} other rows do not change." if same else "",
    )


def _values_row(one: Compared) -> tuple[str, str, Cell, Cell, str]:
    quantity, states = QUANTITIES.get(one.quantity), one.states or (None, None)
    before, after = (
        Cell(
            _value_text(value, quantity, state),
            state=state,
            mark=state.sign if state and value is not None else "",
        )
        for value, state in zip((one.before, one.after), states, strict=True)
    )
    change = ""
    if isinstance(one.before, float) and isinstance(one.after, float) and before.text != after.text:
        assert quantity is not None
        rise = one.after - one.before
        text = quantity.format(rise) if isfinite(rise) else "-"
        change = text if text.startswith("-") else f"+{text}"
    return one.title, quantity.display_unit if quantity else "", before, after, change


def _value_text(value: float | str | None, quantity: Quantity | None, state: State | None) -> str:
    if isinstance(value, str):
        return value
    if value is None or quantity is None:
        return "-" if state is None else state.value
    # an infinite utilisation means that no capacity is left
    return "none left" if value == inf else quantity.format(value)
