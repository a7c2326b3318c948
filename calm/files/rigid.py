"""Rigid components: spheres, cylinders and bodies of any shape."""

from __future__ import annotations

from math import inf
from typing import Annotated, Literal

from pydantic import (
    BeforeValidator,
    Discriminator,
    Field,
    PlainValidator,
    Tag,
    ValidationInfo,
    model_validator,
)

from calm.files import definition
from calm.files.definition import CATALOGUE_DENSITY, Model, QuantityField, described, optional
from calm.physics.hull import tabulated_hull
from calm.units import QuantityError

_AREA = QuantityField("area", at_least=0)
_REACH = QuantityField("length", at_least=-20, at_most=20)
_GYRATION = QuantityField("length", above=0, at_most=20)

Inclination = Annotated[
    Literal["follows", "insensitive"] | None,
    described("whether the drag depends on the inclination of the piece", "follows"),
]
Surface = Annotated[
    Literal["painted", "smooth"] | None,
    described(
        "`smooth` allows drag curves by Reynolds number; `painted` keeps the constant coefficient",
        "smooth",
    ),
]
SphereCoefficient = Annotated[
    float | None, definition.COEFFICIENT, described("drag coefficient of a sphere", 0.5)
]


class Displacement(Model):
    """Table of a floating hull: draft [m], displaced volume [m³] and immersed area [m²]."""

    displacement: tuple[
        tuple[
            Annotated[float, definition.LENGTH],
            Annotated[float, QuantityField("volume", at_least=0)],
            Annotated[float, _AREA],
        ],
        ...,
    ] = described(
        "rows of draft, volume and side area; the last row is for the whole hull",
        [["0 m", "0 m^3", "0 m^2"], ["0.8 m", "2.4 m^3", "1.9 m^2"]],
    )

    @model_validator(mode="after")
    def _grows(self) -> Displacement:
        tabulated_hull(self.displacement)
        return self


def _hull_form(value: object) -> str:
    return "table" if isinstance(value, (dict, Displacement)) else "shape"


Hull = Annotated[
    Annotated[Literal["sphere", "cylinder"], Tag("shape")] | Annotated[Displacement, Tag("table")],
    Discriminator(_hull_form),
]


def _read_rao(rao: object) -> tuple[tuple[float, ...], ...]:
    rows = []
    for key, row in rao.items() if isinstance(rao, dict) else ():
        try:
            at = float(key)
        except (TypeError, ValueError):
            at = 0.0
        if not 0.0 < at < inf:
            raise ValueError(
                f"`{key}` is not an angular frequency in rad/s, such as `0.5: [1, 0 deg]`"
            )
        if not isinstance(row, list) or len(row) not in (2, 4):
            raise ValueError(
                "a row must have two numbers, or four with the pitch: `[1, 0 deg, 6 deg, 90 deg]`"
            )
        try:
            figures = (reader.read(figure) for reader, figure in zip(_RESPONSE, row, strict=False))
            rows.append((at, *figures))
        except QuantityError as error:
            raise ValueError(f"`{key}`: {error}") from None
    if len(rows) < 2 or len({len(row) for row in rows}) > 1:
        raise ValueError(
            "`rao` needs two frequencies or more, with the pitch at all of them or at none"
        )
    return tuple(sorted(rows))


_ANGLE = QuantityField("angle")
_RESPONSE = (
    *(QuantityField("number", at_least=0, at_most=10), _ANGLE),
    *(QuantityField("angle", at_least=0, at_most=90), _ANGLE),
)


class Rigid(definition.Definition):
    """A component of fixed length, in the line or clamped on it."""

    mass: definition.Mass = None
    buoyancy: Annotated[float | None, QuantityField("force")] = optional(
        "net force in sea water of 1025 kg/m^3, positive up (per metre of a cable)", "7000 N"
    )
    volume: Annotated[float | None, QuantityField("volume", at_least=0)] = optional(
        "volume of water displaced, e.g. 0.9 m^3", "0.9 m^3"
    )
    hull: Hull | None = optional(
        "hull of a surface float: a shape, or its displacement by draft", "sphere"
    )
    k_surface: definition.Drag = optional("drag of a float at the surface at 1 m/s", "40 N/(m/s)^2")
    wind_area: Annotated[float | None, _AREA] = optional(
        "area exposed to the wind, with mast and sensors", "1.4 m^2"
    )
    wind_cd: definition.Coefficient = optional("drag coefficient of `wind_area`", 1.0)

    heave: Literal["filtered", "follows", "panels"] | None = optional(
        "method for the heave of a surface float in waves: `filtered` uses its draft, waterplane "
        "and mass; `panels` uses panels on its hull; `follows` moves it with the water surface",
        "follows",
    )
    rao: Annotated[tuple[tuple[float, ...], ...] | None, PlainValidator(_read_rao)] = optional(
        "response of a float at each angular frequency in rad/s: heave per metre of wave elevation "
        "and phase of the heave; optionally, pitch per metre of wave elevation and its phase",
        {"0.5": [1.0, "0 deg"], "2": [0.6, "20 deg"]},
    )
    centre_of_mass: Annotated[float | None, _REACH] = optional(
        "centre of mass of a float with its load, above the keel; needed for its pitch", "0.8 m"
    )
    radius_of_gyration: Annotated[float | None, _GYRATION] = optional(
        "radius of gyration of a float with its load, about `centre_of_mass`", "0.9 m"
    )
    bail: Annotated[float | None, _REACH] = optional(
        "height of the line's attachment above the keel; negative below it", "-0.5 m"
    )

    @model_validator(mode="after")
    def _pitch_is_given_whole(self) -> Rigid:
        weighed = (self.centre_of_mass, self.radius_of_gyration)
        given = self.rao is not None and len(self.rao[0]) > 3
        if None in weighed and (weighed != (None, None) or (self.bail is not None and not given)):
            needs = "both its `centre_of_mass` and `radius_of_gyration`"
            raise ValueError(f"the pitch of a float needs {needs}")
        return self

    @property
    def net_buoyancy(self) -> float:
        """Net buoyancy in water, positive up [N].

        If only the mass is known, the weight in air is used as the weight in water.
        """
        if self.buoyancy is not None:
            return self.buoyancy
        assert self.mass is not None
        return (CATALOGUE_DENSITY * (self.volume or 0.0) - self.mass) * definition.STANDARD_GRAVITY

    @property
    def displaced_volume(self) -> float | None:
        """Displaced volume [m³], specified or computed from the weights; None if unknown."""
        if self.volume is not None or self.buoyancy is None:
            return self.volume
        return definition.volume_from_weights(self.mass, self.net_buoyancy)

    @model_validator(mode="after")
    def _weights_agree(self, info: ValidationInfo) -> Rigid:
        if self.mass is None or self.volume is None:
            if self.buoyancy is None and not definition.is_in_air(info):
                raise ValueError("needs `buoyancy`, or `mass` with `volume`")
            if self.buoyancy is None and self.mass is None:
                raise ValueError("needs `mass`, or `buoyancy`")
        elif self.buoyancy is not None:
            computed = (CATALOGUE_DENSITY * self.volume - self.mass) * definition.STANDARD_GRAVITY
            largest = max(abs(self.buoyancy), abs(computed))
            if abs(self.buoyancy - computed) > definition.DISAGREEMENT * largest:
                raise ValueError(
                    f"`buoyancy` is {self.buoyancy:g} N but `mass` and `volume` give "
                    f"{computed:.5g} N, more than 1 % apart; remove one of the three"
                )
        definition.refuse_weight_above_mass(self.mass, self.net_buoyancy)
        if isinstance(self.hull, Displacement):
            largest = self.hull.displacement[-1][1]
            if CATALOGUE_DENSITY * definition.STANDARD_GRAVITY * largest < self.net_buoyancy:
                raise ValueError(
                    f"the `hull` displaces {largest:g} m³ at most, less than required by its "
                    f"net buoyancy of {self.net_buoyancy:.5g} N"
                )
        return self


class SphereShape(Model):
    """A sphere that represents a part of a body when its drag is computed."""

    kind: Literal["sphere"] = Field(description="kind of the component")
    diameter: definition.Diameter
    cx: SphereCoefficient = None


class CylinderShape(Model):
    """A cylinder that represents a part of a body when its drag is computed."""

    kind: Literal["cylinder"] = Field(description="kind of the component")
    diameter: definition.Diameter
    length: definition.Length
    cn: definition.NormalCoefficient = None
    ct: definition.TangentialCoefficient = None
    inclination: Inclination = None


class Sphere(Rigid, SphereShape):
    """A sphere, whose length along the line is its diameter by default."""

    length: definition.Length = Field(default_factory=lambda data: data.get("diameter", 0.0))
    surface: Surface = None


class Cylinder(Rigid, CylinderShape):
    """A cylinder with its axis along the line."""

    surface: Surface = None


def _two_stops(value: object) -> object:
    if value is not None and (not isinstance(value, list | tuple) or len(value) != 2):
        raise ValueError("`between` must name two stops: `between: [upper stop, lower stop]`")
    return value


class DragMeasurement(Model):
    """A measured drag [N] and the speed at which it was measured [m/s]."""

    speed: Annotated[float, QuantityField("speed", above=0)] = described(
        "relative speed of the water", "0.5 m/s"
    )
    force: Annotated[float, QuantityField("force", at_least=0)] = described("drag measured", "48 N")


Shape = Annotated[SphereShape | CylinderShape, Field(discriminator="kind")]

DRAG_FORMS: tuple[tuple[str, ...], ...] = (
    ("kn",),
    ("drag_area", "cd"),
    ("drag_measurements",),
    ("made_of",),
)
"""Alternative sets of keys for the drag of a body; exactly one set must be given."""


class Shaped(Rigid):
    """A component of any shape, whose drag is given in one of the `DRAG_FORMS`."""

    length: definition.Length
    kn: definition.Drag = optional(
        "drag across the axis at 1 m/s, e.g. 26 N/(m/s)^2", "26 N/(m/s)^2"
    )
    kt: definition.TangentialDrag = None
    drag_area: Annotated[float | None, _AREA] = optional(
        "area seen by the current, e.g. 0.12 m^2", "0.12 m^2"
    )
    cd: definition.Coefficient = optional("drag coefficient of `drag_area`", 1.2)
    drag_measurements: tuple[DragMeasurement, ...] | None = optional(
        "forces measured at several speeds",
        [{"speed": "0.5 m/s", "force": "12 N"}, {"speed": "1 m/s", "force": "48 N"}],
    )
    made_of: tuple[Shape, ...] | None = optional(
        "simple shapes whose drags add up",
        [{"kind": "cylinder", "diameter": "80 mm", "length": "1 m"}],
    )
    inclination: Inclination = None
    lift: Annotated[float | None, QuantityField("drag")] = optional(
        "lift of a towed body at 1 m/s, positive up", "-30 N/(m/s)^2"
    )

    @model_validator(mode="after")
    def _drag_is_given_once(self) -> Shaped:
        forms = [[key for key in form if getattr(self, key) is not None] for form in DRAG_FORMS]
        given = [keys for keys in forms if keys]
        if len(given) != 1:
            what = " and ".join(f"`{key}`" for keys in given for key in keys) or "no drag"
            raise ValueError(
                f"gives {what}; drag must be given by one of: `kn` with `kt`, `drag_area` "
                "with `cd`, `drag_measurements`, or `made_of`"
            )
        if self.made_of == () or self.drag_measurements == ():
            raise ValueError(f"`{given[0][0]}` is empty")
        if (self.drag_area is None) != (self.cd is None):
            raise ValueError("`drag_area` and `cd` must be given together")
        if self.kn is not None and self.kt is None and self.inclination != "insensitive":
            raise ValueError("`kn` needs `kt`, or `inclination: insensitive`")
        if self.inclination == "follows" and self.kt is None and not self.made_of:
            raise ValueError("`inclination: follows` needs `kt`")
        if self.kt is not None and (self.made_of or self.inclination == "insensitive"):
            other = "`made_of`" if self.made_of else "`inclination: insensitive`"
            raise ValueError(f"`kt` cannot be used with {other}")
        return self


class Body(Shaped):
    """A body of any shape, in the line or clamped on it."""

    kind: Literal["body"] = Field(description="kind of the component")


LEAST_WIRE_TENSION = 2224.0
"""Wire tension required by a McLane Moored Profiler: 500 lbf according to its manual [N]."""


class Profiler(Shaped):
    """A profiler that travels along a wire between two stops."""

    kind: Literal["profiler"] = Field(description="kind of the component")
    between: Annotated[tuple[definition.Text, ...] | None, BeforeValidator(_two_stops)] = optional(
        "labels of the upper and the lower stop, which are clamps on the wire, or pieces at "
        "the ends of the wire",
        ["upper bumper", "lower bumper"],
    )
    minimum_tension: Annotated[float, definition.POSITIVE_FORCE] = described(
        "minimum tension of the profiler's wire", "2224 N", default=LEAST_WIRE_TENSION
    )
    drive_force: definition.PositiveForce = optional(
        "maximum force of the profiler's drive", "50 N"
    )
    speed: Annotated[float | None, QuantityField("speed", above=0)] = optional(
        "speed of the profiler along its wire", "0.25 m/s"
    )
    endurance: definition.PositiveLength = optional("range of the profiler's batteries", "1000 km")
