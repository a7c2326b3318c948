"""Rules on the assembly of a line: release, swivels, metals, and the grip of clamps."""

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import cos, radians, sin

import numpy as np

from calm.assemble import axial_drag_of, drag_of, net_buoyancy
from calm.case.leg import Leg
from calm.case.leg_result import LegResult
from calm.case.profilers import ProfilerTravel
from calm.case.result_tables import ClampRow
from calm.case.warnings import is_synthetic
from calm.checks.assessment import Handling
from calm.checks.criterion import JudgedPart, parts_of
from calm.checks.finding import Lack, State, Verdict, at_least, at_most, rule, unknown, verdict_on
from calm.checks.handling import is_hauled_in
from calm.checks.posture import reaches_the_surface
from calm.checks.recovery import Recovery
from calm.drop.launch import Launch
from calm.files import Cable, Clamp, Component, Flexible, Piece, Profiler
from calm.files.pieces import clamps_in
from calm.files.pieces import parts_of as every_part
from calm.physics.materials import materials_in, potential_of
from calm.physics.seawater import REFERENCE_DENSITY
from calm.quantities import duration, say

GREATEST_DIFFERENCE = 0.2
"""Potential difference above which two metals in contact corrode in sea water [V]."""

_BALANCED = re.compile(r"\b(torque[- ]balanced|rotation[- ]res\w*|non[- ]rotating)\b")
_UNBALANCED = re.compile(
    r"\b(not|no|non|never|un|hardly|without)[- ]?(\w+[- ])?(torque|rotation|balanced)"
    r"|\bun(torque|balanced)|balanced\W+(no|not|false)\b"
)
_NO_RELEASE = re.compile(r"\b(shackle|swivel|sling|chain|rope|wire|thimble|pear[- ]?link)s?\b")
_TWICE = re.compile(r"\b(double|dual|pair|twin|tandem|two|releases)\b")
_INSULATED = ("plastic", "jacket", "sheath", "coated", "insulat")


GRAPPLED = 100.0
"""Water depth up to which a single release is accepted [m]; a default of CALM.

In shallow water, a diver or a grapnel can recover a line whose release fails.
"""

LEAST_BELOW_RELEASE = 1.0
"""Minimum height of a release above its anchor [m]; a default of CALM."""


@rule("release-present", once=True)
def release_present(handling: Handling) -> Iterator[Verdict]:
    """Check that the line has an in-line release, and that opening the release frees the line."""
    leg = handling.leg
    release, pieces = leg.file.release, leg.file.pieces
    for clamp in clamps_in(pieces):
        if clamp.component.role == "release":
            message = (
                f"{clamp.label} has `role: release`, but a clamped release cannot free the line."
            )
            yield unknown(clamp, message, "Insert the release in the line, or change its role.")
    if release is None:
        if not reaches_the_surface(leg):
            yield unknown(
                None,
                "No piece has `role: release`; the release of the line is unknown.",
                "Mark the release with `role: release`.",
            )
        return
    piece = pieces[release]
    if _NO_RELEASE.search(_words(piece.use, piece.component.name)):
        message = f"{piece.label} has `role: release`, but its name suggests another component."
        yield unknown(piece, message, "Mark only the release with `role: release`.")
        return
    above = [part.component for part in every_part(pieces[: release + 1])]
    if not _floats(pieces[: release + 1]):
        message = (
            f"No piece above {piece.label} is buoyant, so the release stays on the seabed when it "
            "opens."
        )
        yield verdict_on(piece, State.FAIL, message, "Put the floats above the release.")
        return
    doubts = []
    below = pieces[release + 1 : -1]
    length = sum(one.length or 0.0 for one in below)
    if length < LEAST_BELOW_RELEASE and all(one.fit_top_depth is None for one in below):
        message = (
            f"{piece.label} is {say('depth', length)} above the anchor; "
            f"a release needs at least {LEAST_BELOW_RELEASE:g} m to stay clear of mud and of "
            "falling gear."
        )
        doubts.append((piece, message, "Insert rope or chain between release and anchor."))
    text = _words(piece.use, piece.component.name, piece.label)
    alone = sum(component.role == "release" for component in above) == 1
    if alone and leg.water.depth > GRAPPLED and not _TWICE.search(text):
        message = f"{piece.label} is the only release: if it fails, the line stays moored."
        remedy = "Use two releases in parallel, with `pair` in their label."
        doubts.append((piece, message, remedy))
    for index, one in enumerate(pieces[:release]):
        if one.component.role == "release" and not _floats(pieces[: index + 1]):
            message = f"No piece above release {one.label} is buoyant: opening it frees no float."
            doubts.append(
                (one, message, "Move this release below the buoyancy, or change its role.")
            )
    for one in below:
        floats = net_buoyancy(one.component, leg.water.gravity) > 0.0
        if floats and not isinstance(one.component, Flexible):
            message = f"{one.label} is buoyant, but below the release: it stays with the anchor."
            doubts.append(
                (one, message, "Move this part above the release, or use a part that sinks.")
            )
    for part, message, remedy in doubts:
        yield verdict_on(part, State.WARN, message, remedy)
    if not doubts:
        message = f"{piece.label} frees the line from all pieces below it."
        yield verdict_on(piece, State.PASS, message)


def _floats(pieces: Sequence[Piece]) -> bool:
    return any(part.component.net_buoyancy > 0.0 for part in every_part(pieces))


@rule("hardware", once=True)
def hardware(handling: Handling) -> Iterator[Verdict]:
    """Warn if the line lists no shackle, link or swivel."""
    pieces = handling.leg.file.pieces
    if not any(piece.component.role == "connector" for piece in pieces):
        message = "The line lists no shackle, link or swivel, so its joints are not checked."
        yield verdict_on(None, State.WARN, message, "Add the connecting hardware to the line.")


@rule("swivel", once=True)
def swivel(handling: Handling) -> Iterator[Verdict]:
    """Check that a swivel separates each wire that is not torque-balanced from a float at its end.

    Such a wire twists as its load changes, and kinks if a float resists the rotation. A swivel at
    either end suffices. An end at a chain or rope needs none.
    """
    pieces = handling.leg.file.pieces
    for index, piece in enumerate(pieces):
        if not _bears_torque(piece.component):
            continue
        directions = (pieces[:index][::-1], pieces[index + 1 :])
        ends = [held for pieces_there in directions if (held := _held_by(pieces_there)) is not None]
        if not ends:
            continue
        turning = next((beside for beside, has_swivel in ends if has_swivel), None)
        beside = turning or ends[0][0]
        wire = f"{piece.label} is not torque-balanced"
        if turning is not None:
            message = f"{wire}, but there is a swivel between it and {beside.label}."
            yield verdict_on(piece, State.PASS, message)
        else:
            message = (
                f"{wire}, and there is no swivel between it and {beside.label}, which tilts in the "
                "current."
            )
            remedy = "Insert a swivel between the two, or use wire that is `torque_balanced`."
            yield verdict_on(piece, State.WARN, message, remedy)


def _bears_torque(component: Component) -> bool:
    if not isinstance(component, Cable) or is_synthetic(component):
        return False
    balanced = component.torque_balanced
    if balanced is None:
        text = _words(component.material, component.name, component.note)
        balanced = bool(_BALANCED.search(text)) and not _UNBALANCED.search(text)
    of_steel = any("steel" in each.name for each in materials_in(component.material))
    return of_steel and not balanced


def _held_by(pieces_there: Sequence[Piece]) -> tuple[Piece, bool] | None:
    """Return the first float beyond one end of a wire, and whether a swivel precedes the float.

    Return None if a cable or chain comes before the float.
    """
    has_swivel = False
    for piece in pieces_there:
        if isinstance(piece.component, Flexible):
            return None
        if piece.component.role == "float" and piece.component.net_buoyancy > 0.0:
            return piece, has_swivel
        words = _words(piece.use, piece.component.name)
        has_swivel = has_swivel or "swivel" in words
    return None


_TOUCH = 0.05
"""Accepted overlap of neighbouring clamps [m]; clamped instruments may be mounted side by side."""


@rule("clamp-place", once=True)
def clamp_place(handling: Handling) -> Iterator[Verdict]:
    """Report clamps that overlap or that extend beyond the end of their cable or chain."""
    leg = handling.leg
    lengths = leg.line.length.tolist()
    remedy = "Move the clamp to a free position, or check its `at` and its length."
    for piece in leg.file.pieces:
        if not isinstance(piece.component, Flexible):
            continue
        spans = sorted(
            (_span(clamp, clamp.at) for clamp in piece.clamps), key=lambda span: span[:2]
        )
        fixed = [span for span in spans if not isinstance(span[2].component, Profiler)]
        for upper, lower in pairwise(fixed):
            if upper[1] - lower[0] > _TOUCH:
                message = (
                    f"{lower[2].label} overlaps {upper[2].label} by "
                    f"{upper[1] - lower[0]:.2f} m on {piece.label}."
                )
                yield verdict_on(lower[2], State.FAIL, message, remedy)
        for top, bottom, clamp in fixed:
            out = max(-top, bottom - lengths[piece.index])
            if out > max(_TOUCH, (bottom - top) / 2.0 + _TOUCH if clamp.at == 0.0 else _TOUCH):
                message = f"{clamp.label} extends {out:.2f} m beyond the end of {piece.label}."
                yield verdict_on(clamp, State.FAIL, message, remedy)


def _span(clamp: Clamp, middle: float) -> tuple[float, float, Clamp]:
    half = float(getattr(clamp.component, "length", None) or 0.0) / 2.0
    return middle - half, middle + half, clamp


@rule("metals", once=True)
def metals(handling: Handling) -> Iterator[Verdict]:
    """Report contacts between dissimilar metals, if both materials are known.

    Parts that are `insulated` have no contact. Clamped items have plastic jaws, and are in contact
    with the line only with ``insulated: false``.
    """
    warned: set[str] = set()
    for base, noble, volts in unlike_metals(handling.leg.file.pieces):
        if base.label not in warned:
            warned.add(base.label)
            message = (
                f"{base.label} ({base.component.material}) corrodes in contact with {noble.label} "
                f"({noble.component.material}), which is {volts:.2f} V nobler in sea water."
            )
            remedy = "Insulate the two parts from each other (`insulated: true`), or fit an anode."
            yield at_most(base, volts, GREATEST_DIFFERENCE, message, remedy, State.WARN)


def _is_insulated(part: Piece | Clamp) -> bool:
    insulated = part.component.insulated
    return isinstance(part, Clamp) if insulated is None else insulated


def unlike_metals(pieces: Sequence[Piece]) -> Iterator[tuple[Piece | Clamp, Piece | Clamp, float]]:
    """Yield the contacts between dissimilar metals.

    Each contact is the less noble part, the more noble part, and their potential difference [V].
    """
    pairs: list[tuple[Piece | Clamp, Piece | Clamp]] = [*pairwise(pieces)]
    for piece in pieces:
        text = _words(piece.use, piece.component.name, piece.component.material)
        if not any(word in text for word in _INSULATED):
            pairs += [(piece, clamp) for clamp in piece.clamps]
    for one, other in pairs:
        if _is_insulated(one) or _is_insulated(other):
            continue
        first, second = (potential_of(part.component.material) for part in (one, other))
        if first is None or second is None or abs(first - second) <= GREATEST_DIFFERENCE:
            continue
        base, noble = (one, other) if first < second else (other, one)
        yield base, noble, abs(first - second)


def _words(*texts: str | None) -> str:
    return " ".join(text for text in texts if text).casefold()


_HOLDS = "Use a stronger clamp, a second clamp, or a stopper below it."


@rule("clamp-grip")
def clamp_grip(result: LegResult) -> Iterator[Verdict]:
    """Check the grip of each clamp against weight and drag of the clamped item in the current."""
    water, depth = result.leg.water, np.asarray(result.clamps.depth)
    flows, densities = water.current_at(depth), water.density_at(depth).tolist()
    for part in _clamps(result.leg):
        assert part.clamp is not None
        flow, density = flows[part.clamp], densities[part.clamp]
        drag = drag_of(part.component)[0] * density / REFERENCE_DENSITY
        force = drag * float(np.linalg.norm(flow)) * flow
        force[2] += _lift(part, result.leg, density)
        yield _verdict(part, float(np.linalg.norm(force)), "")


@rule("clamp-grip", situation="launch and recovery", once=True)
def clamp_grip_in_transit(handling: Handling) -> Iterator[Verdict]:
    """Check the grip of each clamp against the axial force during launch and recovery.

    The force [N] is the sum of submerged weight and drag of the clamped item. The drag is computed
    for flow along the line. During launch, the flow speed is the upper limit of the touchdown
    speed. During recovery, the flow speed is the rise speed.
    """
    launch, rise = handling.launch, None if is_hauled_in(handling) else handling.recovery
    deep = np.array(handling.leg.water.depth)
    density = float(handling.leg.water.density_at(deep))
    for part in _clamps(handling.leg):
        drag = axial_drag_of(part.component) * density / REFERENCE_DENSITY
        lift = _lift(part, handling.leg, density)
        pulls = []
        if isinstance(launch, Launch):
            descent = " during the descent"
            pulls.append((abs(lift + drag * launch.greatest_speed**2), descent, "L"))
        if isinstance(rise, Recovery) and part.index <= rise.released:
            ascent = " during the ascent"
            pulls.append((abs(lift - drag * rise.rise_speed**2), ascent, "R"))
        if pulls:
            pull, when, case = max(pulls)
            yield _verdict(part, pull, when).but(case=case)


PROFILER_WIRE = 6.35e-3, 9.53e-3
"""Diameter range of jacketed wire for moored profilers, 1/4 to 3/8 in [m].

Source: McLane Moored Profiler, user manual.
"""


@rule("profiler")
def profiler(result: LegResult) -> Iterator[Verdict]:
    """Check whether each profiler can travel along its wire.

    The rule checks the wire tension at the profiler, the wire diameter, clamps in the path, the
    drive force and the duration of a profile. The drive force must overcome the drag and the net
    weight of the profiler along the wire. The drag is computed for a flow of profiler speed +
    current × sin(tilt), an upper bound. Wheel friction and the compressibility of the profiler are
    neglected.
    """
    for row in result.clamps:
        if isinstance(row.part.component, Profiler):
            found = [*_of_profiler(result, row), *_lasting(result.profilers, row.part)]
            yield from [each for each in found if each.state != State.PASS] or found[:1]


def _of_profiler(result: LegResult, row: ClampRow) -> Iterator[Verdict]:
    part, wire, water = row.part, result.file.pieces[row.index], result.leg.water
    component = part.component
    assert isinstance(component, Profiler)
    least = component.minimum_tension
    message = (
        f"Tension in {wire.label} at {part.label} is {say('load', row.tension)}; "
        f"the profiler needs at least {say('load', least)} to travel."
    )
    yield at_least(part, row.tension, least, message, "Add buoyancy above the wire.")
    yield from _path_obstacles(part, wire)
    if component.drive_force is None:
        message = f"The drive force of {part.label} is unknown; it may be too small for the wire."
        yield unknown(
            part, message, "Set `drive_force` and `speed` of the profiler.", lacks="drive_force"
        )
        return
    flow, density = water.current_at(np.array(row.depth)), water.density_at(np.array(row.depth))
    lean = radians(row.tilt)
    past = (component.speed or 0.0) + float(np.linalg.norm(flow)) * sin(lean)
    drag = axial_drag_of(component) * float(density) / REFERENCE_DENSITY * past**2
    needed = drag + abs(net_buoyancy(component, water.gravity)) * cos(lean)
    message = (
        f"{part.label} needs {say('load', needed)} to travel along {wire.label} against drag and "
        f"its own weight; its drive force is {say('load', component.drive_force)}."
    )
    remedy = "Add buoyancy to straighten the wire, or reduce the speed of the profiler."
    yield at_least(part, component.drive_force, needed, message, remedy)


LONGEST_PROFILE = 8.0 * 3600.0 / 1.25
"""Longest duration of a profile [s].

A McLane profiler stops after 1.25 times the expected time, or after 8 hours.
"""


def _lasting(travels: Sequence[ProfilerTravel], part: Clamp) -> Iterator[Verdict]:
    for travel in travels:
        if travel.label == part.label and (travel.time or 0.0) > LONGEST_PROFILE:
            took, most = duration(travel.time or 0.0), duration(LONGEST_PROFILE)
            message = f"A profile of {part.label} takes {took}; the limit is {most}."
            yield verdict_on(part, State.WARN, message, "Shorten the profile, or increase `speed`.")


def _path_obstacles(part: Clamp, wire: Piece) -> Iterator[Verdict]:
    upper, lower = part.travel or (0.0, 0.0)
    for other in wire.clamps:
        if upper < other.at < lower and other is not part:
            message = f"{other.label}, {other.at:.0f} m down the wire, blocks {part.label}."
            yield verdict_on(part, State.FAIL, message, "Move the obstacle outside the stops.")
    thin, thick = PROFILER_WIRE
    diameter = getattr(wire.component, "diameter", 0.0)
    if not thin <= round(diameter, 5) <= thick:
        message = (
            f"{wire.label} has a diameter of {1000.0 * diameter:.1f} mm; profilers travel on "
            f"jacketed wire of {1000.0 * thin:.2f} to {1000.0 * thick:.2f} mm."
        )
        remedy = "Ask the manufacturer of the profiler."
        yield verdict_on(part, State.WARN, message, remedy, diameter)


def _clamps(leg: Leg) -> list[JudgedPart]:
    parts = (part for part in parts_of(leg) if part.clamp is not None)
    return [part for part in parts if not isinstance(part.component, Profiler)]


def _lift(part: JudgedPart, leg: Leg, density: float) -> float:
    """Return the net force on a submerged part [N], positive up.

    `density` is the water density [kg/m³].
    """
    gravity, volume = leg.water.gravity, part.component.displaced_volume or 0.0
    excess = (density - REFERENCE_DENSITY) * volume * gravity
    return net_buoyancy(part.component, gravity) + excess


def _verdict(part: JudgedPart, pull: float, when: str) -> Verdict:
    grip, breaking = part.component.grip, part.component.breaking_load
    load = f"The load on the clamp of {part.label}{when} is {say('load', pull)}"
    if grip is not None:
        message = f"{load}; the grip of the clamp is {say('load', grip)}."
        return at_most(part, pull, grip, message, _HOLDS)
    if breaking is not None:
        message = f"{load}; the breaking load of the clamp is {say('load', breaking)}."
        return at_most(part, pull, breaking, message, _HOLDS)
    message = f"{load}; the `grip` of the clamp is unknown."
    not_judged = verdict_on(part, State.NOT_JUDGED, message, value=pull)
    return not_judged.but(lacks=Lack(part.label, "grip"))
