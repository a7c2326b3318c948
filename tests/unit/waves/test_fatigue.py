"""Fatigue by Dirlik against rainflow counts of simulated tensions, closed forms and hand sums."""

from itertools import pairwise
from math import gamma, pi, sqrt
from typing import get_args

import numpy as np
import pytest

from calm.files import Cable, Chain
from calm.files.definition import FatigueKeys
from calm.waves.fatigue import (
    CURVES,
    YEAR,
    curve_of,
    dirlik,
    fatigue_of,
    moments_of,
    narrow_band,
)


def rainflow(series):
    """Ranges of full cycles by the four-point method, and of the residue as half cycles (0.5)."""
    turns = series[np.r_[True, np.diff(np.sign(np.diff(series))) != 0, True]]
    stack, ranges = [], []
    for turn in turns:
        stack.append(turn)
        while len(stack) >= 4:
            inner = abs(stack[-2] - stack[-3])
            if inner > abs(stack[-1] - stack[-2]) or inner > abs(stack[-3] - stack[-4]):
                break
            ranges.append((inner, 1.0))
            del stack[-3:-1]
    ranges += [(abs(b - a), 0.5) for a, b in pairwise(stack)]
    return np.array(ranges)


def simulated(omega, density, seed, count=2**18, step=0.25):
    """A Gaussian series of a spectrum, by Fourier coefficients of random phase and size."""
    rng = np.random.default_rng(seed)
    at = 2.0 * pi * np.fft.rfftfreq(count, step)
    width = at[1]
    amplitude = np.sqrt(np.interp(at, omega, density, left=0.0, right=0.0) * width / 2.0)
    noise = rng.normal(size=(2, len(at)))
    return np.fft.irfft(amplitude * (noise[0] + 1j * noise[1]) * count / sqrt(2.0)), step


def bimodal(omega):
    """Swell and wind sea of like variance: a broad band, where a narrow one is far off."""
    first = np.exp(-0.5 * ((omega - 0.5) / 0.05) ** 2)
    return first + 0.5 * np.exp(-0.5 * ((omega - 2.0) / 0.2) ** 2)


def hill(omega):
    return omega**-5.0 * np.exp(-1.25 * (0.6 / omega) ** 4)


@pytest.mark.parametrize("shape", [bimodal, hill])
@pytest.mark.parametrize("slope", [3.0, 4.09, 5.05])
def test_dirlik_against_rainflow_of_a_simulated_series(shape, slope):
    """Within 15 %: Dirlik's own fit is good to some 10 %, a series of 18 hours to 5 %."""
    omega = np.linspace(0.2, 4.0, 2000)
    density = shape(omega)
    moments = moments_of(omega, density * (omega[1] - omega[0]))
    series, step = simulated(omega, density, seed=7)
    assert series.std() == pytest.approx(sqrt(moments[0]), rel=0.02)
    ranges, counts = rainflow(series).T
    counted = float((counts * ranges**slope).sum()) / (len(series) * step)
    assert dirlik(moments, slope) == pytest.approx(counted, rel=0.15)
    assert narrow_band(moments, slope) > counted


def test_a_narrow_band_has_the_ranges_of_rayleigh():
    """Both forms agree where the band is narrow: ν0 (2 √(2 m0))^m Γ(1 + m/2)."""
    omega = np.linspace(0.99, 1.01, 201)
    moments = moments_of(omega, np.exp(-0.5 * ((omega - 1.0) / 0.002) ** 2))
    for slope in (3.0, 4.0, 5.0):
        closed = (2.0 * sqrt(2.0 * moments[0])) ** slope * gamma(1.0 + slope / 2.0) / (2.0 * pi)
        assert narrow_band(moments, slope) == pytest.approx(closed, rel=1e-4)
        # Dirlik's three distributions join at a narrow band to some per cent
        assert dirlik(moments, slope) == pytest.approx(closed, rel=0.05)
    assert dirlik(np.zeros(4), 3.0) == narrow_band(np.zeros(4), 3.0) == 0.0


def test_ranges_grow_as_the_tension():
    moments = moments_of(np.linspace(0.3, 2.0, 50), np.ones(50))
    assert dirlik(9.0 * moments, 4.0) == pytest.approx(3.0**4 * dirlik(moments, 4.0), rel=1e-12)


def chain(**more):
    return Chain.model_validate({"kind": "chain", "diameter": "13 mm", **more})


def rope(**more):
    return Cable.model_validate({"kind": "cable", "diameter": "8 mm", "weight": "2 N/m", **more})


WORN = {"fatigue": {"corrosion": "1 mm"}}


def narrow(deviation, omega=0.8):
    return np.array([deviation**2, *(deviation**2 * omega**power for power in (1, 2, 4))])


def test_miner_adds_up_the_seas_of_a_table():
    """A chain of 13 mm by hand: stress over both bars, N = 6.0e10 S^-3, cycles of 2π/0.8 s."""
    area = 2.0 * pi / 4.0 * 13.0**2
    expected = 0.0
    seas = [(0.7, 3000.0, narrow(400.0)), (0.3, 3000.0, narrow(1200.0))]
    for share, deviation in ((0.7, 400.0), (0.3, 1200.0)):
        each = (2.0 * sqrt(2.0) * deviation / area) ** 3 * gamma(2.5) / 6.0e10
        expected += share * YEAR * 0.8 / (2.0 * pi) * each
    found = fatigue_of(chain(), 1, "chain", seas)
    assert found.damage_per_year == pytest.approx(expected, rel=1e-9)
    assert found.life == pytest.approx(1.0 / expected, rel=1e-9)
    # ± 15 % of the deviations
    assert found.life_low == pytest.approx(found.life / 1.15**3, rel=1e-9)
    assert found.life_high == pytest.approx(found.life / 0.85**3, rel=1e-9)


def test_corrosion_shortens_the_life():
    """A millimetre off 13 mm of chain: its stress by the square; of wire its strength."""
    seas = [(1.0, 3000.0, narrow(800.0))]
    new, worn = (fatigue_of(chain(**more), 1, "c", seas) for more in ({}, WORN))
    assert worn.life == pytest.approx(new.life * (12.0 / 13.0) ** 6, rel=1e-9)
    given = {"material": "galvanised steel", "breaking_load": "40 kN"}
    new, worn = (
        fatigue_of(rope(**given, **more), 1, "w", [(1.0, 0.0, narrow(800.0))])
        for more in ({}, WORN)
    )
    assert worn.life == pytest.approx(new.life * (7.0 / 8.0) ** (2.0 * 4.09), rel=1e-9)
    gone = fatigue_of(chain(fatigue={"corrosion": "13 mm"}), 1, "c", seas)
    assert gone.life is None
    assert "consume its whole diameter" in gone.unknown


def test_wire_bears_fewer_cycles_about_a_greater_mean():
    """API RP 2SK: log10 K falls by 2.79 of the mean over the breaking load."""
    wire = rope(material="galvanised steel", breaking_load="50 kN")
    lives = [fatigue_of(wire, 1, "wire", [(1.0, m, narrow(900.0))]).life for m in (0.0, 1e4)]
    assert lives[0] / lives[1] == pytest.approx(10.0 ** (2.79 * 0.2), rel=1e-9)


def test_which_curve_is_whose():
    assert curve_of(chain()) == "dnv-studless-chain"
    assert curve_of(rope(material="galvanised steel, polyethylene jacket")) == "api-stranded-wire"
    assert curve_of(rope(material="polyester")) == "dnv-polyester"
    assert curve_of(rope(material="nylon")) is None
    assert curve_of(rope()) is None
    assert curve_of(chain(fatigue={"curve": "dnv-stud-chain"})) == "dnv-stud-chain"
    (named, _) = get_args(FatigueKeys.model_fields["curve"].annotation)
    names = get_args(named)
    assert set(names) == set(CURVES)


@pytest.mark.parametrize(
    ("component", "reason"),
    [
        (rope(material="nylon", breaking_load="50 kN"), "no published curve"),
        (rope(material="polyester"), "breaking load"),
        (rope(material="steel", fatigue={"curve": "dnv-stud-chain"}), "stress"),
    ],
)
def test_what_is_not_known_has_no_life(component, reason):
    found = fatigue_of(component, 1, "it", [(1.0, 3000.0, narrow(400.0))])
    assert found.life is None
    assert found.damage_per_year is None
    assert reason in found.unknown


def test_what_is_still_has_no_damage_and_no_end():
    found = fatigue_of(chain(), 1, "chain", [(1.0, 3000.0, np.zeros(4))])
    assert (found.damage_per_year, found.life, found.unknown) == (0.0, None, None)


@pytest.mark.parametrize(
    ("curve", "power", "factor"),
    [("sots-shackle", 3.7, 1.5), ("sots-peened-shackle", 3.7, 2.25), ("sots-link", 3.8, 1.7),
     ("sots-wire", 4.6, 2.4)],
)  # fmt: skip
def test_shackles_and_links_as_the_southern_ocean_time_series_has_them(curve, power, factor):
    """A cycle of a narrow band does (√2 σ / (factor U))^q Γ(1 + q/2); its own evaluation."""
    deviation, breaking, period = 2500.0, 28_500.0 * 9.81, 6.0
    omega = 2.0 * pi / period
    moments = deviation**2 * omega ** np.array([0.0, 1.0, 2.0, 4.0])
    each = (sqrt(2.0) * deviation / (factor * breaking)) ** power * gamma(1.0 + power / 2.0)
    shackle = Cable(
        kind="cable", diameter="20 mm", weight="1 N/m", breaking_load=f"{breaking} N",
        fatigue={"curve": curve},
    )  # fmt: skip
    found = fatigue_of(shackle, 0, "shackle", [(1.0, 1e4, moments)])
    assert found.damage_per_year == pytest.approx(each * YEAR / period, rel=1e-6)
