"""Choice between the interpreted solver and the solver compiled by LLVM.

Both solvers give the same digits. The compiled solver is used, and compiled first if needed, as
soon as this saves time. `CALM_COMPILED=never` and `always`, and the attribute `compiled` of
`Settings`, override this choice.
"""

import os
from enum import Enum
from functools import cache
from importlib.util import find_spec

from calm.physics.compiled import fault, is_cached
from calm.physics.line import Line
from calm.solve.solution import Settings

LOAD_FROM = 40
"""Number of lines above which it pays to load compiled code from the cache."""
COMPILE_FROM = 250
"""Number of lines, announced by `expect_many`, above which it pays to compile."""
UNANNOUNCED = 100
"""Number of unannounced lines above which many more are expected."""
TYPICAL_PARTS = 8
"""Number of pieces and clamps of an ordinary line. Computing time is in proportion to this number.
"""


class CompiledPart(Enum):
    """A part of the solver that is compiled separately.

    The value of a member is the name of a function. This function is compiled last, so the part is
    complete if the cache contains it.
    """

    LINE = "run_search"
    NEARBY = "audited"
    LEGS = "do_task"


class _Pace:
    """Work done so far by one part of the solver, and whether it runs compiled.

    `announced` and `solved` are numbers of lines. `work` is the computing time, divided by the time
    for a typical line.
    """

    def __init__(self, solver: CompiledPart) -> None:
        self.solver = solver
        self.announced = self.solved = self.work = self.checked_at = 0.0
        self.compiled = False

    def switch_if_worthwhile(self) -> None:
        if self.compiled:
            return
        work = max(self.announced, self.work)
        if self.announced >= COMPILE_FROM or self.solved - self.announced >= UNANNOUNCED:
            self.compiled = fault() is None
        elif work >= max(LOAD_FROM, 2.0 * self.checked_at):
            self.checked_at = work
            self.compiled = is_cached(self.solver.value)


_paces = {solver: _Pace(solver) for solver in CompiledPart}


def expect_many(lines: float, solver: CompiledPart = CompiledPart.LINE) -> None:
    """Announce a number of lines to be solved, so that they are solved compiled if this pays."""
    pace = _paces[solver]
    pace.announced = pace.solved + lines
    if _may_choose():
        pace.switch_if_worthwhile()


def runs_compiled(
    settings: Settings, line: Line | None = None, solver: CompiledPart = CompiledPart.LINE
) -> bool:
    """Return whether to solve the next line with compiled code, and count this line."""
    if settings.compiled is not None:
        return settings.compiled
    if not _may_choose():
        return os.environ.get("CALM_COMPILED") == "always" and may_compile()
    if line is not None:
        pieces = len(line.length) + len(line.clamp_piece)
        count_lines(1.0, solver, max(pieces / TYPICAL_PARTS, 1.0))
    return _paces[solver].compiled


def count_lines(lines: float, solver: CompiledPart, work: float | None = None) -> None:
    """Count lines that are about to be solved, and switch to the compiled solver if this pays.

    Parameters
    ----------
    work : computing time in units of the time for a typical line; the default is the number of
        lines
    """
    pace = _paces[solver]
    pace.solved += lines
    pace.work += lines if work is None else work
    if _may_choose():
        pace.switch_if_worthwhile()


def may_compile() -> bool:
    """Return whether a function that belongs to no `CompiledPart` may be compiled on first use."""
    return os.environ.get("CALM_COMPILED") != "never" and _has_llvm() and fault() is None


def _may_choose() -> bool:
    return os.environ.get("CALM_COMPILED") not in ("never", "always") and _has_llvm()


@cache
def _has_llvm() -> bool:
    return find_spec("llvmlite") is not None
