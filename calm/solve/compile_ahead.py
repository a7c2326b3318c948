"""Compile a part of the solver into the cache: `python -m calm.solve.compile_ahead LINE`.

A small line is solved, since every line is packed into arrays of the same types. `two_speeds` runs
this module in a child process.
"""

import sys

import numpy as np

from calm.physics.line import Line, Water
from calm.solve.free import solve_rise
from calm.solve.mooring import Nearby, solve_mooring
from calm.solve.solution import Settings
from calm.solve.tow import Towing, solve_tow
from calm.solve.two_speeds import Solver

COMPILED = Settings(compiled=True)
WATER = Water(100.0, [0.0], [0.2], [0.0], [0.0], [1025.0])


def small_line(buoyancy: float) -> Line:
    """A float or a weight of some net buoyancy [N] above 50 m of cable."""
    zero = np.zeros(2)
    none = np.zeros(0)
    return Line(
        length=[0.0, 50.0],
        flexible=[False, True],
        buoyancy=[buoyancy, -1.0],
        volume=zero,
        normal_drag=[50.0, 5.0],
        tangential_drag=[0.0, 0.1],
        directional=[False, True],
        compliance=zero,
        thinning=[0.0, 0.5],
        clamp_piece=none,
        clamp_at=none,
        clamp_buoyancy=none,
        clamp_volume=none,
        clamp_drag=none,
    )


def compile_part(solver: Solver) -> None:
    """Compile a part of the solver into the cache."""
    if solver is Solver.LEGS:
        solve_tow(small_line(-500.0).reversed(), WATER, Towing(1.0, 0.0), COMPILED)
        return
    line = small_line(500.0)
    if solver is Solver.LINE:
        solve_mooring(line, WATER, COMPILED)
        solve_rise(line, WATER, 10.0, COMPILED)
    else:
        near = Nearby(line, WATER, COMPILED)
        near.solved(line, WATER)


if __name__ == "__main__":
    compile_part(Solver[sys.argv[1]])
