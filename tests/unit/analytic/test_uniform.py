"""Lines in a uniform stream: printed tables, direct integration, limits."""

import numpy as np
import pytest

from calm.analytic.uniform import (
    critical_angle,
    critical_weight_ratio,
    heavy_line,
    neutral_line,
    tension_ratio,
)
from tests.unit.analytic.integration import difference, integrate

# A tow, a mooring seen from its float, a drogue below the critical angle: T [N], φ [rad], s [m].
ENDS = [(900.0, 1.5, 400.0), (900.0, 1.7, -150.0), (300.0, 0.1, 250.0), (300.0, 2.9, 60.0)]


def test_critical_angles() -> None:
    ratios = [0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0]
    degrees = [12.7578, 17.9642, 25.1784, 38.6683, 51.8273, 65.5302, 78.8965, 84.3173]
    # printed to four digits behind the point
    assert np.degrees(critical_angle(ratios)) == pytest.approx(degrees, abs=5.1e-5)


def test_weight_ratios_of_critical_angles() -> None:
    degrees = [5.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 75.0]
    ratios = [0.007625, 0.030619, 0.069350, 0.124485, 0.288675, 0.707107, 1.5, 3.604884]
    # printed to six digits behind the point
    assert critical_weight_ratio(np.radians(degrees)) == pytest.approx(ratios, abs=5.1e-7)


def test_critical_angle_and_its_inverse() -> None:
    angles = np.array([1e-7, 1e-3, 0.3, 1.0, 1.5, 1.5707])
    assert critical_angle(critical_weight_ratio(angles)) == pytest.approx(angles, rel=1e-14)
    assert critical_angle(0.0) == 0.0


@pytest.mark.parametrize(
    ("speed", "degrees"), [(1.0, 31.7304), (2.0, 16.2243), (3.0, 10.8582), (5.0, 6.5277)]
)
def test_bare_cable_towed(speed, degrees) -> None:
    """10 mm, 2.5 N/m, Cn = 1.5."""
    normal_drag = 0.5 * 1025.0 * 1.5 * 0.01 * speed**2
    assert np.degrees(critical_angle(2.5 / normal_drag)) == pytest.approx(degrees, abs=5.1e-5)


@pytest.mark.parametrize(("tension", "angle", "arc"), ENDS)
@pytest.mark.parametrize("normal_drag", [0.01, 2.0, 40.0])
def test_neutral_line_against_integration(tension, angle, arc, normal_drag) -> None:
    expected, _ = integrate(arc, tension, angle, 0.0, normal_drag)
    assert difference(neutral_line(arc, tension, angle, normal_drag), expected, arc) < 1e-10


def test_neutral_line_broadcasts() -> None:
    arcs = np.linspace(0.0, 100.0, 5)
    line = neutral_line(arcs[:, None], 500.0, 1.5, [1.0, 2.0, 3.0])
    assert line.x.shape == line.angle.shape == line.tension.shape == (5, 3)
    assert line.z[3, 1] == neutral_line(75.0, 500.0, 1.5, 2.0).z


@pytest.mark.parametrize(("law", "power"), [("square", 2), ("constant", 0)])
@pytest.mark.parametrize("tangential_drag", [0.0, 0.2])
@pytest.mark.parametrize(("weight", "normal_drag"), [(2.0, 0.05), (2.0, 3.0), (0.05, 4.0)])
@pytest.mark.parametrize(("tension", "angle", "arc"), ENDS)
def test_heavy_line_against_integration(
    tension, angle, arc, weight, normal_drag, tangential_drag, law, power
) -> None:
    expected, least = integrate(
        arc, tension, angle, weight, normal_drag, tangential_drag, friction_exponent=power
    )
    assert least > 0.1 * tension
    found = heavy_line(arc, tension, angle, weight, normal_drag, tangential_drag, law)
    assert difference(found, expected, arc) < 1e-10


@pytest.mark.parametrize(("angle", "arc"), [(2.8, -900.0), (0.4, -300.0), (-0.5, 700.0)])
def test_heavy_line_goes_on_beyond_its_level_point(angle, arc) -> None:
    expected, least = integrate(arc, 700.0, angle, 2.0, 1.5, 0.1)
    assert least > 100.0
    assert np.sin(expected[0]) * np.sin(angle) < 0.0
    assert difference(heavy_line(arc, 700.0, angle, 2.0, 1.5, 0.1), expected, arc) < 1e-10


@pytest.mark.parametrize("ratio", [1e-12, 1e-8, 1e-4, 1e4, 1e8])
@pytest.mark.parametrize("angle", [0.0, 1e-9, 0.7, 1.57, 3.0, np.pi])
@pytest.mark.parametrize("arc", [-300.0, 1e-9, 50.0])
def test_next_to_weightless_and_next_to_no_drag(arc, angle, ratio) -> None:
    weight, normal_drag = min(2.0, 2.0 * ratio), min(2.0, 2.0 / ratio)
    expected, _ = integrate(arc, 500.0, angle, weight, normal_drag, 0.005 * normal_drag)
    found = heavy_line(arc, 500.0, angle, weight, normal_drag, 0.005 * normal_drag)
    assert difference(found, expected, arc) < 1e-10


@pytest.mark.parametrize(
    ("weight", "start", "arc", "end", "height", "downstream"),
    [
        # Braconnot's tow, its body found from the ship
        (0.5, (140.0, 100.0), -100.0, (116.37337330523884, 63.401), -73.198, 67.215),
        (0.5, (165.0, 40.0), 100.0, (145.83813, 63.9741152), 47.9482305, -87.2866976),
        # through the level point
        (0.5, (-20.0, 60.0), 200.0, (107.31124, 105.978848), 91.9576956, 126.772138),
        # Braconnot's buoy, its anchor found from the float
        (5.0, (75.0, 350.0), -28.467, (22.027, 250.0), -20.0, -18.782),
    ],
)
def test_examples_of_braconnot(weight, start, arc, end, height, downstream) -> None:
    """K = R/w = 2.4. His angle to the current is π − φ, or −π − φ below the level point."""
    angle = np.pi - np.radians(start[0])
    angle = angle if angle <= np.pi else angle - 2.0 * np.pi
    found = heavy_line(arc, start[1], angle, weight, 2.4 * weight)
    # the figures given: eight digits in the two rows in the middle, to 1e-3 m in the others
    digits = 1e-7 if arc > 0.0 else 2e-3 / abs(arc)
    to_current = 180.0 - np.degrees(found.angle)
    assert (to_current - end[0] + 180.0) % 360.0 == pytest.approx(180.0, abs=60.0 * digits)
    assert found.tension == pytest.approx(end[1], rel=digits)
    assert (found.z, found.x) == pytest.approx((height, -downstream), abs=digits * abs(arc))


@pytest.mark.parametrize("speed", [0.3, 0.5, 1.0])
def test_tension_of_a_heavy_line_differs_by_its_weight(speed) -> None:
    line = heavy_line(np.linspace(-1000.0, 0.0, 6), 4905.0, 1.6, 2.0, 8.46 * speed**2)
    assert line.tension - 4905.0 == pytest.approx(2.0 * line.z, rel=1e-11)


@pytest.mark.parametrize("law", ["square", "constant"])
def test_tension_ratio_is_that_of_the_shape(law) -> None:
    line = heavy_line([-50.0, -10.0, 30.0, 200.0], 400.0, 1.7, 1.0, 4.0, 0.3, law)
    ratio = tension_ratio(line.angle, 1.7, 0.25, 0.3 / 4.0, law)
    assert ratio == pytest.approx(line.tension / 400.0, rel=1e-13)


def test_tension_ratio_from_square_to_the_stream() -> None:
    angles, p = np.radians([30.0, 60.0, 120.0, 180.0]), 0.1
    u, cosine = np.cos(critical_angle(p)), np.cos(angles)
    plain = (u * (1.0 + u * cosine) / (u - cosine)) ** ((1.0 - u * u) / (1.0 + u * u))
    assert tension_ratio(angles, np.pi / 2.0, p) == pytest.approx(plain, rel=1e-13)


def test_line_at_its_critical_angle_stays_straight() -> None:
    phi = float(critical_angle(0.5))
    line = heavy_line([0.0, 40.0], 100.0, phi, 1.0, 2.0, 0.3)
    assert line.angle == pytest.approx([phi, phi], abs=1e-15)
    assert line.z[1] == pytest.approx(40.0 * np.sin(phi))
    assert line.tension[1] == pytest.approx(100.0 + 40.0 * (np.sin(phi) + 0.3 * np.cos(phi) ** 2))
    with pytest.raises(ValueError, match="falls to 0 before"):
        heavy_line(-500.0, 100.0, phi, 1.0, 2.0)


def test_long_cable_comes_up_to_its_critical_angle() -> None:
    phi = critical_angle(0.5)
    line = heavy_line(1e4, 100.0, 1.5, 1.0, 2.0)
    # the gap closes as (T₀/T)^5 or faster; T grows to 8000 N
    assert line.angle == pytest.approx(phi, abs=1e-6)
    assert line.angle > phi
    assert line.tension - 100.0 == pytest.approx(line.z, rel=1e-12)


def test_long_light_cable() -> None:
    """Far beyond where it turns: its height is still that of its tension."""
    cable = heavy_line([1e3, 1e5], 10.0, 1.5, 1e-3, 1.0)
    assert cable.tension - 10.0 == pytest.approx(1e-3 * cable.z, rel=1e-10)


def test_values_out_of_range() -> None:
    with pytest.raises(ValueError, match="must be above 0"):
        neutral_line(1.0, 0.0, 1.0, 1.0)
    with pytest.raises(ValueError, match="between 0 and π"):
        neutral_line(1.0, 1.0, 0.0, 1.0)
    with pytest.raises(ValueError, match="vertical mirror image"):
        critical_angle(-0.1)
    with pytest.raises(ValueError, match="below 90°"):
        critical_weight_ratio(np.pi / 2.0)
    with pytest.raises(ValueError, match="the neutral line"):
        heavy_line(1.0, 1.0, 1.0, 0.0, 1.0)
    with pytest.raises(ValueError, match="must be above 0"):
        heavy_line(1.0, 0.0, 1.0, 1.0, 1.0)
    with pytest.raises(ValueError, match="must be finite"):
        heavy_line(np.inf, 1.0, 1.0, 1.0, 1.0)
    with pytest.raises(ValueError, match="must not be negative"):
        heavy_line(1.0, 1.0, 1.0, 1.0, 1.0, -0.1)
    with pytest.raises(ValueError, match="from -π to π"):
        heavy_line(1.0, 1.0, 4.0, 1.0, 1.0)
    with pytest.raises(ValueError, match='"constant" or "square"'):
        heavy_line(1.0, 1.0, 1.0, 1.0, 1.0, 0.1, "cubic")
    with pytest.raises(ValueError, match="from 0 to π"):
        tension_ratio(1.0, 4.0, 1.0)
    with pytest.raises(ValueError, match="same side of the critical angle"):
        tension_ratio(0.1, 1.5, 1.0)
