"""Where a line that may land is cut: each case for itself, short where it bends.

A slack line hangs straight, and bends within a length that may be a thousandth of the depth: at its
touchdown, or where something light follows something heavy.

`own` has three layers of a row for each case: the lengths of its cuts [m], the share of the plan's
cuts that each makes up, and how much it turned in the last march [rad], `DOWN` where it lay.
"""

from __future__ import annotations

from calm.batch.kernel.layout import Way
from calm.physics.line import Floats

ROUNDS = 3
"""How often a line is closed for its cuts to follow its bends."""
DOWN = -1.0
FEW = 8
"""One cut in so many is left to what lies of a cable."""
TURN, MOST = 0.5, 2.0
"""A turn that draws as many cuts as the plan has [rad]; how many times as many a turn may draw."""


def as_planned(own: Floats, c: int, way: Way) -> None:
    """Cut a case as the plan has it."""
    for k in range(way.first_cut.size - 1):
        count = way.first_cut[k + 1] - way.first_cut[k]
        for j in range(way.first_cut[k], way.first_cut[k + 1]):
            own[0, c, j], own[1, c, j], own[2, c, j] = way.cuts[j], 1.0 / count, 0.0


def recut(own: Floats, c: int, way: Way, paper: Floats) -> None:
    """Cut every cable of a case anew, by what its last march turned."""
    for k in range(way.first_cut.size - 1):
        first, end = way.first_cut[k], way.first_cut[k + 1]
        if end - first > 1:
            spread(own[0, c, first:end], own[1, c, first:end], own[2, c, first:end], paper)


def spread(cuts: Floats, shares: Floats, turns: Floats, paper: Floats) -> None:
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
    old_cuts, old_shares, turn = paper[0], paper[1], paper[2]
    for k in range(hanging):
        old_cuts[k], old_shares[k], turn[k] = cuts[k], shares[k], turns[k]
    if hanging < cuts.size:
        turn[hanging] = 0.0
        lying, share = total(cuts, hanging), total(shares, hanging)
        beyond = min(cuts[hanging - 1] / lying, 0.5)
        old_cuts[hanging], old_shares[hanging] = beyond * lying, beyond * share
        count, many = hanging + 1, cuts.size - max(cuts.size // FEW, 1)
        for k in range(many, cuts.size):
            cuts[k] = (1.0 - beyond) * lying / (cuts.size - many)
            shares[k] = (1.0 - beyond) * share / (cuts.size - many)
    deal(
        old_cuts[:count], old_shares[:count], turn[:count], paper[3, :count], cuts[:many],
        shares[:many],
    )  # fmt: skip


def total(values: Floats, first: int) -> float:
    """Sum of the values from one on."""
    found = 0.0
    for k in range(first, values.size):
        found += values[k]
    return found


def deal(
    old_cuts: Floats, old_shares: Floats, turn: Floats, draw: Floats, cuts: Floats, shares: Floats
) -> None:
    """Deal out some cuts anew: see `spread`."""
    last = old_cuts.size - 1
    for j in range(old_cuts.size):
        # a bend is seen between two cuts
        seen = turn[j] + 0.5 * (turn[max(j - 1, 0)] + turn[min(j + 1, last)])
        draw[j] = (old_cuts[j] * seen * seen) ** (1.0 / 3.0)
    weight = min(total(turn, 0) / TURN, MOST) * total(old_shares, 0) / max(total(draw, 0), 1e-300)
    for j in range(old_cuts.size):
        draw[j] = old_shares[j] + weight * draw[j]
    each, j, left = total(draw, 0) / cuts.size, 0, 1.0
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
