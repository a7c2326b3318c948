"""The referee's stretch: strain against tension, linear or by a table.

A table is joined by monotone cubics (Fritsch & Butland, as scipy has them) and goes on straight
beyond its last point.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.interpolate import PchipInterpolator

from calm.physics.line import Line


def strain_law(line: Line, piece: int) -> Callable[[float], float]:
    """Strain of a piece by its tension [N]."""
    table = line.elongation[piece] if line.elongation else None
    if table is None:
        compliance = float(line.compliance[piece])
        return lambda tension: compliance * tension
    tensions, strains = np.array(table.tensions), np.array(table.strains)
    inside = PchipInterpolator(tensions, strains)
    chord = (strains[-1] - strains[-2]) / (tensions[-1] - tensions[-2])
    permanent = table.permanent

    def law(tension: float) -> float:
        beyond = max(tension - tensions[-1], 0.0)
        return float(permanent + inside(tension - beyond) + chord * beyond)

    return law
