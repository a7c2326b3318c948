"""Why three quantities give no cable, said for people."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from calm.analytic.chart_branch import critical_angle

_ROUNDING = 1e-9


@dataclass(frozen=True)
class Refusal:
    """Why there is no answer: its status, what is wrong and what to change."""

    status: str
    message: str
    advice: str


def family(what: str) -> Refusal:
    """The refusal of quantities that leave one free."""
    return Refusal("one-parameter-family", what, "Give another quantity in place of one of these.")


def contradiction(known: Mapping[str, float]) -> Refusal | None:
    """What is wrong with the quantities whatever K is; tensions over w [m]; None if nothing is.

    The light end is the one from which the tension grows, A where the cable sinks.
    """
    below, above = known.get("tension_a"), known.get("tension_b")
    height, distance = known.get("height", 0.0), known.get("distance", 0.0)
    if below is not None and above is not None and "height" in known:
        if abs(above - below - height) <= _ROUNDING * above:
            return family("Two tensions and the height say one thing: T_B = T_A + w H.")
        return _inconsistent(
            "T_B = T_A + w H does not hold.", "Give two of these, and another quantity."
        )
    if above is not None and above <= (below or 0.0) + height:
        least = "T_A" if below is not None else "w H" if height else "0"
        return _inconsistent(
            f"The tension at the heavy end must exceed {least}: it grows by w for each metre up.",
            "Check which end is which, and the weight.",
        )
    chord = math.hypot(height, distance)
    if "length" in known and chord > known["length"] * (1.0 + _ROUNDING):
        return _inconsistent(
            f"The cable, {known['length']:.6g} m, is shorter than the way of {chord:.6g} m.",
            "Lengthen the cable or bring its ends closer.",
        )
    return None


def reason(k: float, known: Mapping[str, float]) -> Refusal:
    """Why no cable has quantities that do not contradict each other."""
    critical = float(critical_angle(k))
    angle = f"the critical angle, {math.degrees(critical):.6g}° at K = {k:g}"
    start, end = known.get("phi_a"), known.get("phi_b")
    if known.get("tension_a") == 0.0:
        message = f"A cable without tension at one end is straight, at {angle}."
        return _none(message, "Give a tension, or quantities of that straight cable.")
    if end is not None and not 0.0 < end < math.pi:
        return _none("At its heavy end a cable must rise.", "Give an angle between 0 and 180°.")
    if start is not None and end is not None:
        lean = start + 2 * math.pi if start < critical - math.pi else start
        if (lean - critical) * (end - critical) <= 0.0:
            return _none(f"No cable reaches across {angle}.", "Give two angles on one side of it.")
        return _none(
            "Between these angles the cable does not rise in the direction it curves.",
            f"Below {angle}, φ grows upwards; above it, φ shrinks upwards.",
        )
    return _none(
        f"No cable in a uniform current at K = {k:g} has these three quantities together.",
        "Check K and the quantities; give two of them with another to see what is possible.",
    )


def _inconsistent(message: str, advice: str) -> Refusal:
    return Refusal("inconsistent", message, advice)


def _none(message: str, advice: str) -> Refusal:
    return Refusal("no-equilibrium", message, advice)
