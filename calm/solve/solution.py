"""Settings of the solver, and its result: a solution, or a status that explains its absence."""

from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property
from itertools import accumulate
from math import nan, radians
from typing import NamedTuple

import numpy as np

from calm.errors import NoEquilibrium
from calm.physics.hull import Riding
from calm.physics.line import Floats, Integers, Line, Trace, Water, once_at_rest
from calm.physics.seawater import REFERENCE_DENSITY

LOOSEST_TOLERANCE = 2e-4
"""Largest accepted height error of the line's end, as a fraction of the water depth."""


@dataclass(frozen=True)
class Settings:
    """Settings of the solver.

    Attributes
    ----------
    angle_step : largest rotation of a segment of the line [rad]
    tolerance : allowed height error at the line's end, as a fraction of the water depth
    seabed_friction : friction coefficient of a line on the seabed [-]
    compiled : whether to use the compiled solver; None leaves the choice to `calm.solve.two_speeds`
    """

    angle_step: float = radians(1.0)
    tolerance: float = 1e-7
    seabed_friction: float = 0.0
    compiled: bool | None = None

    def __post_init__(self) -> None:
        if not 0.0 < self.angle_step <= radians(10.0):
            raise ValueError("angle_step must be above 0 and at most 10 degrees")
        if not 0.0 < self.tolerance <= LOOSEST_TOLERANCE:
            raise ValueError(f"tolerance must be above 0 and at most {LOOSEST_TOLERANCE}")
        if not self.seabed_friction >= 0.0:
            raise ValueError("seabed_friction must not be negative")


class OtherEquilibrium(NamedTuple):
    """Another equilibrium of a line.

    Attributes
    ----------
    depth : depth of the free end [m]; negative if there is no other equilibrium
    grounded_length : length on the seabed [m]
    used_buoyancy : used fraction of the surface float's buoyancy; 1 if submerged
    anchor_vertical, anchor_horizontal : upward and horizontal force at the line's end [N]
    """

    depth: float
    grounded_length: float
    used_buoyancy: float
    anchor_vertical: float
    anchor_horizontal: float


@dataclass(frozen=True)
class Solution:
    """A line in equilibrium, as k elements between k + 1 nodes; the free end comes first.

    Positions and forces are extrapolated to zero segment length.

    Attributes
    ----------
    line, water, settings : the solved problem; for a tow, the current is relative to the ship
    position : (k+1, 3) east and north of the anchor or tow point, and up from the surface [m]
    force : (k+1, 3) sum of the external forces between the free end and each node [N]
    element_piece : (k,) index of each element's piece
    element_clamp : (k,) index of the clamp that an element without length represents, else -1
    landed, grounded_length : whether part of the line lies on the seabed, and its unstretched
        length [m]
    hanging : number of suspended elements, which come first
    cut, strain : (k,) unstretched length [m] and strain of each element
    afloat : indices of the pieces at the surface
    buoyancy_used, reserve : used fraction and unused amount [N] of the surface floats' buoyancy
    carried : the line, with buoyancy and drag reduced for floats at the surface
    riding : draft of the surface float and the forces on this float, if computed
    miss : height of the line's end above its target (anchor top, seabed or tow point) [m]; absolute
        for a tow
    closure : relative force imbalance, |sum of the loads - end force| / |end force|
    moment_residual : largest deviation of an element's axis from its moment balance [rad]
    depth_error, tension_error : estimated largest error of depths and offsets [m], and of tensions
        [N]
    lift_error, pull_error : estimated error of the upward and horizontal end force [N]
    frequency : strumming frequency [Hz]; 0 without strumming
    pulled : whether a force acts on the first end, as on a leg of a net
    marched : the audited shape before extrapolation; None if nothing was extrapolated
    slack : length on the seabed minus the distance to the anchor, for a slack leg [m]
    """

    line: Line
    water: Water
    settings: Settings
    position: Floats
    force: Floats
    element_piece: Integers
    element_clamp: Integers
    landed: bool
    hanging: int
    grounded_length: float
    cut: Floats
    strain: Floats
    afloat: tuple[int, ...]
    buoyancy_used: float
    reserve: float
    carried: Line
    marches: int
    segments: int
    miss: float
    depth_error: float
    tension_error: float
    lift_error: float
    pull_error: float
    other: OtherEquilibrium | None = None
    frequency: float = 0.0
    riding: Riding | None = None
    closure: float = nan
    moment_residual: float = nan
    pulled: bool = False
    slack: float = 0.0
    marched: Trace | None = None

    @property
    def as_marched(self) -> "Solution":
        """The solution with the audited shape, before extrapolation."""
        closed = self.marched
        if closed is None:
            return self
        return replace(self, position=closed.position, force=closed.force, marched=None)

    @property
    def surface(self) -> bool:
        """Whether part of the line is at the sea surface."""
        return bool(self.afloat)

    @cached_property
    def tension(self) -> Floats:
        """Tension at the nodes (k+1,) [N]."""
        size: Floats = np.linalg.norm(self.force, axis=1)
        return size

    @cached_property
    def piece_nodes(self) -> Integers:
        """Numbers of the first and last node of every piece (n, 2)."""
        pieces = self.element_piece
        n = len(self.line.length)
        first = np.searchsorted(pieces, np.arange(n), side="left")
        last = np.searchsorted(pieces, np.arange(n), side="right")
        return np.column_stack([first, last]).astype(np.intp)

    @property
    def body_node(self) -> int:
        """Node at which the lowest piece of a tow is attached, or the end node of a bare cable."""
        return 0 if self.line.flexible[0] else int(self.piece_nodes[0, 1])

    def piece_at(self, node: int) -> int:
        """Return the index of the piece that contains a node or ends at the node."""
        return int(self.element_piece[max(node - 1, 0)])


def sizes(vectors: Floats) -> Floats:
    """Return the lengths (n,) of an array of vectors (n, 3)."""
    lengths: Floats = np.sqrt(np.einsum("ij,ij->i", vectors, vectors))
    return lengths


def nodes_of(trace: Trace) -> tuple[Floats, Floats]:
    """Return the positions and forces, each (k+1, 3), at the nodes of a recorded shape.

    Horizontal positions are relative to the end of the line; heights are above the surface [m].
    """
    position = trace.position.copy()
    position[:, :2] -= position[-1, :2]
    return position, trace.force


class Status(Enum):
    """Outcome of a solve, with its name in files and the advice shown if the solve failed."""

    CONVERGED = ("converged", "")
    NO_EQUILIBRIUM = (
        "no-equilibrium",
        "Add buoyancy at the top, remove weight from the line, or check the current profile.",
    )
    NOT_CONVERGED = (
        "not-converged",
        "Try another angle_step. If the error persists, simplify the line to find the cause.",
    )
    SLACK = (
        "slack",
        "Shorten the line below the surface float, or set the design current.",
    )
    GROUNDED = (
        "grounded",
        "Shorten or lighten the lower part, or add buoyancy to it or at the top.",
    )
    ANCHOR_LIFTS = ("anchor-lifts", "Use a heavier anchor, or less buoyancy.")
    ABOVE_SURFACE = (
        "above-surface",
        "Shorten the line, or combine all buoyancy that reaches the surface in one surface float.",
    )

    def __init__(self, label: str, advice: str) -> None:
        self.label = label
        self.advice = advice

    def because(
        self, message: str, piece: int | None = None, advice: str | None = None
    ) -> NoEquilibrium:
        """Build the exception for a solve with this outcome.

        Parameters
        ----------
        message : reason, in which `{piece}` stands for the piece concerned
        piece : index of this piece
        advice : replaces the default advice, which applies to moorings
        """
        return NoEquilibrium(self.label, message, self.advice if advice is None else advice, piece)


(
    FOUND,
    # a march stopped; the value is the reason, see `calm.physics.line`
    MARCH_STOPPED,
    # no closed shape near a coarse one; a shape that misses its end by the value [m]; one that
    # depends on the last digits of the used buoyancy
    NO_SHAPE_NEAR, MISSES, SLACK_ON_DIGITS,
    # no current and a line longer than the water depth; floats that do not stay in the water
    SLACK_AT_REST, TOO_MANY_AFLOAT, RISES,
    # dragged down to the seabed; no touchdown found after all; nothing that supports the line
    DRAGGED_DOWN, NOT_LYING, UNSUPPORTED,
    # a piece below the seabed, or above the surface, by its value [m]
    BELOW_SEABED, ABOVE_SURFACE,
    # loads that do not balance, or an element out of balance (the residual of the audit as value)
    NOT_CLOSED, OUT_OF_BALANCE,
    # the line folds in still water
    FOLDED,
) = range(16)  # fmt: skip


@once_at_rest
def standing_lift(line: Line, water: Water) -> Floats:
    """Return the net buoyancy (n,) of each piece and its clamps in an upright line [N].

    Net buoyancy is positive up. The line is unstretched, and parts above the water count as
    submerged.
    """
    below = np.cumsum(line.length[::-1])[::-1] - 0.5 * line.length
    depth = np.maximum(water.depth - line.anchor_height - below, 0.0)
    density = water.density_at(depth)
    lift = line.net_force((density - REFERENCE_DENSITY) * water.gravity)
    lift.flags.writeable = False  # it is shared
    return lift


def surface_lift(line: Line, water: Water) -> Floats:
    """Return the net buoyancy (n,) of every piece in water at the surface [N], positive up.

    The clamps of the pieces are not included.
    """
    excess = float(water.density_at(np.zeros(()))) - REFERENCE_DENSITY
    return line.buoyancy + excess * water.gravity * line.volume


@once_at_rest
def standing_length(line: Line, water: Water) -> float:
    """Return the length of the upright line in still water [m].

    Each piece is stretched by its mean tension. The position of clamps on a piece is ignored.
    """
    lift = standing_lift(line, water)
    tension = np.maximum(np.cumsum(lift) - 0.5 * lift, 0.0)
    strain: Floats = line.compliance * tension
    for piece, curve in enumerate(line.elongation):
        if curve is not None:
            strain[piece] = curve.strain(float(tension[piece]))
    return float(((1.0 + strain) * line.length).sum())


SUPPORTED, TOO_HEAVY, FOLDS = range(3)
"""Results of the buoyancy check: enough buoyancy, or the reason why a line fails."""


def support_of(lift: Floats, at_rest: bool) -> tuple[int, int, float]:
    """Check whether a line has enough buoyancy.

    Parameters
    ----------
    lift : result of `standing_lift`
    at_rest : whether there is neither current nor wind; each part above the lowest float must then
        be held up

    Returns
    -------
    `SUPPORTED`, `TOO_HEAVY` or `FOLDS`; index of the piece below which the line is not held up, or
    -1; missing buoyancy above this point [N].
    """
    lifts = lift.tolist()
    above = list(accumulate(lifts))
    supported = [piece for piece, pull in enumerate(above) if pull > 0.0]
    if not supported:
        return TOO_HEAVY, -1, 0.0
    if not at_rest:
        return SUPPORTED, -1, 0.0
    last = max(piece for piece, pull in enumerate(lifts) if pull > 0.0)
    for piece in range(supported[0], last):
        if above[piece] <= 0.0:
            return (TOO_HEAVY if above[-1] <= 0.0 else FOLDS), piece, -above[piece]
    return SUPPORTED, -1, 0.0


def refuse_unsupported(line: Line, water: Water) -> None:
    """Raise NoEquilibrium if a line has too little buoyancy, or folds in still water.

    Raises
    ------
    NoEquilibrium
        ``slack`` if the line folds; ``no-equilibrium`` if it has too little buoyancy.
    """
    blown = line.floating is not None and line.floating.blown
    lift = standing_lift(line, water)
    support, piece, lacking = support_of(lift, not (water.moving or blown))
    if support == TOO_HEAVY:
        raise too_heavy(lift)
    if support == FOLDS:
        raise Status.SLACK.because(
            f"In still water, the line is slack below {{piece}}: the part above needs another "
            f"{lacking:.0f} N of buoyancy.",
            piece,
        )


def too_heavy(lift: Floats) -> NoEquilibrium:
    """Return the exception for a line with too little buoyancy.

    Parameters
    ----------
    lift : (n,) net buoyancy of each piece [N]
    """
    up, down = float(lift[lift > 0.0].sum()), float(-lift[lift < 0.0].sum())
    return Status.NO_EQUILIBRIUM.because(
        f"There is too little buoyancy to hold the line up: the net buoyancy of the buoyant pieces "
        f"is {up:.0f} N, but the weight of the other pieces in water is {down:.0f} N."
    )
