"""From a solution's nodes to the columns of a result, in the order of the file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from calm.case.columns import Clamps, Components, Shape
from calm.files import Clamp, Piece
from calm.physics.line import Floats
from calm.physics.track import head_count
from calm.solve import Solution


def clamps_in(pieces: Sequence[Piece]) -> list[Clamp]:
    """The clamps of a line in the order of the file, which is that of the solver."""
    return [clamp for piece in pieces for clamp in piece.clamps]


def clamps_down(pieces: Sequence[Piece]) -> list[Clamp]:
    """The clamps of a mooring's line from its top to its anchor, the order of its results."""
    return [clamp for piece in pieces for clamp in sorted(piece.clamps, key=lambda clamp: clamp.at)]


class PieceMeasures(NamedTuple):
    """The n pieces that are solved for, first-listed first.

    Attributes
    ----------
    top, bottom : (n, 3) their ends: east and north of the line's end, and height above the surface
        [m]
    tension_top, tension_bottom, tension, least : at the ends, the greatest and the least of
        what hangs, NaN where nothing does [N]
    tilt : [degrees]
    knockdown : below the same line in still water [m]; NaN where that is not known
    """

    top: Floats
    bottom: Floats
    tension_top: Floats
    tension_bottom: Floats
    tension: Floats
    least: Floats
    tilt: Floats
    knockdown: Floats


def measured(solution: Solution, still: Solution | None = None) -> PieceMeasures:
    """The pieces of a solution; `still` is the same line in still water, for the knockdown."""
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
        np.linalg.norm(chord, axis=1) > 0, _tilt(chord), _tilt(-pull if towed else pull)
    )
    head = head_count(solution.line)
    if head and (top[0] != bottom[head - 1]).any():
        lean[:head] = _tilt(top[0] - bottom[head - 1])
    knockdown = np.full(len(first), np.nan)
    if still is not None:
        knockdown = still.position[still.piece_nodes[:, 0], 2] - top[:, 2]
    return PieceMeasures(
        top=top,
        bottom=bottom,
        tension_top=tension[upper],
        tension_bottom=tension[lower],
        tension=greatest,
        least=np.where(np.isfinite(least), least, np.nan),
        tilt=lean,
        knockdown=knockdown,
    )


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
        depth_top=-found.top[:, 2],
        depth_bottom=-found.bottom[:, 2],
        x_top=found.top[:, 0],
        y_top=found.top[:, 1],
        x_bottom=found.bottom[:, 0],
        y_bottom=found.bottom[:, 1],
        tension_top=found.tension_top,
        tension_bottom=found.tension_bottom,
        tension=found.tension,
        least_tension=found.least,
        tilt=found.tilt,
        knockdown=found.knockdown,
        safety_factor=breaking / np.where(found.tension > 0, found.tension, np.nan),
        utilisation=found.tension / working,
        reynolds=_reynolds(pieces, solution)[ahead] * _figures(pieces, "diameter"),
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
        knockdown = before[:, 2] - position[:, 2]
    # on a rigid piece it leans as that does, on a cable as the line pulls, above and below it alike
    pull = solution.force[elements] + solution.force[elements + 1]
    towed = solution.line.towed
    cable = solution.line.flexible[solution.element_piece[elements]]
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
        tilt=np.where(cable, _tilt(-pull if towed else pull), measured(solution).tilt[index]),
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
    leaning = _tilt(chord)[np.where(last >= 0, last, first)]
    position = solution.position
    return Shape(
        depth=-position[:, 2],
        x=position[:, 0],
        y=position[:, 1],
        tension=solution.tension,
        tilt=np.concatenate([leaning[:1], leaning]),
    )


def _tilt(vector: Floats) -> Floats:
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
    speed = np.linalg.norm(solution.water.at(middle)[0], axis=1)
    greatest = np.zeros(len(solution.line.length))
    np.maximum.at(greatest, solution.element_piece, speed / solution.water.viscosity_at(middle))
    return greatest
