"""What a component gives a float at the surface: hull, weight, drag afloat, wind."""

from math import cbrt, pi, sqrt

import pytest

from calm.assemble import assemble_floating, assemble_water
from calm.files import Body, Cable, CurrentTable, Cylinder, Environment, Piece, Place, Sphere, Wind

GRAVITY = 9.80665
STILL = CurrentTable((0.0,), (0.0,), (0.0,), (0.0,))
DRAG_BELOW = 512.5 * 0.5 * pi / 4


def piece(component):
    return Piece(
        0, "id", "buoy", component, getattr(component, "length", 0.0), None, (), 1, 1, Place(0)
    )


def floating(*components, density=1025.0, **wind):
    blowing = Wind.model_validate(wind) if wind else None
    surroundings = Environment(None, "water", 100.0, density, None, STILL, blowing, None)
    pieces = [piece(component) for component in components]
    return assemble_floating(pieces, surroundings, assemble_water(surroundings))


def sphere(**figures):
    given = {"kind": "sphere", "diameter": "1 m", "mass": "200 kg", "buoyancy": "3000 N", **figures}
    return Sphere.model_validate({k: v for k, v in given.items() if v is not None})


def body(**figures):
    given = {"kind": "body", "length": "1.2 m", "kn": "300 N/(m/s)^2", "inclination": "insensitive"}
    return Body.model_validate(given | {"mass": "200 kg", "volume": "0.7 m^3"} | figures)


def test_a_sphere_floats_by_its_mass_and_buoyancy():
    afloat = floating(sphere())
    assert afloat.weight == pytest.approx(200 * GRAVITY)
    assert afloat.lift == pytest.approx(3000)
    assert (afloat.hull.height, afloat.hull.area) == (1.0, pytest.approx(pi / 4))
    assert (afloat.surface_drag, afloat.blown, afloat.wind_area) == (None, False, None)


def test_lighter_water_lifts_less_and_leaves_the_weight():
    volume = 200 / 1025 + 3000 / (1025 * GRAVITY)
    afloat = floating(sphere(), density=1000.0)
    assert afloat.weight == pytest.approx(200 * GRAVITY)
    assert afloat.lift == pytest.approx(3000 - 25 * GRAVITY * volume)


def test_a_cylinder_is_a_spar():
    spar = Cylinder.model_validate(
        {"kind": "cylinder", "diameter": "0.5 m", "length": "3 m", "mass": "200 kg",
         "buoyancy": "3000 N"}
    )  # fmt: skip
    hull = floating(spar).hull
    assert (hull.height, hull.area) == (3.0, pytest.approx(1.5))
    assert hull.curve(0.3) == (0.3, 0.3)


def test_a_body_floats_as_a_sphere_or_cylinder_of_its_volume():
    ball = floating(body(hull="sphere")).hull
    assert ball.height == pytest.approx(cbrt(6 * 0.7 / pi))
    assert ball.curve(0.5) == pytest.approx((0.5, 0.5))
    spar = floating(body(hull="cylinder")).hull
    assert spar.height == 1.2
    assert spar.area == pytest.approx(1.2 * sqrt(4 * 0.7 / (pi * 1.2)))
    assert floating(body()) is None


def test_a_table_gives_the_volume_where_nothing_else_does():
    hull = {"displacement": [["0.3 m", "0.4 m^3", "0.2 m^2"], ["0.6 m", "0.7 m^3", "0.5 m^2"]]}
    afloat = floating(
        Body.model_validate(
            {"kind": "body", "length": "0.6 m", "kn": "300 N/(m/s)^2", "buoyancy": "5000 N",
             "inclination": "insensitive", "hull": hull}
        )
    )  # fmt: skip
    assert afloat.weight == pytest.approx(0.7 * 1025 * GRAVITY - 5000)
    assert afloat.hull.curve(4 / 7) == pytest.approx((0.5, 0.4))


def test_drag_afloat_and_wind():
    afloat = floating(
        sphere(k_surface="50 N/(m/s)^2", wind_area="2 m^2", wind_cd=0.8),
        speed="10 m/s", toward="90 deg",
    )  # fmt: skip
    assert afloat.surface_drag == pytest.approx(50 / DRAG_BELOW)
    assert afloat.wind == pytest.approx((10.0, 0.0))
    assert (afloat.wind_area, afloat.wind_cd) == (2.0, 0.8)


def test_without_mass_and_volume_only_a_drag_afloat_makes_a_difference():
    assert floating(sphere(mass=None)) is None
    afloat = floating(sphere(mass=None, k_surface="50 N/(m/s)^2"))
    assert afloat.hull is None
    assert afloat.riding(0.5).drag == pytest.approx(50 / DRAG_BELOW)


def test_it_is_the_first_rigid_buoyant_piece():
    light = body(mass="20 kg", volume="0.001 m^3")
    rope = Cable.model_validate({"kind": "cable", "diameter": "10 mm", "buoyancy": "1 N/m"})
    assert floating(light, rope, sphere()).lift == pytest.approx(3000)
    assert floating(light) is None
