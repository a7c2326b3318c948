"""Error estimates from shapes on coarse and on halved segments, and Richardson extrapolation.

The march is of second order, so the error of the fine shape is one third of the change from the
coarse to the fine shape. Richardson extrapolation adds this third to the fine shape. The load must
have no jumps or kinks within a segment.
"""

from math import sqrt
from typing import NamedTuple

from calm.physics.compiled import within
from calm.physics.line import BETTER, HALVES, NO_SEGMENT, SEGMENT, Record


class Errors(NamedTuple):
    """Estimated errors of a shape.

    Attributes
    ----------
    depth : largest error of depths and offsets [m]
    tension, relative : largest error of tensions [N], and largest relative error [-]
    lift, pull : errors of the upward and horizontal force at the line's end [N]
    """

    depth: float
    tension: float
    relative: float
    lift: float
    pull: float


class Extent(NamedTuple):
    """Number of nodes and of suspended elements in a shape, and whether it has a touchdown."""

    nodes: int
    hanging: int
    landed: bool


UNKNOWN_ERRORS = Errors(0.0, 0.0, 0.0, 0.0, 0.0)


def tension_at(record: Record, node: int) -> float:
    """Return the tension at a node [N]."""
    fx, fy, fz = record[3][node], record[4][node], record[5][node]
    return sqrt(fx * fx + fy * fy + fz * fz)


def next_node(record: Record, node: int, last: int) -> int:
    """Return the next node, up to `last`, that is the end of a segment or of a rigid element.

    Nodes at which a level of the water profile splits a segment are skipped.
    """
    node += 1
    while node < last and record[SEGMENT][node] >= HALVES:
        node += 1
    return min(node, last)


def extrapolate(before: Record, coarse: Extent, after: Record, fine: Extent, near: float) -> Errors:
    """Extrapolate a shape to zero segment length, and return the estimated errors.

    Only nodes that occur in both shapes are compared.

    Parameters
    ----------
    before, coarse : record and extent of the shape on coarse segments
    after, fine : record and extent of the shape on halved segments
    near : as in `MarchSettings`. If `near` is not 0, the line belongs to a batch, and only piece
        ends and clamps are extrapolated
    """
    end = fine.nodes - 1
    greatest = 0.0
    for n in range(coarse.nodes):
        greatest = max(greatest, tension_at(before, n))
    floor = max(1e-3 * greatest, 1e-300)
    place = worst = relative = 0.0
    n = m = before_m = 0
    while True:
        hangs = n < coarse.hanging or not coarse.landed
        inside = 0 < m < end and within_piece(after, m)
        strayed, changed, tension = thirds_at(before, coarse.nodes - 1, n, after, end, m)
        if near == 0.0 or not inside:
            add_third(before, coarse.nodes - 1, n, after, end, m)
        if near == 0.0 or m > before_m + 2:
            fill_between(after, before_m, m)
        if hangs:
            place = max(place, strayed)
        if hangs or n != coarse.hanging:
            worst = max(worst, changed)
            relative = max(relative, changed / max(tension, floor))
        if n == coarse.nodes - 1:
            break
        before_m = m
        n, m = next_pair(before, coarse, n, after, fine, m)
    last = coarse.nodes - 1
    # divided by 2.5 instead of 3, to be cautious: these are two values, not the maximum of many
    east, north = before[3][last] - after[3][end], before[4][last] - after[4][end]
    return Errors(
        place, worst, relative, abs(before[5][last] - after[5][end]) / 2.5,
        sqrt(east * east + north * north) / 2.5,
    )  # fmt: skip


def next_pair(
    before: Record, coarse: Extent, n: int, after: Record, fine: Extent, m: int
) -> tuple[int, int]:
    """Return the next corresponding nodes, after node n of the coarse and m of the fine shape."""
    last, end = coarse.nodes - 1, fine.nodes - 1
    if not coarse.landed or not fine.landed:
        following = next_node(before, n, last)
        if following == last:
            return last, end
        return following, next_node(after, m, end)
    if n < coarse.hanging:
        following = next_node(before, n, coarse.hanging)
        there = next_node(after, m, fine.hanging)
        if following == coarse.hanging or there == fine.hanging:
            return coarse.hanging, fine.hanging
        return following, there
    if last - n != end - m:
        return last, end
    return n + 1, m + 1


def within_piece(record: Record, node: int) -> bool:
    """Return whether a node separates two segments of the same piece."""
    inside: bool = (
        record[SEGMENT][node] != NO_SEGMENT
        and record[SEGMENT][node + 1] != NO_SEGMENT
        and record[6][node] == record[6][node + 1]
    )
    return inside


@within
def thirds_at(
    before: Record, last: int, n: int, after: Record, end: int, m: int
) -> tuple[float, float, float]:
    """Compare a node of the coarse shape with the same node of the fine shape.

    Returns
    -------
    One third of the change in position relative to the line's end [m], one third of the change in
    tension [N], and the fine tension [N].
    """
    x = after[0][m] - after[0][end] - (before[0][n] - before[0][last])
    y = after[1][m] - after[1][end] - (before[1][n] - before[1][last])
    place = max(sqrt(x * x + y * y), abs(after[2][m] - before[2][n])) / 3.0
    tension = tension_at(after, m)
    return place, abs(tension_at(before, n) - tension) / 3.0, tension


def add_third(before: Record, last: int, n: int, after: Record, end: int, m: int) -> None:
    """Extrapolate the position and force of a node that occurs in both shapes.

    Positions are taken relative to the end of the line.
    """
    for column in range(6):
        third = (after[column][m] - before[column][n]) / 3.0
        if column < 2:
            third -= (after[column][end] - before[column][last]) / 3.0
        after[BETTER + column][m] = after[column][m] + third


def fill_between(record: Record, first: int, last: int) -> None:
    """Correct the positions and forces at the nodes between two extrapolated nodes.

    The correction is interpolated linearly along the line.
    """
    length = distance = 0.0
    for m in range(first + 1, last + 1):
        length += record[8][m]
    for m in range(first + 1, last):
        distance += record[8][m]
        share = distance / length if length > 0.0 else 0.0
        for column in range(6):
            above = record[BETTER + column][first] - record[column][first]
            below = record[BETTER + column][last] - record[column][last]
            record[BETTER + column][m] = record[column][m] + above + share * (below - above)


def take_as_marched(record: Record, nodes: int) -> None:
    """Copy the marched positions and forces unchanged to the columns of the extrapolated shape."""
    for column in range(6):
        for m in range(nodes):
            record[BETTER + column][m] = record[column][m]
