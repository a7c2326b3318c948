"""What was found of a mooring's motion, as JSON."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from calm.motion.agreement import Agreement
    from calm.motion.study import HeldOut, Study


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
            "bias": one.bias,
            "rms": one.rms,
            "linear_rms": one.linear_rms,
            "coverage_95": one.coverage,
        }
        for one in held_out
    ]


def _agreement(one: Agreement) -> dict[str, Any]:
    said = asdict(one)
    return {"n": said.pop("count"), **said}
