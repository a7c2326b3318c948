"""All ways to read the currents and the sensors of a time, each tried by the law it is under."""

from dataclasses import replace
from itertools import combinations
from types import SimpleNamespace

import numpy as np
import pytest

import calm.motion.estimate as module
from calm.motion.common_unknowns import Common
from calm.motion.currents_law import Linear
from calm.motion.estimate import _tried, best_state, estimated, posterior
from calm.motion.line_response import LineResponse
from calm.motion.measurements import MooringMeasurements

STILL = np.array([50.0, 100.0, 180.0])  # of three points; the first and the last have sensors
GAIN = np.array([[30.0, 20.0, 8.0], [12.0, 14.0, 9.0], [1.0, 4.0, 6.0]])
U = np.array([0.5, 0.4, 0.3])
LEVELS, SENSORS = 3, np.array([0, 2])
ALL = [*combinations(range(LEVELS), 1), *combinations(range(LEVELS), 2)]


def common(scale=1.0):
    none, never = np.zeros(2), np.full(2, "NaT", "M8[ns]")
    covariance = np.diag([1.5, 0.6, 0.6, 0.0, 0.0]) ** 2  # datum, offsets, moves
    gap = np.array([[0.2, 0.25, 0.3], [0.25, 0.2, 0.3], [0.3, 0.25, 0.2]])
    return Common({}, 0.4, np.array([0.2, -0.1]), none, never, covariance, scale, gap)


def at_times(depth, flag=None, u=None):
    """So many times of three levels, the lowest of which hangs at the point in the middle."""
    n = len(depth)
    u = np.tile(U, (n, 1)) if u is None else u
    return MooringMeasurements(
        np.datetime64("2026-03-01", "ns") + np.arange(n) * np.timedelta64(1, "h"), ("a", "c"),
        SENSORS, depth, np.tile([20.0, 60.0, np.nan], (n, 1)), np.array([-1, -1, 1]),
        u, 0.0 * u, np.ones(u.shape, np.int8) if flag is None else flag,
    )  # fmt: skip


def linear(level, u, v):
    """Depths that are linear in the logarithms of the currents."""
    return STILL + 30.0 * STILL / STILL.sum() + np.log(np.hypot(u, v) / U) @ GAIN.T


def square(level, u, v):
    """Depths that go with the square of the currents, as those of a line nearly do."""
    return STILL + (u**2 + v**2) @ GAIN.T


def exact(part, other, at, common, tried):
    none = np.zeros((len(tried), LEVELS))
    slope = np.tile(GAIN, (len(tried), 1, 1))
    there = linear(other.level, other.u, other.v)
    state = Linear(none, there, slope, np.zeros((*there.shape, 0)))
    return posterior(part.measured, state, other.spread, common, STILL)


def test_the_estimate_is_that_of_all_likely_explanations_by_their_odds(monkeypatch):
    monkeypatch.setattr(module, "_tried", exact)
    known = common()
    base = linear(None, U, 0.0 * U)[SENSORS] + known.datum + known.offset
    off = np.array([[0.1, 0.0], [-25.0, -6.0], [0.3, 90.0], [14.0, 1.0], [9.0, np.nan]])
    flag = np.ones((5, 3), np.int8)
    flag[1] = 1, 3, 4
    one = at_times(base + off, flag)
    moments = LineResponse(one, SimpleNamespace(depths=linear, still=STILL), {})
    begun = best_state(moments, known)
    first, level = begun.found, moments.levels(begun.found.depth)
    tables = [(np.zeros(5), first, ())]
    odds_of_spike = np.full(5, np.log(1e-5))
    for sensor in (0, 1):
        spike = posterior(one, begun.at, begun.way.spread, known, STILL, sensor)
        tables.append((odds_of_spike, spike, ()))
    false = {1: 0.01, 3: 0.10, 4: 0.30}
    chance = np.array([[false[mark] for mark in row] for row in flag.tolist()])
    odds = np.log(chance / (1.0 - chance))
    readings = np.isfinite(one.depth).sum(axis=1)
    at_most = -0.5 * (readings + np.linalg.slogdet(first.expected)[1])
    for sets in ([()], ALL[:3], ALL[3:]):
        best = np.max([o + found.evidence for o, found, _ in tables], axis=0)
        for without in sets:
            way = moments.way(level, known, without)
            mine = odds[:, list(without)].sum(axis=1) if without else np.full(5, np.log(0.01))
            if not without:
                way = replace(way, spread=9.0 * way.spread)
            found = exact(moments, way, None, known, np.arange(5))
            hopeless = mine + at_most <= best + np.log(0.02)
            tables.append((np.where(hopeless, -np.inf, mine), found, without))
    logs = np.array([o + found.evidence for o, found, _ in tables])
    weight = np.exp(logs - logs.max(axis=0))
    weight /= weight.sum(axis=0)
    depth = np.array([found.depth for _, found, _ in tables])
    variance = np.array([found.variance for _, found, _ in tables])
    mean = (weight[:, :, None] * depth).sum(axis=0)
    spread = (weight[:, :, None] * (variance + (depth - mean) ** 2)).sum(axis=0)
    doubt = np.array([[g in without for g in range(3)] for *_, without in tables], float)
    result = estimated(moments, known)
    assert result.depth == pytest.approx(mean)
    assert result.deviation == pytest.approx(np.sqrt(spread))
    assert result.doubt == pytest.approx(np.einsum("en,eg->ng", weight, doubt), abs=1e-12)
    # the cases are what they are meant to be: a false level, a spike, all worse, one of these
    assert result.doubt[1].max() > 0.3 > 0.05 > result.doubt[0].max()
    assert abs(mean[2, 2] - (base + off)[2, 1]) > 80.0
    tried = np.isfinite(logs).sum(axis=0)
    assert tried.min() < len(tables) and len({*tried.tolist()}) > 2
    likely = np.argmax(logs, axis=0)
    assert len({*likely.tolist()}) > 2
    for i, best in enumerate(likely.tolist()):  # its levels, and its currents with their factors
        way = moments.way(level, known, tables[best][2])
        hung = begun.way.level if best < 3 else way.level
        assert result.likely.level[i] == pytest.approx(hung[i])
        assert result.likely.u[i] == pytest.approx(way.u[i] * np.exp(tables[best][1].logs[i]))


def test_without_sensors_the_currents_are_all_that_is_known():
    one = at_times(np.zeros((2, 0)))
    one = replace(one, label=(), point=np.zeros(0, np.int64))
    none = np.zeros(0)
    known = replace(
        common(), offset=none, moved=none, since=none.astype("M8[ns]"),
        covariance=np.array([[1.5**2]]),
    )  # fmt: skip
    moments = LineResponse(one, SimpleNamespace(depths=linear, still=STILL), {})
    result = estimated(moments, known)
    assert result.depth == pytest.approx(linear(None, np.tile(U, (2, 1)), 0.0) + known.datum)
    assert (result.doubt == 0.0).all()


@pytest.mark.parametrize("weaker", [0.7, 1.0, 1.6])
def test_the_state_of_another_reading_is_that_of_gauss_and_newton(weaker):
    """From the slopes of the currents as measured, in others, against steps with its own slopes."""
    known = common(2.0)
    here = square(None, U, 0.0)
    there = square(None, weaker * U, 0.0)
    tried = np.array([0])
    read = (there + 0.2 * (there - STILL))[SENSORS] + known.datum + known.offset
    one = at_times(read[None], u=weaker * U[None])
    part = LineResponse(one, SimpleNamespace(depths=square, still=STILL), {})
    way = part.way(part.levels(there[None]), known)
    slope = 2.0 * GAIN * U**2
    at = Linear(np.zeros((1, 3)), here[None], slope[None], np.zeros((1, 3, 0)))
    found = _tried(part, way, at, known, tried)
    logs = np.zeros((1, 3))
    for _ in range(30):
        u = weaker * U * np.exp(logs[0])
        own = Linear(logs, square(None, u, 0.0)[None], (2.0 * GAIN * u**2)[None], at.common)
        exactly = posterior(one, own, way.spread, known, STILL)
        logs = exactly.logs
    assert np.abs(logs).max() > 0.05
    assert found.depth == pytest.approx(exactly.depth, abs=0.01)
    assert found.logs == pytest.approx(exactly.logs, abs=3e-3)
    assert found.variance == pytest.approx(exactly.variance, rel=0.05)
    assert found.evidence == pytest.approx(exactly.evidence, abs=0.02)


def test_a_reading_that_its_neighbours_share_is_no_spike():
    """40 m off at one time is a spike by itself; the readings before and after tell."""
    known = common()
    base = linear(None, U, 0.0 * U)[SENSORS] + known.datum + known.offset
    off = np.array([0.0, 40.0])
    moments = LineResponse(
        at_times(base[None] + off), SimpleNamespace(depths=linear, still=STILL), {}
    )
    alone = estimated(moments, known).depth[0, 2]
    deviation = np.array([[0.5, 0.5]])
    steady = estimated(moments, known, None, (base[None] + off, deviation)).depth[0, 2]
    thrown = estimated(moments, known, None, (base[None], deviation)).depth[0, 2]
    silent = estimated(moments, known, None, (base[None] * np.nan, deviation * np.inf)).depth[0, 2]
    without_it = linear(None, U, 0.0 * U)[2] + known.datum
    assert abs(alone - without_it) < 2.0
    assert thrown == pytest.approx(alone) and silent == pytest.approx(alone)
    assert steady - without_it > 30.0
