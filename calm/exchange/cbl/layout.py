"""Convert the layout of a WHOI Cable problem to a mooring, a tow, or a net of legs."""

import math
from dataclasses import dataclass, replace
from itertools import zip_longest

from calm.errors import refused
from calm.exchange import model
from calm.exchange.cbl import grammar
from calm.exchange.cbl.components import ComponentMaker, counts_on_depth, varies
from calm.exchange.cbl.words import Token
from calm.quantities import bearing_of

_REACHES = 0.97  # share of the depth: a longer line reaches the surface
_PARTS = 12  # number of lengths of a segment whose drag changes with depth
_CHANGE = 0.02  # relative change of a drag coefficient above which a segment is divided
_MOST_NODES = 1_000_000
_ON_THE_BED = 0.05
"""Height of an anchor, relative to the water depth, below which the anchor stands on the seabed."""


_End = grammar.CableTerminal | str
"""Start or end of a leg in the layout: a terminal, or the name of a node."""


@dataclass
class CableLayout:
    """Converter of the layout in a problem file to pieces, or to legs of a net.

    Pieces and legs are added to `design`. Drag that varies with depth or speed is evaluated in the
    water of `design`. `nodes` is the number of nodes created so far.
    """

    problem: grammar.CableProblem
    makers: ComponentMaker
    design: model.ImportedDesign
    nodes: int = 0

    @property
    def water(self) -> model.ImportedWater:
        """Water of the design."""
        assert self.design.water is not None
        return self.design.water

    @property
    def depth(self) -> float:
        """Water depth [m]; InputError is raised if the file has none."""
        if self.water.depth is None:
            raise refused(self.problem.path, "the environment has no `depth`")
        return self.water.depth

    def lay_mooring(self) -> None:
        """Convert the line of a mooring, from the buoy down to the anchor."""
        items = self._pieces_of(self.problem.segments)
        lower, upper = self.problem.terminals
        if "anchor" in upper.values:
            raise upper.token.refuse("the layout must begin at the anchor and end at the buoy")
        depth, anchor = self.depth, self._anchor(lower)
        if upper.buoy is None:
            raise upper.token.refuse("the upper end must be a buoy")
        reaches = self.problem.kind == "general" and self.problem.length >= _REACHES * depth
        buoy = self._buoy(upper, afloat=reaches or self.problem.kind == "surface")
        self.design.items = [buoy, *reversed(items), model.ImportedPiece(anchor)]

    def lay_tow(self) -> None:
        """Convert the line of a tow, from the ship down.

        A ship at rest in a current becomes a moving ship. The surface current is then subtracted
        from the current at all depths.
        """
        items = self._pieces_of(self.problem.segments)
        body, ship = self.problem.terminals
        if body.buoy is None or "anchor" in ship.values:
            raise body.token.refuse(
                "the layout of a tow must begin at the towed body and end at the ship"
            )
        speeds = (ship.values.get(key) for key in ("x-speed", "y-speed"))
        east, north = (0.0 if value is None else value.at(0.0) for value in speeds)
        if not east and not north and self.water.current:
            _, drift_east, drift_north, _ = self.water.current[0]
            east, north = 0.0 - drift_east, 0.0 - drift_north
            moved = [(d, u + east, v + north, w) for d, u, v, w in self.water.current]
            self.water.current = tuple(moved) if any(any(row[1:]) for row in moved) else ()
            note = "In the file the ship is at rest in a current; in CALM the ship moves instead."
            self.design.notes.append(note)
        speed = math.hypot(east, north)
        if speed == 0.0:
            raise ship.token.refuse("the ship of this tow must move")
        self.design.tow = model.ImportedTow(speed, bearing_of(east, north))
        self.design.items = [*items[::-1], self._buoy(body, afloat=False)]

    def lay_net(self) -> None:
        """Convert a line with branches, or with an anchor at each end, to legs of a net.

        Raises
        ------
        InputError
            A branch has no terminal, or there is nothing between two anchors.
        """
        first, *others = self.problem.layout
        assert isinstance(first, grammar.CableTerminal)
        self._lay_legs(others, first)

    def _anchor(self, end: grammar.CableTerminal) -> model.ImportedComponent:
        name = end.values["anchor"].text
        known, height = self.problem.anchors.get(name), end.values.number("z")
        anchor = self.makers.anchor(known, name, end.values.number("mu"))
        if height > 0.0:
            anchor.figures["length"] = height
        return anchor

    def _buoy(self, end: grammar.CableTerminal, *, afloat: bool) -> model.ImportedPiece:
        found = _definition_of(self.problem.buoys, end.buoy, end.token)
        return model.ImportedPiece(self.makers.buoy(found, afloat=afloat))

    def _pieces_of(self, segments: list[grammar.CableSegment]) -> list[model.ImportedPiece]:
        """Convert segments and their connectors to pieces, from the lowest up."""
        items: list[model.ImportedPiece] = []
        below, seabed = 0.0, self.water.depth or self.problem.length
        for segment in segments:
            length = segment.values.number("length")
            if length <= 0.0:
                raise segment.token.refuse("a segment has no length")
            named = segment.values.get("material")
            material = _definition_of(self.problem.materials, named, segment.token)
            items += self._pieces(segment, material, length, seabed - below)
            below += length
            for key in ("top-spool-length", "bottom-spool-length"):
                if segment.values.number(key) > 0.0:
                    remark = model.Remark(f"segment of {material.name}", f"{key}: on a winch")
                    self.design.dropped.append(remark)
            joint = segment.connector
            if joint is not None and joint.text.lower() not in ("pinned", "spliced"):
                items.append(model.ImportedPiece(self._connector(joint)))
        return items

    def _pieces(
        self,
        segment: grammar.CableSegment,
        material: grammar.CableDefinition,
        length: float,
        lower: float,
    ) -> list[model.ImportedPiece]:
        """Convert a segment to pieces, from the lowest up; several if the drag varies with depth.

        `lower` is the depth of the lower end of the segment in the upright line [m].
        """
        clamps = self._clamps(segment, length)
        count = _PARTS if varies(material) else 1
        made: list[model.ImportedPiece] = []
        for part in range(count):
            depth = max(lower - length * (part + 0.5) / count, 0.0)
            component = self.makers.material(material, length, depth, self._current_speed(depth))
            if made and _similar_drag(made[-1].component, component):
                made[-1].length = made[-1].extent + length / count
            else:
                made.append(model.ImportedPiece(component, length / count))
        start = 0.0
        for item in made:
            end = start + item.extent
            for height, clamped in clamps:
                if start <= height < end or (item is made[-1] and height >= end):
                    item.clamp(clamped, min(max(end - height, 0.0), item.extent))
            item.guess = (
                "the drag was computed for the depth of this part when the line is upright"
                if len(made) > 1
                else ""
            )
            start = end
        for key in ("cdn", "cdt"):
            value = material.values.get(key)
            if value is not None and value.rows and not counts_on_depth(value):
                speed = f"{self._current_speed(lower - length / 2.0):.3g} m/s"
                for item in made:
                    item.guess = (
                        item.guess
                        or f"the file has a table of {key} against speed; this is the value at "
                        f"{speed}"
                    )
        return made

    def _current_speed(self, depth: float) -> float:
        levels = self.water.current or ((0.0, 0.0, 0.0, 0.0),)
        row = min(levels, key=lambda each: abs(each[0] - depth))
        return math.hypot(row[1], row[2])

    def _clamps(
        self, segment: grammar.CableSegment, length: float
    ) -> list[tuple[float, model.ImportedComponent]]:
        """Return attached items, each with its height above the lower end of the segment [m]."""
        heights = _node_heights(segment, length) if segment.attachments else []
        found = []
        for token, nodes in segment.attachments:
            component = self._connector(token)
            for node in nodes:
                if not 1 <= node <= len(heights):
                    raise token.refuse(
                        f"there is no node {node}; the segment has nodes 1 to {len(heights)}"
                    )
                found.append((heights[node - 1], component))
        return found

    def _connector(self, token: Token) -> model.ImportedComponent:
        found = self.problem.connectors.get(token.text)
        if found is None:
            raise token.refuse(f"the connector `{token.text}` is not defined")
        return self.makers.connector(found)

    def _lay_legs(self, layout: grammar.CableItems, start: _End) -> None:
        segments: list[grammar.CableSegment] = []
        branched = any(isinstance(each, grammar.CableBranch) for each in layout)
        last = layout[-1] if layout else None
        anchored = (
            isinstance(end, grammar.CableTerminal) and "anchor" in end.values
            for end in (start, last)
        )
        # a line from anchor to anchor is divided at the first possible position
        whole = not branched and all(anchored)
        for each, following in zip_longest(layout, layout[1:]):
            if isinstance(each, grammar.CableTerminal):
                self._add_leg(start, segments, each)
                segments = []
            elif isinstance(each, grammar.CableBranch):
                self._lay_legs(each.layout, start)
            else:
                segments.append(each)
                cut = whole and not isinstance(start, str) and each.connector is not None
                if isinstance(following, grammar.CableBranch) or cut:
                    self.nodes += 1
                    node = f"node-{self.nodes}"
                    self._add_leg(start, segments, node)
                    start, segments = node, []
        if segments or not isinstance(last, grammar.CableTerminal):
            message = "the layout has no `terminal` at the end of a line"
            raise last.token.refuse(message) if last else refused(self.problem.path, message)

    def _add_leg(self, start: _End, segments: list[grammar.CableSegment], end: _End) -> None:
        items = self._pieces_of(segments)[::-1]
        first, lower, low = self._end(start)
        last, upper, high = self._end(end)
        if not segments or (low and high):
            where = start if isinstance(end, str) else end
            assert not isinstance(where, str)
            raise where.token.refuse(
                "this line has no segment, or both of its ends are anchors or sinking buoys"
            )
        if high:  # the layout lists this leg downwards
            items = [_reversed_piece(each) for each in items[::-1]]
            first, lower, last, upper = last, upper, first, lower
        self.design.lay([*last, *items, *first], upper, lower)

    def _end(self, at: _End) -> tuple[list[model.ImportedPiece], str, bool]:
        """Return the pieces and the connection at an end of a leg.

        The third item is true if the end is a lower end.
        """
        if isinstance(at, str):
            return [], model.joined_at(at), False
        values, token = at.values, at.token
        if "node" in values:
            raise token.refuse(
                "the layout has a loop, because this end of the line is attached to a node"
            )
        x, y, z = (values.number(key) for key in ("x", "y", "z"))
        if "anchor" not in values:
            buoy = self._buoy(at, afloat=self.problem.kind == "surface")
            return [buoy], "free", buoy.component.figures.get("role") != "float"
        if z > _ON_THE_BED * self.depth:
            return [], model.held_at(self.depth - z, x, y), False
        return [model.ImportedPiece(self._anchor(at))], model.anchored_at(x, y), True


def _reversed_piece(item: model.ImportedPiece) -> model.ImportedPiece:
    clamps = [replace(each, at=item.extent - each.at) for each in item.clamps[::-1]]
    return replace(item, clamps=clamps)


def _similar_drag(one: model.ImportedComponent, other: model.ImportedComponent) -> bool:
    pairs = ((one.number(key), other.number(key)) for key in ("cn", "ct"))
    return all(abs(a - b) <= _CHANGE * max(abs(a), abs(b)) for a, b in pairs)


def _node_heights(segment: grammar.CableSegment, length: float) -> list[float]:
    """Return the heights of the nodes above the lower end of a segment [m]."""
    nodes = segment.values.get("nodes")
    if nodes is None or not nodes.rows or any(len(row) != 2 for row in nodes.rows):
        raise segment.token.refuse("attachments need `nodes = (count, share)`")
    heights = [0.0]
    for count, share in nodes.rows:
        whole, part, start = round(count.at()), share.at() * length, heights[-1]
        if not 2 <= whole <= _MOST_NODES:
            raise nodes.token.refuse(f"a segment needs 2 to {_MOST_NODES} nodes")
        heights += [start + part * k / (whole - 1) for k in range(1, whole)]
    if abs(heights[-1] - length) > 1e-3 * length:
        raise nodes.token.refuse(
            f"the nodes cover {heights[-1]:g} m of the segment, which is {length:g} m long"
        )
    return heights


def _definition_of(
    definitions: dict[str, grammar.CableDefinition],
    value: grammar.KeyValue | None,
    token: Token,
) -> grammar.CableDefinition:
    if value is None or not value.text:
        raise token.refuse("the name of a material or a buoy is missing")
    found = definitions.get(value.text)
    if found is None:
        raise value.token.refuse(f"`{value.text}` is not defined")
    return found
