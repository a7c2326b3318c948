"""Rules on deployment and recovery: back-up buoyancy, launch, ascent."""

from collections.abc import Iterator
from math import isnan

from calm.checks.assessment import Handling
from calm.checks.criterion import cited
from calm.checks.finding import State, Verdict, at_least, at_most, rule, unknown, verdict_on
from calm.checks.leg_graph import Break, Loss
from calm.checks.posture import reaches_the_surface
from calm.checks.recovery import Recovery
from calm.checks.strength import (
    governing_load,
    load_text,
    no_load_known,
    passes_load_on,
    wanted_load,
)
from calm.drop.launch import Launch
from calm.errors import NoEquilibrium
from calm.files import LinePart
from calm.quantities import QUANTITIES, duration, say

GREATEST_TOUCHDOWN_SPEED = 2.5
"""Touchdown speed above which an anchor may bury itself or damage instruments [m/s]."""
USUAL_RISE_SPEED = 0.7
"""Rise speed below which the check warns [m/s]: slow lines take hours to surface, and drift."""
FAST_RISE_SPEED = 3.0
"""Rise speed above which the check warns [m/s]: floats breach near the ship, and the line loops."""


def is_hauled_in(handling: Handling) -> bool:
    """Return whether a line is recovered by hauling it in from its surface float.

    This is the case for a line with a surface float and no release.
    """
    return handling.leg.file.release is None and reaches_the_surface(handling.leg)


@rule("backup", once=True, case="B")
def backup(handling: Handling) -> Iterator[Verdict]:
    """Check the net buoyancy that lifts the release after a break or the loss of a float.

    The remaining net buoyancy must be at least `backup_margin` × the lifted weight, and sufficient
    for a rise at `minimum_rise_speed`. A line with a single float is not judged if
    `LegGraph.breaks` judges none of its breaks.
    """
    if handling.leg.file.release is None:
        if is_hauled_in(handling):
            message = (
                "A line without a release is hauled in; if it breaks, the pieces below the break "
                "stay on the seabed."
            )
            yield verdict_on(None, State.NOT_JUDGED, message)
            return
        yield unknown(
            None,
            "The line has no release, so nothing surfaces after a break.",
            "Mark the release with `role: release`.",
        )
        return
    if not handling.backup:
        yield unknown(
            None,
            "The load on the release is unknown, because the line has no equilibrium.",
            "Change the line until it has an equilibrium.",
        )
        return
    breaks = [one for one in handling.backup if one.judged]
    judged: list[Break | Loss] = [*breaks, *handling.losses]
    worst = min(judged, key=lambda one: one.margin - one.required, default=handling.backup[-1])
    if isinstance(worst, Loss):
        part: LinePart = worst
        after, where = f"After the loss of {worst.label}", "above the release"
    else:
        part = handling.leg.file.pieces[worst.break_after]
        after = f"After a break below {worst.label}"
        where = f"between {worst.label} and the release"
    if not breaks and len(handling.losses) == 1:
        message = (
            f"{handling.losses[0].label} provides all the buoyancy, so there is no "
            "back-up buoyancy."
        )
        remedy = "Use several floats if the line must surface after the loss of one."
        yield verdict_on(handling.losses[0], State.NOT_JUDGED, message, remedy)
        return
    hauled_in = reaches_the_surface(handling.leg) and len(handling.losses) == 1
    yield at_least(
        part,
        worst.margin,
        worst.required,
        f"{after}, the section with the release has a net buoyancy of "
        f"{say('load', worst.margin)}; it needs {say('load', worst.required)} to surface.",
        f"Add {say('load', worst.required - worst.margin)} of buoyancy {where}.",
        State.WARN if hauled_in else State.FAIL,
        source=cited(handling.leg.file, "backup_margin", "minimum_rise_speed"),
    )


@rule("launch-strength", once=True, case="L")
def launch_strength(handling: Handling) -> Iterator[Verdict]:
    """Check the tension in every piece while the anchor drops and pulls the line down.

    The limit is the smaller of working load × `launch_working_factor` and breaking load /
    `launch_safety_factor`.
    """
    launch, file = handling.launch, handling.leg.file
    if isinstance(launch, NoEquilibrium):
        yield from _unsolved(handling, "descent", launch)
        return
    times, over = file.checks.launch_working_factor, file.checks.launch_safety_factor
    most = "" if launch.anchor_drag_known else " at most"
    for piece, tension in zip(file.pieces, launch.greatest_tension.tolist(), strict=False):
        limit, figure = governing_load(piece.component, times, over)
        carried = load_text(piece, tension, " during the descent", most)
        if limit is None:
            if passes_load_on(file, piece.index):
                message, remedy = no_load_known(carried)
                lacks = wanted_load(piece.component)
                yield unknown(piece, message, remedy, tension, lacks=lacks)
            continue
        if figure == "working_load":
            load = "working load" if times == 1.0 else f"working load times {times:g}"
            source = cited(file, "launch_working_factor")
        else:
            load = f"breaking load divided by {over:g}"
            source = cited(file, "launch_safety_factor")
        message = f"{carried}; its {load} is {say('load', limit)}."
        if tension > limit and not launch.anchor_drag_known:
            message += " The drag of the anchor is unknown and was neglected."
            remedy, anchor = "Set the anchor's `kt`.", file.pieces[-1]
            yield unknown(piece, message, remedy, tension, lacks="kt", of=anchor)
            continue
        remedy = (
            "Use a stronger component, slow the anchor with a parachute, or lower it on a wire."
        )
        yield at_most(piece, tension, limit, message, remedy, source=source, figure=figure)


@rule("launch-speed", once=True, case="L")
def launch_speed(handling: Handling) -> Iterator[Verdict]:
    """Check the touchdown speed of the anchor."""
    launch = handling.launch
    if isinstance(launch, NoEquilibrium):
        yield from _unsolved(handling, "descent", launch)
        return
    anchor, speed = handling.leg.file.pieces[-1], launch.fall_speed
    slow, fast = (QUANTITIES["speed"].format(one) for one in launch.fall_speed_band)
    message = (
        f"Touchdown speed of the anchor is {say('speed', speed)} ({slow} to {fast} if the drag is "
        f"doubled or halved); the limit is {GREATEST_TOUCHDOWN_SPEED:g} m/s."
    )
    remedy = "Lower the anchor, or add drag with a parachute or a wider anchor."
    if launch.anchor_drag_known:
        limit = GREATEST_TOUCHDOWN_SPEED
        yield at_most(anchor, speed, limit, message, remedy, State.WARN)
        return
    message += (
        " The drag of the anchor is unknown; CALM uses the drag of a cube with the same volume. "
        f"Without any anchor drag, the speed would be {say('speed', launch.greatest_speed)}."
    )
    if launch.greatest_speed <= GREATEST_TOUCHDOWN_SPEED:
        yield at_most(anchor, speed, GREATEST_TOUCHDOWN_SPEED, message, remedy, State.WARN)
    else:
        yield unknown(anchor, message, "Set the anchor's `kt`.", speed, lacks="kt")


@rule("recovery", once=True, case="R")
def recovery(handling: Handling) -> Iterator[Verdict]:
    """Check the terminal rise speed of the line without its anchor.

    The rise of a line that is hauled in is not judged.
    """
    if is_hauled_in(handling):
        message = "A line without a release is hauled in with its anchor, so it has no ascent."
        yield verdict_on(None, State.NOT_JUDGED, message)
        return
    rise, limit = handling.recovery, handling.leg.file.checks.minimum_rise_speed
    if isinstance(rise, NoEquilibrium):
        yield from _unsolved(handling, "ascent", rise)
        return
    lowest = handling.leg.file.pieces[rise.released]
    if rise.time_to_surface == 0.0:
        yield _hauled_in(lowest, float(rise.arrival[rise.released]), rise)
        return
    speed, rises = rise.rise_speed, "does not rise"
    if speed > 0.0:
        rises = f"rises at {say('speed', speed)}"
    message = f"After release below {lowest.label}, the line {rises}; "
    still = ""
    if rise.in_still_water:
        still = (
            " This is the speed in still water, because no steady ascent was found in the current."
        )
    remedy = "Add buoyancy above the release, or remove weight."
    source = cited(handling.leg.file, "minimum_rise_speed")
    if limit <= speed < USUAL_RISE_SPEED:
        message += f"below {say('speed', USUAL_RISE_SPEED)} it surfaces late and drifts far.{still}"
        yield at_least(lowest, speed, USUAL_RISE_SPEED, message, remedy, State.WARN, source)
    elif speed > max(limit, FAST_RISE_SPEED):
        message += f"above {FAST_RISE_SPEED:g} m/s floats may breach and the line may loop.{still}"
        remedy = "Remove buoyancy, or keep the ship clear."
        yield at_most(lowest, speed, FAST_RISE_SPEED, message, remedy, State.WARN, source)
    else:
        message += f"{say('speed', limit)} is required.{still}"
        yield at_least(lowest, speed, limit, message, remedy, source=source)


@rule("tangling", once=True)
def tangling(handling: Handling) -> Iterator[Verdict]:
    """Warn if the line doubles back on itself during descent or ascent."""
    fall = "During the descent, pieces above overtake"
    rise = "During the ascent, pieces below overtake"
    lower = "Pay the line out under tension, or lower the anchor."
    motions: list[tuple[Launch | Recovery | NoEquilibrium, str, str, str]]
    motions = [(handling.launch, fall, lower, "L")]
    if not is_hauled_in(handling):
        up = "Put more of the buoyancy at the top."
        motions.append((handling.recovery, rise, up, "R"))
    for motion, what, remedy, case in motions:
        if not isinstance(motion, NoEquilibrium) and motion.tangles:
            pieces = [handling.leg.file.pieces[piece] for piece in motion.tangles]
            named = ", ".join(piece.label for piece in pieces[:3])
            more = f" and {len(pieces) - 3} more" if len(pieces) > 3 else ""
            message = f"{what} {named}{more}: the line doubles back and may tangle."
            yield verdict_on(pieces[0], State.WARN, message, remedy).but(case=case)


def _hauled_in(lowest: LinePart, arrival: float, rise: Recovery) -> Verdict:
    if isnan(arrival):
        depth = say("depth", float(rise.hangs_at[rise.released]))
        message = (
            f"After release, the lower end of the line ({lowest.label}) hangs at a depth of "
            f"{depth} and is hauled in."
        )
        return verdict_on(lowest, State.PASS, message)
    end = f"the lower end of the line ({lowest.label})"
    message = f"After release, {end} surfaces in {duration(arrival)}."
    return verdict_on(lowest, State.PASS, message, value=rise.rise_speed)


def _unsolved(handling: Handling, motion: str, failure: NoEquilibrium) -> Iterator[Verdict]:
    if handling.result is not None:  # otherwise, the rule `equilibrium` reports the line
        message = f"The {motion} of the line has no solution ({failure.status}): {failure.message}"
        yield unknown(None, message, failure.advice)
