"""What every component definition may say, and the conventions its figures follow.

Figures are SI floats, angles degrees, None where the definition does not say. Net forces are those
in sea water of `CATALOGUE_DENSITY` under standard gravity.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import ValidationInfo, model_validator

from calm.files.fields import POSITIVE_FORCE, POSITIVE_LENGTH, TILT, Model, Quantity, Role, Text
from calm.units import KILOGRAM_FORCE

CATALOGUE_DENSITY = 1025.0
"""Density of the sea water in which net forces and drags are given [kg/m³]."""

STANDARD_GRAVITY = KILOGRAM_FORCE
"""The force of gravity on a kilogram [N]."""

STEEL_DENSITY = 7850.0
"""Density of chains and anchors that do not give theirs [kg/m³]."""

DISAGREEMENT = 0.01
"""Share by which figures that say the same thing may differ."""

IN_AIR: Mapping[str, object] = {"fluid": "air"}
"""Context of a definition that is read for use in air, where its mass is all that is needed."""

MASS = Quantity("mass", at_least=0)
DENSITY = Quantity("density", above=0)


class Definition(Model):
    """What every component may say, whatever its kind.

    `source` is that of every figure but those for which `sources` names another, field by field.
    `searched` are the fields that were looked for and that no source prints; `prefer` is the id of
    the definition of the same thing that is to be used in place of this one.
    """

    role: Role = "instrument"
    name: Text | None = None
    manufacturer: Text | None = None
    part_number: Text | None = None
    material: Text | None = None
    note: Text | None = None
    source: Text | None = None
    sources: dict[str, Text] | None = None
    searched: tuple[str, ...] | None = None
    prefer: Text | None = None
    date: Text | None = None
    depth_rating: Annotated[float | None, POSITIVE_LENGTH] = None
    working_load: Annotated[float | None, POSITIVE_FORCE] = None
    breaking_load: Annotated[float | None, POSITIVE_FORCE] = None
    opening_load: Annotated[float | None, POSITIVE_FORCE] = None
    grip: Annotated[float | None, POSITIVE_FORCE] = None
    max_tilt: Annotated[float | None, TILT] = None
    warn_tilt: Annotated[float | None, TILT] = None
    slack: Literal["allowed"] | None = None

    @model_validator(mode="after")
    def _works_below_breaking(self) -> Definition:
        working, breaking = self.working_load, self.breaking_load
        if working is not None and breaking is not None and working > breaking:
            raise ValueError(
                f"`working_load` is {working:g} N, above the `breaking_load` of {breaking:g} N"
            )
        return self


def is_in_air(info: ValidationInfo) -> bool:
    """Whether the definition that is being validated is read for use in air."""
    return info.context == IN_AIR


def volume_from_weights(mass: float | None, net_buoyancy: float) -> float | None:
    """Volume of water displaced [m³, per metre where they are], None where the mass is unknown."""
    if mass is None:
        return None
    return (mass + net_buoyancy / STANDARD_GRAVITY) / CATALOGUE_DENSITY


def refuse_weight_above_mass(mass: float | None, net_buoyancy: float) -> None:
    """A thing cannot weigh more in water than in air."""
    if mass is not None and -net_buoyancy > mass * STANDARD_GRAVITY * (1 + DISAGREEMENT):
        raise ValueError(
            f"weighs more in water ({-net_buoyancy:.5g} N) than its mass of {mass:g} kg does in air"
        )
