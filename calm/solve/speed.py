"""At which of its two speeds the solver runs: interpreted as it stands, or compiled by numba.

Both are of one source and give the same digits. Compiled it is many times as fast, once it is
there: that costs as much as `WARM` moorings to fetch it, as `COLD` ones to compile it first. Who
solves says by `Settings.compiled` which it is to be. Where that is left open it is compiled once
that pays: for whoever has said by `expect_many` how many lines are to come, or has solved many, if
compiled code is kept.

`CALM_COMPILED=never` and `always` settle what is left open.
"""

from __future__ import annotations

import os
from importlib.util import find_spec

from calm.physics.compiled import is_kept
from calm.physics.line import Line
from calm.solve.solution import Settings

WARM, COLD = 60, 1200
"""Moorings to be solved for which it pays to fetch the compiled solver, and to compile it."""
AS_MANY = 8
"""Pieces and clamps of which a line's solve takes as long as one of an ordinary mooring."""


class _Count:
    """How many lines have been solved, or are expected, by this process; and what that says."""

    def __init__(self) -> None:
        self.solves = 0.0
        self.asked_at = 0.0
        self.pays = False


_count = _Count()


def expect_many(solves: float) -> None:
    """Notice that so many lines are going to be solved."""
    _add(solves)
    _count.pays = _count.pays or solves >= COLD


def runs_compiled(settings: Settings, line: Line | None = None) -> bool:
    """Return whether the solver is to be compiled for a line that is now solved."""
    if settings.compiled is not None:
        return settings.compiled
    if line is not None:
        _add(max((len(line.length) + len(line.clamp_piece)) / AS_MANY, 1.0))
    wish = os.environ.get("CALM_COMPILED")
    if wish == "never" or not (_count.pays or wish == "always"):
        return False
    return find_spec("numba") is not None


def _add(solves: float) -> None:
    _count.solves += solves
    if not _count.pays and _count.solves >= max(WARM, 2.0 * _count.asked_at):
        _count.asked_at = _count.solves
        _count.pays = is_kept()
