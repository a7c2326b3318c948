"""RAPID's mooring WB2 9: seventeen pressures, of which a few place the others, without a current.

Source: see tests/validation/rapid/README.md. Each case hides all sensors but a few, and the
estimate at the hidden ones is compared with what processing toolboxes do without a line: PCHIP of
the knockdown over the height between the same sensors, the anchor being a point. Knots and
deviations of the estimate were chosen on the months before these. The limits are what was set as a
goal beforehand, 0.07 to 0.3 above what is found.
"""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

import calm
from calm.motion.correction import estimate_in_memory
from calm.motion.line_response import Forward
from calm.motion.motion_estimate import RecoveredMooring, fitted
from calm.motion.remarks import calm_times, coverage, difference, rms
from calm.motion.study import prepare

FOLDER = Path(__file__).with_name("rapid")
SEABED = 3880.0


@cache
def measured():
    mooring = calm.load(FOLDER / "mooring.yaml")
    return mooring, RecoveredMooring(mooring, [str(FOLDER / "pressures.csv")]).measured


def both(given):
    """Rms of the hidden sensors by the line and by PCHIP [m], and the shares within the bands: of
    all times, and of the tenth with the most knockdown."""
    mooring, one = measured()
    hidden = [label for label in one.label if label not in given]
    task = prepare(mooring, one, fitted(currents=False), hidden)
    depth, spread = estimate_in_memory(task, one.point.tolist())
    still = Forward(mooring, {}).still[one.point]
    used = [one.label.index(label) for label in given]
    order = sorted(used, key=lambda j: -still[j])
    down = one.depth - np.percentile(one.depth, 5.0, axis=0)
    heights = np.concatenate([[0.0], SEABED - still[order]])
    values = np.concatenate([np.zeros((len(down), 1)), down[:, order]], axis=1)
    between = still + PchipInterpolator(heights, values, axis=1, extrapolate=True)(SEABED - still)
    every = np.ones(len(down), bool)
    at_rest = calm_times(down[:, used[0]], every)
    ours, theirs, bands = [], [], []
    for j in range(len(still)):
        if j not in used:
            ours.append(difference(depth[:, j], one.depth[:, j], at_rest, every))
            theirs.append(difference(between[:, j], one.depth[:, j], at_rest, every))
            bands.append(spread[:, j])
    strong = down[:, used[0]] >= np.quantile(down[:, used[0]], 0.9)
    off, band = np.array(ours), np.array(bands)
    return (
        rms(off), rms(np.array(theirs)), coverage(off.ravel(), band.ravel()),
        coverage(off[:, strong].ravel(), band[:, strong].ravel()),
    )  # fmt: skip


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("given", "limit"),
    [
        (("c50", "c3300"), 0.50),
        (("c50", "c1100"), 0.70),
        (("c50", "c700", "c1900"), 0.60),
        (("c50", "c500", "c1300", "c2800"), 0.65),
        (("c100b", "c1900"), 1.1),
    ],
)
def test_a_few_pressures_place_the_others_better_than_interpolation(given, limit):
    ours, theirs, inside, strong = both(given)
    assert ours < limit * theirs
    assert inside > 0.90
    assert strong > 0.80
