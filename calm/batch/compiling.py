"""Compilation of the batch solver before the first profile, with a message for the user."""

from collections.abc import Callable
from time import perf_counter
from typing import Any

import numpy as np
from numba.core import event

from calm.batch.profiles import Batch
from calm.physics.compiled import cache_folder


class _Notice(event.Listener):
    """Listener that reports when numba compiles a function because it is not in the cache."""

    def __init__(self, report: Callable[[str], None]) -> None:
        self.report = report
        self.reported = False

    def on_start(self, event: Any) -> None:
        if self.reported:
            return
        self.reported = True
        self.report("compiling the solver for this machine, once only; this takes up to a minute")
        if cache_folder() is None:
            self.report(
                "no writable cache folder was found, so every run compiles again; set "
                "NUMBA_CACHE_DIR to a writable folder"
            )

    def on_end(self, event: Any) -> None:
        pass


def compile_solver(batch: Batch, report: Callable[[str], None]) -> None:
    """Compile the solver or load it from the cache; only a compilation is reported."""
    notice, started = _Notice(report), perf_counter()
    with event.install_listener("numba:compile", notice):
        batch.solve(np.zeros((0, 1)), np.zeros((0, 1)), np.zeros(1), workers=1)
    if notice.reported:
        report(f"compiled in {perf_counter() - started:.0f} s")
