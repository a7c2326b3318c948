"""C23: viscosity, density and gravity of the sea."""

from __future__ import annotations

from functools import partial

from calm.physics import seawater
from calm.verification.case import PRINTED, Case, Kind, Source

_TEMPERATURES = (0, 5, 10, 15, 20, 25, 30)

_VISCOSITY = (
    (0, (1.7914, 1.5181, 1.3060, 1.1377, 1.0018, 0.8902, 0.7973)),
    (30, (1.8871, 1.6031, 1.3824, 1.2069, 1.0649, 0.9482, 0.8509)),
    (35, (1.9056, 1.6193, 1.3968, 1.2199, 1.0766, 0.9588, 0.8606)),
    (40, (1.9247, 1.6361, 1.4116, 1.2332, 1.0887, 0.9698, 0.8707)),
)
"""Salinity [g/kg]; dynamic viscosity [mPa s] at each temperature."""

_KINEMATIC = (1.8535, 1.5757, 1.3601, 1.1890, 1.0506, 0.9370, 0.8423)
"""[1e-6 m²/s] at a salinity of 35 at each temperature."""

_DENSITY = (
    (35.165, 10.0, 0, 1026.952), (35.2, 10.0, 500, 1029.237), (35.0, 5.0, 1000, 1032.160),
    (34.9, 1.5, 4000, 1046.132), (34.9, 1.5, 5000, 1050.502), (34.9, 1.5, 6000, 1054.787),
)  # fmt: skip
"""Absolute salinity [g/kg], conservative temperature [°C], depth [m], density [kg/m³]."""

_GRAVITY = ((0, 9.780327), (30, 9.793249), (45, 9.806200), (60, 9.819179), (90, 9.832186))
"""Latitude [degrees], gravity at the sea surface [m/s²]."""

_LATITUDE = 30.0


def _viscosity(temperature: float, salinity: float) -> float:
    """[mPa s]"""
    return 1e3 * float(seawater.dynamic_viscosity(temperature, salinity))


def _kinematic(temperature: float) -> float:
    """[1e-6 m²/s]"""
    density = float(seawater.density(temperature, 35.0, 0.0))
    return 1e6 * float(seawater.kinematic_viscosity(temperature, 35.0, density))


def _density(salinity: float, temperature: float, depth: float) -> float:
    return float(seawater.absolute_density(salinity, temperature, depth, _LATITUDE))


SEA_WATER = Source(
    "Sea water and gravity",
    """Viscosity by Sharqawy, Lienhard & Zubair (Desalination and Water Treatment 16, 2010,
equations 22 and 23; themselves good to 1.5 %), density by TEOS-10 (at 30° of latitude), gravity by
the international formula that TEOS-10 takes (C23). A regression of Dorsey's viscosities (1940),
other measurements, and the accepted viscosity of pure water at 20 °C stand beside them.""",
    (
        *(
            Case(f"C23 dynamic viscosity, {temperature} °C, {salinity} g/kg", printed, "mPa s",
                 5.5e-5, PRINTED, partial(_viscosity, temperature, salinity), Kind.CLOSED_FORM)
            for salinity, row in _VISCOSITY
            for temperature, printed in zip(_TEMPERATURES, row, strict=True)
        ),
        *(
            Case(f"C23 kinematic viscosity, {temperature} °C, 35", printed, "1e-6 m²/s", 5.5e-5,
                 PRINTED, partial(_kinematic, temperature), Kind.CLOSED_FORM)
            for temperature, printed in zip(_TEMPERATURES, _KINEMATIC, strict=True)
        ),
        Case("C23 dynamic viscosity, 10 °C, 30 g/kg, to six digits", 1.38238, "mPa s", 5.5e-6,
             PRINTED, partial(_viscosity, 10, 30), Kind.CLOSED_FORM),
        Case("C23 Dorsey 1940, 10 °C, 30 g/kg", 1.383779, "mPa s", 0.015 * 1.383779,
             "1.5 %, the accuracy of the formula.", partial(_viscosity, 10, 30), Kind.PUBLISHED),
        Case("C23 pure water, 20 °C, accepted", 1.0016, "mPa s", 0.015 * 1.0016,
             "1.5 %, the accuracy of the formula.", partial(_viscosity, 20, 0), Kind.PUBLISHED),
        *(
            Case(f"C23 density, SA {salinity}, CT {temperature:g}, {depth} m", printed, "kg/m³",
                 5.5e-4, PRINTED, partial(_density, salinity, temperature, depth),
                 Kind.BY_CONSTRUCTION)
            for salinity, temperature, depth, printed in _DENSITY
        ),
        *(
            Case(f"C23 gravity, latitude {latitude}°", printed, "m/s²", 5.5e-7, PRINTED,
                 partial(seawater.gravity, latitude), Kind.CLOSED_FORM)
            for latitude, printed in _GRAVITY
        ),
    ),
)  # fmt: skip
