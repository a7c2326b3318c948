"""Villain-Guillot's towed cable: his figures, direct integration, equation 4, limits."""

import numpy as np
import pytest
from scipy.integrate import quad

from calm.analytic.uniform import tension_ratio
from calm.analytic.villain_guillot import (
    body_pull,
    linear_cable,
    linear_tension_ratio,
    quadratic_cable,
    straight_angle,
    unequal_cable,
)
from tests.unit.analytic.integration import difference, integrate

# T₀ [N], α₀ [rad], μg, k_n V^D, k_t V^D [N/m], s [m]: bodies that hang, drag, lift.
CABLES = [
    (500.0, 1.4, 2.0, 3.0, 0.1, 300.0),
    (500.0, 0.2, 2.0, 3.0, 0.1, 300.0),
    (500.0, -0.6, 2.0, 1.0, 0.4, 300.0),
    (30.0, 1.5, 0.2, 6.0, 2.0, 80.0),
    (30.0, 1.5, 6.0, 0.2, 0.5, 80.0),
    (1e4, 1.0, 2.0, 3.0, 0.1, 300.0),
    (0.9, -1.58, 0.0326, 0.0397, 29.5, 0.146),  # tangential drag by far the greatest
]
cables = pytest.mark.parametrize(("tension", "angle", "weight", "normal", "along", "arc"), CABLES)


@pytest.mark.parametrize(
    ("start", "straight", "x", "y"),
    [
        (0.0, 30.0, 1.201579, 0.321762),
        (60.0, 30.0, 0.879444, 0.879717),
        (30.0, 60.0, 0.879717, 0.879444),
    ],
)
def test_figure_1(start, straight, x, y) -> None:
    """L = 1.25 and ℓ = 0.5, all three T/T₀ = 3.402959; printed to six digits behind the point."""
    weight, drag = np.sin(np.radians(straight)), np.cos(np.radians(straight))
    end = linear_cable(1.25, 0.5, np.radians(start), weight, drag)
    assert (end.x, end.z) == pytest.approx((x, y), abs=5.1e-7)
    assert end.tension / 0.5 == pytest.approx(3.402959, abs=5.1e-7)


@cables
def test_equal_linear_drags(tension, angle, weight, normal, along, arc) -> None:
    expected, _ = integrate(arc, tension, angle, weight, normal, normal, 1, 1)
    assert difference(linear_cable(arc, tension, angle, weight, normal), expected, arc) < 1e-10
    found = unequal_cable(arc, tension, angle, weight, normal, normal)
    assert difference(found, expected, arc) < 1e-10


@cables
def test_printed_form_of_equal_linear_drags(tension, angle, weight, normal, along, arc) -> None:
    cable = linear_cable(arc, tension, angle, weight, normal)
    straight = np.arctan2(weight, normal)
    a, unit = angle - straight, tension / np.hypot(weight, normal)
    u = arc / unit + np.cos(a)
    r = np.hypot(u, np.sin(a))
    x, y = unit * (r - 1.0), unit * np.sin(a) * np.log((r + u) / (1.0 + np.cos(a)))
    assert np.tan(cable.angle - straight) == pytest.approx(np.sin(a) / u, rel=1e-12)
    assert cable.tension == pytest.approx(tension * r, rel=1e-12)
    across = x * np.cos(straight) - y * np.sin(straight)
    assert cable.x == pytest.approx(across, abs=1e-11 * arc)


@cables
def test_unequal_linear_drags(tension, angle, weight, normal, along, arc) -> None:
    expected, _ = integrate(arc, tension, angle, weight, normal, along, 1, 1)
    found = unequal_cable(arc, tension, angle, weight, normal, along)
    assert difference(found, expected, arc) < 1e-10
    ratio = linear_tension_ratio(found.angle, angle, weight, normal, along)
    # near α_d the ratio of the sines is that of two small differences
    assert ratio == pytest.approx(found.tension / tension, rel=1e-10)


@cables
def test_quadratic_drags(tension, angle, weight, normal, along, arc) -> None:
    expected, _ = integrate(arc, tension, angle, weight, normal, along, 2, 2)
    found = quadratic_cable(arc, tension, angle, weight, normal, along)
    assert difference(found, expected, arc) < 1e-10


@pytest.mark.parametrize("exponent", [1, 2])
@pytest.mark.parametrize(("start", "end"), [(1.4, 0.8), (0.05, 0.4), (1.2, 1.0)])
def test_radius_of_curvature(start, end, exponent) -> None:
    """dρ/ρ = R(α) dα, R = (2 μg sin α + k_t cos^D α + k_n D cos α sin^(D−1) α)/δ, ρ = T/δ."""
    weight, normal, along = 1.0, 1.5, 0.4

    def delta(alpha):
        return weight * np.cos(alpha) - normal * np.sin(alpha) ** exponent

    def rate(alpha):
        sine, cosine = np.sin(alpha), np.cos(alpha)
        turning = normal * exponent * cosine * sine ** (exponent - 1)
        return (2.0 * weight * sine + along * cosine**exponent + turning) / delta(alpha)

    radius = np.exp(quad(rate, start, end, epsabs=0.0, epsrel=1e-13)[0])
    if exponent == 1:
        tension = linear_tension_ratio(end, start, weight, normal, along)
    else:
        tension = tension_ratio(end, start, weight / normal, along / normal)
    assert radius == pytest.approx(tension * delta(start) / delta(end), rel=1e-12)


def test_radius_of_curvature_for_equal_linear_drags() -> None:
    """ρ/ρ₀ = sin²(α_d − α₀)/sin²(α_d − α): T goes as 1/sin, δ as sin."""
    start, end, straight = 1.4, 0.9, float(straight_angle(1.0, 1.5, 1))
    ratio = linear_tension_ratio(end, start, 1.0, 1.5, 1.5)
    sines = np.sin(straight - start) / np.sin(straight - end)
    assert ratio == pytest.approx(sines, rel=1e-13)


@pytest.mark.parametrize("drag", [0.5, 3.0])
def test_free_end_is_straight(drag) -> None:
    arcs = np.array([0.0, 10.0, 50.0])
    linear = linear_cable(arcs, 0.0, 0.3, 2.0, drag)
    assert linear.angle == pytest.approx(np.arctan2(2.0, drag))
    assert linear.tension == pytest.approx(np.hypot(2.0, drag) * arcs)
    for cable, exponent in ((unequal_cable, 1), (quadratic_cable, 2)):
        free = cable(arcs, 0.0, 0.3, 2.0, drag, 0.1)
        alpha = straight_angle(2.0, drag, exponent)
        assert free.angle == pytest.approx(alpha)
        rate = 2.0 * np.sin(alpha) + 0.1 * np.cos(alpha) ** exponent
        assert free.tension == pytest.approx(rate * arcs)
        assert free.x == pytest.approx(arcs * np.cos(alpha))
        # a body of next to no weight hardly changes that
        light = cable(50.0, 1e-9, 1.2, 2.0, drag, 0.1)
        assert light.angle == pytest.approx(alpha, abs=1e-6)
        assert light.tension == pytest.approx(free.tension[-1], rel=1e-6)


def test_pull_of_a_body() -> None:
    tension, angle = body_pull([100.0, 100.0, 100.0], [0.0, -50.0, 180.0], [100.0, 200.0, 60.0])
    assert tension == pytest.approx([np.sqrt(2e4), 250.0, 100.0])
    assert np.tan(angle) == pytest.approx([1.0, 0.75, -80.0 / 60.0])


def test_long_light_cable_is_straight() -> None:
    """Hardly any weight nor tangential drag: the tension hardly grows, the angle closes at once."""
    cable = unequal_cable([0.0, 1e5], 10.0, 1.2, 1e-3, 1.0, 0.0)
    assert cable.angle[1] == pytest.approx(np.arctan2(1e-3, 1.0), abs=1e-12)
    # T − T₀ = μg z without tangential drag
    assert cable.tension - 10.0 == pytest.approx(1e-3 * cable.z, rel=1e-11)


def test_linear_cable_broadcasts() -> None:
    cable = linear_cable(np.linspace(0.0, 9.0, 4)[:, None], 5.0, [0.5, 1.0], 1.0, [1.0, 2.0])
    assert cable.x.shape == cable.tension.shape == (4, 2)
    assert cable.tension[0] == pytest.approx([5.0, 5.0])


@pytest.mark.parametrize("cable", [unequal_cable, quadratic_cable])
def test_straight_from_a_body_at_the_straight_angle(cable) -> None:
    alpha = float(straight_angle(1.0, 2.0, 1 if cable is unequal_cable else 2))
    line = cable([0.0, 5.0], 10.0, alpha, 1.0, 2.0, 0.0)
    assert line.angle == pytest.approx([alpha, alpha], abs=1e-14)
    assert line.tension == pytest.approx([10.0, 10.0 + 5.0 * np.sin(alpha)])


def test_values_out_of_range() -> None:
    with pytest.raises(ValueError, match="drag of a towed body"):
        body_pull(1.0, 0.0, -1.0)
    with pytest.raises(ValueError, match="exponent"):
        straight_angle(1.0, 1.0, 3)
    with pytest.raises(ValueError, match="weight and normal drag"):
        linear_cable(1.0, 1.0, 1.0, 0.0, 1.0)
    with pytest.raises(ValueError, match="arc length and the tension"):
        quadratic_cable(-1.0, 1.0, 1.0, 1.0, 1.0, 0.0)
    with pytest.raises(ValueError, match="tangential drag"):
        unequal_cable(1.0, 1.0, 1.0, 1.0, 1.0, -1.0)
    with pytest.raises(ValueError, match="less than π"):
        unequal_cable(1.0, 1.0, -3.0, 1.0, 1.0, 0.5)
    with pytest.raises(ValueError, match="same side"):
        linear_tension_ratio(0.5, 1.0, 1.0, 1.0, 0.5)
