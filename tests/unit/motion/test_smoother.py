"""The smoother against the normal law of all states and readings at once, written out."""

import numpy as np
import pytest

from calm.motion import smoother
from calm.motion.smoother import StateSpace, smoothed

TIMES, STATES, READINGS = 11, 3, 2


def law():
    """Two states that fade and are alike, one that stays and steps; some readings are lacking."""
    random = np.random.default_rng(1)
    fade = random.uniform(0.5, 1.0, (TIMES, STATES))
    fade[:, 2] = 1.0
    steady = np.array([[1.0, 0.3, 0.0], [0.3, 2.0, 0.0], [0.0, 0.0, 0.0]])
    stepped = np.zeros((TIMES, STATES))
    stepped[:, 2] = 0.1
    first = steady + np.diag([0.0, 0.0, 4.0])
    seen = random.normal(size=(1, 1, STATES)), random.normal(size=(TIMES, 1, STATES))
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
        seen[t * READINGS : (t + 1) * READINGS, t * q : t * q + q] = given.slopes(t)
    there = np.isfinite(given.read.ravel())
    seen, noise = seen[there], np.diag(given.noise.ravel()[there])
    gain = whole @ seen.T @ np.linalg.inv(seen @ whole @ seen.T + noise)
    mean, left = gain @ given.read.ravel()[there], whole - gain @ seen @ whole
    found = [*smoothed(given)]
    assert [one.time for one in found] == [*range(TIMES - 1, -1, -1)]
    for one in found:
        at = slice(one.time * q, one.time * q + q)
        assert one.mean == pytest.approx(mean[at])
        assert one.covariance == pytest.approx(left[at, at])
        if one.time + 1 < TIMES:
            both = slice(at.start, at.stop + q)
            step = np.hstack([-np.diag(given.fade[one.time + 1]), np.eye(q)])
            noise = step @ mean[both]
            square = np.outer(noise, noise) + step @ left[both, both] @ step.T
            assert one.moved == pytest.approx(square)
        else:
            assert (one.moved == 0.0).all()
