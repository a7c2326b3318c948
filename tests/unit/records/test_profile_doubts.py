"""Values of a single profile that are possible, and mostly are a mistake."""

import numpy as np
import pytest

from calm.records.profile_doubts import direction_doubts, profile_doubts
from calm.records.profile_tables import components


def told(rows, water_depth=1000.0):
    """Doubts about rows of depth, speed and direction."""
    depth = np.array([row[0] for row in rows], float)
    u, v = (np.array(each) for each in zip(*(components(*row[1:]) for row in rows), strict=True))
    return list(profile_doubts(depth, u, v, water_depth))


SLOPE = [(0, 0.6, 90), (200, 0.4, 90), (500, 0.2, 85), (1000, 0.08, 80)]
OVERFLOW = [(0, 0.6, 60), (65, 0.45, 60), (260, 0.24, 60), (1000, 0.9, 60)]
UNDERCURRENT = [(0, 0.5, 270), (100, 1.0, 90), (300, 0.3, 270), (1000, 0.1, 270)]


@pytest.mark.parametrize("rows", [SLOPE, OVERFLOW, UNDERCURRENT, SLOPE[:1]])
def test_usual_profiles_pass(rows):
    assert told(rows) == []


@pytest.mark.parametrize(
    ("rows", "says"),
    [
        ([*SLOPE[:2], (500, 0.2, 265), SLOPE[3]], "at 500.0 m is opposite to the currents above"),
        ([(row[0], speed, 90) for row, speed in zip(SLOPE, (0.08, 0.2, 0.4, 0.6), strict=True)],
         "from 0.08 m/s to 0.60 m/s at the seabed"),
        ([(0, 3.5, 90), (1000, 0.5, 90)], "reaches 3.50 m/s in 1000.0 m of water"),
    ],
)  # fmt: skip
def test_what_is_mostly_a_mistake_is_told(rows, says):
    (doubt,) = told(rows)
    assert says in doubt


def test_a_strong_current_is_usual_in_shallow_water_and_none_below_1000_m():
    race = [(0, 4.5, 90), (40, 2.5, 90)]
    assert told(race, 40.0) == []
    assert "below 1000 m" in told([(0, 2.0, 90), (1500, 1.8, 90)], 3000.0)[0]


@pytest.mark.parametrize(
    "directions",
    [[90.0, 85.5, 80.0], [3.0, 5.0, 2.0], [0.0, 0.0], [], [3.5], [0.0], [1.0], [-170.5, -3.0]],
)
def test_directions_in_degrees_pass(directions):
    assert list(direction_doubts(directions, "toward")) == []


@pytest.mark.parametrize(
    ("directions", "span"),
    [([1.571, 1.571, 1.484], "1.48 to 1.57"), ([0.3, 0.2, 0.1], "0.1 to 0.3"), ([1.57], "1.57"),
     ([-2.36], "-2.36"), ([4.712, 4.712], "4.71")],
)  # fmt: skip
def test_radians_and_velocities_are_told(directions, span):
    (doubt,) = direction_doubts(directions, "from")
    assert doubt.startswith(f"`from` is {span} degrees throughout")
