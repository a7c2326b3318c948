"""Conclusions of a design check: the worst in each environment, and what an engineer signs.

The figures that decide are on page one of the report and in its JSON.
"""

import hashlib
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from math import ceil, hypot
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np

from calm.checks.assess import RULES
from calm.checks.assessment import Assessment, MooringInEnvironment
from calm.checks.finding import AS_GIVEN, ON_THE_WAY, OWN, Finding, State, by_rule, worst_of
from calm.files.check_limits import LimitKey
from calm.quantities import say
from calm.report import blocks, check_tables
from calm.report.blocks import Cell, Pairs, Table, number, table_of, words
from calm.report.check_tables import figure_of, named_components, place_of
from calm.report.provenance import title_pairs
from calm.report.result_files import members
from calm.units import KILOGRAM_FORCE, KNOT

_ABREAST = 5
"""Environments beside each other in a table; more of them take another table."""


_LINES, _SIGNS = 44.0, 76.0  # lines of page one, and letters of a line of a table's words


@dataclass(frozen=True)
class StrongestCurrent:
    """The strongest current of all environments, and what the rule says of one that is weak."""

    speed: float
    depth: float
    environment: str
    weak: str


@dataclass(frozen=True)
class LeastFactor:
    """The least breaking load over tension of all environments, and the piece that has it.

    `unknown` counts the pieces that give no breaking load.
    """

    factor: float
    component: str
    environment: str
    situation: str
    unknown: int


Columns = Mapping[str, Mapping[str, Sequence[Finding]]]
"""Findings by the columns of a summary, and by their rules."""


@dataclass(frozen=True)
class CheckFacts:
    """Hold what is concluded and signed of one mooring.

    Attributes
    ----------
    mooring : its name
    environments : their names
    columns : what each rule finds in each environment, and `ON_THE_WAY`
    titles : name and value of what the title block says
    sha256 : of the mooring file, byte for byte; None where it can no longer be read
    current, anchor, factor : what decides; None where it is not known
    findings, accepted : of which the worst stand on page one
    departures : limits of the design's own
    """

    mooring: str
    environments: frozenset[str]
    columns: Columns
    titles: tuple[tuple[str, str], ...]
    sha256: str | None
    current: StrongestCurrent
    anchor: Finding | None
    factor: LeastFactor | None
    findings: tuple[Finding, ...]
    accepted: tuple[Finding, ...]
    departures: tuple[LimitKey, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON object, in SI units."""
        anchor = None
        if self.anchor is not None:
            anchor = members(self.anchor, "component", "environment", "situation", "margin")
            anchor |= {"weight": self.anchor.value, "required_weight": self.anchor.limit}
        counts = check_tables.counted_states(self.findings)
        return {
            "sha256": self.sha256,
            "strongest_current": vars(self.current),
            "anchor": anchor,
            "least_safety_factor": self.factor and vars(self.factor),
            "counts": {state.value: counts[state] for state in State},
            "departures": [key.name for key in self.departures],
        }


def facts_of(assessment: Assessment) -> CheckFacts:
    """Return what is signed of a mooring that is judged."""
    file = replace(assessment.file, name=assessment.name)
    every = (*assessment.all_findings(), *assessment.tighter_findings())
    anchors = [one for one in every if one.rule == "anchor-weight" and one.value is not None]
    columns = {
        stand.environment: by_rule((*stand.findings, *stand.tighter, *_missing_in(stand, every)))
        for stand in assessment.stands
    }
    on_the_way = [one for one in assessment.findings if _is_of_the_way(one)]
    return CheckFacts(
        assessment.name,
        frozenset(one.leg.file.environment.name or OWN for one in assessment.stands),
        columns | {ON_THE_WAY: by_rule(on_the_way)},
        tuple(title_pairs(file)),
        _file_hash(Path(file.path)),
        _strongest_current(assessment),
        worst_of(anchors) if anchors else None,
        _least_factor(assessment),
        every,
        tuple(assessment.accepted_findings()),
        tuple(key for key in assessment.limits if key.departs),
    )


def _missing_in(stand: MooringInEnvironment, findings: Iterable[Finding]) -> Iterator[Finding]:
    """Missing figures without which a rule cannot judge the mooring in an environment."""
    lacked = {(one.rule, one.place) for one in stand.lacking}
    for one in findings:
        if one.missing is not None:
            wanted = product(one.missing.needed_by, one.missing.places)
            if not lacked.isdisjoint(wanted):
                yield one


def _is_of_the_way(finding: Finding) -> bool:
    """Whether a finding concerns launch, recovery or breaks; a missing figure may not."""
    figure = finding.missing
    return figure is None or any(RULES[name].once for name in figure.needed_by)


def _file_hash(path: Path) -> str | None:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return None


def _strongest_current(assessment: Assessment) -> StrongestCurrent:
    found = []
    for stand in assessment.stands:
        water = stand.leg.water
        level = int(np.hypot(water.u, water.v).argmax())
        speed = hypot(water.u[level], water.v[level])
        found.append((speed, float(water.level[level]), stand.environment))
    currents = (one for one in assessment.all_findings() if one.rule == "current")
    weak = [one.message for one in currents if one.state is State.WARN and one.limit is not None]
    return StrongestCurrent(*max(found, key=lambda each: each[0]), " ".join(weak))


def _least_factor(assessment: Assessment) -> LeastFactor | None:
    """Return the least factor in every situation; None where no piece gives a breaking load."""
    found = []
    for stand, situation in ((one, each) for one in assessment.stands for each in one.situations):
        if situation.result is None:
            continue
        pieces = situation.result.components
        factors = np.asarray(pieces.safety_factor, np.float64)
        if not np.isnan(factors).all():
            row, unknown = int(np.nanargmin(factors)), int(np.isnan(factors[:-1]).sum())
            at = pieces.label[row], stand.environment, situation.name
            found.append(LeastFactor(float(factors[row]), *at, unknown))
    return min(found, key=lambda each: each.factor, default=None)


def key_pairs(facts: CheckFacts) -> Pairs:
    """Return what decides, a line or two each: on page one, and on a terminal."""
    current, anchor = facts.current, facts.anchor
    depth = f" at a depth of {say('depth', current.depth)}" if current.speed else ""
    speed = _both("speed", current.speed, KNOT, "kn", 2)
    strongest = f"{speed}{depth}, environment {current.environment}\n{current.weak}".strip()
    held = "unknown"
    if anchor is not None:
        figures = [each for each in (anchor.margin, anchor.value, anchor.limit) if each is not None]
        if len(figures) == 3:
            margin, weight, needed = (
                _both("tension", each, KILOGRAM_FORCE, "kgf", 0) for each in figures
            )
            place = place_of(anchor)
            held = f"{margin}: {weight} held, {needed} needed, environment {place}"
    counts = check_tables.counted_states(facts.findings)
    named = (State.FAIL, State.WARN, State.UNKNOWN, State.ESTIMATED, State.ACCEPTED)
    return Pairs((
        ("strongest current", strongest),
        ("anchor margin", held),
        ("least factor of safety", _factor_text(facts.factor)),
        ("findings", ", ".join(f"{counts[state]} {state.value}" for state in named)),
    ))  # fmt: skip


def _factor_text(factor: LeastFactor | None) -> str:
    if factor is None:
        return "unknown: no piece gives its breaking load"
    changed = "" if factor.situation == AS_GIVEN else f", {factor.situation}"
    text = f"{factor.factor:.2f}, {factor.component}, environment {factor.environment}{changed}"
    if not factor.unknown:
        return text
    pieces = "1 piece gives" if factor.unknown == 1 else f"{factor.unknown} pieces give"
    return f"{text}\n{pieces} no breaking load."


def _both(quantity: str, value: float, scale: float, unit: str, decimals: int) -> str:
    """A value in the unit that people read, and in another that it is asked for."""
    said = say(quantity, value)
    return said if said.endswith(unit) else f"{said} ({value / scale:.{decimals}f} {unit})"


def settled_tables(facts: CheckFacts) -> Iterator[Table]:
    """Return what the designer has decided: what is accepted, and limits of the design's own."""
    terms = attrgetter("accept.reason", "accept.by", "accept.date", "accept.until")
    groups = check_tables.grouped(facts.accepted, terms)
    rows = [(accept, found) for found in groups if (accept := found[0].accept) is not None]
    if rows:
        yield table_of(
            "Accepted",
            rows,
            words("rule", lambda row: ", ".join(RULES[name].title for name in by_rule(row[1]))),
            words("component", lambda row: named_components(row[1])),
            *blocks.of_first(
                words("reason", share=1.8),
                words("by, on", lambda one: Cell(one.by or "nobody", one.date or ""), 0.8),
                words("until", lambda one: one.until or "for good", 0.0),
            ),
        )
    if facts.departures:
        title = "Limits that depart from their defaults"
        yield check_tables.limits_table(facts.departures, title)


def matrix_tables(moorings: Sequence[CheckFacts]) -> Iterator[Table]:
    """Moorings by environments: the worst state in each, the rule that makes it, and its margin."""
    every = dict.fromkeys(column for each in moorings for column in each.columns)
    del every[ON_THE_WAY]
    rows = [(each.mooring, each.columns) for each in moorings]
    note = "Under each state: the rule that makes it, its least margin, and how many unknown."
    return _states("Moorings by environment", [*every, ON_THE_WAY], rows, note,
                   lambda one: f"{RULES[one.rule].title} {figure_of(one, 'margin')}")  # fmt: skip


def _states(
    title: str,
    columns: Sequence[str],
    rows: Iterable[tuple[str, Columns]],
    note: str,
    detail: Callable[[Finding], str],
) -> Iterator[Table]:
    """Tables of the worst state of each row, a name and what was found of it, in each column.

    The detail of a state stands under it.
    """

    def cell(row: tuple[str, Columns], column: str) -> Cell:
        found = row[1].get(column)
        if not found:
            return Cell("–")
        worst = worst_of(map(worst_of, found.values()))
        missing = sum(one.state is State.UNKNOWN for each in found.values() for one in each)
        texts = (detail(worst).strip(), f"{missing} unknown" if missing else "")
        return Cell(worst.state.value, "; ".join(filter(None, texts)), worst.state)

    size = ceil(len(columns) / ceil(len(columns) / _ABREAST))  # of groups much the same
    for start in range(0, len(columns), size):
        beside = columns[start : start + size]
        yield table_of(
            title,
            [row for row in rows if any(map(row[1].get, beside))],
            words(title.split()[0].lower().removesuffix("s"), 0),
            *(words(name, partial(cell, column=name)) for name in beside),
            note=note,
        )


def worst_table(moorings: Sequence[CheckFacts]) -> Table:
    """Each rule with the worst of all its findings, and in how many moorings it fails or warns."""
    several, rows = len(moorings) > 1, []
    for name in RULES:
        found = [
            (one.mooring, of[name]) for one in moorings for of in one.columns.values() if name in of
        ]
        if found:
            worst = [worst_of(each) for _, each in found]
            states = {(mooring, one.state) for (mooring, _), one in zip(found, worst, strict=True)}
            counts = Counter(state for _, state in states) if several else Counter[State]()
            every = (one for _, each in found for one in each)
            unknown = {id(one) for one in every if one.state is State.UNKNOWN}
            rows.append((worst_of(worst), len(unknown), counts))

    def in_so_many(heading: str, state: State) -> blocks.Field:
        return number(heading, lambda row: row[2][state] or None, narrow=False)

    return table_of(
        "Worst finding of each rule",
        rows,
        *blocks.of_first(words("rule", share=0.0), *check_tables.FIGURES),
        number("unknown", lambda row: row[1] or None, short="?"),
        in_so_many("moorings that fail", State.FAIL),
        in_so_many("that warn", State.WARN),
        words("where", lambda row: _where(row[0], several)),
        sortable=True,
    )


def _where(finding: Finding, several: bool) -> str:
    """The component, with mooring, environment and situation where they are not plain."""
    places = [finding.component, finding.mooring if several else None]
    if several or finding.environment != OWN or finding.situation != AS_GIVEN:
        places.append(place_of(finding))
    return ", ".join(filter(None, places))
