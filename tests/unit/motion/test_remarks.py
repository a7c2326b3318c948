"""What is named from the residuals of sensors, and what is not."""

from dataclasses import replace

import numpy as np
import pytest

from calm.motion.common_unknowns import Common
from calm.motion.remarks import current_remarks, datum_remarks, false_current_times, sensor_remarks

TIMES = 100
TIME = np.datetime64("2026-03-01", "ns") + np.arange(TIMES) * np.timedelta64(1, "h")
NOISE = 0.2 * np.random.default_rng(1).standard_normal((TIMES, 3))
LABELS = ("upper", "middle", "lower")


def named(residual, offset=(0.0, 0.0, 0.0), down=None):
    down = np.zeros(TIMES) if down is None else down
    return sensor_remarks(LABELS, TIME, residual, down, common(offset))


def common(offset, elsewhere=None, moved=None, since=None):
    count = len(offset)
    none, never = np.zeros(count), np.full(count, "NaT", "M8[ns]")
    return Common(
        {}, 0.0, np.array(offset), none if moved is None else np.array(moved),
        never if since is None else np.array(since), none if elsewhere is None else
        np.array(elsewhere), np.eye(2 * count + 1), 1.0, np.eye(3),
    )  # fmt: skip


def test_noise_is_not_named():
    assert named(NOISE) == []
    assert named(np.full((TIMES, 3), np.nan)) == []


@pytest.mark.parametrize("size", [4.0, -4.0])
def test_a_step_is_named_with_its_size_and_time(size):
    residual = NOISE.copy()
    residual[60:, 1] += size
    (said,) = named(residual)
    assert said.startswith(f"middle: steps by {size:+.0f}"[:-1])
    assert "about 2026-03-03T11:00: a clamp that slipped" in said


@pytest.mark.parametrize(
    ("count", "noise", "size", "is_named"),
    [
        (100, 0.2, 1.6, True),  # 1.5 m at least
        (100, 0.2, 1.4, False),
        (100, 1.0, 2.5, True),  # 0.6 of the variance: √6 of the noise
        (100, 1.0, 2.4, False),
        (32, 1.0, 3.8, True),  # 6 standard errors of √(12 / count): 3.67
        (32, 1.0, 3.6, False),
    ],
)
def test_a_step_is_named_that_is_large_and_clear_and_explains_most(count, noise, size, is_named):
    residual = noise * (-1.0) ** np.arange(count) + 3.0
    residual[count // 2 :] += size
    columns = np.column_stack([residual, np.zeros(count), np.zeros(count)])
    said = sensor_remarks(LABELS, TIME[:count], columns, np.zeros(count), common((0.0, 0.0, 0.0)))
    assert [one.split(" m ")[0] for one in said] == [f"upper: steps by {size:+.1f}"] * is_named
    assert not said or said[0].endswith("a clamp that slipped")  # of the others nothing is known


def test_a_step_has_eight_times_on_either_side_and_the_largest_is_named():
    residual = NOISE.copy()
    residual[-8:, 0] += 6.0
    residual[-8:, 1] -= 4.0
    (said,) = named(residual)
    assert said.startswith("upper: steps by +6.") and "2026-03-04T19:00" in said


def test_a_drift_is_named_with_all_of_it():
    residual = NOISE.copy()
    residual[:, 2] -= 6.0 * np.arange(TIMES) / (TIMES - 1)
    (said,) = named(residual)
    assert said == "lower: drifts by -6.1 m over the record"
    known = common(np.zeros(3), (0.0, 0.0, 0.97), (0.0, 0.0, -5.0), TIME[[0, 0, 40]])
    (said,) = sensor_remarks(LABELS, TIME, residual, np.zeros(TIMES), known)
    slipped = "or its clamp slipped by -5.0 m about 2026-03-02T16:00"
    assert said == f"lower: drifts by -6.1 m over the record, {slipped}"


def test_strong_currents_say_nothing_of_sensors():
    residual, down = NOISE.copy(), np.arange(TIMES) * 1.0
    residual[60:, 1] += 4.0  # only where the knockdown is above its median
    assert named(residual, down=down) == []


def test_two_sensors_cannot_tell_which_of_them_it_is():
    residual = NOISE[:, :2].copy()
    residual[60:, 1] += 4.0
    for elsewhere, also in (((0.0, 0.0), True), ((0.4, 0.6), True), ((0.0, 0.99), False)):
        known = common(np.zeros(2), elsewhere)
        (said,) = sensor_remarks(LABELS[:2], TIME, residual, np.zeros(TIMES), known)
        assert said.startswith("middle: steps by +4")
        assert ("or upper the other way: they cannot tell" in said) == also


def test_an_offset_that_is_too_large_is_named():
    (said,) = named(NOISE, offset=(0.0, -2.6, 2.4))
    assert said.startswith("middle: -2.6 m off throughout")


def test_a_sensor_that_hangs_elsewhere_is_named_where_only_strong_currents_show_it():
    moved, since = (12.0, -9.0, 5.0), TIME[[0, 40, 40]]
    known = common((0.5, 0.0, 0.0), (0.9, 0.6, 0.3), moved, since)
    said = sensor_remarks(LABELS, TIME, NOISE, np.zeros(TIMES), known)
    assert said[0].startswith("upper: +12.5 m off throughout")
    assert "or middle, lower the other way: they cannot tell" in said[0]
    assert said[1].startswith("middle: hangs 9.0 m above its place from 2026-03-02T16:00 on")
    assert len(said) == 2


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
