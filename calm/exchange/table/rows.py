"""The rows of a list in SI, each with how it was interpreted."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from calm.exchange.design import Remark
from calm.exchange.table.cells import number
from calm.exchange.table.headings import WORDS, ListColumn, ListHeadings
from calm.exchange.table.sheet import SheetRows
from calm.exchange.words import is_anchor, is_connector, is_line, is_release
from calm.units import KILOGRAM_FORCE

_TOTAL = re.compile(r"^(sub-?)?(total|totaux|sum|somme|ensemble)\b", re.I)
_LINE_KINDS = re.compile(r"\b(cable|c[âa]ble|chain|cha[iî]ne|line|wire|rope|cordage)s?\b", re.I)
_ANCHOR_KINDS = re.compile(r"\banchors?\b|\bancre|\blest\b", re.I)
_ENOUGH = {"length", "buoyancy", "weight"}  # one of them makes a piece
_MOST = 1000  # of one row's count
_FULL = 5.0  # times its diameter: a metre of line shows no larger area
_SPREAD = ("buoyancy", "mass", "area", "drag_area", "tangential_area")  # along a line


@dataclass(eq=False)
class ListRow:
    """A row: its name, its figures, what was guessed in it, and its count.

    `metre` names the figures of a line that are per metre; `line` says whether it is a cable or
    chain, and `hint` where a library says that its figures might be.
    """

    place: int
    name: str
    label: str = ""
    kind: str = ""
    role: str = ""
    figures: dict[str, float] = field(default_factory=dict)
    guesses: dict[str, str] = field(default_factory=dict)
    metre: set[str] = field(default_factory=set)
    line: bool | None = None
    hint: str = ""
    count: int = 1

    @property
    def where(self) -> str:
        """As problems call it."""
        return f"row {self.place}, {self.name}"

    @property
    def is_anchor(self) -> bool:
        """Whether it is the anchor."""
        return bool(_ANCHOR_KINDS.search(f"{self.kind} {self.role}")) or is_anchor(self.name)

    @property
    def is_line(self) -> bool:
        """Whether it is a cable or a chain."""
        if self.line is not None:
            return self.line
        if self.kind:
            return bool(_LINE_KINDS.search(self.kind))
        return is_line(self.name)


def rows_of(
    cells: SheetRows,
    headings: ListHeadings,
    problems: list[str],
    dropped: list[Remark],
    *,
    bare: Callable[[str], bool] = lambda name: False,
) -> list[ListRow]:
    """The rows below the headings; sums and rows without figures go to `dropped`.

    Parameters
    ----------
    bare : whether a name alone makes a piece, since a library has its figures
    """
    rows: list[ListRow] = []
    known = headings.columns
    for place, each in enumerate(cells[headings.row + 1 :], headings.row + 2):
        name = _cell(each, known["name"])
        if not name:
            continue
        if _TOTAL.match(name):
            dropped.append(Remark(f"row {place}", f"`{name}`, a sum"))
            continue
        mistakes: list[str] = []
        row = _row(each, place, name, known, mistakes)
        if not (bare(name) or _ENOUGH & row.figures.keys() or row.is_anchor):
            dropped.append(Remark(f"row {place}", f"`{name}`, without length and weight"))
            continue
        problems += mistakes
        rows.append(row)
    return rows


def names_in(cells: SheetRows) -> list[ListRow]:
    """The rows of a sheet that holds names alone: the words of the column that has most."""
    counts: dict[int, int] = {}
    for row in cells:
        for index, cell in enumerate(row):
            counts[index] = counts.get(index, 0) + bool(re.search(r"[^\W\d]{2}", cell))
    best = max(counts, key=lambda index: counts[index], default=0)
    return [
        ListRow(place, row[best])
        for place, row in enumerate(cells, 1)
        if best < len(row) and row[best] and not _TOTAL.match(row[best])
    ]


def _cell(row: list[str], column: ListColumn | None) -> str:
    if column is None or column.index >= len(row):
        return ""
    return row[column.index].strip().removeprefix("'")


def _row(
    cells: list[str], place: int, name: str, known: dict[str, ListColumn], mistakes: list[str]
) -> ListRow:
    words = {what: _cell(cells, known.get(what)) for what in WORDS}
    row = ListRow(place, name, words["label"], words["kind"], words["role"])
    for what, column in known.items():
        if what in WORDS:
            continue
        value, reading = number(_cell(cells, column))
        if value is None:
            if reading and what != "material":
                mistakes.append(f"{row.where}: {column.heading}: {reading}")
            continue
        scale = KILOGRAM_FORCE if column.by_mass else 1.0
        figure = value * column.factor * scale
        if not math.isfinite(figure):
            mistakes.append(f"{row.where}: {column.heading} is {value:g}")
            continue
        row.figures[what] = figure
        if column.per_metre:
            row.metre.add(what)
        if reading:
            row.guesses[what] = reading
    count = row.figures.pop("count", 1.0)
    if not 1.0 <= round(count) <= _MOST:
        mistakes.append(f"{row.where}: {count:.12g} of them")
    else:
        row.count = round(count)
    return row


def weights_as_buoyancy(rows: Iterable[ListRow], guessed: list[Remark]) -> None:
    """Give every row its net force as buoyancy, positive up.

    Weights are positive down; where they are negative for what sinks by its name, positive up.
    """
    rows = list(rows)
    sinking = [
        row.figures["weight"]
        for row in rows
        if row.figures.get("weight")
        and (is_connector(row.name) or is_release(row.name) or row.is_line or row.is_anchor)
    ]
    upward = 2 * sum(weight < 0.0 for weight in sinking) > len(sinking)
    if upward:
        guessed.append(Remark("weights", "negative for parts that sink: read as buoyancy"))
    for row in rows:
        if "weight" not in row.figures:
            continue
        weight, guess = row.figures.pop("weight"), row.guesses.pop("weight", "")
        if row.figures.get("buoyancy"):
            continue
        row.figures["buoyancy"] = weight if upward else 0.0 - weight
        if "weight" in row.metre:
            row.metre.add("buoyancy")
        if guess:
            row.guesses["buoyancy"] = guess


def count_lines(rows: Iterable[ListRow], known: dict[str, ListColumn]) -> None:
    """Make figures of lines per metre, where the list gives them of the whole length."""
    lines = [row for row in rows if row.is_line and row.figures.get("length", 0.0) > 0.0]
    for what in _SPREAD:
        column = known.get(what) or (known.get("weight") if what == "buoyancy" else None)
        listed = [row for row in lines if what in row.figures and what not in row.metre]
        if column is None or not listed:
            continue
        per_metre = not column.whole and (
            _within_a_metre(listed, what) if "area" in what else _same_for_all(listed, what)
        )
        for row in listed:
            if not per_metre:
                row.figures[what] /= row.figures["length"]
            row.metre.add(what)
            if what == "buoyancy" and not column.whole:
                row.guesses.setdefault(
                    what,
                    "read as that of a metre: it is the same at different lengths"
                    if per_metre
                    else "the weight in the list is read as that of the whole length",
                )


def _within_a_metre(lines: list[ListRow], what: str) -> bool:
    """Whether the figures of every line could be those of a metre."""
    return all(row.figures[what] <= _FULL * row.figures.get("diameter", 0.0) for row in lines)


def _same_for_all(lines: list[ListRow], what: str) -> bool:
    """Whether lines of one name and different lengths have one weight, which is per metre then."""
    seen: dict[str, tuple[float, float]] = {}
    for row in lines:
        length, value = seen.setdefault(row.name, (row.figures["length"], row.figures[what]))
        if abs(length - row.figures["length"]) > 0.05 * length and value:
            return abs(value - row.figures[what]) < 0.01 * abs(value)
    return False
