"""What must hold for every mooring, whatever its figures: no reference is needed.

Two solutions that should be equal are compared by `apart`: the worst of all depths and offsets as
a share of the water depth, the worst of all tensions as a share of the greatest. Where they march
the same segments they differ by rounding and by where the search for the root stops: `SAME`. Where
they do not, by the error of the march, which an angle step of 0.1° holds to 2e-6 each: `ACCURATE`.
Rounding may tip the choice of segments, too: then each may err by what it says of itself.
"""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, radians, sin
from random import Random

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from calm.errors import NoEquilibrium
from calm.physics.line import Line, Water
from calm.solve import Settings, Solution, solve_mooring
from tests.property.strategies import draws, mooring
from tests.validation.agreement import closure
from tests.validation.pieces import cable, line_of, point, profile

TIGHT = Settings(tolerance=1e-9)
FINE = Settings(radians(0.1), tolerance=1e-9)
SAME, ACCURATE = 1e-7, 4e-6

some = settings(max_examples=40)


def solved(line: Line, water: Water, how: Settings = TIGHT) -> Solution:
    """A solution; draws that have none are passed over."""
    try:
        return solve_mooring(line, water, how)
    except NoEquilibrium:
        assume(False)
        raise


def apart(a: Solution, b: Solution) -> float:
    """The worst difference at the ends of all pieces."""
    here, there = a.piece_nodes.ravel(), b.piece_nodes.ravel()
    place = np.abs(a.position[here] - b.position[there]).max() / a.water.depth
    tension = np.abs(a.tension[here] - b.tension[there]).max() / a.tension.max()
    return float(max(place, tension))


def alike(a: Solution, b: Solution) -> bool:
    """Whether two solutions that march the same segments are equal."""
    if a.segments == b.segments:
        return apart(a, b) <= SAME
    place = (a.depth_error + b.depth_error) / a.water.depth
    tension = (a.tension_error + b.tension_error) / a.tension.max()
    return apart(a, b) <= 2.0 * max(place, tension)


def without_clamps(line: Line) -> Line:
    none = np.array([])
    return replace(
        line, clamp_piece=none.astype(int), clamp_at=none, clamp_buoyancy=none,
        clamp_volume=none, clamp_drag=none, clamp_lift=none,
    )  # fmt: skip


def cut(line: Line, parts: int) -> Line:
    """The same line with every cable in equal parts; a clamp on a cut goes to the upper part."""
    repeats = np.where(line.flexible, parts, 1)
    part_length = line.length / repeats
    owner = line.clamp_piece
    part = np.ceil(line.clamp_at / np.where(part_length > 0, part_length, 1.0)[owner]) - 1.0
    part = np.clip(part, 0, repeats[owner] - 1).astype(int)
    first = np.cumsum(repeats) - repeats
    columns = (
        "flexible", "buoyancy", "volume", "normal_drag", "tangential_drag", "directional",
        "compliance", "thinning", "lift", "diameter", "push_east", "push_north",
    )  # fmt: skip
    return replace(
        line,
        length=np.repeat(part_length, repeats),
        **{name: np.repeat(getattr(line, name), repeats) for name in columns},
        clamp_piece=first[owner] + part,
        clamp_at=np.clip(line.clamp_at - part * part_length[owner], 0.0, part_length[owner]),
    )


@some
@given(draws, st.floats(0.0, 2.0 * pi))
def test_turning_the_current_turns_the_mooring(number, angle) -> None:
    line, water = mooring(Random(number))
    turn = np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])
    straight = solved(line, water)
    u, v = turn @ [water.u, water.v]
    turned = solved(line, replace(water, u=u, v=v))
    back = turned.position.copy()
    back[:, :2] = back[:, :2] @ turn
    assert alike(straight, replace(turned, position=back))


@some
@given(draws, st.sampled_from([(-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)]))
def test_mirroring_or_reversing_the_current_does_it_to_the_mooring(number, signs) -> None:
    line, water = mooring(Random(number))
    east, north = signs
    there = solved(line, water)
    here = solved(line, replace(water, u=east * water.u, v=north * water.v))
    back = replace(here, position=here.position * [east, north, 1.0])
    assert alike(there, back)


@some
@given(draws, st.floats(0.1, 10.0), st.floats(0.1, 10.0), st.floats(0.1, 10.0))
def test_similar_moorings_have_similar_shapes(number, length, force, speed) -> None:
    """All lengths, all forces and all speeds in other units; drags follow."""
    line, water = mooring(Random(number))
    amount = force / np.where(line.flexible, length, 1.0)
    other_line = replace(
        line, length=line.length * length, buoyancy=line.buoyancy * amount,
        volume=line.volume * amount, normal_drag=line.normal_drag * amount / speed**2,
        tangential_drag=line.tangential_drag * amount / speed**2,
        compliance=line.compliance / force, clamp_at=line.clamp_at * length,
        clamp_buoyancy=line.clamp_buoyancy * force, clamp_volume=line.clamp_volume * force,
        clamp_drag=line.clamp_drag * force / speed**2, anchor_height=line.anchor_height * length,
    )  # fmt: skip
    other_water = replace(
        water, depth=water.depth * length, level=water.level * length, u=water.u * speed,
        v=water.v * speed, w=water.w * speed,
    )  # fmt: skip
    one, other = solved(line, water), solved(other_line, other_water)
    back = replace(
        other, position=other.position / length, force=other.force / force,
        depth_error=other.depth_error / length, tension_error=other.tension_error / force,
    )  # fmt: skip
    assert alike(one, back)


@some
@given(draws, st.floats(0.01, 1.0))
def test_water_on_top_only_deepens_a_line_below_the_surface(number, share) -> None:
    line, water = mooring(Random(number), surface=False)
    below = solved(line, water, FINE)
    assume(not below.surface)
    more = share * water.depth
    deeper = solved(line, replace(water, depth=water.depth + more, level=water.level + more), FINE)
    back = replace(deeper, position=deeper.position + np.array([0.0, 0.0, more]))
    assert apart(below, back) <= ACCURATE


@some
@given(draws)
def test_cutting_cables_in_ten_changes_nothing(number) -> None:
    line, water = mooring(Random(number))
    whole, parts = solved(line, water, FINE), solved(cut(line, 10), water, FINE)
    ends = np.cumsum(np.where(line.flexible, 10, 1))
    first, last = np.concatenate([[0], ends[:-1]]), ends - 1
    nodes = np.concatenate([parts.piece_nodes[first, 0], parts.piece_nodes[last, 1]])
    same = whole.piece_nodes.T.ravel()
    place = np.abs(whole.position[same] - parts.position[nodes]).max() / water.depth
    tension = np.abs(whole.tension[same] - parts.tension[nodes]).max() / whole.tension.max()
    assert place <= ACCURATE
    assert tension <= 2e-5  # twice 1e-5


def test_cutting_a_cable_in_ten_changes_nothing_to_eight_digits() -> None:
    """S1000's cable; at 0.01° the march itself errs by 1e-9 of the depth."""
    line = line_of(point(4000.0, 307.5), cable(1000.0, 0.01, 2.0, 1.3, 0.01, 1.0 / 4e6))
    water = profile(1100.0, [(0.0, 1.0), (200.0, 0.6), (500.0, 0.2), (1100.0, 0.05)])
    finest = Settings(radians(0.01), tolerance=1e-10)
    whole, parts = (solve_mooring(each, water, finest) for each in (line, cut(line, 10)))
    assert parts.position[0] == pytest.approx(whole.position[0], abs=1e-8 * water.depth)
    assert parts.force[-1] == pytest.approx(whole.force[-1], abs=1e-8 * whole.tension.max())


@some
@given(draws)
def test_without_current_a_line_stands_plumb(number) -> None:
    """Tensions are sums of what is above; stretched lengths follow by hand."""
    line, water = mooring(Random(number), surface=False)
    water = replace(water.still(), density=np.full(len(water.level), 1025.0))
    solution = solved(line, water)
    assume(not solution.surface)
    first, last = solution.piece_nodes.T
    below = np.cumsum(line.total_buoyancy)
    above = np.concatenate([[0.0], below[:-1]])
    assert np.abs(solution.position[:, :2]).max() <= 1e-12 * water.depth
    assert solution.force[last, 2] == pytest.approx(below, rel=1e-12, abs=1e-9 * below.max())
    integral = above * line.length + line.buoyancy * line.length**2 / 2.0
    hanging = line.clamp_buoyancy * (line.length[line.clamp_piece] - line.clamp_at)
    np.add.at(integral, line.clamp_piece, hanging)
    stretched = line.length + np.where(line.flexible, line.compliance * integral, 0.0)
    heights = solution.position[first, 2] - solution.position[last, 2]
    assert heights == pytest.approx(stretched, abs=1e-9 * water.depth)


@some
@given(draws)
def test_tension_falls_by_the_weight_of_the_height(number) -> None:
    """T_top − T_bottom = w (z_top − z_bottom) along a cable without tangential drag or stretch.

    The rods keep it to 1 − cos of half a segment's turn: 4e-7 of it at 0.1°.
    """
    line, water = mooring(Random(number))
    line = replace(
        without_clamps(line), tangential_drag=0.0 * line.length, compliance=0.0 * line.length,
        volume=0.0 * line.length,
    )  # fmt: skip
    solution = solved(line, water, FINE)
    first, last = solution.piece_nodes[line.flexible].T
    height = solution.position[first, 2] - solution.position[last, 2]
    fall = solution.tension[first] - solution.tension[last]
    lift = line.buoyancy[line.flexible]
    assert fall == pytest.approx(-lift * height, abs=1e-6 * solution.tension.max())


@some
@given(draws)
def test_the_anchor_holds_the_sum_of_all_loads(number) -> None:
    solution = solved(*mooring(Random(number)))
    assert closure(solution) <= 1e-6
    assert solution.closure <= 1e-6
    assert solution.moment_residual <= 1e-8
    assert abs(solution.miss) <= TIGHT.tolerance * solution.water.depth


@some
@given(draws)
def test_quartering_the_angle_step_brings_the_error_down_sixteenfold(number) -> None:
    """Of the march; judged by the change to a solution at 0.0125°, which errs by a 25th of that.

    Cuts at levels and clamps stir the ratio, by up to two. The steps are small because the second
    order shows only once a step is smaller than what the long straight part of a line turns by: a
    hair of a degree over hundreds of metres above a slack foot (number 6521), or beside a narrow
    bight (398019). Moorings whose segments had to be finer than the angle step asks are passed
    over.
    """
    line, water = mooring(Random(number))
    exact, fine, coarse = (
        solved(line, water, Settings(radians(degrees), 1e-10)).as_marched
        for degrees in (0.0125, 0.0625, 0.25)
    )
    assume(2.5 <= fine.segments / coarse.segments <= 5.0)
    assume(apart(coarse, exact) > 1e-7)  # else the tolerance of the root is what is seen
    assert apart(coarse, exact) / apart(fine, exact) >= 8.0


@some
@given(draws)
def test_the_same_mooring_has_the_same_answer(number) -> None:
    line, water = mooring(Random(number))
    assert apart(solved(line, water), solved(line, water)) == 0.0
