"""Depths of the line at each time, and their derivatives with respect to the unknowns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from calm.batch.profiles import Batch, Profiles
from calm.case import Design
from calm.files.pieces import clamps_down
from calm.motion.common_unknowns import FACTORS, Common
from calm.motion.currents_law import Linear, ReadCurrents
from calm.motion.measurements import MooringMeasurements
from calm.physics.line import Floats, Line

STEP = 0.05  # step in a logarithm for numerical derivatives
UNMEASURED = 1e4  # standard deviation assigned to a missing reading [m]


class LineResponse:
    """Solver for the depths of a mooring, and for their derivatives, at the times of a block."""

    def __init__(
        self, measured: MooringMeasurements, forward: Forward, shifted: Mapping[str, Forward]
    ) -> None:
        self.measured, self.forward, self.shifted = measured, forward, shifted

    def depths(self, read: ReadCurrents, logs: Floats, forward: Forward | None = None) -> Floats:
        """Return depths (n, p) [m] in currents multiplied by the factors exp(`logs`) (n, k)."""
        factor = np.exp(logs)
        return (forward or self.forward).depths(read.level, read.u * factor, read.v * factor)

    def linear(self, read: ReadCurrents, logs: Floats) -> Linear:
        """Return depths and derivatives in currents multiplied by exp(`logs`) (n, k)."""
        factor = np.exp(logs)
        u, v = read.u * factor, read.v * factor
        there, slopes = self.forward.slopes(read.level, u, v)
        by_u, by_v = np.split(slopes, 2, axis=2)
        own = np.nan_to_num(by_u * u[:, None] + by_v * v[:, None])
        common = [self.depths(read, logs, forward) for forward in self.shifted.values()]
        return Linear(logs, there, own, _slopes(common, there))


def _slopes(ahead: Sequence[Floats], there: Floats) -> Floats:
    """Return derivatives (n, p, m) from the depths after a step in each of m unknowns, `ahead`."""
    columns = [(one - there) / STEP for one in ahead]
    return np.nan_to_num(np.stack(columns, -1)) if columns else np.zeros((*there.shape, 0))


def with_factors(line: Line, factors: Mapping[str, float]) -> Line:
    """Return a copy of a line with drag, net buoyancy and cable lengths multiplied by factors."""
    cable, rigid, lift, length = (factors.get(name, 1.0) for name in FACTORS)
    drag = np.where(line.flexible, cable, rigid)
    cut = np.where(line.flexible, length, 1.0)
    return replace(
        line,
        length=line.length * cut,
        clamp_at=line.clamp_at * cut[line.clamp_piece],
        normal_drag=line.normal_drag * drag,
        tangential_drag=line.tangential_drag * drag,
        clamp_drag=line.clamp_drag * rigid,
        lift=line.lift * drag,
        clamp_lift=line.clamp_lift * rigid,
        buoyancy=np.where(line.buoyancy > 0.0, lift, 1.0) * line.buoyancy,
        clamp_buoyancy=np.where(line.clamp_buoyancy > 0.0, lift, 1.0) * line.clamp_buoyancy,
    )


class Forward:
    """A mooring with factors on its line, to be solved in many currents.

    The p points of the line are the clamped items from the top down, then the upper ends of the
    components in file order. Currents u and v [m/s] and their depths [m] are (n, k), for n times
    and k levels.
    """

    def __init__(self, mooring: Design, factors: Mapping[str, float]) -> None:
        line = with_factors(mooring.line, factors)
        self.mooring = Design(mooring.file, lines=(line,), given_water=mooring.water)
        self._batch = Batch(self.mooring)

    @cached_property
    def still(self) -> Floats:
        """Depths (p,) of the points in still water [m]."""
        nothing = np.zeros((1, 1))
        return np.asarray(self.depths(nothing, nothing, nothing)[0])

    def solve(self, depth: Floats, u: Floats, v: Floats) -> Profiles:
        """Solve the mooring in n current profiles, on one thread."""
        return self._batch.solve(u, v, depth, workers=1)

    def depths(self, depth: Floats, u: Floats, v: Floats) -> Floats:
        """Return (n, p) depths of the points [m]; NaN if there is no equilibrium."""
        return points(self.solve(depth, u, v))

    def slopes(self, depth: Floats, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Return the depths (n, p) of the points [m], and their derivatives (n, p, 2 k) [s].

        The first k derivatives are with respect to u at the k levels, and the others with respect
        to v.
        """
        profiles, slopes = self._batch.slopes(u, v, depth)
        return points(profiles), slopes


def forwards_of(mooring: Design, common: Common) -> tuple[Forward, dict[str, Forward]]:
    """Return the mooring with the common factors, and copies with one factor changed."""
    shifted = {
        name: Forward(mooring, {**common.factors, name: value * float(np.exp(STEP))})
        for name, value in common.factors.items()
    }
    return Forward(mooring, common.factors), shifted


def points(profiles: Profiles) -> Floats:
    """Return (n, p) depths of all points, as defined in `Forward` [m]."""
    return np.hstack([profiles.clamp_depth, profiles.depth_top])


def labels_of(mooring: Design) -> tuple[str, ...]:
    """Return the labels of all points, in the order given in `Forward`."""
    pieces = mooring.file.pieces
    return (*(clamp.label for clamp in clamps_down(pieces)), *(piece.label for piece in pieces))


def instruments_of(mooring: Design) -> list[int]:
    """Return the points of clamped items except floats, and of pieces with role `instrument`."""
    pieces = mooring.file.pieces
    clamps = clamps_down(pieces)
    fixed = [i for i, clamp in enumerate(clamps) if clamp.component.role != "float"]
    own = (i for i, piece in enumerate(pieces) if piece.component.role == "instrument")
    return [*fixed, *(len(clamps) + i for i in own)]


SPAN = 0.25  # correlation length of the error in knockdown, as a share of the line
# Local error of a point, from bends at floats and clamps, as a share of its knockdown. Without this
# error, the depths of RAPID are up to 26 % worse
LOCAL = 0.3


def own_errors(depth: Floats, still: Floats, learnt: bool) -> Floats:
    """Return the error covariance (n, p, p) of the computed depths [m²], if the error share is 1.

    Errors are correlated over a quarter of the line. If the currents were measured, the error at a
    point is a share of its knockdown. Currents that are inferred from the pressures (`learnt`)
    absorb such errors. The error at a point is then a share of the knockdown of each stretch of the
    line below the point, plus a smaller share of the knockdown of the point.
    """
    if not learnt:
        own = np.maximum(np.nan_to_num(depth - still), 0.0)
        span = max(SPAN * float(np.ptp(still)), 1.0)
        alike = np.exp(-np.abs(still[:, None] - still) / span)
        return np.asarray(own[:, :, None] * alike * own[:, None, :])
    order = np.argsort(-still, kind="stable")
    back, place = np.argsort(order, kind="stable"), still[order]
    down = np.maximum(np.nan_to_num(depth - still), 0.0)[:, order]
    part = np.diff(down, axis=1, prepend=0.0)
    middle = place - 0.5 * np.diff(place, prepend=place[0])
    far = np.abs(middle[:, None] - middle) / max(SPAN * float(np.ptp(still)), 1.0)
    alike = np.exp(-far)
    errors = (part[:, :, None] * alike * part[:, None, :]).cumsum(axis=1).cumsum(axis=2)
    errors += LOCAL**2 * down[:, :, None] * alike * down[:, None, :]
    return np.asarray(errors[:, back[:, None], back])
