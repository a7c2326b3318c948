"""Designs that moords exports: a row each element, from the anchor up."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path

from calm.exchange.design import Component, Design, Hung, Item
from calm.exchange.mdd.elements import MODULI, Element
from calm.exchange.mdd.pieces import anchor_of, component_of, rigid
from calm.exchange.refusal import refused
from calm.files.document import read_text

_MARKS = {"name", "length", "buoyancy", "bool_line", "bool_clampon", "height_along_inline"}
_NOTE = (
    "That program solves the equations of Mooring Design & Dynamics. See `calm docs import-table`."
)


def is_moords(content: bytes) -> bool:
    """Whether a file is such a design, by its headings."""
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
        raise refused(path, "is no design of moords: its headings are others")
    problems: list[str] = []
    items: list[Item] = []
    for place, row in enumerate(rows, 2):
        element = _element(row, place, problems)
        if row.get("bool_clampon") == "True":
            if not items:
                problems.append(f"row {place}: a clamp stands before the first piece")
                continue
            host = items[-1]
            length = host.length or float(host.component.figures.get("length", 0.0))
            at = length - _number(row, "height_along_inline", place, problems)
            guess = "" if -1e-6 <= at <= length + 1e-6 else "its place was off the piece"
            host.clamps.append(Hung(rigid(element), min(max(at, 0.0), length), guess))
        elif not items:
            anchor = anchor_of(element)
            if not element.lift:
                del anchor.figures["weight"]
            items.append(Item(anchor))
        else:
            items.append(_item(element))
    if problems:
        raise refused(path, *problems)
    for item in items:
        item.clamps.sort(key=lambda clamp: clamp.at)
    name = rows[0].get("mooring") or path.stem
    return Design("moords", name, items[::-1], None, notes=[_NOTE], in_kilograms=True)


def _item(element: Element) -> Item:
    component: Component = component_of(element)
    return Item(component, element.length if element.is_line else None)


def _element(row: dict[str, str], place: int, problems: list[str]) -> Element:
    is_line = row.get("bool_line") == "True"
    length = _number(row, "length", place, problems)
    lift = _number(row, "buoyancy", place, problems)
    if is_line and length <= 0.0:
        problems.append(f"row {place}, {row['name']}: a line needs its length")
        length = 1.0
    material = _number(row, "material", place, problems)
    known = is_line and 1.0 <= material <= len(MODULI)
    return Element(
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
