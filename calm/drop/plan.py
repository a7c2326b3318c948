"""The plan of an anchor drop: what a ship has to know before it lets the anchor go."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from calm.case import Mooring
from calm.drop.record import DepthReached, Moment, Path, Pull
from calm.files import Position
from calm.physics.ellipsoid import Frame

ASTRAY = 1e-3
"""Share of the depth by which the line may come to rest elsewhere than its equilibrium; beyond it
nothing of what comes after the touchdown is shown."""

BRIEF = 60.0
"""Fall time below which what is left out, inertia, shows in the figures [s]."""


@dataclass(frozen=True)
class DropPlan:
    """The drop of a mooring's anchor, the line streamed behind the ship, anchor last.

    Lengths and depths [m], times [s], speeds [m/s], forces [N], directions [degrees] clockwise
    from north. Distances are positive towards the float, which is where the line streams.

    Attributes
    ----------
    ship_speed, course : of the ship over the ground
    streamed : horizontal distance from the anchor to the free end when the anchor is let go
    astern : direction from the anchor to the free end then
    fall_time : until the anchor stands on the seabed
    fall_back : how far from where it was let go it lands, towards the float
    aside : how far it lands to the right of that direction, seen from where it was let go
    time_error, distance_error : of `fall_time` and of `fall_back`, `aside`: twice what steps of
        twice the length change and bars of twice the length do, together; of the time 0.05 % at
        least
    fall_time_band, fall_back_band : with the anchor's drag halved and doubled, the less first
    touchdown_speed : of the anchor as it meets the seabed
    greatest_tension : in the line, from letting go to the touchdown
    tow_past : how far along its course the ship tows beyond the target before it lets go
    run_in : how far before the target the run begins, with the float put out first
    run_time : from the float over the side to the anchor let go
    let_go, start : where the anchor is let go and where the run begins, east and north of the
        target
    anchor_drag : K of the anchor [N/(m/s)²]; `drag_known` is False where it is that of a cube,
        since the file gives none
    path, moments, depths, pulls : over time; shapes; of floats, instruments and releases, empty
        where the line comes to rest away from its equilibrium; of pieces
    rest_difference : farthest that a piece comes to rest from its place in the equilibrium; None
        where still water leaves the line slack, so that it has no single one
    """

    mooring: Mooring = field(repr=False)
    ship_speed: float
    course: float
    streamed: float
    astern: float
    fall_time: float
    fall_back: float
    aside: float
    time_error: float
    distance_error: float
    fall_time_band: tuple[float, float]
    fall_back_band: tuple[float, float]
    touchdown_speed: float
    greatest_tension: float
    tow_past: float
    run_in: float
    run_time: float
    let_go: tuple[float, float]
    start: tuple[float, float]
    anchor_drag: float
    drag_known: bool
    path: Path = field(repr=False)
    moments: tuple[Moment, ...] = field(repr=False)
    depths: tuple[DepthReached, ...] = field(repr=False)
    pulls: tuple[Pull, ...] = field(repr=False)
    rest_difference: float | None

    def position(self, place: tuple[float, float]) -> Position | None:
        """The position of a place east and north of the target [m]; None where the target has none.

        On WGS 84; by the tangent plane, within 1 m up to 10 km away.
        """
        target = self.mooring.file.position
        if target is None:
            return None
        frame = Frame(target.latitude, target.longitude)
        latitude, longitude, _ = frame.position(np.array([*place, 0.0]))
        return Position.model_construct(latitude=latitude, longitude=longitude)

    @property
    def beyond_rating(self) -> tuple[DepthReached, ...]:
        """What comes deeper in the drop than it is made for."""
        return tuple(each for each in self.depths if each.beyond)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What makes the plan less certain than it looks."""
        said = []
        if not self.drag_known:
            said.append(
                "The anchor gives no `kt`: its drag is taken to be that of a cube of its volume."
            )
        if self.rest_difference is None:
            said.append(
                "In still water the line is slack and has no single shape at rest: where it comes "
                "to rest is not compared with an equilibrium."
            )
        elif self.rest_difference > ASTRAY * self.mooring.water.depth:
            said.append(
                f"The line comes to rest {self.rest_difference:.2f} m from its equilibrium, more "
                "than a thousandth of the depth: the depths of instruments are not shown, and the "
                "fall is doubtful as well."
            )
        if self.fall_time < BRIEF:
            said.append(
                f"The fall takes {self.fall_time:.0f} s only: inertia, which is left out, may make "
                "it half a second longer and change the fall-back by a metre."
            )
        if self.mooring.line.strumming is not None:
            said.append("Strumming is left out: the drag of the cables is that at rest.")
        names = ", ".join(each.label for each in self.beyond_rating)
        if names:
            said.append(f"Deeper in the drop than their depth rating: {names}.")
        return tuple(said)

    def to_dict(self) -> dict[str, Any]:
        """The plan as JSON; figures in SI."""
        path = self.path
        let_go, start = self.position(self.let_go), self.position(self.start)
        return {
            "fall_time": self.fall_time,
            "fall_back": self.fall_back,
            "fall_back_band": list(self.fall_back_band),
            "touchdown_speed": self.touchdown_speed,
            "greatest_tension": self.greatest_tension,
            "tow_past": self.tow_past,
            "run_in": self.run_in,
            "path": {
                "time": path.time.tolist(),
                "anchor_depth": path.anchor_depth.tolist(),
                "anchor_x": path.anchor_x.tolist(),
                "float_x": path.float_x.tolist(),
                "anchor_speed": path.anchor_speed.tolist(),
                "float_depth": path.float_depth.tolist(),
                "anchor_tension": path.anchor_tension.tolist(),
            },
            "accuracy": {"fall_time": self.time_error, "fall_back": self.distance_error},
            "fall_time_band": list(self.fall_time_band),
            "aside": self.aside,
            "streamed": self.streamed,
            "ship_speed": self.ship_speed,
            "course": self.course,
            "astern": self.astern,
            "run_time": self.run_time,
            "let_go": list(self.let_go),
            "start": list(self.start),
            "let_go_position": None if let_go is None else let_go.model_dump(),
            "start_position": None if start is None else start.model_dump(),
            "anchor_drag": self.anchor_drag,
            "anchor_drag_known": self.drag_known,
            "rest_difference": self.rest_difference,
            "warnings": list(self.warnings),
            "depths": [
                {
                    "label": each.label,
                    "rest": each.rest,
                    "greatest": each.greatest,
                    "time": each.time,
                    "depth_rating": each.rating,
                }
                for each in self.depths
            ],
            "tensions": [
                {"label": each.part.label, "tension": each.tension, "time": each.time}
                for each in self.pulls
            ],
        }
