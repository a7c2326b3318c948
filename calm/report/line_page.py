"""Page 3 of a design check: load and capacity of every piece over all load cases."""

from collections.abc import Callable, Iterator, Sequence
from math import inf
from typing import Any, Literal

from calm.case.leg_result import LegResult
from calm.case.result_tables import ComponentRow, run_of
from calm.checks.finding import Finding, State, grouped_by
from calm.drawing.check_figures import PieceBar, load_chart
from calm.drawing.line_picture import differ_by_number, together
from calm.files import Clamp, Piece
from calm.quantities import QUANTITIES
from calm.report.blocks import Block, Cell, Figure, Table, number, table_of, words
from calm.report.load_cases import (
    LOAD,
    LoadCase,
    PieceEnvelope,
    capacity_text,
    load_text,
    piece_loads,
)
from calm.report.open_items import percent_text
from calm.report.page_one import SignedMooring


def line_page(signed: SignedMooring) -> Iterator[Block]:
    """Yield tables of the loads on the main line, on each type of hardware, and on the anchor."""
    if not signed.moored:
        return
    loads = piece_loads(signed.assessment, signed.moored)
    hardware = [one for one in loads if one.row.role == "connector"]
    main = [one for one in loads if one.row.role != "connector"]
    yield _loads_table(main)
    unit = LOAD.display_unit
    points = [
        PieceBar(
            one.number, one.tension * LOAD.scale, _scaled(one.moored), _known(one.launch_tension),
            _scaled(one.launch), one.moored is not None,
        )
        for one in loads
    ]  # fmt: skip
    title = f"Tension and capacity, {unit}"
    aside = (
        "by item; black: moored, grey: launch; tick: capacity, dotted: capacity during launch; "
        "▲ beyond the scale; ? unknown"
    )
    yield Figure(title, load_chart(title, points, (508.0, 130.0)), aside=aside)
    if hardware:
        yield _hardware_table(hardware)
    yield from _anchor_table(signed)


def _scaled(finding: Finding | None) -> float | None:
    return None if finding is None else _known(finding.limit)


def _known(value: float | None) -> float | None:
    return None if value is None else value * LOAD.scale


def _loads_table(loads: Sequence[PieceEnvelope]) -> Table:
    groups: list[list[PieceEnvelope]] = []
    for one in loads:
        last = groups[-1][-1] if groups else None
        same = (
            last is not None
            and last.row.use == one.row.use
            and differ_by_number(last.row.label, one.row.label)
        )
        if same and _has_floats(one.row):
            groups[-1].append(one)
        else:
            groups.append([one])
    unit = LOAD.display_unit

    def moored(show: _Show) -> Callable[[Any], object]:
        return lambda group: show(_most_used(group))

    def falling(show: _Show) -> Callable[[Any], object]:
        return lambda group: show(_most_used(group, "launch"))

    def case(one: PieceEnvelope) -> Cell:
        return Cell(load_text(one.tension), one.case, goes_on=True)

    passes = ("float", "anchor")
    return table_of(
        "The line",
        groups,
        number("No.", lambda group: run_of([str(one.number) for one in group])),
        words("Item", lambda group: together([one.row.label for one in group])),
        number(f"Tension\n{unit}", moored(case)),
        number(f"Mini-\nmum {unit}", lambda group: None if group[0].row.role in passes
               else load_text(min(one.least for one in group))),
        number("Tilt\n°", lambda group: None if group[0].row.role == "anchor"
               else QUANTITIES["tilt"].format(max(one.tilt for one in group))),
        number(f"Capa-\ncity {unit}", moored(lambda one: capacity_text(one.moored))),
        words("Use", moored(lambda one: _bar_cell(one.moored)), 0.45),
        number("%", moored(lambda one: _use_cell(one.moored))),
        number(f"Launch {unit}", falling(lambda one: _force_text(one.launch_tension))),
        number(f"Capa-\ncity {unit}", falling(lambda one: capacity_text(one.launch))),
        number("Use %", falling(lambda one: _use_cell(one.launch))),
        number(f"Rise {unit}", lambda group: _force_text(
            max((one.rise_tension or 0.0 for one in group), default=None))),
        note=(
            "Capacity is the working load, or the breaking load divided by its safety factor if "
            "this is smaller; the launch columns use the factors for the launch. – not judged, ? "
            "no published load, ≈ estimated, ○ accepted. The code of the load case is printed "
            "after the tension. Equal pieces share a row: tension, capacity and use are those of "
            "the piece with the highest use; minimum, tilt and rise are the extremes of all these "
            "pieces."
        ),
        aside="envelope of all load cases: largest tension and tilt, minimum tension",
        ruled=False,
    )  # fmt: skip


def _has_floats(row: ComponentRow) -> bool:
    parts: tuple[Piece | Clamp, ...] = (row.part, *row.part.clamps)
    return any(part.component.role == "float" for part in parts)


_Show = Callable[[PieceEnvelope], object]


def _most_used(
    group: Sequence[PieceEnvelope], when: Literal["moored", "launch"] = "moored"
) -> PieceEnvelope:
    def used(one: PieceEnvelope) -> tuple[float, float]:
        finding = one.moored if when == "moored" else one.launch
        share = None if finding is None else finding.utilisation
        return share or 0.0, (one.tension if when == "moored" else one.launch_tension) or 0.0

    return max(group, key=used)


def _force_text(value: float | None) -> str:
    return "" if not value else load_text(value)


def _bar_cell(finding: Finding | None) -> Cell | None:
    if finding is None or finding.utilisation is None:
        return None
    return Cell(bar=min(finding.utilisation, 9.99), state=finding.state)


def _use_cell(finding: Finding | None) -> Cell | None:
    if finding is None:
        return None
    signs = {State.ACCEPTED: "○", State.UNKNOWN: "?", State.FAIL: "✗", State.WARN: "▲"}
    sign = signs.get(finding.state, "")
    used = "" if finding.utilisation is None else percent_text(finding.utilisation)
    return Cell("\u00a0".join(filter(None, (sign, used))), strong=True)


def _hardware_table(loads: Sequence[PieceEnvelope]) -> Table:
    groups = grouped_by(loads, lambda one: one.row.use).values()
    rows = [(_most_used(group), _most_used(group, "launch"), len(group)) for group in groups]
    unit = LOAD.display_unit
    launched = any(row[1].launch_tension for row in rows)

    def named(one: PieceEnvelope) -> str:
        return f"{one.number} {one.row.label}"

    launch = (
        words("Most used during launch", lambda row: named(row[1])),
        number(f"Launch {unit}", lambda row: _force_text(row[1].launch_tension)),
        number(f"Capa-\ncity {unit}", lambda row: capacity_text(row[1].launch)),
        number("Use %", lambda row: _use_cell(row[1].launch)),
    )
    return table_of(
        "Connecting hardware",
        rows,
        words("Type", lambda row: row[0].row.part.component.name or row[0].row.use, 1.2),
        number("Pieces", 2),
        words("Most used, moored", lambda row: named(row[0])),
        number(f"Largest\ntension {unit}", lambda row: load_text(row[0].tension)),
        number(f"Capa-\ncity {unit}", lambda row: capacity_text(row[0].moored)),
        number("Use %", lambda row: _use_cell(row[0].moored)),
        *(launch if launched else ()),
        aside="one row per type, for the piece with the highest utilisation",
        ruled=False,
    )


def _anchor_table(signed: SignedMooring) -> Iterator[Table]:
    rows = [
        (case, result) for case in signed.moored for result in case.results if result.leg.anchored
    ]
    if not rows:
        return
    anchors = grouped_by(rows, lambda row: row[1].file.pieces[-1].label).values()
    if len(anchors) > 1 or len(rows) > 12:
        rows = [max(group, key=lambda row: row[1].anchor_load.required_weight) for group in anchors]
    checks, angle = signed.assessment.file.checks, QUANTITIES["angle"].format
    factor, unit = checks.anchor_factor, LOAD.display_unit
    first = rows[0][1]
    name = first.file.pieces[-1].component.name or first.file.pieces[-1].label
    one_anchor = len(anchors) == 1
    weighs = f", {LOAD.say(first.anchor_load.weight)} in water" if one_anchor else ""

    def uplift(row: tuple[LoadCase, LegResult]) -> str:
        anchor = row[1].anchor_load
        return percent_text(factor * anchor.vertical / anchor.weight)

    def sliding(row: tuple[LoadCase, LegResult]) -> str:
        anchor = row[1].anchor_load
        holds = anchor.friction * (anchor.weight / factor - anchor.vertical)
        return percent_text(anchor.horizontal / holds if holds > 0.0 else inf)

    yield table_of(
        f"Anchor: {name}{weighs}" if one_anchor else "Anchors, each in its worst case",
        rows,
        words("", lambda row: Cell(row[0].code, strong=True), 0.0),
        words("Case" if one_anchor else "Anchor, case", lambda row: row[0].words if one_anchor
              else f"{row[1].file.pieces[-1].label}, {row[0].words}"),
        number(f"Vertical {unit}", lambda row: load_text(row[1].anchor_load.vertical)),
        number(f"Horizontal {unit}", lambda row: load_text(row[1].anchor_load.horizontal)),
        number("Angle from\nvertical °", lambda row: angle(row[1].anchor_load.angle)),
        number(f"Weight\nrequired {unit}", lambda row: load_text(
            row[1].anchor_load.required_weight)),
        number("Weight use %", lambda row: percent_text(
            row[1].anchor_load.required_weight / row[1].anchor_load.weight)),
        number("Uplift use %", uplift),
        number("Sliding use %", sliding),
        note=f"Weight required: {factor:g} (V + H / {first.anchor_load.friction:.3g}). Uplift use "
        f"is V / (weight / {factor:g}); sliding use is H / "
        f"[{first.anchor_load.friction:.3g} (weight / {factor:g} − V)]. V is the vertical load, H "
        "the horizontal load. Soil strength is not checked.",
        ruled=False,
    )  # fmt: skip
