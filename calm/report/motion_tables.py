"""What was found of a mooring's motion, in tables and as JSON."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from math import isfinite
from typing import TYPE_CHECKING, Any

from calm.checks.finding import State
from calm.report.blocks import Block, Column, Heading, Prose, ReportPart, Table, table_of
from calm.report.result_files import members

if TYPE_CHECKING:
    from calm.motion.remarks import Agreement
    from calm.motion.study import HeldOut, Study

TITLES = {
    "cable_drag": "drag of cables and chains",
    "rigid_drag": "drag of floats and instruments",
    "buoyancy": "net force of the floats",
    "length": "length of cables and chains",
}

PLAIN = (
    "Alone: by the currents with nothing fitted. Estimated: with the pressures of all sensors that "
    "are used. rms is that of the difference less its mean over the calm times, the tenth with the "
    "least knockdown."
)


def motion_part(study: Study, name: str) -> ReportPart:
    """Factors, sensors, sensors that were hidden, and what to doubt."""
    blocks: list[Block] = [
        Heading(name),
        factors_table(study.factors, study.task.common.datum),
        sensors_table(study),
        Prose((PLAIN,)),
    ]
    if study.held_out:
        blocks.append(held_out_table(study.held_out))
    if study.remarks:
        blocks.append(Prose(study.remarks, State.WARN))
    return ReportPart("", tuple(blocks))


def factors_table(factors: Mapping[str, tuple[float, float, float]], datum: float) -> Table:
    """The common factors with their intervals."""
    return table_of(
        "",
        factors.items(),
        (Column("factor for the whole record"), lambda one: TITLES[one[0]]),
        (Column("value", numeric=True), lambda one: f"{one[1][0]:.3f}"),
        (Column("95 % interval", numeric=True), lambda one: f"{one[1][1]:.3f}–{one[1][2]:.3f}"),
        note=f"All depths are shifted by {datum:+.1f} m, the datum that the pressures have in "
        "common.",
    )


def sensors_table(study: Study) -> Table:
    """Return how the sensors that are used agree with the currents alone, and with what is
    estimated.
    """
    return table_of(
        "",
        study.plain.items(),
        (Column("sensor"), lambda one: one[0]),
        (Column("times", numeric=True), lambda one: str(one[1].count)),
        (Column("alone: bias", "m", numeric=True), lambda one: metres(one[1].bias)),
        (Column("rms", "m", numeric=True), lambda one: metres(one[1].rms)),
        (Column("r", numeric=True), lambda one: share(one[1].r)),
        (Column("slope", numeric=True), lambda one: share(one[1].slope)),
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
                "plain": _agreement(study.plain[label]),
            }
            for (label, fit), offset in zip(
                study.fit.items(), study.task.common.offset, strict=True
            )
        ],
        "held_out": held_out_document(study.held_out),
        "doubts": list(study.remarks),
    }


def factors_document(factors: Mapping[str, tuple[float, float, float]]) -> dict[str, Any]:
    """Each factor with its value and the ends of its interval."""
    return {
        name: {"value": value, "low": low, "high": high}
        for name, (value, low, high) in factors.items()
    }


def held_out_document(held_out: Sequence[HeldOut]) -> list[dict[str, Any]]:
    """The hidden sensors."""
    return [
        {
            "label": one.label,
            "n": one.count,
            **members(one, "bias", "rms", "linear_rms"),
            "coverage_95": one.coverage,
        }
        for one in held_out
    ]


def _agreement(one: Agreement) -> dict[str, Any]:
    said = asdict(one)
    return {"n": said.pop("count"), **said}
