"""Figures measured on a solution: pieces, clamps, shape and anchor, and the result they make."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import isnan
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from calm.assemble import net_buoyancy
from calm.case.line_figures import ClampFigures, LineFigures, NodeFigures
from calm.case.result import Result
from calm.case.result_tables import (
    Accuracy,
    AnchorLoad,
    ClampRow,
    Clamps,
    ComponentRow,
    Components,
    LineEnd,
    OnAnchor,
    Shape,
    Top,
)
from calm.case.strumming import strumming_of
from calm.case.warnings import warnings_of
from calm.files import Clamp, Piece
from calm.files.mooring_file import clamps_down, parts_of
from calm.physics.line import Water
from calm.physics.seabed import required_weight
from calm.physics.seawater import REFERENCE_DENSITY
from calm.solve import Solution, Status

if TYPE_CHECKING:
    from calm.case.mooring import Mooring

T = TypeVar("T", Components, Clamps)


def components_of(
    pieces: Sequence[Piece], solution: Solution, still: Solution | None = None
) -> Components:
    """The pieces that are solved for, first-listed first.

    Parameters
    ----------
    pieces : in the order of the file, an anchor left out
    still : the same line in still water, for the knockdown
    """
    line = LineFigures(solution, still, pieces)
    return Components.made(pieces, lambda column: column.found and column.found(line))


def clamps_of(pieces: Sequence[Piece], solution: Solution, still: Solution | None = None) -> Clamps:
    """The clamped instruments, those on the first-listed piece first, down each piece."""
    held = ClampFigures(pieces, solution, still)
    return Clamps.made(held.clamps, lambda column: column.found and column.found(held))


def shape_of(solution: Solution) -> Shape:
    """The line node by node."""
    nodes = NodeFigures(solution)
    return Shape(**{one.name: one.found(nodes) for one in Shape.columns() if one.found})


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
    end = LineEnd(above[-1], anchor, depth)
    return Components.joined([above, _standing(Components, anchor, end)])


def on_anchor(clamp: Clamp, anchor: ComponentRow) -> ClampRow:
    """Make the row of a clamp on the anchor, which stands still with it."""
    return _standing(Clamps, clamp, OnAnchor(clamp, anchor))[0]


def _standing(table: type[T], part: Piece | Clamp, end: LineEnd | OnAnchor) -> T:
    """Make the row of an anchor, or of a clamp on it, as a table."""
    return table.made([part], lambda column: np.array([column.at_anchor and column.at_anchor(end)]))


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
