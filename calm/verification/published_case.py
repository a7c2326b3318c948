"""Define a figure to reproduce, how CALM comes to it, and what a check of it finds.

Lines and waters of published cases are put together without a mooring file, and their ends taken.
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

PRINTED = "Half a unit of the last printed digit, plus a tenth."
"""The reason for a tolerance where CALM is exact beside the figure as printed."""


class Kind(StrEnum):
    """Tell where an expected figure comes from, and so how much its agreement proves."""

    PUBLISHED = "published"
    CLOSED_FORM = "closed form"
    INDEPENDENT = "independent integration"
    PROPERTY = "property"
    BY_CONSTRUCTION = "by construction"

    @property
    def meaning(self) -> str:
        """The kind in a sentence."""
        return _MEANINGS[self]

    @property
    def verifies(self) -> bool:
        """Tell whether agreement is evidence that CALM is right."""
        return self is not Kind.BY_CONSTRUCTION


_MEANINGS = {
    Kind.PUBLISHED: "Printed in a paper, a manual or a maker's data sheet.",
    Kind.CLOSED_FORM: "The value of a formula or the root of one, evaluated without CALM.",
    Kind.INDEPENDENT: "From an integration that shares no code with CALM: a quadrature, a solver "
    "of the differential equations, another program.",
    Kind.PROPERTY: "Holds for any line and needs no reference.",
    Kind.BY_CONSTRUCTION: "A point that CALM's curve is drawn through or fitted to, or a figure of "
    "the library that CALM calls. Agreement guards only against copying errors and does not "
    "count as verification.",
}


@dataclass(frozen=True)
class Case:
    """One figure to reproduce.

    Attributes
    ----------
    name : what the figure is, unique within its source
    expected : the figure, to the digits known
    unit : that of `expected`, as text for a reader; empty for a pure number
    tolerance : greatest difference allowed [unit], > 0
    why : the reason for the tolerance, a sentence
    got : computes CALM's figure [unit]; whatever it raises counts as a figure missed
    kind : where `expected` comes from
    """

    name: str
    expected: float
    unit: str
    tolerance: float
    why: str
    got: Callable[[], float]
    kind: Kind

    def check(self) -> CaseOutcome:
        """Compute the figure; never raises, but for what stops the whole program."""
        try:
            return CaseOutcome(self, float(self.got()))
        except Exception as error:
            return CaseOutcome(self, nan, f"{type(error).__name__}: {error}")


@dataclass(frozen=True)
class CaseOutcome:
    """Hold what became of a case: CALM's figure, or NaN and the reason why there is none."""

    case: Case
    got: float
    reason: str = ""

    @property
    def difference(self) -> float:
        """CALM's figure less the expected one [unit of the case]."""
        return self.got - self.case.expected

    @property
    def within(self) -> bool:
        """Tell whether the figure is met."""
        return abs(self.difference) <= self.case.tolerance


@dataclass(frozen=True)
class Source:
    """Hold the figures that come from one place.

    Attributes
    ----------
    title : a few words
    text : who printed or derived the figures, what of CALM is held against them, and why a
        published figure differs where one does; Markdown, a paragraph to each blank line
    cases : the figures
    picture : stem of the picture that shows them, empty where none does
    """

    title: str
    text: str
    cases: tuple[Case, ...]
    picture: str = ""

    def having(self, words: Iterable[str]) -> Source:
        """Return the source with the cases whose name, or its title, has every word (or part)."""
        wanted = [word.casefold() for word in words]
        chosen = tuple(
            case
            for case in self.cases
            if all(word in f"{self.title} {case.name}".casefold() for word in wanted)
        )
        return Source(self.title, self.text, chosen, self.picture)


@dataclass(frozen=True)
class CaseColumn(Generic[Solved]):
    """Describe a column of a published table.

    Attributes
    ----------
    name, unit : of the figure
    tolerance : greatest difference allowed [unit], or as a share of the figure if `relative`
    of : picks the figure out of CALM's answer
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
    figures : its columns
    rows : the name of each row, what solves it, and its printed figures, one for each column
    why : the reason for the tolerances
    kind : where the figures come from
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
"""[m/s²] of every case that does not name another."""

HALF_DENSITY = REFERENCE_DENSITY / 2.0


@dataclass(frozen=True)
class LinePiece:
    """One piece of a line; the names and units are those of `calm.physics.line.Line`.

    `clamps` holds (distance from the piece's top, buoyancy, volume, drag) of each.
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
    """Return a piece without length: buoyancy [N], drag at 1 m/s [N/(m/s)²]."""
    return LinePiece(0.0, False, buoyancy, drag, drag, directional=False)


def sphere_drag(diameter: float, cx: float) -> float:
    """Drag of a sphere at 1 m/s [N/(m/s)²]."""
    return HALF_DENSITY * cx * pi / 4.0 * diameter**2


def cable(
    length: float, diameter: float, weight: float, cn: float, ct: float, compliance: float = 0.0
) -> LinePiece:
    """Return a piece of rope or wire.

    Parameters
    ----------
    length, diameter : unstretched [m]
    weight : in water [N/m]
    cn, ct : drag coefficients on its diameter and on its surface π D
    compliance : strain of a newton [1/N]
    """
    normal, tangential = HALF_DENSITY * diameter * cn, HALF_DENSITY * pi * diameter * ct
    return LinePiece(
        length, True, -weight, normal, tangential, compliance=compliance, thinning=0.5
    )  # fmt: skip


def line_of(*pieces: LinePiece, anchor_height: float = 0.0) -> Line:
    """Return the arrays of a list of pieces, free end first."""
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
    """Water of a depth [m] and density [kg/m³] with an eastward current: rows of depth, speed."""
    level, u = np.array(rows).T
    still = np.zeros_like(u)
    return Water(
        depth=depth, level=level, u=u, v=still, w=still, density=still + density, gravity=GRAVITY
    )


def stream(depth: float, speed: float, density: float = REFERENCE_DENSITY) -> Water:
    """Water with the same eastward current [m/s] everywhere."""
    return profile(depth, [(0.0, speed)], density)


def deep_water(density: float = REFERENCE_DENSITY) -> Water:
    """Still water without a seabed, for tows: the ship makes the current."""
    return stream(inf, 0.0, density)


FINE = Settings(radians(0.1), tolerance=1e-9)
"""For figures of seven digits: the march errs by some 4e-8 of the length at this angle step."""


@dataclass(frozen=True)
class Ends:
    """Free end and lower end of a line in an eastward current.

    Attributes
    ----------
    x, z : the free end downstream of the lower end and above it [m]
    horizontal, vertical : the pull at the lower end, downstream and up [N]
    """

    x: float
    z: float
    horizontal: float
    vertical: float

    @property
    def tension(self) -> float:
        """The tension at the lower end [N]."""
        return hypot(self.horizontal, self.vertical)

    @property
    def lean(self) -> float:
        """Angle of the pull at the lower end from the vertical [degrees]."""
        return degrees(atan2(self.horizontal, self.vertical))


def ends_of(solution: Solution) -> Ends:
    """Return the ends of a solved line."""
    x, _, z = (solution.position[0] - solution.position[-1]).tolist()
    horizontal, _, vertical = solution.force[-1].tolist()
    return Ends(x, z, horizontal, vertical)


@cache
def finely(made: Callable[..., tuple[Line, Water]], *given: float) -> Ends:
    """Return the ends of a line that is made of some figures, solved at `FINE`."""
    return ends_of(solve_mooring(*made(*given), FINE))


@dataclass(frozen=True)
class Wake:
    """Represent a line towed to the east through still water.

    Attributes
    ----------
    aft, depth : of the free end behind and below the tow point [m]
    tension : at the tow point [N]
    angle : of the line at the tow point from the horizontal [degrees]
    frequency : of the cables that strum [Hz]
    """

    aft: float
    depth: float
    tension: float
    angle: float
    frequency: float


def towed(line: Line, water: Water, speed: float, settings: Settings = FINE) -> Wake:
    """Return the wake of a line that is towed.

    Parameters
    ----------
    line : listed from the ship
    water : in which it is towed
    speed : of the ship [m/s]
    settings : of the march
    """
    solution = solve_tow(line, water, Towing(speed, 0.0), settings)
    x, _, z = solution.position[0].tolist()
    back, _, down = solution.force[-1].tolist()
    return Wake(-x, -z, hypot(back, down), degrees(atan2(-down, -back)), solution.frequency)
