"""Read a problem file of WHOI Cable as a design."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from pathlib import Path

from calm.errors import InputError, Problem, refused
from calm.exchange import cable_grammar
from calm.exchange.cable_components import ComponentMaker, counts_on_depth, varies
from calm.exchange.cable_formulas import UnknownNameError
from calm.exchange.cable_grammar import CableBranch, CableDefinition, CableProblem, CableSegment
from calm.exchange.cable_source import Token
from calm.exchange.cable_water import USUAL_GRAVITY, water_of
from calm.exchange.design import (
    Design,
    ImportedComponent,
    ImportedPiece,
    ImportedTow,
    ImportedWater,
    Remark,
)
from calm.files.definition import CATALOGUE_DENSITY
from calm.quantities import bearing_of

_REFUSED = {
    "horizontal": "a horizontal array, which has an anchor at each end",
    "positioned": "a line between two fixed points",
    "horizontal-drifter": "a drifting horizontal array",
    "drifter": "a drifting line without anchor",
    "deployment": "a line that is being laid; `calm deck` plans that",
    "riser": "a riser below a platform",
    "webster": "a line under a given tension",
    "tensioned": "a line under a given tension",
}
_MOORED = ("general", "surface", "subsurface", "horizontal", "positioned")
_REACHES = 0.97  # of the depth: a line as long reaches the surface
_PARTS = 12  # lengths of a segment whose drag changes with depth
_CHANGE = 0.02  # of a drag that is worth two lengths
_HEADS = re.compile(
    r"^\s*(problem\s+description|analysis\s+parameters|environment|layout|materials)\b(?!\s*[=:])",
    re.MULTILINE,
)
_FORCES = ("x-force", "y-force", "z-force", "x-thrust", "y-thrust", "z-thrust")
_NOTE = (
    "cn and ct are its Cdn and Cdt, defined alike: on the diameter, and on the surface of a metre. "
    "See `calm docs import-cable`."
)


def is_cbl(content: bytes) -> bool:
    """Return whether a file looks like a problem: it names two sections that each must have."""
    text = content.decode("latin-1").lower()
    return b"\0" not in content and len(set(_HEADS.findall(text))) >= 2


def read_cbl(path: Path, defines: Mapping[str, str], *, allow_include: bool) -> Design:
    """Read a mooring or a tow.

    Parameters
    ----------
    path : of the problem
    defines : macros from outside, by name
    allow_include : whether files outside its folder may be read

    Raises
    ------
    InputError
        The file cannot be read, or holds what CALM cannot represent. All undefined names that it
        uses are named at once.
    """
    given, missing = dict(defines), list[Problem]()
    while True:
        try:
            design = _read(path, given, allow_include=allow_include)
        except UnknownNameError as error:
            missing += error.problems
            if any(name in given or not name.isidentifier() for name in error.names):
                break
            given |= dict.fromkeys(error.names, "1")  # to see which others are missing
        except InputError:
            if not missing:
                raise
            break
        else:
            if not missing:
                return design
            break
    raise InputError(missing)


def _read(path: Path, defines: Mapping[str, str], *, allow_include: bool) -> Design:
    problem = cable_grammar.read_problem(path, defines, allow_include=allow_include)
    _refuse_other_shapes(problem)
    title, environment = problem.description.get("title"), problem.environment
    design = Design("WHOI Cable", title.text if title and title.text else path.stem, [], None)
    design.notes.append(_NOTE)
    design.water = water_of(
        environment, problem.length, design.dropped, folder=path.parent, allow_include=allow_include
    )
    if problem.analysis:
        design.dropped.append(Remark("analysis parameters", "how that program is to solve it"))
    density = environment.number("rho", "density")
    gravity = environment.number("gravity", default=USUAL_GRAVITY)
    for key, value in (("density", density), ("gravity", gravity)):
        if value < 0.0 or (key == "gravity" and value == 0.0):
            raise refused(path, f"its {key} is {value:g}")
    makers = ComponentMaker(density or CATALOGUE_DENSITY, gravity, design.dropped)
    if _is_net(problem):
        from calm.exchange.cable_net import lay_net

        lay_net(problem, makers, design)
    else:
        items = pieces_of(problem, problem.segments, makers, design)
        (_lay_tow if problem.kind == "towing" else _lay_mooring)(problem, items, makers, design)
    friction = problem.environment.number("bottom-friction")
    if friction > 0.0 and problem.kind != "towing":
        design.solver["seabed_friction"] = friction, "its bottom-friction"
    known = {"buoy", "platform", "anchor", "mu", "x-speed", "y-speed", "x", "y", "z", *_FORCES}
    for end in problem.terminals:
        found = [key for key in end.values if key not in known]
        if found:
            design.dropped.append(Remark("terminal", ", ".join(found)))
    return design


def _is_net(problem: CableProblem) -> bool:
    """Return whether a line has branches, or an anchor at each end."""
    anchored = all("anchor" in end.values for end in problem.terminals)
    branched = any(isinstance(each, CableBranch) for each in problem.layout)
    return problem.kind != "towing" and (branched or anchored)


def _refuse_other_shapes(problem: CableProblem) -> None:
    """Refuse all but moorings and nets of legs, and tows from a ship to a body."""
    kind, layout, ends = problem.kind, problem.layout, problem.terminals
    if kind in _REFUSED and not (kind in _MOORED and _is_net(problem)):
        raise problem.description["type"].token.refuse(
            f"`type = {kind}` is {_REFUSED[kind]}; CALM has single moorings and tows"
        )
    if kind not in (*_MOORED, "towing"):
        raise problem.description["type"].token.refuse(f"`type = {kind}` is not known")
    segments = problem.segments
    if len(ends) != 2 or not segments:
        counts = f"{len(ends)} terminals and {len(segments)} segments"
        raise refused(problem.path, f"the layout has {counts}")
    if not all(isinstance(layout[end], cable_grammar.CableTerminal) for end in (0, -1)):
        raise refused(problem.path, "the layout must lead from one terminal to the other")
    anchored = ["anchor" in end.values for end in ends]
    if any("node" in end.values for end in ends):
        raise ends[1].token.refuse("a loop: its end is tied to a node of the line")
    if kind != "towing" and not any(anchored):
        raise ends[0].token.refuse("no end is an anchor: a drifting line")
    for values in (*(end.values for end in ends), *(segment.joint for segment in segments)):
        for key in _FORCES:
            if key in values and values[key].at(0.0) != 0.0:
                raise values[key].token.refuse(f"`{key}` pulls at the line from outside")


def _lay_mooring(
    problem: CableProblem, items: list[ImportedPiece], makers: ComponentMaker, design: Design
) -> None:
    """Lay the line from the buoy down to the anchor."""
    lower, upper = problem.terminals
    if "anchor" in upper.values:
        raise upper.token.refuse("the layout must lead from the anchor up")
    if design.water is None or design.water.depth is None:
        raise refused(problem.path, "the environment has no `depth`")
    name = lower.values["anchor"]
    anchor = makers.anchor(problem.anchors.get(name.text), name.text, lower.values.number("mu"))
    if lower.values.number("z") > 0.0:
        anchor.figures["length"] = lower.values.number("z")
    top = upper.values.get("buoy") or upper.values.get("platform")
    if top is None:
        raise upper.token.refuse("the upper end is not a buoy")
    reaches = problem.length >= _REACHES * design.water.depth
    afloat = problem.kind == "surface" or (problem.kind == "general" and reaches)
    buoy = makers.buoy(defined(problem.buoys, top, upper.token), afloat=afloat)
    design.items = [ImportedPiece(buoy), *reversed(items), ImportedPiece(anchor)]


def _lay_tow(
    problem: CableProblem, items: list[ImportedPiece], makers: ComponentMaker, design: Design
) -> None:
    """Lay the line from the ship down; a ship at rest in a current moves against it."""
    body, ship = problem.terminals
    towed = body.values.get("buoy") or body.values.get("platform")
    if towed is None or "anchor" in ship.values:
        raise body.token.refuse("a tow leads from a towed body up to a ship")
    water = design.water
    assert water is not None
    east, north = (
        ship.values[key].at(0.0) if key in ship.values else 0.0 for key in ("x-speed", "y-speed")
    )
    if not east and not north and water.current:
        _, drift_east, drift_north, _ = water.current[0]
        east, north = 0.0 - drift_east, 0.0 - drift_north
        rows = [(d, u - drift_east, v - drift_north, w) for d, u, v, w in water.current]
        water.current = tuple(rows) if any(any(row[1:]) for row in rows) else ()
        design.notes.append("The ship lay in a current: here it moves, and the water with it.")
    speed = math.hypot(east, north)
    if speed == 0.0:
        raise ship.token.refuse("the ship of this tow does not move")
    design.tow = ImportedTow(speed, bearing_of(east, north))
    buoy = makers.buoy(defined(problem.buoys, towed, body.token), afloat=False)
    design.items = [*items[::-1], ImportedPiece(buoy)]


def pieces_of(
    problem: CableProblem, segments: list[CableSegment], makers: ComponentMaker, design: Design
) -> list[ImportedPiece]:
    """Return the pieces of segments and their connectors, from the lower one up.

    Parameters
    ----------
    segments : in the order of the layout
    makers : of components
    design : whose water counts for drags by depth
    """
    assert design.water is not None
    items: list[ImportedPiece] = []
    below = 0.0
    seabed = design.water.depth or problem.length
    for segment in segments:
        length = segment.values.number("length")
        if length <= 0.0:
            raise segment.token.refuse("a segment has no length")
        material = defined(problem.materials, segment.values.get("material"), segment.token)
        clamps = _clamps(problem, segment, length, makers)
        items += _pieces(material, length, seabed - below, clamps, makers, design.water)
        below += length
        for key in ("top-spool-length", "bottom-spool-length"):
            if segment.values.number(key) > 0.0:
                design.dropped.append(Remark(f"segment of {material.name}", f"{key}: on a winch"))
        joint = segment.connector
        if joint is not None and joint.text.lower() not in ("pinned", "spliced"):
            items.append(ImportedPiece(makers.connector(_connector(problem, joint))))
    return items


def _pieces(
    material: CableDefinition,
    length: float,
    lower: float,
    clamps: list[tuple[float, ImportedComponent]],
    makers: ComponentMaker,
    water: ImportedWater,
) -> list[ImportedPiece]:
    """Return a segment as one piece, or as several where its drag changes with depth, from below.

    Its lower end is at the depth `lower` standing upright [m]; clamps have heights above that end
    [m].
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
        for height, clamped in clamps:
            if start <= height < end or (last and height >= end):
                item.clamp(clamped, min(max(end - height, 0.0), part_length))
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
        a, b = one.number(key), other.number(key)
        if abs(a - b) > _CHANGE * max(abs(a), abs(b)):
            return False
    return True


def _speed(water: ImportedWater, depth: float) -> float:
    """Return the speed of the current at the level next to a depth [m/s]."""
    if not water.current:
        return 0.0
    row = min(water.current, key=lambda each: abs(each[0] - depth))
    return math.hypot(row[1], row[2])


def _clamps(
    problem: CableProblem, segment: CableSegment, length: float, makers: ComponentMaker
) -> list[tuple[float, ImportedComponent]]:
    """Return what hangs on the nodes of a segment, with the height above its lower end."""
    if not segment.attachments:
        return []
    heights = _heights(segment, length)
    found = []
    for token, nodes in segment.attachments:
        component = makers.connector(_connector(problem, token))
        for node in nodes:
            if not 1 <= node <= len(heights):
                raise token.refuse(f"node {node}: the segment has nodes 1 to {len(heights)}")
            found.append((heights[node - 1], component))
    return found


def _heights(segment: CableSegment, length: float) -> list[float]:
    """Return the heights of the nodes of a segment above its lower end [m]."""
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
    definitions: dict[str, CableDefinition], value: cable_grammar.KeyValue | None, token: Token
) -> CableDefinition:
    """Return the definition that a value names; a problem stands at the value, or at `token`."""
    if value is None or not value.text:
        raise token.refuse("a name is missing: a material, or a buoy")
    found = definitions.get(value.text)
    if found is None:
        raise value.token.refuse(f"`{value.text}` is defined nowhere")
    return found


def _connector(problem: CableProblem, token: Token) -> CableDefinition:
    found = problem.connectors.get(token.text)
    if found is None:
        raise token.refuse(f"the connector `{token.text}` is defined nowhere")
    return found
