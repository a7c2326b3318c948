"""Small lines and waters to put together in a test."""

from math import pi

import numpy as np

from calm.physics.line import Line, Water


def rigid(length, buoyancy, drag=0.0, tangential=0.0, directional=False, volume=0.0):
    """A rigid piece: length [m], buoyancy [N], drags [N/(m/s)²], volume [m³]."""
    return (length, False, buoyancy, volume, drag, tangential, directional, 0.0, 0.0)


def rope(length, weight=0.0, diameter=0.01, cn=1.3, ct=0.0, stiffness=None):
    """A cable: length [m], weight in water [N/m], diameter [m], EA [N]."""
    compliance = 0.0 if stiffness is None else 1.0 / stiffness
    kn, kt = 512.5 * cn * diameter, 512.5 * ct * pi * diameter
    return (length, True, -weight, 0.0, kn, kt, True, compliance, 0.5)


def line(*pieces, clamps=(), anchor_height=0.0):
    """A line of pieces, top to bottom; clamps are (piece, at, buoyancy, drag)."""
    columns = [np.array(column) for column in zip(*pieces, strict=True)]
    on, at, buoyancy, drag = (
        [np.array(c) for c in zip(*clamps, strict=True)] if clamps else [np.array([])] * 4
    )
    return Line(*columns, on, at, buoyancy, np.zeros(len(on)), drag, anchor_height)


def water(depth, *levels, density=1025.0):
    """Water of a depth [m] with levels (depth, u, v, w); still without any."""
    z, u, v, w = zip(*(levels or [(0.0, 0.0, 0.0, 0.0)]), strict=True)
    return Water(depth, z, u, v, w, np.full(len(z), density))
