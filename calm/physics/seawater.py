"""Properties of sea water, and gravity.

Density follows from TEOS-10, viscosity from Sharqawy, and gravity from the latitude. Positions are
geographic, in degrees north and east, as in TEOS-10.
"""

from __future__ import annotations

from math import radians, sin

import numpy as np
from numpy.typing import ArrayLike, NDArray

REFERENCE_DENSITY = 1025.0
"""Density of the reference sea water [kg/m³], for which buoyancies and drags are specified."""

REFERENCE_VISCOSITY = 1.36e-6
"""Default kinematic viscosity [m²/s], for sea water at 10 °C and salinity 35."""

MID_LATITUDE = 45.0
"""Latitude assumed if the position is unknown [degrees]. The latitude only affects the conversion
of depth to pressure: at 5000 m, the density differs by 0.12 kg/m³ between equator and pole.
"""

SOUTHERNMOST = -86.0
"""Southern limit of the ocean and of the atlas of seawater composition [degrees]."""


def dynamic_viscosity(temperature: ArrayLike, salinity: ArrayLike) -> NDArray[np.float64]:
    """Return the dynamic viscosity of sea water [Pa s] at atmospheric pressure.

    The error is up to 1.5 %. Deep-sea pressure changes the viscosity by a few percent at most.

    Parameters
    ----------
    temperature : (...) in situ temperature [°C], 0 to 180
    salinity : (...) salinity [g/kg], 0 to 150, or practical salinity (0.5 % smaller)

    Source: Sharqawy, Lienhard & Zubair (2010), Desalination and Water Treatment 16, 354-380,
    equations 22 and 23.
    """
    t, s = np.asarray(temperature, dtype=float), 1e-3 * np.asarray(salinity, dtype=float)
    pure = 4.2844e-5 + 1.0 / (0.157 * (t + 64.993) ** 2 - 91.296)
    a = 1.541 + (1.998e-2 - 9.52e-5 * t) * t
    b = 7.974 + (-7.561e-2 + 4.724e-4 * t) * t
    viscosity: NDArray[np.float64] = pure * (1.0 + (a + b * s) * s)
    return viscosity


def kinematic_viscosity(
    temperature: ArrayLike, salinity: ArrayLike, density: ArrayLike
) -> NDArray[np.float64]:
    """Return the kinematic viscosity of sea water [m²/s].

    Parameters
    ----------
    temperature, salinity : as in `dynamic_viscosity`
    density : (...) density [kg/m³]
    """
    viscosity: NDArray[np.float64] = dynamic_viscosity(temperature, salinity) / np.asarray(
        density, dtype=float
    )
    return viscosity


def gravity(latitude: float) -> float:
    """Return the acceleration of gravity at the sea surface [m/s²] for a latitude [degrees].

    The increase with depth (0.011 m/s² at 5000 m) is neglected.

    Source: international gravity formula, within 1e-6 m/s² of TEOS-10.
    """
    square = sin(radians(latitude)) ** 2
    return 9.780327 * (1.0 + 0.0053024 * square - 0.0000058 * sin(radians(2.0 * latitude)) ** 2)


def density(
    temperature: ArrayLike,
    salinity: ArrayLike,
    depth: ArrayLike,
    latitude: float = MID_LATITUDE,
    longitude: float | None = None,
) -> NDArray[np.float64]:
    """Return the in situ density [kg/m³] from temperature, salinity and depth.

    Valid for 0 to 42 g/kg, -6 to 40 °C, and down to 10 km. Without a longitude, or far inland,
    reference composition is assumed (error in the open ocean below 0.03 kg/m³).

    Parameters
    ----------
    temperature : (...) in situ temperature, ITS-90 [°C]
    salinity : (...) practical salinity [-]
    depth : (...) depth below the surface [m]
    latitude, longitude : position [degrees]

    Returns
    -------
    (...) density, with the broadcast shape of temperature, salinity and depth.
    """
    import gsw

    pressure = pressure_at(depth, latitude)
    if longitude is None or latitude < SOUTHERNMOST:
        absolute = gsw.SR_from_SP(salinity)
    else:
        absolute = gsw.SA_from_SP(salinity, pressure, longitude, latitude)
    conservative = gsw.CT_from_t(absolute, temperature, pressure)
    return absolute_density(absolute, conservative, depth, latitude)


def potential_density(
    temperature: ArrayLike, salinity: ArrayLike, depth: ArrayLike
) -> NDArray[np.float64]:
    """Return the density of water that is raised adiabatically to the surface [kg/m³].

    In stable water, this density does not decrease with depth. Reference composition and latitude
    45 are assumed.

    Parameters
    ----------
    temperature : (...) in situ temperature, ITS-90 [°C]
    salinity : (...) practical salinity [-]
    depth : (...) original depth [m]
    """
    import gsw

    absolute = gsw.SR_from_SP(salinity)
    pressure = pressure_at(depth, MID_LATITUDE)
    return absolute_density(absolute, gsw.CT_from_t(absolute, temperature, pressure), 0.0)


def pressure_at(depth: ArrayLike, latitude: float) -> NDArray[np.float64]:
    """Return the pressure [dbar] at depths [m] and a latitude [degrees], according to TEOS-10."""
    import gsw

    return np.asarray(gsw.p_from_z(-np.asarray(depth, dtype=float), latitude), dtype=float)


def absolute_density(
    absolute_salinity: ArrayLike,
    conservative_temperature: ArrayLike,
    depth: ArrayLike,
    latitude: float = MID_LATITUDE,
) -> NDArray[np.float64]:
    """Return the in situ density [kg/m³] from absolute salinity and conservative temperature.

    Parameters
    ----------
    absolute_salinity : (...) absolute salinity [g/kg]
    conservative_temperature : (...) conservative temperature [°C]
    depth : (...) depth below the surface [m]
    latitude : latitude [degrees]

    Source: TEOS-10 (IOC, SCOR & IAPSO 2010), with the 75-term expression of Roquet et al. (2015),
    Ocean Modelling 90, 29-43.
    """
    import gsw

    pressure = pressure_at(depth, latitude)
    return np.asarray(gsw.rho(absolute_salinity, conservative_temperature, pressure), dtype=float)
