"""Compiling the kernel: once a machine, where its cache folder can be written."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from types import FunctionType
from typing import Any

import numba
import numpy as np

from calm.physics.compiled import cache_folder

FLAGS = {"contract", "nsz", "arcp"}
"""Liberties with arithmetic. Not with NaN, which tells a lane that has failed, nor with the order
of sums: it might be another in the first lanes than in the last, and their digits with it."""

OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "fastmath": FLAGS, "_nrt": False}
ALONE: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}


@cache
def called(function: Callable[..., Any]) -> Any:
    return numba.njit(_clone(function), **OPTIONS, **ALONE)


def _clone(function):
    names = {**function.__globals__}
    for name in function.__code__.co_names:
        value = names.get(name)
        if isinstance(value, FunctionType) and value.__module__.startswith("calm."):
            names[name] = called(value)
        elif isinstance(value, tuple) and value and all(type(x) is float for x in value):
            names[name] = np.array(value)
    clone = FunctionType(
        function.__code__, names, function.__name__, function.__defaults__, function.__closure__
    )
    clone.__module__, clone.__qualname__ = function.__module__, function.__qualname__
    return clone


@cache
def entry(function):
    return _kept(numba.njit, _clone(function), **OPTIONS)


def by_address(function, *arguments):
    return _by_address(function)(*arguments)


@cache
def _by_address(function):
    found = []

    def of(*arguments):
        if not found:
            signature = numba.void(*(numba.typeof(a) for a in arguments))
            options = {k: v for k, v in OPTIONS.items() if k != "nogil"}
            found.append(
                _kept(lambda f, **o: numba.cfunc(signature, **o)(f), _clone(function), **options)
            )
        return found[0]

    return of


def _kept(compiler, function, **options):
    folder = cache_folder()
    if folder is None:
        return compiler(function, **options)
    settings: Any = numba.config
    chosen = settings.CACHE_DIR
    settings.CACHE_DIR = str(folder)  # read as the function is decorated
    try:
        return compiler(function, cache=True, **options)
    finally:
        settings.CACHE_DIR = chosen
