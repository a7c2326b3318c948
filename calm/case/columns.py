"""What a column of a result is: its title and unit, what it means, how it is found, who shows it.

The columns themselves stand in `calm.case.result_tables`, one entry each. Tables, JSON, CSV,
NetCDF, the results of batches, the builder and the manual ask there, so that a column that is
entered appears in all outputs that its entry names.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from enum import Flag, auto
from types import SimpleNamespace
from typing import Any

from calm.dataset.netcdf import Attributes
from calm.files import MooringFile
from calm.quantities import QUANTITIES, Quantity

_ENTRY = "column"
_CF_UNITS = {"": "1", "deg": "degree", "m/s": "m s-1"}
"""Units as the CF conventions write them, where results have them otherwise."""


class Output(Flag):
    """Where a column appears; every one is an array of the tables in Python, too."""

    JSON = auto()
    CSV = auto()
    NETCDF = auto()
    """Of one equilibrium: `calm run`, `Result.to_xarray`."""
    BATCH = auto()
    """Of many profiles: `calm batch`, `calm motion`, `calm.solve_profiles`."""
    MOORING_TABLE = auto()
    TOW_TABLE = auto()
    NET_TABLE = auto()
    BUILDER = auto()


NOWHERE = Output(0)
FILES = Output.JSON | Output.CSV | Output.NETCDF
LINE_TABLES = Output.MOORING_TABLE | Output.TOW_TABLE | Output.NET_TABLE
_LAST = 1000


@dataclass(frozen=True)
class ResultColumn:
    """One figure, or word, of the rows of a result.

    It is found in one of four ways: `of_part` from the piece or clamp of the file, `found` from the
    arrays of a solved line, with `at_anchor` for the row of an anchor, `derived` from columns
    entered before it, or `of_row` when a row is shown.

    Attributes
    ----------
    name : in Python and JSON
    quantity : its title, the unit of its numbers, its digits; None of words
    description : what it is, for the manual and the `long_name` of NetCDF
    outputs : where it appears
    prefix : of its name in NetCDF and in batches
    of_part : its value for a piece or clamp of the file
    found : (n,) its values, of `LineFigures`, `ClampFigures` or `NodeFigures`
    at_anchor : its value for an anchor, of `LineEnd`, or for what is clamped on it, of `OnAnchor`
    derived : (…, n) its values, of the other columns by their names, with `part` of (n,)
    of_row : its value, of a row and the file of the mooring; kept in no table
    worst : that of several like pieces which share a row in the builder
    place : from the left in tables for people; without one on the right
    attributes : further ones of the NetCDF variable
    """

    name: str
    quantity: Quantity | None
    description: str
    outputs: Output = NOWHERE
    prefix: str = ""
    of_part: Callable[[Any], Any] | None = None
    found: Callable[[Any], Any] | None = None
    at_anchor: Callable[[Any], Any] | None = None
    derived: Callable[[Any], Any] | None = None
    of_row: Callable[[Any, MooringFile], Any] | None = None
    worst: Callable[[list[float]], float] = max
    place: int = _LAST
    attributes: Mapping[str, str] = field(default_factory=dict)

    @property
    def variable(self) -> str:
        """The name in NetCDF and in batches."""
        return self.prefix + self.name

    @property
    def header(self) -> str:
        """Name and unit as the head of a column of CSV."""
        return self.name if self.quantity is None else self.quantity.header

    @property
    def unit(self) -> str:
        """SI, or degrees; empty of a pure number and of words."""
        return "" if self.quantity is None else self.quantity.unit

    @property
    def term(self) -> tuple[str, str, Attributes]:
        """Unit, meaning and further attributes by the CF conventions."""
        return _CF_UNITS.get(self.unit, self.unit), self.description, dict(self.attributes)

    @property
    def described(self) -> Attributes:
        """The attributes of a variable by the CF conventions; words have no unit."""
        unit, meaning, more = self.term
        units = {} if self.quantity is None else {"units": unit}
        return {**units, "long_name": meaning, **more}

    def value(self, row: Any, file: MooringFile) -> Any:
        """What a row shows; None of one that has no such column, as a clamp has no length."""
        return self.of_row(row, file) if self.of_row else getattr(row, self.name, None)


def column(
    description: str,
    outputs: Output = NOWHERE,
    quantity: Quantity | None = None,
    *,
    in_repr: bool = True,
    **more: Any,
) -> Any:
    """Enter a column: the field of a class of rows, or of arrays, which gives it its name.

    Parameters
    ----------
    description, outputs, more : as of `ResultColumn`
    quantity : where `QUANTITIES` has none of the name; words have none
    in_repr : whether a row says it where it is printed
    """
    entry = ResultColumn("", quantity, description, outputs, **more)
    return field(repr=in_repr, metadata={_ENTRY: entry})


_known: dict[type[Any], tuple[ResultColumn, ...]] = {}


def columns_of(record: type[Any]) -> tuple[ResultColumn, ...]:
    """The columns of a class of rows, or of arrays, in their order.

    A field that is not entered by `column` has the words of the quantity of its name.
    """
    if record not in _known:
        _known[record] = tuple(_columns_of(record))
    return _known[record]


def _columns_of(record: type[Any]) -> Iterator[ResultColumn]:
    for one in fields(record):
        quantity = QUANTITIES.get(one.name)
        meaning = "" if quantity is None else quantity.meaning
        entry = one.metadata.get(_ENTRY) or ResultColumn("", quantity, meaning)
        own = entry.quantity or quantity
        prefix = getattr(record, "prefix", "")
        yield replace(entry, name=one.name, quantity=own, prefix=prefix)


def shown_in(columns: Iterable[ResultColumn], output: Output) -> list[ResultColumn]:
    """Those of some columns that appear in an output."""
    return [one for one in columns if output in one.outputs]


def terms(columns: Iterable[ResultColumn]) -> dict[str, tuple[str, str, Attributes]]:
    """Unit, meaning and attributes of the variables of columns, by their names."""
    return {one.variable: one.term for one in columns}


def derive(columns: Iterable[ResultColumn], known: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of the columns that follow from others, by name.

    Parameters
    ----------
    known : the others, by name; `part` are the pieces or clamps
    """
    rows, found = SimpleNamespace(**known), {}
    for one in columns:
        if one.derived is not None:
            found[one.name] = one.derived(rows)
            setattr(rows, one.name, found[one.name])
    return found
