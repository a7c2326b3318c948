"""Which part a sensor is: by its label, or by its place in the order down the line."""

from itertools import combinations

import numpy as np
import pytest

from calm.errors import UsageError
from calm.motion.matching import CERTAIN, matched_by_label, matched_by_place
from calm.motion.sensors import Sensor

NONE = np.array([], "M8[ns]"), np.array([])
LABELS = ("ctd", "meter", "adcp", "float", "release")
STILL = np.array([120.0, 60.0, 300.0, 50.0, 480.0])


def sensors(*nominal, label=""):
    return [Sensor(label, *NONE, "p.nc", depth) for depth in nominal]


def test_sensors_keep_their_order_down_the_line_and_lie_nearest():
    found = matched_by_place(sensors(318.0, 75.0, 470.0), [0, 1, 2, 4], STILL, LABELS)
    assert found == {1: 1, 0: 2, 2: 4}


def test_the_way_is_the_best_of_all_and_refused_where_another_is_as_good():
    random = np.random.default_rng(6)
    refused = 0
    for _ in range(80):
        still = np.sort(random.uniform(0.0, 60.0, 6))
        nominal = np.sort(random.uniform(0.0, 60.0, 4))
        ways = sorted(
            (float(np.abs(still[list(way)] - nominal).sum()), way)
            for way in combinations(range(6), 4)
        )
        if ways[1][0] - ways[0][0] < CERTAIN:
            refused += 1
            with pytest.raises(UsageError, match="may be"):
                matched_by_place(sensors(*nominal), range(6), still, "abcdef")
        else:
            found = matched_by_place(sensors(*nominal), range(6), still, "abcdef")
            assert found == dict(enumerate(ways[0][1]))
    assert 10 < refused < 70


def test_what_place_cannot_tell_is_refused():
    with pytest.raises(UsageError, match="the line has 2 instruments"):
        matched_by_place(sensors(60.0, 120.0, 300.0), [0, 1], STILL, LABELS)
    with pytest.raises(UsageError, match=r"no nominal height or depth is given for p\.nc"):
        matched_by_place(sensors(60.0, np.nan), [0, 1], STILL, LABELS)


def test_labels_are_matched_and_others_listed_with_the_nearest():
    given = [*sensors(np.nan, label="adcp"), *sensors(np.nan, label="metre")]
    points, lost = matched_by_label(given, LABELS)
    assert points == {0: 2}
    assert lost == ["`metre` of p.nc is not a part of the line; did you mean `meter`?"]


@pytest.mark.parametrize(
    ("label", "labels", "said"),
    [
        ("", LABELS, "does not say what its sensors are called"),
        ("ctd", ("ctd", "ctd"), "two parts of the line are called `ctd`"),
        ("x", LABELS, "no sensor is a part of the line"),
    ],
)
def test_labels_that_match_nothing_or_two_things_are_refused(label, labels, said):
    with pytest.raises(UsageError, match=said):
        matched_by_label(sensors(np.nan, label=label), labels)
