"""Rows of a list as components, with the usual coefficients where the list has none."""

from __future__ import annotations

import math
import re

from calm.exchange.design import FigureOrWord, ImportedComponent
from calm.exchange.mdd.elements import MODULI
from calm.exchange.table.rows import ListRow
from calm.exchange.words import is_chain, role_of
from calm.physics.reference import REFERENCE_DENSITY
from calm.units import KILOGRAM_FORCE

_USUAL = {"cable": 1.3, "chain": 2.75, "sphere": 0.5, "cylinder": 1.2}
_COEFFICIENT = {"cable": "cn", "chain": "cn", "sphere": "cx", "cylinder": "cn"}
_ROLES = ("float", "instrument", "release", "connector")
_ROUND = 1.5  # times its diameter: a float no longer is a sphere
_HALF_DENSITY = 0.5 * REFERENCE_DENSITY


def component_of(row: ListRow, problems: list[str], *, anchor: bool) -> ImportedComponent:
    """The definition of a row; what it lacks is added to `problems`."""
    for what in ("length", "diameter", "width", "cd", "area", "drag_area", "mass", "stiffness"):
        if row.figures.get(what, 0.0) < 0.0:
            problems.append(f"{row.where}: its {what.replace('_', ' ')} is negative")
    if anchor:
        return _anchor(row)
    return _line(row, problems) if row.is_line else _rigid(row, problems)


def _anchor(row: ListRow) -> ImportedComponent:
    figures, guesses = row.figures, dict(row.guesses)
    kept: dict[str, FigureOrWord] = {}
    if figures.get("buoyancy"):
        kept["weight"] = abs(figures["buoyancy"])
    elif figures.get("mass"):
        kept["mass"] = figures["mass"]
        guesses["mass"] = "taken for steel: the list gives no weight in water"
    kept["length"] = figures.get("length", 0.0)
    return ImportedComponent(row.name, "anchor", kept, _of(guesses, kept))


def _rigid(row: ListRow, problems: list[str]) -> ImportedComponent:
    figures, guesses = row.figures, dict(row.guesses)
    if "buoyancy" not in figures:
        problems.append(f"{row.where}: its weight in water or its buoyancy is missing{row.hint}")
    lift, length = figures.get("buoyancy", 0.0), figures.get("length", 0.0)
    kind, across = _shape(row)
    kept: dict[str, FigureOrWord]
    if "drag_area" in figures and figures.get("tangential_area") is not None:
        normal, along = figures["drag_area"], figures["tangential_area"]
        kind, kept = "body", {"length": length}
        kept |= {"kn": _HALF_DENSITY * normal, "kt": _HALF_DENSITY * along}
        guesses["kn"] = guesses.get("drag_area", "")
    elif "drag_area" in figures or "area" in figures:
        of = "drag_area" if "drag_area" in figures else "area"
        coefficient = 1.0 if of == "drag_area" else figures.get("cd", 1.0)
        kind, kept = "body", {"length": length, "drag_area": figures[of], "cd": coefficient}
        guesses["drag_area"] = guesses.get(of, "")
        if of == "area" and "cd" not in figures:
            guesses["cd"] = "the list gives an area and no coefficient"
    elif kind == "body":
        kept = {"length": length, "drag_area": 0.0, "cd": 1.0}
        guesses["drag_area"] = "the list gives no size: it has no drag"
    else:
        kept = {"diameter": across, "length": length or across}
        kept |= _coefficient(row, kind, guesses)
    kept["buoyancy"] = lift
    _keep(row, kept, lift, ("breaking_load",))
    kept["role"] = row.role if row.role in _ROLES else role_of(row.name, lift)
    return ImportedComponent(row.name, kind, kept, _of(guesses, kept))


def _shape(row: ListRow) -> tuple[str, float]:
    """The kind of a rigid piece by its size, and its diameter [m].

    Where a list has widths and diameters, a diameter is that of a sphere. Elsewhere a float that is
    hardly longer than wide is a sphere.
    """
    figures = row.figures
    width, diameter = figures.get("width", 0.0), figures.get("diameter", 0.0)
    length, lift = figures.get("length", 0.0), figures.get("buoyancy", 0.0)
    if "width" in figures and "diameter" in figures:
        round_, across = diameter > 0.0, diameter or width
    else:
        across = diameter or width
        round_ = (lift > 0.0 or row.kind == "sphere") and length <= _ROUND * across
    if across <= 0.0 or (not round_ and length <= 0.0):
        return "body", 0.0
    return "sphere" if round_ else "cylinder", across


def _line(row: ListRow, problems: list[str]) -> ImportedComponent:
    figures, guesses = row.figures, dict(row.guesses)
    if figures.get("length", 0.0) <= 0.0:
        problems.append(f"{row.where}: a line needs its length")
    across = figures.get("diameter", 0.0) or figures.get("width", 0.0)
    kind = "chain" if is_chain(f"{row.name} {row.kind}") else "cable"
    if across <= 0.0:
        across = _size_in(row.name)
        if across <= 0.0:
            problems.append(f"{row.where}: its diameter is missing")
            across = 0.01
        guesses["diameter"] = "from its name"
    kept: dict[str, FigureOrWord] = {"diameter": across}
    lift = figures.get("buoyancy")
    if lift is None:
        problems.append(f"{row.where}: its weight in water is missing{row.hint}")
        lift = 0.0
    if lift > 0.0:
        kind = "cable"
    if "drag_area" in figures:
        along = figures.get("tangential_area", 0.0)
        kept |= {"cn": figures["drag_area"] / across, "ct": along / (math.pi * across)}
    elif "area" in figures:
        coefficient = _coefficient(row, kind, guesses)["cn"]
        kept["cn"] = float(coefficient) * figures["area"] / across
    else:
        kept |= _coefficient(row, kind, guesses)
    if lift > 0.0:
        kept["buoyancy"] = lift
    else:
        kept["weight"] = 0.0 - lift
        if "buoyancy" in guesses:
            guesses["weight"] = guesses["buoyancy"]
    _keep(row, kept, lift, ("stiffness", "breaking_load"))
    material = figures.get("material", 0.0)
    if "stiffness" not in kept and material in range(1, len(MODULI) + 1):
        kept["stiffness"] = MODULI[round(material) - 1] * math.pi / 4.0 * across**2
    return ImportedComponent(row.name, kind, kept, _of(guesses, kept))


def _coefficient(row: ListRow, kind: str, guesses: dict[str, str]) -> dict[str, FigureOrWord]:
    """The drag coefficient of the list, or the usual one of the kind as a guess."""
    key = _COEFFICIENT[kind]
    guesses[key] = row.guesses.get("cd", "")
    if "cd" not in row.figures:
        guesses[key] = f"the usual one of a {kind}"
    return {key: row.figures.get("cd", _USUAL[kind])}


def _keep(row: ListRow, kept: dict[str, FigureOrWord], lift: float, names: tuple[str, ...]) -> None:
    """Take over further figures; a mass lighter than the piece is in water is left out."""
    mass = row.figures.get("mass", 0.0)
    if mass > 0.0 and mass * KILOGRAM_FORCE >= max(-lift, 0.0):
        kept["mass"] = mass
    for name in names:
        if row.figures.get(name, 0.0) > 0.0:
            kept[name] = row.figures[name]


def _of(guesses: dict[str, str], kept: dict[str, FigureOrWord]) -> dict[str, str]:
    """The guesses for the figures that are kept."""
    return {key: text for key, text in guesses.items() if key in kept and text}


def _size_in(name: str) -> float:
    """A diameter in a name such as `8 mm wire` or `3/8" chain` [m]; 0 without one."""
    found = re.search(r"(\d+(?:[.,]\d+)?)\s*mm\b", name, re.I)
    if found:
        return float(found[1].replace(",", ".")) / 1000.0
    found = re.search(r"(?:(\d+)[ -])?(\d+)/(\d+)", name)
    if found and int(found[3]):
        return (int(found[1] or 0) + int(found[2]) / int(found[3])) * 0.0254
    found = re.search(r"(\d+(?:[.,]\d+)?)\s*(?:\"|''|in\b|inch)", name, re.I)
    return float(found[1].replace(",", ".")) * 0.0254 if found else 0.0
