"""What waves do to a mooring, as a person reads it."""

from __future__ import annotations

from math import isnan

from calm.checks.finding import State
from calm.quantities import QUANTITIES, say
from calm.report.blocks import Block, Cell, Column, Prose, ReportPart, Span, Table
from calm.waves.analysis import SLACK, MooringInSea, WaveAnalysis

_NOTE = (
    "Tension at the upper end: mean, standard deviation, most probable greatest and least. "
    "Tz: between upward crossings of the mean. Heave and tilt: standard deviations. "
    "! the piece falls slack."
)


def sea_response_part(analysis: WaveAnalysis) -> ReportPart:
    """Return the pieces in the sea, or in the highest of several seas with a line of each."""
    states = analysis.states
    highest = max(states, key=lambda state: state.sea.significant_height)
    blocks: list[Block] = []
    if len(states) > 1:
        blocks.append(_seas(analysis))
    blocks += [_pieces(highest), Prose(tuple(_told(analysis, highest)))]
    if analysis.warnings:
        blocks.append(Prose(analysis.warnings, State.WARN))
    if analysis.status == SLACK:
        said = f"Slack: {', '.join(highest.slack)}. Linear tensions do not hold there."
        blocks.append(Prose((said,), State.FAIL))
    sea = highest.sea
    title = f"{analysis.name}: Hs {sea.significant_height:.1f} m, Tp {sea.peak_period:.1f} s"
    return ReportPart(title, tuple(blocks))


def _pieces(state: MooringInSea) -> Table:
    tension, unit = QUANTITIES["tension"], QUANTITIES["tension"].display_unit
    columns = (
        Column(""),
        *(Column(f"{name}\n{unit}", numeric=True) for name in ("mean", "std", "max", "min")),
        Column("Tz\ns", numeric=True),
        Column("slack\n%", numeric=True),
        Column("heave\nm", numeric=True),
        Column("tilt\n°", numeric=True),
    )
    rows = []
    for one in state.components:
        figures = (one.tension_mean, one.tension_std, one.tension_max, one.tension_min)
        mark = "!" if one.label in state.slack else ""
        period = one.zero_crossing_period
        rows.append(
            tuple(
                Cell(text)
                for text in (
                    f"{mark}{one.label}",
                    *(tension.format(figure) for figure in figures),
                    "-" if isnan(period) else f"{period:.1f}",
                    f"{100.0 * one.slack_probability:.2g}",
                    f"{one.heave_std:.2f}",
                    f"{one.tilt_std:.1f}",
                )
            )
        )
    return Table("", columns, tuple(rows), note=_NOTE)


def _seas(analysis: WaveAnalysis) -> Table:
    columns = (
        Column("Hs\nm", numeric=True),
        Column("Tp\ns", numeric=True),
        Column("share\n%", numeric=True),
        Column("std at the top\nN", numeric=True),
        Column("greatest there\nN", numeric=True),
        Column("slack"),
    )
    rows = tuple(
        (
            Cell(f"{state.sea.significant_height:.1f}"),
            Cell(f"{state.sea.peak_period:.1f}"),
            Cell(f"{100.0 * state.sea.share:.2g}"),
            Cell(f"{state.components[0].tension_std:.0f}"),
            Cell(f"{state.components[0].tension_max:.0f}"),
            Cell(", ".join(state.slack) or "-"),
        )
        for state in analysis.states
    )
    return Table("", columns, rows)


def _told(analysis: WaveAnalysis, state: MooringInSea) -> list[str | tuple[Span, ...]]:
    said: list[str | tuple[Span, ...]] = []
    if state.follower_std is not None:
        said.append(
            "Below a float that followed every wave the tension would deviate by "
            f"{say('tension', state.follower_std)}."
        )
    one = analysis.accuracy
    good = (
        f"Twice the elements change deviations by {one.mesh:.1%}, twice the frequencies by "
        f"{one.frequencies:.1%}; a fifth less drag by {one.linearisation:.0%}."
    ).replace("%", " %")
    return [*said, (Span(good, quiet=True),)]
