"""dune2: temperatures at 21 levels, of which one is hidden and found again from the others.

Temperatures in docs/field/dune2, by way of oceanarray 0.5.1 (MIT, © 2025 Eleanor Frajka-Williams);
`dune2_depths.npz` has the depths that `calm motion` gives of all its pressures. The front of the
overflow moves through the levels by three degrees within hours.
"""

from pathlib import Path

import numpy as np
import pytest

from calm.gridding.field import estimate, field_of, posterior
from calm.gridding.samples import MooringDepths, Samples, gather
from calm.motion.matching import LinePlaces, points_of
from calm.records.instrument_series import read_series

FIELD = Path(__file__).parents[2] / "docs" / "field" / "dune2"
DEPTHS = Path(__file__).with_name("dune2_depths.npz")
SENSOR = 0.002  # degrees


@pytest.fixture(scope="module")
def measured():
    with np.load(DEPTHS) as kept:
        time = kept["time"].astype("M8[s]").astype("M8[ns]")
        labels = tuple(str(one) for one in kept["label"])
        depth = kept["depth"].astype(float)
        still = np.nanpercentile(depth, 5.0, axis=0)
        places = LinePlaces(DEPTHS.name, labels, ("",) * len(labels), len(labels), still)
        deviation = kept["deviation"].astype(float)
        depths = MooringDepths(time, places, depth, deviation, (), 792.3, {})
    series = read_series(
        [str(FIELD / "temperatures.nc")], ("temperature",), frozenset({1, 2}), 792.3
    )["temperature"]
    points, said = points_of(series, depths.places)
    assert len(points) == 21 and not said
    return gather(depths, series, points, time)


def hidden(measured, label):
    """What is estimated at a sensor without it and without its neighbour a metre away."""
    column = measured.label.index(label)
    depth = measured.depth[:, column]
    far = np.abs(np.mean(measured.depth - depth[:, None], axis=0)) >= 10.0
    others = Samples(
        measured.time,
        tuple(one for one, kept in zip(measured.label, far, strict=True) if kept),
        *(table[:, far] for table in (measured.depth, measured.deviation, measured.value)),
    )
    field = field_of(others, SENSOR)
    mean, spread, _ = posterior(field, np.arange(len(depth)), depth[:, None])
    return mean[:, 0] - measured.value[:, column], spread[:, 0], field, depth


# the solos measure temperature alone
LEVELS = ("solo 575", "solo 475", "solo 375", "solo 275", "solo 175", "solo 75", "Aquadopp 426",
          "Aquadopp 226")  # fmt: skip


@pytest.mark.parametrize(
    "label",
    [
        one if one in LEVELS[2:4] else pytest.param(one, marks=pytest.mark.thorough)
        for one in LEVELS
    ],
)
def test_a_hidden_level_is_within_its_band(measured, label):
    off, spread, *_ = hidden(measured, label)
    # 164 hours, their errors last some hours each: 90 % are 95 % within the chance of 40 that
    # are independent, twice the deviation of 3.4 %
    assert (np.abs(off) < 1.96 * spread).mean() >= 0.88
    # and no band is as wide as the record itself
    column = measured.label.index(label)
    assert np.median(spread) < 0.75 * np.std(measured.value[:, column])


@pytest.mark.thorough
def test_over_all_hidden_levels_bands_hold_and_errors_are_less_than_of_lines(measured):
    covered, errors, lines = [], [], []
    for label in LEVELS:
        off, spread, field, depth = hidden(measured, label)
        covered.append(np.abs(off) < 1.96 * spread)
        rest = field.samples
        own = measured.value[:, measured.label.index(label)]
        line = [np.interp(d, z, y) for d, z, y in zip(depth, rest.depth, rest.value, strict=True)]
        errors.append(np.sqrt((off**2).mean()))
        lines.append(np.sqrt(((np.array(line) - own) ** 2).mean()))
    assert 0.93 <= np.mean(covered) <= 0.99
    assert np.mean(errors) < 0.96 * np.mean(lines)


def test_levels_above_the_knocked_down_line_have_flags(measured):
    field = field_of(measured, SENSOR)
    found = estimate(field, np.array([60.0, 500.0]), np.arange(len(measured.time)))
    top = measured.depth.min(axis=1)
    assert (found.flag[top > 60.0, 0] != 8).all()
    assert (found.flag[:, 1] == 8).all()
