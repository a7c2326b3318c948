"""Drag coefficients against Reynolds number: the printed points, and what lies between them."""

from math import exp

import pytest
from hypothesis import given
from hypothesis import strategies as st

from calm.physics import reynolds

WIESELSBERGER = [
    (3.18, 4.87), (8.01, 2.94), (17.7, 2.12), (31.7, 1.73), (63.6, 1.48), (196, 1.27),
    (356, 1.15), (892, 0.964), (2.27e3, 0.886), (5.15e3, 0.944), (9.18e3, 1.06), (1.5e4, 1.14),
    (3.03e4, 1.16), (6.55e4, 1.17), (1.07e5, 1.17), (1.61e5, 1.18), (2.20e5, 1.06),
    (2.93e5, 0.910), (3.65e5, 0.726), (4.27e5, 0.547), (4.90e5, 0.337), (5.03e5, 0.302),
    (6.28e5, 0.318), (8.10e5, 0.355),
]  # fmt: skip
DNV = [
    (1e4, 1.21), (1e5, 1.21), (2.1e5, 1.21), (2.31e5, 1.20), (2.72e5, 1.17), (2.97e5, 1.11),
    (3.25e5, 1.01), (3.62e5, 0.894), (4.10e5, 0.709), (4.75e5, 0.532), (5.25e5, 0.408),
    (5.79e5, 0.327), (6.38e5, 0.284), (7.44e5, 0.297), (1.07e6, 0.389), (1.39e6, 0.470),
    (1.83e6, 0.539), (2.26e6, 0.584), (2.90e6, 0.629), (3.66e6, 0.648), (4.94e6, 0.678),
]  # fmt: skip


@pytest.mark.parametrize(("re", "cn"), WIESELSBERGER)
def test_wieselsberger_at_his_points(re, cn):
    assert reynolds.wieselsberger_cylinder(re) == pytest.approx(cn, rel=1e-12)


@pytest.mark.parametrize(("re", "cn"), DNV)
def test_dnv_at_its_points(re, cn):
    assert reynolds.dnv_cylinder(re) == pytest.approx(cn, rel=1e-12)


def test_cylinder_takes_the_measurements_below_the_crisis_and_the_recommendation_in_it():
    for re, cn in WIESELSBERGER:
        if re <= 1.61e5:
            assert reynolds.cylinder_coefficient(re) == pytest.approx(cn, rel=1e-12)
    for re, cn in DNV:
        if re >= 2.1e5:
            assert reynolds.cylinder_coefficient(re) == pytest.approx(cn, rel=1e-12)
    assert 1.18 < reynolds.cylinder_coefficient(1.85e5) < 1.21


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


def test_sphere_is_held_beyond_its_range():
    assert reynolds.sphere_coefficient(5e6) == reynolds.sphere_coefficient(1e6)
    assert reynolds.sphere_coefficient(0.0) == reynolds.sphere_coefficient(0.1)


@pytest.mark.parametrize(
    ("slenderness", "below", "above"),
    [
        (2, 0.58, 0.80), (5, 0.62, 0.80), (10, 0.68, 0.82), (20, 0.74, 0.90), (40, 0.82, 0.98),
        (50, 0.87, 0.99), (100, 0.98, 1.00), (1, 0.52, 0.80), (0.2, 0.52, 0.80), (1e4, 0.98, 1.00),
    ],
)  # fmt: skip
def test_finite_length_factor_in_both_columns(slenderness, below, above):
    assert reynolds.finite_length_factor(slenderness) == pytest.approx(below, rel=1e-12)
    assert reynolds.finite_length_factor(slenderness, 1.7e5) == pytest.approx(below, rel=1e-12)
    assert reynolds.finite_length_factor(slenderness, 2.3e5) == pytest.approx(above, rel=1e-12)


def test_finite_length_factor_is_linear_in_the_logarithm_of_the_slenderness():
    assert reynolds.finite_length_factor((2 * 5) ** 0.5) == pytest.approx(0.60)
    assert reynolds.finite_length_factor((10 * 20) ** 0.5, 1e6) == pytest.approx(0.86)


@given(re=st.floats(0, 1e7), slenderness=st.floats(0.5, 200))
def test_nothing_has_a_step(re, slenderness):
    """A millionth more of Re moves no coefficient by more than a few millionths."""
    for curve in (
        reynolds.cylinder_coefficient,
        reynolds.sphere_coefficient,
        lambda x: reynolds.finite_length_factor(slenderness, x),
    ):
        # the steepest is the sphere's fall in its crisis: Cx ~ Re^-5
        assert curve(re * (1 + 1e-6)) == pytest.approx(curve(re), rel=1e-5)
