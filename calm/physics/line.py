"""The line and the water as the march takes them: plain float64 arrays, checked on entry."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Booleans = NDArray[np.bool_]

REFERENCE_DENSITY = 1025.0
"""Density of the sea water [kg/m³] for which buoyancies and drags are given."""


class _Arrays:
    """Freezes every array field as float64, int64 or bool and asserts that it is finite."""

    def __post_init__(self) -> None:
        for field in fields(self):  # type: ignore[arg-type]
            if field.type not in _DTYPES:
                continue
            value = np.array(getattr(self, field.name), dtype=_DTYPES[str(field.type)], ndmin=1)
            if not np.isfinite(value).all():
                raise ValueError(f"{type(self).__name__}.{field.name} must be finite")
            value.setflags(write=False)
            object.__setattr__(self, field.name, value)

    def _same_length(self, *names: str) -> None:
        lengths = {name: len(getattr(self, name)) for name in names}
        if len(set(lengths.values())) > 1:
            raise ValueError(f"{type(self).__name__}: arrays differ in length: {lengths}")


_DTYPES: dict[str, Any] = {
    "Floats": np.float64,
    "Integers": np.int64,
    "Booleans": np.bool_,
}


@dataclass(frozen=True)
class Line(_Arrays):
    """The n pieces above the anchor, free end first, and the m instruments clamped on them.

    Buoyancies and drags are those in sea water of 1025 kg/m³. Where a piece is `flexible`
    (cable, chain) its `buoyancy`, `volume` and drags are per unstretched metre.

    Attributes
    ----------
    length : (n,) unstretched length [m]
    flexible : (n,) cable or chain, cut into segments; else one rigid element
    buoyancy : (n,) net force in water, + up [N or N/m]
    volume : (n,) displaced volume that follows the water's density [m³ or m³/m]; 0 where unknown
    normal_drag, tangential_drag : (n,) Kn and Kt [N/(m/s)², per metre where flexible]
    directional : (n,) False where the drag is Kn|V|V whatever the axis
    compliance : (n,) 1/EA [1/N]; 0 where inextensible
    thinning : (n,) drag per unstretched metre grows by (1 + strain)**thinning: 1/2 where the
        volume is conserved (cables), 0 where only the length grows (chains)
    clamp_piece : (m,) index of the piece a clamp sits on
    clamp_at : (m,) distance from that piece's top along its unstretched length [m]
    clamp_buoyancy, clamp_volume, clamp_drag : (m,) [N], [m³], K of K|V|V [N/(m/s)²]
    anchor_height : the line ends this far above the seabed [m]
    """

    length: Floats
    flexible: Booleans
    buoyancy: Floats
    volume: Floats
    normal_drag: Floats
    tangential_drag: Floats
    directional: Booleans
    compliance: Floats
    thinning: Floats
    clamp_piece: Integers
    clamp_at: Floats
    clamp_buoyancy: Floats
    clamp_volume: Floats
    clamp_drag: Floats
    anchor_height: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        self._same_length(
            "length", "flexible", "buoyancy", "volume", "normal_drag", "tangential_drag",
            "directional", "compliance", "thinning",
        )  # fmt: skip
        self._same_length("clamp_piece", "clamp_at", "clamp_buoyancy", "clamp_volume", "clamp_drag")
        for name in ("length", "normal_drag", "tangential_drag", "compliance", "clamp_drag"):
            if (getattr(self, name) < 0).any():
                raise ValueError(f"Line.{name} must not be negative")
        on = self.clamp_piece
        if ((on < 0) | (on >= len(self.length))).any() or (self.clamp_at < 0).any():
            raise ValueError("Line: a clamp sits on no piece")
        if not 0.0 <= self.anchor_height < inf:
            raise ValueError("Line.anchor_height must be finite and not negative")

    @property
    def total_buoyancy(self) -> Floats:
        """(n,) net force of each whole piece with its clamps in reference water [N]."""
        return self.net_force(np.zeros(len(self.length)))

    def net_force(self, excess: Floats) -> Floats:
        """(n,) net force of each whole piece with its clamps [N].

        Parameters
        ----------
        excess : (n,) what a displaced cubic metre lifts more than in reference water [N/m³]
        """
        whole = np.where(self.flexible, self.length, 1.0)
        total: Floats = (self.buoyancy + excess * self.volume) * whole
        on = self.clamp_piece
        np.add.at(total, on, self.clamp_buoyancy + excess[on] * self.clamp_volume)
        return total

    def with_length(self, piece: int, length: float) -> Line:
        """The same line with one piece cut to another unstretched length [m]."""
        lengths = self.length.copy()
        lengths[piece] = length
        return replace(self, length=lengths)


@dataclass(frozen=True)
class Water(_Arrays):
    """The sea: depth, and current and density by level.

    Attributes
    ----------
    depth : water depth [m]
    level : (k,) depths of the levels [m], strictly increasing, k ≥ 1
    u, v, w : (k,) current to the east, to the north, upward [m/s]
    density : (k,) [kg/m³]
    gravity : [m/s²]

    Between levels everything is linear in depth; above the first and below the last it is constant.
    """

    depth: float
    level: Floats
    u: Floats
    v: Floats
    w: Floats
    density: Floats
    gravity: float = 9.80665

    def __post_init__(self) -> None:
        super().__post_init__()
        self._same_length("level", "u", "v", "w", "density")
        positive = 0.0 < self.depth < inf and 0.0 < self.gravity < inf
        if not positive or (np.diff(self.level) <= 0).any() or (self.density <= 0).any():
            raise ValueError("Water: depth, gravity and densities must be positive, levels rise")

    @property
    def moving(self) -> bool:
        """Whether there is any current at all."""
        return bool(self.u.any() or self.v.any() or self.w.any())

    def still(self) -> Water:
        """The same water without current."""
        zero = np.zeros_like(self.u)
        return replace(self, u=zero, v=zero, w=zero)

    def at(self, depth: Floats) -> tuple[Floats, Floats]:
        """Current (..., 3) [m/s] and density (...) [kg/m³] at depths of any shape [m]."""
        current = np.stack([np.interp(depth, self.level, c) for c in (self.u, self.v, self.w)], -1)
        return current, np.interp(depth, self.level, self.density)
