"""The cables that fit three quantities in a uniform current, as a table and as a document."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from calm.report.blocks import Cell, Column, Note, ReportPart, Table

if TYPE_CHECKING:
    from calm.analytic.chart import ChartAnswer, ChartSolution

_ROWS = (
    ("phi_a", "angle at A", "°", 3),
    ("phi_b", "angle at B", "°", 3),
    ("tension_a", "tension at A", "N", 2),
    ("tension_b", "tension at B", "N", 2),
    ("height", "height H", "m", 3),
    ("distance", "distance D", "m", 3),
    ("length", "length L", "m", 3),
    ("h0", "H₀ of the chart", "m", 3),
)
_NOTE = "A lower end, B upper end; D positive when B is downstream of A; angles to the current."


def answer_document(answer: ChartAnswer) -> dict[str, Any]:
    """The JSON object: `status`, `k`, `solutions` (SI, degrees); without any, the reason too."""
    document: dict[str, Any] = {
        "status": answer.status,
        "k": answer.k,
        "solutions": [_figures(solution) for solution in answer.solutions],
    }
    if not answer.solutions:
        document |= {"message": answer.message, "advice": answer.advice}
    return document


def answer_part(answer: ChartAnswer) -> ReportPart:
    """A column for each cable."""
    figures = [_figures(solution) for solution in answer.solutions]
    several = len(figures) > 1
    columns = (
        Column(""),
        Column("", share=0.0),
        *(
            Column(str(number) if several else "", numeric=True)
            for number, _ in enumerate(figures, start=1)
        ),
    )
    rows = tuple(
        (Cell(heading), Cell(unit), *(Cell(f"{cable[name]:z.{decimals}f}") for cable in figures))
        for name, heading, unit, decimals in _ROWS
    )
    notes = [_NOTE]
    if several:
        notes.append("Each of these cables fits what is given.")
    if any(min(cable["phi_a"], cable["phi_b"]) < 0.0 for cable in figures):
        notes.append("A negative angle: the cable goes down there, beyond the level of that end.")
    title = f"Uniform current, K = {answer.k:.6g}"
    return ReportPart(title, (Table("", columns, rows), Note(tuple(notes))))


def _figures(solution: ChartSolution) -> dict[str, float]:
    """The figures in SI and degrees."""
    return {
        name: math.degrees(value) if name.startswith("phi") else value
        for name, value in vars(solution).items()
    }
