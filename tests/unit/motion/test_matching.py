"""Which part a sensor is: by its label, or by its place in the order down the line."""

from itertools import combinations

import numpy as np
import pytest

from calm.errors import UsageError
from calm.motion.matching import (
    CERTAIN,
    LinePlaces,
    matched_by_place,
    named_point,
    points_of,
)
from calm.records.instrument_series import Identity

LABELS = ("ctd", "meter", "adcp", "float", "release")
STILL = np.array([120.0, 60.0, 300.0, 50.0, 480.0])


def line(labels=LABELS, still=STILL, serials=None):
    return LinePlaces("m.yaml", labels, serials or ("",) * len(labels), 3, still)


def sensors(*nominal, label="", serial=""):
    return [Identity(label, serial, depth, "p.nc") for depth in nominal]


def test_sensors_keep_their_order_down_the_line_and_lie_nearest():
    found, said = matched_by_place(sensors(318.0, 75.0, 470.0), line(), [0, 1, 2, 4])
    assert found == {1: 1, 0: 2, 2: 4}
    assert said[0] == "the sensor at 75.0 m in p.nc matches `meter`"


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
        places = line("abcdef", still)
        if ways[1][0] - ways[0][0] < CERTAIN:
            refused += 1
            with pytest.raises(UsageError, match="could be"):
                matched_by_place(sensors(*nominal), places, range(6))
        else:
            found, _ = matched_by_place(sensors(*nominal), places, range(6))
            assert found == dict(enumerate(ways[0][1]))
    assert 10 < refused < 70


def test_what_place_cannot_tell_is_refused():
    with pytest.raises(UsageError, match="the line has 2 instruments"):
        matched_by_place(sensors(60.0, 120.0, 300.0), line(), [0, 1])
    with pytest.raises(UsageError, match=r"no nominal height or depth is given for p\.nc"):
        matched_by_place(sensors(60.0, np.nan), line(), [0, 1])


def test_labels_are_matched_and_others_listed_with_the_nearest():
    given = [*sensors(np.nan, label="adcp"), *sensors(np.nan, label="metre")]
    points, lost = points_of(given, line())
    assert points == {0: 2}
    assert lost == ["`metre` of p.nc matches no part of m.yaml; did you mean `meter`?"]


@pytest.mark.parametrize(
    ("label", "reason"), [("", "has no label, serial number or nominal depth"), ("x", "`x` of")]
)
def test_sensors_that_match_nothing_are_refused(label, reason):
    with pytest.raises(UsageError, match=f"no instrument matches a part of the line: .*{reason}"):
        points_of(sensors(np.nan, label=label), line())


def test_sensors_without_a_label_are_matched_by_nominal_depth_beside_labelled_ones():
    given = [*sensors(310.0), *sensors(np.nan, label="meter"), *sensors(125.0)]
    points, notes = points_of(given, line())
    assert points == {0: 2, 1: 1, 2: 0}
    assert notes[0].startswith("matched by nominal depth, from the top down: ")


def test_a_sensor_without_a_label_is_that_of_its_serial_number():
    places = line(serials=("0371", "9", "9", "", "top"))
    # 9 is the number of two parts: the sensor is no part
    for serial, label, at in (("371", "", 0), ("9", "", None), ("", "", None), ("5", "float", 3)):
        (one,) = sensors(1.0, label=label, serial=serial)
        assert named_point(one, places) == at


def test_of_labels_that_differ_in_their_case_alone_each_is_its_own():
    places = line(("ctd", "CTD", *LABELS[2:]))
    found = [named_point(*sensors(1.0, label=label), places) for label in ("ctd", "CTD", "Ctd")]
    assert found == [0, 1, None]
