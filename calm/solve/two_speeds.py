"""Choice between the interpreted solver and the solver compiled by LLVM.

Both give the same digits. Compiled code is loaded from the cache as soon as this saves time. If the
cache has none, a child process compiles the solver as soon as compilation pays. Meanwhile this
process continues with the interpreted solver, and switches when the child has finished.
`CALM_COMPILED=never` and `always`, and the attribute `compiled` of `Settings`, override this
choice. With `always`, this process compiles the solver itself.
"""

import os
import sys
from enum import Enum
from functools import cache
from importlib.util import find_spec
from multiprocessing import parent_process
from pathlib import Path
from subprocess import DEVNULL, Popen

from calm.physics.compiled import cache_folder, fault, is_cached
from calm.physics.line import Line
from calm.solve.solution import Settings

LOAD_FROM = 40
"""Number of lines above which it pays to load compiled code from the cache."""
COMPILE_FROM = 400
"""Number of lines, announced by `expect_many`, above which it pays to compile."""
UNANNOUNCED = 100
"""Number of unannounced lines above which many more are expected."""
TYPICAL_PARTS = 8
"""Number of pieces and clamps of an ordinary line. Computing time is in proportion to this number.
"""


class CompiledPart(Enum):
    """A part of the solver that is compiled separately.

    The value of a member is the name of the function of this part that is compiled last.
    """

    LINE = "run_search"
    NEARBY = "audited"
    LEGS = "do_task"


class _Pace:
    """Work done so far by one part of the solver, and whether it runs compiled.

    `announced` and `solved` are numbers of lines; `work` is the computing time, in typical lines.
    """

    def __init__(self, solver: CompiledPart) -> None:
        self.solver = solver
        self.announced = self.solved = self.work = self.checked_at = 0.0
        self.compiled = False
        self.child: Popen[bytes] | None = None

    def consider(self) -> None:
        """Switch to compiled code if it is ready, or start to compile it if that pays."""
        if self.compiled:
            return
        if self.child is not None:
            # a worker process cannot wait for the child of its parent, and `poll` returns 0 there
            of_worker = parent_process() is not None
            self.compiled = is_cached(self.solver.value) if of_worker else self.child.poll() == 0
            return
        work = max(self.announced, self.work)
        if work >= max(LOAD_FROM, 2.0 * self.checked_at):
            self.checked_at = work
            self.compiled = is_cached(self.solver.value)
        if self.compiled or parent_process() is not None:
            return
        if self.announced >= COMPILE_FROM or self.solved - self.announced >= UNANNOUNCED:
            self.child = _compile_ahead(self.solver)


_paces = {solver: _Pace(solver) for solver in CompiledPart}


def expect_many(lines: float, solver: CompiledPart = CompiledPart.LINE) -> None:
    """Announce a number of lines to be solved, so that compilation can start if it pays."""
    pace = _paces[solver]
    pace.announced = pace.solved + lines
    if _may_choose():
        pace.consider()


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
    """Count lines that are about to be solved, which may start compilation of the solver.

    Parameters
    ----------
    work : computing time for these lines, in units of the time for a typical line; by default the
        number of lines
    """
    pace = _paces[solver]
    pace.solved += lines
    pace.work += lines if work is None else work
    if _may_choose():
        pace.consider()


def may_compile() -> bool:
    """Return whether a function that belongs to no `CompiledPart` may be compiled on first use."""
    return os.environ.get("CALM_COMPILED") != "never" and _has_llvm() and fault() is None


def _may_choose() -> bool:
    return os.environ.get("CALM_COMPILED") not in ("never", "always") and _has_llvm()


@cache
def _has_llvm() -> bool:
    return find_spec("llvmlite") is not None


def _compile_ahead(solver: CompiledPart) -> "Popen[bytes] | None":
    """Start a child process that compiles a part of the solver into the cache.

    The child process may outlive this process, so the two share no stream.
    """
    if cache_folder() is None or fault() is not None or not sys.executable:
        return None
    package = str(Path(__file__).parents[2])
    path = os.pathsep.join(filter(None, [package, os.environ.get("PYTHONPATH")]))
    try:
        return Popen(
            [sys.executable, "-m", "calm.solve.compile_ahead", solver.name],
            stdin=DEVNULL,
            stdout=DEVNULL,
            stderr=DEVNULL,
            start_new_session=True,
            env={**os.environ, "CALM_COMPILED": "always", "PYTHONPATH": path},
        )
    except OSError:
        return None
