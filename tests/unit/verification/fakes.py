"""Sources without physics, for tests of what is made of them."""

from __future__ import annotations

from calm.verification import Case, Kind, Source


def case(
    name="length", expected=1.0, got=1.0, tolerance=1e-3, unit="m", why="Printed so.",
    kind=Kind.PUBLISHED,
) -> Case:  # fmt: skip
    return Case(name, expected, unit, tolerance, why, lambda: got, kind)


def failing() -> Case:
    def got() -> float:
        raise ArithmeticError("no such line")

    return Case("tension", 5.0, "N", 0.5, "Measured so.", got, Kind.PUBLISHED)


GOOD = Source(
    "Good book", "By *A. Author*.", (case("length"), case("depth of the float", 2.0, 2.0))
)
BAD = Source("Bad book", "Full of slips.", (case("length", 1.0, 1.25), failing(), case("width")))
