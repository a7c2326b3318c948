"""Another unit, exchanged labels: refused by name, and bands as wide as the misfit."""

import numpy as np
import pytest

from calm.errors import UsageError
from calm.motion.sensors import unusable
from calm.motion.whole_record import _widened

STILL = np.array([50.0, 120.0, 250.0])
LABELS = ("upper", "middle", "lower")
RANDOM = np.random.default_rng(3)


def knocked(shift=0):
    """(n, 3) depths in a tide and a storm, the currents some hours off [m]."""
    hours = np.arange(240.0) - shift
    speed = 0.3 + 0.3 * np.sin(2 * np.pi * hours / 12.42) + 0.2 * np.sin(hours / 25.0)
    return STILL + np.square(speed)[:, None] * np.array([60.0, 35.0, 5.0])


@pytest.mark.parametrize(
    ("factor", "unit"), [(1.45038, "psi for dbar?"), (0.68948, "dbar for psi")]
)
@pytest.mark.parametrize("count", [1, 3])
def test_psi_and_dbar_are_told_apart(factor, unit, count):
    depth = factor * (knocked()[:, 3 - count :] if count == 3 else knocked()[:, 1:2])
    still = STILL if count == 3 else STILL[1:2]
    with pytest.raises(UsageError) as refused:
        unusable(LABELS[: len(still)], depth, still)
    assert str(refused.value).count(f"its unit ({unit}") == count


def test_pressures_that_count_down_have_the_wrong_sign():
    with pytest.raises(UsageError) as refused:
        unusable(LABELS[: len(STILL)], -knocked(), STILL)
    said = str(refused.value)
    assert said.count("its sign or its label is wrong") == 3 and "exchanged" not in said


def test_exchanged_labels_are_refused_by_their_names():
    with pytest.raises(UsageError) as refused:
        unusable(LABELS[: len(STILL)], knocked()[:, [1, 0, 2]] + 8.0, STILL)
    said = str(refused.value)
    assert said.startswith("--pressures: `upper` is at 12") and said.endswith("are exchanged")
    assert unusable(LABELS[: len(STILL)], knocked() + 8.0, STILL) == {}


def test_bands_widen_with_the_misfit_of_usual_times():
    expected = np.tile(np.eye(2), (400, 1, 1))
    left = RANDOM.standard_normal((400, 2))
    known = np.ones((400, 2), bool)
    assert _widened(left, expected, known) == 1.0
    assert _widened(5.0 * left, expected, known) == pytest.approx(5.0, rel=0.1)
    spikes = np.where(RANDOM.random((400, 1)) < 0.08, 30.0 * left, left)
    assert _widened(spikes, expected, known) == 1.0
