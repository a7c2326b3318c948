"""Drag coefficients against Reynolds number: the printed points, and what lies between them."""

from math import exp

import pytest
from hypothesis import given
from hypothesis import strategies as st

from calm.physics import drag, reynolds
from calm.physics.reynolds import DragCurve

WIESELSBERGER = [
    (3.18, 4.87), (8.01, 2.94), (17.7, 2.12), (31.7, 1.73), (63.6, 1.48), (196, 1.27),
    (356, 1.15), (892, 0.964), (2.27e3, 0.886), (5.15e3, 0.944), (9.18e3, 1.06), (1.5e4, 1.14),
    (3.03e4, 1.16), (6.55e4, 1.17), (1.07e5, 1.17), (1.61e5, 1.18),
]  # fmt: skip
DNV = [
    (2.1e5, 1.21), (2.31e5, 1.20), (2.72e5, 1.17), (2.97e5, 1.11), (3.25e5, 1.01), (3.62e5, 0.894),
    (4.10e5, 0.709), (4.75e5, 0.532), (5.25e5, 0.408), (5.79e5, 0.327), (6.38e5, 0.284),
    (7.44e5, 0.297), (1.07e6, 0.389), (1.39e6, 0.470), (1.83e6, 0.539), (2.26e6, 0.584),
    (2.90e6, 0.629), (3.66e6, 0.648), (4.94e6, 0.678),
]  # fmt: skip


@pytest.mark.parametrize(("re", "cn"), WIESELSBERGER + DNV)
def test_cylinder_at_the_measurements_below_the_crisis_and_the_recommendation_in_it(re, cn):
    assert reynolds.cylinder_coefficient(re) == pytest.approx(cn, rel=1e-12)


def test_cylinder_between_two_points_is_linear_in_the_logarithm():
    middle = (1.07e6 * 1.39e6) ** 0.5
    assert reynolds.cylinder_coefficient(middle) == pytest.approx((0.389 + 0.470) / 2)


def test_cylinder_is_held_beyond_its_points():
    assert reynolds.cylinder_coefficient(0.0) == 4.87
    assert reynolds.cylinder_coefficient(1e8) == 0.678


def test_cylinder_against_the_fit_of_cheng():
    """A smooth fit that shares no digit with the table: within 5 % from Re 17 to 1.6e5."""
    for re in (20, 50, 150, 500, 1500, 5e3, 2e4, 8e4, 1.5e5):
        fit = 11 * re**-0.75 + 0.9 * (1 - exp(-1000 / re)) + 1.2 * (1 - exp(-((re / 4500) ** 0.7)))
        assert reynolds.cylinder_coefficient(re) == pytest.approx(fit, rel=0.05)


@pytest.mark.parametrize(
    ("re", "cx", "digit"),
    [
        (1, 24.673, 1e-3), (100, 1.0381, 1e-4), (1e3, 0.4838, 1e-4), (1e4, 0.3926, 1e-4),
        (1e5, 0.4257, 1e-4), (2e5, 0.4159, 1e-4), (3e5, 0.1734, 1e-4), (4e5, 0.0930, 1e-4),
        (1e6, 0.1296, 1e-4),
    ],
)  # fmt: skip
def test_sphere_to_the_printed_digits(re, cx, digit):
    assert reynolds.sphere_coefficient(re) == pytest.approx(cx, abs=0.51 * digit)
    assert DragCurve(0.7).factor(re) * drag.SPHERE_CX == pytest.approx(cx, abs=0.51 * digit)


def test_sphere_is_held_beyond_its_range():
    assert reynolds.sphere_coefficient(5e6) == reynolds.sphere_coefficient(1e6)
    assert reynolds.sphere_coefficient(0.0) == reynolds.sphere_coefficient(0.1)


@pytest.mark.parametrize(
    ("slenderness", "below", "above"),
    [
        (2, 0.58, 0.80), (5, 0.62, 0.80), (10, 0.68, 0.82), (20, 0.74, 0.90), (40, 0.82, 0.98),
        (50, 0.87, 0.99), (100, 0.98, 1.00), (1, 0.52, 0.80), (0, 0.52, 0.80), (1e4, 0.98, 1.00),
        ((10 * 20) ** 0.5, 0.71, 0.86),
    ],
)  # fmt: skip
def test_finite_cylinder_in_both_columns_of_its_table(slenderness, below, above):
    """κ times the long cylinder's Cn, 1.18 at 1.61e5 and 1.20 at 2.31e5."""
    curve = DragCurve(0.1, slenderness)
    constant = drag.LONG_CYLINDER_CN * drag.finite_length_factor(slenderness)
    assert curve.factor(1.61e5) * constant == pytest.approx(1.18 * below, rel=1e-12)
    assert curve.factor(2.31e5) * constant == pytest.approx(1.20 * above, rel=1e-12)
    assert reynolds.finite_length_factor_above(slenderness) == pytest.approx(above, rel=1e-12)


@pytest.mark.parametrize(("re", "way"), [(1.8e5, 0.0), (1.9e5, 0.26943), (2.2e5, 1.0)])
def test_a_finite_cylinder_goes_from_the_lower_column_to_the_upper(re, way):
    """κ from 0.62 below Re 1.8e5 to 0.80 above 2.2e5, linear in log Re in between:
    ln(1.9/1.8)/ln(2.2/1.8) = 0.26943."""
    kappa = DragCurve(0.1, 5.0).factor(re) * 1.2 * 0.62 / reynolds.cylinder_coefficient(re)
    assert kappa == pytest.approx(0.62 + way * (0.80 - 0.62), rel=1e-6)


def test_where_the_curves_end():
    assert DragCurve(1.0).largest_reynolds == 1e6
    assert DragCurve(1.0, 3.0).largest_reynolds == 4.94e6


@given(re=st.floats(0, 1e7), slenderness=st.none() | st.floats(0.5, 200))
def test_nothing_has_a_step(re, slenderness):
    """A millionth more of Re moves no coefficient by more than a few millionths."""
    factor = DragCurve(0.3, slenderness).factor
    # the steepest is the sphere's fall in its crisis: Cx ~ Re^-5
    assert factor(re * (1 + 1e-6)) == pytest.approx(factor(re), rel=1e-5)
