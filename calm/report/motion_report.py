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
from calm.physics.line import Floats
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
_NOTHING = "Nothing is clearly wrong: no clock, gain, offset, drift, slipped clamp or label."


def motion_report(
    study: Study,
    series: Sequence[SensorSeries],
    time: NDArray[datetime64],
    factor: Floats | None,
    name: str,
    notes: Sequence[str],
) -> Report:
    """Return the report: factors, agreement, what to doubt, depths and residuals.

    Parameters
    ----------
    series : of the sensors
    time, factor : (n,) the factor on the current over time; None of currents that are not known
    notes : what was said of the input
    """
    bare = [one for one in series if not np.isfinite(one.measured).any()]
    bare = sorted(bare, key=lambda one: -float(np.nan_to_num(one.spread).mean()))
    bare = sorted(bare[:MOST_PANELS], key=lambda one: float(np.nan_to_num(one.estimated).mean()))
    series = [one for one in series if np.isfinite(one.measured).any()]
    shown = sorted(series, key=lambda one: not one.hidden)[:MOST_PANELS]
    shown = [one for one in series if any(one is each for each in shown)]
    doubts = Prose(study.remarks, State.WARN) if study.remarks else Prose((_NOTHING,))
    marks = (Figure(_FALSE, false_figure(time, study.false)),) if study.false else ()
    held: tuple[Block, ...] = (held_out_table(study.held_out),) if study.held_out else ()
    factors: list[Block] = [factors_table(study.factors, study.task.common.datum)]
    if factor is not None:
        factors.append(Figure("Over time", factor_figure(time, factor)))
    instruments = [Figure(_BARE, depth_figure(bare), tall=True)] if bare else []
    parts = (
        ReportPart("Doubtful data", (*judged_prose(study), doubts, health_table(study), *marks)),
        ReportPart("Factors", tuple(factors)),
        ReportPart(
            "Measured against computed",
            (sensors_table(study), *held, Note((PLAIN if study.plain else UNKNOWN,))),
        ),
        ReportPart("Inputs", (Prose(tuple(notes) or ("Nothing was left out.",)),)),
        ReportPart(
            "Depths",
            (
                *instruments,
                Figure(_DEPTHS, depth_figure(shown), tall=True),
                Note((_LEGEND,)),
            ),
        ),
        ReportPart(
            "Residuals", (Figure("Measured less estimated", residual_figure(shown), tall=True),)
        ),
    )
    span = f"{str(time[0])[:16]} to {str(time[-1])[:16]}, {len(time)} times"
    return Report(f"{name}: where it was", span, (), (Section(name, parts),), date())


_WIDTH = 7.4  # inches: an A4 page between its margins
_FONT_SIZE = 7.0  # points
_MEASURED: dict[str, Any] = {"color": "#111111", "linewidth": 0.8}
_ESTIMATED: dict[str, Any] = {"color": "#0b3c5d", "linewidth": 0.9}
_ALONE: dict[str, Any] = {"color": "#d55e00", "linewidth": 0.7, "linestyle": "--"}
MOST_PANELS = 12
"""Sensors that are drawn; of more, those that are hidden come first."""


def depth_figure(series: Sequence[SensorSeries]) -> str:
    """Depths of each sensor over time: measured, estimated with its band, by the currents alone."""
    figure, panels = _panels(series)
    for axes, one in zip(panels, series, strict=True):
        time = one.time.astype("datetime64[s]")
        low, high = one.estimated - 1.96 * one.spread, one.estimated + 1.96 * one.spread
        axes.fill_between(time, low, high, color="#9ecae1", linewidth=0.0)
        if one.plain is not None:
            axes.plot(time, one.plain, **_ALONE)
        axes.plot(time, one.estimated, **_ESTIMATED)
        axes.plot(time, one.measured, **_MEASURED)
        axes.invert_yaxis()
        _name(axes, one, "depth [m]")
    return figure_svg(figure)


def residual_figure(series: Sequence[SensorSeries]) -> str:
    """Measured less estimated depths of each sensor over time."""
    figure, panels = _panels(series)
    for axes, one in zip(panels, series, strict=True):
        axes.plot(one.time.astype("datetime64[s]"), one.measured - one.estimated, **_MEASURED)
        axes.axhline(0.0, color="#999999", linewidth=0.5)
        _name(axes, one, "residual [m]")
    return figure_svg(figure)


def factor_figure(time: Any, factor: Any) -> str:
    """The factor on the current over time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(_WIDTH, 1.6))
    figure.subplots_adjust(0.1, 0.16, 0.99, 0.97)
    axes = figure.subplots()
    axes.plot(time.astype("datetime64[s]"), factor, **_ESTIMATED)
    axes.axhline(1.0, color="#999999", linewidth=0.5)
    axes.set_ylabel("factor on the current", fontsize=_FONT_SIZE)
    axes.tick_params(labelsize=_FONT_SIZE)
    return figure_svg(figure)


def false_figure(time: Any, false: Mapping[str, Any]) -> str:
    """A row of marks for each level whose current looks false at some of the times (n,)."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(_WIDTH, 0.2 * len(false) + 0.5))
    figure.subplots_adjust(0.2, 0.3 / (0.2 * len(false) + 0.5), 0.99, 0.97)
    axes = figure.subplots()
    for row, when in enumerate(false.values()):
        axes.plot(when.astype("datetime64[s]"), np.full(len(when), row), "|", color="#d55e00")
    axes.set_yticks(range(len(false)), list(false), parse_math=False)
    axes.set(xlim=tuple(time[[0, -1]].astype("datetime64[s]")), ylim=(len(false) - 0.5, -0.5))
    axes.tick_params(labelsize=_FONT_SIZE)
    return figure_svg(figure)


def _panels(series: Sequence[SensorSeries]) -> tuple[Any, Any]:
    from matplotlib.figure import Figure

    count = len(series)
    figure = Figure(figsize=(_WIDTH, 1.25 * count + 0.4))
    figure.subplots_adjust(0.1, 0.25 / (1.25 * count + 0.4), 0.99, 0.98, hspace=0.25)
    return figure, figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]


def _name(axes: Axes, one: SensorSeries, quantity: str) -> None:
    title = f"{one.label}{', hidden' if one.hidden else ''}"
    axes.set_title(title, fontsize=_FONT_SIZE, loc="left", pad=2, parse_math=False)
    axes.set_ylabel(quantity, fontsize=_FONT_SIZE)
    axes.tick_params(labelsize=_FONT_SIZE)
    axes.grid(alpha=0.3)


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
        row |= {key: unit * getattr(one, key) for key in ("value", "low", "high")}
        row |= {"odds": one.odds, "corrected": one.corrected}
        if one.other:
            row |= {"value": None, "low": None, "high": None, "with": one.other}
        row |= {
            key: str(getattr(one, key))[:19]
            for key in ("since", "until")
            if not np.isnat(getattr(one, key))
        }
        said.append(row)
    return said


def _factor_title(one: tuple[str, tuple[float, float, float]]) -> str:
    far = no_drag(one[0], one[1][0])
    return f"{TITLES[one[0]]}{': not drag, see below' if far else ''}"


def factors_table(factors: Mapping[str, tuple[float, float, float]], datum: float) -> Table:
    """The common factors with their intervals."""
    return table_of(
        "",
        factors.items(),
        (Column("factor for the whole record"), _factor_title),
        (Column("value", numeric=True), lambda one: f"{one[1][0]:.3f}"),
        (Column("95 % interval", numeric=True), lambda one: f"{one[1][1]:.3f}–{one[1][2]:.3f}"),
        note=f"All depths are shifted by {datum:+.1f} m, the datum common to all pressures.",
    )


def sensors_table(study: Study) -> Table:
    """Return how sensors in use agree with the currents alone, and with what is estimated."""
    alone = (
        (Column("alone: bias", "m", numeric=True), lambda one: metres(one[1].bias)),
        (Column("rms", "m", numeric=True), lambda one: metres(one[1].rms)),
        (Column("r", numeric=True), lambda one: share(one[1].r)),
        (Column("slope", numeric=True), lambda one: share(one[1].slope)),
    )
    return table_of(
        "",
        (study.plain or study.fit).items(),
        (Column("sensor"), lambda one: one[0]),
        (Column("times", numeric=True), lambda one: str(one[1].count)),
        *(alone if study.plain else ()),
        (Column("estimated: rms", "m", numeric=True), lambda one: metres(study.fit[one[0]].rms)),
    )


def held_out_table(held_out: Sequence[HeldOut]) -> Table:
    """Return how well the depths of hidden sensors were estimated."""
    return table_of(
        "",
        held_out,
        (Column("hidden sensor"), lambda one: one.label),
        (Column("times", numeric=True), lambda one: str(one.count)),
        (Column("bias", "m", numeric=True), lambda one: metres(one.bias)),
        (Column("rms", "m", numeric=True), lambda one: metres(one.rms)),
        (Column("interpolated: rms", "m", numeric=True), lambda one: metres(one.linear_rms)),
        (Column("PCHIP: rms", "m", numeric=True), lambda one: metres(one.pchip_rms)),
        (
            Column("within 95 % band", "%", numeric=True),
            lambda one: f"{100.0 * one.coverage:.0f}" if isfinite(one.coverage) else "-",
        ),
    )


def metres(value: float) -> str:
    """A difference of depths."""
    return f"{value:.2f}" if isfinite(value) else "-"


def share(value: float) -> str:
    """A correlation or a slope."""
    return f"{value:.3f}" if isfinite(value) else "-"


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
