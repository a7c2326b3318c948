"""Which of its two speeds the march has: as it stands, or compiled by numba.

Both give the same digits. Compiled it is some thirty times as fast, once numba is there: that
costs `WARM` marches from the cache, and `COLD` where the laws have to be compiled first. So it is
compiled only for whoever has many lines to solve, and says so by `expect`.

`CALM_COMPILED=never` and `always` settle it whatever is expected.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from importlib.util import find_spec
from typing import Any

from calm.physics.compiled import compiled, is_kept

WARM, COLD = 60, 1200
"""Moorings to be solved for which it pays to fetch the compiled march, and to compile it."""

_fast = False


def expect(solves: float) -> None:
    """Many lines are about to be solved: from now on fast if that pays for so many of them."""
    if _fast:
        return
    wish = os.environ.get("CALM_COMPILED")
    if wish == "never" or find_spec("numba") is None:
        return
    if wish == "always" or solves >= COLD or (solves >= WARM and is_kept()):
        march_fast(True)


def march_fast(fast: bool) -> None:
    """March compiled, or as the laws stand, from now on."""
    global _fast
    _fast = fast


def is_fast() -> bool:
    """Whether the march is compiled now."""
    return _fast


def paced(law: Callable[..., Any]) -> Callable[..., Any]:
    """A law as it stands, or compiled."""
    return compiled(law) if _fast else law
