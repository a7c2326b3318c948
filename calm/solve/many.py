"""Notice that many lines are going to be solved."""

from __future__ import annotations

from typing import Any

import numpy as np

from calm.physics import pace
from calm.physics.line import Line, Water
from calm.physics.reference import REFERENCE_DENSITY
from calm.solve.mooring import solve_mooring


def expect_many(solves: float) -> None:
    """Let so many solves be fast, if that pays: see `calm.physics.pace`.

    What a solve takes is then compiled here, or fetched, before other processes begin.
    """
    pace.expect(solves)
    if pace.is_fast():
        none: Any = np.zeros(1)
        one: Any = np.ones(1)
        clamps: Any = (np.zeros(0),) * 5
        float_alone = Line(one, none, one, none, none, none, none, none, none, *clamps)
        solve_mooring(float_alone, Water(2.0, none, none, none, none, REFERENCE_DENSITY * one))
