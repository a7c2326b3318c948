"""Solution of a net of legs for many current profiles, with compiled code.

Each search starts from the equilibrium of the net in still water. If the net has no equilibrium in
still water, the search starts from the equilibrium in the current of the file. If the search fails
or the seabed is a depth grid, the profile is solved as in `calm run`.
"""

from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from calm.batch import solving
from calm.batch.solving import sea_of  # compiled code calls this function by its own name
from calm.batch.statuses import OF_PROFILES, STATUSES
from calm.case.design import Design, Result, result_together
from calm.case.line_figures import leaning_of
from calm.case.net import net_legs, solve_together
from calm.case.result_tables import MOORED_ENDS
from calm.errors import NoEquilibrium
from calm.files import CurrentTable
from calm.files.legs import nodes_of
from calm.files.pieces import clamps_down
from calm.physics.compiled import optimised, outcome
from calm.physics.line import BETTER, Floats, Water
from calm.physics.profile import Sea
from calm.physics.track import head_count
from calm.records.grids import SeabedGrid
from calm.solve import leg_closing, leg_numbers
from calm.solve.leg_closing import NetTask, copy_values, do_task, drifts
from calm.solve.leg_numbers import Marching, NetProblem, above_bed, place_of
from calm.solve.net import NetSearch, NetSolution
from calm.solve.problem import CHOSEN, FINE
from calm.solve.solution import FOUND

TOLERANCE = 1e-6
"""Relative tolerance of lengths and forces, larger than in a single run to save time."""
BLOCK = 256
"""Number of profiles that a thread solves at a time."""
SOLVE_ALONE = 1
"""Outcome of a profile that must be solved again, as in `calm run`."""
Column = tuple[float, ...]


class NetRows(NamedTuple):
    """Results of a net for n profiles.

    Attributes
    ----------
    pieces : (n, p, 12) position (3) [m] and force (3) [N] at the upper end of each piece, followed
        by position and force at the lower end
    clamps : (n, c, 7) position (3) of each clamp [m], sum of the forces above and below the clamp
        (3) [N], and larger of the tensions above and below the clamp [N]
    shares : (n, l) used fraction of the buoyancy of the float at the top of each leg
    """

    pieces: Floats
    clamps: Floats
    shares: Floats


class NetArrays(NamedTuple):
    """Work arrays for the profiles of a net, and the starting point of the search.

    Attributes
    ----------
    on : work arrays for the levels of a profile
    still : water without current
    start : values of the unknowns at the starting point
    slopes, scale : Jacobian of the net at the starting point, and scales of the unknowns
    x : work array for the unknowns
    piece, clamp : numbers of the first piece and of the first clamp of each leg, as in `NetRows`
    weight : anchor weight of each leg [N]; inf for a leg without an anchor
    """

    on: solving.ProfileLevels
    still: Sea
    start: Any
    slopes: Any
    scale: Any
    x: Any
    piece: Any
    clamp: Any
    weight: Floats


@optimised
def solve_net_rows(
    net: NetProblem,
    step: float,
    arrays: NetArrays,
    depth: Floats,
    u: Floats,
    v: Floats,
    w: Floats,
    rows: NetRows,
    endings: Any,
) -> None:
    """Solve profiles of a net, and write the results to the rows of these profiles.

    Parameters
    ----------
    step : angle step [rad]
    depth, u, v, w : levels [m] and current [m/s], as in `calm.batch.solving.solve_rows`
    endings : (n,) outcome of each profile; profiles with an outcome other than 0 are skipped
    """
    for case in range(endings.size):
        if endings[case] != 0:
            continue
        endings[case], sea = sea_of(arrays.on, depth, u, v, w, case, arrays.still)
        if endings[case] != 0:
            continue
        copy_values(arrays.start, arrays.x)
        for k in range(len(arrays.x)):
            copy_values(arrays.slopes[k], net.slopes[k])
        copy_values(arrays.scale, net.scale)
        how = Marching(sea, 4.0 * step, CHOSEN, False, False, FINE, 0.0)
        ending = do_task(NetTask(leg_closing.CLOSE, net, arrays.x, how, leg_closing.NEAR, True))
        if ending == FOUND:
            how = Marching(sea, step, CHOSEN, False, False, FINE, 0.0)
            ending = do_task(NetTask(leg_closing.SETTLE, net, arrays.x, how, TOLERANCE, True))
        endings[case] = SOLVE_ALONE
        if ending == FOUND and is_valid(net, arrays):
            endings[case] = 0
            write_net(net, arrays, rows, case)


def is_valid(net: NetProblem, arrays: NetArrays) -> bool:
    """Return whether a solution is valid.

    In a valid solution, no leg is above the surface or below the seabed, no anchor is lifted, and
    the net does not drift.
    """
    near = net.errors[leg_closing.DEPTH_ERROR] + 1e-9 * net.length + 1e-6 * net.lines.limits.depth
    for i in range(len(net.legs)):
        leg, state, record = net.legs[i], net.state[i], net.lines.work.records[i][FINE]
        count, first = int(state[leg_numbers.COUNT]), 0
        if leg.kind == leg_numbers.STANDING and state[leg_numbers.SHARE] < 1.0:
            if state[leg_numbers.SHARE] < 0.0:
                return False
            first = net.last[i][net.lines.surfacing[i][0].piece] + 1
        for n in range(count):
            if n < state[leg_numbers.SUSPENDED] and above_bed(net, i, arrays.x, record, n) < -near:
                return False
            if n >= first and record[2][n] > near + leg.highest:
                return False
        if record[5][count - 1] > arrays.weight[i]:
            return False
    return not drifts(net)


def write_net(net: NetProblem, arrays: NetArrays, rows: NetRows, case: int) -> None:
    """Write the results of profile number `case` to row `case`."""
    for i in range(len(net.legs)):
        leg, record = net.legs[i], net.lines.work.records[i][FINE]
        count = int(net.state[i][leg_numbers.COUNT])
        east, north, _ = place_of(net, i, net.better, 1)
        dx, dy = east - record[BETTER][count - 1], north - record[BETTER + 1][count - 1]
        rows.shares[case, i] = net.state[i][leg_numbers.SHARE]
        own = 1 if leg.own > 1 else 0
        for p in range(own, leg.pieces):
            row = rows.pieces[case, arrays.piece[i] + p - own]
            for side in range(2):
                n = net.first[i][p] if side == 0 else net.last[i][p]
                for k in range(6):
                    row[6 * side + k] = record[BETTER + k][n]
                row[6 * side] += dx
                row[6 * side + 1] += dy
        for n in range(1, count):
            if record[7][n] < 0.0:
                continue
            row = rows.clamps[case, arrays.clamp[i] + int(record[7][n])]
            row[0], row[1] = record[BETTER][n - 1] + dx, record[BETTER + 1][n - 1] + dy
            row[2] = record[BETTER + 2][n - 1]
            above = below = 0.0
            for k in range(3, 6):
                upper, lower = record[BETTER + k][n - 1], record[BETTER + k][n]
                row[k] = upper + lower
                above += upper * upper
                below += lower * lower
            row[6] = sqrt(max(above, below))


@dataclass(frozen=True)
class NetProfiles:
    """Solver of a net for many profiles."""

    net: Design

    def water(self, depth: Column, u: Column, v: Column, w: Column) -> Water:
        """Return the water of the net; the given profile replaces the current of the file."""
        environment = replace(self.net.file.environment, current=CurrentTable(depth, u, v, w))
        return self.net.water_of(environment)

    @cached_property
    def still(self) -> NetSolution | None:
        """Solution of the net in still water, or None if there is no equilibrium."""
        settings = replace(self.net.settings, compiled=True)
        try:
            return solve_together(self.net.legs, self.net.water.still(), settings, None)
        except NoEquilibrium:
            return None

    @cached_property
    def at_rest(self) -> Result | None:
        """Results of the net in still water, or None if there is no valid equilibrium."""
        with suppress(NoEquilibrium):
            if self.still is not None:
                return result_together(self.net, self.still, self.still.legs)
        return None

    @cached_property
    def base(self) -> NetSolution | None:
        """Solution from which the search starts.

        If the net has an equilibrium in still water, the search starts from this equilibrium,
        otherwise from the equilibrium in the current of the file. None if neither exists.
        """
        with suppress(NoEquilibrium):
            return self.still or self.net.standing
        return None

    @cached_property
    def slopes(self) -> tuple[Floats, Floats] | None:
        """Jacobian of the net at the starting point, and the scales of the unknowns.

        The value is None if each profile must be solved as in `calm run`.
        """
        if self.base is None or isinstance(self.net.file.environment.seabed, SeabedGrid):
            return None
        search, step = self.search(), 4.0 * self.net.settings.angle_step
        search.put_in(self.net.water.still() if self.still else self.net.water)
        how = search.marching(step, CHOSEN, FINE, given=False)
        # these unknowns already close the net; this call computes the slopes and scales
        search.do(leg_closing.CLOSE, self.base.unknowns, how, np.inf)
        return np.array(search.net.slopes), np.array(search.net.scale)

    def search(self) -> NetSearch:
        """Create the compiled search for the net."""
        settings = replace(self.net.settings, compiled=True)
        nodes = len(nodes_of(self.net.file.legs))
        water = self.water(*[(0.0,)] * 4)
        return NetSearch(net_legs(self.net.legs), nodes, water, settings, rough=True)

    def solve(
        self, current: tuple[Floats, ...], status: NDArray[np.int8], workers: int
    ) -> dict[str, Floats]:
        """Solve the profiles with status 0, update `status`, and return the result columns by name.

        `current` consists of four arrays: level depths (1 or n, k) [m], and u, v and w (n, k)
        [m/s]. `status` (n,) has an index in `STATUSES` for each profile.
        """
        count, pieces = len(status), self.net.file.pieces
        shapes = (len(pieces), 12), (len(clamps_down(pieces)), 7), (len(self.net.legs),)
        rows = NetRows(*(np.full((count, *shape), np.nan) for shape in shapes))
        endings = np.where(status == 0, 0, 99)
        if self.slopes is not None:

            def solve(block: slice) -> None:
                own = (each if len(each) == 1 < count else each[block] for each in current)
                mine = tuple(np.array(each, np.float64, order="C") for each in own)
                self._solve_rows(mine, NetRows(*(row[block] for row in rows)), endings[block])

            solve(slice(0, 0))  # compiles if necessary
            with ThreadPoolExecutor(workers) as pool:
                list(pool.map(solve, [slice(at, at + BLOCK) for at in range(0, count, BLOCK)]))
        else:
            endings[endings == 0] = SOLVE_ALONE
        for ending, name in OF_PROFILES.items():
            status[endings == ending] = STATUSES.index(name)
        columns = self._columns(rows)
        for name in columns:
            columns[name][endings != 0] = np.nan
        for case in np.flatnonzero(endings == SOLVE_ALONE).tolist():
            self._solve_alone(current, case, columns, status)
        return columns

    def _solve_rows(
        self, current: tuple[Floats, ...], rows: NetRows, endings: NDArray[np.intp]
    ) -> None:
        search, water = self.search(), self.water(*[(0.0,)] * 4)
        assert self.base is not None
        assert self.slopes is not None
        of_legs = self.net.file.legs
        weights = [leg.anchor_weight if leg.anchored else inf for leg in self.net.legs]
        clamped = [len(piece.clamps) for piece in self.net.file.pieces]
        arrays = NetArrays(
            on=solving.levels_for(current[0].shape[1], water),
            still=search.sea,
            start=self.base.unknowns,
            slopes=self.slopes[0],
            scale=self.slopes[1],
            x=np.zeros(len(self.base.unknowns)),
            piece=np.array([leg.first for leg in of_legs]),
            clamp=np.array([sum(clamped[: leg.first]) for leg in of_legs]),
            weight=np.array(weights),
        )
        step = float(search.settings.angle_step)
        given = (search.net, step, arrays, *current, rows, endings)
        outcome(solve_net_rows, True, *given)

    def _columns(self, rows: NetRows) -> dict[str, Floats]:
        file, count = self.net.file, len(rows.shares)
        pieces, clamps, legs = (row.shape[1] for row in rows)
        place, tilt = np.zeros((count, pieces, 3)), np.zeros((count, pieces))
        above, below = np.zeros((count, pieces)), np.zeros((count, pieces))
        columns = {one.name: np.full((count, legs), np.nan) for one in MOORED_ENDS}
        of_clamps, leans, held = rows.clamps, np.zeros((count, clamps)), 0
        for i, (leg, line) in enumerate(zip(file.legs, net_legs(self.net.legs), strict=True)):
            own = slice(leg.first, leg.first + len(line.line.length))
            upper, lower = rows.pieces[:, own, :6], rows.pieces[:, own, 6:]
            hangs = line.lower.free and not line.upper.free
            if hangs:  # listed from its lower end
                upper, lower = lower[:, ::-1], upper[:, ::-1]
            chord, pull = upper[..., :3] - lower[..., :3], upper[..., 3:] + lower[..., 3:]
            if line.upper.free and (head := head_count(line.line)):
                chord[:, :head] = (upper[:, :1] - lower[:, head - 1 : head])[..., :3]
            upright = chord.any(-1, keepdims=True)
            tilt[:, own] = leaning_of(np.where(upright, chord, -pull if hangs else pull))
            place[:, own] = upper[..., :3]
            above[:, own] = np.linalg.norm(upper[..., 3:], axis=-1)
            below[:, own] = np.linalg.norm(lower[..., 3:], axis=-1)
            anchor = leg.end - 1 if leg.bottom.anchor is not None else -1
            if anchor >= 0:
                place[:, anchor], force = lower[:, -1, :3], lower[:, -1, 3:]
                above[:, anchor] = below[:, anchor] = below[:, anchor - 1]
                columns["anchor_vertical"][:, i] = force[:, 2]
                columns["anchor_horizontal"][:, i] = np.hypot(force[:, 0], force[:, 1])
            if line.upper.free:
                columns["top_depth"][:, i] = -upper[:, 0, 2]
                columns["used_buoyancy"][:, i] = rows.shares[:, i]
            for p, piece in enumerate(file.pieces[leg.first : leg.end], leg.first):
                for clamp in piece.clamps:
                    row = of_clamps[:, held]
                    leans[:, held] = tilt[:, p]
                    if p == anchor:
                        row[:, :3], row[:, 6] = place[:, p] - [0.0, 0.0, clamp.at], above[:, p]
                    elif line.line.flexible[p - leg.first]:
                        leans[:, held] = leaning_of(-row[:, 3:6] if hangs else row[:, 3:6])
                    held += 1
        on = [(n, clamp.at) for n, piece in enumerate(file.pieces) for clamp in piece.clamps]
        order = sorted(range(clamps), key=on.__getitem__)
        of_clamps, leans = of_clamps[:, order], leans[:, order]
        still = self.at_rest
        known = (still and (still.components.depth_top, still.clamps.depth)) or (np.nan, np.nan)
        sunk, sunk_clamps = -place[..., 2] - known[0], -of_clamps[..., 2] - known[1]
        anchors = [leg.end - 1 for leg in file.legs if leg.bottom.anchor is not None]
        sunk[:, anchors] = 0.0
        sunk_clamps[:, np.isin([on[k][0] for k in order], anchors)] = 0.0
        return columns | {
            "depth_top": -place[..., 2],
            "x_top": place[..., 0],
            "y_top": place[..., 1],
            "tension_top": above,
            "tension_bottom": below,
            "tilt": tilt,
            "knockdown": sunk,
            "clamp_depth": -of_clamps[..., 2],
            "clamp_x": of_clamps[..., 0],
            "clamp_y": of_clamps[..., 1],
            "clamp_tension": of_clamps[..., 6],
            "clamp_tilt": leans,
            "clamp_knockdown": sunk_clamps,
        }

    def _solve_alone(
        self, current: tuple[Floats, ...], case: int, columns: dict[str, Floats],
        status: NDArray[np.int8],
    ) -> None:  # fmt: skip
        (depth, u, v, w), still = current, self.still
        read = np.zeros((depth.shape[1], 4))
        levels = depth[case if len(depth) > 1 else 0]
        count = solving.read_profile(levels, u[case], v[case], w[case], read)
        if count <= 0:
            ending = solving.NO_CURRENT if count == 0 else solving.LEVELS_COINCIDE
            status[case] = STATUSES.index(OF_PROFILES[ending])
            return
        water = self.water(*(tuple(column) for column in read[:count].T.tolist()))
        try:
            solution = self.net.together(water, self.base)
            before: Any = [None] * len(solution.legs) if still is None else still.legs
            result = result_together(self.net, solution, before)
        except NoEquilibrium as failure:
            status[case] = STATUSES.index(failure.status)
            return
        found = result.ends
        for table in (result.components, result.clamps):
            found |= {one.variable: getattr(table, one.name) for one in table.columns()}
        for name, column in columns.items():
            column[case] = found[name]
