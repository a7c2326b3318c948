"""Rows of a CSV record as numbers: many at once where they are plain, else one by one."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from calm.errors import Problem
from calm.files.current_csv import CsvHeader, CsvRow
from calm.files.current_terms import DEEPEST, Terms
from calm.files.tables import heading, magnetic_columns, turned_notices
from calm.physics.line import Floats
from calm.units import QuantityError, unit_factor

COLUMNS = 4
"""Depth [m], u, v and w [m/s]."""

_BLANK = re.compile(r",[ \t]*(?=,|$)", re.MULTILINE)
_DIMENSIONS = {"depth": "length", "toward": "angle", "from": "angle"}
_PLAIN = ({"depth", "u", "v"}, {"depth", "speed", "toward"}, {"depth", "speed", "from"})

Lines = Sequence[tuple[int, str]]
"""Lines of a file without their ends, each with its number."""


class RowReader:
    """Turns the lines of whole profiles into rows of depth, u, v and w.

    Where every cell is a number, and every depth and speed possible, they are read together; in
    any other case profile by profile, as `calm run` reads one, which finds the mistakes.
    """

    def __init__(self, header: CsvHeader, terms: Terms) -> None:
        self._header, self._terms = header, terms
        plain, magnetic = magnetic_columns(header.columns)
        agreed = bool(magnetic) == (terms.declination is not None) and magnetic not in (
            {"u"},
            {"v"},
        )
        self._factors = _factors(plain) if agreed else None  # otherwise the mistake is found
        self._turn = terms.declination or 0.0
        self.turned = turned_notices(header.columns, terms)
        self.has_w = any(_name(column) == "w" for column in plain)

    def read(self, profiles: Sequence[Lines], problems: list[Problem]) -> tuple[Floats, list[int]]:
        """The rows of some profiles, one after the other, and how many each has.

        Rows without a value are NaN or left out. Mistakes are added to `problems`.
        """
        counts = [len(lines) for lines in profiles]
        rows = self._together(profiles, counts)
        if rows is not None:
            return rows, counts
        tables = [self._one(lines, problems) for lines in profiles]
        return np.concatenate(tables), [len(table) for table in tables]

    def _together(self, profiles: Sequence[Lines], counts: list[int]) -> Floats | None:
        """All rows, None where one is not plain."""
        if self._factors is None:
            return None
        # the comma stays, so that a blank first cell is found
        text = "\n".join("," + line.partition(",")[2] for lines in profiles for _, line in lines)
        text = _BLANK.sub(",nan", text)
        try:
            cells = np.loadtxt(
                [line[1:] for line in text.split("\n")], delimiter=",", comments=None, ndmin=2
            )
        except ValueError:
            return None
        if cells.shape[1] != len(self._factors):
            return None
        values = {
            name: cells[:, j] * factor for j, (name, factor) in enumerate(self._factors.items())
        }
        rows = _components(values, self._turn)
        return rows if _possible(values, rows, counts) else None

    def _one(self, lines: Lines, problems: list[Problem]) -> Floats:
        rows = [CsvRow(number, line.split(",")) for number, line in lines]
        known = self._header.without_gaps(rows)
        table = self._header.profile(known, problems, self._terms) if known else None
        if table is None:
            return np.empty((0, COLUMNS))
        return np.column_stack([table.depth, table.u, table.v, table.w])


def _name(column: str) -> str:
    return heading(column)[0].lower()


def _factors(columns: Sequence[str]) -> dict[str, float] | None:
    """The factor of every column to SI (degrees), None where a column is not plain."""
    factors: dict[str, float] = {}
    for column in columns:
        name = _name(column)
        dimension = _DIMENSIONS.get(name, "speed")
        unit = heading(column)[1]
        try:
            factors[name] = unit_factor(unit, dimension) if unit else np.nan
        except QuantityError:
            return None
    plain = set(factors) - {"w"} in _PLAIN and len(factors) == len(columns)
    return factors if plain and all(np.isfinite(list(factors.values()))) else None


def _components(values: dict[str, Floats], turn: float) -> Floats:
    """Depth, u, v and w, whatever way the current is given, turned clockwise [degrees]."""
    w = values.get("w", np.zeros_like(values["depth"]))
    if "u" in values:
        u, v = values["u"], values["v"]
        if turn:
            sine, cosine = np.sin(np.radians(turn)), np.cos(np.radians(turn))
            u, v = u * cosine + v * sine, v * cosine - u * sine
        return np.column_stack([values["depth"], u, v, w])
    direction = values["from"] + 180.0 if "from" in values else values["toward"]
    angle = np.radians(direction + turn)
    speed = values["speed"]
    return np.column_stack([values["depth"], speed * np.sin(angle), speed * np.cos(angle), w])


def _possible(values: dict[str, Floats], rows: Floats, counts: list[int]) -> bool:
    """Whether a reading row by row would find no mistake."""
    known = ~np.isnan(rows).any(axis=1)
    depth = values["depth"]
    if not (np.isfinite(depth) & (depth >= 0) & (depth <= DEEPEST)).all() or np.isinf(rows).any():
        return False
    if "speed" in values and (values["speed"][known] < 0).any():
        return False
    if any(
        (np.abs(values[way][known]) > 360.0).any() for way in ("toward", "from") if way in values
    ):
        return False
    profile = np.repeat(np.arange(len(counts)), counts)[known]
    same = profile[1:] == profile[:-1]
    return bool((np.diff(depth[known])[same] > 0).all())
