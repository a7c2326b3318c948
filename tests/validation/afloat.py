"""The referee's float at the surface: how deep it sits, what of it is dragged, the wind on it.

The water displaced carries the float's weight and what the line pulls. The waterline of the hull
lies at z = 0 on the float's axis, as a share of the float's length; current drags the immersed
area only, wind pushes at the float's middle with ½ ρ Cd A |W| W on the area above. What stands on
the float is out of the water but for the last 2 % of its buoyancy, in which it goes under; so is a
given wind area, and a given drag afloat becomes that below.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import asin, hypot, pi, sin, sqrt

import numpy as np
from scipy.optimize import brentq

from calm.physics.line import Line, Water
from tests.validation.continuous import March
from tests.validation.loads import Vector

AIR = 1.225
"""Density of the standard atmosphere at sea level [kg/m³]."""

Hull = Callable[[float], tuple[float, float]]
"""Shares of the draft and of the area seen from the side, by the share of the volume immersed."""


def ball(share: float) -> tuple[float, float]:
    """A sphere: a cap of height x d holds x²(3 − 2x) of it; the chords of its disc, integrated."""
    x = float(brentq(lambda x: x * x * (3.0 - 2.0 * x) - share, 0.0, 1.0, xtol=1e-15, rtol=1e-15))
    angle = asin(sqrt(x))
    return x, (2.0 * angle - sin(4.0 * angle) / 2.0) / pi


def spar(share: float) -> tuple[float, float]:
    """An upright cylinder."""
    return share, share


def tabulated(rows: Sequence[tuple[float, float, float]]) -> Hull:
    """Rows of draft, volume, area; the first at the keel, the last the whole hull."""
    draft, volume, area = np.array(rows).T

    def hull(share: float) -> tuple[float, float]:
        displaced = share * volume[-1]
        seen = np.interp(displaced, volume, area) / area[-1]
        return float(np.interp(displaced, volume, draft) / draft[-1]), float(seen)

    return hull


def riding(line: Line, water: Water, hull: Hull | None, used: float) -> tuple[Line, float]:
    """The line as it is loaded when `used` of the first float's net buoyancy is.

    Its buoyancy is left whole.

    Returns
    -------
    The line, and the share of every length (n,) above the float's waterline, in metres.
    """
    floating = line.floating
    assert floating is not None
    piece = first_float(line)
    dry = min((1.0 - used) / 0.02, 1.0)
    draft, seen, area = 1.0, 1.0, 0.0
    if floating.hull is not None:
        immersed = (floating.weight + used * floating.lift) / (floating.weight + floating.lift)
        draft, seen = (hull or floating.hull.curve)(immersed)
        area = (1.0 - seen) * floating.hull.area
    if floating.wind_area is not None:
        area = dry * floating.wind_area
    if floating.surface_drag is not None:
        seen = dry * floating.surface_drag + (1.0 - dry)
    wind = 0.5 * AIR * floating.wind_cd * area * hypot(*floating.wind)
    above, on = np.arange(len(line.length)) < piece, line.clamp_piece < piece
    here = np.arange(len(line.length)) == piece
    displaced = dry * 1025.0 * water.gravity

    def wet(column: Vector, where: Vector) -> Vector:
        return np.where(where, (1.0 - dry) * column, column)

    loaded = replace(
        line,
        buoyancy=line.buoyancy - np.where(above, displaced * line.volume, 0.0),
        volume=wet(line.volume, above), lift=wet(line.lift, above),
        normal_drag=np.where(here, seen, 1.0) * wet(line.normal_drag, above),
        tangential_drag=np.where(here, seen, 1.0) * wet(line.tangential_drag, above),
        push_east=np.where(here, wind * floating.wind[0], 0.0),
        push_north=np.where(here, wind * floating.wind[1], 0.0),
        clamp_buoyancy=line.clamp_buoyancy - np.where(on, displaced * line.clamp_volume, 0.0),
        clamp_volume=wet(line.clamp_volume, on), clamp_drag=wet(line.clamp_drag, on),
        clamp_lift=wet(line.clamp_lift, on),
    )  # fmt: skip
    return loaded, dry * float(line.length[above].sum()) + (1.0 - draft) * float(line.length[piece])


def first_float(line: Line) -> int:
    """The first rigid buoyant piece."""
    return int(np.flatnonzero((line.buoyancy > 0.0) & ~line.flexible)[0])


def depth_of_free_end(march: March, share: Vector, out: float) -> float:
    """Depth of the free end [m] where `out` metres of the head of the line are above the water."""
    last = first_float(march.line)
    if march.head <= last:
        return 0.0  # a cable lies above the float

    def residual(depth: float) -> float:
        shape = march.down(depth, share, until=last + 1)
        axis = shape.bottom[last] - shape.top[0]
        return depth + out * max(-float(axis[2] / np.linalg.norm(axis)), 0.0)

    if out == 0.0 or residual(-out) >= 0.0:
        return -out
    return float(brentq(residual, -out, 0.0, xtol=1e-13, rtol=1e-14))
