"""Load cases of a mooring, and the envelope of the loads on its pieces.

A load case is a situation in an environment. Envelope values carry the code of their governing load
case.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import hypot, isnan

import numpy as np

from calm.case.leg_result import LegResult
from calm.case.result_tables import ClampRow, ComponentRow, rows_down
from calm.checks.assessment import Assessment, estimated
from calm.checks.finding import (
    AS_GIVEN,
    DEFAULT_ENVIRONMENT,
    OWN,
    Finding,
    State,
    governing,
    grouped_by,
)
from calm.checks.posture import reaches_the_surface
from calm.checks.situations import FOULED, STILL, STILL_LOW, STRUMMING, case_of
from calm.checks.strength import allowable_load
from calm.errors import NoEquilibrium
from calm.files.pieces import STAND_IN
from calm.quantities import QUANTITIES, say

LOAD = QUANTITIES["load"]
"""Quantity for forces in tables: in kN with two decimals, or in the unit that the user chose."""


def load_text(value: float | None) -> str:
    """Format a force for print, with a typographic minus sign; a dash if unknown."""
    text = LOAD.format(value)
    return "–" if text == "-" else text.replace("-", "−")


def length_text(value: float | None) -> str:
    """Format a cut length for print; a length in whole metres has no decimals."""
    return QUANTITIES["length"].format(value).removesuffix(".00")


@dataclass(frozen=True)
class LoadCase:
    """A situation of a mooring in an environment.

    Attributes
    ----------
    code : code of the load case in findings, such as 1s
    results : result of each leg of a net or of the single line; empty without equilibrium
    failure : reason why there is no equilibrium, or None
    """

    code: str
    environment: str
    situation: str
    results: tuple[LegResult, ...]
    failure: NoEquilibrium | None

    @property
    def as_given(self) -> bool:
        """Whether the environment is used as in the file, without changes."""
        return self.situation == AS_GIVEN

    @property
    def words(self) -> str:
        """Description of the load case."""
        name = DEFAULT_ENVIRONMENT.capitalize() if self.environment == OWN else self.environment
        if self.situation in (STILL, STILL_LOW):
            return self.situation.capitalize()
        changed = {STRUMMING: "strumming, drag × 1.5", FOULED: "growth"}
        if not self.as_given:
            return f"{name}, {changed.get(self.situation, self.situation)}"
        waters = [one.water for one in self.results]
        fastest = max((float(np.hypot(each.u, each.v).max()) for each in waters), default=None)
        return name if fastest is None else f"{name}, {say('speed', fastest)}"

    @cached_property
    def rows(self) -> Mapping[str, ComponentRow | ClampRow]:
        """Results for all pieces and clamps, by label."""
        every: list[ComponentRow | ClampRow] = []
        for result in self.results:
            for piece, clamps in rows_down(result):
                every += (piece, *clamps)
        return {row.part.label: row for row in every}

    @property
    def depth(self) -> float:
        """Depth of the top of the line [m]; for a net, the minimum over all legs."""
        return min(one.top.depth for one in self.results)

    @property
    def knockdown(self) -> float:
        """Knockdown of the top of the line [m]; for a net, the maximum over all legs.

        The value is 0 if no knockdown is known.
        """
        known = [one.top.knockdown for one in self.results]
        return max((one for one in known if one is not None and not isnan(one)), default=0.0)

    @property
    def offset(self) -> float:
        """Horizontal distance of the top of the line from its anchor [m].

        For a net, this is the maximum over all legs, measured from the origin of the net.
        """
        return max(hypot(one.top.x, one.top.y) for one in self.results)

    @cached_property
    def tension(self) -> tuple[float, str]:
        """Maximum tension [N], and the piece that carries this tension."""
        return max((row.tension, row.label) for row in self._pieces())

    @cached_property
    def factor(self) -> tuple[float, str] | None:
        """Minimum safety factor, and the piece with this factor; None if no factor is known."""
        known = ((row.safety_factor, row.label) for row in self._pieces())
        return min((one for one in known if not isnan(one[0])), default=None)

    @cached_property
    def strength(self) -> tuple[float, str] | None:
        """Maximum ratio of tension to allowable load, and the piece with this ratio."""
        shares = []
        for result in self.results:
            leg = estimated(result.leg)
            factors, surface = leg.file.checks.safety_factor, reaches_the_surface(leg)
            for row, piece in zip(result.components, leg.file.pieces, strict=True):
                load = allowable_load(piece.component, factors, surface)
                if load:
                    shares.append((row.tension / load, row.label))
        return max(shares, default=None)

    @cached_property
    def anchor(self) -> tuple[float, str] | None:
        """Maximum ratio of required to actual anchor weight, and the anchor with this ratio."""
        loads = [
            (one.anchor_load.required_weight / one.anchor_load.weight, one.file.pieces[-1].label)
            for one in self.results
            if one.leg.anchored and one.anchor_load.weight > 0.0
        ]
        return max(loads, default=None)

    @cached_property
    def tilt(self) -> tuple[float, str] | None:
        """Maximum tilt of any instrument [degrees], and the instrument with this tilt."""
        tilts = (
            (row.tilt, label)
            for label, row in self.rows.items()
            if row.part.component.role == "instrument" and not isnan(row.tilt)
        )
        return max(tilts, default=None)

    def _pieces(self) -> Iterator[ComponentRow]:
        return (row for result in self.results for row in result.components if row.use != STAND_IN)


def load_cases(assessment: Assessment) -> list[LoadCase]:
    """List the load cases of a mooring, environment by environment.

    Each environment is followed by its variants, such as strumming. Still water is last.
    """
    numbers: dict[str, int] = {}
    found: dict[str, LoadCase] = {}
    for checked in assessment.in_environments:
        environment = checked.leg.file.environment.name or OWN
        number = numbers.setdefault(environment, len(numbers) + 1)
        for one in checked.situations:
            code = case_of(number, one.name)
            known = found.get(code)
            if known is not None and (known.environment != environment or one.result is None):
                continue
            results = () if one.result is None else (one.result,)
            before = () if known is None else known.results
            found[code] = LoadCase(code, environment, one.name, (*before, *results), one.failure)
    return sorted(found.values(), key=lambda one: one.code.startswith("0"))


def worst_of_each_environment(cases: Sequence[LoadCase]) -> list[LoadCase]:
    """Select still water, and from each environment the case with the largest knockdown."""
    kept: dict[str, LoadCase] = {}
    for one in cases:
        key = one.code if one.code.startswith("0") else one.environment
        if key not in kept or one.knockdown > kept[key].knockdown:
            kept[key] = one
    return list(kept.values())


@dataclass(frozen=True)
class PieceEnvelope:
    """Extreme loads on a piece over all load cases, and the strength of the piece.

    Attributes
    ----------
    number : number in the line, from 1
    row : results for the piece in the first load case
    tension, case : maximum tension [N], and the code of its load case
    least, tilt : minimum tension [N] and maximum tilt [degrees]
    moored : finding on the strength of the piece in equilibrium
    launch : finding on the strength of the piece during launch
    launch_tension, rise_tension : maximum tension during launch and ascent [N]
    """

    number: int
    row: ComponentRow
    tension: float
    case: str
    least: float
    tilt: float
    moored: Finding | None
    launch: Finding | None
    launch_tension: float | None
    rise_tension: float | None


def piece_loads(assessment: Assessment, cases: Sequence[LoadCase]) -> list[PieceEnvelope]:
    """Compute the extreme loads on every piece, from the top to the anchor, leg by leg."""
    strong, falling = (found_on(assessment, name) for name in ("strength", "launch-strength"))
    launch, recovery = assessment.launch, assessment.recovery
    moored = [one for one in cases if one.results]
    found = []
    first = (row for result in moored[0].results for row in result.components)
    for number, row in enumerate((one for one in first if one.use != STAND_IN), 1):
        every = ((one.rows.get(row.label), one.code) for one in moored)
        rows = [(each, code) for each, code in every if isinstance(each, ComponentRow)]
        tension, case = max(((each.tension, code) for each, code in rows), key=lambda one: one[0])
        falls = None if launch is None else _at(launch.greatest_tension, row.index)
        rises = None
        if recovery is not None:
            both = recovery.tension_top, recovery.tension_bottom
            known = [one for each in both if (one := _at(each, row.index)) is not None]
            rises = max(known, default=None)
        found.append(PieceEnvelope(
            number, row, tension, case, min(each.least_tension for each, _ in rows),
            max(each.tilt for each, _ in rows), strong.get(row.label), falling.get(row.label),
            falls, rises,
        ))  # fmt: skip
    return found


def _at(figures: np.ndarray, index: int) -> float | None:
    value = float(figures[index]) if index < len(figures) else float("nan")
    return None if isnan(value) else value


def found_on(assessment: Assessment, rule: str) -> Mapping[str, Finding]:
    """Return the governing finding of a rule on each component, by component label."""
    found = (one for one in assessment.every_finding() if one.rule == rule)
    groups = grouped_by(found, lambda one: one.component)
    return {label: governing(group) for label, group in groups.items() if label is not None}


def capacity_text(finding: Finding | None) -> str:
    """Format the allowable load of a piece.

    An estimate has the prefix ≈, an unknown load is shown as ?, and a load that is not checked as
    –.
    """
    if finding is None:
        return "–"
    sign = "≈\u00a0" if finding.state is State.ESTIMATED else ""
    return "?" if finding.limit is None else sign + load_text(finding.limit)
