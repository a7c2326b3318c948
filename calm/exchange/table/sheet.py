"""The cells of a CSV file or a spreadsheet."""

from __future__ import annotations

import csv
import io
from pathlib import Path

from calm.exchange.refusal import refused
from calm.files.document import read_content

_SPREADSHEETS = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1")  # xlsx, xls
_LARGEST = 20_000_000
_MOST_ROWS, _MOST_COLUMNS = 20_000, 500

Rows = list[list[str]]
"""Cells as text, without those behind the last that holds something."""


def is_spreadsheet(content: bytes) -> bool:
    """Whether a file is an Excel workbook, by its first bytes."""
    return content.startswith(_SPREADSHEETS)


def is_table(content: bytes) -> bool:
    """Whether a file is a workbook, or text whose lines are cut by the same sign."""
    if is_spreadsheet(content):
        return True
    lines = [line for line in content.split(b"\n")[:20] if line.strip()]
    cut = any(sum(sign in line for line in lines) >= 2 for sign in (b"\t", b";", b","))
    return b"\0" not in content and cut


def read_rows(path: Path) -> Rows:
    """The rows of a file; lines that begin with # are comments.

    Raises
    ------
    InputError
        It cannot be read.
    """
    content = read_content(path, largest=_LARGEST)
    rows = _workbook(path, content) if is_spreadsheet(content) else _csv(path, content)
    if len(rows) > _MOST_ROWS or any(len(row) > _MOST_COLUMNS for row in rows):
        raise refused(path, f"has more than {_MOST_ROWS} rows or {_MOST_COLUMNS} columns")
    cleaned = []
    for row in rows:
        cells = [" ".join(cell.split()) for cell in row]
        while cells and not cells[-1]:
            cells.pop()
        if cells and not cells[0].startswith("#"):
            cleaned.append(cells)
    return cleaned


def _csv(path: Path, content: bytes) -> Rows:
    if b"\0" in content:
        raise refused(path, "is a binary file; a table in text or a workbook is needed")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("cp1252", "replace")
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    signs = {sign: sum(line.count(sign) for line in lines[:20]) for sign in "\t;,"}
    delimiter = "\t" if signs["\t"] else ";" if signs[";"] else ","
    try:
        return list(csv.reader(io.StringIO("\n".join(lines)), delimiter=delimiter))
    except csv.Error as error:
        raise refused(path, f"is no table: {error}") from None


def _workbook(path: Path, content: bytes) -> Rows:
    try:
        import python_calamine
    except ImportError:
        raise refused(
            path, "is a workbook; install `calm-mooring[sheets]`, or save the sheet as CSV"
        ) from None
    try:
        book = python_calamine.load_workbook(io.BytesIO(content))
        sheets = [book.get_sheet_by_name(name).to_python() for name in book.sheet_names]
    except Exception as error:  # of the library, for damaged files
        raise refused(path, f"is a damaged workbook ({error})") from None
    filled = [sheet for sheet in sheets if sheet]
    return [[_shown(cell) for cell in row] for row in max(filled, key=len)] if filled else []


def _shown(cell: object) -> str:
    return f"{cell:.12g}" if isinstance(cell, float) else str(cell)
