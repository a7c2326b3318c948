"""Tables of quantities: named columns, each with its unit, and rows of numbers."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from calm.errors import Problem
from calm.files.explain import about_quantity, shown, unknown
from calm.units import DIMENSIONS, QuantityError, parse_quantity, unit_factor

Report = Callable[[Sequence[str | int], str], Problem]
"""Makes a problem of a message, at ``("columns", j)`` or ``("rows", i, j)``."""

_BARE_NUMBER = re.compile(r"[-+.,/\deE ]*")

DENSITY_COLUMNS = {"depth": "length", "density": "density"}
CURRENT_COLUMNS = {
    "depth": "length",
    "u": "speed",
    "v": "speed",
    "w": "speed",
    "speed": "speed",
    "toward": "angle",
}


@dataclass(frozen=True)
class CurrentTable:
    """A current profile: east, north and upward speeds [m/s] at increasing depths [m]."""

    depth: tuple[float, ...]
    u: tuple[float, ...]
    v: tuple[float, ...]
    w: tuple[float, ...]


@dataclass(frozen=True)
class DensityTable:
    """A density profile [kg/m³] at increasing depths [m]."""

    depth: tuple[float, ...]
    density: tuple[float, ...]


def read_current(
    columns: Sequence[str],
    rows: Sequence[Sequence[str | None]],
    report: Report,
    problems: list[Problem],
) -> CurrentTable | None:
    """A current from a table; None, with its mistakes added to `problems`, when it has any.

    Parameters
    ----------
    columns : sequence of str
        Names with their unit, ``"depth m"`` or ``"depth[m]"``; without, each value has its own.
        `depth`, with `u` and `v` or `speed` and `toward`, and optionally `w`.
    rows : sequence of rows
        Numbers, or quantities with a unit, as text.
    """
    before = len(problems)
    values = _read_columns(columns, rows, CURRENT_COLUMNS, report, problems)
    given = values.keys()
    if len(given) == len(columns):
        if "depth" not in given:
            problems.append(report(("columns",), "the table has no `depth` column"))
        if given & {"u", "v"} and given & {"speed", "toward"}:
            message = "give `u` and `v`, or `speed` and `toward`, not both"
            problems.append(report(("columns",), message))
        elif not (given >= {"u", "v"} or given >= {"speed", "toward"}):
            message = "a current needs `u` and `v`, or `speed` and `toward`; the columns are "
            problems.append(report(("columns",), message + ", ".join(given)))
    for i, speed in enumerate(values.get("speed", ())):
        if speed < 0:
            place = ("rows", i, list(values).index("speed"))
            problems.append(report(place, f"`speed` {speed:g} m/s is negative; turn `toward`"))
    _check_depths(values, report, problems)
    if len(problems) > before:
        return None
    if "u" in values:
        u, v = values["u"], values["v"]
    else:
        flows = zip(values["speed"], values["toward"], strict=True)
        u, v = map(list, zip(*(components(*flow) for flow in flows), strict=True))
    w = values.get("w", [0.0] * len(u))
    return CurrentTable(tuple(values["depth"]), tuple(u), tuple(v), tuple(w))


def read_density(
    columns: Sequence[str],
    rows: Sequence[Sequence[str | None]],
    report: Report,
    problems: list[Problem],
) -> DensityTable | None:
    """A density profile from a table with the columns `depth` and `density`, as `read_current`."""
    before = len(problems)
    values = _read_columns(columns, rows, DENSITY_COLUMNS, report, problems)
    if len(values) == len(columns):
        problems.extend(
            report(("columns",), f"the table has no `{name}` column")
            for name in DENSITY_COLUMNS
            if name not in values
        )
    for i, density in enumerate(values.get("density", ())):
        if density <= 0:
            place = ("rows", i, list(values).index("density"))
            problems.append(report(place, f"`density` {density:g} kg/m^3 must be more than 0"))
    _check_depths(values, report, problems)
    if len(problems) > before:
        return None
    return DensityTable(tuple(values["depth"]), tuple(values["density"]))


def components(speed: float, toward: float) -> tuple[float, float]:
    """East and north parts of a speed that flows toward a direction [deg from north]."""
    angle = math.radians(toward)
    return speed * math.sin(angle), speed * math.cos(angle)


def _read_columns(
    columns: Sequence[str],
    rows: Sequence[Sequence[str | None]],
    dimensions: Mapping[str, str],
    report: Report,
    problems: list[Problem],
) -> dict[str, list[float]]:
    """The known columns by name, in SI, NaN where a value is wrong."""
    units = _read_headings(columns, dimensions, report, problems)
    values: dict[str, list[float]] = {name: [] for name in units}
    if not rows:
        problems.append(report(("rows",), "the table has no rows"))
    for i, row in enumerate(rows):
        for name in units:
            values[name].append(math.nan)
        if len(row) != len(columns):
            hint = "; a decimal comma? (write 0.8, not 0,8)" if len(row) > len(columns) else ""
            message = f"the row has {len(row)} values, {len(columns)} are needed{hint}"
            problems.append(report(("rows", i), message))
        elif len(units) == len(columns):
            for j, (name, unit) in enumerate(units.items()):
                try:
                    values[name][i] = _read_cell(row[j], unit, dimensions[name])
                except QuantityError as error:
                    problems.append(report(("rows", i, j), about_quantity(name, row[j], error)))
    return values


def _read_headings(
    columns: Sequence[str],
    dimensions: Mapping[str, str],
    report: Report,
    problems: list[Problem],
) -> dict[str, str]:
    """The unit of each known column by its name, empty where the column gives none."""
    units: dict[str, str] = {}
    for j, column in enumerate(columns):
        name, _, unit = column.replace("[", " ", 1).strip().removesuffix("]").partition(" ")
        unit = unit.strip()
        if name not in dimensions:
            message = unknown(f"no column is called `{shown(name)}`", name, dimensions)
            problems.append(report(("columns", j), message))
        elif name in units:
            problems.append(report(("columns", j), f"column `{name}` is given twice"))
        else:
            try:
                unit_factor(unit or DIMENSIONS[dimensions[name]].unit, dimensions[name])
            except QuantityError as error:
                offer = f"; did you mean `{name} {error.suggestion}`?" if error.suggestion else ""
                message = f"`{shown(column)}` {error.complaint}{offer}"
                problems.append(report(("columns", j), message))
            else:
                units[name] = unit
    return units


def _read_cell(text: str | None, unit: str, dimension: str) -> float:
    if text is None:
        raise QuantityError("has no value")
    if unit and _BARE_NUMBER.fullmatch(text):
        text = f"{text} {unit}"
    return parse_quantity(text, dimension)


def _check_depths(
    values: Mapping[str, list[float]], report: Report, problems: list[Problem]
) -> None:
    """Depths must not be negative and must increase from row to row."""
    if "depth" not in values:
        return
    column = list(values).index("depth")
    previous = -math.inf
    for i, depth in enumerate(values["depth"]):
        if depth < 0:
            problems.append(report(("rows", i, column), f"depth {depth:g} m is above the surface"))
        elif depth <= previous:
            word = "repeats" if depth == previous else "comes after"
            message = f"depth {depth:g} m {word} {previous:g} m; depths must increase"
            problems.append(report(("rows", i, column), message))
        previous = depth
