"""Read a list of pieces as a design."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from itertools import accumulate, pairwise
from pathlib import Path

import numpy as np

from calm.errors import refused, unknown
from calm.exchange import model
from calm.exchange.mat_file import MatVariables
from calm.exchange.mdd.water import read_water
from calm.exchange.table.cells import SheetRows, number, read_sheets
from calm.exchange.table.components import component_of
from calm.exchange.table.headings import ListHeadings, check_given, headings_of
from calm.exchange.table.library import Library, complete_rows, is_library, key_of, read_library
from calm.exchange.table.rows import (
    TOTAL,
    ListRow,
    count_lines,
    growing_lengths,
    rows_of,
    weights_as_buoyancy,
)
from calm.files.components import FLEXIBLE_KINDS

_NOTE = "A list has no data on the water and little data on drag. See `calm docs import-table`."
_WATER = ("z", "U", "V", "W", "rho")  # headings of a sheet of Mooring Design & Dynamics
_NAMES = 3  # minimum number of names in a list that has only names


def read_list(path: Path, options: model.ImportOptions) -> model.ImportedDesign:
    """Read a CSV file or a workbook as a design.

    Raises
    ------
    InputError
        No headings are recognised, a value is missing, or neither end of the list is an anchor or
        a float.
    """
    columns, elements = options.columns, options.elements
    sheets, hidden = read_sheets(path)
    check_given(sheets, columns, path)
    if elements is None and not columns and options.sheet is None and is_library(sheets):
        raise refused(
            path,
            "is a library of elements, not a mooring; use it with --elements FILE when you import "
            "a list. If one of its sheets is a list of pieces, select it with --sheet NAME",
        )
    lists = _selected_sheets(sheets, options.sheet, path)
    library = read_library(elements) if elements is not None else {}
    design = model.ImportedDesign("a list", path.stem, [], None, notes=[_NOTE])
    design.water = _water(sheets, design, path)
    problems: list[str] = []
    remarks = list[model.Remark]()
    headings = None
    if chosen := _sheet_with_headings(lists, hidden, columns, path, remarks):
        sheet, cells, headings = chosen
        problems += headings.problems
        remarks += _unit_remarks(headings)
        weighed = {"buoyancy", "weight"} & headings.columns.keys()
        rows = rows_of(
            cells, headings, problems, design.dropped, remarks,
            bare=lambda name: bool(library) and (not weighed or key_of(name) in library),
        )  # fmt: skip
        weights_as_buoyancy(rows, design.guessed)
        if headings.others:
            design.dropped.append(model.Remark("columns", ", ".join(headings.others)))
        problems += growing_lengths(rows)
        design.understood = _summary(sheet, headings, rows)
    else:
        rows = _rows_of_names(lists, design, path, library)
    if elements is not None:
        complete_rows(rows, library, elements.name)
    count_lines(rows, headings.columns if headings else {})
    if sum(row.count for row in rows) > model.MOST_PIECES:
        raise refused(path, f"has more than {model.MOST_PIECES} pieces")
    rows = _from_the_top(rows, path, design)
    if headings and "depth" in headings.columns and not _depths_increase(rows):
        heading = headings.columns["depth"].heading
        remarks.append(
            model.Remark(f"column {heading}", ("does not increase down the line and was ignored"))
        )
        for row in rows:
            row.figures.pop("depth", None)
    design.items = _items(rows)
    design.guessed += remarks
    if problems := [*problems, *(each for row in rows for each in row.problems)]:
        raise refused(path, *problems)
    design.in_kilograms = headings is None or any(
        headings.columns[key].by_mass for key in ("buoyancy", "weight") if key in headings.columns
    )
    return design


def _selected_sheets(
    sheets: Mapping[str, SheetRows], name: str | None, path: Path
) -> Mapping[str, SheetRows]:
    if name is None:
        return sheets
    if name not in sheets:
        raise refused(path, unknown(f"has no sheet `{name}`", name, filter(None, sheets)))
    return {name: sheets[name]}


def _sheet_with_headings(
    sheets: Mapping[str, SheetRows], hidden: Mapping[str, str], columns: Mapping[str, str],
    path: Path, remarks: list[model.Remark],
) -> tuple[str, SheetRows, ListHeadings] | None:  # fmt: skip
    """Return name, cells and headings of the only sheet with headings, or None.

    A hidden sheet is used only if no visible sheet has headings. Raise InputError if several sheets
    have headings.
    """
    found = [
        (name, cells, headings)
        for name, cells in sheets.items()
        if (headings := headings_of(cells, columns)) is not None
    ]
    shown = [each for each in found if hidden.get(each[0]) != "the sheet"] or found
    if not shown:
        return None
    if len(shown) > 1:
        names = ", ".join(f"`{name}` ({len(cells) - 1} rows)" for name, cells, _ in shown)
        raise refused(
            path, f"has {len(shown)} sheets with headings: {names}; select one with --sheet NAME"
        )
    taken = shown[0][0]
    if others := [name for name, *_ in found if name != taken]:
        what = f"used; hidden sheets were ignored: {', '.join(f'`{name}`' for name in others)}"
        remarks.append(model.Remark(f"sheet `{taken}`", what))
    if taken in hidden:
        remarks.append(model.Remark(f"sheet `{taken}`", f"hidden but read: {hidden[taken]}"))
    return shown[0]


def _summary(sheet: str, headings: ListHeadings, rows: list[ListRow]) -> str:
    pieces = [row for row in rows if "at" not in row.figures]
    length = sum(row.count * row.figure("length") for row in pieces)
    columns = ", ".join(
        f"{what.replace('_', ' ')} = `{column.heading}`"
        for what, column in headings.columns.items()
        if column.heading
    )
    of = f" of sheet `{sheet}`" if sheet else ""
    return f"{sum(row.count for row in rows)} pieces{of}, total length {length:.5g} m; {columns}"


def _unit_remarks(headings: ListHeadings) -> list[model.Remark]:
    usual = {"buoyancy": "kg", "weight": "kg", "stiffness": "N", "breaking_load": "N"}
    return [
        model.Remark(f"column {column.heading}", f"has no unit; {usual[what]} is assumed")
        for what, column in headings.columns.items()
        if what in usual and not column.known
    ]


def _rows_of_names(
    sheets: Mapping[str, SheetRows], design: model.ImportedDesign, path: Path, library: Library
) -> list[ListRow]:
    longest = max(sheets.values(), key=len, default=[])
    rows = _names_in(longest)
    filled = sum(bool(cell) for row in longest for cell in row)
    if len(rows) < _NAMES or 2 * len(rows) < filled:
        raise refused(
            path,
            "has no headings that CALM knows; name them with --columns name=…,length=…,weight=…",
        )
    if not library:
        raise refused(
            path,
            f"has names but no values (`{rows[0].name}`, `{rows[1].name}` …); "
            "add the library of these elements with --elements FILE",
        )
    if key_of(rows[0].name) not in library:  # the name of the mooring
        if key_of(rows[0].name) != "name":
            design.name = rows[0].name
        rows = rows[1:]
    return rows


def _names_in(cells: SheetRows) -> list[ListRow]:
    words = (i for row in cells for i, cell in enumerate(row) if re.search(r"[^\W\d]{2}", cell))
    counts = Counter(words)
    best = max(range(max(map(len, cells), default=1)), key=counts.__getitem__)
    return [
        ListRow(place, row[best])
        for place, row in enumerate(cells, 1)
        if best < len(row) and row[best] and not TOTAL.match(row[best])
    ]


def _water(
    sheets: Mapping[str, SheetRows], design: model.ImportedDesign, path: Path
) -> model.ImportedWater | None:
    for rows in sheets.values():
        headings = [cell.lower() for cell in rows[0]]
        if not {"z", "u"} <= set(headings):
            continue
        columns = MatVariables(
            (name, np.array([_figure(row, i, path) for row in rows[1:] if i < len(row)]))
            for name in _WATER
            if name.lower() in headings and (i := headings.index(name.lower())) >= 0
        )
        try:
            water, _ = read_water(columns, False, design.guessed)
        except ValueError as error:
            raise refused(path, str(error)) from None
        return water
    return None


def _figure(row: list[str], index: int, path: Path) -> float:
    found = number(row[index])
    if found.wrong or found.rest:
        raise refused(path, f"water: {found.wrong or f'`{row[index]}` is not a number'}")
    return found.value or 0.0


def _from_the_top(rows: list[ListRow], path: Path, design: model.ImportedDesign) -> list[ListRow]:
    pieces = [row for row in rows if "at" not in row.figures]
    if len(pieces) < 2:
        raise refused(path, f"has {len(pieces)} pieces; at least two are needed")
    anchored = [i for i, row in enumerate(pieces) if row.is_anchor]
    if anchored and anchored[0] == 0 and anchored[-1] != len(pieces) - 1:
        design.notes.append(
            "The list runs from the anchor up; the mooring file has the reverse order."
        )
        return _reversed_rows(rows)
    if anchored and anchored[-1] == len(pieces) - 1:
        return rows
    lifts = [row.figures.get("buoyancy", 0.0) for row in (pieces[0], pieces[-1])]
    if max(lifts) <= 0.0:
        raise refused(
            path,
            "neither end of the list is a float or an anchor; a list of a tow cannot be read, "
            "because the speed of the ship is missing",
        )
    if lifts[0] < lifts[1]:
        design.notes.append(
            "The list runs from the lower end up; the mooring file has the reverse order."
        )
        rows = _reversed_rows(rows)
    design.guessed.append(model.Remark("line.anchor", "the list has no anchor; one is added"))
    return [*rows, ListRow(0, "anchor", kind="anchor", role="anchor")]


def _depths_increase(rows: list[ListRow]) -> bool:
    depths = [row.figures["depth"] for row in rows if "depth" in row.figures]
    return len({*depths}) > 1 and all(upper <= lower for upper, lower in pairwise(depths))


def _planned_depth(row: ListRow, component: model.ImportedComponent) -> float | None:
    of_its_own = "at" in row.figures or component.figures.get("role") in ("float", "instrument")
    return row.figures.get("depth") if of_its_own and row.count == 1 else None


def _reversed_rows(rows: list[ListRow]) -> list[ListRow]:
    # clamps remain after their piece
    pieces = accumulate(int("at" not in row.figures) for row in rows)
    numbered = sorted(zip(pieces, rows, strict=True), key=lambda pair: -pair[0])
    return [row for _, row in numbered]


def _items(rows: list[ListRow]) -> list[model.ImportedPiece]:
    items: list[model.ImportedPiece] = []
    for row in rows:
        component = component_of(row, anchor=row is rows[-1] and row.is_anchor)
        at, planned = row.figures.get("at"), _planned_depth(row, component)
        if at is None:
            length = row.figures.get("length") if component.kind in FLEXIBLE_KINDS else None
            guess = "" if length is None else row.guesses.get("length", "")
            items += [
                model.ImportedPiece(
                    component, length, label=row.label, guess=guess, planned_depth=planned
                )
                for _ in range(row.count)
            ]
        elif items:
            guess = row.guesses.get("at", "")
            clamp = model.ImportedClamp(component, at, guess, planned_depth=planned)
            items[-1].clamps.append(clamp)
    return items
