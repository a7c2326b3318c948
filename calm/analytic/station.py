"""What the closed forms of a line in a stream return: a point of it, or an array of points."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class Station(NamedTuple):
    """A point of a line in a stream, counted from the end that is given.

    Attributes
    ----------
    angle : between the line going up and the way upstream [rad]
    tension : [N]
    x : distance upstream of the given end [m]
    z : height above the given end [m]

    All have the shape of the arcs asked for. A towed cable, given at its body, has angles below
    90°; a mooring line leans downstream and has angles above 90° (90° + tilt). A force at the
    given end is that of the part below it: a body of weight W in water and drag D pulls with
    T₀ = √(W² + D²) at the angle atan2(W, D); under a float of buoyancy B it is atan2(B, −D).
    """

    angle: Floats
    tension: Floats
    x: Floats
    z: Floats
