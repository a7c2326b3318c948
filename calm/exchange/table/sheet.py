"""The cells of a CSV file or a spreadsheet."""

from __future__ import annotations

import csv
import io
from pathlib import Path

from calm.exchange.refusal import refused
from calm.files.document import read_content

_SPREADSHEETS = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1")  # xlsx, xls
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")
_LARGEST = 20_000_000
_MOST_ROWS, _MOST_COLUMNS = 20_000, 500

SheetRows = list[list[str]]
"""Cells as text, up to the last that is not empty."""


def is_spreadsheet(content: bytes) -> bool:
    """Whether a file is an Excel workbook, by its first bytes."""
    return content.startswith(_SPREADSHEETS)


def is_table(content: bytes) -> bool:
    """Whether a file is a workbook, or text whose lines have the same separator."""
    if is_spreadsheet(content):
        return True
    if content.startswith(_UTF_16):
        content = content[: len(content) // 2 * 2].decode("utf-16", "replace").encode()
    lines = [line for line in content.split(b"\n")[:20] if line.strip()]
    cut = any(sum(sign in line for line in lines) >= 2 for sign in (b"\t", b";", b","))
    return b"\0" not in content and cut


def read_sheets(path: Path) -> dict[str, SheetRows]:
    """The rows of every sheet by its name; lines that begin with # are comments.

    A sheet without a cell is left out; text has one sheet, without a name.

    Raises
    ------
    InputError
        It cannot be read.
    """
    content = read_content(path, largest=_LARGEST)
    workbook = is_spreadsheet(content)
    sheets = _workbook(path, content) if workbook else {"": _csv(path, content)}
    for rows in sheets.values():
        if len(rows) > _MOST_ROWS or any(len(row) > _MOST_COLUMNS for row in rows):
            raise refused(path, f"has more than {_MOST_ROWS} rows or {_MOST_COLUMNS} columns")
    return {name: cleaned for name, rows in sheets.items() if (cleaned := _cleaned(rows))}


def _cleaned(rows: SheetRows) -> SheetRows:
    """Rows without blanks at the ends of cells, empty cells at the end, and comments."""
    cleaned = []
    for row in rows:
        cells = [" ".join(cell.split()) for cell in row]
        while cells and not cells[-1]:
            cells.pop()
        if cells and not cells[0].startswith("#"):
            cleaned.append(cells)
    return cleaned


def _csv(path: Path, content: bytes) -> SheetRows:
    lines = [line for line in _text(path, content).splitlines() if line.strip()]
    plain = [line for line in lines if not line.startswith("#")]
    # the sign that most lines have; commas may be decimal ones beside the others
    delimiter = max("\t;,", key=lambda sign: sum(sign in line for line in plain[:200]))
    try:
        return list(csv.reader(io.StringIO("\n".join(plain)), delimiter=delimiter))
    except csv.Error as error:
        raise refused(path, f"is not a table: {error}") from None


def _text(path: Path, content: bytes) -> str:
    """The text: UTF-8, UTF-16 with the mark of Excel, or the Western encoding of Windows."""
    if content.startswith(_UTF_16):
        return content.decode("utf-16", "replace")
    if b"\0" in content:
        raise refused(path, "is a binary file; a table in text or a workbook is needed")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("cp1252", "replace")


def _workbook(path: Path, content: bytes) -> dict[str, SheetRows]:
    try:
        import python_calamine
    except ImportError:
        raise refused(
            path, "is a workbook; install `calm-mooring[sheets]`, or save the sheet as CSV"
        ) from None
    try:
        book = python_calamine.load_workbook(io.BytesIO(content))
        sheets = {name: book.get_sheet_by_name(name).to_python() for name in book.sheet_names}
    except Exception as error:  # of the library, for damaged files
        raise refused(path, f"is a damaged workbook ({error})") from None
    return {
        name: [[_shown(cell) for cell in row] for row in sheet] for name, sheet in sheets.items()
    }


def _shown(cell: object) -> str:
    return f"{cell:.12g}" if isinstance(cell, float) else str(cell)
