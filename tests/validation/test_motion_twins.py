"""Twins: a mooring whose drag, offsets and currents are made, and measured with errors and gaps.

Drag and depths must lie within their intervals as often as these say. The line is that of
docs/field/dune2; everything that was measured is made.
"""

from pathlib import Path

import numpy as np
import pytest

import calm
from calm.motion import common_unknowns
from calm.motion.diagnosis import diagnosed
from calm.motion.line_response import Forward, labels_of, points
from calm.motion.measurements import MooringMeasurements
from calm.motion.study import prepare

FIELD = Path(__file__).parents[2] / "docs" / "field" / "dune2"
LEVELS = ("Aquadopp 626", "Aquadopp 426", "Aquadopp 226", "Aquadopp 26")
USED = ("Aquadopp 626", "Aquadopp 26")
THREE = ("Aquadopp 626", "Aquadopp 226", "Aquadopp 26")
BETWEEN = ("solo 575", "Aquadopp 426", "Aquadopp 226")
NAMES = ("cable_drag", "rigid_drag")
TIMES = 80
WHOLE, SHEAR, OWN, STEADY, FALSE = 0.05, 0.05, 0.05, 0.01, 0.01
"""Errors of the currents: of all, growing down the line, of each, [m/s]; how many are false."""


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


def twin(mooring, seed, used=USED, slip=None):
    """What was measured, and the truth: logarithms of the factors, depths of all points [m].

    Of a slip: the label of a used sensor, how far down the line it is from its place in the file
    [m], from which time on.
    """
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
    error = WHOLE * random.standard_normal((TIMES, 1))
    error = error + SHEAR * place * random.standard_normal((TIMES, 1))
    error = error + OWN * random.standard_normal(u.shape)
    speed = np.maximum(np.hypot(u, v), 0.02)
    error += STEADY / speed * random.standard_normal(u.shape)
    turned = random.random(u.shape) < FALSE  # a tilted meter's direction
    angle = turned * random.uniform(0.5, np.pi, u.shape)
    flow = (u + 1j * v) * np.exp(-error + 1j * angle)
    sensor = np.array([labels.index(label) for label in used])
    sea = 0.8 * np.sin(2.0 * np.pi * np.arange(TIMES) / 12.42) + 0.3 * wandering(random, 1)[:, 0]
    surface = depth + 3.0 * random.standard_normal() + sea[:, None]
    offset = common_unknowns.OFFSET * random.standard_normal(len(used))
    noise = common_unknowns.NOISE * random.standard_normal((TIMES, len(used)))
    pressure = surface[:, sensor] + offset + noise
    if slip is not None:
        label, down, start = slip
        down_the_line, column = np.argsort(forward.still), used.index(label)
        place = forward.still[sensor[column]] + np.array([0.0, down])
        for time in range(start, TIMES):
            along = forward.still[down_the_line], surface[time, down_the_line]
            pressure[time, column] += np.diff(np.interp(place, *along))[0]
    pressure[random.random(pressure.shape) < 0.05] = np.nan
    flow[random.random(flow.shape) < 0.03] = np.nan
    measured = MooringMeasurements(
        time=np.datetime64("2026-01-01", "ns") + np.arange(TIMES) * np.timedelta64(1, "h"),
        label=used,
        point=sensor,
        depth=pressure,
        level_depth=np.full(u.shape, np.nan),
        level_point=at,
        u=flow.real,
        v=flow.imag,
        flag=np.ones(u.shape, np.int8),
    )
    return measured, logs, surface


def recovered(mooring, seed, used=USED, slip=None):
    """Of one twin: errors of the factors in deviations; which depths are in their bands; doubts."""
    measured, logs, depth = twin(mooring, seed, used, slip)
    task = prepare(mooring, measured, NAMES, ())
    common = task.common
    deviation = np.sqrt(np.diag(common.covariance))[: len(NAMES)]
    missed = (np.log(list(common.factors.values())) - logs) / deviation
    profiles, more = task.columns(0, TIMES)
    labels = labels_of(mooring)
    hidden = [labels.index(label) for label in BETWEEN if label not in used]
    off = np.abs(profiles.clamp_depth[:, hidden] - depth[:, hidden])
    inside = off <= 1.96 * more["clamp_depth_sd"][:, hidden]
    return missed, inside, [one.sentence() for one in diagnosed(task)]


def test_a_twin_is_recovered(mooring):
    missed, inside, said = recovered(mooring, 3)
    assert (np.abs(missed) < 3.0).all()
    assert inside.mean() > 0.9 and not said


def test_tide_and_correlation_time_of_the_currents_are_learnt(mooring):
    """A tide of 0.64 m (root mean square); currents with a memory of 0.9 an hour, 9.5 h."""
    scales = prepare(mooring, twin(mooring, 14)[0], NAMES, ()).smoother.scales
    assert scales.tide == pytest.approx(0.64, rel=0.25)
    assert 6.0 < scales.hours < 14.0


SLIPS = (12.0, -9.0, 20.0, -15.0)  # down the line [m]


@pytest.mark.thorough
@pytest.mark.parametrize(("label", "down", "start", "said"), [
    ("Aquadopp 226", 12.0, 0, "it has a constant offset"),
    ("Aquadopp 626", -9.0, 40, "its clamp has probably slipped"),
])  # fmt: skip
def test_a_sensor_that_is_not_where_the_file_says_is_named_and_bends_nothing(
    mooring, label, down, start, said
):
    missed, inside, doubted = recovered(mooring, 0, THREE, (label, down, start))
    found, *_ = (one for one in doubted if one.startswith(f"{label}: "))
    assert said in found and "cannot distinguish" not in found
    assert (np.abs(missed) < 3.0).all()
    assert inside.mean() > 0.9


@pytest.mark.thorough
def test_of_two_sensors_too_the_one_that_hangs_elsewhere_leaves_the_bands_honest(mooring):
    _, plain, _ = recovered(mooring, 0)
    missed, inside, doubted = recovered(mooring, 0, USED, ("Aquadopp 26", -9.0, 0))
    assert any("Aquadopp 26: " in one for one in doubted)
    assert (np.abs(missed) < 3.0).all()
    assert inside.mean() >= plain.mean() - 0.05


@pytest.mark.thorough
def test_a_slip_in_strong_currents_is_not_taken_for_their_errors(mooring):
    missed, inside, doubted = recovered(mooring, 414, USED, ("Aquadopp 626", 20.0, 44))
    assert doubted[0].startswith("Aquadopp 626: ") and "below its nominal position" in doubted[0]
    assert (np.abs(missed) < 3.0).all()
    assert inside.mean() > 0.9


@pytest.mark.slow
@pytest.mark.parametrize("begins", [lambda seed: 0, lambda seed: 30 + seed % 20])
def test_100_twins_with_a_sensor_elsewhere_lie_within_their_intervals(mooring, begins):
    twins = [
        (THREE[seed % 3], recovered(mooring, seed, THREE, (THREE[seed % 3], down, begins(seed))))
        for seed, down in enumerate(SLIPS * 25)
    ]
    assert np.mean([one[1] for _, one in twins]) >= 0.92
    assert np.mean([any(label in said for said in one[2]) for label, one in twins]) >= 0.95
    assert (np.abs([one[0] for _, one in twins]) <= 1.96).mean() >= 0.88


@pytest.mark.slow
def test_200_twins_lie_within_their_intervals(mooring):
    twins = [recovered(mooring, seed) for seed in range(200)]
    assert 0.90 <= (np.abs([one[0] for one in twins]) <= 1.96).mean() <= 0.99
    assert 0.92 <= np.mean([one[1] for one in twins]) <= 0.995


@pytest.mark.thorough
def test_what_a_block_holds_changes_nothing(mooring):
    measured, _, _ = twin(mooring, 5)
    task = prepare(mooring, measured, NAMES, ())
    whole, more = task.columns(0, 40)
    part, less = task.columns(20, 30)
    np.testing.assert_allclose(part.clamp_depth, whole.clamp_depth[20:30], rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(less["depth_sd"], more["depth_sd"][20:30], rtol=0.0, atol=1e-9)
