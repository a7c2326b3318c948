"""`checks:` of a mooring file: the limits of the design check, each with its default and source."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from typing import Annotated

from pydantic import Field
from pydantic.fields import FieldInfo

from calm.files.accept import AcceptKeys
from calm.files.fields import LENGTH, POSITIVE_LENGTH, Model, Quantity, quantity_of

_FACTOR = Quantity("number", above=0)
_SAFETY = Quantity("number", at_least=1)
"""At least 1: a smaller factor would pass what breaks, or an anchor that is lifted."""
_SHARE = Quantity("number", at_least=0, at_most=1)
_SPEED = Quantity("speed", at_least=0)
_LEAST_TENSION = Quantity("force", at_least=0)

THIS_PROGRAM = "a default of this program"
THE_DESIGN = "the design"


@dataclass(frozen=True)
class Limit:
    """Annotation of a key of `checks:`: who gives its default.

    Attributes
    ----------
    source : of the default; of one that is judged only where it is given, the design
    default : [SI, degrees] where the model has None: it is judged all the same
    """

    source: str = THIS_PROGRAM
    default: float | None = None


_UFC = "UFC 4-159-03, table 3-7: 3 on new breaking strength of chain and wire"
_PRACTICE = "oceanographic practice: a third to a fifth of the breaking load"
_DEWEY = "Dewey, Mooring Design & Dynamics: weight in water ≥ 1.5 (V + H/0.6)"
_NO_FIGURE = "practice of mooring groups, 50 to 100 kgf above the release; no figure is published"
_URI = "URI GSO mooring program"


class SafetyFactors(Model):
    """Least breaking load over tension."""

    steel: Annotated[float, _SAFETY, Limit(_UFC)] = Field(
        default=3.0, description="of steel and everything that is not rope", examples=[3]
    )
    synthetic: Annotated[float, _SAFETY, Limit(_PRACTICE)] = Field(
        default=5.0, description="of synthetic rope", examples=[5]
    )
    surface: Annotated[float, _SAFETY, Limit(_PRACTICE)] = Field(
        default=5.0, description="of all pieces of a surface mooring", examples=[5]
    )


class MinimumTensions(Model):
    """Least tension above the release [N]."""

    wire: Annotated[float, _LEAST_TENSION, Limit(_NO_FIGURE)] = Field(
        default=500.0, description="in wire", examples=["500 N"]
    )
    rope: Annotated[float, _LEAST_TENSION, Limit(_NO_FIGURE)] = Field(
        default=300.0, description="in synthetic rope", examples=["300 N"]
    )


class Checks(Model):
    """Limits of the design check, and what of its findings is accepted.

    A limit without a default is judged only when given.
    """

    safety_factor: SafetyFactors = Field(
        default_factory=SafetyFactors,
        description="least breaking load over tension, by the material of a piece",
        examples=[{"steel": 3, "synthetic": 5}],
    )
    anchor_factor: Annotated[float, _SAFETY, Limit(_DEWEY)] = Field(
        default=1.5,
        description="required weight of the anchor: factor × (vertical + horizontal / friction)",
        examples=[1.5],
    )
    anchor_friction: Annotated[float, _FACTOR, Limit(_DEWEY)] = Field(
        default=0.6, description="of an anchor on the seabed, where it gives none", examples=[0.6]
    )
    minimum_tension: MinimumTensions = Field(
        default_factory=MinimumTensions,
        description="above the release",
        examples=[{"wire": "500 N", "rope": "300 N"}],
    )
    backup_margin: Annotated[float, _SHARE, Limit(_URI)] = Field(
        default=0.1,
        description="of the weight lifted, left in buoyancy after any break",
        examples=[0.1],
    )
    minimum_rise_speed: Annotated[float, _SPEED, Limit()] = Field(
        default=0.3,
        description="of what comes up once the release has opened",
        examples=["0.3 m/s"],
    )
    launch_safety_factor: Annotated[float, _SAFETY, Limit(_URI)] = Field(
        default=2.0,
        description="breaking load over tension, as the line falls behind its anchor",
        examples=[2],
    )
    launch_working_factor: Annotated[float, _FACTOR, Limit()] = Field(
        default=1.0, description="working load over tension there", examples=[1]
    )
    minimum_reserve: Annotated[float, _SHARE, Limit()] = Field(
        default=0.3,
        description="share of a surface float's buoyancy that must be left",
        examples=[0.3],
    )
    rating_margin: Annotated[float, LENGTH, Limit()] = Field(
        default=100.0, description="depth that must be left to a depth rating", examples=["100 m"]
    )
    maximum_knockdown: Annotated[float | None, POSITIVE_LENGTH, Limit(THE_DESIGN)] = Field(
        default=None, description="most that the top may be pushed down", examples=["50 m"]
    )
    maximum_excursion: Annotated[float | None, POSITIVE_LENGTH, Limit(THE_DESIGN)] = Field(
        default=None, description="most that the top may go to the side", examples=["200 m"]
    )
    maximum_tilt: Annotated[
        float | None,
        Quantity("angle", above=0, at_most=90),
        Limit(THE_DESIGN),
    ] = Field(default=None, description="most that a piece may lean", examples=["30 deg"])
    minimum_top_depth: Annotated[
        float | None,
        LENGTH,
        Limit(THIS_PROGRAM, default=10.0),
    ] = Field(
        default=None,
        description="least depth of the top of a sub-surface line, at low water too",
        examples=["10 m"],
    )
    accept: tuple[AcceptKeys, ...] = Field(
        default=(),
        description="findings that this design accepts, each with its reason",
        examples=[[{"rule": "strength", "component": "glass *", "reason": "hung on chain"}]],
    )


@dataclass(frozen=True)
class LimitKey:
    """A key of `checks:`, such as ``safety_factor.steel``.

    Attributes
    ----------
    name : dotted
    dimension : of `calm.units`
    value : in use [SI, degrees]; None where it is not judged
    default : None where there is none
    source : of the default
    """

    name: str
    dimension: str
    value: float | None
    default: float | None
    source: str

    @property
    def departs(self) -> bool:
        """Whether the design has another limit than the default."""
        return self.default is not None and self.value != self.default


def limit_keys(checks: Checks) -> Iterator[LimitKey]:
    """Every limit of `checks:`, those that are not given with their default."""
    yield from _limit_keys(checks, "")


def _limit_keys(model: Model, prefix: str) -> Iterator[LimitKey]:
    for name, default in _defaults(type(model)):
        value = getattr(model, name)
        if isinstance(value, Model):
            yield from _limit_keys(value, f"{prefix}{name}.")
        elif default is not None:
            used = default.value if value is None else value
            own = prefix or used != default.value
            yield replace(default, name=prefix + name, value=used) if own else default


@cache
def _defaults(model: type[Model]) -> tuple[tuple[str, LimitKey | None], ...]:
    """Of each field the limit that it is unless given; None of one that is no limit."""
    return tuple((name, _default(name, field)) for name, field in model.model_fields.items())


def _default(name: str, field: FieldInfo) -> LimitKey | None:
    limit = next((one for one in field.metadata if isinstance(one, Limit)), None)
    quantity = quantity_of(field)
    if limit is None or quantity is None:
        return None
    default = limit.default if field.default is None else field.default
    return LimitKey(name, quantity.dimension, default, default, limit.source)
