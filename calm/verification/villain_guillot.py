"""Villain-Guillot's closed form of a cable towed with linear drag."""

from __future__ import annotations

from functools import cache, partial
from math import cos, radians, sin

from calm.analytic.hodograph import Station
from calm.analytic.villain_guillot import linear_cable
from calm.verification.case import PRINTED, CaseColumn, Kind, Source, table

_LENGTH, _UNIT = 1.25, 0.5
"""L and ℓ = T₀/√((μg)² + (kV)²) of the figure."""


@cache
def _cable(start: float, mean: float) -> Station:
    """α₀ and α_d in degrees, unit load."""
    angle = radians(mean)
    return linear_cable(_LENGTH, _UNIT, radians(start), sin(angle), cos(angle))


VILLAIN_GUILLOT = Source(
    "Villain-Guillot, figure 1",
    """S. Villain-Guillot's towed cable with a drag linear in each component of the velocity, equal
along and across (D = 1, k_t = k_n): tan α_d = μg/(kV), ℓ = T₀/√((μg)² + (kV)²), with L = 1.25 and
ℓ = 0.5 as in his figure 1; evaluated from the closed form in the paper and held against
`calm.analytic.villain_guillot`. His formula for ρ(α) at D = 1 is printed upside down; s, T and the
shape are right.""",
    table(
        [
            CaseColumn("x", "", 5.5e-7, lambda cable: float(cable.x)),
            CaseColumn("y", "", 5.5e-7, lambda cable: float(cable.z)),
            CaseColumn("T/T₀", "", 5.5e-7, lambda cable: float(cable.tension) / _UNIT),
        ],
        [
            (f"α₀ {start}°, α_d {mean}°", partial(_cable, start, mean), (x, y, 3.402959))
            for start, mean, x, y in (
                (0, 30, 1.201579, 0.321762),
                (60, 30, 0.879444, 0.879717),
                (30, 60, 0.879717, 0.879444),
            )
        ],
        PRINTED,
        Kind.CLOSED_FORM,
    ),
)
