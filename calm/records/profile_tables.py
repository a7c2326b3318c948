"""Tables of quantities by depth, as text with a unit in each heading, converted to SI."""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import TypeVar

import numpy as np

from calm.errors import Problem, about_quantity, shown, unknown
from calm.physics.line import Booleans, Floats, Integers
from calm.quantities import bearing_of
from calm.records.card import ReadCard
from calm.records.current_terms import DEEPEST, Terms, too_deep, too_fast
from calm.records.delimited import is_gap, plain_numbers
from calm.records.headings import column_unit, heading, magnetic_columns
from calm.records.profile_doubts import direction_doubts
from calm.units import DIMENSIONS, QuantityError, QuantityRange, unit_factor

Report = Callable[[Sequence[str | int], str], Problem]
"""Function that creates a `Problem` for a place and a message.

A place is ``("columns", j)`` or ``("rows", i, j)``.
"""


@dataclass(frozen=True)
class QuantityTable:
    """A table of quantities by depth, as text.

    Attributes
    ----------
    columns : headings with units, such as ``"depth m"`` or ``"depth[m]"``
    rows : numbers, or quantities with a unit if the heading has none
    problems : list to which mistakes are added
    """

    columns: Sequence[str]
    rows: Sequence[Sequence[str | None]]
    report: Report
    problems: list[Problem]

    def refuse(self, place: Sequence[str | int], message: str) -> None:
        """Record a message about a mistake at a place in the table."""
        self.problems.append(self.report(place, message))


_BARE_NUMBER = re.compile(r"[-+.,/\deE ]*")
_AMBIGUOUS = ("direction", "dir", "heading", "bearing")


def read_columns(
    table: QuantityTable, known: Mapping[str, QuantityRange], gaps: Booleans | None = None
) -> dict[str, Floats]:
    """Convert the known columns of a table to SI units; return arrays by column name.

    Mistakes are added to the problems of the table, and wrong values become NaN. `gaps` masks rows
    in which values may be missing.
    """
    columns, rows = table.columns, table.rows
    units = _unit_by_column(table, known)
    if len(units) == len(columns) and "depth" not in units:
        table.refuse(("columns",), "the table has no `depth` column")
    values = {name: np.full(len(rows), np.nan) for name in units}
    if not rows:
        table.refuse(("rows",), "the table has no rows")
    whole = [i for i, row in enumerate(rows) if len(row) == len(columns)]
    for i in sorted({*range(len(rows))} - {*whole}):
        hint = (
            "; is there a decimal comma? Write 0.8, not 0,8" if len(rows[i]) > len(columns) else ""
        )
        message = f"the row has {len(rows[i])} values; {len(columns)} are needed{hint}"
        table.refuse(("rows", i), message)
    if len(units) < len(columns):
        return values
    for j, (name, unit) in enumerate(units.items()):
        cells = [rows[i][j] for i in whole]
        if gaps is not None and gaps.any():
            pairs = zip(cells, gaps[whole].tolist(), strict=True)
            cells = ["nan" if lacks and is_gap(cell) else cell for cell, lacks in pairs]
        missing = np.zeros(len(whole), bool) if gaps is None else gaps[whole]
        together = _read_together(cells, unit, known[name], missing)
        if together is not None:
            values[name][whole] = together
            continue
        quantity = known[name]
        if not unit and DIMENSIONS[quantity.dimension].unit and _has_bare_numbers(cells):
            try:
                column_unit(columns[j], "", [quantity.dimension], quantity.usual_unit or "")
            except QuantityError as error:  # report once per column
                table.refuse(("columns", j), str(error))
                continue
        for i, cell in zip(whole, cells, strict=True):
            try:
                if gaps is None or not (gaps[i] and cell == "nan"):
                    bare = cell is not None and unit and _BARE_NUMBER.fullmatch(cell)
                    values[name][i] = known[name].read(f"{cell} {unit}" if bare else cell)
            except QuantityError as error:
                table.refuse(("rows", i, j), about_quantity(name, cell, error))
    return values


def _has_bare_numbers(cells: Sequence[str | None]) -> bool:
    numbers = (cell for cell in cells if cell is not None and _BARE_NUMBER.fullmatch(cell))
    return sum(any(digit in "123456789" for digit in number) for number in numbers) > 1


def _read_together(
    cells: Sequence[str | None], unit: str, quantity: QuantityRange, gaps: Booleans
) -> Floats | None:
    """Convert a column to SI; None if a cell is not a plain number within the limits.

    `gaps` is a mask of rows in which a value may be missing.
    """
    numbers = plain_numbers(cells) if unit else None
    if numbers is None or (np.isnan(numbers) & ~gaps).any():
        return None
    numbers = numbers * unit_factor(unit, quantity.dimension)
    beyond = (numbers <= quantity.above) | (numbers < quantity.at_least)
    return None if (beyond | (numbers > quantity.at_most)).any() else numbers


def _unit_by_column(table: QuantityTable, known: Mapping[str, QuantityRange]) -> dict[str, str]:
    units: dict[str, str] = {}
    for j, column in enumerate(table.columns):
        name, unit = heading(column)
        name = name.lower() if name.lower() in known else name
        if name.lower() in _AMBIGUOUS and "toward" in known:
            message = (
                f"`{shown(column)}` is ambiguous: call the column `toward` if the current flows "
                "towards this direction, or `from` if the current comes from this direction"
            )
            table.refuse(("columns", j), message)
        elif name not in known:
            table.refuse(
                ("columns", j), unknown(f"no column is called `{shown(name)}`", name, known)
            )
        elif name in units:
            table.refuse(("columns", j), f"column `{name}` is given twice")
        else:
            try:
                if unit:
                    column_unit(column, unit, [known[name].dimension])
            except QuantityError as error:
                table.refuse(("columns", j), str(error))
            else:
                units[name] = unit
    return units


def check_depths(
    table: QuantityTable,
    values: Mapping[str, Floats],
    rows: Integers,
    profile: Integers | None = None,
) -> None:
    """Check that depths are between 0 and `DEEPEST`, and increase within each profile.

    Mistakes are added to the `problems` of the table. `values` are in SI units. `profile` is the
    profile index of each row, or None for a single profile.
    """
    if "depth" not in values:
        return
    column = list(values).index("depth")
    depths = values["depth"][rows]
    ends = np.flatnonzero(np.diff(np.zeros(len(rows)) if profile is None else profile[rows])) + 1
    inside = np.delete(np.diff(depths), ends - 1)
    if ((depths >= 0.0) & (depths <= DEEPEST)).all() and (inside > 0.0).all():
        return
    for start, stop in pairwise([0, *ends.tolist(), len(depths)]):
        mine = depths[start:stop]
        if len(mine) > 1 and (mine <= 0.0).all() and mine.any():
            message = "the depths are negative; depths must be positive down, so remove the signs"
            first = int(rows[start + int(np.argmax(mine < 0.0))])
            table.refuse(("rows", first, column), message)
            continue
        previous = -math.inf
        for i, depth in zip(rows[start:stop].tolist(), mine.tolist(), strict=True):
            word = "repeats" if depth == previous else "comes after"
            reason = f"depth {depth:g} m {word} {previous:g} m; depths must increase"
            if depth < 0:
                reason = f"depth {depth:g} m is above the surface"
            elif deep := too_deep(depth):
                reason = deep
            elif not depth <= previous:
                reason = ""
            if reason:
                table.refuse(("rows", i, column), reason)
            previous = depth


_DEFAULT_TERMS = Terms()
Speed = TypeVar("Speed", float, Floats)

TEMPERATURE = QuantityRange("temperature", at_least=-6, at_most=40)
SALINITY = QuantityRange("salinity", at_least=0, at_most=42)
"""Limits of temperature and salinity: the range of validity of TEOS-10."""

WATER_DENSITY = QuantityRange("density", at_least=900, at_most=1350)
"""Limits of density: fresh water under a glacier, and the brines at the bottom of the Red Sea."""

DENSITY = QuantityRange("density", above=0)

DIRECTION = QuantityRange("angle", at_least=-360, at_most=360)

_DEPTH = QuantityRange("length")
_SPEED = QuantityRange("speed")
_CURRENT = {
    "depth": _DEPTH,
    **dict.fromkeys(("u", "v", "w", "speed"), _SPEED),
    **dict.fromkeys(("toward", "from"), DIRECTION),
}
_WATER = {"depth": _DEPTH, "density": DENSITY, "temperature": TEMPERATURE, "salinity": SALINITY}


@dataclass(frozen=True)
class CurrentTable:
    """A current profile: eastward, northward and upward velocity [m/s] at increasing depths [m].

    `record` is the record file and the options for reading, or None. `doubts` are remarks on
    suspicious directions.
    """

    depth: tuple[float, ...]
    u: tuple[float, ...]
    v: tuple[float, ...]
    w: tuple[float, ...]
    record: tuple[Path, Terms] | None = field(default=None, compare=False, repr=False)
    doubts: tuple[str, ...] = field(default=(), compare=False, repr=False)
    card: ReadCard | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True)
class DepthTable:
    """A quantity at increasing depths [m]; linear between depths, constant beyond the ends."""

    depth: tuple[float, ...]
    value: tuple[float, ...]


@dataclass(frozen=True)
class SeaWater:
    """Profiles of in-situ temperature [°C] and practical salinity in sea water."""

    temperature: DepthTable
    salinity: DepthTable


def read_current(table: QuantityTable, terms: Terms = _DEFAULT_TERMS) -> CurrentTable | None:
    """Parse a current profile; return None and record the problems if the table has mistakes.

    Columns are `depth`, optionally `w`, and either `u` and `v`, or `speed` and one of `toward` and
    `from`. A unit such as ``"deg magnetic"`` marks directions relative to magnetic north.
    """
    found = read_currents(table, terms)
    if found is None:
        return None
    depth, u, v, w = (tuple(values.tolist()) for values in found.T)
    return CurrentTable(depth, u, v, w, doubts=_direction_doubts(table))


def _direction_doubts(table: QuantityTable) -> tuple[str, ...]:
    plain, _ = magnetic_columns(table.columns)
    quiet = replace(table, columns=plain, problems=[])
    values = read_columns(quiet, _CURRENT)
    name = next((name for name in ("toward", "from") if name in values), None)
    if name is None:
        return ()
    flowing = values[name][values["speed"] != 0.0].tolist()
    return tuple(direction_doubts(flowing, name))


def read_currents(
    table: QuantityTable, terms: Terms, profile: Integers | None = None
) -> Floats | None:
    """Convert a table of currents to an array (n, 4) of depth [m] and u, v, w [m/s].

    Return None and record the problems if the table has mistakes. `profile` (n,) is the increasing
    profile index of each row; missing values then become NaN. Without `profile`, missing values are
    mistakes.
    """
    columns, rows, before = table.columns, table.rows, len(table.problems)
    plain, turned = _from_magnetic_north(table, terms)
    gaps = np.zeros(len(rows), bool)
    for j, column in enumerate(plain):
        if profile is not None and heading(column)[0].lower() != "depth":
            cells = [row[j] if len(row) == len(plain) else "" for row in rows]
            blank = {cell for cell in set(cells) if is_gap(cell)}
            gaps |= [cell in blank for cell in cells] if blank else False
    values = read_columns(replace(table, columns=plain), _CURRENT, gaps)
    given = values.keys()
    if len(given) == len(columns):
        components, polar = given & {"u", "v"}, given & {"speed", "toward", "from"}
        if components and polar:
            table.refuse(("columns",), "give `u` and `v`, or `speed` and `toward`, not both")
        elif {"toward", "from"} <= polar:
            message = "give either `toward`, the direction of the flow, or `from`, not both"
            table.refuse(("columns",), message)
        elif len(components) < 2 and (len(polar) < 2 or "speed" not in polar):
            message = "a current needs `u` and `v`, or `speed` and `toward`; the columns are "
            table.refuse(("columns",), message + ", ".join(given))
    speeds = values.get("speed", np.zeros(0))
    for i in np.flatnonzero(speeds < 0.0).tolist():
        place = ("rows", i, list(values).index("speed"))
        table.refuse(place, f"`speed` {speeds[i]:g} m/s is negative; reverse `toward` instead")
    check_depths(table, values, np.flatnonzero(~gaps), profile)
    if len(table.problems) > before:
        return None
    if "u" in values:
        u, v = values["u"], values["v"]
        if turned:
            u, v = turned_by(turned, u, v)
    else:
        sense, turn = ("from", 180.0 + turned) if "from" in values else ("toward", turned)
        angle = np.radians(values[sense] + turn)
        u, v = speeds * np.sin(angle), speeds * np.cos(angle)
    w = values.get("w", np.zeros(len(u)))
    u = np.where(np.isnan(w), np.nan, u)
    fastest = np.hypot(np.hypot(u, v), w)
    for i in np.flatnonzero((fastest > 0.999 * terms.maximum_speed) | np.isinf(fastest)).tolist():
        if reason := too_fast(u[i], v[i], w[i], terms.maximum_speed):
            place = ("rows", i, list(values).index("u" if "u" in values else "speed"))
            table.refuse(place, reason)
    return None if len(table.problems) > before else np.column_stack([values["depth"], u, v, w])


def turned_notices(columns: Sequence[str], terms: Terms) -> tuple[str, ...]:
    """Return a notice if currents in the columns were rotated from magnetic to true north."""
    if terms.declination is None:
        return ()
    which = " and ".join(f"`{name}`" for name in sorted(magnetic_columns(columns)[1]))
    return (f"{which} were relative to magnetic north, and were rotated by {terms.declination:g}°",)


def _from_magnetic_north(table: QuantityTable, terms: Terms) -> tuple[list[str], float]:
    """Return the headings without ``magnetic``, and the rotation to true north [degrees]."""
    columns = table.columns
    plain, magnetic = magnetic_columns(columns)
    if not magnetic:
        if terms.declination is not None:
            table.refuse(
                ("columns",),
                "`declination` needs a column relative to magnetic north, such as "
                "`toward[deg magnetic]`; remove `declination`, or correct the heading",
            )
        return plain, 0.0
    first = next(j for j, column in enumerate(columns) if column != plain[j])
    if magnetic in ({"u"}, {"v"}):
        one, other = ("u", "v") if "u" in magnetic else ("v", "u")
        message = f"`{one}` is relative to magnetic north, but `{other}` is not"
        table.refuse(("columns", first), message)
    if terms.declination is None:
        table.refuse(
            ("columns", first),
            f"`{shown(columns[first])}` is relative to magnetic north; set the `declination` of "
            "the site (positive to the east) next to `file:`, or with `--declination`",
        )
    return plain, terms.declination or 0.0


def read_water(
    table: QuantityTable, density: QuantityRange = WATER_DENSITY
) -> DepthTable | SeaWater | None:
    """Read a profile of density [kg/m³], or of temperature and salinity, from a table.

    Return None and record the problems if the table has mistakes. Columns are `depth`, and
    either `density`, or both `temperature` and `salinity`.
    """
    values = _profile_by_name(table, {**_WATER, "density": density})
    if values is None:
        return None
    if "density" in values:
        return values["density"]
    return SeaWater(values["temperature"], values["salinity"])


def read_profile(name: str, table: QuantityTable) -> DepthTable | None:
    """Parse a profile of `temperature` [°C] or `salinity` from a table.

    Return None and record the problems if the table has mistakes.
    """
    values = _profile_by_name(table, {"depth": _DEPTH, name: _WATER[name]})
    return None if values is None else values[name]


def _profile_by_name(
    table: QuantityTable, known: Mapping[str, QuantityRange]
) -> dict[str, DepthTable] | None:
    before = len(table.problems)
    values = read_columns(table, known)
    given = values.keys() - {"depth"}
    if len(values) == len(table.columns):
        alone = [name for name in known if name != "depth"]
        if len(alone) == 1 and not given:
            table.refuse(("columns",), f"the table has no `{alone[0]}` column")
        elif len(alone) > 1 and given not in ({"density"}, {"temperature", "salinity"}):
            message = "needs `density`, or `temperature` and `salinity`; the columns are "
            table.refuse(("columns",), f"a density {message}{', '.join(values)}")
    check_depths(table, values, np.arange(len(table.rows)))
    if len(table.problems) > before:
        return None
    depth = tuple(values["depth"].tolist())
    return {name: DepthTable(depth, tuple(values[name].tolist())) for name in given}


def components(speed: float, toward: float) -> tuple[float, float]:
    """Return the eastward and northward components of a flow.

    Parameters
    ----------
    speed : speed of the flow
    toward : direction of the flow, clockwise from north [degrees]
    """
    angle = math.radians(toward)
    return speed * math.sin(angle), speed * math.cos(angle)


def turned_by(angle: float, u: Speed, v: Speed) -> tuple[Speed, Speed]:
    """Rotate a velocity clockwise.

    Parameters
    ----------
    angle : angle of rotation, clockwise [degrees]
    u, v : eastward and northward components [m/s]
    """
    sine, cosine = math.sin(math.radians(angle)), math.cos(math.radians(angle))
    return u * cosine + v * sine, v * cosine - u * sine


def speed_and_direction(u: float, v: float) -> tuple[float, float]:
    """Convert eastward and northward components to speed and direction of flow.

    The direction is clockwise from north, 0 to 360 degrees.
    """
    return math.hypot(u, v), bearing_of(u, v)
