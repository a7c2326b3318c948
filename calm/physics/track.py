"""A line laid out for the march: rigid rods, stretches of cable, and the loads between them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from calm.physics.compiled import packed
from calm.physics.line import Line
from calm.physics.stretch import Knot
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


@dataclass(frozen=True)
class Rod:
    """One rigid body: a piece, or the pieces above the first float together with it."""

    pieces: tuple[int, ...]
    lengths: tuple[float, ...]
    loads: tuple[Load, ...]

    @property
    def length(self) -> float:
        return sum(self.lengths)


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
    beat : its frequency times its diameter [m/s]; 0 where it does not strum
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
    beat: float


Part = Rod | CableStretch | Load


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
    """A `Line` laid out for the march: its parts from the free end to the anchor.

    `knots` are those of the elongation curves of its cables, `vibration` the law by which they
    strum.
    """

    stages: tuple[Part, ...]
    knots: tuple[Knot, ...] = ()
    vibration: Vibration = AT_REST

    @cached_property
    def course(self) -> Course:
        """As the march takes it."""
        stages: list[Stage] = []
        loads: list[Load] = []
        cables: list[CableStretch] = []
        for part in self.stages:
            if isinstance(part, CableStretch):
                stages.append(Stage(CABLE, len(cables), 1, part.length))
                cables.append(part)
            elif isinstance(part, Rod):
                stages.append(Stage(ROD, len(loads), len(part.loads), part.length))
                loads += part.loads
            else:
                stages.append(Stage(CLAMP, len(loads), 1, 0.0))
                loads.append(part)
        return Course(stages, loads, cables, self.knots, self.vibration, self.landing)

    @cached_property
    def packed(self) -> Course:
        """Return the same as compiled laws take it."""
        course: Course = packed(self.course)
        return course

    @property
    def landing(self) -> int:
        """The first stage that may come down on the seabed: none below it is buoyant."""
        for i in range(len(self.stages), 0, -1):
            for load in loads_of(self.stages[i - 1]):
                if load.buoyancy > 0.0:
                    return i
        return 0

    @staticmethod
    def of(line: Line, frequency: float = 0.0) -> Track:
        """Lay out a line, free end first; its head (see `head_count`) becomes one rod.

        `frequency` is that of the cables that strum [Hz].
        """
        head, rows = head_count(line), _Rows(line, frequency)
        parts: list[Part] = [_rod(rows, range(head))] if head else []
        knots: list[Knot] = []
        for piece, flexible in enumerate(line.flexible.tolist()[head:], head):
            if flexible:
                curve = line.elongation[piece] if line.elongation else None
                mine = () if curve is None else curve.knots
                parts.extend(_cable_parts(rows, piece, len(knots), len(mine)))
                knots += mine
            else:
                parts.append(_rod(rows, range(piece, piece + 1)))
        vibration = AT_REST if line.strumming is None else line.strumming.vibration(0.0)
        return Track(tuple(parts), tuple(knots), vibration)


def loads_of(stage: Part) -> tuple[Load | CableStretch, ...]:
    """Return what hangs on the line in a stage."""
    return stage.loads if isinstance(stage, Rod) else (stage,)


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
    beat : of each piece, as in `CableStretch`
    clamps : of each piece, from its top
    """

    def __init__(self, line: Line, frequency: float) -> None:
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
        strums = line.strumming is not None
        self.beat: list[float] = (frequency * line.diameter * strums).tolist()
        self.clamps: dict[int, list[int]] = {}
        on = line.clamp_piece.tolist()
        for clamp in np.argsort(line.clamp_at, kind="stable").tolist():
            self.clamps.setdefault(on[clamp], []).append(clamp)

    def clamp_load(self, m: int, piece: int, at: float = 0.0, lever: float = 0.5) -> Load:
        """A clamp on a piece."""
        return Load(piece, m, at, lever, 0.0, *self.clamp[m])


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


def _rod(rows: _Rows, pieces: range) -> Rod:
    lengths = tuple(rows.length[p] for p in pieces)
    total = sum(lengths)
    loads, top = [], 0.0

    def lever(at: float) -> float:
        return 1.0 - at / total if total > 0.0 else 0.5

    for piece, length in zip(pieces, lengths, strict=True):
        middle = top + 0.5 * length
        loads.append(Load(piece, -1, middle, lever(middle), length, *rows.rigid[piece]))
        for m in rows.clamps.get(piece, ()):
            at = top + rows.clamp_at[m]
            loads.append(rows.clamp_load(m, piece, at, lever(at)))
        top += length
    return Rod(tuple(pieces), lengths, tuple(loads))


def _cable_parts(rows: _Rows, piece: int, first_knot: int, knots: int) -> Iterable[Part]:
    start, end = 0.0, rows.length[piece]
    figures = (*rows.cable[piece], first_knot, first_knot + knots, rows.beat[piece])
    rounding = 1e-12 * end  # a clamp so near to an end, or to another, is there
    for m in rows.clamps.get(piece, ()):
        at = rows.clamp_at[m]
        if at - start > rounding:
            yield CableStretch(piece, at - start, *figures)
            start = at
        yield rows.clamp_load(m, piece)
    if end - start > rounding or end == 0.0:
        yield CableStretch(piece, end - start, *figures)
