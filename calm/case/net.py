"""Simultaneous solution of the legs of a net."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from itertools import combinations, permutations, product
from math import dist, inf, isfinite
from typing import Any

import numpy as np

from calm.case.leg import Leg
from calm.case.parts import naming_the_piece
from calm.errors import NoEquilibrium
from calm.files.legs import EndKeys, nodes_of
from calm.physics.line import Water
from calm.quantities import say
from calm.solve import Settings, Status
from calm.solve.leg_layout import LegEnd, NetLeg
from calm.solve.net import NetSolution, solve_net


def net_legs(legs: Sequence[Leg]) -> tuple[NetLeg, ...]:
    """Convert the legs to the input of the solver."""
    nodes = nodes_of([leg.keys for leg in legs])
    return tuple(
        NetLeg(leg.line, _end(leg.top, nodes, leg), _end(leg.bottom, nodes, leg)) for leg in legs
    )


def _end(end: EndKeys, nodes: Mapping[str, int], leg: Leg) -> LegEnd:
    if end.join is not None:
        return LegEnd(node=nodes[end.join])
    if end.held is not None:
        return LegEnd(place=(*end.held.at, -end.held.depth))
    if end.anchor is not None:
        water, seabed = leg.water, -leg.water.depth
        place = (*end.anchor.at, seabed + leg.line.anchor_height)
        deeper = water.deeper_east, water.deeper_north
        return LegEnd(place=place, seabed=seabed, deeper=deeper)
    return LegEnd()


def solve_together(
    legs: Sequence[Leg], water: Water, settings: Settings, near: NetSolution | None
) -> NetSolution:
    """Solve the legs of a net in given water; the search starts from the solution `near` if given.

    Raises NoEquilibrium if no equilibrium passes every check.
    """
    solved_for = [piece for leg in legs for piece in leg.file.pieces[:-1]]
    laid, nodes = net_legs(legs), nodes_of([leg.keys for leg in legs])
    try:
        with naming_the_piece(solved_for):
            return solve_net(laid, len(nodes), water, settings, near)
    except NoEquilibrium as failure:
        if failure.status == Status.SLACK.label:
            raise
        raise _why_not(legs, laid) or failure from None


def _why_not(legs: Sequence[Leg], laid: Sequence[NetLeg]) -> NoEquilibrium | None:
    """Return the error for a net that sinks, or whose legs are too short to join its fixed ends.

    The weight of pieces that may lie on the seabed is ignored. Return None for any other net.
    """
    lift = 0.0
    for each in laid:
        upto = np.cumsum(each.line.total_buoyancy)
        lift += max(float(upto.max()), 0.0) if isfinite(each.lower.seabed) else float(upto[-1])
    if lift <= 0.0 and not any(end.held for leg in legs for end in (leg.top, leg.bottom)):
        return Status.NO_EQUILIBRIUM.because(
            "The net sinks: no end is held, and its weight in water exceeds its buoyancy by "
            f"{say('force', -lift)}, not counting parts that may lie on the seabed.",
            advice="Add buoyancy.",
        )
    shortest: dict[Any, tuple[float, tuple[str, ...]]] = defaultdict(lambda: (inf, ()))
    for each, leg in zip(laid, legs, strict=True):
        ends = [end.node if end.place is None else end.place for end in (each.upper, each.lower)]
        for pair in permutations(ends):
            shortest[pair] = min(shortest[pair], (float(each.line.length.sum()), (leg.name,)))
    points = dict.fromkeys(end for pair in shortest for end in pair if end != -1)  # -1: free
    for by, first, last in product(points, repeat=3):
        (one, some), (other, more) = shortest[first, by], shortest[by, last]
        shortest[first, last] = min(shortest[first, last], (one + other, some + more))
    for first, last in combinations((one for one in points if isinstance(one, tuple)), 2):
        length, names = shortest[first, last]
        if length < dist(first, last):
            subject = f"Leg {names[0]} is" if len(names) == 1 else f"Legs {', '.join(names)} are"
            return Status.NO_EQUILIBRIUM.because(
                f"{subject} {say('length', length)} long in total, but the ends are held "
                f"{say('length', dist(first, last))} apart.",
                advice="Lengthen a leg, or bring the ends closer together.",
            )
    return None
