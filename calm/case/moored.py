"""The result of a moored line: its ends, its anchor, its knockdown."""

from __future__ import annotations

from dataclasses import replace
from math import isnan, nan
from typing import TYPE_CHECKING

import numpy as np

from calm.case.columns import ClampRow, ComponentRow, Components
from calm.case.measure import clamps_down, clamps_of, components_of, shape_of
from calm.case.result import Accuracy, AnchorLoad, Result, Top
from calm.case.strumming import strumming_of
from calm.case.warnings import warnings_of
from calm.files import Clamp, Piece
from calm.physics.anchor import required_weight
from calm.solve import Solution, Status

if TYPE_CHECKING:
    from calm.case.mooring import Mooring


def result_of(mooring: Mooring, solution: Solution, still: Solution | None) -> Result:
    """The result of a solution; `still` is None where the shape in still water is not unique."""
    pieces = mooring.file.pieces
    above = components_of(pieces[:-1], solution, still)
    components = _with_anchor(above, pieces[-1], mooring.water.depth)
    clamps = clamps_of(pieces[:-1], solution, still)
    for clamp in clamps_down(pieces[-1:]):
        clamps = clamps.with_row(_on_anchor(clamp, components[-1]))
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
        other_depth=solution.other_depth,
        other_grounded_length=solution.other_grounded_length,
    )
    return replace(result, warnings=warnings_of(result, solution))


def _with_anchor(above: Components, anchor: Piece, depth: float) -> Components:
    """The components with the anchor, which stands upright below the line's end."""
    line_end = above[-1]
    pull, height = line_end.tension_bottom, anchor.length or 0.0
    breaking, working = anchor.component.breaking_load, anchor.component.working_load
    row = ComponentRow(
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
        x_bottom=0.0,
        y_bottom=0.0,
        tension_top=pull,
        tension_bottom=pull,
        tension=pull,
        least_tension=pull,
        tilt=0.0,
        knockdown=0.0,
        safety_factor=breaking / pull if breaking and pull else nan,
        utilisation=pull / working if working else nan,
        reynolds=nan,
    )
    return above.with_row(row)


def _on_anchor(clamp: Clamp, anchor: ComponentRow) -> ClampRow:
    """What is clamped on the anchor stands still with it, and is held with the line's pull."""
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


def anchor_load(mooring: Mooring, solution: Solution) -> AnchorLoad:
    """What the line of a mooring does to its anchor."""
    force, friction = solution.force[-1], _friction(mooring)
    vertical, horizontal = float(force[2]), float(np.hypot(force[0], force[1]))
    factor = mooring.file.checks.anchor_factor
    return AnchorLoad(
        tension=float(solution.tension[-1]),
        vertical=vertical,
        horizontal=horizontal,
        angle=float(np.degrees(np.arctan2(horizontal, vertical))),
        required_weight=max(required_weight(vertical, horizontal, factor, friction), 0.0),
        weight=mooring.anchor_weight,
        friction=friction,
        grounded_length=solution.grounded_length,
    )


def _accuracy(mooring: Mooring, solution: Solution) -> Accuracy:
    """What the solver states of its errors, and what follows for the weight of the anchor."""
    lift, pull = solution.lift_error, solution.pull_error
    factor = mooring.file.checks.anchor_factor
    return Accuracy(
        depth=solution.depth_error,
        tension=solution.tension_error,
        anchor=max(lift, pull),
        required_weight=required_weight(lift, pull, factor, _friction(mooring)),
    )


def _friction(mooring: Mooring) -> float:
    """Of the anchor on the bed: its own, or that of the checks."""
    own = mooring.file.anchor.friction
    return mooring.file.checks.anchor_friction if own is None else own
