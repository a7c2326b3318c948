"""Waves up to another cut-off frequency, and the band of measured tensions."""

from math import sqrt
from pathlib import Path

import numpy as np
import pytest

from calm.case import load
from calm.records import sea_states
from calm.records.sea_states import spectrum_of
from calm.shipped import shipped_folder
from calm.waves.analysis import analyse
from calm.waves.fatigue import greatest_of
from calm.waves.measured import HIGHEST_LOW_SEA, measured_band
from calm.waves.response import WaveResponse

TAUT = f"{shipped_folder('lines')}/taut-nylon-surface.yaml"
SEA = spectrum_of("bretschneider", 4.0, 9.0, 3.3)


def of_a_constant_spectrum(first, last, count):
    """A response of 1 to waves of 1 m² s/rad between two frequencies."""
    omega = np.geomspace(first, last, count)
    steps = np.diff(omega, prepend=omega[0], append=omega[-1])
    one = np.ones((count, 1), complex)
    weight = 0.5 * (steps[:-1] + steps[1:])
    return WaveResponse(omega, weight, one[:, :, None], one, one[:, 0])


@pytest.mark.parametrize("limit", [0.7, 2.5, 4.99, 5.0, 9.0])
def test_waves_below_a_frequency_have_their_share_of_the_variance(limit):
    """Of a constant spectrum from 0.5 to 5 rad/s: the limit, or 5, less 0.5."""
    whole = of_a_constant_spectrum(0.5, 5.0, 40)
    deviation, _ = whole.below(limit).moments(whole.pull)
    assert deviation[0] == pytest.approx(sqrt(min(limit, 5.0) - 0.5), rel=1e-9)


def test_two_bands_of_waves_have_the_variance_of_both():
    low, high = of_a_constant_spectrum(0.5, 2.0, 20), of_a_constant_spectrum(2.0, 4.0, 10)
    both = low.joined(high)
    deviation, period = both.moments(both.pull)
    assert deviation[0] == pytest.approx(sqrt(3.5), rel=1e-9)
    second = (4.0**3 - 0.5**3) / 3.0
    assert period[0] == pytest.approx(2.0 * np.pi * sqrt(3.5 / second), rel=5e-3)


@pytest.fixture(scope="module")
def taut():
    return load(TAUT)


@pytest.fixture(scope="module")
def state(taut):
    return analyse(taut.leg, [SEA], 300.0).states[0]


@pytest.mark.parametrize(("name", "factor"), [("half_cut_off", 0.5), ("twice_cut_off", 2.0)])
def test_another_cut_off_as_if_it_were_solved_for(taut, state, monkeypatch, name, factor):
    """Within 3 %: the drag stays that of the cut-off itself, elements and frequencies are fewer."""
    monkeypatch.setattr(sea_states, "BETWEEN", (0.5, 1e9))
    monkeypatch.setattr(sea_states, "LARGEST_FREQUENCY", factor * state.cut_off)
    (solved,) = analyse(taut.leg, [SEA], 300.0).states
    assert solved.cut_off == pytest.approx(factor * state.cut_off)
    for quick, row in zip(state.components, solved.components, strict=True):
        loads = getattr(quick, name)
        for figure in ("tension_std", "tension_max", "tension_min", "greatest", "least"):
            assert getattr(loads, figure) == pytest.approx(getattr(row, figure), rel=0.03)
    assert state.components[0].half_cut_off.tension_std < 0.95 * state.components[0].tension_std
    assert state.components[0].twice_cut_off.tension_std > 1.05 * state.components[0].tension_std


def test_lives_follow_the_cut_off(taut):
    (wire,) = [one for one in analyse(taut.leg, [SEA], 300.0).fatigue if one.label == "wire"]
    assert wire.life_twice_cut_off < wire.life < wire.life_half_cut_off
    assert wire.life_half_cut_off > 1.5 * wire.life  # by the fourth power of the range


def test_the_cut_off_is_twelve_times_the_peak_and_10_rad_s_at_most():
    assert SEA.cut_off == pytest.approx(12.0 * 2.0 * np.pi / 9.0)
    assert spectrum_of("bretschneider", 1.0, 4.0, 3.3).cut_off == 10.0
    assert SEA.frequencies(7)[-1] == pytest.approx(SEA.cut_off)


def test_tensions_at_the_ends_of_the_measured_band(state):
    """Deviations times the ends of the band; the extremes as far from the mean as they make them.

    The float of the shipped line follows every wave.
    """
    assert state.band == measured_band(4.0, "follows")
    for row in state.components:
        for loads, factor in ((row.measured_low, state.band.low), (row.measured_high, 0.7)):
            assert loads.tension_std == pytest.approx(factor * row.tension_std, rel=1e-12)
            most = greatest_of(factor * row.tension_std, row.zero_crossing_period, 10_800.0)
            assert loads.tension_max == pytest.approx(row.tension_mean + most, rel=1e-12)
            assert loads.tension_min == pytest.approx(row.tension_mean - most, rel=1e-12)
            assert row.least <= loads.least <= loads.tension_min
            assert loads.tension_max <= loads.greatest <= row.greatest


def test_low_seas_and_high_seas_have_bands_of_their_own():
    low, high = measured_band(HIGHEST_LOW_SEA, "filtered"), measured_band(5.1, "filtered")
    assert (low.low, low.high, low.to_height) == (0.57, 1.0, 5.0)
    assert (high.low, high.high, high.from_height) == (0.74, 1.1, 5.0)
    assert measured_band(0.3, "filtered") == low
    assert measured_band(14.0, "filtered") == high


def test_no_band_below_the_surface_nor_of_a_response_that_is_given(taut):
    below = load(f"{shipped_folder('lines')}/tidal-adcp.yaml")
    (state,) = analyse(below.leg, [SEA], 90.0).states
    assert state.band is None
    assert {(row.measured_low, row.measured_high) for row in state.components} == {(None, None)}
    given = 'rao: {"0.1": [1, 0 deg], "12": [1, 0 deg]}'
    own = load(TAUT, text=Path(TAUT).read_text().replace("heave: follows", given))
    (state,) = analyse(own.leg, [SEA], 300.0).states
    assert state.band is None
