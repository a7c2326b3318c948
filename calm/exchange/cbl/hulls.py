"""Hulls of WHOI Cable: what they displace and show to the current at each draft."""

from __future__ import annotations

import math
from itertools import pairwise

from calm.exchange.cbl.problem import CableDefinition
from calm.exchange.cbl.water import number

_STEPS = 12  # rows of a table between two diameters
_SLIGHT = 1e-9


def largest(definition: CableDefinition, shape: str) -> tuple[float, float, float]:
    """Volume [m³], area shown to the current [m²] and height [m] of the whole hull."""
    rows = displacement(definition, shape)
    draft, volume, area = rows[-1]
    return volume, area, draft


def displacement(definition: CableDefinition, shape: str) -> tuple[tuple[float, float, float], ...]:
    """Rows of draft [m], displaced volume [m³] and immersed area [m²].

    Raises
    ------
    InputError
        The hull has no size, or a shape that is not known.
    """
    values = definition.values
    across = number(values, "d") or number(values, "diam")
    height = number(values, "h") or number(values, "height")
    if shape == "axisymmetric":
        return _turned(definition)
    if across <= 0.0:
        raise definition.token.refuse(f"buoy `{definition.name}` has no diameter")
    radius = across / 2.0
    top = height if shape == "cylinder" else across
    if top <= 0.0:
        raise definition.token.refuse(f"buoy `{definition.name}` has no height `h`")
    rows = []
    for step in range(2 * _STEPS + 1):
        draft = top * step / (2 * _STEPS)
        if shape == "cylinder":
            rows.append((draft, math.pi * radius**2 * draft, across * draft))
            continue
        angle = 2.0 * math.acos(max(-1.0, min(1.0, (radius - draft) / radius)))
        disc = 0.5 * radius**2 * (angle - math.sin(angle))
        volume = (1.5 * across - draft) * draft**2 * math.pi / 3.0
        if shape == "capsule":
            volume += disc * max(height - across, 0.0)
        elif shape != "sphere":
            raise definition.token.refuse(f"buoy `{definition.name}` is of an unknown type")
        rows.append((draft, volume, disc))
    return tuple(rows)


def _turned(definition: CableDefinition) -> tuple[tuple[float, float, float], ...]:
    """Of a hull given by its diameters at levels above its keel."""
    value = definition.values.get("diameters")
    if value is None or len(value.rows) < 2 or any(len(row) != 2 for row in value.rows):
        raise definition.token.refuse(f"buoy `{definition.name}` needs `diameters` at two levels")
    levels = [(row[0].at(), row[1].at()) for row in value.rows]
    if any(b[0] <= a[0] or a[1] < 0.0 for a, b in pairwise(levels)):
        raise value.token.refuse("the levels of `diameters` must go on growing")
    rows = [(0.0, 0.0, 0.0)]
    volume = area = 0.0
    keel = levels[0][0]
    for (low, narrow), (high, wide) in pairwise(levels):
        for step in range(1, _STEPS + 1):
            part = (high - low) * step / _STEPS
            across = narrow + (wide - narrow) * step / _STEPS
            cone = math.pi / 12.0 * part * (narrow**2 + narrow * across + across**2)
            shown = 0.5 * part * (narrow + across)
            rows.append((low - keel + part, volume + cone, area + shown))
        _, volume, area = rows[-1]
    return tuple(row for i, row in enumerate(rows) if i == 0 or row[1] > rows[i - 1][1] + _SLIGHT)
