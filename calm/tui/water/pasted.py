"""Rows of numbers out of a text that was copied from a spreadsheet, a CSV file or a page.

The text is read as files are: by its headings, their units, and which way a direction points.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from calm.errors import Problem
from calm.files.definition import QuantityField
from calm.records import profile_tables
from calm.records.headings import heading
from calm.records.profile_tables import QuantityTable
from calm.tui.checking import Check, Reading, number, quantity
from calm.tui.theme import ELLIPSIS
from calm.units import DIMENSIONS, QuantityError, QuantityRange, unit_factor

Rows = tuple[tuple[str, ...], ...]

_MOST_SHOWN = 8
_OF_A_CURRENT = {"u", "v", "w", "speed", "toward"}


class NoRows(ValueError):
    """A text is not the rows of a table; says which row, and what is wrong with it."""


class UnknownColumns(NoRows):
    """The headings do not tell what the columns are; says what is wrong with them."""


def offered_headings(headings: Sequence[str] | None, columns: Sequence[str]) -> list[str]:
    """Headings for what was copied: its own, with units where it gives none; else the table's."""
    if headings is None:
        return list(columns)
    units = {name: unit for name, unit in map(heading, columns)}
    offered = []
    for column in headings:
        name, unit = heading(column)
        usual = "" if unit else units.get(name.lower(), "")
        offered.append(f"{name.lower()} {usual}" if usual else column)
    return offered


def rows_in(columns: Sequence[str], headings: Sequence[str], rows: Sequence[Sequence[str]]) -> Rows:
    """Copied rows under their headings as rows of a table with other columns.

    Where both are the same the values stay as they were written.

    Raises
    ------
    UnknownColumns
        The headings are not those of such a table.
    NoRows
        A row has a value that is none.
    """
    if [heading(one) for one in headings] == [heading(one) for one in columns]:
        return tuple(_as_written(i, row, columns) for i, row in enumerate(rows, 1))
    values = _by_name(columns, headings, rows)
    try:
        return tuple(zip(*(_column(column, values) for column in columns), strict=True))
    except KeyError as absent:
        raise UnknownColumns(f"there is no column for {absent.args[0]}") from None


def previewed(columns: Sequence[str], rows: Rows) -> str:
    """Rows under their columns as they would be taken, of many the first and the last."""
    lines: list[Sequence[str]] = [columns, *rows]
    if len(rows) > _MOST_SHOWN:
        between = f"{ELLIPSIS} {len(rows) - _MOST_SHOWN} more"
        lines = [columns, *rows[: _MOST_SHOWN - 1], (between,), rows[-1]]
    widths = [max(len(row[n]) for row in [columns, *rows]) for n in range(len(columns))]
    return "\n".join(
        "  ".join(f"{cell:<{width}}" for cell, width in zip(line, widths, strict=False)).rstrip()
        for line in lines
    )


def _as_written(number: int, row: Sequence[str], columns: Sequence[str]) -> tuple[str, ...]:
    if len(row) != len(columns):
        many = f"{len(row)} value{'s' * (len(row) != 1)}"
        raise NoRows(f"row {number} has {many}, and the table {len(columns)} columns")
    readings = [check_of(column)(value) for column, value in zip(columns, row, strict=True)]
    for value, reading in zip(row, readings, strict=True):
        if not reading.is_good:
            raise NoRows(f"row {number}: `{value}` {reading.note}")
    return tuple(reading.text for reading in readings)


def _by_name(
    columns: Sequence[str], headings: Sequence[str], rows: Sequence[Sequence[str]]
) -> dict[str, Sequence[float]]:
    """The copied values in SI by the names that the table's columns may have."""
    problems: list[tuple[bool, str]] = []

    def report(location: Sequence[str | int], message: str) -> Problem:
        row = location[1] if location[0] == "rows" and len(location) > 1 else None
        number = int(row) + 1 if row is not None else 0
        problems.append((number == 0, f"row {number}: {message}" if number else message))
        return Problem("", 0, 0, message)

    names = {heading(column)[0] for column in columns}
    copied = QuantityTable(headings, rows, report, [])
    table: profile_tables.CurrentTable | profile_tables.DepthTable | profile_tables.SeaWater | None
    if names & _OF_A_CURRENT:
        table = profile_tables.read_current(copied)
    elif names == {"depth", "density"} or {"temperature", "salinity"} <= names:
        table = profile_tables.read_water(copied)
    else:
        table = profile_tables.read_profile(next(iter(names - {"depth"})), copied)
    if table is None:
        of_the_headings, message = min(problems, key=lambda one: not one[0])
        raise (UnknownColumns if of_the_headings else NoRows)(message)
    if isinstance(table, profile_tables.SeaWater):
        depth = table.temperature.depth
        return {
            "depth": depth,
            "temperature": table.temperature.value,
            "salinity": table.salinity.value,
        }
    if isinstance(table, profile_tables.DepthTable):
        return {"depth": table.depth, next(iter(names - {"depth"})): table.value}
    if "w" not in names and any(table.w):
        raise UnknownColumns("the current has an upward speed `w`, and the table no column for it")
    flows = [
        profile_tables.speed_and_direction(u, v) for u, v in zip(table.u, table.v, strict=True)
    ]
    speed = [flow for flow, _ in flows]
    toward = [round(way, 9) % 360.0 for _, way in flows]
    return {"depth": table.depth, "u": table.u, "v": table.v, "w": table.w,
            "speed": speed, "toward": toward}  # fmt: skip


def _column(column: str, values: dict[str, Sequence[float]]) -> list[str]:
    """The values of a column in its unit; each with its own where the column has none."""
    name, unit = heading(column)
    dimension = dimension_of(name)
    usual = DIMENSIONS[dimension].unit
    try:
        factor = unit_factor(unit or usual, dimension) if unit or usual else 1.0
    except QuantityError as error:
        raise UnknownColumns(f"`{column}` {error.complaint}") from None
    plain = [f"{round(value / factor, 9) + 0.0:.9g}" for value in values[name]]
    return plain if unit or not usual else [f"{text} {usual}" for text in plain]


_KINDS: dict[str, QuantityRange] = {
    "depth": QuantityField("length"),
    "speed": QuantityField("speed", at_least=0),
    "u": QuantityField("speed"),
    "v": QuantityField("speed"),
    "w": QuantityField("speed"),
    "toward": profile_tables.DIRECTION,
    "density": profile_tables.WATER_DENSITY,
    "temperature": profile_tables.TEMPERATURE,
    "salinity": profile_tables.SALINITY,
}


_TURN = 360.0


def dimension_of(name: str) -> str:
    """The dimension of the quantity that a column holds."""
    return _KINDS[name].dimension


def check_of(column: str) -> Check:
    """Return what judges the values of a column: numbers where it gives its unit, else
    quantities.
    """
    name, unit = heading(column)
    kind = _KINDS.get(name)
    if kind is None:
        return number
    judged = quantity(kind)
    if not unit:
        return judged

    def check(text: str) -> Reading:
        reading = number(text)
        complaint = judged(f"{reading.text} {unit}").complaint if reading.is_good else ""
        return replace(reading, complaint=complaint) if complaint else reading

    return check


def half_way(column: str, one: float, other: float) -> float:
    """The value between two of a column; between directions on the shorter way round."""
    name, unit = heading(column)
    half = (one + other) / 2
    if name != "toward":
        return half
    try:
        turn = _TURN / unit_factor(unit or "deg", "angle")
    except QuantityError:
        return half
    return (half + turn / 2) % turn if abs(one - other) > turn / 2 else half
