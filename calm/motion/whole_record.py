"""What is common to the whole record: factors on the line, the datum, the offsets of sensors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from calm.case import Mooring
from calm.motion import prior
from calm.motion.filled import gap_errors
from calm.motion.forward import Forward
from calm.motion.measured import Measured
from calm.motion.moment import STEP, Common, Moments, settled
from calm.physics.line import Floats, Integers

MOST_TIMES = 500
"""So many times, spread evenly over the record, are what it is estimated from."""
TURNS = 3
"""Steps of Gauss and Newton; the last two agree to a hundredth of the intervals."""
ROBUST = 4.0
"""Degrees of freedom of Student's law for the misfit of a time."""
FURTHEST = 1.0
"""Of the logarithm of a factor, at most."""
SCALES = (0.5, 2.5)
"""Least and greatest factor on the errors of the currents."""
SCALE_KNOWN = 0.15
"""Standard deviation of its logarithm beforehand."""
LONGEST_MEMORY = 25
"""Times over which errors that repeat are looked for."""


def forwards_of(mooring: Mooring, common: Common) -> tuple[Forward, dict[str, Forward]]:
    """The mooring at the common factors, and a step from each."""
    shifted = {
        name: Forward(mooring, {**common.factors, name: value * float(np.exp(STEP))})
        for name, value in common.factors.items()
    }
    return Forward(mooring, common.factors), shifted


def assumed(mooring: Mooring, measured: Measured, names: Sequence[str]) -> Common:
    """What is common before any pressure is looked at."""
    sensors = len(measured.label)
    spread = [
        *(prior.FACTORS[name][1] for name in names),
        prior.DATUM * mooring.water.depth,
        *[prior.OFFSET] * sensors,
    ]
    factors = {name: float(np.exp(prior.FACTORS[name][0])) for name in names}
    moments = Moments(measured, Forward(mooring, factors), {})
    level = moments.levels(np.tile(moments.forward.still, (len(measured.time), 1)))
    gap = gap_errors(level, measured.u, measured.v, moments.group)
    return Common(factors, 0.0, np.zeros(sensors), np.diag(np.square(spread)), 1.0, gap)


def estimate_common(mooring: Mooring, measured: Measured, names: Sequence[str]) -> Common:
    """Maximum a posteriori by Gauss-Newton; the covariance by Laplace.

    The currents of each time are integrated over, by the slopes at what was measured; the mean of
    the depths is corrected for their curvature. A time of large misfit counts less, by Student's
    law. Where the errors of times that follow each other are alike, they count as fewer.

    Parameters
    ----------
    names : of `calm.motion.forward.FACTORS`, those that are estimated
    """
    part = measured.at(_chosen(measured))
    known = assumed(mooring, part, names)
    if not len(part.time):
        return known
    beforehand = np.linalg.inv(known.covariance)
    centre = _vector(known)
    common = replace(known, covariance=np.zeros_like(known.covariance))
    for turn in range(TURNS):
        moments = Moments(part, *forwards_of(mooring, common))
        here = settled(moments, common)
        good = np.isfinite(here.begin.depth).all(axis=1)
        slope = here.begin.slope[good][:, part.point]
        currents = slope @ here.way.spread[good] @ slope.transpose(0, 2, 1)
        down = here.begin.depth[good][:, part.point] - moments.forward.still[part.point]
        bend = 0.5 * np.einsum("nss->ns", currents) / np.maximum(down, 1.0)
        there = np.isfinite(part.depth[good])
        left = np.where(there, here.before.innovation[good] - bend, 0.0)
        expected = here.before.expected[good]
        scale = _scale(left, expected, currents, common.scale)
        expected = expected + ((scale / common.scale) ** 2 - 1.0) * currents
        inverse = np.linalg.inv(expected)
        seen = np.concatenate(
            [
                here.begin.common[good][:, part.point],
                np.ones((*left.shape, 1)),
                np.broadcast_to(np.eye(left.shape[1]), (*left.shape, left.shape[1])),
            ],
            axis=2,
        )
        misfit = np.einsum("ns,nst,nt->n", left, inverse, left)
        weight = (ROBUST + there.sum(axis=1)) / (ROBUST + misfit)
        normal = np.einsum("n,nsq,nst,ntr->qr", weight, seen, inverse, seen)
        pull = np.einsum("n,nsq,nst,nt->nq", weight, seen, inverse, left)
        alike = _alike(pull[:, 0]) if names else 1.0
        covariance = np.linalg.inv(normal / alike + beforehand)
        value = _vector(common)
        value = value + covariance @ (pull.sum(axis=0) / alike + beforehand @ (centre - value))
        common = _moved(common, value, covariance * (turn == TURNS - 1), scale)
    return common


def _chosen(measured: Measured) -> Integers:
    """Times that have a current and a pressure, evenly spread where they are many."""
    currents = np.isfinite(measured.u) & np.isfinite(measured.v)
    used = np.flatnonzero(np.isfinite(measured.depth).any(axis=1) & currents.any(axis=1))
    if len(used) <= MOST_TIMES:
        return used
    return used[np.linspace(0, len(used) - 1, MOST_TIMES).round().astype(np.int64)]


def _vector(common: Common) -> Floats:
    logs = np.log(list(common.factors.values()))
    return np.concatenate([logs, [common.datum], common.offset])


def _moved(known: Common, value: Floats, covariance: Floats, scale: float) -> Common:
    names, count = list(known.factors), len(known.factors)
    logs = np.clip(value[:count], -FURTHEST, FURTHEST)
    factors = {name: float(np.exp(log)) for name, log in zip(names, logs, strict=True)}
    offset = value[count + 1 :]
    return Common(factors, float(value[count]), offset, covariance, scale, known.gap)


def _scale(left: Floats, expected: Floats, currents: Floats, scale: float) -> float:
    """The factor on the errors of the currents under which the pressures are most likely."""
    tried = np.linspace(np.log(SCALES[0]), np.log(SCALES[1]), 41)
    likely = []
    for log in tried:
        covariance = expected + (np.exp(2.0 * log) / scale**2 - 1.0) * currents
        misfit = (left * np.linalg.solve(covariance, left[:, :, None])[:, :, 0]).sum(axis=1)
        fit = np.linalg.slogdet(covariance)[1]
        fit += (ROBUST + left.shape[1]) * np.log1p(misfit / ROBUST)
        likely.append(-0.5 * (fit.sum() + (log / SCALE_KNOWN) ** 2))
    return float(np.exp(tried[int(np.argmax(likely))]))


def _alike(pull: Floats) -> float:
    """How many times that follow each other have the same error, by its autocorrelation."""
    one = pull - pull.mean()
    whole = float(one @ one)
    total, chance = 1.0, 2.0 / np.sqrt(max(len(one), 1))
    for lag in range(1, min(LONGEST_MEMORY, len(one) // 4)):
        share = float(one[lag:] @ one[:-lag]) / whole if whole > 0.0 else 0.0
        if share < chance:
            break
        total += 2.0 * share
    return total
