"""The straight cable at the critical angle, the only one that no branch of the curve holds."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from calm.analytic.chart_branch import critical_angle

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
    """The straight cable that has the known quantities to 1e-9, tensions over w; None if none has.

    Parameters
    ----------
    k : float
        K.
    known : mapping
        Three of the seven quantities [rad, m].
    """
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
