"""What the result of a net says: the table of its legs, its nodes, and what its ends bear."""

from __future__ import annotations

from calm.case import Result
from calm.case.net_result import NetResult, legs_of
from calm.checks.finding import State
from calm.files.legs import EndKeys
from calm.quantities import say
from calm.report.blocks import Cell, Column, Note, Prose, ReportPart, Table, table_of
from calm.report.sheet import line_table, quantity_field

_COLUMNS = ("length", "depth", "x", "y", "knockdown", "tilt", "tension", "safety_factor")


def net_part(result: NetResult) -> ReportPart:
    """A net in short: a table of the pieces leg by leg, its nodes, its anchors and held ends."""
    depth = say("depth", result.file.environment.depth)
    count = len(result.legs)
    title = f"{result.name}: net of {count} leg{'s' * (count != 1)}, {depth} of water"
    heads = {leg.file.legs[0].first: Cell(leg_title(leg), strong=True) for leg in result.legs}
    table = line_table(result, _COLUMNS, "", heads=heads)
    note = Note((
        "Depth, east and north: of the upper end. Tension: the greatest in the piece. "
        "~ near a limit, ! beyond it.",
        _convergence(result),
    ))  # fmt: skip
    warned = (Prose(result.warnings, State.WARN),) if result.warnings else ()
    parts = (table, *_ends(result), *warned, note)
    return ReportPart(title, parts)


def leg_title(leg: Result) -> str:
    """Name of a leg and what holds its ends."""
    (keys,) = leg.file.legs
    top = "at the surface" if leg.type == "surface" else end_text(keys.top)
    return f"{leg.name}: {top} to {end_text(keys.bottom)}"


def leg_titles(result: Result | NetResult) -> dict[str, str]:
    """The titles of the legs by their names; a single line has none."""
    return {leg.name: f"leg {leg_title(leg)}" for leg in legs_of(result) if leg.file.legs}


def ends_told(line: Result) -> tuple[str | None, str | None]:
    """What a leg comes from and leads to; None where it ends at the sea and on the seabed."""
    if not line.file.legs:
        return None, None
    top, bottom = line.file.legs[0].ends
    return (
        None if top.free else f"from {end_text(top)}",
        None if bottom.anchor is not None else end_text(bottom),
    )


def end_text(end: EndKeys) -> str:
    """What holds an end of a leg, in words."""
    if end.join is not None:
        return f"node {end.join}"
    if end.held is not None:
        return "held end"
    return "free end" if end.anchor is None else "anchor"


def _ends(result: NetResult) -> list[Table | Prose]:
    """Nodes, anchors and held ends, and floats at the surface."""
    blocks: list[Table | Prose] = []
    if result.nodes:
        fields = [quantity_field(name) for name in ("depth", "x", "y")]
        blocks.append(table_of("Nodes", result.nodes, (Column(""), lambda one: one.name), *fields))
    for title, loads in (("Anchors", result.anchors), ("Held ends", result.held)):
        if not loads:
            continue
        heads = {"tension": "pull", "vertical": "up", "horizontal": "sideways"}
        heads |= {"depth": "depth", "x": "east", "y": "north"}
        if loads is result.anchors:
            heads["required_weight"] = "needs"
        fields = [quantity_field(name, heading=head) for name, head in heads.items()]
        blocks.append(table_of(title, loads, (Column("leg"), lambda one: one.leg), *fields))
    afloat = [
        f"{leg.name}: float at the surface, {leg.top.used_buoyancy:.1%} of its buoyancy used, "
        f"{say('reserve', leg.top.reserve)} in reserve"
        for leg in result.legs
        if leg.type == "surface"
    ]
    if afloat:
        blocks.append(Prose(tuple(afloat)))
    return blocks


def _convergence(result: NetResult) -> str:
    """How the net was solved and how good that is."""
    accuracy = result.accuracy
    left = max((node.imbalance for node in result.nodes), default=0.0)
    return (
        f"{result.status.capitalize()} in {result.iterations} marches of its legs, "
        f"{result.segments} segments, good to {accuracy.depth:.2g} m and {accuracy.tension:.2g} N; "
        f"ends missed by {result.miss:.1g} m, nodes in balance to {left:.1g} N, forces closed to "
        f"{result.closure:.1g}."
    )
