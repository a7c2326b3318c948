"""From the neighbourhood of a root to a shape of known error.

The march chooses its cuts at twice the angle step; on these the line is closed, and again with
every segment halved. The march is of second order, so a third of the change is the error of the
finer shape; where that is too much, all is done again with a smaller step.

A load or stretch that changes abruptly inside a segment, where a law of drag switches or a table
bends, may count for the same on coarse and on halved segments. It shows as a bend between
neighbours, and that is added.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import degrees, sqrt

import numpy as np

from calm.physics.line import Floats, Line
from calm.physics.march import Cuts
from calm.solve.closing import Closed, Closing, Root
from calm.solve.solution import nodes_of, sizes

DEPTH_TARGET = 4e-5
TENSION_TARGET = 1.6e-4
"""Error estimates, relative to the span and to the tension, above which the step is taken
smaller, at an angle step of 1°; they follow its square."""
MOST_ROUNDS = 6
MOST_SEGMENTS = 20_000
AT_A_LEVEL = 0.05
"""How near to a level, in segments, a node is as good as there: bends are at home at levels."""


@dataclass(frozen=True)
class Refined:
    """A closed line and its errors: of depths and offsets [m], of tensions [N], and of the upward
    and the horizontal force at its end [N]."""

    closed: Closed
    depth_error: float
    tension_error: float
    lift_error: float
    pull_error: float


Polish = Callable[[Root, Cuts], Closed]
"""Closes a line on cuts, near a root."""


def refine(closing: Closing, root: Root, polish: Polish | None = None) -> Refined:
    """Close the line finely enough, from a coarse root.

    Parameters
    ----------
    polish : where that takes more than `Closing.polish`

    Raises
    ------
    NoEquilibrium
        Where the root cannot be polished.
    """
    polish = polish or closing.polish
    wanted = closing.settings.angle_step
    step = wanted
    for _ in range(MOST_ROUNDS):
        root, cuts = closing.planned(root, 2.0 * step)
        coarse = polish(root, cuts)
        fine = polish(coarse.root, cuts.halved())
        depth_error, tension_error, relative = _errors(closing.line, coarse, fine)
        target = degrees(wanted) ** 2
        excess = max(
            depth_error / (DEPTH_TARGET * target * closing.span),
            relative / (TENSION_TARGET * target),
        )
        if excess <= 1.0 or len(fine.end.cuts.lengths) > MOST_SEGMENTS:
            break
        root, step = fine.root, step * max(0.8 / sqrt(excess), 0.2)
    strayed, lost = _abrupt(closing.line, fine, closing.water.level)
    lift, pull = _errors_at_the_end(coarse, fine)
    return Refined(fine, depth_error + strayed, tension_error + lost, lift + lost, pull + lost)


def _errors(line: Line, coarse: Closed, fine: Closed) -> tuple[float, float, float]:
    """Error of the finer shape: of depths and offsets [m], of tensions [N] and relative.

    From the nodes both have: all but those around the touchdown, where there is one.
    """
    pieces, clamps = coarse.trace.piece[: coarse.hanging], coarse.trace.clamp[: coarse.hanging]
    halves = np.where(line.flexible[pieces] & (clamps < 0), 2, 1)
    same = np.concatenate([[0], np.cumsum(halves)])
    if coarse.end.landed:
        same = same[:-1]
    same = same[same <= fine.hanging]
    position, force = nodes_of(fine.trace)
    before, pulled = nodes_of(coarse.trace)
    place = float(np.abs(before[: len(same)] - position[same]).max()) / 3.0
    there = np.arange(len(same))
    lying = len(before) - 1 - coarse.hanging
    if coarse.end.landed and lying == len(position) - 1 - fine.hanging:
        there = np.concatenate([there, np.arange(coarse.hanging + 1, len(before))])
        same = np.concatenate([same, np.arange(fine.hanging + 1, len(position))])
    tension = sizes(force[same])
    change = np.abs(sizes(pulled[there]) - tension) / 3.0
    floor = 1e-3 * float(tension.max())
    return (
        place,
        float(change.max()),
        float((change / np.maximum(tension, max(floor, 1e-300))).max()),
    )


def _errors_at_the_end(coarse: Closed, fine: Closed) -> tuple[float, float]:
    """Error of the upward and of the horizontal force at the end of the finer shape [N].

    A third of the change is their error where the shape is smooth; a little more is stated, as
    these are two figures and no worst of many.
    """
    change = (coarse.trace.force[-1] - fine.trace.force[-1]) / 2.5
    return abs(float(change[2])), float(np.hypot(change[0], change[1]))


def _abrupt(line: Line, fine: Closed, levels: Floats) -> tuple[float, float]:
    """What the worst abrupt change inside a segment may cost: in place [m], in tension [N].

    If the slope of what a segment adds per metre bends by Δ inside one of length h, its value at
    the middle is off by up to Δh²/8. Where the curve is smooth the segments two away bend alike:
    only what exceeds their bend is abrupt.
    """
    hanging = fine.hanging
    trace = fine.trace
    piece, clamp, cut = trace.piece[:hanging], trace.clamp[:hanging], trace.cut[:hanging]
    segment = line.flexible[piece] & (clamp < 0) & (cut > 0.0)
    longer = np.maximum(cut[1:], cut[:-1])
    position, force = (nodes[: hanging + 1] for nodes in nodes_of(fine.trace))
    off = np.abs(position[1:-1, 2, None] + levels).min(axis=1)
    smooth = segment[1:] & segment[:-1] & (piece[1:] == piece[:-1]) & (off > AT_A_LEVEL * longer)
    between = smooth[1:] & smooth[:-1]
    if not between.any():
        return 0.0, 0.0
    length = np.where(segment, cut, 1.0)[:, None]
    # of place and force together: columns 0 to 2, and 3 to 5
    nodes = np.concatenate([position, force], axis=1)
    added = (nodes[1:] - nodes[:-1]) / length
    slope = (added[1:] - added[:-1]) / (0.5 * (length[1:] + length[:-1]))
    bend = (slope[1:] - slope[:-1]) * length[1:-1] ** 2 / 8.0
    bend = bend.reshape(-1, 2, 3)
    size = np.sqrt(np.einsum("ijk,ijk->ij", bend, bend))
    around = np.full((len(size) + 4, 2), -1.0)
    np.copyto(around[2:-2], size, where=between[:, None])
    usual = np.maximum(around[:-4], around[4:])
    abrupt = between[:, None] & (usual >= 0.0) & (size > usual)
    here = np.flatnonzero(abrupt.any(axis=1))
    if not here.size:
        return 0.0, 0.0
    bend, size, usual, abrupt = bend[here], size[here], usual[here], abrupt[here]
    share = np.divide(size - usual, size, out=np.zeros_like(size), where=abrupt)
    strayed, lost = share[:, 0, None] * bend[:, 0], share[:, 1, None] * bend[:, 1]
    # what a force adds to the tension there, and where the line hangs from in the end
    pulled = force[[*here + 2, -1]]
    tension = sizes(pulled)[:, None]
    axis = np.divide(pulled, tension, out=np.zeros_like(pulled), where=tension > 0.0)
    along = np.maximum(np.abs((lost * axis[:-1]).sum(axis=1)), np.abs(lost @ axis[-1]))
    return float(sizes(strayed).max()), float(along.max())
