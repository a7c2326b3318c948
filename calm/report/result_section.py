"""The report of a single solved mooring or tow."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from calm.case import TowResult
from calm.checks.criterion import limits_used
from calm.checks.posture import reaches_the_surface
from calm.drawing.picture import figure_svg
from calm.drawing.plot import draw
from calm.report.blocks import Figure, Prose, Report, ReportPart, Section
from calm.report.check_summary import limits_table
from calm.report.provenance import (
    NOT_JUDGED,
    date,
    document_part,
    inputs_part,
)
from calm.report.sheet import sheet
from calm.report.uncertainty import uncertainty_part

if TYPE_CHECKING:
    from calm.case import Result
    from calm.case.uncertain import Uncertain


def result_report(result: Result | TowResult, uncertain: Uncertain | None = None) -> Report:
    """Schematic, table, drawing and inputs of one result, and how sure its figures are."""
    from calm.drawing.schematic import schematic_svg

    said, file = sheet(result, places=True), result.file
    water = result.tow.water if isinstance(result, TowResult) else result.mooring.water
    environment = file.environment.name or "own"
    drawing = figure_svg(draw(result, uncertain))
    described = (Prose((file.description,)),) if file.description else ()
    parts = (
        *document_part(file),
        ReportPart("Result", (*described, *said.summary, Prose((said.convergence,)))),
        ReportPart("The line", (Figure("Schematic", schematic_svg(file, result), tall=True),
                          replace(said.table, title="Table of the line"))),
        ReportPart("Shape", (Figure("Elevation, current and plan", drawing),)),
        *(() if uncertain is None else (uncertainty_part(uncertain),)),
        *_limits(result),
        NOT_JUDGED,
        inputs_part([file], [environment], [water]),
    )  # fmt: skip
    subtitle = said.title.removeprefix(f"{result.name}: ")
    return Report(result.name, subtitle, (), (Section(result.name, parts),), date())


def _limits(result: Result | TowResult) -> tuple[ReportPart, ...]:
    """The limits of the margins in a mooring's table; a tow has none."""
    if isinstance(result, TowResult):
        return ()
    keys = limits_used(result.file, reaches_the_surface(result.mooring))
    return (ReportPart("Limits", (limits_table([(result.name, keys)]),)),)
