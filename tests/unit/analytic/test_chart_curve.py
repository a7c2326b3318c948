"""The curve against direct integration, and the search for roots against known ones."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from calm.analytic.chart_branch import Branch, critical_angle, curve
from calm.analytic.chart_search import roots
from calm.errors import UsageError


@pytest.mark.parametrize("k", [0.0, 0.15, 2.4, 30.0, 100.0])
@pytest.mark.parametrize("share", [-0.9, -0.4, 0.3, 0.9])
@pytest.mark.parametrize("sign", [1, -1])
def test_the_curve_satisfies_its_equations(k: float, share: float, sign: int) -> None:
    branch = Branch(k, sign)
    end = share * np.arccos(branch.limit if share > 0.0 else -branch.limit)

    def slope(psi: float, state: np.ndarray) -> list[float]:
        normal = np.cos(psi) + sign * k * abs(np.sin(psi)) * np.sin(psi)
        tension = state[0]
        return [tension * np.sin(psi) / normal, tension / normal, tension * np.cos(psi) / normal]

    path = solve_ivp(slope, (0.0, end), [1.0, 0.0, 0.0], method="DOP853", rtol=1e-12, atol=1e-13)
    wanted = path.y[:, -1]
    point = curve(k, branch.turned(end))
    # 1e-12 is asked of the integration; it reaches some 1e-11 over its hundreds of steps.
    assert point.tension == pytest.approx(wanted[0], rel=1e-10)
    assert point.height == pytest.approx(wanted[0] - 1.0, abs=1e-10 * wanted[0])
    assert point.arc == pytest.approx(wanted[1], rel=1e-10)
    assert sign * point.distance == pytest.approx(wanted[2], abs=1e-10 * abs(wanted[1]))


def test_a_published_point() -> None:
    point = curve(2.4, np.radians(75.0))
    assert point.arc == pytest.approx(0.96945, abs=5e-6)
    assert point.distance == pytest.approx(0.75437, abs=5e-6)
    assert point.height == pytest.approx(0.49348, abs=5e-6)


def test_without_drag_the_curve_is_the_catenary() -> None:
    phi = np.radians([-60.0, 0.0, 1e-3, 30.0, 89.0, 120.0])
    points = curve(0.0, phi)
    np.testing.assert_allclose(points.tension, 1.0 / np.abs(np.cos(phi)), rtol=1e-12)
    # Before 90° the arc is tan φ; beyond, it is counted upwards from the other apex.
    np.testing.assert_allclose(points.arc, np.tan(phi) * np.sign(np.cos(phi)), rtol=1e-12)
    distance = np.arcsinh(np.tan(phi))
    np.testing.assert_allclose(points.distance, distance, rtol=1e-12)


def test_distances_far_out_grow_as_those_of_a_straight_cable() -> None:
    branch = Branch(100.0, 1)
    sine = np.sin(critical_angle(100.0))
    arc, distance = branch.span(1000.0, 1400.0)
    rise = np.exp(branch.log_tension(1400.0)) - np.exp(branch.log_tension(1000.0))
    assert arc == pytest.approx(rise / sine, rel=1e-13)
    assert distance == pytest.approx(arc * branch.limit, rel=1e-13)


@pytest.mark.parametrize("angle", [1e-9, 0.3, 1.5, 2.5])
def test_parameter_and_angle_are_inverse(angle: float) -> None:
    branch = Branch(2.4, 1)
    assert branch.angle(branch.parameter(angle)) == pytest.approx(angle, rel=1e-13)


def test_critical_angles() -> None:
    # cos φ_c + K sin² φ_c = 0
    k = np.array([0.0, 0.15, 2.4, 100.0])
    angle = critical_angle(k)
    np.testing.assert_allclose(np.cos(angle) + k * np.sin(angle) ** 2, 0.0, atol=1e-14)
    assert np.degrees(angle[2]) == pytest.approx(144.4, abs=0.05)


@pytest.mark.parametrize(
    ("k", "phi"), [(-1.0, 1.0), (101.0, 1.0), (2.4, 4.0), (2.4, float(critical_angle(2.4)))]
)
def test_where_there_is_no_curve(k: float, phi: float) -> None:
    with pytest.raises(UsageError):
        curve(k, phi)


def test_roots_between_two_points_of_the_grid_are_found() -> None:
    grid = np.linspace(0.0, 1.0, 30)
    found = roots(lambda x: (x - 0.5) ** 2 - 1e-8, grid)
    np.testing.assert_allclose(np.sort(found), [0.4999, 0.5001], rtol=1e-9)
    assert roots(lambda x: (x - 0.5) ** 2 + 1e-8, grid).size == 0
