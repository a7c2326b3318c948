"""A float at its draft on a line: balances done by hand, and the way under water."""

from dataclasses import replace
from math import atan2, cos, degrees, hypot, pi, sin, sqrt

import numpy as np
import pytest

from calm.errors import NoEquilibrium
from calm.physics.hull import AIR_DENSITY, Floating, cylindrical_hull, spherical_hull
from calm.solve import Settings, solve_mooring
from tests.unit.solve.simple import line, rigid, rope, water

GRAVITY = 9.80665
TIGHT = Settings(tolerance=1e-11)


def ball(diameter=1.0, weight=0.25, **floating):
    """A sphere whose weight is a share of what it displaces: its piece, and how it rides."""
    displaced = 1025.0 * GRAVITY * pi * diameter**3 / 6
    drag = 0.5 * 1025.0 * 0.5 * pi * diameter**2 / 4
    lift = (1.0 - weight) * displaced
    piece = rigid(diameter, lift, drag=drag, volume=pi * diameter**3 / 6)
    return piece, Floating(spherical_hull(diameter), weight * displaced, lift, **floating)


def moored(length, floating=None, above=(), **cable):
    """A ball on a line; `floating` gives its wind and the like."""
    piece, riding = ball(**(floating or {}))
    return replace(line(*above, piece, rope(length, **cable)), floating=riding)


def end_of_float(solution, piece=0):
    return solution.force[solution.piece_nodes[piece, 1]]


def test_what_it_displaces_is_its_weight_and_the_pull_of_the_line():
    solution = solve_mooring(moored(99.3, weight=2.0), water(100, (0, 0.6, 0, 0)))
    draft, weight = solution.riding.draft, solution.line.floating.weight
    displaced = draft**2 * (3.0 - 2.0 * draft) * 1025.0 * GRAVITY * pi / 6
    assert displaced == pytest.approx(weight + end_of_float(solution)[2], rel=1e-12)
    assert solution.riding.freeboard == pytest.approx(1.0 - draft)
    spare = solution.line.floating.lift - end_of_float(solution)[2]
    assert solution.reserve == pytest.approx(spare)


def test_on_a_taut_thread_the_forces_across_balance():
    """A thread without weight or drag is straight: what pushes the float leans the line.

    Current and wind are at right angles; the share of the ball in the water is a segment.
    """
    current, wind = 0.9, 18.0
    line_afloat = moored(99.3, {"wind": (0.0, wind)}, diameter=0.0)
    solution = solve_mooring(line_afloat, water(100, (0, current, 0, 0)), TIGHT)
    draft = solution.riding.draft
    c = 1.0 - 2.0 * draft
    wet = (np.arccos(c) - c * sqrt(1.0 - c * c)) / 4  # of a disc of diameter 1
    east = 0.5 * 1025.0 * 0.5 * wet * current**2
    north = 0.5 * AIR_DENSITY * (pi / 4 - wet) * wind**2
    up = draft**2 * (3.0 - 2.0 * draft) * 1025.0 * GRAVITY * pi / 6
    up -= solution.line.floating.weight
    assert solution.force[-1] == pytest.approx([east, north, up], rel=1e-10)
    # the ball leans along the mean of the forces at its ends, as the thread does
    lean = atan2(hypot(east, north), up)
    out = (1.0 - draft) * cos(lean)
    assert solution.position[0, 2] == pytest.approx(out, abs=1e-9)
    assert 100.3 * cos(lean) == pytest.approx(100.0 + out, abs=1e-7)
    x, y, _ = solution.position[0]
    assert hypot(x, y) == pytest.approx(100.3 * sin(lean), abs=1e-5)
    assert y / x == pytest.approx(north / east, rel=1e-9)


@pytest.mark.parametrize("density", [1000.0, 1025.0, 1100.0])
def test_a_taut_line_in_still_water_of_any_density_pulls_as_its_stretch_asks(density):
    """A rope of 100 m that must stretch by 1 m: EA strain = 50 N pull on the anchor.

    The float's share in use is that of its force in this water, which in a lake is less.
    """
    buoy = rigid(0.0, 1000.0, volume=0.5)
    taut = line(buoy, rigid(0.0, -400.0), rope(100.0, stiffness=5000.0))
    solution = solve_mooring(taut, water(101.0, density=density))
    pull = np.linalg.norm(solution.force, axis=1)
    assert pull[1] == pytest.approx(450.0, abs=0.01)  # half a cm of depth is 0.25 N
    assert pull[-1] == pytest.approx(50.0, abs=0.01)


def test_wind_alone_tilts_the_line_in_still_water():
    """A line longer than the depth has no shape at rest; wind gives it one."""
    slack = moored(101.0, {"wind": (15.0, 0.0)}, weight=0.3)
    solution = solve_mooring(slack, water(100))
    assert solution.surface
    pull = solution.marched.force[-1, 0]
    assert pull == pytest.approx(solution.carried.push_east[0], rel=1e-12)
    assert solution.force[-1, 0] == pytest.approx(pull, rel=1e-7)
    assert solution.force[-1, 0] > 0
    with pytest.raises(NoEquilibrium) as caught:
        solve_mooring(moored(101.0, weight=0.3), water(100))
    assert caught.value.status == "slack"


def test_a_drag_afloat_takes_the_place_of_that_of_the_immersed_part():
    solution = solve_mooring(
        moored(99.3, {"surface_drag": 0.4}, diameter=0.0), water(100, (0, 1.2, 0, 0)), TIGHT
    )
    assert solution.buoyancy_used < 0.98
    drag = 0.5 * 1025.0 * 0.5 * pi / 4
    assert solution.force[-1, 0] == pytest.approx(0.4 * drag * 1.44, rel=1e-12)


def test_without_a_hull_it_is_as_ever():
    """`full`: just below the surface, all of its drag, no wind."""
    piece, _ = ball()
    thread = line(piece, rope(99.3, diameter=0.0))
    solution = solve_mooring(thread, water(100, (0, 0.8, 0, 0)), TIGHT)
    assert solution.riding is None
    assert solution.position[0, 2] == 0
    assert solution.force[-1, 0] == pytest.approx(0.5 * 1025.0 * 0.5 * pi / 4 * 0.64, rel=1e-12)


def test_what_stands_on_the_float_is_out_of_the_water():
    """A light weighs its full weight there, and the current does not reach it."""
    light = rigid(1.5, -60.0, drag=40.0, volume=0.01)
    lit = moored(99.3, above=[light], diameter=0.0)
    clamped = replace(
        lit, clamp_piece=np.array([0]), clamp_at=np.array([0.5]), clamp_buoyancy=np.array([-5.0]),
        clamp_volume=np.array([0.002]), clamp_drag=np.array([9.0]), clamp_lift=np.array([0.0]),
    )  # fmt: skip
    solution = solve_mooring(clamped, water(100, (0, 0.7, 0, 0), density=1010.0), TIGHT)
    above = solution.piece_nodes[0, 1]
    weight = 65.0 + 1025.0 * GRAVITY * 0.012
    assert solution.force[above] == pytest.approx([0.0, 0.0, -weight], rel=1e-12)
    height = solution.position[0, 2]
    axis = (solution.position[0, 2] - solution.position[above, 2]) / 1.5
    assert height == pytest.approx((1.5 + solution.riding.freeboard) * axis, abs=1e-9)


def test_several_floats_at_the_surface_are_taken_as_just_below_it():
    """The second float comes up only where its own top is at the surface."""
    piece, riding = ball()
    second = rigid(1.0, 6000.0, drag=300.0)
    both = line(piece, rope(60, weight=20), second, rope(108, weight=1.0))
    current = water(100, (0, 0.5, 0, 0))
    afloat = solve_mooring(replace(both, floating=replace(riding, wind=(9.0, 4.0))), current)
    as_ever = solve_mooring(both, current)
    assert afloat.afloat == (0, 2)
    assert afloat.riding is None
    assert (afloat.position == as_ever.position).all()


LINES = {
    "taut": (dict(length=99.0, diameter=0.005, stiffness=2e5), 1.15, 1.55),
    "slack": (dict(length=110.0, diameter=0.01), 1.6, 2.0),
    "slack, thin": (dict(length=110.0, diameter=0.002), 2.5, 2.9),
}
MORE = {
    "nothing": {},
    "wind": {"wind": (20.0, 10.0)},
    "wind against": {"wind": (-20.0, 5.0)},
    "wind area": {"wind": (20.0, 10.0), "wind_area": 1.0},
    "more drag afloat": {"surface_drag": 1.5},
    "less drag afloat": {"surface_drag": 0.5},
}


def swept(afloat, slowest, fastest, count=41):
    """Solutions in ever faster currents, from afloat to under water."""
    speeds = np.linspace(slowest, fastest, count)
    solutions = [solve_mooring(afloat, water(100, (0, speed, 0, 0))) for speed in speeds]
    assert solutions[0].surface
    return solutions


def steps(solutions):
    """Greatest fall of the free end [m] and relative change of tension from one to the next."""
    depth = np.array([-s.position[0, 2] for s in solutions])
    tension = np.array([s.tension[-1] for s in solutions])
    return np.diff(depth).max(), np.abs(np.diff(np.log(tension))).max()


@pytest.mark.parametrize("cable", LINES)
@pytest.mark.parametrize("more", MORE)
def test_the_way_under_water_is_found_all_along(cable, more):
    """No refusal, no leap back; where it leaps down the other shape was told of before.

    A float is dragged under in a leap where that brings it more drag than buoyancy: by a given
    drag afloat that is less than below, a little by the last of a sphere's cap.
    """
    figures, slowest, fastest = LINES[cable]
    solutions = swept(moored(floating=MORE[more], weight=0.5, **figures), slowest, fastest)
    depth = np.array([-s.position[0, 2] for s in solutions])
    assert (np.diff(depth) > -1e-3).all()
    fall, change = steps(solutions)
    if more != "less drag afloat":
        assert fall <= 0.25  # a quarter of the ball, in steps of 0.01 m/s
        assert change <= 0.05
        return
    assert any(s.other is not None for s in solutions)
    leaps = np.flatnonzero(np.diff(depth) > 0.25)
    assert len(leaps) <= 1
    for before, after in ((solutions[i], solutions[i + 1]) for i in leaps):
        assert before.surface and not after.surface
        assert before.other.depth == pytest.approx(-after.position[0, 2], abs=0.3)


def test_a_light_goes_under_with_its_float():
    light = rigid(1.0, -100.0, drag=5.0, volume=0.002)
    solutions = swept(moored(99.0, above=[light], weight=0.5, stiffness=2e5), 1.0, 1.4)
    assert not solutions[-1].surface
    fall, change = steps(solutions)
    assert fall <= 0.25
    assert change <= 0.05


def test_a_spar_is_pulled_under_without_a_leap():
    """Its drag grows no faster than its buoyancy: there is one equilibrium in every current."""
    spar = rigid(3.0, 4000.0, drag=400.0, directional=True, volume=0.55)
    riding = Floating(cylindrical_hull(0.48, 3.0), 1025.0 * GRAVITY * 0.55 - 4000.0, 4000.0)
    solutions = swept(replace(line(spar, rope(98.0, weight=0.5)), floating=riding), 0.8, 1.2)
    assert not solutions[-1].surface
    assert all(s.other is None for s in solutions)
    fall, change = steps(solutions)
    assert fall <= 0.12  # in steps of 0.01 m/s
    assert change <= 0.03


def test_the_offset_of_a_slack_line_does_not_leap_with_a_breath_of_wind():
    """Ever less wind leaves the float nearer to the watch circle it has at rest."""
    radii = []
    for wind in (8.0, 4.0, 2.0):
        solution = solve_mooring(moored(108.0, {"wind": (wind, 0.0)}, weight=0.3), water(100))
        radii.append(float(np.hypot(*solution.position[0, :2])))
        assert degrees(atan2(solution.force[-1, 0], abs(solution.force[-1, 2]) + 1e-9)) > 0
    assert radii[0] > radii[1] > radii[2] > 0
    assert radii[0] < sqrt(109.0**2 - 99.0**2)


def test_a_rope_without_weight_where_the_current_begins_below_the_surface():
    """Nothing pulls its upper end where none of the float's buoyancy is in use."""
    moored = line(rigid(1.0, 3000.0, drag=100.0), rope(120.0, ct=0.01))
    solution = solve_mooring(moored, water(100.0, (0, 0, 0, 0), (100, 0.3, 0, 0)))
    assert solution.riding is not None or solution.afloat == (0,)
    assert solution.position[0, 2] == pytest.approx(0.0, abs=0.01)
    assert solution.closure < 1e-6
