"""The deck of one mooring: its pages, and its sheets as files that a spreadsheet opens."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from datetime import datetime
from io import BytesIO

from calm.checks.finding import State
from calm.deck import Deck
from calm.drop import DropPlan
from calm.records.delimited import table_csv
from calm.report.blocks import PageBreak, Plate, Prose, Report, ReportPart, Section
from calm.report.check_summary import short_verdict
from calm.report.deck_lists import (
    cutting_part,
    hardware_part,
    instruments_part,
    lifts_part,
    shipping_part,
)
from calm.report.deck_logs import deployment_part, recovery_part
from calm.report.diagram import Paper, diagram_pages
from calm.report.drop_sheet import drop_part
from calm.report.provenance import date, document_part, input_hash, moment, versions

Rows = Iterable[Sequence[object]]


def deck_csvs(deck: Deck) -> dict[str, str]:
    """The content of each file by its name: UTF-8, SI units in the header, empty where unknown."""
    return {f"{name}.csv": table_csv(*sheet) for name, sheet in deck_sheets(deck).items()}


def deck_workbook(deck: Deck) -> bytes:
    """The same sheets as one Excel workbook, units in the headings, ready to print.

    Texts are texts, whatever they begin with; the date of the workbook is `moment`.
    """
    from xlsxwriter import Workbook

    content = BytesIO()
    book = Workbook(content, {"in_memory": True})
    book.set_properties({"title": deck.file.name, "created": moment() or datetime(1980, 1, 1)})
    bold = book.add_format({"bold": True, "text_wrap": True, "valign": "top", "bottom": 1})
    for name, (header, rows) in deck_sheets(deck).items():
        sheet = book.add_worksheet(name)
        for column, head in enumerate(header):
            sheet.write_string(0, column, head.replace("_", " ").replace("[", " ["), bold)
        for number, row in enumerate(rows, 1):
            for column, value in enumerate(row):
                if isinstance(value, int | float) and value == value:
                    sheet.write_number(number, column, float(f"{value:.6g}"))
                elif isinstance(value, str):
                    sheet.write_string(number, column, value)
        sheet.freeze_panes(1, 0)
        sheet.repeat_rows(0)
        sheet.set_landscape()
        sheet.fit_to_pages(1, 0)
        sheet.set_footer("&L&A&RPage &P of &N")
        sheet.autofit()
    book.close()
    return content.getvalue()


def deck_sheets(deck: Deck) -> dict[str, tuple[Sequence[str], Rows]]:
    """The head and the rows of each sheet by its name, in SI; None where unknown."""
    return {
        "parts": (_PARTS, _parts(deck)),
        "cutting": (_CUTTING, _cutting(deck)),
        "instruments": (_INSTRUMENTS, _instruments(deck)),
        "hardware": (_HARDWARE, _hardware(deck)),
        "shipping": (_SHIPPING, _shipping(deck)),
        "lifts": (_LIFTS, _lifts(deck)),
        "deployment": (_DEPLOYMENT, _deployment(deck)),
        "recovery": (_RECOVERY, _recovery(deck)),
    }


_PARTS = (
    "index", "label", "use", "name", "role", "clamped_on", "at[m]", "cut_length[m]", "mass[kg]",
    "weight_in_water[N]",
)  # fmt: skip


def _parts(deck: Deck) -> Rows:
    for one in deck.assessment.inventory:
        yield (
            one.index, one.label, one.use, one.name, one.role, one.clamped_on, one.at,
            one.cut_length, one.dry_mass, one.wet_weight,
        )  # fmt: skip


_DEPLOYMENT = (
    "number", "index", "label", "use", "name", "serial", "clamped_on", "at[m]", "cut_length[m]",
    "depth[m]", "height[m]", "time_over", "remarks", "checked",
)  # fmt: skip


def _deployment(deck: Deck) -> Rows:
    for number, one in enumerate(deck.deployment, 1):
        yield (
            number, one.index, one.label, one.part.use, one.name, one.serial, one.on, one.at,
            one.cut_length, one.depth, one.height, None, None, None,
        )  # fmt: skip


_RECOVERY = (
    "number", "index", "label", "use", "name", "serial", "clamped_on", "expected[s]", "hangs_at[m]",
    "seen", "on_deck", "condition", "remarks",
)  # fmt: skip


def _recovery(deck: Deck) -> Rows:
    for number, one in enumerate(deck.recovery, 1):
        item = one.item
        yield (
            number, item.index, item.label, item.part.use, item.name, item.deployed_serial, item.on,
            one.time, one.hangs_at, None, None, None, item.remark,
        )  # fmt: skip


_CUTTING = (
    "label", "use", "cut_length[m]", "at_load[N]", "marks[m]", "unstretched_length[m]",
    "tolerance[m]", "top_deeper_by_half_percent[m]", "termination", "over_the_side",
    "onto_the_drum",
)  # fmt: skip


def _cutting(deck: Deck) -> Rows:
    for cut in deck.cuts:
        marks = ";".join(f"{mark.label.replace(';', ',')}@{mark.at:.3f}" for mark in cut.marks)
        yield (
            cut.item.label, cut.item.part.use, cut.length, cut.load, marks, cut.unstretched,
            cut.tolerance, cut.effect, cut.termination, cut.over, cut.onto,
        )  # fmt: skip


_HARDWARE = ("kind", "use", "name", "count", "length[m]", "spares", "total", "basis")


def _hardware(deck: Deck) -> Rows:
    for one in deck.hardware:
        yield (
            one.kind, one.use, one.name, one.count, one.length, one.spares, one.total, one.basis
        )  # fmt: skip


_SHIPPING = (
    "use", "name", "count", "length[m]", "mass[kg]", "volume[m^3]", "missing_masses",
    "missing_volumes",
)  # fmt: skip


def _shipping(deck: Deck) -> Rows:
    for one in deck.shipped:
        unknown = one.missing_masses == one.count, one.missing_volumes == one.count
        yield (
            one.use, one.name, one.count, one.length, None if unknown[0] else one.mass,
            None if unknown[1] else one.volume, one.missing_masses, one.missing_volumes,
        )  # fmt: skip


_LIFTS = ("stage", "index", "label", "lift_mass[kg]", "lift_weight[N]", "hanging[N]")


def _lifts(deck: Deck) -> Rows:
    for stage, lifts in (
        (f"deployment, {deck.order}", deck.lifts.deployment),
        ("recovery", deck.lifts.recovery),
    ):
        for one in lifts:
            yield stage, one.index, one.label, one.mass, one.weight, one.hanging


_INSTRUMENTS = (
    "label", "use", "name", "serial", "clamped_on", "depth[m]", "still_depth[m]",
    "least_depth[m]", "least_in", "greatest_depth[m]", "greatest_in", "greatest_tilt[deg]",
    "warn_tilt[deg]", "max_tilt[deg]", "sampling", "battery_until", "calibrated",
)  # fmt: skip


def _instruments(deck: Deck) -> Rows:
    for one in deck.instruments:
        item, component = one.item, one.item.part.component
        equipment = item.part.equipment
        yield (
            item.label, item.part.use, item.name, item.serial, item.on, item.depth, one.still,
            one.shallowest.depth, one.shallowest.environment, one.deepest.depth,
            one.deepest.environment, one.greatest_tilt, component.warn_tilt, component.max_tilt,
            equipment.sampling, equipment.battery_until, equipment.calibrated,
        )  # fmt: skip


def deck_report(deck: Deck, paper: Paper, notes: tuple[str, ...] = ()) -> Report:
    """Diagram, logs, lists and plans; `notes` is what else is to be said on the first sheet."""
    parts: list[ReportPart] = [*document_part(deck.file)]
    said = (*deck.notes, *notes)
    if said:
        parts.append(ReportPart("To be known", (Prose(said, State.WARN),)))
    parts += _sheets(deck)
    (made_by,) = (f"{name} {number}" for name, number in versions()[:1])
    return Report(
        deck.file.name,
        f"{deck.order}, environment: {deck.environment}",
        (),
        (Section(deck.file.name, tuple(parts)),),
        date(),
        plates(deck, paper),
        verdict=short_verdict(deck.assessment.all_findings()),
        foot=f"{made_by}, inputs SHA-256 {input_hash([deck.file])}",
    )


def diagram_report(deck: Deck, paper: Paper) -> Report:
    """The diagram alone."""
    return Report(deck.file.name, "mooring diagram", (), (), date(), plates(deck, paper))


def plates(deck: Deck, paper: Paper) -> tuple[Plate, ...]:
    """The pages of the diagram."""
    pages = diagram_pages(deck, paper)
    return tuple(
        Plate(f"Mooring diagram, {number} of {len(pages)}", svg)
        for number, svg in enumerate(pages, 1)
    )


def _sheets(deck: Deck) -> Iterator[ReportPart]:
    """Yield the logs on pages of their own, the lists and the drop plan one below the other."""
    yield _last(deployment_part(deck))
    yield _last(recovery_part(deck))
    yield instruments_part(deck)
    yield cutting_part(deck)
    yield hardware_part(deck)
    yield shipping_part(deck)
    yield lifts_part(deck)
    if isinstance(deck.plan, DropPlan):
        yield drop_part(deck.plan)


def _last(part: ReportPart) -> ReportPart:
    return replace(part, blocks=(*part.blocks, PageBreak()))
