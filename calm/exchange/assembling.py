"""A mooring or a tow as parts that other programs can take."""

from __future__ import annotations

import numpy as np

from calm.case import Mooring, Tow
from calm.errors import NoEquilibrium, UsageError
from calm.exchange.parts import ExportedLine, ExportedPart
from calm.physics.line import Line, Water
from calm.physics.reference import REFERENCE_DENSITY

_DIGITS = 9  # of a speed in m/s


def assembled(mooring: Mooring | Tow) -> ExportedLine:
    """The parts of a mooring or a tow.

    Raises
    ------
    NoEquilibrium
        A piece is to be cut to fit, and no length does.
    """
    file, water, line = mooring.file, mooring.water, mooring.line
    if file.environment.fluid == "air":
        raise UsageError(f"{file.path} is towed in air; the other programs know water alone")
    secant = _secants(mooring)
    depths = _depths(line, water, isinstance(mooring, Tow))
    parts = []
    for i in range(len(line.length)):
        piece = file.pieces[i]
        density = float(water.at(np.array(depths[i]))[1])
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
    wind = file.environment.wind
    riding, windage = _riding(mooring)
    anchor = None
    tow = None
    if isinstance(mooring, Tow):
        keys = mooring.keys
        tow = keys.speed, keys.toward, keys.height
    else:
        anchor = file.anchor, mooring.anchor_weight
    return ExportedLine(
        name=file.name,
        description=file.description,
        parts=tuple(parts),
        anchor=anchor,
        depth=float(water.depth),
        levels=_levels(water, 2.0 * float(line.length.sum()) if tow else float(water.depth)),
        gravity=float(water.gravity),
        wind=(0.0, 0.0) if wind is None else (wind.speed, wind.toward),
        tow=tow,
        afloat=(_reaches(mooring), line.floating is not None and line.floating.hull is not None),
        riding=riding,
        windage=windage,
        unsaid=_unsaid(mooring),
        solve=mooring.solve,
    )


def _reaches(mooring: Mooring | Tow) -> bool:
    """Whether a mooring floats at the surface; by its length where it has no equilibrium."""
    if isinstance(mooring, Tow):
        return False
    try:
        return mooring.solve().type == "surface"
    except NoEquilibrium:
        whole = mooring.line.anchor_height + float(mooring.line.length.sum())
        return whole >= float(mooring.water.depth)


def _riding(mooring: Mooring | Tow) -> tuple[tuple[float, float], tuple[float, float]]:
    """How the float stands at the surface here: `riding` and `windage` of `ExportedLine`."""
    floating = mooring.line.floating
    if not _reaches(mooring):
        return (1.0, 1.0), (0.0, 1.0)
    assert isinstance(mooring, Mooring)
    try:
        used = mooring.solve().top.used_buoyancy
    except NoEquilibrium:
        used = 1.0
    if floating is None:
        return (used, 1.0), (0.0, 1.0)
    seen = floating.riding(used).drag
    area = floating.wind_area
    if area is None:
        area = 0.0 if floating.hull is None else floating.hull.area * (1.0 - seen)
    return (used, seen), (area, floating.wind_cd)


def _secants(mooring: Mooring | Tow) -> dict[int, float]:
    """Stiffness of the pieces that stretch by a table, as it is at their tension here [N]."""
    curves = mooring.line.elongation
    if not any(curves):
        return {}
    rows = mooring.solve().components
    secants = {}
    for i, curve in enumerate(curves):
        if curve is not None:
            strain = rows[i].length / rows[i].cut_length - 1.0
            tension = (rows[i].tension_top + rows[i].tension_bottom) / 2.0
            secants[i] = tension / strain if strain > 0.0 else 0.0
    return secants


def _depths(line: Line, water: Water, towed: bool) -> list[float]:
    """Depths of the middle of every piece, upright above the anchor or below the ship [m]."""
    below = np.cumsum(line.length) - line.length / 2.0
    if not towed:
        below += float(water.depth) - line.anchor_height - float(line.length.sum())
    return [max(float(depth), 0.0) for depth in below]


def _levels(water: Water, deepest: float) -> tuple[tuple[float, float, float, float, float], ...]:
    """Rows of depth, u, v, w and density, from the surface to the seabed."""
    inside = [float(depth) for depth in water.level if 0.0 < depth < deepest]
    rows = []
    for depth in (0.0, *inside, deepest):
        u, v, w, density = (
            round(float(np.interp(depth, water.level, values)), _DIGITS) + 0.0
            for values in (water.u, water.v, water.w, water.density)
        )
        rows.append((depth, u, v, w, density))
    return tuple(rows)


def _unsaid(mooring: Mooring | Tow) -> tuple[str, ...]:
    """What a mooring file says that other programs do not know."""
    file = mooring.file
    unsaid = [
        "limits of the design check, strengths, ratings and tilts of components",
    ]
    if file.solver.strumming is not None:
        unsaid.append("strumming: the drag of cables is that at rest")
    if file.solver.drag == "reynolds":
        unsaid.append("`drag: reynolds`: drags are those of the constant coefficients")
    if file.solver.friction != "berteaux":
        unsaid.append(f"`friction: {file.solver.friction}`")
    if any(mooring.line.elongation):
        unsaid.append("elongation tables: stiffness is that at the tension found here")
    if any(mooring.line.lift) or any(mooring.line.clamp_lift):
        unsaid.append("lift of towed bodies")
    return tuple(unsaid)
