"""Situations of a mooring: its environment as given, or with one change.

The changes are those of `situations_of`. The module also contains the rules on currents.
"""

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import hypot
from typing import TypeVar

import numpy as np

from calm.case.design import Design
from calm.case.leg import Leg
from calm.case.leg_result import LegResult
from calm.case.profilers import held, profilers_in
from calm.case.strumming import FACTOR
from calm.checks.assessment import Handling, Situation
from calm.checks.finding import AS_GIVEN, State, Verdict, at_least, at_most, rule, verdict_on
from calm.checks.growth import grown
from calm.checks.posture import reaches_the_surface
from calm.errors import NoEquilibrium, UsageError, or_why_not
from calm.files import Cable, Clamp, CurrentTable, MooringFile, Piece, StrummingFactor
from calm.files.environment import Environment
from calm.files.logbook import DeployedItem
from calm.physics.line import Water
from calm.quantities import say
from calm.records.current_file import strongest_of
from calm.records.grids import kilometres_from
from calm.records.value_tests import left_out
from calm.solve import Status

STILL, STILL_LOW = "still water", "still low water"
HIGH, LOW = "high water", "low water"
SOLVES = 3.0
"""Approximate number of lines that are solved for one mooring in one environment."""

FOULED, STRUMMING, DEPLOYED = "fouling", "strumming", "as deployed"

_SUFFIXES = {
    AS_GIVEN: "", STRUMMING: "s", FOULED: "g", HIGH: "h", LOW: "l", DEPLOYED: "d",
}  # fmt: skip
_AT_STOP, _AT_LEAN = "at its lower stop", "at its largest wire angle"


def case_of(environment: int, situation: str) -> str:
    """Return the code of a load case, such as ``2s`` for strumming in the second environment.

    Codes are the number of the environment (from 1, in file order) and a suffix:

    - none: the unchanged mooring
    - s, g: strumming, growth (biofouling)
    - h, l: high water, low water
    - d: as deployed
    - p, q: profiler at its lower stop, or at the maximum wire angle

    Still water has the code 0, and still low water 0l.
    """
    if situation in (STILL, STILL_LOW):
        return "0" if situation == STILL else "0l"
    suffix = _SUFFIXES.get(situation) or ("p" if situation.endswith(_AT_STOP) else "q")
    return f"{environment}{'' if situation == AS_GIVEN else suffix}"


_NO_CURRENT = CurrentTable((0.0,), (0.0,), (0.0,), (0.0,))


Situations = tuple[Situation, ...]
"""Solutions of a design in one situation, leg by leg; a single entry without an equilibrium."""


def situations_of(design: Design) -> tuple[Situations, ...]:
    """Solve a design as given, and then in every situation that its file requires.

    These situations are:

    - still water, unless a surface line is slack there;
    - high, low and still low water, if the environment has a `depth_range`;
    - profilers at their lower stops and at the position of maximum wire angle;
    - biofouling, if `fouling` is set;
    - cables with Cn × 1.5, without a strumming law;
    - the depth and lengths of `deployed`, if they differ from the design.

    A fitted piece keeps the length that it has in the design as given.
    """
    given = solved(AS_GIVEN, design)
    if given[0].result is None:
        return (given,)
    # a single line stays a surface or sub-surface mooring in all situations
    surface = None if design.several else reaches_the_surface(given[0].result.leg)
    legs = [each.result for each in given if each.result is not None]
    changed = [solved(name, each) for name, each in _changed(design, legs, surface)]
    return (
        given,
        *(each for each in changed if not (surface and _is_slack_in_still_water(each[0]))),
    )


def solved(name: str, design: Design) -> Situations:
    """Solve a design, and return one situation with the given name for each leg.

    Without an equilibrium, a single situation contains the reason.
    """

    # environments of equal depth and density share the solution in still water
    environment = replace(design.environment, name=None)
    given = name, replace(design.file, environment=environment), design.for_surface
    for known, before in list(_STILL):
        if known == given:
            return before
    found = or_why_not(design.solve)
    if isinstance(found, NoEquilibrium):
        situations: Situations = (Situation(name, None, found),)
    else:
        situations = tuple(Situation(name, leg, None) for leg in found.legs)
    if name in (STILL, STILL_LOW):
        _STILL.append((given, situations))
    return situations


_STILL: deque[tuple[object, Situations]] = deque(maxlen=4)
"""Cache of the latest solutions in still water, by key."""


def _changed(
    design: Design, given: Sequence[LegResult], surface: bool | None
) -> Iterator[tuple[str, Design]]:
    leg, first = design.legs[0], given[0]
    file = held(leg.cut(design.file))

    def changed(other: MooringFile) -> Design:
        return Design(other, surface, design.memory)

    for name, other in in_other_waters(file, design.water):
        yield name, changed(other)
    for clamp, travel in zip(profilers_in(leg), first.profilers, strict=True):
        yield f"{clamp.label} {_AT_STOP}", changed(held(file, clamp.place, travel.lower.at))
        if travel.worst not in (travel.upper, travel.lower):
            leaning = changed(held(file, clamp.place, travel.worst.at))
            yield f"{clamp.label} {_AT_LEAN}", leaning
    fouling = design.environment.fouling
    if fouling is not None:
        own = changed(file).legs
        pieces = [
            grown(leg.file.pieces, result, fouling) for leg, result in zip(own, given, strict=True)
        ]
        yield FOULED, changed(file).with_pieces(pieces)
    if (strummed := strumming_file(file)) is not None:
        yield STRUMMING, changed(strummed)
    if file.deployed is not None and differs(file, deployed := _deployed_file(file)):
        yield DEPLOYED, changed(deployed)


def in_other_waters(file: MooringFile, water: Water) -> Iterator[tuple[str, MooringFile]]:
    """Yield the name and the file of each situation with changed current or water depth.

    These are still water, still low water, high water and low water, as applicable.
    """
    environment, tide = file.environment, file.environment.depth_range
    if water.moving or environment.wind is not None:
        still = replace(environment, current=_NO_CURRENT, wind=None)
        yield STILL, replace(file, environment=still)
        if tide is not None:
            yield STILL_LOW, replace(file, environment=replace(still, depth=tide[0]))
    if tide is not None:
        for name, depth in ((HIGH, tide[1]), (LOW, tide[0])):
            yield name, replace(file, environment=replace(environment, depth=depth))


def strumming_file(file: MooringFile) -> MooringFile | None:
    """Return the file with Cn × 1.5 for all cables, which represents strumming.

    Return None if the file has a strumming law or no cables.
    """
    if file.solver.strumming is not None:
        return None
    if not any(isinstance(piece.component, Cable) for piece in file.pieces):
        return None
    solver = file.solver.model_copy(update={"strumming": StrummingFactor(factor=FACTOR)})
    return replace(file, solver=solver)


def _is_slack_in_still_water(situation: Situation) -> bool:
    failure = situation.failure
    still = situation.name in (STILL, STILL_LOW)
    return still and failure is not None and failure.status == Status.SLACK.label


_Part = TypeVar("_Part", Piece, Clamp)

SOUNDING = 1.0, 0.023
"""95 % error of a sounding: fixed part [m], and fraction of the depth (IHO S-44, order 2)."""


def as_deployed(design: Design) -> Design:
    """Return the design with the depth, position, serial numbers and cut lengths from `deployed`.

    A fitted piece keeps its design length, unless `deployed` specifies a length.

    Raises
    ------
    UsageError
        The file has no key `deployed`.
    NoEquilibrium
        No length of the fitted piece reaches its target depth.
    """
    file = design.file
    if file.deployed is None:
        raise UsageError(f"{file.path} has no `deployed:` section to compare with its design")
    return Design(_deployed_file(design.legs[0].cut(file)))


def _deployed_file(file: MooringFile) -> MooringFile:
    """Replace the values of a file with those under `deployed`; the file has no fitted piece."""
    deployed = file.deployed
    assert deployed is not None
    items = {item.label: item for item in deployed.items}
    depth, position = deployed.depth, deployed.position
    environment = replace(
        file.environment,
        depth=file.environment.depth if depth is None else depth,
        position=position or file.environment.position,
    )
    return replace(
        file,
        position=position or file.position,
        environment=environment,
        pieces=tuple(_as_cut(piece, items) for piece in file.pieces),
    )


def differs(designed: MooringFile, deployed: MooringFile) -> bool:
    """Return whether the mooring as deployed differs from the design in water depth or lengths."""
    return deployed.environment.depth != designed.environment.depth or any(
        there.length != piece.length
        for piece, there in zip(designed.pieces, deployed.pieces, strict=True)
    )


@rule("as-deployed", once=True, case="d")
def deployed_depth(handling: Handling) -> Iterator[Verdict]:
    """Compare the top depth as deployed with the top depth of the design.

    Both depths are for the upright line. For a surface mooring, the water depths are compared
    instead.
    """
    leg = handling.leg
    if leg.file.deployed is None:
        return
    if (far := _far_away(leg)) is not None:
        yield far
    try:
        designed_file = leg.cut(leg.file)
    except NoEquilibrium:  # found by `equilibrium`
        return
    deployed = Leg(_deployed_file(designed_file))
    if not differs(designed_file, deployed.file):
        return
    designed, depth = leg.water.depth, deployed.water.depth
    longer = float(deployed.line.length.sum() - leg.line.length.sum())
    fixed, share = SOUNDING
    limit = hypot(fixed, share * designed)
    moved, what = depth - designed - longer, "The top of the upright line"
    if reaches_the_surface(leg):
        moved, what = depth - designed, "The water"
    direction = "deeper" if moved > 0.0 else "shallower"
    message = (
        f"The mooring was deployed in {say('depth', depth)} of water instead of "
        f"{say('depth', designed)}. {what} is {say('depth', abs(moved))} {direction} than "
        f"designed; the limit is {say('depth', limit)}, the error of a depth sounding."
    )
    remedy = "Run `calm diff` on this file to see the effect."
    yield at_most(None, abs(moved), limit, message, remedy, State.WARN)


_ANOTHER_SITE = 20.0
"""Distance from the planned position above which the design currents are considered invalid
[km].
"""


def _far_away(leg: Leg) -> Verdict | None:
    assert leg.file.deployed is not None
    planned = leg.file.position or leg.file.environment.position
    there = leg.file.deployed.position
    if planned is None or there is None:
        return None
    place = planned.latitude, planned.longitude
    away = float(kilometres_from(there.latitude, there.longitude, place))
    if away <= _ANOTHER_SITE:
        return None
    message = (
        f"The mooring was deployed {away:.0f} km from the planned position; the water depth and "
        "currents of the design may not apply there."
    )
    remedy = "Check both positions, or use the environment of the site."
    return verdict_on(None, State.UNKNOWN, message, remedy)


def _as_cut(piece: Piece, items: dict[str, DeployedItem]) -> Piece:
    item = items.get(piece.label)
    clamps = tuple(_numbered(clamp, items) for clamp in piece.clamps)
    piece = replace(_numbered(piece, items), clamps=clamps)
    return piece if item is None or item.length is None else replace(piece, length=item.length)


def _numbered(part: _Part, items: dict[str, DeployedItem]) -> _Part:
    item = items.get(part.label)
    if item is None or item.serial is None:
        return part
    return replace(part, equipment=part.equipment.model_copy(update={"serial": item.serial}))


LEAST_CURRENT = 0.01
"""Current speed that is treated as zero [m/s]."""


@rule("equilibrium")
def equilibrium(failure: NoEquilibrium) -> Iterator[Verdict]:
    """Report that the mooring has no equilibrium, with the reason."""
    message = f"{failure.status}: {failure.message}"
    yield verdict_on(None, State.FAIL, message, failure.advice)


STILL_ONLY = verdict_on(
    None,
    State.WARN,
    "No environment has a current of 1 cm/s or more, so tilt, knockdown and loads in a current "
    "are not checked.",
    "Add a current, or an environment that has one.",
)
"""Verdict of the rule `equilibrium` on a mooring without significant current."""

USUAL_CURRENT = 0.2
"""Surface current driven by a wind of 7 m/s alone: 0.03 times the wind speed, DNV-RP-C205 [m/s]."""

SHARE_OF_ITS_RECORD = 0.9
"""Minimum ratio of the design current to the strongest current of the underlying record."""

WEAK_BESIDE_OTHERS = 0.02
"""Ratio of a current to the strongest current of all environments, below which a unit is doubtful.

A ratio near 1/100 suggests that speeds in cm/s and m/s were exchanged.
"""


@rule("current")
def currents(legs: Sequence[Leg]) -> Iterator[tuple[Leg, Verdict]]:
    """Check the strongest current, and report depths that current profiles do not cover.

    `legs` contains one leg per environment. Yield pairs of a leg and a verdict on its environment.
    """
    speeds = [float(np.hypot(each.water.u, each.water.v).max()) for each in legs]
    for leg, speed in zip(legs, speeds, strict=True):
        if 0.0 < speed < WEAK_BESIDE_OTHERS * max(speeds):
            message = (
                f"The strongest current is {speed:.2g} m/s in this environment and "
                f"{say('speed', max(speeds))} in another; one of them may be in the wrong unit."
            )
            yield leg, verdict_on(None, State.WARN, message, "Check m/s and cm/s.", speed)
        if speed >= LEAST_CURRENT and (left := _uncovered_depths(leg)):
            remedy = "Add levels to the current, with one near the surface and one near the seabed."
            yield leg, verdict_on(None, State.WARN, left, remedy, speed)
    strongest = max(range(len(speeds)), key=speeds.__getitem__)
    speed = speeds[strongest]
    for leg, recorded in _strongest_of_records(legs):
        limit = SHARE_OF_ITS_RECORD * recorded
        if speed < limit:
            message = (
                "This current profile comes from a record. The strongest current in the record is "
                f"{say('speed', recorded)}; the strongest current checked is {say('speed', speed)}."
            )
            remedy = "Add an environment with that current, or run `calm batch` on the record."
            yield leg, at_least(None, speed, limit, message, remedy, State.WARN)
    if speed < LEAST_CURRENT:
        return
    message = f"The strongest current checked is {say('speed', speed)}"
    if speed < USUAL_CURRENT:
        message += (
            f"; a wind of 7 m/s alone drives a surface current of {say('speed', USUAL_CURRENT)}"
        )
    remedy = "Add an environment with the strongest current of the site."
    yield (
        legs[strongest],
        at_least(None, speed, USUAL_CURRENT, f"{message}.", remedy, State.WARN),
    )


def _strongest_of_records(legs: Sequence[Leg]) -> Iterator[tuple[Leg, float]]:
    """Yield one leg for each current record, and the strongest current of the record [m/s]."""
    sources = {leg.file.environment.current.record: leg for leg in legs}
    for source, leg in sources.items():
        if source is not None:
            yield leg, strongest_of(*source)


def _uncovered_depths(leg: Leg) -> str:
    environment: Environment = leg.file.environment
    levels = environment.current.depth
    if levels == (0.0,):  # a single speed at the surface is uniform with depth
        return ""
    left = left_out(levels[0], levels[-1], leg.water.depth)
    return left and f"{left[0].upper()}{left[1:]}."
