from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pytest

from calm.case import memory
from calm.case.memory import Memory
from calm.errors import NoEquilibrium
from calm.physics.line import Water


@dataclass(frozen=True)
class Given:
    values: np.ndarray

    @cached_property
    def found_out(self) -> int:
        return 1


def curve(factor: float):
    return lambda share: factor * share


def test_the_same_digits_are_solved_once() -> None:
    solved = []

    def solver(given: Given, factor: float) -> float:
        solved.append(factor)
        return factor * float(given.values.sum())

    kept = Memory()
    first = Given(np.array([1.0, 2.0]))
    assert kept.of(solver, first, 2.0) == 6.0
    assert first.found_out == 1
    assert kept.of(solver, first, 2.0) == kept.of(solver, Given(np.array([1.0, 2.0])), 2.0) == 6.0
    assert kept.of(solver, first, 3.0) == kept.of(solver, first, factor=3.0) == 9.0
    assert kept.of(solver, Given(np.array([1.0, 2.0 + 1e-15])), 2.0) == pytest.approx(6.0)
    assert solved == [2.0, 3.0, 3.0, 2.0]


def test_equal_water_is_one_key_and_another_current_is_another() -> None:
    solved = []

    def solver(water: Water) -> float:
        solved.append(water)
        return float(water.u.sum())

    def water(speed: float) -> Water:
        zero = np.zeros(2)
        return Water(100.0, [0.0, 50.0], [speed, 0.0], zero, zero, zero + 1025.0)

    kept, first = Memory(), water(0.5)
    assert [kept.of(solver, each) for each in (first, first, water(0.5))] == [0.5] * 3
    assert kept.of(solver, first.still()) == 0.0
    assert kept.of(solver, water(0.25)) == 0.25
    assert len(solved) == 3


def test_functions_are_told_apart_by_what_they_enclose() -> None:
    kept = Memory()

    def solver(of) -> float:
        return of(10.0)

    assert [kept.of(solver, curve(factor)) for factor in (1.0, 2.0, 1.0)] == [10.0, 20.0, 10.0]


def test_a_failure_is_kept_too() -> None:
    tried = []

    def solver() -> None:
        tried.append(1)
        raise NoEquilibrium("slack", "why", "what to do", 3)

    kept = Memory()
    for _ in range(2):
        with pytest.raises(NoEquilibrium) as failure:
            kept.of(solver)
        assert (failure.value.status, failure.value.piece) == ("slack", 3)
    assert tried == [1]


def test_the_oldest_are_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "MOST", 2)
    solved = []
    kept = Memory()

    def solver(number: int) -> int:
        solved.append(number)
        return number

    for number in (1, 2, 1, 3, 1, 2):
        kept.of(solver, number)
    assert solved == [1, 2, 3, 2]
