"""Solution of one mooring for many current profiles, with arrays as input and output."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cached_property
from math import prod
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from calm.assemble import assemble_water
from calm.batch import solving
from calm.batch.net_profiles import NetProfiles
from calm.batch.solving import LACKS_ROOM, OF_CLAMP, OF_ENDS, OF_PIECE, ProfileArrays, Results
from calm.batch.statuses import STATUSES, implausible, status_of
from calm.case import Design
from calm.case.columns import Output, ResultColumn, derive, shown_in
from calm.case.leg import Leg
from calm.case.measure import clamps_of, components_of
from calm.case.result_tables import MOORED_ENDS, Clamps, Columnar, Components
from calm.files import Clamp, CurrentTable, Piece
from calm.files.pieces import clamps_down
from calm.physics.compiled import outcome
from calm.physics.line import Floats, Integers, Line, Water
from calm.records.given import as_file, is_record
from calm.solve import Status
from calm.solve.audit import referee_of
from calm.solve.mooring import MORE_ROOM
from calm.solve.problem import MANY_ROOM, problem_of
from calm.solve.solution import FOUND

if TYPE_CHECKING:
    import pandas
    from xarray import Dataset

    from calm.records.given import Given
    from calm.records.record import Levels

BLOCK = 1024
"""Number of profiles that a worker solves at a time."""

_IMPLAUSIBLE = STATUSES.index("implausible-current")
_ANCHOR_LIFTS = STATUSES.index(Status.ANCHOR_LIFTS.label)
_STILL = CurrentTable((0.0,), (0.0,), (0.0,), (0.0,))


class Profiles(Columnar):
    """Results of a mooring for n profiles, with NaN for a profile whose `status` is not 0.

    Depths, offsets and knockdown are in m, tensions and forces in N, tilt in degrees.

    Attributes for the components, such as ``tilt``, have the shape (n, p). The p components are in
    the order of the file, with the anchor last. Attributes for the clamps, such as ``clamp_depth``,
    have the shape (n, m), in order down the line. Attributes for the ends of the line, such as
    ``top_depth``, have the shape (n,), or (n, l) for a net of l legs. If the profiles form an array
    with several dimensions, these dimensions replace n.

    Attributes
    ----------
    component_label, clamp_label : labels of the components (p,) and of the clamps (m,)
    status : (n,) status of each profile, as an index in `STATUSES`
    """

    component_label: tuple[str, ...]
    clamp_label: tuple[str, ...]
    status: NDArray[np.int8]

    @classmethod
    def names(cls) -> list[str]:
        """Return the names of the columns, in table order."""
        own = (one.variable for columns in cls.columns().values() for one in columns)
        return ["component_label", "clamp_label", *own, "status"]

    @classmethod
    def columns(cls) -> dict[str, list[ResultColumn]]:
        """Return the batch columns by dimension: `component`, `clamp`, or an empty string.

        The empty string stands for values at the ends of the line.
        """
        return {
            "component": Components.columns(Output.BATCH),
            "clamp": Clamps.columns(Output.BATCH),
            "": shown_in(MOORED_ENDS, Output.BATCH),
        }

    @classmethod
    def made(
        cls, pieces: Sequence[Piece], status: NDArray[np.int8], columns: Mapping[str, Floats]
    ) -> Profiles:
        """Build the results for the profiles of a line, with labels and derived columns."""
        parts: dict[str, Sequence[Piece | Clamp]] = {
            "component": pieces,
            "clamp": clamps_down(pieces),
        }
        labels = {f"{one}_label": tuple(part.label for part in own) for one, own in parts.items()}
        known: dict[str, Any] = {**columns}
        for dimension, own in parts.items():
            entered = cls.columns()[dimension]
            given = {one.name: known[one.variable] for one in entered if one.variable in known}
            found = derive(entered, {"part": own, **given})
            known |= {one.variable: found[one.name] for one in entered if one.name in found}
        return cls(**labels, **known, status=status)

    def __repr__(self) -> str:
        parts = f"{len(self.component_label)} components, {len(self.clamp_label)} clamps"
        failed = np.count_nonzero(self.status)
        return f"Profiles({self.status.size} profiles, {failed} not solved; {parts})"

    def to_xarray(self) -> Dataset:
        """Return a dataset with labels and units; its dimensions are `profile` (or `profile_0`, …),
        `component`, `clamp` and, for a net, `leg`.
        """
        from xarray import Dataset

        many = self.status.ndim > 1
        profile = tuple(f"profile_{n}" if many else "profile" for n in range(self.status.ndim))
        legs = ("leg",) * (self.top_depth.ndim - self.status.ndim)
        variables: dict[str, Any] = {
            one.variable: (
                (*profile, *((part,) if part else legs)), getattr(self, one.variable), one.described
            )
            for part, columns in self.columns().items()
            for one in columns
        }  # fmt: skip
        meanings = {"flag_values": range(len(STATUSES)), "flag_meanings": " ".join(STATUSES)}
        variables["status"] = (profile, self.status, meanings)
        labels = {"component": [*self.component_label], "clamp": [*self.clamp_label]}
        return Dataset(variables, coords=labels)

    def to_pandas(self) -> pandas.DataFrame:
        """Return a data frame with one row per profile, and one column per quantity and label.

        An example of a column is ``frame["tilt", "adcp"]``. Values of the whole line have the label
        0. In a net, the label is the number of the leg, counted from 0.
        """
        import pandas

        frames = {}
        labels = {"component": self.component_label, "clamp": self.clamp_label}
        own = {one.variable: part for part, columns in self.columns().items() for one in columns}
        for name, part in {**own, "status": ""}.items():
            values = getattr(self, name).reshape(self.status.size, -1)
            named = labels.get(part, range(values.shape[1]))
            frames[name] = pandas.DataFrame(values, columns=[*named])
        return pandas.concat(frames, axis=1)


def solve_profiles(
    mooring: Design,
    u: ArrayLike | Given,
    v: ArrayLike | None = None,
    depth: ArrayLike | None = None,
    w: ArrayLike | None = None,
    *,
    workers: int | None = None,
) -> Profiles:
    """Solve a mooring for many current profiles.

    Each profile replaces the current of the file. Its results agree with `calm run` to 1e-4 of the
    water depth and 2e-4 of the tension, and do not depend on other profiles or on `workers`.

    Parameters
    ----------
    u, v, w : (..., k) current to the east, to the north and upward [m/s]; w is 0 by default. Levels
        with NaN and levels above the surface are ignored. The current is linear between levels, and
        constant above the first and below the last. Instead of arrays, `u` may be a record: a path,
        an `xarray.Dataset`, or a `pandas.DataFrame` with the columns of a CSV file
    depth : depths of the levels, in any order, with the shape (k,) or the shape of u [m]
    workers : number of threads; by default one per available processor

    Raises
    ------
    UsageError
        The design is a tow.
    InputError
        The record cannot be read.
    TypeError
        The current is not numeric, or `v` or `depth` is missing.
    ValueError
        The shapes do not match, or there is less than one worker.
    NoEquilibrium
        No length of a fitted piece reaches the required depth.
    """
    batch = Batch(mooring)
    if is_record(u):
        if any(each is not None for each in (v, depth, w)):
            raise TypeError("a record contains the whole current; omit v, depth and w")
        levels, east, north, up = _levels_of_record(mooring, u)
        return batch.solve(east, north, levels, up, workers=workers)
    if v is None or depth is None:
        raise TypeError(
            "v or depth is missing; they can only be omitted if u is a path, a dataset or a table"
        )
    return batch.solve(cast("ArrayLike", u), v, depth, w, workers=workers)


def _levels_of_record(mooring: Design, given: Any) -> Levels:
    from calm.records.current_file import open_record
    from calm.records.current_terms import Terms

    at = mooring.file.position
    place = None if at is None else (at.latitude, at.longitude)
    terms = Terms(float(mooring.water.depth), place)
    with as_file(given) as path, open_record(path, terms) as record:
        return record.profiles(0, record.count)


@dataclass(frozen=True)
class Batch:
    """Solver of a mooring or a net for many profiles, which may be solved in several calls."""

    mooring: Design

    @cached_property
    def water(self) -> Water:
        """Water of the mooring without current, except for the surface drift driven by the wind."""
        return assemble_water(replace(self.mooring.file.environment, current=_STILL))

    @cached_property
    def _net(self) -> NetProfiles:
        return NetProfiles(self.mooring)

    def solve(
        self,
        u: ArrayLike,
        v: ArrayLike,
        depth: ArrayLike,
        w: ArrayLike | None = None,
        *,
        workers: int | None = None,
    ) -> Profiles:
        """Solve profiles. For the parameters and errors, see `solve_profiles`."""
        if workers is not None and workers < 1:
            raise ValueError(f"`workers` is {workers}; it must be at least 1")
        shape, current = _checked(u, v, depth, w)
        if self.mooring.several:
            measured = self._solve_together(current, workers)
        else:
            measured, _ = self._solve_alone(self.mooring.moored, current, workers)
        return measured if shape == measured.status.shape else _reshaped(measured, shape)

    def slopes(self, u: Floats, v: Floats, depth: Floats) -> tuple[Profiles, Floats]:
        """Solve profiles (n, k) of a moored line in one thread, with derivatives of the depths.

        The derivatives (n, m + p, 2 k) [s] are the changes in depth of the m clamps and p
        components per change of u and v at each level. The derivatives are NaN for a profile
        without equilibrium.
        """
        _, current = _checked(u, v, depth, None)
        return self._solve_alone(self.mooring.moored, current, 1, 2 * current[1].shape[1])

    def _solve_together(self, current: tuple[Floats, ...], workers: int | None) -> Profiles:
        status = np.zeros(len(current[1]), np.int8)
        status[self._implausible(current)] = _IMPLAUSIBLE
        columns: dict[str, Any] = self._net.solve(current, status, workers or processors())
        return Profiles.made(self.mooring.file.pieces, status, columns)

    def _solve_alone(
        self, leg: Leg, current: tuple[Floats, ...], workers: int | None, columns: int = 0
    ) -> tuple[Profiles, Floats]:
        """Solve profiles of a single line.

        Return the results, and the derivatives (n, m + p, `columns`) of the depths of clamps and
        components with respect to u and v at each level. `columns` is 0 to omit the derivatives.
        """
        count = len(current[1])
        rows = unsolved(leg.line, count, columns)
        status = np.zeros(count, np.int8)

        def solve(block: slice) -> None:
            depth, *others = current
            levels = depth if len(depth) == 1 else depth[block]
            mine = levels, *(array[block] for array in others)
            columns = Results(*(array[block] for array in rows))
            self._solve_block(leg, mine, columns, status[block])

        _ = self._starts  # compiles if necessary, in a single thread
        with ThreadPoolExecutor(workers or processors()) as pool:
            for _ in pool.map(solve, [slice(at, at + BLOCK) for at in range(0, count, BLOCK)]):
                pass
        anchored = len(clamps_down(leg.file.pieces[-1:]))
        clamps = rows.clamps.shape[2]
        return _measured(leg, rows, status), np.concatenate(
            [
                rows.slopes[:, :clamps],
                np.zeros((count, anchored, columns)),
                rows.slopes[:, clamps:],
                np.zeros((count, 1, columns)),
            ],
            axis=1,
        )

    def _implausible(self, current: tuple[Floats, ...]) -> NDArray[np.bool_]:
        greatest = self.mooring.file.environment.maximum_speed
        depth, u, v, w = current
        return np.asarray(implausible(depth, u, v, w, greatest).any(axis=1))

    def _solve_block(
        self, leg: Leg, current: tuple[Floats, ...], rows: Results, status: NDArray[np.int8]
    ) -> None:
        # copies, since the currents of implausible profiles are removed
        depth, u, v, w = (np.array(array, np.float64, order="C") for array in current)
        false = self._implausible((depth, u, v, w))
        if false.any():
            u[false] = np.nan
        endings = np.zeros(len(status), np.intp)
        self._solve_rows(leg, (depth, u, v, w), rows, endings, MANY_ROOM)
        for ending in np.unique(endings).tolist():
            status[endings == ending] = status_of(leg, ending)
        lifts = (endings == FOUND) & (rows.ends[:, 1] > leg.anchor_weight)
        status[lifts] = _ANCHOR_LIFTS
        status[false] = _IMPLAUSIBLE
        for array in rows:
            array[status != 0] = np.nan

    @cached_property
    def _starts(self) -> Floats:
        """Starting values of the search; all profiles of a line have the same starting values."""
        leg = self.mooring.moored
        none = np.zeros((0, 1))
        current = np.zeros((1, 1)), none, none, none
        rows = unsolved(leg.line, 0)
        return self._march(leg, current, rows, np.zeros(0, np.intp), MANY_ROOM, None)

    def _solve_rows(
        self,
        leg: Leg,
        current: tuple[Floats, ...],
        rows: Results,
        endings: Integers,
        room: int,
    ) -> None:
        """Solve profiles with work arrays for `room` segments, or larger arrays if necessary."""
        self._march(leg, current, rows, endings, room, self._starts)
        again = np.flatnonzero(endings == LACKS_ROOM)
        if again.size:
            depth, *parts = current
            mine = depth if len(depth) == 1 else depth[again]
            found, ends = Results(*(array[again] for array in rows)), endings[again]
            few = (mine, *(np.ascontiguousarray(part[again]) for part in parts))
            self._solve_rows(leg, few, found, ends, MORE_ROOM * room)
            endings[again] = ends
            for array, solved in zip(rows, found, strict=True):
                array[again] = solved

    def _march(
        self,
        leg: Leg,
        current: tuple[Floats, ...],
        rows: Results,
        endings: Integers,
        room: int,
        starts: Floats | None,
    ) -> Floats:
        """Solve profiles, and return the starting values of the search.

        If `starts` is None, the starting values are computed, otherwise they are `starts`.
        """
        line, water = leg.line, self.water
        depth, *parts = current
        on = solving.levels_for(depth.shape[1], water)
        problem = problem_of(
            line, water, leg.settings, compiled=True, rough=True, room=room,
            intervals=len(on.intervals),
        )  # fmt: skip
        # a profile without current is detected separately
        problem = problem._replace(limits=problem.limits._replace(at_rest=False))
        referee = referee_of(line, water, 0.0, True)
        found: Any = problem.starts
        if starts is not None:
            found[:] = starts
        pieces = leg.file.pieces[:-1]
        arrays = ProfileArrays(
            on=on,
            may_lie=np.array([one.component.kind == "chain" for one in pieces], np.intp),
            depths=np.zeros((3, len(line.clamp_piece) + len(line.length))),
        )
        given = (problem, referee, arrays, starts is None, depth, *parts, rows, endings)
        outcome(solving.solve_rows, True, *given)
        return np.asarray(found)


def unsolved(line: Line, count: int, columns: int = 0) -> Results:
    """Create results filled with NaN for `count` profiles.

    `columns` is the number of current components in the derivatives of the depths; 0 omits the
    derivatives.
    """
    pieces, clamps = len(line.length), len(line.clamp_piece)
    shapes = [
        (count, len(OF_PIECE), pieces),
        (count, len(OF_CLAMP), clamps),
        (count, len(OF_ENDS)),
        (count, clamps + pieces if columns else 0, columns),
    ]
    return Results(*(np.full(shape, np.nan) for shape in shapes))


def processors() -> int:
    """Number of processors available to this process."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _checked(
    u: ArrayLike, v: ArrayLike, depth: ArrayLike, w: ArrayLike | None
) -> tuple[tuple[int, ...], tuple[Floats, Floats, Floats, Floats]]:
    """Check the input arrays. Return the dimensions of the profiles, and depth, u, v, w as
    two-dimensional arrays.
    """
    east, north, down = _numeric_array(u), _numeric_array(v), _numeric_array(depth)
    up = np.broadcast_to(np.zeros(()), east.shape) if w is None else _numeric_array(w)
    if not east.ndim or not east.shape == north.shape == up.shape:
        raise ValueError(
            "u, v and w must have the same shape, profiles by levels; their shapes are "
            f"{east.shape}, {north.shape}, {up.shape}"
        )
    levels = east.shape[-1]
    if down.shape not in {(levels,), (1, levels), east.shape}:
        raise ValueError(
            f"depth must have the shape {(levels,)} or the shape of u, {east.shape}; its shape is "
            f"{down.shape}"
        )
    shape = east.shape[:-1]
    count = prod(shape)
    flat = [array.reshape(count, levels) for array in (east, north, up)]
    rows = count if down.shape == east.shape else 1  # a single row of depths for all profiles
    return shape, (down.reshape(rows, levels), flat[0], flat[1], flat[2])


def _numeric_array(values: ArrayLike) -> NDArray[Any]:
    array: NDArray[Any] = np.ma.filled(values, np.nan) if np.ma.isMA(values) else np.asarray(values)
    if array.dtype.kind not in "iuf":
        raise TypeError(f"the current must be numeric, not {array.dtype}")
    return array


def _reshaped(profiles: Profiles, shape: tuple[int, ...]) -> Profiles:
    columns: dict[str, Any] = {
        name: array.reshape(shape + array.shape[1:])
        for name, array in vars(profiles).items()
        if isinstance(array, np.ndarray)
    }
    return profiles.with_columns(**columns)


def _measured(leg: Leg, rows: Results, status: NDArray[np.int8]) -> Profiles:
    """Build the results of all profiles, with the values of the anchor as the last component."""
    pieces, clamps, ends, _ = rows
    above = leg.file.pieces[:-1]
    depth_top = np.full(pieces.shape[-1], np.nan)
    clamp_depth = np.full(clamps.shape[-1], np.nan)
    still = leg.at_rest
    if still is not None:
        depth_top = components_of(above, still).depth_top
        clamp_depth = clamps_of(above, still).depth
    pull = pieces[:, OF_PIECE.index("tension_bottom"), -1:]
    nothing = np.where(status[:, None] == 0, 0.0, np.nan)
    ends_at = {
        "depth_top": ends[:, OF_ENDS.index("end_depth"), None],
        "tension_top": pull,
        "tension_bottom": pull,
    }
    columns: dict[str, Any] = {
        name: np.hstack([pieces[:, i], ends_at.get(name, nothing)])
        for i, name in enumerate(OF_PIECE)
    }
    on_anchor = clamps_down(leg.file.pieces[-1:])
    ends_at |= {
        "depth": ends_at["depth_top"] + [clamp.at for clamp in on_anchor],
        "tension": np.repeat(pull, len(on_anchor), axis=1),
    }
    standing = np.repeat(nothing, len(on_anchor), axis=1)
    columns |= {
        f"clamp_{name}": np.hstack([clamps[:, i], ends_at.get(name, standing)])
        for i, name in enumerate(OF_CLAMP)
    }
    columns |= {name: ends[:, i] for i, name in enumerate(OF_ENDS) if name != "end_depth"}
    columns["knockdown"] = np.hstack([columns["depth_top"][:, :-1] - depth_top, nothing])
    columns["clamp_knockdown"] = np.hstack(
        [clamps[:, OF_CLAMP.index("depth")] - clamp_depth, standing]
    )
    return Profiles.made(leg.file.pieces, status, columns)
