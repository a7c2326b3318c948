"""Read designs that moords exports: a row each element, from the anchor up."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path

from calm.exchange.design import MOST_PIECES, Design, ImportedComponent, ImportedPiece, refused
from calm.exchange.mdd_elements import (
    MODULI,
    MddElement,
    anchor_of,
    component_of,
    mistakes_of,
    rigid,
)
from calm.whole_file import read_text

_MARKS = {"name", "length", "buoyancy", "bool_line", "bool_clampon", "height_along_inline"}
_SLIGHT = 1e-6  # m by which a clamp may stand off its piece
_NOTE = (
    "That program solves the equations of Mooring Design & Dynamics. See `calm docs import-table`."
)


def is_moords(content: bytes) -> bool:
    """Return whether a file is such a design, by its headings."""
    head = content.split(b"\n", 1)[0].decode("utf-8", "replace")
    return set(head.strip().split(",")) >= _MARKS


def read_moords(path: Path) -> Design:
    """Read a design.

    Raises
    ------
    InputError
        Its headings or figures are not those of that program.
    """
    rows = list(csv.DictReader(io.StringIO(read_text(path))))
    if not rows or not rows[0].keys() >= _MARKS:
        raise refused(path, "is not a design of moords: its headings are others")
    if len(rows) > MOST_PIECES:
        raise refused(path, f"has {len(rows)} rows; more than {MOST_PIECES} are not read")
    problems: list[str] = []
    elements = [_element(row, place, problems) for place, row in enumerate(rows, 2)]
    if not problems and rows[0].get("bool_clampon") == "True":
        problems.append("row 2: a clamp stands before the first piece")
    if problems:
        raise refused(path, *problems)
    items = [ImportedPiece(_anchor(elements[0]))]
    for row, element in zip(rows[1:], elements[1:], strict=True):
        if row.get("bool_clampon") == "True":
            _hang(items[-1], element, float(row["height_along_inline"] or 0.0))
        else:
            items.append(
                ImportedPiece(component_of(element), element.length if element.is_line else None)
            )
    name = rows[0].get("mooring") or path.stem
    return Design("moords", name, items[::-1], None, notes=[_NOTE], in_kilograms=True)


def _anchor(element: MddElement) -> ImportedComponent:
    anchor = anchor_of(element)
    if not element.lift:
        del anchor.figures["weight"]
    return anchor


def _hang(host: ImportedPiece, element: MddElement, height: float) -> None:
    """Clamp an element on a piece, at a height above its lower end [m]."""
    length = host.extent
    at = length - height
    guess = "" if -_SLIGHT <= at <= length + _SLIGHT else "its place was off the piece"
    host.clamp(rigid(element), min(max(at, 0.0), length), guess)


def _element(row: dict[str, str], place: int, problems: list[str]) -> MddElement:
    is_line = row.get("bool_line") == "True"
    length = _number(row, "length", place, problems)
    lift = _number(row, "buoyancy", place, problems)
    if is_line and length <= 0.0:
        problems.append(f"row {place}, {row['name']}: a line needs its length")
        length = 1.0
    material = _number(row, "material", place, problems)
    known = is_line and 1.0 <= material <= len(MODULI)
    element = MddElement(
        name=row["name"] or f"row {place}",
        length=length,
        width=_number(row, "width", place, problems),
        diameter=_number(row, "diameter", place, problems),
        is_line=is_line,
        is_fastener=row.get("type") == "rigging",
        lift=lift / length if is_line else lift,
        cd=_number(row, "drag", place, problems),
        mass=None,
        modulus=MODULI[round(material) - 1] if known else None,
        number=place,
    )
    problems += mistakes_of(element, f"row {place}, {element.name}")
    if row.get("bool_clampon") == "True":
        _number(row, "height_along_inline", place, problems)
    return element


def _number(row: dict[str, str], key: str, place: int, problems: list[str]) -> float:
    text = (row.get(key) or "").strip()
    if not text or text.lower() in ("nan", "none"):
        return 0.0
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        problems.append(f"row {place}, {row.get('name')}: {key} is `{text}`")
        return 0.0
    return value
