"""The figures of a component that the list shows, sorts by and is asked for."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from calm.errors import CalmError
from calm.files import Catalogue
from calm.units import QuantityError, parse_quantity


@dataclass(frozen=True)
class Column:
    """A figure of components: its key, heading, dimension, and the unit it is shown in."""

    key: str
    heading: str
    dimension: str
    unit: str
    scale: float = 1.0
    decimals: int = 0

    def shown(self, value: float | None) -> str:
        """A figure for people; empty where it is not known."""
        return "" if value is None else f"{value * self.scale:.{self.decimals}f}"


COLUMNS = (
    Column("net", "net N", "force", "N"),
    Column("breaking", "break kN", "force", "kN", 1e-3, 1),
    Column("working", "work kN", "force", "kN", 1e-3, 1),
    Column("depth", "to m", "length", "m"),
    Column("drag", "drag N", "force", "N", 1.0, 1),
    Column("mass", "mass kg", "mass", "kg", 1.0, 1),
)
"""Net force in water, + up; loads; depth rating; drag across the axis at 1 m/s; mass in air. Of a
cable or chain per metre, but for its loads."""

_ALSO = {
    "mbl": "breaking",
    "wll": "working",
    "swl": "working",
    "buoyancy": "net",
    "rating": "depth",
}
_ASKED = re.compile(r"([a-z]+)(<=|>=|<|>)([-+]?[\d.].*)")
_HOLDS: dict[str, Callable[[float, float], bool]] = {
    "<": lambda value, limit: value < limit,
    "<=": lambda value, limit: value <= limit,
    ">": lambda value, limit: value > limit,
    ">=": lambda value, limit: value >= limit,
}
Figures = dict[str, float | None]


def figures_of(catalogue: Catalogue, id: str) -> Figures:
    """The figures of a component or assembly by the keys of `COLUMNS`; SI units."""
    from calm.assemble.datasheet import datasheet

    try:
        definition = catalogue.get(id)
        sheet = datasheet(definition, catalogue)
    except CalmError:
        return {}
    return {
        "net": None if sheet is None else sheet.net_buoyancy,
        "breaking": getattr(definition, "breaking_load", None),
        "working": getattr(definition, "working_load", None),
        "depth": getattr(definition, "depth_rating", None),
        "drag": None if sheet is None else sheet.kn,
        "mass": getattr(definition, "mass", None),
    }


@dataclass(frozen=True)
class Wanted:
    """A limit that a figure is to keep: ``breaking>50kN``."""

    key: str
    relation: str
    limit: float

    def holds(self, figures: Figures) -> bool:
        """Whether it is kept; not where the figure is unknown."""
        value = figures.get(self.key)
        return value is not None and _HOLDS[self.relation](value, self.limit)


def wanted(word: str) -> Wanted | None:
    """The limit that a word of a search is; None of a plain word.

    A number alone has the unit of its column.
    """
    found = _ASKED.fullmatch(word)
    if found is None:
        return None
    key = _ALSO.get(found[1], found[1])
    column = next((each for each in COLUMNS if each.key == key), None)
    if column is None:
        return None
    for text in (found[3], f"{found[3]} {column.unit}"):
        try:
            return Wanted(key, found[2], parse_quantity(text, column.dimension))
        except QuantityError:
            continue
    return None
