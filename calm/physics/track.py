"""A line laid out for the march: rigid rods, stretches of cable, and the loads between them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

from calm.physics.friction import Friction
from calm.physics.line import Line
from calm.physics.reynolds import DragCurve
from calm.physics.stretch import ElongationCurve
from calm.physics.strumming import BourgetMarichal


@dataclass(frozen=True)
class Load:
    """A rigid piece or a clamped instrument at `at` metres below the top of its rod.

    `lever` is 1 - at/length, the share of the load that turns the rod; ½ for a rod of no length.
    """

    piece: int
    clamp: int
    at: float
    lever: float
    buoyancy: float
    volume: float
    normal_drag: float
    tangential_drag: float
    directional: bool
    lift: float = 0.0
    push_east: float = 0.0
    push_north: float = 0.0
    curve: DragCurve | None = None


@dataclass(frozen=True)
class Rod:
    """One rigid body: a piece, or the pieces above the first float together with it."""

    pieces: tuple[int, ...]
    lengths: tuple[float, ...]
    loads: tuple[Load, ...]

    @cached_property
    def length(self) -> float:
        return sum(self.lengths)


@dataclass(frozen=True)
class Vibration:
    """A cable that strums: the law, and its frequency times its diameter [m/s]."""

    law: BourgetMarichal
    beat: float


@dataclass(frozen=True)
class Cable:
    """A stretch of cable or chain without clamps: a whole piece, or the part between two clamps."""

    piece: int
    length: float
    buoyancy: float
    volume: float
    normal_drag: float
    tangential_drag: float
    compliance: float
    thinning: float
    elongation: ElongationCurve | None = None
    friction: Friction = Friction.BERTEAUX
    vibration: Vibration | None = None

    def strain(self, tension: float) -> float:
        """At a tension [N]."""
        if self.elongation is None:
            return self.compliance * tension
        return self.elongation.strain(tension)


Stage = Rod | Cable | Load


@dataclass(frozen=True)
class Track:
    """A `Line` laid out for the march: its stages from the free end to the anchor."""

    stages: tuple[Stage, ...]

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
        head = head_count(line)
        stages: list[Stage] = [_rod(line, range(head))] if head else []
        for piece in range(head, len(line.length)):
            if line.flexible[piece]:
                stages.extend(_cable_stages(line, piece, frequency))
            else:
                stages.append(_rod(line, range(piece, piece + 1)))
        return Track(tuple(stages))


def loads_of(stage: Stage) -> tuple[Load | Cable, ...]:
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


def _clamps_of(line: Line, piece: int) -> list[int]:
    clamps = [m for m in range(len(line.clamp_piece)) if line.clamp_piece[m] == piece]
    return sorted(clamps, key=lambda m: float(line.clamp_at[m]))


def _clamp_load(line: Line, m: int, at: float = 0.0, lever: float = 0.5) -> Load:
    return Load(
        piece=int(line.clamp_piece[m]),
        clamp=m,
        at=at,
        lever=lever,
        buoyancy=float(line.clamp_buoyancy[m]),
        volume=float(line.clamp_volume[m]),
        normal_drag=float(line.clamp_drag[m]),
        tangential_drag=0.0,
        directional=False,
        lift=float(line.clamp_lift[m]),
        curve=line.clamp_drag_curve[m] if line.clamp_drag_curve else None,
    )


def _rod(line: Line, pieces: range) -> Rod:
    lengths = tuple(float(line.length[p]) for p in pieces)
    total = sum(lengths)
    loads, top = [], 0.0

    def lever(at: float) -> float:
        return 1.0 - at / total if total > 0.0 else 0.5

    for piece, length in zip(pieces, lengths, strict=True):
        middle = top + 0.5 * length
        loads.append(
            Load(
                piece=piece,
                clamp=-1,
                at=middle,
                lever=lever(middle),
                buoyancy=float(line.buoyancy[piece]),
                volume=float(line.volume[piece]),
                normal_drag=float(line.normal_drag[piece]),
                tangential_drag=float(line.tangential_drag[piece]),
                directional=bool(line.directional[piece]),
                lift=float(line.lift[piece]),
                curve=line.drag_curve[piece] if line.drag_curve else None,
            )
        )
        for m in _clamps_of(line, piece):
            at = top + float(line.clamp_at[m])
            loads.append(_clamp_load(line, m, at, lever(at)))
        top += length
    return Rod(tuple(pieces), lengths, tuple(loads))


def _cable_stages(line: Line, piece: int, frequency: float) -> Iterable[Stage]:
    vibration = None
    if line.strumming is not None and frequency * line.diameter[piece] > 0.0:
        vibration = Vibration(line.strumming, frequency * float(line.diameter[piece]))

    def stretch(length: float) -> Cable:
        return Cable(
            piece=piece,
            length=length,
            buoyancy=float(line.buoyancy[piece]),
            volume=float(line.volume[piece]),
            normal_drag=float(line.normal_drag[piece]),
            tangential_drag=float(line.tangential_drag[piece]),
            compliance=float(line.compliance[piece]),
            thinning=float(line.thinning[piece]),
            elongation=line.elongation[piece] if line.elongation else None,
            friction=line.friction,
            vibration=vibration,
        )

    start, end = 0.0, float(line.length[piece])
    rounding = 1e-12 * end  # a clamp so near to an end, or to another, is there
    for m in _clamps_of(line, piece):
        at = float(line.clamp_at[m])
        if at - start > rounding:
            yield stretch(at - start)
            start = at
        yield _clamp_load(line, m)
    if end - start > rounding or end == 0.0:
        yield stretch(end - start)
