"""How the error that a solution states compares with the error it has.

That is the error of the figures reported, which are extrapolated, or that of the shape as it was
marched, which the stated error estimates.

The true error is the departure from the same case solved at a tenth of the angle step, closed to
1e-10: a hundredth of the error, and itself held against the independent referee in the tests of
random moorings, floats and tows. Slack moorings, which somewhere carry less than 1e-5 of their
greatest tension, hang in folds there that are no shape of their own: they are left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import radians
from random import Random

import numpy as np
from scipy.interpolate import PchipInterpolator

from calm.errors import NoEquilibrium
from calm.physics.line import Floats, Integers
from calm.physics.seabed import required_weight
from calm.solve import Settings, Solution
from tests.validation.agreement import clamp_nodes, last_before_touchdown
from tests.validation.families import FAMILIES

FINE = Settings(radians(0.1), 1e-10)
SLACK = 1e-5


@dataclass(frozen=True)
class Honesty:
    """True over stated error: of the worst depth or offset, and of the worst tension.

    `place` and `tension` are those at the ends of all pieces and at all clamps; `shape` and
    `pull` those at the nodes inside the cables. `anchor` is that of the worse of its vertical and
    horizontal pull, `weight` that of the weight that it needs.
    """

    place: float
    tension: float
    shape: float
    pull: float
    anchor: float
    weight: float


def honesty(family: str, number: int, marched: bool = False) -> Honesty | str:
    """That of a case of a family, or why it counts for nothing: its status, or that it is slack.

    Of the shape as it was `marched`, or as reported.
    """
    case = FAMILIES[family](Random(f"{family} {number}"))
    try:
        solution = case(Settings())
    except NoEquilibrium as refusal:
        return str(refusal.status)
    slackest = float(solution.tension[1:].min())
    if slackest < SLACK * solution.tension.max() and not solution.line.towed:
        return "slack somewhere"
    try:
        fine = case(FINE)
    except NoEquilibrium as refusal:
        return f"at a tenth of the step {refusal.status}"
    if (solution.landed, solution.afloat) != (fine.landed, fine.afloat):
        return "on the limit between two ways to stand"
    solution = solution.as_marched if marched else solution
    at, there = _ends(solution), _ends(fine)
    place = np.abs(solution.position[at] - fine.position[there]).max()
    tension = np.abs(solution.tension[at] - fine.tension[there]).max()
    inside = _inside(solution, fine)
    shape, pull = (inside[:, :3].max(), inside[:, 3].max()) if len(inside) else (0.0, 0.0)
    depth_error, tension_error = solution.depth_error, solution.tension_error
    return Honesty(
        float(place / depth_error), float(tension / tension_error),
        float(shape / depth_error), float(pull / tension_error),
        *_at_the_anchor(solution, fine),
    )  # fmt: skip


def _at_the_anchor(solution: Solution, fine: Solution) -> tuple[float, float]:
    """True over stated error of the pull on the anchor and of its needed weight; 0 of a tow."""
    if solution.line.towed:
        return 0.0, 0.0
    lift = abs(float(solution.force[-1, 2] - fine.force[-1, 2]))
    ours, theirs = (float(np.hypot(*one.force[-1, :2])) for one in (solution, fine))
    pull = abs(ours - theirs)
    stated = max(solution.lift_error, solution.pull_error)
    needed = required_weight(solution.lift_error, solution.pull_error, 1.5, 0.6)
    return max(lift, pull) / stated, required_weight(lift, pull, 1.5, 0.6) / needed


def _ends(solution: Solution) -> Integers:
    """The nodes at the ends of all pieces and above all clamps."""
    return np.concatenate([*solution.piece_nodes.T, np.array(clamp_nodes(solution), dtype=int)])


def _inside(solution: Solution, fine: Solution) -> Floats:
    """(k, 4) departures in x, y, z and tension at the nodes inside cables, between their clamps.

    What is extrapolated of the touchdown is its place, which is at another length of the line in
    every shape: it does not count here, nor does what lies below it.
    """
    departures = [np.zeros((0, 4))]
    hanging = last_before_touchdown(solution)
    for (first, *ours), (_, *theirs) in zip(_runs(solution), _runs(fine), strict=True):
        if len(theirs[0]) > 3:
            there = PchipInterpolator(*theirs)(ours[0])
            departures.append(np.abs(there - ours[1])[: max(hanging + 1 - first, 0)])
    return np.concatenate(departures)


def _runs(solution: Solution) -> list[tuple[int, Floats, Floats]]:
    """Of every stretch of cable without clamps: its first node, and of all of its nodes the
    unstretched length from there and x, y, z, tension.
    """
    columns = np.column_stack([solution.position, solution.tension])
    runs = []
    for first, last in solution.piece_nodes[solution.line.flexible]:
        clamped = np.flatnonzero(solution.element_clamp[first:last] >= 0) + first
        starts, stops = [first, *(clamped + 1)], [*clamped, last]
        for start, stop in zip(starts, stops, strict=True):
            along = np.concatenate([[0.0], np.cumsum(solution.cut[start:stop])])
            if along[-1] > 0.0:
                runs.append((start, along, columns[start : stop + 1]))
    return runs
