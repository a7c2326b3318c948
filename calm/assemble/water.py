"""The environment of a mooring file as one table of levels, and the viscosity of its water."""

from collections.abc import Callable

import numpy as np

from calm.files import CurrentTable, DepthTable, Environment, SeaWater
from calm.files.definition import STANDARD_GRAVITY
from calm.physics import seawater
from calm.physics.line import REFERENCE_VISCOSITY, Floats, Water
from calm.records.profile_tables import components

DEEPEST = 11_000.0
"""Depth of the water where a tow gives none [m]: more than the deepest trench has."""

LINEAR_WITHIN = 1e-5
"""Share by which the density of sea water may differ from linear between levels."""

AIR_VISCOSITY = 1.46e-5
"""Kinematic viscosity of air [m²/s], in the standard atmosphere at sea level."""

_QUARTERS = np.array([0.25, 0.5, 0.75])


def assemble_water(environment: Environment) -> Water:
    """Current and density on the union of their levels, viscosity on its own; linear between."""
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
    """Depths [m] and the kinematic viscosity at them [m²/s], from the levels of the density.

    Where temperature and salinity are not given, it is that of sea water of 10 °C and salinity 35.
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


def _surface_drift(environment: Environment) -> list[CurrentTable]:
    """Return what the wind adds to the current; nothing where it drives no surface drift."""
    wind = environment.wind
    if wind is None or wind.surface_drift == 0.0:
        return []
    u, v = components(wind.surface_drift * wind.speed, wind.toward)
    depth = wind.drift_depth or _depth(environment)
    return [CurrentTable((0.0, depth), (u, 0.0), (v, 0.0), (0.0, 0.0))]


def _density(environment: Environment) -> tuple[Floats, Floats]:
    """Levels [m] and the density at them [kg/m³]."""
    given = environment.density
    if isinstance(given, DepthTable):
        return np.array(given.depth), np.array(given.value)
    if not isinstance(given, SeaWater):
        # A constant asks for no level of its own.
        return np.array(environment.current.depth[:1]), np.array([given])
    position = environment.position
    place = () if position is None else (position.latitude, position.longitude)

    def density(depth: Floats) -> Floats:
        return seawater.density(*_probed(given, depth), depth, *place)

    # Without rows to the bottom the last ones hold, but pressure goes on rising.
    rows = [*given.temperature.depth, *given.salinity.depth, 0.0, _depth(environment)]
    levels = _refined(np.unique(rows), density)
    return levels, density(levels)


def _probed(sea: SeaWater, depth: Floats) -> tuple[Floats, Floats]:
    """Temperature [°C] and practical salinity at depths of any shape [m]."""
    temperature, salinity = sea.temperature, sea.salinity
    return (
        np.interp(depth, temperature.depth, temperature.value),
        np.interp(depth, salinity.depth, salinity.value),
    )


def _refined(levels: Floats, values: Callable[[Floats], Floats]) -> Floats:
    """Levels halved until `values` is linear between them; it may bend only at the levels given."""
    while True:
        thickness = np.diff(levels)[:, np.newaxis]
        inside = levels[:-1, np.newaxis] + thickness * _QUARTERS
        error = np.abs(np.interp(inside, levels, values(levels)) / values(inside) - 1.0)
        # Half of what is promised: between the quarters it may be a little more.
        bent = error.max(axis=1) > 0.5 * LINEAR_WITHIN
        if not bent.any():
            return levels
        levels = np.union1d(levels, inside[bent, 1])
