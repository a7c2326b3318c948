"""Report on one solved mooring or tow."""

from collections.abc import Iterable, Iterator
from functools import partial
from typing import Any

from calm.case import Result
from calm.case.design import AnyResult
from calm.case.uncertain import Uncertain
from calm.checks.criterion import limits_used
from calm.checks.finding import DEFAULT_ENVIRONMENT
from calm.checks.posture import reaches_the_surface
from calm.drawing.line_drawing import line_drawing
from calm.drawing.schematic import schematic_sheets
from calm.files import MooringFile, Uncertainty
from calm.files.uncertainty import Spread
from calm.quantities import QUANTITIES
from calm.report import blocks
from calm.report.blocks import Block, Field, Figure, ReportPart, Table, number, table_of, words
from calm.report.check_tables import limits_table
from calm.report.provenance import NOT_JUDGED, document_part, inputs_part, report_of
from calm.report.sheet import (
    accuracy_text,
    leg_title,
    net_part,
    summary_of,
    table_of_line,
    title_of,
)


def result_report(result: Result, uncertain: Uncertain | None = None) -> blocks.Report:
    """Build the report on one result: schematic, table, drawing, inputs and uncertainty."""
    file = result.file
    limits: tuple[ReportPart, ...] = ()
    if result.several:
        net = net_part(result, verbose=False)
        title, summary = net.title, net.blocks
        table: tuple[Block, ...] = ()
        schematics = tuple(
            sheet
            for leg in result.legs
            for sheet in _schematics(f"Schematic of leg {leg_title(leg)}", leg.file, leg)
        )
    else:
        title, summary = title_of(result.leg), summary_of(result.leg)
        table = (table_of_line(result, "Table of the line", places=True),)
        schematics = _schematics("Schematic", file, result)
    if not (result.several or result.towed):  # tables of nets and tows have no margins
        keys = limits_used(result.file, reaches_the_surface(result.leg.leg))
        limits = (ReportPart("Limits", (limits_table(keys),)),)
    described = (blocks.Prose((file.description,)),) if file.description else ()
    drawing = line_drawing(result, uncertain)
    return report_of(
        result.name,
        title.removeprefix(f"{result.name}: "),
        *document_part(file),
        ReportPart("Result", (*described, *summary, blocks.Note((accuracy_text(result.legs),)))),
        *([ReportPart("The line", table)] if table else []),
        ReportPart("Shape", (Figure("Elevation, current and plan", drawing),)),
        ReportPart("", schematics),
        *(() if uncertain is None else (uncertainty_part(uncertain),)),
        *limits,
        NOT_JUDGED,
        inputs_part([(file.environment.name or DEFAULT_ENVIRONMENT, file, result.water)]),
    )


def _schematics(title: str, file: MooringFile, result: AnyResult) -> tuple[Figure, ...]:
    sheets = schematic_sheets(file, result)
    return tuple(
        Figure(title if len(sheets) == 1 else f"{title}, {at} of {len(sheets)}", sheet, tall=True)
        for at, sheet in enumerate(sheets, 1)
    )


_ENDS = ("5 %", "50 %", "95 %")


def uncertainty_part(uncertain: Uncertain) -> ReportPart:
    """Report the uncertainty of a result, within 80 columns.

    The report gives the 5th, 50th and 95th percentiles of values at the ends of the line and on
    each piece. A table shows how much each uncertain input contributes to the spread.
    """
    each = ", ".join(f"{count} {status}" for status, count in uncertain.failures.items())
    failures = f"{uncertain.failed} of {uncertain.samples} samples have no equilibrium ({each})"
    drawn = drawn_text(uncertain.result.file.uncertainty)
    shown: tuple[Block, ...] = (
        _ends_table(uncertain),
        _pieces_table(uncertain),
        *([_contributions_table(uncertain)] if uncertain.contributions else []),
        *blocks.warned(
            [(f"{failures}; the values refer to the other samples.")] if uncertain.failed else []
        ),
        blocks.quiet(f"{uncertain.samples} samples, seed {uncertain.seed}; varied: {drawn}."),
    )
    return ReportPart("Uncertainty of these values", shown)


def drawn_text(uncertainty: Uncertainty) -> str:
    """Describe the uncertain inputs and their spread.

    An example is ``current ±10 %, cable drag −15 to +30 %``.
    """
    texts = []
    for name in type(uncertainty).model_fields:
        spread: Spread = getattr(uncertainty, name)
        unit, scale = ("°", 1.0) if name == "direction" else (" %", 100.0)
        if spread.between is not None:
            low, high = (scale * end for end in spread.between)
            texts.append(f"{_words(name)} {low:+.3g} to {high:+.3g}{unit}".replace("-", "−"))
        elif spread.deviation:
            texts.append(f"{_words(name)} ±{scale * spread.deviation:.3g}{unit}")
    return ", ".join(texts) or "nothing"


def _words(name: str) -> str:
    return name.replace("_", " ")


def _ends_table(uncertain: Uncertain) -> Table:
    rows = [
        ("depth of the top", QUANTITIES["depth"], uncertain.depth_top[:, 0]),
        ("knockdown", QUANTITIES["knockdown"], uncertain.knockdown[:, 0]),
        ("excursion of the top", QUANTITIES["offset"], uncertain.offset[:, 0]),
        ("anchor load", QUANTITIES["tension"], uncertain.anchor_tension),
        ("anchor weight required", QUANTITIES["required_weight"], uncertain.required_weight),
    ]
    return table_of(
        "",
        [(name, of.display_unit, *map(of.format, values)) for name, of, values in rows],
        words("", 0),
        *(number(end, at) for at, end in enumerate(_ENDS, 2)),
        words("unit", 1, 0.0),
    )


def _pieces_table(uncertain: Uncertain) -> Table:
    components = uncertain.result.components
    spreads = uncertain.depth_top.T, uncertain.tilt.T, uncertain.tension.T
    rows = [*zip(components.index, components.label, *spreads, strict=True)]
    for (index, label), (depth, _, tilt, tension) in zip(
        uncertain.clamped, uncertain.clamps.T, strict=True
    ):
        rows.append((index, f"  {label}", depth, tilt, tension))
    rows.sort(key=lambda row: row[0])

    def figures(at: int, name: str, ends: Iterable[int]) -> Iterator[Field]:
        shown = QUANTITIES[name]
        for end in ends:
            text = partial(lambda end, row: shown.format(row[at][end]), end)
            yield number(f"{name}\n{_ENDS[end]}", text, shown.display_unit)

    spread = (
        *figures(2, "depth", range(3)),
        *figures(3, "tilt", (1, 2)),
        *figures(4, "tension", (1, 2)),
    )
    return table_of("", rows, words("component", 1), *spread)


def _contributions_table(uncertain: Uncertain) -> Table:
    cause, unexplained = uncertain.contributions[0].quantity, uncertain.unexplained
    note = (
        f"{unexplained:.0%} of the spread cannot be attributed to inputs: the response is not "
        "linear."
    )

    def share(heading: str, name: str) -> Field:
        def text(one: Any) -> str:
            share = getattr(one, name)
            return f"{100.0 * share:.0f}" if share >= 0.005 else "<1"

        return number(heading, text, "%")

    return table_of(
        "",
        uncertain.contributions,
        words(f"sources of the spread of the {cause}", lambda one: _words(one.cause)),
        share("alone", "first"),
        share("in all", "total"),
        note=note if unexplained > 0.05 else "",
    )
