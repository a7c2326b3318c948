"""Attribution of a mooring's knockdown and excursion to the drag of each part.

Let y be the quantity to explain, such as the knockdown. If the drag of part i is multiplied by λ_i,
the quantity is y(λ₁ … λ_p). The share of drag i in y is its Aumann–Shapley value,

    share_i = ∫₀¹ ∂y/∂λ_i (s, …, s) ds

The shares add up to y(1 … 1) − y(0 … 0), do not depend on the division of the line into components,
and are zero for a drag without effect. No other rule has these three properties (Billera & Heath,
Mathematics of Operations Research 7, 1982).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import radians

import numpy as np

from calm.case.design import Design
from calm.case.net import net_legs
from calm.files.legs import nodes_of
from calm.physics.line import Floats, Line, Water
from calm.solve import Settings
from calm.solve.mooring import Nearby
from calm.solve.net import NearbyNet

STAGES = (4, 8)
"""Numbers of Gauss points of the integral over the drag. The second number is used if the first
leaves an error above `LARGEST_MISS`.
"""
LARGEST_MISS = 0.01
LEAST_DRAG = 1e-3
"""Fraction of the drag at which the integration begins, for a line whose shape is not unique
without drag.
"""

_STEP = 2e-4
"""Relative increase of a drag for the finite-difference derivative, much larger than the tolerance
of the solver.
"""
SETTINGS = Settings(angle_step=radians(4.0), tolerance=1e-10)
"""Coarse solver settings. They suffice, because the contributions are finally scaled to the total.
"""


SolverPart = tuple[int, int, int]
"""Position of a part for the solver: number of the leg (0 for a single line), index of the piece,
and index of the clamp or -1.
"""

Varied = Callable[[int, Line], Floats]
"""Function that solves the mooring with a slightly changed line in one leg.

The arguments are the number of the leg and the changed line. The result (3,) is the depth, the
excursion and the used buoyancy, as in `Attribution`.
"""


@dataclass(frozen=True)
class Attribution:
    """Contributions of the drags of p pieces and clamped instruments to the shape of a line.

    Columns are the depth and the excursion of a point of the line [m], and the used fraction of the
    surface float's buoyancy.

    Attributes
    ----------
    parts : leg, piece and clamp on which each drag acts; the clamp is -1 for the piece itself
    start : (3,) values without drag, or with the smallest drag
    shares : (p, 3) contributions, scaled so that they add up to the total change
    miss : (3,) relative error of the sum of the contributions before the scaling
    """

    parts: list[SolverPart]
    start: Floats
    shares: Floats
    miss: Floats


def attribute(
    lines: Sequence[Line],
    near: Callable[[Sequence[Line]], Varied],
    start: Floats | None,
    whole: Floats,
) -> Attribution:
    """Attribute the depth and excursion of a point, and the used buoyancy, to the drags.

    Parameters
    ----------
    lines : lines of the legs, or a single line
    near : function that solves these lines, and returns a function `Varied` for variants of the
        lines
    start : (3,) values without drag. If the shape without drag is not unique, `start` is None, and
        the integral over the drag begins at `LEAST_DRAG`
    whole : (3,) values with full drag

    Raises
    ------
    NoEquilibrium
        The line has no equilibrium at one of the intermediate drags.
    """
    parts = [(leg, *part) for leg, line in enumerate(lines) for part in _parts_with_drag(line)]
    least = 0.0
    if start is None:
        least = LEAST_DRAG
        first = [with_drag(line, least) for line in lines]
        start = near(first)(0, first[0])
    growth = whole - start
    for stages in STAGES:
        shares = _integral(lines, near, parts, least, stages)
        total = shares.sum(axis=0)
        grows = np.abs(growth) > 1e-9 * np.maximum(np.abs(whole), 1.0)
        miss = np.where(grows, total / np.where(grows, growth, 1.0) - 1.0, 0.0)
        if np.abs(miss).max() <= LARGEST_MISS:
            break
    scaled = shares * np.where(grows & (total != 0.0), growth / np.where(total, total, 1.0), 0.0)
    return Attribution(parts=parts, start=start, shares=scaled, miss=miss)


def with_drag(line: Line, pieces: float | Floats, clamps: float | Floats | None = None) -> Line:
    """Return the line with its drags multiplied by factors.

    By default, the factor of the pieces also applies to the clamps.
    """
    return replace(
        line,
        normal_drag=pieces * line.normal_drag,
        tangential_drag=pieces * line.tangential_drag,
        clamp_drag=(pieces if clamps is None else clamps) * line.clamp_drag,
    )


def _parts_with_drag(line: Line) -> list[tuple[int, int]]:
    pieces = np.flatnonzero((line.normal_drag > 0.0) | (line.tangential_drag > 0.0))
    clamps = np.flatnonzero(line.clamp_drag > 0.0)
    parts = [(int(p), -1) for p in pieces] + [(int(line.clamp_piece[m]), int(m)) for m in clamps]
    return sorted(parts)  # down the line, each piece before its clamps


def _with_part(line: Line, piece: int, clamp: int, factor: float) -> Line:
    pieces, clamps = np.ones(len(line.length)), np.ones(len(line.clamp_drag))
    if clamp >= 0:
        clamps[clamp] = factor
    else:
        pieces[piece] = factor
    return with_drag(line, pieces, clamps)


def _integral(
    lines: Sequence[Line],
    near: Callable[[Sequence[Line]], Varied],
    parts: list[SolverPart],
    least: float,
    stages: int,
) -> Floats:
    """Compute the contributions (p, 3), which are the integrals ∫ ∂y/∂λ ds from `least` to 1.

    The variable of integration is t, with s = t². The derivative ∂y/∂λ is (∂y/∂ln λ)/s.
    """
    abscissae, weights = np.polynomial.legendre.leggauss(stages)
    low = np.sqrt(least)
    half = 0.5 * (1.0 - low)
    shares = np.zeros((len(parts), 3))
    for abscissa, weight in zip(abscissae, weights, strict=True):
        t = low + half * (1.0 + abscissa)
        stage = [with_drag(line, t * t) for line in lines]
        varied = near(stage)
        there = varied(0, stage[0])
        for i, (leg, piece, clamp) in enumerate(parts):
            more = varied(leg, _with_part(stage[leg], piece, clamp, 1.0 + _STEP))
            shares[i] += half * weight * 2.0 / t * (more - there) / _STEP
    return shares


def of_a_line(water: Water, point: SolverPart) -> Callable[[Sequence[Line]], Varied]:
    """Return the function `near` that `attribute` needs, for a single line.

    The point is at a clamp or at the top of a piece.
    """

    def near(lines: Sequence[Line]) -> Varied:
        nearby = Nearby(lines[0], water, SETTINGS)
        node = nearby.node(*point[1:])
        return lambda _, line: _observed(*nearby.shape(line), node)

    return near


def of_a_net(net: Design, point: SolverPart) -> Callable[[Sequence[Line]], Varied]:
    """Return the function `near` that `attribute` needs, for a net.

    The point is at a clamp or at the top of a piece.
    """

    def near(lines: Sequence[Line]) -> Varied:
        legs, nodes = net_legs(net.with_lines(lines).legs), len(nodes_of(net.file.legs))
        nearby = NearbyNet(legs, nodes, net.water, SETTINGS, net.standing)
        node = nearby.node(*point)
        return lambda leg, line: _observed(*nearby.shape(leg, line, point[0]), node)

    return near


def _observed(position: Floats, used: float, node: int) -> Floats:
    x, y, z = position[node]
    return np.array([-z, np.hypot(x, y), used])
