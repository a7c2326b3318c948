"""Whether the clamps hold what is on them: in the current, in the fall and in the rise."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from calm.assemble import axial_drag_of, drag_of, net_buoyancy
from calm.checks.criterion import Judged, parts_of
from calm.checks.finding import Verdict, at_most, reported, rule
from calm.checks.launch import Launch
from calm.checks.recovery import Recovery
from calm.physics.reference import REFERENCE_DENSITY
from calm.quantities import say

if TYPE_CHECKING:
    from calm.case import Mooring, Result
    from calm.checks.handling import Handling

_HOLDS = "Take a clamp that holds more, two of them, or a stopper below it."


@rule("clamp-grip")
def clamp_grip(result: Result) -> Iterator[Verdict]:
    """Pull of what is clamped on the line: its weight in water and the drag of the current."""
    water = result.mooring.water
    for part in _clamps(result.mooring):
        assert part.clamp is not None
        depth = np.array(float(result.clamps.depth[part.clamp]))
        flow, density = water.at(depth)
        flow = np.asarray(flow, float).reshape(3)
        drag = _length_drag(part) * float(density) / REFERENCE_DENSITY
        force = drag * float(np.linalg.norm(flow)) * flow
        force[2] += _lift(part, result.mooring, float(density))
        yield _verdict(part, float(np.linalg.norm(force)), "")


@rule("clamp-grip", situation="launch and recovery", once=True)
def clamp_grip_on_the_way(handling: Handling) -> Iterator[Verdict]:
    """The greater pull along the line of the fall, which drags up, and the rise, which drags down.

    Both at terminal speed, with the drag of what is clamped in the flow along its axis.
    """
    launch, rise = handling.launch, handling.recovery
    deep = np.array(handling.mooring.water.depth)
    density = float(handling.mooring.water.at(deep)[1])
    for part in _clamps(handling.mooring):
        drag = axial_drag_of(part.component) * density / REFERENCE_DENSITY
        lift = _lift(part, handling.mooring, density)
        pulls = []
        if isinstance(launch, Launch):
            pulls.append((abs(lift + drag * launch.greatest_speed**2), " in the fall"))
        if isinstance(rise, Recovery) and part.index <= rise.released:
            pulls.append((abs(lift - drag * rise.rise_speed**2), " in the rise"))
        if pulls:
            yield _verdict(part, *max(pulls))


def _clamps(mooring: Mooring) -> list[Judged]:
    return [part for part in parts_of(mooring) if part.clamp is not None]


def _length_drag(part: Judged) -> float:
    """K of the drag K|V|V across the axis [N/(m/s)²]."""
    return drag_of(part.component, getattr(part.component, "length", 0.0))[0]


def _lift(part: Judged, mooring: Mooring, density: float) -> float:
    """Net force in water of a density [N], + up."""
    gravity, volume = mooring.water.gravity, part.component.displaced_volume or 0.0
    excess = (density - REFERENCE_DENSITY) * volume * gravity
    return net_buoyancy(part.component, gravity) + excess


def _verdict(part: Judged, pull: float, when: str) -> Verdict:
    grip, breaking = part.component.grip, part.component.breaking_load
    pulls = f"{part.label} pulls on its clamp with {say('tension', pull)}{when}"
    if grip is not None:
        message = f"{pulls}; it grips with {say('tension', grip)}."
        return at_most(part, pull, grip, message, _HOLDS)
    if breaking is not None:
        message = f"{pulls}; it breaks at {say('tension', breaking)}."
        return at_most(part, pull, breaking, message, _HOLDS)
    return reported(part, pull, f"{pulls}; its `grip` is not given.")
