"""A mooring file as read: the expanded line, its environment and settings, in SI and degrees."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator

from calm.errors import UsageError
from calm.files.check_limits import Accept, Checks, LimitKey
from calm.files.components import Anchor
from calm.files.definition import LENGTH, Model, QuantityField, described, optional
from calm.files.environment import Environment, Position
from calm.files.legs import (
    ANCHORED,
    FREE,
    ONE_LEG_ONLY,
    EndKeys,
    FileLeg,
    HeldKeys,
    stand_in_anchor,
)
from calm.files.logbook import Deployed, DocumentKeys, ReleaseKeys
from calm.files.pieces import Piece, parts_of
from calm.files.strumming_keys import Strumming
from calm.files.uncertainty import Uncertainty
from calm.files.yaml_document import SourceMapping


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
    legs: tuple[FileLeg, ...] = ()

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

    def leg_alone(self, leg: FileLeg) -> MooringFile:
        """Return a leg as the file of a single line: its pieces, counted from its upper end.

        One of several without an anchor has a stand-in for it, of the id `STAND_IN`.
        """
        if not self.legs:
            return self
        own = self.pieces[leg.first : leg.end]
        pieces = [replace(piece, index=index) for index, piece in enumerate(own)]
        if leg.bottom.anchor is None:
            pieces.append(stand_in_anchor(len(pieces), own[-1].place.item + 1))
        environment, anchor = self.environment, leg.bottom.anchor
        if anchor is not None and anchor.depth is not None:
            environment = replace(environment, depth=anchor.depth)
        elif anchor is not None and environment.seabed is not None and environment.depth:
            deeper = float(environment.seabed.deeper(np.array([anchor.at]))[0])
            environment = replace(environment, depth=environment.depth + deeper)
        if anchor is not None and environment.seabed is not None:
            environment = replace(environment, seabed=environment.seabed.at(*anchor.at))
        return replace(
            self,
            name=leg.name,
            environment=environment,
            pieces=tuple(pieces),
            legs=(leg,),
            notices=(),
        )


def unknown_releases(
    releases: Sequence[ReleaseKeys], pieces: Sequence[Piece], deployed: Deployed | None
) -> list[str]:
    """Note the releases whose serial number nothing in the line has, designed or deployed."""
    parts = [part for part in parts_of(pieces) if part.component.role == "release"]
    designed = {part.label: part.serial for part in parts}
    items = () if deployed is None else deployed.items
    serials = {*designed.values(), *(one.serial for one in items if one.label in designed)}
    return [
        f"`releases`: no release of the line has the serial number {release.serial}."
        for release in releases
        if serials != {None} and release.serial is not None and release.serial not in serials
    ]


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


def legs_of(file: MooringFile) -> tuple[FileLeg, ...]:
    """Legs of a file; a file without `legs` has one.

    The leg of a mooring is free above and anchored below, the leg of a tow is held at the ship.
    """
    if file.legs:
        return file.legs
    ends = FREE, ANCHORED
    if file.tow is not None:
        ship = HeldKeys.model_construct(depth=-file.tow.height, at=(0.0, 0.0))
        ends = EndKeys(held=ship), FREE
    return (FileLeg(file.name, 0, len(file.pieces), *ends),)


def leg_numbers(file: MooringFile) -> list[int]:
    """Return the number of the leg that each piece of a file is in."""
    return [n for n, leg in enumerate(legs_of(file)) for _ in range(leg.first, leg.end)]


def refuse_several(file: MooringFile) -> None:
    """Reject a file of legs for uses of a single line: UsageError."""
    if file.legs:
        raise UsageError(f"{file.path}: {ONE_LEG_ONLY}")


def refuse_tow(file: MooringFile) -> None:
    """Reject a tow for uses of a mooring: UsageError."""
    if file.tow is not None:
        raise UsageError(f"{file.path} is a tow; this is for moorings")


def refuse_all_but_moorings(file: MooringFile) -> None:
    """Reject tows and files of legs for uses of a single mooring: UsageError."""
    refuse_several(file)
    refuse_tow(file)
