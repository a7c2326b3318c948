"""Where the free end of the referee's line is: the highest equilibrium of a mooring.

A line whose free end, left at the surface with its full buoyancy, hangs too deep for its anchor
floats: its free end is at the surface and the unknown is the part in use of the buoyancy of the
first float, which may have a draft. If that leaves the next float in the air or the line too high,
the next one is at the surface too, the part of the first being what leaves it there, and its own
part is the unknown.
Otherwise the unknown is the depth of the free end. Each is searched from the upright side in
`SCAN` steps, then closed by Brent's method to rounding.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from calm.physics.line import Line, Water
from tests.validation.afloat import Hull, depth_of_free_end, first_float, riding
from tests.validation.cables import Folded, NoContinuousSolution
from tests.validation.continuous import March, Shape
from tests.validation.loads import Vector

COARSE, FINE = 1e-5, 1e-11
SCAN = 60
AWASH = np.array([0.0, 1e-6, 1e-5, 1e-4, 5e-4, 2e-3, 5e-3, 0.01, 0.015, 0.02, 0.025])
"""Shares of a float's buoyancy, not in use, that are tried besides."""
SLACK = 1e-6
"""Least tension in a cable, as a part of the greatest: below it the line hangs in a sharp fold."""


@dataclass(frozen=True)
class Equilibrium:
    """The referee's answer.

    In `shape` x and y count from the line's lower end. `share` (n,) is the part in use of each
    piece's buoyancy, 1 but for floats at the surface; `depth` [m] is that of the free end.
    """

    shape: Shape
    share: Vector
    depth: float
    surface: bool


def solve_continuous(
    line: Line, water: Water, hull: Hull | None = None, friction: float = 0.0
) -> Equilibrium:
    """The highest equilibrium of a mooring: clear of the seabed or else lying on it at the end.

    `hull` is the form of its first float; without it the one that the line has. `friction` is that
    on the seabed.

    Raises
    ------
    NoContinuousSolution
        Where there is none, or none without parts in the air, below the seabed or slack.
    """
    refusals: list[NoContinuousSolution] = []
    for lands in (False, True):
        try:
            found = _closed(line, water, lands, hull, friction)
        except NoContinuousSolution as refusal:
            refusals.append(refusal)
            continue
        if not lands or found.shape.grounded is not None:
            return found
    raise refusals[0]


def _closed(
    line: Line, water: Water, lands: bool, hull: Hull | None, friction: float
) -> Equilibrium:
    # A line on the seabed ends there, not at the top of its anchor.
    bottom = water.depth - (0.0 if lands else line.anchor_height)
    rough, fine = (March(line, water, tolerance, friction) for tolerance in (COARSE, FINE))

    def excess(march: March, depth: float, share: Vector) -> float:
        """How much deeper than it should the line ends [m]."""
        return float(-march.down(depth, share, lands=lands).bottom[-1, 2] - bottom)

    riding = _riding(line, water, excess, hull, friction)
    if riding is not None:
        fine, share, depth = riding
        return _standing(fine, water, share, depth, lands, surface=True)
    share, depth = np.ones(len(line.length)), 0.0
    surface = excess(fine, 0.0, share) > 0.0
    if surface:
        share = _afloat(line, lambda march, parts: excess(march, 0.0, parts), rough, fine)
    else:
        depth = _first_root(
            lambda d: excess(rough, d, share), lambda d: excess(fine, d, share),
            _depths(line, water, share, bottom),
        )  # fmt: skip
    return _standing(fine, water, share, depth, lands, surface)


def _standing(
    march: March, water: Water, share: Vector, depth: float, lands: bool, surface: bool
) -> Equilibrium:
    shape = march.kept(depth, share, lands)
    _refuse_impossible(shape, march.line, water, share)
    return Equilibrium(shape.shifted(-shape.bottom[-1, :2]), share, depth, surface)


def _riding(
    line: Line,
    water: Water,
    excess: Callable[[March, float, Vector], float],
    hull: Hull | None,
    friction: float,
) -> tuple[March, Vector, float] | None:
    """The first float alone at the surface, at its draft: the march, the parts in use, the depth.

    None where it has no draft, is under water or leaves another float in the air. The highest
    root is sought from the unloaded float on.
    """
    if line.floating is None:
        return None
    first, n = first_float(line), len(line.length)
    following = [p for p in range(first + 1, n) if line.buoyancy[p] > 0.0 and not line.flexible[p]]

    def placed(part: float, tolerance: float) -> tuple[March, Vector, float]:
        loaded, out = riding(line, water, hull, part)
        march = March(loaded, water, tolerance, friction)
        share = np.where(np.arange(n) == first, part, 1.0)
        return march, share, depth_of_free_end(march, share, out)

    def residual(part: float, tolerance: float) -> float:
        march, share, depth = placed(part, tolerance)
        return excess(march, depth, share)

    parts = np.unique(np.concatenate([np.linspace(0.0, 1.0, SCAN) ** 2, 1.0 - AWASH]))
    try:
        part = _first_root(lambda p: residual(p, COARSE), lambda p: residual(p, FINE), parts)
    except Folded:
        raise
    except NoContinuousSolution:
        return None
    found = march, share, depth = placed(part, FINE)
    if following:
        top = march.down(depth, share, until=following[0]).bottom[following[0] - 1, 2]
        if top > 1e-9 * water.depth:
            return None
    return found


def _depths(line: Line, water: Water, share: Vector, bottom: float) -> Vector:
    """Depths to try: the surface, then downwards from above the upright line, closest there."""
    hanging = -float(March(line, water.still(), COARSE).down(0.0, share).bottom[-1, 2])
    stretch = hanging - float(line.length.sum())
    start = max(0.0, bottom - hanging - 2.0 * stretch - 1e-3 * water.depth)
    steps = np.linspace(0.0, 1.0, SCAN + 1) ** 2
    return np.unique(np.concatenate([[0.0], start + (bottom - start) * steps]))


def _afloat(
    line: Line, excess: Callable[[March, Vector], float], rough: March, fine: March
) -> Vector:
    """The parts in use of the buoyancies when floats lie at the surface."""
    share = np.ones(len(line.length))
    refusal = NoContinuousSolution("more than the floats rises to the surface")
    floats = np.flatnonzero((line.buoyancy > 0.0) & ~line.flexible)
    for this, following in zip(floats, [*floats[1:], -1], strict=True):

        def used(part: float, this: int = this, above: Vector = share) -> Vector:
            return np.where(np.arange(len(above)) == this, part, above)

        def height(march: March, parts: Vector, piece: int = following) -> float:
            """That of the next float's top above the surface."""
            return float(march.down(0.0, parts, until=piece).bottom[piece - 1, 2])

        try:
            if line.floating is not None and this == floats[0]:
                raise refusal  # it would have a draft
            parts = used(_share(excess, used, rough, fine))
            if following < 0 or height(fine, parts) <= 1e-9 * fine.depth:
                return parts
        except NoContinuousSolution as none:
            refusal = none
        # The next float comes to the surface too, and this one bears the line between them.
        if following < 0 or height(fine, used(0.0)) < -1e-9 * fine.depth:
            break
        if height(fine, used(0.0)) <= 1e-9 * fine.depth:
            share = used(0.0)
        else:
            share = used(_share(lambda m, parts: -height(m, parts), used, rough, fine))
    raise refusal


def _share(
    excess: Callable[[March, Vector], float],
    used: Callable[[float], Vector],
    rough: March,
    fine: March,
) -> float:
    """The part of one float's buoyancy that leaves no excess of depth; all of it leaves some."""
    return _first_root(
        lambda part: -excess(rough, used(part)),
        lambda part: -excess(fine, used(part)),
        np.linspace(1.0, 0.0, SCAN + 1) ** 2,
    )


def _first_root(
    rough: Callable[[float], float], fine: Callable[[float], float], grid: Iterable[float]
) -> float:
    """The first root on the way through `grid`, from the negative side."""
    passed: list[float] = []
    refusal = NoContinuousSolution("no depth or part of the buoyancy brings the line to its anchor")
    for point in grid:
        try:
            beyond = passed and rough(point) > 0.0 and fine(point) >= 0.0
        except Folded as folded:
            refusal = folded  # no shape to follow here; the root may lie further on
            continue
        if beyond:
            # The rough march may see the root on the wrong side of a grid point.
            for near in passed[:-3:-1]:
                if fine(near) <= 0.0:
                    return float(brentq(fine, near, point, xtol=1e-13, rtol=1e-14))
            break
        passed.append(float(point))
    raise refusal


def _refuse_impossible(shape: Shape, line: Line, water: Water, share: Vector) -> None:
    afloat = float(line.length[share < 1.0].sum())  # a float may stand out of the water,
    if line.floating is not None:  # and with it what is on it
        afloat += float(line.length[: first_float(line)].sum())
    if min(shape.depths) < -afloat - 1e-9 * water.depth:
        raise NoContinuousSolution("a part of the line is in the air")
    if max(shape.depths) > water.depth * (1.0 + 1e-9):
        raise NoContinuousSolution("a part of the line is on the seabed")
    if line.flexible.any():
        greatest = float(np.linalg.norm(shape.force_bottom, axis=1).max())
        if shape.slackest < SLACK * greatest:
            raise Folded("the line folds where it is slack")
