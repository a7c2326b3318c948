"""CALM against the referee on random tows: 60 that have an equilibrium.

What a tow can be is told in `tests.validation.random_tows`. The limits are CALM's promises:
positions within 5e-5 of the line out and tensions within 2e-4 at the default angle step of 1°, 2e-6
and 1e-5 at 0.1°, in at most 60 marches but where a line strums; its forces close to 1e-6,
recomputed here. A frequency, which weighs little in them, is within 1e-4. Where the referee finds
no shape, CALM must find none either; a line that hangs in a sharp fold, or that has something half
out of the water, it may solve or refuse.
"""

from __future__ import annotations

from dataclasses import replace
from math import radians
from random import Random

import numpy as np
import pytest

from calm.errors import NoEquilibrium
from calm.solve import Settings, solve_tow
from calm.solve.search import LARGEST_MOMENT
from tests.validation.agreement import closure, difference
from tests.validation.audited import moment_of
from tests.validation.cables import Folded, NoContinuousSolution
from tests.validation.random_tows import tow
from tests.validation.towed import HalfOut, Passing, solve_continuous_tow

TOWED = 3
BLOCKS = [
    0,
    pytest.param(1, marks=pytest.mark.thorough),
    *(pytest.param(block, marks=pytest.mark.slow) for block in range(2, 20)),
]


@pytest.mark.parametrize("block", BLOCKS)
def test_calm_agrees_with_the_referee(block) -> None:
    """Three tows a block; a failure names the number that draws its tow."""
    number, towed = 1000 * block, 0
    while towed < TOWED:
        number += 1
        line, water, towing = tow(Random(number))
        try:
            referee = solve_continuous_tow(line, water, towing)
        except (Folded, HalfOut):
            continue
        except NoContinuousSolution:
            with pytest.raises(NoEquilibrium):
                pytest.fail(f"tow {number}: {solve_tow(line, water, towing).position[0]}")
            continue
        towed += 1
        for degrees, near, close in [(1.0, 5e-5, 2e-4), (0.1, 2e-6, 1e-5)]:
            case = f"tow {number} at {degrees}°"
            solution = solve_tow(line, water, towing, Settings(radians(degrees)))
            found = difference(solution, referee)
            assert found.place <= near, case
            assert found.tension <= close, case
            assert solution.frequency == pytest.approx(referee.frequency, rel=1e-4), case
            assert solution.marches <= 60 or line.strumming is not None, case
            assert closure(solution, Passing(water, towing)) <= 1e-6, case


@pytest.mark.parametrize(
    ("number", "status", "why"),
    [
        (997, "no-equilibrium", "has neither weight nor tangential drag"),
        (2942, "no-equilibrium", "fully in water or fully in air"),
        (4555, "no-equilibrium", "fully in water or fully in air"),
        (652, "no-equilibrium", "with piece 12 fully in water"),
        (2079, "no-equilibrium", "with piece 9 fully in water"),
    ],
)
def test_a_tow_without_a_shape_is_refused_by_its_reason(number, status, why) -> None:
    """The referee finds none either: no direction of a limp end, no frequency across a jump."""
    with pytest.raises(NoEquilibrium, match=why) as caught:
        solve_tow(*tow(Random(number)))
    assert caught.value.status == status


@pytest.mark.parametrize("number", [94, 117, 252])
def test_a_line_that_closes_at_the_surface_is_solved(number) -> None:
    """94 has a clamp there, 117 leaves the water at 1.5° under 0.08 N, and the march of 252 stops
    at depths above its root."""
    line, water, towing = tow(Random(number))
    usual, fine = (solve_tow(line, water, towing, Settings(radians(step))) for step in (1.0, 0.1))
    near = usual.depth_error + fine.depth_error
    assert usual.position[0] == pytest.approx(fine.position[0], abs=near)


def test_a_line_that_would_fly_from_the_surface_hangs_below_it() -> None:
    """With its free end at the surface the strumming line has no balance in the wind; the root,
    the same at finer steps, is 6 m down."""
    for degrees in (1.0, 0.5, 0.2):
        solution = solve_tow(*tow(Random(4326)), Settings(radians(degrees)))
        assert -solution.position[0, 2] == pytest.approx(6.12827, abs=1e-4)
    # at its limp end the rounding of places a tenth of a millimetre apart turns a force of 1e-8 of
    # the greatest by 5e-8; as much is a fault elsewhere, and there a thousandth is one
    assert moment_of(solution) <= LARGEST_MOMENT
    solution = solution.as_marched
    segments = np.diff(solution.position, axis=0)
    pulled = int(np.argmax(solution.tension > 0.01 * solution.tension.max()))
    for segment, angle in ((pulled, 5e-8), (len(segments) - 2, 5e-8), (2, 1e-3)):
        across = np.cross(segments[segment], [0.0, 1.0, 0.0])
        position = solution.position.copy()
        position[segment + 1 :] += angle * across
        turned = replace(solution, position=position)
        assert moment_of(turned) > LARGEST_MOMENT, segment
