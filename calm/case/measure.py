"""From a solution's nodes to the figures of the result format."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from calm.case.columns import Clamps, Components, Shape
from calm.case.result import Accuracy, AnchorLoad, Result, Top
from calm.case.warnings import warnings_of
from calm.checks.anchor import required_weight
from calm.physics.line import Floats
from calm.physics.track import head_count
from calm.solve import Solution, Status

if TYPE_CHECKING:
    from calm.case.mooring import Mooring
    from calm.files import Piece

KINEMATIC_VISCOSITY = 1.36e-6
"""Of sea water at 10 °C and 35 g/kg [m²/s], for the Reynolds numbers."""


def result_of(mooring: Mooring, solution: Solution, still: Solution | None) -> Result:
    """Measure a solution against its still-water shape (None where that is not unique)."""
    components = _components(mooring, solution, still)
    anchor = _anchor_load(mooring, solution)
    knockdown = float(components.knockdown[0])
    result = Result(
        mooring=mooring,
        name=mooring.file.name,
        type="surface" if solution.surface else "subsurface",
        status=Status.CONVERGED.label,
        iterations=solution.marches,
        segments=solution.segments,
        miss=solution.miss,
        closure=solution.closure,
        accuracy=Accuracy(solution.depth_error, solution.tension_error),
        top=Top(
            depth=float(components.depth_top[0]),
            x=float(components.x_top[0]),
            y=float(components.y_top[0]),
            knockdown=None if still is None else knockdown,
            used_buoyancy=solution.buoyancy_used,
            reserve=solution.reserve,
        ),
        anchor=anchor,
        components=components,
        clamps=_clamps(mooring, solution, still),
        shape=_shape(solution),
        still_shape=None if still is None else _shape(still),
    )
    return replace(result, warnings=warnings_of(result, solution))


def _tilt(vector: Floats) -> Floats:
    """Angle of upward-pointing vectors (..., 3) from the vertical [degrees]; 0 for none."""
    horizontal = np.hypot(vector[..., 0], vector[..., 1])
    tilt: Floats = np.degrees(np.arctan2(horizontal, vector[..., 2]))
    return np.where((horizontal > 0) | (vector[..., 2] != 0), tilt, 0.0)


def _shape(solution: Solution) -> Shape:
    chord = solution.position[:-1] - solution.position[1:]
    lengthy = np.linalg.norm(chord, axis=1) > 0
    # a point without length leans as the segment above it, the first ones as the one below
    last = np.maximum.accumulate(np.where(lengthy, np.arange(len(chord)), -1))
    first = int(np.argmax(lengthy))
    leaning = _tilt(chord)[np.where(last >= 0, last, first)]
    position = solution.position
    return Shape(
        depth=-position[:, 2],
        x=position[:, 0],
        y=position[:, 1],
        tension=solution.tension,
        tilt=np.concatenate([leaning[:1], leaning]),
    )


def _components(mooring: Mooring, solution: Solution, still: Solution | None) -> Components:
    pieces, water = mooring.file.pieces, mooring.water
    nodes = solution.piece_nodes
    top, bottom = solution.position[nodes[:, 0]], solution.position[nodes[:, 1]]
    base = np.array([[0.0, 0.0, -water.depth]])
    top, bottom = np.vstack([top, bottom[-1:]]), np.vstack([bottom, base])
    tension = solution.tension
    greatest = np.maximum.reduceat(tension[:-1], nodes[:, 0])
    greatest = np.append(np.maximum(greatest, tension[nodes[:, 1]]), tension[-1])
    stretched = solution.cut * (1.0 + solution.strain)
    own = pieces[-1].length or 0.0
    chord = (top - bottom)[:-1]
    force = solution.force[nodes].mean(axis=1)
    lean = np.where(np.linalg.norm(chord, axis=1) > 0, _tilt(chord), _tilt(force))
    head = head_count(solution.line)
    if head and (top[0] != bottom[head - 1]).any():
        lean[:head] = _tilt(top[0] - bottom[head - 1])
    knockdown = np.full(len(pieces), np.nan)
    if still is not None:
        before = still.position[still.piece_nodes[:, 0]]
        knockdown = np.append(before[:, 2] - top[:-1, 2], 0.0)
    breaking, working = (_figures(pieces, name) for name in ("breaking_load", "working_load"))
    pulled = np.where(greatest > 0, greatest, np.nan)
    return Components(
        index=np.array([piece.index for piece in pieces]),
        use=[piece.use for piece in pieces],
        label=[piece.label for piece in pieces],
        kind=[piece.component.kind for piece in pieces],
        role=[piece.component.role for piece in pieces],
        length=np.append(np.bincount(solution.element_piece, stretched), own),
        cut_length=np.append(solution.line.length, own),
        depth_top=-top[:, 2],
        depth_bottom=-bottom[:, 2],
        x_top=top[:, 0],
        y_top=top[:, 1],
        x_bottom=bottom[:, 0],
        y_bottom=bottom[:, 1],
        tension_top=np.append(tension[nodes[:, 0]], tension[-1]),
        tension_bottom=np.append(tension[nodes[:, 1]], tension[-1]),
        tension=greatest,
        tilt=np.append(lean, 0.0),
        knockdown=knockdown,
        safety_factor=breaking / pulled,
        utilisation=greatest / working,
        reynolds=np.append(_reynolds(pieces, solution), np.nan),
    )


def _figures(pieces: tuple[Piece, ...], name: str) -> Floats:
    values = [getattr(piece.component, name, None) for piece in pieces]
    return np.array([np.nan if value is None else value for value in values])


def _reynolds(pieces: tuple[Piece, ...], solution: Solution) -> Floats:
    """(n,) greatest Reynolds number of speed and diameter; NaN where there is no diameter."""
    middle = -0.5 * (solution.position[:-1] + solution.position[1:])[:, 2]
    speed = np.linalg.norm(solution.water.at(middle)[0], axis=1)
    greatest = np.zeros(len(solution.line.length))
    np.maximum.at(greatest, solution.element_piece, speed)
    return greatest * _figures(pieces, "diameter")[:-1] / KINEMATIC_VISCOSITY


def _clamps(mooring: Mooring, solution: Solution, still: Solution | None) -> Clamps:
    order = [clamp for piece in mooring.file.pieces for clamp in piece.clamps]
    elements = np.flatnonzero(solution.element_clamp >= 0)
    which = solution.element_clamp[elements]
    position = solution.position[elements]
    tension = np.maximum(solution.tension[elements], solution.tension[elements + 1])
    knockdown = np.full(len(elements), np.nan)
    if still is not None:
        before = still.position[np.flatnonzero(still.element_clamp >= 0)]
        knockdown = before[:, 2] - position[:, 2]
    return Clamps(
        index=solution.element_piece[elements],
        use=[order[m].use for m in which],
        label=[order[m].label for m in which],
        depth=-position[:, 2],
        x=position[:, 0],
        y=position[:, 1],
        tension=tension,
        tilt=_shape(solution).tilt[elements],
        knockdown=knockdown,
    )


def _anchor_load(mooring: Mooring, solution: Solution) -> AnchorLoad:
    anchor, checks = mooring.file.anchor, mooring.file.checks
    force = solution.force[-1]
    vertical, horizontal = float(force[2]), float(np.hypot(force[0], force[1]))
    friction = anchor.friction or checks.anchor_friction
    return AnchorLoad(
        tension=float(solution.tension[-1]),
        vertical=vertical,
        horizontal=horizontal,
        angle=float(np.degrees(np.arctan2(horizontal, vertical))),
        required_weight=required_weight(vertical, horizontal, checks.anchor_factor, friction),
        weight=mooring.anchor_weight,
        grounded_length=solution.grounded_length,
    )
