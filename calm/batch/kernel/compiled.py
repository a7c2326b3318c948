"""Compiling the kernel, and the laws into it: once a machine, where its cache can be written."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from typing import Any

import numba

from calm.physics import compiled

FLAGS = {"contract", "nsz", "arcp"}
"""Liberties with arithmetic. Not with NaN, which shows a lane that has failed, nor with the order
of sums: it might be another in the first lanes than in the last, and their digits with it."""

OPTIONS: dict[str, Any] = {"error_model": "numpy", "fastmath": FLAGS, "_nrt": False}
"""Nothing is allocated by the kernel, so that arrays need not be counted when they are passed on:
that takes as long as a segment."""

Function = Callable[..., Any]


@cache
def called(function: Function, singly: bool) -> Any:
    """A function compiled into those that call it."""
    njit: Any = numba.njit
    return njit(
        _clone(function, singly),
        nogil=True,
        no_cpython_wrapper=True,
        no_cfunc_wrapper=True,
        **OPTIONS,
    )


@cache
def entry(function: Function) -> Any:
    """A function that is called from outside: compiled, and kept for the next process."""
    options = {"nogil": True, **OPTIONS}
    return compiled.kept(numba.njit, _clone(function, False), cache_folder(), **options)


def by_address(function: Function, *arguments: Any, singly: bool = False) -> Any:
    """A function for arguments of some types, compiled by itself and called by its address.

    Those that call it are not compiled anew with it, which would take as long for each. `singly`:
    with the laws that each lane takes by itself.
    """
    typeof: Any = numba.typeof
    types = tuple(typeof(argument) for argument in arguments)
    return _by_address(function, numba.void(*types), singly)


@cache
def _by_address(function: Function, signature: Any, singly: bool) -> Any:
    def compiler(clone: Function, **options: Any) -> Any:
        return numba.cfunc(signature, **options)(clone)

    return compiled.kept(compiler, _clone(function, singly), cache_folder(), **OPTIONS)


def _clone(function: Function, singly: bool) -> Function:
    """The function with what it calls, and without what a mooring has no use for.

    With the laws that each lane takes by itself it has another name. Kept code is linked by name:
    of two functions of one name, kept by two processes, a third would use the first for both.
    """
    clone = compiled.clone(function, partial(called, singly=singly))
    if "SINGLY" in clone.__globals__:
        clone.__globals__["SINGLY"] = singly
    if singly:
        clone.__qualname__ += "_singly"
    return clone


def cache_folder() -> Path | None:
    """Where the compiled kernel is kept: see `calm.physics.compiled`."""
    return compiled.cache_folder("kernel", Path(__file__).parent)
