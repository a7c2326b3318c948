"""Read the cells of a list: sheets, numbers and units in common notations."""

import html
import io
import re
import zipfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from calm.errors import refused
from calm.exchange.foreign_process import read_apart
from calm.records.delimited import cells_in
from calm.units import DIMENSIONS, KILOGRAM_FORCE, QuantityError, unit_factor
from calm.whole_file import read_content

_DIMENSIONS = {
    **dict.fromkeys(("length", "diameter", "width", "at", "height", "depth"), "length"),
    **dict.fromkeys(("buoyancy", "weight", "stiffness", "breaking_load"), "force"),
    **dict.fromkeys(("area", "drag_area", "tangential_area"), "area"),
    "mass": "mass",
}  # dimensions of the columns
_NAMES_OF_UNITS = {
    "m": "meter metre metres meters mtr mètre mètres metern metro metros mts",
    "in": "inch inches zoll pouce pouces pulgada pulgadas \" ″ '' ” po",
    "ft": "foot feet fuß fuss pied pieds pie pies ' ′ ’",
    "fathom": "fathom fathoms fth faden brasse brasses",
    "mm": "millimeter millimetre millimetres millimètres",
    "cm": "zentimeter centimeter centimetre centimètres",
    "kg": (
        "kgs kilo kilos kilogram kilograms kilogramm kilogramme kilogrammes kilogramo kilogramos"
    ),
    "g": "gram grams gramm gramme grammes gr",
    "t": "tonne tonnes tonnen tonelada toneladas",
    "lb": "pound pounds lbs libra libras",
    "N": "newton newtons",
    "kgf": "kp kgp kilopond kg-f kgforce",
    "m^2": "m² m2 sqm qm",
    "cm^2": "cm² cm2",
    "ft^2": "ft² ft2 sqft",
    "in^2": "in² in2",
}
_SPELLED = {name: unit for unit, names in _NAMES_OF_UNITS.items() for name in names.split()}
_AMBIGUOUS = ("ton", "tons")  # may mean 907, 1000 or 1016 kg
_SUBSTANCES = r"(?:sea ?|salt ?|fresh ?)?(?:water|air|wasser|luft|l'?eau|eau|agua|aire|mer|mar)"
_IN_WATER = re.compile(
    rf"\b(?:in|im|an|dans|unter|en|el|l['’])(?: the| el| der| la)? {_SUBSTANCES}\b"
)
_PLAIN_WORDS = re.compile(
    rf"\b(?:wet|dry|{_SUBSTANCES}|net|nett[oa]?|gross|brutto|each|ea|total|whole|nominal|nom|approx"
    r"|est|ca|outer|outside|od|id|mean|max|min|immersed|submerged|immerg[ée]e?|sec|nass|trocken"
    r"|sumergido|seco|mojado|off|btm|bottom|fond|mbl|cyl|sph|unit|pc|pcs|pieces?|stk|stück"
    r"|st|x|pzas?|pi[èe]ces?)\b\.?",
    re.I,
)
_PER_METRE = re.compile(
    r"^(?P<unit>\S+?)\s*(?:/|\bper\b|\bpro\b|\bpar\b|\bpor\b|\bje\b)\s*(?P<count>\d*)\s*(?P<of>\S+)$"
)
_BRACKETS = re.compile(r"[(\[{]([^()\[\]{}]*)[)\]}]")
_NUMERAL = re.compile(
    r"(?P<sign>[-+−]?)\s*(?P<digits>\d[\d.,'’]*(?:[ \u00a0\u202f]\d{3}(?!\d)[\d.,]*)*|[.,]\d+)"
    r"(?P<power>[eE][-+]?\d{1,3}(?!\d))?"
)
_RATIO = re.compile(r"(?P<sign>[-+−]?)(?:(?P<whole>\d+)[ -])?(?P<over>\d+)/(?P<under>[1-9]\d*)")
_MULTIPLIED = re.compile(r"\s*[x×*]\s*\d", re.I)
_BEFORE = re.compile(r"^(?:[~≈≃<>øØ±\s]|ca\.|env\.|etwa\b|approx\.?|aprox\.?)+")
_SPREADSHEETS = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1")  # xlsx, xls
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")
_LARGEST = 20_000_000
_SHOWN = 5  # number of hidden rows that a remark names
_MOST_ROWS, _MOST_COLUMNS = 20_000, 500
_NOTHING = {
    "", "-", "–", "—", "/", "*", "**", "n/a", "na", "nan", "none", "?", "nil", "x", "sans", "null",
}  # fmt: skip


class WorkbookNumber(str):
    """A number from a workbook as text, always with a decimal point."""

    __slots__ = ()


SheetRows = list[list[str]]
"""Rows of cells as text; each row ends at its last nonempty cell."""


@dataclass(frozen=True)
class ColumnUnit:
    """The unit of a column: its conversion factor to SI, and whether values are per metre.

    `by_mass` is true if forces are given in kilograms or pounds.
    """

    factor: float
    per_metre: bool = False
    by_mass: bool = False


def unit_called(text: str, what: str) -> ColumnUnit | None:
    """Parse a unit, ignoring words such as *wet*; return None if the text has no unit.

    `what` is the quantity in the column. Raise ValueError if the unit does not fit this quantity.
    """
    plain = " ".join(text.replace("_", " ").split())
    while plain:
        if (found := _unit(plain, what)) is not None:
            return found
        less = _IN_WATER.sub(" ", plain.lower()) if _IN_WATER.search(plain.lower()) else ""
        less = less or _PLAIN_WORDS.sub(" ", plain)
        less = " ".join(re.sub(r"[,;:]", " ", less).split()).strip(".- ")
        if less == plain:
            break
        plain = less
    if not plain:
        return None
    if what not in _DIMENSIONS:
        raise ValueError(f"`{text}` is not understood")
    hint = " (it may mean 907, 1000 or 1016 kg)" if plain.lower() in _AMBIGUOUS else ""
    raise ValueError(f"`{plain}` is not a unit of {_DIMENSIONS[what]} that CALM knows{hint}")


def unit_of_heading(heading: str, what: str) -> ColumnUnit | None:
    """Find the unit in a heading, in brackets or at the end; return None if there is none.

    Raises
    ------
    ValueError
        The text in brackets is not a unit, or the heading has two units.
    """
    if what not in _DIMENSIONS:
        return None
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z][a-z])", " ", heading)  # buoyancyPerMeter
    found = [unit for inside in _BRACKETS.findall(spaced) if (unit := unit_called(inside, what))]
    if len(set(found)) > 1:
        raise ValueError(f"`{heading}` names two units")
    if found:
        return found[0]
    bare = " ".join(_IN_WATER.sub(" ", _BRACKETS.sub(" ", spaced).replace("_", " ")).split())
    words = re.sub(r"(\s*/\s*)(?=[^/]*$)", "/", bare).rstrip(".:").split()
    while len(words) > 1 and _PLAIN_WORDS.fullmatch(words[-1]):
        words.pop()
    for count in (3, 2, 1):
        if len(words) > count and (unit := _unit(" ".join(words[-count:]), what)):
            return unit
    last = words[-1].partition("/")[2] if len(words) == 1 else words[-1].lstrip("/")
    if last and (unit := _unit(last, what)):
        return unit
    if len(words) > 2 and words[-2].lower() in ("in", "en") and words[-1].isalpha():
        raise ValueError(f"`{words[-1]}` is not a unit of {_DIMENSIONS[what]} that CALM knows")
    return None


def _unit(text: str, what: str) -> ColumnUnit | None:
    dimension = _DIMENSIONS.get(what, "")
    for each, scale, by_mass in (
        (dimension, 1.0, False),
        *([("mass", KILOGRAM_FORCE, True)] if dimension == "force" else []),
        *([("force", 1.0 / KILOGRAM_FORCE, False)] if dimension == "mass" else []),
    ):
        if (factor := _factor(text, each)) is not None:
            return ColumnUnit(factor * scale, False, by_mass)
    parted = _PER_METRE.match(text)
    if parted is None or dimension not in ("mass", "force", "area"):
        return None
    of = _factor(parted["of"], "length")
    above = _unit(parted["unit"], what)
    if of is None or above is None or above.per_metre:
        return None
    return ColumnUnit(above.factor / of / float(parted["count"] or 1), True, above.by_mass)


def _factor(text: str, dimension: str) -> float | None:
    if dimension not in DIMENSIONS or text.lower() in _AMBIGUOUS:
        return None
    known = DIMENSIONS[dimension].units
    near = {unit.lower(): unit for unit in known if unit != "MN"}
    spelled = text if text in known else _SPELLED.get(text.lower().rstrip("."), "")
    try:
        spelled = spelled or near.get(text.lower(), "")
        return unit_factor(spelled, dimension) if spelled else None
    except QuantityError:
        return None


class CellNumber(NamedTuple):
    """Number in a cell, text after the number, and a message if the cell cannot be read.

    `value` is None without a number. `tidied` is true if the cell also has other text.
    """

    value: float | None
    rest: str = ""
    wrong: str = ""
    tidied: bool = False


def number(cell: str, decimal: str = "") -> CellNumber:
    """Parse the number in a cell; `decimal` is the decimal symbol of the file, empty if unknown."""
    text = cell.strip().lstrip("'")
    if text.lower() in _NOTHING:
        return CellNumber(None)
    bare = _BEFORE.sub("", text)
    if ratio := _RATIO.match(bare):
        value = int(ratio["whole"] or 0) + int(ratio["over"]) / int(ratio["under"])
        value *= -1.0 if ratio["sign"] in ("-", "−") else 1.0
        return CellNumber(value, bare[ratio.end() :].strip(), tidied=True)
    found = _NUMERAL.match(bare)
    if found is None:
        return CellNumber(None, wrong=f"`{cell}` is not a number")
    digits = found["digits"].rstrip(".,'’")
    rest = (
        bare[found.start("digits") + len(digits) :] if not found["power"] else bare[found.end() :]
    )
    if _MULTIPLIED.match(rest):
        wrong = f"`{cell}` contains a count and a value; put the count in a separate column"
        return CellNumber(None, wrong=wrong)
    if isinstance(cell, WorkbookNumber):
        decimal = "."
    sure, doubtful = _signs(digits)
    if doubtful and not decimal:
        return CellNumber(None, wrong=f"`{cell}` may be {_either(digits)}")
    decimal = decimal or sure or "."
    groups = re.split(f"[{re.escape(',' if decimal == '.' else '.')}'’ \u00a0\u202f]", digits)
    whole, _, part = groups[-1].partition(decimal)
    if (
        any(decimal in group for group in groups[:-1])
        or not re.fullmatch(r"\d*", part)
        or (groups[1:] and not all(len(group) == 3 for group in [*groups[1:-1], whole]))
    ):
        return CellNumber(None, wrong=f"`{cell}` is not a number")
    plain = "".join(groups[:-1]) + whole + "." + part + (found["power"] or "")
    value = float(plain) * (-1.0 if found["sign"] in ("-", "−") else 1.0)
    return CellNumber(value, rest.strip(), tidied=bool(rest.strip()) or bare != text)


def _signs(digits: str) -> tuple[str, str]:
    """Return the decimal symbol of a number, and a symbol of unclear meaning.

    The symbol is unclear in numbers such as `1,250`, and may then mark decimals or thousands. A
    symbol that is absent or unknown is empty.
    """
    plain = re.sub(r"['’\s]", "", digits)
    present = [sign for sign in ".," if sign in plain]
    if len(present) == 2:
        return max(present, key=plain.rfind), ""
    if not present:
        return "", ""
    (sign,), other = present, {".": ",", ",": "."}[present[0]]
    if plain.count(sign) > 1:
        return other, ""
    whole, _, part = plain.partition(sign)
    return ("", sign) if len(part) == 3 and whole.strip("0") and len(whole) <= 3 else (sign, "")


def _either(digits: str) -> str:
    plain = re.sub(r"[.,]", "", digits)
    return f"{plain} or {plain[:-3]}.{plain[-3:]}; write one of these"


def decimal_sign(cells: Iterable[tuple[str, str]]) -> tuple[str, str]:
    """Find the decimal symbol of a file; also return a remark on the meaning of commas.

    The remark is empty if the commas need no explanation. `cells` yields the position and text of
    each cell that should have a number. Raise ValueError if the numbers are contradictory, or
    ambiguous like `1,250`.
    """
    seen: dict[str, str] = {}
    doubtful: dict[str, tuple[str, str]] = {}  # position, and digits
    for place, cell in cells:
        found = None if isinstance(cell, WorkbookNumber) else _NUMERAL.match(_BEFORE.sub("", cell))
        if found is None or _RATIO.match(_BEFORE.sub("", cell)):
            continue
        digits = found["digits"].rstrip(".,'’")
        sure, doubt = _signs(digits)
        if sure:
            seen.setdefault(sure, f"`{cell}` ({place})")
        if doubt:
            doubtful.setdefault(doubt, (f"`{cell}` ({place})", digits))
    if len(seen) == 2:
        raise ValueError(f"has decimal points, {seen['.']}, and decimal commas, {seen[',']}")
    if not seen and doubtful:
        sign, (first, digits) = next(iter(doubtful.items()))
        what = "points" if sign == "." else "commas"
        raise ValueError(
            f"{first} may be {_either(digits)}; no other number shows whether {what} mark "
            "thousands or decimals"
        )
    decimal = next(iter(seen), ".")
    if decimal == ",":
        return decimal, f"commas are decimal signs, as in {seen[',']}"
    if "," in doubtful:
        return decimal, f"commas separate thousands, as in {doubtful[','][0]}; decimals have points"
    return decimal, ""


def is_workbook(content: bytes) -> bool:
    """True if a file is an Excel workbook."""
    return content.startswith(_SPREADSHEETS)


def is_table(content: bytes) -> bool:
    """True if a file is a workbook, or text whose lines have a common separator."""
    if is_workbook(content):
        return True
    if content.startswith(_UTF_16):
        content = content[: len(content) // 2 * 2].decode("utf-16", "replace").encode()
    lines = [line for line in content.split(b"\n")[:20] if line.strip()]
    cut = any(sum(sign in line for line in lines) >= 2 for sign in (b"\t", b";", b","))
    return b"\0" not in content and cut


class ReadSheets(NamedTuple):
    """Rows and hidden parts of the sheets in a file.

    Attributes
    ----------
    rows : rows of cells, by sheet name
    hidden : description of the hidden parts, by sheet name
    """

    rows: dict[str, SheetRows]
    hidden: dict[str, str]


def read_sheets(path: Path) -> ReadSheets:
    """Read the rows of each sheet with cells; lines that begin with # are comments.

    A text file has one sheet, whose name is empty.

    Raises
    ------
    InputError
        The file cannot be read.
    """
    content = read_content(path, largest=_LARGEST)
    if is_workbook(content):
        sheets, hidden = _workbook(path, content)
    else:
        sheets, hidden = {"": cells_in(_decoded(path, content))}, {}
    for rows in sheets.values():
        if len(rows) > _MOST_ROWS or any(len(row) > _MOST_COLUMNS for row in rows):
            raise refused(path, f"has more than {_MOST_ROWS} rows or {_MOST_COLUMNS} columns")
    kept = {name: cleaned for name, rows in sheets.items() if (cleaned := _cleaned(rows))}
    return ReadSheets(kept, hidden)


def _cleaned(rows: SheetRows) -> SheetRows:
    cleaned = []
    for row in rows:
        cells = [one if isinstance(one, WorkbookNumber) else " ".join(one.split()) for one in row]
        while cells and not cells[-1]:
            cells.pop()
        if cells and not cells[0].startswith("#"):
            cleaned.append(cells)
    return cleaned


def _decoded(path: Path, content: bytes) -> str:
    if content.startswith(_UTF_16):
        return content.decode("utf-16", "replace")
    if b"\0" in content:
        raise refused(path, "is a binary file; a table in text or a workbook is needed")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("cp1252", "replace")


def _workbook(path: Path, content: bytes) -> tuple[dict[str, SheetRows], dict[str, str]]:
    try:
        return read_apart(_sheets, content)
    except ValueError as error:
        raise refused(path, f"is a damaged workbook ({error})") from None


def _sheets(content: bytes) -> tuple[dict[str, SheetRows], dict[str, str]]:
    import python_calamine

    book = python_calamine.load_workbook(io.BytesIO(content))
    rows = {
        name: [[_shown(cell) for cell in row] for row in book.get_sheet_by_name(name).to_python()]
        for name in book.sheet_names
    }
    visible = python_calamine.SheetVisibleEnum.Visible
    whole = {each.name: "the sheet" for each in book.sheets_metadata if each.visible != visible}
    return rows, _hidden_rows_and_columns(content) | whole


def _hidden_rows_and_columns(content: bytes) -> dict[str, str]:
    if not zipfile.is_zipfile(io.BytesIO(content)):
        return {}
    hidden = {}
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        parts = set(archive.namelist())
        if not {"xl/workbook.xml", "xl/_rels/workbook.xml.rels"} <= parts:
            return {}
        relations = _element_attributes(archive.read("xl/_rels/workbook.xml.rels"), "Relationship")
        targets = {each.get("Id"): each.get("Target", "").lstrip("/") for each in relations}
        for sheet in _element_attributes(archive.read("xl/workbook.xml"), "sheet"):
            target = targets.get(sheet.get("r:id"), "")
            part = target if target in parts else f"xl/{target}"
            if part not in parts:
                continue
            text = archive.read(part)
            rows = [
                each.get("r", "?") for each in _element_attributes(text, "row") if _is_hidden(each)
            ]
            columns = sum(_is_hidden(each) for each in _element_attributes(text, "col"))
            within = [f"row{'s' * (len(rows) > 1)} {', '.join(rows[:_SHOWN])}"] if rows else []
            within += ["columns"] if columns else []
            if within:
                hidden[html.unescape(sheet.get("name", ""))] = " and ".join(within)
    return hidden


def _element_attributes(text: bytes, name: str) -> list[dict[str, str]]:
    found = re.findall(rf"<(?:\w+:)?{name}\s([^<>]*)>", text.decode("utf-8", "replace"))
    return [dict(re.findall(r'([\w:]+)="([^"]*)"', each)) for each in found]


def _is_hidden(attributes: dict[str, str]) -> bool:
    return attributes.get("hidden") in ("1", "true")


def _shown(cell: object) -> str:
    return WorkbookNumber(f"{cell:.12g}") if isinstance(cell, float) else str(cell)
