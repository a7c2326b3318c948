"""Read a list of pieces as a design."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from calm.exchange.design import (
    MOST_PIECES,
    Design,
    ImportedClamp,
    ImportedComponent,
    ImportedPiece,
    ImportedWater,
    Remark,
    refused,
)
from calm.exchange.element_library import Library, complete_rows, is_library, key_of, read_library
from calm.exchange.list_cells import SheetRows, number, read_sheets
from calm.exchange.list_headings import ListHeadings, check_given, headings_of
from calm.exchange.list_rows import (
    ListRow,
    component_of,
    count_lines,
    names_in,
    rows_of,
    weights_as_buoyancy,
)
from calm.exchange.mdd_reader import read_water
from calm.files.components import FLEXIBLE_KINDS

_NOTE = "A list says nothing about the water, and little about drag. See `calm docs import-table`."
_WATER = ("z", "U", "V", "W", "rho")  # headings of a sheet of Mooring Design & Dynamics
_NAMES = 3  # at least, in a list of names alone


def read_list(path: Path, columns: Mapping[str, str], elements: Path | None = None) -> Design:
    """Read a CSV file or a workbook.

    Parameters
    ----------
    columns : headings by what they hold
    elements : a library with the figures that the list lacks

    Raises
    ------
    InputError
        No headings are recognised, a figure is missing, or no end is an anchor.
    """
    sheets = read_sheets(path)
    check_given(sheets, columns, path)
    if elements is None and not columns and is_library(sheets):
        raise refused(
            path,
            "is a library of elements, not a mooring; a list takes its figures: --elements FILE",
        )
    library = read_library(elements) if elements is not None else {}
    design = Design("a list", path.stem, [], None, notes=[_NOTE])
    design.water = _water(sheets, design, path)
    problems: list[str] = []
    chosen = _sheet(sheets, columns)
    headings, said = None, list[Remark]()
    if chosen is not None:
        cells, headings = chosen
        problems += headings.problems
        said = _unit_remarks(headings)
        weighed = {"buoyancy", "weight"} & headings.columns.keys()
        rows = rows_of(
            cells, headings, problems, design.dropped, said,
            bare=lambda name: bool(library) and (not weighed or key_of(name) in library),
        )  # fmt: skip
        weights_as_buoyancy(rows, design.guessed)
        if headings.others:
            design.dropped.append(Remark("columns", ", ".join(headings.others)))
    else:
        rows = _names(sheets, design, path, library)
    if elements is not None:
        complete_rows(rows, library, elements.name)
    count_lines(rows, headings.columns if headings else {})
    if sum(row.count for row in rows) > MOST_PIECES:
        raise refused(path, f"has more than {MOST_PIECES} pieces")
    rows = _from_the_top(rows, path, design)
    design.items = _items(rows, problems)
    design.guessed += said
    if problems:
        raise refused(path, *problems)
    design.in_kilograms = headings is None or any(
        headings.columns[key].by_mass for key in ("buoyancy", "weight") if key in headings.columns
    )
    return design


def _unit_remarks(headings: ListHeadings) -> list[Remark]:
    """Return what is taken for the unit of forces whose headings give none."""
    usual = {"buoyancy": "kg", "weight": "kg", "stiffness": "N", "breaking_load": "N"}
    return [
        Remark(f"column {column.heading}", f"gives no unit: read as {usual[what]}")
        for what, column in headings.columns.items()
        if what in usual and not column.known
    ]


def _sheet(
    sheets: Mapping[str, SheetRows], columns: Mapping[str, str]
) -> tuple[SheetRows, ListHeadings] | None:
    """Return the longest sheet that has headings, and those."""
    found = [
        (rows, headings)
        for rows in sorted(sheets.values(), key=len, reverse=True)
        if (headings := headings_of(rows, columns)) is not None
    ]
    return found[0] if found else None


def _names(
    sheets: Mapping[str, SheetRows], design: Design, path: Path, library: Library
) -> list[ListRow]:
    """Return the rows of a list that holds names alone, in the longest sheet.

    The first is the name of the mooring where the library has no such element.
    """
    longest = max(sheets.values(), key=len, default=[])
    rows = names_in(longest)
    filled = sum(bool(cell) for row in longest for cell in row)
    if len(rows) < _NAMES or 2 * len(rows) < filled:
        raise refused(
            path, "has no headings that CALM knows; name them: --columns name=…,length=…,weight=…"
        )
    if not library:
        raise refused(
            path,
            f"holds names and no figures (`{rows[0].name}`, `{rows[1].name}` …); "
            "give the library of these elements: --elements FILE",
        )
    if key_of(rows[0].name) not in library:
        if key_of(rows[0].name) != "name":
            design.name = rows[0].name
        rows = rows[1:]
    return rows


def _water(sheets: Mapping[str, SheetRows], design: Design, path: Path) -> ImportedWater | None:
    """Return the environment in a sheet of heights, `z`, of Mooring Design & Dynamics."""
    for rows in sheets.values():
        headings = [cell.lower() for cell in rows[0]]
        if not {"z", "u"} <= set(headings):
            continue
        columns = {
            name: np.array([_figure(row, i, path) for row in rows[1:] if i < len(row)])
            for name in _WATER
            if name.lower() in headings and (i := headings.index(name.lower())) >= 0
        }
        try:
            water, _ = read_water(columns, False, design.guessed)
        except ValueError as error:
            raise refused(path, str(error)) from None
        return water
    return None


def _figure(row: list[str], index: int, path: Path) -> float:
    """Return a number of the water; 0 of an empty cell."""
    found = number(row[index])
    if found.wrong or found.rest:
        raise refused(path, f"water: {found.wrong or f'`{row[index]}` is not a number'}")
    return found.value or 0.0


def _from_the_top(rows: list[ListRow], path: Path, design: Design) -> list[ListRow]:
    """Return the rows from the top down; lists run either way, clamps follow their piece."""
    pieces = [row for row in rows if "at" not in row.figures]
    if len(pieces) < 2:
        raise refused(path, f"has {len(pieces)} pieces")
    anchored = [i for i, row in enumerate(pieces) if row.is_anchor]
    if anchored and anchored[0] == 0 and anchored[-1] != len(pieces) - 1:
        design.notes.append("The list runs from the anchor up: here it is reversed.")
        return _turned(rows)
    if anchored and anchored[-1] == len(pieces) - 1:
        return rows
    lifts = [row.figures.get("buoyancy", 0.0) for row in (pieces[0], pieces[-1])]
    if max(lifts) <= 0.0:
        raise refused(
            path,
            "no end of the list is a float, and none is an anchor; a list of what is towed is not "
            "read, since it has neither ship nor speed",
        )
    if lifts[0] < lifts[1]:
        design.notes.append("The list runs from the lower end up: here it is reversed.")
        rows = _turned(rows)
    design.guessed.append(Remark("line.anchor", "the list has none"))
    return [*rows, ListRow(0, "anchor", kind="anchor", role="anchor")]


def _turned(rows: list[ListRow]) -> list[ListRow]:
    groups: list[list[ListRow]] = []
    for row in rows:
        if "at" in row.figures and groups:
            groups[-1].append(row)
        else:
            groups.append([row])
    return [row for group in reversed(groups) for row in group]


def _items(rows: list[ListRow], problems: list[str]) -> list[ImportedPiece]:
    items: list[ImportedPiece] = []
    for row in rows:
        component: ImportedComponent = component_of(
            row, problems, anchor=row is rows[-1] and row.is_anchor
        )
        at = row.figures.get("at")
        if at is None:
            length = row.figures.get("length") if component.kind in FLEXIBLE_KINDS else None
            guess = "" if length is None else row.guesses.get("length", "")
            items += [
                ImportedPiece(component, length, label=row.label, guess=guess)
                for _ in range(row.count)
            ]
        elif items:
            items[-1].clamps.append(ImportedClamp(component, at, row.guesses.get("at", "")))
    return items
