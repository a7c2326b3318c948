"""What a result says: the table of its line, its marks, and the words around it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from calm.case import Result, TowResult
from calm.case.net_result import AnyResult
from calm.case.profilers import ProfilerTravel
from calm.case.result_tables import ClampRow, ComponentRow, rows_down
from calm.case.strumming import StrummingBand
from calm.checks.finding import State
from calm.checks.posture import reaches_the_surface
from calm.checks.strength import safety_factor
from calm.drawing.schematic.shown_parts import place_text
from calm.files import Component
from calm.files.strumming_keys import BourgetMarichalKeys
from calm.quantities import QUANTITIES, duration, say
from calm.report.blocks import (
    Block,
    Cell,
    Column,
    Field,
    Line,
    Note,
    Prose,
    ReportPart,
    Span,
    Table,
)
from calm.solve import Status

NO_HEADS: Mapping[int, Cell] = {}

_MOORING_COLUMNS = (
    "length", "depth", "height", "knockdown", "offset", "tilt", "tension", "safety_factor",
)  # fmt: skip
_TOW_COLUMNS = ("length", "depth", "layback", "tilt", "tension", "safety_factor")
_NOTE = "of the upper end. Tension: the greatest in the piece. ~ near a limit, ! beyond it."
_TYPES = {"subsurface": "sub-surface mooring", "surface": "surface mooring"}


def result_part(
    result: Result | TowResult, facts: Sequence[Line] = (), *, verbose: bool = False
) -> ReportPart:
    """A result in short: it fits 80 columns, where long labels wrap.

    A figure beyond its limit carries ``!`` and one near it ``~``, so that nothing hangs on colour.

    Parameters
    ----------
    facts : more about the line, after its summary
    verbose : say how the solution was reached
    """
    table, (summary, *warned) = table_of_line(result), summary_of(result)
    quality = quality_of(result).lines if verbose else quality_of(result).lines[:1]
    ends = replace(summary, lines=(*summary.lines, *facts))
    blocks: tuple[Block, ...] = (ends, *warned, Note((table.note, *map(str, quality))))
    return ReportPart(title_of(result), (replace(table, note=""), *blocks))


def title_of(result: Result | TowResult) -> str:
    """Name and kind of what is solved."""
    if isinstance(result, TowResult):
        return f"{result.name}: tow at {say('speed', result.speed)} towards {result.toward:.0f}°"
    depth = say("depth", result.file.environment.depth)
    return f"{result.name}: {_TYPES[result.type]}, {depth} of water"


def table_of_line(result: Result | TowResult, title: str = "", *, places: bool = False) -> Table:
    """A row for each component and clamp, in file order; `places` as in `line_table`."""
    names: tuple[str, ...]
    if isinstance(result, TowResult):
        names, note = _TOW_COLUMNS, f"Depth and layback: {_NOTE}"
    else:
        names, note = _MOORING_COLUMNS, f"Depth, height and offset: {_NOTE}"
    return replace(line_table(result, names, note, places=places), title=title)


def summary_of(result: Result | TowResult) -> tuple[Prose, ...]:
    """The two ends of the line in words, the warnings below them."""
    ends = _tow_summary(result) if isinstance(result, TowResult) else _mooring_summary(result)
    warned = (Prose(result.warnings, State.WARN),) if result.warnings else ()
    return (Prose((*ends, *_strumming(result))), *warned)


def quality_of(result: Result | TowResult) -> Prose:
    """How good the solution is, and how it was reached."""
    good, end = result.accuracy, "tow point" if isinstance(result, TowResult) else "anchor"
    pull = "" if good.anchor is None else f", at the anchor {good.anchor:.2g} N"
    return Prose(
        (
            f"Good to {good.depth:.2g} m and {good.tension:.2g} N{pull}.",
            f"{result.status.capitalize()} in {result.iterations} marches of {result.segments} "
            f"segments; {end} missed by {abs(result.miss):.1g} m, forces closed to "
            f"{result.closure:.1g}.",
        )
    )


def _travel(profiler: ProfilerTravel) -> str:
    """Return the way of a profiler: its stops, and where its wire leans most."""
    upper, lower, worst = (
        f"{say('depth', place.depth)} ({say('tension', place.tension)}, {say('tilt', place.tilt)})"
        for place in (profiler.upper, profiler.lower, profiler.worst)
    )
    said = f"{profiler.label} travels from {upper} to {lower}; its wire leans most at {worst}"
    if profiler.time is not None:
        said += f"; a profile takes {duration(profiler.time)}"
    if profiler.profiles is not None:
        said += f", its batteries last for {profiler.profiles}"
    return said


def _mooring_summary(result: Result) -> tuple[Line, ...]:
    """The top, and the loads on the anchor."""
    top, anchor = result.top, result.anchor
    offset = f"{say('offset', math.hypot(top.x, top.y))} off the anchor"
    if result.type == "surface":
        used = f"{top.used_buoyancy:.1%} of its buoyancy used"
        at = f"at the surface, {offset}; {used}, {say('reserve', top.reserve)} in reserve"
    else:
        at = f"{say('depth', top.depth)} deep, {offset}; "
        at += f"knockdown {say('knockdown', top.knockdown)}"
    pull = (
        f"{say('tension', anchor.tension)}, {say('angle', anchor.angle)} from the vertical: "
        f"{say('vertical', anchor.vertical)} up, {say('horizontal', anchor.horizontal)} sideways"
    )
    if anchor.grounded_length > 0.0:
        pull += f"; {say('grounded_length', anchor.grounded_length)} of line on the seabed"
    needed = say("required_weight", anchor.required_weight)
    weighs = f"{say('required_weight', anchor.weight)} in water, {needed} needed"
    if lifts := anchor.weight < anchor.required_weight:
        weighs += " !"
    hull = f"Hull: draft {say('draft', top.draft)}, freeboard {say('freeboard', top.freeboard)}"
    return (
        f"Top {at}",
        *([hull] if top.draft is not None else []),
        *map(_travel, result.profilers),
        f"Anchor pulled by {pull}",
        (Span(f"Anchor weighs {weighs}", State.FAIL if lifts else None),),
    )


def _tow_summary(result: TowResult) -> tuple[Line, ...]:
    """The loads at the ship, and where the body is."""
    point, body = result.tow_point, result.body
    way = "down" if point.vertical >= 0.0 else "up"
    return (
        (
            f"Tow point pulled by {_pull(point.tension, point.angle)}: "
            f"{say('vertical', abs(point.vertical))} {way}, "
            f"{say('horizontal', point.horizontal)} back"
        ),
        (
            f"Body {_level(result, body.depth)}, layback {say('layback', body.layback)}; "
            f"pulled by {_pull(body.tension, body.angle)}"
        ),
    )


def _strumming(result: Result | TowResult) -> tuple[str, ...]:
    """Return how fast cables vibrate and what that makes, or would make, of their drag."""
    strumming, band = result.strumming, result.strumming_band
    if strumming is not None:
        together = isinstance(result.file.solver.strumming, BourgetMarichalKeys)
        frequency = f"{'' if together else 'up to '}{say('frequency', strumming.frequency)}"
        least, greatest = say("cn", strumming.cn_min), say("cn", strumming.cn_max)
        return (f"Strumming at {frequency}, Cn from {least} to {greatest}",)
    if band is not None:
        return (f"If the cables strum, Cn × {band.factor:g}: {_with(result, band)}",)
    return ()


def _with(result: Result | TowResult, band: StrummingBand) -> str:
    """Return what the line would do with more drag on its cables."""
    if band.status != Status.CONVERGED.label:
        return band.status
    assert band.depth is not None
    if isinstance(result, TowResult):
        return f"body {_level(result, band.depth)}, tow point {say('tension', band.tension)}"
    if result.type == "surface" and band.depth <= 0.0:  # a float at its draft stands out
        top = "top at the surface"
    elif band.knockdown is None:
        top = f"top {say('depth', band.depth)} deep"
    else:
        top = f"knockdown {say('knockdown', band.knockdown)}"
    return f"{top}, anchor {say('tension', band.tension)}"


def _pull(tension: float, angle: float) -> str:
    return f"{say('tension', tension)}, {say('angle', angle)} from the horizontal"


def _level(result: TowResult, depth: float) -> str:
    """Return how deep the body is, or how high it flies."""
    if result.file.environment.fluid == "air":
        return f"{say('depth', depth + result.tow.keys.height)} below the tow point"
    return f"{say('depth', depth)} deep" if depth >= 0.0 else f"{say('depth', -depth)} in the air"


# Headings cut so that the whole table fits 80 columns.
_SHORT = {
    "height": "above\nseabed",
    "knockdown": "knock-\ndown",
    "safety_factor": "safety\nfactor\n",
}
_MARKED = ("tilt", "safety_factor")


_MARKS = {State.WARN: "~", State.FAIL: "!"}
"""The sign after a figure that is near its limit or beyond it: legible without colour."""


def line_table(
    result: AnyResult,
    names: tuple[str, ...],
    note: str,
    *,
    places: bool = False,
    heads: Mapping[int, Cell] = NO_HEADS,
) -> Table:
    """The line from its first-listed end, each clamped instrument indented below its piece.

    Parameters
    ----------
    names : of the quantities in each row
    note : how to read them
    places : whether a clamp says where on its piece it sits, in place of a length
    heads : what stands above pieces, by their index
    """
    columns = (Column("no.", numeric=True, narrow=False), Column("piece", short=""))
    rows = tuple(_rows(result, names, places, heads))
    return Table("", (*columns, *map(quantity_column, names)), rows, note, dense=True)


def quantity_field(name: str, attribute: str = "", heading: str | None = None) -> Field:
    """A column of a quantity for `table_of`.

    Parameters
    ----------
    name : of the quantity
    attribute : of the items, where it has another name
    heading : where it is another
    """
    column = quantity_column(name, heading)
    return column, lambda one: figure_cell(name, getattr(one, attribute or name))


def quantity_column(name: str, heading: str | None = None) -> Column:
    """The head of a column of a quantity, or another, with the unit that people read."""
    quantity = QUANTITIES[name]
    return Column(
        heading or quantity.heading,
        quantity.display_unit,
        numeric=True,
        short=None if heading else _SHORT.get(name),
        marked=name in _MARKED,
    )


def figure_cell(name: str, value: float | None, state: State | None = None) -> Cell:
    """Return a value of a quantity as it stands under its `quantity_column`.

    Parameters
    ----------
    name : of the quantity
    value : SI, degrees; None where it is not known
    state : warns or fails where the figure is near a limit or beyond it, and marks it so
    """
    return Cell(QUANTITIES[name].format(value), state=state, mark=_MARKS[state] if state else "")


def tilt_state(component: Component, tilt: float) -> State | None:
    """How a tilt [deg] is marked: beyond `max_tilt` the component is not to be trusted."""
    if component.max_tilt is not None and tilt > component.max_tilt:
        return State.FAIL
    if component.warn_tilt is not None and tilt > component.warn_tilt:
        return State.WARN
    return None


def safety_state(result: AnyResult, record: ComponentRow) -> State | None:
    """How a safety factor is marked: too small, or the piece bears more than its working load.

    The factor asked on the breaking load is the file's `checks.safety_factor`, for a surface
    mooring, for a synthetic cable, or for steel. What is not known, NaN, is not marked.
    """
    meant = isinstance(result, Result) and reaches_the_surface(result.mooring)
    surface = meant or result.type == "surface"
    least = safety_factor(record.part.component, result.file.checks.safety_factor, surface)
    beyond = record.safety_factor < least or record.utilisation > 1.0
    return State.FAIL if beyond else None


def _rows(
    result: AnyResult, names: tuple[str, ...], places: bool, heads: Mapping[int, Cell]
) -> Iterator[tuple[Cell, ...]]:
    for number, (piece, clamps) in enumerate(rows_down(result)):
        if piece.index in heads:
            yield (heads[piece.index],)
        where = _where(result, piece.depth_top, piece.x_top, piece.y_top)
        states = {
            "tilt": tilt_state(piece.part.component, piece.tilt),
            "safety_factor": safety_state(result, piece),
        }
        label = Cell(piece.label, strong=piece.role == "instrument")
        yield Cell(str(number)), label, *_cells(names, piece, where, states)
        for clamp in clamps:
            component = clamp.part.component
            where = _where(result, clamp.depth, clamp.x, clamp.y)
            states = {"tilt": tilt_state(component, clamp.tilt)}
            strong = component.role == "instrument"
            label = Cell(clamp.label, indented=True, strong=strong)
            cells = [*_cells(names, clamp, where, states)]
            if places:
                cells[names.index("length")] = Cell(place_text(clamp.part.at))
            yield Cell(), label, *cells


def _where(result: AnyResult, depth: float, x: float, y: float) -> dict[str, float]:
    """Return where a clamped instrument is, or the upper end of a piece."""
    bottom = result.file.environment.depth
    return {
        "depth": depth,
        "height": math.nan if bottom is None else bottom - depth,
        "offset": math.hypot(x, y),
        "layback": math.hypot(x, y),
        "x": x,
        "y": y,
    }


def _cells(
    names: tuple[str, ...],
    row: ComponentRow | ClampRow,
    where: dict[str, float],
    states: Mapping[str, State | None],
) -> Iterator[Cell]:
    for name in names:
        value = where[name] if name in where else getattr(row, name, None)
        yield figure_cell(name, value, states.get(name))
