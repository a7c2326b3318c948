"""Read the cells of a list, and tell what its columns hold by headings in English or French."""

from __future__ import annotations

import io
import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from calm.exchange.design import refused
from calm.records.delimited import cells_in
from calm.suggestions import unknown
from calm.units import KILOGRAM_FORCE
from calm.whole_file import read_content

COLUMNS = (
    "name", "label", "kind", "role", "length", "diameter", "width", "mass", "buoyancy", "weight",
    "cd", "area", "drag_area", "tangential_area", "material", "stiffness", "breaking_load", "count",
    "at", "height",
)  # fmt: skip
"""What a column may hold, as `--columns` calls it."""

WORDS = ("name", "label", "kind", "role")
"""Columns that hold words."""

_PATTERNS: tuple[tuple[str, str], ...] = (
    ("count", r"^(qty|quantity|count|number|no\.? of|nb|nombre|qte|quantite)\b"),
    ("at", r"clamped at|along|position sur|distance"),
    ("tangential_area", r"tangential cd x area"),
    ("drag_area", r"drag area|\bcd ?[x*.]? ?a(rea)?\b|\bcda\b"),
    ("area", r"area|surface|maitre.?couple"),
    ("cd", r"^(cd|cx|c_?d|cn)\b|drag|trainee"),
    ("breaking_load", r"break|rupture|\bmbl\b|strength|resistance"),
    ("stiffness", r"^ea\b|stiff|raideur"),
    ("buoyancy", r"buoy|flott|lift|portance|poussee"),
    ("weight", r"(weight|poids|masse?).*(water|wet|eau|immerg|submer|sea|mer)"),
    ("weight", r"(wet|submerged|immersed).*(weight|mass)"),
    ("mass", r"(weight|poids).*\bair\b|\bmasse?\b|\bdry\b"),
    ("weight", r"^(weight|poids)\b"),
    ("mass", r"^(weight|poids)\b"),
    ("diameter", r"diam|ø"),
    ("width", r"width|largeur"),
    ("height", r"(height|hauteur|altitude).*(bottom|btm|fond|seabed|above)|bottom_height"),
    ("height", r"^altitude|^height$|^hauteur$"),
    ("length", r"^(length|longueur|long|len|l)\b|length|longueur"),
    ("material", r"^(material|materiau)\b"),
    ("role", r"^(role|fonction|function)\b"),
    ("kind", r"^(kind|type|category|categorie|famille|family)\b"),
    ("label", r"^(label|etiquette|serial|s/?n|repere)\b"),
    ("name", r"name|^nom\b|item|element|description|designation|component|composant|materiel"),
    ("name", r"equip|instrument|piece|part"),
)  # fmt: skip
_ALONG = re.compile(r"tangent|axial")  # a drag along the piece, which has a column of its own
_UNITS = {
    "m": 1.0, "mm": 1e-3, "cm": 1e-2, "in": 0.0254, "inch": 0.0254, "inches": 0.0254, "ft": 0.3048,
    "kg": 1.0, "kgf": KILOGRAM_FORCE, "g": 1e-3, "lb": 0.45359237, "lbs": 0.45359237,
    "lbf": 0.45359237 * KILOGRAM_FORCE, "n": 1.0, "kn": 1e3, "dan": 10.0, "t": 1e3, "m2": 1.0,
    "m^2": 1.0, "m²": 1.0, "cm2": 1e-4, "cm²": 1e-4, "pouces": 0.0254,
}  # fmt: skip
_MASSES = {"kg", "g", "lb", "lbs", "t"}
_FORCES = {"buoyancy", "weight", "stiffness", "breaking_load"}
_SEARCHED = 60  # rows in which the headings stand
_MEASURES = {"length", "buoyancy", "weight", "mass"}
_SPREADSHEETS = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1")  # xlsx, xls
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")
_LARGEST = 20_000_000
_MOST_ROWS, _MOST_COLUMNS = 20_000, 500
SheetRows = list[list[str]]
"""Cells as text, up to the last that is not empty."""

_NUMBER = re.compile(r"[-+−]?\s*(?:\d{1,3}(?:[ \u00a0]\d{3})+|\d+)?(?:[.,]\d+)?(?:[eE][-+]?\d+)?")
_NOTHING = {
    "", "-", "–", "—", "/", "*", "**", "n/a", "na", "nan", "none", "?", "nil", "x", "sans", "null",
}  # fmt: skip


@dataclass(frozen=True)
class ListColumn:
    """Describe a column: where it stands, its heading, and what its numbers are multiplied by.

    `by_mass`: forces are counted in kilograms; `per_metre`: figures of lines are those of a metre;
    `known`: the heading gives a unit; `whole`: it says that its figures are those of a whole piece.
    """

    index: int
    heading: str
    factor: float = 1.0
    by_mass: bool = False
    per_metre: bool = False
    known: bool = False
    whole: bool = False


@dataclass(frozen=True)
class ListHeadings:
    """Hold the row of the headings, the columns that are understood, and the other headings."""

    row: int
    columns: dict[str, ListColumn]
    others: tuple[str, ...]


def headings_of(rows: SheetRows, given: Mapping[str, str]) -> ListHeadings | None:
    """Return the headings of a sheet; None where no row has a name and a length or a force.

    Parameters
    ----------
    given : headings by what they hold, which come before those that are recognised
    """
    best: tuple[int, int, ListHeadings] | None = None
    for i in range(min(len(rows), _SEARCHED)):
        cells = _with_units(rows, i)
        found = _columns(cells, given)
        if "name" not in found and len(found) >= 2:
            index = _unnamed(rows, i, found)
            if index is not None:
                found["name"] = ListColumn(index, "")
        if "name" not in found or not _MEASURES & found.keys():
            continue
        merit = len(found), sum(column.known for column in found.values())
        if best is None or merit > best[:2]:
            taken = {column.index for column in found.values()}
            others = tuple(
                heading for index, heading in enumerate(rows[i]) if heading and index not in taken
            )
            best = *merit, ListHeadings(i, found, others)
    return best[2] if best else None


def check_given(sheets: Mapping[str, SheetRows], given: Mapping[str, str], path: Path) -> None:
    """Check that `--columns` names figures of a piece, and headings of the list.

    Parameters
    ----------
    sheets : cells by the name of the sheet
    given : headings by what they hold
    path : of the list

    Raises
    ------
    InputError
        It does not.
    """
    for what in given:
        if what not in COLUMNS:
            raise refused(
                path, unknown(f"--columns: `{what}` is nothing of a piece", what, COLUMNS)
            )
    cells = {
        _plain(cell) for rows in sheets.values() for row in rows[:_SEARCHED] for cell in row
    }  # fmt: skip
    for what, heading in given.items():
        if not any(cell.startswith(_plain(heading)) for cell in cells):
            raise refused(path, f"--columns: no column is called `{heading}` ({what})")


def _columns(row: list[str], given: Mapping[str, str]) -> dict[str, ListColumn]:
    found: dict[str, ListColumn] = {}
    plain = [_plain(cell) for cell in row]
    taken: set[int] = set()
    for what, heading in given.items():
        wanted = _plain(heading)
        matches = [i for i, cell in enumerate(plain) if cell == wanted] or [
            i for i, cell in enumerate(plain) if wanted and cell.startswith(wanted)
        ]
        if matches:
            taken.add(matches[0])
            found[what] = _column(what, matches[0], row[matches[0]])
    for what, pattern in _PATTERNS:
        for i, cell in enumerate(plain):
            along = what != "tangential_area" and _ALONG.search(cell)
            if what in found or i in taken or not cell or along:
                continue
            if re.search(pattern, cell):
                taken.add(i)
                found[what] = _column(what, i, row[i])
    _resolve(found)
    return found


def _resolve(found: dict[str, ListColumn]) -> None:
    """Take a height for a missing length, and a weight beside a buoyancy as that in air."""
    if "length" not in found and "height" in found and _plain(found["height"].heading) == "height":
        found["length"] = found.pop("height")
    plain_weight = re.match(r"(weight|poids)\b(?!.*(water|wet|eau))", _plain_of(found, "weight"))
    if plain_weight and "buoyancy" in found and "mass" not in found:
        found["mass"] = _column("mass", found["weight"].index, found.pop("weight").heading)


def _plain_of(found: dict[str, ListColumn], what: str) -> str:
    return _plain(found[what].heading) if what in found else ""


def _with_units(rows: SheetRows, i: int) -> list[str]:
    """Return a row of headings, with the units that stand below them."""
    row = rows[i]
    below = rows[i + 1] if i + 1 < len(rows) else []
    units = [cell for cell in below if cell]
    if not units or not all(_is_unit(cell) for cell in units):
        return row
    below = below + [""] * (len(row) - len(below))
    return [f"{cell} {unit}".strip() for cell, unit in zip(row, below, strict=False)]


def _is_unit(cell: str) -> bool:
    """Return whether a cell below a heading goes with it: `(kg)`, `m`, `off btm (m)`."""
    inside = re.search(r"\(([^()]*)\)\s*$", cell)
    words = _plain(inside[1] if inside else cell, keep="²^/").split("/")[0].split()
    return bool(words) and words[0] in _UNITS


def _unnamed(rows: SheetRows, i: int, found: dict[str, ListColumn]) -> int | None:
    """Return the first column without a heading whose cells are words."""
    taken = {column.index for column in found.values()}
    below = rows[i + 1 : i + 16]
    for index in range(min(3, max(map(len, below), default=0))):
        headed = index < len(rows[i]) and rows[i][index]
        words = [row[index] for row in below if index < len(row) and row[index]]
        named = sum(bool(re.search(r"[^\W\d]{3}", word)) for word in words)
        if not headed and index not in taken and len(words) >= 3 and 2 * named > len(words):
            return index
    return None


def _column(what: str, index: int, heading: str) -> ListColumn:
    if what in WORDS:
        return ListColumn(index, heading)
    words = re.findall(r"[a-z]+(?:\^?2|²)?", _plain(heading, keep="²^/"))
    unit = next((word for word in reversed(words) if word in _UNITS and word != what), None)
    per_metre = bool(re.search(r"/ ?m\b|per m|par m|lineique", _plain(heading, keep="/")))
    if per_metre and unit == "m":
        unit = next((word for word in words if word in _UNITS and word not in ("m", what)), None)
    by_mass = unit in _MASSES if unit else what in ("buoyancy", "weight")
    return ListColumn(
        index=index,
        heading=heading,
        factor=_UNITS[unit] if unit else 1.0,
        by_mass=by_mass and what in _FORCES,
        per_metre=per_metre,
        known=unit is not None,
        whole=bool(re.search(r"whole|total", _plain(heading))),
    )


def _plain(text: str, keep: str = "") -> str:
    """Return a heading without accents and capitals, signs as blanks but for those that matter."""
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text)  # buoyancyPerMeter
    decomposed = unicodedata.normalize("NFD", spaced.lower())
    letters = "".join(sign for sign in decomposed if not unicodedata.combining(sign))
    allowed = f"/.ø²^*_{keep}"
    return " ".join(
        "".join(sign if sign.isalnum() or sign in allowed else " " for sign in letters).split()
    )


def _is_spreadsheet(content: bytes) -> bool:
    """Return whether a file is an Excel workbook, by its first bytes."""
    return content.startswith(_SPREADSHEETS)


def is_table(content: bytes) -> bool:
    """Return whether a file is a workbook, or text whose lines have the same separator."""
    if _is_spreadsheet(content):
        return True
    if content.startswith(_UTF_16):
        content = content[: len(content) // 2 * 2].decode("utf-16", "replace").encode()
    lines = [line for line in content.split(b"\n")[:20] if line.strip()]
    cut = any(sum(sign in line for line in lines) >= 2 for sign in (b"\t", b";", b","))
    return b"\0" not in content and cut


def read_sheets(path: Path) -> dict[str, SheetRows]:
    """Return the rows of every sheet by its name; lines that begin with # are comments.

    A sheet without a cell is left out; text has one sheet, without a name.

    Raises
    ------
    InputError
        It cannot be read.
    """
    content = read_content(path, largest=_LARGEST)
    workbook = _is_spreadsheet(content)
    sheets = _workbook(path, content) if workbook else {"": cells_in(_text(path, content))}
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


def _text(path: Path, content: bytes) -> str:
    """Return the text: UTF-8, UTF-16 with the mark of Excel, or the Western encoding of Windows."""
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


def number(cell: str) -> tuple[float | None, str]:
    """Return the number of a cell, None where there is none; and how it was interpreted.

    A comma is a decimal sign, or parts thousands where a point follows; a word or unit after the
    number, or `~` before it, is left out and reported.
    """
    text = cell.strip().lstrip("'")
    if text.lower() in _NOTHING:
        return None, ""
    if re.fullmatch(r"[-+]?\d{1,3}(,\d{3})+\.\d+", text):
        return float(text.replace(",", "")), ""
    bare = text.lstrip("~≈≃<> ").removeprefix("ca.").removeprefix("env.").strip()
    found = _NUMBER.match(bare)
    if found is None or not any(sign.isdigit() for sign in found[0]):
        return None, f"`{cell}` is not a number"
    plain = found[0].replace("−", "-").replace(",", ".")
    value = float("".join(plain.split()).replace("\u00a0", ""))
    rest = bare[found.end() :].strip()
    reading = f"`{cell}` read as {value:g}" if rest or bare != text else ""
    return value, reading
