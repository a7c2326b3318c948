"""Tables in text: separators, quotes, decimal commas and the position of each cell.

Separators are tabs, semicolons, commas or blanks; cells may be quoted. Empty lines and text after
``#`` are ignored.
"""

from __future__ import annotations

import csv
import io
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, islice
from pathlib import Path
from typing import NamedTuple

import numpy as np

from calm.errors import Problem, refused, shown
from calm.physics.line import Floats
from calm.whole_file import decoded, read_content

LARGEST_CSV = 50_000_000
"""Maximum size of a table that is read whole [bytes]."""

MOST_PROBLEMS = 20
"""Maximum number of mistakes shown for one file, as a wrong unit would cause thousands."""

GAPS = frozenset({"", "nan", "na", "n/a", "-", "none", "null"})
"""Lower-case cell texts that mark a missing value."""

COMMENT = re.compile(rb"(?m)^([ \t]*#).*")
"""Pattern of a comment in the bytes of a file. The encoding of comments does not matter."""

NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
_SAMPLE = 200  # lines from which the dialect is found
_LONGEST_CELL = 10  # most lines of one quoted cell
_SEPARATORS = {"\t": "tab", ";": "semicolon", ",": "comma", " ": "blank"}
_QUOTED = r'"(?:[^"]|"")*"'
_CELLS = {
    sign: re.compile(rf"( *)({_QUOTED}(?= *(?:{sign}|$))|[^{sign}]*)( *)({sign}|$)")
    for sign in "\t;,"
}
_WORDS = re.compile(rf"{_QUOTED}(?=\s|$)|\S+")
_FINISHED = re.compile(rf'(?:\s*(?:{_QUOTED}[^,;\t]*|[^",;\t\s][^,;\t]*|)(?:[,;\t]|$))*')
_POINT = re.compile(r"[-+]?\d*\.\d+([eE][-+]?\d+)?(\s*[^\d\s.,:-].*)?")
_COMMA = re.compile(r"([-+]?\d*),(\d+)((?:[eE][-+]?\d+)?(?:\s*[^\d\s.,:-].*)?)")

NumberedLine = tuple[int, str]
"""The number of a line, from 1, and its text."""


class NoTableError(ValueError):
    """Error raised if copied text is not a table; the message gives the line and the fault."""


@dataclass(frozen=True)
class Dialect:
    """Separator and decimal symbol of a table in text.

    Attributes
    ----------
    separator : tab, semicolon, comma or blank; a blank stands for any number of blanks
    decimal : decimal symbol, a point or a comma
    """

    separator: str
    decimal: str = "."

    def cells(self, line: str) -> list[str]:
        """Split a line into stripped, unquoted cells, and convert decimal commas to points."""
        if '"' in line:
            found = [text for _, text in self._placed(line)]
        elif self.separator == " ":
            found = line.split()
        else:
            found = line.split(self.separator)
            found = found if line.isprintable() and " " not in line else [*map(str.strip, found)]
        return [self.with_point(text) for text in found] if self.decimal == "," else found

    def column(self, line: str, cell: int) -> int:
        """Return the position in a line, from 1, at which a cell begins; 1 for a missing cell."""
        placed = self._placed(line)
        return placed[cell][0] + 1 if cell < len(placed) else 1

    def with_point(self, cell: str) -> str:
        """Replace the decimal comma of a number with a point, and return other cells unchanged."""
        found = _COMMA.fullmatch(cell) if self.decimal == "," else None
        return f"{found[1]}.{found[2]}{found[3]}" if found else cell

    def _placed(self, line: str) -> list[tuple[int, str]]:
        if self.separator == " ":
            return [(one.start(), _unquoted(one[0])) for one in _WORDS.finditer(line)]
        pattern, at, found = _CELLS[self.separator], 0, []
        while True:
            match = pattern.match(line, at)
            assert match is not None  # a cell may be empty
            found.append((match.end(1), _unquoted(match[2].strip())))
            at = match.end()
            if not match[4]:
                return found


class CellRow(NamedTuple):
    """A line of a table, divided into cells.

    Attributes
    ----------
    number, line : line number and original text
    cells : cells without the skipped cells at the start of the line
    skipped : number of skipped cells
    """

    path: Path
    number: int
    line: str
    cells: Sequence[str]
    dialect: Dialect
    skipped: int = 0

    def problem(self, message: str, cell: int | None = None) -> Problem:
        """Return a mistake located at a cell, or at the start of the line if `cell` is None."""
        at = 1 if cell is None else self.dialect.column(self.line, cell + self.skipped)
        return Problem(str(self.path), self.number, at, message)

    def mixed_decimals(self) -> list[Problem]:
        """Return a mistake for each number with a decimal point in a table with decimal commas."""
        if self.dialect.decimal != ",":
            return []
        mixed = "has a decimal point, but earlier numbers have decimal commas"
        return [
            self.problem(f"`{shown(cell)}` {mixed}", j - self.skipped)
            for j, cell in enumerate(Dialect(self.dialect.separator).cells(self.line))
            if _POINT.fullmatch(cell)
        ]

    def below(self, number: int, line: str) -> CellRow:
        """Split a line of the table below this header row into cells.

        In tables separated by blanks, a time may consist of two words: a date and a clock time.
        """
        cells, skipped = self.dialect.cells(line), self.skipped
        if self.dialect.separator == " " and len(cells) == len(self.cells) + skipped + 1:
            cells[skipped : skipped + 2] = [f"{cells[skipped]} {cells[skipped + 1]}"]
        return CellRow(self.path, number, line, cells[skipped:], self.dialect, skipped)


@dataclass(frozen=True)
class TextTable:
    """Header and rows of a table in a file."""

    header: CellRow
    rows: Sequence[CellRow]

    def whole_rows(self, problems: list[Problem]) -> list[CellRow]:
        """Return the rows that have as many cells as the header.

        For each other row, a mistake is added to `problems`.
        """
        whole = []
        for row in self.rows:
            problems += row.mixed_decimals()
            count, needed = len(row.cells), len(self.header.cells)
            if count == needed:
                whole.append(row)
                continue
            hint = "; is there a decimal comma? Write 48.2, not 48,2" if count > needed else ""
            problems.append(row.problem(f"the row has {count} values; {needed} are needed{hint}"))
        return whole


@dataclass(frozen=True)
class CopiedTable:
    """Cells of copied text.

    Attributes
    ----------
    headings : column headings; None if the first line holds numbers
    rows : stripped cells; all rows have the same number of cells
    """

    headings: tuple[str, ...] | None
    rows: tuple[tuple[str, ...], ...]


def read_table(path: Path, example: str, lines: Iterable[NumberedLine] | None = None) -> TextTable:
    """Read a table from a file of UTF-8 text.

    `example` is a sample header for messages. `lines` are the numbered lines of a file that is
    already split. Raise InputError if the file is unreadable or has no header.
    """
    if lines is None:
        text = decoded(path, COMMENT.sub(rb"\1", read_content(path, largest=LARGEST_CSV)))
        lines = enumerate(text.removeprefix("\ufeff").splitlines(), 1)
    header, lines = table_lines(path, lines, example)
    return TextTable(header, [header.below(*line) for line in lines])


def table_lines(
    path: Path, lines: Iterable[NumberedLine], example: str
) -> tuple[CellRow, Iterator[NumberedLine]]:
    """Return the header of a table, and an iterator over the lines below the header.

    A first column without a heading, as written by R and pandas, is skipped. `example` is a sample
    header for messages. Raise InputError without a header.
    """
    lines = _content(lines)
    sample = list(islice(lines, _SAMPLE))
    if not sample:
        raise refused(path, "is empty")
    dialect = dialect_of([line for _, line in sample])
    number, line = sample[0]
    cells = dialect.cells(line)
    skipped = int(not cells[0])
    header = CellRow(path, number, line, cells[skipped:], dialect, skipped)
    if len(cells) > 1 and not cells[-1]:
        message = f"the line ends in a {_SEPARATORS[dialect.separator]}; remove it from every line"
        raise refused(path, message, line=number, column=len(line.rstrip(" ")))
    if all(NUMBER.fullmatch(cell) for cell in cells):
        raise refused(path, f"there is no header; did you mean `{example}`?", line=number)
    if len(cells) < 2:
        message = f"`{shown(line[:40])}` is not a header such as `{example}`"
        raise refused(path, message, line=number)
    return header, chain(sample[1:], lines)


def copied_table(text: str) -> CopiedTable:
    """Parse a table copied from a spreadsheet, a file or a web page.

    A first line without numbers is the header. Raise NoTableError if there are no rows, or if rows
    differ in length.
    """
    lines = list(_content(enumerate(text.splitlines(), 1)))
    dialect = dialect_of([line.strip(" ") for _, line in lines])
    cells = [(number, tuple(dialect.cells(line.strip(" ")))) for number, line in lines]
    if not cells:
        raise NoTableError("the text has no numbers")
    first = cells[0][1]
    headings = None if any(map(_begins_with_number, first)) else first
    rows = cells[headings is not None :]
    if not rows:
        raise NoTableError("the text has no numbers")
    for number, row in rows:
        if len(row) != len(first):
            raise NoTableError(
                f"line {number} of the file has {len(row)} value{'s' * (len(row) != 1)}, but the "
                f"first line has {len(first)}"
            )
    return CopiedTable(headings, tuple(row for _, row in rows))


def cells_in(text: str) -> list[list[str]]:
    """Split the text of a table, with or without header, into cells.

    Decimal symbols are unchanged.
    """
    lines = [line for _, line in _content(enumerate(text.splitlines(), 1))]
    dialect = Dialect(dialect_of(lines[:_SAMPLE], words=True).separator)
    return [dialect.cells(line) for line in lines]


def dialect_of(lines: Sequence[str], *, words: bool = False) -> Dialect:
    """Find the separator and the decimal symbol of a table.

    `lines` has neither blank lines nor comments. If `words` is true, blanks do not separate cells.
    The decimal symbol is a comma if no number has a point, and if a comma is at a position at which
    it cannot separate thousands.
    """
    best, most = ",", 0
    for separator in _SEPARATORS:
        counts = Counter(len(Dialect(separator).cells(line)) for line in lines)
        alike = max((times for count, times in counts.items() if count > 1), default=0)
        if alike > most and not (separator == " " and (most or words)):
            best, most = separator, alike
    plain = Dialect(best)
    cells = [cell for line in lines for cell in plain.cells(line)]
    if any(_POINT.fullmatch(cell) for cell in cells):
        return plain
    commas = [found for cell in cells if (found := _COMMA.fullmatch(cell))]
    sure = any(len(one[2]) != 3 or not one[1].strip("+-0") for one in commas)
    return Dialect(best, "," if sure else ".")


def no_number(cell: str) -> str | None:
    """Return a message if a cell is not a plain number, else None."""
    if NUMBER.fullmatch(cell):
        return None
    pointed = Dialect(";", ",").with_point(cell)
    if NUMBER.fullmatch(pointed):
        return f"has a decimal comma; did you mean `{pointed}`?"
    return "is no number"


def is_gap(cell: str | None) -> bool:
    """Return whether a cell marks a missing value."""
    return cell is None or cell.lower() in GAPS


def plain_numbers(cells: Sequence[str | None]) -> Floats | None:
    """Convert cells to numbers, with NaN for missing values.

    Return None if a cell is neither a plain number nor a missing value.
    """
    try:
        found = np.array([float(cell) for cell in cells], np.float64)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return None
    plain = not np.isinf(found).any() and not any("_" in cell for cell in cells if cell)
    return found if plain else None


def abridged(problems: list[Problem]) -> list[Problem]:
    """Return the first `MOST_PROBLEMS` mistakes in file order.

    If there are more, the last entry states their number.
    """
    ordered = sorted(dict.fromkeys(problems), key=lambda one: (one.line, one.column))
    hidden = len(ordered) - MOST_PROBLEMS
    if hidden <= 0:
        return ordered
    more = Problem(problems[0].path, 0, 0, f"and {hidden} more mistakes")
    return [*ordered[:MOST_PROBLEMS], more]


def _content(lines: Iterable[NumberedLine]) -> Iterator[NumberedLine]:
    """Yield the lines that are neither empty nor comments.

    If a quoted cell continues on further lines, these lines are joined.
    """
    begun: list[NumberedLine] = []
    for number, line in lines:
        if not begun and (not line.strip() or line.lstrip().startswith("#")):
            continue
        if not begun and '"' not in line:
            yield number, line
            continue
        begun.append((number, line))
        whole = " ".join(text.strip(" ") for _, text in begun) if begun[1:] else line
        if _FINISHED.fullmatch(whole):
            yield begun[0][0], whole
            begun = []
        elif len(begun) == _LONGEST_CELL:
            yield from begun
            begun = []
    yield from begun


def _unquoted(cell: str) -> str:
    if len(cell) > 1 and cell[0] == cell[-1] == '"':
        return " ".join(cell[1:-1].replace('""', '"').split())
    return cell


def _begins_with_number(cell: str) -> bool:
    cell = Dialect(";", ",").with_point(cell)
    number = NUMBER.match(cell)
    rest = cell[number.end() :] if number else "?"
    return not rest or rest[0].isspace() or rest[0].isalpha() or rest[0] in "°%"


_FORMULA = ("=", "+", "-", "@", "\t", "\n")


def table_csv(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a table as CSV text, with empty cells for None and NaN.

    Numbers have at most twelve significant digits. An apostrophe precedes texts that spreadsheets
    would interpret as formulas.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(map(_cell, header))
    writer.writerows(map(_cell, row) for row in rows)
    return text.getvalue()


def _cell(value: object) -> str:
    if value is None or value != value:
        return ""
    if isinstance(value, str):
        text = value.replace("\r\n", "\n").replace("\r", "\n")
        return f"'{text}" if text.startswith(_FORMULA) else text
    return f"{value + 0.0:.12g}" if isinstance(value, float) else str(value)
