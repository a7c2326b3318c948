"""Layout of a line for the march: rods, cables and clamps in order, with the loads on them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from calm.physics.compiled import packed
from calm.physics.line import Line, once_per_input
from calm.physics.stretch import ElongationCurve, Knot
from calm.physics.strumming import AT_REST, Vibration

if TYPE_CHECKING:
    from calm.physics.reynolds import DragCurve


class Load(NamedTuple):
    """A rigid piece or a clamped instrument as a load on a rod.

    Attributes
    ----------
    piece, clamp : indices of piece and clamp in the line; the clamp is -1 for the piece itself
    at : distance of the load's centre from the top of the rod [m]
    lever : fraction of the load that rotates the rod, 1 - `at`/(length of the rod); ½ for a rod
        without length
    length : length of the rigid piece [m]; 0 for a clamp
    diameter, lengthening : values of the load's `DragCurve`; 0 without a curve

    Other attributes are as in `Line`.
    """

    piece: int
    clamp: int
    at: float
    lever: float
    length: float
    buoyancy: float
    volume: float
    normal_drag: float
    tangential_drag: float
    directional: int
    lift: float
    push_east: float
    push_north: float
    diameter: float
    lengthening: float


class CableStretch(NamedTuple):
    """A length of cable or chain without clamps: a whole piece, or a part between clamps.

    Attributes
    ----------
    piece : index of the piece in the line
    length : unstretched length [m]
    friction : number of the friction law, see `Friction`
    first_knot, end_knot : the points `first_knot` to `end_knot` - 1 of `Track.knots` are the
        elongation curve. Both numbers are equal for a cable without a curve
    diameter : diameter [m] if the cable strums, otherwise 0

    Other attributes are as in `Line`.
    """

    piece: int
    length: float
    buoyancy: float
    volume: float
    normal_drag: float
    tangential_drag: float
    compliance: float
    thinning: float
    friction: int
    first_knot: int
    end_knot: int
    diameter: float


ROD, CABLE, CLAMP = range(3)


class Stage(NamedTuple):
    """One step of the march along a line: a rod, a length of cable, or a clamp.

    Attributes
    ----------
    kind : ROD, CABLE or CLAMP
    first : index of the cable, or of the first load
    size : number of loads; 1 for a cable
    length : length of the stage [m]
    """

    kind: int
    first: int
    size: int
    length: float


class Course(NamedTuple):
    """A `Track` in the form used by the march, with lists of its parts from the top down.

    `landing` is the index of the first stage that may touch the seabed.
    """

    stages: Sequence[Stage]
    loads: Sequence[Load]
    cables: Sequence[CableStretch]
    knots: Sequence[Knot]
    vibration: Vibration
    landing: int


@dataclass(frozen=True)
class Track:
    """A `Line` as rows of plain numbers for the march, from the free end to the anchor.

    The rows have the fields of `Stage`, `Load`, `CableStretch` and `Knot`. `vibration` is the
    strumming law of the cables.
    """

    stages: list[tuple[Any, ...]]
    loads: list[tuple[Any, ...]]
    cables: list[tuple[Any, ...]]
    knots: list[Knot]
    vibration: Vibration = AT_REST

    @cached_property
    def course(self) -> Course:
        """The track as named tuples for interpreted code."""
        stages, cables = map(Stage._make, self.stages), map(CableStretch._make, self.cables)
        loads = list(map(Load._make, self.loads))
        return Course(list(stages), loads, list(cables), self.knots, self.vibration, self.landing)

    @cached_property
    def packed(self) -> Course:
        """The track as arrays for compiled code."""
        rows: Any = (self.stages, self.loads, self.cables, self.knots)
        course: Course = packed(Course._make([*rows, self.vibration, self.landing]))
        return course

    @property
    def landing(self) -> int:
        """Index of the first stage that may touch the seabed, below the last buoyant stage."""
        for i in range(len(self.stages), 0, -1):
            kind, first, size, _ = self.stages[i - 1]
            if kind == CABLE:
                rises = CableStretch._make(self.cables[first]).buoyancy > 0.0
            else:
                rises = any(
                    Load._make(load).buoyancy > 0.0 for load in self.loads[first : first + size]
                )
            if rises:
                return i
        return 0

    def first_pieces(self, count: int) -> Track:
        """Return a track with only the first `count` pieces."""
        cables = [row for row in self.cables if row[0] < count]
        stages = [
            row
            for row in self.stages
            if (self.cables if row[0] == CABLE else self.loads)[row[1]][0] < count
        ]
        return replace(self, stages=stages, cables=cables)

    @staticmethod
    @once_per_input
    def of(line: Line) -> Track:
        """Convert a line to a track. The pieces counted by `head_count` become one rod."""
        vibration = AT_REST if line.strumming is None else line.strumming.vibration(0.0)
        track = Track([], [], [], [], vibration)
        rows, head = _Rows(line), head_count(line)
        if head:
            track._add_rod(rows, range(head))
        for piece, flexible in enumerate(line.flexible.tolist()[head:], head):
            if flexible:
                track._add_cable(rows, piece, line.elongation[piece] if line.elongation else None)
            else:
                track._add_rod(rows, range(piece, piece + 1))
        return track

    def _add_rod(self, rows: _Rows, pieces: range) -> None:
        first, top, total = len(self.loads), 0.0, sum([rows.length[piece] for piece in pieces])
        for piece in pieces:
            length, clamps = rows.length[piece], rows.clamps.get(piece, ())
            clamp_loads = [(one, rows.clamp_at[one], 0.0, rows.clamp[one]) for one in clamps]
            for one, down, size, load in [
                (-1, 0.5 * length, length, rows.rigid[piece]),
                *clamp_loads,
            ]:
                at = top + down
                lever = 1.0 - at / total if total > 0.0 else 0.5
                self.loads.append((piece, one, at, lever, size, *load))
            top += length
        self.stages.append((ROD, first, len(self.loads) - first, total))

    def _add_cable(self, rows: _Rows, piece: int, curve: ElongationCurve | None) -> None:
        start, end, first = 0.0, rows.length[piece], len(self.knots)
        self.knots.extend(() if curve is None else curve.knots)
        figures = (*rows.cable[piece], first, len(self.knots), rows.strums[piece])
        rounding = 1e-12 * end  # clamps this close to an end or to each other share one position
        for clamp in rows.clamps.get(piece, ()):
            at = rows.clamp_at[clamp]
            if at - start > rounding:
                self._add_stretch((piece, at - start, *figures))
                start = at
            self.stages.append((CLAMP, len(self.loads), 1, 0.0))
            self.loads.append((piece, clamp, 0.0, 0.5, 0.0, *rows.clamp[clamp]))
        if end - start > rounding or end == 0.0:
            self._add_stretch((piece, end - start, *figures))

    def _add_stretch(self, cable: tuple[Any, ...]) -> None:
        self.stages.append((CABLE, len(self.cables), 1, cable[1]))
        self.cables.append(cable)


def head_count(line: Line) -> int:
    """Return the number of pieces at the free end that form one rigid body.

    The body ends with the first buoyant piece; pieces above, such as a beacon, are rigidly
    connected. The number is 0 if the end is towed, if no piece is buoyant, or if a cable is above
    the first buoyant piece.
    """
    if line.towed:
        return 0
    for piece in range(len(line.length)):
        if line.flexible[piece]:
            break
        if line.buoyancy[piece] > 0:
            return piece + 1
    return 0


class _Rows:
    """Data of a `Line` as plain numbers, which Python reads much faster than array elements.

    Attributes
    ----------
    length, clamp_at : as in `Line`
    rigid : for each piece, the fields of its `Load` after `length`
    clamp : for each clamp, the fields of its `Load` after `length`
    cable : for each piece, the fields of its `CableStretch` from `buoyancy` to `friction`
    strums : for each piece, the diameter of its `CableStretch` [m]
    clamps : for each piece, the indices of its clamps from the top down
    """

    def __init__(self, line: Line) -> None:
        pieces, clamps = len(line.length), len(line.clamp_at)
        self.length: list[float] = line.length.tolist()
        self.clamp_at: list[float] = line.clamp_at.tolist()
        self.rigid = _rows(
            pieces, line.buoyancy, line.volume, line.normal_drag, line.tangential_drag,
            line.directional, line.lift, 0.0, 0.0, *_followed(line.drag_curve),
        )  # fmt: skip
        self.clamp = _rows(
            clamps, line.clamp_buoyancy, line.clamp_volume, line.clamp_drag, 0.0,
            False, line.clamp_lift, 0.0, 0.0, *_followed(line.clamp_drag_curve),
        )  # fmt: skip
        self.cable = _rows(
            pieces, line.buoyancy, line.volume, line.normal_drag, line.tangential_drag,
            line.compliance, line.thinning, line.friction.law,
        )  # fmt: skip
        self.strums: list[float] = (line.diameter * (line.strumming is not None)).tolist()
        self.clamps: dict[int, list[int]] = {}
        on = line.clamp_piece.tolist()
        for clamp in np.argsort(line.clamp_at, kind="stable").tolist():
            self.clamps.setdefault(on[clamp], []).append(clamp)


def _rows(count: int, *columns: Any) -> list[tuple[Any, ...]]:
    values = (
        column.tolist() if isinstance(column, np.ndarray) else [column] * count
        for column in columns
    )
    return list(zip(*values, strict=True))


def _followed(curves: Sequence[DragCurve | None]) -> tuple[Any, Any]:
    if not curves:
        return 0.0, 0.0
    return (
        np.array([0.0 if curve is None else curve.diameter for curve in curves]),
        np.array([0.0 if curve is None else curve.lengthening for curve in curves]),
    )
