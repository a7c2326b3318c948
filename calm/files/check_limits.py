"""Key `checks:` of a mooring file: limits of the design check, and accepted findings."""

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
"""Allowed values of a safety factor.

With a factor below 1, the check would accept broken pieces and lifted anchors.
"""
_FRICTION = definition.QuantityField("number", above=0, at_most=1)
_SHARE = definition.QuantityField("number", at_least=0, at_most=1)
_SPEED = definition.QuantityField("speed", at_least=0)
_LEAST_TENSION = definition.QuantityField("force", at_least=0)

THIS_PROGRAM = "a default of CALM"
THE_DESIGN = "the design"


@dataclass(frozen=True)
class Limit:
    """Annotation of a key of `checks:` with its default and the source of the default.

    Attributes
    ----------
    source : source of the default; `THE_DESIGN` without a default
    default : default limit [SI, degrees], if the default of the key itself is None
    """

    source: str = THIS_PROGRAM
    default: float | None = None


_UFC = "UFC 4-159-03, table 3-7: a factor of 3 on the breaking strength of new chain and wire"
_PRACTICE = "oceanographic practice: a third to a fifth of the breaking load"
_DEWEY = RULES["anchor-weight"].source
_NO_FIGURE = "practice of mooring groups: 50 to 100 kgf above the release; no value is published"
_BERTEAUX = (
    "Berteaux, Prindle & May, OCEANS '87: fish attack ropes from the surface to 1000 m and deeper"
)
_2SK = RULES["wave-strength"].source
_LIFE = "API RP 2SK: a fatigue life of three times the service life"
_URI = "URI GSO mooring program"


class SafetyFactors(definition.Model):
    """Required ratios of breaking load to tension, by material."""

    steel: Annotated[float, _SAFETY, Limit(_UFC)] = definition.described(
        "factor for steel and all other materials except synthetic rope", 3, default=3.0
    )
    synthetic: Annotated[float, _SAFETY, Limit(_PRACTICE)] = definition.described(
        "factor for synthetic rope", 5, default=5.0
    )
    surface: Annotated[float, _SAFETY, Limit(_PRACTICE)] = definition.described(
        "factor for all pieces of a surface mooring", 5, default=5.0
    )


class MinimumTensions(definition.Model):
    """Minimum tensions above the release [N]."""

    wire: Annotated[float, _LEAST_TENSION, Limit(_NO_FIGURE)] = definition.described(
        "minimum tension in wire", "500 N", default=500.0
    )
    rope: Annotated[float, _LEAST_TENSION, Limit(_NO_FIGURE)] = definition.described(
        "minimum tension in synthetic rope", "300 N", default=300.0
    )


class Checks(definition.Model):
    """Limits for the design check, and the findings that the designer accepts.

    A limit that has no default is checked only if the file sets it.
    """

    safety_factor: SafetyFactors = definition.described(
        "minimum ratio of breaking load to tension, by the material of a piece",
        {"steel": 3, "synthetic": 5},
        default_factory=SafetyFactors,
    )
    anchor_factor: Annotated[float, _SAFETY, Limit(_DEWEY)] = definition.described(
        "required weight of the anchor: factor × (vertical + horizontal / friction)",
        1.5,
        default=1.5,
    )
    anchor_friction: Annotated[float, _FRICTION, Limit(_DEWEY)] = definition.described(
        "default friction coefficient of an anchor on the seabed", 0.6, default=0.6
    )
    minimum_tension: MinimumTensions = definition.described(
        "minimum tensions above the release",
        {"wire": "500 N", "rope": "300 N"},
        default_factory=MinimumTensions,
    )
    backup_margin: Annotated[float, _SHARE, Limit(_URI)] = definition.described(
        "minimum net buoyancy after a break of the line, as a share of the weight that it lifts",
        0.1,
        default=0.1,
    )
    minimum_rise_speed: Annotated[float, _SPEED, Limit()] = definition.described(
        "minimum speed of the ascent after release", "0.3 m/s", default=0.3
    )
    launch_safety_factor: Annotated[float, _SAFETY, Limit(_URI)] = definition.described(
        "minimum ratio of breaking load to tension during the anchor drop", 2, default=2.0
    )
    launch_working_factor: Annotated[float, _FACTOR, Limit()] = definition.described(
        "maximum ratio of tension to working load during the anchor drop", 1, default=1.0
    )
    waves_safety_factor: Annotated[float, _SAFETY, Limit(_2SK)] = definition.described(
        "minimum ratio of breaking load to maximum tension in waves", 1.67, default=1.67
    )
    fatigue_factor: Annotated[float, _SAFETY, Limit(_LIFE)] = definition.described(
        "minimum ratio of fatigue life in waves to `service_time`", 3, default=3.0
    )
    service_time: Annotated[float, definition.QuantityField("time", above=0), Limit()] = (
        definition.described(
            "time between two renewals of the line", "730 d", default=365.0 * 86_400.0
        )
    )
    minimum_reserve: Annotated[float, _SHARE, Limit()] = definition.described(
        "share of a surface float's buoyancy that must remain", 0.3, default=0.3
    )
    rating_margin: Annotated[float, definition.LENGTH, Limit()] = definition.described(
        "margin by which a part must stay shallower than its depth rating", "100 m", default=100.0
    )
    maximum_knockdown: Annotated[float | None, definition.POSITIVE_LENGTH, Limit(THE_DESIGN)] = (
        definition.optional("maximum knockdown of the top", "50 m")
    )
    maximum_excursion: Annotated[float | None, definition.POSITIVE_LENGTH, Limit(THE_DESIGN)] = (
        definition.optional("maximum offset of the top", "200 m")
    )
    maximum_tilt: Annotated[
        float | None, definition.QuantityField("angle", above=0, at_most=90), Limit(THE_DESIGN)
    ] = definition.optional("maximum tilt of a piece", "30 deg")
    minimum_top_depth: Annotated[
        float | None, definition.LENGTH, Limit(THIS_PROGRAM, default=10.0)
    ] = definition.optional(
        "minimum depth of the top of a subsurface line, even at low water", "10 m"
    )
    planned_depth_warning: Annotated[float, definition.LENGTH, Limit()] = definition.described(
        "difference from the planned depth that causes a warning; at least 2 % of planned depth",
        "10 m",
        default=10.0,
    )
    planned_depth_limit: Annotated[float, _SHARE, Limit()] = definition.described(
        "difference from the planned depth that causes a failure, as a share of planned depth",
        "10 %",
        default=0.1,
    )
    fishbite_depth: Annotated[float, definition.LENGTH, Limit(_BERTEAUX)] = definition.described(
        "depth down to which fish attack synthetic rope; 0 m in waters without such fish",
        "1500 m",
        default=1000.0,
    )
    accept: tuple[AcceptKeys, ...] = definition.described(
        "findings that this design accepts, each with its reason",
        [{"rule": "strength", "component": "glass *", "reason": "the chain carries the load"}],
        default=(),
    )


LENIENT_IF_GREATER = (
    *("breaking_load", "working_load", "opening_load", "grip"),
    *("depth_rating", "max_tilt", "warn_tilt", "buoyancy"),
)
"""Component keys for which a larger value makes the check more lenient."""
LENIENT_IF_LESS = (
    *("weight", "diameter", "cn", "ct", "cx", "cd", "drag_area", "kn", "kt"),
    *("k_surface", "wind_area", "wind_cd"),
)
"""Keys for which a smaller value makes the check more lenient, in components but anchors."""


@dataclass(frozen=True)
class LimitKey:
    """A limit in `checks:`, such as ``safety_factor.steel``, with its value and default.

    Attributes
    ----------
    name : dotted name of the key
    dimension : dimension, as in `calm.units`
    value : limit in use [SI, degrees]; None if there is no limit
    default : default [SI, degrees]; None without a default
    backed : False if an item of the line sets the limit but gives no source for the value
    share : whether the value is displayed in percent
    """

    name: str
    dimension: str
    value: float | None
    default: float | None
    source: str
    backed: bool = True
    share: bool = False

    @property
    def departs(self) -> bool:
        """Whether the value in the design differs from the default."""
        return self.default is not None and self.value != self.default


def limit_keys(checks: definition.Model, prefix: str = "") -> Iterator[LimitKey]:
    """Yield all limits of `checks:`, with the default of any limit that the file does not set.

    `prefix` precedes the name of each key, such as ``safety_factor.`` for nested keys.
    """
    for name, field in type(checks).model_fields.items():
        value, quantity = getattr(checks, name), definition.quantity_of(field)
        limit = next((one for one in field.metadata if isinstance(one, Limit)), None)
        if isinstance(value, definition.Model):
            yield from limit_keys(value, f"{prefix}{name}.")
        elif limit is not None and quantity is not None:
            default = limit.default if field.default is None else field.default
            used = default if value is None else value
            share = quantity == _SHARE
            yield LimitKey(
                prefix + name, quantity.dimension, used, default, limit.source, share=share
            )


def _day(text: str) -> str:
    try:
        if calendar_date.fromisoformat(text).isoformat() == text:
            return text
    except ValueError:
        pass
    raise ValueError(f"`{shown(text)}` is not a date; write it as 2027-06-30")


def _reason(text: str) -> str:
    if not text.strip():
        raise ValueError("`reason` is blank")
    if not any(sign.isalnum() for sign in text):
        raise ValueError(f"`reason: {shown(text)}` contains no words; give a reason")
    return text.strip()


Day = Annotated[
    definition.Text,
    AfterValidator(_day),
    WithJsonSchema({"type": "string", "pattern": r"^\d{4}-\d{2}-\d{2}$"}),
]
"""A date such as 2027-06-30. Dates sort correctly as texts."""

Reason = Annotated[definition.Text, AfterValidator(_reason)]


class AcceptKeys(definition.Model):
    """An item of `checks: accept:`."""

    rule: Annotated[definition.Text, WithJsonSchema({"enum": list(ACCEPTABLE)})] = (
        definition.described("rule of the design check", "knockdown")
    )
    reason: Reason = definition.described(
        "reason for accepting the finding", "no load is published; the chain carries the load"
    )
    component: definition.Text | None = definition.optional(
        "label of a part, or a pattern of labels; by default all parts", "glass *"
    )
    by: definition.Text | None = definition.optional("who accepts it", "A. Martin")
    date: Day | None = definition.optional("day, e.g. 2026-11-20", "2026-11-22")
    until: Day | None = definition.optional("last day of validity", "2027-12-31")
    load: Annotated[float | None, definition.QuantityField("force", above=0)] = definition.optional(
        "maximum tension accepted, such as a proof load", "25 kN"
    )

    @model_validator(mode="after")
    def _ends_after_it_begins(self) -> AcceptKeys:
        if self.date is not None and self.until is not None and self.until < self.date:
            raise ValueError(
                f"this `accept` entry ends on {self.until}, before its `date`, {self.date}"
            )
        return self


class Accept(AcceptKeys):
    """An item of `checks: accept:`, by which the designer accepts findings of a rule.

    `labels` are the labels of the parts concerned; None for all parts. `line` is the line number
    in the mooring file.
    """

    labels: tuple[str, ...] | None
    line: int

    def covers(self, rule: str, component: str | None) -> bool:
        """True if the acceptance applies to a finding of this rule about this component."""
        return self.rule == rule and (self.labels is None or component in self.labels)

    def counts_on(self, day: calendar_date) -> bool:
        """True if the acceptance is valid on a given day."""
        begun = self.date is None or self.date <= day.isoformat()
        return begun and (self.until is None or day.isoformat() <= self.until)


def read_accepts(
    keys: Sequence[AcceptKeys], labels: Sequence[str] | None, top: SourceMapping
) -> tuple[Accept, ...]:
    """Read the accepted findings in a mooring file, sorted from most to least specific.

    `labels` are the labels of the pieces and clamps in the line; None if the line has mistakes.
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
        message = f"`load` is a tension, but the rule `{keys.rule}` does not use tensions"
        top.refuse((*here, "load"), message)
    covered = None
    if keys.component is not None and labels is not None:
        covered = tuple(matching(keys.component, labels))
        if not covered:
            top.refuse((*here, "component"), _no_such_label(keys.component, labels))
    line = top.problem(here, "").line
    return Accept.model_construct(**dict(keys), labels=covered, line=line)


def matching(component: str, labels: Iterable[str]) -> list[str]:
    """Return the labels that equal a text or match a pattern; letter case matters.

    A text that equals a label matches only that label. Patterns are those of `fnmatch`.
    """
    labels = list(labels)
    if component in labels:
        return [component]
    return [label for label in labels if fnmatchcase(label, component)]


def _no_such_label(component: str, labels: Sequence[str]) -> str:
    text = shown(component)
    message = f"no piece or clamp is called `{text}`"
    if any(label.startswith(f"{component} ") for label in labels):
        return f"{message}; did you mean `{text} *`?"
    return unknown(message, component, labels)
