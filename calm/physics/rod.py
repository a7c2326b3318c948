"""Integration (march) along a rigid body in moment equilibrium.

The body is a piece with its clamps, or all rigid pieces at the head of the line.
"""

from collections.abc import Sequence
from math import inf

from calm.physics.line import (
    NO_BALANCE,
    Bed,
    Record,
    State,
    along_bed,
    off_bed,
    write_element,
    write_node,
)
from calm.physics.profile import Sea, interval_at
from calm.physics.rod_axis import force_at, rod_axis
from calm.physics.track import Load, Stage

_LEANINGS = 50


def pass_clamp(
    load: Load,
    sea: Sea,
    state: State,
    lands: bool,
    bed: Bed,
    record: Record,
    recording: bool,
    nodes: int,
) -> tuple[State, float, int]:
    """Integrate past an instrument clamped on a cable, with results as in `pass_rod`."""
    x, y, z, fx, fy, fz, tz, level = state
    qx, qy, qz = force_at(load, sea, -z, level, 0.0, 0.0, -1.0)
    sx, sy, sz, hanging = fx + qx, fy + qy, fz + qz, -1.0
    if lands and off_bed(bed, fx, fy, fz) > 0.0 >= off_bed(bed, sx, sy, sz):
        sx, sy, sz = along_bed(bed, sx, sy, sz)
        hanging = inf
    below: State = (x, y, z, sx, sy, sz, tz, level)
    if recording:
        write_element(record, nodes, load.piece, load.clamp, 0.0, 0.0)
        write_node(record, nodes, below)
    return below, hanging, nodes + 1


def pass_rod(
    rod: Stage,
    loads: Sequence[Load],
    sea: Sea,
    state: State,
    lands: bool,
    bed: Bed,
    near: float,
    record: Record,
    recording: bool,
    nodes: int,
) -> tuple[State, float, int]:
    """Integrate along a rod from its top to its bottom.

    Parameters
    ----------
    lands : whether the seabed supports the rod if the line cannot carry the rod
    near : as in `rod_axis`
    record, recording : output for nodes and elements, and whether to record them
    nodes : number of nodes so far

    Returns
    -------
    - the state; the vertical axis is `NO_BALANCE` if no axis is in balance;
    - -1 if the rod is off the seabed, inf if the rod stands there, 0 if the rod lies there;
    - the number of nodes.
    """
    x, y, z, fx, fy, fz, before, level = state
    tx, ty, tz = rod_axis(rod, loads, sea, state, near)
    if tz == NO_BALANCE:
        return (x, y, z, fx, fy, fz, tz, level), -1.0, nodes
    sx, sy, sz = fx, fy, fz
    for i in range(rod.first, rod.first + rod.size):
        qx, qy, qz = force_at(loads[i], sea, -z - loads[i].at * tz, level, tx, ty, tz)
        sx, sy, sz = sx + qx, sy + qy, sz + qz
    landed = lands and off_bed(bed, fx, fy, fz) > 0.0 >= off_bed(bed, sx, sy, sz)
    if landed and off_bed(bed, tx, ty, tz) >= 0.0:
        fx, fy, fz = along_bed(bed, fx, fy, fz)
        return (x, y, z, fx, fy, fz, before, level), 0.0, nodes
    if recording:
        nodes = _record(rod, loads, sea, state, tx, ty, tz, record, nodes)
    length = rod.length
    if landed:
        sx, sy, sz = along_bed(bed, sx, sy, sz)
        if recording:
            record[3][nodes - 1], record[4][nodes - 1], record[5][nodes - 1] = sx, sy, sz
    below = (x + length * tx, y + length * ty, z + length * tz, sx, sy, sz, tz, level)
    return below, inf if landed else -1.0, nodes


def floating_depth(rod: Stage, loads: Sequence[Load], sea: Sea, out: float, near: float) -> float:
    """Return the depth [m] of the free end of a line if the topmost rod is partly out of the water.

    The depth is negative. `out` is the length of the emerged part of the rod [m]. The rod is
    assumed upright if no axis is in moment balance.
    """
    depth = -out
    for _ in range(_LEANINGS):
        level = interval_at(sea.levels, depth, 0)
        state = (0.0, 0.0, -depth, 0.0, 0.0, 0.0, -1.0, level)
        _, _, tz = rod_axis(rod, loads, sea, state, near)
        following = min(out * max(tz, -1.0), 0.0)
        if abs(following - depth) <= max(1e-14 * out, near):
            break
        depth = following
    return depth


def _record(
    rod: Stage,
    loads: Sequence[Load],
    sea: Sea,
    state: State,
    tx: float,
    ty: float,
    tz: float,
    record: Record,
    nodes: int,
) -> int:
    """Record a rod piece by piece.

    The load of a piece is distributed along the piece, and the load of a clamp acts at a point.
    """
    x, y, top, fx, fy, fz, _, level = state
    z = top
    end, reached = 0.0, 0.0
    ox = oy = oz = 0.0
    last = rod.first + rod.size - 1
    length, piece = 0.0, 0
    for i in range(rod.first, rod.first + rod.size):
        load = loads[i]
        qx, qy, qz = force_at(load, sea, -top - load.at * tz, level, tx, ty, tz)
        if load.clamp < 0:
            ox, oy, oz, length, piece = qx, qy, qz, load.length, load.piece
            end = reached + length
        else:
            step = load.at - reached
            share = step / length if length > 0.0 else 0.0
            x, y, z = x + step * tx, y + step * ty, z + step * tz
            fx, fy, fz = fx + share * ox, fy + share * oy, fz + share * oz
            write_element(record, nodes, piece, -1, step, 0.0)
            write_node(record, nodes, (x, y, z, fx, fy, fz, tz, level))
            fx, fy, fz = fx + qx, fy + qy, fz + qz
            write_element(record, nodes + 1, piece, load.clamp, 0.0, 0.0)
            write_node(record, nodes + 1, (x, y, z, fx, fy, fz, tz, level))
            nodes += 2
            reached = load.at
        if i == last or loads[i + 1].clamp < 0:
            step = end - reached
            share = step / length if length > 0.0 else 1.0
            x, y, z = x + step * tx, y + step * ty, z + step * tz
            fx, fy, fz = fx + share * ox, fy + share * oy, fz + share * oz
            write_element(record, nodes, piece, -1, step, 0.0)
            write_node(record, nodes, (x, y, z, fx, fy, fz, tz, level))
            nodes += 1
            reached = end
    return nodes
