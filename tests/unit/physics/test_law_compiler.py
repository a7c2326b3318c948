"""Compiled laws mean what they mean in Python."""

from collections.abc import MutableSequence, Sequence
from math import copysign, floor, inf, isfinite, isnan, log, nan, pi, sqrt
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


def plus(point: Point, x: float) -> float:
    return point.x + x


def twice(function: Any, point: Point, x: float) -> float:
    return function(point, x) + function(Point(1.0, 0.0, 0), 1.0)  # type: ignore[no-any-return]


def both(point: Point, x: float) -> float:
    return twice(times, point, x) + 100.0 * twice(plus, point, x)


def test_a_law_is_passed_to_another_law() -> None:
    given = Point(3.0, 0.0, 1), 2.0
    assert both(*given) == 707.0
    assert compiled.outcome(both, True, *given) == 707.0


def with_else(n: int) -> int:
    found = 0
    for i in range(n):
        if i == 3:
            break
    else:
        found += 7
    for i in (1, n):
        if i == 2:
            break
    else:
        found += 100
    while n > 0:
        n -= 2
        if n == 1:
            break
    else:
        return found + 5000
    return found + 10


@pytest.mark.parametrize("n", [0, 1, 2, 3, 4, 9])
def test_what_follows_a_loop_without_break_is_done(n: int) -> None:
    assert compiled.outcome(with_else, True, n) == with_else(n)


def needed(x: float, n: int) -> tuple[float, float, float, int]:
    either, both = x or n or 2.5, x and n
    if not ((x and n) or x > 1.0):
        both += 10.0
    return either, both, (n or 3) / 2, n and 4


@pytest.mark.parametrize("x", [0.0, -0.0, 1.5, nan])
@pytest.mark.parametrize("n", [0, 2])
def test_and_and_or_have_the_value_that_python_gives(x: float, n: int) -> None:
    *real, whole = needed(x, n)
    assert repr(compiled.outcome(needed, True, x, n)) == repr((*map(float, real), whole))


def overwritten(path: Path) -> tuple[float, float, float, float]:
    points, first = path.points, path.points[0]
    compiled.set_row(points, 0, moved(first, 10.0))
    kept = first.x
    points[1], points[2] = points[2], points[1]  # type: ignore[index]
    total, last = 0.0, 1.0
    for each in (kept, last):
        last = 100.0
        total += each
    return kept, points[1].x, points[2].x, total + last


def test_a_row_keeps_its_value_when_its_place_is_overwritten() -> None:
    plain = path()
    listed = plain._replace(points=[Point._make(row) for row in plain.points.tolist()])  # type: ignore[attr-defined]
    assert compiled.outcome(overwritten, True, plain) == overwritten(listed)
    assert [tuple(row) for row in plain.points.tolist()] == listed.points  # type: ignore[attr-defined]


def parts(points: Sequence[float], first: int) -> tuple[int, int, int]:
    return len(points[first:2]), len(points[first:]), len(points[:first])


@pytest.mark.parametrize("first", [0, 2, 4, 9])
def test_a_part_beyond_the_end_is_empty(first: int) -> None:
    given = np.arange(5.0)
    assert compiled.outcome(parts, True, given, first) == parts(list(given), first)


def numbers(x: float, n: int) -> tuple[float, bool, int, bool]:
    return copysign(1.0, floor(x) * 1.0), isnan(n) or isfinite(n), abs(x < 1.0), 5 < n in (1, 2)


@pytest.mark.parametrize("x", [-0.0, -0.5, 2.5])
def test_numbers_are_those_of_python(x: float) -> None:
    assert compiled.outcome(numbers, True, x, 1) == numbers(x, 1)


def test_an_argument_has_the_kind_that_the_law_declares() -> None:
    assert compiled.outcome(largest, True, 1, 2) == (2, 1, 2)
    assert compiled.outcome(largest, True, 1.5, 2.5) == (2.5, 1.5, 2.5)


def with_power(x: float) -> float:
    return x**2


def with_text(x: float) -> float:
    return len(str(x)) * x


def with_plus(x: float) -> float:
    return +x


def with_base(x: float) -> float:
    return log(x, 2.0)


def with_name(x: float) -> float:
    return max(x, 2.0, key=abs)


def with_steps(x: Any) -> float:
    return len(x[::2])


def counted_from_the_end(x: Any) -> float:
    return len(x[:-1])


def itself(x: float) -> float:
    return itself(x - 1.0)


@pytest.mark.parametrize(
    "law",
    [
        with_power, with_text, with_plus, with_base, with_name, with_steps, counted_from_the_end,
        itself,
    ],
)  # fmt: skip
def test_what_is_no_law_is_refused_with_its_line(law: Any) -> None:
    given: Any = np.ones(4) if law in (with_steps, counted_from_the_end) else 1.5
    with pytest.raises(
        Uncompilable, match=f"{law.__name__}, line {law.__code__.co_firstlineno + 1}"
    ):
        compiled.outcome(law, True, given)


def without_result(x: float) -> float:  # type: ignore[return]
    if x > 0.0:
        return 1.0


def unset(n: int) -> float:
    while n > 0:
        if n < 3:
            return pi  # noqa: F823
        pi = 1.0  # noqa: F841
        n -= 1
    return 0.0


@pytest.mark.parametrize("law", [without_result, unset])
def test_what_has_no_value_is_refused(law: Any) -> None:
    with pytest.raises(Uncompilable, match=r"without a result|pi has no value"):
        compiled.outcome(law, True, 5)


def test_arrays_with_gaps_are_refused() -> None:
    with pytest.raises(ValueError, match="must be contiguous"):
        compiled.outcome(shared_out, True, path(), np.ones(6)[::2])
