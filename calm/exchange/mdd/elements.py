"""The elements of a Mooring Design & Dynamics line: matrices in, one row each out."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from calm.exchange.design import MOST_PIECES
from calm.exchange.mdd.value import MatValue, RealArray, names, numbers


@dataclass(frozen=True)
class MddElement:
    """One column of ``H``, and the figures that go with it.

    Attributes
    ----------
    length, width, diameter : [m]; a sphere has a diameter, all else a width
    is_line : whether its figures are per metre: wire, rope or chain
    is_fastener : shackles, links, swivels
    lift : net buoyancy, of a line per metre [kg]
    mass : in air, where that version of the program has it [kg]
    modulus : of a line [Pa]; None where it is not known, inf where it does not stretch
    number : its column, from 1
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

    @property
    def across(self) -> float:
        """Width, or the diameter where there is none [m]."""
        return self.width or self.diameter


_LARGEST = 1e9  # m, kg: of no piece

MODULI = (1.38e11, 3.45e8, 8.0e8, 3.45e8, 6.9e8, 6.9e10, 7.6e10, 1.0e11)
"""Of the materials that the program numbers from 1: steel, nylon, Dacron, polypropylene,
polyethylene, Kevlar, aluminium, Dyneema [Pa]."""


def read_elements(
    variables: Mapping[str, MatValue], suffix: str
) -> tuple[list[MddElement], list[str]]:
    """The elements of a line in the order of the file, and what is wrong with them.

    Parameters
    ----------
    suffix : ``t`` for the matrices of a tow, ``CO`` for what is clamped on, or nothing
    """
    prefix = "moorele"
    problems: list[str] = []
    size = _matrix(variables, f"H{suffix}", problems)
    count = size.shape[1]
    lift = _row(variables, f"B{suffix}", count, problems)
    drag = _row(variables, f"Cd{suffix}", count, problems)
    if count > MOST_PIECES:
        problems.append(f"`H{suffix}` has {count} elements; more than {MOST_PIECES} are not read")
    if problems or not count:
        return [], problems
    modulus = _optional(variables, f"ME{suffix}")
    mass = _optional(variables, f"Wt{suffix}")
    called = _names(variables, f"{prefix}{suffix}", count)
    elements = []
    for i in range(count):
        length, width, diameter, flag = (float(value) for value in size[:, i])
        elements.append(
            MddElement(
                name=called[i],
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
            )
        )
        problems += mistakes_of(elements[-1], f"element {i + 1}, {called[i]}")
    return elements, problems


def mistakes_of(element: MddElement, where: str) -> list[str]:
    """The figures of an element that no piece of a mooring can have."""
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


def _matrix(variables: Mapping[str, MatValue], name: str, problems: list[str]) -> RealArray:
    """``H``: four rows, one column an element; the flag is 0 where a row is missing."""
    try:
        size = numbers(variables.get(name))
    except ValueError as error:
        problems.append(f"`{name}` {error}")
        return np.zeros((4, 0))
    if size.size == 0:
        return np.zeros((4, 0))
    size = np.atleast_2d(size)
    if size.ndim == 2 and size.shape[0] not in (3, 4) and size.shape[1] in (3, 4):
        size = size.T
    if size.ndim != 2 or size.shape[0] not in (3, 4):
        shape = "×".join(str(length) for length in size.shape)
        problems.append(f"`{name}` is {shape}; it must have 4 rows, one column an element")
        return np.zeros((4, 0))
    return size if size.shape[0] == 4 else np.vstack([size, np.zeros(size.shape[1])])


def _row(
    variables: Mapping[str, MatValue], name: str, count: int, problems: list[str]
) -> RealArray:
    try:
        row = numbers(variables.get(name)).ravel()
    except ValueError as error:
        problems.append(f"`{name}` {error}")
        return np.zeros(count)
    if row.size != count:
        problems.append(f"`{name}` has {row.size} values for {count} elements")
        return np.zeros(count)
    return row


def _optional(variables: Mapping[str, MatValue], name: str) -> RealArray:
    try:
        return numbers(variables.get(name)).ravel()
    except ValueError:
        return np.zeros(0)


def _names(variables: Mapping[str, MatValue], name: str, count: int) -> list[str]:
    """A name for every element, also where the file has none."""
    value = variables.get(name)
    found = names(value) if value is not None else []
    if len(found) != count and isinstance(value, np.ndarray) and value.ndim == 2:
        found = names(value.T)
    found = (found + [""] * count)[:count]
    return [each or f"element {i}" for i, each in enumerate(found, 1)]


def _modulus(value: float) -> float | None:
    """A modulus of elasticity [Pa]; small whole numbers stand for a material."""
    if math.isnan(value) or value <= 0.0:
        return None
    if value <= len(MODULI) and value == int(value):
        return MODULI[int(value) - 1]
    return value
