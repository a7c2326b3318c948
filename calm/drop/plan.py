"""From a mooring and a ship to the plan of its anchor drop, which the ship has to know before."""

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
from calm.physics.line import Floats
from calm.positions import Frame
from calm.quantities import bearing_of
from calm.solve import Status
from calm.units import in_si

ASTRAY = 1e-3
"""Share of the depth by which the line may come to rest elsewhere than its equilibrium; beyond it
nothing of what comes after the touchdown is shown."""

BRIEF = 60.0
"""Fall time below which what is left out, inertia, shows in the figures [s]."""


@dataclass(frozen=True)
class RunStart:
    """Hold where the first piece goes over the side, and how long the run is.

    Attributes
    ----------
    distance : before the target, along the ship's course; negative beyond it [m]
    time : until the anchor is let go [s]
    place : east and north of the target [m]
    """

    distance: float
    time: float
    place: tuple[float, float]


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
    let_go : where the anchor is let go, east and north of the target
    deck_time : of handling a piece, by its role [s]; None where it is not given
    start : of the run, with the float put out first; None without a deck time
    anchor_drag : K of the anchor [N/(m/s)²]; `drag_known` is False where it is that of a cube,
        since the file gives none
    path, moments, depths, pulls : over time; shapes; of floats, instruments and releases, empty
        where the line comes to rest away from its equilibrium; of pieces
    rest_difference : farthest that a piece comes to rest from its place in the equilibrium; None
        where still water leaves the line slack, so that it has no single one
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
    def warnings(self) -> tuple[str, ...]:
        """Return what makes the plan less certain than it looks."""
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
                f"The fall takes {self.fall_time:.0f} s only: inertia, which is neglected, may "
                "add half a second and change the fall-back by a metre."
            )
        if self.mooring.line.strumming is not None:
            said.append("Strumming is neglected: cables have their drag at rest.")
        names = ", ".join(each.label for each in self.depths if each.beyond)
        if names:
            said.append(f"Below their depth rating during the drop: {names}.")
        return tuple(said)

    def to_dict(self) -> dict[str, Any]:
        """The plan as JSON; figures in SI."""
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
"""Figures of a plan that its JSON has under their own names."""

FINE = Fineness(bars=100, steps=100)
FINEST = 4
"""Times as many bars at most, until the line comes to rest in its equilibrium."""
DRAG_BAND = 2.0
"""By how many times the anchor's drag may be more, or less, than given."""
CAUTION = 2.0
"""How many times what steps and bars of twice the length change the stated errors are."""
LEAST_TIME_ERROR = 5e-4
"""Of the fall time, where the changes by steps and bars happen to be small."""


def drop_plan(
    mooring: Design,
    ship_speed: float | str = launch.SHIP_SPEED,
    streamed: float | str | None = None,
    course: float | str | None = None,
    result: Result | None = None,
    fineness: Fineness = FINE,
    deck_time: Mapping[str, float] | None = None,
) -> DropPlan:
    """The drop of a mooring's anchor from a ship that streams the line, the anchor last.

    Parameters
    ----------
    ship_speed : over the ground [m/s]; it, `streamed` and `course` may be texts with a unit, such
        as ``"2 knot"``
    streamed : horizontal distance from the anchor to the free end when it is let go [m]; that of
        the line as it is towed where not given
    course : of the ship over the ground [degrees]; against the current at the surface where not
        given, and north where there is none
    result : of the mooring in the same environment, where it is solved already
    fineness : of the chain and its steps
    deck_time : of handling a piece before it goes over, by its role [s]; without it no start of the
        run is given, since most of the time goes there

    Raises
    ------
    UsageError
        A ship that makes no way through the water, or a distance that the line does not span; a
        tow, or several legs.
    NoEquilibrium
        As `Design.solve`; ``anchor-lifts`` where the anchor does not draw the line down,
        ``not-converged`` where no step is found.
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
        """The line as it is towed, its fall and its rest, and how far from its equilibrium."""
        start = towed(falling, water, anchor, ship, fine)
        drop = let_go(start, anchor.drag, fine)
        rest = settle(leg.line, water, anchor, drop.states[-1], fine)
        return start, drop, rest, None if result is None else rest_difference(result.leg, rest)

    def is_astray(difference: float | None) -> bool:
        return difference is not None and difference > ASTRAY * water.depth

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
    # of steps twice as long, and of bars
    missed = [
        np.subtract(_split(other.states[-1], toward), (back, aside)) for other in (slower, coarser)
    ]
    delays = [other.states[-1].time - landed.time for other in (slower, coarser)]
    backs = [_split(other, toward)[0] - float(missed[0][0]) for other in others]
    times = [other.time - late.time + landed.time for other in others]
    way = np.array([sin(radians(course)), cos(radians(course))])
    released = -landed.node[-1, :2]
    past = float(released @ way)
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
        time_error=max(CAUTION * sum(map(abs, delays)), LEAST_TIME_ERROR * landed.time),
        distance_error=CAUTION * sum(float(np.linalg.norm(each)) for each in missed),
        fall_time_band=(min(times), max(times)),
        fall_back_band=(min(*backs, back), max(*backs, back)),
        touchdown_speed=-float(landed.velocity[-1, 2]),
        greatest_tension=max(pull.tension for pull in pulls),
        tow_past=past,
        let_go=(float(released[0]), float(released[1])),
        deck_time=deck_time,
        start=None if deck_time is None else _run_start(leg, way, ship_speed, past, deck_time),
        anchor_drag=anchor.drag,
        drag_known=leg.file.anchor.kt is not None,
        path=fall_record.path_of(drop, toward, leg.line.anchor_height),
        moments=fall_record.moments_of(drop, None if astray else rest, toward),
        depths=() if astray else fall_record.depths_of(leg.file.pieces, drop, rest),
        pulls=pulls,
        rest_difference=difference,
    )


def _one_or_all(times: Mapping[str, float] | None) -> float | dict[str, float] | None:
    """Return the time of a piece where it is the same for all, else that by role."""
    once = set((times or {}).values())
    return once.pop() if len(once) == 1 else None if times is None else dict(times)


def _equilibrium(mooring: Design) -> Result | None:
    """The mooring at rest; None where it has no unique shape, longer than still water is deep."""
    try:
        return mooring.solve()
    except NoEquilibrium as failure:
        if failure.status != Status.SLACK.label:
            raise
        return None


def _split(state: ChainState, toward: Floats) -> tuple[float, float]:
    """Return where the anchor is: towards the float, and to the right of that [m]."""
    (east, north), (x, y) = state.node[-1, :2].tolist(), toward.tolist()
    return east * x + north * y, east * y - north * x


def _run_start(
    leg: Leg, way: Floats, speed: float, past: float, deck_time: Mapping[str, float]
) -> RunStart:
    """Return where the run begins, at the ship's speed, with the cables paid out as fast.

    Parameters
    ----------
    way : (2,) direction of the ship
    speed : of the ship over the ground [m/s]
    past : how far beyond the target the anchor is let go, along the course [m]
    deck_time : see `drop_plan`
    """
    pieces = leg.file.pieces[:-1]
    roles = [piece.component.role for piece in pieces]
    roles += [clamp.component.role for piece in pieces for clamp in piece.clamps]
    handled = sum(deck_time.get(role, 0.0) for role in roles)
    cables = sum(leg.line.length[: len(pieces)][leg.line.flexible[: len(pieces)]])
    time = handled + cables / speed
    distance = speed * time - past
    return RunStart(distance, time, (float(-distance * way[0]), float(-distance * way[1])))
