"""The rules of the design check, in the order in which a design is reported."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from calm.checks.anchor import anchor_sliding, anchor_uplift, anchor_weight
from calm.checks.arrangement import metals, release_present, swivel
from calm.checks.clamps import clamp_grip, clamp_grip_on_the_way
from calm.checks.deployed import deployed_depth
from calm.checks.figures import figures
from calm.checks.finding import State, Verdict, rule, verdict_on
from calm.checks.handling import backup, launch_speed, launch_strength, recovery, tangling
from calm.checks.posture import depth_rating, excursion, knockdown, tilt, top_depth
from calm.checks.slack import slack
from calm.checks.strength import release_load, strength, strength_steps
from calm.checks.surface import freeboard, reserve, scope, watch_circle

if TYPE_CHECKING:
    from calm.errors import NoEquilibrium


@rule("equilibrium")
def equilibrium(failure: NoEquilibrium) -> Iterator[Verdict]:
    """Found only where there is none."""
    message = f"{failure.status}: {failure.message}"
    yield verdict_on(None, State.FAIL, message, failure.advice)


STILL_ONLY = verdict_on(
    None,
    State.WARN,
    "No environment has a current of 1 cm/s: what tilts, is knocked down and pulls in one is not "
    "judged.",
    "Give the current, or an environment that has one.",
)
"""What `equilibrium` says of a mooring that nothing moves to speak of."""

STANDING = (
    strength,
    release_load,
    clamp_grip,
    strength_steps,
    tilt,
    depth_rating,
    top_depth,
    knockdown,
    excursion,
    anchor_weight,
    anchor_uplift,
    anchor_sliding,
    slack,
    reserve,
    freeboard,
    watch_circle,
    scope,
)
"""What is judged of a `Result`, in every environment and situation."""

ONCE = (
    deployed_depth,
    figures,
    release_present,
    swivel,
    metals,
    backup,
    launch_strength,
    launch_speed,
    recovery,
    tangling,
    clamp_grip_on_the_way,
)
"""What is judged once of a mooring: its breaks, its launch and its recovery."""

RULES = {each.name: each for each in (equilibrium, *STANDING, *ONCE)}
"""Every rule by its name."""
