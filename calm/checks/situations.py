"""The currents a mooring is judged in, and the mooring with something changed.

The currents: how strong they are, and whether they cover the line. Changed: still water, the tide,
growth, strumming; and as deployed.
"""

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import hypot
from typing import TypeVar

import numpy as np

from calm.case import Mooring, Result
from calm.case.mooring import held, profilers_in
from calm.case.parts import cut_like
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
from calm.records.current_terms import left_out
from calm.records.grids import kilometres_from
from calm.solve import Status

STILL, STILL_LOW = "still water", "still low water"
HIGH, LOW = "high water", "low water"
SOLVES = 6.0
"""About how many equilibria one mooring in one environment takes."""

FOULED, STRUMMING, DEPLOYED = "fouling", "strumming", "as deployed"

_NO_CURRENT = CurrentTable((0.0,), (0.0,), (0.0,), (0.0,))


def situations_of(mooring: Mooring) -> tuple[Situation, ...]:
    """The mooring solved as given, then in every situation that its file asks for.

    Still water, high and low water, and still low water where the environment has a `depth_range`,
    profilers at their lower stops and where the wire leans most, growth where it has `fouling`,
    cables with Cn × 1.5 where no law of strumming is in use, and the
    depth and lengths of `deployed` where they are others than those of the design.
    Pieces that are cut to fit keep the length that fits as given. Still water in which a line to
    the surface is slack, since it is longer than the water is deep, has no unique shape and is
    left out.
    """
    given = solved(AS_GIVEN, mooring)
    if given.result is None:
        return (given,)
    surface = reaches_the_surface(given.result.mooring)
    changed = [solved(name, each) for name, each in _changed(mooring, given.result)]
    return (given, *(each for each in changed if not (surface and _shapeless(each))))


def solved(name: str, mooring: Mooring) -> Situation:
    """The situation of that name, with the result or the failure of a mooring."""

    # all environments of a mooring that are as deep and dense have still water in common
    environment = replace(mooring.file.environment, name=None)
    given = name, replace(mooring.file, environment=environment), mooring.for_surface
    for known, situation in list(_STILL):
        if known == given:
            return situation
    found = or_why_not(mooring.solve)
    failed = isinstance(found, NoEquilibrium)
    situation = Situation(name, *((None, found) if failed else (found, None)))
    if name in (STILL, STILL_LOW):
        _STILL.append((given, situation))
    return situation


_STILL: deque[tuple[object, Situation]] = deque(maxlen=4)
"""The latest situations in still water, and what they are of."""


def _changed(mooring: Mooring, given: Result) -> Iterator[tuple[str, Mooring]]:
    file, surface = held(cut_like(mooring.file, mooring)), reaches_the_surface(given.mooring)

    def changed(other: MooringFile) -> Mooring:
        return Mooring(other, surface, mooring.memory)

    for name, other in in_other_waters(file, mooring.water):
        yield name, changed(other)
    for clamp, travel in zip(profilers_in(mooring), given.profilers, strict=True):
        yield f"{clamp.label} at its lower stop", changed(held(file, clamp.place, travel.lower.at))
        if travel.worst not in (travel.upper, travel.lower):
            leaning = changed(held(file, clamp.place, travel.worst.at))
            yield f"{clamp.label} where its wire leans most", leaning
    fouling = file.environment.fouling
    if fouling is not None:
        yield FOULED, changed(replace(file, pieces=grown(file.pieces, given, fouling)))
    if (strummed := strumming_file(file)) is not None:
        yield STRUMMING, changed(strummed)
    if file.deployed is not None and differs(mooring, deployed := as_deployed(mooring)):
        yield DEPLOYED, Mooring(deployed.file, surface, mooring.memory)


def in_other_waters(file: MooringFile, water: Water) -> Iterator[tuple[str, MooringFile]]:
    """Return a file, of an environment with this water, in still water, at high and low water, and
    in still low water.
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
    """Return a file with more drag on its cables, as they strum; None where that is in it."""
    if file.solver.strumming is not None:
        return None
    if not any(isinstance(piece.component, Cable) for piece in file.pieces):
        return None
    solver = file.solver.model_copy(update={"strumming": StrummingFactor(factor=FACTOR)})
    return replace(file, solver=solver)


def _shapeless(situation: Situation) -> bool:
    """Return whether it is still water in which a slack line has no shape of its own."""
    failure = situation.failure
    still = situation.name in (STILL, STILL_LOW)
    return still and failure is not None and failure.status == Status.SLACK.label


_Part = TypeVar("_Part", Piece, Clamp)

SOUNDING = 1.0, 0.023
"""Of a sounding's error, 95 %: the fixed part [m] and the share of the depth; IHO S-44, order 2."""


def as_deployed(mooring: Mooring) -> Mooring:
    """The mooring with the depth, position, serial numbers and cut lengths of its `deployed`.

    What is cut to fit keeps the length that fits as designed, unless another was cut.

    Raises
    ------
    UsageError
        The file says nothing of a deployment.
    NoEquilibrium
        What is cut to fit has no length that fits as designed.
    """
    file = mooring.file if mooring.file.deployed is None else cut_like(mooring.file, mooring)
    return Mooring(deployed_file(file))


def deployed_file(file: MooringFile) -> MooringFile:
    """The same of a file in which nothing is cut to fit, such as that of a net."""
    deployed = file.deployed
    if deployed is None:
        raise UsageError(f"{file.path} has no `deployed:` to compare its design with")
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


def differs(mooring: Mooring, deployed: Mooring) -> bool:
    """Return whether it stands in another depth than designed, or on other lengths."""
    return deployed.water.depth != mooring.water.depth or any(
        piece.length is not None and piece.length != length
        for piece, length in zip(deployed.file.pieces, mooring.line.length.tolist(), strict=False)
    )


@rule("as-deployed", once=True)
def deployed_depth(handling: Handling) -> Iterator[Verdict]:
    """Return how far the top of the upright line is from where it was designed to be.

    A line to the surface keeps its top there: what differs is the depth under it.
    """
    mooring = handling.mooring
    if mooring.file.deployed is None:
        return
    if (far := _far_away(mooring)) is not None:
        yield far
    try:
        deployed = as_deployed(mooring)
    except NoEquilibrium:  # found by `equilibrium`
        return
    if not differs(mooring, deployed):
        return
    designed, depth = mooring.water.depth, deployed.water.depth
    longer = float(deployed.line.length.sum() - mooring.line.length.sum())
    fixed, share = SOUNDING
    limit = hypot(fixed, share * designed)
    moved, what = depth - designed - longer, "its top, upright,"
    if reaches_the_surface(mooring):
        moved, what = depth - designed, "it"
    way = "deeper" if moved > 0.0 else "shallower"
    message = (
        f"Deployed in {say('depth', depth)} of water, designed for "
        f"{say('depth', designed)}: {what} is {say('depth', abs(moved))} {way}; "
        f"{say('depth', limit)} is within the error of a sounding."
    )
    remedy = "`calm diff` with this file alone shows what that does."
    yield at_most(None, abs(moved), limit, message, remedy, State.WARN)


_ANOTHER_SITE = 20.0
"""Distance from the planned position beyond which the currents of the design are of elsewhere
[km]."""


def _far_away(mooring: Mooring) -> Verdict | None:
    """Return that it was deployed at another place than it was designed for."""
    assert mooring.file.deployed is not None
    planned = mooring.file.position or mooring.file.environment.position
    there = mooring.file.deployed.position
    if planned is None or there is None:
        return None
    place = planned.latitude, planned.longitude
    away = float(kilometres_from(there.latitude, there.longitude, place))
    if away <= _ANOTHER_SITE:
        return None
    message = (
        f"Deployed {away:.0f} km from the planned position: the water and the currents of "
        "this design are those of another place."
    )
    remedy = "Check both positions, or give the environment of the site."
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
"""Speed below which a current counts as none [m/s]."""


@rule("equilibrium")
def equilibrium(failure: NoEquilibrium) -> Iterator[Verdict]:
    """Found only where there is none."""
    message = f"{failure.status}: {failure.message}"
    yield verdict_on(None, State.FAIL, message, failure.advice)


STILL_ONLY = verdict_on(
    None,
    State.WARN,
    "No environment has a current of 1 cm/s or more: tilt, knockdown and pull in a "
    "current are not judged.",
    "Give the current, or an environment that has one.",
)
"""What `equilibrium` says of a mooring without a current to speak of."""

USUAL_CURRENT = 0.2
"""What a wind of 7 m/s alone drives at the surface, 0.03 of it by DNV-RP-C205 [m/s]."""

SHARE_OF_ITS_RECORD = 0.9
"""Share of the strongest current of its own record below which a judged one is too weak."""

WEAK_BESIDE_OTHERS = 0.02
"""Share of the strongest current below which another was typed in another unit: 1/100 is cm/s."""


@rule("current")
def currents(moorings: Sequence[Mooring]) -> Iterator[tuple[Mooring, Verdict]]:
    """Judge the strongest current of all environments, and what each leaves out.

    Each verdict comes with the mooring in the environment that it is of.
    """
    speeds = [float(np.hypot(each.water.u, each.water.v).max()) for each in moorings]
    for mooring, speed in zip(moorings, speeds, strict=True):
        if 0.0 < speed < WEAK_BESIDE_OTHERS * max(speeds):
            message = (
                f"The current is {speed:.2g} m/s at its strongest, {say('speed', max(speeds))} in "
                "another environment: was m/s read as cm/s, or cm/s as m/s?"
            )
            yield mooring, verdict_on(None, State.WARN, message, "Check its unit.", speed)
        if speed >= LEAST_CURRENT and (left := _left_out(mooring)):
            remedy = "Give the current at more levels, with one near each end."
            yield mooring, verdict_on(None, State.WARN, left, remedy, speed)
    strongest = max(range(len(speeds)), key=speeds.__getitem__)
    speed = speeds[strongest]
    for mooring, recorded in _records(moorings):
        if speed < SHARE_OF_ITS_RECORD * recorded:
            message = (
                f"The record that this current is taken from reaches {say('speed', recorded)}; "
                f"the strongest current judged is {say('speed', speed)}."
            )
            remedy = "Add an environment with that current, or solve the record with `calm batch`."
            yield mooring, verdict_on(None, State.WARN, message, remedy, speed, recorded)
    if speed < LEAST_CURRENT:
        return
    message = f"The strongest current judged is {say('speed', speed)}"
    if speed < USUAL_CURRENT:
        message += f"; a wind of 7 m/s alone drives {say('speed', USUAL_CURRENT)} at the surface"
    remedy = "Add an environment with the strongest current of the site."
    yield (
        moorings[strongest],
        at_least(None, speed, USUAL_CURRENT, f"{message}.", remedy, State.WARN),
    )


def _records(moorings: Sequence[Mooring]) -> Iterator[tuple[Mooring, float]]:
    """Return the strongest current of each record that an environment is a time of [m/s]."""
    sources = {mooring.file.environment.current.record: mooring for mooring in moorings}
    for source, mooring in sources.items():
        if source is not None:
            yield mooring, strongest_of(*source)


def _left_out(mooring: Mooring) -> str:
    """Return what of the depth a profile of the current says nothing of; "" of one that covers it.

    One speed at the surface is taken for a current that is the same everywhere.
    """
    environment: Environment = mooring.file.environment
    levels = environment.current.depth
    if levels == (0.0,):
        return ""
    left = left_out(levels[0], levels[-1], mooring.water.depth)
    return left and f"{left[0].upper()}{left[1:]}."
