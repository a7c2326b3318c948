"""Compile a part of the solver into the cache: `python -m calm.solve.compile_ahead LINE`.

One small line is solved, which compiles the code for all lines, since every line is packed into
arrays of the same types. `two_speeds` runs this module in a child process.
"""

import sys

import numpy as np

from calm.physics.line import Line, Water
from calm.solve.free import solve_rise
from calm.solve.mooring import Nearby, solve_mooring
from calm.solve.solution import Settings
from calm.solve.tow import Towing, solve_tow
from calm.solve.two_speeds import CompiledPart

COMPILED = Settings(compiled=True)


def small_line(buoyancy: float) -> Line:
    """Return a test line: 50 m of cable below a float or weight with the given buoyancy [N]."""
    zero, none = np.zeros(2), np.zeros(0)
    return Line(
        length=np.array([0.0, 50.0]),
        flexible=np.array([False, True]),
        buoyancy=np.array([buoyancy, -1.0]),
        volume=zero,
        normal_drag=np.array([50.0, 5.0]),
        tangential_drag=np.array([0.0, 0.1]),
        directional=np.array([False, True]),
        compliance=zero,
        thinning=np.array([0.0, 0.5]),
        clamp_piece=np.zeros(0, np.int64),
        clamp_at=none,
        clamp_buoyancy=none,
        clamp_volume=none,
        clamp_drag=none,
    )


def compile_part(solver: CompiledPart) -> None:
    """Compile a part of the solver and store it in the cache."""
    speed, rest, density = np.array([0.2]), np.zeros(1), np.array([1025.0])
    water = Water(100.0, rest, speed, rest, rest, density)
    if solver is CompiledPart.LEGS:
        solve_tow(small_line(-500.0).reversed(), water, Towing(1.0, 0.0), COMPILED)
        return
    line = small_line(500.0)
    if solver is CompiledPart.LINE:
        solve_mooring(line, water, COMPILED)
        solve_rise(line, water, 10.0, COMPILED)
    else:
        near = Nearby(line, water, COMPILED)
        near.solved(line, water)


if __name__ == "__main__":
    compile_part(CompiledPart[sys.argv[1]])
