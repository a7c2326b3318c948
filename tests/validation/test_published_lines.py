"""The moored lines of `calm.verification` along their whole length, against the referee.

Their figures are held against CALM by `test_verification`; here the referee, which shares nothing
with CALM, agrees with it on the same lines. The limits are CALM's promises: depths and offsets
within 5e-5 of the water depth and tensions within 2e-4 at an angle step of 1°, 2e-6 and 1e-5 at
0.1°.
"""

from __future__ import annotations

from math import radians

import numpy as np
import pytest

from calm.solve import Settings, solve_mooring
from calm.verification import cable_papers, solved_moorings, still_water
from calm.verification.uniform_current import (
    ball_on_a_thread,
    float_on_a_rope,
    float_on_a_thread,
)
from tests.validation.agreement import difference
from tests.validation.closing import solve_continuous

ROPES = {"neutral": (0.0, 0.0), "heavy": (2.0, 0.0), "heavy and rough": (2.0, 0.01)}
LINES = {
    **{f"float on a thread, {speed} m/s": float_on_a_thread(speed) for speed in (0.5, 1.0, 1.5)},
    "ball on a thread": ball_on_a_thread(),
    **{
        f"{name} line, {speed} m/s": float_on_a_rope(*rope, speed)
        for name, rope in ROPES.items()
        for speed in (0.3, 0.5, 1.0)
    },
    "elastic hang": (still_water.HANGING_ROPE, still_water.HANGING_SEA),
    "CDMS-1": (solved_moorings.cdms_1_mooring(), solved_moorings.CDMS_1_SEA),
    "CDMS-1 with tangential drag": (
        solved_moorings.cdms_1_mooring(0.009),
        solved_moorings.CDMS_1_SEA,
    ),
    "Braconnot's buoy below the surface": cable_papers.buoy(cable_papers.BUOY_LIFT, 25.0),
    "Braconnot's buoy afloat": cable_papers.buoy(1000.0, 20.0),
}


@pytest.mark.parametrize(("line", "water"), LINES.values(), ids=LINES)
def test_calm_agrees_with_the_referee(line, water) -> None:
    referee = solve_continuous(line, water)
    for degrees, near, close in [(1.0, 5e-5, 2e-4), (0.1, 2e-6, 1e-5)]:
        solution = solve_mooring(line, water, Settings(radians(degrees), 1e-9))
        found = difference(solution, referee)
        assert found.place <= near, f"at {degrees}°"
        assert found.tension <= close, f"at {degrees}°"


@pytest.mark.parametrize("speed", [0.3, 0.5, 1.0, 1.4])
def test_referee_has_the_last_digits_of_the_neutral_line(speed) -> None:
    """cot φ = cot φ₀ + R s/T at constant T; 1e-6 m is a hundred of the referee's step errors."""
    line, water = float_on_a_rope(0.0, 0.0, speed)
    shape = solve_continuous(line, water).shape
    x, _, z = shape.top[0] - shape.bottom[-1]
    drag, resistance = line.normal_drag * speed**2
    tension, above = np.hypot(line.buoyancy[0], drag), drag / line.buoyancy[0]
    below = above + resistance * 1000.0 / tension
    across = tension / resistance * (np.hypot(1.0, below) - np.hypot(1.0, above))
    height = tension / resistance * (np.arcsinh(below) - np.arcsinh(above))
    assert x == pytest.approx(across, abs=1e-6)
    assert z == pytest.approx(height, abs=1e-6)


def test_tangential_drag_hardly_matters_to_cdms_1() -> None:
    """Berteaux's Ct of 0.009, a rough finish: no tension changes by more than 0.01 %."""
    without, rough = (
        np.linalg.norm(
            solve_continuous(
                solved_moorings.cdms_1_mooring(ct), solved_moorings.CDMS_1_SEA
            ).shape.force_bottom,
            axis=1,
        )
        for ct in (0.0, 0.009)
    )
    assert rough == pytest.approx(without, rel=1e-4)
