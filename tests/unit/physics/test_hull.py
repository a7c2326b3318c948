"""A float at its draft: hulls against their geometry, and what it displaces against its weight."""

from dataclasses import replace
from math import hypot, isnan, pi, sqrt

import numpy as np
import pytest
from scipy.integrate import quad

from calm.physics.hull import (
    AIR_DENSITY,
    AWASH,
    Floating,
    cylindrical_hull,
    spherical_hull,
    tabulated_hull,
)

SHARES = [0.0, 1e-6, 0.01, 0.1, 0.25, 0.5, 0.75, 0.9, 0.99, 1.0 - 1e-9, 1.0]
ROUNDING = 1e-12
TABLE = [(0.2, 0.5, 0.4), (0.4, 1.25, 0.9), (0.6, 1.5, 1.0)]
PRESSURE = 0.5 * AIR_DENSITY * 1.0


@pytest.mark.parametrize("share", SHARES)
def test_a_sphere_sits_as_deep_as_a_cap_of_that_volume(share):
    """A cap of height h of a sphere of diameter D holds π h² (3D − 2h)/6."""
    hull = spherical_hull(1.6)
    draft, _ = hull.curve(share)
    h = 1.6 * draft
    assert pi * h**2 * (3 * 1.6 - 2 * h) / 6 == pytest.approx(share * pi * 1.6**3 / 6, abs=ROUNDING)


@pytest.mark.parametrize("share", SHARES)
def test_the_immersed_area_of_a_sphere_is_a_segment_of_its_disc(share):
    """The chord at a height y is 2√(y(D − y)); with y = D sin² a the integrand is smooth."""
    draft, area = spherical_hull(1.0).curve(share)
    top = np.arcsin(sqrt(min(draft, 1.0)))
    segment, _ = quad(lambda a: np.sin(2 * a) ** 2, 0.0, top, epsabs=1e-14)
    assert area * pi / 4 == pytest.approx(segment, abs=1e-12)


def test_half_a_sphere_and_the_whole_one():
    hull = spherical_hull(2.0)
    assert (hull.height, hull.area) == (2.0, pytest.approx(pi))
    assert hull.curve(0.5) == pytest.approx((0.5, 0.5), abs=1e-15)
    assert hull.curve(1.0) == pytest.approx((1.0, 1.0), abs=1e-15)
    assert hull.curve(0.0) == pytest.approx((0.0, 0.0), abs=1e-15)


def test_a_spar_sinks_in_proportion():
    hull = cylindrical_hull(0.4, 3.0)
    assert (hull.height, hull.area) == (3.0, pytest.approx(1.2))
    assert hull.curve(0.37) == (0.37, 0.37)


def test_a_table_is_linear_between_its_rows_and_from_the_keel():
    hull = tabulated_hull(TABLE)
    assert (hull.height, hull.area) == (0.6, 1.0)
    assert hull.curve(0.25 / 1.5) == pytest.approx((0.1 / 0.6, 0.2))
    assert hull.curve(0.5 / 1.5) == pytest.approx((0.2 / 0.6, 0.4))
    assert hull.curve(0.875 / 1.5) == pytest.approx((0.3 / 0.6, 0.65))
    assert hull.curve(1.0) == pytest.approx((1.0, 1.0))
    assert tabulated_hull([(0.0, 0.0, 0.0), *TABLE]).curve(0.3) == hull.curve(0.3)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ([], "no rows"),
        ([(0.2, 1, 1), (0.2, 2, 2)], "draft must increase"),
        ([(0.2, 1, 1), (0.4, 1, 2)], "volume must increase"),
        ([(0.2, 1, 1), (0.4, 2, 0.9)], "area must not decrease"),
        ([(0.0, 0.0, 0.0)], "at least two rows are needed"),
    ],
)
def test_tables_that_are_no_hulls(rows, message):
    with pytest.raises(ValueError, match=message):
        tabulated_hull(rows)


HULLS = {
    "sphere": spherical_hull(1.1),
    "spar": cylindrical_hull(0.5, 2.0),
    "table": tabulated_hull(TABLE),
}


@pytest.mark.parametrize("hull", HULLS.values(), ids=HULLS)
@pytest.mark.parametrize("used", [0.0, 0.2, 0.6, 0.99, 1.0])
def test_the_water_displaced_carries_the_weight_and_the_pull(hull, used):
    floating = Floating(hull, weight=1700.0, lift=5200.0)
    draft = floating.riding(used).draft / hull.height
    volumes = {
        "sphere": draft**2 * (3 - 2 * draft),
        "spar": draft,
        "table": np.interp(0.6 * draft, [0, 0.2, 0.4, 0.6], [0, 0.5, 1.25, 1.5]) / 1.5,
    }
    name = next(name for name, each in HULLS.items() if each is hull)
    assert volumes[name] * 6900.0 == pytest.approx(1700.0 + used * 5200.0, rel=ROUNDING)


def test_what_is_in_the_water_is_dragged_and_what_is_out_of_it_is_blown():
    floating = Floating(cylindrical_hull(0.5, 2.0), 1000.0, 3000.0, wind=(6.0, -8.0), wind_cd=0.9)
    riding = floating.riding(0.5)
    assert (riding.draft, riding.freeboard) == pytest.approx((1.25, 0.75))
    assert riding.standing == pytest.approx(0.375)
    assert riding.drag == pytest.approx(0.625)
    force = PRESSURE * 0.9 * 0.375 * 10.0
    assert riding.push == pytest.approx((6.0 * force, -8.0 * force))
    assert floating.blown


def test_a_given_drag_afloat_and_a_given_area_in_the_wind():
    floating = Floating(
        spherical_hull(1.0), 1000.0, 3000.0, surface_drag=0.3, wind=(10.0, 0.0), wind_area=2.0
    )
    riding = floating.riding(0.5)
    assert riding.drag == pytest.approx(0.3)
    assert riding.push[0] == pytest.approx(PRESSURE * 2.0 * 100.0)
    awash = floating.riding(1.0 - 0.25 * AWASH)
    assert awash.drag == pytest.approx(0.75 + 0.25 * 0.3)
    assert awash.push[0] == pytest.approx(0.25 * riding.push[0])
    assert awash.above == pytest.approx(0.25)


def test_without_a_hull_there_is_no_draft():
    riding = Floating(None, 0.0, 3000.0, surface_drag=1.4).riding(0.4)
    assert isnan(riding.draft)
    assert isnan(riding.freeboard)
    assert (riding.standing, riding.push) == (0.0, (0.0, 0.0))
    assert riding.drag == pytest.approx(1.4)


@pytest.mark.parametrize("hull", [*HULLS.values(), None])
def test_with_all_its_buoyancy_in_use_it_is_as_just_below_the_surface(hull):
    floating = Floating(hull, 1000.0, 3000.0, 0.3, wind=(20.0, 5.0), wind_area=3.0)
    for each in (floating, replace(floating, wind_area=None, surface_drag=None)):
        riding = each.riding(1.0)
        assert riding.drag == pytest.approx(1.0, abs=1e-15)
        assert (riding.standing, riding.above) == (pytest.approx(0.0, abs=1e-15), 0.0)
        assert hypot(*riding.push) == pytest.approx(0.0, abs=1e-12)
