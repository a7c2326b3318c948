"""Plan of an anchor drop for use on board, from a mooring and a ship."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import cos, radians, sin
from typing import Any

import numpy as np

from calm.case import Design, Result
from calm.case.leg import Leg
from calm.drop import fall_record, launch
from calm.drop.fall import Fineness, Motion, fall, settle, towed
from calm.drop.fall_record import rest_difference
from calm.drop.motion import ChainState
from calm.errors import NoEquilibrium
from calm.files import Position
from calm.files.definition import in_si
from calm.physics.line import Floats
from calm.positions import Frame
from calm.quantities import bearing_of
from calm.solve import Status

REST_TOLERANCE = 1e-3
"""Largest allowed distance between the line at rest and its equilibrium, as a fraction of the
depth. Above this limit, results after the touchdown are not shown.
"""

SHORT_FALL = 60.0
"""Fall time below which the neglected inertia affects the results noticeably [s]."""


@dataclass(frozen=True)
class RunStart:
    """Start of the ship's run, where the first piece is deployed.

    Attributes
    ----------
    distance : distance to the target along the ship's course [m]; negative past the target
    time : time from the start to the release of the anchor [s]
    place : position of the start east and north of the target [m]
    """

    distance: float
    time: float
    place: tuple[float, float]


@dataclass(frozen=True)
class DropPlan:
    """Plan for dropping a mooring anchor last, with the line streamed behind the ship.

    Units are m, s, m/s, N, and degrees clockwise from north. Speed and course are over the ground,
    and positions are east and north of the target. The fall lasts from the release of the anchor to
    its touchdown.

    Attributes
    ----------
    streamed, astern : horizontal distance and direction from the anchor to the free end at the
        release
    fall_back, aside : horizontal distances from the release to the touchdown: `fall_back` towards
        the float, and `aside` to the right of this direction
    time_error : estimated numerical error of `fall_time`
    distance_error : estimated numerical error of `fall_back` and `aside`
    fall_time_band, fall_back_band : smallest and largest value if the anchor drag is between half
        and twice its value
    tow_past : distance of the release past the target, along the course
    let_go : position of the release
    deck_time : time to handle a piece on deck, by the role of the piece
    start : start of the ship's run; None without deck times
    anchor_drag : K of the drag K|V|V of the anchor [N/(m/s)²]
    drag_known : False if the anchor drag is assumed to be that of a cube
    path, moments, pulls : time series of the fall, shapes of the line, and maximum tensions in
        pieces
    depths : largest depths of floats and instruments; empty if the line settles away from its
        equilibrium
    rest_difference : largest distance between a piece's end at rest and its equilibrium position;
        None if the equilibrium is not unique (slack line)
    """

    mooring: Design = field(repr=False)
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
    let_go: tuple[float, float]
    deck_time: Mapping[str, float] | None
    start: RunStart | None
    anchor_drag: float
    drag_known: bool
    path: fall_record.FallPath = field(repr=False)
    moments: tuple[fall_record.ShapeInTime, ...] = field(repr=False)
    depths: tuple[fall_record.DepthReached, ...] = field(repr=False)
    pulls: tuple[fall_record.Pull, ...] = field(repr=False)
    rest_difference: float | None

    def position(self, place: tuple[float, float]) -> Position | None:
        """Return the geographic position of a point, given in m east and north of the target.

        The result is None if the position of the target is unknown. The position is accurate to 1 m
        within 10 km of the target (tangent plane of the WGS 84 ellipsoid).
        """
        target = self.mooring.file.position
        if target is None:
            return None
        frame = Frame(target.latitude, target.longitude)
        latitude, longitude, _ = frame.position(np.array([*place, 0.0]))
        return Position.model_construct(latitude=latitude, longitude=longitude)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings about the assumptions and the doubtful results of the plan."""
        texts = []
        if not self.drag_known:
            texts.append("The anchor has no `kt`; the drag of a cube of equal volume is assumed.")
        if self.rest_difference is None:
            texts.append(
                "In still water the line is slack and its shape is not unique, so the line at rest "
                "is not compared with an equilibrium."
            )
        elif self.rest_difference > REST_TOLERANCE * self.mooring.water.depth:
            texts.append(
                f"The line settles {self.rest_difference:.2f} m from its equilibrium, and the "
                "distance exceeds a thousandth of the depth. The depths of instruments are not "
                "shown, and the results of the fall are uncertain."
            )
        if self.fall_time < SHORT_FALL:
            texts.append(
                f"The fall takes only {self.fall_time:.0f} s. Inertia is neglected; inertia may "
                "add half a second and change the fall-back by a metre."
            )
        if self.mooring.line.strumming is not None:
            texts.append(
                "Strumming is neglected; cables have the drag of a cable that does not vibrate."
            )
        names = ", ".join(each.label for each in self.depths if each.beyond)
        if names:
            texts.append(f"Depth rating exceeded during the drop: {names}.")
        return tuple(texts)

    def to_dict(self) -> dict[str, Any]:
        """Return the plan as a JSON object, in SI units."""
        let_go, start = self.position(self.let_go), self.start
        first = None if start is None else self.position(start.place)
        return {
            **{name: getattr(self, name) for name in _AS_THEY_ARE},
            "fall_back_band": list(self.fall_back_band),
            "run_in": None if start is None else start.distance,
            "path": {name: column.tolist() for name, column in vars(self.path).items()},
            "accuracy": {"fall_time": self.time_error, "fall_back": self.distance_error},
            "fall_time_band": list(self.fall_time_band),
            "deck_time": _one_or_all(self.deck_time),
            "let_go": list(self.let_go),
            "start": None if start is None else {"distance": start.distance, "time": start.time},
            "let_go_position": None if let_go is None else let_go.model_dump(),
            "start_position": None if first is None else first.model_dump(),
            "anchor_drag_known": self.drag_known,
            "warnings": list(self.warnings),
            "depths": [
                {
                    "label": each.label,
                    "rest": each.rest,
                    "greatest": each.greatest,
                    "time": each.time,
                    "depth_rating": each.rating,
                    "beyond_rating": each.beyond,
                }
                for each in self.depths
            ],
            "tensions": [
                {"label": each.part.label, "tension": each.tension, "time": each.time}
                for each in self.pulls
            ],
        }


_AS_THEY_ARE = (
    *("fall_time", "fall_back", "touchdown_speed", "greatest_tension", "tow_past", "aside"),
    *("streamed", "ship_speed", "course", "astern", "anchor_drag", "rest_difference"),
)
"""Attributes of a plan that have the same names in its JSON."""

FINE = Fineness(bars=100, steps=100)
FINEST = 4
"""Largest factor by which the number of bars is increased until the line settles in its
equilibrium.
"""
DRAG_BAND = 2.0
"""Uncertainty factor on the drag of the anchor."""
ERROR_SAFETY = 2.0
"""Safety factor of the error estimates. An estimate is the change in a result if time steps and
bars are twice as long, multiplied by this factor.
"""
LEAST_TIME_ERROR = 5e-4
"""Smallest relative error of the fall time, in case the estimated error is small by chance."""


def drop_plan(
    mooring: Design,
    ship_speed: float | str = launch.SHIP_SPEED,
    streamed: float | str | None = None,
    course: float | str | None = None,
    result: Result | None = None,
    fineness: Fineness = FINE,
    deck_time: Mapping[str, float] | None = None,
) -> DropPlan:
    """Plan the drop of a mooring that is deployed anchor last, behind the ship.

    Parameters
    ----------
    ship_speed : speed over the ground [m/s]; `ship_speed`, `streamed` and `course` may be texts
        with a unit, such as ``"2 knot"``
    streamed : horizontal distance from the anchor to the free end at the release [m]; by default
        the distance under tow
    course : course over the ground [degrees]; by default against the surface current, or north
    result : result of the mooring in the same environment, if already solved
    deck_time : time to handle a piece on deck, by the role of the piece [s]; required for the start
        of the run

    Raises
    ------
    UsageError
        The ship is too slow through the water, the line is shorter than `streamed`, or the file
        contains a tow or several legs.
    NoEquilibrium
        As in `Design.solve`; also ``anchor-lifts`` if the anchor does not pull the line down, and
        ``not-converged`` if a time step has no solution.
    """
    leg = mooring.moored
    ship_speed = in_si("ship_speed", ship_speed, "speed")
    streamed = None if streamed is None else in_si("streamed", streamed, "length")
    if course is None:
        course = launch.course_into_current(leg.water)
    course = in_si("course", course, "angle") % 360.0
    if result is None:
        result = _equilibrium(mooring)
    ship = launch.ship_of(leg, ship_speed, course, streamed)
    anchor, falling = launch.falling_anchor(leg), launch.falling_line(leg)
    water = leg.water

    def let_go(start: ChainState, drag: float, fineness: Fineness) -> Motion:
        return fall(falling, water, replace(anchor, drag=drag), start, fineness)

    def dropped(fine: Fineness) -> tuple[ChainState, Motion, Motion, float | None]:
        start = towed(falling, water, anchor, ship, fine)
        drop = let_go(start, anchor.drag, fine)
        rest = settle(leg.line, water, anchor, drop.states[-1], fine)
        return start, drop, rest, None if result is None else rest_difference(result.leg, rest)

    def is_astray(difference: float | None) -> bool:
        return difference is not None and difference > REST_TOLERANCE * water.depth

    fine = fineness
    start, drop, rest, difference = dropped(fine)
    while is_astray(difference) and fine.bars < FINEST * fineness.bars:
        finer = replace(fine, bars=2 * fine.bars)
        try:
            start, drop, rest, difference = dropped(finer)
        except NoEquilibrium:
            break
        fine = finer
    astray = is_astray(difference)
    longer = replace(fine, steps=fine.steps // 2)
    slower = let_go(start, anchor.drag, longer)
    fewer = replace(fine, bars=fine.bars // 2)
    coarser = let_go(towed(falling, water, anchor, ship, fewer), anchor.drag, fewer)
    toward = start.node[0, :2] / np.linalg.norm(start.node[0, :2])
    others = [
        let_go(start, anchor.drag * factor, longer).states[-1]
        for factor in (1.0 / DRAG_BAND, DRAG_BAND)
    ]
    landed, late = drop.states[-1], slower.states[-1]
    back, aside = _split(landed, toward)
    # changes for steps and for bars of twice the length
    missed = [
        np.subtract(_split(other.states[-1], toward), (back, aside)) for other in (slower, coarser)
    ]
    delays = [other.states[-1].time - landed.time for other in (slower, coarser)]
    backs = [_split(other, toward)[0] - float(missed[0][0]) for other in others]
    times = [other.time - late.time + landed.time for other in others]
    heading = np.array([sin(radians(course)), cos(radians(course))])
    released = -landed.node[-1, :2]
    past = float(released @ heading)
    pulls = fall_record.pulls_of(leg.file.pieces, drop)
    return DropPlan(
        mooring=mooring,
        ship_speed=ship_speed,
        course=course,
        streamed=float(np.linalg.norm(start.node[0, :2])),
        astern=bearing_of(*toward.tolist()),
        fall_time=landed.time,
        fall_back=back,
        aside=aside,
        time_error=max(ERROR_SAFETY * sum(map(abs, delays)), LEAST_TIME_ERROR * landed.time),
        distance_error=ERROR_SAFETY * sum(float(np.linalg.norm(each)) for each in missed),
        fall_time_band=(min(times), max(times)),
        fall_back_band=(min(*backs, back), max(*backs, back)),
        touchdown_speed=-float(landed.velocity[-1, 2]),
        greatest_tension=max(pull.tension for pull in pulls),
        tow_past=past,
        let_go=(float(released[0]), float(released[1])),
        deck_time=deck_time,
        start=None if deck_time is None else _run_start(leg, heading, ship_speed, past, deck_time),
        anchor_drag=anchor.drag,
        drag_known=leg.file.anchor.kt is not None,
        path=fall_record.path_of(drop, toward, leg.line.anchor_height),
        moments=fall_record.moments_of(drop, None if astray else rest, toward),
        depths=() if astray else fall_record.depths_of(leg.file.pieces, drop, rest),
        pulls=pulls,
        rest_difference=difference,
    )


def _one_or_all(times: Mapping[str, float] | None) -> float | dict[str, float] | None:
    once = set((times or {}).values())
    return once.pop() if len(once) == 1 else None if times is None else dict(times)


def _equilibrium(mooring: Design) -> Result | None:
    try:
        return mooring.solve()
    except NoEquilibrium as failure:
        if failure.status != Status.SLACK.label:
            raise
        return None


def _split(state: ChainState, toward: Floats) -> tuple[float, float]:
    """Return the distances of the anchor in a direction, and to the right of this direction [m]."""
    (east, north), (x, y) = state.node[-1, :2].tolist(), toward.tolist()
    return east * x + north * y, east * y - north * x


def _run_start(
    leg: Leg, heading: Floats, speed: float, past: float, deck_time: Mapping[str, float]
) -> RunStart:
    """Compute the start of the run, with cables paid out at the speed of the ship.

    `heading` (2,) and `speed` are the ship's direction and speed over the ground [m/s]. `past` is
    the distance of the release past the target [m].
    """
    pieces = leg.file.pieces[:-1]
    roles = [piece.component.role for piece in pieces]
    roles += [clamp.component.role for piece in pieces for clamp in piece.clamps]
    handled = sum(deck_time.get(role, 0.0) for role in roles)
    cables = sum(leg.line.length[: len(pieces)][leg.line.flexible[: len(pieces)]])
    time = handled + cables / speed
    distance = speed * time - past
    return RunStart(distance, time, (float(-distance * heading[0]), float(-distance * heading[1])))
