"""Currents to begin with: shapes of profiles, for a person to put their own figures into."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import exp

_SHARES = (0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0)
_POWER = 1 / 7


@dataclass(frozen=True)
class Preset:
    """A profile to begin with.

    Attributes
    ----------
    key : the key that chooses it
    name : what it is, for people
    speed : the speed [m/s] at a share of the depth: 0 at the surface to 1 at the bed
    """

    key: str
    name: str
    speed: Callable[[float], float]

    def rows(self, depth: float) -> tuple[tuple[str, str, str], ...]:
        """Depth [m], speed [m/s] and direction [degrees], east, in water of a depth [m]."""
        return tuple(
            (f"{share * depth:.4g}", f"{self.speed(share):.2g}", "90") for share in _SHARES
        )


PRESETS = (
    Preset("1", "uniform, 0.5 m/s", lambda share: 0.5),
    Preset("2", "tidal stream, 1 m/s, falling by the 1/7 power of the height above the bed",
           lambda share: (1.0 - share) ** _POWER),
    Preset("3", "linear shear, 0.8 m/s at the surface to nothing at the bed",
           lambda share: 0.8 * (1.0 - share)),
    Preset("4", "boundary current, 1.2 m/s at the surface, decaying by e in a fifth of the depth",
           lambda share: 0.05 + 1.15 * exp(-share / 0.2)),
)  # fmt: skip
"""In the order in which they are offered."""
