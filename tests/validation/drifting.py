"""The referee of lines that move freely: continuous lines, marched to where they must meet.

A line that falls goes from its upper end to its anchor, one that rises from both its ends to a
piece in between. Velocity, and the depth of the one end that is unknown, follow from the three
forces and the height that must agree there, by scipy's hybrid method.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.optimize import root

from calm.physics.line import Line, Water
from tests.validation.continuous import March, Shape
from tests.validation.loads import Vector

Left = Callable[[Water, float], Vector]
"""What is left of three forces and a height, in flowing water from a depth that is unknown [m]."""

TOLERANCE = 1e-9
"""Relative error of a step along a cable."""


def seen_from(water: Water, velocity: Vector) -> Water:
    """The water as a line of a velocity (3,) over the ground sees it."""
    east, north, up = velocity
    return replace(water, u=water.u - east, v=water.v - north, w=water.w - up)


def falling(line: Line, water: Water, weight: float, drag: float, near: Vector) -> Vector:
    """Velocity (3,) of a line behind an anchor of a weight [N] and a drag K, near another one."""

    def left(flow: Water, depth: float) -> Vector:
        shape = _down(line, flow, depth)
        speed = np.array([np.interp(water.depth, flow.level, c) for c in (flow.u, flow.v, flow.w)])
        density = np.interp(water.depth, flow.level, flow.density)
        pull = drag * density / 1025.0 * np.linalg.norm(speed) * speed
        above = shape.force_bottom[-1] + pull - [0.0, 0.0, weight]
        goal = line.anchor_height - water.depth
        return np.append(above / weight, (shape.bottom[-1, 2] - goal) / water.depth)

    depth = water.depth - line.anchor_height - float(line.length.sum())
    return _root(left, water, near, depth)


def rising(upper: Line, lower: Line, water: Water, top: float, near: Vector) -> Vector:
    """Velocity (3,) of a line in two parts without an anchor, its upper end at a depth [m]."""
    below = replace(lower.reversed(), towed=True)
    size = float(np.abs(upper.total_buoyancy).sum())

    def left(flow: Water, depth: float) -> Vector:
        down, up = _down(upper, flow, top), _down(below, flow, depth)
        force = down.force_bottom[-1] + up.force_bottom[-1]
        return np.append(force / size, (down.bottom[-1, 2] - up.bottom[-1, 2]) / water.depth)

    depth = top + float(upper.length.sum()) + float(lower.length.sum())
    return _root(left, water, near, depth)


def _down(line: Line, flow: Water, depth: float) -> Shape:
    return March(line, flow, TOLERANCE).down(depth, np.ones(len(line.length)))


def _root(left: Left, water: Water, near: Vector, depth: float) -> Vector:
    def system(x: Vector) -> Vector:
        return left(seen_from(water, x[:3]), float(x[3]) * water.depth)

    found = root(system, np.append(near, depth / water.depth), tol=1e-9)
    assert np.abs(found.fun).max() < 1e-7, found.message
    return found.x[:3]
