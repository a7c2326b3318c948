"""What hangs on the line, in the lanes: rigid pieces and clamped instruments."""

from __future__ import annotations

from math import sqrt

from calm.batch.kernel.compiled import compiled
from calm.batch.kernel.lanes import (
    ABOVE_IT,
    AFLOAT,
    AX,
    AY,
    AZ,
    BUOYANCY,
    DENSITY,
    DEPTH,
    DIRECTIONAL,
    FX,
    FY,
    FZ,
    GX,
    GY,
    GZ,
    HELD,
    ITSELF,
    L_BUOYANCY,
    L_EAST,
    L_LIFT,
    L_NORMAL,
    L_NORTH,
    L_TANGENTIAL,
    L_VOLUME,
    LANES,
    LEVER,
    LIFT,
    MX,
    MY,
    MZ,
    NORMAL,
    NX,
    NY,
    NZ,
    PER_DENSITY,
    QX,
    QY,
    QZ,
    SHARE,
    SX,
    SY,
    SZ,
    TANGENTIAL,
    VOLUME,
    WET,
    WIND_EAST,
    WIND_NORTH,
    K,
    Tables,
    U,
    V,
    W,
    Z,
    look_up,
)
from calm.physics.element import drag_force
from calm.physics.line import REFERENCE_DENSITY, Floats


@compiled
def load_of_every_lane(s: Floats, load: Floats, gravity: float) -> None:
    """Lay out a load in the lanes; what is at the surface, by how much of it is in use."""
    for i in range(LANES):
        s[L_BUOYANCY + i] = load[BUOYANCY]
        s[L_VOLUME + i] = load[VOLUME]
        s[L_NORMAL + i] = load[NORMAL]
        s[L_TANGENTIAL + i] = load[TANGENTIAL]
        s[L_LIFT + i] = load[LIFT]
        s[L_EAST + i] = 0.0
        s[L_NORTH + i] = 0.0
    if load[AFLOAT] == ITSELF:
        for i in range(LANES):
            s[L_BUOYANCY + i] *= s[SHARE + i]
            s[L_VOLUME + i] *= s[SHARE + i]
            s[L_NORMAL + i] *= s[HELD + i]
            s[L_TANGENTIAL + i] *= s[HELD + i]
            s[L_EAST + i] = s[WIND_EAST + i]
            s[L_NORTH + i] = s[WIND_NORTH + i]
    elif load[AFLOAT] == ABOVE_IT:
        for i in range(LANES):
            wet = s[WET + i]
            s[L_BUOYANCY + i] -= (1.0 - wet) * REFERENCE_DENSITY * gravity * load[VOLUME]
            s[L_VOLUME + i] *= wet
            s[L_NORMAL + i] *= wet
            s[L_TANGENTIAL + i] *= wet
            s[L_LIFT + i] *= wet


@compiled
def gather_load(s: Floats, load: Floats, gravity: float, several: bool) -> None:
    """Add a load's part in the moments: what turns the rod by itself, and its normal drag."""
    lever, directional = load[LEVER], load[DIRECTIONAL]
    for i in range(LANES):
        u, v, w, density = s[U + i], s[V + i], s[W + i], s[DENSITY + i]
        scale = lever * density * PER_DENSITY
        vv = u * u + v * v + w * w
        kn = scale * s[L_NORMAL + i]
        drag = (1.0 - directional) * kn * sqrt(vv)
        excess = (density - REFERENCE_DENSITY) * gravity
        s[AX + i] += lever * s[L_EAST + i] + drag * u
        s[AY + i] += lever * s[L_NORTH + i] + drag * v
        s[AZ + i] += (
            lever * (s[L_BUOYANCY + i] + excess * s[L_VOLUME + i])
            + scale * s[L_LIFT + i] * vv
            + drag * w
        )
        share = directional * kn
        if several:
            cx = v * s[NZ + i] - w * s[NY + i]
            cy = w * s[NX + i] - u * s[NZ + i]
            cz = u * s[NY + i] - v * s[NX + i]
            share *= sqrt(cx * cx + cy * cy + cz * cz)
        s[K + i] += share
        weight = share if several else directional
        s[GX + i] += weight * u
        s[GY + i] += weight * v
        s[GZ + i] += weight * w


@compiled
def add_load(s: Floats, load: Floats, gravity: float) -> None:
    """Force of a load in the current looked up: in QX, QY, QZ, added to the sums."""
    lever, directional = load[LEVER], load[DIRECTIONAL]
    for i in range(LANES):
        u, v, w, density = s[U + i], s[V + i], s[W + i], s[DENSITY + i]
        scale = density * PER_DENSITY
        vv = u * u + v * v + w * w
        kn = scale * s[L_NORMAL + i]
        drag = (1.0 - directional) * kn * sqrt(vv)
        qx, qy, qz = drag_force(
            directional * kn, directional * scale * s[L_TANGENTIAL + i],
            u, v, w, s[NX + i], s[NY + i], s[NZ + i],
        )  # fmt: skip
        excess = (density - REFERENCE_DENSITY) * gravity
        qx += drag * u + s[L_EAST + i]
        qy += drag * v + s[L_NORTH + i]
        qz += drag * w + s[L_BUOYANCY + i] + excess * s[L_VOLUME + i] + scale * s[L_LIFT + i] * vv
        s[QX + i], s[QY + i], s[QZ + i] = qx, qy, qz
        s[SX + i] += qx
        s[SY + i] += qy
        s[SZ + i] += qz
        s[MX + i] += lever * qx
        s[MY + i] += lever * qy
        s[MZ + i] += lever * qz


@compiled
def pass_clamp(s: Floats, water: Tables, loads: Floats, gravity: float, record: Floats) -> None:
    """Add an instrument clamped on a cable."""
    for i in range(LANES):
        s[DEPTH + i] = -s[Z + i]
        s[SX + i], s[SY + i], s[SZ + i] = 0.0, 0.0, 0.0
    look_up(s, water)
    load_of_every_lane(s, loads[0], gravity)
    for i in range(LANES):
        s[AX + i], s[AY + i], s[AZ + i] = s[QX + i], s[QY + i], s[QZ + i]
    add_load(s, loads[0], gravity)
    for i in range(LANES):
        s[FX + i] += s[SX + i]
        s[FY + i] += s[SY + i]
        s[FZ + i] += s[SZ + i]
        s[QX + i], s[QY + i], s[QZ + i] = s[AX + i], s[AY + i], s[AZ + i]
