"""What there is to know beforehand of a line that may lie on the seabed."""

from __future__ import annotations

import numpy as np

from calm.case import Mooring
from calm.physics.line import Floats, Line, Water
from calm.physics.reference import REFERENCE_DENSITY
from calm.physics.track import Cable, Rod, Track, loads_of
from calm.solve.standing import standing_lift

NEVER, IF_REFUSED, LIKELY = range(3)
"""When a line is looked for on the seabed: never; where it cannot hang clear of it; where it would
not carry its lower end."""


def when_looked_for(line: Line, water: Water, track: Track) -> int:
    """When the line is looked for on the seabed, as `calm.solve.mooring` has it."""
    lift = standing_lift(line, water)
    if track.landing == len(track.stages) or not (np.cumsum(lift) > 0.0).any():
        return NEVER
    longer, heavy = line.length.sum() > water.depth, lift.sum() <= 0.0
    return LIKELY if longer or heavy else IF_REFUSED


def first_chain_of(mooring: Mooring, track: Track) -> int:
    """The stage from which on there is nothing but chain."""
    kinds = [piece.component.kind for piece in mooring.file.pieces]
    others = [
        n
        for n, stage in enumerate(track.stages)
        if kinds[stage.pieces[0] if isinstance(stage, Rod) else stage.piece] != "chain"
    ]
    return max(others, default=-1) + 1


def grips_on(track: Track, water: Water, friction: float) -> tuple[Floats, Floats]:
    """Friction on the seabed [N].

    (stages, 2) of a metre of cable, and of a whole rod or clamp; (loads,) of every load.
    """
    _, density = water.at(np.array([water.depth]))
    excess = (float(density[0]) - REFERENCE_DENSITY) * water.gravity
    grips = np.zeros((len(track.stages), 2))
    holds: list[float] = []
    for n, stage in enumerate(track.stages):
        mine = [-friction * (part.buoyancy + excess * part.volume) for part in loads_of(stage)]
        grips[n, 0 if isinstance(stage, Cable) else 1] = sum(mine)
        holds += [] if isinstance(stage, Cable) else mine
    return grips, np.array(holds)
