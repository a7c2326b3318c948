"""`uncertainty:` of a mooring file: how sure its figures are, each with its default."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import Field, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from calm.files.definition import Model, QuantityField
from calm.units import QuantityError

MOST_DEVIATION = 0.25
"""Of a share: a normal distribution wider than this would often pass below nothing."""
_SHARE = QuantityField("number", at_least=0.0)
_TOO_WIDE = "is too wide for a deviation, 25 % at most; give a pair, its 5 and 95 %"


@dataclass(frozen=True)
class Spread:
    """Say how far a figure may be off: of a share that of 1, of an angle in degrees.

    Attributes
    ----------
    deviation : standard deviation of a normal distribution; None where `between` is given
    between : its 5 and 95 %
    """

    deviation: float | None = None
    between: tuple[float, float] | None = None


@dataclass(frozen=True)
class SpreadOf:
    """Annotate a key of `uncertainty:` with what may stand there.

    Attributes
    ----------
    one : what a standard deviation may be
    end : what the 5 and the 95 % may be
    """

    one: QuantityField
    end: QuantityField

    def read(self, value: object) -> Spread:
        """Read one text with a unit, or two in a list."""
        if not isinstance(value, list | tuple):
            return Spread(self._deviation(value))
        if len(value) != 2:
            raise QuantityError("is neither one deviation nor a pair, its 5 and 95 %")
        low, high = map(self._end, value)
        if not low < high:
            raise QuantityError("is a pair, but its 5 % is not below its 95 %")
        return Spread(between=(low, high))

    def _deviation(self, value: object) -> float:
        deviation = self.one.read(value)
        if self.one is _SHARE and deviation > MOST_DEVIATION:
            bare = isinstance(value, int | float) or "%" not in str(value)
            meant = f"{value} %" if bare and deviation <= 100.0 * MOST_DEVIATION else None
            raise QuantityError(_TOO_WIDE, meant)
        return deviation

    def _end(self, value: object) -> float:
        try:
            return self.end.read(value)
        except QuantityError as error:
            raise QuantityError(f"has an end, `{value}`, which {error}") from None

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        pair = {"type": "array", "items": self.end.json_schema(), "minItems": 2, "maxItems": 2}
        return {"anyOf": [self.one.json_schema(), pair]}


_SHARES = (_SHARE, QuantityField("number", above=-1.0, at_most=10.0))
_ANGLES = (
    QuantityField("angle", at_least=0.0, at_most=180.0),
    QuantityField("angle", at_least=-180.0, at_most=180.0),
)


class Uncertainty(Model):
    """How sure what a design stands on is: one draw of each a mooring."""

    current: Annotated[Spread, SpreadOf(*_SHARES)] = Field(
        default=Spread(0.1), description="of the speed, at all depths alike", examples=["10 %"]
    )
    direction: Annotated[Spread, SpreadOf(*_ANGLES)] = Field(
        default=Spread(5.0), description="of the current, at all depths alike", examples=["5 deg"]
    )
    cable_drag: Annotated[Spread, SpreadOf(*_SHARES)] = Field(
        default=Spread(between=(-0.15, 0.30)),
        description="of cables and chains, strumming aside",
        examples=[["-15 %", "30 %"]],
    )
    rigid_drag: Annotated[Spread, SpreadOf(*_SHARES)] = Field(
        default=Spread(0.15),
        description="of rigid pieces and of what is clamped on",
        examples=["15 %"],
    )
    buoyancy: Annotated[Spread, SpreadOf(*_SHARES)] = Field(
        default=Spread(0.02),
        description="net, of rigid pieces and clamps that float",
        examples=["2 %"],
    )
    cable_weight: Annotated[Spread, SpreadOf(*_SHARES)] = Field(
        default=Spread(0.03),
        description="net force of cables and chains in water",
        examples=["3 %"],
    )
    length: Annotated[Spread, SpreadOf(*_SHARES)] = Field(
        default=Spread(0.003), description="of cables and chains, as cut", examples=["0.3 %"]
    )
    stiffness: Annotated[Spread, SpreadOf(*_SHARES)] = Field(
        default=Spread(0.2), description="of cables and chains", examples=["20 %"]
    )
    depth: Annotated[Spread, SpreadOf(*_SHARES)] = Field(
        default=Spread(0.01), description="of the water", examples=["1 %"]
    )
