"""A line laid out for the march: rigid rods, stretches of cable, and the loads between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from calm.physics.compiled import packed
from calm.physics.line import Line
from calm.physics.stretch import ElongationCurve, Knot
from calm.physics.strumming import AT_REST, Vibration

if TYPE_CHECKING:
    from calm.physics.reynolds import DragCurve


class Load(NamedTuple):
    """A rigid piece or a clamped instrument at `at` metres below the top of its rod.

    Attributes
    ----------
    piece, clamp : of the line; the clamp is -1 for the piece itself
    at : [m]
    lever : 1 - at/length, the share of the load that turns the rod; ½ for a rod of no length
    length : of the piece [m]; 0 of a clamp
    buoyancy, volume, normal_drag, tangential_drag, directional, lift, push_east, push_north : as
        in `Line`
    diameter, lengthening : of the curve that its drag follows, see `DragCurve`; the diameter is 0
        where it follows none
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
    """A stretch of cable or chain without clamps: a whole piece, or the part between two clamps.

    Attributes
    ----------
    piece : of the line
    length : unstretched [m]
    buoyancy, volume, normal_drag, tangential_drag, compliance, thinning : as in `Line`
    friction : number of the law, see `Friction`
    first_knot, end_knot : of its elongation curve among the knots of the track; the same where it
        has none
    diameter : by which it strums [m]; 0 where it does not
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
    """A rod, a stretch of cable or a clamp as the march comes to it.

    Attributes
    ----------
    kind : ROD, CABLE or CLAMP
    first, size : its first load among those of the course and how many it has; of a cable, its
        place among the cables and 1
    length : [m]
    """

    kind: int
    first: int
    size: int
    length: float


class Course(NamedTuple):
    """A `Track` as the march takes it: what stands in it, kind by kind, down the line.

    `landing` is the first stage that may come down on the seabed: none below it is buoyant.
    """

    stages: Sequence[Stage]
    loads: Sequence[Load]
    cables: Sequence[CableStretch]
    knots: Sequence[Knot]
    vibration: Vibration
    landing: int


@dataclass(frozen=True)
class Track:
    """A `Line` laid out for the march, from the free end to the anchor: rows of plain numbers.

    Attributes
    ----------
    stages, loads, cables, knots : of a `Stage`, a `Load`, a `CableStretch` and a `Knot` each
    vibration : the law by which the cables strum
    """

    stages: list[tuple[Any, ...]]
    loads: list[tuple[Any, ...]]
    cables: list[tuple[Any, ...]]
    knots: list[Knot]
    vibration: Vibration = AT_REST

    @cached_property
    def course(self) -> Course:
        """As the march takes it."""
        stages, cables = map(Stage._make, self.stages), map(CableStretch._make, self.cables)
        loads = list(map(Load._make, self.loads))
        return Course(list(stages), loads, list(cables), self.knots, self.vibration, self.landing)

    @cached_property
    def packed(self) -> Course:
        """Return the same as compiled laws take it."""
        rows: Any = (self.stages, self.loads, self.cables, self.knots)
        course: Course = packed(Course._make([*rows, self.vibration, self.landing]))
        return course

    @property
    def landing(self) -> int:
        """The first stage that may come down on the seabed: none below it is buoyant."""
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
        """The track as far as the first pieces go."""
        cables = [row for row in self.cables if row[0] < count]
        stages = [
            row
            for row in self.stages
            if (self.cables if row[0] == CABLE else self.loads)[row[1]][0] < count
        ]
        return replace(self, stages=stages, cables=cables)

    @staticmethod
    def of(line: Line) -> Track:
        """Lay out a line, free end first; its head (see `head_count`) becomes one rod."""
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
            hung = [(one, rows.clamp_at[one], 0.0, rows.clamp[one]) for one in clamps]
            for one, down, size, load in [(-1, 0.5 * length, length, rows.rigid[piece]), *hung]:
                at = top + down
                lever = 1.0 - at / total if total > 0.0 else 0.5
                self.loads.append((piece, one, at, lever, size, *load))
            top += length
        self.stages.append((ROD, first, len(self.loads) - first, total))

    def _add_cable(self, rows: _Rows, piece: int, curve: ElongationCurve | None) -> None:
        start, end, first = 0.0, rows.length[piece], len(self.knots)
        self.knots.extend(() if curve is None else curve.knots)
        figures = (*rows.cable[piece], first, len(self.knots), rows.strums[piece])
        rounding = 1e-12 * end  # a clamp so near to an end, or to another, is there
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
    """Return how many pieces at the free end make one rigid body: down to the first buoyant piece.

    Pieces without buoyancy listed above the first buoyant one (a beacon, ballast) are rigid with
    it; where a cable lies between, or nothing is buoyant, the first piece stands alone. At a
    towed end each does.
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
    """A line by rows of plain numbers, which are looked up far faster than arrays one by one.

    Attributes
    ----------
    length, clamp_at : as in `Line`
    rigid, clamp : of each piece, and of each clamp, what comes after the length in a `Load`
    cable : of each piece, what comes between the length and the knots in a `CableStretch`
    strums : of each piece, the diameter of a `CableStretch`
    clamps : of each piece, from its top
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
    """Columns, or single values throughout, row by row."""
    values = (
        column.tolist() if isinstance(column, np.ndarray) else [column] * count
        for column in columns
    )
    return list(zip(*values, strict=True))


def _followed(curves: Sequence[DragCurve | None]) -> tuple[Any, Any]:
    """The columns `diameter` and `lengthening` of loads that follow a curve, or 0 for none."""
    if not curves:
        return 0.0, 0.0
    return (
        np.array([0.0 if curve is None else curve.diameter for curve in curves]),
        np.array([0.0 if curve is None else curve.lengthening for curve in curves]),
    )
