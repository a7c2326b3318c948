"""`checks:` of a mooring file: the limits of the design check, and the findings that it accepts.

Each limit has its default and the source of that; each finding accepted has a reason.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import date as calendar_date
from fnmatch import fnmatchcase
from typing import Annotated

from pydantic import AfterValidator, WithJsonSchema, model_validator

from calm.errors import shown, unknown
from calm.files import definition
from calm.files.rule_texts import ACCEPTABLE, LOADED, RULES
from calm.files.yaml_document import SourceMapping

_FACTOR = definition.QuantityField("number", above=0)
_SAFETY = definition.QuantityField("number", at_least=1)
"""At least 1: a smaller factor would pass what breaks, or an anchor that is lifted."""
_FRICTION = definition.QuantityField("number", above=0, at_most=1)
_SHARE = definition.QuantityField("number", at_least=0, at_most=1)
_SPEED = definition.QuantityField("speed", at_least=0)
_LEAST_TENSION = definition.QuantityField("force", at_least=0)

THIS_PROGRAM = "a default of this program"
THE_DESIGN = "the design"


@dataclass(frozen=True)
class Limit:
    """Annotate a key of `checks:` with who gives its default.

    Attributes
    ----------
    source : of the default; of one that is judged only where it is given, the design
    default : [SI, degrees] where the model has None: it is judged all the same
    """

    source: str = THIS_PROGRAM
    default: float | None = None


_UFC = "UFC 4-159-03, table 3-7: 3 on new breaking strength of chain and wire"
_PRACTICE = "oceanographic practice: a third to a fifth of the breaking load"
_DEWEY = RULES["anchor-weight"].source
_NO_FIGURE = "practice of mooring groups, 50 to 100 kgf above the release; no figure is published"
_BERTEAUX = "Berteaux, Prindle & May, OCEANS '87: fish bite from the surface to 1000 m and more"
_2SK = RULES["wave-strength"].source
_LIFE = "API RP 2SK: a fatigue life of three times the service life"
_URI = "URI GSO mooring program"


class SafetyFactors(definition.Model):
    """Least breaking load over tension."""

    steel: Annotated[float, _SAFETY, Limit(_UFC)] = definition.described(
        "of steel and everything that is not rope", 3, default=3.0
    )
    synthetic: Annotated[float, _SAFETY, Limit(_PRACTICE)] = definition.described(
        "of synthetic rope", 5, default=5.0
    )
    surface: Annotated[float, _SAFETY, Limit(_PRACTICE)] = definition.described(
        "of all pieces of a surface mooring", 5, default=5.0
    )


class MinimumTensions(definition.Model):
    """Least tension above the release [N]."""

    wire: Annotated[float, _LEAST_TENSION, Limit(_NO_FIGURE)] = definition.described(
        "in wire", "500 N", default=500.0
    )
    rope: Annotated[float, _LEAST_TENSION, Limit(_NO_FIGURE)] = definition.described(
        "in synthetic rope", "300 N", default=300.0
    )


class Checks(definition.Model):
    """Limits of the design check, and what of its findings is accepted.

    A limit without a default is judged only when given.
    """

    safety_factor: SafetyFactors = definition.described(
        "least breaking load over tension, by the material of a piece",
        {"steel": 3, "synthetic": 5},
        default_factory=SafetyFactors,
    )
    anchor_factor: Annotated[float, _SAFETY, Limit(_DEWEY)] = definition.described(
        "required weight of the anchor: factor × (vertical + horizontal / friction)",
        1.5,
        default=1.5,
    )
    anchor_friction: Annotated[float, _FRICTION, Limit(_DEWEY)] = definition.described(
        "friction of an anchor on the seabed that gives none", 0.6, default=0.6
    )
    minimum_tension: MinimumTensions = definition.described(
        "above the release", {"wire": "500 N", "rope": "300 N"}, default_factory=MinimumTensions
    )
    backup_margin: Annotated[float, _SHARE, Limit(_URI)] = definition.described(
        "buoyancy left after any break, as a share of the weight lifted", 0.1, default=0.1
    )
    minimum_rise_speed: Annotated[float, _SPEED, Limit()] = definition.described(
        "speed of the rise once the release has opened", "0.3 m/s", default=0.3
    )
    launch_safety_factor: Annotated[float, _SAFETY, Limit(_URI)] = definition.described(
        "breaking load over tension, as the line falls behind its anchor", 2, default=2.0
    )
    launch_working_factor: Annotated[float, _FACTOR, Limit()] = definition.described(
        "working load over tension there", 1, default=1.0
    )
    waves_safety_factor: Annotated[float, _SAFETY, Limit(_2SK)] = definition.described(
        "breaking load over greatest tension in waves", 1.67, default=1.67
    )
    fatigue_factor: Annotated[float, _SAFETY, Limit(_LIFE)] = definition.described(
        "life in waves over `service_time`", 3, default=3.0
    )
    service_time: Annotated[float, definition.QuantityField("time", above=0), Limit()] = (
        definition.described("between two renewals of the line", "730 d", default=365.0 * 86_400.0)
    )
    minimum_reserve: Annotated[float, _SHARE, Limit()] = definition.described(
        "share of a surface float's buoyancy that must remain", 0.3, default=0.3
    )
    rating_margin: Annotated[float, definition.LENGTH, Limit()] = definition.described(
        "margin to keep to a depth rating", "100 m", default=100.0
    )
    maximum_knockdown: Annotated[float | None, definition.POSITIVE_LENGTH, Limit(THE_DESIGN)] = (
        definition.optional("greatest allowed knockdown of the top", "50 m")
    )
    maximum_excursion: Annotated[float | None, definition.POSITIVE_LENGTH, Limit(THE_DESIGN)] = (
        definition.optional("greatest allowed offset of the top", "200 m")
    )
    maximum_tilt: Annotated[
        float | None, definition.QuantityField("angle", above=0, at_most=90), Limit(THE_DESIGN)
    ] = definition.optional("greatest allowed tilt of a piece", "30 deg")
    minimum_top_depth: Annotated[
        float | None, definition.LENGTH, Limit(THIS_PROGRAM, default=10.0)
    ] = definition.optional(
        "least depth of the top of a sub-surface line, at low water too", "10 m"
    )
    planned_depth_warning: Annotated[float, definition.LENGTH, Limit()] = definition.described(
        "distance from the planned depth beyond which the check warns, unless 2 % of that is more",
        "10 m",
        default=10.0,
    )
    planned_depth_limit: Annotated[float, _SHARE, Limit()] = definition.described(
        "distance from the planned depth, as a share of it, beyond which the check fails",
        "10 %",
        default=0.1,
    )
    fishbite_depth: Annotated[float, definition.LENGTH, Limit(_BERTEAUX)] = definition.described(
        "depth down to which fish bite synthetic rope; 0 m for nowhere", "1500 m", default=1000.0
    )
    accept: tuple[AcceptKeys, ...] = definition.described(
        "findings that this design accepts, each with its reason",
        [{"rule": "strength", "component": "glass *", "reason": "hung on chain"}],
        default=(),
    )


GREATER_FLATTERS = (
    *("breaking_load", "working_load", "opening_load", "grip"),
    *("depth_rating", "max_tilt", "warn_tilt", "buoyancy"),
)
"""Limits by which a component is judged, and its lift: each flatters the greater it is."""
LESSER_FLATTERS = (
    *("weight", "diameter", "cn", "ct", "cx", "cd", "drag_area", "kn", "kt"),
    *("k_surface", "wind_area", "wind_cd"),
)
"""Weight and drag of a component, each of which flatters the less it is; an anchor's do not."""


@dataclass(frozen=True)
class LimitKey:
    """Represent a key of `checks:`, such as ``safety_factor.steel``.

    Attributes
    ----------
    name : dotted
    dimension : of `calm.units`
    value : in use [SI, degrees]; None where it is not judged
    default : None where there is none
    source : of the default
    backed : whether the design says where its own value comes from
    """

    name: str
    dimension: str
    value: float | None
    default: float | None
    source: str
    backed: bool = True

    @property
    def departs(self) -> bool:
        """Return whether the design has another limit than the default."""
        return self.default is not None and self.value != self.default


def limit_keys(checks: definition.Model, prefix: str = "") -> Iterator[LimitKey]:
    """Return every limit of `checks:`, those that are not given with their default.

    `prefix` is that of the names where the model stands under a key of another one.
    """
    for name, field in type(checks).model_fields.items():
        value, quantity = getattr(checks, name), definition.quantity_of(field)
        limit = next((one for one in field.metadata if isinstance(one, Limit)), None)
        if isinstance(value, definition.Model):
            yield from limit_keys(value, f"{prefix}{name}.")
        elif limit is not None and quantity is not None:
            default = limit.default if field.default is None else field.default
            used = default if value is None else value
            yield LimitKey(prefix + name, quantity.dimension, used, default, limit.source)


def _day(text: str) -> str:
    try:
        if calendar_date.fromisoformat(text).isoformat() == text:
            return text
    except ValueError:
        pass
    raise ValueError(f"`{shown(text)}` is not a day of the calendar; write it as 2027-06-30")


def _said(text: str) -> str:
    if not text.strip():
        raise ValueError("`reason` is blank")
    if not any(sign.isalnum() for sign in text):
        raise ValueError(f"`reason: {shown(text)}` gives no reason; say it in words")
    return text.strip()


Day = Annotated[
    definition.Text,
    AfterValidator(_day),
    WithJsonSchema({"type": "string", "pattern": r"^\d{4}-\d{2}-\d{2}$"}),
]
"""A day such as 2027-06-30; such texts sort by date."""

Reason = Annotated[definition.Text, AfterValidator(_said)]


class AcceptKeys(definition.Model):
    """An item of `checks: accept:`."""

    rule: Annotated[definition.Text, WithJsonSchema({"enum": list(ACCEPTABLE)})] = (
        definition.described("of the design check", "knockdown")
    )
    reason: Reason = definition.described(
        "why the finding is accepted", "the maker gives no load; hung on chain"
    )
    component: definition.Text | None = definition.optional(
        "label of the line, or a pattern of labels; all when absent", "glass *"
    )
    by: definition.Text | None = definition.optional("who accepts it", "A. Martin")
    date: Day | None = definition.optional("day, e.g. 2026-11-20", "2026-11-22")
    until: Day | None = definition.optional("last day on which it counts", "2027-12-31")
    load: Annotated[float | None, definition.QuantityField("force", above=0)] = definition.optional(
        "greatest tension that is accepted, such as a proof load", "25 kN"
    )

    @model_validator(mode="after")
    def _ends_after_it_begins(self) -> AcceptKeys:
        if self.date is not None and self.until is not None and self.until < self.date:
            raise ValueError(f"the `accept` ends on {self.until}, before its `date`, {self.date}")
        return self


class Accept(AcceptKeys):
    """Say what is accepted of a mooring.

    `labels` are those of the pieces and clamps that it stands for, None for every finding of the
    rule; `line` is its own in the mooring file.
    """

    labels: tuple[str, ...] | None
    line: int

    def covers(self, rule: str, component: str | None) -> bool:
        """Return whether it is of that rule and component."""
        return self.rule == rule and (self.labels is None or component in self.labels)

    def counts_on(self, day: calendar_date) -> bool:
        """Return whether it has not ended before that day, and is not dated after it."""
        begun = self.date is None or self.date <= day.isoformat()
        return begun and (self.until is None or day.isoformat() <= self.until)


def read_accepts(
    keys: Sequence[AcceptKeys], labels: Sequence[str] | None, top: SourceMapping
) -> tuple[Accept, ...]:
    """Return what a mooring file accepts, the most specific first.

    Parameters
    ----------
    labels : of the line; None where the line has mistakes of its own
    top : the mooring file
    """
    found = [_accept(one, number, labels, top) for number, one in enumerate(keys)]
    known = labels or ()
    return tuple(sorted(found, key=lambda one: (one.component is None, one.component not in known)))


def _accept(
    keys: AcceptKeys, number: int, labels: Sequence[str] | None, top: SourceMapping
) -> Accept:
    here = "checks", "accept", number
    if keys.rule not in ACCEPTABLE:
        rule = shown(keys.rule)
        message = unknown(f"no rule that can be accepted is called `{rule}`", rule, ACCEPTABLE)
        top.refuse((*here, "rule"), message)
    if keys.load is not None and keys.rule not in LOADED:
        message = f"`load` is a tension, and `{keys.rule}` judges none"
        top.refuse((*here, "load"), message)
    covered = None
    if keys.component is not None and labels is not None:
        covered = tuple(matching(keys.component, labels))
        if not covered:
            top.refuse((*here, "component"), _nothing_called(keys.component, labels))
    line = top.problem(here, "").line
    return Accept.model_construct(**dict(keys), labels=covered, line=line)


def matching(component: str, labels: Iterable[str]) -> list[str]:
    """Return the labels that a label or a pattern of labels stands for.

    A text that is a label is that label alone, whatever signs it has. Otherwise ``*`` stands for
    any signs, ``?`` for one, ``[ab]`` for a or b; capitals count.
    """
    labels = list(labels)
    if component in labels:
        return [component]
    return [label for label in labels if fnmatchcase(label, component)]


def _nothing_called(component: str, labels: Sequence[str]) -> str:
    text = shown(component)
    message = f"no piece or clamp is called `{text}`"
    if any(label.startswith(f"{component} ") for label in labels):
        return f"{message}; did you mean `{text} *`?"
    return unknown(message, component, labels)
