"""Initial tables of the water form: typical currents, currents from files, and pasted rows.

Headings, units and directions of pasted rows are interpreted as in files.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import chain
from math import exp, isclose
from pathlib import Path

from numpy import float32

from calm.errors import Problem, UsageError
from calm.files.definition import QuantityField
from calm.records import profile_tables
from calm.records.headings import heading
from calm.records.profile_tables import QuantityTable, speed_and_direction
from calm.tui import forms, theme
from calm.tui.checking import Check, Reading, number, one_of, quantity
from calm.tui.dialogs import InputSheet
from calm.tui.forms import Rows
from calm.units import DIMENSIONS, QuantityError, QuantityRange, unit_factor

CURRENT_COLUMNS = ("depth m", "speed m/s", "toward deg")

USUAL_DEPTH = 100.0
"""Depth of the last row in new tables if the water depth is unknown [m]."""

SHARES = (0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0)
_POWER = 1 / 7


PRESETS: Mapping[str, Callable[[float], float]] = {
    "uniform, 0.5 m/s": lambda share: 0.5,
    "tidal stream, 1 m/s at the surface, 1/7-power law of the height above the seabed":
        lambda share: (1.0 - share) ** _POWER,
    "linear shear, from 0.8 m/s at the surface to zero at the seabed":
        lambda share: 0.8 * (1.0 - share),
    "boundary current, 1.2 m/s at the surface, exponential decay over a fifth of the depth":
        lambda share: 0.05 + 1.15 * exp(-share / 0.2),
}  # fmt: skip
"""Typical current profiles: speed [m/s] by relative depth, from 0 at the surface to 1 at the
seabed.
"""


_SPEEDS = ("depth m", "u m/s", "v m/s", "w m/s")
_NOISE = 1e-12  # rounding of speed and direction in doubles, with a margin


def import_sheet(folder: Path) -> InputSheet:
    """Create the sheet for importing a current file.

    The sheet asks for the name of the file, a time, and whether to refer to the file or to copy its
    profile.
    """
    return InputSheet(
        "A current from a file",
        f"CSV or CF NetCDF, relative to {folder}. `refer` writes the name of this file into the "
        "mooring file; `copy` writes its current profile as a table.",
        [
            forms.FormField("file", "File", check=_existing(folder), placeholder="e.g. adcp.nc"),
            forms.FormField(
                "time", "Time", placeholder="e.g. 2026-03-01T06:00, if the file is a record"
            ),
            forms.FormField("how", "refer or copy", "refer", one_of(("refer", "copy"))),
        ],
    )


def imported(path: Path, time: str, depth: float) -> tuple[Sequence[str], Sequence[Sequence[str]]]:
    """Read a current profile from a file, as columns and rows of a table.

    Parameters
    ----------
    path : CSV, NetCDF or zarr file
    time : time of the profile, in ISO 8601 format; empty for a single profile
    depth : water depth [m]

    Returns
    -------
    columns : depth [m], and either speed [m/s] and direction [degrees], or velocities [m/s]. The
        table has the columns that need fewer digits. A table with vertical velocities always has
        velocities.
    rows : one row for each level, from the top, with all digits of the file

    Raises
    ------
    CalmError
        The file or the time is invalid.
    """
    from calm.records.current_file import read_current_file
    from calm.records.current_terms import Terms, TimeChoiceError

    try:
        table, _ = read_current_file(path, time or None, Terms(water_depth=depth))
    except TimeChoiceError as error:
        raise UsageError(f"{path.name}: {error}") from None
    levels = [*zip(table.depth, table.u, table.v, table.w, strict=True)]
    if any(table.w):
        return _SPEEDS, [[*map(_written, level)] for level in levels]
    flows = [[*map(_written, level[:3])] for level in levels]
    tables = [[*map(_written, (deep, *speed_and_direction(u, v)))] for deep, u, v, _ in levels]
    signs = [len("".join(chain.from_iterable(rows))) for rows in (flows, tables)]
    return (_SPEEDS[:3], flows) if signs[0] < signs[1] else (CURRENT_COLUMNS, tables)


def _written(value: float) -> str:
    """Format a value with all its significant digits.

    The additional digits of a number with 32-bit precision are rounding noise, and are omitted.
    """
    short = float32(value)
    if isclose(short, value, rel_tol=_NOISE):
        return f"{float(str(short)) + 0.0:.12g}"
    return f"{round(value, 12) + 0.0:.12g}"


def _existing(folder: Path) -> Check:
    def check(text: str) -> Reading:
        tidy = text.strip()
        if not tidy:
            return Reading("", "a file is needed")
        try:
            is_there = (folder / tidy).exists()
        except (OSError, ValueError):  # not a valid file name
            is_there = False
        return Reading(tidy) if is_there else Reading(tidy, "no such file")

    return check


_MOST_SHOWN = 8
_OF_A_CURRENT = {"u", "v", "w", "speed", "toward"}


class NoRows(ValueError):
    """Raised for a text that is not a table; the message gives the row and the mistake."""


class UnknownColumns(NoRows):
    """Raised for headings that do not identify the columns; the message gives the mistake."""


def offered_headings(headings: Sequence[str] | None, columns: Sequence[str]) -> list[str]:
    """Return headings for copied rows.

    The headings are those of the copied text, with missing units added. If the copied text
    has no headings, the headings of the table are used.
    """
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
    """Convert copied rows to the columns of a table.

    If the headings of the rows are those of the table, the texts are kept as typed.

    Raises
    ------
    UnknownColumns
        The columns of the table cannot be derived from the headings.
    NoRows
        A row has an invalid value.
    """
    if [heading(one) for one in headings] == [heading(one) for one in columns]:
        return tuple(_as_written(i, row, columns) for i, row in enumerate(rows, 1))
    values = _by_name(columns, headings, rows)
    try:
        return tuple(zip(*(_column(column, values) for column in columns), strict=True))
    except KeyError as absent:
        raise UnknownColumns(f"there is no column for {absent.args[0]}") from None


def previewed(columns: Sequence[str], rows: Rows) -> str:
    """Format rows for a preview; a long table is reduced to its first rows and its last row."""
    lines: list[Sequence[str]] = [columns, *rows]
    if len(rows) > _MOST_SHOWN:
        between = f"{theme.ELLIPSIS} {len(rows) - _MOST_SHOWN} more"
        lines = [columns, *rows[: _MOST_SHOWN - 1], (between,), rows[-1]]
    widths = [max(len(row[n]) for row in [columns, *rows]) for n in range(len(columns))]
    return "\n".join(
        "  ".join(f"{cell:<{width}}" for cell, width in zip(line, widths, strict=False)).rstrip()
        for line in lines
    )


def _as_written(number: int, row: Sequence[str], columns: Sequence[str]) -> tuple[str, ...]:
    if len(row) != len(columns):
        many = f"{len(row)} value{'s' * (len(row) != 1)}"
        raise NoRows(f"row {number} has {many}; the table has {len(columns)} columns")
    readings = [check_of(column)(value) for column, value in zip(columns, row, strict=True)]
    for value, reading in zip(row, readings, strict=True):
        if not reading.is_good:
            raise NoRows(f"row {number}: `{value}` {reading.note}")
    return tuple(reading.text for reading in readings)


def _by_name(
    columns: Sequence[str], headings: Sequence[str], rows: Sequence[Sequence[str]]
) -> dict[str, Sequence[float]]:
    """Return the copied values in SI units by column name, for all columns that can be derived."""
    problems: list[tuple[bool, str]] = []

    def report(location: Sequence[str | int], message: str) -> Problem:
        of_a_row = location[0] == "rows" and len(location) > 1
        text = f"row {int(location[1]) + 1}: {message}" if of_a_row else message
        problems.append((not of_a_row, text))
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
        warm, salt = table.temperature, table.salinity
        return {"depth": warm.depth, "temperature": warm.value, "salinity": salt.value}
    if isinstance(table, profile_tables.DepthTable):
        return {"depth": table.depth, next(iter(names - {"depth"})): table.value}
    if "w" not in names and any(table.w):
        raise UnknownColumns("the current has an upward speed `w`, but the table has no column `w`")
    flows = [speed_and_direction(*uv) for uv in zip(table.u, table.v, strict=True)]
    return {
        "depth": table.depth,
        "u": table.u,
        "v": table.v,
        "w": table.w,
        "speed": [flow for flow, _ in flows],
        "toward": [round(azimuth, 9) % 360.0 for _, azimuth in flows],
    }


def _column(column: str, values: dict[str, Sequence[float]]) -> list[str]:
    """Format the values of a column in the unit of its heading.

    If the heading has no unit, each value gets the SI unit.
    """
    name, unit = heading(column)
    dimension = _KINDS[name].dimension
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


def check_of(column: str) -> Check:
    """Return the check for the texts of a column.

    The texts must be numbers if the heading has a unit, otherwise quantities with units.
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
    """Return the mean of two values or, for directions, the middle of the shorter arc."""
    name, unit = heading(column)
    half = (one + other) / 2
    if name != "toward":
        return half
    try:
        turn = 360.0 / unit_factor(unit or "deg", "angle")
    except QuantityError:
        return half
    return (half + turn / 2) % turn if abs(one - other) > turn / 2 else half
