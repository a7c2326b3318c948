"""Export a mooring file to another program, in one of the registered formats."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from calm.case import load
from calm.case.leg import Leg
from calm.case.leg_result import LegResult
from calm.errors import NoEquilibrium, UsageError, unknown
from calm.exchange.exported_parts import (
    ExportedDesign,
    ExportedLine,
    ExportedPart,
    ExportedTow,
    Levels,
)
from calm.exchange.registry import Exported, FileFormat, file_format, file_formats
from calm.physics.line import Water
from calm.physics.seawater import REFERENCE_DENSITY
from calm.records.profile_tables import components

_DIGITS = 9  # digits of a speed in m/s


def export_file(
    path: Path, to: str, *, environment: str | None = None, catalogs: Sequence[Path] = ()
) -> Exported:
    """Convert a mooring or a tow to the file of another program.

    `to` is a registered format, and `environment` a name in the file or the path of an environment
    file.

    Raises
    ------
    InputError
        The file has mistakes.
    NoEquilibrium
        The format, or a fitted length, needs an equilibrium that does not exist.
    UsageError
        The format is unknown, or cannot represent the design.
    """
    chosen = written_format(to)
    assert chosen.write is not None
    read = load(path, environment, list(catalogs))
    if not read.several:
        line = _exported_line(read.leg, lambda: read.solve().leg)
        return chosen.write(ExportedDesign(line.name, (line,)))
    if not chosen.writes_nets:
        others = " or ".join(f"`--to {one.name}`" for one in file_formats() if one.writes_nets)
        raise UsageError(f"{path} is a net of legs, which {to} does not support; use {others}")
    legs = tuple(
        replace(
            _exported_line(found.leg, partial(_known, found)),
            ends=(found.leg.top, found.leg.bottom),
        )
        for found in read.solve().legs
    )
    return chosen.write(ExportedDesign(read.file.name, legs))


def written_format(to: str) -> FileFormat:
    """Return the format with a given name; raise UsageError if CALM cannot write this format."""
    try:
        chosen = file_format(to)
    except KeyError:
        chosen = None
    if chosen is None or chosen.write is None:
        written = [one.name for one in file_formats() if one.write is not None]
        what = f"--to: `{to}` is not a format that CALM writes"
        raise UsageError(unknown(what, to, written))
    return chosen


def _known(leg: LegResult) -> LegResult:
    return leg


Solve = Callable[[], LegResult]


def _exported_line(leg: Leg, solve: Solve) -> ExportedLine:
    file, water, line = leg.file, leg.water, leg.line
    if file.environment.fluid == "air":
        raise UsageError(f"{file.path} is towed in air; the other programs support only water")
    secant = _secant_stiffness(leg, solve)
    # depth of the middle of each piece, in a tow
    depths = np.cumsum(line.length) - line.length / 2.0
    if not leg.towed:  # a mooring: heights are counted from the seabed
        depths += float(water.depth) - line.anchor_height - float(line.length.sum())
    depths = np.maximum(depths, 0.0)
    parts = []
    for i in range(len(line.length)):
        piece = file.pieces[i]
        density = float(water.density_at(np.array(depths[i])))
        excess = (density - REFERENCE_DENSITY) * float(water.gravity)
        on = [k for k in range(len(line.clamp_at)) if line.clamp_piece[k] == i]
        clamps = tuple(
            (
                ExportedPart(
                    clamp.use, clamp.label, clamp.component.role, clamp.component, False,
                    float(getattr(clamp.component, "length", 0.0)),
                    float(line.clamp_buoyancy[k]),
                    float(line.clamp_buoyancy[k] + excess * line.clamp_volume[k]), density,
                    float(line.clamp_drag[k]), float(line.clamp_drag[k]), False, 0.0,
                ),
                float(line.clamp_at[k]),
            )
            for k, clamp in zip(on, piece.clamps, strict=True)
        )  # fmt: skip
        compliance = float(line.compliance[i])
        stiffness = secant.get(i, 1.0 / compliance if compliance else 0.0)
        parts.append(
            ExportedPart(
                piece.use, piece.label, piece.component.role, piece.component,
                bool(line.flexible[i]), float(line.length[i]), float(line.buoyancy[i]),
                float(line.buoyancy[i] + excess * line.volume[i]), density,
                float(line.normal_drag[i]), float(line.tangential_drag[i]),
                bool(line.directional[i]), stiffness, clamps,
            )
        )  # fmt: skip
    wind, anchor, tow = file.environment.wind, None, None
    if (keys := file.tow) is not None:
        tow = ExportedTow(*components(keys.speed, keys.toward), keys.height)
    else:
        anchor = file.anchor, leg.anchor_weight
    afloat, riding, windage = _at_the_surface(leg, solve)
    return ExportedLine(
        name=file.name,
        parts=tuple(parts),
        anchor=anchor,
        depth=float(water.depth),
        levels=_levels(water, 2.0 * float(line.length.sum()) if tow else float(water.depth)),
        gravity=float(water.gravity),
        wind=(0.0, 0.0) if wind is None else components(wind.speed, wind.toward),
        tow=tow,
        afloat=afloat,
        has_draft=line.floating is not None and line.floating.hull is not None,
        riding=riding,
        windage=windage,
        omitted=_omitted(leg),
        solve=solve,
    )


def _at_the_surface(
    leg: Leg, solve: Solve
) -> tuple[bool, tuple[float, float], tuple[float, float]]:
    """Return the values of the attributes `afloat`, `riding` and `windage` of `ExportedLine`."""
    below, line = (False, (1.0, 1.0), (0.0, 1.0)), leg.line
    if leg.towed:
        return below
    try:
        result = solve()
        afloat, used = result.type == "surface", result.top.used_buoyancy
    except NoEquilibrium:
        whole = line.anchor_height + float(line.length.sum())
        afloat, used = whole >= float(leg.water.depth), 1.0
    if not afloat:
        return below
    floating = line.floating
    if floating is None:
        return True, (used, 1.0), (0.0, 1.0)
    seen = floating.riding(used).drag
    area = floating.wind_area
    if area is None:
        area = 0.0 if floating.hull is None else floating.hull.area * (1.0 - seen)
    return True, (used, seen), (area, floating.wind_cd)


def _secant_stiffness(leg: Leg, solve: Solve) -> dict[int, float]:
    """Return the secant stiffness EA [N] in equilibrium, by index of the piece."""
    curves = leg.line.elongation
    if not any(curves):
        return {}
    rows = solve().components
    secants = {}
    for i, curve in enumerate(curves):
        if curve is not None:
            strain = rows[i].length / rows[i].cut_length - 1.0
            tension = (rows[i].tension_top + rows[i].tension_bottom) / 2.0
            secants[i] = tension / strain if strain > 0.0 else 0.0
    return secants


def _levels(water: Water, deepest: float) -> Levels:
    inside = [float(depth) for depth in water.level if 0.0 < depth < deepest]
    rows = []
    for depth in (0.0, *inside, deepest):
        u, v, w, density = (
            round(float(np.interp(depth, water.level, values)), _DIGITS) + 0.0
            for values in (water.u, water.v, water.w, water.density)
        )
        rows.append((depth, u, v, w, density))
    return tuple(rows)


def _omitted(leg: Leg) -> tuple[str, ...]:
    file = leg.file
    omitted = ["limits of the design check; strengths, depth ratings and tilt limits of components"]
    if file.solver.strumming is not None:
        omitted.append("strumming: the exported drag of cables does not include its effect")
    anchor = leg.bottom.anchor
    if file.environment.seabed is not None or (anchor is not None and anchor.depth is not None):
        omitted.append(
            "the slope of the seabed: the exported seabed is level, at the depth of the deepest "
            "anchor"
        )
    if file.solver.drag == "reynolds":
        omitted.append("`drag: reynolds`: the constant coefficients are written")
    if file.solver.friction != "berteaux":
        omitted.append(f"`friction: {file.solver.friction}`")
    if any(leg.line.elongation):
        omitted.append("elongation tables: the stiffness at the computed tension is written")
    if any(leg.line.lift) or any(leg.line.clamp_lift):
        omitted.append("lift of towed bodies")
    return tuple(omitted)
