"""How the float of a mooring rides at the surface: hull, drag afloat, wind."""

from __future__ import annotations

from collections.abc import Sequence
from math import cbrt, pi, sqrt

import numpy as np

from calm.assemble.line_arrays import drag_of, net_buoyancy
from calm.files import Cylinder, Environment, Piece, Rigid, Sphere
from calm.files.components import RigidComponent
from calm.files.definition import CATALOGUE_DENSITY
from calm.files.rigid import Displacement
from calm.physics.hull import Floating, Hull, cylindrical_hull, spherical_hull, tabulated_hull
from calm.physics.line import Water
from calm.records.profile_tables import components


def _first_float(pieces: Sequence[Piece]) -> Piece | None:
    """The first rigid buoyant piece of a line, None where there is none."""
    for piece in pieces:
        component = piece.component
        if isinstance(component, Rigid) and component.net_buoyancy > 0.0:
            return piece
    return None


def assemble_floating(
    pieces: Sequence[Piece], environment: Environment, water: Water
) -> Floating | None:
    """Return how the first float rides at the surface; None where neither its draft nor its drag
    is known.

    A hull is that of the component's `hull`, or of its kind for a sphere and a cylinder; without
    mass or volume there is no draft, and only a `k_surface` makes a difference.
    """
    piece = _first_float(pieces)
    component = None if piece is None else piece.component
    if not isinstance(component, Rigid):
        return None
    hull = _hull(component)
    if hull is None and component.k_surface is None:
        return None
    _, density = water.at(np.zeros(()))
    volume = _volume(component) or 0.0
    net = net_buoyancy(component, water.gravity)
    lift = net + (float(density) - CATALOGUE_DENSITY) * water.gravity * volume
    below, *_ = drag_of(component, component.length)
    afloat = component.k_surface if below > 0.0 else None
    wind = environment.wind
    return Floating(
        hull=hull,
        weight=CATALOGUE_DENSITY * water.gravity * volume - net,
        lift=lift,
        surface_drag=None if afloat is None else afloat / below,
        wind=(0.0, 0.0) if wind is None else components(wind.speed, wind.toward),
        wind_area=component.wind_area,
        wind_cd=1.0 if component.wind_cd is None else component.wind_cd,
    )


def _volume(component: RigidComponent) -> float | None:
    """Volume of the whole hull [m³]: the component's own, or the last row of its table."""
    if component.displaced_volume is None and isinstance(component.hull, Displacement):
        return component.hull.displacement[-1][1]
    return component.displaced_volume


def _hull(component: RigidComponent) -> Hull | None:
    volume, hull = _volume(component), component.hull
    if not volume:
        return None
    if isinstance(hull, Displacement):
        return tabulated_hull(hull.displacement)
    if isinstance(component, Sphere) and hull != "cylinder":
        return spherical_hull(component.diameter)
    if isinstance(component, Cylinder) and hull != "sphere":
        return cylindrical_hull(component.diameter, component.length)
    # a body of no stated width is as wide as its volume makes it
    if hull == "sphere":
        return spherical_hull(cbrt(6.0 * volume / pi))
    if hull == "cylinder" and component.length > 0.0:
        return cylindrical_hull(sqrt(4.0 * volume / (pi * component.length)), component.length)
    return None
