"""A mooring file as read: the expanded line, its environment and settings, in SI and degrees.

Every piece and clamp has its own place in the line, and a label that no other has.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Literal, Protocol

from pydantic import AfterValidator

from calm.errors import unknown
from calm.files.check_limits import Accept, Checks, LimitKey
from calm.files.components import Anchor, Component
from calm.files.definition import LENGTH, Model, QuantityField, described, optional
from calm.files.environment import Environment, Position
from calm.files.logbook import NO_EQUIPMENT, Deployed, DocumentKeys, Equipment, ReleaseKeys
from calm.files.rigid import Profiler
from calm.files.strumming_keys import Strumming
from calm.files.uncertainty import Uncertainty
from calm.files.yaml_document import SourceMapping

if TYPE_CHECKING:
    from calm.files.legs import Leg


STAND_IN = ""
"""Id of what holds a line whose anchor is yet to be chosen, or a leg that has none."""


class TowKeys(Model):
    """A tow: speed over ground [m/s], course [degrees], height of the tow point [m]."""

    speed: Annotated[float, QuantityField("speed", above=0)] = described(
        "of the ship over the ground", "0.5 m/s"
    )
    toward: Annotated[float, QuantityField("angle")] = described(
        "course, clockwise from north", "90 deg"
    )
    height: Annotated[float, LENGTH] = described(
        "of the tow point above the water, e.g. 4 m", "4 m", default=0.0
    )


class Solver(Model):
    """Settings of the solver: `angle_step` in radians, `tolerance` as a share of the depth."""

    angle_step: Annotated[
        float, QuantityField("angle", above=0, at_most=10), AfterValidator(math.radians)
    ] = described(
        "how much a cable may turn from one segment to the next, e.g. 1 deg",
        "1 deg",
        default=math.radians(1),
    )
    tolerance: Annotated[float, QuantityField("number", above=0, at_most=2e-4)] = described(
        "of the depth of the anchor, as a share of the water depth", 1e-07, default=1e-7
    )
    drag: Literal["constant", "reynolds"] = described(
        "constant coefficients, or by Reynolds number for what is `surface: smooth`",
        "reynolds",
        default="constant",
    )
    friction: Literal["berteaux", "hoerner", "constant"] = described(
        "law of friction along cables", "berteaux", default="berteaux"
    )
    strumming: Strumming = optional("how much vibration raises the Cn of cables", {"factor": 1.5})
    buoy_drag: Literal["immersed", "full"] = described(
        "of a float at the surface: at its draft, or fully immersed", "immersed", default="immersed"
    )
    seabed_friction: Annotated[float, QuantityField("number", at_least=0)] = described(
        "of line that lies on the seabed", 0.3, default=0.0
    )


@dataclass(frozen=True, order=True)
class Place:
    """Hold where a piece or a clamp stands in the line as read, by which it is known from there on.

    A row of the file is the place of what it gives: `Place(3)` its fourth item, whatever the count
    of that, `Place(3, clamp=0)` the first clamp of it.

    Attributes
    ----------
    item : of the `line:` of the file, from 0
    repeat : which of the `count` of the item, from 0
    part : which piece of an assembly, from 0; -1 where the item is a component
    clamp : which clamp of the piece, from 0; -1 where the piece itself is meant
    """

    item: int
    repeat: int = 0
    part: int = -1
    clamp: int = -1

    @property
    def is_clamp(self) -> bool:
        """Return whether it is that of a clamp."""
        return self.clamp >= 0

    @property
    def row(self) -> Place:
        """Return the row of the file that gives it: of what stands in an assembly, its item."""
        return Place(self.item) if self.part >= 0 else Place(self.item, clamp=self.clamp)


class LinePart(Protocol):
    """Represent a piece or a clamp, or what was found for one."""

    @property
    def place(self) -> Place:
        """Return which one it is."""

    @property
    def label(self) -> str:
        """Return what people call it."""


@dataclass(frozen=True)
class Clamp:
    """Represent an instrument fixed to a piece, `at` metres (unstretched) from the piece's top.

    A profiler travels over `travel`, the same distance of its upper and its lower stop; inf is the
    end of the piece. It is taken to be `at` its upper one.
    """

    use: str
    label: str
    component: Component
    at: float
    place: Place
    equipment: Equipment = NO_EQUIPMENT
    travel: tuple[float, float] | None = None

    @property
    def serial(self) -> str | None:
        """Return the serial number of this instrument, where the file gives it."""
        return _serial(self.equipment)

    @property
    def planned_depth(self) -> float | None:
        """Depth it is planned to hang at in still water [m]; None without a plan."""
        return self.equipment.planned_depth


@dataclass(frozen=True)
class Piece:
    """Represent one piece of the expanded line.

    Attributes
    ----------
    index : position in the line, 0 at the top (in a tow, at the ship)
    use, label : id of the component; the label is unique in the line
    component : its definition with the overrides of the line applied
    length : unstretched length [m]; None where it is to be cut to fit
    fit_top_depth : depth wanted for the top of the line in still water [m], on the piece cut to fit
    clamps : tuple of Clamp
    line, column : the item in the mooring file, counted from 1
    place : Place
    fit_body_depth : depth wanted for the lower end of the piece at the tow's speed [m], where it is
        cut to fit
    equipment : what the file says of this individual piece
    measured_load : load under which its length is measured [N], `length` being without load all the
        same
    """

    index: int
    use: str
    label: str
    component: Component
    length: float | None
    fit_top_depth: float | None
    clamps: tuple[Clamp, ...]
    line: int
    column: int
    place: Place
    fit_body_depth: float | None = None
    equipment: Equipment = NO_EQUIPMENT
    measured_load: float = 0.0

    @property
    def serial(self) -> str | None:
        """Return the serial number of this piece, where the file gives it."""
        return _serial(self.equipment)

    @property
    def planned_depth(self) -> float | None:
        """Depth its upper end is planned to hang at in still water [m]; None without a plan."""
        return self.equipment.planned_depth

    def with_clamps(self, changed: Callable[[Clamp], Clamp], **own: Any) -> Piece:
        """Return the piece with each of its clamps changed, and with other fields of its own."""
        return replace(self, clamps=tuple(map(changed, self.clamps)), **own)


def _serial(equipment: Equipment) -> str | None:
    assert not isinstance(equipment.serial, tuple)  # one was chosen as the item was expanded
    return equipment.serial


@dataclass(frozen=True)
class MooringFile:
    """Hold a mooring file with everything in it resolved.

    `pieces` lead from the top of a mooring to its anchor; in a tow, where `tow` is not None, from
    the ship to the towed body. `notices` say what a person may want to know: a catalogue entry
    hidden by a nearer one, levels dropped from a measured current. `variants` are the environments
    it gives besides its own, by name, as they are written, `accepts` what it accepts of the design
    check, `uncertainty` how uncertain its inputs are, `looser` the limits of components that its
    line sets beyond those of their definitions. `document` is what its title block says, `releases`
    the codes of the releases, `deployed` what went over the side, `units` those in which people
    read it. A net has `legs`, whose pieces follow one another.
    """

    path: str
    name: str
    description: str
    position: Position | None
    tow: TowKeys | None
    environment: Environment
    pieces: tuple[Piece, ...]
    solver: Solver
    checks: Checks
    notices: tuple[str, ...]
    variants: Mapping[str, Any] = field(default_factory=dict, hash=False)
    accepts: tuple[Accept, ...] = ()
    uncertainty: Uncertainty = field(default_factory=Uncertainty)
    looser: tuple[LimitKey, ...] = ()
    document: DocumentKeys | None = None
    releases: tuple[ReleaseKeys, ...] = field(default=(), hash=False)
    deployed: Deployed | None = None
    units: Mapping[str, str] = field(default_factory=dict, hash=False)
    legs: tuple[Leg, ...] = ()

    def __repr__(self) -> str:
        """Return its name, where it is, and how many pieces it has."""
        return f"MooringFile({self.path!r}, {self.name!r}, {len(self.pieces)} pieces)"

    @property
    def release(self) -> int | None:
        """Return the index of the lowest release in line, or None: what is above it comes up."""
        releases = [piece.index for piece in self.pieces if piece.component.role == "release"]
        return releases[-1] if releases else None

    @property
    def anchor(self) -> Anchor:
        """Return the last piece of a mooring's line."""
        anchor = self.pieces[-1].component
        assert isinstance(anchor, Anchor)
        return anchor

    @property
    def anchor_friction(self) -> float:
        """Return the friction of the anchor on the bed: its own, or that of the checks.

        On a slope b a weight w that H pulls down holds as long as H cos b + w sin b <= friction (w
        cos b - H sin b): by tan(arctan(friction) - b), the worst of all directions.
        """
        own, seabed = self.anchor.friction, self.environment.seabed
        friction = self.checks.anchor_friction if own is None else own
        if seabed is None or not seabed.slope:
            return friction
        return math.tan(math.atan(friction) - math.radians(seabed.slope))


def placed(piece: Piece, place: Place) -> Piece:
    """Put a piece, with its clamps and the serial numbers there, at a place of the line."""

    def moved(clamp: Clamp) -> Clamp:
        own = replace(place, clamp=clamp.place.clamp)
        return replace(clamp, place=own, equipment=clamp.equipment.of(place.repeat))

    return piece.with_clamps(moved, place=place, equipment=piece.equipment.of(place.repeat))


def unplanned(piece: Piece) -> Piece:
    """Take the planned depths from a piece and its clamps."""

    def without(clamp: Clamp) -> Clamp:
        return replace(clamp, equipment=clamp.equipment.planned_for(None))

    return piece.with_clamps(without, equipment=piece.equipment.planned_for(None))


def numbered(pieces: Iterable[Piece]) -> tuple[Piece, ...]:
    """Give the pieces their index, and number labels that occur more than once down the line."""
    pieces = tuple(pieces)
    labels = iter(numbered_labels(labels_of(pieces)))

    def relabelled(clamp: Clamp) -> Clamp:
        return replace(clamp, label=next(labels))

    return tuple(
        piece.with_clamps(relabelled, index=index, label=next(labels))
        for index, piece in enumerate(pieces)
    )


def numbered_labels(texts: Sequence[str]) -> list[str]:
    """Number labels that occur more than once down a line, clamps below their piece."""
    total, seen = Counter(texts), Counter[str]()

    def numbered_label(text: str) -> str:
        if total[text] == 1:
            return text
        seen[text] += 1
        while f"{text} {seen[text]}" in total:
            seen[text] += 1
        return f"{text} {seen[text]}"

    return [numbered_label(text) for text in texts]


def parts_of(pieces: Iterable[Piece]) -> list[Piece | Clamp]:
    """Every piece of a line, each with its clamps after it."""
    parts: list[Piece | Clamp] = []
    for piece in pieces:
        parts += (piece, *piece.clamps)
    return parts


def clamps_in(pieces: Iterable[Piece]) -> list[Clamp]:
    """List the clamps of a line in the order of the file, which is that of the solver."""
    return [clamp for piece in pieces for clamp in piece.clamps]


def clamps_down(pieces: Iterable[Piece]) -> list[Clamp]:
    """List the clamps of a mooring's line from its top to its anchor, the order of its results."""
    return [clamp for piece in pieces for clamp in sorted(piece.clamps, key=lambda clamp: clamp.at)]


def labels_of(pieces: Iterable[Piece]) -> list[str]:
    """Return the labels of pieces and clamps, down the line."""
    return [part.label for part in parts_of(pieces)]


def unknown_releases(
    releases: Sequence[ReleaseKeys], pieces: Sequence[Piece], deployed: Deployed | None
) -> list[str]:
    """Note the releases whose serial number nothing in the line has, designed or deployed."""
    parts = [part for part in parts_of(pieces) if part.component.role == "release"]
    designed = {part.label: part.serial for part in parts}
    items = () if deployed is None else deployed.items
    serials = {*designed.values(), *(one.serial for one in items if one.label in designed)}
    return [
        f"`releases`: no release of the line has the serial number {release.serial}"
        for release in releases
        if serials != {None} and release.serial is not None and release.serial not in serials
    ]


def travelling(pieces: Sequence[Piece], top: SourceMapping) -> tuple[Piece, ...]:
    """Give each profiler the way that it travels, by the labels of its stops."""
    return tuple(piece.with_clamps(partial(_travelling, piece, pieces, top)) for piece in pieces)


def _travelling(piece: Piece, pieces: Sequence[Piece], top: SourceMapping, clamp: Clamp) -> Clamp:
    if not isinstance(clamp.component, Profiler):
        return clamp
    stops = {each.label: 0.0 if each.index < piece.index else math.inf for each in pieces}
    del stops[piece.label]
    stops |= {each.label: each.at for each in piece.clamps if each.travel is None}
    stops.pop(clamp.label, None)
    between = clamp.component.between or ()
    place, lacks = clamp.place, "" if between else f"no stops of {clamp.label}"
    row = ("line", place.item, *(() if place.part >= 0 else ("clamps", place.clamp)))
    messages = [] if between else ["a profiler needs `between: [upper stop, lower stop]`"]
    messages += [
        unknown(f"`{label}` is no stop on `{piece.label}`, nor a piece beside it", label, stops)
        for label in between
        if label not in stops
    ]
    if not messages and between and not stops[between[0]] < stops[between[1]]:
        messages = [f"`{between[0]}` is not above `{between[1]}`: give the upper stop first"]
    for message in messages:
        top.refuse(row, message, lacks=lacks)
    if messages or not between:
        return clamp
    upper, lower = (stops[label] for label in between)
    return replace(clamp, at=upper, travel=(upper, lower))


def check_one_fit(pieces: Sequence[Piece], top: SourceMapping) -> None:
    """Check that one piece at most is to be cut to fit."""
    fits = [piece for piece in pieces if piece.length is None]
    for piece in fits[1:]:
        message = f"only one piece can be cut to fit; line {fits[0].line} has one already"
        top.refuse_at(piece.line, piece.column, message)


def check_fit(
    pieces: Sequence[Piece], seabed: float | None, tow: TowKeys | None, top: SourceMapping
) -> None:
    """Check that the depth to reach lies above the seabed, and below the ship."""
    for piece in pieces:
        here = piece.line, piece.column
        for key, depth in (("top", piece.fit_top_depth), ("body", piece.fit_body_depth)):
            if depth is not None and seabed is not None and depth >= seabed:
                top.refuse_at(*here, f"`{key}_depth` is below the seabed, {seabed:g} m deep")
        if tow and piece.fit_body_depth is not None and piece.fit_body_depth <= -tow.height:
            message = f"`body_depth` is not below the tow point, {tow.height:g} m above the water"
            top.refuse_at(*here, message)
