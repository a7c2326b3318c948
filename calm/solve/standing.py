"""Whether the buoyancy of a line holds it up, in the water it stands in."""

from __future__ import annotations

import numpy as np

from calm.errors import NoEquilibrium
from calm.physics.line import Floats, Line, Water
from calm.physics.seawater import REFERENCE_DENSITY
from calm.solve.solution import Status


def standing_lift(line: Line, water: Water) -> Floats:
    """(n,) net force of every piece with its clamps where it would stand upright, + up [N].

    Upright is unstretched, from the anchor up; what would stand out of the water counts as just
    below the surface.
    """
    below = np.cumsum(line.length[::-1])[::-1] - 0.5 * line.length
    depth = np.maximum(water.depth - line.anchor_height - below, 0.0)
    _, density = water.at(depth)
    return line.net_force((density - REFERENCE_DENSITY) * water.gravity)


def surface_lift(line: Line, water: Water) -> Floats:
    """(n,) net force of every piece without its clamps in the water of the surface, + up [N]."""
    _, density = water.at(np.zeros(1))
    return line.buoyancy + (float(density[0]) - REFERENCE_DENSITY) * water.gravity * line.volume


def standing_length(line: Line, lift: Floats) -> float:
    """Length of the line standing upright in still water, each piece stretched by its mean
    tension [m]; where a clamp hangs on a piece makes no difference here. `lift` is the
    `standing_lift`."""
    tension = np.maximum(np.cumsum(lift) - 0.5 * lift, 0.0)
    strain: Floats = line.compliance * tension
    for piece, curve in enumerate(line.elongation):
        if curve is not None:
            strain[piece] = curve.strain(float(tension[piece]))
    return float(((1.0 + strain) * line.length).sum())


SUPPORTED, TOO_HEAVY, FOLDS = range(3)
"""Whether a line is held up, or why not."""


def support_of(lift: Floats, at_rest: bool) -> tuple[int, int, float]:
    """Return whether a line is held up, else the piece below which it folds and what is lacking
    [N].

    Parameters
    ----------
    lift : the `standing_lift`
    at_rest : whether nothing moves; then it must stay held up down to its lowest float
    """
    above = np.cumsum(lift)
    if not (above > 0.0).any():
        return TOO_HEAVY, -1, 0.0
    if not at_rest:
        return SUPPORTED, -1, 0.0
    first, last = int(np.argmax(above > 0.0)), int(np.flatnonzero(lift > 0.0)[-1])
    short = np.flatnonzero(above[first:last] <= 0.0)
    if not len(short):
        return SUPPORTED, -1, 0.0
    piece = first + int(short[0])
    return (TOO_HEAVY if above[-1] <= 0.0 else FOLDS), piece, -float(above[piece])


def refuse_unsupported(line: Line, water: Water, lift: Floats) -> None:
    """Refuse a line that nothing holds up or, in still water, one that folds.

    Once held up it must stay so, down to its lowest float. `lift` is the `standing_lift`.

    Raises
    ------
    NoEquilibrium
        ``slack``, or ``no-equilibrium`` where too little holds the line up.
    """
    blown = line.floating is not None and line.floating.blown
    support, piece, lacking = support_of(lift, not (water.moving or blown))
    if support == TOO_HEAVY:
        raise too_heavy(lift)
    if support == FOLDS:
        raise Status.SLACK.because(
            f"In still water the line is slack below {{piece}}: {lacking:.0f} N are "
            "lacking to hold up what is above.",
            piece,
        )


def too_heavy(lift: Floats) -> NoEquilibrium:
    """The exception for a line that its buoyancy does not hold up, piece by piece [N]."""
    up, down = float(lift[lift > 0.0].sum()), float(-lift[lift < 0.0].sum())
    return Status.NO_EQUILIBRIUM.because(
        f"Too little buoyancy to hold the line up: its buoyant pieces lift {up:.0f} N, the "
        f"others weigh {down:.0f} N in water."
    )
