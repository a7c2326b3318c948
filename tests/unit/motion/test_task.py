"""What a block of times comes to, and what is known of a record, from parts written out."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

import calm.motion.correction as module
from calm.batch.statuses import STATUSES
from calm.motion.common_unknowns import Common
from calm.motion.correction import MeasuredRecord, Task
from calm.motion.currents_law import ReadCurrents
from calm.motion.matching import without
from calm.motion.measurements import MooringMeasurements

STILL = np.array([60.0, 150.0, 40.0, 250.0])  # two clamps, then two components
U = np.array([[0.3, 0.4], [0.5, 0.2], [np.nan, np.nan], [0.1, 0.1]])
V = 0.5 * U
READ = np.array([[66.0, 255.0], [70.0, np.nan], [61.0, 250.0], [62.0, 251.0]])


@dataclass(frozen=True)
class Solved:
    """What a task takes of the profiles of a batch."""

    clamp_depth: np.ndarray
    depth_top: np.ndarray
    clamp_knockdown: np.ndarray
    knockdown: np.ndarray
    top_depth: np.ndarray
    status: np.ndarray
    tension: np.ndarray

    def with_columns(self, **columns):
        return replace(self, **columns)


class Line:
    """Its knockdown is 10 m at u of 1 m/s and a twentieth of the depth of the upper level."""

    still = STILL

    def depths(self, level, u, v):
        return STILL + (10.0 * u[:, :1] + level[:, :1] / 20.0) * [1.0, 0.5, 1.2, 0.1]

    def solve(self, level, u, v):
        depth = 100.0 * u[:, :1] + 10.0 * v[:, :1] + STILL + level[:, :1]
        lost = ~np.isfinite(u).all(axis=1)
        status = np.where(lost, STATUSES.index("no-current"), 0).astype(np.int8)
        return Solved(depth[:, :2], depth[:, 2:], 0.0 * depth[:, :2], 0.0 * depth[:, 2:],
                      depth[:, 2] - 1.5, status, u + 10.0 * v)  # fmt: skip


def measured(**more):
    one = MooringMeasurements(
        np.datetime64("2026-03-01", "ns") + np.arange(4) * np.timedelta64(1, "h"), ("a", "d"),
        np.array([0, 3]), READ, np.array([[20.0, np.nan]] * 4), np.array([-1, 0]),
        U, V, np.ones((4, 2), np.int8),
    )  # fmt: skip
    return replace(one, **more)


def common():
    return Common({"cable_drag": 1.2}, 2.0, np.array([0.5, -0.4]), np.eye(4))


def test_a_block_has_the_estimated_depths_and_what_is_known_besides():
    depth = STILL + 5.0 + np.arange(16.0).reshape(4, 4)
    surface = 2.0 + np.array([0.3, -0.2, 0.0, 0.1])
    offset = np.array([[0.5, -0.4], [0.5, -0.3], [0.6, -0.4], [0.7, 0.1]])
    speeds = np.where(np.isfinite(U), U, 0.2)
    speeds[0, 0] = 40.0
    smoother = SimpleNamespace(
        best=Line(), offset=offset, depth=depth, deviation=0.1 * depth, surface=surface,
        read=lambda times: ReadCurrents(np.full((4, 2), 7.0), speeds, V),
        lost=np.array([False, False, True, False]), doubt=np.full((4, 2), 0.01),
        current_factor=np.array([1.1, 0.9, np.nan, 1.2]), plain=depth - 3.0,
    )  # fmt: skip
    one = measured(false=np.array([False, True, True, False]))
    environment = SimpleNamespace(maximum_speed=5.0)
    mooring = SimpleNamespace(file=SimpleNamespace(environment=environment))
    profiles, more = Task(mooring, one, common(), smoother).columns(0, 4)
    # an estimated current is solved at most at the limit, so that its time is not left empty
    share = np.minimum(5.0 / np.hypot(speeds, V), 1.0)
    likely = Line().solve(np.full((4, 2), 7.0), share * speeds, share * V)
    lost = np.array([1.0, 1.0, np.nan, 1.0])[:, None]
    assert profiles.clamp_depth == pytest.approx(depth[:, :2] * lost, nan_ok=True)
    assert profiles.depth_top == pytest.approx(depth[:, 2:] * lost, nan_ok=True)
    # the top is above the upper end of the first component by what it is in the likely currents
    assert profiles.top_depth == pytest.approx((depth[:, 2] - 1.5) * lost[:, 0], nan_ok=True)
    down = (depth - STILL - surface[:, None]) * lost
    assert profiles.clamp_knockdown == pytest.approx(down[:, :2], nan_ok=True)
    assert profiles.knockdown == pytest.approx(down[:, 2:], nan_ok=True)
    assert profiles.tension == pytest.approx(likely.tension * lost, nan_ok=True)
    names = [STATUSES[code] for code in profiles.status.tolist()]
    assert names == [STATUSES[0], STATUSES[0], "implausible-current", STATUSES[0]]
    assert more["clamp_depth_sd"] == pytest.approx(0.1 * depth[:, :2] * lost, nan_ok=True)
    assert more["depth_sd"] == pytest.approx(0.1 * depth[:, 2:] * lost, nan_ok=True)
    assert more["current_factor"] == pytest.approx(smoother.current_factor, nan_ok=True)
    assert more["current_doubt"] == pytest.approx(0.01 * lost * np.ones(2), nan_ok=True)
    assert more["residual"] == pytest.approx(READ - offset - depth[:, [0, 3]], nan_ok=True)
    assert more["plain_depth"] == pytest.approx(depth[:, [0, 3]] - 3.0)


def test_a_hidden_sensor_is_hidden_everywhere():
    one = measured(level_point=np.array([3, 0]))
    upper, lower = without(one, ["d"]), without(one, ["a"])
    assert (upper.label, lower.label) == (("a",), ("d",))
    assert upper.depth.tolist() == READ[:, :1].tolist()
    assert (upper.point.tolist(), lower.point.tolist()) == ([0], [3])


def test_what_was_measured_is_the_record_of_a_result():
    known = MeasuredRecord(measured(tide=np.zeros(4)), {"currents": "c.nc"}, ())
    level, u, v, none = known.profiles(1, 3)
    assert none is None and u.tolist()[0] == U[1].tolist() and v.tolist()[0] == V[1].tolist()
    assert level.shape == (2, 2)


def test_a_mooring_is_asked_at_its_factors_and_a_step_from_each(monkeypatch):
    asked = []
    record = SimpleNamespace(Forward=lambda mooring, factors: asked.append(factors) or len(asked))
    monkeypatch.setattr("calm.motion.line_response.Forward", record.Forward)
    here, shifted = module.forwards_of(None, replace(common(), factors={"a": 1.2, "b": 0.9}))
    assert (here, list(shifted)) == (3, ["a", "b"])
    step = np.exp(0.05)
    assert asked[0] == pytest.approx({"a": 1.2 * step, "b": 0.9})
    assert asked[1] == pytest.approx({"a": 1.2, "b": 0.9 * step})
    assert asked[2] == {"a": 1.2, "b": 0.9}
