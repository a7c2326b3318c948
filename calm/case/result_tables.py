"""Registry of result columns, and the tables of these columns.

To add a column, add a field with its entry to the class of the rows; longer computations belong in
`calm.case.line_figures`. `OF_ROWS`, `MOORED_ENDS` and `TOWED_ENDS` list columns that appear in
outputs only.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from itertools import chain
from math import hypot, isfinite, nan
from typing import TYPE_CHECKING, Any, ClassVar, Generic, NamedTuple, Protocol, Self, TypeVar

import numpy as np

from calm.case.columns import (
    FILES,
    LINE_TABLES,
    Output,
    ResultColumn,
    column,
    columns_of,
    derive,
    shown_in,
)
from calm.case.line_figures import catalogue_figures
from calm.errors import unknown
from calm.files import Clamp, MooringFile, Piece, Place
from calm.files.pieces import STAND_IN
from calm.physics.line import Floats
from calm.quantities import QUANTITIES

if TYPE_CHECKING:
    import pandas
    from xarray import Dataset

Row = TypeVar("Row")

_OF_THE_FILE = "part"
"""Column for the file's data model of a part, omitted in JSON and in data frames."""


class Columnar:
    """Table whose columns are attributes; for example, `table.depth` has the depths of all rows."""

    def __init__(self, **columns: Any) -> None:
        if sorted(columns) != sorted(self.names()):
            raise TypeError(f"{type(self).__name__} has only the columns {', '.join(self.names())}")
        self.__dict__ = {name: columns[name] for name in self.names()}

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any: ...

    @classmethod
    def names(cls) -> list[str]:
        """Return the names of the columns, in table order."""
        raise NotImplementedError

    def __getstate__(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in self.names()}

    def with_columns(self, **columns: Any) -> Self:
        """Return a copy of the table with some columns replaced."""
        return type(self)(**{**self.__getstate__(), **columns})


class ColumnTable(Columnar, Generic[Row]):
    """Table stored by column.

    A column is an array of numbers or a list. `table[row]` is a row by number or label. The columns
    have the names of the fields of `record`.
    """

    record: ClassVar[type[Any]]
    label: list[str]

    @classmethod
    def names(cls) -> list[str]:
        """Return the names of the columns, in table order."""
        return [each.name for each in fields(cls.record)]

    @classmethod
    def columns(cls, output: Output | None = None) -> list[ResultColumn]:
        """Return the definitions of all columns, or of the columns that an output shows."""
        every = columns_of(cls.record)
        return [*every] if output is None else shown_in(every, output)

    @classmethod
    def made(cls, parts: Sequence[Any], value: Callable[[ResultColumn], Any]) -> Self:
        """Build a table of pieces or clamps of a file, and compute its derived columns.

        The function `value` computes each column that has neither `of_part` nor `derived`.
        """
        known: dict[str, Any] = {}
        for one in cls.columns():
            if one.of_part is not None:
                known[one.name] = [one.of_part(part) for part in parts]
            elif one.derived is None:
                known[one.name] = value(one)
        return cls(**known, **derive(cls.columns(), known))

    @classmethod
    def joined(cls, tables: Sequence[Self]) -> Self:
        """Join the rows of several tables in one table."""
        columns = {name: [getattr(table, name) for table in tables] for name in cls.names()}
        whole = {
            name: [*chain(*parts)] if isinstance(parts[0], list) else np.concatenate(parts)
            for name, parts in columns.items()
        }
        return cls(**whole)

    def __repr__(self) -> str:
        shown = self.label if len(self) < 6 else [*self.label[:3], "…", self.label[-1]]
        return f"{type(self).__name__}({len(self)} rows: {', '.join(shown)})"

    def __len__(self) -> int:
        return len(self.label)

    def __getitem__(self, row: int | str) -> Row:
        if isinstance(row, int):
            return self._records[row]
        if row not in self.label:
            raise KeyError(unknown(f"no row is labelled {row!r}", row, self.label))
        return self._records[self.label.index(row)]

    def __iter__(self) -> Iterator[Row]:
        return iter(self._records)

    # cached for the rules of the design check
    @cached_property
    def _records(self) -> tuple[Row, ...]:
        columns = [getattr(self, name) for name in self.names()]
        # converting whole columns to plain numbers is faster than element by element
        plain = [column if isinstance(column, list) else column.tolist() for column in columns]
        return tuple(map(self.record, *plain))

    def rows(self, chosen: slice) -> Self:
        """Return a table that contains a slice of the rows."""
        return type(self)(**{name: part[chosen] for name, part in self.__getstate__().items()})

    def with_row(self, row: Row) -> Self:
        """Return a copy of the table with a row appended."""
        last = {name: [getattr(row, name)] for name in self.names()}
        return self.joined([self, type(self)(**last)])

    def to_dicts(self) -> list[dict[str, Any]]:
        """Return the rows as dictionaries of plain numbers and text; None stands for unknown
        values.
        """
        names = [name for name in self.names() if name != _OF_THE_FILE]
        return [{name: _known(getattr(row, name)) for name in names} for row in self]

    def to_pandas(self) -> pandas.DataFrame:
        """Return a pandas data frame with one row per table row."""
        import pandas

        names = (name for name in self.names() if name != _OF_THE_FILE)
        return pandas.DataFrame({name: getattr(self, name) for name in names})

    def to_xarray(self) -> Dataset:
        """Return a dataset along the dimension `label`.

        The variables have their units and meanings as attributes.
        """
        return _dataset(self.to_pandas(), self.columns(), "label")


def _dataset(values: Mapping[str, Any], columns: Sequence[ResultColumn], along: str) -> Dataset:
    from xarray import Dataset

    return Dataset(
        {
            one.name: (along, [*values[one.name]], one.described)
            for one in columns
            if one.name in values
        }
    )


def _known(value: Any) -> Any:
    return None if isinstance(value, float) and not isfinite(value) else value


class LineEnd(NamedTuple):
    """Input for the row of an anchor: the row above the anchor, the piece of the anchor, and the
    water depth [m].
    """

    above: ComponentRow
    piece: Piece
    seabed: float

    @property
    def height(self) -> float:
        """Height of the anchor [m]."""
        return self.piece.length or 0.0


class OnAnchor(NamedTuple):
    """Input for the row of a clamp on an anchor: the clamp, and the row of the anchor."""

    clamp: Clamp
    anchor: ComponentRow


_LEVEL = {"standard_name": "depth", "positive": "down"}
_EAST, _NORTH = "offset to the east of the anchor", "offset to the north of the anchor"
_IN_BATCHES = FILES | Output.BATCH
_OF_PIECES = FILES & ~Output.NETCDF
_OF_NODES = Output.JSON | Output.NETCDF
_WITH_PLANS = Output.JSON | Output.CSV | Output.MOORING_TABLE | Output.NET_TABLE | Output.BUILDER


def _planned(part: Piece | Clamp) -> float:
    return nan if part.planned_depth is None else part.planned_depth


@dataclass(frozen=True, slots=True)
class ComponentRow:
    """One piece of a solved line; a row of the table `Components`."""

    part: Piece = column("piece as defined in the file", of_part=lambda piece: piece, in_repr=False)
    index: int = column(
        "number of the piece in the file; the first piece has number 0",
        _OF_PIECES,
        title="no.",
        unit="",
        decimals=0,
        found=lambda line: line.index,
        at_anchor=lambda end: end.piece.index,
    )
    use: str = column("the component's id", _OF_PIECES, of_part=lambda piece: piece.use)
    label: str = column(
        "name of the piece in this line", _OF_PIECES, of_part=lambda piece: piece.label
    )
    kind: str = column("kind of component", of_part=lambda piece: piece.component.kind)
    role: str = column(
        "purpose of the piece, such as float or instrument",
        of_part=lambda piece: piece.component.role,
    )
    length: float = column(
        "length, stretched",
        FILES | LINE_TABLES,
        place=1,
        found=lambda line: line.length,
        at_anchor=lambda end: end.height,
    )
    cut_length: float = column(
        "unstretched length",
        FILES,
        found=lambda line: line.cut_length,
        at_anchor=lambda end: end.height,
    )
    depth_top: float = column(
        "depth of the upper end",
        _IN_BATCHES,
        title="depth, upper end",
        unit="m",
        found=lambda line: -line.top[:, 2],
        at_anchor=lambda end: end.above.depth_bottom,
        attributes=_LEVEL,
    )
    depth_bottom: float = column(
        "depth of the lower end",
        FILES,
        title="depth, lower end",
        unit="m",
        found=lambda line: -line.bottom[:, 2],
        at_anchor=lambda end: end.seabed,
        attributes=_LEVEL,
    )
    planned_depth: float = column(
        "planned depth of the upper end in still water; unknown without a plan",
        _WITH_PLANS,
        place=2,
        of_part=lambda piece: _planned(piece),
    )
    x_top: float = column(
        f"{_EAST}, at the upper end",
        _IN_BATCHES,
        title="east, upper end",
        unit="m",
        found=lambda line: line.top[:, 0],
        at_anchor=lambda end: end.above.x_bottom,
    )
    y_top: float = column(
        f"{_NORTH}, at the upper end",
        _IN_BATCHES,
        title="north, upper end",
        unit="m",
        found=lambda line: line.top[:, 1],
        at_anchor=lambda end: end.above.y_bottom,
    )
    x_bottom: float = column(
        "offset to the east, at the lower end",
        FILES,
        title="east, lower end",
        unit="m",
        found=lambda line: line.bottom[:, 0],
        at_anchor=lambda end: end.above.x_bottom,
    )
    y_bottom: float = column(
        "offset to the north, at the lower end",
        FILES,
        title="north, lower end",
        unit="m",
        found=lambda line: line.bottom[:, 1],
        at_anchor=lambda end: end.above.y_bottom,
    )
    tension_top: float = column(
        "tension at the upper end",
        _IN_BATCHES,
        title="tension, upper end",
        unit="N",
        decimals=0,
        found=lambda line: line.tension_top,
        at_anchor=lambda end: end.above.tension_bottom,
    )
    tension_bottom: float = column(
        "tension at the lower end",
        _IN_BATCHES,
        title="tension, lower end",
        unit="N",
        decimals=0,
        found=lambda line: line.tension_bottom,
        at_anchor=lambda end: end.above.tension_bottom,
    )
    tension: float = column(
        "maximum tension in the piece",
        LINE_TABLES | Output.BUILDER,
        place=10,
        found=lambda line: line.greatest_tension,
        at_anchor=lambda end: end.above.tension_bottom,
    )
    least_tension: float = column(
        "minimum tension in the suspended part; unknown if the whole piece lies on the seabed",
        title="minimum tension",
        unit="N",
        decimals=0,
        found=lambda line: line.least_tension,
        at_anchor=lambda end: end.above.tension_bottom,
    )
    tilt: float = column(
        "angle between the vertical and the chord of the piece",
        _IN_BATCHES | LINE_TABLES | Output.BUILDER,
        place=9,
        found=lambda line: line.tilt,
        at_anchor=lambda end: 0.0,
    )
    knockdown: float = column(
        "depth of the upper end minus its depth in still water",
        _IN_BATCHES | Output.MOORING_TABLE | Output.NET_TABLE,
        place=6,
        found=lambda line: line.knockdown,
        at_anchor=lambda end: 0.0,
    )
    safety_factor: float = column(
        "breaking load divided by the maximum tension",
        FILES | LINE_TABLES,
        place=11,
        derived=lambda rows: (
            catalogue_figures(rows.part, "breaking_load")
            / np.where(rows.tension > 0, rows.tension, nan)
        ),
    )
    utilisation: float = column(
        "maximum tension divided by the working load",
        FILES,
        derived=lambda rows: rows.tension / catalogue_figures(rows.part, "working_load"),
    )
    reynolds: float = column(
        "largest Reynolds number, computed from current speed and diameter",
        Output.JSON,
        title="Reynolds number",
        unit="",
        decimals=0,
        found=lambda line: line.reynolds,
        at_anchor=lambda end: nan,
    )

    @property
    def place(self) -> Place:
        """Place of the piece in the file."""
        return self.part.place

    @property
    def upper(self) -> tuple[float, float, float]:
        """Depth, east and north of the upper end of the piece [m]."""
        return self.depth_top, self.x_top, self.y_top


@dataclass(frozen=True, slots=True)
class ClampRow:
    """One clamped instrument of a solved line; a row of the table `Clamps`."""

    prefix: ClassVar[str] = "clamp_"

    part: Clamp = column("clamp as defined in the file", of_part=lambda clamp: clamp, in_repr=False)
    index: int = column(
        "number of the piece that carries the clamp; the first piece has number 0",
        _OF_PIECES,
        title="no.",
        unit="",
        decimals=0,
        found=lambda held: held.index,
        at_anchor=lambda on: on.anchor.index,
    )
    use: str = column("the component's id", _OF_PIECES, of_part=lambda clamp: clamp.use)
    label: str = column(
        "name of the clamp in this line", _OF_PIECES, of_part=lambda clamp: clamp.label
    )
    depth: float = column(
        "depth of the clamped instrument",
        _IN_BATCHES,
        found=lambda held: -held.position[:, 2],
        at_anchor=lambda on: on.anchor.depth_top + on.clamp.at,
        attributes=_LEVEL,
    )
    planned_depth: float = column(
        "planned depth of the clamped instrument in still water; unknown without a plan",
        _WITH_PLANS,
        of_part=lambda clamp: _planned(clamp),
    )
    x: float = column(
        f"{_EAST}, at the clamped instrument",
        _IN_BATCHES,
        found=lambda held: held.position[:, 0],
        at_anchor=lambda on: on.anchor.x_bottom,
    )
    y: float = column(
        f"{_NORTH}, at the clamped instrument",
        _IN_BATCHES,
        found=lambda held: held.position[:, 1],
        at_anchor=lambda on: on.anchor.y_bottom,
    )
    tension: float = column(
        "tension at the clamp",
        _IN_BATCHES,
        found=lambda held: held.tension,
        at_anchor=lambda on: on.anchor.tension,
    )
    tilt: float = column(
        "angle between the vertical and the line at the clamp",
        _IN_BATCHES,
        found=lambda held: held.tilt,
        at_anchor=lambda on: on.anchor.tilt,
    )
    knockdown: float = column(
        "depth of the clamped instrument minus its depth in still water",
        _IN_BATCHES,
        found=lambda held: held.knockdown,
        at_anchor=lambda on: on.anchor.knockdown,
    )

    @property
    def place(self) -> Place:
        """Place of the clamp in the file."""
        return self.part.place

    @property
    def upper(self) -> tuple[float, float, float]:
        """Depth, east and north of the clamp [m]."""
        return self.depth, self.x, self.y


def _height(row: ComponentRow | ClampRow, file: MooringFile) -> float:
    bottom = file.environment.depth
    return nan if bottom is None else bottom - row.upper[0]


def _offset(row: ComponentRow | ClampRow, _: MooringFile) -> float:
    return hypot(*row.upper[1:])


def _leg(row: ComponentRow | ClampRow, file: MooringFile) -> str | None:
    alone = len(file.legs) == 1
    own = (leg.name for leg in file.legs if alone or leg.first <= row.index < leg.end)
    return next(own, None)


OF_ROWS = tuple(
    ResultColumn(name, QUANTITIES.get(name), description, outputs, of_row=of_row, **more)
    for name, description, outputs, of_row, more in (
        ("depth", "depth of the upper end", LINE_TABLES | Output.BUILDER,
         lambda row, _: row.upper[0], {"place": 2, "worst": lambda depths: depths[0]}),
        ("layback", "horizontal distance of the upper end behind the tow point",
         Output.TOW_TABLE, _offset, {"place": 3}),
        ("x", _EAST, Output.NET_TABLE, lambda row, _: row.upper[1], {"place": 3}),
        ("y", _NORTH, Output.NET_TABLE, lambda row, _: row.upper[2], {"place": 4}),
        ("height", "height of the upper end above the seabed", Output.MOORING_TABLE, _height,
         {"place": 5}),
        ("offset", "horizontal distance of the upper end from the anchor",
         Output.MOORING_TABLE, _offset, {"place": 7}),
        ("serial", "serial number, if specified in the file", Output.JSON,
         lambda row, _: row.part.serial, {}),
        ("leg", "name of the leg in a net", Output.JSON | Output.CSV, _leg, {}),
    )
)  # fmt: skip
"""Columns of pieces and clamps that are computed row by row for output and not stored. JSON omits a
column whose value is None.
"""


class Components(ColumnTable[ComponentRow]):
    """Table of the n pieces of the line, in file order. NaN stands for unknown values.

    A mooring is listed from the free end down, with the anchor last; a tow from the ship down. The
    columns are the fields of `ComponentRow`, in m, N and degrees. x and y are distances to the east
    and north of the anchor or the tow point; depths are positive down. `knockdown` is NaN in a tow.
    """

    record = ComponentRow


class Clamps(ColumnTable[ClampRow]):
    """Table of the m clamped instruments, in file order.

    The columns are the fields of `ClampRow`. `tension` is the larger of the tensions above and
    below the clamp [N]. For `tilt`, see `calm.case.line_figures.ClampFigures`.
    """

    record = ClampRow


def documents(table: Components | Clamps, file: MooringFile) -> list[dict[str, Any]]:
    """Convert the rows of a table to JSON objects; None stands for unknown values."""
    own, of_the_file = table.columns(Output.JSON), shown_in(OF_ROWS, Output.JSON)
    rows = []
    for row in table:
        values = {one.name: _known(getattr(row, one.name)) for one in own}
        more = {one.name: one.value(row, file) for one in of_the_file}
        rows.append(values | {name: value for name, value in more.items() if value is not None})
    return rows


def table_columns(output: Output) -> list[ResultColumn]:
    """Return the columns of a table in an output, from left to right.

    The columns of the builder are in the order of their definition.
    """
    shown = shown_in((*OF_ROWS, *Components.columns()), output)
    return shown if output == Output.BUILDER else sorted(shown, key=lambda one: one.place)


@dataclass(frozen=True, repr=False)
class Shape:
    """Shape of the line, node by node from the free end. A clamp has two nodes, above and below it.

    Attributes
    ----------
    depth, x, y : (k,) depth, east and north [m]
    tension : (k,) tension [N]
    tilt : (k,) angle from the vertical of the segment between each node and the node before it
        [degrees]
    """

    prefix: ClassVar[str] = "shape_"

    depth: Floats = column(
        "depth of the node",
        _OF_NODES,
        found=lambda nodes: -nodes.position[:, 2],
        attributes=_LEVEL,
    )
    x: Floats = column(
        f"{_EAST}, at the node",
        _OF_NODES,
        found=lambda nodes: nodes.position[:, 0],
    )
    y: Floats = column(
        f"{_NORTH}, at the node",
        _OF_NODES,
        found=lambda nodes: nodes.position[:, 1],
    )
    tension: Floats = column("tension at the node", _OF_NODES, found=lambda nodes: nodes.tension)
    tilt: Floats = column(
        "angle between the vertical and the segment that ends at the node",
        _OF_NODES,
        found=lambda nodes: nodes.tilt,
    )

    @classmethod
    def columns(cls, output: Output | None = None) -> list[ResultColumn]:
        """Return the definitions of all columns, or of the columns that an output shows."""
        every = columns_of(cls)
        return [*every] if output is None else shown_in(every, output)

    def __repr__(self) -> str:
        return f"Shape({len(self.depth)} nodes)"

    def to_dict(self) -> dict[str, list[float]]:
        """Return the columns as lists of Python numbers."""
        return {one.name: getattr(self, one.name).tolist() for one in self.columns(Output.JSON)}

    def to_pandas(self) -> pandas.DataFrame:
        """Return a pandas data frame with one row per node."""
        import pandas

        return pandas.DataFrame(vars(self))

    def to_xarray(self) -> Dataset:
        """Return a dataset along the dimension `node`.

        The variables have their units and meanings as attributes.
        """
        return _dataset(vars(self), self.columns(), "node")


# Ends of lines. `calm.case` fills these records; all fields are in JSON.

_AN_END = Output.JSON | Output.NET_TABLE


@dataclass(frozen=True)
class Accuracy:
    """Error estimates of the solver.

    Values for the anchor are None if there is no anchor, as in a tow.
    """

    depth: float = column("estimate of the largest error of any depth or offset", Output.JSON)
    tension: float = column("estimate of the largest error of any tension", Output.JSON)
    anchor: float | None = column(
        "estimate of the largest error of the vertical and horizontal anchor load",
        Output.JSON,
        title="anchor load",
        unit="N",
        decimals=0,
        default=None,
    )
    required_weight: float | None = column(
        "estimate of the error of the anchor's required weight in water", Output.JSON, default=None
    )


@dataclass(frozen=True)
class Top:
    """Values at the free end of a line; unavailable values are None."""

    depth: float = column("depth of the free end", Output.JSON)
    x: float = column(f"{_EAST}, at the free end", Output.JSON)
    y: float = column(f"{_NORTH}, at the free end", Output.JSON)
    knockdown: float | None = column(
        "depth of the free end minus its depth in still water", Output.JSON
    )
    used_buoyancy: float = column(
        "used fraction of the buoyancy of the float at the surface; 1 if the float is submerged",
        Output.JSON,
    )
    reserve: float = column(
        "unused buoyancy of the float at the surface; 0 if the float is submerged", Output.JSON
    )
    draft: float | None = column(
        "draft of the hull at the surface, if the hull is known", Output.JSON, default=None
    )
    freeboard: float | None = column(
        "freeboard of the hull at the surface, if the hull is known", Output.JSON, default=None
    )


@dataclass(frozen=True)
class AnchorLoad:
    """The load of a line on its anchor."""

    tension: float = column("tension of the line at the anchor", Output.JSON)
    vertical: float = column("upward pull of the line on the anchor", Output.JSON)
    horizontal: float = column("horizontal pull of the line on the anchor", Output.JSON)
    angle: float = column("angle of the pull from the vertical", Output.JSON)
    required_weight: float = column("weight in water that the anchor needs", Output.JSON)
    weight: float = column("weight of the anchor in water", Output.JSON)
    friction: float = column("coefficient of friction of the anchor on the seabed", Output.JSON)
    grounded_length: float = column("unstretched length of line on the seabed", Output.JSON)


@dataclass(frozen=True)
class TowPoint:
    """The load of a towed line on the ship."""

    tension: float = column("tension of the line at the ship", Output.JSON)
    angle: float = column(
        "angle between the horizontal and the line at the ship, positive down", Output.JSON
    )
    vertical: float = column("downward pull on the ship", Output.JSON)
    horizontal: float = column("backward pull on the ship", Output.JSON)


@dataclass(frozen=True)
class TowedBody:
    """Values at the upper end of the lowest piece of a tow, or at the free end of a bare cable."""

    depth: float = column("depth of the towed body", Output.JSON)
    layback: float = column("horizontal distance behind the tow point", Output.JSON)
    tension: float = column("tension at the towed body", Output.JSON)
    angle: float = column(
        "angle between the horizontal and the line just above the body", Output.JSON
    )


@dataclass(frozen=True)
class EndLoad:
    """Load of a leg on its anchor or on another support.

    The last four attributes are only set for an anchor.
    """

    leg: str = column("name of the leg", Output.JSON)
    tension: float = column("tension of the leg at this end", _AN_END, title="tension", place=1)
    vertical: float = column("upward pull of the leg", _AN_END, title="vertical", place=2)
    horizontal: float = column("horizontal pull of the leg", _AN_END, title="horizontal", place=3)
    angle: float = column("angle of the pull from the vertical", Output.JSON)
    x: float = column("offset of the end to the east of the origin", _AN_END, place=5)
    y: float = column("offset of the end to the north of the origin", _AN_END, place=6)
    depth: float = column("depth of the end", _AN_END, place=4)
    required_weight: float | None = column(
        "weight in water that the anchor needs", _AN_END, title="required", place=7, default=None
    )
    weight: float | None = column("weight of the anchor in water", Output.JSON, default=None)
    grounded_length: float = column(
        "unstretched length of the leg on the seabed", Output.JSON, default=0.0
    )
    slack_length: float = column(
        "length on the seabed minus the distance from the touchdown point to the anchor",
        Output.JSON,
        title="slack length",
        unit="m",
        default=0.0,
    )


@dataclass(frozen=True)
class NodePlace:
    """Position of a node that joins legs."""

    name: str = column("name of the node", Output.JSON)
    depth: float = column("depth of the node", _AN_END)
    x: float = column("offset of the node to the east of the origin", _AN_END)
    y: float = column("offset of the node to the north of the origin", _AN_END)
    imbalance: float = column(
        "magnitude of the sum of all forces at the node; 0 in exact equilibrium",
        Output.JSON,
        title="imbalance",
        unit="N",
        decimals=2,
    )


ENDS: Mapping[str, type[Any]] = {
    "accuracy": Accuracy,
    "top": Top,
    "anchor": AnchorLoad,
    "tow_point": TowPoint,
    "body": TowedBody,
}
"""Types of the end records of a single line, by their names in JSON and in the Python result."""

NET_ENDS: Mapping[str, type[Any]] = {"anchors": EndLoad, "held": EndLoad, "nodes": NodePlace}
"""Types of the end records of a net, by name; each name refers to a list of records."""


def _free(line: Any) -> float:
    """Return 1 for a free upper end, and NaN for an upper end that is held or joined."""
    legs = line.file.legs
    return 1.0 if not legs or legs[0].top.free else nan


_OF_ENDS = Output.NETCDF | Output.BATCH
MOORED_ENDS = (
    ResultColumn(
        "top_depth",
        QUANTITIES["depth"],
        "depth of the free end",
        _OF_ENDS,
        found=lambda line: _free(line) * line.top.depth,
        attributes=_LEVEL,
    ),
    ResultColumn(
        "anchor_vertical",
        QUANTITIES["vertical"],
        "upward pull of the line on the anchor",
        _OF_ENDS,
        found=lambda line: line.anchor_load.vertical,
    ),
    ResultColumn(
        "anchor_horizontal",
        QUANTITIES["horizontal"],
        "horizontal pull of the line on the anchor",
        _OF_ENDS,
        found=lambda line: line.anchor_load.horizontal,
    ),
    ResultColumn(
        "used_buoyancy",
        QUANTITIES["used_buoyancy"],
        "used fraction of the buoyancy of the float at the surface",
        _OF_ENDS,
        found=lambda line: _free(line) * line.top.used_buoyancy,
    ),
    ResultColumn(
        "other_used_buoyancy",
        QUANTITIES["used_buoyancy"],
        "used fraction of the float's buoyancy in another equilibrium, if one was found",
        _OF_ENDS,
        found=lambda line: _free(line) * line.other_used_buoyancy,
    ),
)
"""Columns of the end values of a moored line, or of each leg of a net."""

TOWED_ENDS = (
    ResultColumn(
        "speed",
        QUANTITIES["speed"],
        "speed of the ship over the ground",
        Output.NETCDF,
        found=lambda tow: tow.file.tow.speed,
        attributes={"standard_name": "platform_speed_wrt_ground"},
    ),
    ResultColumn(
        "body_depth",
        QUANTITIES["depth"],
        "depth of the towed body",
        Output.NETCDF,
        found=lambda tow: tow.body.depth,
        attributes=_LEVEL,
    ),
    ResultColumn(
        "layback",
        QUANTITIES["layback"],
        "horizontal distance of the towed body behind the tow point",
        Output.NETCDF,
        found=lambda tow: tow.body.layback,
    ),
    ResultColumn(
        "tow_tension",
        QUANTITIES["tension"],
        "tension at the tow point",
        Output.NETCDF,
        found=lambda tow: tow.tow_point.tension,
    ),
)
"""Columns of the end values of a tow."""


class WithClamps(Protocol):
    """Protocol of results that have pieces and clamps."""

    @property
    def components(self) -> Components:
        """Pieces of the line."""

    @property
    def clamps(self) -> Clamps:
        """Instruments clamped on the pieces."""


def rows_by_place(result: WithClamps) -> dict[Place, ComponentRow | ClampRow]:
    """Return the result rows of all pieces and clamps, by their places in the file."""
    return {row.place: row for row in (*result.components, *result.clamps)}


def item_numbers(*results: WithClamps) -> dict[str, str]:
    """Return the item number of each piece and clamp, by label; all documents use these numbers.

    Pieces are numbered from 1 through all `results`. A clamp has the number of its piece and a
    letter, such as ``3a``.
    """
    found: dict[str, str] = {}
    rows = (row for result in results for row in rows_down(result))
    for piece, (row, clamps) in enumerate(rows, 1):
        found[row.label] = str(piece)
        for at, clamp in enumerate(clamps):
            found[clamp.label] = f"{piece}{chr(ord('a') + at) if at < 26 else f'.{at + 1}'}"
    return found


def run_of(numbers: Sequence[str]) -> str:
    """Format the numbers of items that share a row, such as `19–26` or `5a–5c, 6`.

    Clamp numbers are omitted if the first number refers to a piece.
    """
    pieces = sorted(int(one) for one in numbers if one.isdigit())
    clamps = [] if numbers[0].isdigit() else [one for one in numbers if not one.isdigit()]
    runs = (clamps, [*map(str, pieces)])
    return ", ".join("–".join(dict.fromkeys((run[0], run[-1]))) for run in runs if run)


def rows_down(result: WithClamps) -> Iterator[tuple[ComponentRow, list[ClampRow]]]:
    """Yield the pieces of a result, each followed by its clamps, without stand-ins for anchors."""
    on: dict[int, list[ClampRow]] = {}
    for clamp in result.clamps:
        on.setdefault(clamp.index, []).append(clamp)
    for component in result.components:
        if component.use != STAND_IN:
            yield component, on.get(component.index, [])
