"""Drag that goes with the Reynolds number, and ropes that stretch by a table.

Closed forms first; then CALM against the referee on random moorings whose rigid pieces and clamps
are smooth spheres and cylinders, and whose ropes stretch by tables.
"""

from __future__ import annotations

from dataclasses import replace
from math import exp, log, pi
from random import Random

import numpy as np
import pytest
from hypothesis import assume, given, settings

from calm.errors import NoEquilibrium
from calm.physics.line import Line
from calm.physics.reynolds import DragCurve
from calm.physics.stretch import ElongationCurve
from calm.solve import Settings, Solution, solve_mooring
from calm.solve.search import LARGEST_CLOSURE, LARGEST_MOMENT
from tests.property.strategies import draws, mooring
from tests.validation.agreement import closure, difference
from tests.validation.audited import closure_of, moment_of
from tests.validation.cables import Folded, NoContinuousSolution
from tests.validation.closing import solve_continuous
from tests.validation.pieces import Piece, cable, line_of, point, sphere_drag, stream
from tests.validation.ropes import strain_law

# braided nylon that stiffens: load over breaking load, strain
TABLE = ((0.02, 0.035), (0.05, 0.06), (0.1, 0.09), (0.2, 0.13), (0.4, 0.18))
TIGHT = Settings(tolerance=1e-9)


@pytest.mark.parametrize("permanent", [0.0, 0.05])
@pytest.mark.parametrize("load", [60.0, 900.0, 5000.0, 14_000.0])
def test_a_hanging_rope_is_as_long_as_the_integral_of_its_strain(load, permanent) -> None:
    """In still water T(s) = load + w s from below: L + ∫ ε(T(s)) ds, slack or beyond the table.

    The segments' two Gauss points are exact but where a point of the table lies inside one: what
    that costs, the bend of the curve there times the cube of the segment, stays below 1e-7 of L.
    """
    length, weight = 400.0, 3.0
    curve = ElongationCurve(TABLE, 30e3, permanent)
    rope = Piece(length, True, -weight)
    line = line_of(point(load + weight * length, 0.0), rope)
    line = replace(line, elongation=(None, curve))
    solution = solve_mooring(line, stream(700.0, 0.0), TIGHT)
    law = strain_law(line, 1)
    s = length * (np.arange(4000) + 0.5) / 4000
    strain = np.mean([law(load + weight * up) for up in s])
    assert solution.position[0, 2] + 700.0 == pytest.approx(
        length * (1.0 + strain), abs=1e-7 * length
    )
    assert solution.tension[-1] == pytest.approx(load, rel=1e-12)


@pytest.mark.parametrize(
    ("reynolds", "cx"),
    # printed of Morrison's formula, to the digit
    [(1e3, 0.4838), (1e4, 0.3926), (1e5, 0.4257), (2e5, 0.4159), (3e5, 0.1734), (4e5, 0.0930),
     (1e6, 0.1296)],
)  # fmt: skip
def test_a_smooth_sphere_leans_by_the_drag_of_its_reynolds_number(reynolds, cx) -> None:
    """On a weightless thread, through the drag crisis: tan θ = ½ρ Cx πD²/4 V²/B."""
    diameter, buoyancy, viscosity = 0.6, 800.0, 1.19e-6
    k = sphere_drag(diameter, 0.5)
    float_ = Piece(0.0, False, buoyancy, k, k, directional=False)
    line = line_of(float_, Piece(50.0, True, 0.0))
    line = replace(line, drag_curve=(DragCurve(diameter), None))
    speed = reynolds * viscosity / diameter
    water = replace(stream(100.0, speed), viscosity=np.array([viscosity]))
    solution = solve_mooring(line, water, TIGHT)
    x, _, z = solution.position[0] - solution.position[-1]
    drag = 512.5 * cx * pi / 4.0 * diameter**2 * speed**2
    assert x / z == pytest.approx(drag / buoyancy, rel=0.51e-4 / cx)


def test_a_smooth_cylinder_leans_until_its_own_flow_across_agrees() -> None:
    """Free in 1.6 m/s: B sin θ = Kn f(V cos θ) V² cos²θ, in the drag crisis and leaning into it."""
    curve, kn, speed = DragCurve(0.4, 5.0), 512.5 * 1.2 * 0.62 * 0.4 * 2.0, 1.6
    line = line_of(Piece(2.0, False, 500.0, kn), Piece(50.0, True, 0.0))
    line = replace(line, drag_curve=(curve, None))
    solution = solve_mooring(line, stream(80.0, speed), TIGHT)
    nodes = solution.piece_nodes[0]
    x, _, z = (solution.position[nodes[0]] - solution.position[nodes[1]]) / 2.0
    reynolds = speed * z * 0.4 / 1.36e-6
    assert 2.5e5 < reynolds < 4e5
    # Cn 1.2 κ by DNV above the crisis' onset, joined over log Re; κ 0.62 becomes 0.80
    points = [(2.72e5, 1.17), (2.97e5, 1.11), (3.25e5, 1.01), (3.62e5, 0.894), (4.10e5, 0.709)]
    table, cn = np.array(points).T
    across = 512.5 * 0.80 * 0.8 * np.interp(log(reynolds), np.log(table), cn)
    assert 500.0 * x == pytest.approx(across * (speed * z) ** 2, rel=1e-9)


def test_viscosity_counts_where_the_drag_acts() -> None:
    """The same sphere in the same current: warm above, where its Re is beyond the crisis."""
    k = sphere_drag(0.6, 0.5)
    leans = []
    for length in (20.0, 80.0):
        line = line_of(Piece(0.0, False, 800.0, k, k, directional=False), Piece(length, True, 0.0))
        line = replace(line, drag_curve=(DragCurve(0.6), None))
        water = replace(
            stream(100.0, 0.6), viscosity_level=np.array([0.0, 50.0, 60.0]),
            viscosity=np.array([0.9e-6, 0.9e-6, 1.7e-6]),
        )  # fmt: skip
        solution = solve_mooring(line, water, TIGHT)
        x, _, z = solution.position[0] - solution.position[-1]
        leans.append(x / z)
    deep, shallow = leans
    assert deep / shallow > 2.0


@settings(max_examples=25)
@given(draws)
def test_a_table_on_a_straight_line_is_a_stiffness(number) -> None:
    """Whatever the mooring: rounding alone may differ, and where the search for the root stops."""
    line, water = mooring(Random(number))
    assume((line.compliance[line.flexible] > 0.0).any())
    straight = tuple(
        ElongationCurve([(0.1, 2e3 * c), (0.5, 1e4 * c), (1.0, 2e4 * c)], 2e4) if c > 0.0 else None
        for c in line.compliance
    )
    try:
        by_stiffness = solve_mooring(line, water, TIGHT)
    except NoEquilibrium:
        assume(False)
    by_table = solve_mooring(replace(line, elongation=straight), water, TIGHT)
    assume(by_table.segments == by_stiffness.segments)
    assert np.abs(by_table.position - by_stiffness.position).max() <= 1e-7 * water.depth
    assert by_table.tension == pytest.approx(
        by_stiffness.tension, abs=1e-7 * float(by_stiffness.tension.max())
    )


def curved(line: Line, random: Random) -> Line:
    """The line with smooth pieces and clamps, and tables in place of stiffnesses."""

    def smooth(cylinder: bool) -> DragCurve | None:
        if random.random() < 0.3:
            return None
        diameter = exp(random.uniform(log(0.05), log(1.5)))
        return DragCurve(diameter, random.uniform(0.5, 30.0) if cylinder else None)

    def table(compliance: float) -> ElongationCurve | None:
        if compliance == 0.0 or random.random() < 0.2:
            return None
        strain = random.uniform(0.01, 0.2)
        shape = [(0.05, 0.3 * strain), (0.15, 0.6 * strain), (0.5, strain)]
        permanent = random.choice([0.0, 0.04])
        return ElongationCurve(shape, 2.0 * strain / compliance, permanent)

    return replace(
        line,
        drag_curve=tuple(
            None if flexible else smooth(bool(directional))
            for flexible, directional in zip(line.flexible, line.directional, strict=True)
        ),
        clamp_drag_curve=tuple(smooth(True) for _ in line.clamp_at),
        elongation=tuple(table(float(c)) for c in line.compliance),
    )


STANDING = 3
BLOCKS = [
    0,
    *(pytest.param(block, marks=pytest.mark.thorough) for block in (1, 2)),
    *(pytest.param(block, marks=pytest.mark.slow) for block in range(3, 14)),
]


@pytest.mark.parametrize("block", BLOCKS)
def test_calm_agrees_with_the_referee(block) -> None:
    """The promises of `test_random_moorings`, kept with curves."""
    number, standing = 50_000 + 1000 * block, 0
    while standing < STANDING:
        number += 1
        line, water = mooring(Random(number))
        line = curved(line, Random(number))
        try:
            referee = solve_continuous(line, water)
        except (Folded, NoContinuousSolution):
            continue
        standing += 1
        for degrees, near, close in [(1.0, 5e-5, 2e-4), (0.1, 2e-6, 1e-5)]:
            case = f"mooring {number} at {degrees}°"
            solution = solve_mooring(line, water, Settings(np.radians(degrees)))
            found = difference(solution, referee)
            assert found.place <= near, case
            assert found.tension <= close, case
            assert closure(solution) <= 1e-6, case


@pytest.fixture(scope="module")
def solution() -> Solution:
    """A smooth float, a leaning smooth cylinder with a clamp, and a rope that stretches a lot."""
    k = sphere_drag(1.0, 0.5)
    rod = Piece(2.0, False, -80.0, 240.0, 20.0, clamps=[(0.4, -30.0, 0.0, 12.0)])
    rope = cable(150.0, 0.014, 0.4, 1.3, 0.01)
    line = line_of(Piece(1.0, False, 2500.0, k, k, directional=False), rod, rope)
    line = replace(
        line,
        drag_curve=(DragCurve(1.0), DragCurve(0.4, 5.0), None),
        clamp_drag_curve=(DragCurve(0.2, 3.0),),
        elongation=(None, None, ElongationCurve(TABLE, 20e3, 0.03)),
    )
    return solve_mooring(line, stream(300.0, 0.9), TIGHT)


def test_the_audit_takes_drag_and_stretch_from_the_curves(solution) -> None:
    assert closure_of(solution) <= 1e-10
    assert moment_of(solution) <= LARGEST_MOMENT
    assert closure(solution) <= 1e-10


@pytest.mark.parametrize(
    "wrong",
    [
        {"drag_curve": (DragCurve(1.001), DragCurve(0.4, 5.0), None)},
        {"drag_curve": (DragCurve(1.0), DragCurve(0.4, 5.01), None)},
        {"clamp_drag_curve": (DragCurve(0.21, 3.0),)},
    ],
    ids=["sphere", "cylinder", "clamp"],
)
def test_the_audit_sees_a_march_on_another_drag_curve(solution, wrong) -> None:
    other = replace(solution, carried=replace(solution.carried, **wrong))
    assert closure_of(other) > LARGEST_CLOSURE


@pytest.mark.parametrize(("breaking_load", "permanent"), [(20.01e3, 0.03), (20e3, 0.03001)])
def test_the_audit_sees_a_march_on_another_table(solution, breaking_load, permanent) -> None:
    curve = ElongationCurve(TABLE, breaking_load, permanent)
    other = replace(solution, carried=replace(solution.line, elongation=(None, None, curve)))
    assert moment_of(other) > LARGEST_MOMENT


def test_what_lies_on_the_seabed_stretches_by_the_table_too() -> None:
    """A heavy rope, 60 m of it lying: friction takes its tension evenly, down to nothing."""
    curve = ElongationCurve(TABLE, 8e3, 0.02)
    rope = cable(130.0, 0.02, 20.0, 1.3, 0.0)
    line = replace(line_of(point(3000.0, 900.0), rope), elongation=(None, curve))
    for friction in (0.0, 0.3, 3.0):
        settings = Settings(tolerance=1e-9, seabed_friction=friction)
        found = solve_mooring(line, stream(50.0, 0.5), settings)
        assert found.landed
        lying = found.position[found.hanging :]
        pull = found.tension[found.hanging]
        length = found.grounded_length
        s = length * (np.arange(2000) + 0.5) / 2000
        law = strain_law(line, 1)
        strain = np.mean([law(max(pull - friction * 20.0 * at, 0.0)) for at in s])
        stretched = float(np.hypot(*(lying[0] - lying[-1])[:2]))
        # two Gauss points over the bends of the table
        assert stretched == pytest.approx(length * (1.0 + strain), rel=2e-3 if friction else 1e-9)
