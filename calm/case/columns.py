"""Definition of a result column: title, unit, description, computation and outputs.

`calm.case.result_tables` has one entry for each column. The entry names the outputs in which the
column appears.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import MISSING, dataclass, field, fields, replace
from enum import Flag, auto
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from calm.quantities import QUANTITIES, Quantity

if TYPE_CHECKING:
    from calm.dataset.netcdf import Attributes
    from calm.files import MooringFile

_ENTRY = "column"
_CF_UNITS = {"": "1", "deg": "degree", "m/s": "m s-1"}
"""CF spelling of the units that CALM spells differently."""


class Output(Flag):
    """Outputs in which a column can appear. In Python, every column is available as an array of its
    table.
    """

    JSON = auto()
    CSV = auto()
    NETCDF = auto()
    """NetCDF file or `to_xarray` of one equilibrium."""
    BATCH = auto()
    """Results of many profiles: `calm batch`, `calm motion`, `calm.solve_profiles`."""
    MOORING_TABLE = auto()
    TOW_TABLE = auto()
    NET_TABLE = auto()
    BUILDER = auto()


NO_OUTPUT = Output(0)
FILES = Output.JSON | Output.CSV | Output.NETCDF
LINE_TABLES = Output.MOORING_TABLE | Output.TOW_TABLE | Output.NET_TABLE
_LAST = 1000


@dataclass(frozen=True)
class ResultColumn:
    """A column of a result table, computed by at most one of its functions.

    Attributes
    ----------
    name : name in Python and JSON
    quantity : title, unit and digits of a numeric column; None for text
    description : meaning, for the manual and the NetCDF `long_name`
    prefix : prefix of the name in NetCDF and batches
    of_part : function that returns the value for a piece or clamp of the file
    found : function that returns the values (n,) from `LineFigures`, `ClampFigures` or
        `NodeFigures`
    at_anchor : function that returns the value for an anchor from a `LineEnd`, or for a clamp on
        the anchor from an `OnAnchor`. `found` does not cover these rows
    derived : function that returns the values (…, n) from other columns. The argument is a
        namespace with the earlier columns, and with the n pieces or clamps as `part`
    of_row : function that returns the value for outputs from a row and the mooring file
    worst : selects the value shown in the builder if several pieces share a row
    place : rank from the left in printed tables; columns without a rank come last
    attributes : additional attributes of the NetCDF variable
    """

    name: str
    quantity: Quantity | None
    description: str
    outputs: Output = NO_OUTPUT
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
        """Name in NetCDF and batches."""
        return self.prefix + self.name

    @property
    def header(self) -> str:
        """Heading in CSV: name and unit."""
        return self.name if self.quantity is None else self.quantity.header

    @property
    def unit(self) -> str:
        """SI unit, or degrees; empty for text and pure numbers."""
        return "" if self.quantity is None else self.quantity.unit

    @property
    def term(self) -> tuple[str, str, Attributes]:
        """CF unit, description and additional attributes."""
        return _CF_UNITS.get(self.unit, self.unit), self.description, dict(self.attributes)

    @property
    def described(self) -> Attributes:
        """Attributes of the NetCDF variable; a text variable has no unit."""
        unit, meaning, more = self.term
        units = {} if self.quantity is None else {"units": unit}
        return {**units, "long_name": meaning, **more}

    def value(self, row: Any, file: MooringFile) -> Any:
        """Return the value to show for a row, or None for a missing value, such as the length of a
        clamp.
        """
        return self.of_row(row, file) if self.of_row else getattr(row, self.name, None)


def column(
    description: str,
    outputs: Output = NO_OUTPUT,
    *,
    title: str = "",
    unit: str | None = None,
    decimals: int = 1,
    in_repr: bool = True,
    default: Any = MISSING,
    **more: Any,
) -> Any:
    """Declare a dataclass field as a result column with the name of the field.

    Parameters
    ----------
    description, outputs, more : attributes of the `ResultColumn`
    title, unit, decimals : properties of the quantity. If `unit` is None, the quantity is the entry
        of `QUANTITIES` with the name of the field, and `title` replaces its heading. If
        `QUANTITIES` has no such entry, the column is text
    in_repr : whether the `repr` of a row includes the field
    """

    def named(name: str, prefix: str) -> ResultColumn:
        quantity = QUANTITIES.get(name)
        if unit is not None:
            quantity = Quantity(name, title, unit, f"{description.capitalize()}.", decimals)
        elif quantity is not None and title:
            quantity = replace(quantity, heading=title)
        return ResultColumn(name, quantity, description, outputs, prefix, **more)

    return field(default=default, repr=in_repr, metadata={_ENTRY: named})


_known: dict[type[Any], tuple[ResultColumn, ...]] = {}


def columns_of(record: type[Any]) -> tuple[ResultColumn, ...]:
    """Return the columns of a dataclass, in the order of its fields.

    Fields that are declared without `column` have the title and meaning of their entry in
    `QUANTITIES`.
    """
    if record not in _known:
        _known[record] = tuple(_columns_of(record))
    return _known[record]


def _columns_of(record: type[Any]) -> Iterator[ResultColumn]:
    for one in fields(record):
        if (named := one.metadata.get(_ENTRY)) is not None:
            yield named(one.name, getattr(record, "prefix", ""))
        else:
            quantity = QUANTITIES.get(one.name)
            yield ResultColumn(one.name, quantity, "" if quantity is None else quantity.meaning)


def shown_in(columns: Iterable[ResultColumn], output: Output) -> list[ResultColumn]:
    """Return the columns that appear in an output."""
    return [one for one in columns if output in one.outputs]


def terms(columns: Iterable[ResultColumn]) -> dict[str, tuple[str, str, Attributes]]:
    """Return the CF unit, description and attributes of each variable, by name."""
    return {one.variable: one.term for one in columns}


def derive(columns: Iterable[ResultColumn], known: Mapping[str, Any]) -> dict[str, Any]:
    """Compute the derived columns of a table, by name.

    Parameters
    ----------
    known : the other columns by name, and `part`, which lists the pieces or clamps
    """
    rows, found = SimpleNamespace(**known), {}
    for one in columns:
        if one.derived is not None:
            found[one.name] = one.derived(rows)
            setattr(rows, one.name, found[one.name])
    return found
