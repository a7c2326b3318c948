"""Report on the motion of a mooring: tables, JSON, and an HTML page and a PDF with drawings."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.drawing.graph import Axes, Graph, Scale, Stroke, Tick, covering, moments, seconds
from calm.drawing.schematic.pen import shortened, text_width
from calm.motion.remarks import Agreement, Fault, no_drag
from calm.motion.study import HeldOut, MotionEstimate, SensorSeries, knockdown
from calm.records.card import ReadCard
from calm.report import blocks
from calm.report.blocks import Figure, Note, Prose, ReportPart, Table, number, table_of, words
from calm.report.provenance import report_of
from calm.report.read_card import card_blocks
from calm.report.result_files import members
from calm.version import __version__

if TYPE_CHECKING:
    from numpy.typing import NDArray


_BARE = "Instruments without a pressure sensor: depths estimated, with the 95 % band"
_DEPTHS = "Depths measured (black), estimated (blue, 95 % band), from the currents alone (orange)"
_FALSE = "Times when a current is probably wrong"
_WHOLE = (
    "Depths of all instruments, with 95 % bands; dashed: withheld instruments and those without a "
    "pressure sensor"
)
_ASSUMED = (
    "Prior assumptions: buoyancy, weights, lengths and positions as in the mooring file; an "
    "uncertainty of 15 % in the drag of each part, 1 % of the water depth in the offset common to "
    "all sensors, and 1 m in the offset of each sensor."
)
_NOTHING = "No sensor fault was found (clock, gain, offset, drift or slipped clamp)."


def motion_report(
    study: MotionEstimate,
    series: Sequence[SensorSeries],
    time: NDArray[np.datetime64],
    name: str,
    notes: Sequence[str],
    cards: Sequence[ReadCard] = (),
) -> blocks.Report:
    """Build the report of a motion study, beginning with one page on the whole deployment.

    `series` are the depths of sensors and of other instruments over time. `time` is the (n,) times
    of these depths. `cards` summarise the input files.
    """
    bare = [one for one in series if not np.isfinite(one.measured).any()]
    sensors = [one for one in series if np.isfinite(one.measured).any()]
    bare.sort(key=lambda one: -float(np.nan_to_num(one.spread).mean()))
    bare = sorted(bare[:MOST_PANELS], key=lambda one: float(np.nan_to_num(one.estimated).mean()))
    hidden_first = sorted(sensors, key=lambda one: not one.hidden)[:MOST_PANELS]
    shown = [one for one in sensors if any(one is each for each in hidden_first)]
    doubts = blocks.warned(study.remarks) or (Prose((_NOTHING,)),)
    whole = Figure(_WHOLE, overview_figure([*sensors, *bare]))
    depths = [Figure(_DEPTHS, depth_figure(shown), tall=True)]
    depths += [Figure(_BARE, depth_figure(bare), tall=True)] if bare else []
    factors = factors_table(study.factors, study.task.common.datum)
    found = [
        sensors_table(study),
        *([held_out_table(study.held_out.values())] if study.held_out else []),
    ]
    how = Note((PLAIN if study.plain else UNKNOWN,))
    notes_block = (Prose(tuple(notes) or ("All of the input was used.",)),)
    marks = (Figure(_FALSE, false_figure(time, study.false)),) if study.false else ()
    return report_of(
        f"{name}: motion of the mooring",
        f"{str(time[0])[:16]} to {str(time[-1])[:16]}, {len(time)} times",
        ReportPart("The deployment", (whole, *doubts, health_table(study))),
        ReportPart("For the methods of a cruise report", (Prose(methods_text(study, series)),)),
        ReportPart("Factors", (factors, Note((_ASSUMED,)))),
        ReportPart("Measured against computed", (*found, how, *marks)),
        ReportPart("Depths", tuple(depths)),
        ReportPart("Inputs", (*card_blocks(one.to_dict() for one in cards), *notes_block)),
        name=name,
    )


MOST_PANELS = 12
"""Maximum number of sensors drawn; withheld sensors are selected first."""


def methods_text(study: MotionEstimate, series: Sequence[SensorSeries]) -> tuple[str, ...]:
    """Return sentences for the methods section of a cruise report."""
    used, common, time = study.task.measured, study.task.common, series[0].time
    levels = used.u.shape[1]
    by = f"the currents at {levels} levels" if study.plain else "no measured current"
    down = knockdown(used)
    down = down[np.isfinite(down)]
    wide = np.concatenate([one.spread[np.isfinite(one.spread)] for one in series])
    factors = "; ".join(
        f"{TITLES[key]} {value:.2f} times the assumed value (95 %: {low:.2f} to {high:.2f})"
        for key, (value, low, high) in study.factors.items()
    )
    sentences = [
        f"The depths of {len(series)} instruments between {str(time[0])[:16]} and "
        f"{str(time[-1])[:16]} ({len(time)} times) were estimated from the static equilibrium of "
        f"the line, the pressures of {', '.join(used.label)}, and {by} (CALM {__version__}).",
        f"The estimates for the whole record are: {factors}; and an offset common to all depths, "
        f"{common.datum:+.1f} m.",
        f"The knockdown of the uppermost pressure sensor was up to {down.max():.0f} m (median "
        f"{np.median(down):.0f} m, 95th percentile {np.quantile(down, 0.95):.0f} m). The standard "
        f"deviation of the depths has a median of {np.median(wide):.1f} m and a 95th percentile of "
        f"{np.quantile(wide, 0.95):.1f} m.",
    ]
    sentences += [
        f"When withheld, {one.label} was predicted with an rms error of {one.rms:.1f} m "
        f"(linear interpolation: {one.linear_rms:.1f} m)."
        for one in study.held_out.values()
    ]
    corrected = (one for one in study.faults(of_line=False) if one.corrected)
    return (*sentences, *(f"{one.sentence()}." for one in corrected))


TITLES = {
    "cable_drag": "drag of cables and chains",
    "rigid_drag": "drag of floats and instruments",
    "buoyancy": "net force of the floats",
    "length": "length of cables and chains",
}

_RMS = (
    "Rms is the rms difference from the measured depths, minus the mean difference in calm periods "
    "(the 10 % of times with the smallest knockdown)."
)
PLAIN = (
    "Alone: depths computed from the currents only, without fitting. Estimated: depths computed "
    f"with the pressures of all sensors in use. {_RMS}"
)
UNKNOWN = f"Without a current record, the currents are inferred from the pressures. {_RMS}"


def motion_part(study: MotionEstimate, name: str) -> ReportPart:
    """Build the terminal report.

    The tables give the estimated factors, the agreement with each sensor, and the errors at
    withheld sensors. Sentences on doubts about the data follow.
    """
    shown: tuple[blocks.Block, ...] = (
        blocks.Heading(name),
        factors_table(study.factors, study.task.common.datum),
        sensors_table(study),
        Prose((PLAIN if study.plain else UNKNOWN,)),
        *([held_out_table(study.held_out.values())] if study.held_out else []),
        *blocks.warned(study.remarks),
    )
    return ReportPart("", shown)


_HEALTH = {
    "clock": ("clock late", "h"), "gain": ("gain", ""), "offset": ("offset", "m"),
    "drift": ("drift", "m"), "slip": ("slipped", "m"),
}  # fmt: skip


_DOUBTED = "“?” marks a diagnosis with an almost equally likely alternative (see above)."


def health_table(study: MotionEstimate) -> Table:
    """Tabulate the faults of each sensor; a dash means that there is no such fault."""
    found: dict[str, dict[str, str]] = {label: {} for label in study.sensors}
    faults = [*study.faults(of_line=False)]
    for one in faults:
        text = format(one.value, ".3f" if one.kind == "gain" else "+.2f")
        found.setdefault(one.label, {})[one.kind] = text + ("" if one.certain else " ?")

    def of(kind: str) -> Callable[[tuple[str, dict[str, str]]], str]:
        return lambda row: row[1].get(kind, "-")

    return table_of(
        "",
        found.items(),
        words("sensor", 0),
        *(number(heading, of(kind), unit) for kind, (heading, unit) in _HEALTH.items()),
        note="" if all(one.certain for one in faults) else _DOUBTED,
    )


def diagnosis_document(diagnosis: Sequence[Fault]) -> list[dict[str, Any]]:
    """Return the faults of the sensors as JSON objects.

    Clock errors are in s, gains are factors, and all other values are in m.
    """
    documents = []
    for one in diagnosis:
        unit = 3600.0 if one.kind == "clock" else 1.0
        figures = {key: unit * getattr(one, key) for key in ("value", "low", "high")}
        times = {key: getattr(one, key) for key in ("since", "until")}
        documents.append(
            members(one, "label", "kind")
            | figures
            | members(one, "odds", "corrected")
            | {key: str(time)[:19] for key, time in times.items() if not np.isnat(time)}
        )
    return documents


def factors_table(factors: Mapping[str, tuple[float, float, float]], datum: float) -> Table:
    """Tabulate the common factors with their 95 % intervals."""
    rows = [
        (TITLES[name] + (": implausible, see below" if no_drag(name, value) else ""),
         f"{value:.3f}", f"{low:.3f}–{high:.3f}")
        for name, (value, low, high) in factors.items()
    ]  # fmt: skip
    fields = words("factor for the whole record", 0), number("value", 1), number("95 % interval", 2)
    note = f"A common offset of {datum:+.1f} m is added to all depths."
    return table_of("", rows, *fields, note=note)


def sensors_table(study: MotionEstimate) -> Table:
    """Tabulate the agreement of the computed line with each sensor.

    The line is computed twice: from the currents alone, and with the estimated factors.
    """
    rows = [(alone, label) for label, alone in (study.plain or study.sensors).items()]
    alone = blocks.of_first(
        _value_column("alone: bias", "bias"), _value_column("rms", "rms"),
        _value_column("r", "r", "", 3), _value_column("slope", "slope", "", 3),
    )  # fmt: skip
    return table_of(
        "",
        rows,
        words("sensor", 1),
        *blocks.of_first(number("times", "count")),
        *(alone if study.plain else ()),
        number("estimated: rms", lambda row: _value_text(study.sensors[row[1]].rms), "m"),
    )


def held_out_table(held_out: Iterable[HeldOut]) -> Table:
    """Tabulate the errors of the estimated depth at withheld sensors."""
    return table_of(
        "",
        held_out,
        words("hidden sensor", "label"),
        number("times", "count"),
        _value_column("bias", "bias"),
        _value_column("rms", "rms"),
        _value_column("interpolated: rms", "linear_rms"),
        _value_column("PCHIP: rms", "pchip_rms"),
        number("within 95 % band", lambda one: _value_text(100.0 * one.coverage, 0), "%"),
    )


def _value_column(heading: str, name: str, unit: str = "m", decimals: int = 2) -> blocks.Field:
    return number(heading, lambda one: _value_text(getattr(one, name), decimals), unit)


def _value_text(value: float, decimals: int = 2) -> str:
    return f"{value:.{decimals}f}" if isfinite(value) else "-"


def motion_document(
    study: MotionEstimate, name: str, cards: Sequence[ReadCard] = ()
) -> dict[str, Any]:
    """Return the JSON object of a motion study: factors with 95 % intervals, and depth errors [m].

    Each entry of `sensors` gives the agreement of a sensor with the estimate. In this entry, the
    key `plain` gives the agreement with the line computed from currents alone. `held_out` lists
    withheld sensors. `read` lists the input files.
    """
    sensors = [
        {"label": label, **_agreement_document(fit), "offset": float(offset)}
        | ({"plain": _agreement_document(study.plain[label])} if label in study.plain else {})
        for (label, fit), offset in zip(
            study.sensors.items(), study.task.common.offset, strict=True
        )
    ]
    return {
        "calm": __version__,
        "name": name,
        "factors": factors_document(study.factors),
        "datum": study.task.common.datum,
        "sensors": sensors,
        "held_out": held_out_document(study.held_out.values()),
        "diagnosis": diagnosis_document(study.faults(of_line=False)),
        "line": {"fits": study.fits, "causes": diagnosis_document(study.faults(of_line=True))},
        "doubts": list(study.remarks),
        "read": [card.to_dict() for card in cards],
    }


def factors_document(factors: Mapping[str, tuple[float, float, float]]) -> dict[str, Any]:
    """Return each factor with its estimate and the limits of its 95 % interval."""
    keys = ("value", "low", "high")
    return {name: dict(zip(keys, three, strict=True)) for name, three in factors.items()}


def held_out_document(held_out: Iterable[HeldOut]) -> list[dict[str, Any]]:
    """Return the errors at withheld sensors as JSON objects."""
    names = ("bias", "rms", "linear_rms", "pchip_rms")
    return [
        {"label": one.label, "n": one.count, **members(one, *names), "coverage_95": one.coverage}
        for one in held_out
    ]


def _agreement_document(one: Agreement) -> dict[str, Any]:
    fields = asdict(one)
    return {"n": fields.pop("count"), **fields}


_WIDTH, _SIZE = 510.0, 7.5  # text width of an A4 page, and font size [pt]
_PAGE_HEIGHT = 645.0
_LEFT, _RIGHT, _BELOW = 44.0, 8.0, 16.0  # room around the axes for their scales [pt]
_ESTIMATED, _BAND = "#0b3c5d", "#9ecae1"
_BY_CURRENTS, _MEASURED = Stroke("#d55e00", 0.8, (3.0, 1.5)), Stroke("#111111", 0.8)


def overview_figure(series: Sequence[SensorSeries]) -> str:
    """Draw the depths of all instruments over time, with their uncertainty bands."""
    page = Graph(_WIDTH, 260.0, "Depths of all instruments", _SIZE)
    place = (_LEFT, 6.0, _WIDTH - _LEFT - _RIGHT, 260.0 - 6.0 - _BELOW)
    _draw_depths(page, place, series, lambda one: [(one.estimated, _stroke_of(one))], numbered=True)
    return page.svg()


def _stroke_of(one: SensorSeries) -> Stroke:
    return Stroke(_ESTIMATED, 0.7, (3.0, 1.5) if one.hidden else ())


def depth_figure(series: Sequence[SensorSeries]) -> str:
    """Draw the depth of each sensor over time.

    Curves show the measured depth, the estimate with its uncertainty band, and the depth computed
    from currents alone.
    """
    apart = 14.0
    tall = max(min(76.0, _PAGE_HEIGHT / len(series) - apart), 36.0)
    page = Graph(_WIDTH, len(series) * (tall + apart) + _BELOW, "Depths of each sensor", _SIZE)

    def curves(one: SensorSeries) -> list[tuple[Any, Stroke]]:
        plain = [] if one.plain is None else [(one.plain, _BY_CURRENTS)]
        return [*plain, (one.estimated, Stroke(_ESTIMATED, 1.0)), (one.measured, _MEASURED)]

    for row, one in enumerate(series):
        hidden = one.hidden and np.isfinite(one.measured).any()
        place = (_LEFT, row * (tall + apart) + apart, _WIDTH - _LEFT - _RIGHT, tall)
        axes = _draw_depths(page, place, [one], curves, numbered=row == len(series) - 1)
        axes.title(f"{one.label}{', withheld' if hidden else ''}")
    return page.svg()


def _draw_depths(
    page: Graph,
    place: tuple[float, float, float, float],
    series: Sequence[SensorSeries],
    curves: Callable[[SensorSeries], Iterable[tuple[Any, Stroke]]],
    *,
    numbered: bool,
) -> Axes:
    times = [seconds(one.time) for one in series]
    bands = [(one.estimated - 1.96 * one.spread, one.estimated + 1.96 * one.spread)
             for one in series]  # fmt: skip
    drawn = [list(curves(one)) for one in series]
    down = covering(*(edge for band in bands for edge in band),
                    *(values for one in drawn for values, _ in one))  # fmt: skip
    axes = page.axes(*place, covering(*times, margin=0.02), Scale(down.high, down.low))
    for time, band in zip(times, bands, strict=True):
        axes.band(time, *band, _BAND)
    for time, one in zip(times, drawn, strict=True):
        for values, stroke in one:
            axes.line(time, values, stroke)
    begin, end = min(one.time[0] for one in series), max(one.time[-1] for one in series)
    axes.frame(
        moments(begin, end, 8), max(round(place[3] / 25.0), 3),
        beside="depth [m]", grid=True, numbered=(numbered, True),
    )  # fmt: skip
    return axes


def false_figure(time: Any, false: Mapping[str, Any]) -> str:
    """Draw marks at the times of apparently false currents, with a row for each current level.

    `time` is the (n,) times of the record. `false` is the times of false currents, by name of the
    level.
    """
    names = list(false)
    left = min(max(text_width(name, _SIZE) for name in names) + 12.0, 0.4 * _WIDTH)
    page = Graph(_WIDTH, 14.4 * len(false) + 12.0 + _BELOW, _FALSE, _SIZE)
    rows = Scale(len(false) - 0.5, -0.5)
    place = (left, 6.0, _WIDTH - left - _RIGHT, 14.4 * len(false))
    axes = page.axes(*place, Scale(*seconds(time[[0, -1]])), rows)
    for row, when in enumerate(false.values()):
        for at in seconds(when):
            axes.mark(float(at), row, "|", 7.0, "#d55e00")
    ticks = [Tick(row, shortened(name, left - 8.0, _SIZE)) for row, name in enumerate(names)]
    axes.frame(moments(time[0], time[-1], 8), ticks)
    return page.svg()
