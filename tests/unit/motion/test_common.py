"""What is common to a record, against the same law written out and iterated to its end."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from calm.motion import common_unknowns, line_response
from calm.motion.measurements import MooringMeasurements
from calm.motion.whole_record import _scale, _widened, _worst, estimate_common, repeated

STILL = np.array([50.0, 100.0, 180.0])  # of three points; the first and the last have sensors
GAIN = np.array([[90.0, 60.0], [50.0, 45.0], [15.0, 20.0]])
SENSORS = np.array([0, 2])
MOORING = SimpleNamespace(water=SimpleNamespace(depth=200.0))
TIMES = 150


class Line:
    """A line whose knockdown goes with its drag and with the square of the currents."""

    def __init__(self, mooring, factors):
        self.factor, self.still = factors.get("cable_drag", 1.0), STILL

    def depths(self, level, u, v):
        return STILL + self.factor * (u**2 + v**2) @ GAIN.T


def record(seed, factor, datum, wrong, memory=0.0):
    """Currents that are wrong by so many times their prior, and pressures of the line in them."""
    random = np.random.default_rng(seed)
    phase = np.arange(TIMES)[:, None] / [9.0, 7.0]
    u = 0.6 + 0.35 * np.sin(phase)
    error = random.standard_normal((TIMES, 4))
    for i in range(1, TIMES):
        error[i] = memory * error[i - 1] + np.sqrt(1.0 - memory**2) * error[i]
    whole, shear, own = error[:, :1], error[:, 1:2] * [-1.0, 1.0], error[:, 2:]
    logs = wrong * 0.05 * (whole + shear + own)
    depth = Line(None, {"cable_drag": factor}).depths(None, u * np.exp(logs), 0.0)[:, SENSORS]
    depth += datum + np.array([0.4, -0.3]) + random.standard_normal((TIMES, 1))
    depth += common_unknowns.NOISE * random.standard_normal(depth.shape)
    depth[7, 0] += 40.0  # an outlier, and what was not measured
    depth[[20, 90], [0, 1]] = np.nan
    return MooringMeasurements(
        np.datetime64("2026-03-01", "ns") + np.arange(TIMES) * np.timedelta64(1, "h"), ("a", "c"),
        SENSORS, depth, np.tile([20.0, 60.0], (TIMES, 1)), np.full(2, -1), u,
        0.0 * u, np.ones(u.shape, np.int8),
    )  # fmt: skip


def best(one, start=None):
    """Value and covariance of the factor, the datum and two offsets, the scale: all written out.

    And how far down the line the lower sensor has moved, if it has from some time on.
    """
    prior_of = np.diag([0.15, 0.01 * 200.0, 1.0, 1.0, 20.0][: 4 + (start is not None)]) ** 2
    known = np.isfinite(one.depth)
    square = one.u**2
    own = np.hypot(0.05, 0.01 / one.u)
    currents = 0.05**2 * np.ones((2, 2)) + 0.05**2 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    spread = currents + own[:, :, None] ** 2 * np.eye(2)
    apart = np.abs(STILL[SENSORS][:, None] - STILL[SENSORS])
    alike_down = np.exp(-apart / (0.25 * np.ptp(STILL)))
    state, scale, worst = np.zeros(len(prior_of)), 1.0, 0.07
    for _ in range(12):
        factor = np.exp(state[0])
        down = factor * square @ GAIN[SENSORS].T
        slope = factor * (np.exp(0.1) - 1.0) / 0.05 * GAIN[SENSORS] * square[:, None, :]
        by_currents = scale**2 * slope @ spread @ slope.transpose(0, 2, 1)
        rest = common_unknowns.TIDE**2 + common_unknowns.NOISE**2 * np.eye(2)
        bent = down[:, :, None] * alike_down * down[:, None, :]
        rest = rest + worst**2 * bent
        rest = rest + np.where(known, 0.0, 1e8)[:, :, None] * np.eye(2)
        bend = 0.5 * np.einsum("nss->ns", by_currents) / np.maximum(down, 1.0)
        left = one.depth - STILL[SENSORS] - down - state[1] - state[2:4] - bend
        seen = np.concatenate(
            [
                (np.exp(0.05) - 1.0) / 0.05 * down[:, :, None],
                np.ones((TIMES, 2, 1)),
                np.tile(np.eye(2), (TIMES, 1, 1)),
            ],
            axis=2,
        )
        if start is not None:  # the line below the point in the middle leans so much
            middle = factor * square @ GAIN[1]
            share = (80.0 + down[:, 1] - middle) / 80.0
            fall = np.where(np.arange(TIMES) >= start, share, 0.0)
            seen = np.concatenate([seen, (fall[:, None] * [0.0, 1.0])[:, :, None]], axis=2)
            left = left - seen[:, :, 4] * state[4]
        left = np.where(known, left, 0.0)
        usual = rest + (0.07**2 - worst**2) * bent + by_currents
        tried, _ = _scale(left, usual, by_currents, scale)
        usual = usual + ((tried / scale) ** 2 - 1.0) * by_currents
        before, worst = worst, _worst(left, rest + by_currents, bent, worst)
        worst = worst if _widened(left, usual, known) == 1.0 else 0.07
        rest = rest + (worst**2 - before**2) * bent
        scale, _ = _scale(left, rest + by_currents, by_currents, scale)
        by_currents = scale**2 * slope @ spread @ slope.transpose(0, 2, 1)
        inverse = np.linalg.inv(rest + by_currents)
        misfit = np.einsum("ns,nst,nt->n", left, inverse, left)
        weight = (4.0 + known.sum(axis=1)) / (4.0 + misfit)
        normal = np.einsum("n,nsi,nst,ntj->ij", weight, seen, inverse, seen)
        each = np.einsum("n,nsi,nst,nt->ni", weight, seen, inverse, left)
        memory = repeated(each[:, 0])
        pull = each.sum(axis=0) + normal @ state
        covariance = np.linalg.inv(normal / memory + np.linalg.inv(prior_of))
        state = covariance @ pull / memory
    return state, covariance, scale, memory


@pytest.mark.parametrize(
    ("seed", "factor", "datum", "wrong", "memory"),
    [(1, 1.25, 2.0, 1.0, 0.0), (2, 0.85, -1.5, 1.7, 0.0), (3, 1.1, 0.5, 1.0, 0.8)],
)
def test_the_common_factor_is_that_of_the_law_written_out(
    monkeypatch, seed, factor, datum, wrong, memory
):
    monkeypatch.setattr(line_response, "Forward", Line)
    one = record(seed, factor, datum, wrong, memory)
    found = estimate_common(MOORING, one, ("cable_drag",))
    state, covariance, scale, repeated = best(one)
    deviation = np.sqrt(np.diag(covariance))
    mine = np.concatenate([[np.log(found.factors["cable_drag"]), found.datum], found.offset])
    assert (np.abs(mine - state) < 0.03 * deviation).all()
    assert np.sqrt(np.diag(found.covariance)[:4]) == pytest.approx(deviation, rel=0.05)
    assert found.scale == pytest.approx(scale)
    assert (repeated > 1.5) == (memory > 0.0)


def slipped(seed, size, memory=0.0, start=80):
    """The lower sensor hangs lower from a time on, its errors may repeat; no first reading."""
    one = record(seed, 1.1, 1.0, 1.0)
    random = np.random.default_rng(seed)
    error = 0.8 * random.standard_normal(TIMES)
    for i in range(1, TIMES):
        error[i] = memory * error[i - 1] + np.sqrt(1.0 - memory**2) * error[i]
    depth = one.depth + np.array([0.0, 1.0]) * (size * (np.arange(TIMES) >= start))[:, None]
    depth[:, 1] += error * (memory > 0.0)
    depth[0] = np.nan
    return replace(one, depth=depth)


def test_a_sensor_that_slips_is_as_if_that_were_known(monkeypatch):
    monkeypatch.setattr(line_response, "Forward", Line)
    one = slipped(4, 4.0)
    found = estimate_common(MOORING, one, ("cable_drag",))
    state, covariance, scale, _ = best(one, 80)
    deviation = np.sqrt(np.diag(covariance))
    mine = np.concatenate([[np.log(found.factors["cable_drag"]), found.datum], found.offset])
    mine = np.append(mine, found.moved[1])
    assert (np.abs(mine - state) < 0.05 * deviation).all()
    assert found.scale == pytest.approx(scale)
    assert (
        found.since.tolist() == one.time[[80, 80]].tolist()
    )  # what never moves is as the file says
    assert abs(found.moved[0]) < 0.01


@pytest.mark.parametrize(
    ("seed", "memory", "low", "high"),
    [(6, 0.0, 1.2, 3.0), (10, 0.9, 0.0, 0.5), (8, 0.9, 1.2, 3.0)],
)
def test_errors_that_repeat_make_a_slip_less_sure(monkeypatch, seed, memory, low, high):
    """A small one, beside errors that are white, that cannot be told from it, and that can."""
    monkeypatch.setattr(line_response, "Forward", Line)
    found = estimate_common(MOORING, slipped(seed, 1.5, memory), ("cable_drag",))
    assert low <= found.moved[1] <= high
    # as likely not moved as one in fifty would make it 0.35 m
    assert np.sqrt(found.covariance[-1, -1]) < 0.35


def test_a_sensor_elsewhere_throughout_is_so_from_the_first_time_of_the_record(monkeypatch):
    monkeypatch.setattr(line_response, "Forward", Line)
    one = slipped(4, 9.0, start=0)
    found = estimate_common(MOORING, one, ("cable_drag",))
    assert found.since[1] == one.time[0]
    # its zero, or its place: which of them is not told
    assert found.offset[1] + found.moved[1] == pytest.approx(9.0 - 0.3, abs=1.0)
    assert found.factors["cable_drag"] == pytest.approx(1.1, rel=0.05)
