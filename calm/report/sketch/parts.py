"""What is marked on a line, and how, in every sketch."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from calm.report.labels import named_parts
from calm.report.sketch.frame import Frame

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from calm.case import Result, TowResult
    from calm.report.labels import Named

    Floats = NDArray[np.float64]

LINE = "bold cyan"
STILL = "white"
OTHER = "magenta"
"""Of a line in another environment, or of another design, drawn beside."""
SURFACE, SEABED = "blue", "yellow"
LIMIT = "red"
SHIP = ("▲", "bold")

SIGNS = {
    "anchor": ("▼", "bold"),
    "float": ("●", "bold yellow"),
    "release": ("◆", "green"),
    "instrument": ("■", "red"),
}
"""Sign and style of each role, the first where it is and the others beside it."""

_HEADED = 9


def header_rows(height: int) -> int:
    """Rows above a picture for what it says in words; none where it is low."""
    return int(height >= _HEADED)


def mark_parts(
    frame: Frame, result: Result | TowResult, place: Callable[[Named], tuple[float, float]]
) -> None:
    """Mark floats, instruments, releases and the anchor, `place` giving both axes."""
    parts = named_parts(result)
    for role, (sign, style) in SIGNS.items():
        for part in parts:
            if part.role == role:
                frame.mark(*place(part), sign, style)
