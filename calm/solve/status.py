"""How a solve can end, and what to do about it."""

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
