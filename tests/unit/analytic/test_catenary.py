"""Catenaries: published rows, direct integration, the place found from the pull and back."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from calm.analytic.catenary import Catenary, between, position

INF = np.inf


def test_suspended_line() -> None:
    line = between(400.0, 300.0, 520.0, 50.0, 5e6)
    assert line.horizontal == pytest.approx(15677.747, abs=1e-3)
    assert line.vertical == pytest.approx(26291.876, abs=1e-3)
    assert line.vertical_bottom == pytest.approx(291.876, abs=1e-3)
    assert line.tension_top == pytest.approx(30611.346, abs=1e-3)
    assert line.grounded == 0.0


def test_taut_line_that_must_stretch() -> None:
    line = between(400.0, 300.0, 490.0, 50.0, 5e6)
    assert line.horizontal == pytest.approx(86912.281, abs=1e-3)
    assert line.vertical == pytest.approx(77703.619, abs=1e-3)
    assert line.tension_top == pytest.approx(116583.005, abs=1e-3)


def test_line_that_touches_down() -> None:
    line = between(5.3, 2.65, 6.98, 1.036, 560e3, seabed=True)
    assert line.horizontal == pytest.approx(0.763277, abs=1e-6)
    assert line.vertical == pytest.approx(3.424639, abs=1e-6)
    assert line.tension_top == pytest.approx(3.508667, abs=1e-6)
    assert line.grounded == pytest.approx(3.674364, abs=1e-6)
    assert line.vertical_bottom == 0.0
    assert line.tension_bottom == pytest.approx(line.horizontal)


def test_level_span() -> None:
    line = between(300.0, 0.0, 330.0, 20.0)
    assert line.horizontal == pytest.approx(3929.783686, abs=1e-6)
    assert line.tension_top == pytest.approx(5131.588430, abs=1e-6)
    assert -line.position(165.0)[1] == pytest.approx(60.090237, abs=1e-6)


@pytest.mark.parametrize("stiffness", [INF, 4000.0])
@pytest.mark.parametrize(("horizontal", "vertical"), [(200.0, 900.0), (50.0, 120.0), (3e4, -2e4)])
def test_direct_integration(horizontal, vertical, stiffness) -> None:
    length, weight = 80.0, 5.0
    line = Catenary(horizontal, vertical, length, weight, stiffness)

    def slope(s, _):
        v = vertical - weight * (length - s)
        tension = np.hypot(horizontal, v)
        stretched = 1.0 + tension / stiffness
        return [stretched * horizontal / tension, stretched * v / tension]

    for arc in (20.0, length):
        run = solve_ivp(slope, (0.0, arc), [0.0, 0.0], method="DOP853", rtol=1e-12, atol=1e-13)
        assert line.position(arc) == pytest.approx(run.y[:, -1], rel=1e-10, abs=1e-10 * length)


def test_seabed_takes_what_the_pull_does_not_lift() -> None:
    line = Catenary(100.0, [50.0, 200.0, 500.0], 60.0, 5.0, seabed=True)
    assert line.grounded == pytest.approx([50.0, 20.0, 0.0])
    assert line.vertical_bottom == pytest.approx([0.0, 0.0, 200.0])
    x, z = line.position(10.0)
    assert x[:2] == pytest.approx([10.0, 10.0])
    assert z[:2] == pytest.approx([0.0, 0.0])
    assert z[2] > 0.0


def test_forms_of_taut_and_slack_lines_meet() -> None:
    """The half-angle form and the difference of inverse sines, on both sides of their border."""
    # w s/(T₁ + T₀) = 1/2 where H = w s √3/2 and the lowest point is in the middle
    x, z = position(1.0, np.sqrt(3.0) / 2.0 * np.array([1.0 - 1e-13, 1.0 + 1e-13]), -0.5, 1.0)
    # dx = 1.1 · 2e-13 between the two; the rest is rounding
    assert x[0] == pytest.approx(x[1], abs=1e-12)
    assert z == pytest.approx([0.0, 0.0], abs=1e-15)


def test_nearly_straight_line_keeps_its_digits() -> None:
    # To second order in w s/T: sag 1/2 w s²/T, shortening of the chord (w s/T)²/24 · s.
    x, z = position(1.0, 1e6, -0.5, 1.0)
    assert z == pytest.approx(0.0, abs=1e-18)
    assert 1.0 - x == pytest.approx(1e-12 / 24.0, abs=2e-16)


def test_position_below_a_point() -> None:
    x, z = position(7.0, 30.0, -4.0, 2.0)
    back_x, back_z = position(-7.0, 30.0, -4.0 + 14.0, 2.0)
    assert (back_x, back_z) == pytest.approx((-x, -z), rel=1e-14)


@settings(deadline=None, max_examples=200)
@given(
    x=st.floats(1e-3, 3.0),
    z=st.floats(-1.0, 1.0),
    slack=st.floats(-9.0, 0.3),
    stiffness=st.one_of(st.none(), st.floats(0.0, 8.0)),
    weight=st.floats(1e-3, 1e3),
    seabed=st.booleans(),
)
def test_pull_found_from_the_place_leads_there(x, z, slack, stiffness, weight, seabed) -> None:
    z = max(abs(z), 1e-3) if seabed else z
    length = np.hypot(x, z) * (1.0 + 10.0**slack)
    axial = INF if stiffness is None else weight * length * 10.0**stiffness
    try:
        line = between(x, z, length, weight, axial, seabed=seabed)
    except ValueError as error:
        assert "is slack" in str(error)
        return
    # a thousand roundings of numbers of the size of the length
    assert line.end == pytest.approx((x, z), abs=2e-13 * length)


@pytest.mark.parametrize(
    ("arguments", "seabed", "message"),
    [
        ((3.0, 4.0, 5.0, 1.0), False, "does not reach"),
        ((0.0, 4.0, 5.0, 1.0), False, "distance"),
        ((3.0, 4.0, 6.0, 0.0), False, "weight"),
        ((3.0, 4.0, 6.0, 1.0, -1.0), False, "stiffness"),
        ((3.0, 4.0, 8.0, 1.0), True, "is slack"),
        ((3.0, -1.0, 8.0, 1.0), True, "above the seabed"),
        ((3.0, 4.0, np.nan, 1.0), False, "finite"),
    ],
)
def test_places_out_of_range(arguments, seabed, message) -> None:
    with pytest.raises(ValueError, match=message):
        between(*arguments, seabed=seabed)


def test_pulls_out_of_range() -> None:
    with pytest.raises(ValueError, match="horizontal"):
        Catenary(0.0, 1.0, 1.0, 1.0)
    with pytest.raises(ValueError, match="vertical pull above 0"):
        Catenary(1.0, -1.0, 1.0, 1.0, seabed=True)
    with pytest.raises(ValueError, match="from 0 to the length"):
        Catenary(1.0, 1.0, 1.0, 1.0).position(1.1)
