"""Read element libraries, which supply values missing in a list.

A library is either `mdcodes.mat` of Mooring Design & Dynamics, which has elements in character
matrices, or a table or workbook whose sheets have headings.
"""

from collections.abc import Iterable, Mapping
from pathlib import Path

from calm.errors import nearest, refused
from calm.exchange.mat_file import MatVariables, is_mat, names, read_variables
from calm.exchange.mdd.elements import GROUPS
from calm.exchange.part_names import is_called
from calm.exchange.table.cells import SheetRows, read_sheets
from calm.exchange.table.headings import headings_of
from calm.exchange.table.rows import ListRow, rows_of, weights_as_buoyancy
from calm.units import KILOGRAM_FORCE
from calm.whole_file import read_content

# columns that are ignored in a library, because an element has no such values
_NOT_THEIRS = ("at", "count", "height", "depth")
_A_METRE = 1e-6  # m: tolerance for the length of 1 m to which the values of a line refer
_SHEETS = 3  # minimum number of sheets with headings in a library

_LINES = ("wires", "chains")
_NAME = 16  # bytes of a name, if the file does not give their number
# numbers of values after a name: buoyancy, mass in air (newer versions), length, width, diameter,
# Cd, material
_FIGURES = (6, 7)
_CENTIMETRE = 0.01
_METRE = 100.0  # cm: length of a line whose values are per metre


Library = Mapping[str, ListRow]
"""Elements by name in lower case without blanks; values of lines are per metre."""


def read_library(path: Path) -> Library:
    """Read elements from `mdcodes.mat` of Mooring Design & Dynamics, or from a table or workbook.

    Of elements with the same name, the first is used. Raise InputError if the file is unreadable or
    has no elements.
    """
    content = read_content(path, largest=200_000_000)
    elements = _of_matrices(path) if is_mat(content) else _of_sheets(path)
    library: dict[str, ListRow] = {}
    for element in elements:
        library.setdefault(key_of(element.name), element)
    return library


def is_library(sheets: Mapping[str, SheetRows]) -> bool:
    """True if the sheets form a library of elements.

    A library has several sheets with headings, or a sheet that is the element table of moords.
    """
    headed = [found for rows in sheets.values() if (found := headings_of(rows, {})) is not None]
    moords = {"buoyancy_kg", "length_m", "width_m", "diameter_m"}
    return len(headed) >= _SHEETS or any(
        moords <= {column.heading for column in found.columns.values()} for found in headed
    )


def key_of(name: str) -> str:
    """Convert a name to a library key: lower case without blanks."""
    return "".join(name.lower().split())


def complete_rows(rows: Iterable[ListRow], library: Library, source: str) -> None:
    """Fill missing values in rows from the library element of the same name.

    Parameters
    ----------
    rows : rows of the list, changed in place
    source : name of the library, for hints to the user
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


def _of_matrices(path: Path) -> list[ListRow]:
    variables = read_variables(path, [*GROUPS, "format"])
    entries = [
        entry
        for group in GROUPS
        for text in names(variables.get(group))
        if (entry := _entry(text, group, _name_width(variables))) is not None
    ]
    if not entries:
        raise refused(
            path, "contains no element library of Mooring Design & Dynamics (`floats`, `wires` …)"
        )
    return entries


def _name_width(variables: MatVariables) -> int:
    try:
        columns = variables.reals("format")
    except ValueError:
        return _NAME
    return int(columns[0, -1]) if columns.ndim == 2 and 0 < columns.size <= 100 else _NAME


def _entry(text: str, group: str, end: int) -> ListRow | None:
    content = text.encode()
    try:
        figures = [float(word) for word in content[end:].split()]
    except ValueError:
        return None
    if len(figures) not in _FIGURES:
        return None
    length, width, diameter, cd, material = figures[-5:]
    sizes = {"length": length, "width": width, "diameter": diameter}
    return ListRow(
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


def _of_sheets(path: Path) -> Iterable[ListRow]:
    found = False
    for title, cells in read_sheets(path).rows.items():
        headings = headings_of(cells, {})
        if headings is None:
            continue
        if headings.problems:
            raise refused(path, *headings.problems)
        rows = rows_of(cells, headings, [], [], [])
        weights_as_buoyancy(rows, [])
        for row in rows:
            found = True
            row.line = _is_line(row, title)
            row.figures = {k: one for k, one in row.figures.items() if k not in _NOT_THEIRS}
            yield row
    if not found:
        raise refused(path, "contains no elements: no sheet has headings that CALM knows")


def _is_line(row: ListRow, title: str) -> bool:
    floats = row.figures.get("buoyancy", 0.0) > 0.0 and row.figures.get("diameter", 0.0) > 0.0
    if abs(row.figures.get("length", 1.0) - 1.0) > _A_METRE or (floats and "width" in row.figures):
        return False
    return bool(row.metre) or row.is_line or is_called(title, "line")
