"""Key `uncertainty:` of a mooring file: uncertainties of input values, with defaults."""

from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from calm.files.definition import Model, QuantityField, described
from calm.units import QuantityError

MOST_DEVIATION = 0.25
"""Largest relative standard deviation: a wider normal distribution would often give negative
values.
"""
_SHARE = QuantityField("number", at_least=0.0)
_TOO_WIDE = (
    "more than the maximum standard deviation of 25 %; set a pair of 5 and 95 % points instead"
)


@dataclass(frozen=True)
class Spread:
    """Uncertainty as a fraction of a value; for an angle, uncertainty in degrees.

    Attributes
    ----------
    deviation : standard deviation of a normal distribution, or None
    between : 5th and 95th percentile, or None
    """

    deviation: float | None = None
    between: tuple[float, float] | None = None


@dataclass(frozen=True)
class SpreadOf:
    """Annotation that gives a key of `uncertainty:` its allowed values.

    Attributes
    ----------
    one : allowed values of a single number, which is the standard deviation
    end : allowed values of each number in a pair, which contains the 5th and 95th percentiles
    """

    one: QuantityField
    end: QuantityField

    def read(self, value: object) -> Spread:
        """Parse a standard deviation, or a list of the 5th and the 95th percentiles."""
        if not isinstance(value, list | tuple):
            return Spread(self._deviation(value))
        if len(value) != 2:
            raise QuantityError("is neither a standard deviation nor a pair of 5 and 95 % points")
        low, high = map(self._end, value)
        if not low < high:
            raise QuantityError("is a pair whose 5 % point is not below its 95 % point")
        return Spread(between=(low, high))

    def _deviation(self, value: object) -> float:
        deviation = self._read(self.one, value)
        if self.one is _SHARE and deviation > MOST_DEVIATION:
            if isinstance(value, str) and "%" in value:
                raise QuantityError(f"is {_TOO_WIDE}")
            suggestion = f"{value} %" if deviation <= 100.0 * MOST_DEVIATION else None
            raise QuantityError(f"is a share of {100.0 * deviation:g} %, {_TOO_WIDE}", suggestion)
        return deviation

    def _end(self, value: object) -> float:
        try:
            return self._read(self.end, value)
        except QuantityError as error:
            raise QuantityError(f"contains `{value}`, which {error}") from None

    def _read(self, field: QuantityField, value: object) -> float:
        try:
            return field.read(value)
        except QuantityError as error:
            if self.one is not _SHARE or not error.is_other:
                raise
            needed = "a share of the value is needed, such as 0.4 % (5 m of 1250 m)"
            raise QuantityError(str(error).replace("a plain number is needed", needed)) from None

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        pair = {"type": "array", "items": self.end.json_schema(), "minItems": 2, "maxItems": 2}
        return {"anyOf": [self.one.json_schema(), pair]}


ShareSpread = Annotated[Spread, SpreadOf(_SHARE, QuantityField("number", above=-1.0, at_most=10.0))]
AngleSpread = Annotated[
    Spread,
    SpreadOf(
        QuantityField("angle", at_least=0.0, at_most=180.0),
        QuantityField("angle", at_least=-180.0, at_most=180.0),
    ),
]


class Uncertainty(Model):
    """Uncertainties of the inputs of a design, from which random moorings are drawn."""

    current: ShareSpread = described(
        "speed of the current, by the same factor at all depths", "10 %", default=Spread(0.1)
    )
    direction: AngleSpread = described(
        "direction of the current, by the same angle at all depths", "5 deg", default=Spread(5.0)
    )
    cable_drag: ShareSpread = described(
        "drag of cables and chains, without strumming",
        ["-15 %", "30 %"],
        default=Spread(between=(-0.15, 0.30)),
    )
    rigid_drag: ShareSpread = described(
        "drag of rigid pieces and clamps", "15 %", default=Spread(0.15)
    )
    buoyancy: ShareSpread = described(
        "net buoyancy of rigid pieces and clamps that float", "2 %", default=Spread(0.02)
    )
    cable_weight: ShareSpread = described(
        "net force of cables and chains in water", "3 %", default=Spread(0.03)
    )
    length: ShareSpread = described(
        "cut length of cables and chains", "0.3 %", default=Spread(0.003)
    )
    stiffness: ShareSpread = described(
        "stiffness of cables and chains", "20 %", default=Spread(0.2)
    )
    depth: ShareSpread = described("depth of the water", "1 %", default=Spread(0.01))
