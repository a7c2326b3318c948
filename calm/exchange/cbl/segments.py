"""The segments of a WHOI Cable layout as pieces of a line, with what hangs on their nodes."""

from __future__ import annotations

import math

from calm.exchange.cbl.components import ComponentMaker, counts_on_depth, varies
from calm.exchange.cbl.problem import CableDefinition, CableProblem, CableSegment, KeyValue
from calm.exchange.cbl.tokens import Token
from calm.exchange.cbl.water import number
from calm.exchange.design import (
    Design,
    ImportedClamp,
    ImportedComponent,
    ImportedPiece,
    ImportedWater,
    Remark,
)

_PARTS = 12  # lengths of a segment whose drag changes with depth
_CHANGE = 0.02  # of a drag that is worth two lengths


def laid(
    problem: CableProblem, segments: list[CableSegment], makers: ComponentMaker, design: Design
) -> list[ImportedPiece]:
    """The pieces between the ends, from the lower one up."""
    assert design.water is not None
    items: list[ImportedPiece] = []
    below = 0.0
    seabed = design.water.depth or sum(number(each.values, "length") for each in segments)
    for segment in segments:
        length = number(segment.values, "length")
        if length <= 0.0:
            raise segment.token.refuse("a segment has no length")
        material = defined(problem.materials, segment.values.get("material"), segment.token)
        clamps = _clamps(problem, segment, length, makers)
        items += _pieces(material, length, seabed - below, clamps, makers, design.water)
        below += length
        for key in ("top-spool-length", "bottom-spool-length"):
            if number(segment.values, key) > 0.0:
                design.dropped.append(Remark(f"segment of {material.name}", f"{key}: on a winch"))
        joint = segment.connector
        if joint is not None and joint.text.lower() not in ("pinned", "spliced"):
            items.append(
                ImportedPiece(makers.connector(_named(problem.connectors, joint, "connector")))
            )
    return items


def _pieces(
    material: CableDefinition,
    length: float,
    lower: float,
    clamps: list[tuple[float, ImportedComponent]],
    makers: ComponentMaker,
    water: ImportedWater,
) -> list[ImportedPiece]:
    """A segment as one piece, or as several where its drag changes with depth; lower end first.

    Parameters
    ----------
    lower : depth of its lower end, standing upright [m]
    clamps : height above its lower end [m], and what hangs there
    """
    count = _PARTS if varies(material) else 1
    made: list[tuple[float, ImportedComponent]] = []
    for part in range(count):
        depth = max(lower - length * (part + 0.5) / count, 0.0)
        component = makers.material(material, length, depth, _speed(water, depth))
        if made and _alike(made[-1][1], component):
            made[-1] = (made[-1][0] + length / count, made[-1][1])
        else:
            made.append((length / count, component))
    items, start = [], 0.0
    for part_length, component in made:
        guess = "its drag at the depth where it stands upright" if len(made) > 1 else ""
        item = ImportedPiece(component, part_length, guess=guess)
        end = start + part_length
        last = component is made[-1][1]
        for height, hung in clamps:
            if start <= height < end or (last and height >= end):
                item.clamps.append(ImportedClamp(hung, min(max(end - height, 0.0), part_length)))
        item.clamps.sort(key=lambda clamp: clamp.at)
        items.append(item)
        start = end
    for key in ("cdn", "cdt"):
        value = material.values.get(key)
        if value is not None and value.rows and not counts_on_depth(value):
            for item in items:
                speed = f"{_speed(water, lower - length / 2.0):.3g} m/s"
                item.guess = item.guess or f"{key} is a table by speed: its value at {speed}"
    return items


def _alike(one: ImportedComponent, other: ImportedComponent) -> bool:
    for key in ("cn", "ct"):
        a, b = float(one.figures[key]), float(other.figures[key])
        if abs(a - b) > _CHANGE * max(abs(a), abs(b)):
            return False
    return True


def _speed(water: ImportedWater, depth: float) -> float:
    """Of the current at the level next to a depth [m/s]."""
    if not water.current:
        return 0.0
    row = min(water.current, key=lambda each: abs(each[0] - depth))
    return math.hypot(row[1], row[2])


def _clamps(
    problem: CableProblem, segment: CableSegment, length: float, makers: ComponentMaker
) -> list[tuple[float, ImportedComponent]]:
    """What hangs on the nodes of a segment, with the height above its lower end."""
    if not segment.attachments:
        return []
    heights = _heights(segment, length)
    found = []
    for attachment in segment.attachments:
        component = makers.connector(_named(problem.connectors, attachment.token, "connector"))
        for node in attachment.nodes:
            if not 1 <= node <= len(heights):
                raise attachment.token.refuse(
                    f"node {node}: the segment has nodes 1 to {len(heights)}"
                )
            found.append((heights[node - 1], component))
    return found


def _heights(segment: CableSegment, length: float) -> list[float]:
    """Of the nodes of a segment above its lower end [m]."""
    nodes = segment.values.get("nodes")
    if nodes is None or not nodes.rows or any(len(row) != 2 for row in nodes.rows):
        raise segment.token.refuse("attachments need `nodes = (count, share)`")
    heights = [0.0]
    for count, share in nodes.rows:
        number_, part = round(count.at()), share.at() * length
        if not 2 <= number_ <= 1_000_000:
            raise nodes.token.refuse("a segment needs two nodes at least")
        start = heights[-1]
        heights += [start + part * k / (number_ - 1) for k in range(1, number_)]
    if abs(heights[-1] - length) > 1e-3 * length:
        raise nodes.token.refuse(f"the nodes reach over {heights[-1]:g} m of {length:g} m")
    return heights


def defined(
    definitions: dict[str, CableDefinition], value: KeyValue | None, token: Token
) -> CableDefinition:
    """The definition that a value names, else a problem at the value, or at `token` without one."""
    if value is None or not value.text:
        raise token.refuse("a name is missing: a material, or a buoy")
    found = definitions.get(value.text)
    if found is None:
        raise value.token.refuse(f"`{value.text}` is defined nowhere")
    return found


def _named(definitions: dict[str, CableDefinition], token: Token, what: str) -> CableDefinition:
    found = definitions.get(token.text)
    if found is None:
        raise token.refuse(f"the {what} `{token.text}` is defined nowhere")
    return found
