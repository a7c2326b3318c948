"""Define what a file of another program says, in CALM's terms: the model that every importer fills.

Figures are SI and degrees under the names of the mooring file; depths are positive down.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from calm.errors import one_line
from calm.exchange.current_record import CurrentRecord
from calm.exchange.part_names import is_called

MOST_PIECES = 2_000
"""Most pieces of a line, and most levels of its water."""

FigureOrWord = float | str
"""A number in SI, or a word of the mooring file such as ``insensitive``."""


@dataclass(frozen=True)
class ImportOptions:
    """Hold how a file is to be read.

    Attributes
    ----------
    defines : macros of WHOI Cable; ids of the catalogue by the names of oceanarray
    columns : the headings of a table, by what they hold
    elements : a library with the figures that a table lacks
    allow_include : whether a file may include another from outside its folder
    """

    defines: Mapping[str, str] = field(default_factory=dict)
    columns: Mapping[str, str] = field(default_factory=dict)
    elements: Path | None = None
    allow_include: bool = False


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
        cls, name: str, weight: float, figures: dict[str, FigureOrWord]
    ) -> ImportedComponent:
        """Make a cable, or a chain where it is called one and sinks.

        Parameters
        ----------
        name : as that file calls it
        weight : of a metre in water, negative for what floats [N]
        figures : its diameter and drag, to which the weight is added
        """
        figures["buoyancy" if weight < 0.0 else "weight"] = abs(weight)
        kind = "chain" if weight >= 0.0 and is_called(name, "chain") else "cable"
        return cls(name, kind, figures)

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
    label: str = ""
    serial: str = ""
    planned_depth: float | None = None


@dataclass(eq=False)
class ImportedPiece:
    """Represent a piece of the line; `length` [m] is that of a cable or chain."""

    component: ImportedComponent
    length: float | None = None
    clamps: list[ImportedClamp] = field(default_factory=list)
    guess: str = ""
    label: str = ""
    count: int = 1
    serial: str = ""
    planned_depth: float | None = None

    @property
    def extent(self) -> float:
        """The length of a line, or that of its component [m]."""
        return self.component.number("length") if self.length is None else self.length

    def clamp(
        self, component: ImportedComponent, at: float, guess: str = "", label: str = "",
        serial: str = "",
    ) -> None:  # fmt: skip
        """Clamp a component on it, after those that sit above.

        Parameters
        ----------
        component : that is clamped on
        at : distance from its upper end [m]
        guess : why the place is not from the file
        label, serial : its name in results, and its number
        """
        self.clamps.append(ImportedClamp(component, at, guess, label, serial))
        self.clamps.sort(key=lambda clamp: clamp.at)


@dataclass(eq=False)
class ImportedLeg:
    """Represent a leg of a net: its pieces from its upper end, and its ends as the file has them,
    such as ``{join: A}``; empty where the key is not needed.
    """

    name: str
    items: list[ImportedPiece]
    top: str = ""
    bottom: str = ""


def held_at(depth: float, east: float, north: float) -> str:
    """Return the key of an end of a leg that is held at a depth and a place [m]."""
    return f"{{held: {{depth: {depth:.9g} m, at: [{east:.9g} m, {north:.9g} m]}}}}"


def anchored_at(east: float, north: float, depth: float | None = None) -> str:
    """Return the key of a lower end with an anchor [m]; its depth where it is not the water's."""
    deeper = "" if depth is None else f", depth: {depth:.9g} m"
    return f"{{anchor: {{at: [{east:.9g} m, {north:.9g} m]{deeper}}}}}"


def joined_at(node: str) -> str:
    """Return the key of an end that joins others at a node."""
    return f"{{join: {node}}}"


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
class ImportedDesign:
    """Hold a mooring or a tow as another program's file gives it.

    Attributes
    ----------
    program : that wrote the file
    items : from the top down; of a tow, from the ship; of a net, one leg after the other
    legs : of a net
    water : None where the file gives no environment
    environment : lines of the `environment` key in its place
    solver : keys of `solver`, each with a comment
    guessed : guesses that belong to no figure; figures carry their own
    dropped : what the file says and CALM cannot use
    notes : what else the heading of the mooring file says
    heading : further keys of the mooring file, as it has them
    in_kilograms : whether the file counts forces in kilograms-force
    sunken : the uppermost component where the line, once solved, leaves it under water; None where
        there is no question
    understood : how the file was read, for people; empty where its format leaves no choice
    """

    program: str
    name: str
    items: list[ImportedPiece]
    water: ImportedWater | None
    environment: list[str] = field(default_factory=list)
    description: str = ""
    tow: ImportedTow | None = None
    record: CurrentRecord | None = None
    solver: dict[str, tuple[FigureOrWord, str]] = field(default_factory=dict)
    guessed: list[Remark] = field(default_factory=list)
    dropped: list[Remark] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    heading: dict[str, str] = field(default_factory=dict)
    in_kilograms: bool = False
    legs: list[ImportedLeg] = field(default_factory=list)
    sunken: ImportedComponent | None = None
    understood: str = ""

    def lay(self, items: list[ImportedPiece], top: str, bottom: str) -> None:
        """Add a leg, from its upper end, to those of a net."""
        self.legs.append(ImportedLeg(f"leg-{len(self.legs) + 1}", items, top, bottom))
        self.items += items

    def components(self) -> Iterator[ImportedComponent]:
        """Every definition in use, those of clamps after that of their piece; repeats included."""
        for item in self.items:
            yield item.component
            for clamp in item.clamps:
                yield clamp.component
