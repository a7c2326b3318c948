"""Sea states and their wave spectra: named spectra, measured spectra and scatter tables."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import exp, isfinite, nan, pi, sqrt
from math import gamma as gamma_function
from pathlib import Path
from typing import Any

import numpy as np

from calm.errors import InputError, Problem, UsageError, refused
from calm.physics.line import Floats
from calm.records.cf_files import UnreadableError, holds_arrays, known_values, open_current, reading
from calm.records.delimited import read_table

Density = Callable[[Floats], Floats]

SPECTRA = ("bretschneider", "jonswap", "pierson-moskowitz", "ochi-hubble")
"""Names of the spectra."""

OF_HEIGHT = ("pierson-moskowitz", "ochi-hubble")
"""Names of the spectra that follow from the significant height alone."""

STEEPEST = 1.0 / 7.0
"""Height of a breaking wave divided by the wavelength (Michell 1893)."""

HIGHEST, LONGEST_PERIOD = 30.0, 30.0
"""Largest accepted significant height [m] and peak period [s].

Both limits exceed all measured values. The highest sea measured by a buoy had 19 m (WMO 2016).
"""

BETWEEN = 0.5, 12.0
"""Frequency range of the solution, as multiples of the peak frequency.

Outside this range, a Bretschneider spectrum has less than 1e-4 of its variance.
"""

UNSEEN = 1e-3
"""Share of the variance of a measured sea that may lie below the frequencies of the solution."""

PEAK_BY_MEAN = "Tp is 1.41 times the mean zero-crossing period Tz, or 1.29 Tz for jonswap"
"""Advice for users who have Tz instead of Tp, for messages.

The ratios Tp/Tz follow from the spectral moments: 1.286 for jonswap, and 1.408 for other spectra.
"""

SHARES = 0.02
"""Tolerance for the sum of the shares in a scatter table; the shares may be rounded."""

CUT_OFF = 0.5
"""Largest accepted density at the last frequency of a measured spectrum, relative to the peak."""

_STANDARD_NAMES = (
    "sea_surface_wave_variance_spectral_density",
    "sea_surface_wave_directional_variance_spectral_density",
)
_SPECTRAL_NAMES = ("spectral_wave_density", "ef", "efth")

LARGEST_FREQUENCY = 10.0
"""Highest angular frequency of the solution [rad/s]."""

SHORTEST_PERIOD, BEYOND = 2.0, 0.02
"""Shortest accepted peak period [s], and largest accepted share of the variance of a measured sea
above `LARGEST_FREQUENCY`.

A sea with the shortest peak period has 1 % of its variance above `LARGEST_FREQUENCY`.
"""


@dataclass(frozen=True)
class SpectralForm:
    """A wave spectrum, stored as a function and its parameters.

    Two spectra are equal if the functions and the parameters are equal.
    """

    law: Callable[..., Floats]
    figures: tuple[Any, ...]

    def __call__(self, omega: Floats) -> Floats:
        return self.law(*self.figures, omega)


@dataclass(frozen=True)
class SeaState:
    """A sea state with its spectrum.

    Attributes
    ----------
    significant_height : Hs, four times the standard deviation of the elevation [m]
    peak_period : Tp [s]
    density : one-sided spectrum of the elevation [m² s/rad] over angular frequency [rad/s]
    share : fraction of time of this sea state in a set
    longest, shortest : longest and shortest peak period of a sea with several components [s]. For a
        measured sea, `longest` is the period that sets the first value of `frequencies` to the
        lowest frequency with energy
    """

    significant_height: float
    peak_period: float
    density: Density
    share: float = 1.0
    longest: float | None = None
    shortest: float | None = None

    def severity(self) -> tuple[float, float]:
        """Return a key to sort seas by height, and seas of equal height by steepness."""
        return self.significant_height, -self.peak_period

    @property
    def cut_off(self) -> float:
        """Highest angular frequency at which the response to waves is computed [rad/s]."""
        peak = 2.0 * pi / (self.shortest or self.peak_period)
        return min(BETWEEN[1] * peak, LARGEST_FREQUENCY)

    def frequencies(self, count: int) -> Floats:
        """Return `count` angular frequencies at which the response is computed [rad/s].

        The spacing is logarithmic.
        """
        first = 2.0 * pi / (self.longest or self.peak_period)
        return np.geomspace(BETWEEN[0] * first, self.cut_off, count)


def bretschneider(height: float, period: float) -> Density:
    """Return the spectrum of a growing or fully developed sea with Hs [m] and Tp [s].

    S = 5/16 Hs² ωp⁴ ω⁻⁵ exp(-5/4 (ωp/ω)⁴) (Bretschneider 1959; the two-parameter ITTC spectrum).
    """
    return SpectralForm(_gamma_form, (((height, 2.0 * pi / period, 1.0),),))


def ochi_hubble(parts: Sequence[tuple[float, float, float]]) -> Density:
    """Return the combined spectrum of swell and wind sea of Ochi and Hubble 1976.

    S = Σ ¼ ((4λ + 1)/4 ωp⁴)^λ / Γ(λ) Hs² ω^-(4λ+1) exp(-(4λ + 1)/4 (ωp/ω)⁴). Each component has Hs
    [m], Tp [s] and λ. A larger λ gives a narrower spectrum; λ = 1 is Bretschneider.
    """
    terms = tuple((height, 2.0 * pi / period, narrow) for height, period, narrow in parts)
    return SpectralForm(_gamma_form, (terms,))


def _gamma_form(parts: tuple[tuple[float, float, float], ...], omega: Floats) -> Floats:
    total = np.zeros(np.shape(omega))
    for height, peak, narrow in parts:
        ratio = (narrow + 0.25) * (peak / omega) ** 4
        total += 0.25 * height**2 / gamma_function(narrow) * ratio**narrow * np.exp(-ratio) / omega
    return total


def jonswap(height: float, period: float, gamma: float = 3.3) -> Density:
    """Return the JONSWAP spectrum of a fetch-limited sea with Hs [m], Tp [s] and peakedness gamma.

    The Bretschneider spectrum times gamma^exp(-(ω - ωp)²/(2 σ² ωp²)) is normalised to Hs. σ is 0.07
    below and 0.09 above the peak (Hasselmann and others 1973).
    """
    peak = 2.0 * pi / period
    fine = np.geomspace(0.3 * peak, 30.0 * peak, 4000)
    whole = float(np.trapezoid(_peaked(height, peak, gamma, fine), fine))
    return SpectralForm(_peaked, (height**2 / 4.0 / sqrt(whole), peak, gamma))


def _peaked(height: float, peak: float, gamma: float, omega: Floats) -> Floats:
    width = np.where(omega <= peak, 0.07, 0.09)
    raised = np.exp(-((omega / peak - 1.0) ** 2) / (2.0 * width**2))
    return _gamma_form(((height, peak, 1.0),), omega) * gamma**raised


def full_sea_period(height: float) -> float:
    """Return Tp [s] of a fully developed sea with a given Hs [m].

    The law of Pierson and Moskowitz 1964 is ωp² = 0.16 g/Hs.
    """
    return 2.0 * pi / sqrt(0.16 * 9.80665 / height)


def spectrum_of(kind: str, height: float, period: float | None, gamma: float = 3.3) -> SeaState:
    """Return the sea state of a named spectrum, from `SPECTRA`.

    `height` is Hs [m] and `period` Tp [s]; without a period, Tp follows from Hs. `gamma` is the
    peakedness of "jonswap".

    Raise UsageError if the waves are higher, longer, shorter or steeper than the limits, or if
    "ochi-hubble" has a period.
    """
    if kind == "ochi-hubble":
        if period is not None:
            raise UsageError(
                "the ochi-hubble spectrum derives its periods from the height; remove the period"
            )
        return _most_probable(height)
    period = full_sea_period(height) if period is None else period
    if wrong := _impossible(height, period):
        raise UsageError(wrong)
    form = jonswap(height, period, gamma) if kind == "jonswap" else bretschneider(height, period)
    return SeaState(height, period, form)


def _impossible(height: float, period: float) -> str | None:
    length, waves = 9.80665 * period**2 / (2.0 * pi), f"waves of {height:.3g} m and {period:.3g} s"
    if height > HIGHEST or period > LONGEST_PERIOD:
        return (
            f"{waves}: the maximum wave height is {HIGHEST:g} m, and the maximum period is "
            f"{LONGEST_PERIOD:g} s"
        )
    if period < SHORTEST_PERIOD:
        return f"{waves}: the shortest peak period that can be solved is {SHORTEST_PERIOD:g} s"
    if height > STEEPEST * length:
        highest = (
            f"at a wavelength of {length:.1f} m, the maximum height is {STEEPEST * length:.2f} m"
        )
        return f"{waves} would break: {highest}"
    return None


def doubted(sea: SeaState) -> str | None:
    """Return a remark if a sea is steeper than measured seas, else None.

    The maximum ratio of Hs to the wavelength at Tp is 1/15 up to 8 s, and 1/25 at 15 s
    (DNV-RP-C205, steepness criteria).
    """
    height, period = sea.significant_height, sea.peak_period
    steepness = 2.0 * pi * height / (9.80665 * period**2)
    if steepness <= float(np.interp(period, [8.0, 15.0], [1.0 / 15.0, 1.0 / 25.0])):
        return None
    return (
        f"Hs {height:.3g} m with Tp {period:.3g} s is steeper than any measured sea (1 in "
        f"{1.0 / steepness:.0f}). Check whether the period is a mean period ({PEAK_BY_MEAN}) and "
        "the height is in metres."
    )


def with_swell(sea: SeaState, height: float, period: float) -> SeaState:
    """Add a swell with Hs [m] and Tp [s], in the same direction, to a sea.

    The swell has the spectrum of Ochi and Hubble with λ = 3. Raise UsageError if the swell is
    impossible, or if the period does not exceed that of the sea.
    """
    spectrum_of("bretschneider", height, period, 1.0)
    if period <= sea.peak_period:
        raise UsageError(
            f"the swell of {period:g} s must have a longer period than the sea of "
            f"{sea.peak_period:g} s"
        )
    swell = ochi_hubble(((height, period, 3.0),))
    form = SpectralForm(_together, (sea.density, swell))
    whole = sqrt(sea.significant_height**2 + height**2)
    at = np.geomspace(pi / period, 4.0 * pi / sea.peak_period, 400)
    peak = 2.0 * pi / float(at[int(form(at).argmax())])
    first = period if sea.longest is None else max(period, sea.longest)
    return SeaState(whole, peak, form, sea.share, first, sea.shortest or sea.peak_period)


def _together(first: Density, second: Density, omega: Floats) -> Floats:
    return first(omega) + second(omega)


def _most_probable(height: float) -> SeaState:
    """Return the most probable sea state of Ochi and Hubble (1976) for a significant height [m].

    The sea state has a swell and a wind sea. The constants are from secondary sources.
    """
    if height > HIGHEST:
        raise UsageError(
            f"waves of {height:g} m are not possible; the wave height must not exceed {HIGHEST:g} m"
        )
    swell = 0.84 * height, 2.0 * pi / (0.70 * exp(-0.046 * height)), 3.0
    sea = 0.54 * height, 2.0 * pi / (1.15 * exp(-0.039 * height)), 1.54 * exp(-0.062 * height)
    form = ochi_hubble((swell, sea))
    at = 2.0 * pi / np.array([swell[1], sea[1]])
    peak = (swell, sea)[int(form(at).argmax())][1]
    return SeaState(height, peak, form, longest=swell[1], shortest=sea[1])


def measured_spectrum(path: Path) -> SeaState:
    """Read a measured spectrum from CSV, ``frequency[Hz],density[m^2/Hz]``, or from NetCDF.

    NetCDF files of NDBC and WAVEWATCH III are supported. If the file has several times, the
    spectrum with the highest waves is used. Raise InputError if the spectrum is invalid.
    """
    if holds_arrays(path):
        return _sea_of(path, *_spectral_arrays(path))
    rows = _numbered_rows(path, ("frequency[Hz]", "density[m^2/Hz]"))
    frequency, density = np.array([row for _, row in rows]).reshape(-1, 2).T
    return _sea_of(path, frequency, density, [line for line, _ in rows])


def _sea_of(path: Path, frequency: Floats, density: Floats, lines: Sequence[int] = ()) -> SeaState:
    """Return the sea state with given densities [m²/Hz] at frequencies [Hz].

    `lines` gives the file line of each value, for messages.
    """
    falls = np.diff(frequency, prepend=-1e-12) <= 0.0
    problems = [
        Problem(str(path), lines[int(row)] if lines else 0, column, message)
        for wrong, column, message in (
            (falls, 1, "frequencies must increase and must not be negative"),
            (~(density >= 0.0), 2, "a spectral density must not be negative"),
        )
        for row in np.flatnonzero(wrong)
    ]
    if len(frequency) < 3 or not density.any():
        message = "needs three frequencies or more, and densities that are not all zero"
        problems.append(Problem(str(path), 0, 0, message))
    if problems:
        raise InputError(problems)
    omega, spectral = 2.0 * pi * frequency, density / (2.0 * pi)
    parts = 0.5 * (spectral[1:] + spectral[:-1]) * np.diff(omega)
    height = 4.0 * sqrt(float(parts.sum()))
    wrong = _impossible(height, 1.0 / max(float(frequency[int(density.argmax())]), 1e-9))
    beyond = float(parts[omega[1:] > LARGEST_FREQUENCY].sum() / parts.sum())
    if wrong is None and beyond > BEYOND:
        wrong = (
            f"{beyond:.0%} of the variance of the spectrum is above "
            f"{LARGEST_FREQUENCY / (2.0 * pi):.2g} Hz"
        )
    if density[-1] > CUT_OFF * density.max():
        wrong = wrong or f"the spectrum is cut off at {frequency[-1]:.3g} Hz, near its peak"
    if wrong is not None:
        raise refused(path, f"{wrong}; check its units")
    lowest = omega[int(np.searchsorted(parts.cumsum(), UNSEEN * parts.sum()))]
    peak = float(omega[int(density.argmax())])
    first = max(float(lowest), 0.02 * peak)
    form = SpectralForm(_between, (tuple(omega.tolist()), tuple(spectral.tolist())))
    return SeaState(height, 2.0 * pi / peak, form, longest=2.0 * pi * BETWEEN[0] / first)


def _between(omega: Sequence[float], spectral: Sequence[float], at: Floats) -> Floats:
    return np.interp(at, omega, spectral, left=0.0, right=0.0)


def _spectral_arrays(path: Path) -> tuple[Floats, Floats]:
    """Read frequencies [Hz] and densities summed over all directions [m²/Hz] from NetCDF."""
    with reading(path), open_current(path) as data:
        names = [
            str(name)
            for name, variable in data.data_vars.items()
            if variable.attrs.get("standard_name") in _STANDARD_NAMES or name in _SPECTRAL_NAMES
        ]
        if not names:
            raise UnreadableError(
                "no spectrum of waves: no variable has the standard name "
                f"{' or '.join(_STANDARD_NAMES)}, nor is called {', '.join(_SPECTRAL_NAMES)}"
            )
        spectrum = data[names[0]]
        along = [str(each) for each in spectrum.dims if str(each).startswith("freq")]
        if not along or along[0] not in data.coords:
            raise UnreadableError(f"{names[0]} has no frequency dimension with values")
        values = spectrum.transpose(along[0], ...)
        for name in [str(each) for each in spectrum.dims if str(each).startswith("dir")]:
            count, unit = data.sizes[name], str(spectrum.attrs.get("units", ""))
            step = (2.0 * pi if "rad" in unit else 360.0) / count
            values = values.sum(name, skipna=False) * step
        density = known_values(values).reshape(values.sizes[along[0]], -1)
        frequency = np.asarray(data[along[0]].values, float)
        if "rad" in str(data[along[0]].attrs.get("units", "")):
            frequency, density = frequency / (2.0 * pi), density * 2.0 * pi
    density = density[:, np.isfinite(density).all(axis=0)]
    if not density.size:
        raise refused(path, "every spectrum in the file has gaps")
    return frequency, density[:, int(np.trapezoid(density, frequency, axis=0).argmax())]


def scatter_states(path: Path, kind: str, gamma: float = 3.3) -> list[SeaState]:
    """Return the sea states of a scatter table, each with its share of the time.

    The columns are ``significant_wave_height[m],peak_period[s],share``; shares may be counts. Raise
    InputError if the table has mistakes, and UsageError for "ochi-hubble".
    """
    rows = _numbered_rows(path, ("significant_wave_height[m]", "peak_period[s]", "share"))
    if kind == "ochi-hubble":
        raise UsageError(
            "the ochi-hubble spectrum has its own periods and cannot use those of a scatter table"
        )
    problems, states = [], []
    shares = [max(share, 0.0) for _, (*_, share) in rows]
    whole = sum(shares)
    for number, (height, period, share) in rows:
        if height <= 0.0 or period <= 0.0 or share < 0.0:
            message = "height and period must be above 0, and a share must not be negative"
            problems.append(Problem(str(path), number, 1, message))
            continue
        try:
            sea = spectrum_of(kind, height, period, gamma)
        except UsageError as error:
            problems.append(Problem(str(path), number, 1, str(error)))
            continue
        if share > 0.0:
            states.append(SeaState(height, period, sea.density, share / whole))
    if not problems and not states:
        problems.append(Problem(str(path), 1, 1, "no sea state has a share above 0"))
    counts = all(share == round(share) for share in shares)
    if not counts and min(abs(whole - 1.0), abs(whole / 100.0 - 1.0)) > SHARES:
        message = f"the shares add up to {whole:.4g}, not 1 or 100; include calm seas as low waves"
        problems.append(Problem(str(path), 1, 1, message))
    if problems:
        raise InputError(problems)
    return states


def _numbered_rows(path: Path, names: tuple[str, ...]) -> list[tuple[int, tuple[float, ...]]]:
    example = ",".join(names)
    table = read_table(path, example)
    header = [cell.strip() for cell in table.header.cells]
    missing = [name for name in names if name not in header]
    if missing:
        message = f"no column `{'`, `'.join(missing)}`; write {example}, not {','.join(header)}"
        if "peak_period[s]" in missing:
            message += f" ({PEAK_BY_MEAN})"
        raise InputError([table.header.problem(message)])
    places = [header.index(name) for name in names]
    rows, problems = [], []
    for row in table.rows:
        try:
            figures = tuple(float(row.cells[place]) for place in places)
        except (ValueError, IndexError):
            figures = (nan,)
        rows.append((row.number, figures))
        if not all(isfinite(each) for each in figures):
            problems.append(row.problem(f"the row must contain numbers, as in {example}"))
    if problems:
        raise InputError(problems)
    return rows
