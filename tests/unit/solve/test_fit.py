"""Cutting a piece to fit: the top then stands where it was wanted, stretch included."""

from dataclasses import replace

import pytest

from calm.errors import NoEquilibrium
from calm.solve import Settings, fit_length, solve_mooring
from tests.unit.solve.simple import line, rigid, rope, water

PIECES = (
    rigid(1.0, 4000.0, drag=250.0),
    rope(100, weight=2.0, stiffness=1e5),
    rigid(0.8, -400.0),
    rope(0.0, weight=0.1, stiffness=5e4),
)


def test_the_top_stands_at_the_wanted_depth_in_still_water():
    uncut = line(*PIECES, anchor_height=0.5)
    length = fit_length(uncut, water(500), 3, 120.0, Settings())
    solution = solve_mooring(uncut.with_length(3, length), water(500))
    assert -solution.position[0, 2] == pytest.approx(120.0, abs=1e-7 * 500)
    # by hand: stretched 100 m at a mean 3900 N, and L of rope at 3400 N less half its weight
    upper = 100 * (1 + 3900 / 1e5)
    room = 500 - 0.5 - 120 - 1 - 0.8 - upper
    assert length * (1 + (3400 - 0.05 * length) / 5e4) == pytest.approx(room, abs=1e-4)


def test_the_current_does_not_change_the_cut():
    uncut = line(*PIECES)
    moving = water(500, (0, 1.0, 0, 0), (500, 0.1, 0, 0))
    assert fit_length(uncut, moving, 3, 120.0, Settings()) == pytest.approx(
        fit_length(uncut, water(500), 3, 120.0, Settings()), abs=1e-6
    )


def test_no_room_for_the_other_pieces():
    with pytest.raises(NoEquilibrium) as caught:
        fit_length(line(*PIECES), water(150), 3, 120.0, Settings())
    assert caught.value.status == "no-equilibrium"
    assert caught.value.piece == 3
    assert "101.80 m" in caught.value.message


def test_a_clamp_below_the_cut_is_refused():
    clamped = line(*PIECES, clamps=[(3, 390.0, -10.0, 1.0)])
    with pytest.raises(NoEquilibrium) as caught:
        fit_length(clamped, water(500), 3, 120.0, Settings())
    assert caught.value.status == "no-equilibrium"
    assert "390.00 m long down to its lowest clamp" in caught.value.message


def test_a_line_too_heavy_to_stand_says_so():
    heavy = line(rigid(1.0, 300.0), rigid(0.8, -400.0), rope(0.0, weight=0.1))
    with pytest.raises(NoEquilibrium, match="too little buoyancy"):
        fit_length(heavy, water(500), 2, 120.0, Settings())


@pytest.mark.parametrize("height", [0.0, 0.5])
def test_chain_that_lies_on_the_seabed_lengthens_nothing(height):
    uncut = line(rigid(0.8, 1500.0), rope(0.0, weight=0.5), rope(40.0, weight=70.0))
    uncut = replace(uncut, anchor_height=height)
    length = fit_length(uncut, water(200), 1, 50.0, Settings())
    # by hand: what is left of the buoyancy below the rope lifts so much chain off the seabed
    assert 0.8 + length + (1500.0 - 0.5 * length) / 70.0 == pytest.approx(150.0, abs=1e-4)
