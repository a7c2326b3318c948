"""The types of the fields of CALM's files: text with a unit in, SI float out (angles: degrees)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    GetJsonSchemaHandler,
    WithJsonSchema,
)
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, core_schema

from calm.positions import HEMISPHERES
from calm.units import DIMENSIONS, QuantityRange


class Model(BaseModel):
    """Base of everything read from a file: frozen, and no key but the known ones."""

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)


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

Role = Annotated[
    Literal["float", "instrument", "release", "connector", "line", "anchor"],
    Field(description="what the piece is for", examples=["instrument"]),
]


def quantity_of(field: FieldInfo) -> QuantityField | None:
    """Return the quantity that a field of a model holds, None where it holds none."""
    return next((one for one in field.metadata if isinstance(one, QuantityField)), None)
