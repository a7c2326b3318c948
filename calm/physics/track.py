"""A line laid out for the march: rigid rods, stretches of cable, and the loads between them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from calm.physics.compiled import packed
from calm.physics.line import Line
from calm.physics.stretch import Knot
from calm.physics.strumming import AT_REST, Vibration


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

    @cached_property
    def length(self) -> float:
        return sum(self.lengths)


class Cable(NamedTuple):
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


Part = Rod | Cable | Load


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
    cables: Sequence[Cable]
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
        cables: list[Cable] = []
        for part in self.stages:
            if isinstance(part, Cable):
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
        """The same as compiled laws take it."""
        course: Course = packed(self.course)
        return course

    @property
    def landing(self) -> int:
        """The first stage that may come down on the seabed: none below it is buoyant."""
        lifting = [
            i
            for i, stage in enumerate(self.stages)
            if any(load.buoyancy > 0.0 for load in loads_of(stage))
        ]
        return lifting[-1] + 1 if lifting else 0

    @staticmethod
    def of(line: Line, frequency: float = 0.0) -> Track:
        """Lay out a line, free end first; its head (see `head_count`) becomes one rod.

        `frequency` is that of the cables that strum [Hz].
        """
        head, rows = head_count(line), _Rows(line)
        parts: list[Part] = [_rod(rows, range(head))] if head else []
        knots: list[Knot] = []
        for piece, flexible in enumerate(line.flexible.tolist()[head:], head):
            if flexible:
                curve = line.elongation[piece] if line.elongation else None
                mine = () if curve is None else curve.knots
                parts.extend(_cable_parts(rows, piece, frequency, len(knots), len(mine)))
                knots += mine
            else:
                parts.append(_rod(rows, range(piece, piece + 1)))
        vibration = AT_REST if line.strumming is None else line.strumming.vibration(0.0)
        return Track(tuple(parts), tuple(knots), vibration)


def loads_of(stage: Part) -> tuple[Load | Cable, ...]:
    """What hangs on the line in a stage."""
    return stage.loads if isinstance(stage, Rod) else (stage,)


def head_count(line: Line) -> int:
    """How many pieces at the free end make one rigid body: down to the first buoyant piece.

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
    """The columns of a line as lists of numbers, which are looked up far faster one by one.

    `clamps` are those of each piece, from its top.
    """

    def __init__(self, line: Line) -> None:
        self.line = line
        self.length: list[float] = line.length.tolist()
        self.buoyancy: list[float] = line.buoyancy.tolist()
        self.volume: list[float] = line.volume.tolist()
        self.normal_drag: list[float] = line.normal_drag.tolist()
        self.tangential_drag: list[float] = line.tangential_drag.tolist()
        self.compliance: list[float] = line.compliance.tolist()
        self.thinning: list[float] = line.thinning.tolist()
        self.lift: list[float] = line.lift.tolist()
        self.diameter: list[float] = line.diameter.tolist()
        self.clamp_at: list[float] = line.clamp_at.tolist()
        self.clamp_buoyancy: list[float] = line.clamp_buoyancy.tolist()
        self.clamp_volume: list[float] = line.clamp_volume.tolist()
        self.clamp_drag: list[float] = line.clamp_drag.tolist()
        self.clamp_lift: list[float] = line.clamp_lift.tolist()
        self.directional: list[bool] = line.directional.tolist()
        self.clamp_piece: list[int] = line.clamp_piece.tolist()
        self.clamps: dict[int, list[int]] = {}
        for clamp in np.argsort(line.clamp_at, kind="stable").tolist():
            self.clamps.setdefault(self.clamp_piece[clamp], []).append(clamp)


def _clamp_load(rows: _Rows, m: int, at: float = 0.0, lever: float = 0.5) -> Load:
    curves = rows.line.clamp_drag_curve
    curve = curves[m] if curves else None
    return Load(
        piece=rows.clamp_piece[m],
        clamp=m,
        at=at,
        lever=lever,
        length=0.0,
        buoyancy=rows.clamp_buoyancy[m],
        volume=rows.clamp_volume[m],
        normal_drag=rows.clamp_drag[m],
        tangential_drag=0.0,
        directional=False,
        lift=rows.clamp_lift[m],
        push_east=0.0,
        push_north=0.0,
        diameter=0.0 if curve is None else curve.diameter,
        lengthening=0.0 if curve is None else curve.lengthening,
    )


def _rod(rows: _Rows, pieces: range) -> Rod:
    lengths = tuple(rows.length[p] for p in pieces)
    total = sum(lengths)
    curves = rows.line.drag_curve
    loads, top = [], 0.0

    def lever(at: float) -> float:
        return 1.0 - at / total if total > 0.0 else 0.5

    for piece, length in zip(pieces, lengths, strict=True):
        middle = top + 0.5 * length
        curve = curves[piece] if curves else None
        loads.append(
            Load(
                piece=piece,
                clamp=-1,
                at=middle,
                lever=lever(middle),
                length=length,
                buoyancy=rows.buoyancy[piece],
                volume=rows.volume[piece],
                normal_drag=rows.normal_drag[piece],
                tangential_drag=rows.tangential_drag[piece],
                directional=rows.directional[piece],
                lift=rows.lift[piece],
                push_east=0.0,
                push_north=0.0,
                diameter=0.0 if curve is None else curve.diameter,
                lengthening=0.0 if curve is None else curve.lengthening,
            )
        )
        for m in rows.clamps.get(piece, ()):
            at = top + rows.clamp_at[m]
            loads.append(_clamp_load(rows, m, at, lever(at)))
        top += length
    return Rod(tuple(pieces), lengths, tuple(loads))


def _cable_parts(
    rows: _Rows, piece: int, frequency: float, first_knot: int, knots: int
) -> Iterable[Part]:
    start, end = 0.0, rows.length[piece]
    stretch = Cable(
        piece=piece,
        length=end,
        buoyancy=rows.buoyancy[piece],
        volume=rows.volume[piece],
        normal_drag=rows.normal_drag[piece],
        tangential_drag=rows.tangential_drag[piece],
        compliance=rows.compliance[piece],
        thinning=rows.thinning[piece],
        friction=rows.line.friction.law,
        first_knot=first_knot,
        end_knot=first_knot + knots,
        beat=frequency * rows.diameter[piece] if rows.line.strumming is not None else 0.0,
    )
    rounding = 1e-12 * end  # a clamp so near to an end, or to another, is there
    for m in rows.clamps.get(piece, ()):
        at = rows.clamp_at[m]
        if at - start > rounding:
            yield stretch._replace(length=at - start)
            start = at
        yield _clamp_load(rows, m)
    if end - start > rounding or end == 0.0:
        yield stretch._replace(length=end - start)
