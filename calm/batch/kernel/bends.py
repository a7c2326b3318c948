"""Where a line that may land is cut: each case for itself, short where it bends.

A slack line hangs straight, and bends within a length that may be a thousandth of the depth: at its
touchdown, or where something light follows something heavy.

`own` has three layers of a row for each case: the lengths of its cuts [m], the share of the plan's
cuts that each makes up, and how much it turned in the last march [rad], `DOWN` where it lay.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from calm.batch.kernel.compiled import compiled
from calm.batch.kernel.lanes import CABLE
from calm.physics.line import Floats

ROUNDS = 3
"""How often a line is closed for its cuts to follow its bends."""
LANDS = 12
"""Where the stages of a plan tell whether the line may land."""
DOWN = -1.0
FEW = 8
"""One cut in so many is left to what lies of a cable."""
TURN, MOST = 0.5, 2.0
"""A turn that draws as many cuts as the plan has [rad]; how many times as many a turn may draw."""


@compiled
def as_planned(own: Floats, c: int, stages: Any) -> None:
    """Cut a case as the plan has it."""
    kinds, firsts, counts, cuts = stages[0], stages[1], stages[2], stages[5]
    for n in range(kinds.size):
        if kinds[n] == CABLE:
            for j in range(firsts[n], firsts[n] + counts[n]):
                own[0, c, j], own[1, c, j], own[2, c, j] = cuts[j], 1.0 / counts[n], 0.0


@compiled
def recut(own: Floats, c: int, stages: Any) -> None:
    """Cut every cable of a case anew, by what its last march turned."""
    kinds, firsts, counts = stages[0], stages[1], stages[2]
    for n in range(kinds.size):
        if kinds[n] == CABLE and counts[n] > 1:
            here = slice(firsts[n], firsts[n] + counts[n])
            spread(own[0, c, here], own[1, c, here], own[2, c, here])


@compiled
def spread(cuts: Floats, shares: Floats, turns: Floats) -> None:
    """Cut so that every cut has as much of the plan's cuts and of the bends together.

    A segment of length h that turns by δ is hδ²/24 off its arc. The sum of that is least for so
    many segments where their number goes with the curvature to the power of 2/3. What lies is cut
    evenly, but for a little beyond the touchdown, which may yet move.
    """
    hanging = 0
    while hanging < cuts.size and turns[hanging] != DOWN:
        hanging += 1
    if hanging == 0:
        return
    count, many = hanging, cuts.size
    old_cuts, old_shares, turn = np.zeros(many + 1), np.zeros(many + 1), np.zeros(many + 1)
    old_cuts[:hanging], old_shares[:hanging] = cuts[:hanging], shares[:hanging]
    turn[:hanging] = turns[:hanging]
    if hanging < cuts.size:
        lying, share = cuts[hanging:].sum(), shares[hanging:].sum()
        beyond = min(cuts[hanging - 1] / lying, 0.5)
        old_cuts[hanging], old_shares[hanging] = beyond * lying, beyond * share
        count, many = hanging + 1, cuts.size - max(cuts.size // FEW, 1)
        for k in range(many, cuts.size):
            cuts[k] = (1.0 - beyond) * lying / (cuts.size - many)
            shares[k] = (1.0 - beyond) * share / (cuts.size - many)
    deal(old_cuts[:count], old_shares[:count], turn[:count], cuts[:many], shares[:many])


@compiled
def deal(old_cuts: Floats, old_shares: Floats, turn: Floats, cuts: Floats, shares: Floats) -> None:
    """Deal out some cuts anew: see `spread`."""
    last = old_cuts.size - 1
    draw = np.zeros(old_cuts.size)
    for j in range(old_cuts.size):
        # a bend is seen between two cuts
        seen = turn[j] + 0.5 * (turn[max(j - 1, 0)] + turn[min(j + 1, last)])
        draw[j] = (old_cuts[j] * seen * seen) ** (1.0 / 3.0)
    weight = min(turn.sum() / TURN, MOST) * old_shares.sum() / max(draw.sum(), 1e-300)
    for j in range(old_cuts.size):
        draw[j] = old_shares[j] + weight * draw[j]
    each, j, left = draw.sum() / cuts.size, 0, 1.0
    for k in range(cuts.size):
        wanted = each
        cuts[k] = shares[k] = 0.0
        while j < last and (k == cuts.size - 1 or left * draw[j] <= wanted):
            wanted -= left * draw[j]
            cuts[k] += left * old_cuts[j]
            shares[k] += left * old_shares[j]
            j, left = j + 1, 1.0
        part = left if k == cuts.size - 1 else min(wanted / draw[j], left)
        cuts[k] += part * old_cuts[j]
        shares[k] += part * old_shares[j]
        left -= part
