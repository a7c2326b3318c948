"""The levels of a current profile, joined with those of the water and laid out for the march."""

from __future__ import annotations

from math import inf, isfinite
from typing import Any

from calm.physics.compiled import set_row
from calm.physics.line import Floats
from calm.physics.profile import Interval


def read_profile(depth: Floats, u: Floats, v: Floats, w: Floats, read: Floats) -> int:
    """The levels at or below the surface that have a value, sorted; how many, -1 if two are one."""
    count = 0
    for j in range(depth.size):
        if not (isfinite(u[j]) and isfinite(v[j]) and isfinite(w[j]) and depth[j] >= 0.0):
            continue
        if not isfinite(depth[j]):
            continue
        k = count
        while k > 0 and read[k - 1, 0] > depth[j]:
            for c in range(4):
                read[k, c] = read[k - 1, c]
            k -= 1
        read[k, 0], read[k, 1], read[k, 2], read[k, 3] = depth[j], u[j], v[j], w[j]
        count += 1
    for j in range(1, count):
        if read[j, 0] == read[j - 1, 0]:
            return -1
    return count


def between(table: Floats, count: int, k: int, depth: float, c: int) -> float:
    """Column of a table at a depth, of which the first level below it is the k-th."""
    if k == 0:
        return float(table[0, c])
    if k == count:
        return float(table[count - 1, c])
    share = (depth - table[k - 1, 0]) / (table[k, 0] - table[k - 1, 0])
    return float(table[k - 1, c] + share * (table[k, c] - table[k - 1, c]))


def lay_profile(
    read: Floats, count: int, fixed: Floats, levels: Any, intervals: Any, joined: Floats
) -> int:
    """Join a profile with the fixed levels, and lay out levels and intervals as in `Sea`.

    Parameters
    ----------
    read : depth, u, v, w of its levels
    fixed : (f, 4) depth, what is added to u and to v, density
    joined : filled with depth, u, v, w, density of the levels of both

    Returns
    -------
    How many levels both have.
    """
    total = i = j = 0
    given = fixed.shape[0]
    while i < count or j < given:
        of_profile = j == given or (i < count and read[i, 0] <= fixed[j, 0])
        depth = read[i, 0] if of_profile else fixed[j, 0]
        if i < count and read[i, 0] == depth:
            i += 1
        if j < given and fixed[j, 0] == depth:
            j += 1
        # at a level itself the upper of its intervals holds it to rounding
        k = i - 1 if i > 0 and read[i - 1, 0] == depth else i
        f = j - 1 if j > 0 and fixed[j - 1, 0] == depth else j
        joined[total, 0] = depth
        joined[total, 1] = value_at(read, count, k, depth, 1) + value_at(fixed, given, f, depth, 1)
        joined[total, 2] = value_at(read, count, k, depth, 2) + value_at(fixed, given, f, depth, 2)
        joined[total, 3] = value_at(read, count, k, depth, 3)
        joined[total, 4] = value_at(fixed, given, f, depth, 3)
        total += 1
    levels[0], levels[total + 1] = -inf, inf
    for k in range(total + 1):
        upper, lower = max(k - 1, 0), min(k, total - 1)
        depth = joined[upper, 0]
        thickness = joined[lower, 0] - depth if lower > upper else inf
        u, v, w, density = joined[upper, 1], joined[upper, 2], joined[upper, 3], joined[upper, 4]
        row = Interval(
            depth, u, (joined[lower, 1] - u) / thickness, v, (joined[lower, 2] - v) / thickness,
            w, (joined[lower, 3] - w) / thickness, density,
            (joined[lower, 4] - density) / thickness,
        )  # fmt: skip
        set_row(intervals, k, row)
        if k < total:
            levels[k + 1] = joined[k, 0]
    return total


def value_at(table: Floats, count: int, k: int, depth: float, c: int) -> float:
    """As `between`; at the k-th level itself, what stands there."""
    if k < count and table[k, 0] == depth:
        return float(table[k, c])
    return between(table, count, k, depth, c)
