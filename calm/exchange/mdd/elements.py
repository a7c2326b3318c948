"""Convert elements of Mooring Design & Dynamics (MDD) to components with the same drag."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np

from calm.exchange import model
from calm.exchange.mat_file import MatVariables, RealArray, names
from calm.exchange.part_names import role_of
from calm.files.definition import CATALOGUE_DENSITY
from calm.units import KILOGRAM_FORCE

_SLIGHT = 1e-6  # relative excess of hull volume over net buoyancy
_FLAT = 1e-3  # m: height assumed for a float without a height
_SOFT = 1e10  # Pa: ropes have a lower modulus, wires a higher one
_HARD = re.compile(r"\bwire|\bchain|\bsteel", re.I)
_LARGEST = 1e9  # m, kg: no piece is longer or heavier
_ROWS = ("B", "Cd", "ME", "Wt")
GROUPS = ("floats", "wires", "chains", "acrels", "cms", "anchors", "miscs")
"""Library variables that hold elements."""

MODULI = (1.38e11, 3.45e8, 8.0e8, 3.45e8, 6.9e8, 6.9e10, 7.6e10, 1.0e11)
"""Elastic moduli [Pa] of the materials 1 to 8 in the files.

The materials are steel, nylon, Dacron, polypropylene, polyethylene, Kevlar, aluminium and Dyneema.
"""


def piece_of(element: MddElement) -> model.ImportedPiece:
    """Convert an element, which must not be the anchor, to a piece."""
    if element.is_line:
        return model.ImportedPiece(_flexible(element), element.length)
    return model.ImportedPiece(rigid(element))


def rigid(element: MddElement) -> model.ImportedComponent:
    """Convert a rigid or clamped element to a component.

    As in Mooring Design & Dynamics, an element with a diameter becomes a sphere, whatever its
    length. An element with only a width becomes a cylinder without drag on the end faces.
    """
    lift = element.lift * KILOGRAM_FORCE
    role = role_of(element.name, lift, fastener=element.is_fastener)
    figures: dict[str, model.FigureOrWord]
    if element.diameter > 0.0:
        kind = "sphere"
        figures = {"diameter": element.diameter, "length": element.length, "cx": element.cd}
    elif element.width > 0.0 and element.length > 0.0:
        kind = "cylinder"
        figures = {"diameter": element.width, "length": element.length, "cn": element.cd, "ct": 0.0}
    else:
        kind = "body"
        figures = {"length": element.length, "drag_area": 0.0, "cd": element.cd}
    figures["buoyancy"] = lift
    if lift > 0.0 and element.mass is not None:
        figures["mass"] = element.mass
        volume = (element.mass + element.lift) / element.density
        figures["buoyancy"] = (CATALOGUE_DENSITY * volume - element.mass) * KILOGRAM_FORCE
    component = model.ImportedComponent(element.name, kind, {**figures, "role": role})
    if kind == "body":
        component.comment = "The file has no size for this piece, so it has no drag."
    elif _is_too_small(element):
        component.guesses["diameter"] = (
            f"value of the file, but too small for a float that lifts {element.lift:g} kgf; the "
            "drag of this float is also too small"
        )
    return component


def rides_by_buoyancy(component: model.ImportedComponent) -> None:
    """Give a surface float a hull as in Mooring Design & Dynamics.

    Draft and drag of this hull are proportional to the used buoyancy, which is the part of the net
    buoyancy that carries the line. The whole hull displaces just enough water for the net buoyancy.
    """
    lift, height = component.number("buoyancy"), component.number("length")
    if component.kind not in ("sphere", "cylinder", "body") or lift <= 0.0:
        return
    across = component.number("diameter")
    shown = {
        "sphere": math.pi / 4.0 * across**2,
        "cylinder": across * height,
        "body": component.number("drag_area"),
    }
    volume = (1.0 + _SLIGHT) * lift / (CATALOGUE_DENSITY * KILOGRAM_FORCE)
    component.hull = ((0.0, 0.0, 0.0), (height or _FLAT, volume, shown[component.kind]))
    component.comment = (
        "At the surface, the draft and drag of this float are proportional to the share of its "
        "buoyancy in use."
    )


def _is_too_small(element: MddElement) -> bool:
    if element.diameter > 0.0:
        volume = math.pi * element.diameter**2 * max(element.diameter / 6.0, element.length / 4.0)
    else:
        volume = math.pi * element.width**2 * element.length / 4.0
    return element.lift > CATALOGUE_DENSITY * volume


def _flexible(element: MddElement) -> model.ImportedComponent:
    figures: dict[str, model.FigureOrWord] = {
        "diameter": element.across,
        "cn": element.cd,
        "ct": 0.0,
    }
    weight = 0.0 - element.lift * KILOGRAM_FORCE
    component = model.ImportedComponent.of_line(element.name, weight, figures)
    modulus = element.modulus
    if modulus is not None and math.isfinite(modulus):
        component.figures["stiffness"] = modulus * math.pi / 4.0 * element.across**2
        if _HARD.search(element.name) and modulus < _SOFT:
            component.guesses["stiffness"] = (
                f"computed from the modulus in the file; {modulus / 1e9:g} GPa is typical of "
                "rope: was this modulus left over from another material?"
            )
    if component.kind == "chain":
        component.comment = (
            "The diameter is the width in the file, because Cd refers to this width. The width "
            "is not the bar diameter of the chain."
        )
    if element.width > 0.0 and element.diameter > 0.0:
        component.guesses["diameter"] = (
            "the file has a width and also the diameter of a sphere; the width is used"
        )
    return component


def anchor_of(element: MddElement) -> model.ImportedComponent:
    """Convert the lowest element to an anchor; the weight in the file may have either sign."""
    figures: dict[str, model.FigureOrWord] = {
        "weight": abs(element.lift) * KILOGRAM_FORCE,
        "length": element.length,
    }
    return model.ImportedComponent(element.name, "anchor", figures)


@dataclass(frozen=True)
class MddElement:
    """An element of the line: a column of the matrix ``H``, with values from other matrices.

    Values of a line (`is_line`: wire, rope or chain) are per metre. Fasteners are shackles, links
    and swivels.

    Attributes
    ----------
    length, width, diameter : sizes [m]; only a sphere has a diameter
    lift : net buoyancy [kg or kg/m]
    mass : mass in air [kg]; None if unknown
    modulus : modulus of elasticity of a line [Pa]; None if unknown, inf if inextensible
    number : number of the column, from 1
    density : density of the water to which `lift` applies [kg/m³]
    """

    name: str
    length: float
    width: float
    diameter: float
    is_line: bool
    is_fastener: bool
    lift: float
    cd: float
    mass: float | None
    modulus: float | None
    number: int
    density: float = CATALOGUE_DENSITY

    @property
    def across(self) -> float:
        """Width of the element [m], or its diameter if it has no width."""
        return self.width or self.diameter


def read_elements(variables: MatVariables, suffix: str) -> tuple[list[MddElement], list[str]]:
    """Read the elements of a line in file order; also return messages about mistakes.

    `suffix` is the end of the matrix names: ``t`` for a tow, ``CO`` for clamped elements, or empty.
    """
    problems: list[str] = []
    size = _matrix(variables, f"H{suffix}", problems)
    count = size.shape[1]
    for name in (f"B{suffix}", f"Cd{suffix}"):
        try:
            if (given := variables.reals(name).size) != count:
                problems.append(f"`{name}` has {given} values for {count} elements")
        except ValueError as error:
            problems.append(str(error))
    if count > model.MOST_PIECES:
        problems.append(
            f"`H{suffix}` has {count} elements; more than {model.MOST_PIECES} cannot be read"
        )
    if problems or not count:
        return [], problems
    lift, drag, modulus, mass = (variables.row(f"{name}{suffix}") for name in _ROWS)
    density = _densities(variables, size[0])
    elements = []
    for i, name in enumerate(_names(variables, f"moorele{suffix}", count)):
        length, width, diameter, flag = (float(value) for value in size[:, i])
        elements.append(
            MddElement(
                name=name,
                length=length,
                width=width,
                diameter=diameter,
                is_line=round(flag) == 1,
                is_fastener=round(flag) == 2,
                lift=float(lift[i]),
                cd=float(drag[i]),
                mass=float(mass[i]) if mass.size == count and mass[i] > 0.0 else None,
                modulus=_modulus(float(modulus[i])) if modulus.size == count else None,
                number=i + 1,
                density=float(density[i]),
            )
        )
        problems += mistakes_of(elements[-1], f"element {i + 1}, {name}")
    return elements, problems


def mistakes_of(element: MddElement, where: str) -> list[str]:
    """Return a message for each value of an element that is out of range."""
    sizes = {
        "length": element.length, "width": element.width, "diameter": element.diameter,
        "drag coefficient": element.cd,
    }  # fmt: skip
    wrong = [
        f"{where}: its {what} is {value:g}"
        for what, value in sizes.items()
        if not 0.0 <= value <= _LARGEST
    ]
    if not abs(element.lift) <= _LARGEST:
        wrong.append(f"{where}: its buoyancy is {element.lift:g}")
    return wrong


def _matrix(variables: MatVariables, name: str, problems: list[str]) -> RealArray:
    """Return the matrix ``H``, shape (4, elements); a missing row of flags is filled with 0."""
    try:
        size = np.atleast_2d(variables.reals(name))
        if size.ndim == 2 and size.shape[0] not in (3, 4) and size.shape[1] in (3, 4):
            size = size.T
        if size.size and (size.ndim != 2 or size.shape[0] not in (3, 4)):
            shape = "×".join(str(length) for length in size.shape)
            raise ValueError(
                f"`{name}` has the size {shape}; it must have 4 rows and a column for each element"
            )
    except ValueError as error:
        problems.append(str(error))
        return np.zeros((4, 0))
    if not size.size:
        return np.zeros((4, 0))
    return size if size.shape[0] == 4 else np.vstack([size, np.zeros(size.shape[1])])


def _densities(variables: MatVariables, length: RealArray) -> RealArray:
    """Return the water density at each element of a vertical line [kg/m³]."""
    levels, density = variables.row("z"), variables.row("rho")
    if not density.size == levels.size > 0 or not density.min() > 0.0:
        return np.full(length.size, CATALOGUE_DENSITY)
    order = np.argsort(levels)
    heights = np.cumsum(length[::-1])[::-1]
    return np.interp(heights, levels[order], density[order])


def _names(variables: MatVariables, name: str, count: int) -> list[str]:
    value = variables.get(name)
    found = names(value)
    if len(found) != count and isinstance(value, np.ndarray) and value.ndim == 2:
        found = names(value.T)
    found = (found + [""] * count)[:count]
    return [each or f"element {i}" for i, each in enumerate(found, 1)]


def _modulus(value: float) -> float | None:
    if not value > 0.0:
        return None
    # a small whole number in the file is the number of a material
    return MODULI[int(value) - 1] if value in range(1, len(MODULI) + 1) else value
