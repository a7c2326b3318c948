"""Read a list of pieces as a design, and libraries of elements, whose figures complete it.

A library is the table of elements of Mooring Design & Dynamics, in character matrices, or a table
or workbook whose sheets have headings.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping
from itertools import accumulate
from pathlib import Path

import numpy as np

from calm.errors import nearest, refused
from calm.exchange import list_rows, model
from calm.exchange.list_cells import SheetRows, number, read_sheets
from calm.exchange.list_headings import ListHeadings, check_given, headings_of
from calm.exchange.mat_file import MatVariables, is_mat, names, read_variables
from calm.exchange.mdd_file import GROUPS, read_water
from calm.files.components import FLEXIBLE_KINDS
from calm.units import KILOGRAM_FORCE
from calm.whole_file import read_content

_NOTE = "A list says nothing about the water, and little about drag. See `calm docs import-table`."
_WATER = ("z", "U", "V", "W", "rho")  # headings of a sheet of Mooring Design & Dynamics
_NAMES = 3  # at least, in a list of names alone


def read_list(path: Path, options: model.ImportOptions) -> model.ImportedDesign:
    """Read a CSV file or a workbook.

    InputError: no headings are recognised, a figure is missing, or no end is an anchor.
    """
    columns, elements = options.columns, options.elements
    sheets = read_sheets(path)
    check_given(sheets, columns, path)
    if elements is None and not columns and is_library(sheets):
        raise refused(
            path,
            "is a library of elements, not a mooring; a list takes its figures: --elements FILE",
        )
    library = read_library(elements) if elements is not None else {}
    design = model.ImportedDesign("a list", path.stem, [], None, notes=[_NOTE])
    design.water = _water(sheets, design, path)
    problems: list[str] = []
    ordered = sorted(sheets.values(), key=len, reverse=True)
    headed = ((cells, headings_of(cells, columns)) for cells in ordered)
    cells, headings = next((each for each in headed if each[1] is not None), ([], None))
    said = list[model.Remark]()
    if headings is not None:
        problems += headings.problems
        said = _unit_remarks(headings)
        weighed = {"buoyancy", "weight"} & headings.columns.keys()
        rows = list_rows.rows_of(
            cells, headings, problems, design.dropped, said,
            bare=lambda name: bool(library) and (not weighed or key_of(name) in library),
        )  # fmt: skip
        list_rows.weights_as_buoyancy(rows, design.guessed)
        if headings.others:
            design.dropped.append(model.Remark("columns", ", ".join(headings.others)))
    else:
        rows = _names(sheets, design, path, library)
    if elements is not None:
        complete_rows(rows, library, elements.name)
    list_rows.count_lines(rows, headings.columns if headings else {})
    if sum(row.count for row in rows) > model.MOST_PIECES:
        raise refused(path, f"has more than {model.MOST_PIECES} pieces")
    rows = _from_the_top(rows, path, design)
    design.items = _items(rows)
    design.guessed += said
    if problems := [*problems, *(each for row in rows for each in row.problems)]:
        raise refused(path, *problems)
    design.in_kilograms = headings is None or any(
        headings.columns[key].by_mass for key in ("buoyancy", "weight") if key in headings.columns
    )
    return design


def _unit_remarks(headings: ListHeadings) -> list[model.Remark]:
    """Return what is taken for the unit of forces whose headings give none."""
    usual = {"buoyancy": "kg", "weight": "kg", "stiffness": "N", "breaking_load": "N"}
    return [
        model.Remark(f"column {column.heading}", f"gives no unit: read as {usual[what]}")
        for what, column in headings.columns.items()
        if what in usual and not column.known
    ]


def _names(
    sheets: Mapping[str, SheetRows], design: model.ImportedDesign, path: Path, library: Library
) -> list[list_rows.ListRow]:
    """Return the rows of a list that holds names alone, in the longest sheet.

    The first is the name of the mooring where the library has no such element.
    """
    longest = max(sheets.values(), key=len, default=[])
    rows = _names_in(longest)
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


def _names_in(cells: SheetRows) -> list[list_rows.ListRow]:
    """Return the rows of a sheet that holds names alone: the words of the column that has most."""
    words = (i for row in cells for i, cell in enumerate(row) if re.search(r"[^\W\d]{2}", cell))
    counts = Counter(words)
    best = max(range(max(map(len, cells), default=1)), key=counts.__getitem__)
    return [
        list_rows.ListRow(place, row[best])
        for place, row in enumerate(cells, 1)
        if best < len(row) and row[best] and not list_rows.TOTAL.match(row[best])
    ]


def _water(
    sheets: Mapping[str, SheetRows], design: model.ImportedDesign, path: Path
) -> model.ImportedWater | None:
    """Return the environment in a sheet of heights, `z`, of Mooring Design & Dynamics."""
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
    """Return a number of the water; 0 of an empty cell."""
    found = number(row[index])
    if found.wrong or found.rest:
        raise refused(path, f"water: {found.wrong or f'`{row[index]}` is not a number'}")
    return found.value or 0.0


def _from_the_top(
    rows: list[list_rows.ListRow], path: Path, design: model.ImportedDesign
) -> list[list_rows.ListRow]:
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
    design.guessed.append(model.Remark("line.anchor", "the list has none"))
    return [*rows, list_rows.ListRow(0, "anchor", kind="anchor", role="anchor")]


def _turned(rows: list[list_rows.ListRow]) -> list[list_rows.ListRow]:
    pieces = accumulate(int("at" not in row.figures) for row in rows)
    numbered = sorted(zip(pieces, rows, strict=True), key=lambda pair: -pair[0])
    return [row for _, row in numbered]


def _items(rows: list[list_rows.ListRow]) -> list[model.ImportedPiece]:
    items: list[model.ImportedPiece] = []
    for row in rows:
        component = list_rows.component_of(row, anchor=row is rows[-1] and row.is_anchor)
        at = row.figures.get("at")
        if at is None:
            length = row.figures.get("length") if component.kind in FLEXIBLE_KINDS else None
            guess = "" if length is None else row.guesses.get("length", "")
            items += [
                model.ImportedPiece(component, length, label=row.label, guess=guess)
                for _ in range(row.count)
            ]
        elif items:
            items[-1].clamps.append(model.ImportedClamp(component, at, row.guesses.get("at", "")))
    return items


_NOT_THEIRS = ("at", "count", "height")  # of an element, whatever the heading says
_A_METRE = 1e-6  # m by which the length of a line's figures may miss a metre
_SHEETS = 3  # with headings of their own make a library

_LINES = ("wires", "chains")
_NAME = 16  # bytes of a name, where the file does not say
_FIGURES = (6, 7)  # behind it: buoyancy, mass in air of late, length, width, diameter, Cd, material
_CENTIMETRE = 0.01
_METRE = 100.0  # cm: the length of a line whose figures are those of a metre


Library = Mapping[str, list_rows.ListRow]
"""Elements by their name without capitals and blanks; figures of a line are those of a metre."""


def read_library(path: Path) -> Library:
    """Return the elements of Mooring Design & Dynamics' `mdcodes.mat`, or of a table or workbook.

    Of several elements of one name the first holds. InputError: the file cannot be read, or holds
    no elements.
    """
    content = read_content(path, largest=200_000_000)
    elements = _of_matrices(path) if is_mat(content) else _of_sheets(path)
    library: dict[str, list_rows.ListRow] = {}
    for element in elements:
        library.setdefault(key_of(element.name), element)
    return library


def is_library(sheets: Mapping[str, SheetRows]) -> bool:
    """Return whether sheets are a library: several with headings, or the table of moords."""
    headed = [found for rows in sheets.values() if (found := headings_of(rows, {})) is not None]
    moords = {"buoyancy_kg", "length_m", "width_m", "diameter_m"}
    return len(headed) >= _SHEETS or any(
        moords <= {column.heading for column in found.columns.values()} for found in headed
    )


def key_of(name: str) -> str:
    """Return a name without capitals and blanks, as libraries are searched."""
    return "".join(name.lower().split())


def complete_rows(rows: Iterable[list_rows.ListRow], library: Library, source: str) -> None:
    """Give rows the figures that they lack, from the element of their name.

    Parameters
    ----------
    rows : of the list, changed in place
    library : in which they are looked up
    source : name of the library in hints
    """
    for row in rows:
        element = library.get(key_of(row.name))
        if element is None:
            near = nearest(row.name.lower(), [each.name.lower() for each in library.values()])
            if "buoyancy" not in row.figures and near is not None:
                row.hint = f"; {source} has `{near}`"
            elif "buoyancy" not in row.figures:
                row.hint = f"; {source} has no element of that name"
            continue
        row.line = element.line
        for what, value in element.figures.items():
            if what in row.figures or (element.line and what == "length"):
                continue
            row.figures[what] = value
            if element.line:
                row.metre.add(what)


def _of_matrices(path: Path) -> list[list_rows.ListRow]:
    """Return the elements of character matrices, a row an element, as in `mdcodes.mat`."""
    variables = read_variables(path, [*GROUPS, "format"])
    entries = [
        entry
        for group in GROUPS
        for text in names(variables.get(group))
        if (entry := _entry(text, group, _width(variables))) is not None
    ]
    if not entries:
        raise refused(path, "holds no element library of that program (`floats`, `wires` …)")
    return entries


def _width(variables: MatVariables) -> int:
    """Bytes of a name: `format` has the columns of the name and of each figure."""
    try:
        columns = variables.reals("format")
    except ValueError:
        return _NAME
    return int(columns[0, -1]) if columns.ndim == 2 and 0 < columns.size <= 100 else _NAME


def _entry(text: str, group: str, end: int) -> list_rows.ListRow | None:
    """Return an element of a row; None for a row that cannot be read."""
    content = text.encode()
    try:
        figures = [float(word) for word in content[end:].split()]
    except ValueError:
        return None
    if len(figures) not in _FIGURES:
        return None
    length, width, diameter, cd, material = figures[-5:]
    sizes = {"length": length, "width": width, "diameter": diameter}
    return list_rows.ListRow(
        0,
        content[:end].decode("utf-8", "replace").strip(),
        line=group in _LINES and length == _METRE,
        figures={
            "buoyancy": figures[0] * KILOGRAM_FORCE,
            **{name: size * _CENTIMETRE for name, size in sizes.items()},
            "cd": cd,
            "material": material,
        },
    )


def _of_sheets(path: Path) -> Iterable[list_rows.ListRow]:
    found = False
    for title, cells in read_sheets(path).items():
        headings = headings_of(cells, {})
        if headings is None:
            continue
        if headings.problems:
            raise refused(path, *headings.problems)
        rows = list_rows.rows_of(cells, headings, [], [], [])
        list_rows.weights_as_buoyancy(rows, [])
        for row in rows:
            found = True
            row.line = _is_line(row, title)
            row.figures = {k: one for k, one in row.figures.items() if k not in _NOT_THEIRS}
            yield row
    if not found:
        raise refused(path, "holds no elements: no sheet has headings that CALM knows")


def _is_line(row: list_rows.ListRow, title: str) -> bool:
    """Return whether an element is a line, with figures per metre."""
    floats = row.figures.get("buoyancy", 0.0) > 0.0 and row.figures.get("diameter", 0.0) > 0.0
    if abs(row.figures.get("length", 1.0) - 1.0) > _A_METRE or (floats and "width" in row.figures):
        return False
    return bool(row.metre) or row.is_line or model.is_called(title, "line")
