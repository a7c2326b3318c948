"""Column headings of text tables: a name and its unit, in common notations.

Examples are ``depth[m]``, ``Depth (m)``, ``depth m``, ``toward[deg magnetic]`` and ``time (UTC)``.
Names of several words need a unit in brackets, or a known unit.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem, about_quantity, shown, unknown
from calm.physics.line import Floats
from calm.positions import HEMISPHERES
from calm.records import delimited
from calm.records.current_terms import ZONES_OF_UTC, TimeChoiceError, parse_time
from calm.units import DIMENSIONS, QuantityError, QuantityRange, unit_factor

_BRACKETED = re.compile(r"(.*?)\s*[\[(]((?:[^\[\]()]|\([^()]*\))*)[\])]")
_WORD = re.compile(r"([^\s\[(]*)\s*(.*)")
_MAGNETIC = re.compile(r"(?i)\s*\bmag(netic)?$")


def heading(column: str, dimensions: Sequence[str] = ()) -> tuple[str, str]:
    """Split a heading into its name and its unit; a missing unit is empty.

    Units are in brackets. If `dimensions` (keys of `calm.units.DIMENSIONS`) are given, known units
    are also found without brackets. Units of these dimensions take precedence over other units.
    """
    text = " ".join(column.split())
    bracketed = _BRACKETED.fullmatch(text)
    if bracketed:
        return bracketed[1], bracketed[2].strip()
    words = text.split(" ")
    for wanted in (
        dimensions,
        DIMENSIONS if dimensions else (),
    ):  # a unit of another dimension also ends the name
        for first in range(1, len(words)):
            unit = " ".join(words[first:])
            if any(_is_unit(unit, dimension) for dimension in wanted):
                return " ".join(words[:first]), unit
    if dimensions:
        return text, ""
    found = _WORD.fullmatch(text)
    assert found is not None  # either part may be empty
    return found[1], found[2]


def column_unit(
    column: str, unit: str, dimensions: Sequence[str], usual: str = ""
) -> tuple[str, float]:
    """Return the dimension of a column, and the factor from its unit to SI (degrees for angles).

    Latitudes and longitudes need no unit.

    Parameters
    ----------
    column : heading, for messages
    unit : unit in the heading, or empty
    dimensions : allowed dimensions, keys of `calm.units.DIMENSIONS`
    usual : unit to suggest

    Raises
    ------
    QuantityError
        The unit is missing, unknown or of another dimension. The text is a complete message.
    """
    name = heading(column, dimensions)[0]
    if not unit and dimensions[0] in HEMISPHERES:
        return dimensions[0], 1.0
    if not unit:
        usual = usual or DIMENSIONS[dimensions[0]].unit
        raise QuantityError(f"column `{shown(name)}` needs a unit; did you mean `{name}[{usual}]`?")
    complaints = []
    for dimension in dimensions:
        try:
            return dimension, unit_factor(unit, dimension)
        except QuantityError as error:
            complaints.append(error)
    first = next((one for one in complaints if one.suggestion), complaints[0])
    meant = column.strip().replace(unit, first.suggestion) if first.suggestion else ""
    offer = f"; did you mean `{shown(meant)}`?" if meant else ""
    raise QuantityError(f"`{shown(column)}` {first.complaint}{offer}")


def is_time(column: str) -> bool:
    """Return whether a heading marks the time column."""
    return heading(column)[0].lower() == "time"


def zone_complaint(column: str) -> str | None:
    """Return a message if a time heading names a zone other than UTC, else None."""
    zone = heading(column)[1]
    if not zone or zone.upper() in ZONES_OF_UTC:
        return None
    return (
        f"`{column.strip()[:40]}`: times must be in UTC, or include their offset, as in "
        "2026-03-01T06:00+02:00"
    )


def magnetic_columns(columns: Sequence[str]) -> tuple[list[str], set[str]]:
    """Remove the word ``magnetic`` from headings.

    Return the plain headings, and the names of the columns whose heading changed.
    """
    plain = [_without_north(column) for column in columns]
    pairs = zip(columns, plain, strict=True)
    return plain, {heading(column)[0].lower() for column, other in pairs if column != other}


def _without_north(column: str) -> str:
    name, unit = heading(column)
    plain = _MAGNETIC.sub("", unit)
    return column if plain == unit else f"{name} {plain}".strip()


def _is_unit(text: str, dimension: str) -> bool:
    try:
        unit_factor(text, dimension)
    except QuantityError:
        return False
    return True


_INFINITE = ("inf", "infinity")


@dataclass(frozen=True)
class NamedColumns:
    """Rows of a table in which the known columns have been identified by name.

    Attributes
    ----------
    factors : factor from the unit of each known column to SI (degrees for angles), by column name
    places : position of each known column in a row, by column name
    rows : rows with as many cells as the header
    others : headings of unknown columns
    """

    factors: Mapping[str, float]
    places: Mapping[str, int]
    rows: Sequence[delimited.CellRow]
    others: Sequence[str]
    header: delimited.CellRow

    def lacks(self, name: str, unit: str) -> Problem:
        """Return a mistake for the missing column `name`; the message suggests a unit."""
        message = unknown(f"there is no column `{name}[{unit}]`", name, self.others or [name])
        return self.header.problem(message)


@dataclass(frozen=True)
class TimeColumns:
    """Columns of a table over time.

    Attributes
    ----------
    time : (n,) increasing times
    names, dimensions : label and dimension (key of `calm.units.DIMENSIONS`) of the c columns
    values : (n, c) values in SI units; NaN in gaps
    """

    time: NDArray[np.datetime64]
    names: tuple[str, ...]
    dimensions: tuple[str, ...]
    values: Floats


def read_named_columns(
    table: delimited.TextTable,
    known: Mapping[str, str],
    problems: list[Problem],
    *,
    other_names: Mapping[str, str] = MappingProxyType({}),
) -> NamedColumns:
    """Find the known columns of a table by name.

    Parameters
    ----------
    known : dimension of each known column by name; spaces in headings are read as underscores
    problems : list to which mistakes are added
    other_names : alternative names of known columns; the values of the mapping are the known names
    """
    header = table.header
    names = [heading(column)[0].lower().replace(" ", "_") for column in header.cells]
    names = [name if name in known else other_names.get(name, name) for name in names]
    factors: dict[str, float] = {}
    for j, (column, name) in enumerate(zip(header.cells, names, strict=True)):
        if name not in known:
            continue
        try:
            if name in factors:
                raise QuantityError(f"column `{name}` is given twice")
            factors[name] = column_unit(column, heading(column)[1], [known[name]])[1]
        except QuantityError as error:
            factors[name] = 1.0
            problems.append(header.problem(str(error), j))
    places = {name: j for j, name in enumerate(names) if name in factors}
    rows = table.whole_rows(problems)
    pairs = zip(header.cells, names, strict=True)
    others = [column for column, name in pairs if column and name not in known]
    return NamedColumns(factors, places, rows, others, header)


def read_time_columns(path: Path, dimensions: Sequence[str], example: str) -> TimeColumns:
    """Read a table of times and quantities; the heading of a quantity has a label and a unit.

    `dimensions` are the allowed dimensions of columns, keys of `calm.units.DIMENSIONS`. `example`
    is a sample heading for messages. Raise InputError with up to `MOST_PROBLEMS` mistakes.
    """
    table = delimited.read_table(path, f"time,{example}")
    header = table.header
    if not is_time(header.cells[0]):
        message = f"is not a table of a time series; its heading should be `time,{example}`"
        raise InputError([header.problem(message)])
    problems: list[Problem] = []
    if complaint := zone_complaint(header.cells[0]):
        problems.append(header.problem(complaint, 0))
    columns: dict[int, tuple[str, float, QuantityRange]] = {}
    for j, column in enumerate(header.cells[1:], 1):
        name, unit = heading(column, dimensions)
        try:
            dimension, factor = column_unit(column, unit, dimensions, heading(example)[1])
        except QuantityError as error:
            problems.append(header.problem(str(error), j))
        else:
            usual = DIMENSIONS[dimension].unit
            columns[j] = name, factor, QuantityRange(dimension, unit or usual)
    rows = table.whole_rows(problems)
    if not rows and not problems:
        problems.append(header.problem("the table has no rows"))
    times = np.full(len(rows), np.datetime64("NaT"), "M8[ns]")
    values = np.full((len(rows), len(columns)), np.nan)
    for i, row in enumerate(rows):
        try:
            times[i] = parse_time(row.cells[0])
        except TimeChoiceError as error:
            problems.append(row.problem(str(error), 0))
        for k, (j, (name, factor, quantity)) in enumerate(columns.items()):
            try:
                values[i, k] = _si_value(row.cells[j], factor, quantity)
            except QuantityError as error:
                problems.append(row.problem(about_quantity(name, row.cells[j], error), j))
    if problems:
        raise InputError(delimited.abridged(problems))
    order = np.argsort(times, kind="stable")
    labels = tuple(name for name, _, _ in columns.values())
    kinds = tuple(quantity.dimension for _, _, quantity in columns.values())
    return TimeColumns(times[order], labels, kinds, values[order])


def _si_value(cell: str, factor: float, quantity: QuantityRange) -> float:
    if delimited.NUMBER.fullmatch(cell):
        return float(cell) * factor
    if delimited.is_gap(cell) or cell.lower().lstrip("+-") in _INFINITE:
        return float("nan")
    return quantity.read(cell)
