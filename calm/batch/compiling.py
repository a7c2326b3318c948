"""Compilation of the batch solver before the first profile, with a message for the user."""

from collections.abc import Callable
from time import perf_counter

import numpy as np

from calm.batch.profiles import Batch
from calm.physics.compiled import cache_folder, on_compilation


def compile_solver(batch: Batch, report: Callable[[str], None]) -> None:
    """Load the compiled solver from the cache, or compile it and report this to the user."""
    started, reported = perf_counter(), False

    def announce() -> None:
        nonlocal reported
        if reported:
            return
        reported = True
        report(
            "compiling the solver for this machine; this is done only once and takes a few seconds"
        )
        if cache_folder() is None:
            report(
                "no writable cache folder was found, so every run compiles again; set "
                "CALM_CACHE_DIR to a writable folder"
            )

    on_compilation.append(announce)
    try:
        batch.solve(np.zeros((0, 1)), np.zeros((0, 1)), np.zeros(1), workers=1)
    finally:
        on_compilation.remove(announce)
    if reported:
        report(f"compiled in {perf_counter() - started:.0f} s")
