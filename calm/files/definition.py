"""Keys that every component may have, and the conventions for their values.

In the models, quantities are in SI units and degrees. Net forces refer to sea water of
`CATALOGUE_DENSITY` and to standard gravity.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    GetJsonSchemaHandler,
    ValidationInfo,
    WithJsonSchema,
    field_validator,
    model_validator,
)
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, core_schema

from calm.errors import UsageError, about_quantity
from calm.physics.materials import MATERIAL_NAMES
from calm.positions import HEMISPHERES
from calm.quantities import say
from calm.units import (
    DIMENSIONS,
    KILOGRAM_FORCE,
    QuantityError,
    QuantityRange,
    parse_quantity,
)


class Model(BaseModel):
    """Base class of the data models of input files, which are immutable and reject unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    def __repr_args__(self) -> Iterator[tuple[str | None, Any]]:
        return (each for each in super().__repr_args__() if each[1] is not None)


@dataclass(frozen=True)
class QuantityField(QuantityRange):
    """Annotation of a model field whose value is a quantity within limits."""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return self.json_schema()

    def json_schema(self) -> dict[str, Any]:
        """Return the JSON Schema of the quantity as written in a file, without its limits."""
        kind = DIMENSIONS[self.dimension]
        number = r"^\s*[-+]?[0-9.]+([eE][-+]?[0-9]+)?(\s*[0-9]*/[0-9]+)?"
        if not kind.unit:
            units = "|".join(kind.units)
            return {"type": ["number", "string"], "pattern": rf"{number}\s*({units})$"}
        units = ", ".join(kind.units)
        if self.dimension in HEMISPHERES:
            text = {"type": "string", "pattern": r"[0-9].*[A-Za-z°'′ -]"}
            return {
                "description": f"{kind.noun} such as 48.3 deg or 48 18.0 N",
                "anyOf": [text, {"const": 0}],
            }
        return {
            "description": f"{kind.noun} with its unit ({units})",
            "anyOf": [{"type": "string", "pattern": number + r"\s*[A-Za-z°µ].*$"}, {"const": 0}],
        }


class ColumnHeading(str):
    """Annotation that contains the displayed column heading of a value in a table row."""

    __slots__ = ()


def described(description: str, example: object, **default: Any) -> Any:
    """Declare a key of a model, which is required unless `default` or `default_factory` is set."""
    return Field(description=description, examples=[example], **default)


def optional(description: str, example: object) -> Any:
    """Declare an optional key whose default is None."""
    return described(description, example, default=None)


def _as_text(value: object) -> object:
    return str(value) if isinstance(value, (int, float)) else value


Text = Annotated[str, BeforeValidator(_as_text), WithJsonSchema({"type": ["string", "number"]})]
"""Type of a text; a bare number is kept as written, digit by digit."""

POSITIVE_LENGTH = QuantityField("length", above=0)
DIAMETER = QuantityField("length", usual_unit="mm", above=0)
LENGTH = QuantityField("length", at_least=0)
POSITIVE_FORCE = QuantityField("force", usual_unit="kN", above=0)
COEFFICIENT = QuantityField("number", at_least=0)
DRAG = QuantityField("drag", at_least=0)
TILT = QuantityField("angle", above=0, at_most=180)

PositiveLength = Annotated[float | None, POSITIVE_LENGTH]
PositiveForce = Annotated[float | None, POSITIVE_FORCE]
Coefficient = Annotated[float | None, COEFFICIENT]
Drag = Annotated[float | None, DRAG]

Role = Annotated[
    Literal["float", "instrument", "release", "connector", "line", "anchor"],
    described("purpose of the piece", "instrument"),
]


def quantity_of(field: FieldInfo) -> QuantityField | None:
    """Return the `QuantityField` that annotates a model field, or None if there is none."""
    return next((one for one in field.metadata if isinstance(one, QuantityField)), None)


def in_si(name: str, value: float | str, dimension: str) -> float:
    """Convert a text with a unit to SI units (degrees, °C); a number is returned unchanged.

    Raises
    ------
    UsageError
        The text is not a quantity of this dimension; the message contains `name`.
    """
    if not isinstance(value, str):
        return value
    try:
        return parse_quantity(value, dimension)
    except QuantityError as error:
        raise UsageError(about_quantity(name, value, error)) from error


CATALOGUE_DENSITY = 1025.0
"""Density of the sea water to which net forces and drags in the catalogue refer [kg/m³]."""

STANDARD_GRAVITY = KILOGRAM_FORCE
"""Standard gravity [m/s²], for the weight of a given mass."""

DISAGREEMENT = 0.01
"""Relative difference up to which redundant values of a component count as consistent."""

IN_AIR: Mapping[str, object] = {"fluid": "air"}
"""Validation context for a component that is used in air; the component only needs a mass."""

MASS = QuantityField("mass", at_least=0)
DENSITY = QuantityField("density", above=0)


Length = Annotated[
    float,
    LENGTH,
    described("unstretched length along the line; `fit` cuts a cable to reach a depth", "480 m"),
]
Diameter = Annotated[
    float,
    DIAMETER,
    described("diameter; for a chain, the diameter of its bar, e.g. 12 mm", "12 mm"),
]
Mass = Annotated[
    float | None, MASS, described("mass in air (per metre of a cable or chain)", "35 kg")
]
_ANY_QUANTITY = {"type": "string", "description": "with its unit"}
MaterialDensity = Annotated[
    float | None,
    DENSITY,
    described("density of the water, or of a component's material", "1025 kg/m^3"),
]
NormalCoefficient = Annotated[
    float | None, COEFFICIENT, described("drag coefficient across the axis", 1.2)
]
TangentialCoefficient = Annotated[
    float | None, COEFFICIENT, described("drag coefficient along the axis", 0.01)
]
TangentialDrag = Annotated[
    float | None, DRAG, described("drag along the axis at 1 m/s", "9 N/(m/s)^2")
]


def _listed(value: object) -> object:
    return [value] if isinstance(value, dict) else value


def _estimated(quantity: str) -> QuantityField:
    return {"max_tilt": TILT, "depth_rating": POSITIVE_LENGTH}.get(quantity, POSITIVE_FORCE)


def _alone_or_listed(schema: dict[str, Any]) -> None:
    schema["anyOf"] += [form["items"] for form in schema["anyOf"] if "items" in form]


class EstimatedFigure(Model):
    """Estimate of a component value that no source publishes, with its lower bound `low`.

    `low_in_waves` is a smaller lower bound for lines in waves. This bound is given if the estimate
    is made from values that apply only to steady loads.
    """

    quantity: Literal[
        "working_load", "breaking_load", "opening_load", "grip", "max_tilt", "depth_rating"
    ] = described("the estimated figure", "working_load")
    value: Annotated[float | None, WithJsonSchema(_ANY_QUANTITY)] = optional(
        "best estimate, if there is one", "20 kN"
    )
    low: Annotated[float, WithJsonSchema(_ANY_QUANTITY)] = described(
        "lower bound, used in the check", "12 kN"
    )
    low_in_waves: Annotated[float | None, WithJsonSchema(_ANY_QUANTITY)] = optional(
        "lower bound in waves, if it is less than `low`", "8 kN"
    )
    quality: Literal["high", "medium", "low"] | None = optional(
        "how well the source applies to this item. high: the manufacturer published the values; "
        "medium: an owner's list, or proven use at the depth; low: a similar item, or a computed "
        "value",
        "low",
    )
    source: Text = described("source of the figures", "the chain above it")

    @field_validator("value", "low", "low_in_waves", mode="plain")
    @classmethod
    def _quantity(cls, text: object, info: ValidationInfo) -> float:
        return _estimated(info.data.get("quantity", "")).read(text)

    def bound(self, *, in_waves: bool) -> float:
        """Return the lower bound: `low_in_waves` for a line in waves, if given; otherwise `low`."""
        return self.low_in_waves if in_waves and self.low_in_waves is not None else self.low

    @property
    def bounds_text(self) -> str:
        """Text of the bounds and the best estimate: ``at least 7.36 kN, probably 33.18 kN``."""
        name = self.quantity if self.quantity in ("max_tilt", "depth_rating") else "load"
        text, best = f"at least {say(name, self.low)}", self.value
        if self.low_in_waves is not None:
            text += f" ({say(name, self.low_in_waves)} in waves)"
        return text if best in (None, self.low) else f"{text}, probably {say(name, best)}"

    @property
    def in_words(self) -> str:
        """Text of the bounds, the best estimate, the source and its quality."""
        quality = f", quality {self.quality}" if self.quality is not None else ""
        return f"{self.bounds_text} ({self.source}{quality})"

    def __str__(self) -> str:
        return f"`{self.quantity}` is estimated: {self.in_words}"

    @model_validator(mode="after")
    def _low_is_least(self) -> EstimatedFigure:
        if self.value is not None and self.low > self.value:
            raise ValueError(f"`low` is {self.low:g}, above the `value` of {self.value:g}")
        if self.low_in_waves is not None and self.low_in_waves > self.low:
            raise ValueError(
                f"`low_in_waves` is {self.low_in_waves:g}, above the `low` of {self.low:g}"
            )
        return self


class FatigueKeys(Model):
    """Keys of `fatigue:` in a component: its published fatigue curve, and its corrosion."""

    curve: Literal[
        "dnv-studless-chain", "dnv-stud-chain", "dnv-polyester", "api-studless-chain",
        "api-stud-chain", "api-connecting-link", "api-stranded-wire", "api-spiral-strand",
        "sots-shackle", "sots-peened-shackle", "sots-link", "sots-wire",
    ] | None = described(
        "fatigue curve of DNV-OS-E301, API RP 2SK or SOTS; by default the curve for the kind and "
        "material of the part",
        "dnv-stud-chain",
        default=None,
    )  # fmt: skip
    corrosion: Annotated[float, QuantityField("length", at_least=0)] = described(
        "loss of diameter by the end of the deployment; fatigue is computed with the reduced "
        "diameter from the first day",
        "1 mm",
        default=0.0,
    )


class Definition(Model):
    """Keys common to all kinds of components.

    Attributes
    ----------
    source : source of the values that `sources` does not list
    searched : keys for which a search found no published value
    prefer : id of a better definition of the same product
    """

    role: Role = "instrument"
    name: Text | None = optional("name in common use", "Shelf edge 2026")
    manufacturer: Text | None = optional("manufacturer", "the manufacturer")
    part_number: Text | None = optional("part number of the manufacturer", "1250-A")
    material: Text | None = optional(
        f"material: a text that contains one of {MATERIAL_NAMES}", "galvanised steel"
    )
    note: Text | None = optional("any remark", "galvanised; inspect after each cruise")
    source: Text | None = optional("source of the figures", "data sheet of the manufacturer, 2026")
    sources: dict[str, Text] | None = optional(
        "sources of individual values, by key; all other values are from `source`",
        {"breaking_load": "test of 2025"},
    )
    searched: tuple[str, ...] | None = optional(
        "keys for which no source was found", ["breaking_load"]
    )
    prefer: Text | None = optional("id of a better-documented entry for the same product", "sbe37")
    date: Text | None = optional("day, e.g. 2026-11-20", "2026-11-20")
    items: Annotated[int | None, Field(ge=1)] = optional(
        "number of identical items in the component, each with its own serial number, such as two "
        "releases in parallel",
        2,
    )
    depth_rating: PositiveLength = optional("maximum depth of use", "2000 m")
    working_load: PositiveForce = optional("maximum load in use, e.g. 20 kN", "20 kN")
    breaking_load: PositiveForce = optional("load at which the part breaks, e.g. 40 kN", "40 kN")
    opening_load: PositiveForce = optional(
        "maximum load under which a release opens, e.g. 10 kN", "10 kN"
    )
    grip: PositiveForce = optional(
        "force at which the clamp of the part slips along the line, e.g. 1 kN", "1 kN"
    )
    insulated: bool | None = optional(
        "true if the metal of the part is insulated from adjacent metals, e.g. by plastic clamp "
        "jaws or rubber bushes in the eyes; by default true for clamps and false for pieces",
        True,
    )
    max_tilt: Annotated[float | None, TILT] = optional(
        "tilt above which the data of the part are not reliable", "20 deg"
    )
    warn_tilt: Annotated[float | None, TILT] = optional("tilt that causes a warning", "15 deg")
    estimate: Annotated[tuple[EstimatedFigure, ...] | None, BeforeValidator(_listed)] = Field(
        default=None,
        description="estimates of unpublished values, for the design check",
        json_schema_extra=_alone_or_listed,
        examples=[
            {
                "quantity": "working_load",
                "value": "20 kN",
                "low": "12 kN",
                "source": "the chain above it",
            }
        ],
    )
    fatigue: FatigueKeys | None = optional(
        "fatigue curve in waves; by default the curve for the kind and material of the part",
        {"curve": "dnv-stud-chain"},
    )
    slack: Literal["allowed"] | None = optional(
        "`allowed` exempts the piece from `minimum_tension`", "allowed"
    )

    @property
    def estimates(self) -> dict[str, EstimatedFigure]:
        """Estimates of the values that the definition does not give, by key."""
        if self.estimate is None:
            return {}
        every = {one.quantity: one for one in self.estimate}
        return {name: one for name, one in every.items() if getattr(self, name) is None}

    @model_validator(mode="after")
    def _works_below_breaking(self) -> Definition:
        working, breaking = self.working_load, self.breaking_load
        if working is not None and breaking is not None and working > breaking:
            raise ValueError(
                f"`working_load` is {working:g} N, above the `breaking_load` of {breaking:g} N"
            )
        return self


def is_in_air(info: ValidationInfo) -> bool:
    """True if the definition being validated is for use in air."""
    return info.context == IN_AIR


def volume_from_weights(mass: float | None, net_buoyancy: float) -> float | None:
    """Compute the displaced volume [m³] from mass [kg] and net buoyancy [N], or None.

    The volume is per metre if the arguments are.
    """
    if mass is None:
        return None
    return (mass + net_buoyancy / STANDARD_GRAVITY) / CATALOGUE_DENSITY


def refuse_weight_above_mass(mass: float | None, net_buoyancy: float) -> None:
    """Raise ValueError if a component weighs more in water than its mass weighs in air."""
    if mass is not None and -net_buoyancy > mass * STANDARD_GRAVITY * (1 + DISAGREEMENT):
        raise ValueError(
            f"weighs more in water ({-net_buoyancy:.5g} N) than its mass of {mass:g} kg does in air"
        )
