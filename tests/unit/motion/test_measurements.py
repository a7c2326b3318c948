"""Values at common times, and which times these are."""

from dataclasses import replace

import numpy as np
import pytest

from calm.errors import UsageError
from calm.motion.measurements import (
    CurrentMeasurements,
    MooringMeasurements,
    common_times,
    interpolated,
    joined,
    without_spikes,
)
from calm.records.instrument_series import InstrumentSeries

START = np.datetime64("2026-03-01", "ns")


def hours(*values):
    return START + (np.array(values) * 3600e9).astype("m8[ns]")


def currents(time, u, depth=(10.0,), **more):
    u = np.atleast_2d(np.asarray(u, float).T).T
    level = np.broadcast_to(np.asarray(depth, float), u.shape)
    told = {"label": ("",) * u.shape[1], "source": "c", **more}
    return CurrentMeasurements(time, level, u=u, v=0.0 * u, flag=np.ones(u.shape, np.int8), **told)


def sensor(label, time, depth):
    return InstrumentSeries(label, "", np.nan, "p", time, np.asarray(depth, float))


def test_values_are_linear_within_the_gap_and_never_beyond_the_ends():
    time, wanted = hours(0, 1, 4), hours(-1, 0, 0.25, 2, 4, 5)
    found = interpolated(time, np.array([1.0, 2.0, 5.0]), wanted, np.timedelta64(2, "h"))
    assert found == pytest.approx([np.nan, 1.0, 1.25, np.nan, 5.0, np.nan], nan_ok=True)
    wide = interpolated(time, np.array([1.0, 2.0, 5.0]), wanted, np.timedelta64(3, "h"))
    assert wide[3] == 3.0


def test_times_are_those_of_the_first_current_and_what_is_far_from_it():
    first = currents(hours(0, 1, 2), [0.1, 0.2, 0.3])
    other = sensor("a", hours(1.4, 2.6, 3.0), [1.0, 1.0, 1.0])
    assert common_times([first], [other]).tolist() == hours(0, 1, 2, 2.6, 3.0).tolist()


def test_a_burst_far_from_the_currents_is_one_time():
    first, burst = currents(hours(0, 1, 2), [0.1, 0.2, 0.3]), hours(2.7, 2.71, 2.72, 2.94, 2.96)
    found = common_times([first], [sensor("a", burst, np.ones(5))])
    assert found.tolist() == hours(0, 1, 2, 2.7, 2.96).tolist()


def test_records_are_joined_level_by_level_from_the_top_down():
    low = currents(hours(0, 1, 2), [0.1, 0.2, 0.3], depth=(90.0,))
    high = currents(hours(1, 2, 3), [0.5, 0.6, 0.7], depth=(10.0,), false=np.array([0, 1, 0], bool))
    own = currents(hours(0, 1, 2), [0.8, 0.9, 1.0], depth=(np.nan,), label=("b",))
    one = joined(
        [low, high, own],
        [sensor("b", hours(0, 1, 2), [52, 53, 54]), sensor("a", hours(0, 1, 2), [21, 22, 23])],
        [1, 0], ("a", "b", "c"), np.array([20.0, 50.0, 99.0]), np.timedelta64(2, "h"),
        (hours(0, 1, 2, 3), np.array([0.5, 0.7, 0.9, 0.7])),
    )  # fmt: skip
    assert one.label == ("a", "b") and one.point.tolist() == [0, 1]
    assert one.level_point.tolist() == [-1, 1, -1]
    u = [[np.nan, 0.8, 0.1], [0.5, 0.9, 0.2], [0.6, 1.0, 0.3], [0.7, np.nan, np.nan]]
    assert one.u == pytest.approx(np.array(u), nan_ok=True)
    assert one.depth[1].tolist() == [22.0, 53.0]
    assert one.tide == pytest.approx([-0.2, 0.0, 0.2, 0.0])  # about its mean
    assert one.false.tolist() == [False, False, True, False]


def test_the_flag_is_the_worse_on_either_side_and_missing_outside():
    flag = np.array([[1], [3], [2], [1]], np.int8)
    one = replace(currents(hours(1, 2, 3, 4), [0.1, 0.2, 0.3, 0.4]), flag=flag)
    other = currents(hours(0, 1, 1.5, 2.5, 3.5, 4, 5), np.ones(7), depth=(99.0,))
    found = joined(
        [other, one], [sensor("", hours(0, 5), [20, 21])], [1], ("a", "b"), np.array([9.0, 20.0]),
        np.timedelta64(2, "h"),
    )  # fmt: skip
    assert found.flag[:, 0].tolist() == [9, 1, 3, 3, 2, 1, 9]
    assert found.label == ("b",)  # of the place, where the sensor has no name


def test_records_that_share_no_time_are_refused():
    here, later = currents(hours(0, 1), [0.1, 0.2]), [sensor("a", hours(50, 51), [20, 21])]
    with pytest.raises(UsageError, match="no time has both a current and a pressure"):
        joined([here], later, [0], ("a",), np.array([20.0]), np.timedelta64(2, "h"))


@pytest.mark.parametrize("lost", ["u", "v"])
def test_half_a_current_is_none(lost):
    here = currents(hours(0, 1), [0.1, 0.2])
    here = replace(here, **{lost: np.full((2, 1), np.nan)})
    with pytest.raises(UsageError, match="no time has both a current and a pressure"):
        joined(
            [here], [sensor("a", hours(0, 1), [20, 21])], [0], ("a",), np.array([20.0]),
            np.timedelta64(2, "h"),
        )  # fmt: skip


def record(depth, labels=("a", "b", "c")):
    count = depth.shape[1]
    none = np.zeros((len(depth), 0))
    return MooringMeasurements(
        hours(*range(len(depth))), labels[:count], np.arange(count), depth, none,
        np.zeros(0, np.int64), none, none, none.astype(np.int8),
    )  # fmt: skip


def test_a_reading_far_from_its_neighbours_is_left_out_unless_others_move_with_it():
    random = np.random.default_rng(2)
    depth = np.array([50.0, 120.0, 250.0]) + 0.2 * random.standard_normal((60, 3))
    depth[20, 1] += 5.0  # a spike
    depth[30] += [20.0, 8.0, 2.0]  # an hour of strong current
    depth[40:, 2] += 9.0  # a slip: the readings after it agree
    depth[50, 0] = np.nan
    found, said = without_spikes(record(depth))
    assert np.argwhere(np.isnan(found.depth)).tolist() == [[20, 1], [50, 0]]
    assert said == [
        "b: 1 of its readings were excluded as spikes, because other sensors show no change at "
        f"these times; the first is {depth[20, 1]:.1f} m, at 2026-03-01T20:00:00"
    ]
    assert without_spikes(record(depth), ["b"])[1] == []
    assert without_spikes(record(depth[:, 1:2]))[1] == []  # no other sensor confirms it


def test_across_a_gap_no_reading_is_a_spike():
    depth = np.array([50.0, 120.0]) + 0.2 * np.random.default_rng(2).standard_normal((60, 2))
    depth[20, 1] += 5.0
    depth[21:25, 1] = np.nan
    assert without_spikes(record(depth))[1] == []
