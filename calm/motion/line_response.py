"""The line at each time of a block as its currents say, and how it changes with what is unknown.

Every time is estimated for itself. Unknown are the logarithm of a factor on the current of each
group of levels, the height of the sea, and what is common to the record, whose values and
covariance are given. A current that is missing at a level comes from its neighbours.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import NDArray

from calm.batch.profiles import Batch, Profiles
from calm.case import Design
from calm.files.pieces import clamps_down
from calm.motion import common_unknowns
from calm.motion.common_unknowns import Common
from calm.motion.currents_law import Linear, ReadCurrents
from calm.motion.measurements import FREE, MooringMeasurements
from calm.physics.line import Floats, Integers, Line

STEP = 0.05
"""Of the logarithms by which the derivatives are found."""
APART = 1e-6
"""Between levels of instruments that hang in one place [m]."""


class LineResponse:
    """The times of a block, with a mooring to ask."""

    def __init__(
        self, measured: MooringMeasurements, forward: Forward, shifted: Mapping[str, Forward]
    ) -> None:
        self.measured, self.forward, self.shifted = measured, forward, shifted
        self.group = measured.group
        self.groups = int(self.group.max()) + 1 if len(self.group) else 0

    # --- currents

    def levels(self, depths: Floats) -> Floats:
        """Return (n, k) depths of the levels, of those that hang by the depths of the points.

        A current whose sensor is used hangs where that was measured.
        """
        one = self.measured
        level = one.level_depth.copy()
        for k, (point, sensor) in enumerate(zip(one.level_point, one.level_sensor, strict=True)):
            if point == FREE:
                continue
            level[:, k] = depths[:, point]
            if sensor != FREE:
                known = np.isfinite(one.depth[:, sensor])
                level[known, k] = one.depth[known, sensor]
        apart: Floats = np.maximum(level, 0.0) + APART * np.arange(level.shape[1])
        return apart

    def read(
        self, level: Floats, without: tuple[int, ...] = ()
    ) -> tuple[Floats, Floats, NDArray[np.bool_]]:
        """Return (n, k) u and v [m/s] at these levels, and whether each was measured.

        Groups that are left out are taken from the others, as is what was not measured.
        """
        one = self.measured
        known = np.isfinite(one.u) & np.isfinite(one.v) & np.isfinite(level)
        known &= ~np.isin(self.group, without)
        return filled(level, one.u, known), filled(level, one.v, known), known

    def way(self, level: Floats, common: Common, without: tuple[int, ...] = ()) -> ReadCurrents:
        """Return the currents at these levels with their errors; some groups taken from the others.

        Parameters
        ----------
        level : (n, k) depths [m]
        common : what is common to the record
        without : groups whose currents are taken from the others
        """
        if common.law is not None:
            return common.law.read(level)
        u, v, known = self.read(level, without)
        speed = np.maximum(np.hypot(u, v), 1e-3)
        own = np.hypot(
            by_flag(common_unknowns.LEVEL, self.measured.flag),
            common_unknowns.STEADY / speed,
        )
        gap = common.gap[:, [*without]].max(axis=1) if without else np.diag(common.gap)
        own = np.minimum(np.where(known, own, gap[self.group]), common_unknowns.LARGEST)
        spread = np.zeros((len(u), self.groups, self.groups))
        place = np.linspace(-1.0, 1.0, self.groups) if self.groups > 1 else np.zeros(1)
        spread += common_unknowns.CURRENT**2 + common_unknowns.SHEAR**2 * np.outer(place, place)
        for g in range(self.groups):
            mine = own[:, self.group == g]
            spread[:, g, g] += (mine**2).mean(axis=1)
        return ReadCurrents(level, u, v, common.scale**2 * spread)

    def depths(self, way: ReadCurrents, logs: Floats, forward: Forward | None = None) -> Floats:
        """Return (n, p) depths of the points with factors on the currents.

        Parameters
        ----------
        way : the currents as they are read
        logs : (n, g) logarithms of the factors on them
        forward : the mooring; that of the block where it is None
        """
        factor = np.exp(logs[:, self.group])
        return (forward or self.forward).depths(way.level, way.u * factor, way.v * factor)

    def linear(self, way: ReadCurrents, logs: Floats) -> Linear:
        """Return the line with factors on the currents, of logarithms (n, g), and its slopes."""
        there = self.depths(way, logs)
        own = [self.depths(way, logs + ahead) for ahead in STEP * np.eye(self.groups)]
        common = [self.depths(way, logs, forward) for forward in self.shifted.values()]
        return Linear(logs, there, _slopes(own, there), _slopes(common, there))


def by_flag(values: Mapping[int, float], flag: NDArray[np.int8]) -> Floats:
    """Return a figure for every flag; one that is not known counts as bad, 4."""
    table = np.array([values.get(number, values[4]) for number in range(256)])
    return table[flag.astype(np.uint8)]


def _slopes(ahead: Sequence[Floats], there: Floats) -> Floats:
    """Return (n, p, m) slopes of depths (n, p) to those a step ahead in each direction [m]."""
    columns = [(one - there) / STEP for one in ahead]
    return np.nan_to_num(np.stack(columns, -1)) if columns else np.zeros((*there.shape, 0))


FACTORS = ("cable_drag", "rigid_drag", "buoyancy", "length")
"""What may be estimated for the whole record: drag of cables and chains; drag of rigid pieces and
clamped instruments; net force of all that floats; lengths of cables and chains."""


def with_factors(line: Line, factors: Mapping[str, float]) -> Line:
    """Return a line with factors on its drags, on the net force of its floats, on its lengths."""
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
    """A mooring that is asked for its depths in many currents.

    A point is a clamped instrument or the upper end of a component: the clamps down the line come
    first, then the components in the order of the file.
    """

    def __init__(self, mooring: Design, factors: Mapping[str, float]) -> None:
        line = with_factors(mooring.line, factors)
        self.mooring = Design(mooring.file, lines=(line,), given_water=mooring.water)
        self._batch = Batch(self.mooring)

    @cached_property
    def still(self) -> Floats:
        """Return (p,) depths of the points in still water [m]."""
        nothing = np.zeros((1, 1))
        depths: Floats = points(self.solve(nothing, nothing, nothing))[0]
        return depths

    def solve(self, depth: Floats, u: Floats, v: Floats) -> Profiles:
        """Return the mooring in many currents, solved on one thread.

        Parameters
        ----------
        depth : (n, k) of the levels [m]
        u, v : (n, k) to the east and to the north [m/s]
        """
        return self._batch.solve(u, v, depth, workers=1)

    def depths(self, depth: Floats, u: Floats, v: Floats) -> Floats:
        """Return (n, p) depths of the points [m], NaN where there is no equilibrium.

        Parameters
        ----------
        depth, u, v : see `solve`
        """
        return points(self.solve(depth, u, v))


def forwards_of(mooring: Design, common: Common) -> tuple[Forward, dict[str, Forward]]:
    """Return the mooring at the common factors, and a step from each."""
    shifted = {
        name: Forward(mooring, {**common.factors, name: value * float(np.exp(STEP))})
        for name, value in common.factors.items()
    }
    return Forward(mooring, common.factors), shifted


def points(profiles: Profiles) -> Floats:
    """Return (n, p) depths of all points [m]."""
    return np.hstack([profiles.clamp_depth, profiles.depth_top])


def labels_of(mooring: Design) -> tuple[str, ...]:
    """Return the labels of all points, see `Forward`."""
    pieces = mooring.file.pieces
    return (*(clamp.label for clamp in clamps_down(pieces)), *(piece.label for piece in pieces))


def instruments_of(mooring: Design) -> list[int]:
    """Return the points that may be instruments: all clamps, and the pieces whose role it is."""
    pieces = mooring.file.pieces
    clamps = len(clamps_down(pieces))
    inline = [clamps + i for i, piece in enumerate(pieces) if piece.component.role == "instrument"]
    return [*range(clamps), *inline]


SPAN, LOCAL = 0.25, 0.3
"""Share of the line over which the errors of its knockdown are alike, and what a point is wrong by
for itself where currents are inferred, as floats and clamps bend the line there."""


def own_errors(depth: Floats, still: Floats, inferred: bool) -> Floats:
    """Return (n, p, p) covariance of the errors of the line at its points, of a share of 1 [m²].

    With measured currents a point is wrong by a share of its own knockdown, alike over a quarter of
    the line. Where they are inferred, which takes up what is so, the knockdown of each stretch is
    wrong by such a share, a point by all that is below it, so that between two sensors the error is
    smooth, and by a lesser share of its own knockdown.

    Parameters
    ----------
    depth, still : (n, p), (p,) of the points, and in still water [m]; of NaN they are 0
    inferred : whether the currents are
    """
    if not inferred:
        own = np.maximum(np.nan_to_num(depth - still), 0.0)
        span = max(SPAN * float(np.ptp(still)), 1.0)
        errors = own[:, :, None] * np.exp(-np.abs(still[:, None] - still) / span) * own[:, None, :]
        return errors
    order = np.argsort(-still, kind="stable")
    back, place = np.argsort(order, kind="stable"), still[order]
    down = np.maximum(np.nan_to_num(depth - still), 0.0)[:, order]
    part = np.diff(down, axis=1, prepend=0.0)
    middle = place - 0.5 * np.diff(place, prepend=place[0])
    far = np.abs(middle[:, None] - middle) / max(SPAN * float(np.ptp(still)), 1.0)
    alike = np.exp(-far)
    errors = (part[:, :, None] * alike * part[:, None, :]).cumsum(axis=1).cumsum(axis=2)
    errors += LOCAL**2 * down[:, :, None] * alike * down[:, None, :]
    ordered: Floats = errors[:, back[:, None], back]
    return ordered


FEWEST = 20
"""Times from which the errors of what is taken from neighbours are known."""


def filled(depth: Floats, value: Floats, known: NDArray[np.bool_]) -> Floats:
    """Return values (n, k) at levels (n, k), those that are not known linear in depth between the
    others.

    Beyond the first and the last known level they are constant; NaN where none is known.

    Parameters
    ----------
    depth : (n, k) of the levels [m]
    value : (n, k) at these
    known : (n, k) which of the values count
    """
    result = np.where(known, value, np.nan)
    for i in np.flatnonzero(~known.all(axis=1)):
        there = known[i]
        if there.any():
            order = np.argsort(depth[i, there], kind="stable")
            result[i, ~there] = np.interp(
                depth[i, ~there], depth[i, there][order], value[i, there][order]
            )
    return result


def gap_errors(level: Floats, u: Floats, v: Floats, group: Integers) -> Floats:
    """Return (g, g) how far the speeds of a group of levels are from those that the others give.

    The median size of the logarithm of their ratio, as the deviation of a normal law, over the half
    of the times with the stronger current: of the group of a row, left out with that of a column.
    `calm.motion.common_unknowns.GAP` where too few times say.

    Parameters
    ----------
    level, u, v : (n, k) depths [m] and currents [m/s]
    group : (k,) of each level
    """
    count = int(group.max()) + 1 if len(group) else 0
    errors = np.full((count, count), common_unknowns.GAP)
    whole = np.isfinite(u) & np.isfinite(v) & np.isfinite(level)
    times = np.flatnonzero(whole.all(axis=1))
    if len(times) < FEWEST:
        return errors
    for one, other in product(range(count), repeat=2):
        mine, known = group == one, ~np.isin(group, (one, other))
        if known.any():
            known = np.broadcast_to(known, (len(times), len(group)))
            taken = [filled(level[times], each[times], known)[:, mine] for each in (u, v)]
            here, there = (
                np.hypot(east, north).mean(axis=1) + common_unknowns.STEADY
                for east, north in ((u[times][:, mine], v[times][:, mine]), taken)
            )
            off = np.abs(np.log(there / here))[here + there >= np.median(here + there)]
            errors[one, other] = common_unknowns.NORMAL * np.median(off)
    least: Floats = np.maximum(errors, common_unknowns.LEVEL[1])
    return least


def between(one: MooringMeasurements, depth: Floats, still: Floats) -> Floats:
    """Return (n, p) depths with what the sensors measure beside them, linear by the height in still
    water.

    Parameters
    ----------
    depth : (n, p) of the points as far as they are known [m]
    still : (p,) in still water
    """
    order = np.argsort(still[one.point], kind="stable")
    result = depth.copy()
    for i, row in enumerate(one.depth):
        known = order[np.isfinite(row[order])]
        if len(known):
            points = one.point[known]
            result[i] += np.interp(still, still[points], row[known] - depth[i, points])
    return result
