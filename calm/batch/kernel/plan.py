"""A mooring laid out for the kernel: its stages, loads, cuts and limits."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from calm.assemble import assemble_water
from calm.batch.kernel.contact import first_chain_of, grips_on, when_looked_for
from calm.batch.kernel.cuts import cuts_of
from calm.batch.kernel.lanes import ABOVE_IT, CABLE, CLAMP, ITSELF, ROD
from calm.case import Mooring
from calm.files import CurrentTable
from calm.physics.friction import Friction
from calm.physics.hull import Floating
from calm.physics.line import Floats, Line, Water
from calm.physics.profile import Profile
from calm.physics.state import MarchError
from calm.physics.track import Cable, Load, Part, Rod, Track, head_count
from calm.solve.closing import Closing
from calm.solve.locate import SHARES, upright_depth
from calm.solve.mooring import BARELY_LANDED
from calm.solve.unknown import Unknown

NEAR = 2e-6
"""How far the loads of a rod may be from where they are looked up, as a share of the depth."""
NEAR_ON_SEABED = 2e-7
"""The same of a line on the seabed, which may lie far in the direction of its last pull."""
FASTEST, SPEEDS = 4.0, 41
"""Currents up to so many m/s, and how many of them, for which the fall of the line is known."""
SHARES_KNOWN = 1025
"""Shares of its buoyancy in use for which it is known how a float rides."""

_STILL = CurrentTable((0.0,), (0.0,), (0.0,), (0.0,))


@dataclass(frozen=True)
class Way:
    """What the kernel reads of a line that is looked for clear of the seabed, or lying on it."""

    stages: tuple[Any, ...]
    mooring: tuple[Any, ...]
    chances: tuple[Any, ...]


@dataclass(frozen=True)
class Plan:
    """What the kernel reads of a mooring: see the functions below for what stands in each.

    `water` is the sea without the current of the file: density, and what the wind drives.
    """

    water: Water
    parts: tuple[Any, ...]
    floating: tuple[Any, ...]
    clear: Way
    lying: Way
    fixed: Floats
    contact: int

    @property
    def arrays(self) -> tuple[Any, ...]:
        """All that the kernel takes."""
        clear, lying = (
            (way.stages, self.parts, way.mooring, self.floating, way.chances, self.fixed)
            for way in (self.clear, self.lying)
        )
        return clear, lying, self.contact


def base_water(mooring: Mooring) -> Water:
    """The water of a mooring with no current but what the wind drives."""
    return assemble_water(replace(mooring.file.environment, current=_STILL))


def plan_of(mooring: Mooring) -> Plan | None:
    """Lay a mooring out; None where it has what the lanes do not solve.

    That is elongation tables, drag curves, strumming by Bourget & Marichal, other friction than
    Berteaux's, and a line that begins with a cable.
    """
    line, water = mooring.line, base_water(mooring)
    if not _simple(line):
        return None
    closing = Closing(line, water, mooring.settings)
    track = closing.track
    head = track.stages[0]
    if not isinstance(head, Rod):
        return None
    afloat = closing.floats[0] if closing.floats else -1
    floats = afloat in head.pieces
    load_of = [load for stage in track.stages for load in _loads(stage)]
    first_chain = first_chain_of(mooring, track)
    clear, lying = (
        _way(closing, track, afloat if floats else -1, first_chain, lands=lands)
        for lands in (False, True)
    )
    return Plan(
        water=water,
        parts=_parts(line, track, load_of),
        floating=_riding(head, afloat, line.floating if floats else None),
        clear=clear,
        lying=lying,
        fixed=np.column_stack([water.level, water.u, water.v, water.density]),
        contact=when_looked_for(line, water, track),
    )


def _way(closing: Closing, track: Track, afloat: int, first_chain: int, *, lands: bool) -> Way:
    """The line clear of the seabed, or on it: how it is cut, where it ends, what it may miss by."""
    unknown = closing.whole(lands)
    top = upright_depth(closing, unknown)
    line, water = closing.line, closing.water
    return Way(
        stages=(
            *_stages(line, water, track, afloat, lands),
            *grips_on(track, water, closing.settings.seabed_friction),
            lands,
        ),
        mooring=(
            water.depth,
            unknown.goal,
            top,
            afloat >= 0,
            line.floating is not None,
            line.anchor_height,
            first_chain,
            BARELY_LANDED * line.anchor_height,
        ),
        chances=(np.array(SHARES), _falls(closing, unknown, top)),
    )


def _simple(line: Line) -> bool:
    """Whether a line has only what the lanes solve."""
    curves = (*line.elongation, *line.drag_curve, *line.clamp_drag_curve)
    return (
        all(curve is None for curve in curves)
        and line.strumming is None
        and line.friction is Friction.BERTEAUX
        and bool(np.isin(line.thinning, (0.0, 0.5)).all())
        and bool((line.length[line.flexible] > 0.0).all())
    )


def _loads(stage: Part) -> tuple[Load, ...]:
    if isinstance(stage, Cable):
        return ()
    return stage.loads if isinstance(stage, Rod) else (stage,)


def _stages(line: Line, water: Water, track: Track, afloat: int, lands: bool) -> tuple[Any, ...]:
    """Kind, first load or cut, count of them and length of every stage; cables, cuts, loads."""
    kinds, firsts, counts, lengths = [], [], [], []
    cables: list[tuple[float, ...]] = []
    cuts: list[float] = []
    loads: list[tuple[float, ...]] = []
    given = iter(cuts_of(track, water.depth, lands))
    for n, stage in enumerate(track.stages):
        if isinstance(stage, Cable):
            mine = next(given).tolist()
            kinds.append(CABLE)
            firsts.append(len(cuts))
            counts.append(len(mine))
            lengths.append(stage.length)
            cuts += mine
            cables.append(_cable(stage))
            continue
        kinds.append(ROD if isinstance(stage, Rod) else CLAMP)
        firsts.append(len(loads))
        counts.append(len(_loads(stage)))
        lengths.append(stage.length if isinstance(stage, Rod) else 0.0)
        loads += [
            _load(load, _place_afloat(line, load, afloat) if n == 0 else 0.0)
            for load in _loads(stage)
        ]
    return (
        np.array(kinds, np.int64),
        np.array(firsts, np.int64),
        np.array(counts, np.int64),
        np.array(lengths, np.float64),
        np.array(cables, np.float64).reshape(-1, 6),
        np.array(cuts, np.float64),
        np.array(loads, np.float64),
        water.gravity,
        (NEAR_ON_SEABED if lands else NEAR) * water.depth,
        track.landing,
    )


def _cable(cable: Cable) -> tuple[float, ...]:
    """A row of cables, in the order of the kernel's columns."""
    return (
        cable.buoyancy,
        cable.volume,
        cable.normal_drag,
        cable.tangential_drag,
        cable.compliance,
        2.0 * cable.thinning,
    )


def _load(load: Load, place: float) -> tuple[float, ...]:
    """A row of loads, in the order of the kernel's columns."""
    return (
        load.at,
        load.lever,
        load.buoyancy,
        load.volume,
        load.normal_drag,
        load.tangential_drag,
        load.lift,
        float(load.directional),
        place,
    )


def _place_afloat(line: Line, load: Load, afloat: int) -> float:
    """Whether a load is the float at the surface, or stands out of the water above it."""
    if load.piece == afloat and load.clamp < 0:
        return ITSELF
    return ABOVE_IT if load.piece < afloat and line.floating is not None else 0.0


def _parts(line: Line, track: Track, loads: list[Load]) -> tuple[Any, ...]:
    """Piece of every stage and load; clamp of every load, down the line; lengths; head."""
    clamped = np.array([load.clamp >= 0 for load in loads], np.bool_)
    first = [stage.pieces[0] if isinstance(stage, Rod) else stage.piece for stage in track.stages]
    return (
        np.array(first, np.int64),
        np.array([load.piece for load in loads], np.int64),
        np.where(clamped, np.cumsum(clamped) - 1, -1),
        line.length.copy(),
        head_count(line),
    )


def _riding(head: Rod, afloat: int, floating: Floating | None) -> tuple[Any, ...]:
    """How the float rides, by 1 - √(1 - share in use); and the lengths that stand out with it.

    The columns are `standing`, `above`, `drag` and the push of the wind, as in `Riding`.
    """
    if floating is None:
        return np.tile([0.0, 0.0, 1.0, 0.0, 0.0], (2, 1)), (0.0, 0.0)
    *above, own = head.lengths[: head.pieces.index(afloat) + 1]
    rides = [floating.riding(1.0 - (1.0 - at) ** 2) for at in np.linspace(0.0, 1.0, SHARES_KNOWN)]
    table = np.array([(r.standing, r.above, r.drag, *r.push) for r in rides])
    return table, (sum(above, 0.0), own)


def _falls(closing: Closing, unknown: Unknown, top: float) -> Floats:
    """How deep even currents of growing speed push the line [m], and the step of the speed [m/s].

    Where one pushes it beyond all bounds, as deep as the water.
    """
    water = closing.water
    falls = []
    speeds, step = np.linspace(0.0, FASTEST, SPEEDS, retstep=True)
    for speed in speeds:
        zero = np.zeros_like(water.u)
        even = Profile(replace(water, u=zero + speed, v=zero, w=zero))
        try:
            height = closing.run(unknown, top, closing.coarse_step, profile=even).z
        except MarchError:
            height = 0.0
        falls.append(max(height - unknown.goal, closing.allowed))
    return np.array([*falls, step])
