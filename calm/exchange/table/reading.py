"""A list of pieces as a design."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from calm.exchange.design import Component, Design, Figure, Hung, Item, Remark
from calm.exchange.refusal import refused
from calm.exchange.table.cells import number
from calm.exchange.table.headings import Column, headings_of
from calm.exchange.table.sheet import read_rows
from calm.exchange.words import is_anchor, is_chain, is_line, role_of
from calm.units import KILOGRAM_FORCE

_TOTAL = re.compile(r"^(sub-?)?(total|totaux|sum|somme|ensemble)\b", re.I)
_LINE_KINDS = re.compile(r"\b(cable|c[âa]ble|chain|cha[iî]ne|line|wire|rope|cordage)s?\b", re.I)
_ANCHOR_KINDS = re.compile(r"\banchors?\b|\bancre|\blest\b", re.I)
_MATERIAL_CD = {"cable": 1.3, "chain": 2.75}
_RIGID_CD = {"sphere": 0.5, "cylinder": 1.2}
_MOST = 1000  # of one row's count


@dataclass
class Row:
    """A row of the list in SI: what it is called, its figures, and what was guessed in it."""

    place: int
    name: str
    label: str
    kind: str
    role: str
    figures: dict[str, float]
    guesses: dict[str, str] = field(default_factory=dict)
    per_metre: bool = False

    @property
    def is_anchor(self) -> bool:
        """Whether it is the anchor."""
        return bool(_ANCHOR_KINDS.search(f"{self.kind} {self.role}")) or is_anchor(self.name)

    @property
    def is_line(self) -> bool:
        """Whether it is a cable or a chain."""
        if self.kind:
            return bool(_LINE_KINDS.search(self.kind))
        return is_line(self.name)


def read_table(path: Path, columns: Mapping[str, str]) -> Design:
    """Read a CSV file or a workbook.

    Raises
    ------
    InputError
        No headings are recognised, a figure is missing, or no end is an anchor.
    """
    cells = read_rows(path)
    start, known = headings_of(cells, columns, path)
    design = Design("a list", path.stem, [], None)
    rows: list[Row] = []
    problems: list[str] = []
    for place, each in enumerate(cells[start + 1 :], start + 2):
        name = _cell(each, known.get("name"))
        if not name:
            continue
        if _TOTAL.match(name):
            design.dropped.append(Remark(f"row {place}", f"`{name}`, a sum"))
            continue
        read = _rows(each, place, name, known, problems)
        if read and not {"length", "buoyancy"} & read[0].figures.keys() and not read[0].is_anchor:
            design.dropped.append(Remark(f"row {place}", f"`{name}`, without length and weight"))
            continue
        rows += read
    _count_lines(rows, known)
    rows = _from_the_top(rows, path, design)
    design.items = _items(rows, known, problems)
    if problems:
        raise refused(path, *problems)
    design.notes.append(
        "A list says nothing of the water, and little of drag. See `calm docs import-table`."
    )
    design.in_kilograms = any(known[key].by_mass for key in ("buoyancy", "weight") if key in known)
    return design


def _cell(row: list[str], column: Column | None) -> str:
    if column is None or column.index >= len(row):
        return ""
    return row[column.index].strip().removeprefix("'")


def _rows(
    cells: list[str],
    place: int,
    name: str,
    known: dict[str, Column],
    problems: list[str],
) -> list[Row]:
    """A row as often as it says."""
    row = Row(
        place, name, _cell(cells, known.get("label")), _cell(cells, known.get("kind")),
        _cell(cells, known.get("role")), {},
    )  # fmt: skip
    for what, column in known.items():
        if what in ("name", "label", "kind", "role"):
            continue
        value, told = number(_cell(cells, column))
        if value is None:
            if told:
                problems.append(f"row {place}, {name}: {column.heading}: {told}")
            continue
        if not math.isfinite(value):
            problems.append(f"row {place}, {name}: {column.heading} is {value:g}")
            continue
        scale = KILOGRAM_FORCE if column.by_mass else 1.0
        row.figures[what] = value * column.factor * scale
        if told:
            row.guesses[what] = told
    if "weight" in row.figures:
        weight = row.figures.pop("weight")
        guess = row.guesses.pop("weight", "")
        if "buoyancy" not in row.figures or not row.figures["buoyancy"]:
            row.figures["buoyancy"] = 0.0 - weight
            if guess:
                row.guesses["buoyancy"] = guess
    count = round(row.figures.pop("count", 1.0))
    if not 1 <= count <= _MOST:
        problems.append(f"row {place}, {name}: {count} of them")
        return []
    return [row] * count


def _count_lines(rows: list[Row], known: dict[str, Column]) -> None:
    """Forces and masses of lines per metre, where the list has those of the whole length."""
    lines = [row for row in rows if row.is_line and row.figures.get("length", 0.0) > 0.0]
    for what in ("buoyancy", "mass", "area"):
        column = known.get(what) or (known.get("weight") if what == "buoyancy" else None)
        if column is None or column.per_metre or not any(what in row.figures for row in lines):
            continue
        per_metre = not column.whole and _same_for_all_lengths(lines, what)
        for row in {id(each): each for each in lines}.values():
            if what not in row.figures or row.per_metre:
                continue
            if not per_metre:
                row.figures[what] /= row.figures["length"]
            if what == "buoyancy" and not column.whole:
                row.guesses.setdefault(
                    what,
                    "taken for that of a metre: it is the same at different lengths"
                    if per_metre
                    else "the list's weight taken for that of the whole length",
                )


def _same_for_all_lengths(lines: list[Row], what: str) -> bool:
    """Whether lines of one name and different lengths weigh the same: then that is of a metre."""
    seen: dict[str, tuple[float, float]] = {}
    for row in lines:
        if what not in row.figures:
            continue
        length, value = seen.setdefault(row.name, (row.figures["length"], row.figures[what]))
        if abs(length - row.figures["length"]) > 0.05 * length and value:
            return abs(value - row.figures[what]) < 0.01 * abs(value)
    return False


def _from_the_top(rows: list[Row], path: Path, design: Design) -> list[Row]:
    """The rows from the top down; lists lead either way, clamps stand behind their piece."""
    if len(rows) < 2:
        raise refused(path, f"has {len(rows)} pieces")
    pieces = [row for row in rows if "at" not in row.figures]
    anchored = [i for i, row in enumerate(pieces) if row.is_anchor]
    if anchored and anchored[0] == 0 and anchored[-1] != len(pieces) - 1:
        design.notes.append("The list leads from the anchor up: here it is turned round.")
        return _turned(rows)
    if anchored and anchored[-1] == len(pieces) - 1:
        return rows
    lifts = [row.figures.get("buoyancy", 0.0) for row in (pieces[0], pieces[-1])]
    if max(lifts) <= 0.0:
        raise refused(path, "no end of the list is a float, and none is an anchor")
    if lifts[0] < lifts[1]:
        design.notes.append("The list leads from the lower end up: here it is turned round.")
        rows = _turned(rows)
    anchor = Row(0, "anchor", "", "anchor", "anchor", {})
    design.guessed.append(Remark("line.anchor", "the list has none"))
    return [*rows, anchor]


def _turned(rows: list[Row]) -> list[Row]:
    groups: list[list[Row]] = []
    for row in rows:
        if "at" in row.figures and groups:
            groups[-1].append(row)
        else:
            groups.append([row])
    return [row for group in reversed(groups) for row in group]


def _items(rows: list[Row], known: dict[str, Column], problems: list[str]) -> list[Item]:
    items: list[Item] = []
    made: dict[int, Component] = {}
    for number_, row in enumerate(rows):
        last = number_ == len(rows) - 1
        component = made.get(id(row))
        if component is None:
            component = made[id(row)] = _component(row, problems, anchor=last and row.is_anchor)
        at = row.figures.get("at")
        if at is None:
            length = row.figures.get("length") if component.kind in ("cable", "chain") else None
            items.append(Item(component, length, label=row.label))
        elif items:
            items[-1].clamps.append(Hung(component, at))
    return items


def _component(row: Row, problems: list[str], *, anchor: bool) -> Component:
    where = f"row {row.place}, {row.name}"
    figures = row.figures
    guesses = {key: text for key, text in row.guesses.items()}
    if anchor:
        kept: dict[str, Figure] = {}
        if figures.get("buoyancy"):
            kept["weight"] = abs(figures["buoyancy"])
        elif figures.get("mass"):
            kept["mass"] = figures["mass"]
            guesses["mass"] = "taken for steel: the list gives no weight in water"
        kept["length"] = figures.get("length", 0.0)
        return Component(row.name, "anchor", kept, {k: v for k, v in guesses.items() if k in kept})
    if row.is_line:
        return _line(row, where, problems, guesses)
    if "buoyancy" not in figures:
        problems.append(f"{where}: its weight in water or its buoyancy is missing")
    if figures.get("length", 0.0) < 0.0 or figures.get("diameter", 0.0) < 0.0:
        problems.append(f"{where}: a length or diameter is negative")
    lift = figures.get("buoyancy", 0.0)
    across, length = figures.get("diameter", 0.0), figures.get("length", 0.0)
    role = row.role if row.role in _ROLES else role_of(row.name, lift)
    kept = {}
    round_ = across > 0.0 and (lift > 0.0 or row.kind == "sphere") and length <= 1.5 * across
    if "area" in figures:
        kind, kept = "body", {"length": length, "drag_area": figures["area"], "cd": 1.0}
        guesses["drag_area"] = guesses.get("area", "")
    elif across <= 0.0 or (not round_ and length <= 0.0):
        kind, kept = "body", {"length": length, "drag_area": 0.0, "cd": 1.0}
        guesses["drag_area"] = "the list gives no size: it has no drag"
    elif round_:
        kind = "sphere"
        kept = {"diameter": across, "length": length or across, "cx": figures.get("cd", 0.5)}
    else:
        kind = "cylinder"
        kept = {"diameter": across, "length": length, "cn": figures.get("cd", 1.2)}
    coefficient = {"sphere": "cx", "cylinder": "cn"}.get(kind)
    if coefficient and "cd" not in figures:
        guesses[coefficient] = f"the usual one of a {kind}"
    elif coefficient and row.guesses.get("cd"):
        guesses[coefficient] = row.guesses["cd"]
    kept["buoyancy"] = lift
    if figures.get("mass", 0.0) * KILOGRAM_FORCE >= max(-lift, 0.0) and figures.get("mass"):
        kept["mass"] = figures["mass"]
    if figures.get("breaking_load"):
        kept["breaking_load"] = figures["breaking_load"]
    kept["role"] = role
    return Component(row.name, kind, kept, {k: v for k, v in guesses.items() if k in kept and v})


_ROLES = ("float", "instrument", "release", "connector")


def _line(row: Row, where: str, problems: list[str], guesses: dict[str, str]) -> Component:
    figures = row.figures
    if figures.get("length", 0.0) <= 0.0:
        problems.append(f"{where}: a line needs its length")
    across = figures.get("diameter", 0.0)
    kind = "chain" if is_chain(f"{row.name} {row.kind}") else "cable"
    if across <= 0.0:
        across = _size_in(row.name)
        if across <= 0.0:
            problems.append(f"{where}: its diameter is missing")
            across = 0.01
        guesses["diameter"] = "from its name"
    kept: dict[str, Figure] = {"diameter": across}
    kept["cn"] = figures.get("cd", _MATERIAL_CD[kind])
    if "area" in figures:
        kept["cn"], kept["ct"] = figures["area"] / across, 0.0
    elif "cd" not in figures:
        guesses["cn"] = f"the usual one of a {kind}"
    lift = figures.get("buoyancy")
    if lift is None:
        problems.append(f"{where}: its weight in water is missing")
        lift = 0.0
    if lift > 0.0:
        kept["buoyancy"], kind = lift, "cable"
    else:
        kept["weight"] = 0.0 - lift
        if "buoyancy" in guesses:
            guesses["weight"] = guesses["buoyancy"]
    if figures.get("mass", 0.0) * KILOGRAM_FORCE >= max(-lift, 0.0) and figures.get("mass"):
        kept["mass"] = figures["mass"]
    for key in ("stiffness", "breaking_load"):
        if figures.get(key):
            kept[key] = figures[key]
    return Component(row.name, kind, kept, {k: v for k, v in guesses.items() if k in kept and v})


def _size_in(name: str) -> float:
    """A diameter in a name such as `8 mm wire` or `3/8" chain` [m]; 0 without one."""
    found = re.search(r"(\d+(?:[.,]\d+)?)\s*mm\b", name, re.I)
    if found:
        return float(found[1].replace(",", ".")) / 1000.0
    found = re.search(r"(?:(\d+)[ -])?(\d+)/(\d+)", name)
    if found and int(found[3]):
        return (int(found[1] or 0) + int(found[2]) / int(found[3])) * 0.0254
    found = re.search(r"(\d+(?:[.,]\d+)?)\s*(?:\"|''|in\b|inch)", name, re.I)
    return float(found[1].replace(",", ".")) * 0.0254 if found else 0.0
