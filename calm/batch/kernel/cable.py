"""A stretch of cable in the lanes: `calm.physics.cable`, with passes that are foreseen.

The load of the last segment tells how the next one leans, to the order that its current needs.
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from typing import Any

from calm.batch.kernel.compiled import compiled
from calm.batch.kernel.lanes import (
    AX,
    AY,
    AZ,
    C_BUOYANCY,
    C_COMPLIANCE,
    C_NORMAL,
    C_TANGENTIAL,
    C_THINNING,
    C_VOLUME,
    CUT,
    DENSITY,
    DEPTH,
    DOUBT,
    FX,
    FY,
    FZ,
    GX,
    GY,
    GZ,
    HIGHEST,
    LANES,
    LEAST_PULL,
    LOWEST,
    PER_DENSITY,
    PULL,
    QX,
    QY,
    QZ,
    TX,
    TY,
    TZ,
    C,
    K,
    Tables,
    U,
    V,
    W,
    X,
    Y,
    Z,
    exact_shares,
    look_up,
)
from calm.physics.element import axis_along, drag_force, share_step
from calm.physics.line import REFERENCE_DENSITY, Floats


def _passing(length_of: Callable[[Floats, float, int], float]) -> Any:
    """What takes lanes down a stretch of cable, where `length_of` tells a segment's length."""

    @compiled
    def pass_segments(
        s: Floats, water: Tables, cable: Floats, cuts: Floats, halvings: int, gravity: float
    ) -> None:
        """Take all lanes down a stretch of cable; each cut is halved so many times."""
        buoyancy, volume, kn, kt = (
            cable[C_BUOYANCY],
            cable[C_VOLUME],
            cable[C_NORMAL],
            cable[C_TANGENTIAL],
        )
        compliance, thinning = cable[C_COMPLIANCE], cable[C_THINNING]
        parts = 1 << halvings
        for j in range(cuts.size):
            cut = cuts[j] / parts
            for _ in range(parts):
                for i in range(LANES):
                    half = 0.5 * length_of(s, cut, i)
                    gx, gy, gz = (
                        s[FX + i] + half * s[QX + i],
                        s[FY + i] + half * s[QY + i],
                        s[FZ + i] + half * s[QZ + i],
                    )
                    pull = sqrt(gx * gx + gy * gy + gz * gz)
                    s[PULL + i] = pull
                    s[DEPTH + i] = -s[Z + i] + half * (1.0 + compliance * pull) * gz / pull
                look_up(s, water)
                for i in range(LANES):
                    u, v, w, density = s[U + i], s[V + i], s[W + i], s[DENSITY + i]
                    pull = s[PULL + i]
                    length = length_of(s, cut, i)
                    area = length * density * PER_DENSITY
                    area *= 1.0 + thinning * (sqrt(1.0 + compliance * pull) - 1.0)
                    lift = length * (buoyancy + (density - REFERENCE_DENSITY) * gravity * volume)
                    ax, ay, az = s[FX + i], s[FY + i], s[FZ + i] + 0.5 * lift
                    k = 0.5 * kn * area
                    aa = ax * ax + ay * ay + az * az
                    av = ax * u + ay * v + az * w
                    vv = u * u + v * v + w * w
                    cx, cy, cz = ay * w - az * v, az * u - ax * w, ax * v - ay * u
                    target = k * sqrt(cx * cx + cy * cy + cz * cz)
                    first = target / pull
                    _, c = share_step(aa, av, vv, target, first)
                    step = c - first
                    doubt = step * step * vv / aa
                    s[AX + i], s[AY + i], s[AZ + i] = ax, ay, az
                    s[K + i], s[C + i], s[DOUBT + i] = k, c, doubt
                    s[GX + i], s[GY + i], s[GZ + i] = u, v, w
                exact_shares(s)
                for i in range(LANES):
                    u, v, w = s[GX + i], s[GY + i], s[GZ + i]
                    k = 2.0 * s[K + i]
                    tx, ty, tz = axis_along(s[AX + i], s[AY + i], s[AZ + i], s[C + i], u, v, w)
                    qx, qy, qz = drag_force(k, kt / kn * k, u, v, w, tx, ty, tz)
                    qz += 2.0 * (s[AZ + i] - s[FZ + i])
                    fx, fy, fz = s[FX + i], s[FY + i], s[FZ + i]
                    pull = -((fx + 0.5 * qx) * tx + (fy + 0.5 * qy) * ty + (fz + 0.5 * qz) * tz)
                    length = length_of(s, cut, i)
                    stretched = length * (1.0 + compliance * pull)
                    s[LEAST_PULL + i] = pull if pull < s[LEAST_PULL + i] else s[LEAST_PULL + i]
                    s[X + i] += stretched * tx
                    s[Y + i] += stretched * ty
                    z = s[Z + i] + stretched * tz
                    s[Z + i] = z
                    s[LOWEST + i] = z if z < s[LOWEST + i] else s[LOWEST + i]
                    s[HIGHEST + i] = z if z > s[HIGHEST + i] else s[HIGHEST + i]
                    s[FX + i], s[FY + i], s[FZ + i] = fx + qx, fy + qy, fz + qz
                    s[TX + i], s[TY + i], s[TZ + i] = tx, ty, tz
                    s[QX + i], s[QY + i], s[QZ + i] = qx / length, qy / length, qz / length

    return pass_segments


@compiled
def _given(s: Floats, cut: float, i: int) -> float:
    return cut


@compiled
def _own(s: Floats, cut: float, i: int) -> float:
    return float(s[CUT + i])


pass_segments = _passing(_given)
pass_own_segments = _passing(_own)
"""The same with a length for each lane, its `CUT`."""
