"""What is named of currents and of a datum, and what is not."""

from dataclasses import replace

import numpy as np
import pytest

from calm.motion.common_unknowns import Common
from calm.motion.remarks import (
    current_remarks,
    datum_remarks,
    factor_remarks,
    false_current_times,
)

TIMES = 100
TIME = np.datetime64("2026-03-01", "ns") + np.arange(TIMES) * np.timedelta64(1, "h")


def common(offset):
    count = len(offset)
    none, never = np.zeros(count), np.full(count, "NaT", "M8[ns]")
    return Common(
        {}, 0.0, np.array(offset), none, never, none, np.eye(2 * count + 1), 1.0, np.eye(3)
    )


def test_currents_that_look_false_are_listed_with_their_times():
    doubt = np.zeros((TIMES, 2))
    doubt[[7, 9], 1] = 0.6, 0.51
    doubt[8] = 0.5
    false = false_current_times(("a", "b"), TIME, doubt)
    assert list(false) == ["b"] and false["b"].tolist() == TIME[[7, 9]].tolist()
    (said,) = current_remarks(false, TIMES)
    assert "current at b" in said and "2 of 100 times, first at 2026-03-01T07:00" in said


@pytest.mark.parametrize(
    ("datum", "offset", "spread", "said"),
    [
        (9.7, 0.3, 0.5, "as if the pressures included that of the air"),
        (9.2, 0.0, 0.5, "as if the pressures included that of the air"),
        (9.0, 0.0, 0.5, "the depth of the water"),
        (7.8, 1.5, 3.4, "as if the pressures included that of the air"),
        (6.0, 2.0, 3.4, None),  # less than two deviations from none
        (7.6, 0.0, 0.5, "the depth of the water"),  # 2.5 times a hundredth of it
        (-7.6, 0.0, 0.5, "the depth of the water"),
        (7.4, 0.0, 0.5, None),
        (-10.1, 0.0, 0.5, "the depth of the water"),
    ],
)
def test_all_sensors_off_alike_are_named_and_the_weight_of_the_air_is_known(
    datum, offset, spread, said
):
    known = replace(common((offset, offset)), factors={"cable_drag": 1.0}, datum=datum)
    covariance = np.diag([0.1, spread, 1.0, 1.0, 0.0, 0.0]) ** 2
    found = datum_remarks(replace(known, covariance=covariance), 300.0)
    assert len(found) == (said is not None)
    for one in found:
        assert said in one and one.startswith(f"all sensors: {datum:+.1f} m off alike")


def test_an_absurd_factor_is_not_called_drag():
    known = replace(common((0.0,)), factors={"cable_drag": 1.3, "rigid_drag": 2.61, "length": 1.2})
    (said,) = factor_remarks(known)  # 6.4 deviations of 15 %; 1.3 is 1.7, and a length is no drag
    assert said.startswith("rigid_drag: a factor of 2.61 is 6.4 deviations")
    assert (
        "measured 38 % too low" in said and "62 % less net force" in said
    )  # 1 - 2.61^-1/2, 1/2.61
    (low,) = factor_remarks(replace(known, factors={"rigid_drag": 0.5}))
    assert "measured 41 % too high" in low  # 2^1/2 - 1
