"""Tows that cannot be: each is told with its own status and what to do."""

from dataclasses import replace
from math import inf, pi, radians

import numpy as np
import pytest

from calm.errors import NoEquilibrium
from calm.physics.line import Line, Water
from calm.physics.strumming import BourgetMarichal
from calm.solve import Settings, Towing, fit_tow_length, solve_tow
from calm.solve.problem import ROOM
from tests.unit.solve import simple

DEEP = Water(inf, [0.0], [0.0], [0.0], [0.0], [1025.0])


def line(length: float, weight: float, body: float, *, body_length: float = 0.0) -> Line:
    """A 10 mm cable of a weight per metre [N/m] above a body of a weight [N]; none of 0 N."""
    bare = body == 0.0
    n = 1 if bare else 2
    return Line(
        length=[length, body_length][:n],
        flexible=[True, False][:n],
        buoyancy=[-weight, -body][:n],
        volume=np.zeros(n),
        normal_drag=[6.7, 5.0][:n],
        tangential_drag=[0.08, 5.0][:n],
        directional=[True, False][:n],
        compliance=np.zeros(n),
        thinning=np.zeros(n),
        clamp_piece=[],
        clamp_at=[],
        clamp_buoyancy=[],
        clamp_volume=[],
        clamp_drag=[],
        diameter=[0.01, 0.0][:n],
    )


@pytest.mark.parametrize("height", [0.0, 4.0])
@pytest.mark.parametrize("speed", [2.0, 3.0, 5.0, 7.0])
def test_a_floating_line_comes_to_the_surface(height, speed):
    with pytest.raises(NoEquilibrium) as caught:
        solve_tow(line(100.0, -0.5, 5.0), DEEP, Towing(speed, 0.0, height))
    assert caught.value.status == "above-surface"
    assert "depressor" in caught.value.advice


def test_a_line_that_does_not_reach_the_water():
    with pytest.raises(NoEquilibrium, match=r"12.00 m long, does not reach .* 20 m") as caught:
        solve_tow(line(12.0, 2.5, 100.0), DEEP, Towing(1.0, 0.0, 20.0))
    assert (caught.value.status, caught.value.advice) == ("above-surface", "Pay out more line.")


def test_a_line_without_length():
    with pytest.raises(NoEquilibrium, match="no length"):
        solve_tow(line(0.0, 2.5, 100.0), DEEP, Towing(1.0, 0.0))


def test_the_seabed_is_told_with_advice_for_a_tow():
    shallow = Water(50.0, [0.0], [0.0], [0.0], [0.0], [1025.0])
    with pytest.raises(NoEquilibrium, match="seabed: piece 1") as caught:
        solve_tow(line(100.0, 2.5, 500.0), shallow, Towing(0.5, 0.0))
    assert caught.value.status == "grounded"
    assert "Pay out less line" in caught.value.advice


def test_a_fit_too_deep_already_says_so():
    deep_body = line(100.0, 2.5, 5000.0)
    clamped = Line(
        **{
            **{name: getattr(deep_body, name) for name in vars(deep_body)},
            "clamp_piece": [0],
            "clamp_at": [60.0],
            "clamp_buoyancy": [-1.0],
            "clamp_volume": [0.0],
            "clamp_drag": [0.0],
            "clamp_lift": [0.0],
            "clamp_drag_curve": (),
        }
    )
    with pytest.raises(NoEquilibrium, match=r"with 60 m paid out, the lower end is at (59|60)\."):
        fit_tow_length(clamped, DEEP, Towing(0.5, 0.0), 0, 20.0, Settings())


def test_a_ship_that_drifts_with_the_water():
    """The line hangs plumb."""
    drifting = Water(inf, [0.0], [1.0], [0.0], [0.0], [1025.0])
    solution = solve_tow(line(100.0, 2.5, 500.0), drifting, Towing(1.0, 0.0))
    assert solution.position[0] == pytest.approx([0.0, 0.0, -100.0], abs=1e-4)
    assert solution.tension[-1] == pytest.approx(750.0, rel=1e-6)


def test_an_even_current_given_at_levels_is_even():
    """The levels cut the line, so that the march is not quite as deep as it is long."""
    kn = 0.5 * 1025.0 * 0.5 * pi * 0.4**2 / 4
    wire = simple.rope(150.0, weight=2.0, diameter=0.008)
    towed = simple.line(wire, simple.rigid(0.4, -1500.0, drag=kn))
    even = solve_tow(towed, simple.water(500.0, (0, -0.2, 0, 0)), Towing(1.0, 0.0))
    for levels in ([0, 40, 90], [0, 10, 139], [0, 33, 66]):
        sea = simple.water(500.0, *((depth, -0.2, 0, 0) for depth in levels))
        solution = solve_tow(towed, sea, Towing(1.0, 0.0))
        assert solution.position[0, 2] == pytest.approx(even.position[0, 2], abs=0.01)
    assert -even.position[0, 2] == pytest.approx(139.5, abs=0.5)


@pytest.mark.parametrize("speed", [1.0, 2.5])
def test_a_line_that_leaves_the_water_in_still_air_has_a_node_at_the_surface(speed):
    """Only the density changes there: the ship makes the same wind as current."""
    a_frame = Towing(speed, 0.0, 5.3)
    solution = solve_tow(line(60.0, 4.0, 300.0), DEEP, a_frame)
    fine = solve_tow(line(60.0, 4.0, 300.0), DEEP, a_frame, Settings(radians(0.1)))
    assert solution.marched is not None
    assert np.abs(solution.marched.position[:, 2]).min() <= 1e-7 * 60.0
    assert solution.position[0] == pytest.approx(fine.position[0], abs=solution.depth_error)
    assert solution.tension[-1] == pytest.approx(fine.tension[-1], abs=solution.tension_error)


@pytest.mark.parametrize("current", [0.0, 0.7])
def test_a_line_strums_at_the_frequency_that_it_sheds_at_the_ship(current):
    """F = 0.166 |V × T|/(|T| D), of the shape that was marched."""
    sea = Water(inf, [0.0, 60.0], [0.0, 0.0], [current, 0.0], [0.0, 0.0], [1025.0, 1025.0])
    strums = replace(line(100.0, 4.0, 800.0), strumming=BourgetMarichal())
    solution = solve_tow(strums, sea, Towing(1.7, 0.0, 2.0))
    assert solution.marched is not None
    pull, past = solution.marched.force[-1], np.array([-1.7, current, 0.0])
    across = np.linalg.norm(np.cross(past, pull)) / np.linalg.norm(pull)
    assert solution.frequency == pytest.approx(0.166 * across / 0.01, rel=1e-7)


def test_a_line_of_more_segments_than_there_is_room_for_is_the_same_at_both_speeds():
    strums = replace(line(100.0, 2.5, 50.0), strumming=BourgetMarichal())
    plain, compiled = (
        solve_tow(strums, DEEP, Towing(2.0, 0.0), Settings(radians(0.02), compiled=compiled))
        for compiled in (False, True)
    )
    assert len(plain.cut) > ROOM
    assert plain.position.tobytes() == compiled.position.tobytes()
    assert plain.frequency == compiled.frequency
