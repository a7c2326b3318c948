"""Statuses of the profiles in a batch, and their use in statistics."""

from collections.abc import Mapping
from enum import Enum
from math import hypot

import numpy as np
from numpy.typing import NDArray

from calm.batch.solving import LEVELS_COINCIDE, LIES_ON_SEABED, NO_CURRENT
from calm.case.leg import Leg
from calm.physics.line import Floats
from calm.records.current_terms import DEEPEST, IMPOSSIBLE
from calm.records.record import Record
from calm.solve import Status
from calm.solve.finish import STATUS_OF


class Ending(Enum):
    """Category of a profile's status in statistics."""

    SOLVED = "solved"
    NO_EQUILIBRIUM = "without equilibrium"
    NOT_CONVERGED = "not converged"
    NO_DATA = "without data"


STATUSES = (*(status.label for status in Status), "no-current", "levels-coincide",
            "implausible-current")  # fmt: skip
"""Names of the status numbers, beginning with 0."""

IN_WEAK_CURRENT = frozenset({Status.SLACK.label, Status.ABOVE_SURFACE.label})
"""Statuses of a line in a current too weak to tighten the line or to keep the line submerged. Such
profiles do not contain the extremes of a response.
"""

_ENDINGS = {
    Status.CONVERGED.label: Ending.SOLVED,
    Status.NOT_CONVERGED.label: Ending.NOT_CONVERGED,
    "no-current": Ending.NO_DATA,
    "levels-coincide": Ending.NO_DATA,
    "implausible-current": Ending.NO_DATA,
}


OF_PROFILES = {NO_CURRENT: "no-current", LEVELS_COINCIDE: "levels-coincide"}
"""Status of a profile without a usable current, by outcome."""


def status_of(leg: Leg, ending: int) -> int:
    """Convert the outcome of the solver for a profile to an index in `STATUSES`."""
    if ending == LIES_ON_SEABED:
        return STATUSES.index(leg.grounded_error("a piece").status)
    return STATUSES.index(OF_PROFILES.get(ending) or STATUS_OF[ending].label)


def ending_of(status: str) -> Ending:
    """Return the category of a status in `STATUSES`."""
    return _ENDINGS.get(status, Ending.NO_EQUILIBRIUM)


def endings(counts: Mapping[str, int]) -> dict[Ending, int]:
    """Convert numbers of profiles by status to numbers by category; a category without profiles has
    0.
    """
    ended = dict.fromkeys(Ending, 0)
    for status, count in counts.items():
        ended[ending_of(status)] += count
    return ended


_AT_ONCE = 8192


def implausible(
    depth: Floats, u: Floats, v: Floats, w: Floats | None, maximum_speed: float
) -> NDArray[np.bool_]:
    """Return whether each level (n, k) of current profiles is implausible.

    An implausible level is faster than `maximum_speed` [m/s], or deeper than any ocean. Levels
    above the surface and levels without a value are plausible.
    """
    with np.errstate(invalid="ignore", over="ignore"):
        squared = u * u + v * v + (0.0 if w is None else w * w)
        fast = (squared > maximum_speed * maximum_speed) & (depth >= 0.0)
        found: NDArray[np.bool_] = fast | ((depth > DEEPEST) & np.isfinite(squared))
    return found


def first_implausible(record: Record, maximum_speed: float) -> str:
    """Describe the first implausible current of a record by time, depth and speed.

    Raises InputError if the file is damaged.
    """
    for start in range(0, record.count, _AT_ONCE):
        depth, u, v, w = record.profiles(start, min(start + _AT_ONCE, record.count))
        found = implausible(depth, u, v, w, maximum_speed)
        if found.any():
            at, level = (int(index[0]) for index in np.nonzero(found))
            deep = float(depth[at if depth.ndim == 2 else ..., level])
            up = 0.0 if w is None else float(w[at, level])
            speed = hypot(u[at, level], v[at, level], up)
            time = np.datetime_as_string(record.time[start + at], unit="m")
            value = f"{speed:.5g} m/s" if np.isfinite(speed) else IMPOSSIBLE
            return f"the first at {time}, {deep:g} m: {value}"
    return ""
