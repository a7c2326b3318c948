"""`checks:` of a mooring file: the limits of the design check, each with its default and source."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from typing import Annotated

from pydantic import Field
from pydantic.fields import FieldInfo

from calm.files.accept import AcceptKeys
from calm.files.fields import LENGTH, POSITIVE_LENGTH, Model, Quantity

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
    """Annotation of a key of `checks:`: what it limits, and who gives its default.

    Attributes
    ----------
    meaning : for the schema and for people
    source : of the default; of one that is judged only where it is given, the design
    default : [SI, degrees] where the model has None: it is judged all the same
    """

    meaning: str
    source: str = THIS_PROGRAM
    default: float | None = None


_UFC = "UFC 4-159-03, table 3-7: 3 on new breaking strength of chain and wire"
_PRACTICE = "oceanographic practice: a third to a fifth of the breaking load"
_DEWEY = "Dewey, Mooring Design & Dynamics: weight in water ≥ 1.5 (V + H/0.6)"
_NO_FIGURE = "practice of mooring groups, 50 to 100 kgf above the release; no figure is published"
_URI = "URI GSO mooring program"


class SafetyFactors(Model):
    """Least breaking load over tension."""

    steel: Annotated[float, _SAFETY, Limit("of steel and everything that is not rope", _UFC)] = 3.0
    synthetic: Annotated[float, _SAFETY, Limit("of synthetic rope", _PRACTICE)] = 5.0
    surface: Annotated[float, _SAFETY, Limit("of all pieces of a surface mooring", _PRACTICE)] = 5.0


class MinimumTensions(Model):
    """Least tension above the release [N]."""

    wire: Annotated[float, _LEAST_TENSION, Limit("in wire", _NO_FIGURE)] = 500.0
    rope: Annotated[float, _LEAST_TENSION, Limit("in synthetic rope", _NO_FIGURE)] = 300.0


class Checks(Model):
    """Limits of the design check, and what of its findings is accepted.

    A limit without a default is judged only when given.
    """

    safety_factor: SafetyFactors = Field(default_factory=SafetyFactors)
    anchor_factor: Annotated[
        float, _SAFETY, Limit("required weight of the anchor over V + H / friction", _DEWEY)
    ] = 1.5
    anchor_friction: Annotated[
        float, _FACTOR, Limit("of an anchor on the seabed that gives none of its own", _DEWEY)
    ] = 0.6
    minimum_tension: MinimumTensions = Field(default_factory=MinimumTensions)
    backup_margin: Annotated[
        float, _SHARE, Limit("share of the weight lifted, and 250 N, left after any break", _URI)
    ] = 0.1
    minimum_rise_speed: Annotated[float, _SPEED, Limit("of the line without its anchor")] = 0.3
    launch_safety_factor: Annotated[
        float, _SAFETY, Limit("breaking load over tension in the launch", _URI)
    ] = 2.0
    launch_working_factor: Annotated[
        float, _FACTOR, Limit("times the working load that is borne in the launch")
    ] = 1.0
    minimum_reserve: Annotated[
        float, _SHARE, Limit("share of the surface float's buoyancy that is left")
    ] = 0.3
    rating_margin: Annotated[float, LENGTH, Limit("left of a depth rating in the current")] = 100.0
    maximum_knockdown: Annotated[float | None, POSITIVE_LENGTH, Limit("of the top", THE_DESIGN)] = (
        None
    )
    maximum_excursion: Annotated[
        float | None, POSITIVE_LENGTH, Limit("of the top, sideways", THE_DESIGN)
    ] = None
    maximum_tilt: Annotated[
        float | None,
        Quantity("angle", above=0, at_most=90),
        Limit("of instruments and releases", THE_DESIGN),
    ] = None
    minimum_top_depth: Annotated[
        float | None,
        LENGTH,
        Limit("of a sub-surface line's top, at low water too", THIS_PROGRAM, default=10.0),
    ] = None
    accept: tuple[AcceptKeys, ...] = ()


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
    quantity = next((one for one in field.metadata if isinstance(one, Quantity)), None)
    if limit is None or quantity is None:
        return None
    default = limit.default if field.default is None else field.default
    return LimitKey(name, quantity.dimension, default, default, limit.source)
