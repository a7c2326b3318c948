"""Criteria: upper or lower limits on a quantity of a piece or clamp, or of the whole line.

The design check evaluates a criterion for one result. Batch statistics count the profiles that
violate a criterion.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import groupby
from math import hypot, isnan, nan

from calm.case.leg import Leg
from calm.case.leg_result import LegResult
from calm.case.strumming import FACTOR
from calm.checks.finding import Rule, State, Verdict, at_most, rule, unknown
from calm.files import Component, MooringFile, Place, StrummingFactor
from calm.files.check_limits import Checks, LimitKey, limit_keys
from calm.files.pieces import clamps_down
from calm.quantities import say
from calm.units import DIMENSIONS

AT_SURFACE = 0.1
"""Depth down to which a part is treated as being at the surface [m]."""


@dataclass(frozen=True)
class JudgedPart:
    """Piece of the line or clamped instrument to which a criterion applies.

    Attributes
    ----------
    label, place : label and place in the file, both unique within the line
    index : index of the piece, or of the piece that carries the clamp, from the top
    clamp : index among all clamps of the line; None for a piece
    """

    label: str
    place: Place
    component: Component
    index: int
    clamp: int | None = None


def pieces_of(leg: Leg) -> list[JudgedPart]:
    """Return the pieces of a leg from the top to the anchor."""
    return [
        JudgedPart(each.label, each.place, each.component, each.index) for each in leg.file.pieces
    ]


def parts_of(leg: Leg) -> list[JudgedPart]:
    """Return the pieces above the anchor and then all clamps, each from the top down.

    Clamps on the anchor are included.
    """
    pieces = leg.file.pieces
    on = [piece.index for piece in pieces for _ in piece.clamps]
    clamps = [
        JudgedPart(each.label, each.place, each.component, index, number)
        for number, (index, each) in enumerate(zip(on, clamps_down(pieces), strict=True))
    ]
    return pieces_of(leg)[:-1] + clamps


@dataclass(frozen=True)
class Criterion:
    """Limit on a quantity of a piece or clamp, or of the whole line.

    Attributes
    ----------
    part : piece or clamp to check; for the whole line, the top piece or the anchor
    quantity : a key of `READINGS`
    limit : limit in SI units or degrees; None if the component lacks a value for the limit
    words : function that returns message and remedy, given the value (NaN if unknown) and the
        result
    least : whether the limit is a lower limit
    beyond : state of the verdict if the value violates the limit
    silent : whether to skip the criterion if the value is NaN; otherwise, the verdict is unknown
    source, figure : as in `Verdict`
    lacks : key of the missing component value, if `limit` is None
    stated : function that converts the value to a more customary quantity for display; given the
        value and the result, the function returns the displayed value and its limit
    stated_least : whether the displayed limit is a lower limit
    """

    part: JudgedPart
    quantity: str
    limit: float | None
    words: Callable[[float, LegResult], tuple[str, str]]
    least: bool = False
    beyond: State = State.FAIL
    silent: bool = False
    source: str = ""
    lacks: str = ""
    figure: str = ""
    stated: Callable[[float, LegResult], tuple[float, float]] | None = None
    stated_least: bool = False

    def verdict(self, result: LegResult) -> Verdict | None:
        """Evaluate the criterion for a result.

        Return None if the criterion does not apply.
        """
        value = READINGS[self.quantity](result, self.part)
        if isnan(value) and self.silent:
            return None
        message, remedy = self.words(value, result)
        if isnan(value) or self.limit is None:
            lacks = self.lacks if self.limit is None else ""
            known = None if isnan(value) else value
            return unknown(self.part, message, remedy, known, lacks=lacks)
        shown, limit, least = value, self.limit, self.least
        if self.stated is not None:
            shown, limit = self.stated(value, result)
            least = self.stated_least
        return at_most(
            self.part, shown, limit, message, remedy, self.beyond, self.source,
            least=least, figure=self.figure,
        )  # fmt: skip


def verdicts(criteria: Iterable[Criterion], result: LegResult) -> Iterator[Verdict]:
    """Yield the most severe verdict on each part; criteria for the same part must be adjacent."""
    for _, group in groupby(criteria, key=lambda criterion: criterion.part):
        found = [verdict for each in group if (verdict := each.verdict(result)) is not None]
        if found:
            yield min(found, key=lambda verdict: verdict.rank)


def criteria(
    name: str, *, of_anchor: bool = False
) -> Callable[[Callable[[Leg], Iterator[Criterion]]], Rule]:
    """Return a decorator that creates the rule called `name` from a function.

    The function yields the criteria for a leg. `of_anchor` is as in `Rule`.
    """

    def of(criteria_of: Callable[[Leg], Iterator[Criterion]]) -> Rule:
        def judge(result: LegResult) -> Iterator[Verdict]:
            return verdicts(criteria_of(result.leg), result)

        return replace(rule(name, of_anchor=of_anchor)(judge), criteria=criteria_of)

    return of


def _tilt(result: LegResult, part: JudgedPart) -> float:
    rows = result.components if part.clamp is None else result.clamps
    return float(rows.tilt[part.index if part.clamp is None else part.clamp])


def _max_depth(result: LegResult, part: JudgedPart) -> float:
    if part.clamp is not None:
        return float(result.clamps.depth[part.clamp])
    top, bottom = (
        float(ends[part.index])
        for ends in (result.components.depth_top, result.components.depth_bottom)
    )
    return nan if result.type == "surface" and top <= AT_SURFACE else max(top, bottom)


def _offset(result: LegResult) -> float:
    # in a net, the anchor may not be at the origin
    anchor = result.components[-1]
    return hypot(result.top.x - anchor.x_top, result.top.y - anchor.y_top)


READINGS: dict[str, Callable[[LegResult, JudgedPart], float]] = {
    "tension": lambda result, part: float(result.components.tension[part.index]),
    "tension_bottom": lambda result, part: float(result.components.tension_bottom[part.index]),
    "least_tension": lambda result, part: float(result.components.least_tension[part.index]),
    "tilt": _tilt,
    "depth": _max_depth,
    "top_depth": lambda result, _: result.top.depth,
    "knockdown": lambda result, _: nan if result.top.knockdown is None else result.top.knockdown,
    "offset": lambda result, _: _offset(result),
    "required_weight": lambda result, _: result.anchor_load.required_weight,
    "vertical": lambda result, _: result.anchor_load.vertical,
    "slide": lambda result, _: (
        result.anchor_load.horizontal + result.anchor_load.friction * result.anchor_load.vertical
    ),
    "reserve": lambda result, _: (
        1.0 - result.top.used_buoyancy if result.type == "surface" else 0.0
    ),
}
"""Functions that extract each quantity from a result.

- `tension`: maximum over the whole piece
- `least_tension`: minimum off the seabed
- `slide`: H + friction × V, with horizontal anchor load H and vertical anchor load V
"""


def limits_used(file: MooringFile, surface: bool) -> tuple[LimitKey, ...]:
    """Return every limit that the design check applies to a mooring.

    The list also has the values and settings of the file that make the check more lenient, such as
    a load rating above the catalogue value. If the anchor has its own friction coefficient, the
    list has this value for `anchor_friction`. `surface` is true for a surface mooring. A surface
    mooring has no default for the minimum top depth.
    """
    given = file.checks.minimum_top_depth is not None
    used = (
        key
        for key in _keys(file.checks, file.anchor.friction)
        if key.value is not None and (key.name != "minimum_top_depth" or given or not surface)
    )
    return (*used, *file.looser, *_lenient_settings(file))


def _lenient_settings(file: MooringFile) -> Iterator[LimitKey]:
    solver, wire = file.solver, file.checks.minimum_tension.wire
    if isinstance(solver.strumming, StrummingFactor) and solver.strumming.factor < FACTOR:
        factor, source = solver.strumming.factor, "typical of measurements on strumming lines"
        yield LimitKey("solver.strumming.factor", "number", factor, FACTOR, source)
    if solver.seabed_friction > 0.0:
        source = "the anchor alone holds the horizontal load"
        yield LimitKey("solver.seabed_friction", "number", solver.seabed_friction, 0.0, source)
    for piece in file.pieces:
        if piece.component.slack == "allowed":
            name = f"minimum_tension of {piece.label}"
            yield LimitKey(name, "force", 0.0, wire, "`slack: allowed` exempts it")


@lru_cache
def _keys(checks: Checks, friction: float | None) -> tuple[LimitKey, ...]:
    keys = limit_keys(checks)
    if friction is None:
        return tuple(keys)
    return tuple(replace(k, value=friction) if k.name == "anchor_friction" else k for k in keys)


def cited(file: MooringFile, *names: str) -> str:
    """Describe the named limits that differ from their defaults; return "" if no limit differs."""
    return "; ".join(
        f"The design's own `{key.name}`, {limit_value_text(key, key.value)} instead of "
        f"{limit_value_text(key, key.default)}"
        for key in _keys(file.checks, file.anchor.friction)
        if key.name in names and key.departs
    )


def limit_value_text(key: LimitKey, value: float | None) -> str:
    """Format a value of a limit with its unit, or return a dash if the value is None.

    Times are in days, and fractions in percent.
    """
    if value is None:
        return "-"
    if key.share:
        return f"{100.0 * value:.10g} %"
    if key.dimension == "time":
        return f"{value / 86_400.0:.10g} d"
    if key.dimension == "force":
        return say("load", value)
    unit = DIMENSIONS[key.dimension].unit.replace("deg", "°")
    return f"{value:.10g} {unit}".strip().replace(" °", "°")
