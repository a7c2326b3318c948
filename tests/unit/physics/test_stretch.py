"""Elongation curves against scipy's monotone interpolation, and what is refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator

from calm.physics.stretch import ElongationCurve, stretched_diameter

# a braided rope that stiffens, with an uneven table and a flat stretch
LOADS = (0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7)
STRAINS = (0.0, 0.03, 0.05, 0.08, 0.08, 0.11, 0.125)
BREAKING_LOAD = 50e3


def curve(permanent=0.0):
    return ElongationCurve(zip(LOADS, STRAINS, strict=True), BREAKING_LOAD, permanent)


def test_passes_through_every_point():
    for load, strain in zip(LOADS, STRAINS, strict=True):
        assert curve().strain(load * BREAKING_LOAD) == pytest.approx(strain, abs=1e-15)


def test_agrees_with_scipy_between_the_points():
    reference = PchipInterpolator(np.multiply(LOADS, BREAKING_LOAD), STRAINS)
    slope = reference.derivative()
    for tension in np.linspace(0, 0.7 * BREAKING_LOAD, 501)[:-1]:
        assert curve().strain(tension) == pytest.approx(reference(tension), rel=1e-12, abs=1e-16)
        assert curve().slope(tension) == pytest.approx(slope(tension), rel=1e-9, abs=1e-18)


def test_goes_on_straight_beyond_the_last_point():
    chord = (0.125 - 0.11) / (0.2 * BREAKING_LOAD)
    assert curve().strain(0.9 * BREAKING_LOAD) == pytest.approx(0.125 + chord * 0.2 * BREAKING_LOAD)
    assert curve().slope(0.9 * BREAKING_LOAD) == pytest.approx(chord)


def test_begins_at_nothing_whether_the_table_says_so_or_not():
    points = list(zip(LOADS, STRAINS, strict=True))[1:]
    short = ElongationCurve(points, BREAKING_LOAD)
    for tension in (0.0, 100.0, 7e3, 3e4, 6e4):
        assert short.strain(tension) == curve().strain(tension)


def test_one_point_is_a_linear_stiffness():
    linear = ElongationCurve([(1.0, 0.25)], BREAKING_LOAD)
    for tension in (0.0, 1.0, 2e4, 5e4, 8e4):
        assert linear.strain(tension) == pytest.approx(tension / 200e3, rel=1e-14)
        assert linear.slope(tension) == pytest.approx(1 / 200e3, rel=1e-14)


def test_permanent_elongation_adds_to_the_strain_at_every_tension():
    for tension in (0.0, 100.0, 7e3, 6e4):
        assert curve(0.04).strain(tension) == pytest.approx(0.04 + curve().strain(tension))
        assert curve(0.04).slope(tension) == curve().slope(tension)


def test_limit_is_the_end_of_the_table_and_at_most_four_fifths_of_the_breaking_load():
    assert curve().limit == pytest.approx(0.7 * BREAKING_LOAD)
    assert ElongationCurve([(1.0, 0.2)], BREAKING_LOAD).limit == pytest.approx(0.8 * BREAKING_LOAD)


tables = st.lists(
    st.tuples(st.floats(0.01, 0.2), st.floats(0, 0.2)), min_size=1, max_size=5
).map(lambda steps: np.cumsum(steps, axis=0).tolist())  # fmt: skip


@given(points=tables)
def test_never_falls_between_the_points(points):
    rope = ElongationCurve(points, 1000.0)
    strains = [rope.strain(tension) for tension in np.linspace(0, 1200, 301)]
    # a flat stretch of the table may tremble by rounding
    assert np.diff(strains).min() >= -1e-14


@given(points=tables, tension=st.floats(0, 1200))
def test_slope_is_the_derivative(points, tension):
    rope = ElongationCurve(points, 1000.0)
    step = 1e-3
    knots = [0.0, *(1000.0 * load for load, _ in points)]
    if min(abs(tension - knot) for knot in knots) < 2 * step:
        return
    difference = (rope.strain(tension + step) - rope.strain(tension - step)) / (2 * step)
    # strains of order 1 over a step of 2e-3 N keep 1e-13/N by rounding
    assert rope.slope(tension) == pytest.approx(difference, rel=1e-6, abs=1e-11)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([(0.1, 0.01), (0.1, 0.02)], "point 2: the load 0.1 does not grow"),
        ([(0.2, 0.01), (0.1, 0.02)], "point 2: the load 0.1 does not grow"),
        ([(0.1, 0.02), (0.2, 0.01)], "point 2: the strain 0.01 falls"),
        ([(0.0, 0.01), (0.2, 0.02)], "permanent elongation"),
        ([(20, 0.1)], "20 times the breaking load"),
        ([(-0.1, 0.1)], "does not grow"),
        ([(0.1, float("nan"))], "not a number"),
        ([(float("inf"), 0.1)], "not a number"),
        ([(0.0, 0.0)], "needs a point"),
        ([], "needs a point"),
    ],
)
def test_a_table_that_can_be_no_ropes_is_refused(points, message):
    with pytest.raises(ValueError, match=message):
        ElongationCurve(points, BREAKING_LOAD)


def test_a_breaking_load_or_a_permanent_elongation_that_cannot_be_is_refused():
    with pytest.raises(ValueError, match="breaking load"):
        ElongationCurve([(0.1, 0.1)], 0.0)
    with pytest.raises(ValueError, match="permanent"):
        ElongationCurve([(0.1, 0.1)], 1e3, permanent=-0.01)


def test_diameter_by_constant_volume():
    """At 10 % the diameter loses 4.65 % and the drag area of the stretched line gains 4.88 %."""
    assert stretched_diameter(0.02, 0.1) / 0.02 - 1 == pytest.approx(-0.0465, abs=5e-5)
    assert 1.1 * stretched_diameter(0.02, 0.1) / 0.02 - 1 == pytest.approx(0.0488, abs=5e-5)
    assert stretched_diameter(0.02, 0.1) ** 2 * 1.1 == pytest.approx(0.02**2)
