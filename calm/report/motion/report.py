"""What was found of a mooring's motion as a report: a page and a PDF."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from calm.checks.finding import State
from calm.report.blocks import Block, Figure, Note, Part, Prose, Report, Section
from calm.report.html import page
from calm.report.motion.brief import PLAIN, factors_table, held_out_table, sensors_table
from calm.report.motion.figures import (
    MOST_PANELS,
    depth_figure,
    factor_figure,
    false_figure,
    residual_figure,
    scatter_figure,
)
from calm.report.pdf import printed
from calm.report.provenance import date

if TYPE_CHECKING:
    from numpy import datetime64
    from numpy.typing import NDArray

    from calm.motion.study import SensorSeries, Study
    from calm.physics.line import Floats

_DEPTHS = "Depths over time"
_FALSE = "Times at which a current is more likely false than not"
_LEGEND = (
    "Black: measured. Blue: estimated, with its band of 95 %. Orange: by the currents alone. A "
    "hidden sensor was not used."
)
_NOTHING = "Nothing in the residuals is clearly a drift, a slipped clamp or a wrong length."


def motion_files(
    study: Study,
    series: Sequence[SensorSeries],
    time: NDArray[datetime64],
    factor: Floats,
    name: str,
    notes: Sequence[str],
) -> dict[str, bytes]:
    """The files of the report, by name: ``motion.html`` and ``motion.pdf``.

    Parameters
    ----------
    series : of the sensors
    time, factor : (n,) the factor on the current over time
    notes : what was said of the input
    """
    report = motion_report(study, series, time, factor, name, notes)
    return {"motion.html": page(report).encode(), "motion.pdf": printed(report)}


def motion_report(
    study: Study,
    series: Sequence[SensorSeries],
    time: NDArray[datetime64],
    factor: Floats,
    name: str,
    notes: Sequence[str],
) -> Report:
    """Factors, agreement, what to doubt, depths, scatter and residuals."""
    shown = sorted(series, key=lambda one: not one.hidden)[:MOST_PANELS]
    shown = [one for one in series if any(one is each for each in shown)]
    doubts = Prose(study.remarks, State.WARN) if study.remarks else Prose((_NOTHING,))
    marks = (Figure(_FALSE, false_figure(time, study.false)),) if study.false else ()
    held: tuple[Block, ...] = (held_out_table(study.held_out),) if study.held_out else ()
    factors = factors_table(study.factors, study.task.common.datum)
    parts = (
        Part("What to doubt", (doubts, *marks)),
        Part("Factors", (factors, Figure("Over time", factor_figure(time, factor)))),
        Part("Measured against computed", (sensors_table(study), *held, Note((PLAIN,)))),
        Part("Inputs", (Prose(tuple(notes) or ("Nothing was left out.",)),)),
        Part("Depths", (Figure(_DEPTHS, depth_figure(shown), tall=True), Note((_LEGEND,)))),
        Part("Scatter", (Figure("Computed against measured depths", scatter_figure(shown)),)),
        Part("Residuals", (Figure("Measured less estimated", residual_figure(shown), tall=True),)),
    )
    span = f"{str(time[0])[:16]} to {str(time[-1])[:16]}, {len(time)} times"
    return Report(f"{name}: where it was", span, (), (Section(name, parts),), date())
