"""A line whose lower part lies on the seabed."""

from dataclasses import replace
from math import asinh, radians, sqrt

import numpy as np
import pytest

from calm.errors import NoEquilibrium
from calm.files.definition import STANDARD_GRAVITY
from calm.solve import Settings, solve_mooring
from tests.unit.solve.simple import line, rigid, rope, water

FLOAT = rigid(1.0, 5000.0, drag=250.0)
CHAIN = rope(60, weight=60, stiffness=1e7)
CURRENT = (0, 0.5, 0.2, 0)


def landed(*args, **settings):
    solution = solve_mooring(*args, Settings(**settings))
    assert solution.landed
    assert solution.closure <= 1e-9
    assert solution.moment_residual <= 1e-8
    return solution


def test_touchdown_of_an_elastic_catenary():
    """Fairlead at (5.3, 2.65) m, L 6.98 m, w 1.036 N/m, EA 560 kN: H 0.763277, V 3.424639 N,
    3.674364 m on the bed. A surface float whose drag is H must find V and the same place.

    Tolerance: the printed digits, and the error of segments of 0.05°.
    """
    pull = rigid(0.0, 10.0, drag=0.763277)
    rest = rope(6.98, weight=1.036, cn=0, stiffness=560e3)
    solution = landed(line(pull, rest), water(2.65, (0, 1, 0, 0)), angle_step=radians(0.05))
    assert solution.surface
    assert 10.0 * solution.buoyancy_used == pytest.approx(3.424639, abs=2e-6)
    assert solution.position[0, 0] == pytest.approx(5.3, abs=2e-6)
    assert solution.grounded_length == pytest.approx(3.674364, abs=2e-6)


def test_a_chain_hangs_from_a_float_pulled_by_the_current():
    """No drag but the float's: H and V are known, and the chain is a catenary to its touchdown."""
    bare = rope(100, weight=60, cn=0)
    solution = landed(line(FLOAT, bare), water(70, CURRENT), angle_step=radians(0.2))
    speed = sqrt(0.29)
    pull, up = 250 * speed * speed, solution.force[1, 2]
    height, out = 69.0, np.hypot(*solution.position[1, :2])
    assert solution.surface
    assert up == pytest.approx(60 * sqrt(height**2 + 2 * height * pull / 60), rel=1e-5)
    lying = 100 - up / 60
    assert solution.grounded_length == pytest.approx(lying, abs=1e-3)
    assert out == pytest.approx(lying + pull / 60 * asinh(up / pull), rel=1e-5)


def test_the_part_on_the_seabed_lies_along_the_pull_and_friction_eats_it():
    free = landed(line(FLOAT, rope(40, weight=0.5), CHAIN), water(70, CURRENT))
    held = landed(
        line(FLOAT, rope(40, weight=0.5), CHAIN), water(70, CURRENT), seabed_friction=0.05
    )
    lying = free.position[free.hanging :]
    assert lying[:, 2] == pytest.approx(-70, abs=1e-5)
    along = lying[0] - lying[-1]
    assert np.cross(along, free.force[-1])[2] == pytest.approx(0, abs=1e-6)
    assert free.force[-1, 2] == held.force[-1, 2] == 0
    weight = 60 * held.grounded_length
    assert held.tension[-1] == pytest.approx(free.tension[-1] - 0.05 * weight, abs=1e-3)
    much = landed(line(FLOAT, rope(40, weight=0.5), CHAIN), water(70, CURRENT), seabed_friction=0.6)
    assert much.tension[-1] == 0


@pytest.mark.parametrize("density", [1000.0, 1025.0, 1200.0])
def test_what_lies_weighs_by_the_density_of_its_water(density):
    """60 N/m in water of 1025 kg/m³ and 8 litres per metre, a clamp of 300 N and 10 litres: with
    friction the tension falls by 0.05 of the weight in the water that is there.
    """
    chain = (*CHAIN[:3], 8e-3, *CHAIN[4:])
    pieces = line(FLOAT, rope(40, weight=0.5), chain, clamps=[(2, 50.0, -300.0, 0.0)])
    pieces = replace(pieces, clamp_volume=np.array([0.01]))
    current = water(70, CURRENT, density=density)
    solution = landed(pieces, current, seabed_friction=0.05)
    per_metre, clamp = (
        weight - (density - 1025.0) * STANDARD_GRAVITY * volume
        for weight, volume in ((60.0, 8e-3), (300.0, 0.01))
    )
    first, last = solution.hanging, len(solution.tension) - 1
    weight = per_metre * solution.grounded_length + clamp
    assert solution.tension[last] == pytest.approx(
        np.hypot(*solution.force[first, :2]) - 0.05 * weight, abs=1e-3
    )


def test_a_heavy_piece_stands_on_the_seabed():
    """What the line cannot carry of it the seabed does; beyond it the line only pulls sideways."""
    shallow = water(40, CURRENT)
    solution = landed(line(FLOAT, rope(38.2, weight=0.5), rigid(1, -6000), CHAIN), shallow)
    foot = solution.piece_nodes[2, 1]
    assert solution.position[foot, 2] == pytest.approx(-40, abs=1e-5)
    assert solution.force[foot, 2] == 0
    assert solution.grounded_length == 60


def test_a_piece_too_heavy_to_be_tipped_up_lies_flat():
    """The line has less than half its weight to give at its top end: it lies all along."""
    pieces = rope(40, weight=30, cn=0.1), rigid(3.0, -9000.0), rope(30, weight=20)
    solution = landed(line(FLOAT, *pieces), water(39, CURRENT))
    first, last = solution.piece_nodes[2]
    assert 0 <= solution.force[first, 2] < 4500
    assert solution.position[[first, last], 2] == pytest.approx([-39, -39], abs=1e-5)
    assert solution.grounded_length >= 33


def test_a_clamp_on_the_seabed():
    clamps = [(2, 50.0, -30.0, 3.0), (1, 20.0, -30.0, 3.0)]
    solution = landed(line(FLOAT, rope(40, 0.5), CHAIN, clamps=clamps), water(70, CURRENT))
    on_chain = int(np.flatnonzero(solution.element_clamp == 0)[0])
    assert on_chain > solution.hanging
    assert solution.position[on_chain, 2] == pytest.approx(-70, abs=1e-5)
    distance = np.linalg.norm(solution.position[on_chain] - solution.position[-1])
    assert distance == pytest.approx(10, rel=1e-4)


def test_a_sub_surface_float_lifts_the_chain_it_can():
    """5000 N less 20 N of rope are 83 m of chain at 60 N/m; the rest lies in still water."""
    solution = landed(line(FLOAT, rope(40, 0.5), rope(200, weight=60)), water(300))
    assert solution.grounded_length == pytest.approx(200 - 83)
    assert -solution.position[0, 2] == pytest.approx(300 - 1 - 40 - 83, abs=1e-5)
    assert np.hypot(*solution.position[0, :2]) == pytest.approx(117)


def test_a_barely_slack_line_hangs_between_the_seabed_and_the_top_of_its_anchor():
    slack = line(FLOAT, rope(69.2, weight=20, cn=0.2), anchor_height=2.0)
    solution = solve_mooring(slack, water(70, CURRENT))
    assert not solution.landed
    assert solution.position[-1, 2] == pytest.approx(-68, abs=1e-5)


def test_a_line_that_lies_at_rest_lies_until_the_current_has_lifted_it():
    """Near the end it could hang between the seabed and the top of its anchor, too."""
    slack = line(FLOAT, rope(60, weight=1), rope(20, weight=60), anchor_height=1.0)
    speeds = np.linspace(0.2, 2.0, 37)
    solutions = [solve_mooring(slack, water(70, (0, speed, 0, 0))) for speed in speeds]
    lying = np.array([solution.grounded_length for solution in solutions])
    assert solutions[0].landed
    assert not solutions[-1].landed
    assert (np.diff(lying) <= 1e-6).all()
    offset = np.array([solution.position[0, 0] for solution in solutions])
    assert (np.diff(offset) > 0).all()


@pytest.mark.parametrize(
    ("length", "anchor_height", "lies"), [(78.0, 2.0, False), (80.0, 2.0, True), (74.4, 0.2, True)]
)
def test_what_has_barely_landed_hangs_instead(length, anchor_height, lies):
    """Up to four heights of its anchor on the seabed a line is tried hanging first.

    With 4.66 m there it hangs, below the limit of 8 m; with 6.66 m nothing hangs clear of the
    seabed; and with 1.06 m, above the limit of 0.8 m, it lies though it could hang.
    """
    slack = line(FLOAT, rope(length, weight=20, cn=0.2), anchor_height=anchor_height)
    solution = solve_mooring(slack, water(70, CURRENT))
    assert solution.landed is lies
    assert solution.grounded_length == pytest.approx(
        {80.0: 6.66, 74.4: 1.06}.get(length, 0.0), abs=0.01
    )


def test_only_what_the_pull_reaches_into_is_stretched_on_the_seabed():
    """Friction μw holds a pull H back within H/μw of the touchdown, of which H²/(2 μ w EA) is
    stretch; the rest of the chain lies as long as it is."""
    solution = landed(
        line(FLOAT, rope(40, weight=0.5), CHAIN), water(70, CURRENT), seabed_friction=0.6
    )
    pull = np.linalg.norm(solution.marched.force[solution.hanging])
    cut = solution.cut[solution.hanging :]
    assert pull / (0.6 * 60) < 0.5 * solution.grounded_length
    stretch = solution.strain[solution.hanging :] @ cut
    assert stretch == pytest.approx(pull**2 / (2 * 0.6 * 60 * 1e7), rel=1e-9)


@pytest.mark.parametrize(("depth", "doubted"), [(55.0, False), (50.0, True)])
def test_a_line_too_long_for_its_water_says_so(depth, doubted):
    """Of 102 m of line a weight in the middle touches the seabed, for want of water."""
    long = line(rigid(1.0, 5000.0, drag=250.0), rope(60, 6), rigid(1.0, -300.0), rope(40, -1))
    with pytest.raises(NoEquilibrium, match="touch the seabed") as refused:
        solve_mooring(long, water(depth, CURRENT))
    said = str(refused.value)
    assert "The line is 102.0 m long: its float would reach the surface." in said
    assert (f"The water is {depth:.1f} m deep: check `depth`" in said) is doubted
