"""Which readings cannot be from where a sensor hangs, and which sensors cannot be used."""

import numpy as np
import pytest

import calm
from calm.errors import UsageError
from calm.motion.remarks import Fault
from calm.motion.sensors import depth_of, metre_notes, plausible, unusable
from calm.motion.suspects import distances_of
from calm.records.instrument_series import InstrumentSeries

SEABED = 300.0


def sensor(*depth, again=()):
    time = np.datetime64("2026-03-01", "ns") + np.arange(len(depth)) * np.timedelta64(1, "h")
    time[list(again)] = time[[i - 1 for i in again]]
    return InstrumentSeries("a", "", np.nan, "p.csv", time, np.array(depth))


@pytest.mark.parametrize(("place", "least"), [(60.0, 30.0), (30.0, 10.0), (10.0, -10.0)])
def test_readings_far_above_the_place_or_below_the_seabed_are_left_out(place, least):
    good = [place + 5.0] * 7
    found, said = plausible(sensor(*good, least - 0.1, least, 330.0, 330.1), place, SEABED)
    assert np.isnan(found.value).tolist() == [False] * 7 + [True, False, False, True]
    assert said == [
        f"a: 2 of its readings are impossible at its depth of {place:.1f} m and were excluded; the "
        f"first is {least - 0.1:.1f} m, at 2026-03-01T07:00:00"
    ]
    shallow, _ = plausible(
        sensor(*[95.0] * 7, 119.9, 120.1), 90.0, 100.0
    )  # 20 m below, not a tenth
    assert np.isnan(shallow.value).tolist() == [False] * 8 + [True]


def test_several_depths_at_one_time_are_those_of_several_instruments():
    with pytest.raises(UsageError, match="`a` has several depths at 2 of its times"):
        plausible(sensor(60.0, 95.0, 60.0, 95.0, again=(1, 3)), 60.0, SEABED)
    found, said = plausible(sensor(60.0, 60.5, 61.0, 61.5, again=(1, 3)), 60.0, SEABED)
    assert found.value.tolist() == [60.0, 61.0]
    assert "2 of its times appear twice" in said[0]


def test_where_half_are_wrong_the_sensor_is_and_nothing_is_left_out():
    for count, left_out in ((2, True), (3, False)):
        found, said = plausible(sensor(*[60.0] * 3, np.nan, *[-999.0] * count), 60.0, SEABED)
        assert np.isnan(found.value).sum() == 1 + count * left_out
        assert bool(said) == left_out


def test_of_readings_at_one_time_the_first_counts():
    found, said = plausible(sensor(60.0, 61.0, 99.0, 62.0, again=(2,)), 60.0, SEABED)
    assert found.value.tolist() == [60.0, 61.0, 62.0] and len(found.time) == 3
    assert said == [
        "a: 1 of its times appear twice, the earliest at 2026-03-01T01:00:00; only the "
        "first reading at each time is used"
    ]


@pytest.mark.parametrize(
    ("depth", "place", "reason"),
    [
        ([np.nan] * 4, 60.0, "no good pressure"),
        ([60.0, 60.0, np.nan, 60.0 + 9e-7], 60.0, "is constant at 60.0 m"),
        ([60.0, 60.0, 60.0 + 2e-6], 60.0, None),
        ([60.0, 60.0], 60.0, None),  # two are too few to say
    ],
)
def test_a_sensor_that_measures_nothing_is_named(depth, place, reason):
    found = unusable(("a",), np.array(depth)[:, None], np.array([place]))
    assert list(found) == ["a"] * (reason is not None)
    assert reason is None or reason in found["a"]


@pytest.mark.parametrize(
    ("least", "place", "refused"),
    [
        (121.0, 60.0, True),
        (119.0, 60.0, False),
        (29.0, 60.0, True),
        (31.0, 60.0, False),
        (29.0, 10.0, False),  # three times as deep, but 19 m
        (31.0, 10.0, True),
    ],
)
def test_a_sensor_far_from_its_place_at_its_least_is_refused(least, place, refused):
    depth = np.linspace(least, least + 40.0, 41) - 2.0  # a twentieth is less than the least
    given = ("a",), depth[:, None], np.array([place])
    if refused:
        with pytest.raises(
            UsageError, match=rf"`a` is at {least:.1f} m at its shallowest.* {place:.1f}"
        ):
            unusable(*given)
    else:
        assert unusable(*given) == {}


def test_points_are_as_far_down_the_line_as_it_was_cut(tmp_path):
    clamps = "[{use: sbe37, at: 60 m}, {use: sbe37, at: 5 m}]"
    line = f"{{use: wire-jacketed-8, length: 100 m, clamps: {clamps}}}"
    (tmp_path / "m.yaml").write_text(
        "environment: {depth: 300 m}\ncomponents:\n"
        "  ball: {kind: sphere, diameter: 2 m, buoyancy: 5 kN}\nline:\n"
        f"  - {{use: ball}}\n  - {line}\n  - {{use: anchor-wheels-3}}\n"
    )
    mooring = calm.load(tmp_path / "m.yaml")
    assert distances_of(mooring).tolist() == [7.0, 62.0, 0.0, 2.0, 102.0]


NEVER = np.datetime64("NaT")


@pytest.mark.parametrize(
    ("kind", "value", "since", "until", "read"),
    [
        ("gain", 1.1, NEVER, NEVER, [66.0, 88.0, 110.0]),
        ("offset", 3.0, NEVER, NEVER, [63.0, 83.0, 103.0]),
        ("drift", 4.0, "2026-03-01T00", "2026-03-01T02", [60.0, 82.0, 104.0]),
    ],
)
def test_what_a_fault_adds_is_taken_off(kind, value, since, until, read):
    """Of 60, 80 and 100 m, read as the words of `Fault` say."""
    fault = Fault("a", kind, value, value, value, 9.0, np.datetime64(since), np.datetime64(until))
    one = sensor(*read)
    time, depth = fault.taken_off(one.time, one.value)
    assert depth == pytest.approx([60.0, 80.0, 100.0])
    assert (time == one.time).all()


def test_times_that_are_late_are_set_back():
    late = Fault("a", "clock", 0.5, 0.5, 0.5, 9.0, NEVER, NEVER)
    one = sensor(60.0, 80.0)
    time, depth = late.taken_off(one.time, one.value)
    assert time[0] == np.datetime64("2026-02-28T23:30")
    assert depth.tolist() == [60.0, 80.0]


def test_depths_recorded_as_pressures_are_named_and_errors_of_clamps_are_not():
    place = np.array([220.0, 400.0])
    wrong = depth_of(place, 45.0)  # depths in metres read as dbar
    assert (
        "0.9 % low, as if depths in metres were recorded as dbar"
        in metre_notes(wrong, place, 45.0)[0]
    )
    assert "0.9 % high, as if pressures in dbar" in metre_notes(place, wrong + 0.1, 45.0)[0]
    # nor is a common error of the same size, or one that a single sensor has
    for off in ([-2.9, -2.9], [-2.0, 0.0], [-0.1, -0.2]):
        assert not metre_notes(place + off, place, 45.0)
    assert not metre_notes(wrong[:1], place[:1], 45.0)
    random, named = np.random.default_rng(1), 0
    for size in (5.0, 10.0, 20.0):
        for places in ([170.0, 670.0], [50.0, 1900.0], [500.0, 1500.0, 2500.0]):
            for _ in range(100):
                off = size * random.standard_normal(len(places))
                named += len(metre_notes(np.array(places) + off, np.array(places), 45.0))
    assert named <= 4
