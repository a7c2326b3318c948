"""Another unit, exchanged labels: refused by name, and bands as wide as the misfit."""

import numpy as np
import pytest

from calm.errors import UsageError
from calm.motion.measurements import MooringMeasurements
from calm.motion.sensors import unusable
from calm.motion.suspects import torn

STILL = np.array([50.0, 120.0, 250.0])
LABELS = ("upper", "middle", "lower")
HOURS = np.datetime64("2026-03-01", "ns") + np.arange(240) * np.timedelta64(1, "h")


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


def measured(depth):
    count = depth.shape[1]
    return MooringMeasurements(
        HOURS, LABELS[:count], np.arange(count), depth, np.zeros((240, 1)), np.zeros(1, int),
        np.zeros(1, int), np.ones((240, 1)), np.ones((240, 1)), np.ones((240, 1), np.int8),
    )  # fmt: skip


def test_depths_farther_apart_than_the_line_is_long_are_left_out():
    depth = np.tile([60.0, 150.0, 290.0], (240, 1))
    depth[4, 1] = 60.0 + 1.25 * 100.0 + 20.1  # 100 m of line to the first: the second is wrong
    depth[5, 1] = 60.0 + 1.25 * 100.0 + 19.9
    depth[6, 0] = -100.0
    found, said = torn(measured(depth), np.array([0.0, 100.0, 250.0]))
    assert np.argwhere(np.isnan(found.depth)).tolist() == [[4, 1], [6, 0]]
    assert said[1] == (
        f"{LABELS[1]}: 1 of its readings were excluded, because their distance in depth from "
        "another sensor exceeds the length of line between both sensors; the first is 205.1 m, "
        f"at {HOURS[4]!s:.19}"
    )
    depth[:, 0] = -100.0  # the sensor is wrong, not its readings
    assert torn(measured(depth), np.array([0.0, 100.0, 250.0]))[1] == []


def test_a_hidden_sensor_takes_no_reading_from_another():
    depth = np.tile([60.0, 150.0, 290.0], (240, 1))
    depth[4, 1], depth[:, 2] = 205.1, 12.0
    found, notes = torn(measured(depth), np.array([0.0, 100.0, 250.0]), LABELS[2:3])
    assert np.argwhere(np.isnan(found.depth)).tolist() == [[4, 1]] and len(notes) == 1
