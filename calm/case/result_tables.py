"""Tables kept by column: one array per figure, records and data frames on demand."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property
from itertools import chain
from math import isfinite
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Protocol, Self, TypeVar

import numpy as np

from calm.errors import unknown
from calm.files import Clamp, Piece, Place
from calm.files.pieces import STAND_IN
from calm.physics.line import Floats
from calm.quantities import QUANTITIES

if TYPE_CHECKING:
    import pandas
    from xarray import Dataset

Row = TypeVar("Row")

_OF_THE_FILE = "part"
"""The column with the models of the file, left out of JSON and of a data frame."""


class ColumnTable(Generic[Row]):
    """A table of rows that is kept by column: `table.depth` has the `depth` of all its rows.

    A column is an array of numbers, or a list. Its names are those of the fields of `record`.
    """

    record: ClassVar[type[Any]]
    label: list[str]

    def __init__(self, **columns: Any) -> None:
        if sorted(columns) != sorted(self.names()):
            raise TypeError(f"the columns of {type(self).__name__} are {', '.join(self.names())}")
        vars(self).update({name: columns[name] for name in self.names()})

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """Return a column."""

    @classmethod
    def names(cls) -> list[str]:
        """Return the names of the columns, in their order."""
        return [each.name for each in fields(cls.record)]

    @classmethod
    def joined(cls, tables: Sequence[Self]) -> Self:
        """Return tables one after another."""
        columns = {name: [getattr(table, name) for table in tables] for name in cls.names()}
        whole = {
            name: [*chain(*parts)] if isinstance(parts[0], list) else np.concatenate(parts)
            for name, parts in columns.items()
        }
        return cls(**whole)

    def __repr__(self) -> str:
        """Return how many rows there are, and the labels at both ends."""
        shown = self.label if len(self) < 6 else [*self.label[:3], "…", self.label[-1]]
        return f"{type(self).__name__}({len(self)} rows: {', '.join(shown)})"

    def __len__(self) -> int:
        return len(self.label)

    def __getitem__(self, row: int | str) -> Row:
        """Return a row by its number or its label, as a record with the columns' names.

        KeyError: no row has the label; the one most like it is named.
        """
        if isinstance(row, int):
            return self._records[row]
        if row not in self.label:
            raise KeyError(unknown(f"no row is labelled {row!r}", row, self.label))
        return self._records[self.label.index(row)]

    def __iter__(self) -> Iterator[Row]:
        return iter(self._records)

    def __getstate__(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in self.names()}

    @cached_property
    def _records(self) -> tuple[Row, ...]:
        """The rows, which every rule of a design check goes through again."""
        columns = [getattr(self, name) for name in self.names()]
        # whole columns become plain numbers faster than their numbers one by one
        plain = [column if isinstance(column, list) else column.tolist() for column in columns]
        return tuple(map(self.record, *plain))

    def with_columns(self, **columns: Any) -> Self:
        """Return the same table with other columns in place of some of its own."""
        return type(self)(**{**self.__getstate__(), **columns})

    def head(self, count: int) -> Self:
        """Return the first rows."""
        return type(self)(**{name: part[:count] for name, part in self.__getstate__().items()})

    def with_row(self, row: Row) -> Self:
        """Return the same table with one more row."""
        last = {name: [getattr(row, name)] for name in self.names()}
        return self.joined([self, type(self)(**last)])

    def to_dicts(self) -> list[dict[str, Any]]:
        """The rows as dictionaries of plain numbers and text; None where unknown."""
        names = [name for name in self.names() if name != _OF_THE_FILE]
        return [{name: _known(getattr(row, name)) for name in names} for row in self]

    def to_pandas(self) -> pandas.DataFrame:
        """Return a pandas data frame with a row for each of its own."""
        import pandas

        names = (name for name in self.names() if name != _OF_THE_FILE)
        return pandas.DataFrame({name: getattr(self, name) for name in names})

    def to_xarray(self) -> Dataset:
        """Return a dataset over `label`, with units and meanings."""
        return _dataset(self.to_pandas(), "label")


def _dataset(columns: Mapping[str, Any], along: str) -> Dataset:
    """Columns of equal length as a dataset of one dimension."""
    from xarray import Dataset

    said = {
        name: {"units": QUANTITIES[name].unit or "1", "long_name": QUANTITIES[name].meaning}
        for name in columns
        if name in QUANTITIES
    }
    return Dataset({name: (along, [*columns[name]], said.get(name)) for name in columns})


def _known(value: Any) -> Any:
    return None if isinstance(value, float) and not isfinite(value) else value


@dataclass(frozen=True, slots=True)
class ComponentRow:
    """A piece of a solved line: a row of `Components`, which says what the figures are."""

    part: Piece = field(repr=False)
    index: int
    use: str
    label: str
    kind: str
    role: str
    length: float
    cut_length: float
    depth_top: float
    depth_bottom: float
    x_top: float
    y_top: float
    x_bottom: float
    y_bottom: float
    tension_top: float
    tension_bottom: float
    tension: float
    least_tension: float
    tilt: float
    knockdown: float
    safety_factor: float
    utilisation: float
    reynolds: float

    @property
    def place(self) -> Place:
        """Return which piece it is."""
        return self.part.place

    @property
    def upper(self) -> tuple[float, float, float]:
        """Depth, east and north of its upper end [m]."""
        return self.depth_top, self.x_top, self.y_top


@dataclass(frozen=True, slots=True)
class ClampRow:
    """An instrument clamped on a solved line: a row of `Clamps`."""

    part: Clamp = field(repr=False)
    index: int
    use: str
    label: str
    depth: float
    x: float
    y: float
    tension: float
    tilt: float
    knockdown: float

    @property
    def place(self) -> Place:
        """Return which clamp it is."""
        return self.part.place

    @property
    def upper(self) -> tuple[float, float, float]:
        """Depth, east and north of where it sits [m]."""
        return self.depth, self.x, self.y


class Components(ColumnTable[ComponentRow]):
    """The n pieces of the line in file order; NaN where a figure is unknown.

    Those of a mooring from the free end down, the anchor last; those of a tow from the ship.

    Attributes
    ----------
    part : (n,) the piece of the file
    index, use, label, kind, role : (n,) which it is, of what component
    length, cut_length : (n,) stretched and unstretched [m]
    depth_top, depth_bottom : (n,) of the first-listed and the other end [m], + down
    x_top, y_top, x_bottom, y_bottom : (n,) east and north of the anchor or the tow point [m]
    tension_top, tension_bottom, tension : (n,) at the ends and the greatest in the piece [N]
    least_tension : (n,) of what does not lie on the seabed [N]; NaN where all of a piece does
    tilt : (n,) of the chord from the lower to the upper end, from the vertical [degrees]
    knockdown : (n,) depth_top less the same in still water [m]; NaN in a tow
    safety_factor : (n,) breaking load / greatest tension
    utilisation : (n,) greatest tension / working load
    reynolds : (n,) greatest Reynolds number of speed and diameter
    """

    record = ComponentRow


class Clamps(ColumnTable[ClampRow]):
    """The m instruments clamped on the line, in file order.

    Attributes
    ----------
    part : (m,) the clamp of the file
    index : (m,) of the piece each sits on
    use, label : (m,)
    depth, x, y, knockdown : (m,) [m]
    tension : (m,) the greater of those above and below [N]
    tilt : (m,) of the pull in the line, of the sum of those above and below; on a rigid piece that
        of the piece [degrees]
    """

    record = ClampRow


@dataclass(frozen=True, repr=False)
class Shape:
    """The line node by node, free end first; a clamp's point twice (above, below).

    Attributes
    ----------
    depth, x, y : (k,) [m]
    tension : (k,) [N]
    tilt : (k,) of the segment that ends there [degrees]
    """

    depth: Floats
    x: Floats
    y: Floats
    tension: Floats
    tilt: Floats

    def __repr__(self) -> str:
        """Return how many nodes there are."""
        return f"Shape({len(self.depth)} nodes)"

    def to_dict(self) -> dict[str, list[float]]:
        """Return the columns as lists of plain numbers."""
        return {name: column.tolist() for name, column in vars(self).items()}

    def to_pandas(self) -> pandas.DataFrame:
        """Return a pandas data frame with a row a node."""
        import pandas

        return pandas.DataFrame(vars(self))

    def to_xarray(self) -> Dataset:
        """Return a dataset over `node`, with units and meanings."""
        return _dataset(vars(self), "node")


class WithClamps(Protocol):
    """Describe a result as far as its pieces and clamps go."""

    @property
    def components(self) -> Components:
        """Return the pieces."""

    @property
    def clamps(self) -> Clamps:
        """Return what is clamped on them."""


def rows_by_place(result: WithClamps) -> dict[Place, ComponentRow | ClampRow]:
    """Return every row of a result by the place of its piece or clamp."""
    return {row.place: row for row in (*result.components, *result.clamps)}


def rows_down(result: WithClamps) -> Iterator[tuple[ComponentRow, list[ClampRow]]]:
    """Yield the pieces of a result, each with what is clamped on it; no stand-in for an anchor."""
    on: dict[int, list[ClampRow]] = {}
    for clamp in result.clamps:
        on.setdefault(clamp.index, []).append(clamp)
    for component in result.components:
        if component.use != STAND_IN:
            yield component, on.get(component.index, [])
