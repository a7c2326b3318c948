"""The report of a single solved mooring or tow."""

from __future__ import annotations

from math import isnan

from calm.case import Result
from calm.case.net_result import AnyResult, NetResult
from calm.case.uncertain import Uncertain
from calm.checks.criterion import limits_used
from calm.checks.finding import State
from calm.checks.posture import reaches_the_surface
from calm.drawing.line_picture import water_of
from calm.drawing.picture import figure_svg
from calm.drawing.plot import draw
from calm.files import Uncertainty
from calm.files.uncertainty import Spread
from calm.report.blocks import (
    Block,
    Cell,
    Column,
    Figure,
    Prose,
    Report,
    ReportPart,
    Section,
    Span,
    Table,
    table_of,
)
from calm.report.check_summary import limits_table
from calm.report.net_sheet import leg_title, net_part
from calm.report.provenance import NOT_JUDGED, date, document_part, inputs_part
from calm.report.sheet import quality_of, summary_of, table_of_line, title_of


def result_report(result: AnyResult, uncertain: Uncertain | None = None) -> Report:
    """Schematic, table, drawing and inputs of one result, and how sure its figures are."""
    from calm.drawing.schematic import schematic_svg

    file, water = result.file, water_of(result)
    if isinstance(result, NetResult):
        net = net_part(result)
        title, said = net.title, net.blocks
        line: tuple[Block, ...] = tuple(
            Figure(f"Schematic of leg {leg_title(leg)}", schematic_svg(leg.file, leg), tall=True)
            for leg in result.legs
        )
    else:
        title, said = title_of(result), (*summary_of(result), quality_of(result))
        line = (
            Figure("Schematic", schematic_svg(file, result), tall=True),
            table_of_line(result, "Table of the line", places=True),
        )
    environment = file.environment.name or "own"
    drawing = figure_svg(draw(result, uncertain))
    limits: tuple[ReportPart, ...] = ()
    if isinstance(result, Result):  # a tow and a net have no margins in their tables
        keys = limits_used(result.file, reaches_the_surface(result.mooring))
        limits = (ReportPart("Limits", (limits_table(keys),)),)
    described = (Prose((file.description,)),) if file.description else ()
    parts = (
        *document_part(file),
        ReportPart("Result", (*described, *said)),
        ReportPart("The line", line),
        ReportPart("Shape", (Figure("Elevation, current and plan", drawing),)),
        *(() if uncertain is None else (uncertainty_part(uncertain),)),
        *limits,
        NOT_JUDGED,
        inputs_part([file], [environment], [water]),
    )
    subtitle = title.removeprefix(f"{result.name}: ")
    return Report(result.name, subtitle, (), (Section(result.name, parts),), date())


_ENDS = ("5 %", "50 %", "95 %")


def uncertainty_part(uncertain: Uncertain) -> ReportPart:
    """The line's ends and pieces at 5, 50 and 95 %, and what their spread comes from.

    It fits 80 columns.
    """
    blocks: list[Block] = [_ends(uncertain), _pieces(uncertain)]
    if uncertain.contributions:
        blocks.append(_contributions(uncertain))
    if uncertain.failed:
        each = ", ".join(f"{count} {status}" for status, count in uncertain.failures.items())
        said = f"{uncertain.failed} of {uncertain.samples} samples have no equilibrium ({each})"
        blocks.append(Prose((f"{said}; the figures are of the others.",), State.WARN))
    drawn = drawn_text(uncertain.result.file.uncertainty)
    basis = f"{uncertain.samples} samples, seed {uncertain.seed}; drawn: {drawn}."
    blocks.append(Prose(((Span(basis, quiet=True),),)))
    return ReportPart("Uncertainty of these figures", tuple(blocks))


def drawn_text(uncertainty: Uncertainty) -> str:
    """Return what is drawn, and how far: ``current ±10 %, cable drag −15 to +30 %``."""
    said = []
    for name in type(uncertainty).model_fields:
        spread: Spread = getattr(uncertainty, name)
        unit, scale = ("°", 1.0) if name == "direction" else (" %", 100.0)
        if spread.between is not None:
            low, high = (scale * end for end in spread.between)
            said.append(f"{_words(name)} {low:+.3g} to {high:+.3g}{unit}".replace("-", "−"))
        elif spread.deviation:
            said.append(f"{_words(name)} ±{scale * spread.deviation:.3g}{unit}")
    return ", ".join(said) or "nothing"


def _words(name: str) -> str:
    return name.replace("_", " ")


def _ends(uncertain: Uncertain) -> Table:
    rows = [
        ("depth of the top", "m", uncertain.depth_top[:, 0], 1),
        ("knockdown", "m", uncertain.knockdown[:, 0], 1),
        ("excursion of the top", "m", uncertain.offset[:, 0], 1),
        ("pull on the anchor", "N", uncertain.anchor_tension, 0),
        ("weight needed", "N", uncertain.required_weight, 0),
    ]
    columns = (Column(""), *(Column(end, numeric=True) for end in _ENDS), Column("unit", share=0.0))
    cells = tuple(
        (Cell(name), *(Cell(_figure(value, decimals)) for value in values), Cell(unit))
        for name, unit, values, decimals in rows
    )
    return Table("", columns, cells)


def _pieces(uncertain: Uncertain) -> Table:
    heads = [Column("component")]
    for quantity, unit, ends in (("depth", "m", _ENDS), ("tilt", "°", _ENDS[1:]),
                                 ("tension", "N", _ENDS[1:])):  # fmt: skip
        heads += [Column(f"{quantity}\n{end}", unit, numeric=True) for end in ends]
    rows = []
    held = zip(uncertain.clamped, uncertain.clamps.T, strict=True)
    clamps = [
        (index, f"  {label}", depth, tilt, tension)
        for (index, label), (depth, _, tilt, tension) in held
    ]
    spreads = (uncertain.depth_top.T, uncertain.tilt.T, uncertain.tension.T)
    components = uncertain.result.components
    pieces = zip(components.index, components.label, *spreads, strict=True)
    for _, label, depth, tilt, tension in sorted((*pieces, *clamps), key=lambda row: row[0]):
        figures = [_figure(value, 1) for value in (*depth, *tilt[1:])]
        figures += [_figure(value, 0) for value in tension[1:]]
        rows.append((Cell(label), *map(Cell, figures)))
    return Table("", tuple(heads), tuple(rows))


def _contributions(uncertain: Uncertain) -> Table:
    quantity, unexplained = uncertain.contributions[0].quantity, uncertain.unexplained
    note = f"No single input explains {unexplained:.0%} of the spread: the response is not linear."
    return table_of(
        "",
        uncertain.contributions,
        (Column(f"the spread of the {quantity} comes from"), lambda one: _words(one.cause)),
        (Column("alone", "%", numeric=True), lambda one: _share(one.first)),
        (Column("in all", "%", numeric=True), lambda one: _share(one.total)),
        note=note if unexplained > 0.05 else "",
    )


def _share(share: float) -> str:
    return f"{100.0 * share:.0f}" if share >= 0.005 else "<1"


def _figure(value: float, decimals: int) -> str:
    return "-" if isnan(value) else f"{value:z.{decimals}f}"
