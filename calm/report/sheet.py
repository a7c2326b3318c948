"""The words around the rows: of a mooring, and of a tow."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from calm.case import TowResult
from calm.files.strumming import BourgetMarichalKeys
from calm.quantities import say
from calm.report.limits import Mark
from calm.report.rows import Phrase, Sheet, convergence, rows
from calm.solve import Status

if TYPE_CHECKING:
    from calm.case import Result
    from calm.case.band import StrummingBand

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


def sheet(result: Result | TowResult) -> Sheet:
    """What the table of a mooring or a tow says."""
    return _tow(result) if isinstance(result, TowResult) else _mooring(result)


def _mooring(result: Result) -> Sheet:
    depth = say("depth", result.file.environment.depth)
    return Sheet(
        title=f"{result.name}: {_TYPES[result.type]}, {depth} of water",
        columns=_MOORING_COLUMNS,
        rows=tuple(rows(result, _MOORING_COLUMNS)),
        summary=_mooring_summary(result),
        warnings=result.warnings,
        note=f"Depth, height and offset: {_NOTE}",
        convergence=convergence(result, "anchor"),
    )


def _mooring_summary(result: Result) -> tuple[Phrase, ...]:
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
    return (
        Phrase(f"Top {at}"),
        *([Phrase(hull)] if top.draft is not None else []),
        Phrase(f"Anchor pulled by {pull}"),
        Phrase(f"Anchor weighs {weighs}", mark),
        *_strumming(result),
    )


def _tow(result: TowResult) -> Sheet:
    return Sheet(
        title=f"{result.name}: tow at {say('speed', result.speed)} towards {result.toward:.0f}°",
        columns=_TOW_COLUMNS,
        rows=tuple(rows(result, _TOW_COLUMNS)),
        summary=_tow_summary(result),
        warnings=result.warnings,
        note=f"Depth and layback: {_NOTE}",
        convergence=convergence(result, "tow point"),
    )


def _tow_summary(result: TowResult) -> tuple[Phrase, ...]:
    """The loads at the ship, and where the body is."""
    point, body = result.tow_point, result.body
    way = "down" if point.vertical >= 0.0 else "up"
    return (
        Phrase(
            f"Tow point pulled by {_pull(point.tension, point.angle)}: "
            f"{say('vertical', abs(point.vertical))} {way}, "
            f"{say('horizontal', point.horizontal)} back"
        ),
        Phrase(
            f"Body {_level(result, body.depth)}, layback {say('layback', body.layback)}; "
            f"pulled by {_pull(body.tension, body.angle)}"
        ),
        *_strumming(result),
    )


def _strumming(result: Result | TowResult) -> tuple[Phrase, ...]:
    """How fast the cables vibrate and what that makes of their drag; or what it would make."""
    strumming, band = result.strumming, result.strumming_band
    if strumming is not None:
        together = isinstance(result.file.solver.strumming, BourgetMarichalKeys)
        frequency = f"{'' if together else 'up to '}{say('frequency', strumming.frequency)}"
        least, greatest = say("cn", strumming.cn_min), say("cn", strumming.cn_max)
        return (Phrase(f"Strumming at {frequency}, Cn from {least} to {greatest}"),)
    if band is not None:
        return (Phrase(f"If the cables strum, Cn × {band.factor:g}: {_with(result, band)}"),)
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
