from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pytest

from calm.case import memory
from calm.case.memory import Memory
from calm.errors import NoEquilibrium


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
