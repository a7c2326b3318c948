"""The referee against closed forms of its own: whoever judges is judged first.

Rods: moments about the lower end. Catenaries: M. Irvine, *Cable Structures* (1981), elastic, in
still surroundings, x = (H/w)(asinh(V/H) − asinh(V′/H)) + H L/EA and so on with V′ = V − w L.
Here a float without length pulls sideways with H and up with V, and the cable has no drag.
"""

from __future__ import annotations

from math import asinh, hypot

import numpy as np
import pytest

from calm.physics.line import Water
from tests.validation.cables import NoContinuousSolution
from tests.validation.closing import FINE, solve_continuous
from tests.validation.continuous import March
from tests.validation.pieces import Piece, cable, line_of, point, profile, stream

EXACT = 1e-9  # a hundred times the error of a step, relative to depths and forces of 1e2 to 1e4


def test_a_rod_leans_along_the_mean_of_its_end_forces() -> None:
    body = Piece(2.0, False, -300.0, 80.0, directional=False)
    line = line_of(point(1000.0, 100.0), body, Piece(50.0, True, 0.0))
    shape = solve_continuous(line, stream(80.0, 1.5)).shape
    mean = np.array([100.0 + 80.0 / 2.0, 0.0, 0.0]) * 1.5**2 + [0.0, 0.0, 1000.0 - 150.0]
    chord = shape.top[1] - shape.bottom[1]
    assert chord == pytest.approx(2.0 * mean / np.linalg.norm(mean), abs=EXACT)


def test_a_clamp_weighs_on_a_rod_by_its_distance_from_the_lower_end() -> None:
    body = Piece(2.0, False, 0.0, directional=False, clamps=[(0.5, -200.0, 0.0, 40.0)])
    line = line_of(point(1000.0, 100.0), body, Piece(50.0, True, 0.0))
    shape = solve_continuous(line, stream(80.0, 1.0)).shape
    lever = np.array([100.0 + 0.75 * 40.0, 0.0, 1000.0 - 0.75 * 200.0])
    chord = shape.top[1] - shape.bottom[1]
    assert chord == pytest.approx(2.0 * lever / np.linalg.norm(lever), abs=EXACT)
    assert shape.clamp[0] == pytest.approx(shape.top[1] - chord / 4.0, abs=EXACT)
    assert shape.clamp_below[0] - shape.clamp_above[0] == pytest.approx([40.0, 0.0, -200.0])


def test_a_beacon_and_the_float_below_it_are_one_rod() -> None:
    beacon = Piece(1.0, False, -100.0, 30.0, directional=False)
    hull = Piece(3.0, False, 2000.0, 200.0, directional=False)
    line = line_of(beacon, hull, Piece(50.0, True, 0.0))
    shape = solve_continuous(line, stream(80.0, 1.0)).shape
    across, up = 30.0 * 0.875 + 200.0 * 0.375, -100.0 * 0.875 + 2000.0 * 0.375
    lean = np.array([across, 0.0, up]) / hypot(across, up)
    assert shape.top[0] - shape.bottom[0] == pytest.approx(lean, abs=EXACT)
    assert shape.top[1] - shape.bottom[1] == pytest.approx(3.0 * lean, abs=EXACT)


def test_a_rod_that_follows_the_current_turns_until_its_normal_drag_is_balanced() -> None:
    """A free cylinder: B sin θ = Kn V² cos² θ across its axis."""
    line = line_of(Piece(4.0, False, 500.0, 400.0), Piece(50.0, True, 0.0))
    shape = solve_continuous(line, stream(80.0, 1.2)).shape
    x, _, z = (shape.top[0] - shape.bottom[0]) / 4.0
    assert 500.0 * x == pytest.approx(400.0 * 1.2**2 * z**2, rel=EXACT)


@pytest.mark.parametrize(
    ("length", "horizontal", "vertical", "tension"),
    [
        pytest.param(520.0, 15677.747, 26291.876, 30611.346, id="suspended"),
        pytest.param(490.0, 86912.281, 77703.619, 116583.005, id="taut"),
    ],
)
def test_elastic_catenary(length, horizontal, vertical, tension) -> None:
    """Ends 400 m apart and 300 m above each other, 50 N/m, EA = 5 MN; inputs printed to 1e-3 N."""
    line = line_of(
        point(vertical, horizontal), Piece(length, True, -50.0, compliance=1.0 / 5e6)
    )  # fmt: skip
    shape = solve_continuous(line, stream(600.0, 1.0)).shape
    across, _, up = shape.top[0] - shape.bottom[-1]
    below = vertical - 50.0 * length
    angles = asinh(vertical / horizontal) - asinh(below / horizontal)
    x = horizontal / 50.0 * angles + horizontal * length / 5e6
    ends = hypot(horizontal, vertical) - hypot(horizontal, below)
    z = ends / 50.0 + (vertical + below) / 2.0 * length / 5e6
    assert (across, up) == pytest.approx((x, z), abs=600.0 * EXACT)
    assert (across, up) == pytest.approx((400.0, 300.0), abs=1e-4)
    assert np.linalg.norm(shape.force_top[1]) == pytest.approx(tension, abs=1e-3)


def test_a_line_on_the_seabed_is_a_catenary_that_starts_level() -> None:
    """The elastic catenary with V′ = 0 at the touchdown; what is left lies straight."""
    pull, weight, stiffness = 500.0, 20.0, 1e5
    chain = Piece(100.0, True, -weight, compliance=1.0 / stiffness)
    found = solve_continuous(line_of(point(5000.0, pull), chain), stream(30.0, 1.0))
    lifted = found.share[0] * 5000.0
    s, rise = lifted / weight, hypot(pull, lifted) - pull
    assert rise / weight + lifted**2 / (2.0 * weight * stiffness) == pytest.approx(30.0, abs=1e-8)
    assert found.shape.grounded == pytest.approx(100.0 - s, abs=1e-8)
    x = pull / weight * asinh(lifted / pull) + pull * s / stiffness
    lying = (100.0 - s) * (1.0 + pull / stiffness)
    assert found.shape.top[0, 0] == pytest.approx(x + lying, abs=1e-8)
    assert found.shape.force_bottom[-1] == pytest.approx([pull, 0.0, 0.0], abs=1e-8)


def test_a_float_at_the_surface_uses_what_the_line_needs() -> None:
    """61 m of water, 60 m of stretchy line: what stretches it by a metre, and its weight."""
    line = line_of(point(5000.0, 100.0), cable(60.0, 0.01, 3.0, 1.3, 0.0, 1e-5))
    solution = solve_continuous(line, stream(61.0, 0.0))
    # 61 = 60 + (T L + w L²/2)/EA, T the tension at the lower end.
    tension = 1.0 / (60.0 * 1e-5) - 3.0 * 30.0
    assert solution.surface
    assert solution.share[0] * 5000.0 == pytest.approx(tension + 180.0, rel=EXACT)


def test_density_changes_net_forces_and_drags() -> None:
    """Still water denser with depth: the tension below is the sum of what was lifted."""
    rows = np.array([0.0, 100.0])
    still = np.zeros(2)
    water = Water(100.0, rows, still, still, still, np.array([1000.0, 1050.0]), 9.81)
    line = line_of(Piece(0.0, False, 1000.0, volume=0.2), Piece(80.0, True, -5.0, volume=1e-3))
    shape = solve_continuous(line, water).shape
    # The float at 20 m: 1010 kg/m³; the line from 20 to 100 m: 1030 kg/m³ on the mean.
    lifted = 1000.0 - 15.0 * 9.81 * 0.2 + 80.0 * (-5.0 + 5.0 * 9.81 * 1e-3)
    assert shape.force_bottom[-1] == pytest.approx([0.0, 0.0, lifted], abs=1e-6)


def test_kinks_of_the_profile_are_hit() -> None:
    """Steps a hundred times finer change nothing; a kink inside a step would cost 1e-5 or more."""
    rows = [(0.0, 0.8), (37.0, -0.6), (38.0, 1.2), (240.0, 0.0), (300.0, 0.9)]
    line = line_of(point(2000.0, 80.0), cable(270.0, 0.01, 1.0, 1.3, 0.01, 1e-6))
    water, full = profile(300.0, rows), np.ones(2)
    coarse, fine = (March(line, water, t).down(20.0, full).bottom[-1] for t in (FINE, FINE / 100.0))
    assert coarse == pytest.approx(fine, abs=300.0 * EXACT)


def test_lines_that_cannot_stand_are_refused() -> None:
    heavy = line_of(point(100.0, 0.0), cable(50.0, 0.01, 3.0, 1.3, 0.0))
    with pytest.raises(NoContinuousSolution):
        solve_continuous(heavy, stream(60.0, 0.0))
    sagging = cable(50.0, 0.01, 1.0, 1.3, 0.0)
    dragged = line_of(point(60.0, 50.0), sagging, point(1.0, 0.0))
    with pytest.raises(NoContinuousSolution, match="seabed"):
        solve_continuous(dragged, stream(60.0, 2.0))


def test_friction_takes_its_share_of_the_pull_along_the_seabed() -> None:
    """T falls by μ w a metre from the touchdown on, until nothing is left; it stretches by ∫ T/EA.

    10 m of chain beyond where nothing is left lie unstretched.
    """
    pull, weight, stiffness, friction = 500.0, 20.0, 1e5, 0.5
    chain = Piece(140.0, True, -weight, compliance=1.0 / stiffness)
    line, water = line_of(point(5000.0, pull), chain), stream(30.0, 1.0)
    smooth, rough = (solve_continuous(line, water, friction=each) for each in (0.0, friction))
    grounded = smooth.shape.grounded
    assert rough.shape.grounded == pytest.approx(grounded, abs=1e-8)
    held = pull / (friction * weight)
    assert grounded is not None and grounded > held + 10.0
    shorter = (grounded - 0.5 * held) * pull / stiffness
    ends = [found.shape.top[0, 0] - found.shape.bottom[-1, 0] for found in (smooth, rough)]
    assert ends[0] - ends[1] == pytest.approx(shorter, abs=1e-8)
    assert rough.shape.force_bottom[-1] == pytest.approx([0.0, 0.0, 0.0], abs=1e-8)
