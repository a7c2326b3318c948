"""Tensions below the buoys of five SOFS moorings in waves: measured, and of WHOI Cable in time.

Lines and measured tensions are in `sofs.py`, with their source.
"""

import numpy as np
import pytest

from calm.records.sea_states import spectrum_of
from calm.waves.analysis import analyse
from calm.waves.buoy import buoy_of
from calm.waves.lumped_line import lumped_line
from calm.waves.response import Waves, respond
from tests.validation.sofs import (
    KGF,
    MEASURED,
    at_the_top,
    holds_the_five_lines,
    mooring,
    ratios,
    seas,
)

pytestmark = pytest.mark.thorough


@pytest.fixture(scope="module")
def sofs5():
    return mooring("SOFS-5")


@pytest.fixture(scope="module")
def analysis(sofs5):
    return analyse(sofs5, seas(), 90.0)


def test_measured_deviations_of_the_tension(analysis):
    """SOFS-5 by its deck is within 15 %, with nothing fitted."""
    found = at_the_top(analysis) / MEASURED["SOFS-5"]
    assert found == pytest.approx(1.0, abs=0.15)
    assert float(found.mean()) == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize("heave", ["filtered", "follows"])
def test_the_band_holds_the_five_lines(heave):
    """`heave: panels` is looked at in `tests/peers/test_panels.py`."""
    holds_the_five_lines(heave)


def test_the_cages_of_sofs5_decide_its_agreement():
    """With their whole mass it is overestimated by a fifth, as the other lines are in high seas."""
    found = ratios("SOFS-5", whole_cages=True)
    assert list(found.values()) == pytest.approx([1.22] * 9, abs=0.08)
    others = [ratios(name)[6.5] for name in ("SOFS-1", "SOFS-3", "SOFS-4", "SOFS-6")]
    assert others == pytest.approx([1.19] * 4, abs=0.09)


def test_in_a_low_sea_the_period_decides():
    """SOFS-1, Hs 2.5 m: 103 kgf measured. The load cases have 6.1 s, a fully developed sea 7.9 s,
    other load cases of the same source 9.6 s (`wave-env.sh`, named for Orcina)."""
    grown = spectrum_of("pierson-moskowitz", 2.5, None, 3.3)
    given = [spectrum_of("bretschneider", 2.5, period, 3.3) for period in (6.1, 9.6)]
    found = at_the_top(analyse(mooring("SOFS-1"), [given[0], grown, given[1]], 90.0))
    assert found == pytest.approx([161.0, 109.0, 80.0], abs=1.0)
    assert grown.peak_period == pytest.approx(7.93, abs=0.01)


def test_its_own_accuracy_is_settled(analysis):
    assert max(analysis.accuracy.mesh, analysis.accuracy.frequencies) < 0.01


def test_half_of_the_frequencies_are_enough(analysis):
    """The heave of the disc leaves nothing above half the cut-off, 3 to 5 rad/s."""
    for state in analysis.states:
        top = state.components[2]
        assert top.half_cut_off.tension_std == pytest.approx(top.tension_std, rel=0.01)
        assert top.twice_cut_off.tension_std == pytest.approx(top.tension_std, rel=0.001)


def test_a_float_that_follows_every_wave_as_whoi_cable_has_it(sofs5):
    """Hs 5 m, Tp 8.4 s, 900 s in the time domain: 318 kgf; its sampling error is some 5 %."""
    (state,) = analyse(sofs5, [spectrum_of("bretschneider", 5.0, 8.4, 3.3)], 90.0).states
    assert state.follower_std / KGF == pytest.approx(318.0, rel=0.1)
    assert state.components[2].tension_std < state.follower_std


def test_regular_waves_as_whoi_cable_has_them(sofs5):
    """An amplitude of 704 N in waves of 1 m and 8.4 s, the buoy following."""
    solution = sofs5.equilibrium()
    line, buoy = lumped_line(sofs5, solution, 20.0), buoy_of(sofs5, solution, True)
    omega = 2.0 * np.pi / 8.4 * np.array([0.999, 1.0, 1.001])
    sea = spectrum_of("bretschneider", 1.0, 8.4, 3.3)
    regular = type(sea)(1.0, 8.4, lambda at: np.full(at.shape, 0.125 / np.ptp(omega)))
    water = Waves(omega, 90.0, sofs5.water.depth, 1027.0, sofs5.water.gravity)
    response, _ = respond(line, buoy, water, regular)
    assert abs(response.pull[1, 0]) == pytest.approx(704.0, rel=0.1)


DESIGNED = (
    (1.4, 5.2, 1783.6), (2.3, 5.9, 2318.7), (3.2, 6.8, 2630.9), (4.1, 7.6, 2720.0),
    (5.0, 8.4, 2809.2), (5.9, 9.2, 2898.4), (7.8, 10.7, 2898.4), (9.6, 12.3, 2898.4),
)  # fmt: skip
"""Of SOFS-1, by WHOI with WHOI Cable: significant height [m], standard deviation [N]; and the peak
period [s] that the load cases of the Southern Ocean Time Series pair with that height."""


def test_sofs1_as_it_was_designed():
    """Below a float that follows every wave, as that program has it; runs of minutes leave 5 %.

    What was measured is half of it in low seas, and is not met.
    """
    designed = [spectrum_of("bretschneider", height, period, 3.3) for height, period, _ in DESIGNED]
    sofs1 = mooring("SOFS-1")
    solution = sofs1.equilibrium()
    line, buoy = lumped_line(sofs1, solution, 20.0), buoy_of(sofs1, solution, True)
    found, flow = [], None
    for sea in designed:
        water = Waves(sea.frequencies(48), 90.0, sofs1.water.depth, 1027.0, sofs1.water.gravity)
        response, flow = respond(line, buoy, water, sea, first=flow)
        found.append(response.moments(line.upper_ends(response.pull))[0][2])
    expected = np.array([tension for *_, tension in DESIGNED])
    assert np.array(found) / expected == pytest.approx(1.0, abs=0.1)
