"""What must hold for every tow, whatever its figures, on thirty drawn at random.

Two solutions that march the same segments differ by rounding and by where the search for the root
stops; those that do not, by the error of the march: 2e-6 of the line out and 1e-5 of the tension
each at an angle step of 0.1°.
"""

from __future__ import annotations

from dataclasses import fields, replace
from math import cos, pi, radians, sin
from random import Random

import numpy as np
import pytest

from calm.errors import NoEquilibrium
from calm.physics.line import Line, Water
from calm.physics.strumming import BourgetMarichal
from calm.solve import Settings, Solution, Towing, solve_mooring, solve_tow
from tests.validation.agreement import difference
from tests.validation.pieces import Piece, cable, line_of, point, stream
from tests.validation.random_tows import tow
from tests.validation.towed import solve_continuous_tow

TIGHT = Settings(tolerance=1e-10)
FINE = Settings(radians(0.1), tolerance=1e-10)

drawn = pytest.mark.parametrize("number", range(30))


def solved(line: Line, water: Water, towing: Towing, how: Settings = TIGHT) -> Solution:
    """A solution; the few draws that have none are passed over."""
    try:
        return solve_tow(line, water, towing, how)
    except NoEquilibrium as refusal:
        if refusal.status == "not-converged":
            raise
        pytest.skip(str(refusal))


def apart(a: Solution, b: Solution) -> tuple[float, float]:
    """The worst of all positions by the length out, and of all forces by the greatest."""
    here, there = a.piece_nodes.ravel(), b.piece_nodes.ravel()
    place = np.abs(a.position[here] - b.position[there]).max() / a.line.length.sum()
    force = np.abs(a.force[here] - b.force[there]).max() / a.tension.max()
    return float(place), float(force)


def same(a: Solution, b: Solution) -> bool:
    """Whether two solutions are equal, or as equal as their own errors allow."""
    place, force = apart(a, b)
    if a.segments == b.segments:
        return max(place, force) <= 1e-7
    near = 2.0 * (a.depth_error + b.depth_error) / a.line.length.sum()
    close = 2.0 * (a.tension_error + b.tension_error) / a.tension.max()
    return place <= near and force <= close


@drawn
def test_turning_everything_turns_the_tow(number) -> None:
    line, water, towing = tow(Random(number))
    angle = 2.0 * pi * Random(number).random()
    turn = np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])
    u, v = turn @ [water.u, water.v]
    east, north = turn @ [towing.east, towing.north]
    wind = turn @ towing.wind
    there = replace(towing, east=east, north=north, wind=tuple(wind))
    one, turned = solved(line, water, towing), solved(line, replace(water, u=u, v=v), there)
    position, force = turned.position.copy(), turned.force.copy()
    position[:, :2] = position[:, :2] @ turn
    force[:, :2] = force[:, :2] @ turn
    assert same(one, replace(turned, position=position, force=force))


@drawn
def test_only_what_flows_past_counts(number) -> None:
    """A current added everywhere, and to wind and ship alike."""
    line, water, towing = tow(Random(number))
    faster = replace(water, u=water.u + 1.3, v=water.v - 0.4)
    east, north = towing.wind
    carried = replace(
        towing, east=towing.east + 1.3, north=towing.north - 0.4, wind=(east + 1.3, north - 0.4)
    )
    one, other = solved(line, water, towing), solved(line, faster, carried)
    assert same(one, other)


@drawn
def test_cutting_cables_in_ten_changes_nothing(number) -> None:
    line, water, towing = tow(Random(number))
    whole, parts = solved(line, water, towing, FINE), solved(cut(line), water, towing, FINE)
    repeats = np.where(whole.line.flexible, 10, 1)
    last = np.cumsum(repeats) - 1
    ends = parts.piece_nodes[last, 1]
    same = whole.piece_nodes[:, 1]
    place = np.abs(whole.position[same] - parts.position[ends]).max() / line.length.sum()
    force = np.abs(whole.force[same] - parts.force[ends]).max() / whole.tension.max()
    assert place <= 4e-6
    assert force <= 2e-5


def cut(line: Line) -> Line:
    """Every cable in ten; a clamp on a cut stays on the piece nearer to the ship."""
    repeats = np.where(line.flexible, 10, 1)
    part, owner = line.length / repeats, line.clamp_piece
    before = np.ceil(line.clamp_at / np.where(part > 0.0, part, 1.0)[owner]) - 1.0
    before = np.clip(before, 0, repeats[owner] - 1).astype(int)
    columns = {
        column.name: np.repeat(getattr(line, column.name), repeats)
        for column in fields(line)
        if column.type == "Floats" and not column.name.startswith("clamp_")
    }
    columns["length"] = np.repeat(part, repeats)
    return replace(
        line,
        **columns,
        flexible=np.repeat(line.flexible, repeats),
        directional=np.repeat(line.directional, repeats),
        clamp_piece=(np.cumsum(repeats) - repeats)[owner] + before,
        clamp_at=np.clip(line.clamp_at - before * part[owner], 0.0, part[owner]),
    )


@drawn
def test_a_ship_that_drifts_with_the_water_tows_a_plumb_line(number) -> None:
    """Tensions are sums of what hangs below, and stretch follows by hand."""
    line, water, towing = tow(Random(number))
    level, none = np.zeros(1), np.zeros(1)
    dense = np.full(1, 1025.0)
    even = replace(water, level=level, u=none + 0.7, v=none - 0.2, w=none, density=dense)
    heavy = replace(line, buoyancy=-np.abs(line.buoyancy) - 0.01,  # a weightless end hangs no way
 strumming=None,
        clamp_buoyancy=-np.abs(line.clamp_buoyancy))  # fmt: skip
    drifting = Towing(0.7, -0.2, in_air=towing.in_air)
    solution = solved(heavy, even, drifting)
    below = np.cumsum(solution.line.total_buoyancy)
    assert solution.force[solution.piece_nodes[:, 1], 2] == pytest.approx(below, rel=1e-12)
    assert np.abs(solution.position[:, :2]).max() <= 1e-9 * line.length.sum()
    hung = solution.line
    above = np.concatenate([[0.0], below[:-1]])
    pull = above * hung.length + hung.buoyancy * hung.length**2 / 2.0
    reach = hung.length[hung.clamp_piece] - hung.clamp_at
    np.add.at(pull, hung.clamp_piece, hung.clamp_buoyancy * reach)
    stretched = hung.length - np.where(hung.flexible, hung.compliance * pull, 0.0)
    first, last = solution.piece_nodes.T
    heights = solution.position[last, 2] - solution.position[first, 2]
    assert heights == pytest.approx(stretched, abs=1e-9 * line.length.sum())


@pytest.mark.parametrize("speed", [0.3, 1.0, 2.0])
def test_a_tow_is_a_mooring_upside_down(speed) -> None:
    """In an even current: what sinks behind the ship rises above the anchor alike."""
    wire, rope = cable(150.0, 0.012, 2.0, 1.3, 0.01, 1e-6), cable(80.0, 0.02, 0.5, 1.5, 0.02, 1e-5)
    pod = Piece(1.5, False, -80.0, 40.0, 8.0, clamps=[(0.4, -20.0, 0.0, 3.0)])
    body = point(-1500.0, 60.0)
    tow_line = line_of(wire, pod, rope, body)
    towed = solve_tow(tow_line, stream(5000.0, 0.0), Towing(-speed, 0.0), FINE)
    raised = towed.line
    raised = replace(
        raised, buoyancy=-raised.buoyancy, clamp_buoyancy=-raised.clamp_buoyancy, towed=False
    )
    moored = solve_mooring(raised, stream(400.0, speed), FINE)
    above_anchor = moored.position - moored.position[-1]
    upright = replace(
        moored, position=above_anchor * [1.0, 1.0, -1.0], force=moored.force * [1.0, 1.0, -1.0]
    )
    place, force = apart(towed, upright)
    assert place <= 4e-6
    assert force <= 2e-5


@pytest.mark.parametrize("speed", [0.5, 1.3, 3.0, 6.0])
def test_a_strumming_tow_has_more_drag_and_less_depth(speed) -> None:
    line = line_of(cable(100.0, 0.012, 4.0, 1.2, 0.01), point(-800.0, 10.0))
    water, towing = stream(1000.0, 0.0), Towing(speed, 0.0)
    still = solve_tow(line, water, towing)
    strumming = solve_tow(replace(line, strumming=BourgetMarichal()), water, towing)
    capped = solve_tow(replace(line, normal_drag=line.normal_drag * [2.5, 1.0]), water, towing)
    depths = [-shape.position[0, 2] for shape in (still, strumming, capped)]
    assert depths[0] > depths[1] > depths[2]
    assert strumming.frequency > 0.0 == still.frequency


def test_of_several_equilibria_the_deepest() -> None:
    """Below a swift surface layer the body hangs; in it, it would be swept up and stay there."""
    level, none = np.array([0.0, 8.0, 12.0]), np.zeros(3)
    swift = np.array([2.5, 2.5, 0.0])
    water = Water(np.inf, level, swift, none, none, none + 1025.0, 9.81)
    line = line_of(Piece(20.0, True, -0.2, 1.0), point(-150.0, 120.0))
    anchored = Towing(0.0, 0.0)
    referee = solve_continuous_tow(line, water, anchored)
    assert referee.others == pytest.approx([3.911, 9.711], abs=1e-3)
    solution = solve_tow(line, water, anchored)
    assert difference(solution, referee).place <= 5e-5
    assert solution.other is not None
