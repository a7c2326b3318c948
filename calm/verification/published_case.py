"""Cases of `calm verify`: expected values, their computation by CALM, and the comparison.

No mooring file is read; the lines and waters of published cases are built here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import cache
from math import atan2, degrees, hypot, inf, nan, pi, radians
from typing import Generic, TypeVar

import numpy as np

from calm.physics.line import Floats, Line, Water
from calm.physics.seawater import REFERENCE_DENSITY
from calm.solve import Settings, Solution, Towing, solve_mooring, solve_tow

Solved = TypeVar("Solved")

PRINTED = "Half a unit of the last printed digit, with a margin of 10 %."
"""Reason for the tolerance of a printed value that CALM computes to more digits."""


class Kind(StrEnum):
    """Origin of an expected value, which determines how much an agreement with CALM proves."""

    PUBLISHED = "published"
    CLOSED_FORM = "closed form"
    INDEPENDENT = "independent integration"
    PROPERTY = "property"
    BY_CONSTRUCTION = "by construction"

    @property
    def meaning(self) -> str:
        """Sentence that explains this kind of origin."""
        return _MEANINGS[self]

    @property
    def verifies(self) -> bool:
        """Whether agreement is evidence that CALM is correct."""
        return self is not Kind.BY_CONSTRUCTION


_MEANINGS = {
    Kind.PUBLISHED: "Printed in a paper, a manual or a manufacturer's data sheet.",
    Kind.CLOSED_FORM: "The value or the root of a formula, evaluated without CALM.",
    Kind.INDEPENDENT: "From an integration that shares no code with CALM: a quadrature, a solver "
    "of the differential equations, another program.",
    Kind.PROPERTY: "Holds for any line and needs no reference.",
    Kind.BY_CONSTRUCTION: "A point to which CALM's curve is fitted or through which it is "
    "drawn, or a value from a library that CALM calls. Agreement excludes only copying errors and "
    "does not count as verification.",
}


@dataclass(frozen=True)
class Case:
    """Value to reproduce with CALM.

    Attributes
    ----------
    name : name of the value, unique within its source
    expected : the value, with all known digits
    unit : unit of `expected`, as text for a reader; empty for a pure number
    tolerance : largest allowed difference [unit], > 0
    why : reason for the tolerance, in a sentence
    got : function that computes the value with CALM [unit]
    """

    name: str
    expected: float
    unit: str
    tolerance: float
    why: str
    got: Callable[[], float]
    kind: Kind

    def check(self) -> CaseOutcome:
        """Compute the value with CALM, and return the outcome.

        If the computation raises an exception, the outcome has no value, and the exception is the
        reason.
        """
        try:
            return CaseOutcome(self, float(self.got()))
        except Exception as error:
            return CaseOutcome(self, nan, f"{type(error).__name__}: {error}")


@dataclass(frozen=True)
class CaseOutcome:
    """Result of a case: the value from CALM, or NaN and the reason why there is no value."""

    case: Case
    got: float
    reason: str = ""

    @property
    def difference(self) -> float:
        """Value from CALM minus expected value [unit of the case]."""
        return self.got - self.case.expected

    @property
    def within(self) -> bool:
        """Whether the value from CALM and the expected value agree within the tolerance."""
        return abs(self.difference) <= self.case.tolerance


@dataclass(frozen=True)
class Source:
    """Cases of one publication or derivation.

    Attributes
    ----------
    text : origin of the values, compared part of CALM, and reasons for differences; Markdown
    picture : stem of the file name of a picture; empty if there is none
    """

    title: str
    text: str
    cases: tuple[Case, ...]
    picture: str = ""

    def having(self, words: Iterable[str]) -> Source:
        """Return the source with only the cases that match a search.

        Each of the given words must occur in the title of the source or in the name of the case.
        """
        wanted = [word.casefold() for word in words]
        chosen = tuple(
            case
            for case in self.cases
            if all(word in f"{self.title} {case.name}".casefold() for word in wanted)
        )
        return Source(self.title, self.text, chosen, self.picture)


@dataclass(frozen=True)
class CaseColumn(Generic[Solved]):
    """Column of a published table.

    Attributes
    ----------
    tolerance : largest allowed difference [unit]; a fraction of the value if `relative` is true
    of : function that extracts the value from a solution of CALM
    """

    name: str
    unit: str
    tolerance: float
    of: Callable[[Solved], float]
    relative: bool = False


def table(
    figures: Sequence[CaseColumn[Solved]],
    rows: Iterable[tuple[str, Callable[[], Solved], Sequence[float]]],
    why: str,
    kind: Kind,
) -> tuple[Case, ...]:
    """Return the cases of a published table, row by row.

    Parameters
    ----------
    figures : columns of the table
    rows : name, function that computes the solution, and published values of each row
    why, kind : as in `Case`
    """

    def case(
        row: str, solve: Callable[[], Solved], figure: CaseColumn[Solved], value: float
    ) -> Case:
        tolerance = figure.tolerance * (abs(value) if figure.relative else 1.0)
        name = f"{row}: {figure.name}"
        return Case(name, value, figure.unit, tolerance, why, lambda: figure.of(solve()), kind)

    return tuple(
        case(row, solve, figure, value)
        for row, solve, values in rows
        for figure, value in zip(figures, values, strict=True)
    )


GRAVITY = 9.81
"""Gravitational acceleration of every case that specifies no other [m/s²]."""

HALF_DENSITY = REFERENCE_DENSITY / 2.0


@dataclass(frozen=True)
class LinePiece:
    """Piece of a line, with the attributes and units of `calm.physics.line.Line`.

    `clamps` lists, for each clamp, the distance from the upper end of the piece, the buoyancy, the
    volume and the drag.
    """

    length: float
    flexible: bool
    buoyancy: float
    normal_drag: float = 0.0
    tangential_drag: float = 0.0
    directional: bool = True
    volume: float = 0.0
    compliance: float = 0.0
    thinning: float = 0.0
    clamps: tuple[tuple[float, float, float, float], ...] = ()


def point(buoyancy: float, drag: float) -> LinePiece:
    """Return a piece without length.

    Parameters
    ----------
    buoyancy : net buoyancy [N]
    drag : drag at 1 m/s [N/(m/s)²]
    """
    return LinePiece(0.0, False, buoyancy, drag, drag, directional=False)


def sphere_drag(diameter: float, cx: float) -> float:
    """Return the drag of a sphere at 1 m/s [N/(m/s)²]."""
    return HALF_DENSITY * cx * pi / 4.0 * diameter**2


def cable(
    length: float, diameter: float, weight: float, cn: float, ct: float, compliance: float = 0.0
) -> LinePiece:
    """Return a piece of rope or wire.

    Parameters
    ----------
    length, diameter : unstretched length and diameter [m]
    weight : weight in water [N/m]
    cn : normal drag coefficient, for the reference area D × length
    ct : tangential drag coefficient, for the reference area π D × length
    compliance : strain per newton [1/N]
    """
    normal, tangential = HALF_DENSITY * diameter * cn, HALF_DENSITY * pi * diameter * ct
    return LinePiece(
        length, True, -weight, normal, tangential, compliance=compliance, thinning=0.5
    )  # fmt: skip


def line_of(*pieces: LinePiece, anchor_height: float = 0.0) -> Line:
    """Return a line of the given pieces, free end first."""
    held = [(owner, *clamp) for owner, piece in enumerate(pieces) for clamp in piece.clamps]
    clamps = np.array(held, dtype=np.float64).reshape(len(held), 5)

    def column(name: str) -> Floats:
        return np.array([getattr(piece, name) for piece in pieces], dtype=np.float64)

    return Line(
        length=column("length"),
        flexible=column("flexible").astype(bool),
        buoyancy=column("buoyancy"),
        volume=column("volume"),
        normal_drag=column("normal_drag"),
        tangential_drag=column("tangential_drag"),
        directional=column("directional").astype(bool),
        compliance=column("compliance"),
        thinning=column("thinning"),
        clamp_piece=clamps[:, 0].astype(np.intp),
        clamp_at=clamps[:, 1],
        clamp_buoyancy=clamps[:, 2],
        clamp_volume=clamps[:, 3],
        clamp_drag=clamps[:, 4],
        anchor_height=anchor_height,
    )


def profile(
    depth: float, rows: Sequence[tuple[float, float]], density: float = REFERENCE_DENSITY
) -> Water:
    """Return water with an eastward current that varies with depth.

    Parameters
    ----------
    depth : water depth [m]
    rows : depths [m] and speeds [m/s] of the current
    density : density [kg/m³]
    """
    level, u = np.array(rows).T
    still = np.zeros_like(u)
    return Water(
        depth=depth, level=level, u=u, v=still, w=still, density=still + density, gravity=GRAVITY
    )


def stream(depth: float, speed: float, density: float = REFERENCE_DENSITY) -> Water:
    """Return water with a uniform eastward current [m/s]."""
    return profile(depth, [(0.0, speed)], density)


def deep_water(density: float = REFERENCE_DENSITY) -> Water:
    """Return still water without a seabed, for tows."""
    return stream(inf, 0.0, density)


FINE = Settings(radians(0.1), tolerance=1e-9)
"""Solver settings for values of seven digits; the error is about 4e-8 of the length."""


@dataclass(frozen=True)
class Ends:
    """Positions and forces at the ends of a line in an eastward current.

    Attributes
    ----------
    x, z : distance downstream and height of the free end, from the lower end [m]
    horizontal, vertical : force at the lower end, positive downstream and upward [N]
    """

    x: float
    z: float
    horizontal: float
    vertical: float

    @property
    def tension(self) -> float:
        """Tension at the lower end [N]."""
        return hypot(self.horizontal, self.vertical)

    @property
    def lean(self) -> float:
        """Angle of the force at the lower end from the vertical [degrees]."""
        return degrees(atan2(self.horizontal, self.vertical))


def ends_of(solution: Solution) -> Ends:
    """Return the ends of a solved line."""
    x, _, z = (solution.position[0] - solution.position[-1]).tolist()
    horizontal, _, vertical = solution.force[-1].tolist()
    return Ends(x, z, horizontal, vertical)


@cache
def finely(made: Callable[..., tuple[Line, Water]], *given: float) -> Ends:
    """Solve a line with the settings `FINE`, and return its ends.

    The function `made` is called with the values `given`, and returns the line and the water.
    """
    return ends_of(solve_mooring(*made(*given), FINE))


@dataclass(frozen=True)
class Wake:
    """Shape and tension of a line towed east through still water.

    Attributes
    ----------
    aft, depth : distances of the free end behind and below the tow point [m]
    tension, angle : tension [N], and angle from the horizontal [degrees], at the tow point
    frequency : strumming frequency [Hz]
    """

    aft: float
    depth: float
    tension: float
    angle: float
    frequency: float


def towed(line: Line, water: Water, speed: float, settings: Settings = FINE) -> Wake:
    """Solve a towed line, and return its shape and tension.

    Parameters
    ----------
    line : the line, from the ship to the free end
    speed : speed of the ship [m/s]
    settings : settings of the integration along the line
    """
    solution = solve_tow(line, water, Towing(speed, 0.0), settings)
    x, _, z = solution.position[0].tolist()
    back, _, down = solution.force[-1].tolist()
    return Wake(-x, -z, hypot(back, down), degrees(atan2(-down, -back)), solution.frequency)
