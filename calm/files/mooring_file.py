"""Validated mooring file: expanded line, environment and settings, in SI units and degrees."""

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
    """A tow: speed over ground [m/s], course [degrees], and height of the tow point [m]."""

    speed: Annotated[float, QuantityField("speed", above=0)] = described(
        "speed of the ship over ground", "0.5 m/s"
    )
    toward: Annotated[float, QuantityField("angle")] = described(
        "course, clockwise from north", "90 deg"
    )
    height: Annotated[float, LENGTH] = described(
        "height of the tow point above the water, e.g. 4 m", "4 m", default=0.0
    )


class Solver(Model):
    """Solver settings; after the file is read, `angle_step` is in radians."""

    angle_step: Annotated[
        float, QuantityField("angle", above=0, at_most=10), AfterValidator(math.radians)
    ] = described(
        "maximum change of direction from one segment to the next, e.g. 1 deg",
        "1 deg",
        default=math.radians(1),
    )
    tolerance: Annotated[float, QuantityField("number", above=0, at_most=2e-4)] = described(
        "tolerance of the anchor's depth, as a share of the water depth", 1e-07, default=1e-7
    )
    drag: Literal["constant", "reynolds"] = described(
        "drag coefficients: constant, or a function of the Reynolds number for parts with "
        "`surface: smooth`",
        "reynolds",
        default="constant",
    )
    friction: Literal["berteaux", "hoerner", "constant"] = described(
        "law of friction along cables", "berteaux", default="berteaux"
    )
    strumming: Strumming = optional(
        "increase of the Cn of cables due to vibration", {"factor": 1.5}
    )
    buoy_drag: Literal["immersed", "full"] = described(
        "drag of a surface float: at its draft, or fully immersed", "immersed", default="immersed"
    )
    seabed_friction: Annotated[float, QuantityField("number", at_least=0)] = described(
        "friction coefficient of the line on the seabed", 0.3, default=0.0
    )


@dataclass(frozen=True)
class MooringFile:
    """A mooring file in which all references are resolved.

    Attributes
    ----------
    tow : tow settings; None for a mooring
    pieces : pieces from top to anchor, or in a tow from ship to towed body; with `legs`, leg by leg
    checks : limits of the design check
    notices : remarks for the user, such as discarded levels of a measured current
    variants : named environments before validation
    accepts : accepted findings of the design check
    looser : overrides in the line that make a limit less strict than in the component definition
    document : title block
    units : display units by dimension
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
        return f"MooringFile({self.path!r}, {self.name!r}, {len(self.pieces)} pieces)"

    @property
    def release(self) -> int | None:
        """Index of the lowest release in the line; None if there is no release."""
        releases = [piece.index for piece in self.pieces if piece.component.role == "release"]
        return releases[-1] if releases else None

    @property
    def anchor(self) -> Anchor:
        """Component that defines the anchor, which is the last piece of a mooring."""
        anchor = self.pieces[-1].component
        assert isinstance(anchor, Anchor)
        return anchor

    @property
    def anchor_friction(self) -> float:
        """Friction coefficient that would hold the anchor equally well on a level seabed.

        With the weight w and the friction coefficient µ, an anchor on the slope b holds a downhill
        load H if H cos b + w sin b <= µ (w cos b - H sin b). On a level seabed, the equivalent
        coefficient is tan(arctan(µ) - b).
        """
        own, seabed = self.anchor.friction, self.environment.seabed
        friction = self.checks.anchor_friction if own is None else own
        if seabed is None or not seabed.slope:
            return friction
        return math.tan(math.atan(friction) - math.radians(seabed.slope))

    def leg_alone(self, leg: FileLeg) -> MooringFile:
        """Return a copy of the file with a single leg, whose first piece has the index 0.

        A leg without an anchor gets a substitute anchor with the id `STAND_IN`.
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
    """Return a note for each entry in `releases` whose serial number matches no release."""
    parts = [part for part in parts_of(pieces) if part.component.role == "release"]
    given = {} if deployed is None else deployed.serials
    serials = {one for part in parts for one in (*part.serials, *given.get(part.label, ()))}
    return [
        f"`releases`: no release of the line has the serial number {release.serial}."
        for release in releases
        if serials and release.serial is not None and release.serial not in serials
    ]


def check_fit(
    pieces: Sequence[Piece], seabed: float | None, tow: TowKeys | None, top: SourceMapping
) -> None:
    """Check that the target depth of a fitted piece is above the seabed and below the tow point."""
    for piece in pieces:
        here = piece.line, piece.column
        for key, depth in (("top", piece.fit_top_depth), ("body", piece.fit_body_depth)):
            if depth is not None and seabed is not None and depth >= seabed:
                top.refuse_at(
                    *here, f"`{key}_depth` must not be below the seabed, which is {seabed:g} m deep"
                )
        if tow and piece.fit_body_depth is not None and piece.fit_body_depth <= -tow.height:
            message = (
                f"`body_depth` must be below the tow point, which is {tow.height:g} "
                "m above the water"
            )
            top.refuse_at(*here, message)


def legs_of(file: MooringFile) -> tuple[FileLeg, ...]:
    """Return the legs of a file; without the key `legs`, the whole line is one leg.

    The lower end of a single mooring line is anchored. In a tow, the ship holds the upper end.
    """
    if file.legs:
        return file.legs
    ends = FREE, ANCHORED
    if file.tow is not None:
        ship = HeldKeys.model_construct(depth=-file.tow.height, at=(0.0, 0.0))
        ends = EndKeys(held=ship), FREE
    return (FileLeg(file.name, 0, len(file.pieces), *ends),)


def leg_numbers(file: MooringFile) -> list[int]:
    """Return for each piece the number of its leg, counted from 0."""
    return [n for n, leg in enumerate(legs_of(file)) for _ in range(leg.first, leg.end)]


def refuse_several(file: MooringFile) -> None:
    """Raise UsageError if a file has `legs`."""
    if file.legs:
        raise UsageError(f"{file.path}: {ONE_LEG_ONLY}")


def refuse_tow(file: MooringFile) -> None:
    """Raise UsageError if a file is a tow."""
    if file.tow is not None:
        raise UsageError(f"{file.path} is a tow; only a mooring can be used here")


def refuse_all_but_moorings(file: MooringFile) -> None:
    """Raise UsageError if a file is a tow or has `legs`."""
    refuse_several(file)
    refuse_tow(file)
