"""Elements of Mooring Design & Dynamics as components of CALM, with that program's drag."""

from __future__ import annotations

import math
import re

from calm.exchange.design import FigureOrWord, ImportedComponent
from calm.exchange.mdd.elements import MddElement
from calm.exchange.words import is_chain, role_of
from calm.files.definition import CATALOGUE_DENSITY
from calm.units import KILOGRAM_FORCE

_SLIGHT = 1e-6  # by which a hull takes more than its net buoyancy
_FLAT = 1e-3  # m: height of a float that the file gives none
_SOFT = 1e10  # Pa: the modulus of a rope is below, of a wire above
_HARD = re.compile(r"\bwire|\bchain|\bsteel", re.I)


def component_of(element: MddElement) -> ImportedComponent:
    """The definition of an element that is not the anchor."""
    return _flexible(element) if element.is_line else rigid(element)


def rigid(element: MddElement) -> ImportedComponent:
    """The definition of a rigid element, or of one clamped on.

    That program takes an element with a diameter for a sphere of that diameter, whatever its
    length, and one with a width alone for a cylinder, whose Cd is for flow across it, without end
    faces.
    """
    lift = element.lift * KILOGRAM_FORCE
    role = role_of(element.name, lift, fastener=element.is_fastener)
    figures: dict[str, FigureOrWord]
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
    component = ImportedComponent(element.name, kind, {**figures, "role": role})
    if kind == "body":
        component.comment = "The file gives it no size, so that it has no drag."
    elif _is_too_small(element):
        component.guesses["diameter"] = (
            f"kept as it is, a placeholder: nothing of this size lifts {element.lift:g} kgf, "
            "so its drag is missing"
        )
    return component


def rides_by_buoyancy(component: ImportedComponent) -> None:
    """Let a float ride as in that program: its draft and drag follow the buoyancy it uses.

    Its hull displaces, in proportion to the draft, no more than its net buoyancy needs.
    """
    figures = component.figures
    lift, height = float(figures.get("buoyancy", 0.0)), float(figures.get("length", 0.0))
    if component.kind not in ("sphere", "cylinder", "body") or lift <= 0.0:
        return
    across = float(figures.get("diameter", 0.0))
    shown = {
        "sphere": math.pi / 4.0 * across**2,
        "cylinder": across * height,
        "body": float(figures.get("drag_area", 0.0)),
    }
    figures.pop("mass", None)
    volume = (1.0 + _SLIGHT) * lift / (CATALOGUE_DENSITY * KILOGRAM_FORCE)
    component.hull = ((0.0, 0.0, 0.0), (height or _FLAT, volume, shown[component.kind]))
    component.comment = "At the surface it sinks, and drags, in proportion to the buoyancy it uses."


def _is_too_small(element: MddElement) -> bool:
    """Whether a float of this size cannot displace enough water for its buoyancy."""
    if element.diameter > 0.0:
        volume = math.pi * element.diameter**2 * max(element.diameter / 6.0, element.length / 4.0)
    else:
        volume = math.pi * element.width**2 * element.length / 4.0
    return element.lift > CATALOGUE_DENSITY * volume


def _flexible(element: MddElement) -> ImportedComponent:
    """The definition of a wire, rope or chain: its Cd is of its width, without drag along it."""
    chain = is_chain(element.name)
    figures: dict[str, FigureOrWord] = {"diameter": element.across, "cn": element.cd, "ct": 0.0}
    weight = 0.0 - element.lift * KILOGRAM_FORCE
    component = ImportedComponent(element.name, "chain" if chain else "cable", figures)
    if weight < 0.0 and not chain:
        figures["buoyancy"] = -weight
    else:
        figures["weight"] = weight
    modulus = element.modulus
    if modulus is not None and math.isfinite(modulus):
        figures["stiffness"] = modulus * math.pi / 4.0 * element.across**2
        if _HARD.search(element.name) and modulus < _SOFT:
            component.guesses["stiffness"] = (
                f"the file's modulus of {modulus / 1e9:g} GPa is that of a rope; is it a remnant "
                "of an edit?"
            )
    if chain:
        component.comment = (
            "The width that the file gives stands as diameter, which is not that of the bar; "
            "Cd counts on it."
        )
    if element.width > 0.0 and element.diameter > 0.0:
        component.guesses["diameter"] = "the file gives a width and a diameter of a sphere"
    return component


def anchor_of(element: MddElement) -> ImportedComponent:
    """The definition of the lowest element; files give its weight with either sign."""
    figures: dict[str, FigureOrWord] = {
        "weight": abs(element.lift) * KILOGRAM_FORCE,
        "length": element.length,
    }
    return ImportedComponent(element.name, "anchor", figures)
