"""A mooring file as read: the expanded line, its environment and settings, in SI and degrees."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from calm.files.components import Anchor, Component
from calm.files.environment import Environment
from calm.files.fields import LENGTH, POSITIVE_LENGTH, Model, Quantity
from calm.files.strumming import Strumming

_FACTOR = Quantity("number", above=0)
_SHARE = Quantity("number", at_least=0, at_most=1)
_SPEED = Quantity("speed", at_least=0)
_LEAST_TENSION = Quantity("force", at_least=0)


class Position(Model):
    """Where the mooring stands [degrees]."""

    latitude: Annotated[float, Quantity("angle", at_least=-90, at_most=90)]
    longitude: Annotated[float, Quantity("angle", at_least=-360, at_most=360)]


class TowKeys(Model):
    """What tows the line: speed over ground [m/s], where to [degrees], height above water [m]."""

    speed: Annotated[float, Quantity("speed", above=0)]
    toward: Annotated[float, Quantity("angle")]
    height: Annotated[float, LENGTH] = 0.0


class Solver(Model):
    """How the line is solved; `angle_step` in radians, `tolerance` as a share of the depth."""

    angle_step: Annotated[
        float, Quantity("angle", above=0, at_most=10), AfterValidator(math.radians)
    ] = math.radians(1)
    tolerance: Annotated[float, Quantity("number", above=0, at_most=2e-4)] = 1e-7
    drag: Literal["constant", "reynolds"] = "constant"
    friction: Literal["berteaux", "hoerner", "constant"] = "berteaux"
    strumming: Strumming = None
    buoy_drag: Literal["immersed", "full"] = "immersed"
    seabed_friction: Annotated[float, Quantity("number", at_least=0)] = 0.0


class SafetyFactors(Model):
    """Least breaking load over tension, where no working load is known."""

    steel: Annotated[float, _FACTOR] = 3.0
    synthetic: Annotated[float, _FACTOR] = 5.0
    surface: Annotated[float, _FACTOR] = 5.0


class MinimumTensions(Model):
    """Least tension above the release [N]."""

    wire: Annotated[float, _LEAST_TENSION] = 500.0
    rope: Annotated[float, _LEAST_TENSION] = 300.0


class Checks(Model):
    """Limits of the design check; a limit without a default is judged only when given."""

    safety_factor: SafetyFactors = Field(default_factory=SafetyFactors)
    anchor_factor: Annotated[float, _FACTOR] = 1.5
    anchor_friction: Annotated[float, _FACTOR] = 0.6
    minimum_tension: MinimumTensions = Field(default_factory=MinimumTensions)
    backup_margin: Annotated[float, _SHARE] = 0.1
    minimum_rise_speed: Annotated[float, _SPEED] = 0.3
    launch_safety_factor: Annotated[float, _FACTOR] = 2.0
    launch_working_factor: Annotated[float, _FACTOR] = 1.0
    minimum_reserve: Annotated[float, _SHARE] = 0.3
    rating_margin: Annotated[float, LENGTH] = 100.0
    maximum_knockdown: Annotated[float | None, POSITIVE_LENGTH] = None
    maximum_excursion: Annotated[float | None, POSITIVE_LENGTH] = None
    maximum_tilt: Annotated[float | None, Quantity("angle", above=0, at_most=180)] = None


@dataclass(frozen=True)
class Clamp:
    """An instrument fixed to a piece, `at` metres (unstretched) from the piece's top."""

    use: str
    label: str
    component: Component
    at: float


@dataclass(frozen=True)
class Piece:
    """One piece of the expanded line.

    Attributes
    ----------
    index : int
        Position in the line, 0 at the top (in a tow, at the ship).
    use, label : str
        Id of the component; the label is unique in the line.
    component : Component
        Its definition with the overrides of the line applied.
    length : float or None
        Unstretched length [m]; None where it is to be cut to fit.
    fit_top_depth : float or None
        Depth wanted for the top of the line in still water [m], on the piece cut to fit.
    clamps : tuple of Clamp
    line, column : int
        The item in the mooring file, counted from 1.
    fit_body_depth : float or None
        Depth wanted for the lower end of the piece at the tow's speed [m], where it is cut to fit.
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
    fit_body_depth: float | None = None


@dataclass(frozen=True)
class MooringFile:
    """A mooring file with everything in it resolved.

    `pieces` lead from the top of a mooring to its anchor; in a tow, where `tow` is not None, from
    the ship to the towed body. `notices` tell what a person may want to know: a catalogue entry
    hidden by a nearer one, levels dropped from a measured current. `variants` are the names of
    the environments it gives besides its own.
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
    variants: tuple[str, ...] = ()

    @property
    def release(self) -> int | None:
        """Index of the lowest release in line, None without one: what is above it comes up."""
        releases = [piece.index for piece in self.pieces if piece.component.role == "release"]
        return releases[-1] if releases else None

    @property
    def anchor(self) -> Anchor:
        """The last piece of a mooring's line."""
        anchor = self.pieces[-1].component
        assert isinstance(anchor, Anchor)
        return anchor
