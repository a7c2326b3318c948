"""The paper of the original CALM: viscosities and the drag of a current meter."""

from __future__ import annotations

from functools import partial

from calm.physics.drag import measured_drag
from calm.physics.seawater import dynamic_viscosity
from calm.verification.case import PRINTED, Case, Kind, Source
from calm.verification.sea_water import _TEMPERATURES

_PAPER_VISCOSITY = (
    (0, (1.79, 1.52, 1.31, 1.14, 1.01, 0.89, 0.80)),
    (10, (1.82, 1.55, 1.34, 1.17, 1.03, 0.91, 0.82)),
    (20, (1.85, 1.58, 1.36, 1.19, 1.05, 0.93, 0.84)),
    (30, (1.88, 1.60, 1.38, 1.21, 1.07, 0.95, 0.86)),
    (35, (1.89, 1.61, 1.39, 1.22, 1.09, 0.96, 0.87)),
)
"""Salinity [g/kg]; dynamic viscosity [mPl, which is mPa s] at each temperature."""

_METER_SPEED = (0.51, 1.03, 1.54, 2.06, 2.57)
_METER_DRAG = (1.03, 2.45, 4.98, 10.56, 20.60)
"""Drag of an Aanderaa RCM4 or RCM5 [kgf] at those speeds [m/s], the maker's figures."""


def _viscosity_at(temperature: float, salinity: float) -> float:
    """[mPa s]"""
    return 1e3 * float(dynamic_viscosity(temperature, salinity))


CALM_PAPER = Source(
    "The paper of the original CALM",
    """The original CALM's paper prints a table of dynamic viscosities (mPl, which is mPa s) and the
drag of an Aanderaa RCM4/RCM5 at five speeds, with the rule K = Σ(F/V) / ΣV for what CALM makes of
such pairs. It calls that K = 2.694 newtons; the figures are the maker's and in kilograms-force, as
a plate of that instrument's size bears out, so that K is 26.4 N/(m/s)².""",
    (
        *(
            Case(f"viscosity, {temperature} °C, {salinity} g/kg", printed, "mPa s",
                 0.015 * printed,
                 "1.5 %, the accuracy of Sharqawy's formula; the table is of other measurements.",
                 partial(_viscosity_at, temperature, salinity), Kind.PUBLISHED)
            for salinity, row in _PAPER_VISCOSITY
            for temperature, printed in zip(_TEMPERATURES, row, strict=True)
        ),
        Case("RCM4/RCM5: K", 2.694, "kgf/(m/s)²", 5.5e-4,
             PRINTED,
             partial(measured_drag, _METER_SPEED, _METER_DRAG), Kind.PUBLISHED),
    ),
)  # fmt: skip
