"""Define what a file of another program says, in CALM's terms: the model that every importer fills.

Figures are SI and degrees under the names of the mooring file; depths are positive down.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem

MOST_PIECES = 2_000
"""Most pieces of a line, and most levels of its water."""

FigureOrWord = float | str
"""A number in SI, or a word of the mooring file such as ``insensitive``."""


def one_line(text: str) -> str:
    """Return a text in one line, without control signs."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


@dataclass(frozen=True)
class Remark:
    """Say that something was guessed, or left out: where it stands, and what."""

    where: str
    what: str

    def __str__(self) -> str:
        return one_line(f"{self.where}: {self.what}")


@dataclass(eq=False)
class ImportedComponent:
    """Hold a definition, with the figures of the file it comes from.

    Attributes
    ----------
    name : as that file calls it
    kind : sphere, cylinder, body, cable, chain or anchor
    figures : by the fields of `kind`; of cables and chains per metre
    guesses : why a field is not from the file
    comment : what a reader should know about where the figures come from
    hull : draft [m], displaced volume [m³] and immersed area [m²], rows
    entry : id of the catalogue entry that stands in its place
    """

    name: str
    kind: str
    figures: dict[str, FigureOrWord]
    guesses: dict[str, str] = field(default_factory=dict)
    comment: str = ""
    hull: tuple[tuple[float, float, float], ...] = ()
    entry: str = ""

    @classmethod
    def of_line(
        cls, name: str, weight: float, figures: dict[str, FigureOrWord], *, chain: bool
    ) -> ImportedComponent:
        """Make a cable, or a chain where it is called one and sinks.

        Parameters
        ----------
        name : as that file calls it
        weight : of a metre in water, negative for what floats [N]
        figures : its diameter and drag, to which the weight is added
        chain : whether it is called a chain
        """
        figures["buoyancy" if weight < 0.0 else "weight"] = abs(weight)
        return cls(name, "chain" if chain and weight >= 0.0 else "cable", figures)

    def number(self, field: str) -> float:
        """Return a figure; 0 where it has none."""
        return float(self.figures.get(field, 0.0))

    def identity(self) -> tuple[object, ...]:
        """Return all its figures: components with the same figures are one definition."""
        figures = tuple(sorted(self.figures.items(), key=lambda pair: pair[0]))
        return self.name, self.kind, figures, self.hull


@dataclass(eq=False)
class ImportedClamp:
    """Represent a component clamped on a piece, `at` metres from the piece's upper end."""

    component: ImportedComponent
    at: float
    guess: str = ""


@dataclass(eq=False)
class ImportedPiece:
    """Represent a piece of the line; `length` [m] is that of a cable or chain."""

    component: ImportedComponent
    length: float | None = None
    clamps: list[ImportedClamp] = field(default_factory=list)
    guess: str = ""
    label: str = ""
    count: int = 1

    @property
    def extent(self) -> float:
        """The length of a line, or that of its component [m]."""
        return self.component.number("length") if self.length is None else self.length

    def clamp(self, component: ImportedComponent, at: float, guess: str = "") -> None:
        """Clamp a component on it, after those that sit above.

        Parameters
        ----------
        component : that is clamped on
        at : distance from its upper end [m]
        guess : why the place is not from the file
        """
        self.clamps.append(ImportedClamp(component, at, guess))
        self.clamps.sort(key=lambda clamp: clamp.at)


@dataclass(eq=False)
class CurrentRecord:
    """Hold currents at several times: `u`, `v`, `w` [m/s] by time and level, `depth` [m].

    `days` count from `epoch`, a date.
    """

    days: NDArray[np.float64]
    epoch: str
    depth: NDArray[np.float64]
    u: NDArray[np.float64]
    v: NDArray[np.float64]
    w: NDArray[np.float64]


@dataclass(eq=False)
class ImportedWater:
    """Hold the environment of the line.

    Attributes
    ----------
    depth : of the water [m]; None in a tow whose file gives none
    density : [kg/m³], or rows of depth and density; None where the file does not say
    gravity : [m/s²]
    current : rows of depth, and speed to the east, to the north and up [m/s]
    wind : speed [m/s] and where it blows to [degrees]
    guesses : why a field is not from the file
    """

    depth: float | None
    density: float | tuple[tuple[float, float], ...] | None = None
    gravity: float | None = None
    current: tuple[tuple[float, float, float, float], ...] = ()
    wind: tuple[float, float] | None = None
    guesses: dict[str, str] = field(default_factory=dict)


@dataclass(eq=False)
class ImportedTow:
    """Hold speed [m/s], course [degrees], height of the sheave above the water [m]."""

    speed: float
    toward: float
    height: float = 0.0


@dataclass(eq=False)
class Design:
    """Hold a mooring or a tow as another program's file gives it.

    Attributes
    ----------
    program : that wrote the file
    items : from the top down; of a tow, from the ship
    water : None where the file gives no environment
    solver : keys of `solver`, each with a comment
    guessed : guesses that belong to no figure; figures carry their own
    dropped : what the file says and CALM cannot use
    notes : what else the heading of the mooring file says
    in_kilograms : whether the file counts forces in kilograms-force
    """

    program: str
    name: str
    items: list[ImportedPiece]
    water: ImportedWater | None
    description: str = ""
    tow: ImportedTow | None = None
    record: CurrentRecord | None = None
    solver: dict[str, tuple[FigureOrWord, str]] = field(default_factory=dict)
    guessed: list[Remark] = field(default_factory=list)
    dropped: list[Remark] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    in_kilograms: bool = False

    def components(self) -> Iterator[ImportedComponent]:
        """Every definition in use, those of clamps after that of their piece; repeats included."""
        for item in self.items:
            yield item.component
            for clamp in item.clamps:
                yield clamp.component


def refused(path: object, *messages: str) -> InputError:
    """Return why a file cannot be read, or what in it CALM cannot represent."""
    return InputError([Problem(str(path), 0, 0, one_line(message)) for message in messages])


def refused_at(path: object, line: int, column: int, message: str) -> InputError:
    """Return why a file cannot be read, with the place in its text.

    Parameters
    ----------
    path : of the file
    line, column : from 1
    message : what is wrong there
    """
    return InputError([Problem(str(path), line, column, one_line(message))])
