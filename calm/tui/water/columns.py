"""The columns of a table: their names and units, and what these make of the values."""

from __future__ import annotations

from dataclasses import replace

from calm.files.fields import QuantityField
from calm.records.headings import heading
from calm.records.profile_tables import DIRECTION, SALINITY, TEMPERATURE, WATER_DENSITY
from calm.tui.checking import Check, Reading, number, quantity
from calm.units import QuantityError, QuantityRange, unit_factor

_KINDS: dict[str, QuantityRange] = {
    "depth": QuantityField("length"),
    "speed": QuantityField("speed", at_least=0),
    "u": QuantityField("speed"),
    "v": QuantityField("speed"),
    "w": QuantityField("speed"),
    "toward": DIRECTION,
    "density": WATER_DENSITY,
    "temperature": TEMPERATURE,
    "salinity": SALINITY,
}
_TURN = 360.0


def dimension_of(name: str) -> str:
    """The dimension of the quantity that a column holds."""
    return _KINDS[name].dimension


def check_of(column: str) -> Check:
    """What judges the values of a column: numbers where it gives its unit, else quantities."""
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
