"""Read the rows of a list in SI units, with notes on the interpretation of each row."""

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from itertools import pairwise

from calm.exchange import model
from calm.exchange.part_names import is_called, is_long, size_in
from calm.exchange.table.cells import SheetRows, number, unit_called
from calm.exchange.table.headings import WORDS, ListColumn, ListHeadings, cell_of, decimals_of

TOTAL = re.compile(
    r"^(sub-?)?(totals?|totaux|gesamt\w*|summ?[ae]?|somme|ensemble|i alt|tilsammans)\b", re.I
)
_DITTO = re.compile(r"^(ditt?o|do|idem|id|dto|[\"'\u2033\u201d\u201e\u3003]+)\.?$", re.I)
_COUNTED = re.compile(r"^\(?([2-9]|[1-9]\d)\s?[x\u00d7]\s?(?=\S)", re.I)  # 10x glass, 6 x 17 in
_LENGTHS = re.compile(r"^\(?\d+\s?[x\u00d7]\s?\d+([.,]\d+)?\s?m\b", re.I)  # 2 x 200 m wire
_ANCHOR_KINDS = re.compile(r"\banchors?\b|\bancre|\blest\b", re.I)
_ENOUGH = {"length", "buoyancy", "weight"}  # a row with any of these keys is a piece
_MOST = 1000  # maximum count of a row
# m: largest diameter of a piece, and of a line, in a column without a unit
_WIDEST, _WIDEST_LINE = 10.0, 0.5
_FULL = 5.0  # maximum ratio of the area of a line per metre to its diameter
_METRES = re.compile(r"/\s*(\d+)")  # kg/100 m
# values that are per metre for a line
_SPREAD = ("buoyancy", "mass", "area", "drag_area", "tangential_area")
ROLES = ("float", "instrument", "release", "connector")
_TALLEST = 20.0  # m: maximum length of a float, release or anchor
_FEWEST = 4  # minimum number of pieces for which increasing lengths are not a coincidence
_GROWN = 3.0  # m: longer than any usual fitting at the end of a line
_SHARED = ("length", "buoyancy", "weight", "mass", "area", "drag_area", "tangential_area")
_FITTING = 1.0  # m: a shorter connector is a fitting, not a rope


@dataclass(eq=False)
class ListRow:
    """A row of a list: name, values in SI units, count, and guesses.

    `metre` contains the keys of the values in `figures` that are per metre. `line` is true for a
    cable or chain, and false for another part. If `line` is None, CALM decides by role, kind and
    name.
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
    problems: list[str] = field(default_factory=list)

    @property
    def where(self) -> str:
        """Row number and name, for messages."""
        return f"row {self.place}, {self.name}"

    def refuse(self, problem: str) -> None:
        """Add a problem about this row."""
        self.problems.append(f"{self.where}: {problem}")

    def figure(self, what: str) -> float:
        """Return a value of the row; 0 if the list has none."""
        return self.figures.get(what, 0.0)

    @property
    def is_anchor(self) -> bool:
        """Whether the component of the row is an anchor."""
        anchor = _ANCHOR_KINDS.search(f"{self.kind} {self.role}")
        return anchor is not None or is_called(self.name, "anchor")

    @property
    def sinks(self) -> bool:
        """Whether the row is a part that sinks: a line, an anchor, a connector or a release."""
        named = is_called(self.name, "connector", "release")
        return named or self.is_line or self.is_anchor

    @property
    def is_line(self) -> bool:
        """Whether the row is a cable or a chain."""
        if self.line is not None:
            return self.line
        if self.role in ROLES or is_called(self.kind, "rigid"):
            return False
        if is_called(self.name, "connector") and self.figure("length") < _FITTING:
            return self.role == "line"
        return self.role == "line" or is_called(f"{self.kind} {self.name}", "line")


def rows_of(
    cells: SheetRows,
    headings: ListHeadings,
    problems: list[str],
    dropped: list[model.Remark],
    guessed: list[model.Remark],
    *,
    bare: Callable[[str], bool] = lambda name: False,
) -> list[ListRow]:
    """Read the rows below the headings; rows with totals or without values are added to `dropped`.

    `bare` is a function of a name. It returns true if a row with only this name is a piece, because
    a library has the values.
    """
    rows: list[ListRow] = []
    known = headings.columns
    decimal, remark = decimals_of(cells, headings, problems)
    if remark:
        guessed.append(model.Remark("numbers", remark))
    for place, each in enumerate(cells[headings.row + 1 :], headings.row + 2):
        name = cell_of(each, known["name"])
        if _DITTO.match(name) and rows:
            guessed.append(model.Remark(f"row {place}", f"`{name}` read as `{rows[-1].name}`"))
            name = rows[-1].name
        if not name:
            held = [cell_of(each, column) for what, column in known.items() if what in _ENOUGH]
            if any(re.search(r"\d", cell) for cell in held):
                dropped.append(model.Remark(f"row {place}", "the row has values but no name"))
            continue
        if TOTAL.match(name):
            dropped.append(model.Remark(f"row {place}", f"`{name}`, a sum"))
            continue
        row = _row(each, ListRow(place, name), known, decimal)
        if not (bare(name) or _ENOUGH & row.figures.keys() or row.is_anchor):
            dropped.append(model.Remark(f"row {place}", f"`{name}`, without length and weight"))
            continue
        size = row.figure("diameter") or row.figure("width") or size_in(name)
        fixed = row.is_line or row.is_anchor or row.role in ROLES or is_called(row.kind, "rigid")
        if not fixed and is_long(name, row.figure("length"), size):
            row.line = True
            guessed.append(model.Remark(row.where, "read as a rope, since it is long and thin"))
        several = _COUNTED.match(name)
        if several and row.count == 1 and not (row.is_line and not _LENGTHS.match(name)):
            remark = (
                "read as one piece with the values of this row, although the name counts "
                f"{several[1]} pieces"
            )
            guessed.append(model.Remark(row.where, remark))
        _divide_totals(row, known, guessed)
        rows.append(row)
    return rows


def _row(cells: list[str], row: ListRow, known: dict[str, ListColumn], decimal: str) -> ListRow:
    row.label, row.kind, row.role = (
        cell_of(cells, known.get(what)).removeprefix("'") for what in ("label", "kind", "role")
    )
    for what, column in known.items():
        if what in WORDS:
            continue
        column, cell = column.of(cells, line=row.is_line)
        found = number(cell, decimal)
        if found.value is None:
            if found.wrong and what != "material":
                row.refuse(f"{column.heading}: {found.wrong}")
            continue
        try:
            unit = unit_called(found.rest, what)
        except ValueError as error:
            row.refuse(f"{column.heading}: `{cell}`: {error}")
            continue
        figure = found.value * (unit or column).factor
        if not math.isfinite(figure):
            row.refuse(f"{column.heading} is {found.value:g}")
            continue
        widest = _WIDEST_LINE if row.is_line else _WIDEST
        if what in ("diameter", "width") and not (unit or column.known) and figure > widest:
            row.refuse(f"{column.heading} is {figure:g} m; is its unit correct?")
        if unit.per_metre if unit else column.per_metre:
            row.metre.add(what)
            several = _METRES.search(f"{column.heading} {found.rest}")
            if several and not row.is_line:
                figure *= int(several[1])
                row.guesses[what] = (
                    "read as the value of the whole piece, because the piece is not a line"
                )
        row.figures[what] = figure
        if found.tidied:
            row.guesses[what] = f"`{cell}` read as {found.value:g} {found.rest}".rstrip()
    count = row.figures.pop("count", 1.0)
    row.count = round(count)
    if not 1 <= row.count <= _MOST:
        row.refuse(f"the count is {count:.12g}; it must be from 1 to {_MOST}")
        row.count = 1
    return row


def _divide_totals(row: ListRow, known: dict[str, ListColumn], guessed: list[model.Remark]) -> None:
    totals = [what for what in _SHARED if what in row.figures and what in known]
    totals = [what for what in totals if known[what].whole and what not in row.metre]
    if row.count == 1 or not totals:
        return
    for what in totals:
        row.figures[what] /= row.count
    headings = ", ".join(f"`{known[what].heading}`" for what in totals)
    guessed.append(model.Remark(row.where, f"{headings} divided by the count, {row.count}"))


def growing_lengths(rows: Iterable[ListRow]) -> list[str]:
    """Return messages about cumulative or implausibly large lengths.

    Lengths that increase from piece to piece along the whole line are treated as distances from an
    end of the line.
    """
    pieces = [row for row in rows if "at" not in row.figures and "length" in row.figures]
    lengths = [row.figures["length"] for row in pieces]
    if len({*lengths}) >= _FEWEST and max(lengths) >= _GROWN:
        longest = pieces[lengths.index(max(lengths))]
        grow = any(all(a <= b for a, b in pairwise(each)) for each in (lengths, lengths[::-1]))
        if grow and not longest.is_line:
            return [
                f"the lengths increase from piece to piece, from {min(lengths):g} m to "
                f"{max(lengths):g} m ({longest.name}), so they are distances from an end of the "
                "line; give each piece its own length"
            ]
    return [
        f"{row.where}: is {row.figures['length']:g} m long; is its unit correct?"
        for row in pieces
        if row.figures["length"] > _TALLEST
        and not row.is_line
        and (row.is_anchor or row.role in ("float", "release") or is_called(row.name, "release"))
    ]


def weights_as_buoyancy(rows: Iterable[ListRow], guessed: list[model.Remark]) -> None:
    """Convert weights to net buoyancy, positive up.

    A weight is read as positive down. If most sinking parts have negative weights, all weights are
    read as positive up. A buoyancy is read as positive up. If all sinking parts have a positive
    buoyancy and all other parts a negative one, all buoyancies are read as positive down.
    """
    rows = list(rows)
    sinking = [row.figures["weight"] for row in rows if row.sinks and row.figures.get("weight")]
    upward = 2 * sum(weight < 0.0 for weight in sinking) > len(sinking)
    lifts = [row for row in rows if row.figures.get("buoyancy")]
    turned = all(row.sinks == (row.figures["buoyancy"] > 0.0) for row in lifts)
    if turned and 0 < sum(row.sinks for row in lifts) < len(lifts):
        guessed.append(model.Remark("buoyancy", "positive for parts that sink: read as weight"))
        for row in lifts:
            row.figures["buoyancy"] *= -1.0
    if upward:
        guessed.append(model.Remark("weights", "negative for parts that sink: read as buoyancy"))
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
    """Convert the values of cables and chains to values per metre.

    Values are divided by the length of the cable or chain, unless they already are per metre.
    """
    lines = [row for row in rows if row.is_line and row.figure("length") > 0.0]
    for what in _SPREAD:
        column = known.get(what) or (known.get("weight") if what == "buoyancy" else None)
        listed = [row for row in lines if what in row.figures and what not in row.metre]
        if column is None or not listed:
            continue
        per_metre = not column.whole and (
            all(row.figures[what] <= _FULL * row.figure("diameter") for row in listed)
            if "area" in what
            else _same_for_all(listed, what)
        )
        for row in listed:
            if not per_metre:
                row.figures[what] /= row.figures["length"]
            row.metre.add(what)
            if what == "buoyancy" and not column.whole:
                row.guesses.setdefault(
                    what,
                    "read as values per metre, because lines of different lengths have the same "
                    "value"
                    if per_metre
                    else "read as the value of the whole length",
                )


def _same_for_all(lines: list[ListRow], what: str) -> bool:
    """True if cables or chains of the same name have equal values but different lengths.

    Values that do not depend on the length are per metre.
    """
    seen: dict[str, tuple[float, float]] = {}
    for row in lines:
        length, value = seen.setdefault(row.name, (row.figures["length"], row.figures[what]))
        if abs(length - row.figures["length"]) > 0.05 * length and value:
            return abs(value - row.figures[what]) < 0.01 * abs(value)
    return False
