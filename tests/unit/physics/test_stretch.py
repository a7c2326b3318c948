"""Elongation curves against scipy's monotone interpolation, and what is refused."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.interpolate import PchipInterpolator

from calm.physics.materials import published_stiffnesses
from calm.physics.stretch import ElongationCurve, mean_curve_strain

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
    for tension in np.linspace(0, 0.7 * BREAKING_LOAD, 501)[:-1]:
        assert curve().strain(tension) == pytest.approx(reference(tension), rel=1e-12, abs=1e-16)


def test_goes_on_straight_beyond_the_last_point():
    chord = (0.125 - 0.11) / (0.2 * BREAKING_LOAD)
    assert curve().strain(0.9 * BREAKING_LOAD) == pytest.approx(0.125 + chord * 0.2 * BREAKING_LOAD)


def test_begins_at_nothing_whether_the_table_says_so_or_not():
    points = list(zip(LOADS, STRAINS, strict=True))[1:]
    short = ElongationCurve(points, BREAKING_LOAD)
    for tension in (0.0, 100.0, 7e3, 3e4, 6e4):
        assert short.strain(tension) == curve().strain(tension)


def test_one_point_is_a_linear_stiffness():
    linear = ElongationCurve([(1.0, 0.25)], BREAKING_LOAD)
    for tension in (0.0, 1.0, 2e4, 5e4, 8e4):
        assert linear.strain(tension) == pytest.approx(tension / 200e3, rel=1e-14)


def test_permanent_elongation_adds_to_the_strain_at_every_tension():
    for tension in (0.0, 100.0, 7e3, 6e4):
        assert curve(0.04).strain(tension) == pytest.approx(0.04 + curve().strain(tension))


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


def mean_strain(rope, tension, half):
    """Mean strain where the tension goes evenly by `half` below and above a tension."""
    return mean_curve_strain(rope.knots, 0, len(rope.knots), tension, half)


@given(points=tables, tension=st.floats(0, 1200), half=st.floats(-1200, 1200))
def test_mean_strain_is_that_of_all_tensions_between(points, tension, half):
    """Against a thousand steps, whose middles come within 1e-6; the table's points are kept out."""
    rope = ElongationCurve(points, 1000.0, permanent=0.02)
    knots = rope.tensions
    low, high = tension - abs(half), tension + abs(half)
    assume(low >= 0.0 and not any(low < knot < high for knot in knots))
    middles = low + (high - low) * (np.arange(1000) + 0.5) / 1000
    mean = np.mean([rope.strain(t) for t in middles])
    assert mean_strain(rope, tension, half) == pytest.approx(mean, abs=1e-6)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([(0.1, 0.01), (0.1, 0.02)], "point 2: the load 0.1 is not above that of the point before"),
        ([(0.2, 0.01), (0.1, 0.02)], "point 2: the load 0.1 is not above that of the point before"),
        ([(0.1, 0.02), (0.2, 0.01)], "point 2: the strain 0.01 is below that of the point before"),
        ([(0.0, 0.01), (0.2, 0.02)], "permanent_elongation"),
        ([(20, 0.1)], "20 times the breaking load"),
        ([(-0.1, 0.1)], "is not above that of the point before"),
        ([(0.1, float("nan"))], "not a number"),
        ([(float("inf"), 0.1)], "not a number"),
        ([(0.0, 0.0)], "needs at least one point"),
        ([], "needs at least one point"),
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


@pytest.mark.parametrize(
    ("material", "printed"),
    [
        ("nylon", (43, 98, 381)),
        ("polyester", (196, 394, 1557)),
        ("polyester parallel fibre, polyethylene sheath", (196, 394, 1557)),
    ],
)
def test_published_stiffnesses_as_printed(material, printed):
    """19 mm ropes, EA in kN; half a unit of the last digit and a tenth, as moduli are rounded."""
    got = [1e-3 * stiffness for stiffness in published_stiffnesses(material, 0.019)]
    assert got == pytest.approx(printed, abs=0.55)


def test_nylon_of_19_mm_at_1000_kgf():
    """Strains of 23, 10 and 2.6 % are printed for the same rope."""
    strains = [100 * 9806.65 / stiffness for stiffness in published_stiffnesses("Nylon", 0.019)]
    assert strains == pytest.approx([23, 10, 2.6], rel=0.021)


@pytest.mark.parametrize(
    ("material", "count"),
    [("HMPE core, polyester jacket", 2), ("Kevlar", 1), ("polypropylene with lead", 2),
     ("Vectran", 0), ("galvanised steel", 0)],
)  # fmt: skip
def test_how_many_stiffnesses_are_published(material, count):
    assert len(published_stiffnesses(material, 0.012)) == count


def test_mean_strain_across_points_of_the_table_is_exact():
    """Against quadrature that knows where the cubics meet."""
    curve = ElongationCurve([(0.1, 0.02), (0.3, 0.035), (0.6, 0.06)], 50e3)
    low, high = 2e3, 32e3
    exact, _ = quad(curve.strain, low, high, points=[5e3, 15e3, 30e3], epsabs=0.0, epsrel=1e-13)
    mean = mean_strain(curve, 0.5 * (low + high), 0.5 * (high - low))
    assert mean == pytest.approx(exact / (high - low), rel=1e-13)
