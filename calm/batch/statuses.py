"""How the profiles of a batch end, and what that means for what is counted of them."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum

from calm.solve import Status


class Ending(Enum):
    """What a status comes to, in words."""

    SOLVED = "solved"
    NO_EQUILIBRIUM = "without equilibrium"
    NOT_CONVERGED = "not converged"
    NO_DATA = "without data"


STATUSES = (*(status.label for status in Status), "no-current", "levels-coincide",
            "implausible-current")  # fmt: skip
"""What the numbers of a `status` mean; the first is 0."""

IN_WEAK_CURRENT = frozenset({Status.SLACK.label, Status.ABOVE_SURFACE.label})
"""Statuses of a line that the current is too weak to pull tight or to keep in the water: the
extremes of its response are not among these profiles. They may be among those of the others."""

_ENDINGS = {
    Status.CONVERGED.label: Ending.SOLVED,
    Status.NOT_CONVERGED.label: Ending.NOT_CONVERGED,
    "no-current": Ending.NO_DATA,
    "levels-coincide": Ending.NO_DATA,
    "implausible-current": Ending.NO_DATA,
}


def ending_of(status: str) -> Ending:
    """What a status of `STATUSES` comes to."""
    return _ENDINGS.get(status, Ending.NO_EQUILIBRIUM)


def endings(counts: Mapping[str, int]) -> dict[Ending, int]:
    """Profiles by how they ended, 0 where none did.

    Parameters
    ----------
    counts : profiles by their status
    """
    ended = dict.fromkeys(Ending, 0)
    for status, count in counts.items():
        ended[ending_of(status)] += count
    return ended
