"""The kinds of components that a catalogue, or `components:` of a mooring file, can define.

Some figures are alternatives: a body gives its drag as `kn` or as `drag_area` with `cd`; a net
force is given, or follows from mass and volume. An override that gives one alternative drops the
others; whatever it does not contradict stays.
"""

from __future__ import annotations

from collections.abc import Set
from typing import Annotated, Literal

from pydantic import Field, model_validator

from calm.files.definition import (
    CATALOGUE_DENSITY,
    STANDARD_GRAVITY,
    Definition,
    Length,
    Mass,
    MaterialDensity,
    QuantityField,
    Role,
    TangentialDrag,
    refuse_weight_above_mass,
    volume_from_weights,
)
from calm.files.flexible import Cable, Chain, Flexible
from calm.files.rigid import (
    DRAG_FORMS,
    Body,
    Cylinder,
    CylinderShape,
    Profiler,
    Rigid,
    Shaped,
    Sphere,
    SphereShape,
)
from calm.physics.materials import STEEL_DENSITY, density_of

__all__ = [
    "FLEXIBLE_KINDS",
    "KINDS",
    "RIGID_KINDS",
    "Anchor",
    "Body",
    "Cable",
    "Chain",
    "Component",
    "Cylinder",
    "CylinderShape",
    "FlexibleComponent",
    "Profiler",
    "RigidComponent",
    "Shaped",
    "Sphere",
    "SphereShape",
]


class Anchor(Definition):
    """The lower end: stands on the seabed, carries no drag."""

    role: Role = "anchor"
    kind: Literal["anchor"] = Field(description="which kind of component it is")
    mass: Mass = None
    weight: Annotated[float | None, QuantityField("force", at_least=0)] = Field(
        default=None,
        description="in sea water of 1025 kg/m^3 (per metre of a cable or chain)",
        examples=["5000 N"],
    )
    density: MaterialDensity = None
    length: Length = 0.0
    friction: Annotated[float | None, QuantityField("number", above=0)] = Field(
        default=None, description="coefficient on the seabed", examples=[0.6]
    )
    kt: TangentialDrag = None

    @property
    def net_buoyancy(self) -> float:
        """Return the net force in water, positive up: the weight negated [N]."""
        if self.weight is not None:
            return -self.weight
        assert self.mass is not None
        submerged = 1 - CATALOGUE_DENSITY / (self.material_density or STEEL_DENSITY)
        return -submerged * self.mass * STANDARD_GRAVITY

    @property
    def material_known(self) -> bool:
        """Return whether its weight in water is given, or follows from a known material."""
        return self.weight is not None or self.material_density is not None

    @property
    def material_density(self) -> float | None:
        """Return the density given, or that of its material [kg/m³]; None if unknown."""
        return self.density or density_of(self.material)

    @property
    def displaced_volume(self) -> float | None:
        """Return the volume of water displaced [m³], None when only the weight is known."""
        return volume_from_weights(self.mass, self.net_buoyancy)

    @model_validator(mode="after")
    def _weight_is_known(self) -> Anchor:
        if self.mass is None and self.weight is None:
            raise ValueError("needs `mass`, or `weight` in water")
        refuse_weight_above_mass(self.mass, self.net_buoyancy)
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
"""Those whose figures are per metre, and that are cut to a length."""

RIGID_KINDS = frozenset(kind for kind, model in KINDS.items() if issubclass(model, Rigid))
"""Those of a fixed length, which may be clamped on a line too."""


_DRAG_KEYS = frozenset(key for form in DRAG_FORMS for key in form) | {"kt"}


def contradicted(kind: str, base: Set[str], override: Set[str]) -> frozenset[str]:
    """Return the keys of a definition that an override of it makes void.

    Parameters
    ----------
    kind : str
        Of the definition.
    base, override : set of str
        The keys that the definition and the override give.

    Notes
    -----
    ================ =========================== ==============================================
    kind             override gives              dropped from the definition
    ================ =========================== ==============================================
    body, profiler   a drag in another form      its own form, with the `kt` that went with it
    rigid            `buoyancy`                  `volume`
    rigid            `mass` or `volume`, both    `buoyancy`, which then follows from them
                     being known
    cable            `weight` or `buoyancy`      the other of the two
    cable            `density`, or `mass` where  `weight`, `buoyancy`, which then follow
                     a density is known
    cable            `stiffness`                 `elongation`, `permanent_elongation`
    cable            `elongation`                `stiffness`
    chain, anchor    `mass` or `density`         `weight`, which then follows
    ================ =========================== ==============================================
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
