"""The march of all lanes from their free ends to the anchor."""

from __future__ import annotations

from math import inf
from typing import Any

from calm.batch.kernel.cable import pass_segments
from calm.batch.kernel.compiled import compiled
from calm.batch.kernel.lanes import (
    C_COMPLIANCE,
    CABLE,
    FREE_END,
    FX,
    FY,
    FZ,
    HANGING,
    HIGHEST,
    LANES,
    LEAST_PULL,
    LIGHTEST,
    LOWEST,
    QX,
    QY,
    QZ,
    RESTING,
    ROD,
    SHARPEST,
    STATE,
    TX,
    TY,
    TZ,
    Tables,
    X,
    Y,
    Z,
)
from calm.batch.kernel.loads import pass_clamp
from calm.batch.kernel.rod import pass_piece, pass_rod
from calm.batch.kernel.seabed import come_down, keep, lie_down, lie_loads, pass_to_seabed
from calm.physics.line import Floats


@compiled
def march(
    s: Floats, water: Tables, plan: Any, halvings: int, nodes: Floats, forces: Floats, own: Floats
) -> None:
    """March all lanes from their free ends; their states at every joint go to `nodes`.

    A line that may land is cut as its slot of `own` has it: see `calm.batch.kernel.bends`.
    """
    kinds, firsts, counts, lengths, cables, cuts, loads = plan[:7]
    gravity, limit, landing, grips, holds, lands = plan[7:]
    for i in range(LANES):
        s[X + i], s[Y + i], s[Z + i] = 0.0, 0.0, -s[FREE_END + i]
        s[FX + i], s[FY + i], s[FZ + i] = 0.0, 0.0, 0.0
        s[TX + i], s[TY + i], s[TZ + i] = 0.0, 0.0, -1.0
        s[QX + i], s[QY + i], s[QZ + i] = 0.0, 0.0, 0.0
        s[LOWEST + i], s[HIGHEST + i] = inf, -inf
        s[LIGHTEST + i], s[LEAST_PULL + i] = inf, inf
        s[RESTING + i], s[HANGING + i], s[SHARPEST + i] = -1.0, 0.0, 0.0
    cable = 0
    for n in range(kinds.size):
        first, count = firsts[n], counts[n]
        to_seabed = lands and n >= landing
        compliance = 0.0
        if to_seabed:
            keep(s)
        if kinds[n] == CABLE:
            mine = cables[cable]
            if lands:
                stretch, compliance = (n, first, count), mine[C_COMPLIANCE]
                pass_to_seabed(s, water, mine, own, stretch, halvings, gravity, to_seabed)
            else:
                pass_segments(s, water, mine, cuts[first : first + count], halvings, gravity)
            cable += 1
        else:
            hung, written = loads[first : first + count], forces[3 * LANES * first :]
            if kinds[n] == ROD and count == 1 and n > 0:
                pass_piece(s, water, loads, first, lengths[n], gravity, limit)
            elif kinds[n] == ROD:
                pass_rod(s, water, hung, lengths[n], gravity, limit, n == 0, written)
            else:
                pass_clamp(s, water, hung, gravity, written)
            if to_seabed:
                come_down(s, kinds[n], n)
        if to_seabed:
            lie_down(s, lengths[n], grips[n], compliance)
            if kinds[n] == ROD and count > 1:
                lie_loads(s, holds[first : first + count], n, forces[3 * LANES * first :])
        if n >= landing:
            for i in range(LANES):
                fz = s[FZ + i]
                s[LIGHTEST + i] = fz if fz < s[LIGHTEST + i] else s[LIGHTEST + i]
        if n == 0:
            note(s, nodes, 0)
            for i in range(LANES):
                nodes[X + i] = 0.0
                nodes[Y + i] = 0.0
                nodes[Z + i] = s[Z + i] - lengths[0] * s[TZ + i]
                nodes[FX + i], nodes[FY + i], nodes[FZ + i] = 0.0, 0.0, 0.0
        note(s, nodes, n + 1)


@compiled
def note(s: Floats, nodes: Floats, n: int) -> None:
    """Record the state of all lanes."""
    base = n * STATE * LANES
    for i in range(STATE * LANES):
        nodes[base + i] = s[i]
    for i in range(LANES):
        z = s[Z + i]
        s[LOWEST + i] = z if z < s[LOWEST + i] else s[LOWEST + i]
        s[HIGHEST + i] = z if z > s[HIGHEST + i] else s[HIGHEST + i]
