"""The smoother against the normal law of all states and readings at once, written out."""

import numpy as np
import pytest

from calm.motion import smoother
from calm.motion.smoother import StateSpace, smoothed

TIMES, STATES, READINGS = 11, 3, 2
PARTS = "mean", "covariance", "pull", "hold"


def law():
    """Two states that fade and are alike, one that stays and steps; some readings are lacking."""
    random = np.random.default_rng(1)
    fade = random.uniform(0.5, 1.0, (TIMES, STATES))
    fade[:, 2] = 1.0
    steady = np.array([[1.0, 0.3, 0.0], [0.3, 2.0, 0.0], [0.0, 0.0, 0.0]])
    stepped = np.zeros((TIMES, STATES))
    stepped[:, 2] = 0.1
    first = steady + np.diag([0.0, 0.0, 4.0])
    seen = np.tile(random.normal(size=(1, 1, STATES)), (TIMES, 1, 1))
    seen = np.concatenate([seen, random.normal(size=(TIMES, 1, STATES))], axis=1)
    read = random.normal(size=(TIMES, READINGS))
    read[3], read[5, 0] = np.nan, np.nan
    noise = random.uniform(0.1, 1.0, (TIMES, READINGS))
    return StateSpace(fade, steady, stepped, first, seen, read, noise)


@pytest.mark.parametrize("block", [4, 256])
def test_mean_covariance_and_steps_are_those_of_the_whole_law(monkeypatch, block):
    monkeypatch.setattr(smoother, "BLOCK", block)
    given, q = law(), STATES
    own = [given.first]
    for t in range(1, TIMES):
        own.append(given.fade[t][:, None] * own[-1] * given.fade[t] + given.added(t))
    whole = np.zeros((TIMES * q, TIMES * q))
    for t in range(TIMES):
        part = own[t]
        for later in range(t, TIMES):
            part = part * given.fade[later] if later > t else part
            whole[t * q : t * q + q, later * q : later * q + q] = part
            whole[later * q : later * q + q, t * q : t * q + q] = part.T
    seen = np.zeros((TIMES * READINGS, TIMES * q))
    for t in range(TIMES):
        seen[t * READINGS : (t + 1) * READINGS, t * q : t * q + q] = given.seen[t]
    there = np.isfinite(given.read.ravel())
    seen, noise = seen[there], np.diag(given.noise.ravel()[there])
    gain = whole @ seen.T @ np.linalg.inv(seen @ whole @ seen.T + noise)
    mean, left = gain @ given.read.ravel()[there], whole - gain @ seen @ whole
    found = [*smoothed(given)][::-1]
    assert [t for one in found for t in range(TIMES)[one.times]] == [*range(TIMES)]
    parts = [np.concatenate([getattr(one, name) for one in found]) for name in PARTS]
    for t, (state, covariance, pull, hold) in enumerate(zip(*parts, strict=True)):
        at = slice(t * q, t * q + q)
        assert state == pytest.approx(mean[at])
        assert covariance == pytest.approx(left[at, at])
        if t:
            both, added = slice(at.start - q, at.stop), given.added(t)
            step = np.hstack([-np.diag(given.fade[t]), np.eye(q)])
            assert added @ pull == pytest.approx(step @ mean[both])
            assert added - added @ hold @ added == pytest.approx(step @ left[both, both] @ step.T)
