"""Sea states: spectra of the elevation of the sea, and the waves that they are made of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import exp, log, pi, sqrt
from pathlib import Path

import numpy as np

from calm.errors import InputError, Problem, UsageError
from calm.physics.line import Floats
from calm.records.delimited import read_table

SPECTRA = ("bretschneider", "jonswap", "pierson-moskowitz")
"""Spectra by name."""

STEEPEST = 1.0 / 7.0
"""Height over length of a wave that breaks (Michell 1893); a sea is far below it."""

HIGHEST, LONGEST_PERIOD = 30.0, 30.0
"""Beyond every significant height and peak period measured: 19 m by a buoy (WMO 2016) [m], [s]."""

BETWEEN = 0.5, 12.0
"""Frequencies solved for, as multiples of that of the peak: beyond them a sea of Bretschneider's
form has less than 1e-4 of its variance."""

LARGEST_FREQUENCY = 10.0
"""Above it lines are not solved for [rad/s]."""


@dataclass(frozen=True)
class SeaState:
    """Represent a sea by its spectrum.

    Attributes
    ----------
    significant_height : Hs, four times the standard deviation of the elevation [m]
    peak_period : Tp [s]
    density : spectrum of the elevation by angular frequency [rad/s], one-sided [m² s/rad]
    share : of the time, where it is one of several
    """

    significant_height: float
    peak_period: float
    density: Callable[[Floats], Floats]
    share: float = 1.0

    def frequencies(self, count: int) -> Floats:
        """Return angular frequencies to solve for [rad/s], evenly spread in their logarithm."""
        peak = 2.0 * pi / self.peak_period
        low, high = BETWEEN
        return np.geomspace(low * peak, min(high * peak, LARGEST_FREQUENCY), count)


def bretschneider(height: float, period: float) -> Callable[[Floats], Floats]:
    """Return the spectrum of a growing or a full sea, by Hs [m] and Tp [s].

    S = 5/16 Hs² ωp⁴ ω⁻⁵ exp(-5/4 (ωp/ω)⁴): Bretschneider 1959, the ITTC spectrum of two parameters.
    """
    peak = 2.0 * pi / period

    def density(omega: Floats) -> Floats:
        ratio = peak / omega
        return 5.0 / 16.0 * height**2 / omega * ratio**4 * np.exp(-1.25 * ratio**4)

    return density


def jonswap(height: float, period: float, gamma: float = 3.3) -> Callable[[Floats], Floats]:
    """Return the spectrum of a sea short of its fetch, by Hs [m], Tp [s] and its peakedness.

    Bretschneider's times gamma^exp(-(ω - ωp)²/(2 σ² ωp²)), σ 0.07 below the peak and 0.09 above it
    (Hasselmann and others 1973), normalised so that Hs is kept.
    """
    peak, plain = 2.0 * pi / period, bretschneider(height, period)

    def shape(omega: Floats) -> Floats:
        width = np.where(omega <= peak, 0.07, 0.09)
        raised = np.exp(-((omega / peak - 1.0) ** 2) / (2.0 * width**2))
        return plain(omega) * gamma**raised

    fine = np.geomspace(0.3 * peak, 30.0 * peak, 4000)
    scale = (height / 4.0) ** 2 / float(np.trapezoid(shape(fine), fine))
    return lambda omega: scale * shape(omega)


def full_sea_period(height: float) -> float:
    """Return Tp of a fully grown sea by Hs [s]; Pierson and Moskowitz 1964: ωp² = 0.16 g/Hs."""
    return 2.0 * pi / sqrt(0.16 * 9.80665 / height)


def spectrum_of(kind: str, height: float, period: float, gamma: float) -> SeaState:
    """Return the sea of a named spectrum.

    Parameters
    ----------
    kind : "bretschneider", "jonswap" or "pierson-moskowitz"
    height, period : Hs [m] and Tp [s]
    gamma : peakedness of "jonswap"

    Raises
    ------
    UsageError
        Waves higher, longer or steeper than there are.
    """
    if height > HIGHEST or period > LONGEST_PERIOD:
        raise UsageError(
            f"waves of {height:g} m and {period:g} s: no sea is higher than {HIGHEST:g} m or "
            f"longer than {LONGEST_PERIOD:g} s"
        )
    length = 9.80665 * period**2 / (2.0 * pi)
    if height > STEEPEST * length:
        raise UsageError(
            f"waves of {height:g} m and {period:g} s would break: {length:.1f} m long, they are "
            f"{STEEPEST * length:.1f} m high at most"
        )
    form = jonswap(height, period, gamma) if kind == "jonswap" else bretschneider(height, period)
    return SeaState(height, period, form)


def measured_spectrum(path: Path) -> SeaState:
    """Return the sea of a table with columns ``frequency[Hz]`` and ``density[m^2/Hz]``.

    Raises
    ------
    InputError
        It is no such table, or its frequencies do not grow.
    """
    rows = _figures(path, ("frequency[Hz]", "density[m^2/Hz]"))
    frequency, density = np.array(rows).T
    if len(rows) < 3 or np.any(np.diff(frequency) <= 0.0) or frequency[0] < 0.0:
        raise InputError([Problem(str(path), 2, 1, "needs three frequencies or more that grow")])
    if np.any(density < 0.0) or not density.any():
        raise InputError([Problem(str(path), 2, 2, "densities are not negative, nor all zero")])
    omega, spectral = 2.0 * pi * frequency, density / (2.0 * pi)
    height = 4.0 * sqrt(float(np.trapezoid(spectral, omega)))
    period = 1.0 / float(frequency[int(density.argmax())])
    return SeaState(height, period, lambda at: np.interp(at, omega, spectral, left=0.0, right=0.0))


def scatter_states(path: Path, kind: str, gamma: float) -> list[SeaState]:
    """Return the seas of a scatter table, each with its share of the time.

    Its columns are ``significant_wave_height[m],peak_period[s],share``; shares may also be counts.

    Raises
    ------
    InputError
        It is no such table; every mistake with its line.
    """
    rows = _figures(path, ("significant_wave_height[m]", "peak_period[s]", "share"))
    problems = []
    states = []
    whole = sum(max(row[2], 0.0) for row in rows)
    for number, (height, period, share) in enumerate(rows, 2):
        if height <= 0.0 or period <= 0.0 or share < 0.0:
            message = "height and period are above 0, and a share is not negative"
            problems.append(Problem(str(path), number, 1, message))
            continue
        try:
            sea = spectrum_of(kind, height, period, gamma)
        except UsageError as error:
            problems.append(Problem(str(path), number, 1, str(error)))
            continue
        if share > 0.0:
            states.append(SeaState(height, period, sea.density, share / whole))
    if problems or not states:
        raise InputError(problems or [Problem(str(path), 1, 1, "no sea has a share of the time")])
    return states


def _figures(path: Path, names: tuple[str, ...]) -> list[tuple[float, ...]]:
    """Return the rows of a table by the names of its columns."""
    example = ",".join(names)
    table = read_table(path, example)
    header = [cell.strip() for cell in table.header.cells]
    missing = [name for name in names if name not in header]
    if missing:
        message = f"no column `{'`, `'.join(missing)}`; write {example}"
        raise InputError([Problem(str(path), table.header.number, 1, message)])
    places = [header.index(name) for name in names]
    rows, problems = [], []
    for row in table.rows:
        try:
            rows.append(tuple(float(row.cells[place]) for place in places))
        except (ValueError, IndexError):
            problems.append(Problem(str(path), row.number, 1, f"not numbers as in {example}"))
    if problems:
        raise InputError(problems)
    return rows


def wave_numbers(omega: Floats, depth: float, gravity: float) -> Floats:
    """Return the wave numbers of linear waves [1/m]: ω² = g k tanh(k h), by Newton's method.

    Parameters
    ----------
    omega : (f,) angular frequencies [rad/s]
    depth : of the water [m]
    gravity : [m/s²]
    """
    deep = omega**2 / gravity
    k = deep / np.sqrt(np.tanh(np.minimum(deep * depth, 50.0)))
    for _ in range(20):
        tanh = np.tanh(np.minimum(k * depth, 50.0))
        slope = gravity * (tanh + k * depth * (1.0 - tanh**2))
        k = k - (gravity * k * tanh - omega**2) / slope
    return k


def greatest_of(deviation: float, period: float, duration: float) -> float:
    """Return the most probable greatest departure of a Gaussian process from its mean.

    σ √(2 ln N) of N = duration / zero-crossing period (Longuet-Higgins 1952).

    Parameters
    ----------
    deviation : standard deviation σ, in the unit of the result
    period : between upward crossings of the mean [s]
    duration : [s]
    """
    return deviation * sqrt(2.0 * log(max(duration / period, 1.0 + 1e-9)))


def passing_probability(margin: float, deviation: float, period: float, duration: float) -> float:
    """Return how probable it is that a Gaussian process passes a margin from its mean in a time.

    1 - exp(-N exp(-½ (margin/σ)²)), N as in `greatest_of` (Rice 1945).

    Parameters
    ----------
    margin, deviation : from the mean, and the standard deviation, in one unit
    period, duration : [s]
    """
    if deviation <= 0.0:
        return 0.0 if margin > 0.0 else 1.0
    if margin <= 0.0:
        return 1.0
    return 1.0 - exp(-duration / period * exp(-0.5 * (margin / deviation) ** 2))
