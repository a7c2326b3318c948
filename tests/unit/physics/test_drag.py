"""Drag coefficients against the figures they come from."""

from math import pi

import pytest

from calm.physics import drag


@pytest.mark.parametrize(
    ("slenderness", "kappa"),
    # DNV-RP-C205 table 6-2 at Re < 2e5; Wieselsberger's L/D = 1 below
    [(1, 0.52), (2, 0.58), (5, 0.62), (10, 0.68), (20, 0.74), (40, 0.82), (50, 0.87), (100, 0.98)],
)
def test_finite_length_factor_at_the_points_of_its_table(slenderness, kappa):
    assert drag.finite_length_factor(slenderness) == pytest.approx(kappa, rel=1e-12)


def test_finite_length_factor_is_linear_in_the_logarithm_and_held_outside():
    assert drag.finite_length_factor((2 * 5) ** 0.5) == pytest.approx(0.60)
    assert drag.finite_length_factor(0.2) == 0.52
    assert drag.finite_length_factor(1e4) == 0.98


@pytest.mark.parametrize(
    ("slenderness", "ct"),
    [(0.1, 1.17), (0.6, 1.07), (0.88, 0.97), (1.3, 0.86), (1.8, 0.82), (0.35, 1.12), (9, 0.82)],
)
def test_end_face_coefficient(slenderness, ct):
    assert drag.end_face_coefficient(slenderness) == pytest.approx(ct)


def test_sphere():
    """½ρ Cx πD²/4 of a 1 m sphere, Cx 0.65, at 0.5 m/s: 65.4089 N, the printed drag of case C1."""
    assert drag.sphere_drag(1.0, 0.65) * 0.5**2 == pytest.approx(65.4089, abs=5e-5)
    assert drag.sphere_drag(1.0) == pytest.approx(0.5 * 1025 * 0.5 * pi / 4)


def test_cylinder_takes_given_coefficients_as_they_are():
    kn, kt = drag.cylinder_drag(0.2, 2.0, cn=1.2, ct=0.9)
    assert kn == pytest.approx(0.5 * 1025 * 1.2 * 0.4)
    assert kt == pytest.approx(0.5 * 1025 * 0.9 * pi * 0.01)


def test_cylinder_defaults_follow_its_slenderness():
    kn, kt = drag.cylinder_drag(0.2, 2.0)
    assert kn == pytest.approx(0.5 * 1025 * 1.2 * 0.68 * 0.4)
    assert kt == pytest.approx(0.5 * 1025 * 0.82 * pi * 0.01)


def test_line():
    """R of case C3: 2.115344 N/m at 0.5 m/s for 12.7 mm and Cn 1.3."""
    kn, kt = drag.line_drag(0.0127, 1.3, 0.01)
    assert kn * 0.25 == pytest.approx(2.115344, abs=5e-7)
    assert kt == pytest.approx(0.5 * 1025 * 0.01 * pi * 0.0127)


def test_measured_drag_of_the_aanderaa_meters():
    """The maker's five pairs in kgf give 2.694 kgf, 26.4 N per (m/s)²."""
    speeds = (0.51, 1.03, 1.54, 2.06, 2.57)
    forces = [9.80665 * kgf for kgf in (1.03, 2.45, 4.98, 10.56, 20.60)]
    assert drag.measured_drag(speeds, forces) == pytest.approx(26.4, abs=0.05)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_friction_of_each_law_goes_with_the_current_whichever_way_the_axis_is_named(side):
    """Kt 2, a current of (3, 4, 0) m/s and an axis along x: 3 m/s along it, 5 m/s in all."""
    expected = {
        drag.Friction.BERTEAUX: (18.0, 0.0, 0.0),
        drag.Friction.HOERNER: (30.0, 40.0, 0.0),
        drag.Friction.CONSTANT: (50.0, 0.0, 0.0),
    }
    for friction, force in expected.items():
        there = drag.friction_force(friction.law, 2.0, 3.0, 4.0, 0.0, side, 0.0, 0.0)
        back = drag.friction_force(friction.law, 2.0, -3.0, -4.0, 0.0, side, 0.0, 0.0)
        assert there == pytest.approx(force)
        assert back == pytest.approx([-each for each in force])
