"""The audit finds what a wrong march would leave."""

from dataclasses import replace

import numpy as np
import pytest

from calm.solve import solve_mooring
from calm.solve.audit import loads_of
from calm.solve.search import LARGEST_CLOSURE, LARGEST_MOMENT
from tests.unit.solve.simple import line, rigid, rope, water
from tests.validation.audited import closure_of, moment_of


@pytest.fixture(scope="module")
def solution():
    head = rigid(0.4, -30.0, drag=20.0), rigid(1.0, 4000.0, drag=250.0)
    meter = rigid(0.6, -220.0, drag=60.0, tangential=9.0, directional=True)
    pieces = (*head, rope(150, 2.0, ct=0.01, stiffness=8e5), meter, rope(100, 0.3, stiffness=5e4))
    clamps = [(2, 40.0, -30.0, 5.0), (3, 0.2, -10.0, 8.0), (2, 150.0, -30.0, 5.0)]
    current = [(0, 0.9, 0.1, 0.01), (120, 0.4, -0.2, 0), (300, 0.1, 0.05, 0)]
    return solve_mooring(line(*pieces, clamps=clamps), water(300, *current))


def test_a_true_solution_passes(solution):
    assert closure_of(solution) <= 1e-10
    assert moment_of(solution) <= LARGEST_MOMENT


def test_loads_sum_to_the_anchor_force(solution):
    total = loads_of(solution).sum(axis=0)
    assert total == pytest.approx(solution.marched.force[-1], rel=1e-9)


def test_a_missing_load_is_found(solution):
    """A thousandth of the drag of one rope left out of the march."""
    drag = solution.line.normal_drag.copy()
    drag[2] *= 1.001
    wrong = replace(solution, carried=replace(solution.carried, normal_drag=drag))
    assert closure_of(wrong) > LARGEST_CLOSURE


def test_a_bent_element_is_found(solution):
    position = solution.marched.position.copy()
    position[20:, 0] += 1e-6
    moved = replace(solution, marched=replace(solution.marched, position=position))
    assert moment_of(moved) > LARGEST_MOMENT


def test_a_tilted_rod_is_found(solution):
    position = solution.marched.position.copy()
    nodes = solution.piece_nodes[3]
    middle = position[nodes[1]].copy()
    position[nodes[0] + 1 : nodes[1] + 1] += 1e-6 * np.array([1.0, 0.0, 0.0])
    assert not np.array_equal(middle, position[nodes[1]])
    moved = replace(solution, marched=replace(solution.marched, position=position))
    assert moment_of(moved) > LARGEST_MOMENT
