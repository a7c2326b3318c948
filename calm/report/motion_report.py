"""What was found of a mooring's motion: tables, JSON, and a page and a PDF with its drawings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.checks.finding import State
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
from calm.report.motion_figures import (
    depth_figure,
    false_figure,
    overview_figure,
)
from calm.report.provenance import date
from calm.report.result_files import members

if TYPE_CHECKING:
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
_WHOLE = (
    "Depths of all instruments, with bands of 95 %; hidden ones and those without pressure dashed"
)
_ASSUMED = (
    "Assumed: floats, weights, lengths and places as in the mooring file; the drag of every part "
    "within 15 % beforehand, the datum within 1 % of the water depth, each sensor within 1 m."
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
    every = series
    bare = [one for one in series if not np.isfinite(one.measured).any()]
    bare = sorted(bare, key=lambda one: -float(np.nan_to_num(one.spread).mean()))
    bare = sorted(bare[:MOST_PANELS], key=lambda one: float(np.nan_to_num(one.estimated).mean()))
    series = [one for one in series if np.isfinite(one.measured).any()]
    shown = sorted(series, key=lambda one: not one.hidden)[:MOST_PANELS]
    shown = [one for one in series if any(one is each for each in shown)]
    doubts = Prose(study.remarks, State.WARN) if study.remarks else Prose((_NOTHING,))
    marks = (Figure(_FALSE, false_figure(time, study.false)),) if study.false else ()
    held: tuple[Block, ...] = (held_out_table(study.held_out),) if study.held_out else ()
    instruments = [Figure(_BARE, depth_figure(bare), tall=True)] if bare else []
    parts = (
        ReportPart(
            "The deployment",
            (
                Figure(_WHOLE, overview_figure([*series, *bare])),
                *judged_prose(study),
                doubts,
                health_table(study),
            ),
        ),
        ReportPart("For the methods of a cruise report", (Prose(methods_text(study, every)),)),
        ReportPart(
            "Factors",
            (factors_table(study.factors, study.task.common.datum), Note((_ASSUMED,))),
        ),
        ReportPart(
            "Measured against computed",
            (sensors_table(study), *held, Note((PLAIN if study.plain else UNKNOWN,)), *marks),
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
