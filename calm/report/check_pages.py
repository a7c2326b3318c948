"""Pages 4 to 6 of a design check: all checks, deployment and recovery, and basis of the check."""

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby

import numpy as np

from calm.case.result_tables import item_numbers, run_of
from calm.checks.assess import RULES
from calm.checks.assessment import Assessment
from calm.checks.criterion import limit_value_text
from calm.checks.finding import (
    DEFAULT_ENVIRONMENT,
    Finding,
    State,
    by_rule,
    governing,
    grouped_by,
    reported_findings,
)
from calm.checks.inventory import InventoryItem, total_of
from calm.checks.leg_graph import Break, Loss
from calm.checks.posture import reaches_the_surface
from calm.files import MooringFile
from calm.files.check_limits import LimitKey
from calm.files.components import FLEXIBLE_KINDS
from calm.physics.line import Water
from calm.quantities import QUANTITIES, bearing_of, duration, say
from calm.report import blocks, provenance
from calm.report.blocks import (
    Beside,
    Block,
    Cell,
    Listing,
    Prose,
    Table,
    number,
    quantity,
    table_of,
    words,
)
from calm.report.check_tables import component_text
from calm.report.load_cases import LOAD, length_text, load_text
from calm.report.open_items import (
    FIGURE_FIELDS,
    advice,
    counts_text,
    figure_text,
    limit_text,
    open_groups,
    percent_text,
    plain,
    where_text,
)
from calm.report.page_one import MOST_REVISIONS, TEXT_HEIGHT, SignedMooring, item_tags
from calm.report.sheet import accuracy_text


def checks_page(signed: SignedMooring) -> Iterator[Block]:
    """Yield the table of all rules, with governing component, governing case, limit and remedy."""
    findings = [*signed.assessment.every_finding()]
    yield checks_table(signed, findings)
    yield blocks.Heading("Accuracy of these values")
    yield Prose((_accuracy_sentences(signed),))


def checks_table(signed: SignedMooring, findings: Sequence[Finding]) -> Table:
    """Tabulate the governing finding of each rule, in order of decreasing utilisation."""
    tags = item_tags(signed)
    rules = [(reported_findings(found), found) for found in by_rule(findings).values()]
    rules.sort(key=lambda rule: _by_utilisation(rule[0][0]))
    rows = [
        (one, len({each.component for each in found}) if one is reported[0] else 0)
        for reported, found in rules
        for one in reported
    ]
    counts = {state: sum(one.state is state for one in findings) for state in State}
    items = counts_text(open_groups(signed.assessment))

    named = {State.PASS: "passed", State.WARN: "warned", State.FAIL: "failed"}
    counted = ", ".join(
        f"{count} {named.get(state, state.value.replace('-', ' '))}"
        for state, count in counts.items()
        if count
    )

    def basis(row: tuple[Finding, int]) -> Cell:
        one, _ = row
        source, todo = plain(one.source).rstrip("."), advice(one)
        tag = tags.get((one.rule, one.component))
        return Cell(detail=f"{source}.", then=f"{todo} ({tag})" if todo and tag else todo)

    return table_of(
        "Checks in full",
        rows,
        words("", lambda row: Cell(state=row[0].state), 0.0),
        words("Rule", lambda row: Cell(
            RULES[row[0].rule].title, f"({row[1]})" if row[1] > 1 else "", goes_on=True), 1.2),
        *blocks.of_first(*FIGURE_FIELDS, words("Where, case", where_text, 0.9)),
        words("Basis of the limit; remedy", basis, 2.2),
        note=f"These {len(rows)} rows summarise {len(findings)} findings: {counted}. "
        + (f"Open items: {items}. " if items else "")
        + "The option --all-findings lists all findings in checks.csv.",
        aside=(
            "Each rule has a row for its finding with the highest utilisation, and a second row if "
            "another finding is more severe. The number of pieces is in brackets."
        ),
    )  # fmt: skip


def _by_utilisation(finding: Finding) -> tuple[float, int]:
    used = finding.utilisation
    return 1.0 if used is None else -used, -finding.state.severity


_A_DIFFERENCE = 0.1
"""Smallest difference between two knockdowns that is reported [m]."""


def _accuracy_sentences(signed: SignedMooring) -> str:
    results = [one for case in signed.moored for one in case.results]
    if not results:
        return "The mooring has no equilibrium, so checks that need one were skipped."
    text = accuracy_text(results)
    given = signed.moored[0]
    strums = next((one for one in signed.moored if one.code == f"{given.code}s"), None)
    if strums is not None and strums.knockdown - given.knockdown >= _A_DIFFERENCE:
        text += (
            f" If the cables strum (case {strums.code}), the knockdown increases from "
            f"{say('knockdown', given.knockdown)} to {say('knockdown', strums.knockdown)}."
        )
    return plain(text)


def handling_page(signed: SignedMooring) -> Iterator[Block]:
    """Yield a summary of launch and recovery, net buoyancy after breaks, and the parts list."""
    assessment = signed.assessment
    if assessment.launch is not None or assessment.recovery is not None:
        yield Beside((_launch_table(assessment),), (_recovery_table(assessment),))
    else:
        of_net = "Launch and recovery of a net of legs are not checked."
        of_line = "Launch and recovery could not be computed."
        several = len({one.leg.name for one in assessment.in_environments}) > 1
        yield Prose((of_net if several else of_line,))
    if assessment.backup:
        yield _breaks_table(assessment)
    yield _inventory_table(signed)


def _pairs(title: str, rows: Iterable[tuple[str, str, str]]) -> Table:
    return table_of(title, rows, words("", 0), number("", 1), number("", 2), ruled=False)


def _launch_table(assessment: Assessment) -> Table:
    launch = assessment.launch
    if launch is None:
        return _pairs("Launch, anchor last", [("No solution", "", "")])
    slow, fast = (QUANTITIES["speed"].format(one) for one in launch.fall_speed_band)
    drag = "" if launch.anchor_drag_known else ", drag assumed"
    tension = launch.greatest_tension
    label = assessment.file.pieces[int(np.nanargmax(tension))].label
    strong = [one for one in assessment.findings if one.rule == "launch-strength"]
    loaded = [one for one in strong if one.component == label]
    most = governing(strong) if strong else None
    rows = [
        ("Touchdown speed" + drag, say("speed", launch.fall_speed),
         _limit_of_rule(assessment, "launch-speed")),
        ("Drag doubled or halved",
         f"{slow} to {fast} {QUANTITIES['speed'].display_unit}", ""),
        ("Anchor tension in descent", LOAD.say(launch.anchor_tension), ""),
        (f"Largest tension, {label}", LOAD.say(float(np.nanmax(tension))), _limit_of(loaded)),
    ]  # fmt: skip
    if most is not None and most.utilisation is not None and most.component != label:
        rows.append((f"Largest use, {most.component}", figure_text(most), _limit_of([most])))
    return _pairs("Launch, anchor last", rows)


def _recovery_table(assessment: Assessment) -> Table:
    rise = assessment.recovery
    if rise is None:
        return _pairs("Recovery, after release", [("No solution", "", "")])
    still = ", in still water" if rise.in_still_water else ""
    arrivals = [float(rise.arrival[piece]) for piece in rise.order]
    first, last = rise.time_to_surface, max(arrivals, default=None)
    tensions = np.fmax(rise.tension_top, rise.tension_bottom)
    rows = [
        ("Net buoyancy of the rising line", LOAD.say(rise.net_buoyancy), ""),
        (
            f"Rise speed{still}",
            say("speed", rise.rise_speed),
            _limit_of_rule(assessment, "recovery"),
        ),
        ("First float at the surface after", "–" if first is None else duration(first), ""),
        ("Last float at the surface after", "–" if last is None else duration(last), ""),
    ]
    if not np.isnan(tensions).all():
        label = assessment.file.pieces[int(np.nanargmax(tensions))].label
        rows.append((f"Largest tension, {label}", LOAD.say(float(np.nanmax(tensions))), ""))
    return _pairs("Recovery, after release", rows)


def _limit_of_rule(assessment: Assessment, rule: str) -> str:
    return _limit_of([one for one in assessment.findings if one.rule == rule])


def _limit_of(found: Sequence[Finding]) -> str:
    if not found:
        return ""
    lead = governing(found)
    used = lead.utilisation
    return limit_text(lead) if used is None else f"{limit_text(lead)}, {percent_text(used)} %"


_MOST_BREAKS = 10


def _breaks_table(assessment: Assessment) -> Table:
    parts = {piece.index: piece for piece in assessment.file.pieces}
    groups: dict[str, list[Break]] = {}
    section = "the top"
    for one in assessment.backup:
        piece = parts.get(one.break_after)
        if piece is None or piece.component.role in ("line", "float", "release"):
            section = one.label
        groups.setdefault(section, []).append(one)
    rows: list[tuple[str, Break | Loss]] = []
    for name, breaks in groups.items():
        judged = [one for one in breaks if one.judged]
        if judged:
            worst = min(judged, key=lambda one: one.margin - one.required)
            rows.append((f"Break at or below {name}", worst))
    left = len(rows) - _MOST_BREAKS
    rows = sorted(rows, key=lambda row: row[1].margin - row[1].required)[:_MOST_BREAKS]
    if assessment.losses:
        loss = min(assessment.losses, key=lambda one: one.margin - one.required)
        rows.append((f"Loss of one float, {loss.label}", loss))
    unit = LOAD.display_unit

    def used(row: tuple[str, Break | Loss]) -> Cell:
        margin = row[1].margin
        share = row[1].required / margin if margin > 0.0 else float("inf")
        return Cell(percent_text(share), strong=True)

    unjudged = sum(not one.judged for one in assessment.backup)
    note = ""
    if rows:
        note = (
            f"Breaks computed: {len(assessment.backup)}. Each row shows the most critical break of "
            "a section. "
        )
    if left > 0:
        note += f"Sections with a larger margin omitted: {left}. "
    if unjudged:
        note += (
            f"Breaks not judged: {unjudged}. A break within the lowest floats, or between the "
            "lowest floats and the release, leaves the release on the seabed in any design."
        )
    return table_of(
        "Breaks and losses",
        rows,
        words("Break or loss", 0, 2.0),
        number(f"Weight to\nlift {unit}", lambda row: load_text(row[1].weight_lifted)),
        number(f"Net buoy-\nancy {unit}", lambda row: load_text(row[1].margin)),
        number(f"Required {unit}", lambda row: load_text(row[1].required)),
        number(f"Drifting\npart {unit}", lambda row: load_text(row[1].loose)
               if isinstance(row[1], Break) else None),
        number("Use %", used),
        note=note.strip(),
        aside="net buoyancy of the section with the release after a break or loss",
        ruled=False,
    )  # fmt: skip


def _number_ranges(numbers: Iterable[str]) -> list[str]:
    """Shorten item numbers to ranges, such as ``7a–7d``."""
    groups = groupby(dict.fromkeys(numbers), lambda one: re.sub(r"\D.*", "", one))
    return [run_of([*own]) for _, own in groups]


def _inventory_table(signed: SignedMooring) -> Table:
    items = signed.assessment.inventory
    numbers = item_numbers(*signed.moored[0].results) if signed.moored else {}
    unit = LOAD.display_unit

    def length(group: Sequence[InventoryItem]) -> str | None:
        known = [one.cut_length for one in group if one.kind in FLEXIBLE_KINDS and one.cut_length]
        return length_text(sum(known)) if known else None

    def mass(group: Sequence[InventoryItem]) -> str:
        known = [one.dry_mass for one in group if one.dry_mass is not None]
        if not known:
            return "unknown"
        least = "≥ " if len(known) < len(group) else ""
        return least + QUANTITIES["dry_mass"].format(sum(known))

    def weight(group: Sequence[InventoryItem]) -> str:
        known = [one.wet_weight for one in group if one.wet_weight is not None]
        return load_text(sum(known)) if known else "–"

    def places(group: Sequence[InventoryItem]) -> Cell:
        if group is items:
            missing = total_of(items).missing_masses
            return Cell(detail=f"{missing} without mass" if missing else "")
        known = _number_ranges(numbers[one.label] for one in group if one.label in numbers)
        return Cell(detail=", ".join(known))

    def name(group: Sequence[InventoryItem]) -> str:
        if group is items:
            return "Total"
        return component_text(group[0].name or group[0].use, group[0].items)

    return table_of(
        "Inventory",
        grouped_by(items, lambda one: one.use).values(),
        number("Pieces", len),
        words("Component", name, 1.6),
        words(
            "Catalogue", lambda group: None if group is items else Cell(detail=group[0].use), 0.9
        ),
        number(f"Cut length\n{QUANTITIES['length'].display_unit}", length),
        number(f"Mass in\nair {QUANTITIES['dry_mass'].display_unit}", mass),
        number(f"Weight in\nwater {unit}", weight),
        words("Items", places, 1.0),
        sums=[items],
        aside="for purchase and packing",
        ruled=False,
    )


def basis_page(signed: SignedMooring, page_size: str = "a4") -> Iterator[Block]:
    """Yield the blocks of the last page: limits, hash of the inputs, environments, mooring file."""
    assessment = signed.assessment
    waters = {
        one.leg.file.environment.name or DEFAULT_ENVIRONMENT: one.leg.water
        for one in assessment.in_environments
    }
    every = (one.leg.file.environment.depth_range for one in assessment.in_environments)
    tides = [*dict.fromkeys(one for one in every if one is not None)]
    environments = (one.leg.file.environment for one in assessment.in_environments)
    unseen = (
        f"{plain('; '.join(provenance.unjudged(environments)))}.",
        "No utilisation in this report takes these effects into account.",
    )
    text = provenance.source_text(assessment.file)
    name = provenance.file_name(assessment.file)
    limits, environment = _limits([*_limits_that_count(signed)]), _environment(waters, tides)
    beside = environment, blocks.Heading("Not covered"), Prose(unseen)
    inputs = Prose((
        "SHA-256 of the inputs (mooring file and all catalogue values used):",
        signed.sha256,
    ))  # fmt: skip
    yield Beside((limits, inputs), beside, 0.62)
    yield from (history := [*_history(assessment.file)])
    listing = "The file can no longer be read." if text is None else text.rstrip()
    above = max(len(limits.rows), len(environment.rows) + _UNJUDGED)
    above += sum(len(table.rows) + 3 for table in history)
    room = TEXT_HEIGHT[page_size] - _AROUND - _ROW * above
    yield Listing("Mooring file", listing, name, 2 * int(room / _LISTED))


_AROUND, _ROW, _LISTED = 95.0, 12.6, 6.5
"""Heights of all headings, of a table row, and of a line of the mooring file [pt].

These heights determine how many lines of the file fit on the last page.
"""
_UNJUDGED = 11
"""Height of the section "Not covered", in rows of the environment table."""


def _limits(limits: Iterable[LimitKey]) -> Table:
    def own(key: LimitKey) -> bool:
        return key.departs or key.default is None

    def called(key: LimitKey) -> str:
        head, _, tail = key.name.replace("_", " ").partition(".")
        text = f"{head}, {tail.replace('.', ', ')}" if tail else head
        return text[:1].upper() + text[1:]

    def source(key: LimitKey) -> Cell:
        usual = "" if key.default is None else f"; default {_value(key, key.default)}"
        return Cell(
            detail=plain(f"set by the design{usual}" if own(key) else _source_name(key.source))
        )

    return table_of(
        "Limits used",
        limits,
        words("Limit", lambda key: Cell(called(key), strong=own(key))),
        number("Value", lambda key: Cell(_value(key, key.value), strong=own(key))),
        words("Source", source, 1.6),
        aside="the limits that the design sets are bold",
        ruled=False,
    )


def _value(key: LimitKey, value: float | None) -> str:
    return plain(limit_value_text(key, value))


def _source_name(source: str) -> str:
    head = re.split(r"[:;]", source)[0]
    return head if len(head) <= 45 else head.split(",")[0]


_OF_WAVES = ("waves_safety_factor", "fatigue_factor", "service_time")
_OF_SURFACE = ("safety_factor.surface", "minimum_reserve")


def _limits_that_count(signed: SignedMooring) -> Iterator[LimitKey]:
    assessment = signed.assessment
    waves = any(one.leg.file.environment.waves for one in assessment.in_environments)
    surface = any(reaches_the_surface(one.leg) for one in assessment.in_environments if one.result)
    for key in assessment.limits:
        idle = (key.name in _OF_WAVES and not waves) or (key.name in _OF_SURFACE and not surface)
        if key.value is not None and not idle:
            yield key


_MOST_LEVELS = 12


def _environment(waters: dict[str, Water], tides: Sequence[tuple[float, float]]) -> Table:
    if len(waters) > 1:
        rows = []
        for name, water in waters.items():
            speed = np.hypot(water.u, water.v)
            at = int(speed.argmax())
            rows.append((name, float(speed[at]), float(water.level[at])))
        return table_of(
            "Environments",
            rows,
            words("", 0),
            quantity("speed", 1, "strongest current"),
            quantity("depth", 2, "at depth"),
            ruled=False,
            note=_water_note(next(iter(waters.values())), tides),
        )
    (water,) = waters.values()
    count = len(water.level)
    levels = np.unique(np.linspace(0, count - 1, min(count, _MOST_LEVELS)).round().astype(int))
    rows_ = [
        (float(water.level[at]), float(np.hypot(water.u[at], water.v[at])),
         f"{bearing_of(float(water.u[at]), float(water.v[at])):.0f}")
        for at in levels
    ]  # fmt: skip
    note = "" if len(levels) == count else f"{len(levels)} of {count} levels. "
    return table_of(
        "Environment",
        rows_,
        quantity("depth", 0),
        quantity("speed", 1),
        number("towards", 2, "°"),
        ruled=False,
        note=note + _water_note(water, tides),
    )


def _water_note(water: Water, tides: Sequence[tuple[float, float]]) -> str:
    low, high = float(water.density.min()), float(water.density.max())
    density = f"{low:.1f}" if high - low < 0.05 else f"{low:.1f} to {high:.1f}"
    levels = "; ".join(f"{say('depth', low)} to {say('depth', high)}" for low, high in tides)
    depth = f"Water depth at low and high water {levels}. " if tides else ""
    rest = "Launch, rise and breaks are checked in environment 1."
    return f"{depth}Density {density} kg/m³. {rest}"


def _history(file: MooringFile) -> Iterator[Table]:
    given = file.document
    if given is not None and len(given.history) > MOST_REVISIONS:
        first = words("Revision", "revision", 0.0), words("Date", "date", 0.0)
        fields = (*first, words("By", "by"), words("Change", "change", 3.0))
        yield table_of("History", given.history, *fields, ruled=False)
