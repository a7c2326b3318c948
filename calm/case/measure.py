"""Figures measured on a solution: pieces, clamps, shape and anchor, and the result they make."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import isnan, nan
from typing import TYPE_CHECKING

import numpy as np

from calm.assemble import net_buoyancy
from calm.case.result import Accuracy, AnchorLoad, Result, Top
from calm.case.result_tables import ClampRow, Clamps, ComponentRow, Components, Shape
from calm.case.strumming import strumming_of
from calm.case.warnings import warnings_of
from calm.files import Clamp, Piece
from calm.files.pieces import clamps_down, clamps_in, parts_of
from calm.physics.line import Floats, Water
from calm.physics.seabed import required_weight
from calm.physics.seawater import REFERENCE_DENSITY
from calm.physics.track import head_count
from calm.solve import Solution, Status

if TYPE_CHECKING:
    from calm.case.mooring import Mooring


def measured(solution: Solution, still: Solution | None = None) -> dict[str, Floats]:
    """Figures of the pieces that are solved for, first-listed first, as columns of `Components`.

    `still` is the same line in still water, for the knockdown; without it that is NaN.
    """
    towed = solution.line.towed
    ahead = slice(None, None, -1) if towed else slice(None)
    first, last = solution.piece_nodes.T
    upper, lower = (last[ahead], first[ahead]) if towed else (first, last)
    top, bottom = solution.position[upper], solution.position[lower]
    tension = solution.tension
    greatest = np.maximum(np.maximum.reduceat(tension[:-1], first), tension[last])[ahead]
    hanging = np.where(np.arange(len(tension)) <= solution.hanging, tension, np.inf)
    least = np.minimum(np.minimum.reduceat(hanging[:-1], first), hanging[last])[ahead]
    chord = top - bottom
    pull = solution.force[upper] + solution.force[lower]
    lean = np.where(
        np.linalg.norm(chord, axis=1) > 0, leaning_of(chord), leaning_of(-pull if towed else pull)
    )
    head = 0 if solution.pulled else head_count(solution.line)
    if head and (top[0] != bottom[head - 1]).any():
        lean[:head] = leaning_of(top[0] - bottom[head - 1])
    knockdown = np.full(len(first), np.nan)
    if still is not None:
        before = still.piece_nodes[ahead, 1 if towed else 0]
        knockdown = still.position[before, 2] - top[:, 2]
    return {
        "depth_top": -top[:, 2],
        "depth_bottom": -bottom[:, 2],
        "x_top": top[:, 0],
        "y_top": top[:, 1],
        "x_bottom": bottom[:, 0],
        "y_bottom": bottom[:, 1],
        "tension_top": tension[upper],
        "tension_bottom": tension[lower],
        "tension": greatest,
        "least_tension": np.where(np.isfinite(least), least, np.nan),
        "tilt": lean,
        "knockdown": knockdown,
    }


def components_of(
    pieces: Sequence[Piece], solution: Solution, still: Solution | None = None
) -> Components:
    """The pieces that are solved for, first-listed first.

    Parameters
    ----------
    pieces : in the order of the file, an anchor left out
    still : the same line in still water, for the knockdown
    """
    ahead = slice(None, None, -1) if solution.line.towed else slice(None)
    found = measured(solution, still)
    tension = found["tension"]
    stretched = np.zeros(len(pieces))
    np.add.at(stretched, solution.element_piece, solution.cut * (1.0 + solution.strain))
    breaking, working = (_figures(pieces, name) for name in ("breaking_load", "working_load"))
    return Components(
        part=list(pieces),
        index=np.array([piece.index for piece in pieces]),
        use=[piece.use for piece in pieces],
        label=[piece.label for piece in pieces],
        kind=[piece.component.kind for piece in pieces],
        role=[piece.component.role for piece in pieces],
        length=stretched[ahead],
        cut_length=solution.line.length[ahead],
        safety_factor=breaking / np.where(tension > 0, tension, np.nan),
        utilisation=tension / working,
        reynolds=_reynolds(pieces, solution)[ahead] * _figures(pieces, "diameter"),
        **found,
    )


def clamps_of(pieces: Sequence[Piece], solution: Solution, still: Solution | None = None) -> Clamps:
    """The clamped instruments, those on the first-listed piece first, down each piece."""
    order = clamps_in(pieces)
    elements = np.flatnonzero(solution.element_clamp >= 0)
    index = solution.element_piece[elements]
    if solution.line.towed:
        elements = elements[::-1]
        index = len(pieces) - 1 - index[::-1]
    which = solution.element_clamp[elements]
    position = solution.position[elements]
    knockdown = np.full(len(elements), np.nan)
    if still is not None:
        before = still.position[np.flatnonzero(still.element_clamp >= 0)]
        ahead = slice(None, None, -1) if solution.line.towed else slice(None)
        knockdown = before[ahead, 2] - position[:, 2]
    # on a rigid piece it leans as that does, on a cable as the line pulls, above and below it alike
    pull = solution.force[elements] + solution.force[elements + 1]
    towed = solution.line.towed
    cable = solution.line.flexible[solution.element_piece[elements]]
    tilt = leaning_of(-pull if towed else pull)
    if not cable.all():
        tilt = np.where(cable, tilt, measured(solution)["tilt"][index])
    clamps = [order[m] for m in which]
    return Clamps(
        part=clamps,
        index=index,
        use=[clamp.use for clamp in clamps],
        label=[clamp.label for clamp in clamps],
        depth=-position[:, 2],
        x=position[:, 0],
        y=position[:, 1],
        tension=np.maximum(solution.tension[elements], solution.tension[elements + 1]),
        tilt=tilt,
        knockdown=knockdown,
    )


def shape_of(solution: Solution) -> Shape:
    """The line node by node."""
    chord = solution.position[:-1] - solution.position[1:]
    if solution.line.towed:
        chord = -chord
    lengthy = np.linalg.norm(chord, axis=1) > 0
    # a point without length leans as the segment above it, the first ones as the one below
    last = np.maximum.accumulate(np.where(lengthy, np.arange(len(chord)), -1))
    first = int(np.argmax(lengthy))
    leaning = leaning_of(chord)[np.where(last >= 0, last, first)]
    position = solution.position
    return Shape(
        depth=-position[:, 2],
        x=position[:, 0],
        y=position[:, 1],
        tension=solution.tension,
        tilt=np.concatenate([leaning[:1], leaning]),
    )


def result_of(mooring: Mooring, solution: Solution, still: Solution | None) -> Result:
    """The result of a solution; `still` is None where the shape in still water is not unique."""
    pieces = mooring.file.pieces
    above = components_of(pieces[:-1], solution, still)
    components = with_anchor(above, pieces[-1], mooring.water.depth)
    clamps = clamps_of(pieces[:-1], solution, still)
    for clamp in clamps_down(pieces[-1:]):
        clamps = clamps.with_row(on_anchor(clamp, components[-1]))
    knockdown, riding = float(components.knockdown[0]), solution.riding
    shape = shape_of(solution)
    still_shape = shape if still is solution else None if still is None else shape_of(still)
    result = Result(
        mooring=mooring,
        name=mooring.file.name,
        type="surface" if solution.surface else "subsurface",
        status=Status.CONVERGED.label,
        iterations=solution.marches,
        segments=solution.segments,
        miss=solution.miss,
        closure=solution.closure,
        accuracy=_accuracy(mooring, solution),
        top=Top(
            depth=float(components.depth_top[0]),
            x=float(components.x_top[0]),
            y=float(components.y_top[0]),
            knockdown=None if still is None else knockdown,
            used_buoyancy=solution.buoyancy_used,
            reserve=solution.reserve,
            draft=None if riding is None or isnan(riding.draft) else riding.draft,
            freeboard=None if riding is None or isnan(riding.freeboard) else riding.freeboard,
        ),
        anchor=anchor_load(mooring, solution),
        strumming=strumming_of(mooring.file.solver, solution),
        components=components,
        clamps=clamps,
        shape=shape,
        still_shape=still_shape,
        other=solution.other,
    )
    return replace(result, warnings=warnings_of(result, solution))


def with_anchor(above: Components, anchor: Piece, depth: float) -> Components:
    """The components with the anchor, which stands upright below the line's end."""
    line_end = above[-1]
    pull, height = line_end.tension_bottom, anchor.length or 0.0
    breaking, working = anchor.component.breaking_load, anchor.component.working_load
    row = replace(
        line_end,
        part=anchor,
        index=anchor.index,
        use=anchor.use,
        label=anchor.label,
        kind=anchor.component.kind,
        role=anchor.component.role,
        length=height,
        cut_length=height,
        depth_top=line_end.depth_bottom,
        depth_bottom=depth,
        x_top=line_end.x_bottom,
        y_top=line_end.y_bottom,
        tension_top=pull,
        tension=pull,
        least_tension=pull,
        tilt=0.0,
        knockdown=0.0,
        safety_factor=breaking / pull if breaking and pull else nan,
        utilisation=pull / working if working else nan,
        reynolds=nan,
    )
    return above.with_row(row)


def on_anchor(clamp: Clamp, anchor: ComponentRow) -> ClampRow:
    """Return what is clamped on the anchor stands still with it, and is held with the line's
    pull.
    """
    return ClampRow(
        part=clamp,
        index=anchor.index,
        use=clamp.use,
        label=clamp.label,
        depth=anchor.depth_top + clamp.at,
        x=anchor.x_bottom,
        y=anchor.y_bottom,
        tension=anchor.tension,
        tilt=anchor.tilt,
        knockdown=anchor.knockdown,
    )


def anchor_weight_of(anchor: Piece, water: Water) -> float:
    """Weight in the water at the seabed of an anchor with what is clamped on it [N]."""
    density = water.density_at(np.array(water.depth))
    excess = (float(density) - REFERENCE_DENSITY) * water.gravity
    return -sum(
        net_buoyancy(part.component, water.gravity)
        + excess * (part.component.displaced_volume or 0.0)
        for part in parts_of([anchor])
    )


def anchor_load(mooring: Mooring, solution: Solution) -> AnchorLoad:
    """Return what the line of a mooring does to its anchor."""
    force, friction = solution.force[-1], mooring.file.anchor_friction
    vertical, horizontal = float(force[2]), float(np.hypot(force[0], force[1]))
    factor = mooring.file.checks.anchor_factor
    return AnchorLoad(
        tension=float(solution.tension[-1]),
        vertical=vertical,
        horizontal=horizontal,
        angle=float(np.degrees(np.arctan2(horizontal, vertical))),
        required_weight=float(required_weight(vertical, horizontal, factor, friction)),
        weight=mooring.anchor_weight,
        friction=friction,
        grounded_length=solution.grounded_length,
    )


def _accuracy(mooring: Mooring, solution: Solution) -> Accuracy:
    """Return what the solver states of its errors, and what follows for the weight of the
    anchor.
    """
    lift, pull = solution.lift_error, solution.pull_error
    factor = mooring.file.checks.anchor_factor
    return Accuracy(
        depth=solution.depth_error,
        tension=solution.tension_error,
        anchor=max(lift, pull),
        required_weight=float(required_weight(lift, pull, factor, mooring.file.anchor_friction)),
    )


def leaning_of(vector: Floats) -> Floats:
    """Angle of upward-pointing vectors (..., 3) from the vertical [degrees]; 0 for none."""
    horizontal = np.hypot(vector[..., 0], vector[..., 1])
    tilt: Floats = np.degrees(np.arctan2(horizontal, vector[..., 2]))
    return np.where((horizontal > 0) | (vector[..., 2] != 0), tilt, 0.0)


def _figures(pieces: Sequence[Piece], name: str) -> Floats:
    values = [getattr(piece.component, name, None) for piece in pieces]
    return np.array([np.nan if value is None else value for value in values])


def _reynolds(pieces: Sequence[Piece], solution: Solution) -> Floats:
    """(n,) greatest Reynolds number per metre of diameter, in the solver's order [1/m]."""
    middle = -0.5 * (solution.position[:-1] + solution.position[1:])[:, 2]
    speed = np.linalg.norm(solution.water.current_at(middle), axis=1)
    greatest = np.zeros(len(solution.line.length))
    np.maximum.at(greatest, solution.element_piece, speed / solution.water.viscosity_at(middle))
    return greatest
