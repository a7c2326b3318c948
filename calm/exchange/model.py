"""Common design model of all importers, in the terms of a mooring file.

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
    defines : macros of WHOI Cable; or catalogue ids by the names that oceanarray uses
    columns : the headings of a table, by the name of the column in CALM
    elements : a library with the figures missing in a table
    allow_include : whether a file may include one from outside its folder
    sheet : name of the sheet with the list in a workbook; None if only one can be meant
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
    name : its name in that file
    kind : sphere, cylinder, body, cable, chain or anchor
    figures : figures by the fields of `kind`; those of cables and chains are per metre
    guesses : for each field that is not from the file, why
    comment : comment about the source of the figures
    hull : rows of draft [m], displaced volume [m³] and immersed area [m²]
    entry : id of the catalogue entry that replaces it, if any
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
        """Create a cable, or a chain if its name says so and it sinks.

        Parameters
        ----------
        name : its name in that file
        weight : weight in water per metre, negative for a line that floats [N]
        figures : its diameter and drag; the weight is added here
        """
        figures["buoyancy" if weight < 0.0 else "weight"] = abs(weight)
        kind = "chain" if weight >= 0.0 and is_called(name, "chain") else "cable"
        return cls(name, kind, figures)

    def number(self, field: str) -> float:
        """Return a value; 0 if it is missing."""
        return float(self.figures.get(field, 0.0))

    def identity(self) -> tuple[object, ...]:
        """All values, as a key: components with equal keys share a definition."""
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
        """Length of the piece [m], else of its component."""
        return self.component.number("length") if self.length is None else self.length

    def clamp(
        self, component: ImportedComponent, at: float, guess: str = "", label: str = "",
        serial: str = "",
    ) -> None:  # fmt: skip
        """Clamp a component on this piece, below the existing clamps.

        Parameters
        ----------
        component : the component
        at : distance from its upper end [m]
        guess : why the place is guessed; empty if it is from the file
        label, serial : its name in results, and its serial number
        """
        self.clamps.append(ImportedClamp(component, at, guess, label, serial))
        self.clamps.sort(key=lambda clamp: clamp.at)


@dataclass(eq=False)
class ImportedLeg:
    """A leg of a net.

    `items` are its pieces from the upper end. `top` and `bottom` are the keys of its ends as in a
    mooring file, such as ``{join: A}``; empty if the key is not needed.
    """

    name: str
    items: list[ImportedPiece]
    top: str = ""
    bottom: str = ""


def held_at(depth: float, east: float, north: float) -> str:
    """Return the key for a leg end that is held at a depth and a position [m]."""
    return f"{{held: {{depth: {depth:.9g} m, at: [{east:.9g} m, {north:.9g} m]}}}}"


def anchored_at(east: float, north: float, depth: float | None = None) -> str:
    """Return the key for a lower leg end with an anchor at a position [m].

    `depth` [m] is given if the anchor is not at the depth of the water.
    """
    deeper = "" if depth is None else f", depth: {depth:.9g} m"
    return f"{{anchor: {{at: [{east:.9g} m, {north:.9g} m]{deeper}}}}}"


def joined_at(node: str) -> str:
    """Return the key for a leg end that joins other legs at a node."""
    return f"{{join: {node}}}"


@dataclass(eq=False)
class ImportedWater:
    """Water, current and wind of an imported design.

    Attributes
    ----------
    depth : depth of the water [m]; None in a tow whose file gives none
    density : density [kg/m³], or rows of depth and density; None if the file gives none
    gravity : gravitational acceleration [m/s²]
    current : rows of depth [m] and speeds east, north and up [m/s]
    wind : speed [m/s] and the direction toward which it blows [degrees]
    guesses : for each field that is not from the file, why
    """

    depth: float | None
    density: float | tuple[tuple[float, float], ...] | None = None
    gravity: float | None = None
    current: tuple[tuple[float, float, float, float], ...] = ()
    wind: tuple[float, float] | None = None
    guesses: dict[str, str] = field(default_factory=dict)


@dataclass(eq=False)
class ImportedTow:
    """Speed [m/s] and course [degrees] of a tow, and sheave height above the water [m]."""

    speed: float
    toward: float
    height: float = 0.0


@dataclass(eq=False)
class ImportedDesign:
    """A mooring or a tow, as described by the file of another program.

    Attributes
    ----------
    program : the program that wrote the file
    items : pieces from the top down (in a tow from the ship, in a net leg after leg)
    legs : the legs of a net
    water : the environment; None if the file gives none
    environment : lines of the `environment` key that replaces `water`
    solver : keys of `solver`, each with its value and a comment
    guessed : guesses about the design; those about a figure are kept with it
    dropped : what the file gives but CALM cannot use
    notes : further comments at the head of the mooring file
    heading : further keys of the mooring file, as text
    in_kilograms : whether the file gives forces in kilograms-force
    sunken : definition of the uppermost component if it turns out to be submerged once the line is
        solved; None if the file decides this
    understood : how the file was interpreted, as a text; empty if its format leaves no choice
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
        """Add a leg to the net, with its pieces listed from the upper end."""
        self.legs.append(ImportedLeg(f"leg-{len(self.legs) + 1}", items, top, bottom))
        self.items += items

    def components(self) -> Iterator[ImportedComponent]:
        """Yield the component of every piece, then the components of its clamps, with
        repetitions.
        """
        for item in self.items:
            yield item.component
            for clamp in item.clamps:
                yield clamp.component
