"""How results agree with what was measured, by the definitions written out."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import xarray

import calm.motion.study as module
from calm.errors import UsageError
from calm.motion.common_unknowns import Common
from calm.motion.correction import Task
from calm.motion.matching import without
from calm.motion.measurements import MooringMeasurements
from calm.motion.study import (
    cross_validated,
    intervals,
    judge_hidden,
    judged,
    knockdown,
    prepare,
    several,
)

TIMES = 40
STILL = np.array([60.0, 150.0, 250.0])  # three clamps with a sensor each
RANDOM = np.random.default_rng(5)
DOWN = 8.0 + 8.0 * np.sin(np.arange(TIMES) / 3.0)
SHARE = np.array([1.0, 0.5, 0.1])
READ = STILL + DOWN[:, None] * SHARE + 0.2 * RANDOM.standard_normal((TIMES, 3))
READ[4, 0] = READ[9, 1] = READ[14, 2] = np.nan  # the last is one of the calmest times
OFFSET = np.array([0.5, 0.3, -0.4])


def measured():
    u = np.full((TIMES, 1), 0.3)
    return MooringMeasurements(
        np.datetime64("2026-03-01", "ns") + np.arange(TIMES) * np.timedelta64(1, "h"),
        ("a", "b", "c"), np.arange(3), READ, np.full((TIMES, 1), 20.0), np.array([-1]),
        u, 0.0 * u, np.ones(u.shape, np.int8),
    )  # fmt: skip


def common(offset):
    count = len(offset)
    covariance = np.diag([0.1, 0.2, 0.5, *[1.0] * count]) ** 2
    return Common({"cable_drag": 1.1, "rigid_drag": 0.9}, 0.4, offset, covariance)


def rms(values):
    return np.sqrt(np.nanmean(values**2))


def calmest(down, among):
    """Mean over the tenth of the times with the least knockdown."""
    where = np.flatnonzero(among)
    return where[np.argsort(down[where], kind="stable")[: max(round(0.1 * len(where)), 1)]]


@pytest.fixture
def line(monkeypatch):
    """The depths of the line in still water, without a line."""
    monkeypatch.setattr(module, "Forward", lambda *_: SimpleNamespace(still=STILL))
    monkeypatch.setattr(module, "labels_of", lambda _: ("a", "b", "c"))


def test_the_ends_of_an_interval_are_1_96_deviations_of_the_logarithm_away():
    found = intervals(Task(None, measured(), common(OFFSET)))
    assert found["cable_drag"] == pytest.approx((1.1, 1.1 * np.exp(-0.196), 1.1 * np.exp(0.196)))
    assert found["rigid_drag"] == pytest.approx((0.9, 0.9 * np.exp(-0.392), 0.9 * np.exp(0.392)))


def test_the_knockdown_is_of_the_highest_sensor_there_is():
    down = knockdown(measured())
    assert down[:4] == pytest.approx(READ[:4, 0] - np.nanmin(READ[:, 0]))
    assert down[4] == pytest.approx(READ[4, 1] - np.nanmin(READ[:, 1]))
    nothing = replace(measured(), depth=np.full((TIMES, 3), np.nan))
    assert np.isnan(knockdown(nothing)).all()


def test_a_hidden_sensor_is_judged_where_it_and_all_used_ones_have_pressures():
    used = without(measured(), ["b"])
    depth = READ[:, 1] + 2.0 + 0.3 * DOWN * RANDOM.standard_normal(TIMES)
    depth[17] = np.nan
    spread = np.full(TIMES, 1.5)
    held = judge_hidden(measured(), used, "b", depth, spread, STILL)
    among = np.isfinite(READ).all(axis=1) & np.isfinite(depth)
    rest = calmest(knockdown(used), among)
    off = np.where(among, depth - READ[:, 1], np.nan)
    share = (150.0 - 60.0) / (250.0 - 60.0)
    other = np.where(among, READ[:, 0] * (1 - share) + READ[:, 2] * share - READ[:, 1], np.nan)
    assert held.label == "b" and held.count == TIMES - 4
    assert held.bias == pytest.approx(np.nanmean(off))
    off, other = off - off[rest].mean(), other - other[rest].mean()
    assert held.rms == pytest.approx(rms(off))
    assert held.linear_rms == pytest.approx(rms(other))
    assert 0.0 < held.pchip_rms < 2.0 * held.linear_rms
    assert held.coverage == pytest.approx((np.abs(off[among]) <= 1.96 * 1.5).mean())
    assert 0.5 < held.coverage < 1.0


def test_used_sensors_are_judged_without_their_offsets_and_hidden_ones_too(line):
    used = without(measured(), ["b"])
    mooring = SimpleNamespace(
        water=SimpleNamespace(depth=300.0), file=SimpleNamespace(position=None)
    )
    task = Task(mooring, used, common(OFFSET[[0, 2]]))
    estimated = STILL + DOWN[:, None] * SHARE + 0.3 * RANDOM.standard_normal((TIMES, 3))
    residual = READ[:, [0, 2]] - OFFSET[[0, 2]] - estimated[:, [0, 2]]
    plain = estimated[:, [0, 2]] * 1.005 + 3.0
    times = {"time": used.time}
    doubt = np.where(np.arange(TIMES) == 3, 0.9, 0.1)[:, None]
    result = xarray.Dataset(
        {
            "residual": (("time", "sensor"), residual),
            "plain_depth": (("time", "sensor"), plain),
            "current_doubt": (("time", "level"), doubt),
            "clamp_depth": (("time", "clamp"), estimated),
            "clamp_depth_sd": (("time", "clamp"), np.full((TIMES, 3), 0.4)),
        },
        times,
    )
    study = judged(task, measured(), result)
    for j, column in enumerate((0, 2)):
        there = np.isfinite(READ[:, column])
        rest = calmest(knockdown(used), there)
        for found, computed in (
            (study.sensors, estimated[:, column]),
            (study.plain, plain[:, j]),
        ):
            mine = found[used.label[j]]
            off = np.where(there, computed - READ[:, column], np.nan)
            assert mine.count == there.sum()
            assert mine.bias == pytest.approx(np.nanmean(off))
            assert mine.rms == pytest.approx(rms(off - off[rest].mean()))
    expected = judge_hidden(measured(), used, "b", estimated[:, 1], np.full(TIMES, 0.4), STILL)
    assert study.held_out == {"b": expected}
    assert study.false == {"20.0 m": used.time[[3]]}
    assert len(study.remarks) == 1 and "20.0 m" in study.remarks[0]
    far = replace(task, common=replace(task.common, datum=10.0))
    assert (
        "all sensors have a common offset of +10.0 m" in judged(far, measured(), result).remarks[-1]
    )


def test_each_sensor_is_hidden_in_turn_beside_those_that_are_anyway(line, monkeypatch):
    seen = []
    estimate = np.stack([READ[:, 0] + 1.0, np.full(TIMES, 0.3)])
    smoother = SimpleNamespace(solve=lambda: None, common=lambda: common(np.zeros(1)))
    monkeypatch.setattr(module, "CurrentSmoother", lambda *_: smoother)
    monkeypatch.setattr(module, "diagnosed", lambda task: ())

    def in_memory(task, points, workers):
        seen.append((task.measured.label, points))
        return estimate[:1].T, estimate[1:].T

    monkeypatch.setattr(module, "estimate_in_memory", in_memory)
    told = []
    held = cross_validated(None, measured(), ("cable_drag",), ["b"], told.append)
    assert [one.label for one in held] == ["a", "c"] and len(told) == 2
    assert seen == [(("c",), [0]), (("a",), [2])]
    assert held[0].bias == pytest.approx(1.0)
    assert several(measured(), ["b"]) == ["a", "c"]
    for call in (
        lambda: several(measured(), ["a", "b"]),
        lambda: prepare(None, measured(), (), ["a", "b", "c"]),
    ):
        with pytest.raises(UsageError, match=r"at least two|at least one sensor"):
            call()
