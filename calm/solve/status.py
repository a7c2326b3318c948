"""How a search and a solve can end, and what to do about it."""

from __future__ import annotations

from enum import Enum

from calm.errors import NoEquilibrium


class Status(Enum):
    """An outcome: its name in files and its advice."""

    CONVERGED = ("converged", "")
    NO_EQUILIBRIUM = (
        "no-equilibrium",
        "Add buoyancy at the top, take weight off the line, or check the current profile.",
    )
    NOT_CONVERGED = (
        "not-converged",
        "Try another angle_step; if it persists, simplify the line to find what prevents it.",
    )
    SLACK = (
        "slack",
        "Shorten the line below the surface float, or give the current it has to stand in.",
    )
    GROUNDED = (
        "grounded",
        "Shorten, lighten or buoy up the lower part, or add buoyancy at the top.",
    )
    ANCHOR_LIFTS = (
        "anchor-lifts",
        "Use a heavier anchor, or less buoyancy.",
    )
    ABOVE_SURFACE = (
        "above-surface",
        "Shorten the line, or put the buoyancy that reaches the surface into the surface float.",
    )

    def __init__(self, label: str, advice: str) -> None:
        self.label = label
        self.advice = advice

    def because(
        self, message: str, piece: int | None = None, advice: str | None = None
    ) -> NoEquilibrium:
        """The exception that shows this outcome, at a piece of the line where it has one.

        `advice` is in place of the outcome's own, which is that for moorings.
        """
        return NoEquilibrium(self.label, message, self.advice if advice is None else advice, piece)


(
    FOUND,
    # a march stopped: its value is why, see `calm.physics.state`
    MARCH_STOPPED,
    # no closed shape near a coarser one; one that misses its end, by its value [m]; one that hangs
    # on the last digits of the buoyancy in use
    NO_SHAPE_NEAR, MISSES, SLACK_ON_DIGITS,
    # without current, longer than the water is deep; floats that do not keep the line in the water
    SLACK_AT_REST, TOO_MANY_AFLOAT, RISES,
    # dragged down to the seabed; not lying there after all; nothing that holds it up
    DRAGGED_DOWN, NOT_LYING, UNSUPPORTED,
    # a piece below the seabed, or above the surface, by its value [m]
    BELOW_SEABED, ABOVE_SURFACE,
    # loads that do not sum up, an element out of balance: by its value, of the audit
    NOT_CLOSED, OUT_OF_BALANCE,
    # it folds in still water
    FOLDED,
) = range(16)  # fmt: skip
