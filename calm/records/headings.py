"""Headings of columns: a name and its unit, as people and programs write them.

``depth[m]``, ``Depth (m)``, ``depth m``, ``toward[deg magnetic]``, ``time (UTC)``. A name of
several words needs brackets around its unit, or a unit that is known.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from calm.positions import HEMISPHERES
from calm.records.times import ZONES_OF_UTC
from calm.suggestions import shown
from calm.units import DIMENSIONS, QuantityError, unit_factor

_BRACKETED = re.compile(r"(.*?)\s*[\[(]((?:[^\[\]()]|\([^()]*\))*)[\])]")
_WORD = re.compile(r"([^\s\[(]*)\s*(.*)")
_MAGNETIC = re.compile(r"(?i)\s*\bmag(netic)?$")


def heading(column: str, dimensions: Sequence[str] = ()) -> tuple[str, str]:
    """Return the name and the unit of a heading; the unit is empty where it gives none.

    Parameters
    ----------
    column : as it stands
    dimensions : of `calm.units.DIMENSIONS`; a name of several words ends where a unit of one of
        these begins
    """
    text = " ".join(column.split())
    bracketed = _BRACKETED.fullmatch(text)
    if bracketed:
        return bracketed[1], bracketed[2].strip()
    words = text.split(" ")
    for wanted in (dimensions, DIMENSIONS if dimensions else ()):  # a wrong unit is one too
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
    """Return the dimension of a column and its factor to SI (degrees).

    Latitudes and longitudes need no unit: they are in degrees, or in degrees and minutes.

    Parameters
    ----------
    column : its heading, for the message
    unit : that it gives
    dimensions : those it may be of, of `calm.units.DIMENSIONS`
    usual : the unit to offer; that of SI where it is empty

    Raises
    ------
    QuantityError
        The unit is unknown, or of something else; its text is the whole message.
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
    said = next((one for one in complaints if one.suggestion), complaints[0])
    meant = column.strip().replace(unit, said.suggestion) if said.suggestion else ""
    offer = f"; did you mean `{shown(meant)}`?" if meant else ""
    raise QuantityError(f"`{shown(column)}` {said.complaint}{offer}")


def is_time(column: str) -> bool:
    """Return whether a heading is that of the times."""
    return heading(column)[0].lower() == "time"


def zone_complaint(column: str) -> str | None:
    """Return what is wrong with a heading of times that gives another zone than UTC."""
    zone = heading(column)[1]
    if not zone or zone.upper() in ZONES_OF_UTC:
        return None
    return (
        f"`{column.strip()[:40]}`: times are in UTC, or each says what it is ahead, as in "
        "2026-03-01T06:00+02:00"
    )


def magnetic_columns(columns: Sequence[str]) -> tuple[list[str], set[str]]:
    """Return headings without the word for their north, and the names of those that had one."""
    plain = [_without_north(column) for column in columns]
    pairs = zip(columns, plain, strict=True)
    return plain, {heading(column)[0].lower() for column, other in pairs if column != other}


def _without_north(column: str) -> str:
    """Return a heading without the word ``magnetic`` at the end of its unit."""
    name, unit = heading(column)
    plain = _MAGNETIC.sub("", unit)
    return column if plain == unit else f"{name} {plain}".strip()


def _is_unit(text: str, dimension: str) -> bool:
    try:
        unit_factor(text, dimension)
    except QuantityError:
        return False
    return True
