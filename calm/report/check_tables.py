"""Tables of the design check: findings, the worst of many, and the verdict in words."""

import re
from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from functools import partial
from itertools import groupby
from math import hypot, isnan
from operator import attrgetter
from typing import Any, TypeVar

from calm.case.leg_result import LegResult
from calm.checks.assess import RULES
from calm.checks.assessment import Assessment, MooringInEnvironment
from calm.checks.criterion import said
from calm.checks.finding import AS_GIVEN, Finding, State, worst_of, worst_state
from calm.checks.inventory import InventoryItem
from calm.checks.recovery import Break
from calm.drawing.schematic.shown_parts import place_text
from calm.files.check_limits import LimitKey
from calm.files.components import FLEXIBLE_KINDS
from calm.physics.line import Floats
from calm.quantities import QUANTITIES, say
from calm.report import blocks
from calm.report.blocks import Cell, Field, Prose, Span, Table, number, quantity, table_of, words

Item = TypeVar("Item")


def figure_of(finding: Finding, name: str) -> str:
    """The value, limit or margin of a finding with its unit; nothing where it is unknown."""
    value = getattr(finding, name)
    if value is None:
        return ""
    text = QUANTITIES[RULES[finding.rule].quantity].say(value)
    return text if name != "margin" or text.startswith("-") else f"+{text}"


FIGURES = (
    words("state", lambda one: Cell(one.state.value, state=one.state), 0.0),
    *(number(name, partial(figure_of, name=name)) for name in ("value", "limit", "margin")),
)
"""Columns of findings."""


def place_of(finding: Finding) -> str:
    """The environment, and what was changed in it."""
    changed = "" if finding.situation == AS_GIVEN else f", {finding.situation}"
    return f"{finding.environment}{changed}"


def worst_by_part(findings: Iterable[Finding]) -> list[Finding]:
    """The worst finding of each rule on each component, the gravest first."""
    groups = grouped(findings, lambda each: (each.rule, each.place, each.missing))
    return sorted(map(worst_of, groups), key=attrgetter("rank"))


def grouped(items: Iterable[Item], key: Callable[[Item], Hashable]) -> list[list[Item]]:
    """Return the items of each key together, in the order in which the keys come."""
    groups: dict[Hashable, list[Item]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return list(groups.values())


def joined(findings: Iterable[Finding]) -> list[list[Finding]]:
    """Return together the findings of one rule that say the same of several components."""
    return grouped(findings, lambda one: (one.rule, one.state, _wording(one)))


def to_mend(findings: Iterable[Finding]) -> list[list[Finding]]:
    """Return what fails, is unknown or warns, the gravest first, what says the same together."""
    states = (State.FAIL, State.UNKNOWN, State.WARN)
    return joined(one for one in worst_by_part(findings) if one.state in states)


def _wording(finding: Finding) -> str:
    """Return what a finding says and advises, without its component and figures."""
    text = f"{finding.message} {finding.remedy or ''}"
    if finding.component is not None:
        text = text.replace(finding.component, "")
    return re.sub(r"\d[\d.]*", "#", text)


def named(labels: Iterable[str], most: int = 3) -> str:
    """Name labels, each once, such as ``glass 1 to 4, cable``.

    Of more than `most` names, successive numbers as one, how many are left is said.
    """
    numbered: dict[str, list[int]] = {}
    for label in labels:
        match = re.fullmatch(r"(.+ )([1-9]\d{0,5})", label)
        stem, number = match.groups() if match else (label, "0")
        numbered.setdefault(stem, []).append(int(number))
    runs = [run for stem, numbers in numbered.items() for run in _runs(stem, numbers)]
    left = sum(count for _, count in runs[most:])
    return ", ".join(name for name, _ in runs[:most]) + (f" and {left} more" if left else "")


def _runs(stem: str, numbers: Iterable[int]) -> Iterator[tuple[str, int]]:
    """Name each run of successive numbers, and count what it stands for."""
    each = sorted(set(numbers))
    for _, group in groupby(enumerate(each), lambda pair: pair[1] - pair[0]):
        run = [number for _, number in group]
        last = f"{' and ' if len(run) == 2 else ' to '}{run[-1]}" if len(run) > 1 else ""
        yield f"{stem}{run[0] or ''}{last}", len(run)


def named_components(findings: Iterable[Finding]) -> str:
    """Name the components of some findings."""
    return named(one.component or "whole line" for one in findings)


def said_of(finding: Finding) -> Cell:
    """Return what was found and what to do; the figures of a pass say it all, and so does a remedy
    that names the figure missing."""
    if finding.state is State.PASS:
        return Cell()
    if finding.state is State.UNKNOWN and finding.remedy:
        return Cell(finding.remedy)
    return Cell(finding.message, finding.remedy or "")


def counted_states(findings: Iterable[Finding]) -> Counter[State]:
    """Return how many parts of one or several moorings each state is the worst of, rule by rule.

    A missing figure of a component is counted once, and so is a cluster of which every float fails
    or warns.
    """
    by_mooring = grouped(findings, attrgetter("mooring"))
    found = [one for each in by_mooring for one in grouped(worst_by_part(each), _counted_as)]
    return Counter(one[0].state for one in found)


def _counted_as(finding: Finding) -> Hashable:
    """Return what findings are counted as one: of equal pieces in one row of the file, what is to
    be mended.
    """
    place = finding.place
    if place is None or finding.state not in (State.FAIL, State.WARN):
        return id(finding)
    called = re.sub(r" \d+$", "", finding.component or "")
    return finding.rule, finding.state, place.row, called, finding.missing


def verdict_of(findings: Iterable[Finding]) -> tuple[State, str]:
    """The worst state of one or several moorings, and the verdict in words."""
    findings = list(findings)
    counts = counted_states(findings)
    unsigned = [one for one in findings if one.accept is not None and one.accept.by is None]
    nobody = len(worst_by_part(unsigned))
    # what is accepted may be a failure, and not only unknown
    failing = any(one.accept is not None and (one.margin or 0.0) < 0.0 for one in findings)
    other = "else " if failing else ""
    state = worst_state(counts)
    told = [
        _counted(counts[State.FAIL], "failure") if counts[State.FAIL] else f"nothing {other}fails",
        _counted(counts[State.UNKNOWN], "figure") + " unknown" if counts[State.UNKNOWN] else "",
        _counted(counts[State.WARN], "warning") if counts[State.WARN] else "",
        f"{counts[State.ESTIMATED]} estimated" if counts[State.ESTIMATED] else "",
        f"{counts[State.ACCEPTED]} accepted" if counts[State.ACCEPTED] else "",
        f"{nobody} of them by nobody" if nobody else "",
    ]
    return state, ", ".join(filter(None, told))


def verdict_prose(findings: Iterable[Finding]) -> Prose:
    """The verdict with its sign, such as ``? nothing fails, 34 figures unknown``."""
    state, told = verdict_of(findings)
    return Prose(((Span(f"{state.sign} {told}", state),),), state)


def short_verdict(findings: Iterable[Finding]) -> Span:
    """The verdict for the head of a page, such as ``? 0 fail, 34 unknown, 1 warn``."""
    given = [*findings]
    counts = Counter(finding.state for finding in given)
    states = (State.FAIL, State.UNKNOWN, State.WARN)
    state, _ = verdict_of(given)
    return Span(f"{state.sign} {', '.join(f'{counts[one]} {one}' for one in states)}", state)


def limits_table(limits: Iterable[LimitKey], title: str = "Limits as used") -> Table:
    """Limits with their defaults and the sources of those; departures come first."""
    departs = Cell("departs", state=State.WARN)
    return table_of(
        title,
        sorted(limits, key=lambda key: not key.departs),
        words("", lambda key: departs if key.departs else None, 0.0),
        words("limit", "name", 1.2),
        number("as used", lambda key: said(key, key.value)),
        number("default", lambda key: said(key, key.default)),
        words("source of the default", "source", 2.0),
        note="A limit that departs from its default is the design's own; no source is given "
        "for it.",
    )


def _counted(count: int, word: str) -> str:
    return f"{count} {word}{'s' * (count != 1)}"


_RESULTS: dict[str, Callable[[LegResult], float | None]] = {
    "depth": lambda result: result.top.depth,
    "knockdown": lambda result: result.top.knockdown,
    "offset": lambda result: hypot(result.top.x, result.top.y),
    "tilt": lambda result: float(result.components.tilt.max()),
    "tension": lambda result: float(result.components.tension.max()),
    "vertical": lambda result: result.anchor_load.vertical,
    "horizontal": lambda result: result.anchor_load.horizontal,
    "required_weight": lambda result: result.anchor_load.required_weight,
}


def results_table(stands: Sequence[MooringInEnvironment]) -> Table:
    """The mooring as given in each environment: its top, and the pull on its anchor."""

    def figure(stand: MooringInEnvironment, name: str) -> float | None:
        return None if stand.result is None else _RESULTS[name](stand.result)

    def status(stand: MooringInEnvironment) -> Cell:
        failure, state = stand.situations[0].failure, None if stand.result else State.FAIL
        return Cell(stand.environment, failure.status if failure else "", state)

    return table_of(
        "Results by environment",
        stands,
        words("environment", status),
        *(quantity(name, partial(figure, name=name)) for name in _RESULTS),
        note="Depth, knockdown and offset are of the top; tilt and tension are the greatest "
        "in the line.",
    )


def checks_table(findings: Iterable[Finding]) -> Iterator[Table | Prose]:
    """The worst finding of each rule on each component, and the sources of the rules."""
    kept = worst_by_part(findings)
    sources = list(dict.fromkeys(finding.source for finding in kept))

    def rule(found: Sequence[Finding]) -> Cell:
        return Cell(RULES[found[0].rule].title, f"[{sources.index(found[0].source) + 1}]")

    def component(found: Sequence[Finding]) -> Cell:
        """The components, and where the first, the worst, has its figures."""
        place = place_of(found[0])
        where = f"{found[0].component}, {place}" if len(found) > 1 else place
        return Cell(named_components(found), where)

    state, *figures = FIGURES
    yield table_of(
        "Worst finding of each rule on each component",
        joined(kept),
        *blocks.of_first(state),
        words("rule", rule),
        words("component", component, 1.8),
        *blocks.of_first(*figures),
        *blocks.of_first(words("finding and remedy", said_of, 2.5)),
        note="Components with the same finding share a row, which shows the worst of them; "
        "every finding is in checks.csv and report.json. [1] is the first source below "
        "the table.",
        sortable=True,
    )
    yield Prose(tuple(f"[{number}] {source}" for number, source in enumerate(sources, 1)))


def breaks_table(backup: Sequence[Break]) -> Table:
    """Return what would float the release up again after each break."""
    return table_of(
        "Back-up buoyancy",
        backup,
        number("no.", "break_after"),
        words("break below", "label"),
        quantity("wet_weight", "weight_lifted", "weight lifted"),
        quantity("net_buoyancy", "margin", "buoyancy left over"),
        quantity("net_buoyancy", "required", "required"),
        quantity("net_buoyancy", "loose", "comes loose"),
        words("judged", lambda one: "yes" if one.judged else "no"),
        note="Breaks inside the lowest cluster of floats, or between it and the release, "
        "leave the release on the seabed in any design and are not judged. Comes loose: "
        "the net buoyancy of the part that drifts off, before a release opens.",
    )


def handling_summary(assessment: Assessment) -> blocks.Pairs:
    """The launch and the recovery in a few figures."""
    pairs, launch, recovery = [], assessment.launch, assessment.recovery
    if launch is not None:
        low, high = (say("speed", speed) for speed in launch.fall_speed_band)
        speed = f"{say('speed', launch.fall_speed)}; {low} to {high} with twice and half the drag"
        pairs = [
            ("Launch, anchor last: speed at touchdown", f"{speed} of line and anchor"),
            ("Pull of the falling anchor", say("tension", launch.anchor_tension)),
        ]
        if not launch.anchor_drag_known:
            pairs.append(("Drag of the anchor", "unknown; taken as that of a cube of its volume"))
    if recovery is not None:
        time, still = recovery.time_to_surface, " in still water" * recovery.in_still_water
        pairs += [
            ("Recovery: net buoyancy above the release", say("vertical", recovery.net_buoyancy)),
            ("Speed of the rise", say("speed", recovery.rise_speed) + still),
            ("Time to the surface", "-" if time is None else f"{time / 60:.1f} min"),
        ]
    return blocks.Pairs(tuple(pairs))


def handling_table(assessment: Assessment) -> Table:
    """Tensions of each piece on its way down and up, and when and where it ends."""

    def figures(name: str, heading: str, values: Floats) -> Field:
        return quantity(name, lambda piece: float(values[piece.index]), heading)

    fields: list[Field] = []
    if (launch := assessment.launch) is not None:
        fields += [
            figures("tension", "launch, upper end", launch.tension_top),
            figures("tension", "launch, lower end", launch.tension_bottom),
        ]
    if (recovery := assessment.recovery) is not None:

        def minutes(piece: Any) -> str:
            arrival = recovery.arrival[piece.index] / 60.0
            return "" if isnan(arrival) else f"{arrival:.1f}"

        fields += [
            figures("tension", "recovery, upper end", recovery.tension_top),
            figures("tension", "recovery, lower end", recovery.tension_bottom),
            number("at the surface after", minutes, "min"),
            figures("depth", "hangs at depth", recovery.hangs_at),
        ]
    pieces = assessment.file.pieces[:-1]
    heads = number("no.", "index"), words("piece", "label")
    return table_of("Tensions in the launch and the rise", pieces, *heads, *fields)


def deck_table(items: Sequence[InventoryItem]) -> Table:
    """Pieces in the order in which they come to the deck, with their weights and lifts."""
    return table_of(
        "Pieces for the deck",
        items,
        number("no.", lambda one: None if one.clamped_on else one.index),
        words("piece", lambda one: Cell(one.label, indented=one.clamped_on is not None)),
        words("component", lambda one: one.name or one.use),
        number("on its piece", lambda one: None if one.at is None else place_text(one.at), "m"),
        *map(quantity, ("cut_length", "dry_mass", "wet_weight", "lift_mass")),
        note="On its piece: distance of a clamp from the upper end. Weight in water is "
        "positive down. Mass of the lift: of the piece with its clamps.",
    )


def inventory_table(items: Sequence[InventoryItem]) -> Table:
    """Return how many and how much of each component is needed, with room for the spares."""
    note = "Cut lengths are of wires, ropes and chains. Spares are filled in by hand."
    if any(item.dry_mass is None for item in items):
        note += " ≥ marks a lower bound, because masses in air are missing: plan no lift on it."

    def summed(name: str) -> Field:
        return quantity(name, lambda group: None)[0], lambda group: _sum(name, group)

    return table_of(
        "Inventory",
        grouped(items, lambda item: item.use),
        words(
            "component", lambda group: "Total" if group is items else group[0].name or group[0].use
        ),
        words("id", lambda each: None if each is items else each[0].use),
        number("pieces", len),
        *map(summed, ("cut_length", "dry_mass", "wet_weight")),
        blocks.blank("spares"),
        note=note,
        sums=[items],
        by_hand=True,
    )


def _sum(name: str, items: Sequence[InventoryItem]) -> Cell:
    """The sum of what is known, and how much is not; of masses that is the least there can be."""
    if name == "cut_length":
        items = [each for each in items if each.kind in FLEXIBLE_KINDS]
    known = [value for item in items if (value := getattr(item, name)) is not None]
    missing = len(items) - len(known)
    if not known:
        return Cell("-")
    least = "≥ " if missing and name == "dry_mass" else ""
    text = f"{least}{QUANTITIES[name].format(sum(known))}"
    return Cell(text, f"{missing} unknown" if missing else "")
