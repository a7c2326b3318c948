"""Effect of biofouling on the drag and weight of the line.

Biofouling is a layer of uniform thickness on everything above a given depth in still water. The
layer increases the diameter of a cable, and the projected areas of a rigid piece. A body without
dimensions is treated as a sphere. A layer without a specified density is weightless in water.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import pi, sqrt
from typing import Any, assert_never

import numpy as np

from calm import files
from calm.assemble import drag_of, net_buoyancy
from calm.case.leg_result import LegResult
from calm.files.components import FlexibleComponent, RigidComponent
from calm.files.definition import CATALOGUE_DENSITY, STANDARD_GRAVITY
from calm.physics import drag
from calm.physics.seawater import REFERENCE_DENSITY

CHAIN_BREADTH = 1.8
"""Ratio of a chain's equivalent diameter to its bar diameter (OrcaFlex).

A cylinder of the equivalent diameter has the displacement of the chain.
"""


def grown(
    pieces: Sequence[files.Piece], given: LegResult, fouling: files.Fouling
) -> tuple[files.Piece, ...]:
    """Return the pieces with biofouling on everything above `fouling.depth` in still water.

    A cable or chain that crosses this depth is split there. Depths come from `given`, the result
    without biofouling.
    """
    gravity = given.leg.water.gravity
    return tuple(
        replace(piece, index=index)
        for index, piece in enumerate(_grown_pieces(pieces, given, fouling, gravity))
    )


def _grown_pieces(
    pieces: Sequence[files.Piece], given: LegResult, fouling: files.Fouling, gravity: float
) -> Iterator[files.Piece]:
    sunk = np.nan_to_num(given.components.knockdown)  # none where still water has no shape
    below = np.append(sunk[1:], 0.0)
    for row, piece, high, low in zip(given.components, pieces, sunk, below, strict=True):
        top, bottom = row.depth_top - high, row.depth_bottom - low
        along = (bottom - top) / piece.length if piece.length else 0.0
        clamps = tuple(
            replace(clamp, component=grown_component(clamp.component, fouling, gravity))
            if top + along * clamp.at < fouling.depth
            else clamp
            for clamp in piece.clamps
        )
        whole = replace(piece, clamps=clamps)
        if top >= fouling.depth:
            yield whole
            continue
        share = 1.0
        if isinstance(piece.component, files.Flexible) and bottom > fouling.depth:
            share = (fouling.depth - top) / (bottom - top)
        upper, lower = _split(whole, share)
        yield replace(upper, component=grown_component(piece.component, fouling, gravity))
        if lower is not None:
            yield lower


def grown_component(
    component: files.Component, fouling: files.Fouling, gravity: float
) -> files.Component:
    """Return a copy of a component with biofouling all over its surface; anchors are unchanged.

    Parameters
    ----------
    gravity : gravitational acceleration [m/s²]
    """
    if isinstance(component, files.Anchor):
        return component
    thickness = fouling.thickness
    drags, volume = _larger(component, thickness)
    if fouling.density is None:
        return component.model_copy(update=drags)
    weight = (fouling.density - REFERENCE_DENSITY) * gravity * volume
    net = net_buoyancy(component, gravity) - weight
    force: dict[str, Any] = (
        {"weight": -net} if isinstance(component, files.Chain) else {"buoyancy": net}
    )
    if component.displaced_volume is not None:
        held = CATALOGUE_DENSITY * component.displaced_volume
        bare = held - component.net_buoyancy / STANDARD_GRAVITY
        force["mass"] = bare + fouling.density * volume
    displaced = getattr(component, "volume", None)
    if displaced is not None:
        force["volume"] = displaced + volume
    return component.model_copy(update=drags | force)


def _larger(
    component: RigidComponent | FlexibleComponent, t: float
) -> tuple[dict[str, Any], float]:
    """Return the size and drag values of a component with biofouling, and the biofouling volume.

    `t` is the layer thickness [m]. The volume is in m³, or in m³ per metre of cable or chain.
    """
    if isinstance(component, files.Cable):
        d = component.diameter
        return {"diameter": d + 2.0 * t}, pi * t * (d + t)
    if isinstance(component, files.Chain):
        wider = (component.diameter + 2.0 * t) / component.diameter
        cn = drag.CHAIN_CN if component.cn is None else component.cn
        ct = drag.CHAIN_CT if component.ct is None else component.ct
        volume = pi * t * (CHAIN_BREADTH * component.diameter + t)
        return {"cn": wider * cn, "ct": wider * ct}, volume
    kn, kt, directional = drag_of(component)
    across, along, volume = _scales(component, kn, t)
    update: dict[str, Any] = {}
    if isinstance(component, files.Sphere):
        update["cx"] = across * (drag.SPHERE_CX if component.cx is None else component.cx)
    elif isinstance(component, files.Cylinder):
        d, length = component.diameter, component.length
        if length > 0.0:
            update["cn"] = across * kn / (0.5 * REFERENCE_DENSITY * d * length)
        update["ct"] = along * kt / (0.5 * REFERENCE_DENSITY * pi * d**2 / 4.0)
    elif isinstance(component, files.Shaped):
        update = dict.fromkeys(("drag_area", "cd", "drag_measurements", "made_of", "inclination"))
        update |= {"kn": across * kn, "kt": along * kt if directional else None}
    else:
        assert_never(component)
    k_surface = getattr(component, "k_surface", None)
    return update | ({} if k_surface is None else {"k_surface": across * k_surface}), volume


def _scales(component: files.Component, kn: float, t: float) -> tuple[float, float, float]:
    """Return the factors by which biofouling increases the projected areas, and its volume [m³].

    The first factor is for flow normal to the axis, and the second for flow along the axis. `kn` is
    the normal drag at 1 m/s [N/(m/s)²], and `t` the layer thickness [m].
    """
    if isinstance(component, files.Cylinder):
        d, length = component.diameter, component.length
        wide, long = d + 2.0 * t, length + 2.0 * t
        across = wide * long / (d * length) if length > 0.0 else 1.0
        return across, (wide / d) ** 2, pi / 4.0 * (wide**2 * long - d**2 * length)
    if isinstance(component, files.Sphere):
        d = component.diameter
    else:
        area = getattr(component, "drag_area", None)
        d = sqrt(4.0 / pi * (kn / (0.5 * REFERENCE_DENSITY) if area is None else area))
    if d == 0.0:
        return 1.0, 1.0, 0.0
    wide = d + 2.0 * t
    return (wide / d) ** 2, (wide / d) ** 2, pi / 6.0 * (wide**3 - d**3)


def _split(piece: files.Piece, share: float) -> tuple[files.Piece, files.Piece | None]:
    if share >= 1.0 or piece.length is None:
        return piece, None
    at = share * piece.length

    def lowered(clamp: files.Clamp) -> files.Clamp:
        return replace(clamp, at=clamp.at - at)

    above = tuple(clamp for clamp in piece.clamps if clamp.at <= at)
    below = tuple(lowered(clamp) for clamp in piece.clamps if clamp.at > at)
    return (
        replace(piece, length=at, clamps=above),
        replace(piece, length=piece.length - at, clamps=below),
    )
