"""The balance of one element, against the moment rule it solves and against brute force."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from calm.physics.drag import axis_along, drag_force, drag_share
from calm.physics.reynolds import DragCurve, Smooth, varying_share

component = st.floats(-3, 3)
vectors = st.tuples(component, component, component)


@given(force=vectors, current=vectors, k=st.floats(0, 50))
def test_the_share_solves_its_equation(force, current, k):
    """c |A + c V| = k |V × A|: the residual is held to rounding of its two sides."""
    a, v = np.array(force), np.array(current)
    c = drag_share(*force, k, *current)
    left, right = c * np.linalg.norm(a + c * v), k * np.linalg.norm(np.cross(v, a))
    assert 0 <= c <= k * np.linalg.norm(v) * (1 + 1e-12)
    assert left == pytest.approx(right, rel=1e-9, abs=1e-12 * (1 + k))


def test_the_smallest_of_three_roots_is_taken():
    """A nearly against V: three roots; the one that grows from rest is the first."""
    a, v, k = np.array([-10.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]), 12.0
    shares = np.linspace(0, k, 2_000_001)
    excess = shares * np.linalg.norm(a + shares[:, None] * v, axis=1) - k * 1.0
    crossings = shares[:-1][np.diff(np.sign(excess)) != 0]
    assert len(crossings) == 3
    assert drag_share(*a, k, *v) == pytest.approx(crossings[0], abs=1e-5)


@given(force=vectors, current=vectors, k=st.floats(0, 50), lengthening=st.floats(0.8, 1.8))
def test_a_varying_share_that_does_not_vary_is_the_share(force, current, k, lengthening):
    """In water so viscous that Re < 3.18, where the curve is held at 4.87.

    And where no three roots are too near each other to be told apart.
    """
    a, v = np.array(force), np.array(current)
    assume(a @ v >= 0.0)
    constant = 4.87 / 1.2
    varying = varying_share(*force, k, Smooth(0.5, lengthening), *current)
    assert varying == pytest.approx(drag_share(*force, constant * k, *current), rel=1e-9, abs=1e-14)


@given(force=vectors, current=vectors, k=st.floats(0, 50), diameter=st.floats(0.05, 1.0))
def test_a_varying_share_solves_its_equation(force, current, k, diameter):
    """c |A + c V| = k f(|Vn|) |V × A| with the speed across the axis that follows."""
    curve, v = DragCurve(diameter, 5.0), np.array(current)

    def varied(speed):
        return curve.factor(speed * diameter / 1.36e-6)

    smooth = Smooth(diameter / 1.36e-6, curve.lengthening)
    c = varying_share(*force, k, smooth, *current)
    axis = np.array(axis_along(*force, c, *current))
    across = float(np.linalg.norm(np.cross(v, axis)))
    # c and |Vn| each err by 1e-14 of |V × A|/|A|; the curve's slope makes up to three times that
    assert c == pytest.approx(k * varied(across) * across, rel=1e-8, abs=1e-10 * (1 + k))


def test_of_leaning_and_standing_in_the_drag_crisis_the_first_from_rest_is_taken():
    """A light cylinder in 4 m/s: it may lean by 73 degrees, or by 65 in less of a drag."""
    curve, force, k, v = DragCurve(0.5, 5.0), 100.0, 100.0, 4.0

    def varied(speed):
        return curve.factor(speed * 0.5 / 1.36e-6)

    speeds = np.linspace(0.0, v, 200_001)[1:]
    c = k * np.array([varied(s) for s in speeds]) * speeds
    excess = speeds * np.hypot(force, c * v) - v * force
    crossings = speeds[:-1][np.diff(np.sign(excess)) != 0]
    assert len(crossings) == 3
    smooth = Smooth(0.5 / 1.36e-6, curve.lengthening)
    share = varying_share(0.0, 0.0, force, k, smooth, v, 0.0, 0.0)
    assert v * force / np.hypot(force, share * v) == pytest.approx(crossings[0], abs=2e-5)


@given(force=vectors, current=vectors, kn=st.floats(0, 50), kt=st.floats(0, 5))
def test_the_axis_lies_along_the_mean_of_the_end_forces(force, current, kn, kt):
    """t ∥ F + q/2 for the drag q at that very axis: the moment rule itself."""
    c = drag_share(*force, kn / 2, *current)
    axis = np.array(axis_along(*force, c, *current))
    mean = np.array(force) + 0.5 * np.array(drag_force(kn, kt, *current, *axis))
    assert np.linalg.norm(axis) == pytest.approx(1)
    assert np.linalg.norm(np.cross(axis, mean)) <= 1e-8 * (1 + np.linalg.norm(mean))


def test_without_any_force_a_piece_hangs_plumb_or_trails_with_the_current():
    assert axis_along(0, 0, 0, 0, 0, 0, 0) == (0, 0, -1)
    assert axis_along(0, 0, 0, 0, 2.0, 0, 0) == (-1, 0, 0)


def test_drag_splits_into_normal_and_tangential():
    """A rod at 60° to a current of 2 m/s: Kn V² sin²60 across, Kt V² cos²60 along."""
    axis = (0.5, 0.0, -np.sqrt(0.75))
    drag = np.array(drag_force(10.0, 3.0, 2.0, 0.0, 0.0, *axis))
    along = float(drag @ axis)
    assert along == pytest.approx(3.0 * 4 * 0.25)
    assert np.linalg.norm(drag - along * np.array(axis)) == pytest.approx(10.0 * 4 * 0.75)


def test_a_bare_towed_end_takes_its_critical_angle():
    """F = 0: the first element of a bare cable leans at cos φ = √(1 + p²/4) - p/2, p = w/R."""
    weight, normal_drag = 2.5, 0.5 * 1025 * 1.5 * 0.01
    c = drag_share(0, 0, -weight / 2, normal_drag / 2, 1.0, 0, 0)
    axis = axis_along(0, 0, -weight / 2, c, 1.0, 0, 0)
    p = weight / normal_drag
    assert abs(axis[0]) == pytest.approx(np.sqrt(1 + p * p / 4) - p / 2, rel=1e-12)
