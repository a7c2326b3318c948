"""Which column of a list holds what, by its heading in English or French."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from calm.exchange.refusal import refused
from calm.exchange.table.sheet import Rows
from calm.files.explain import unknown

COLUMNS = (
    "name", "label", "kind", "role", "length", "diameter", "mass", "buoyancy", "weight", "cd",
    "area", "stiffness", "breaking_load", "count", "at", "height",
)  # fmt: skip
"""What a column may hold, as `--columns` calls it."""

_PATTERNS: tuple[tuple[str, str], ...] = (
    ("count", r"^(qty|quantity|count|number|no\.? of|nb|nombre|qte|quantite)\b"),
    ("at", r"clamped at|along|position sur|distance"),
    ("area", r"drag area|area|surface|maitre.?couple|cd ?[x*.] ?a|cda"),
    ("cd", r"^(cd|cx|c_?d|cn)\b|drag|trainee"),
    ("breaking_load", r"break|rupture|\bmbl\b|strength|resistance"),
    ("stiffness", r"^ea\b|stiff|raideur"),
    ("buoyancy", r"buoy|flott|lift|portance|poussee"),
    ("weight", r"wet ?weight|(weight|poids).*(water|wet|eau|immerg|submer|sea|mer)"),
    ("mass", r"(weight|poids).*\bair\b|\bmasse?\b|\bdry\b"),
    ("weight", r"^(weight|poids)\b"),
    ("mass", r"^(weight|poids)\b"),
    ("diameter", r"diam|ø|width|largeur"),
    ("height", r"(height|hauteur|altitude).*(bottom|btm|fond|seabed|above)|bottom_height"),
    ("height", r"^altitude|^height$|^hauteur$"),
    ("length", r"^(length|longueur|long|len|l)\b|length|longueur"),
    ("role", r"^(role|fonction|function)\b"),
    ("kind", r"^(kind|type|category|categorie|famille|family)\b"),
    ("label", r"^(label|etiquette|serial|s/?n|repere)\b"),
    ("name", r"name|^nom\b|item|element|description|designation|component|composant|materiel"),
    ("name", r"equip|instrument|piece|part"),
)  # fmt: skip
_UNIT_CELL = re.compile(r"\(?[A-Za-zµ°²^/0-9 .]{1,24}\)?$")
_UNITS = {
    "m": 1.0, "mm": 1e-3, "cm": 1e-2, "in": 0.0254, "inch": 0.0254, "inches": 0.0254, "ft": 0.3048,
    "kg": 1.0, "kgf": 9.80665, "g": 1e-3, "lb": 0.45359237, "lbs": 0.45359237,
    "lbf": 4.4482216152605, "n": 1.0, "kn": 1e3, "dan": 10.0, "t": 1e3, "m2": 1.0, "m^2": 1.0,
    "m²": 1.0, "cm2": 1e-4, "pouces": 0.0254,
}  # fmt: skip
_MASSES = {"kg", "g", "lb", "lbs", "t"}


@dataclass(frozen=True)
class Column:
    """A column: where it stands, its heading, and what its numbers are multiplied by.

    `by_mass` marks forces that are counted in kilograms, `per_metre` of figures of lines that
    are those of a metre; `known` whether the heading gives a unit.
    """

    index: int
    heading: str
    factor: float
    by_mass: bool
    per_metre: bool
    known: bool
    whole: bool = False


def headings_of(rows: Rows, given: Mapping[str, str], path: Path) -> tuple[int, dict[str, Column]]:
    """The row of the headings, and the column of each thing that the list has.

    Parameters
    ----------
    given : headings by what they hold, which come before those that are recognised

    Raises
    ------
    InputError
        No row has a name and a length or a force, or a heading that is given is not there.
    """
    for what in given:
        if what not in COLUMNS:
            raise refused(
                path, unknown(f"--columns: `{what}` is nothing of a piece", what, COLUMNS)
            )
    cells = {_plain(cell) for row in rows[:60] for cell in row}
    for what, heading in given.items():
        if not any(cell.startswith(_plain(heading)) for cell in cells):
            raise refused(path, f"--columns: no column is called `{heading}` ({what})")
    best: tuple[int, dict[str, Column]] | None = None
    for i in range(min(len(rows), 60)):
        found = _columns(_with_units(rows, i), given)
        if (
            "name" not in found
            and len(found) >= 2
            and (index := _unnamed(rows, i, found)) is not None
        ):
            found["name"] = Column(index, "", 1.0, False, False, False)
        enough = "name" in found and {"length", "buoyancy", "weight", "mass"} & found.keys()
        if enough and (best is None or len(found) > len(best[1])):
            best = i, found
    if best is None:
        raise refused(
            path, "has no headings that CALM knows; name them: --columns name=…,length=…,weight=…"
        )
    return best


def _columns(row: list[str], given: Mapping[str, str]) -> dict[str, Column]:
    found: dict[str, Column] = {}
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
            if what not in found and i not in taken and cell and re.search(pattern, cell):
                taken.add(i)
                found[what] = _column(what, i, row[i])
    return found


def _with_units(rows: Rows, i: int) -> list[str]:
    """A row of headings, with the units that stand below them."""
    row = rows[i]
    below = rows[i + 1] if i + 1 < len(rows) else []
    units = [cell for cell in below if cell]
    if not units or not all(_UNIT_CELL.match(cell) for cell in units):
        return row
    below = below + [""] * (len(row) - len(below))
    return [f"{cell} {unit}".strip() for cell, unit in zip(row, below, strict=False)]


def _unnamed(rows: Rows, i: int, found: dict[str, Column]) -> int | None:
    """The first column without a heading whose cells are words."""
    taken = {column.index for column in found.values()}
    below = rows[i + 1 : i + 16]
    for index in range(min(3, max(map(len, below), default=0))):
        headed = index < len(rows[i]) and rows[i][index]
        words = [row[index] for row in below if index < len(row) and row[index]]
        named = sum(bool(re.search(r"[^\W\d]{3}", word)) for word in words)
        if not headed and index not in taken and len(words) >= 3 and 2 * named > len(words):
            return index
    return None


def _column(what: str, index: int, heading: str) -> Column:
    words = re.findall(r"[a-z]+(?:\^?2|²)?", _plain(heading, keep="²^/"))
    unit = next((word for word in reversed(words) if word in _UNITS and word != what), None)
    if what == "name" or what in ("label", "kind", "role"):
        unit = None
    per_metre = bool(re.search(r"/ ?m\b|per m|par m|lineique", _plain(heading, keep="/")))
    if per_metre and unit == "m":
        unit = next((word for word in words if word in _UNITS and word not in ("m", what)), None)
    factor = _UNITS[unit] if unit else 1.0
    by_mass = what in ("buoyancy", "weight") and (unit is None or unit in _MASSES)
    whole = bool(re.search(r"whole|total", _plain(heading)))
    return Column(index, heading, factor, by_mass, per_metre, unit is not None, whole)


def _plain(text: str, keep: str = "") -> str:
    """A heading without accents and capitals, signs as blanks but for those that matter."""
    decomposed = unicodedata.normalize("NFD", text.lower())
    letters = "".join(sign for sign in decomposed if not unicodedata.combining(sign))
    allowed = f"/.ø²^*_{keep}"
    return " ".join(
        "".join(sign if sign.isalnum() or sign in allowed else " " for sign in letters).split()
    )
