"""Notice that many lines are going to be solved."""

from __future__ import annotations

import numpy as np

from calm.physics import pace
from calm.physics.line import REFERENCE_DENSITY, Water
from calm.physics.march import march
from calm.physics.profile import Profile
from calm.physics.track import Load, Track


def expect_many(solves: float) -> None:
    """Let so many solves be fast, if that pays: see `calm.physics.pace`.

    The march is then compiled here, or fetched, before other processes begin.
    """
    pace.expect(solves)
    if pace.is_fast():
        still, top = np.zeros(1), np.zeros(1)
        water = Water(1.0, top, still, still, still, np.array([REFERENCE_DENSITY]))
        nothing = Load(*[0] * len(Load._fields))
        march(Track((nothing,)), Profile(water), 0.5, angle_step=1.0, reach=1.0)
