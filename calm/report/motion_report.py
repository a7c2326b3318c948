"""What was found of a mooring's motion: tables, JSON, and a page and a PDF with its drawings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.checks.finding import State
from calm.drawing.picture import figure_svg
from calm.motion.remarks import no_drag
from calm.motion.study import knockdown
from calm.report.blocks import (
    Block,
    Column,
    Figure,
    Heading,
    Note,
    Prose,
    Report,
    ReportPart,
    Section,
    Table,
    table_of,
)
from calm.report.provenance import date
from calm.report.result_files import members

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy import datetime64
    from numpy.typing import NDArray

    from calm.motion.remarks import Agreement, Fault
    from calm.motion.study import HeldOut, SensorSeries, Study


_BARE, _DEPTHS = "Instruments without a pressure", "Depths over time"
_FALSE = "Times when a current is probably wrong"
_LEGEND = (
    "Black: measured. Blue: estimated, with its 95 % band. Orange: from the currents "
    "alone. Hidden sensors were not used."
)
_WHOLE = "Depths of all instruments, with 95 % bands; hidden ones and those without pressure dashed"
_ASSUMED = (
    "Assumed beforehand: floats, weights, lengths and places as in the mooring file; the drag of "
    "every part to 15 %, the datum to 1 % of the water depth, each sensor to 1 m."
)
_NOTHING = "Nothing is clearly wrong: no clock, gain, offset, drift, slipped clamp or label."


def motion_report(
    study: Study,
    series: Sequence[SensorSeries],
    time: NDArray[datetime64],
    name: str,
    notes: Sequence[str],
) -> Report:
    """Return the report: one page of the whole deployment, and the details.

    Parameters
    ----------
    series : of the sensors
    time : (n,)
    notes : what was said of the input
    """
    bare = [one for one in series if not np.isfinite(one.measured).any()]
    bare = sorted(bare, key=lambda one: -float(np.nan_to_num(one.spread).mean()))
    bare = sorted(bare[:MOST_PANELS], key=lambda one: float(np.nan_to_num(one.estimated).mean()))
    sensors = [one for one in series if np.isfinite(one.measured).any()]
    hidden_first = sorted(sensors, key=lambda one: not one.hidden)[:MOST_PANELS]
    shown = [one for one in sensors if any(one is each for each in hidden_first)]
    doubts = Prose(study.remarks, State.WARN) if study.remarks else Prose((_NOTHING,))
    marks = (Figure(_FALSE, false_figure(time, study.false)),) if study.false else ()
    whole = Figure(_WHOLE, overview_figure([*sensors, *bare]))
    depths = [Figure(_BARE, depth_figure(bare), tall=True)] if bare else []
    depths.append(Figure(_DEPTHS, depth_figure(shown), tall=True))
    factors = factors_table(study.factors, study.task.common.datum)
    held = [held_out_table(study.held_out)] if study.held_out else []
    how = Note((PLAIN if study.plain else UNKNOWN,))
    parts = (
        ReportPart("The deployment", (whole, *judged_prose(study), doubts, health_table(study))),
        ReportPart("For the methods of a cruise report", (Prose(methods_text(study, series)),)),
        ReportPart("Factors", (factors, Note((_ASSUMED,)))),
        ReportPart("Measured against computed", (sensors_table(study), *held, how, *marks)),
        ReportPart("Inputs", (Prose(tuple(notes) or ("Nothing was left out.",)),)),
        ReportPart("Depths", (*depths, Note((_LEGEND,)))),
    )
    span = f"{str(time[0])[:16]} to {str(time[-1])[:16]}, {len(time)} times"
    return Report(f"{name}: where it was", span, (), (Section(name, parts),), date())


MOST_PANELS = 12
"""Sensors that are drawn; of more, those that are hidden come first."""


def methods_text(study: Study, series: Sequence[SensorSeries]) -> tuple[str, ...]:
    """Return sentences to paste into the methods of a cruise report."""
    from calm.version import __version__

    used, common, time = study.task.measured, study.task.common, series[0].time
    levels = used.u.shape[1]
    by = f"the currents at {levels} levels" if study.plain else "no measured current"
    down = knockdown(used)
    down = down[np.isfinite(down)]
    wide = np.concatenate([one.spread[np.isfinite(one.spread)] for one in series])
    factors = "; ".join(
        f"{TITLES[key]} {value:.2f} times that assumed (95 %: {low:.2f} to {high:.2f})"
        for key, (value, low, high) in study.factors.items()
    )
    said = [
        f"The depths of {len(series)} instruments between {str(time[0])[:16]} and "
        f"{str(time[-1])[:16]} ({len(time)} times) were estimated from the static equilibrium of "
        f"the line, the pressures of {', '.join(used.label)}, and {by} (CALM {__version__}).",
        f"Estimated for the whole record: {factors}; a datum common to all pressures of "
        f"{common.datum:+.1f} m.",
        f"The uppermost pressure was up to {down.max():.0f} m below its least depth (median "
        f"{np.median(down):.0f} m, 95th percentile {np.quantile(down, 0.95):.0f} m). The standard "
        f"deviation of the depths is {np.median(wide):.1f} m in the median and "
        f"{np.quantile(wide, 0.95):.1f} m in the 95th percentile.",
    ]
    for one in study.held_out:
        said.append(
            f"Hidden from the estimate, {one.label} was found with an rms of {one.rms:.1f} m "
            f"(interpolated: {one.linear_rms:.1f} m)."
        )
    return (*said, *(f"{one.sentence()}." for one in study.diagnosis if one.corrected))


TITLES = {
    "cable_drag": "drag of cables and chains",
    "rigid_drag": "drag of floats and instruments",
    "buoyancy": "net force of the floats",
    "length": "length of cables and chains",
}

_RMS = "rms: of the difference, less its mean in calm times, the tenth with the least knockdown."
PLAIN = (
    "Alone: computed from the currents, with nothing fitted. Estimated: with the pressures of all "
    f"sensors in use. {_RMS}"
)
UNKNOWN = f"The currents are not known: they are inferred from these pressures. {_RMS}"


def motion_part(study: Study, name: str) -> ReportPart:
    """Factors, sensors, sensors that were hidden, and what to doubt."""
    blocks: list[Block] = [
        Heading(name),
        factors_table(study.factors, study.task.common.datum),
        sensors_table(study),
        Prose((PLAIN if study.plain else UNKNOWN,)),
    ]
    if study.held_out:
        blocks.append(held_out_table(study.held_out))
    blocks += judged_prose(study)
    if study.remarks:
        blocks.append(Prose(study.remarks, State.WARN))
    return ReportPart("", tuple(blocks))


def judged_prose(study: Study) -> list[Block]:
    """Return what is said of the sensor that was judged, if one was."""
    one = study.judged
    if one is None:
        return []
    state = {True: State.PASS, False: State.FAIL, None: State.UNKNOWN}[one.fits]
    return [Prose((one.sentence(),), state)]


_HEALTH: Mapping[str, Column] = {
    "clock": Column("clock late", "h", numeric=True),
    "gain": Column("gain", numeric=True),
    "offset": Column("offset", "m", numeric=True),
    "drift": Column("drift", "m", numeric=True),
    "slip": Column("slipped", "m", numeric=True),
    "exchanged": Column("exchanged with"),
}


def health_table(study: Study) -> Table:
    """Return what is wrong with each sensor: a dash where nothing is."""
    found: dict[str, dict[str, str]] = {label: {} for label in study.fit}
    for one in study.diagnosis:
        text = one.other or format(one.value, ".3f" if one.kind == "gain" else "+.2f")
        found.setdefault(one.label, {})[one.kind] = text + ("" if one.certain else " ?")
    return table_of(
        "",
        found.items(),
        (Column("sensor"), lambda one: one[0]),
        *(
            (column, lambda one, kind=kind: one[1].get(kind, "-"))
            for kind, column in _HEALTH.items()
        ),
        note="A question mark: another cause is nearly as likely; see above.",
    )


def diagnosis_document(diagnosis: Sequence[Fault]) -> list[dict[str, Any]]:
    """What is wrong with sensors: clocks in seconds, gains as factors, all else in metres."""
    said = []
    for one in diagnosis:
        unit = 3600.0 if one.kind == "clock" else 1.0
        row: dict[str, Any] = {"label": one.label, "kind": one.kind}
        for key in ("value", "low", "high"):
            row[key] = None if one.other else unit * getattr(one, key)
        row |= {"odds": one.odds, "corrected": one.corrected}
        row |= {"with": one.other} if one.other else {}
        row |= {
            key: str(getattr(one, key))[:19]
            for key in ("since", "until")
            if not np.isnat(getattr(one, key))
        }
        said.append(row)
    return said


def factors_table(factors: Mapping[str, tuple[float, float, float]], datum: float) -> Table:
    """The common factors with their intervals."""

    def title(one: tuple[str, tuple[float, float, float]]) -> str:
        name, (value, *_) = one
        return TITLES[name] + (": not drag, see below" if no_drag(name, value) else "")

    return table_of(
        "",
        factors.items(),
        (Column("factor for the whole record"), title),
        (Column("value", numeric=True), lambda one: f"{one[1][0]:.3f}"),
        (Column("95 % interval", numeric=True), lambda one: f"{one[1][1]:.3f}–{one[1][2]:.3f}"),
        note=f"All depths are shifted by {datum:+.1f} m, the datum common to all pressures.",
    )


def sensors_table(study: Study) -> Table:
    """Return how sensors in use agree with the currents alone, and with what is estimated."""
    alone = (
        (Column("alone: bias", "m", numeric=True), lambda one: _said(one[1].bias)),
        (Column("rms", "m", numeric=True), lambda one: _said(one[1].rms)),
        (Column("r", numeric=True), lambda one: _said(one[1].r, 3)),
        (Column("slope", numeric=True), lambda one: _said(one[1].slope, 3)),
    )
    return table_of(
        "",
        (study.plain or study.fit).items(),
        (Column("sensor"), lambda one: one[0]),
        (Column("times", numeric=True), lambda one: str(one[1].count)),
        *(alone if study.plain else ()),
        (Column("estimated: rms", "m", numeric=True), lambda one: _said(study.fit[one[0]].rms)),
    )


def held_out_table(held_out: Sequence[HeldOut]) -> Table:
    """Return how well the depths of hidden sensors were estimated."""
    return table_of(
        "",
        held_out,
        (Column("hidden sensor"), lambda one: one.label),
        (Column("times", numeric=True), lambda one: str(one.count)),
        (Column("bias", "m", numeric=True), lambda one: _said(one.bias)),
        (Column("rms", "m", numeric=True), lambda one: _said(one.rms)),
        (Column("interpolated: rms", "m", numeric=True), lambda one: _said(one.linear_rms)),
        (Column("PCHIP: rms", "m", numeric=True), lambda one: _said(one.pchip_rms)),
        (Column("within 95 % band", "%", numeric=True), lambda one: _said(100.0 * one.coverage, 0)),
    )


def _said(value: float, decimals: int = 2) -> str:
    return f"{value:.{decimals}f}" if isfinite(value) else "-"


def motion_document(study: Study, name: str) -> dict[str, Any]:
    """The JSON object: factors with their intervals of 95 %, and how well depths agree [m].

    `sensors` has for each sensor that was used the agreement of what is estimated, and as `plain`
    that of the currents alone; `held_out` those that were hidden.
    """
    from calm.version import __version__

    return {
        "calm": __version__,
        "name": name,
        "factors": factors_document(study.factors),
        "datum": study.task.common.datum,
        "sensors": [
            {
                "label": label,
                **_agreement(fit),
                "offset": float(offset),
                **({"plain": _agreement(study.plain[label])} if label in study.plain else {}),
            }
            for (label, fit), offset in zip(
                study.fit.items(), study.task.common.offset, strict=True
            )
        ],
        "held_out": held_out_document(study.held_out),
        "diagnosis": diagnosis_document(study.diagnosis),
        "line": {"fits": study.fits, "causes": diagnosis_document(study.line)},
        **({} if study.judged is None else {"judge": asdict(study.judged)}),
        "doubts": list(study.remarks),
    }


def factors_document(factors: Mapping[str, tuple[float, float, float]]) -> dict[str, Any]:
    """Each factor with its value and the ends of its interval."""
    keys = ("value", "low", "high")
    return {name: dict(zip(keys, three, strict=True)) for name, three in factors.items()}


def held_out_document(held_out: Sequence[HeldOut]) -> list[dict[str, Any]]:
    """The hidden sensors."""
    return [
        {
            "label": one.label,
            "n": one.count,
            **members(one, "bias", "rms", "linear_rms", "pchip_rms"),
            "coverage_95": one.coverage,
        }
        for one in held_out
    ]


def _agreement(one: Agreement) -> dict[str, Any]:
    said = asdict(one)
    return {"n": said.pop("count"), **said}


_WIDTH = 7.4  # inches: an A4 page between its margins
_FONT_SIZE = 7.0  # points
_ESTIMATED = "#0b3c5d"


def overview_figure(series: Sequence[SensorSeries]) -> str:
    """Depths of all instruments over time, with their bands: where and when the line went down."""
    from matplotlib import figure as drawing

    figure = drawing.Figure(figsize=(_WIDTH, 3.6))
    figure.subplots_adjust(0.1, 0.09, 0.99, 0.98)
    axes = figure.subplots()
    for one in series:
        style = "--" if one.hidden else "-"
        axes.plot(_band(axes, one), one.estimated, style, color=_ESTIMATED, linewidth=0.6)
    _frame(axes)
    return figure_svg(figure)


def depth_figure(series: Sequence[SensorSeries]) -> str:
    """Depths of each sensor over time: measured, estimated with its band, by the currents alone."""
    from matplotlib import figure as drawing

    height = 1.25 * len(series) + 0.4
    figure = drawing.Figure(figsize=(_WIDTH, height))
    figure.subplots_adjust(0.1, 0.25 / height, 0.99, 0.98, hspace=0.25)
    panels = figure.subplots(len(series), 1, sharex=True, squeeze=False)[:, 0]
    for axes, one in zip(panels, series, strict=True):
        time = _band(axes, one)
        if one.plain is not None:
            axes.plot(time, one.plain, "--", color="#d55e00", linewidth=0.7)
        axes.plot(time, one.estimated, color=_ESTIMATED, linewidth=0.9)
        axes.plot(time, one.measured, color="#111111", linewidth=0.8)
        title = f"{one.label}{', hidden' if one.hidden else ''}"
        axes.set_title(title, fontsize=_FONT_SIZE, loc="left", pad=2, parse_math=False)
        _frame(axes)
    return figure_svg(figure)


def _band(axes: Axes, one: SensorSeries) -> Any:
    """Draw the band of what is estimated; the times of the sensor."""
    time = one.time.astype("datetime64[s]")
    low, high = one.estimated - 1.96 * one.spread, one.estimated + 1.96 * one.spread
    axes.fill_between(time, low, high, color="#9ecae1", linewidth=0.0)
    return time


def _frame(axes: Axes) -> None:
    axes.invert_yaxis()
    axes.set_ylabel("depth [m]", fontsize=_FONT_SIZE)
    axes.tick_params(labelsize=_FONT_SIZE)
    axes.grid(alpha=0.3)


def false_figure(time: Any, false: Mapping[str, Any]) -> str:
    """A row of marks for each level whose current looks false at some of the times (n,)."""
    from matplotlib import figure as drawing

    height = 0.2 * len(false) + 0.5
    figure = drawing.Figure(figsize=(_WIDTH, height))
    figure.subplots_adjust(0.2, 0.3 / height, 0.99, 0.97)
    axes = figure.subplots()
    for row, when in enumerate(false.values()):
        axes.plot(when.astype("datetime64[s]"), np.full(len(when), row), "|", color="#d55e00")
    axes.set_yticks(range(len(false)), list(false), parse_math=False)
    axes.set(xlim=tuple(time[[0, -1]].astype("datetime64[s]")), ylim=(len(false) - 0.5, -0.5))
    axes.tick_params(labelsize=_FONT_SIZE)
    return figure_svg(figure)
