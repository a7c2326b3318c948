"""Lay a problem of WHOI Cable that has branches, or an anchor at each end, as a net of legs."""

from __future__ import annotations

from dataclasses import dataclass, replace

from calm.errors import refused
from calm.exchange.cable_components import ComponentMaker
from calm.exchange.cable_grammar import CableBranch, CableProblem, CableSegment, CableTerminal
from calm.exchange.cable_reader import defined, pieces_of
from calm.exchange.design import (
    Design,
    ImportedLeg,
    ImportedPiece,
)

_ON_THE_BED = 0.05
"""Share of the depth: an anchor no higher above the seabed stands on it."""


def lay_net(problem: CableProblem, makers: ComponentMaker, design: Design) -> None:
    """Lay the legs of a problem, and join them where it has branches.

    Parameters
    ----------
    makers : of components
    design : to which the legs are added

    Raises
    ------
    InputError
        A branch has no end, or nothing stands between two anchors.
    """
    if design.water is None or design.water.depth is None:
        raise refused(problem.path, "the environment has no `depth`")
    net = _Net(problem, makers, design, design.water.depth)
    first, *others = problem.layout
    assert isinstance(first, CableTerminal)
    net.lay(others, _Start(first))
    design.items = [item for leg in design.legs for item in leg.items]


@dataclass(frozen=True)
class _Start:
    """Where a leg of the layout begins: at a terminal, or at a node."""

    terminal: CableTerminal | None = None
    node: str = ""


@dataclass
class _Net:
    """A net as it is laid; legs begin where the layout has their first segment."""

    problem: CableProblem
    makers: ComponentMaker
    design: Design
    depth: float
    nodes: int = 0

    def lay(self, layout: list[CableTerminal | CableSegment | CableBranch], start: _Start) -> None:
        """Lay what follows a terminal or a node, and the branches at the nodes on the way."""
        segments: list[CableSegment] = []
        for at, each in enumerate(layout):
            following = layout[at + 1] if at + 1 < len(layout) else None
            if isinstance(each, CableTerminal):
                self._leg(start, segments, _Start(each))
                segments = []
            elif isinstance(each, CableBranch):
                self.lay(each.layout, start)
            else:
                segments.append(each)
                if isinstance(following, CableBranch) or self._splits(each, layout, start):
                    self.nodes += 1
                    node = _Start(node=f"node-{self.nodes}")
                    self._leg(start, segments, node)
                    start, segments = node, []
        if segments or not layout or not isinstance(layout[-1], CableTerminal):
            where = layout[-1].token if layout else None
            message = "the layout has no `terminal` at the end of a line"
            raise where.refuse(message) if where else refused(self.problem.path, message)

    def _splits(
        self,
        segment: CableSegment,
        layout: list[CableTerminal | CableSegment | CableBranch],
        start: _Start,
    ) -> bool:
        """Whether a line from anchor to anchor is cut above a segment: where it first can be."""
        last = layout[-1]
        held = start.terminal is not None and "anchor" in start.terminal.values
        return (
            held
            and isinstance(last, CableTerminal)
            and "anchor" in last.values
            and not any(isinstance(each, CableBranch) for each in layout)
            and segment.connector is not None
        )

    def _leg(self, start: _Start, segments: list[CableSegment], end: _Start) -> None:
        """Add a leg, turned where what the layout has last is its lower end."""
        items = pieces_of(self.problem, segments, self.makers, self.design)[::-1]
        first, lower, low = self._end(start)
        last, upper, high = self._end(end)
        if not segments or (low and high):
            where = end.terminal or start.terminal
            assert where is not None
            raise where.token.refuse("nothing stands between its two ends, which both go down")
        if high:
            items, first, lower, last, upper = (
                [_turned(each) for each in items[::-1]],
                last,
                upper,
                first,
                lower,
            )
        legs = self.design.legs
        legs.append(ImportedLeg(f"leg-{len(legs) + 1}", [*last, *items, *first], upper, lower))

    def _end(self, at: _Start) -> tuple[list[ImportedPiece], str, bool]:
        """What stands at an end, what holds it, and whether it is a lower one."""
        if at.terminal is None:
            return [], f"{{join: {at.node}}}", False
        values, token = at.terminal.values, at.terminal.token
        if "node" in values:
            raise token.refuse("a loop: its end is tied to a node of the line")
        x, y, z = (values.number(key) for key in ("x", "y", "z"))
        place = f"[{x:.9g} m, {y:.9g} m]"
        if "anchor" not in values:
            name = values.get("buoy") or values.get("platform")
            buoy = self.makers.buoy(
                defined(self.problem.buoys, name, token), afloat=self.problem.kind == "surface"
            )
            return [ImportedPiece(buoy)], "free", buoy.figures.get("role") != "float"
        if z > _ON_THE_BED * self.depth:
            return [], f"{{held: {{depth: {self.depth - z:.9g} m, at: {place}}}}}", False
        name = values["anchor"]
        mu = values.number("mu")
        anchor = self.makers.anchor(self.problem.anchors.get(name.text), name.text, mu)
        if z > 0.0:
            anchor.figures["length"] = z
        return [ImportedPiece(anchor)], f"{{anchor: {{at: {place}}}}}", True


def _turned(item: ImportedPiece) -> ImportedPiece:
    """Return a piece with its clamps counted from the other end."""
    clamps = [replace(each, at=item.extent - each.at) for each in item.clamps[::-1]]
    return replace(item, clamps=clamps)
