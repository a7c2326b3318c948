"""The kinds of components that a catalogue, or `components:` of a mooring file, can define.

Lengths, masses and forces of cables and chains are per metre.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Set
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, ConfigDict, Field, ValidationInfo, model_validator

from calm.errors import about_quantity
from calm.files import definition
from calm.files.definition import (
    CATALOGUE_DENSITY,
    STANDARD_GRAVITY,
    ColumnHeading,
    QuantityField,
    optional,
)
from calm.files.rigid import DRAG_FORMS, Body, Cylinder, Profiler, Rigid, Sphere
from calm.files.yaml_document import unknown_key
from calm.physics.materials import STEEL_DENSITY, density_of, fibre_of
from calm.physics.stretch import ElongationCurve
from calm.units import QuantityError

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
    tuple[
        tuple[
            Annotated[float, _LOAD, ColumnHeading("load / breaking load")],
            Annotated[float, _STRAIN, ColumnHeading("strain")],
        ],
        ...,
    ],
    AfterValidator(_refuse_what_is_no_curve),
]
"""Table of (load / breaking load, strain at that load), with increasing loads."""


WeightPerMetre = Annotated[
    float | None,
    QuantityField("force per length"),
    Field(description="weight in sea water of 1025 kg/m^3 (per metre of a cable or chain)"),
]
MassPerMetre = Annotated[
    float | None,
    QuantityField("mass per length", at_least=0),
    Field(description="mass in air (per metre of a cable or chain)"),
]


class Flexible(definition.Definition):
    """Base class of cables and chains, whose weight, mass and buoyancy are per metre."""

    role: definition.Role = "line"
    diameter: definition.Diameter
    weight: WeightPerMetre = Field(default=None, examples=["2.1 N/m"])
    mass: MassPerMetre = Field(default=None, examples=["0.2 kg/m"])
    density: definition.MaterialDensity = None
    cn: definition.NormalCoefficient = None
    ct: definition.TangentialCoefficient = None
    stiffness: definition.PositiveForce = optional(
        "EA, the force that would double the length, e.g. 4 MN", "4 MN"
    )

    def strain_under(self, load: float) -> float:
        """Return the strain under a load ≥ 0 [N], as the solver computes it.

        The strain is 0 if the stiffness is unknown.
        """
        return load / self.stiffness if self.stiffness is not None else 0.0


class Cable(Flexible):
    """A rope, wire or electrical cable."""

    kind: Literal["cable"] = Field(description="kind of the component")
    buoyancy: Annotated[float | None, QuantityField("force per length")] = optional(
        "net force in sea water of 1025 kg/m^3, positive up (per metre of a cable)", "0.1 N/m"
    )
    finish: Literal["smooth", "rough", "very-rough"] | None = optional(
        "surface finish of a cable", "rough"
    )
    torque_balanced: bool | None = optional(
        "true for a wire rope that does not rotate under load", True
    )
    elongation: Elongation | None = optional(
        "rows of two numbers: the load as a fraction of the breaking load, then the strain at "
        "that load, e.g. [[0.1, 0.03], [0.3, 0.08]]",
        [[0.05, 0.05], [0.1, 0.08], [0.2, 0.12]],
    )
    dynamic_stiffness: definition.PositiveForce = optional(
        "EA under the rapid loads of waves, larger than EA under a slow load", "600 kN"
    )
    permanent_elongation: Annotated[
        float | None, QuantityField("number", at_least=0, at_most=1)
    ] = optional(
        "permanent strain of a rope after its first loading, added to every strain in `elongation`",
        "4 %",
    )

    @property
    def net_buoyancy(self) -> float:
        """Net buoyancy per metre in water, positive up [N/m].

        If only the mass is known, the weight in air is used as the weight in water.
        """
        if self.buoyancy is not None:
            return self.buoyancy
        if self.weight is not None:
            return -self.weight
        assert self.mass is not None
        borne = 0.0 if self.density is None else CATALOGUE_DENSITY / self.density
        return (borne - 1) * self.mass * STANDARD_GRAVITY

    @property
    def displaced_volume(self) -> float | None:
        """Displaced volume per metre [m³/m]; None if it does not follow from the given values."""
        if self._gives_no_force and self.density is None:
            return None
        return definition.volume_from_weights(self.mass, self.net_buoyancy)

    @property
    def _gives_no_force(self) -> bool:
        return self.weight is None and self.buoyancy is None

    @model_validator(mode="after")
    def _weight_is_given_once(self, info: ValidationInfo) -> Cable:
        if self.weight is not None and self.buoyancy is not None:
            raise ValueError(
                "has both `weight` and `buoyancy`; give only one, since each is the negative "
                "of the other"
            )
        if self._gives_no_force:
            if not definition.is_in_air(info) and (self.mass is None or self.density is None):
                raise ValueError("needs `weight` or `buoyancy` in water, or `mass` with `density`")
            if self.mass is None:
                raise ValueError("needs `mass`, or `weight`")
        definition.refuse_weight_above_mass(self.mass, self.net_buoyancy)
        return self

    @model_validator(mode="after")
    def _stretch_is_given_once(self) -> Cable:
        if self.elongation is None:
            if self.permanent_elongation is not None:
                raise ValueError("`permanent_elongation` needs `elongation`")
        elif self.stiffness is not None:
            raise ValueError("has both `stiffness` and `elongation`; give only one")
        elif self.breaking_load is None:
            raise ValueError(
                "`elongation` needs `breaking_load`, because its loads are fractions of the "
                "breaking load"
            )
        return self

    def strain_under(self, load: float) -> float:
        """Return the strain under a load ≥ 0 [N], from the table `elongation` or the stiffness."""
        if self.elongation is None:
            return super().strain_under(load)
        assert self.breaking_load is not None
        permanent = self.permanent_elongation or 0.0
        return ElongationCurve(self.elongation, self.breaking_load, permanent).strain(load)


class Chain(Flexible):
    """A chain; `diameter` is the bar diameter."""

    kind: Literal["chain"] = Field(description="kind of the component")
    weight: WeightPerMetre = Field(default=None, examples=["27 N/m"])
    mass: MassPerMetre = Field(default=None, examples=["3.2 kg/m"])

    @property
    def net_buoyancy(self) -> float:
        """Net buoyancy per metre in water, positive up [N/m]."""
        if self.weight is not None:
            return -self.weight
        mass = 19.9e3 * self.diameter**2 if self.mass is None else self.mass
        return (CATALOGUE_DENSITY / (self.density or STEEL_DENSITY) - 1) * mass * STANDARD_GRAVITY

    @property
    def displaced_volume(self) -> float | None:
        """Displaced volume per metre [m³/m]; None if only the weight is known."""
        if self.mass is not None or self.weight is not None:
            return definition.volume_from_weights(self.mass, self.net_buoyancy)
        return 19.9e3 * self.diameter**2 / (self.density or STEEL_DENSITY)

    @model_validator(mode="after")
    def _weight_is_possible(self) -> Chain:
        definition.refuse_weight_above_mass(self.mass, self.net_buoyancy)
        return self


class Anchor(definition.Definition):
    """An anchor at the lower end of a line; the drag of the anchor is used only during its fall."""

    role: definition.Role = "anchor"
    kind: Literal["anchor"] = Field(description="kind of the component")
    mass: definition.Mass = None
    weight: Annotated[float | None, QuantityField("force", at_least=0)] = optional(
        "weight in sea water of 1025 kg/m^3 (per metre of a cable or chain)", "5000 N"
    )
    density: definition.MaterialDensity = None
    length: definition.Length = 0.0
    friction: Annotated[float | None, QuantityField("number", above=0, at_most=10)] = optional(
        "friction coefficient on the seabed", 0.6
    )
    kt: definition.TangentialDrag = Field(default=None, examples=["200 N/(m/s)^2"])

    @property
    def net_buoyancy(self) -> float:
        """Net buoyancy in water [N], which is minus the submerged weight."""
        if self.weight is not None:
            return -self.weight
        assert self.mass is not None
        submerged = 1 - CATALOGUE_DENSITY / (self.material_density or STEEL_DENSITY)
        return -submerged * self.mass * STANDARD_GRAVITY

    @property
    def material_known(self) -> bool:
        """Whether the weight in water is given or follows from a known material density."""
        return self.weight is not None or self.material_density is not None

    @property
    def material_density(self) -> float | None:
        """Density of the anchor, specified or from its material [kg/m³]; None if unknown."""
        return self.density or density_of(self.material)

    @property
    def displaced_volume(self) -> float | None:
        """Displaced volume [m³]; None if only the weight is known."""
        return definition.volume_from_weights(self.mass, self.net_buoyancy)

    @model_validator(mode="after")
    def _weight_is_known(self) -> Anchor:
        if self.mass is None and self.weight is None:
            raise ValueError("needs `mass`, or `weight` in water")
        definition.refuse_weight_above_mass(self.mass, self.net_buoyancy)
        return self


RigidComponent = Sphere | Cylinder | Body | Profiler
FlexibleComponent = Cable | Chain
Component = RigidComponent | FlexibleComponent | Anchor

KINDS: dict[str, type[Component]] = {
    "sphere": Sphere,
    "cylinder": Cylinder,
    "body": Body,
    "profiler": Profiler,
    "cable": Cable,
    "chain": Chain,
    "anchor": Anchor,
}

FLEXIBLE_KINDS = frozenset(kind for kind, model in KINDS.items() if issubclass(model, Flexible))
"""Kinds with values per metre, which are cut to a length."""

RIGID_KINDS = frozenset(kind for kind, model in KINDS.items() if issubclass(model, Rigid))
"""Kinds of a fixed length, which may also be clamped on a line."""


_DRAG_KEYS = frozenset(key for form in DRAG_FORMS for key in form) | {"kt"}


_ESSENTIAL = {
    "length": {"length"},
    "diameter": {"diameter"},
    "buoyancy": {"buoyancy", "volume"},
    "weight": {"weight", "buoyancy", "density"},
    "drag_area": _DRAG_KEYS,
}
"""Values that every component needs, and the keys from which each value can be computed."""


class Outline(definition.Definition):
    """A product for which no source publishes some required values.

    The mooring file that uses the product must supply these values.
    """

    model_config = ConfigDict(extra="allow")

    kind: str

    @model_validator(mode="before")
    @classmethod
    def _of_its_kind(cls, data: dict[str, Any]) -> dict[str, Any]:
        fields = KINDS[data["kind"]].model_fields
        if strange := next((key for key in data if key not in fields), None):
            raise ValueError(unknown_key(strange, [*fields], f" for kind {data['kind']}"))
        for key in data.keys() - cls.model_fields.keys():
            if quantity := definition.quantity_of(fields[key]):
                try:
                    data = data | {key: quantity.read(data[key])}
                except QuantityError as error:
                    raise ValueError(about_quantity(key, data[key], error)) from error
        return data

    @property
    def lacks(self) -> list[str]:
        """Missing keys that the mooring file must supply."""
        return lacking(self.model_dump(exclude_none=True))

    def asks(self, id: str) -> str:
        """Return a message that lists the values that the mooring file must supply."""
        given = self.model_dump(exclude_none=True)
        also = [key for key in self.searched or () if key not in (*given, *self.lacks)]
        keys, judged = (", ".join(f"`{key}`" for key in each) for each in (self.lacks, also))
        message = (
            f"no source gives {keys} of `{id}`: measure it or ask the manufacturer, and "
            "specify it here"
        )
        message += f", with {judged} for the design check" if judged else ""
        return f"{message} (the rest is from: {self.source})" if self.source else message


def lacking(fields: Mapping[str, Any]) -> list[str]:
    """Return the required keys that are missing because no value is published.

    The key `searched` of a component lists the keys without a published value.
    """
    searched = fields.get("searched")
    known = searched if isinstance(searched, list | tuple) else ()
    return [
        key
        for key, alternatives in _ESSENTIAL.items()
        if key in known and not fields.keys() & alternatives
    ]


def contradicted(kind: str, base: Set[str], override: Set[str]) -> frozenset[str]:
    """Return the keys of a definition that must be dropped because of an override.

    =============== ============================ =====================================
    kind            override gives               dropped from the definition
    =============== ============================ =====================================
    body, profiler  a drag in another form       all drag keys
    rigid           `buoyancy`                   `volume`
    rigid           `mass` or `volume`,          `buoyancy`
                    if both are known
    cable           `weight` or `buoyancy`       the other of the two
    cable           `mass` or `density`,         `weight`, `buoyancy`
                    if both are known
    cable           `stiffness`                  `elongation`, `permanent_elongation`
    cable           `elongation`                 `stiffness`
    chain, anchor   `mass` or `density`          `weight`
    =============== ============================ =====================================

    In this table, a key is known if the definition or the override gives it.
    """
    known = base | override
    void: set[str] = set()
    if kind in ("body", "profiler"):
        for form in DRAG_FORMS:
            if override & set(form) and not base & set(form):
                void = set(_DRAG_KEYS)
    if kind in RIGID_KINDS:
        if "buoyancy" in override:
            void.add("volume")
        elif known >= {"mass", "volume"} and override & {"mass", "volume"}:
            void.add("buoyancy")
    elif kind == "cable":
        if override & {"weight", "buoyancy"} or (
            known >= {"mass", "density"} and override & {"mass", "density"}
        ):
            void |= {"weight", "buoyancy"}
        if "stiffness" in override:
            void |= {"elongation", "permanent_elongation"}
        if "elongation" in override:
            void.add("stiffness")
    elif override & {"mass", "density"}:
        void.add("weight")
    return frozenset(void - override)


def odd_overrides(
    use: str, defined: Component, component: Component, given: Set[str]
) -> Iterator[str]:
    """Yield a message for each implausible override of a definition.

    Parameters
    ----------
    use : id of the definition
    defined, component : the component before and after the overrides
    given : keys that are overridden
    """
    if "mass" in given and component.net_buoyancy == defined.net_buoyancy:
        yield (
            f"`mass` of {use} is overridden, but not its net force in water; override the net "
            "force as well if it changes"
        )
    if isinstance(defined, Anchor) and isinstance(component, Anchor) and "weight" in given:
        share = 1.0 - CATALOGUE_DENSITY / (defined.material_density or STEEL_DENSITY)
        in_air = defined.net_buoyancy / -share
        if abs((component.weight or 0.0) - in_air) < 0.01 * in_air:
            yield f"`weight` of {use} equals its weight in air; `weight` means weight in water"
    fibre = fibre_of(defined.material)
    if fibre is not None and fibre_of(component.material) is None:
        yield (
            f"`material: {component.material}` replaces the {fibre.name} of {use}; the part is "
            "no longer checked as a fibre rope"
        )
