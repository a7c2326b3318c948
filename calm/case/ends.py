"""The ends of a leg: where they are, and what the line does to what holds them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from math import atan2, degrees, hypot, isnan, nan

import numpy as np

from calm.case.leg import Leg
from calm.case.result_tables import Components
from calm.physics.line import Floats
from calm.physics.seabed import required_weight
from calm.solve import Solution


@dataclass(frozen=True)
class Accuracy:
    """The solver's own estimate of its errors.

    Of the worst of any depth or offset [m], of any tension [N], of the vertical and the horizontal
    pull on the anchor [N], and of the weight that it needs [N]; the last two None in a tow.
    """

    depth: float
    tension: float
    anchor: float | None = None
    required_weight: float | None = None


@dataclass(frozen=True)
class Top:
    """The free end: depth, offsets east and north, knockdown [m]; None where there is none.

    `used_buoyancy` is the share in use of the buoyancy that is at the surface, `reserve` the
    rest of it [N]; 1 and 0 below the surface. `draft` and `freeboard` [m] are those of a float at
    the surface whose hull is known.
    """

    depth: float
    x: float
    y: float
    knockdown: float | None
    used_buoyancy: float
    reserve: float
    draft: float | None = None
    freeboard: float | None = None


@dataclass(frozen=True)
class AnchorLoad:
    """Hold what the line does to its anchor [N]; `angle` is from the vertical [degrees].

    `required_weight` is the weight in water that holds it, `weight` what it has, `friction` its
    coefficient on the bed; `grounded_length` is the unstretched length of line on the seabed [m].
    """

    tension: float
    vertical: float
    horizontal: float
    angle: float
    required_weight: float
    weight: float
    friction: float
    grounded_length: float


@dataclass(frozen=True)
class TowPoint:
    """Hold what the line does to the ship: its tension, downward and backward [N].

    `angle` is that of the line there below the horizontal [degrees].
    """

    tension: float
    angle: float
    vertical: float
    horizontal: float


@dataclass(frozen=True)
class TowedBody:
    """The upper end of the lowest piece, or the free end of a bare cable.

    Depth and horizontal distance from the tow point [m], tension there [N], and the angle of the
    line above it from the horizontal [degrees].
    """

    depth: float
    layback: float
    tension: float
    angle: float


@dataclass(frozen=True)
class EndLoad:
    """Hold what a leg does to an end that is held, or to its anchor.

    The pull of the line and its parts up and sideways [N], its angle from the vertical [degrees];
    where the end is [m]. Of an anchor the weight in water that it needs, and has [N], the
    unstretched length of line on the seabed, and how much more of that there is than leads to the
    anchor [m].
    """

    leg: str
    tension: float
    vertical: float
    horizontal: float
    angle: float
    x: float
    y: float
    depth: float
    required_weight: float | None = None
    weight: float | None = None
    grounded_length: float = 0.0
    slack_length: float = 0.0


@dataclass(frozen=True)
class NodePlace:
    """Hold where the legs of a node meet [m]; `imbalance` is left of their pulls there [N]."""

    name: str
    depth: float
    x: float
    y: float
    imbalance: float


def anchor_load(leg: Leg, solution: Solution) -> AnchorLoad:
    """Return what a line does to its anchor; NaN where it has none."""
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
    """Return what the solver states of its errors, and what follows for the weight of the
    anchor.
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


def top_of(components: Components, solution: Solution, knockdown: float | None) -> Top:
    """Return the upper end of a leg, whose knockdown [m] is None where still water has no shape."""
    riding = solution.riding
    return Top(
        depth=float(components.depth_top[0]),
        x=float(components.x_top[0]),
        y=float(components.y_top[0]),
        knockdown=knockdown,
        used_buoyancy=solution.buoyancy_used,
        reserve=solution.reserve,
        draft=None if riding is None or isnan(riding.draft) else riding.draft,
        freeboard=None if riding is None or isnan(riding.freeboard) else riding.freeboard,
    )


def tow_point_of(solution: Solution) -> TowPoint:
    """Return what a tow does to the ship."""
    force = solution.force[-1]
    backward = hypot(force[0], force[1])
    return TowPoint(
        tension=float(solution.tension[-1]),
        angle=degrees(atan2(-force[2], backward)),
        vertical=-float(force[2]),
        horizontal=backward,
    )


def body_of(solution: Solution) -> TowedBody:
    """Return what a tow pulls."""
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
    """Return what a leg does to where it is held, and to its anchor."""
    last = len(leg.pieces) - 1
    if leg.top.held is not None:
        # what hangs down from its upper end is marched from its lower one
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
        borne = _end_load(leg.name, solution.force[-1], (row.x_top, row.y_top, row.depth_top))
        yield replace(
            borne,
            required_weight=load.required_weight,
            weight=load.weight,
            grounded_length=load.grounded_length,
            slack_length=solution.slack,
        )


def _end_load(leg: str, force: Floats, place: tuple[float, float, float]) -> EndLoad:
    vertical, horizontal = float(force[2]), float(np.hypot(force[0], force[1]))
    angle = float(np.degrees(np.arctan2(horizontal, vertical)))
    return EndLoad(leg, float(np.linalg.norm(force)), vertical, horizontal, angle, *place)
