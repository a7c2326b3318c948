"""Extremes and fatigue of a Gaussian tension: ranges by Dirlik, damage by Miner's rule."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, gamma, isnan, log, pi, sqrt
from typing import Literal

import numpy as np

from calm.files import Cable, Chain, Component
from calm.physics.line import Floats
from calm.physics.materials import fibre_of, materials_in


def greatest_of(deviation: float, period: float, duration: float) -> float:
    """Return the most probable maximum of a Gaussian process, measured from its mean.

    The formula is σ √(2 ln N), where N = duration / period (Longuet-Higgins 1952). The result is 0
    for a constant process.

    Parameters
    ----------
    deviation : standard deviation σ, in the unit of the result
    period, duration : zero-crossing period, and duration for which the maximum is computed [s]
    """
    if not deviation > 0.0 or isnan(period):
        return 0.0
    return deviation * sqrt(2.0 * log(max(duration / period, 1.0 + 1e-9)))


def passing_probability(margin: float, deviation: float, period: float, duration: float) -> float:
    """Return the probability that a Gaussian process departs from its mean by more than a margin.

    The formula is 1 - exp(-N exp(-½ (margin/σ)²)), where N = duration / period (Rice 1945).
    `margin` and the standard deviation σ have the same unit; for the periods, see `greatest_of`.
    """
    if deviation <= 0.0:
        return 0.0 if margin > 0.0 else 1.0
    if margin <= 0.0:
        return 1.0
    return 1.0 - exp(-duration / period * exp(-0.5 * (margin / deviation) ** 2))


YEAR = 365.25 * 86_400.0
"""Length of a year [s]."""

BAND = 0.15
"""Relative change in the standard deviations of tension for `life_low` and `life_high`. The band of
tensions measured at sea is wider (`calm.waves.measured`).
"""


@dataclass(frozen=True)
class FatigueCurve:
    """Fatigue curve N = K R^-m for the number N of cycles to failure at the range R.

    Attributes
    ----------
    slope, logarithm : exponent m, and log10 of K at zero mean tension
    by_mean : decrease of log10 K if the mean tension rises from zero to the breaking load
    range : quantity R: ``stress`` for the range of the stress in the steel [MPa], ``share`` for the
        range of the tension divided by the breaking load
    source : publication that gives the curve
    """

    slope: float
    logarithm: float
    by_mean: float
    range: Literal["stress", "share"]
    source: str


_E301 = "DNV-OS-E301, fatigue limit state"
_2SK = "API RP 2SK, fatigue resistance"
_SOTS = "Southern Ocean Time Series, figures of its mooring design (sots-cable-model, P. Jansen)"

CURVES = {
    "dnv-studless-chain": FatigueCurve(3.0, log(6.0e10, 10), 0.0, "stress", _E301),
    "dnv-stud-chain": FatigueCurve(3.0, log(1.2e11, 10), 0.0, "stress", _E301),
    "dnv-polyester": FatigueCurve(13.46, log(0.259, 10), 0.0, "share", _E301),
    "api-studless-chain": FatigueCurve(3.0, log(316.0, 10), 0.0, "share", _2SK),
    "api-stud-chain": FatigueCurve(3.0, 3.0, 0.0, "share", _2SK),
    "api-connecting-link": FatigueCurve(3.0, log(178.0, 10), 0.0, "share", _2SK),
    "api-stranded-wire": FatigueCurve(4.09, 3.20, 2.79, "share", _2SK),
    "api-spiral-strand": FatigueCurve(5.05, 3.25, 3.43, "share", _2SK),
    "sots-shackle": FatigueCurve(3.7, 3.7 * log(3.0, 10), 0.0, "share", _SOTS),
    "sots-peened-shackle": FatigueCurve(3.7, 3.7 * log(4.5, 10), 0.0, "share", _SOTS),
    "sots-link": FatigueCurve(3.8, 3.8 * log(3.4, 10), 0.0, "share", _SOTS),
    "sots-wire": FatigueCurve(4.6, 4.6 * log(4.8, 10), 0.0, "share", _SOTS),
}
"""Published curves by name.

The curves of DNV and API are two standard deviations below the mean of the tests. Their constants
are from secondary texts, since the standards themselves were not available. The curves of `_SOTS`
are published with the load amplitude at which one cycle breaks the part: 1.5, 2.25, 1.7 and 2.4
times the breaking load. The curves here use the range, which is twice the amplitude. The source
does not state the distance of the `_SOTS` curves from the mean.
"""


@dataclass(frozen=True)
class PieceFatigue:
    """Fatigue of a piece; values are None if unknown.

    Attributes
    ----------
    life : time until the damage is 1 [years]
    life_low, life_high : lives for standard deviations of tension larger and smaller by `BAND`
    unknown : reason why there are no values
    life_half_cut_off, life_twice_cut_off : lives for half and for twice the cut-off frequency
    """

    index: int
    label: str
    damage_per_year: float | None
    life: float | None
    life_low: float | None
    life_high: float | None
    curve: str | None
    source: str | None
    unknown: str | None
    life_half_cut_off: float | None = None
    life_twice_cut_off: float | None = None


def moments_of(omega: Floats, spectral: Floats) -> Floats:
    """Return the spectral moments m0, m1, m2 and m4 of a response, in this order.

    Parameters
    ----------
    omega : (f,) angular frequencies [rad/s]
    spectral : (f, …) variance of the response at each frequency
    """
    shape = (-1,) + (1,) * (spectral.ndim - 1)
    powers = [(spectral * omega.reshape(shape) ** power).sum(0) for power in (0, 1, 2, 4)]
    return np.array(powers)


def dirlik(moments: Sequence[float], slope: float) -> float:
    """Return the expected sum of R^slope over all rainflow ranges R per second.

    Source: Dirlik 1985, Application of computers in fatigue analysis, University of Warwick.

    Parameters
    ----------
    moments : spectral moments m0, m1, m2, m4 of the tension
    slope : exponent of the fatigue curve
    """
    zeroth, first, second, fourth = moments
    if not zeroth > 0.0:
        return 0.0
    peaks = sqrt(fourth / second) / (2.0 * pi)
    regular = second / sqrt(zeroth * fourth)
    if regular > 1.0 - 1e-9:
        return narrow_band(moments, slope)
    mean = first / zeroth * sqrt(second / fourth)
    one = 2.0 * (mean - regular**2) / (1.0 + regular**2)
    width = (regular - mean - one**2) / (1.0 - regular - one + one**2)
    two = (1.0 - regular - one + one**2) / (1.0 - width)
    three = 1.0 - one - two
    scale = 1.25 * (regular - three - two * width) / one
    ranges = one * scale**slope * gamma(1.0 + slope) + 2.0 ** (0.5 * slope) * gamma(
        1.0 + 0.5 * slope
    ) * (two * abs(width) ** slope + three)
    return float(peaks * (2.0 * sqrt(zeroth)) ** slope * ranges)


def narrow_band(moments: Sequence[float], slope: float) -> float:
    """Return the result of `dirlik` in the limit of a narrow-band process.

    The result is ν0 (2 √(2 m0))^m Γ(1 + m/2), with m = `slope` and the rate ν0 of upward crossings
    of the mean. This result is an upper bound for all processes with the same m0 and m2 (Rychlik
    1993).
    """
    zeroth, _, second, _ = moments
    if not zeroth > 0.0:
        return 0.0
    crossings = sqrt(second / zeroth) / (2.0 * pi)
    ranges = (2.0 * sqrt(2.0 * zeroth)) ** slope * gamma(1.0 + 0.5 * slope)
    return float(crossings * ranges)


def curve_of(component: Component) -> str | None:
    """Return the name of a component's fatigue curve, or None if no curve applies.

    If the component does not specify a curve, the curve follows from its type and material.
    """
    if component.fatigue is not None and component.fatigue.curve is not None:
        return component.fatigue.curve
    if isinstance(component, Chain):
        return "dnv-studless-chain"
    if isinstance(component, Cable):
        fibre, named = fibre_of(component.material), materials_in(component.material)
        if fibre is not None:
            return "dnv-polyester" if fibre.name == "polyester" else None
        return "api-stranded-wire" if any(each.family == "metal" for each in named) else None
    return None


def fatigue_of(
    component: Component, index: int, label: str, seas: Sequence[tuple[float, float, Floats]]
) -> PieceFatigue:
    """Compute the damage per year of a piece, summed over the sea states by Miner's rule.

    Corrosion reduces the diameter, and reduces the strength with the square of the diameter.

    Parameters
    ----------
    seas : share of time, mean tension [N], and spectral moments of tension for each sea state
    """
    name, strength = curve_of(component), component.breaking_load
    size = getattr(component, "diameter", None)
    lost = 0.0 if component.fatigue is None else component.fatigue.corrosion
    left = 1.0 if not lost or not size else max(1.0 - lost / size, 0.0)
    bar = size * left if size and isinstance(component, Chain) else None
    curve = None if name is None else CURVES[name]
    unknown = None
    if curve is None:
        unknown = "no published curve applies: set its `fatigue`"
    elif curve.range == "share" and strength is None:
        unknown = "its breaking load is unknown"
    elif curve.range == "stress" and bar is None:
        unknown = "its stress is unknown, since it is not a chain"
    elif lost and not size:
        unknown = "its diameter, which corrosion reduces, is unknown"
    elif not left > 0.0:
        unknown = "corrosion would consume its whole diameter"
    source = None if curve is None else curve.source
    if unknown is not None or curve is None:
        return PieceFatigue(index, label, None, None, None, None, name, source, unknown)
    # a stress refers to both bars of a link, in mm²
    by_load = curve.range == "share"
    unit = (
        (strength or 0.0) * left**2 if by_load else 2.0 * pi / 4.0 * (1e3 * (bar or 0.0)) ** 2
    ) or 1.0
    damage = 0.0
    for share, mean, moments in seas:
        bears = 10.0 ** (curve.logarithm - (curve.by_mean * mean / unit if by_load else 0.0))
        damage += share * YEAR * dirlik((moments / unit**2).tolist(), curve.slope) / bears
    if not damage > 0.0:
        return PieceFatigue(index, label, 0.0, None, None, None, name, source, None)
    life, low, high = ((1.0 + off) ** -curve.slope / damage for off in (0.0, BAND, -BAND))
    return PieceFatigue(index, label, damage, life, low, high, name, source, None)
