"""Design model that all importers share, in the terms of a mooring file.

Values are in SI units and degrees, under the key names of the mooring file; depths are positive
down.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from calm.errors import one_line
from calm.exchange.current_record import CurrentRecord
from calm.exchange.part_names import is_called

MOST_PIECES = 2_000
"""Maximum number of pieces in a line, and of levels in its water."""

FigureOrWord = float | str
"""A number in SI units, or a word of the mooring file such as ``insensitive``."""


@dataclass(frozen=True)
class ImportOptions:
    """Options for reading a file.

    Attributes
    ----------
    defines : macros by name (WHOI Cable), or catalogue ids by component name (oceanarray)
    columns : headings in a table, by column name in CALM
    elements : library of elements for values that a table lacks
    allow_include : whether files outside the folder may be included
    sheet : name of the sheet with the list, if several sheets have lists
    """

    defines: Mapping[str, str] = field(default_factory=dict)
    columns: Mapping[str, str] = field(default_factory=dict)
    elements: Path | None = None
    allow_include: bool = False
    sheet: str | None = None


@dataclass(frozen=True)
class Remark:
    """Remark about a guessed or omitted value, and the place in the design to which it applies."""

    where: str
    what: str

    def __str__(self) -> str:
        return one_line(f"{self.where}: {self.what}")


@dataclass(eq=False)
class ImportedComponent:
    """An imported component, with values from the file.

    Attributes
    ----------
    kind : sphere, cylinder, body, cable, chain or anchor
    figures : values by field; per metre for cables and chains
    guesses : reason for each value not from the file
    comment : source of the values
    hull : rows of draft [m], displaced volume [m³] and immersed area [m²], for a float
    entry : id of the catalogue entry that replaces the component, or empty
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
        """Create a chain if the line sinks and is called a chain, else a cable.

        `weight` in water is per metre [N/m], negative for a floating line. `figures` holds the
        other values by field.
        """
        figures["buoyancy" if weight < 0.0 else "weight"] = abs(weight)
        kind = "chain" if weight >= 0.0 and is_called(name, "chain") else "cable"
        return cls(name, kind, figures)

    def number(self, field: str) -> float:
        """Return the value of a field; 0 if the value is missing."""
        return float(self.figures.get(field, 0.0))

    def identity(self) -> tuple[object, ...]:
        """Return all values as a key; components with equal keys share a definition."""
        figures = tuple(sorted(self.figures.items(), key=lambda pair: pair[0]))
        return self.name, self.kind, figures, self.hull


@dataclass(eq=False)
class ImportedClamp:
    """A component clamped on a piece, `at` metres below the upper end of the piece."""

    component: ImportedComponent
    at: float
    guess: str = ""
    label: str = ""
    serial: str = ""
    planned_depth: float | None = None


@dataclass(eq=False)
class ImportedPiece:
    """A piece of the line; only cables and chains have a `length` [m]."""

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
        """Length of the piece [m]; for a rigid piece, the length of its component."""
        return self.component.number("length") if self.length is None else self.length

    def clamp(
        self, component: ImportedComponent, at: float, guess: str = "", label: str = "",
        serial: str = "",
    ) -> None:  # fmt: skip
        """Clamp a component on the piece; clamps stay in order from the top.

        `at` is the distance from the upper end of the piece [m]. `guess` is the reason for a
        guessed position, or empty.
        """
        self.clamps.append(ImportedClamp(component, at, guess, label, serial))
        self.clamps.sort(key=lambda clamp: clamp.at)


@dataclass(eq=False)
class ImportedLeg:
    """A leg of a net, with the pieces from the upper end down.

    `top` and `bottom` are the connections of the ends as in a mooring file, such as ``{join: A}``.
    An unneeded connection is empty.
    """

    name: str
    items: list[ImportedPiece]
    top: str = ""
    bottom: str = ""


def held_at(depth: float, east: float, north: float) -> str:
    """Return the mooring-file text for a leg end that is held in place.

    Parameters
    ----------
    depth : depth [m]
    east, north : position [m]
    """
    return f"{{held: {{depth: {depth:.9g} m, at: [{east:.9g} m, {north:.9g} m]}}}}"


def anchored_at(east: float, north: float, depth: float | None = None) -> str:
    """Return the mooring-file text for the lower end of a leg with an anchor.

    Position and depth are in metres; `depth` is needed only if it differs from the water depth.
    """
    deeper = "" if depth is None else f", depth: {depth:.9g} m"
    return f"{{anchor: {{at: [{east:.9g} m, {north:.9g} m]{deeper}}}}}"


def joined_at(node: str) -> str:
    """Return the mooring-file text for a leg end that joins other legs at a node."""
    return f"{{join: {node}}}"


@dataclass(eq=False)
class ImportedWater:
    """Water, current and wind of an imported design.

    Attributes
    ----------
    depth : water depth [m]; None for a tow if unknown
    density : density [kg/m³], or rows of depth and density
    gravity : acceleration of gravity [m/s²]
    current : rows of depth [m] and velocity (east, north, up) [m/s]
    wind : speed [m/s], and direction towards which the wind blows [degrees]
    guesses : reason for each value not from the file
    """

    depth: float | None
    density: float | tuple[tuple[float, float], ...] | None = None
    gravity: float | None = None
    current: tuple[tuple[float, float, float, float], ...] = ()
    wind: tuple[float, float] | None = None
    guesses: dict[str, str] = field(default_factory=dict)


@dataclass(eq=False)
class ImportedTow:
    """Speed [m/s] and course [degrees] of a tow, and height of the sheave above the water [m]."""

    speed: float
    toward: float
    height: float = 0.0


@dataclass(eq=False)
class ImportedDesign:
    """A mooring or a tow, as described by the file of another program.

    Attributes
    ----------
    items : pieces from the top (of a tow: from the ship) down; in a net, leg by leg
    water : None if the file has no environment
    environment : lines of the `environment` key that replaces `water`
    solver : keys of `solver`, each with its value and a comment
    guessed : remarks on guesses, except for values of a component
    dropped : remarks on contents that CALM cannot use
    notes : further comments at the head of the mooring file
    heading : values of further keys at the head of the mooring file, as text
    in_kilograms : whether the file gives forces in kilograms-force
    sunken : component that replaces the uppermost float if it is submerged in still water
    understood : interpretation of an ambiguous format, as text
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
        """Add a leg to the net.

        Parameters
        ----------
        items : pieces of the leg, from the upper end
        top, bottom : connections of the two ends, as in `ImportedLeg`
        """
        self.legs.append(ImportedLeg(f"leg-{len(self.legs) + 1}", items, top, bottom))
        self.items += items

    def components(self) -> Iterator[ImportedComponent]:
        """Yield the components of all pieces and of their clamps, with repetitions."""
        for item in self.items:
            yield item.component
            for clamp in item.clamps:
                yield clamp.component
