"""Read a moords design, a list of Mooring Design & Dynamics elements from the anchor up."""

import csv
import io
import math
from pathlib import Path

from calm.errors import refused
from calm.exchange import model
from calm.exchange.mdd.elements import MODULI, MddElement, anchor_of, mistakes_of, piece_of, rigid
from calm.exchange.registry import register_format
from calm.whole_file import read_text

_MARKS = {"name", "length", "buoyancy", "bool_line", "bool_clampon", "height_along_inline"}
_FIGURES = ("length", "buoyancy", "material", "width", "diameter", "drag")
_OFF = 1e-6  # m: distance by which a clamp may lie beyond its piece
_NOTE = "moords solves the equations of Mooring Design & Dynamics. See `calm docs import-table`."


def is_moords(content: bytes) -> bool:
    """True if a file has the headings of a moords design."""
    head = content.split(b"\n", 1)[0].decode("utf-8", "replace")
    return set(head.strip().split(",")) >= _MARKS


def read_moords(path: Path) -> model.ImportedDesign:
    """Read a moords file as a design.

    Raises
    ------
    InputError
        The headings or values are not valid for moords.
    """
    rows = list(csv.DictReader(io.StringIO(read_text(path))))
    if not rows or not rows[0].keys() >= _MARKS:
        raise refused(path, "does not have the headings of a moords design")
    if len(rows) > model.MOST_PIECES:
        raise refused(
            path, f"has {len(rows)} rows; a file with more than {model.MOST_PIECES} cannot be read"
        )
    problems: list[str] = []
    elements = [_element(row, place, problems) for place, row in enumerate(rows, 2)]
    if not problems and rows[0].get("bool_clampon") == "True":
        problems.append("row 2: a clamp is listed before the first piece")
    if problems:
        raise refused(path, *problems)
    anchor = anchor_of(elements[0])
    if not elements[0].lift:
        del anchor.figures["weight"]
    items = [model.ImportedPiece(anchor)]
    for row, element in zip(rows[1:], elements[1:], strict=True):
        if row.get("bool_clampon") == "True":
            host, length = items[-1], items[-1].extent
            at = length - float(row["height_along_inline"] or 0.0)
            guess = (
                ""
                if -_OFF <= at <= length + _OFF
                else "the position in the file is beyond the end of the piece"
            )
            host.clamp(rigid(element), min(max(at, 0.0), length), guess)
        else:
            items.append(piece_of(element))
    name = rows[0].get("mooring") or path.stem
    return model.ImportedDesign("moords", name, items[::-1], None, notes=[_NOTE], in_kilograms=True)


def _element(row: dict[str, str], place: int, problems: list[str]) -> MddElement:
    clamped = row.get("bool_clampon") == "True"
    keys = (*_FIGURES, "height_along_inline") if clamped else _FIGURES
    figures = {key: _number(row, key, place, problems) for key in keys}
    is_line, length, lift = row.get("bool_line") == "True", figures["length"], figures["buoyancy"]
    if is_line and length <= 0.0:
        problems.append(f"row {place}, {row['name']}: the length of the line is missing")
        length = 1.0
    material = figures["material"]
    known = is_line and 1.0 <= material <= len(MODULI)
    element = MddElement(
        name=row["name"] or f"row {place}",
        length=length,
        width=figures["width"],
        diameter=figures["diameter"],
        is_line=is_line,
        is_fastener=row.get("type") == "rigging",
        lift=lift / length if is_line else lift,
        cd=figures["drag"],
        mass=None,
        modulus=MODULI[round(material) - 1] if known else None,
        number=place,
    )
    problems += mistakes_of(element, f"row {place}, {element.name}")
    return element


def _number(row: dict[str, str], key: str, place: int, problems: list[str]) -> float:
    text = (row.get(key) or "").strip()
    try:
        value = float(text) if text and text.lower() not in ("nan", "none") else 0.0
    except ValueError:
        value = math.nan
    if math.isfinite(value):
        return value
    problems.append(f"row {place}, {row.get('name')}: {key} is `{text}`, which is not a number")
    return 0.0


register_format("moords", is_moords, lambda path, _: read_moords(path), program="moords")
