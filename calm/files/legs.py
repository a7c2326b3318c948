"""Key `legs` of a mooring file: legs that meet at nodes, with free, anchored or held ends."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Field, ValidationInfo

from calm.errors import unknown
from calm.files.components import Anchor
from calm.files.definition import Model, QuantityField, Text, described, optional
from calm.files.environment import Position
from calm.files.line_items import LineReader
from calm.files.pieces import STAND_IN, Piece, Place, numbered, placed
from calm.files.rigid import Profiler
from calm.files.yaml_document import SourceMapping, validate
from calm.positions import HEMISPHERES, Frame
from calm.units import QuantityError

MOST_LEGS = 40
ONE_LEG_ONLY = (
    "this file is a net of legs; a single line with one free end and one anchor is needed here. "
    "Only `calm run`, `check`, `batch`, `deck`, `size`, `diff` and `export` accept nets. For the "
    "depths of a net's instruments in a record of currents, use `calm batch`. For waves or an "
    "anchor drop, make a file of the most loaded leg alone"
)
NET_SURE = (
    "single lines; for a net, `calm run --explain` shows the effect of drag, buoyancy or current; "
    "or change values in a copy of the file (in Python: `with_`) and solve the net again"
)

_Offset = Annotated[float, QuantityField("length")]
_LATITUDE, _LONGITUDE = (Position.model_fields[name] for name in HEMISPHERES)
_ON_A_CHART = re.compile(r"deg|[°º]|\d['′\s]*[NSEW]\s*$", re.IGNORECASE)


def _at_given(value: object, info: ValidationInfo) -> object:
    given = value if isinstance(value, list) and len(value) == 2 else ()
    if not any(_ON_A_CHART.search(str(each)) for each in given):
        return value
    origin: Position | None = info.context and info.context["position"]
    if origin is None:
        raise QuantityError("is a latitude and a longitude, for which the file needs a `position`")
    north, east = (
        np.array(field.metadata[0].read(text))
        for field, text in zip((_LATITUDE, _LONGITUDE), given, strict=True)
    )
    place = Frame(origin.latitude, origin.longitude).place(north, east, np.zeros(()))
    return [f"{each:.3f} m" for each in place[:2]]


_At = Annotated[
    tuple[_Offset, _Offset],
    BeforeValidator(_at_given, json_schema_input_type=tuple[Text, Text]),
    Field(
        description="metres east and north of the origin, or a latitude and a longitude; the "
        "origin is the `position` of the file",
        examples=[["30 m", "0 m"], ["57 28.84 N", "3 12.10 W"]],
    ),
]


class HeldKeys(Model):
    """Position of a held end, for instance at a ship, a pier or a platform."""

    depth: _Offset = Field(
        description="depth below the surface; negative above it, in air", examples=["2 m", "-10 m"]
    )
    at: _At = (0.0, 0.0)


class AnchoredKeys(Model):
    """Position of the anchor of a leg."""

    at: _At = (0.0, 0.0)
    depth: Annotated[float, QuantityField("length", above=0)] | None = optional(
        "depth of the seabed at the anchor, if not the water depth", "44 m"
    )


class EndKeys(Model):
    """Connection of a leg end, given by one of these keys; a free end has none of the keys."""

    join: Text | None = optional("a node where legs meet", "A")
    anchor: AnchoredKeys | None = optional("the seabed", {"at": ["30 m", "0 m"]})
    held: HeldKeys | None = optional("a fixed place", {"depth": "2 m"})

    @property
    def free(self) -> bool:
        """Whether the end is free."""
        return self.join is None and self.anchor is None and self.held is None


FREE, ANCHORED = EndKeys(), EndKeys(anchor=AnchoredKeys())


def _end_given(value: object) -> object:
    if value == "free":
        return {}
    if not isinstance(value, dict):
        raise QuantityError("must be `free`, or one of `{join: …}`, `{anchor: …}`, `{held: …}`")
    return value


_End = Annotated[
    EndKeys, BeforeValidator(_end_given, json_schema_input_type=Literal["free"] | EndKeys)
]


class LegKeys(Model):
    """Keys of a leg: its pieces from the upper to the lower end, and its two end connections."""

    line: Annotated[tuple[Any, ...], Field(min_length=1)] = described(
        "the pieces from the upper to the lower end",
        [{"use": "wire-jacketed-8", "length": "150 m"}],
    )
    top: _End = Field(
        default=FREE,
        description="connection of the upper end of the leg",
        examples=["free", {"join": "A"}],
    )
    bottom: _End | None = Field(
        default=None,
        description="connection of the lower end of the leg; by default its last item, if this is "
        "an anchor",
        examples=[{"join": "A"}, {"anchor": {"at": ["30 m", "0 m"]}}, "free"],
    )


@dataclass(frozen=True)
class FileLeg:
    """A leg of a net, with the range of its pieces and its two end connections.

    The indices of its pieces run from `first` up to, but not including, `end`.
    """

    name: str
    first: int
    end: int
    top: EndKeys
    bottom: EndKeys

    def grown(self, index: int, more: int) -> FileLeg:
        """Return a copy of the leg with its indices adjusted to pieces inserted into the line.

        Parameters
        ----------
        index : index of the piece below which the new pieces are inserted, in this leg or another
        more : number of new pieces
        """
        return replace(
            self,
            first=self.first + more * (self.first > index),
            end=self.end + more * (self.end > index),
        )

    @property
    def ends(self) -> tuple[EndKeys, EndKeys]:
        """Connections of the upper and the lower end."""
        return self.top, self.bottom


def stand_in_anchor(index: int, item: int) -> Piece:
    """Create a substitute anchor without height and of practically unlimited weight.

    Parameters
    ----------
    index : index of the anchor in the line
    item : index of the line item of the anchor in the file
    """
    component = Anchor.model_validate({"kind": "anchor", "weight": "1e6 kN"})
    return Piece(index, STAND_IN, "anchor", component, 0.0, None, (), 0, 0, Place(item))


def read_legs(
    top: SourceMapping, reader: LineReader, position: Position | None
) -> tuple[tuple[FileLeg, ...], tuple[Piece, ...]]:
    """Read the legs of a file. Return the legs, and the pieces of all legs in file order.

    Parameters
    ----------
    position : geographic position of the origin, needed for ends given by latitude and longitude
    """
    if "line" in top.data:
        message = "`line` and `legs` exclude each other; give the line as a leg"
        top.refuse(("line",), message, key=True)
    if "tow" in top.data:
        top.refuse(("tow",), "a tow has no `legs`", key=True)
    found = top.data["legs"]
    if not isinstance(found, dict) or not found:
        top.refuse(("legs",), "`legs` must contain legs by name, each with its `line`")
        return (), ()
    if len(found) > MOST_LEGS:
        top.refuse(("legs",), f"more than {MOST_LEGS} legs", key=True)
        return (), ()
    legs: list[FileLeg] = []
    pieces: list[Piece] = []
    section, whole, items = top.child("legs"), True, 0
    for name in found:
        if not isinstance(found[name], dict):
            section.refuse((name,), f"leg `{name}` must have a `line`")
            whole = False
            continue
        own = section.child(name)
        keys = validate(LegKeys, own, context={"position": position})
        before, first = len(top.problems), len(pieces)
        if isinstance(own.data.get("line"), list):
            read = reader.read(own, "line")
            for piece in read:  # places also count the items of preceding legs
                place = replace(piece.place, item=piece.place.item + items)
                pieces.append(placed(piece, place))
            items += len(own.data["line"])
        if keys is None:
            whole = False
            continue
        ends = keys.top, keys.bottom or FREE
        if len(top.problems) == before:
            ends = _ends(keys, own, pieces[first:])
        legs.append(FileLeg(str(name), first, len(pieces), *ends))
    if whole:
        _check_net(legs, top)
    return tuple(legs), numbered(pieces)


def _ends(keys: LegKeys, own: SourceMapping, pieces: Sequence[Piece]) -> tuple[EndKeys, EndKeys]:
    def refuse(place: tuple[str | int, ...], message: str) -> None:
        own.refuse(place, message, key=bool(place))

    ends = []
    for name, end in (("top", keys.top), ("bottom", keys.bottom)):
        end = FREE if end is None else end
        given = sorted(end.model_fields_set)
        if len(given) != 1 and name in own.data and own.data[name] != "free":
            each = " and ".join(f"`{one}`" for one in given) or "nothing"
            refuse(
                (name,),
                f"`{name}` has {each}; it must have exactly one of `join`, `anchor` and `held`",
            )
        ends.append(end)
    upper, lower = ends
    anchors = [piece for piece in pieces if isinstance(piece.component, Anchor)]
    anchored = bool(anchors) and anchors[-1] is pieces[-1]
    if upper.anchor is not None:
        refuse(
            ("top",),
            "the upper end of a leg cannot be an anchor; list the leg in the opposite order",
        )
    for anchor in anchors[: len(anchors) - anchored]:
        message = f"anchor `{anchor.use}` must be the last item of its leg"
        own.refuse_at(anchor.line, anchor.column, message)
    if anchored and keys.bottom is None:
        lower = EndKeys(anchor=AnchoredKeys())
    elif anchored and lower.anchor is None:
        refuse(("bottom",), "the leg ends in an anchor; `bottom` must be `{anchor: …}`")
    elif lower.anchor is not None and not anchors:
        refuse(("bottom",), "the leg has no anchor; its last item must be one (`kind: anchor`)")
    elif keys.bottom is None:
        refuse((), "`bottom` is missing: `{join: NODE}`, `free`, or an anchor as the last item")
    if len(anchors) == len(pieces) > 0:
        refuse(("line",), "a line needs at least one piece above its anchor")
    if upper.join is not None and upper.join == lower.join:
        refuse(("bottom",), f"the two ends of a leg must not join at the same node, `{upper.join}`")
    if upper == lower == FREE and (keys.bottom is not None or not anchored):
        refuse(("bottom",), "both ends are free; join one end to another leg, or hold it")
    for piece in pieces:
        here = piece.line, piece.column
        if piece.length is None:
            own.refuse_at(*here, "a piece of a net cannot be cut to fit; give its length")
        if any(isinstance(clamp.component, Profiler) for clamp in piece.clamps):
            own.refuse_at(*here, "a net cannot contain a profiler")
    return upper, lower


def check_held_depths(legs: Sequence[FileLeg], top: SourceMapping, depth: float | None) -> None:
    """Check that held ends are above the seabed."""
    for leg in legs:
        for name, end in zip(("top", "bottom"), leg.ends, strict=True):
            if end.held is not None and depth is not None and end.held.depth >= depth:
                message = f"`depth` must be above the seabed, which is {depth:g} m deep"
                top.refuse(("legs", leg.name, name, "held", "depth"), message)


def _check_net(legs: Sequence[FileLeg], top: SourceMapping) -> None:
    section = top.child("legs")
    joins = [
        (leg, name, end.join)
        for leg in legs
        for name, end in zip(("top", "bottom"), leg.ends, strict=True)
        if end.join is not None
    ]
    known = top.data.get("nodes")
    if known is not None and not isinstance(known, dict):
        top.refuse(("nodes",), "`nodes` must name nodes: `nodes: {A: {}}`")
        known = None
    meeting = [join for *_, join in joins]
    for leg, end, join in joins:
        place = (leg.name, end, "join")
        if known is not None and join not in known:
            section.refuse(place, unknown(f"no node is called `{join}`", join, known))
        elif meeting.count(join) == 1:
            others = dict.fromkeys(other for other in meeting if other != join)
            section.refuse(place, unknown(f"no other leg joins at `{join}`", join, others))
    for name, keys in (known or {}).items():
        if keys:
            top.refuse(("nodes", name), "a node must not have keys; write `A: {}`")
        if name not in meeting:
            top.refuse(("nodes", name), f"no leg joins at node `{name}`", key=True)
    if not top.problems:
        _check_held(legs, section)


def _check_held(legs: Sequence[FileLeg], section: SourceMapping) -> None:
    """Check that every leg is connected to an anchor or a held end, directly or by other legs."""
    held: set[str] = set()
    reached: set[str | None] = set()
    while True:
        more = {
            leg.name
            for leg in legs
            if any(end.anchor or end.held or end.join in reached for end in leg.ends)
        }
        reached |= {end.join for leg in legs if leg.name in more for end in leg.ends} - {None}
        if more == held:
            break
        held = more
    # two anchors may share a position only if the file specifies both positions
    stand: dict[tuple[float, float], str] = {}
    for leg in legs:
        anchor = leg.bottom.anchor
        before = leg.name if anchor is None else stand.setdefault(anchor.at, leg.name)
        if anchor is not None and before != leg.name and "at" not in anchor.model_fields_set:
            message = (
                f"the anchor is at the position of the anchor of leg `{before}`; set another "
                "position: `bottom: {anchor: {at: [30 m, 0 m]}}`"
            )
            section.refuse((leg.name,), message, key=True)
        if leg.name not in held:
            message = f"leg `{leg.name}` is connected to no anchor and no held end"
            section.refuse((leg.name,), message, key=True)


def nodes_of(legs: Sequence[FileLeg]) -> Mapping[str, int]:
    """Number the nodes in the order in which the legs name them; return the numbers by name."""
    names = dict.fromkeys(end.join for leg in legs for end in leg.ends if end.join is not None)
    return {name: number for number, name in enumerate(names)}
