"""Positions and loads at the ends of a leg."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, replace
from math import atan2, degrees, hypot, isnan, nan

import numpy as np

from calm.case.leg import Leg
from calm.case.result_tables import (
    Accuracy,
    AnchorLoad,
    Components,
    EndLoad,
    Top,
    TowedBody,
    TowPoint,
)
from calm.physics.line import Floats
from calm.physics.seabed import required_weight
from calm.solve import Solution


def anchor_load(leg: Leg, solution: Solution) -> AnchorLoad:
    """Return the load of a leg on its anchor; the values are NaN for a leg without an anchor."""
    if not leg.anchored:
        return AnchorLoad(**{each.name: nan for each in fields(AnchorLoad)})
    force, friction = solution.force[-1], leg.file.anchor_friction
    vertical, horizontal = float(force[2]), float(np.hypot(force[0], force[1]))
    factor = leg.file.checks.anchor_factor
    return AnchorLoad(
        tension=float(solution.tension[-1]),
        vertical=vertical,
        horizontal=horizontal,
        angle=float(np.degrees(np.arctan2(horizontal, vertical))),
        required_weight=float(required_weight(vertical, horizontal, factor, friction)),
        weight=leg.anchor_weight,
        friction=friction,
        grounded_length=solution.grounded_length,
    )


def accuracy_of(leg: Leg, solution: Solution) -> Accuracy:
    """Return the error estimates of the solver, and the resulting error in the required anchor
    weight.
    """
    if leg.towed:
        return Accuracy(solution.depth_error, solution.tension_error)
    lift, pull = solution.lift_error, solution.pull_error
    factor = leg.file.checks.anchor_factor
    return Accuracy(
        depth=solution.depth_error,
        tension=solution.tension_error,
        anchor=max(lift, pull),
        required_weight=float(required_weight(lift, pull, factor, leg.file.anchor_friction)),
    )


def top_of(solution: Solution, still: Solution | None) -> Top:
    """Return the values at the upper end of a leg; `still` is None if the shape in still water is
    not unique.
    """
    riding, upper = solution.riding, -1 if solution.line.towed else 0
    x, y, z = solution.position[upper]
    return Top(
        depth=-float(z),
        x=float(x),
        y=float(y),
        knockdown=None if still is None else float(still.position[upper, 2] - z),
        used_buoyancy=solution.buoyancy_used,
        reserve=solution.reserve,
        draft=None if riding is None or isnan(riding.draft) else riding.draft,
        freeboard=None if riding is None or isnan(riding.freeboard) else riding.freeboard,
    )


def tow_point_of(solution: Solution) -> TowPoint:
    """Return the load of a tow on the ship."""
    force = solution.force[-1]
    backward = hypot(force[0], force[1])
    return TowPoint(
        tension=float(solution.tension[-1]),
        angle=degrees(atan2(-force[2], backward)),
        vertical=-float(force[2]),
        horizontal=backward,
    )


def body_of(solution: Solution) -> TowedBody:
    """Return the values at the towed body, or at the free end of a bare cable."""
    node = solution.body_node
    x, y, z = solution.position[node]
    pull = -solution.force[node]
    if solution.line.flexible[0]:
        pull = solution.position[1] - solution.position[0]
    return TowedBody(
        depth=-float(z),
        layback=hypot(x, y),
        tension=float(solution.tension[node]),
        angle=degrees(atan2(pull[2], hypot(pull[0], pull[1]))),
    )


def end_loads(leg: Leg, components: Components, solution: Solution) -> Iterator[EndLoad]:
    """Return the loads of a leg on its anchor and on other fixed ends."""
    last = len(leg.pieces) - 1
    if leg.top.held is not None:
        # a leg that hangs from its upper end is marched from its lower end
        row, force = (
            components[0],
            solution.force[-1] if solution.line.towed else -solution.force[0],
        )
        yield _end_load(leg.name, force, (row.x_top, row.y_top, row.depth_top))
    if leg.bottom.held is not None:
        row = components[last]
        place = row.x_bottom, row.y_bottom, row.depth_bottom
        yield _end_load(leg.name, solution.force[-1], place)
    if leg.anchored:
        row, load = components[len(components) - 1], anchor_load(leg, solution)
        lower = _end_load(leg.name, solution.force[-1], (row.x_top, row.y_top, row.depth_top))
        yield replace(
            lower,
            required_weight=load.required_weight,
            weight=load.weight,
            grounded_length=load.grounded_length,
            slack_length=solution.slack,
        )


def _end_load(leg: str, force: Floats, place: tuple[float, float, float]) -> EndLoad:
    vertical, horizontal = float(force[2]), float(np.hypot(force[0], force[1]))
    angle = float(np.degrees(np.arctan2(horizontal, vertical)))
    return EndLoad(leg, float(np.linalg.norm(force)), vertical, horizontal, angle, *place)
