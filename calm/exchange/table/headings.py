"""Recognise the columns of a list by headings in five languages."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from calm.errors import refused, unknown
from calm.exchange.table.cells import SheetRows, decimal_sign, number, unit_called, unit_of_heading
from calm.units import KILOGRAM_FORCE

COLUMNS = (
    "name", "label", "kind", "role", "length", "diameter", "width", "mass", "buoyancy", "weight",
    "cd", "area", "drag_area", "tangential_area", "material", "stiffness", "breaking_load", "count",
    "at", "height", "depth",
)  # fmt: skip
"""Column names, as in `--columns`."""

WORDS = ("name", "label", "kind", "role")
"""Columns with words instead of numbers."""

_WEIGHT = r"(weight|poids|gewicht|vekt|\bpeso|mass(e|a)?\b|\bmasa\b)"
_WET = (
    r"(water|\bwet|\beau\b|immerg|submer|immersed|\bsea|\bmer\b|wasser|vann|nass|agua|sumergid"
    r"|mojad)"
)
_AIR = r"(\bair\b|luft|trocken|\baire\b|\bsec[oa]?\b|\bdry\b)"
_END = r"\b(anchor|bottom|btm|seabed|anker|grund|boden|ancre|fond|ancla|fondo|surface|top)\b"
_PATTERNS: tuple[tuple[str, str], ...] = (
    ("count", r"^(qty|quantity|count|number|no\.? of|nb|nombre|qte|quantite)\b"),
    ("count", r"^(anzahl|antall|menge|stuck(zahl)?|stk|cant(idad)?)\b"),
    ("at", rf"clamped at|along|position sur|geklemmt|(distance|abstand|distancia)(?!.*{_END})"),
    ("tangential_area", r"tangential cd x area"),
    ("drag_area", r"drag area|\bcd ?[x*.]? ?a(rea)?\b|\bcda\b"),
    ("area", r"area|surface|maitre.?couple|flache|superficie"),
    ("cd", r"^(cd|cx|cw|c_?d|cn)\b|drag|trainee|widerstand|arrastre"),
    ("breaking_load", r"break|rupture|\bmbl\b|strength|resistance|bruch|rotura"),
    ("stiffness", r"^ea\b|stiff|raideur|steifigkeit|rigidez"),
    ("buoyancy", r"buoy|flott|lift|portance|poussee|auftrieb|oppdrift|flotabilidad|empuje"),
    ("weight", rf"{_WEIGHT}.*{_WET}|{_WET}.*{_WEIGHT}|^(wet|in water)\b"),
    ("mass", rf"{_WEIGHT}.*{_AIR}|{_AIR}.*{_WEIGHT}|\bmass(e|a)?\b|\bmasa\b|\bdry\b"),
    ("weight", r"^(weight|poids|gewicht|vekt|peso)\b"),
    ("mass", r"^(weight|poids|gewicht|vekt|peso)\b"),
    ("diameter", r"diam|ø|durchmesser|^dia\b|^o\.?d\b"),
    ("width", r"width|largeur|breite|\banch(o|ura)\b"),
    (
        "height",
        r"(height|hauteur|altitude|hohe|altura).*(bottom|btm|fond|seabed|above|grund|boden)",
    ),
    ("height", r"bottom_height|^altitude|^(height|hauteur|hohe|altura)\b"),
    (
        "depth",
        r"^((planned|nominal|target|design|instrument|deployment|soll|geplante?) ?)?"
        r"(depth|profondeur|immersion|tiefe|dybde|dyp|profundidad)\b(?!.*(rat|max|limit|water|wasser))",
    ),
    ("length", r"^(length|longueur|lange|laenge|longitud|largo|long|len|l)\b"),
    ("length", r"length|longueur|lange\b|laenge|lengde|longitud"),
    ("material", r"^(material|materiau|werkstoff)\b"),
    ("role", r"^(role|fonction|function|funktion|funcion)\b"),
    ("kind", r"^(kind|type?|art|tipo|categor(y|ie|ia)|kategorie|famille|family)\b"),
    ("label", r"\b(label|etiquette|etiqueta|serial|s/?n|repere)\b|seriennummer|serie\b"),
)
_NAMES = (
    r"name|^navn\b|^nom\b|element|description|designation|component|composant|materiel|bezeichnung"
    r"|benennung|beschreibung|descripcion|komponente?|bauteil",
    r"^(item|article|artikel|teil)\b|equip|instrument|piece|pieza|part|gerat",
)
_NUMBERED = re.compile(
    r"\b(no|nr|n°|number|num|nummer|numero|serial|s/?n|id|code|pos)\b|seriennummer"
)
_SPANISH = re.compile(r"\b(longitud|largo|peso|diametro|cantidad|empuje|flotabilidad)\b")
_LINES = r"(length|lange|laenge|longueur|longitud|rope|wire|line|cable|chain|seil|leine|kette|cabo)"
_BESIDE = re.compile(
    rf"\b{_LINES}\w*\b.*\b(below|above|beneath|under|between|to next|unterhalb|darunter|oberhalb"
    r"|daruber|zwischen|dessous|dessus|entre|debajo|encima)\b"
)  # length of a line that is listed in the row of another piece
_ALONG = re.compile(r"tangent|axial")  # drag along the piece, which has a column of its own
_RUNNING = re.compile(r"cumul|kumul|acumul|running")
_FROM_AN_END = re.compile(rf"(distance|abstand|distancia).*{_END}|(cumul|kumul|acumul|running)")
_SEARCHED = 60  # number of rows in which the headings are searched
_UNIT = re.compile(r" ?\b(kgf?|g|lbf?|lbs|k?n|t)\b| ?/ ?(m|ft)\b| ?\b(per|total|whole|met\w+)\b")
_MEASURES = {"length", "buoyancy", "weight", "mass"}


@dataclass(frozen=True)
class ListColumn:
    """A column of a list: index, heading, and conversion factor to SI.

    Attributes
    ----------
    by_mass : whether forces are in kilograms
    per_metre : whether the values of lines are per metre
    known : whether the heading has a unit
    whole : whether a value is a total for all pieces in a row, or for the whole length of a line
    wrong : message about a mistake in the heading, or empty
    twin : second column for the same quantity; one column is per metre, the other per piece
    """

    index: int
    heading: str
    factor: float = 1.0
    by_mass: bool = False
    per_metre: bool = False
    known: bool = False
    whole: bool = False
    wrong: str = ""
    twin: ListColumn | None = None

    def of(self, row: list[str], *, line: bool) -> tuple[ListColumn, str]:
        """Choose between this column and its twin for a row; return the chosen column and its cell.

        The column per metre is preferred for lines, and the column per piece for other rows.
        """
        both = [each for each in (self, self.twin) if each and cell_of(row, each)]
        column = min(both, key=lambda each: each.per_metre != line, default=self)
        return column, cell_of(row, column)


@dataclass(frozen=True)
class ListHeadings:
    """Headings of a sheet: index of their row, recognised columns, and other headings."""

    row: int
    columns: dict[str, ListColumn]
    others: tuple[str, ...]

    @property
    def problems(self) -> list[str]:
        """Messages about wrong headings, and about unknown headings that cannot be ignored."""
        beside = "lists lines in the same rows as other pieces; each line needs its own row"
        from_an_end = "has distances from an end of the line; each piece needs its own length"
        return [
            *(
                f"row {self.row + 1}, column {column.index + 1}, `{column.heading}`: {column.wrong}"
                for column in self.columns.values()
                if column.wrong
            ),
            *(
                f"row {self.row + 1}, `{heading}`: {beside}"
                for heading in self.others
                if _BESIDE.search(_plain(heading)) and not re.search("height|hohe", _plain(heading))
            ),
            *(
                f"row {self.row + 1}, `{heading}`: {from_an_end}"
                for heading in self.others
                if "length" not in self.columns and _FROM_AN_END.search(_plain(heading))
            ),
        ]


def headings_of(rows: SheetRows, given: Mapping[str, str]) -> ListHeadings | None:
    """Find the headings of a sheet, or return None.

    The row of headings must have a column of names, and a column of lengths, masses or forces.
    Columns in `given` take precedence over recognised columns.
    """
    best, highest = None, (0, 0)
    for i in range(min(len(rows), _SEARCHED)):
        cells = _with_units(rows, i)
        found = _recognised_columns(cells, given, rows[i + 1 : i + 31])
        if "name" not in found and len(found) >= 2:
            index = _names_without_heading(rows, i, found)
            if index is not None:
                found["name"] = ListColumn(index, "")
        if "name" not in found or not _MEASURES & found.keys():
            continue
        merit = len(found), sum(column.known for column in found.values())
        if merit > highest:
            every = [each for column in found.values() for each in (column, column.twin) if each]
            taken = {column.index for column in every}
            others = [each for index, each in enumerate(rows[i]) if each and index not in taken]
            best, highest = ListHeadings(i, found, tuple(others)), merit
    return best


def check_given(sheets: Mapping[str, SheetRows], given: Mapping[str, str], path: Path) -> None:
    """Check that `--columns` names known columns, and headings that occur in the list.

    `given` has the headings by column name in CALM. Raise InputError if a name or a heading is
    unknown.
    """
    for what in (each for each in given if each not in COLUMNS):
        raise refused(
            path, unknown(f"--columns: `{what}` is not a property of a piece", what, COLUMNS)
        )
    cells = {_plain(cell) for rows in sheets.values() for row in rows[:_SEARCHED] for cell in row}
    for what, heading in given.items():
        if not any(cell.startswith(_plain(heading)) for cell in cells):
            raise refused(path, f"--columns: no column is called `{heading}` ({what})")


def _recognised_columns(
    row: list[str], given: Mapping[str, str], below: SheetRows
) -> dict[str, ListColumn]:
    found: dict[str, ListColumn] = {}
    plain = [_plain(cell) for cell in row]
    if any(_SPANISH.search(cell) for cell in plain):
        plain = [re.sub(r"^nombre\b", "name", cell) for cell in plain]  # in French, a count
    taken: set[int] = set()
    for what, heading in given.items():
        wanted = _plain(heading)
        matches = [i for i, cell in enumerate(plain) if cell == wanted] or [
            i for i, cell in enumerate(plain) if wanted and cell.startswith(wanted)
        ]
        if matches:
            best = matches[0]
            taken.add(best)
            found[what] = _column(what, best, row[best])
    for what, pattern in _PATTERNS:
        for i, cell in enumerate(plain):
            along = what != "tangential_area" and _ALONG.search(cell)
            other = _BESIDE.search(cell) or _RUNNING.search(cell) if what == "length" else None
            if what in found or i in taken or not cell or along or other:
                continue
            if re.search(pattern, cell) and (what != "count" or not _has_words(below, i)):
                found[what] = _with_twin(_column(what, i, row[i]), what, row, taken)
    bare = [i for i, cell in enumerate(plain) if i not in taken and not _NUMBERED.search(cell)]
    called = (i for pattern in _NAMES for i in bare if re.search(pattern, plain[i]))
    named = next((i for i in called if _has_words(below, i)), None)
    if named is not None:
        found.setdefault("name", ListColumn(named, row[named]))
    elif "kind" in found and _has_words(below, found["kind"].index):
        found.setdefault("name", found["kind"])
    _resolve_ambiguous(found)
    return found


def _with_twin(column: ListColumn, what: str, row: list[str], taken: set[int]) -> ListColumn:
    taken.add(column.index)
    stem = _UNIT.sub("", _plain(column.heading, keep="/"))
    for i, heading in enumerate(row if what in _MEASURES else ()):
        if i not in taken and _UNIT.sub("", _plain(heading, keep="/")) == stem:
            other = _column(what, i, heading)
            if other.per_metre != column.per_metre:
                taken.add(i)
                return replace(column, twin=other)
    return column


def _has_words(below: SheetRows, index: int) -> bool:
    cells = [row[index] for row in below if index < len(row) and row[index]]
    return 2 * sum(bool(re.search(r"[^\W\d]{2}", cell)) for cell in cells) > len(cells)


def _resolve_ambiguous(found: dict[str, ListColumn]) -> None:
    plain = {what: _plain(column.heading) for what, column in found.items()}
    tall = r"(height|hauteur|hohe|altura)\b(?!.*(bottom|btm|fond|grund|above))"
    if "length" not in found and re.match(tall, plain.get("height", "")):
        found["length"] = found.pop("height")
    in_air = re.match(rf"(weight|poids|gewicht|peso)\b(?!.*{_WET})", plain.get("weight", ""))
    if in_air and "buoyancy" in found and "mass" not in found:
        weight = found.pop("weight")
        twin = weight.twin and _column("mass", weight.twin.index, weight.twin.heading)
        found["mass"] = replace(_column("mass", weight.index, weight.heading), twin=twin)


def _with_units(rows: SheetRows, i: int) -> list[str]:
    row = rows[i]
    below = rows[i + 1] if i + 1 < len(rows) else []
    cells = [cell for cell in below if cell]
    units = sum(_is_unit(cell) for cell in cells)
    if not units or 2 * units < len(cells) or any(number(cell).value is not None for cell in cells):
        return row
    below = below + [""] * (len(row) - len(below))
    return [
        cell if not unit or not cell else f"{cell} {unit if '(' in unit else f'({unit})'}"
        for cell, unit in zip(row, below, strict=False)
    ]


def _is_unit(cell: str) -> bool:
    inside = re.search(r"[(\[]([^()\[\]]*)[)\]]\s*$", cell)  # as in `off btm (m)`
    for what in ("length", "weight", "area"):
        try:
            if unit_called(inside[1] if inside else cell, what):
                return True
        except ValueError:
            continue
    return False


def _names_without_heading(rows: SheetRows, i: int, found: dict[str, ListColumn]) -> int | None:
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
    try:
        unit, wrong = unit_of_heading(heading, what), ""
    except ValueError as error:
        unit, wrong = None, str(error)
    plain = _plain(heading, keep="/")
    per_metre = what not in ("length", "diameter", "width", "at", "height", "depth") and bool(
        re.search(r"/ ?m\b|\b(per|par|pro|je|por) (m\b|met)|lineique|metergewicht", plain)
    )
    return ListColumn(
        index=index,
        heading=heading,
        factor=unit.factor if unit else KILOGRAM_FORCE if what in ("buoyancy", "weight") else 1.0,
        by_mass=unit.by_mass if unit else what in ("buoyancy", "weight"),
        per_metre=unit.per_metre or per_metre if unit else per_metre,
        known=unit is not None,
        whole=bool(re.search(r"whole|total|gesamt", plain)),
        wrong=wrong,
    )


def _plain(text: str, keep: str = "") -> str:
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text)  # buoyancyPerMeter
    decomposed = unicodedata.normalize("NFD", spaced.lower())
    letters = "".join(sign for sign in decomposed if not unicodedata.combining(sign))
    allowed = f"/.ø²^*_{keep}"
    return " ".join(
        "".join(sign if sign.isalnum() or sign in allowed else " " for sign in letters).split()
    )


def cell_of(row: list[str], column: ListColumn | None) -> str:
    """Return the text of the cell in a row and a column; empty if the row has no such cell."""
    return row[column.index] if column and column.index < len(row) else ""


def decimals_of(cells: SheetRows, headings: ListHeadings, problems: list[str]) -> tuple[str, str]:
    """Find the decimal symbol in the columns of numbers; also return a remark on the commas.

    If the numbers are contradictory or ambiguous, a message is added to `problems`, and symbol and
    remark are empty.
    """
    figures = [column for what, column in headings.columns.items() if what not in WORDS]
    try:
        return decimal_sign(
            (f"row {place}", cell_of(row, column))
            for place, row in enumerate(cells[headings.row + 1 :], headings.row + 2)
            for column in figures
        )
    except ValueError as error:
        problems.append(str(error))
        return "", ""
