"""Deck documents of one mooring, as printed pages and as spreadsheet files."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from datetime import datetime
from io import BytesIO
from operator import attrgetter
from typing import Any

from calm.checks.finding import environment_text
from calm.deck import Deck
from calm.drawing.line_drawing import line_drawing
from calm.drop import DropPlan
from calm.records.delimited import table_csv
from calm.report import deck_lists, deck_logs, provenance
from calm.report.anchor_sheets import drop_part
from calm.report.blocks import Figure, PageBreak, Report, ReportPart, warned
from calm.report.diagram import PageSize, diagram_pages
from calm.report.open_items import assessment_verdict
from calm.report.sheet import net_part

Rows = Iterable[Sequence[object]]


def deck_csvs(deck: Deck) -> dict[str, str]:
    """Return the CSV text of each sheet by file name, in SI units; unknown values are empty."""
    return {f"{name}.csv": table_csv(*sheet) for name, sheet in deck_sheets(deck).items()}


def deck_workbook(deck: Deck) -> bytes:
    """Write the sheets into one Excel workbook that is ready to print, with units in the headings.

    Texts are never formulas. The date of the workbook comes from `provenance.moment`.
    """
    from xlsxwriter import Workbook

    content = BytesIO()
    book = Workbook(content, {"in_memory": True})
    book.set_properties(
        {"title": deck.file.name, "created": provenance.moment() or datetime(1980, 1, 1)}
    )
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
    """Return the header and rows of each sheet, by name, in SI units; unknown values are None."""
    stages = {f"deployment, {deck.order}": deck.lifts.deployment, "recovery": deck.lifts.recovery}
    lifts = [(stage, one) for stage, each in stages.items() for one in each]
    rows: dict[str, Sequence[Any]] = {
        "parts": [(deck.numbers[one.label], one) for one in deck.assessment.inventory],
        "cutting": deck.cuts,
        "instruments": [(deck.numbers[one.item.label], one) for one in deck.instruments],
        "hardware": deck.hardware,
        "shipping": deck.shipped,
        "lifts": lifts,
        "deployment": [(deck.numbers[one.label], one) for one in deck.deployment],
        "recovery": [(deck.numbers[one.item.label], one) for one in deck.recovery],
    }
    sheets = {name: _sheet(_COLUMNS[name], items) for name, items in rows.items()}
    if deck.result.several:
        for name, index in _INDEX.items():
            heads, listed = sheets[name]
            legs = [deck.leg(index(one)) for one in rows[name]]
            whole = ((*row, leg) for row, leg in zip(listed, legs, strict=True))
            sheets[name] = (*heads, "leg"), whole
    return sheets


_COLUMNS = {
    "parts": """
        number= index label use name role clamped_on at[m] cut_length[m] mass[kg]=dry_mass
        weight_in_water[N]=wet_weight
    """,
    "cutting": """
        label=item.label use=item.part.use cut_length[m]=length at_load[N]=load marks[m]=marks_text
        unstretched_length[m]=unstretched tolerance[m] top_deeper_by_half_percent[m]=effect
        termination over_the_side=over onto_the_drum=onto
    """,
    "instruments": """
        number= label=item.label use=item.part.use name=item.name serial=item.serial
        clamped_on=item.on depth[m]=item.depth still_depth[m]=still
        planned_depth[m]=item.planned_depth
        least_depth[m]=shallowest.depth least_in=shallowest.environment
        greatest_depth[m]=deepest.depth greatest_in=deepest.environment
        greatest_tilt[deg]=greatest_tilt
        warn_tilt[deg]=item.part.component.warn_tilt max_tilt[deg]=item.part.component.max_tilt
        sampling=item.part.equipment.sampling battery_until=item.part.equipment.battery_until
        calibrated=item.part.equipment.calibrated
    """,
    "hardware": "kind use name count length[m] spares total basis",
    "shipping": """
        use name count units length[m] mass[kg]=known_mass volume[m^3]=known_volume missing_masses
        missing_volumes
    """,
    "lifts": "stage= index label lift_mass[kg]=mass lift_weight[N]=weight hanging[N]",
    "deployment": """
        number= index label use=part.use name serial clamped_on=on at[m] cut_length[m] depth[m]
        planned_depth[m] height[m] time_over=- remarks=- checked=-
    """,
    "recovery": """
        number= index=item.index label=item.label use=item.part.use name=item.name
        serial=item.deployed_serial clamped_on=item.on expected[s]=time hangs_at[m] seen=- on_deck=-
        condition=- remarks=item.remark
    """,
}
"""Columns of each sheet, each as ``heading=attribute``.

A heading without ``=`` is also the name of the attribute. A column with ``=-`` is filled in by
hand. The first column may have no attribute, as in ``number=``. The items are then pairs of the
value in this column and an object with the other attributes.
"""


_INDEX: dict[str, Callable[[Any], int]] = {
    "parts": lambda one: one[1].index,
    "cutting": attrgetter("item.index"),
    "instruments": lambda one: one[1].item.index,
    "lifts": lambda one: one[1].index,
    "deployment": lambda one: one[1].index,
    "recovery": lambda one: one[1].item.index,
}
"""Functions that return the index of the piece for an entry of a sheet, by name of the sheet.

For a net, these sheets have a last column `leg`.
"""


def _sheet(columns: str, items: Iterable[Any]) -> tuple[Sequence[str], Rows]:
    named = [column.partition("=") for column in columns.split()]
    heads = [head for head, _, _ in named]
    numbered = int(named[0][1:] == ("=", ""))
    shown = [
        attrgetter(attribute or head.partition("[")[0]) if attribute != "-" else lambda _: None
        for head, _, attribute in named[numbered:]
    ]
    if numbered:
        return heads, ([number, *(show(one) for show in shown)] for number, one in items)
    return heads, ([show(one) for show in shown] for one in items)


def deck_report(deck: Deck, page_size: PageSize, notes: tuple[str, ...] = ()) -> Report:
    """Build the printed deck documents of a mooring: diagram, logs, lists and drop plan.

    `notes` are added to the warnings on the first sheet.
    """
    parts: list[ReportPart] = [*provenance.document_part(deck.file)]
    if warnings := warned((*deck.notes, *notes)):
        parts.append(ReportPart("Warnings", warnings))
    if deck.result.several:
        shape = Figure("The net from the side, the current, and from above", net_svg(deck))
        parts.append(ReportPart("The net", (shape, *net_part(deck.result).blocks[1:-1])))
    parts += [
        deck_logs.deployment_part(deck),
        *([deck_lists.instruments_part(deck)] if deck.instruments else []),
        deck_lists.cutting_part(deck),
        *([deck_lists.hardware_part(deck)] if deck.hardware else []),
        deck_lists.shipping_part(deck),
        deck_lists.lifts_part(deck),
        *([drop_part(deck.plan)] if isinstance(deck.plan, DropPlan) else []),
    ]
    parts[-1] = replace(parts[-1], blocks=(*parts[-1].blocks, PageBreak()))
    report = provenance.report_of(
        deck.file.name,
        f"{deck.order}, {environment_text(deck.environment)}",
        *parts,
        deck_logs.recovery_part(deck),
    )
    made_by, *_ = provenance.made_by().split(",")
    return replace(
        report,
        plates=plates(deck, page_size),
        verdict=assessment_verdict(deck.assessment),
        foot=f"{made_by}, inputs SHA-256 {provenance.input_hash([deck.file])}",
    )


def net_svg(deck: Deck) -> str:
    """Draw a net from the side and from above, as SVG."""
    return line_drawing(deck.result)


def diagram_report(deck: Deck, page_size: PageSize) -> Report:
    """Build a report that contains only the mooring diagram."""
    return Report(
        deck.file.name, "mooring diagram", (), (), provenance.date(), plates(deck, page_size)
    )


def plates(deck: Deck, page_size: PageSize) -> tuple[Figure, ...]:
    """Return the pages of the mooring diagram."""
    pages = diagram_pages(deck, page_size)
    return tuple(
        Figure(f"Mooring diagram, {number} of {len(pages)}", svg)
        for number, svg in enumerate(pages, 1)
    )
