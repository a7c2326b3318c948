"""Loading of the compiled solver before a process is forked."""

import numpy as np

from calm.physics.line import Line, Water
from calm.solve.free import solve_rise
from calm.solve.mooring import solve_mooring
from calm.solve.solution import Settings
from calm.solve.two_speeds import runs_compiled


def load_line_solver() -> None:
    """Load the compiled solver for moored lines if it pays, and compile it first if necessary.

    Processes forked afterwards share the code.
    """
    settings = Settings()
    if not runs_compiled(settings):
        return
    # a small line loads the code for all lines, which are packed into arrays of the same types
    zero, none, speed = np.zeros(2), np.zeros(0), np.array([0.2])
    line = Line(
        length=np.array([0.0, 50.0]),
        flexible=np.array([False, True]),
        buoyancy=np.array([500.0, -1.0]),
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
    water = Water(100.0, zero[:1], speed, zero[:1], zero[:1], np.array([1025.0]))
    solve_mooring(line, water, settings)
    solve_rise(line, water, 10.0, settings)
