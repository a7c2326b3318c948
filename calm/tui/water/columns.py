"""The columns of a table: their names and units, and what these make of the values."""

from __future__ import annotations

from calm.files.fields import Quantity
from calm.tui.checking import Check, number, quantity
from calm.units import QuantityError, unit_factor

_DIMENSIONS = {
    "depth": "length",
    "speed": "speed",
    "u": "speed",
    "v": "speed",
    "w": "speed",
    "toward": "angle",
    "density": "density",
    "temperature": "temperature",
    "salinity": "salinity",
}
_TURN = 360.0


def named(column: str) -> tuple[str, str]:
    """The name and the unit that the heading of a column gives; empty where it gives none."""
    name, _, unit = column.replace("[", " ").replace("]", " ").strip().partition(" ")
    return name, unit.strip()


def check_of(column: str) -> Check:
    """What judges the values of a column: numbers where it gives its unit, else quantities."""
    name, unit = named(column)
    dimension = _DIMENSIONS.get(name)
    return number if unit or dimension is None else quantity(Quantity(dimension))


def half_way(column: str, one: float, other: float) -> float:
    """The value between two of a column; between directions on the shorter way round."""
    name, unit = named(column)
    half = (one + other) / 2
    if name != "toward":
        return half
    try:
        turn = _TURN / unit_factor(unit or "deg", "angle")
    except QuantityError:
        return half
    return (half + turn / 2) % turn if abs(one - other) > turn / 2 else half
