"""General tests of values: each kind of fault is found where it was put, and nowhere else."""

import numpy as np
import pytest

from calm.records.value_tests import (
    CurrentValues,
    current_doubts,
    exchanged_pair,
    impossible_values,
    level_doubts,
    sector_doubts,
    series_doubts,
    speed_doubts,
)

COUNT = 720
TIMES = np.datetime64("2026-03-01", "ns") + np.arange(COUNT) * np.timedelta64(1, "h")
HOURS = np.arange(COUNT, dtype=float)
DEPTH = np.array([20.0, 60.0, 120.0])


def tide(period: float, size: float = 0.3) -> np.ndarray:
    """A tide and a slow change, at three levels."""
    angle = 2.0 * np.pi * HOURS[:, np.newaxis] / period
    slow = 0.1 * np.cos(2.0 * np.pi * HOURS[:, np.newaxis] / 331.7)
    return (size * np.cos(angle) + slow) * np.array([1.0, 0.7, 0.4])


def doubts(u=None, v=None, times=TIMES, depth=DEPTH, water_depth=130.0, **more):
    u = tide(12.4206) if u is None else u
    v = tide(12.4206, 0.2) + 0.02 * np.sin(HOURS[:, np.newaxis] / 7.7) if v is None else v
    return [*current_doubts(CurrentValues(depth, u, v, times, water_depth, **more))]


@pytest.mark.parametrize("step", [1, 6, 12])
@pytest.mark.parametrize("noise", [0.0, 0.05])
def test_tides_are_beyond_doubt_at_any_step(step, noise):
    stir = noise * np.random.default_rng(3).standard_normal((2, COUNT, 3))
    u, v = tide(12.4206) + stir[0], tide(12.0, 0.2) + stir[1]
    assert doubts(u[::step], v[::step], TIMES[::step]) == []


def test_two_instruments_in_turn():
    u = tide(12.4206)
    u[1::2, 1] += 0.5
    (said,) = doubts(u)
    assert said.startswith("1 of 3 series appear to alternate between two instruments")


def test_levels_whose_components_are_exchanged_or_of_the_other_sign():
    u, v = tide(12.4206), tide(12.0, 0.2) + 0.02 * np.sin(HOURS[:, np.newaxis] / 7.7)
    for own_u, own_v in ((v, u), (-u, -v), (u, -v), (-v, u)):
        one, other = u.copy(), v.copy()
        one[:, 1], other[:, 1] = own_u[:, 1], own_v[:, 1]
        (said,) = doubts(one, other)
        assert said.startswith("currents at 60 m differ in direction from the currents above and")
        assert doubts(one[:, :2], other[:, :2], depth=DEPTH[:2], water_depth=60.0) == []


def test_an_undercurrent_is_no_doubt():
    u, v = tide(12.4206), tide(12.0, 0.2)
    u[:, 1], v[:, 1] = -1.6 * u[:, 0], -1.6 * v[:, 0]
    assert doubts(u, v) == []


def test_components_that_are_missing_equal_or_zero():
    rng = np.random.default_rng(5)
    u, v = tide(12.4206), tide(12.0, 0.2)
    u += 0.03 * rng.standard_normal(u.shape)
    v += 0.03 * rng.standard_normal(v.shape)
    gone = u.copy()
    gone[3:9, 0] = np.nan
    assert doubts(gone, v) == ["6 of 2160 currents have one component without the other"]
    assert "all 2160 currents have equal components to the east and to the north" in doubts(u, u)
    filled, other = u.copy(), v.copy()
    filled[100:110] = other[100:110] = 0.0
    (said,) = doubts(filled, other)
    assert said.startswith("30 of 2160 currents are exactly 0, and hardly any are nearly 0")
    rounded = np.round(0.03 * rng.standard_normal((2, COUNT, 3)), 2)  # weak, to a cm/s
    assert (np.hypot(*rounded) == 0.0).sum() > 30
    assert not [one for one in doubts(*rounded) if "exactly 0" in one]


def test_levels_that_repeat_and_times_that_repeat():
    u, v = tide(12.4206), tide(12.0, 0.2)
    u[:, 2], v[:, 2] = u[:, 1], v[:, 1]
    (said,) = doubts(u, v)
    assert said.startswith("1 of 3 levels have the same currents at all times as the level above")
    several = np.repeat(TIMES[: COUNT // 2], 2)
    notes = [*series_doubts(np.random.default_rng(2).random((COUNT, 1, 1)), several)]
    assert notes == [
        "360 of 720 times are equal to the time before: does the file combine several instruments?"
    ]


def test_a_few_impossible_values_of_one_size_are_fill_values():
    values = np.where(np.arange(90) % 9 == 0, -999.0, 8.0 + np.arange(90) / 90.0)
    assert impossible_values("temperature", values)[1].endswith(
        "median of -999: is this a fill value?"
    )


def test_levels_without_a_depth_and_a_clock_that_was_not_set():
    depth = np.array([20.0, np.nan, 120.0])
    assert doubts(depth=depth) == ["720 of 2160 currents have no depth and are excluded"]
    (said,) = doubts(times=TIMES - TIMES[0] + np.datetime64("1970-01-01", "ns"))
    assert said == "720 of 720 times are in January 1970: was the clock not set?"


def test_a_stretch_that_stands_twice():
    u, v = tide(12.4206), tide(11.7, 0.2)
    u[400:460], v[400:460] = u[100:160], v[100:160]
    (said,) = doubts(u, v)
    assert said == (
        "60 readings from 2026-03-17T16:00 are the same as those from 2026-03-05T04:00: was a part "
        "of the record copied?"
    )
    u[410:450] += 1e-9  # one digit is enough
    assert doubts(u, v) == []


@pytest.mark.parametrize(("length", "told"), [(60, False), (72, True)])
def test_a_tenth_without_change(length, told):
    u = tide(12.4206)
    v = tide(12.0, 0.2)
    u[10 : 10 + length, 2], v[10 : 10 + length, 2] = 0.11, 0.07
    said = doubts(u, v)
    assert len(said) == told
    if told:
        assert "1 of 3 levels do not change for a tenth" in said[0]
        assert f"at 120 m has {length} readings, from 2026-03-01T10:00" in said[0]


def test_levels_against_the_water():
    known = np.ones((4, 3), bool)
    assert [*level_doubts(DEPTH, known, 130.0)] == []
    said, _ = level_doubts(DEPTH / 0.3048, known, 130.0)
    assert said == (
        "2 of 3 levels with values are deeper than the water, 130.0 m: the deepest is at 393.7 m "
        "(120.0 m, if these are feet)"
    )
    known[:, 1:] = False
    said = [*level_doubts(DEPTH, known, 130.0)]
    assert said[0] == "1 of 3 levels above the seabed have no value at any time: 60 to 60 m"
    assert said[1].startswith("the current has no level below 20.0 m")


@pytest.mark.parametrize(("speeds", "unit", "factor", "likely"), [
    (np.linspace(0.0, 0.01, 99), "cm/s", 0.01, "; are they in m/s or kn?"),
    (np.linspace(0.0, 0.8, 99), "m/s", 1.0, None),
    (np.linspace(0.0, 0.0001, 99), "m/s", 1.0, "in the declared unit, m/s"),
])  # fmt: skip
def test_speeds_against_their_unit(speeds, unit, factor, likely):
    said = [*speed_doubts(speeds, unit, factor)]
    assert len(said) == (likely is not None)
    assert all(one.endswith(str(likely)) for one in said)


def test_currents_stronger_than_any_at_their_depth():
    deep = np.array([100.0, 1500.0, 3000.0])
    assert [one for one in doubts(depth=deep, water_depth=3100.0) if "reaches" in one] == []
    (said,) = (one for one in doubts(6.0 * tide(12.4), depth=deep, water_depth=3100.0)
               if "reaches" in one)  # fmt: skip
    assert said.startswith("the current reaches 1.") and "below 1000 m" in said


@pytest.mark.parametrize(("turn", "told"), [(1.0, 0), (0.1, 1), (np.pi / 180.0, 1)])
def test_directions_in_another_unit(turn, told):
    towards = np.radians(turn * np.arange(0.0, 360.0, 5.0))
    assert len([*sector_doubts(np.sin(towards), np.cos(towards))]) == told


def test_shares_of_good_pings_and_times():
    good = np.full((COUNT, 3), 0.9)
    good[:5, 0] = 0.3
    assert doubts(good=good) == ["for 5 of 2160 currents, less than half of the pings are good"]
    early = TIMES - np.timedelta64(40_000, "D")
    (said,) = doubts(times=early)
    assert said.startswith("720 of 720 times are before 1950 or after ")
    broken = np.concatenate([TIMES[:300], TIMES[300:] + np.timedelta64(9, "D")])
    assert doubts(times=broken) == [
        "1 gap in time: the longest is 217 h, from 2026-03-13T11:00 to 2026-03-22T12:00; "
        "the step is 1 h"
    ]


def test_series_may_be_short_or_empty():
    for count in (0, 1, 2, 5):
        assert [*series_doubts(np.zeros((count, 1, 1)), TIMES[:count])] == []
    assert [*series_doubts(np.full((COUNT, 2, 1), np.nan), TIMES, ("", ""))] == []


def test_values_of_no_sea_water():
    wrong, said, most = impossible_values("temperature", np.array([10.0, 99.0, 11.0, np.nan]))
    assert (wrong.tolist(), most) == ([False, True, False, False], False)
    assert said.startswith(
        "1 of 3 values are outside the range of temperature in sea water, -6 to 40 °C"
    )
    assert impossible_values("salinity", np.array([0.0, 35.0]))[1] == ""
    assert impossible_values("salinity", np.array([44.0, 46.0]))[2]


def test_the_exchange_that_puts_means_in_order():
    assert exchanged_pair(np.array([15.0, 9.0, 11.0, 8.0])) == (1, 2)
    assert exchanged_pair(np.array([15.0, 11.0, 9.0, 8.0])) is None
    assert exchanged_pair(np.array([8.0, 15.0, 7.0, 14.0, 6.0])) is None
    assert exchanged_pair(np.array([9.0, 11.0, 8.0])) is None
