"""Convert the pieces and the environment of a mooring file to the arrays that the solver uses."""

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import replace
from math import cbrt, pi, sqrt

import numpy as np

from calm import files
from calm.assemble.component_forces import axial_drag_of, drag_of, net_buoyancy
from calm.files import Cable, DepthTable, Environment, SeaWater, Solver, strumming_keys
from calm.files.components import RigidComponent
from calm.files.definition import CATALOGUE_DENSITY, STANDARD_GRAVITY
from calm.files.rigid import Displacement
from calm.physics import drag, seawater
from calm.physics.drag import Friction
from calm.physics.hull import Floating, Hull, cylindrical_hull, spherical_hull, tabulated_hull
from calm.physics.line import Floats, Line, Water
from calm.physics.reynolds import DragCurve
from calm.physics.seawater import REFERENCE_VISCOSITY
from calm.physics.stretch import ElongationCurve
from calm.physics.strumming import BourgetMarichal
from calm.records.profile_tables import components

TOWED_SPHERE_CX = 0.90
"""Drag coefficient Cx of a sphere at the free end of a tow (Bourget & Marichal).

Such a sphere oscillates. A fixed sphere has a Cx of 0.45.
"""

DEEPEST = 11_000.0
"""Default water depth of a tow [m], larger than the depth of any trench."""

LINEAR_WITHIN = 1e-5
"""Allowed relative error of the sea water density after linear interpolation between levels."""

AIR_VISCOSITY = 1.46e-5
"""Kinematic viscosity of air [m²/s], in the standard atmosphere at sea level."""

_QUARTERS = np.array([0.25, 0.5, 0.75])


def assemble_line(
    pieces: Sequence[files.Piece], solver: Solver | None = None, gravity: float = STANDARD_GRAVITY
) -> Line:
    """Build the arrays of the line above the anchor, or of a whole towed line, in piece order.

    A piece that is cut to fit has length 0 until the length is computed.

    Parameters
    ----------
    pieces : pieces from top to bottom; an anchor is the last piece
    solver : laws of drag, friction and strumming; None for the defaults
    gravity : acceleration of gravity, for the weights of masses [m/s²]
    """
    # the environments of a mooring share its lines, with all results cached on the lines
    given = tuple(pieces), solver or Solver(), gravity
    for known, line in list(_ASSEMBLED):
        if known == given:
            return line
    _ASSEMBLED.append((given, line := _assembled(*given)))
    return line


_ASSEMBLED: deque[tuple[object, Line]] = deque(maxlen=32)
"""Cache of the latest lines. Each entry contains the inputs of `assemble_line` and the line."""


def _assembled(pieces: Sequence[files.Piece], solver: Solver, gravity: float) -> Line:
    anchor = pieces[-1].component
    moored = isinstance(anchor, files.Anchor)
    above = pieces[:-1] if moored else pieces
    parts = [piece.component for piece in above]
    drags = [drag_of(part, solver) for part in parts]
    curves = [_drag_curve(part, solver) for part in parts]
    if not moored and isinstance(anchor, files.Sphere) and anchor.cx is None:
        k = drag.sphere_drag(anchor.diameter, TOWED_SPHERE_CX)
        drags[-1], curves[-1] = (k, k, False), None
    clamps = [(i, clamp) for i, piece in enumerate(above) for clamp in piece.clamps]
    clamped = [clamp.component for _, clamp in clamps]
    return Line(
        length=np.array([piece.length or 0.0 for piece in above]),
        flexible=np.array([isinstance(part, files.Flexible) for part in parts]),
        buoyancy=np.array([net_buoyancy(part, gravity) for part in parts]),
        volume=np.array([part.displaced_volume or 0.0 for part in parts]),
        normal_drag=np.array([kn for kn, _, _ in drags]),
        tangential_drag=np.array([kt for _, kt, _ in drags]),
        directional=np.array([directional for _, _, directional in drags]),
        compliance=np.array(
            [1.0 / stiff if (stiff := getattr(part, "stiffness", None)) else 0.0 for part in parts]
        ),
        thinning=np.array([0.5 if isinstance(part, Cable) else 0.0 for part in parts]),
        clamp_piece=np.array([i for i, _ in clamps]),
        clamp_at=np.array([clamp.at for _, clamp in clamps]),
        clamp_buoyancy=np.array([net_buoyancy(part, gravity) for part in clamped]),
        clamp_volume=np.array([part.displaced_volume or 0.0 for part in clamped]),
        # clamped items: use the drag normal to their axis, for any inclination of the line
        clamp_drag=np.array([drag_of(part)[0] for part in clamped]),
        anchor_height=anchor.length if isinstance(anchor, files.Anchor) else 0.0,
        lift=np.array([getattr(part, "lift", None) or 0.0 for part in parts]),
        clamp_lift=np.array([getattr(part, "lift", None) or 0.0 for part in clamped]),
        diameter=np.array([part.diameter if isinstance(part, Cable) else 0.0 for part in parts]),
        friction=Friction(solver.friction),
        strumming=vibration_law(solver),
        elongation=tuple(map(_elongation, parts)),
        drag_curve=tuple(curves),
        clamp_drag_curve=tuple(_drag_curve(part, solver) for part in clamped),
    )


def _drag_curve(component: files.Component, solver: Solver) -> DragCurve | None:
    if solver.drag == "constant":
        return None
    if not isinstance(component, files.Sphere | files.Cylinder) or component.surface != "smooth":
        return None
    given = component.cx if isinstance(component, files.Sphere) else component.cn
    if given is not None or component.k_surface is not None:
        return None
    if isinstance(component, files.Sphere):
        return DragCurve(component.diameter)
    return DragCurve(component.diameter, component.length / component.diameter)


def _elongation(component: files.Component) -> ElongationCurve | None:
    if not isinstance(component, Cable) or component.elongation is None:
        return None
    assert component.breaking_load is not None
    return ElongationCurve(
        component.elongation, component.breaking_load, component.permanent_elongation or 0.0
    )


def with_axial_clamps(line: Line, pieces: Sequence[files.Piece]) -> Line:
    """Return a copy of a line whose clamps have their axial drag.

    In descent and ascent, the water flows along the line.
    """
    clamps = [clamp.component for piece in pieces for clamp in piece.clamps]
    axial = [drag_of(each)[2] for each in clamps]
    curves = tuple(
        None if along else curve for along, curve in zip(axial, line.clamp_drag_curve, strict=False)
    )
    drags = np.array([axial_drag_of(each) for each in clamps])
    return replace(line, clamp_drag=drags, clamp_drag_curve=curves)


def vibration_law(solver: Solver) -> BourgetMarichal | None:
    """Return Bourget & Marichal's strumming law, or None if the file does not set this law."""
    keys = solver.strumming
    if not isinstance(keys, strumming_keys.BourgetMarichalKeys):
        return None
    return BourgetMarichal(keys.a1, keys.b1, keys.c1, rest=keys.c0, strouhal=keys.strouhal)


def assemble_floating(
    pieces: Sequence[files.Piece], environment: Environment, water: Water
) -> Floating | None:
    """Return the surface properties of the first float.

    Return None if the line has no float. Also return None if neither the hull nor the surface drag
    of the float is known; a hull needs a volume. By default, a sphere has a spherical hull, and a
    cylinder has a cylindrical hull.
    """
    parts = (piece.component for piece in pieces)
    floats = (part for part in parts if isinstance(part, files.Rigid) and part.net_buoyancy > 0.0)
    component = next(floats, None)
    if component is None:
        return None
    hull = _hull(component)
    if hull is None and component.k_surface is None:
        return None
    density = water.density_at(np.zeros(()))
    volume = _hull_volume(component) or 0.0
    net = net_buoyancy(component, water.gravity)
    lift = net + (float(density) - CATALOGUE_DENSITY) * water.gravity * volume
    below, *_ = drag_of(component)
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


def _hull_volume(component: RigidComponent) -> float | None:
    """Return the displaced volume of a float [m³], or None if unknown.

    If only a hull table is given, this is the last volume in the table.
    """
    if component.displaced_volume is None and isinstance(component.hull, Displacement):
        return component.hull.displacement[-1][1]
    return component.displaced_volume


def _hull(component: RigidComponent) -> Hull | None:
    volume, hull = _hull_volume(component), component.hull
    if not volume:
        return None
    if isinstance(hull, Displacement):
        return tabulated_hull(hull.displacement)
    if isinstance(component, files.Sphere) and hull != "cylinder":
        return spherical_hull(component.diameter)
    if isinstance(component, files.Cylinder) and hull != "sphere":
        return cylindrical_hull(component.diameter, component.length)
    # a body of unspecified width gets the width for its volume
    if hull == "sphere":
        return spherical_hull(cbrt(6.0 * volume / pi))
    if hull == "cylinder" and component.length > 0.0:
        return cylindrical_hull(sqrt(4.0 * volume / (pi * component.length)), component.length)
    return None


def assemble_water(environment: Environment) -> Water:
    """Build the water column from an environment.

    The levels of the current and density profiles are merged. Viscosity has its own levels.
    """
    flows = [environment.current, *_surface_drift(environment)]
    density_levels, density = _density(environment)
    # np.unique would import masked arrays
    depths = {*density_levels.tolist(), *(depth for flow in flows for depth in flow.depth)}
    levels = np.array(sorted(depths))
    velocity = np.zeros((3, len(levels)))
    for flow in flows:
        velocity += [np.interp(levels, flow.depth, part) for part in (flow.u, flow.v, flow.w)]
    u, v, w = velocity
    viscosity_level, viscosity = _viscosity(environment, density_levels, density)
    deeper = (0.0, 0.0) if environment.seabed is None else environment.seabed.plane
    return Water(
        depth=_depth(environment),
        level=levels,
        u=u,
        v=v,
        w=w,
        density=np.interp(levels, density_levels, density),
        gravity=_gravity(environment),
        viscosity_level=viscosity_level,
        viscosity=viscosity,
        deeper_east=deeper[0],
        deeper_north=deeper[1],
    )


def _viscosity(environment: Environment, levels: Floats, density: Floats) -> tuple[Floats, Floats]:
    """Return depths [m], and kinematic viscosities at these depths [m²/s].

    If temperature and salinity are not given, the viscosity is constant. It is then the viscosity
    of air, or of sea water at 10 °C and salinity 35.
    """
    sea = environment.density
    if not isinstance(sea, SeaWater):
        in_air = environment.fluid == "air"
        return np.zeros(1), np.array([AIR_VISCOSITY if in_air else REFERENCE_VISCOSITY])
    return levels, seawater.kinematic_viscosity(*_probed(sea, levels), density)


def _depth(environment: Environment) -> float:
    return DEEPEST if environment.depth is None else environment.depth


def _gravity(environment: Environment) -> float:
    if environment.gravity is not None:
        return environment.gravity
    if isinstance(environment.density, SeaWater) and environment.position is not None:
        return seawater.gravity(environment.position.latitude)
    return STANDARD_GRAVITY


def _surface_drift(environment: Environment) -> list[files.CurrentTable]:
    wind = environment.wind
    if wind is None or wind.surface_drift == 0.0:
        return []
    u, v = components(wind.surface_drift * wind.speed, wind.toward)
    depth = wind.drift_depth or _depth(environment)
    return [files.CurrentTable((0.0, depth), (u, 0.0), (v, 0.0), (0.0, 0.0))]


def _density(environment: Environment) -> tuple[Floats, Floats]:
    """Return depths [m], and densities at these depths [kg/m³]."""
    given = environment.density
    if isinstance(given, DepthTable):
        return np.array(given.depth), np.array(given.value)
    if not isinstance(given, SeaWater):
        # a constant density needs no level
        return np.array(environment.current.depth[:1]), np.array([given])
    position = environment.position
    place = () if position is None else (position.latitude, position.longitude)

    def density(depth: Floats) -> Floats:
        return seawater.density(*_probed(given, depth), depth, *place)

    # below the last row its values are kept, but the pressure increases down to the seabed
    rows = [*given.temperature.depth, *given.salinity.depth, 0.0, _depth(environment)]
    levels = _refined(np.unique(rows), density)
    return levels, density(levels)


def _probed(sea: SeaWater, depth: Floats) -> tuple[Floats, Floats]:
    """Interpolate the temperature [°C] and practical salinity at the given depths [m].

    Both results have the shape of the array `depth`.
    """
    temperature, salinity = sea.temperature, sea.salinity
    return (
        np.interp(depth, temperature.depth, temperature.value),
        np.interp(depth, salinity.depth, salinity.value),
    )


def _refined(levels: Floats, values: Callable[[Floats], Floats]) -> Floats:
    """Return the given levels and the new levels that are needed for linear interpolation.

    Levels are added until the function `values` is nearly linear between any two neighbours.
    """
    while True:
        thickness = np.diff(levels)[:, np.newaxis]
        inside = levels[:-1, np.newaxis] + thickness * _QUARTERS
        error = np.abs(np.interp(inside, levels, values(levels)) / values(inside) - 1.0)
        # half of the tolerance, since the error may be slightly larger between the quarter points
        bent = error.max(axis=1) > 0.5 * LINEAR_WITHIN
        if not bent.any():
            return levels
        levels = np.union1d(levels, inside[bent, 1])
