"""Quantities that give no cable, and why, said for people; and the straight cable at the critical
angle, the only one that no branch of the curve holds.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from calm.analytic.chart_branch import critical_angle

_ROUNDING = 1e-9
_LEAST_SLACK = 1e-12


@dataclass(frozen=True)
class ChartRefusal:
    """Describe why there is no answer: its status, what is wrong and what to change."""

    status: str
    message: str
    advice: str


def family(what: str) -> ChartRefusal:
    """The refusal of quantities that leave one free."""
    return ChartRefusal(
        "one-parameter-family", what, "Give another quantity in place of one of these."
    )


def contradiction(known: Mapping[str, float]) -> ChartRefusal | None:
    """Return what is wrong with the quantities of a sinking cable whatever K is, if anything.

    Tensions are over w [m]. A cable that floats comes here upside down; messages hold for both.
    """
    below, above = known.get("tension_a"), known.get("tension_b")
    height, distance = known.get("height", 0.0), known.get("distance", 0.0)
    if below is not None and above is not None and "height" in known:
        if abs(above - below - height) <= _ROUNDING * above:
            return family("Two tensions and the height are not independent: T_B = T_A + w H.")
        return _inconsistent(
            "T_B = T_A + w H does not hold.", "Give two of these and one other quantity."
        )
    if above is not None and above <= (below or 0.0) + height:
        least = "that at the other end" if below is not None else "w H" if height else "0"
        return _inconsistent(
            f"The tension at the upper end (the lower of a cable that floats) must exceed {least}.",
            "Check which end is which, and the weight.",
        )
    chord = math.hypot(height, distance)
    if "length" in known and chord > known["length"] * (1.0 + _ROUNDING):
        return _inconsistent(
            f"The cable, {known['length']:.6g} m, is shorter than the distance of {chord:.6g} m.",
            "Lengthen the cable or bring its ends closer.",
        )
    return None


def is_taut(known: Mapping[str, float]) -> bool:
    """Return whether the cable is no longer than the straight way between its ends, to rounding."""
    chord = math.hypot(known.get("height", 0.0), known.get("distance", 0.0))
    return "length" in known and chord >= known["length"] * (1.0 - _LEAST_SLACK)


def reason(k: float, known: Mapping[str, float], floats: bool) -> ChartRefusal:
    """Return why no cable has quantities that do not contradict each other.

    Parameters
    ----------
    k : K
    known : the quantities, of a cable that floats turned upside down
    floats : whether they were turned
    """
    critical = float(critical_angle(k))
    shown = math.degrees(math.pi - critical if floats else critical)
    angle = f"the critical angle, {shown:.6g}° at K = {k:g}"
    start, end = known.get("phi_a"), known.get("phi_b")
    if known.get("tension_a") == 0.0:
        message = f"A cable without tension at one end is straight, at {angle}."
        return _none(message, "Give a tension, or quantities of that straight cable.")
    if is_taut(known):
        message = (
            "A cable no longer than the distance between its ends would need infinite tension."
        )
        return _none(message, "Lengthen the cable or bring its ends closer.")
    if end is not None and not 0.0 < end < math.pi:
        message = "The cable must rise at the end where its tension is greater."
        return _none(message, "Give an angle between 0 and 180° there.")
    if start is not None and end is not None:
        lean = start + 2 * math.pi if start < critical - math.pi else start
        if (lean - critical) * (end - critical) <= 0.0:
            return _none(f"No cable reaches across {angle}.", "Give two angles on one side of it.")
        return _none(
            "Between these two angles no cable rises from A to B in that sense.",
            "Check which end is which, and the sign of the distance if it is given.",
        )
    return _none(
        f"No cable in a uniform current at K = {k:g} satisfies these three quantities.",
        "Check K and the quantities; replace one of them to see what is possible.",
    )


def _inconsistent(message: str, advice: str) -> ChartRefusal:
    return ChartRefusal("inconsistent", message, advice)


def _none(message: str, advice: str) -> ChartRefusal:
    return ChartRefusal("no-equilibrium", message, advice)


_AGREEMENT = 1e-9


@dataclass(frozen=True)
class StraightCable:
    """A straight cable; `tension_a` (over w) or `length` is None where nothing fixes it."""

    angle: float
    tension_a: float | None
    length: float | None

    @property
    def figures(self) -> dict[str, float] | None:
        """The seven quantities and h0, tensions over w; None where they are not fixed."""
        if self.tension_a is None or self.length is None:
            return None
        rise = self.length * math.sin(self.angle)
        return {
            "phi_a": self.angle,
            "phi_b": self.angle,
            "tension_a": self.tension_a,
            "tension_b": self.tension_a + rise,
            "height": rise,
            "distance": self.length * math.cos(self.angle),
            "length": self.length,
            "h0": 0.0,
        }


def straight(k: float, known: Mapping[str, float]) -> StraightCable | None:
    """The straight cable of three quantities [rad, m] to 1e-9, tensions over w; None if none."""
    angle = float(critical_angle(k))
    sine, cosine = math.sin(angle), 0.0 if k == 0.0 else math.cos(angle)
    if any(abs(known[name] - angle) > _AGREEMENT for name in ("phi_a", "phi_b") if name in known):
        return None
    below, above, distance = (known.get(name) for name in ("tension_a", "tension_b", "distance"))
    lengths = [known["length"]] if "length" in known else []
    if "height" in known:
        lengths.append(known["height"] / sine)
    if below is not None and above is not None:
        lengths.append((above - below) / sine)
    if distance is not None and cosine != 0.0:
        lengths.append(distance / cosine)
    elif distance:
        return None
    if lengths and (min(lengths) <= 0.0 or max(lengths) > (1.0 + _AGREEMENT) * min(lengths)):
        return None
    length = lengths[0] if lengths else None
    if below is None and above is not None and length is not None:
        below = above - length * sine
        if below < -_AGREEMENT * above:
            return None
        below = max(below, 0.0)
    return StraightCable(angle, below, length)
