"""Compiling the kernel: once a machine, where its cache folder can be written."""

from __future__ import annotations

import hashlib
import os
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import numba

from calm.physics import element

Function = TypeVar("Function", bound=Callable[..., Any])

FLAGS = {"contract", "nsz", "arcp"}
"""Liberties with arithmetic. Not with NaN, which tells a lane that has failed, nor with the order
of sums: it might be another in the first lanes than in the last, and their digits with it."""


def compiled(function: Function) -> Function:
    """A function compiled into those that call it."""
    jitted: Function = numba.njit(function, nogil=True, error_model="numpy", fastmath=FLAGS)
    return jitted


def compilable(formula: Callable[..., Any]) -> None:
    """Let compiled functions call a formula of the plain march."""
    numba.extending.register_jitable(error_model="numpy", fastmath=FLAGS)(formula)


def entry(function: Callable[..., Any]) -> Any:
    """A function that is called from outside: compiled, and kept for the next process."""
    folder = cache_folder()
    options: dict[str, Any] = {"nogil": True, "error_model": "numpy", "fastmath": FLAGS}
    settings: Any = numba.config
    if folder is None:
        return numba.njit(function, **options)
    chosen = settings.CACHE_DIR
    settings.CACHE_DIR = str(folder)  # read as the function is decorated
    try:
        return numba.njit(function, cache=True, **options)
    finally:
        settings.CACHE_DIR = chosen


@cache
def cache_folder() -> Path | None:
    """Where compiled code is kept; None where no such folder can be written.

    `NUMBA_CACHE_DIR`, or else CALM's folder in the user's cache. What is compiled from other
    sources has another folder, as numba itself looks at one file alone.
    """
    given = os.environ.get("NUMBA_CACHE_DIR")
    folder = (Path(given) if given else _user_cache() / "calm") / f"kernel-{_fingerprint()}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError:
        return None


def _user_cache() -> Path:
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")


def _fingerprint() -> str:
    """Of everything that is compiled."""
    sources = [Path(element.__file__), *sorted(Path(__file__).parent.glob("*.py"))]
    digest = hashlib.sha256()
    for source in sources:
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]
