"""A few equations in as many unknowns: Newton's method with Broyden's updates, damped."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from calm.physics.line import Floats
from calm.physics.state import MarchError

_ROUNDS = 40
_HALVINGS = 6
_DIFFERENCE = 1e-5
"""Step of the differences that the derivatives are taken from, in units of the unknowns."""

System = Callable[[Floats], Floats]


def system_root(system: System, start: Floats, small: float) -> Floats | None:
    """Root of a system near a start; None where none is found.

    Parameters
    ----------
    system : from k unknowns to k values, both scaled so that 1 is much; it may raise `MarchError`
    small : stop when no value is greater than this

    The derivatives are taken by differences once, then kept up by Broyden's rule, and taken anew
    where the values do not fall to half. A step is halved until they fall.

    Source: C. G. Broyden (1965), Mathematics of Computation 19, 577-593.
    """
    x = start
    value = _tried(system, x)
    if value is None:
        return None
    slopes, fresh = _slopes(system, x, value), True
    for _ in range(_ROUNDS):
        if np.abs(value).max() <= small:
            return x
        found = None if slopes is None else _step(system, x, value, slopes)
        if found is None:
            if fresh:
                return None
            slopes, fresh = _slopes(system, x, value), True
            continue
        following, values = found
        halved = np.linalg.norm(values) <= 0.5 * np.linalg.norm(value)
        assert slopes is not None
        step = following - x
        missed = values - value - slopes @ step
        slopes = slopes + np.outer(missed, step) / (step @ step)
        x, value, fresh = following, values, False
        if not halved:
            slopes, fresh = _slopes(system, x, value), True
    return None


def _step(system: System, x: Floats, value: Floats, slopes: Floats) -> tuple[Floats, Floats] | None:
    """The next place, where the values are less, and these; None where there is none."""
    try:
        step = -np.linalg.solve(slopes, value)
    except np.linalg.LinAlgError:
        return None
    for _ in range(_HALVINGS):
        values = _tried(system, x + step)
        if values is not None and np.linalg.norm(values) < np.linalg.norm(value):
            return x + step, values
        step = 0.5 * step
    return None


def _slopes(system: System, x: Floats, value: Floats) -> Floats | None:
    columns = []
    for direction in np.eye(len(x)) * _DIFFERENCE:
        values = _tried(system, x + direction)
        if values is None:
            return None
        columns.append((values - value) / _DIFFERENCE)
    return np.column_stack(columns)


def _tried(system: System, x: Floats) -> Floats | None:
    try:
        return system(x)
    except MarchError:
        return None
