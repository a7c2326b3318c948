"""Convert rows of a list to components, and note guesses for missing values."""

import math

from calm.exchange import model
from calm.exchange.mdd.elements import MODULI
from calm.exchange.part_names import is_called, role_of, size_in
from calm.exchange.table.rows import ROLES, ListRow
from calm.files.definition import STANDARD_GRAVITY
from calm.physics.seawater import REFERENCE_DENSITY
from calm.units import KILOGRAM_FORCE

_USUAL = {"cable": 1.3, "chain": 2.75, "sphere": 0.5, "cylinder": 1.2}
_ROUND = 1.5  # maximum ratio of length to diameter of a float that is treated as a sphere
_HALF_DENSITY = 0.5 * REFERENCE_DENSITY


def component_of(row: ListRow, *, anchor: bool) -> model.ImportedComponent:
    """Convert a row to a component; mistakes are added to the `problems` of the row."""
    for what in ("length", "diameter", "width", "cd", "area", "drag_area", "mass", "stiffness"):
        if row.figure(what) < 0.0:
            row.refuse(f"its {what.replace('_', ' ')} is negative")
    kind, kept = (_anchor if anchor else _line if row.is_line else _rigid)(row)
    guesses = {key: text for key, text in row.guesses.items() if key in kept and text}
    return model.ImportedComponent(row.name, kind, kept, guesses)


_Definition = tuple[str, dict[str, model.FigureOrWord]]
"""Kind of a component, and its values."""


def _anchor(row: ListRow) -> _Definition:
    kept: dict[str, model.FigureOrWord] = {}
    if row.figure("buoyancy"):
        kept["weight"] = abs(row.figure("buoyancy"))
    elif row.figure("mass"):
        kept["mass"] = row.figure("mass")
        row.guesses["mass"] = "the list gives no weight in water; steel is assumed"
    return "anchor", kept | {"length": row.figure("length")}


def _rigid(row: ListRow) -> _Definition:
    figures, guesses = row.figures, row.guesses
    if "buoyancy" not in figures:
        row.refuse(f"the weight in water or the buoyancy is missing{row.hint}")
    lift, length = row.figure("buoyancy"), row.figure("length")
    kind, across = _shape(row)
    kept: dict[str, model.FigureOrWord] = {"length": length}
    if "drag_area" in figures and "tangential_area" in figures:
        kind, guesses["kn"] = "body", guesses.get("drag_area", "")
        kept["kn"] = _HALF_DENSITY * figures["drag_area"]
        kept["kt"] = _HALF_DENSITY * figures["tangential_area"]
    elif "drag_area" in figures or "area" in figures:
        of = "drag_area" if "drag_area" in figures else "area"
        coefficient = 1.0 if of == "drag_area" else figures.get("cd", 1.0)
        kind, guesses["drag_area"] = "body", guesses.get(of, "")
        kept |= {"drag_area": figures[of], "cd": coefficient}
        if of == "area" and "cd" not in figures:
            guesses["cd"] = "the list has an area but no drag coefficient; 1 is assumed"
    elif kind == "body":
        kept |= {"drag_area": 0.0, "cd": 1.0}
        guesses["drag_area"] = "the list has no size, so the drag is 0"
    else:
        kept = {"diameter": across, "length": length or across, **_drag_coefficient(row, kind)}
    kept["buoyancy"] = lift
    _check_lift(row, kind, across, length)
    kept |= _optional_values(row, lift, "breaking_load")
    kept["role"] = row.role if row.role in ROLES else role_of(row.name, lift)
    return kind, kept


def _check_lift(row: ListRow, kind: str, across: float, length: float) -> None:
    if kind not in ("sphere", "cylinder"):
        return
    volume = math.pi * across**2 * max(across / 6.0, length / 4.0)
    lift, most = row.figure("buoyancy"), volume * REFERENCE_DENSITY * STANDARD_GRAVITY
    if lift <= most:
        return
    kilograms = (
        f"displaces only {most / KILOGRAM_FORCE:.4g} kg of water, so it cannot lift "
        f"{lift / KILOGRAM_FORCE:.4g} kg"
    )
    if row.count > 1 and lift <= row.count * most:
        row.refuse(
            f"each piece {kilograms}; if the buoyancy is for all {row.count} pieces, name its "
            "column `total`"
        )
    else:
        row.guesses["buoyancy"] = f"value of the list, although the piece {kilograms}"


def _shape(row: ListRow) -> tuple[str, float]:
    """Choose kind and diameter [m] of a rigid piece from its size.

    In a list with widths and diameters, a piece with a diameter is a sphere. In other lists, a
    float hardly longer than wide is a sphere.
    """
    width, diameter, length, lift = map(row.figure, ("width", "diameter", "length", "buoyancy"))
    if {"width", "diameter"} <= row.figures.keys():
        round_, across = diameter > 0.0, diameter or width
    else:
        across = diameter or width
        round_ = (lift > 0.0 or row.kind == "sphere") and length <= _ROUND * across
    if across <= 0.0 or (not round_ and length <= 0.0):
        return "body", 0.0
    return "sphere" if round_ else "cylinder", across


def _line(row: ListRow) -> _Definition:
    if row.figure("length") <= 0.0:
        row.refuse("the length of the line is missing")
    if "buoyancy" not in row.figures:
        row.refuse(f"the weight in water is missing{row.hint}")
    across, lift = row.figure("diameter") or row.figure("width"), row.figure("buoyancy")
    kind = "chain" if lift <= 0.0 and is_called(f"{row.name} {row.kind}", "chain") else "cable"
    if across <= 0.0:
        across = size_in(row.name)
        if across <= 0.0:
            row.refuse("the diameter is missing")
            across = 0.01
        row.guesses["diameter"] = "read from the name of the piece"
    kept: dict[str, model.FigureOrWord] = {"diameter": across}
    if "drag_area" in row.figures:
        kept["cn"] = row.figure("drag_area") / across
        kept["ct"] = row.figure("tangential_area") / (math.pi * across)
    else:
        kept |= _drag_coefficient(row, kind)
        if "area" in row.figures:
            kept["cn"] = float(kept["cn"]) * row.figure("area") / across
    if lift > 0.0:
        kept["buoyancy"] = lift
    else:
        kept["weight"] = 0.0 - lift
        row.guesses["weight"] = row.guesses.get("buoyancy", row.guesses.get("weight", ""))
    kept |= _optional_values(row, lift, "stiffness", "breaking_load")
    material = row.figure("material")
    if "stiffness" not in kept and material in range(1, len(MODULI) + 1):
        kept["stiffness"] = MODULI[round(material) - 1] * math.pi / 4.0 * across**2
    return kind, kept


def _drag_coefficient(row: ListRow, kind: str) -> dict[str, model.FigureOrWord]:
    key = "cx" if kind == "sphere" else "cn"
    guess = f"the list has no value; the usual value for a {kind} is used"
    row.guesses[key] = row.guesses.get("cd", "") if "cd" in row.figures else guess
    return {key: row.figures.get("cd", _USUAL[kind])}


def _optional_values(row: ListRow, lift: float, *names: str) -> dict[str, model.FigureOrWord]:
    mass = row.figure("mass")
    # a mass that is too small for the weight in water is omitted
    heavy = mass > 0.0 and mass * KILOGRAM_FORCE >= max(-lift, 0.0)
    named = {name: row.figure(name) for name in names if row.figure(name) > 0.0}
    return {"mass": mass, **named} if heavy else {**named}
