"""The statistics of a batch as a page."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from calm.batch.statistics.extremes import EXTRAPOLATION
from calm.checks.finding import State
from calm.report.batch.figures import exceedance_figure, parts_figure, series_figure
from calm.report.batch.labels import DEFINITIONS, extent, left_out, standing
from calm.report.batch.tables import (
    levels_tables,
    limits_table,
    rules_table,
    statistics_tables,
    worst_tables,
)
from calm.report.blocks import Block, Figure, Listing, Part, Prose, Report, Section
from calm.report.check.verdict import limits_table as limits_used_table
from calm.report.html import page
from calm.report.inputs import UNSEEN
from calm.report.provenance import date, versions

if TYPE_CHECKING:
    from calm.batch.statistics.summary import Summary


def summary_html(summary: Summary) -> str:
    """The page of a summary, which needs no other file and no network."""
    return page(summary_report(summary))


def summary_report(summary: Summary) -> Report:
    """How often limits are broken, drawings, distributions, worst profiles, return levels."""
    moving = [part for part in summary.parts if part.clamped] or list(summary.parts[:-1])
    parts = (
        Part("Result", tuple(_result(summary))),
        Part(
            "Through time", (Figure("Least and greatest in each interval", series_figure(summary)),)
        ),
        Part(
            "How often",
            (
                Figure("Responses of the line", exceedance_figure(summary)),
                Figure("Clamped instruments, or components", parts_figure(moving)),
                *_left_out(summary),
            ),
        ),
        Part("Return levels", (*levels_tables(summary), Prose((_EXTRAPOLATED,)))),
        Part("Worst profiles", tuple(worst_tables(summary))),
        Part(
            "Limits",
            (
                limits_table(summary),
                _not_judged(summary),
                limits_used_table([(summary.name, summary.limits_used)]),
            ),
        ),
        Part("Distributions", (*_left_out(summary), *statistics_tables(summary))),
        Part("What is not judged", (Prose(UNSEEN, State.UNKNOWN),)),
        Part("Inputs", tuple(_inputs(summary))),
    )
    section = Section(summary.name, parts)
    return Report(summary.name, extent(summary), (), (section,), date())


def _result(summary: Summary) -> Iterator[Block]:
    lost = summary.count - summary.solved
    yield Prose((f"{standing(summary)}.",), State.WARN if lost else None)
    yield rules_table(summary)
    yield from _left_out(summary)
    yield Prose(DEFINITIONS)


def _left_out(summary: Summary) -> Iterator[Prose]:
    if summary.unsolved:
        yield Prose((left_out(summary),), State.WARN)


def _not_judged(summary: Summary) -> Prose:
    reasons = (f"Not judged: {name}, {reason}." for name, reason in summary.not_judged.items())
    return Prose(tuple(reasons))


def _inputs(summary: Summary) -> Iterator[Block]:
    for name, text in summary.source.items():
        yield Listing(name.replace("_", " ").capitalize(), text)
    made_by = ", ".join(f"{name} {number}" for name, number in versions())
    yield Prose((f"Gathered with {made_by}",))


_EXTRAPOLATED = (
    f"No level is given for more than {EXTRAPOLATION:.0f} times the length of the record. A level "
    "says how the mooring would answer to currents like those of the record: not to what the "
    "record is too short to hold or lost in its gaps, nor to a current field that changes. A "
    "fitted tail knows no bounds: a tilt beyond 90° or a knockdown below the seabed says that the "
    "record does not reach so far."
)
