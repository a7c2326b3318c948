"""A line laid out for the march: rigid rods, stretches of cable, and the loads between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from calm.physics.compiled import record_type
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
    """A `Line` laid out for the march, from the free end to the anchor.

    Attributes
    ----------
    packed : as compiled laws take it
    """

    packed: Course

    @cached_property
    def course(self) -> Course:
        """The same as CPython takes it."""
        given: Any = self.packed
        return Course(
            [Stage(*row) for row in given.stages.tolist()],
            [Load(*row) for row in given.loads.tolist()],
            [CableStretch(*row) for row in given.cables.tolist()],
            [Knot(*row) for row in given.knots.tolist()],
            given.vibration,
            given.landing,
        )

    def first_pieces(self, count: int) -> Track:
        """The track as far as the first pieces go."""
        given: Any = self.packed
        hung = given.loads["piece"], given.cables["piece"]
        stages = [
            stage for stage in given.stages.tolist() if hung[stage[0] == CABLE][stage[1]] < count
        ]
        cables = given.cables[hung[1] < count]
        return Track(
            given._replace(
                stages=given.stages[: len(stages)],
                cables=cables,
                landing=_landing(stages, given.loads, cables),
            )
        )

    @staticmethod
    def of(line: Line, frequency: float = 0.0) -> Track:
        """Lay out a line, free end first; its head (see `head_count`) becomes one rod.

        `frequency` is that of the cables that strum [Hz].
        """
        stages, hung, stretches = _places(line)
        piece, clamp, at, lever, length = _columns(hung, 5)
        row = np.where(clamp < 0.0, len(line.clamp_at) + piece, clamp).astype(np.int64)
        nothing = np.zeros(len(line.clamp_at))

        def of_both(clamps: Any, pieces: Any) -> Any:
            return np.concatenate([clamps, pieces])[row]

        loads = _records(
            Load, piece, clamp, at, lever, length,
            of_both(line.clamp_buoyancy, line.buoyancy), of_both(line.clamp_volume, line.volume),
            of_both(line.clamp_drag, line.normal_drag), of_both(nothing, line.tangential_drag),
            of_both(nothing, line.directional), of_both(line.clamp_lift, line.lift), 0.0, 0.0,
            *map(of_both, _followed(line.clamp_drag_curve, len(nothing)),
                 _followed(line.drag_curve, len(line.length))),
        )  # fmt: skip
        piece, length = _columns(stretches, 2)
        on = piece.astype(np.int64)
        curves = [() if curve is None else curve.knots for curve in line.elongation]
        ends = np.cumsum([0, *(map(len, curves) if curves else [0] * len(line.length))])
        cables = _records(
            CableStretch, piece, length, line.buoyancy[on], line.volume[on],
            line.normal_drag[on], line.tangential_drag[on], line.compliance[on],
            line.thinning[on], line.friction.law, ends[on], ends[on + 1],
            frequency * line.diameter[on] * (line.strumming is not None),
        )  # fmt: skip
        knots: Any = np.array([knot for curve in curves for knot in curve], record_type(Knot))
        vibration = AT_REST if line.strumming is None else line.strumming.vibration(0.0)
        landing = _landing(stages, loads, cables)
        rows = _records(Stage, *_columns(stages, 4))
        return Track(Course(rows, loads, cables, knots, vibration, landing))


def _landing(stages: Sequence[Any], loads: Any, cables: Any) -> int:
    """The first stage that may come down on the seabed: none below it is buoyant."""
    rises = [(loads["buoyancy"] > 0.0).tolist(), (cables["buoyancy"] > 0.0).tolist()]
    for i in range(len(stages), 0, -1):
        kind, first, size, _ = stages[i - 1]
        if any(rises[kind == CABLE][first : first + size]):
            return i
    return 0


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


def _places(line: Line) -> tuple[list[Any], list[Any], list[Any]]:
    """Return what stands where along a line.

    These are the rows of its stages, the first five columns of its loads, and the piece and length
    of its stretches of cable.
    """
    stages: list[tuple[int, int, int, float]] = []
    loads: list[tuple[int, int, float, float, float]] = []
    stretches: list[tuple[int, float]] = []
    lengths: list[float] = line.length.tolist()
    from_top: list[float] = line.clamp_at.tolist()
    on: list[int] = line.clamp_piece.tolist()
    clamps: dict[int, list[int]] = {}
    for clamp in np.argsort(line.clamp_at, kind="stable").tolist():
        clamps.setdefault(on[clamp], []).append(clamp)

    def rod(pieces: range) -> None:
        first, top, total = len(loads), 0.0, sum([lengths[piece] for piece in pieces])
        for piece in pieces:
            length = lengths[piece]
            hung = [(clamp, from_top[clamp], 0.0) for clamp in clamps.get(piece, ())]
            for clamp, down, high in [(-1, 0.5 * length, length), *hung]:
                at = top + down
                loads.append((piece, clamp, at, 1.0 - at / total if total > 0.0 else 0.5, high))
            top += length
        stages.append((ROD, first, len(loads) - first, total))

    def cable(piece: int) -> None:
        start, end = 0.0, lengths[piece]
        rounding = 1e-12 * end  # a clamp so near to an end, or to another, is there

        def stretch(length: float) -> None:
            stages.append((CABLE, len(stretches), 1, length))
            stretches.append((piece, length))

        for clamp in clamps.get(piece, ()):
            at = from_top[clamp]
            if at - start > rounding:
                stretch(at - start)
                start = at
            stages.append((CLAMP, len(loads), 1, 0.0))
            loads.append((piece, clamp, 0.0, 0.5, 0.0))
        if end - start > rounding or end == 0.0:
            stretch(end - start)

    head = head_count(line)
    if head:
        rod(range(head))
    for piece, flexible in enumerate(line.flexible.tolist()[head:], head):
        if flexible:
            cable(piece)
        else:
            rod(range(piece, piece + 1))
    return stages, loads, stretches


def _columns(rows: Sequence[Any], count: int) -> Any:
    return np.array(rows, float).reshape(-1, count).T


def _records(named: type, first: Any, *others: Any) -> Any:
    """Return an array of a named tuple's records from its columns, or values that all share."""
    rows = np.empty(len(first), record_type(named))
    for name, column in zip(rows.dtype.names or (), (first, *others), strict=True):
        rows[name] = column
    return rows


def _followed(curves: Sequence[DragCurve | None], count: int) -> tuple[Any, Any]:
    """The columns `diameter` and `lengthening` of loads that follow a curve, or 0 for none."""
    if not curves:
        return np.zeros(count), np.zeros(count)
    return (
        np.array([0.0 if curve is None else curve.diameter for curve in curves]),
        np.array([0.0 if curve is None else curve.lengthening for curve in curves]),
    )
