"""Seas: spectra by their closed forms, tables of them, and what no sea can be."""

from math import pi, sqrt

import numpy as np
import pytest

from calm.errors import InputError, UsageError
from calm.records import sea_states


@pytest.mark.parametrize("kind", sea_states.SPECTRA)
def test_spectra_hold_their_height_and_peak(kind):
    own = kind == "ochi-hubble"
    sea = sea_states.spectrum_of(kind, 4.0, None if own else 9.0, 3.3)
    omega = np.geomspace(0.1, 60.0, 40_000)
    density = sea.density(omega)
    # Ochi and Hubble's shares of the height are rounded: 0.84² + 0.54² is 0.997
    assert np.trapezoid(density, omega) == pytest.approx(1.0, rel=4e-3 if own else 2e-4)
    assert omega[density.argmax()] == pytest.approx(2.0 * pi / sea.peak_period, rel=1e-3)


def test_swell_and_sea_of_ochi_and_hubble():
    """Each part holds its own height and peak; λ of 1 is Bretschneider's form."""
    omega = np.geomspace(0.05, 80.0, 60_000)
    for narrow in (1.0, 1.4, 3.0):
        density = sea_states.ochi_hubble(((3.0, 12.0, narrow),))(omega)
        assert 4.0 * sqrt(np.trapezoid(density, omega)) == pytest.approx(3.0, rel=1e-3)
        assert omega[density.argmax()] == pytest.approx(2.0 * pi / 12.0, rel=1e-3)
    one = sea_states.ochi_hubble(((3.0, 12.0, 1.0),))(omega)
    assert one == pytest.approx(sea_states.bretschneider(3.0, 12.0)(omega), rel=1e-12)
    sea = sea_states.spectrum_of("ochi-hubble", 4.0, None, 3.3)
    # the swell, ωp 0.70 e^(-0.046 Hs), is inside what is solved for
    assert sea.frequencies(64)[0] < 0.6 * 0.70 * np.exp(-0.184)
    with pytest.raises(UsageError, match="remove the period"):
        sea_states.spectrum_of("ochi-hubble", 4.0, 9.0, 3.3)
    with pytest.raises(UsageError, match="must not exceed"):
        sea_states.spectrum_of("ochi-hubble", 40.0, None, 3.3)


def test_a_swell_under_a_sea():
    """Variances add up; each part keeps its own peak, and the frequencies reach past both."""
    sea = sea_states.spectrum_of("jonswap", 3.0, 7.0, 3.3)
    both = sea_states.with_swell(sea, 4.0, 15.0)
    omega = np.geomspace(0.05, 60.0, 40_000)
    density = both.density(omega)
    assert both.significant_height == 5.0
    assert 4.0 * sqrt(np.trapezoid(density, omega)) == pytest.approx(5.0, rel=1e-3)
    assert both.peak_period == pytest.approx(15.0, rel=0.01)
    later = omega > 0.65
    assert omega[later][density[later].argmax()] == pytest.approx(2.0 * pi / 7.0, rel=0.01)
    solved = both.frequencies(64)
    assert solved[0] == pytest.approx(pi / 15.0)
    assert solved[-1] == pytest.approx(min(12.0 * 2.0 * pi / 7.0, 10.0))
    for height, period, message in (
        (2.0, 6.0, "a longer period"),
        (40.0, 14.0, "maximum wave height"),
    ):
        with pytest.raises(UsageError, match=message):
            sea_states.with_swell(sea, height, period)


def test_peakedness_of_one_is_a_full_sea():
    omega = np.geomspace(0.2, 5.0, 50)
    one, plain = sea_states.jonswap(4.0, 9.0, 1.0)(omega), sea_states.bretschneider(4.0, 9.0)(omega)
    assert one == pytest.approx(plain, rel=2e-4)


def test_waves_that_would_break_are_refused():
    with pytest.raises(UsageError, match="would break"):
        sea_states.spectrum_of("bretschneider", 5.0, 4.0, 3.3)


def test_tables_of_seas(tmp_path):
    table = tmp_path / "seas.csv"
    table.write_text("significant_wave_height[m],peak_period[s],share\n2,7,30\n4,9,10\n6,11,0\n")
    states = sea_states.scatter_states(table, "bretschneider", 3.3)
    assert [(one.significant_height, one.share) for one in states] == [(2.0, 0.75), (4.0, 0.25)]
    table.write_text("significant_wave_height[m],peak_period[s],share\n-2,7,1\n9,4,1\n2,x,1\n")
    with pytest.raises(InputError) as refused:
        sea_states.scatter_states(table, "bretschneider", 3.3)
    assert [problem.line for problem in refused.value.problems] == [4]
    table.write_text("significant_wave_height[m],peak_period[s],share\n-2,7,1\n9,4,1\n")
    with pytest.raises(InputError) as refused:
        sea_states.scatter_states(table, "bretschneider", 3.3)
    assert [problem.line for problem in refused.value.problems] == [2, 3]


def test_a_measured_spectrum(tmp_path):
    table = tmp_path / "sea.csv"
    sea = sea_states.spectrum_of("bretschneider", 3.0, 8.0, 3.3)
    frequency = np.linspace(0.03, 1.5, 600)
    density = sea.density(2.0 * pi * frequency) * 2.0 * pi
    rows = "\n".join(f"{f:.6g},{s:.6g}" for f, s in zip(frequency, density, strict=True))
    table.write_text(f"frequency[Hz],density[m^2/Hz]\n{rows}\n")
    read = sea_states.measured_spectrum(table)
    assert read.significant_height == pytest.approx(3.0, rel=2e-3)
    assert read.peak_period == pytest.approx(8.0, rel=0.02)
    with pytest.raises(InputError, match="write frequency"):
        table.write_text("frequency[rad/s],density[m^2/Hz]\n1,2\n")
        sea_states.measured_spectrum(table)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (
            "0.1,2\n0.05,1\n0.2,-1",
            "sea.csv:3:1: frequencies must increase and must not be negative",
        ),
        ("0.1,2\n0.05,1\n0.2,-1", "sea.csv:4:2: a spectral density must not be negative"),
        ("0.1,2\n0.2,nan\n0.3,1", "sea.csv:3:1: the row must contain numbers"),
        ("0.1,0\n0.2,0\n0.3,0", "densities that are not all zero"),
        ("0.1,0", "needs three frequencies or more"),
        ("1,0\n2,0.01\n3,0", "that can be solved is 2 s; check its units"),
        (
            "0.1,0\n0.2,1\n0.3,0\n4,.02\n9,.02",
            "of the variance of the spectrum is above 1.6 Hz; check its units",
        ),
        ("0.1,0\n0.3,9\n0.5,0", "would break"),
        ("0,9\n0.1,1\n0.2,0", "the maximum wave height is 30 m, and the maximum period is 30 s"),
    ],
)
def test_spectra_that_cannot_be(tmp_path, rows, message):
    table = tmp_path / "sea.csv"
    table.write_text(f"frequency[Hz],density[m^2/Hz]\n{rows}\n")
    with pytest.raises(InputError) as refused:
        sea_states.measured_spectrum(table)
    assert message in str(refused.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "significant_wave_height[m],peak_period[s],share\n# calm\n2,nan,1\n",
            ":3:1: the row must contain numbers",
        ),
        ("significant_wave_height[m],peak_period[s],share\n2,7,.3\n4,9,.1\n", "add up to 0.4"),
        (
            "significant_wave_height[ft],peak_period[s],share\n6,7,1\n",
            "significant_wave_height[ft]",
        ),
        ("significant_wave_height[m],Tz[s],share\n2,7,1\n", "Tp is 1.41 times"),
        (
            "significant_wave_height[m],peak_period[s],share\n0.1,0.9,1\n",
            "solved is 2 s",
        ),
    ],
)
def test_tables_of_seas_that_cannot_be(tmp_path, text, message):
    table = tmp_path / "seas.csv"
    table.write_text(text)
    with pytest.raises(InputError) as refused:
        sea_states.scatter_states(table, "bretschneider", 3.3)
    assert message in str(refused.value)
