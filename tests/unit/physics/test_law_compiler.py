"""Compiled laws mean what they mean in Python."""

from collections.abc import MutableSequence, Sequence
from math import copysign, inf, isfinite, isnan, nan, pi, sqrt
from typing import Any, NamedTuple

import numpy as np
import pytest

from calm.physics import compiled
from calm.physics.law_compiler import Uncompilable
from calm.physics.law_kinds import record_type

TABLE = (0.5, 1.5, 4.0)


class Point(NamedTuple):
    """A point."""

    x: float
    y: float
    n: int


class Path(NamedTuple):
    """Points, and one of them."""

    points: Sequence[Point]
    own: Point
    grid: Any
    open: bool


@pytest.fixture(autouse=True)
def nothing_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiled, "cache_folder", lambda: None)
    monkeypatch.setattr(compiled, "_entries", {})


def path() -> Path:
    points: Any = np.array([(1.0, 2.0, 3), (4.0, 5.0, 6), (7.0, 8.0, 9)], record_type(Point))
    return Path(points, Point(0.5, 0.25, 7), np.arange(24.0).reshape(2, 3, 4), True)


def largest(a: float, b: float) -> tuple[float, float, float]:
    return max(a, b), min(a, b), max(a, 1.0, b, 0)


@pytest.mark.parametrize("a", [nan, 0.0, -0.0, inf, 2.0])
@pytest.mark.parametrize("b", [nan, 0.0, -0.0, -inf, 1.0])
def test_the_greater_number_is_that_of_python(a: float, b: float) -> None:
    assert repr(compiled.outcome(largest, True, a, b)) == repr(largest(a, b))


def widened(n: int) -> float:
    total = last = 0
    for i in range(n, 0, -1):
        if i == 3:
            continue
        total += i / 2
        last = i
        if i < -n:
            break
    while True:
        total = total * 0.5
        if total < 1.0 or not last:
            break
    return total + last // 2 + TABLE[last + 1]


def test_a_variable_may_become_a_real_number() -> None:
    assert compiled.outcome(widened, True, 9) == widened(9)


def moved(point: Point, by: float) -> Point:
    return Point(point.x + by, point.y - by, point.n + 1)


def walked(path: Path, steps: int) -> tuple[Point, Point, float, bool]:
    here, before = path.own, path.points[0]
    for _ in range(steps):
        here, before = moved(here, 0.25), here
    part = path.points[1:9]
    far = sqrt(part[1].x) if path.open and len(part) == 2 else -1.0
    for k in (0, 2):
        far += path.grid[1, k, 3] * path.grid[0][k][-1]
    return here, before, far, isnan(before.x) or not isfinite(far) or steps in (4, 5)


@pytest.mark.parametrize("steps", [0, 1, 4])
def test_tuples_are_values(steps: int) -> None:
    plain = path()
    listed = plain._replace(points=[Point._make(row) for row in plain.points.tolist()])  # type: ignore[attr-defined]
    here, before, far, known = compiled.outcome(walked, True, plain, steps)
    assert (here, before, far, known) == walked(listed, steps)
    assert (type(here), type(known)) == (Point, bool)


def shared_out(path: Path, sums: MutableSequence[float]) -> None:
    if not path.open:
        return
    for i in range(len(path.points)):
        sums[i] += copysign(path.points[i].x * pi, -1.0)
        compiled.set_row(path.points, i, moved(path.own, abs(-3)))


def test_arrays_are_written() -> None:
    given, sums = path(), np.ones(3)
    assert compiled.outcome(shared_out, True, given, sums) is None
    assert sums.tolist() == [1.0 - x * pi for x in (1.0, 4.0, 7.0)]
    assert given.points.tolist() == [(3.5, -2.75, 8)] * 3  # type: ignore[attr-defined]


def times(point: Point, x: float) -> float:
    return point.x * x


def twice(function: Any, point: Point) -> float:
    return function(point, 2.0) + function(Point(1.0, 0.0, 0), 1.0)  # type: ignore[no-any-return]


def test_a_law_is_called_by_its_address() -> None:
    point = Point(3.0, 0.0, 1)
    function = compiled.by_address(times, point)
    assert function(point, 2.0) == 6.0
    assert compiled.outcome(twice, True, function, point) == 7.0


def with_power(x: float) -> float:
    return x**2


def with_text(x: float) -> float:
    return len(str(x)) * x


@pytest.mark.parametrize("law", [with_power, with_text])
def test_what_is_no_law_is_refused_with_its_line(law: Any) -> None:
    with pytest.raises(
        Uncompilable, match=f"{law.__name__}, line {law.__code__.co_firstlineno + 1}"
    ):
        compiled.outcome(law, True, 1.5)


def test_arrays_with_gaps_are_refused() -> None:
    with pytest.raises(ValueError, match="without gaps"):
        compiled.outcome(shared_out, True, path(), np.ones(6)[::2])
