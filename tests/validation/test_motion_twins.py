"""Twins: a mooring whose drag, offsets and currents are made, and measured with errors and gaps.

Whatever is drawn from the laws that `calm.motion` assumes must lie within its intervals as often as
these say. The line is that of docs/field/dune2; everything that was measured is made.
"""

from pathlib import Path

import numpy as np
import pytest

import calm
from calm.motion import prior
from calm.motion.forward import Forward, points
from calm.motion.matching import labels_of
from calm.motion.measured import Measured
from calm.motion.task import Task
from calm.motion.whole_record import estimate_common

FIELD = Path(__file__).parents[2] / "docs" / "field" / "dune2"
LEVELS = ("Aquadopp 626", "Aquadopp 426", "Aquadopp 226", "Aquadopp 26")
USED = ("Aquadopp 626", "Aquadopp 26")
BETWEEN = ("solo 575", "Aquadopp 426", "Aquadopp 226")
NAMES = ("cable_drag", "rigid_drag")
TIMES = 80


@pytest.fixture(scope="module")
def mooring():
    return calm.load(FIELD / "mooring.yaml")


def wandering(random, count, memory=0.9):
    """Series of unit variance in which neighbouring times are alike."""
    series = np.zeros((TIMES, count))
    series[0] = random.standard_normal(count)
    for time in range(1, TIMES):
        step = random.standard_normal(count)
        series[time] = memory * series[time - 1] + np.sqrt(1.0 - memory**2) * step
    return series


def twin(mooring, seed):
    """What was measured, and the truth: logarithms of the factors, depths of all points [m]."""
    random = np.random.default_rng(seed)
    logs = 0.15 * random.standard_normal(2)
    forward = Forward(mooring, dict(zip(NAMES, np.exp(logs), strict=True)))
    labels = labels_of(mooring)
    at = np.array([labels.index(label) for label in LEVELS])
    shape = np.array([1.0, 0.8, 0.8, 0.9])
    east, north = (wandering(random, 2) * [0.35, 0.25]).T
    u = east[:, None] * shape + 0.08 * wandering(random, len(LEVELS))
    v = north[:, None] * shape + 0.08 * wandering(random, len(LEVELS))
    level = np.tile(forward.still[at], (TIMES, 1))
    for _ in range(4):
        depth = points(forward.solve(level, u, v))
        level = depth[:, at]
    place = np.linspace(-1.0, 1.0, len(LEVELS))
    error = prior.CURRENT * random.standard_normal((TIMES, 1))
    error = error + prior.SHEAR * place * random.standard_normal((TIMES, 1))
    error = error + prior.LEVEL[1] * random.standard_normal(u.shape)
    speed = np.maximum(np.hypot(u, v), 0.02)
    error += prior.STEADY / speed * random.standard_normal(u.shape)
    turned = random.random(u.shape) < prior.FALSE[1]  # a tilted meter's direction
    angle = turned * random.uniform(0.5, np.pi, u.shape)
    flow = (u + 1j * v) * np.exp(-error + 1j * angle)
    sensor = np.array([labels.index(label) for label in USED])
    sea = 0.8 * np.sin(2.0 * np.pi * np.arange(TIMES) / 12.42) + 0.3 * wandering(random, 1)[:, 0]
    surface = depth + 3.0 * random.standard_normal() + sea[:, None]
    offset = prior.OFFSET * random.standard_normal(len(USED))
    noise = prior.NOISE * random.standard_normal((TIMES, len(USED)))
    pressure = surface[:, sensor] + offset + noise
    pressure[random.random(pressure.shape) < 0.05] = np.nan
    flow[random.random(flow.shape) < 0.03] = np.nan
    measured = Measured(
        time=np.datetime64("2026-01-01", "ns") + np.arange(TIMES) * np.timedelta64(1, "h"),
        label=USED,
        point=sensor,
        depth=pressure,
        level_depth=np.full(u.shape, np.nan),
        level_point=at,
        level_sensor=np.array([USED.index(label) if label in USED else -1 for label in LEVELS]),
        u=flow.real,
        v=flow.imag,
        flag=np.ones(u.shape, np.int8),
    )
    return measured, logs, surface


def recovered(mooring, seed):
    """Of one twin: errors of the factors in deviations; whether each depth is in its band."""
    measured, logs, depth = twin(mooring, seed)
    common = estimate_common(mooring, measured, NAMES)
    deviation = np.sqrt(np.diag(common.covariance))[: len(NAMES)]
    missed = (np.log(list(common.factors.values())) - logs) / deviation
    profiles, more = Task(mooring, measured, common).columns(0, TIMES)
    labels = labels_of(mooring)
    hidden = [labels.index(label) for label in BETWEEN]
    off = np.abs(profiles.clamp_depth[:, hidden] - depth[:, hidden])
    return missed, off <= 1.96 * more["clamp_depth_sd"][:, hidden]


def test_a_twin_is_recovered(mooring):
    missed, inside = recovered(mooring, 3)
    assert (np.abs(missed) < 3.0).all()
    assert inside.mean() > 0.8


@pytest.mark.slow
def test_200_twins_lie_within_their_intervals(mooring):
    twins = [recovered(mooring, seed) for seed in range(200)]
    missed = np.array([one[0] for one in twins])
    assert 0.92 <= (np.abs(missed) <= 1.96).mean() <= 0.98
    assert 0.92 <= np.mean([one[1] for one in twins]) <= 0.98


@pytest.mark.thorough
def test_what_a_block_holds_changes_nothing(mooring):
    measured, _, _ = twin(mooring, 5)
    task = Task(mooring, measured, estimate_common(mooring, measured.at(slice(0, 40)), NAMES))
    whole, more = task.columns(0, 40)
    part, less = task.columns(20, 30)
    np.testing.assert_allclose(part.clamp_depth, whole.clamp_depth[20:30], rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(less["depth_sd"], more["depth_sd"][20:30], rtol=0.0, atol=1e-9)
