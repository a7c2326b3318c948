"""Keys that every component may have, and the conventions that its figures follow.

A field is text with a unit in the file, and here an SI float, angles in degrees, None where the
definition does not say. Net forces are those in sea water of `CATALOGUE_DENSITY` under standard
gravity.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
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
from calm.units import (
    DIMENSIONS,
    KILOGRAM_FORCE,
    QuantityError,
    QuantityRange,
    parse_quantity,
    with_unit,
)


class Model(BaseModel):
    """Base of everything read from a file: frozen, and no key but the known ones."""

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    def __repr_args__(self) -> Iterator[tuple[str | None, Any]]:
        """Return the fields that are known."""
        return (each for each in super().__repr_args__() if each[1] is not None)


@dataclass(frozen=True)
class QuantityField(QuantityRange):
    """Annotate a field that holds a quantity within limits."""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return self.json_schema()

    def json_schema(self) -> dict[str, Any]:
        """Return the JSON Schema of the text, without the limits."""
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
    """Annotate a value of a row with the heading of its column, where tables are shown."""

    __slots__ = ()


def described(description: str, example: object, **default: Any) -> Any:
    """Return the field of a key, required without a `default` or a `default_factory`."""
    return Field(description=description, examples=[example], **default)


def optional(description: str, example: object) -> Any:
    """Return the field of a key that may be left out: None."""
    return described(description, example, default=None)


def _as_text(value: object) -> object:
    return str(value) if isinstance(value, (int, float)) else value


Text = Annotated[str, BeforeValidator(_as_text), WithJsonSchema({"type": ["string", "number"]})]
"""Text; a bare number is taken as the person wrote it."""

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
    described("what the piece is for", "instrument"),
]


def quantity_of(field: FieldInfo) -> QuantityField | None:
    """Return the quantity that a field of a model holds, None where it holds none."""
    return next((one for one in field.metadata if isinstance(one, QuantityField)), None)


def in_si(name: str, value: float | str, dimension: str) -> float:
    """Return an argument in SI (degrees, degC): a number as it is, a text with its unit converted.

    UsageError, with the name of the argument: the text is no quantity of this dimension.
    """
    if not isinstance(value, str):
        return value
    try:
        return parse_quantity(value, dimension)
    except QuantityError as error:
        raise UsageError(about_quantity(name, value, error)) from error


CATALOGUE_DENSITY = 1025.0
"""Density of the sea water in which net forces and drags are given [kg/m³]."""

STANDARD_GRAVITY = KILOGRAM_FORCE
"""The force of gravity on a kilogram [N]."""

DISAGREEMENT = 0.01
"""Share by which figures that say the same thing may differ."""

IN_AIR: Mapping[str, object] = {"fluid": "air"}
"""Context of a definition that is read for use in air, where its mass is all that is needed."""

MASS = QuantityField("mass", at_least=0)
DENSITY = QuantityField("density", above=0)


Length = Annotated[
    float,
    LENGTH,
    described("along the line, unstretched; `fit` cuts a cable to reach a depth", "480 m"),
]
Diameter = Annotated[float, DIAMETER, described("e.g. 12 mm; of a chain, that of its bar", "12 mm")]
Mass = Annotated[float | None, MASS, described("in air (per metre of a cable or chain)", "35 kg")]
_ANY_QUANTITY = {"type": "string", "description": "with its unit"}
MaterialDensity = Annotated[
    float | None,
    DENSITY,
    described("of the water, or of the material of a component", "1025 kg/m^3"),
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
    """Estimate of a figure that no source prints, from its class: at least `low`.

    A figure that its source prints for steady loads alone has a lesser bound for a line that waves
    move, `low_in_waves`.
    """

    quantity: Literal[
        "working_load", "breaking_load", "opening_load", "grip", "max_tilt", "depth_rating"
    ] = described("the figure that is estimated", "working_load")
    value: Annotated[float | None, WithJsonSchema(_ANY_QUANTITY)] = optional(
        "best estimate, where there is one", "20 kN"
    )
    low: Annotated[float, WithJsonSchema(_ANY_QUANTITY)] = described(
        "lower bound, by which it is judged", "12 kN"
    )
    low_in_waves: Annotated[float | None, WithJsonSchema(_ANY_QUANTITY)] = optional(
        "lower bound for a line that waves move, where it is less than `low`", "8 kN"
    )
    quality: Literal["high", "medium", "low"] | None = optional(
        "how far its source holds for the item: high, its maker prints the alternatives; medium, "
        "an owner's list or use at that depth; low, a similar item, or derived",
        "low",
    )
    source: Text = described("where the figures come from", "the chain it hangs on")

    @field_validator("value", "low", "low_in_waves", mode="plain")
    @classmethod
    def _quantity(cls, text: object, info: ValidationInfo) -> float:
        return _estimated(info.data.get("quantity", "")).read(text)

    def bound(self, *, in_waves: bool) -> float:
        """Return the lower bound of a line that waves move, or of one that they do not."""
        return self.low_in_waves if in_waves and self.low_in_waves is not None else self.low

    def in_words(self, said: Callable[[float], str]) -> str:
        """Return the bounds, the best estimate, the source and its quality, each figure `said`."""
        waves = self.low_in_waves
        figures = (
            f"{said(self.low)} at least",
            f"{said(waves)} in waves" if waves is not None else "",
            f"{said(self.value)} likely" if self.value is not None else "",
        )
        quality = f", quality {self.quality}" if self.quality is not None else ""
        return f"{', '.join(filter(None, figures))} ({self.source}{quality})"

    def __str__(self) -> str:
        unit = DIMENSIONS[_estimated(self.quantity).dimension].unit
        return f"`{self.quantity}` is estimated: {self.in_words(lambda one: with_unit(one, unit))}"

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
    """`fatigue:` of a component: by which published curve its fatigue in waves is found."""

    curve: Literal[
        "dnv-studless-chain", "dnv-stud-chain", "dnv-polyester", "api-studless-chain",
        "api-stud-chain", "api-connecting-link", "api-stranded-wire", "api-spiral-strand",
        "sots-shackle", "sots-peened-shackle", "sots-link", "sots-wire",
    ] | None = described(
        "of DNV-OS-E301, API RP 2SK or SOTS, where it is not that of its kind",
        "dnv-stud-chain",
        default=None,
    )  # fmt: skip
    corrosion: Annotated[float, QuantityField("length", at_least=0)] = described(
        "off its diameter by the end of the deployment; all of it counts from the first day",
        "1 mm",
        default=0.0,
    )


class Definition(Model):
    """Hold what every component may say, whatever its kind.

    `source` is that of every figure but those for which `sources` names another, field by field.
    `searched` are the fields that were looked for and that no source prints; `prefer` is the id of
    the definition of the same thing that is to be used in place of this one.
    """

    role: Role = "instrument"
    name: Text | None = optional("what people call it", "Shelf edge 2026")
    manufacturer: Text | None = optional("who makes it", "the maker")
    part_number: Text | None = optional("the maker's", "1250-A")
    material: Text | None = optional(
        f"what it is made of, in words that name one of {MATERIAL_NAMES}", "galvanised steel"
    )
    note: Text | None = optional(
        "anything worth knowing", "galvanised; look at it after each cruise"
    )
    source: Text | None = optional("where the figures come from", "data sheet of the maker, 2026")
    sources: dict[str, Text] | None = optional(
        "by field, where a figure comes from that is not of `source`",
        {"breaking_load": "test of 2025"},
    )
    searched: tuple[str, ...] | None = optional(
        "fields that no source prints, though they were looked for", ["breaking_load"]
    )
    prefer: Text | None = optional(
        "id of the definition of the same thing to use in place of this one", "sbe37"
    )
    date: Text | None = optional("day, e.g. 2026-11-20", "2026-11-20")
    depth_rating: PositiveLength = optional("deepest it may be used", "2000 m")
    working_load: PositiveForce = optional("load it may carry in use, e.g. 20 kN", "20 kN")
    breaking_load: PositiveForce = optional("load at which it breaks, e.g. 40 kN", "40 kN")
    opening_load: PositiveForce = optional(
        "of a release, the greatest under which it opens, e.g. 10 kN", "10 kN"
    )
    grip: PositiveForce = optional(
        "pull at which its clamp slips along the line, e.g. 1 kN", "1 kN"
    )
    insulated: bool | None = optional(
        "whether plastic or rubber keeps its metal from what it touches: jaws of its clamp, bushes "
        "in its eyes; taken as true of what is clamped, and else as false",
        True,
    )
    max_tilt: Annotated[float | None, TILT] = optional(
        "tilt beyond which it is not to be trusted", "20 deg"
    )
    warn_tilt: Annotated[float | None, TILT] = optional("tilt to be warned of", "15 deg")
    estimate: Annotated[tuple[EstimatedFigure, ...] | None, BeforeValidator(_listed)] = Field(
        default=None,
        description="estimates of figures that are not given, for the rules that need them",
        json_schema_extra=_alone_or_listed,
        examples=[
            {
                "quantity": "working_load",
                "value": "20 kN",
                "low": "12 kN",
                "source": "the chain it hangs on",
            }
        ],
    )
    fatigue: FatigueKeys | None = optional(
        "curve of its fatigue in waves, where it is not that of its kind",
        {"curve": "dnv-stud-chain"},
    )
    slack: Literal["allowed"] | None = optional(
        "`allowed` exempts the piece from `minimum_tension`", "allowed"
    )

    @property
    def estimates(self) -> dict[str, EstimatedFigure]:
        """Return the estimates of figures that are not given, by figure."""
        every = {one.quantity: one for one in self.estimate or ()}
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
    """Return whether the definition that is being validated is read for use in air."""
    return info.context == IN_AIR


def volume_from_weights(mass: float | None, net_buoyancy: float) -> float | None:
    """Return the volume of water displaced [m³, or per metre], None where the mass is unknown."""
    if mass is None:
        return None
    return (mass + net_buoyancy / STANDARD_GRAVITY) / CATALOGUE_DENSITY


def refuse_weight_above_mass(mass: float | None, net_buoyancy: float) -> None:
    """Refuse what weighs more in water than in air."""
    if mass is not None and -net_buoyancy > mass * STANDARD_GRAVITY * (1 + DISAGREEMENT):
        raise ValueError(
            f"weighs more in water ({-net_buoyancy:.5g} N) than its mass of {mass:g} kg does in air"
        )
