"""Which part a sensor is: by its label, or by its place in the order down the line."""

from dataclasses import replace
from itertools import combinations
from types import SimpleNamespace

import numpy as np
import pytest

from calm.errors import UsageError
from calm.motion.matching import CERTAIN, matched_by_label, matched_by_place, named_by_serial
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


def test_a_sensor_without_a_label_is_that_of_its_serial_number():
    def part(label, serial):
        return SimpleNamespace(label=label, serial=serial, at=1.0)

    top = SimpleNamespace(label="rope", serial=None, clamps=[part("deep", "0371"), part("a", "9")])
    end = SimpleNamespace(label="b", serial="9", clamps=[])
    mooring = SimpleNamespace(file=SimpleNamespace(pieces=[top, end]))
    given = [
        replace(one, serial=serial, label=label)
        for one, serial, label in zip(
            sensors(1.0, 2.0, 3.0, 4.0), ("371", "9", "", "5"), ("", "", "", "top"), strict=True
        )
    ]
    # 9 is the number of two parts: the sensor is called by it, and listed as no part
    assert [one.label for one in named_by_serial(given, mooring)] == ["deep", "9", "", "top"]
