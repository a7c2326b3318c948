"""A leg whose end is held above the water: heavier in the air, and without drag there."""

from math import asinh, hypot, sqrt

import numpy as np
import pytest
from scipy.optimize import fsolve

import calm

SPAN = """\
name: From a pier
environment: {{depth: 300 m, density: 1025 kg/m^3, current: {{speed: {speed} m/s, toward: 90 deg}}}}
legs:
  span:
    line: [{{use: rope, length: {length} m}}]
    top: {{held: {{depth: {depth} m, at: [-60 m, 0 m]}}}}
    bottom: {{held: {{depth: 60 m, at: [40 m, 0 m]}}}}
components:
  rope: {{kind: cable, diameter: 20 mm, mass: 0.75 kg/m, weight: 4 N/m, stiffness: 100000 MN}}
"""
IN_WATER = 4.0  # N/m
IN_AIR = 0.75 * 9.80665 - 1.225 * 9.80665 * (0.75 - IN_WATER / 9.80665) / 1025.0


def solved(folder, depth, length, speed):
    file = folder / "span.yaml"
    file.write_text(SPAN.format(depth=depth, length=length, speed=speed))
    return calm.load(file).solve()


def two_catenaries(height, length):
    """Tensions at both ends [N] of a rope of two weights, by the equations of the catenary."""

    def forces(unknown):
        pull, top = unknown
        at_surface = sqrt(max((hypot(pull, top) - height * IN_AIR) ** 2 - pull**2, 0.0))
        return pull, top, at_surface, at_surface - IN_WATER * length + (
            (top - at_surface) * IN_WATER / IN_AIR
        )  # fmt: skip

    def missed(unknown):
        pull, top, at_surface, bottom = forces(unknown)
        across = (asinh(top / pull) - asinh(at_surface / pull)) / IN_AIR
        across += (asinh(at_surface / pull) - asinh(bottom / pull)) / IN_WATER
        down = (hypot(pull, at_surface) - hypot(pull, bottom)) / IN_WATER
        return np.array([pull * across - 100.0, down - 60.0])

    found = fsolve(missed, [200.0, 500.0], xtol=1e-12)
    assert missed(found) == pytest.approx([0.0, 0.0], abs=1e-6)
    pull, top, _, bottom = forces(found)
    return hypot(pull, top), hypot(pull, bottom)


@pytest.mark.parametrize(("height", "length"), [(2.0, 119.0), (2.0, 130.0), (20.0, 150.0)])
def test_in_still_water_two_catenaries_meet_at_the_surface(tmp_path, height, length):
    rope = solved(tmp_path, -height, length, 0.0).legs[0].components[0]
    # the density changes within 1 mm above the surface
    assert (rope.tension_top, rope.tension_bottom) == pytest.approx(
        two_catenaries(height, length), rel=3e-5
    )


def test_a_little_higher_changes_little(tmp_path):
    below, above = (solved(tmp_path, depth, 130.0, 0.3) for depth in (0.5, -0.5))
    one, other = (result.legs[0].components[0] for result in (below, above))
    assert other.tension_top - one.tension_top == pytest.approx(0.0, abs=10.0)
    assert other.tension_top != one.tension_top
