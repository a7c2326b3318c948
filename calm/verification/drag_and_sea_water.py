"""Verification of the formulas for drag, strumming, sea water and gravity (C23).

The drag of smooth bodies is compared over the Reynolds number. The increase of drag by strumming is
compared with three published fits.
"""

from functools import partial
from math import exp, pow

from calm.physics import seawater
from calm.physics.drag import end_face_coefficient, finite_length_factor, measured_drag
from calm.physics.reynolds import (
    cylinder_coefficient,
    finite_length_factor_above,
    sphere_coefficient,
)
from calm.physics.strumming import blevins, skop_griffin, vandiver
from calm.verification.published_case import PRINTED, Case, Kind, Source

WIESELSBERGER = (
    (3.18, 4.87), (8.01, 2.94), (17.7, 2.12), (31.7, 1.73), (63.6, 1.48), (196.0, 1.27),
    (356.0, 1.15), (892.0, 0.964), (2.27e3, 0.886), (5.15e3, 0.944), (9.18e3, 1.06),
    (1.5e4, 1.14), (3.03e4, 1.16), (6.55e4, 1.17), (1.07e5, 1.17), (1.61e5, 1.18),
    (2.20e5, 1.06), (2.93e5, 0.910), (3.65e5, 0.726), (4.27e5, 0.547), (4.90e5, 0.337),
    (5.03e5, 0.302), (6.28e5, 0.318), (8.10e5, 0.355),
)  # fmt: skip
"""Reynolds number and measured Cn of a long cylinder (NACA report 121)."""

DNV = (
    (2.1e5, 1.21), (2.31e5, 1.20), (2.72e5, 1.17), (2.97e5, 1.11), (3.25e5, 1.01),
    (3.62e5, 0.894), (4.10e5, 0.709), (4.75e5, 0.532), (5.25e5, 0.408), (5.79e5, 0.327),
    (6.38e5, 0.284), (7.44e5, 0.297), (1.07e6, 0.389), (1.39e6, 0.470), (1.83e6, 0.539),
    (2.26e6, 0.584), (2.90e6, 0.629), (3.66e6, 0.648), (4.94e6, 0.678),
)  # fmt: skip
"""Reynolds number and recommended Cn of a long cylinder (DNV-RP-C205, figure 6-6)."""

MORRISON = (
    (1.0, 24.673), (1e2, 1.0381), (1e3, 0.4838), (1e4, 0.3926), (1e5, 0.4257), (2e5, 0.4159),
    (3e5, 0.1734), (4e5, 0.0930), (1e6, 0.1296),
)  # fmt: skip
"""Reynolds number and Cx of a sphere, from Morrison's correlation."""

MEASURED_UP_TO = 1.61e5
"""Reynolds number up to which CALM's curve for a cylinder follows the measurements."""

_SLENDERNESS = (2.0, 5.0, 10.0, 20.0, 40.0, 50.0, 100.0)
_KAPPA = (0.58, 0.62, 0.68, 0.74, 0.82, 0.87, 0.98)
_KAPPA_ABOVE = (0.80, 0.80, 0.82, 0.90, 0.98, 0.99, 1.00)
_END_FACE = ((0.1, 1.17), (0.6, 1.07), (0.88, 0.97), (1.3, 0.86), (1.8, 0.82))

_COPIED = "The printed digits, because CALM's curve passes through these points."
_SHARE = 1e-9


def cheng(reynolds: float) -> float:
    """Return the drag coefficient Cn of a smooth cylinder by the fit of Cheng.

    The fit is valid for Reynolds numbers below 2e5.
    """
    creeping = 11.0 * pow(reynolds, -0.75)
    middle = 0.9 * (1.0 - exp(-1000.0 / reynolds))
    return creeping + middle + 1.2 * (1.0 - exp(-pow(reynolds / 4500.0, 0.7)))


DRAG_CURVES = Source(
    "Drag curves of smooth bodies",
    """Cn of a long smooth cylinder depends on the Reynolds number (C23). CALM uses Wieselsberger's
measurements (NACA report 121) up to 1.61e5 and the curve of DNV-RP-C205, figure 6-6, from 2.1e5. In
the drag crisis the two sources differ, probably because of roughness or turbulence, which neither
source states. CALM uses DNV's curve there, because this curve is more recent and more conservative.

Factors for finite length are from DNV-RP-C205, table 6-2. The drag of an end face is from
Kritzinger. Cx of a sphere is from F. A. Morrison's correlation (Michigan Technological University,
2016). Agreement with the printed points only excludes copying errors. CALM's curve is therefore
also compared with Cheng's fit (Journal of Hydraulic Engineering 139, 2013), which does not use the
printed points. The curves apply only to components declared smooth.""",
    (
        *(
            Case(f"C23 cylinder, Re {reynolds:g}, Wieselsberger", cn, "", _SHARE, _COPIED,
                 partial(cylinder_coefficient, reynolds), Kind.BY_CONSTRUCTION)
            for reynolds, cn in WIESELSBERGER if reynolds <= MEASURED_UP_TO
        ),
        *(
            Case(f"C23 cylinder, Re {reynolds:g}, DNV", cn, "", _SHARE, _COPIED,
                 partial(cylinder_coefficient, reynolds), Kind.BY_CONSTRUCTION)
            for reynolds, cn in DNV
        ),
        *(
            Case(f"C23 cylinder, Re {reynolds:g}, Cheng", round(cheng(reynolds), 4), "",
                 0.05 * cheng(reynolds),
                 "5 %, the difference between fit and measurements for Re from 17 to 1.6e5.",
                 partial(cylinder_coefficient, reynolds), Kind.CLOSED_FORM)
            for reynolds in (17.7, 63.6, 196.0, 892.0, 5.15e3, 1.5e4, 6.55e4, 1.07e5)
        ),
        *(
            Case(f"C23 κ, L/D {slenderness:g}, Re below 2e5", kappa, "", _SHARE, _COPIED,
                 partial(finite_length_factor, slenderness), Kind.BY_CONSTRUCTION)
            for slenderness, kappa in zip(_SLENDERNESS, _KAPPA, strict=True)
        ),
        *(
            Case(f"C23 κ, L/D {slenderness:g}, Re above 2e5", kappa, "", _SHARE, _COPIED,
                 partial(finite_length_factor_above, slenderness), Kind.BY_CONSTRUCTION)
            for slenderness, kappa in zip(_SLENDERNESS, _KAPPA_ABOVE, strict=True)
        ),
        Case("C23 κ, L/D 1, Wieselsberger", 0.52, "", 5.5e-3, PRINTED,
             partial(finite_length_factor, 1.0), Kind.BY_CONSTRUCTION),
        *(
            Case(f"C23 end face, L/D {slenderness:g}", ct, "", _SHARE, _COPIED,
                 partial(end_face_coefficient, slenderness), Kind.BY_CONSTRUCTION)
            for slenderness, ct in _END_FACE
        ),
        *(
            Case(f"C23 sphere, Re {reynolds:g}", cx, "", 5.5e-4 if cx > 10.0 else 5.5e-5, PRINTED,
                 partial(sphere_coefficient, reynolds), Kind.CLOSED_FORM)
            for reynolds, cx in MORRISON
        ),
    ),
    picture="verification-drag-curves",
)  # fmt: skip


_AMPLITUDES = (0.3, 0.5, 0.9, 1.0, 1.4)

STRUMMING_FACTORS = Source(
    "Strumming factors",
    """The ratio of Cn of a strumming line to Cn at rest depends on the amplitude A/D. It is 1 +
1.043 (2 Y_rms/D)^0.65 with Y_rms = A/√2 by Vandiver (1983), 1 + 2.1 A/D by Blevins (1990), and 1 +
1.16 (w_r − 1)^0.65 with w_r = 1 + 2 A/D by Skop, Griffin & Ramberg (1977). Above A/D = 1, CALM
keeps Blevins' ratio constant, because the straight line exceeds the values measured on cables at
sea: Cn of 2.4 to 3.2, about 2.0 to 2.7 times the value at rest (Griffin et al. 1984). All three
laws give such ratios for A/D from 0.5 to 1.""",
    tuple(
        Case(f"{name}, A/D {amplitude:g}", printed, "", 5.5e-4,
             PRINTED, partial(factor, amplitude), Kind.CLOSED_FORM)
        for name, factor, row in (
            ("Vandiver", vandiver, (1.597, 1.833, 2.220, 2.307, 2.626)),
            ("Blevins", blevins, (1.630, 2.050, 2.890, 3.100)),
            ("Skop-Griffin-Ramberg", skop_griffin, (1.832, 2.160, 2.700, 2.820, 3.265)),
        )
        for amplitude, printed in zip(_AMPLITUDES, row, strict=False)
    ),
)  # fmt: skip


_TEMPERATURES = (0, 5, 10, 15, 20, 25, 30)

_VISCOSITY = (
    (0, (1.7914, 1.5181, 1.3060, 1.1377, 1.0018, 0.8902, 0.7973)),
    (30, (1.8871, 1.6031, 1.3824, 1.2069, 1.0649, 0.9482, 0.8509)),
    (35, (1.9056, 1.6193, 1.3968, 1.2199, 1.0766, 0.9588, 0.8606)),
    (40, (1.9247, 1.6361, 1.4116, 1.2332, 1.0887, 0.9698, 0.8707)),
)
"""Salinities [g/kg], each with the dynamic viscosities at `_TEMPERATURES` [mPa s]."""

_KINEMATIC = (1.8535, 1.5757, 1.3601, 1.1890, 1.0506, 0.9370, 0.8423)
"""Kinematic viscosity at a salinity of 35 g/kg and at `_TEMPERATURES` [1e-6 m²/s]."""

_DENSITY = (
    (35.165, 10.0, 0, 1026.952), (35.2, 10.0, 500, 1029.237), (35.0, 5.0, 1000, 1032.160),
    (34.9, 1.5, 4000, 1046.132), (34.9, 1.5, 5000, 1050.502), (34.9, 1.5, 6000, 1054.787),
)  # fmt: skip
"""Absolute salinity [g/kg], conservative temperature [°C], depth [m], density [kg/m³]."""

_GRAVITY = ((0, 9.780327), (30, 9.793249), (45, 9.806200), (60, 9.819179), (90, 9.832186))
"""Latitude [degrees], gravity at the sea surface [m/s²]."""

_LATITUDE = 30.0


def _viscosity(temperature: float, salinity: float) -> float:
    return 1e3 * float(seawater.dynamic_viscosity(temperature, salinity))


def _kinematic(temperature: float) -> float:
    """Return the kinematic viscosity at 35 g/kg [1e-6 m²/s]."""
    density = float(seawater.density(temperature, 35.0, 0.0))
    return 1e6 * float(seawater.kinematic_viscosity(temperature, 35.0, density))


def _density(salinity: float, temperature: float, depth: float) -> float:
    return float(seawater.absolute_density(salinity, temperature, depth, _LATITUDE))


SEA_WATER = Source(
    "Sea water and gravity",
    """CALM computes viscosity by Sharqawy, Lienhard & Zubair (Desalination and Water Treatment 16,
2010, equations 22 and 23, accurate to 1.5 %), density by TEOS-10 (here at 30° of latitude), and
gravity by the international formula that TEOS-10 uses (C23). The viscosity is also compared with a
regression of Dorsey's measurements (1940), with other measurements, and with the viscosity of pure
water at 20 °C.""",
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


_PAPER_VISCOSITY = (
    (0, (1.79, 1.52, 1.31, 1.14, 1.01, 0.89, 0.80)),
    (10, (1.82, 1.55, 1.34, 1.17, 1.03, 0.91, 0.82)),
    (20, (1.85, 1.58, 1.36, 1.19, 1.05, 0.93, 0.84)),
    (30, (1.88, 1.60, 1.38, 1.21, 1.07, 0.95, 0.86)),
    (35, (1.89, 1.61, 1.39, 1.22, 1.09, 0.96, 0.87)),
)
"""Salinities [g/kg], each with the dynamic viscosities at `_TEMPERATURES` [mPl = mPa s]."""

_METER_SPEED = (0.51, 1.03, 1.54, 2.06, 2.57)
_METER_DRAG = (1.03, 2.45, 4.98, 10.56, 20.60)
"""Drag of an Aanderaa RCM4 or RCM5 current meter [kgf] at the tabulated speeds [m/s], as published
by the manufacturer.
"""


CALM_PAPER = Source(
    "Paper on the original CALM",
    """The paper on the original CALM has a table of dynamic viscosities, in mPl, which is mPa s. It
also has the drag F of an Aanderaa RCM4/RCM5 at five speeds V, and the rule K = Σ(F/V) / ΣV. CALM
uses this rule to derive a drag from such measurements. The paper gives K as 2.694 N. The
manufacturer's forces are in kilograms-force, so K is 26.4 N/(m/s)². The drag of a plate as large as
the meter confirms this unit.""",
    (
        *(
            Case(f"viscosity, {temperature} °C, {salinity} g/kg", printed, "mPa s",
                 0.015 * printed,
                 "1.5 %, the accuracy of Sharqawy's formula; the table is from other measurements.",
                 partial(_viscosity, temperature, salinity), Kind.PUBLISHED)
            for salinity, row in _PAPER_VISCOSITY
            for temperature, printed in zip(_TEMPERATURES, row, strict=True)
        ),
        Case("RCM4/RCM5: K", 2.694, "kgf/(m/s)²", 5.5e-4,
             PRINTED,
             partial(measured_drag, _METER_SPEED, _METER_DRAG), Kind.PUBLISHED),
    ),
)  # fmt: skip
