"""What a result says: the table of its line, and the words around it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from calm.case import TowResult
from calm.checks.finding import State
from calm.files.strumming_keys import BourgetMarichalKeys
from calm.quantities import say
from calm.report.blocks import Line, Note, Part, Prose, Span, Table
from calm.report.line import Mark, line_table
from calm.solve import Status

if TYPE_CHECKING:
    from calm.case import Result
    from calm.case.strumming import StrummingBand

_MOORING_COLUMNS = (
    "length",
    "depth",
    "height",
    "knockdown",
    "offset",
    "tilt",
    "tension",
    "safety_factor",
)
_TOW_COLUMNS = ("length", "depth", "layback", "tilt", "tension", "safety_factor")
_NOTE = "of the upper end. Tension: the greatest in the piece. ~ near a limit, ! beyond it."
_TYPES = {"subsurface": "sub-surface mooring", "surface": "surface mooring"}


@dataclass(frozen=True)
class Sheet:
    """Everything a result says.

    Attributes
    ----------
    title : name and kind
    table : a row for each component and each clamped instrument, in file order
    summary : the two ends of the line in words, the warnings below them
    convergence : how the solution was reached and how good it is
    """

    title: str
    table: Table
    summary: tuple[Prose, ...]
    convergence: str


def sheet(result: Result | TowResult, *, places: bool = False) -> Sheet:
    """What a mooring or a tow says; in a report its clamps have their places on their pieces."""
    if isinstance(result, TowResult):
        return _tow(result, places)
    return _mooring(result, places)


def result_part(result: Result | TowResult) -> Part:
    """A result in short: it fits 80 columns, where long labels wrap.

    A figure beyond its limit carries ``!`` and one near it ``~``, so that nothing hangs on colour.
    """
    said = sheet(result)
    note = Note((said.table.note, said.convergence))
    return Part(said.title, (replace(said.table, note=""), *said.summary, note))


def _summary(result: Result | TowResult, *lines: Line) -> tuple[Prose, ...]:
    warned = (Prose(result.warnings, State.WARN),) if result.warnings else ()
    return (Prose(lines), *warned)


def _mooring(result: Result, places: bool) -> Sheet:
    depth = say("depth", result.file.environment.depth)
    return Sheet(
        title=f"{result.name}: {_TYPES[result.type]}, {depth} of water",
        table=line_table(
            result, _MOORING_COLUMNS, f"Depth, height and offset: {_NOTE}", places=places
        ),
        summary=_mooring_summary(result),
        convergence=_convergence(result, "anchor"),
    )


def _mooring_summary(result: Result) -> tuple[Prose, ...]:
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
    mark = Mark.BEYOND if anchor.weight < anchor.required_weight else Mark.NONE
    hull = f"Hull: draft {say('draft', top.draft)}, freeboard {say('freeboard', top.freeboard)}"
    return _summary(
        result,
        f"Top {at}",
        *([hull] if top.draft is not None else []),
        f"Anchor pulled by {pull}",
        (Span(f"Anchor weighs {weighs} {mark}".rstrip(), mark.state),),
        *_strumming(result),
    )


def _tow(result: TowResult, places: bool) -> Sheet:
    return Sheet(
        title=f"{result.name}: tow at {say('speed', result.speed)} towards {result.toward:.0f}°",
        table=line_table(result, _TOW_COLUMNS, f"Depth and layback: {_NOTE}", places=places),
        summary=_tow_summary(result),
        convergence=_convergence(result, "tow point"),
    )


def _tow_summary(result: TowResult) -> tuple[Prose, ...]:
    """The loads at the ship, and where the body is."""
    point, body = result.tow_point, result.body
    way = "down" if point.vertical >= 0.0 else "up"
    return _summary(
        result,
        (
            f"Tow point pulled by {_pull(point.tension, point.angle)}: "
            f"{say('vertical', abs(point.vertical))} {way}, "
            f"{say('horizontal', point.horizontal)} back"
        ),
        (
            f"Body {_level(result, body.depth)}, layback {say('layback', body.layback)}; "
            f"pulled by {_pull(body.tension, body.angle)}"
        ),
        *_strumming(result),
    )


def _strumming(result: Result | TowResult) -> tuple[str, ...]:
    """How fast the cables vibrate and what that makes of their drag; or what it would make."""
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
    """What the line would do with more drag on its cables."""
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
    """How deep the body is, or how high it flies."""
    if result.file.environment.fluid == "air":
        return f"{say('depth', depth + result.tow.keys.height)} below the tow point"
    return f"{say('depth', depth)} deep" if depth >= 0.0 else f"{say('depth', -depth)} in the air"


def _convergence(result: Result | TowResult, end: str) -> str:
    """How the solution was reached and how good it is; `end` is where the line is held."""
    accuracy = result.accuracy
    pull = "" if accuracy.anchor is None else f", at the anchor {accuracy.anchor:.2g} N"
    return (
        f"{result.status.capitalize()} in {result.iterations} marches of {result.segments} "
        f"segments, good to {accuracy.depth:.2g} m and {accuracy.tension:.2g} N{pull}; {end} "
        f"missed by {abs(result.miss):.1g} m, forces closed to {result.closure:.1g}."
    )
