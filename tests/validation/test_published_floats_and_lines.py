"""A float on a thread, a neutral line, a heavy line: cases with exact or closely computed answers.

C1  Float of 1 m on 100 m of line without weight or drag: tan θ = D/B, T = √(B² + D²).
C2  Ball on a thread, the check of the R package *mooring* (D. Kelley), water of 1027 kg/m³.
C3  The same float on 1000 m of neutral line, 12.7 mm, Cn = 1.3, no tangential drag: T is constant,
    the shape a catenary on its side, cot φ = cot φ₀ + R s/T.
C4  C3 with a weight of 2 N/m: T_top − T_bottom = w z exactly; the rest by quadrature of
    T' = w sin φ, T φ' = w cos φ − R sin² φ (Pode's equations with f = 0).
C5  C4 with Ct = 0.01 on the surface π D, law |Vt| Vt: tells the sign of the tangential drag.

All with ρ = 1025 kg/m³, g = 9.81 m/s². Figures are printed to seven digits or more and are held to
1e-6 of the length and of the tension. CALM is there at an angle step of 0.1° (4e-8), its error
being of second order; at the default of 1° it
owes 5e-5 of the water depth and 2e-4 of the tension.
"""

from __future__ import annotations

from math import radians

import numpy as np
import pytest

from calm.physics.line import Line, Water
from calm.solve import Settings, solve_mooring
from tests.validation.closing import solve_continuous
from tests.validation.pieces import Piece, cable, line_of, point, sphere_drag, stream

Ends = tuple[np.ndarray, np.ndarray]
"""Position of the free end above the lower end, force above at the lower end."""


def referee(line: Line, water: Water) -> Ends:
    shape = solve_continuous(line, water).shape
    return shape.top[0] - shape.bottom[-1], shape.force_bottom[-1]


def calm_at(degrees: float):
    def ends(line: Line, water: Water) -> Ends:
        solution = solve_mooring(line, water, Settings(radians(degrees), 1e-9))
        return solution.position[0] - solution.position[-1], solution.force[-1]

    return ends


# Length as a share of the line's, tension as a share of itself.
SOLVERS = [
    pytest.param(referee, 1e-6, 1e-6, id="referee"),
    pytest.param(calm_at(0.1), 1e-6, 1e-6, id="calm, fine"),
    pytest.param(calm_at(1.0), 5e-5, 2e-4, id="calm, default"),
]
solvers = pytest.mark.parametrize(("solve", "near", "close"), SOLVERS)

FLOAT = point(4905.0, sphere_drag(1.0, 0.65))


def rope(weight: float, ct: float) -> Line:
    return line_of(FLOAT, cable(1000.0, 0.0127, weight, 1.3, ct))


@solvers
@pytest.mark.parametrize(
    ("speed", "drag", "tension", "angle", "offset", "drop"),
    [
        (0.5, 65.4089, 4905.4361, 0.76400, 1.33340, 0.00889),
        (1.0, 261.6358, 4911.9730, 3.05330, 5.32649, 0.14196),
        (1.5, 588.6805, 4940.1994, 6.84370, 11.91613, 0.71251),
    ],
)
def test_c1_float_on_a_massless_line(
    solve, near, close, speed, drag, tension, angle, offset, drop
) -> None:
    line = line_of(FLOAT, Piece(100.0, True, 0.0))
    (x, _, z), force = solve(line, stream(110.0, speed))
    assert x == pytest.approx(offset, abs=100.0 * near)
    assert 100.0 - z == pytest.approx(drop, abs=100.0 * near)
    # One rod is exact whatever the angle step; the figures are printed to 1e-4 N.
    assert force[0] == pytest.approx(drag, abs=1e-4)
    assert np.linalg.norm(force) == pytest.approx(tension, abs=1e-4)
    assert np.degrees(np.arctan2(x, z)) == pytest.approx(angle, abs=1e-5)


@solvers
def test_c2_ball_on_a_thread(solve, near, close) -> None:
    ball = point(0.337612, sphere_drag(0.04, 1.0))
    line = line_of(ball, Piece(0.5, True, 0.0))
    (x, _, z), force = solve(line, stream(1.0, 0.5, density=1027.0))
    # Printed to 1e-6.
    assert force[0] == pytest.approx(0.161321, abs=1e-6)
    assert np.linalg.norm(force) == pytest.approx(0.374174, abs=1e-6)
    assert x == pytest.approx(0.215569, abs=1e-6)
    assert 0.5 - z == pytest.approx(0.048857, abs=1e-6)
    assert np.degrees(np.arctan2(x, z)) == pytest.approx(25.5398, abs=1e-4)


@solvers
@pytest.mark.parametrize(
    ("speed", "tension", "angle", "offset", "knockdown", "horizontal", "vertical"),
    [
        (0.3, 4905.05652, 9.09326, 81.90536, 4.35144, 775.2048, 4843.4117),
        (0.5, 4905.43610, 23.96800, 218.62256, 31.25006, 1992.7172, 4482.4526),
        (1.0, 4911.97295, 60.61696, 601.82678, 253.81368, 4280.0921, 2410.0395),
    ],
)
def test_c3_neutral_line(
    solve, near, close, speed, tension, angle, offset, knockdown, horizontal, vertical
) -> None:
    (x, _, z), force = solve(rope(0.0, 0.0), stream(1010.0, speed))
    assert x == pytest.approx(offset, abs=1000.0 * near)
    assert 1000.0 - z == pytest.approx(knockdown, abs=1000.0 * near)
    assert np.linalg.norm(force) == pytest.approx(tension, rel=close)
    assert force[0] == pytest.approx(horizontal, abs=close * tension)
    assert force[2] == pytest.approx(vertical, abs=close * tension)
    assert np.degrees(np.arctan2(force[0], force[2])) == pytest.approx(angle, abs=60.0 * close)


@pytest.mark.parametrize("speed", [0.3, 0.5, 1.0, 1.4])
def test_c3_closed_form_to_the_last_digits(speed) -> None:
    """The referee against the closed form itself; 1e-9 is a hundred of its steps' errors."""
    line = rope(0.0, 0.0)
    (x, _, z), _ = referee(line, stream(1010.0, speed))
    drag, resistance = FLOAT.normal_drag * speed**2, float(line.normal_drag[1]) * speed**2
    tension, above = np.hypot(FLOAT.buoyancy, drag), drag / FLOAT.buoyancy
    below = above + resistance * 1000.0 / tension
    across = tension / resistance * (np.hypot(1.0, below) - np.hypot(1.0, above))
    height = tension / resistance * (np.arcsinh(below) - np.arcsinh(above))
    assert x == pytest.approx(across, abs=1e-6)
    assert z == pytest.approx(height, abs=1e-6)


@solvers
@pytest.mark.parametrize(
    ("ct", "speed", "tension", "angle", "offset", "height"),
    [
        pytest.param(0.0, 0.3, 2923.34451, 15.16163, 112.91905, 1000.0 - 9.14400, id="C4-0.3"),
        pytest.param(0.0, 0.5, 3026.41812, 37.45139, 288.75562, 1000.0 - 60.49101, id="C4-0.5"),
        pytest.param(0.0, 1.0, 3617.23106, 75.74447, 671.31955, 1000.0 - 352.62905, id="C4-1.0"),
        pytest.param(0.01, 0.3, 2923.67728, 15.16114, 112.91781, 990.85628, id="C5-0.3"),
        pytest.param(0.01, 0.5, 3032.17770, 37.43331, 288.70951, 939.53639, id="C5-0.5"),
        pytest.param(0.01, 1.0, 3720.85012, 75.41155, 670.62132, 648.89038, id="C5-1.0"),
    ],
)
def test_c4_and_c5_heavy_line(
    solve, near, close, ct, speed, tension, angle, offset, height
) -> None:
    (x, _, z), force = solve(rope(2.0, ct), stream(1010.0, speed))
    assert x == pytest.approx(offset, abs=1000.0 * near)
    assert z == pytest.approx(height, abs=1000.0 * near)
    assert np.linalg.norm(force) == pytest.approx(tension, rel=close)
    assert np.degrees(np.arctan2(force[0], force[2])) == pytest.approx(angle, abs=60.0 * close)


@solvers
@pytest.mark.parametrize("speed", [0.3, 0.5, 1.0])
def test_c4_tension_falls_by_the_weight_of_the_height(solve, near, close, speed) -> None:
    (_, _, z), force = solve(rope(2.0, 0.0), stream(1010.0, speed))
    top = np.hypot(FLOAT.buoyancy, FLOAT.normal_drag * speed**2)
    assert top - np.linalg.norm(force) == pytest.approx(2.0 * z, rel=close)
