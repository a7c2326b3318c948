"""Braconnot's buoy: uniform current, normal drag only, by the charts of EDF.

K = ρ Cx D V²/(2w) = 2.4, w = 5 N/m. At the buoy, 20 m above the lower end, the cable makes 75°
with the current and carries 350 N: it is 28.467 m long, its lower end lies 18.782 m upstream and
carries 250.00 N at 22.027° (read off the charts: 28.3 m, 18.5 m, 250 N, 22°).

The figures are printed to five: tolerance 1e-3 m and 0.005 N for the referee; CALM at its default
adds 5e-5 of the depth (1e-3 m) and 2e-4 of the tension (0.07 N).
"""

from __future__ import annotations

from math import cos, radians, sin

import numpy as np
import pytest

from calm.solve import solve_mooring
from tests.validation.closing import solve_continuous
from tests.validation.pieces import Piece, line_of, point, stream

DRAG, LIFT = 350.0 * cos(radians(75.0)), 350.0 * sin(radians(75.0))
CABLE = Piece(28.467, True, -5.0, normal_drag=2.4 * 5.0)


def check(free_end, lower_end, force, near: float, close: float) -> None:
    across, _, up = free_end - lower_end
    assert up == pytest.approx(20.0, abs=near)
    assert across == pytest.approx(18.782, abs=near)
    assert np.linalg.norm(force) == pytest.approx(250.0, abs=close)
    assert np.degrees(np.arctan2(force[2], force[0])) == pytest.approx(22.027, abs=close)


@pytest.mark.parametrize(("buoyancy", "depth"), [(LIFT, 25.0), (1000.0, 20.0)])
def test_referee(buoyancy, depth) -> None:
    """Below the surface with just the lift it needs, and afloat with more."""
    line = line_of(point(buoyancy, DRAG), CABLE)
    found = solve_continuous(line, stream(depth, 1.0))
    check(found.shape.top[0], found.shape.bottom[-1], found.shape.force_bottom[-1], 1e-3, 5e-3)


def test_calm_below_the_surface() -> None:
    found = solve_mooring(line_of(point(LIFT, DRAG), CABLE), stream(25.0, 1.0))
    check(found.position[0], found.position[-1], found.force[-1], 2e-3, 0.075)


def test_calm_afloat() -> None:
    found = solve_mooring(line_of(point(1000.0, DRAG), CABLE), stream(20.0, 1.0))
    check(found.position[0], found.position[-1], found.force[-1], 2e-3, 0.075)
    assert found.buoyancy_used * 1000.0 == pytest.approx(LIFT, abs=0.075)
    assert found.reserve == pytest.approx(1000.0 - LIFT, abs=0.075)
