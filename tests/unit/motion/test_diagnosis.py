"""What is wrong with sensors is named with its size; of sound ones nothing is said."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import quad

from calm.motion.common_unknowns import ROBUST, Common, LinearLaw
from calm.motion.diagnosis import GAIN, Diagnosis
from calm.motion.measurements import interpolated
from calm.motion.remarks import ALL

TIMES = 240
TIME = np.datetime64("2026-01-01", "ns") + np.arange(TIMES) * np.timedelta64(1, "h")
HOURS, SHARE = np.arange(float(TIMES)), np.linspace(0.0, 1.0, TIMES)
LABELS = ("upper", "middle", "lower")
PLACE = np.array([50.0, 120.0, 250.0])
NOISE, CURRENT = 0.2, 0.05


def knocked(hours):
    """(n, 3) knockdown in a tide and a storm [m]."""
    speed = 0.3 + 0.3 * np.sin(2 * np.pi * hours / 12.42) + 0.2 * np.sin(hours / 25.0)
    return np.square(speed)[:, None] * np.array([60.0, 35.0, 5.0])


def diagnosis(change=lambda depth: depth, seed=3):
    random = np.random.default_rng(seed)
    down = knocked(HOURS)
    error = CURRENT * random.standard_normal((TIMES, 1)) * down
    # errors of the line itself: each sensor by 1 % of its knockdown
    error += 0.01 * down * random.standard_normal((TIMES, 3))
    depth = change(PLACE + 2.0 + down + error + NOISE * random.standard_normal((TIMES, 3)))
    expected = CURRENT**2 * down[:, :, None] * down[:, None, :]
    expected += np.eye(3) * (NOISE**2 + (0.01 * down[:, :, None]) ** 2)
    fixed = np.concatenate(
        [down[:, :, None], np.ones((TIMES, 3, 1)), np.tile(np.eye(3), (TIMES, 1, 1))], axis=2
    )
    known = np.isfinite(depth)
    expected += np.eye(3) * np.where(known, 0.0, 1e8)[:, :, None]
    raw = np.where(known, depth - PLACE - down, 0.0)
    law = LinearLaw(
        TIME,
        SHARE,
        known,
        raw,
        raw,
        expected,
        fixed,
        np.ones((TIMES, 3)),
    )
    common = Common({"cable_drag": 1.0}, 0.0, np.zeros(3), np.eye(5))
    water = SimpleNamespace(water=SimpleNamespace(depth=300.0))
    measured = SimpleNamespace(time=TIME, label=LABELS, depth=depth)
    return Diagnosis(SimpleNamespace(measured=measured, common=common, mooring=water), law)


def later(depth, hours, columns):
    """As sensors write it whose clocks are late by so much."""
    result = depth.copy()
    for j in columns:
        result[:, j] = np.interp(HOURS - hours, HOURS, depth[:, j])
    return result


def changed(column, value):
    def change(depth):
        result = depth.copy()
        result[:, column] += value
        return result

    return change


@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_of_sound_sensors_nothing_is_said(seed):
    assert diagnosis(seed=seed).faults() == ()


def test_of_gaps_nothing_is_said():
    def gaps(depth):
        depth = depth.copy()
        depth[50:90, 1], depth[::7, 0] = np.nan, np.nan
        return depth

    assert diagnosis(gaps).faults() == ()


CASES = {
    "an hour": (lambda d: later(d, 1.0, [1]), "middle", "clock", 1.0),
    "ten minutes": (lambda d: later(d, 1.0 / 6.0, [0]), "upper", "clock", 1.0 / 6.0),
    "early": (lambda d: later(d, -2.0, [0]), "upper", "clock", -2.0),
    "all clocks": (lambda d: later(d, 1.0, [0, 1, 2]), ALL, "clock", 1.0),
    "drift": (changed(2, 5.0 * SHARE), "lower", "drift", 5.0),
    "settles": (changed(1, -4.0 * np.minimum(SHARE / 0.3, 1.0)), "middle", "drift", -4.0),
    "slip": (changed(1, np.where(HOURS >= 100, 4.0, 0.0)), "middle", "slip", 4.0),
    "gain": (lambda d: d * [1.03, 1.0, 1.0], "upper", "gain", 1.03),
    "moved": (lambda d: d + np.where(HOURS >= 90, 12.0, 0.0)[:, None], ALL, "moved", 12.0),
    "all gains": (lambda d: d * 1.06, ALL, "gain", 1.06),
}


@pytest.mark.parametrize("name", CASES)
def test_what_is_wrong_is_named_with_its_size(name):
    change, label, kind, value = CASES[name]
    (found,) = diagnosis(change).faults()
    assert (found.label, found.kind) == (label, kind)
    assert found.certain or label == ALL  # of three sensors a gain of all may be offsets
    assert found.low <= value <= found.high
    assert found.value == pytest.approx(value, abs=0.02 if kind in ("clock", "gain") else 0.4)
    assert found.sentence().startswith(f"{label}: ")


def test_two_things_that_are_wrong_are_both_named():
    change = changed(2, 5.0 * SHARE)
    found = diagnosis(lambda d: later(change(d), 1.0, [0])).faults()
    assert {(one.label, one.kind) for one in found} == {("upper", "clock"), ("lower", "drift")}


def test_a_zero_and_a_gain_of_a_sensor_that_hardly_moves_cannot_be_told_apart():
    (found,) = diagnosis(changed(2, 8.0)).faults()
    assert found.label == "lower" and not found.certain
    assert "cannot distinguish these" in found.sentence() and found.rival


def test_the_weight_of_a_fault_is_that_of_the_likelihood_integrated_over_its_size():
    """Laplace against a quadrature, with all but the size of a gain held."""
    given = diagnosis(lambda d: d * [1.01, 1.0, 1.0])
    held = np.diag(np.full(5, 1e-12))
    given.spread = held
    suspect = next(
        one
        for one in given._suspects([], given.fitted([], None, 1.0))
        if one.fault.label == "upper" and one.fault.kind == "gain"
    )
    law, inverse = given.law, np.linalg.inv(given.law.expected)

    def log(size):
        left = law.raw - suspect.column * size
        misfit = np.einsum("ns,nst,nt->n", left, inverse, left)
        return -0.5 * float(((ROBUST + 3) * np.log1p(misfit / ROBUST)).sum())

    found, none = given.fitted([], suspect, 1.0), given.fitted([], None, 1.0)
    best = log(found.value)
    whole, _ = quad(
        lambda z: np.exp(log(z) - best - 0.5 * (z / GAIN) ** 2) / GAIN / np.sqrt(2.0 * np.pi),
        found.value - 8.0 * found.deviation,
        found.value + 8.0 * found.deviation,
    )
    # Laplace takes the weights as they are at the best size: some 10 % of the width of Student's
    assert found.log - none.log == pytest.approx(np.log(whole) + best - log(0.0), abs=0.3)


def test_between_times_noise_neither_grows_nor_is_smoothed():
    given = diagnosis()
    white = np.random.default_rng(5).standard_normal((TIMES, 3))
    given.measured.depth, given._kept = white, {}
    inside = slice(2, -2)
    for late in (0.1, 0.25, 0.4):
        assert np.var(given._at(late)[inside]) == pytest.approx(np.var(white), rel=0.06)
    straight = interpolated(
        TIME, white[:, 0], TIME + np.timedelta64(24, "m"), np.timedelta64(2, "h")
    )
    assert np.nanvar(straight) < 0.7 * np.var(white)
