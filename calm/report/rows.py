"""What the table of a mooring says, as plain text: a terminal and a notebook show the same."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from calm.quantities import QUANTITIES, say
from calm.report.limits import Mark, safety_mark, tilt_mark

if TYPE_CHECKING:
    from calm.case import Result

COLUMNS = (
    "length",
    "depth",
    "height",
    "knockdown",
    "offset",
    "tilt",
    "tension",
    "safety_factor",
)
"""The quantities of a row, in order."""

NOTE = (
    "Depth, height and offset: of the upper end. Tension: the greatest in the piece. "
    "~ near a limit, ! beyond it."
)
"""How to read the rows."""

_TYPES = {"subsurface": "sub-surface mooring", "surface": "surface mooring"}


@dataclass(frozen=True)
class Phrase:
    """A piece of text, and whether what it says passes a limit."""

    text: str
    mark: Mark = Mark.NONE


@dataclass(frozen=True)
class Row:
    """A component, or an instrument clamped on the one above it (`clamped`)."""

    label: str
    clamped: bool
    instrument: bool
    cells: tuple[Phrase, ...]


def title(result: Result) -> str:
    """Name and kind of the mooring, and the depth of the water [m]."""
    kind = _TYPES[result.type]
    return f"{result.name}: {kind}, {say('depth', result.mooring.water.depth)} of water"


def rows(result: Result) -> Iterator[Row]:
    """The rows of the table, free end first, each clamped instrument below its component."""
    for piece, component in zip(result.mooring.file.pieces, result.components, strict=True):
        values = (
            component.length,
            *_place(result, component.depth_top, component.knockdown),
            math.hypot(component.x_top, component.y_top),
            component.tilt,
            component.tension,
            component.safety_factor,
        )
        marks = {
            "tilt": tilt_mark(piece.component, component.tilt),
            "safety_factor": safety_mark(result, piece.component, component),
        }
        yield Row(component.label, False, component.role == "instrument", _cells(values, marks))
        clamped = {clamp.label: clamp.component for clamp in piece.clamps}
        for clamp in result.clamps:
            if clamp.index == component.index:
                values = (
                    math.nan,
                    *_place(result, clamp.depth, clamp.knockdown),
                    math.hypot(clamp.x, clamp.y),
                    clamp.tilt,
                    clamp.tension,
                    math.nan,
                )
                definition = clamped[clamp.label]
                marks = {"tilt": tilt_mark(definition, clamp.tilt)}
                instrument = definition.role == "instrument"
                yield Row(clamp.label, True, instrument, _cells(values, marks))


def summary(result: Result) -> list[Phrase]:
    """The two ends of the line in words: the top, and the loads on the anchor."""
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
    mark = Mark.BEYOND if anchor.weight < anchor.required_weight else Mark.NONE
    return [
        Phrase(f"Top {at}"),
        Phrase(f"Anchor pulled by {pull}"),
        Phrase(f"Anchor weighs {weighs}", mark),
    ]


def convergence(result: Result) -> str:
    """How the solution was reached and how good it is."""
    accuracy = result.accuracy
    return (
        f"{result.status.capitalize()} in {result.iterations} marches of {result.segments} "
        f"segments, good to {accuracy.depth:.2g} m and {accuracy.tension:.2g} N; anchor missed by "
        f"{abs(result.miss):.1g} m, forces closed to {result.closure:.1g}."
    )


def _place(result: Result, depth: float, knockdown: float) -> tuple[float, float, float]:
    return depth, result.mooring.water.depth - depth, knockdown


def _cells(values: tuple[float, ...], marks: dict[str, Mark]) -> tuple[Phrase, ...]:
    return tuple(
        Phrase(QUANTITIES[name].format(value), marks.get(name, Mark.NONE))
        for name, value in zip(COLUMNS, values, strict=True)
    )
