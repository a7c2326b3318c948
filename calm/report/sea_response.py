"""What waves do to a mooring, as a person reads it."""

from __future__ import annotations

from math import isnan

from calm.checks.finding import State
from calm.drawing.picture import figure_svg
from calm.quantities import QUANTITIES, say
from calm.records.sea_states import doubted
from calm.report.blocks import (
    Block,
    Column,
    Field,
    Figure,
    Prose,
    Report,
    ReportPart,
    Section,
    Span,
    Table,
    table_of,
)
from calm.report.provenance import date
from calm.waves.analysis import SLACK, MooringInSea, PieceInWaves, WaveAnalysis
from calm.waves.fatigue import PieceFatigue

_NOTE = (
    "Tension at the upper end: mean, standard deviation, most probable greatest and least. "
    "Tz: mean time between upward crossings of the mean. Heave and tilt: standard deviations. "
    "!: the piece goes slack."
)
_LIFE = (
    "Life: years until the damage is 1 in these seas; low and high, with standard deviations of "
    "tension 15 % greater and smaller. Curves are quoted from secondary sources: compare them "
    "with the standard."
)


def sea_response_report(analysis: WaveAnalysis) -> Report:
    """Return the tables with pictures of the tension: spectrum, along the line, over Hs."""
    said = "Tension in the highest sea: its spectrum at the top; along the line"
    if several := len(analysis.states) > 1:
        said += ". Tension at the top over Hs"
    pictures = ReportPart("Tension", (Figure(said, _drawn(analysis, several)),))
    section = Section(analysis.name, (sea_response_part(analysis), pictures))
    return Report(analysis.name, "in waves", (), (section,), date())


def sea_response_part(analysis: WaveAnalysis) -> ReportPart:
    """Return the pieces in the sea, or in the highest of several seas with a line of each."""
    states, highest = analysis.states, _highest(analysis)
    title = f"Hs {highest.sea.significant_height:.1f} m, Tp {highest.sea.peak_period:.1f} s"
    told, several = Prose(tuple(_told(analysis, highest))), len(states) > 1
    blocks: list[Block] = [
        _pieces(highest, f"In the highest sea, {title}" if several else ""),
        told,
    ]
    if several:
        blocks.insert(0, table_of("", states, *_SEAS))
        title = f"{len(states)} seas"
        known = [each for each in analysis.fatigue if each.life]
        blocks.append(table_of("Fatigue over all seas", known, *_LIVES, note=_LIFE))
        unknown = [each.label for each in analysis.fatigue if each.unknown]
        if unknown:
            blocks.append(Prose((f"Life unknown: {', '.join(unknown)}.",)))
    doubts = [doubt for each in states if (doubt := doubted(each.sea)) is not None]
    if said := (*analysis.warnings, *doubts[:1]):
        blocks.append(Prose(said, State.WARN))
    if analysis.status == SLACK:
        slack = ", ".join(dict.fromkeys(label for each in states for label in each.slack))
        blocks.append(Prose((f"Slack: {slack}. Linear tensions are not valid there.",), State.FAIL))
    return ReportPart(f"{analysis.name}: {title}", tuple(blocks))


def _highest(analysis: WaveAnalysis) -> MooringInSea:
    return max(analysis.states, key=lambda state: state.sea.significant_height)


def _number(heading: str) -> Column:
    return Column(heading, numeric=True)


_LIVES: tuple[Field[PieceFatigue], ...] = (
    (Column(""), lambda one: one.label),
    (_number("life\nyears"), lambda one: _years(one.life)),
    (_number("low\nyears"), lambda one: _years(one.life_low)),
    (_number("high\nyears"), lambda one: _years(one.life_high)),
    (Column("curve"), lambda one: one.curve or ""),
)


def _years(count: float | None) -> str:
    if count is None or count > 1000.0:
        return "-" if count is None else "> 1000"
    return f"{float(f'{count:.2g}'):g}"


def _pieces(state: MooringInSea, title: str) -> Table:
    tension, unit = QUANTITIES["tension"], QUANTITIES["tension"].display_unit

    def named(one: PieceInWaves) -> str:
        return f"{'!' if one.label in state.slack else ''}{one.label}"

    fields: tuple[Field[PieceInWaves], ...] = (
        (Column(""), named),
        (_number(f"mean\n{unit}"), lambda one: tension.format(one.tension_mean)),
        (_number(f"std\n{unit}"), lambda one: tension.format(one.tension_std)),
        (_number(f"max\n{unit}"), lambda one: tension.format(one.tension_max)),
        (_number(f"min\n{unit}"), lambda one: tension.format(one.tension_min)),
        (
            _number("Tz\ns"),
            lambda one: "-" if isnan(period := one.zero_crossing_period) else f"{period:.1f}",
        ),
        (_number("slack\n%"), lambda one: _percent(one.slack_probability)),
        (_number("heave\nm"), lambda one: f"{one.heave_std:.2f}"),
        (_number("tilt\n°"), lambda one: f"{one.tilt_std:.1f}"),
    )
    return table_of(title, state.components, *fields, note=_NOTE)


def _percent(share: float) -> str:
    return f"{round(100.0 * share, 2):.3g}"


_SEAS: tuple[Field[MooringInSea], ...] = (
    (_number("Hs\nm"), lambda state: f"{state.sea.significant_height:.1f}"),
    (_number("Tp\ns"), lambda state: f"{state.sea.peak_period:.1f}"),
    (_number("share\n%"), lambda state: _percent(state.sea.share)),
    (_number("std at the top\nN"), lambda state: f"{state.components[0].tension_std:.0f}"),
    (_number("max at the top\nN"), lambda state: f"{state.components[0].tension_max:.0f}"),
    (Column("slack"), lambda state: ", ".join(state.slack) or "-"),
)


def _told(analysis: WaveAnalysis, state: MooringInSea) -> list[str | tuple[Span, ...]]:
    said: list[str | tuple[Span, ...]] = []
    top = state.components[0].tension_std
    if state.follower_std is not None and abs(state.follower_std - top) > 1e-3 * top:
        said.append(
            "If the float followed every wave, the standard deviation of tension below it would "
            f"be {say('tension', state.follower_std)}."
        )
    if state.pitch_std is not None:
        said.append(f"The float pitches by {state.pitch_std:.1f}° (standard deviation).")
    elif analysis.pitch_unknown is not None:
        said.append(f"The pitch of the float is not computed: {analysis.pitch_unknown}.")
    one = analysis.accuracy
    good = (
        f"Standard deviations change by {one.mesh:.1%} with twice the elements, by "
        f"{one.frequencies:.1%} with twice the frequencies, by {one.linearisation:.0%} with a "
        "fifth less drag."
    ).replace("%", " %")
    return [*said, (Span(good, quiet=True),)]


def _drawn(analysis: WaveAnalysis, several: bool) -> str:
    from matplotlib import figure as drawing

    state = _highest(analysis)
    figure = drawing.Figure(figsize=(7.4, 3.2), layout="constrained")
    left, right, *over = figure.subplots(1, 3 if several else 2)
    omega, density = state.spectrum
    left.plot(omega, 1e-6 * density, color="#0b3c5d")
    left.set(xlabel="frequency [rad/s]", ylabel="spectrum of tension [kN² s/rad]", xscale="log")
    ticks = [at for at in (0.2, 0.5, 1.0, 2.0, 5.0) if omega[0] < at < omega[-1]]
    left.set_xticks(ticks, [f"{at:g}" for at in ticks])
    left.minorticks_off()
    depth, *tensions = state.along
    for values, name, dash in zip(tensions, ("mean", "std", "max"), ("-", ":", "--"), strict=True):
        right.plot(values, depth, dash, color="#0b3c5d", label=name)
    right.set(xlabel="tension [N]", ylabel="depth [m]")
    right.invert_yaxis()
    right.legend(frameon=False)
    for axes in over:
        heights = [each.sea.significant_height for each in analysis.states]
        tops = [each.components[0] for each in analysis.states]
        axes.plot(heights, [each.tension_std for each in tops], "+", color="#0b3c5d", label="std")
        axes.plot(heights, [each.tension_max for each in tops], ".", color="#0b3c5d", label="max")
        axes.set(xlabel="Hs [m]", ylabel="tension at the top [N]", ylim=(0.0, None))
        axes.legend(frameon=False)
    return figure_svg(figure)
