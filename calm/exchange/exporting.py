"""Export a mooring file to another program: its line as parts, written by one of the writers."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from calm.case import load
from calm.case.leg import Leg
from calm.case.leg_result import LegResult
from calm.errors import NoEquilibrium, UsageError, unknown
from calm.exchange.cable_writer import cbl_file
from calm.exchange.exported_parts import ExportedLine, ExportedPart, ExportedTow, Levels
from calm.exchange.mdd_file import mdd_file
from calm.exchange.moordyn_writer import CURRENTS, current_profile, moordyn_file
from calm.physics.line import Water
from calm.physics.seawater import REFERENCE_DENSITY
from calm.records.delimited import table_csv
from calm.records.profile_tables import components

_HEADER = (
    "name", "label", "kind", "role", "clamped at[m]", "length[m]", "diameter[m]", "whole mass[kg]",
    "whole buoyancy[N]", "whole Cd x area[m^2]", "whole tangential Cd x area[m^2]", "EA[N]",
)  # fmt: skip
_DIGITS = 9  # of a speed in m/s


@dataclass(frozen=True)
class Exported:
    """Hold the content of a file for another program, what it cannot hold, and files beside it."""

    content: bytes
    lost: tuple[str, ...]
    beside: dict[str, bytes]


def export_file(
    path: Path, to: str, *, environment: str | None = None, catalogs: Sequence[Path] = ()
) -> Exported:
    """Write a mooring or a tow for another program.

    Parameters
    ----------
    to : one of `WRITERS`
    environment : a name in the file, or an environment file
    catalogs : as `calm.load` takes them

    Raises
    ------
    InputError, NoEquilibrium, UsageError
        The file has mistakes, no length of a piece that is cut to fit is right, or `to` is no
        program.
    """
    if to not in WRITERS:
        raise UsageError(
            unknown(f"--to: `{to}` is not a program that CALM writes for", to, WRITERS)
        )
    read = load(path, environment, list(catalogs))
    if read.several:
        if to != "moordyn":
            raise UsageError(f"{path} is a net of legs; `--to moordyn` takes it, {to} single lines")
        designs = []
        for found in read.solve().legs:
            design = _exported_line(found.leg, partial(_known, found))
            designs.append(replace(design, ends=(found.leg.top, found.leg.bottom)))
        deepest = max(designs, key=lambda design: design.depth)
        designs[0] = replace(designs[0], name=read.file.name, depth=deepest.depth)
        content, lost = moordyn_file(*designs)
        design = deepest
    else:
        design = _exported_line(read.leg, lambda: read.solve().leg)
        content, lost = WRITERS[to](design)
    beside = {CURRENTS: current_profile(design)} if to == "moordyn" else {}
    return Exported(content, lost, beside)


def _known(leg: LegResult) -> LegResult:
    return leg


Solve = Callable[[], LegResult]


def _exported_line(leg: Leg, solve: Solve) -> ExportedLine:
    """Return the parts of a mooring or a tow, of which `solve` finds the equilibrium."""
    file, water, line = leg.file, leg.water, leg.line
    if file.environment.fluid == "air":
        raise UsageError(f"{file.path} is towed in air; the other programs know only water")
    secant = _secants(leg, solve)
    depths = np.cumsum(line.length) - line.length / 2.0  # of the middles, hanging down
    if not leg.towed:  # standing upright
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
    """Return `afloat`, `riding` and `windage` of `ExportedLine`; by length without equilibrium."""
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


def _secants(leg: Leg, solve: Solve) -> dict[int, float]:
    """Stiffness of the pieces that stretch by a table, as it is at their tension here [N]."""
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


def _omitted(leg: Leg) -> tuple[str, ...]:
    """Return what a mooring file says that other programs do not know."""
    file = leg.file
    omitted = ["limits of the design check, strengths, ratings and tilts of components"]
    if file.solver.strumming is not None:
        omitted.append("strumming: cables have their drag at rest")
    anchor = leg.bottom.anchor
    if file.environment.seabed is not None or (anchor is not None and anchor.depth is not None):
        omitted.append("the slope of the seabed: it is level there, as deep as the deepest anchor")
    if file.solver.drag == "reynolds":
        omitted.append("`drag: reynolds`: the constant coefficients are written")
    if file.solver.friction != "berteaux":
        omitted.append(f"`friction: {file.solver.friction}`")
    if any(leg.line.elongation):
        omitted.append("elongation tables: the stiffness at the tension found here is written")
    if any(leg.line.lift) or any(leg.line.clamp_lift):
        omitted.append("lift of towed bodies")
    return tuple(omitted)


def _csv_file(design: ExportedLine) -> tuple[bytes, tuple[str, ...]]:
    """Return the content of the file, and what it cannot hold."""
    lost = ["the water", "hulls and wind: floats drag in full at the surface"]
    if design.tow is not None:
        lost.append("the speed of the ship: a list is a mooring's")
    losses = design.losses(lost)
    rows = [
        row
        for part in design.parts
        for row in (_row(part, None), *(_row(clamp, at) for clamp, at in part.clamps))
    ]
    if design.anchor is not None:
        anchor, weight = design.anchor
        figures = [None, anchor.length, None, anchor.mass, -weight, None, None, None]
        rows.append([*["anchor"] * 4, *figures])
    comments = (f"{design.name}, by CALM; lost:", *losses)
    above = "".join(f"# {' '.join(line.split())}\n" for line in comments)
    return (above + table_csv(_HEADER, rows)).encode(), losses


def _row(part: ExportedPart, at: float | None) -> list[str | float | None]:
    whole = part.length if part.flexible else 1.0
    return [
        part.use,
        part.label,
        part.component.kind,
        part.role,
        at,
        part.length,
        part.diameter or None,
        None if part.mass is None else part.mass * whole,
        part.buoyancy * whole,
        part.area() * whole,
        part.area(along=True) * whole if part.directional else None,
        part.stiffness or None,
    ]


WRITERS: dict[str, Callable[[ExportedLine], tuple[bytes, tuple[str, ...]]]] = {
    "mdd": mdd_file, "cbl": cbl_file, "csv": _csv_file, "moordyn": moordyn_file,
}  # fmt: skip
"""What a mooring can be written for."""
