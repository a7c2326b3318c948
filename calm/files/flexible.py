"""Cables and chains; their lengths, masses and forces are per metre."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field, ValidationInfo, model_validator

from calm.files.definition import (
    CATALOGUE_DENSITY,
    POSITIVE_FORCE,
    STANDARD_GRAVITY,
    Definition,
    Diameter,
    MaterialDensity,
    NormalCoefficient,
    QuantityField,
    Role,
    TangentialCoefficient,
    is_in_air,
    refuse_weight_above_mass,
    volume_from_weights,
)
from calm.physics.materials import STEEL_DENSITY
from calm.physics.stretch import ElongationCurve

_LOAD = QuantityField("number", at_least=0, at_most=1)
_STRAIN = QuantityField("number", at_least=0)

Points = tuple[tuple[float, float], ...]


def _refuse_what_is_no_curve(points: Points) -> Points:
    try:
        ElongationCurve(points, breaking_load=1.0)
    except ValueError as error:
        raise ValueError(f"`elongation`: {error}") from error
    return points


Elongation = Annotated[
    tuple[tuple[Annotated[float, _LOAD], Annotated[float, _STRAIN]], ...],
    AfterValidator(_refuse_what_is_no_curve),
]
"""Load over breaking load, and the strain under it: rows by growing load."""


WeightPerMetre = Annotated[
    float | None,
    QuantityField("force per length"),
    Field(description="in sea water of 1025 kg/m^3 (per metre of a cable or chain)"),
]
MassPerMetre = Annotated[
    float | None,
    QuantityField("mass per length", at_least=0),
    Field(description="in air (per metre of a cable or chain)"),
]


class Flexible(Definition):
    """A cable or chain: all its figures are per metre."""

    role: Role = "line"
    diameter: Diameter
    weight: WeightPerMetre = Field(default=None, examples=["2.1 N/m"])
    mass: MassPerMetre = Field(default=None, examples=["0.2 kg/m"])
    density: MaterialDensity = None
    cn: NormalCoefficient = None
    ct: TangentialCoefficient = None
    stiffness: Annotated[float | None, POSITIVE_FORCE] = Field(
        default=None,
        description="EA, the force that would double the length, e.g. 4 MN",
        examples=["4 MN"],
    )


class Cable(Flexible):
    """A rope, wire or electrical cable."""

    kind: Literal["cable"] = Field(description="which kind of component it is")
    buoyancy: Annotated[float | None, QuantityField("force per length")] = Field(
        default=None,
        description="net force in sea water of 1025 kg/m^3, positive up (per metre of a cable)",
        examples=["0.1 N/m"],
    )
    finish: Literal["smooth", "rough", "very-rough"] | None = Field(
        default=None, description="of the surface of a cable", examples=["rough"]
    )
    torque_balanced: bool | None = Field(
        default=None,
        description="of a wire rope: whether it does not turn under load",
        examples=[True],
    )
    elongation: Elongation | None = Field(
        default=None,
        description="rows of load over breaking load and strain, e.g. [[0.1, 0.03], [0.3, 0.08]]",
        examples=[[[0.05, 0.05], [0.1, 0.08], [0.2, 0.12]]],
    )
    dynamic_stiffness: Annotated[float | None, POSITIVE_FORCE] = Field(
        default=None,
        description="EA under the quick loads of waves, greater than that of a slow load",
        examples=["600 kN"],
    )
    permanent_elongation: Annotated[
        float | None, QuantityField("number", at_least=0, at_most=1)
    ] = Field(
        default=None,
        description="of a rope that has been loaded, at every tension, e.g. 4 %",
        examples=["4 %"],
    )

    @property
    def net_buoyancy(self) -> float:
        """Return the net force of a metre in water, positive up; of a mass alone, in air [N/m]."""
        if self.buoyancy is not None:
            return self.buoyancy
        if self.weight is not None:
            return -self.weight
        assert self.mass is not None
        borne = 0.0 if self.density is None else CATALOGUE_DENSITY / self.density
        return (borne - 1) * self.mass * STANDARD_GRAVITY

    @property
    def displaced_volume(self) -> float | None:
        """Return the volume displaced by a metre [m³/m], None if the mass is unknown, or is all."""
        if self._gives_no_force and self.density is None:
            return None
        return volume_from_weights(self.mass, self.net_buoyancy)

    @property
    def _gives_no_force(self) -> bool:
        return self.weight is None and self.buoyancy is None

    @model_validator(mode="after")
    def _weight_is_given_once(self, info: ValidationInfo) -> Cable:
        if self.weight is not None and self.buoyancy is not None:
            raise ValueError("gives both `weight` and `buoyancy`; one is the other negated")
        if self._gives_no_force:
            if not is_in_air(info) and (self.mass is None or self.density is None):
                raise ValueError("needs `weight` or `buoyancy` in water, or `mass` with `density`")
            if self.mass is None:
                raise ValueError("needs `mass`, or `weight`")
        refuse_weight_above_mass(self.mass, self.net_buoyancy)
        return self

    @model_validator(mode="after")
    def _stretch_is_given_once(self) -> Cable:
        if self.elongation is None:
            if self.permanent_elongation is not None:
                raise ValueError("`permanent_elongation` needs `elongation`")
        elif self.stiffness is not None:
            raise ValueError("gives both `stiffness` and `elongation`; one says how it stretches")
        elif self.breaking_load is None:
            raise ValueError("`elongation` needs `breaking_load`: its loads are shares of that")
        return self


def strain_under(component: Flexible, load: float) -> float:
    """Return the strain of a cable or chain under a load ≥ 0 [N], as the solver has it [-].

    By its `elongation`, else load / `stiffness`; 0 of one that gives neither.
    """
    if isinstance(component, Cable) and component.elongation is not None:
        assert component.breaking_load is not None
        permanent = component.permanent_elongation or 0.0
        return ElongationCurve(component.elongation, component.breaking_load, permanent).strain(
            load
        )
    return load / component.stiffness if component.stiffness is not None else 0.0


class Chain(Flexible):
    """A chain; `diameter` is that of its bar."""

    kind: Literal["chain"] = Field(description="which kind of component it is")
    weight: WeightPerMetre = Field(default=None, examples=["27 N/m"])
    mass: MassPerMetre = Field(default=None, examples=["3.2 kg/m"])

    @property
    def net_buoyancy(self) -> float:
        """Return the net force in water of a metre, positive up [N/m]."""
        if self.weight is not None:
            return -self.weight
        mass = 19.9e3 * self.diameter**2 if self.mass is None else self.mass
        return (CATALOGUE_DENSITY / (self.density or STEEL_DENSITY) - 1) * mass * STANDARD_GRAVITY

    @property
    def displaced_volume(self) -> float | None:
        """Return the volume displaced by a metre [m³/m], None when only its weight is known."""
        if self.mass is not None or self.weight is not None:
            return volume_from_weights(self.mass, self.net_buoyancy)
        return 19.9e3 * self.diameter**2 / (self.density or STEEL_DENSITY)

    @model_validator(mode="after")
    def _weight_is_possible(self) -> Chain:
        refuse_weight_above_mass(self.mass, self.net_buoyancy)
        return self
