"""What a solved case tells of its pieces and clamps."""

from __future__ import annotations

from math import atan2, hypot, pi, sqrt

import numpy as np

from calm.batch.compiled import compiled
from calm.batch.kernel import CABLE, LANES, ROD, STATE

DEPTH, EAST, NORTH, TENSION_TOP, TENSION_BOTTOM, TILT = range(6)
OF_PIECE = ("depth_top", "x_top", "y_top", "tension_top", "tension_bottom", "tilt")
OF_CLAMP = ("depth", "x", "y", "tension", "tilt")
OF_ENDS = ("top_depth", "anchor_vertical", "anchor_horizontal", "used_buoyancy", "error")


@compiled
def tilt_of(x, y, z):
    """Angle of a vector from the vertical [degrees]; 0 for none."""
    across = hypot(x, y)
    return atan2(across, z) * 180.0 / pi if across > 0.0 or z != 0.0 else 0.0


@compiled
def size_of(x, y, z):
    """Size of a vector."""
    return sqrt(x * x + y * y + z * z)


@compiled
def write_case(plan, parts, old, new, old_forces, new_forces, i, used, error, results, case):
    """Write a lane's case to its row: what its shapes on cuts and on halved cuts lead to."""
    kinds, firsts, counts, lengths = plan[0], plan[1], plan[2], plan[3]
    loads = plan[6]
    piece_of_stage, piece_of_load, clamp_of_load, piece_length, head = parts
    pieces, clamps, ends = results
    stages = kinds.size
    at = np.empty((stages + 1, 6))
    axis = np.empty((stages + 1, 3))
    force = np.empty((loads.shape[0], 3))
    bottom = np.empty((piece_length.size, 3))
    pull = np.empty((piece_length.size, 6))
    seen = np.zeros(piece_length.size, np.bool_)
    end = stages * STATE * LANES + i
    for n in range(stages + 1):
        base = n * STATE * LANES + i
        for c in range(6):
            here, before = new[base + c * LANES], old[base + c * LANES]
            if c < 2:
                here, before = here - new[end + c * LANES], before - old[end + c * LANES]
            at[n, c] = (4.0 * here - before) / 3.0
        for c in range(3):
            axis[n, c] = 2.0 * new[base + (6 + c) * LANES] - old[base + (6 + c) * LANES]
    for j in range(loads.shape[0]):
        for c in range(3):
            k = (3 * j + c) * LANES + i
            force[j, c] = (4.0 * new_forces[k] - old_forces[k]) / 3.0
    for n in range(stages):
        if kinds[n] == ROD:
            walk_rod(
                at[n], at[n + 1], lengths[n], firsts[n], counts[n], loads, force, piece_of_load,
                clamp_of_load, piece_length, pieces[case], clamps[case], bottom, pull,
            )  # fmt: skip
            continue
        p = piece_of_stage[n]
        if not seen[p]:
            seen[p] = True
            write_top(pieces[case], p, at[n, 0], at[n, 1], at[n, 2], at[n, 3], at[n, 4], at[n, 5], pull)
        write_bottom(
            pieces[case], p, at[n + 1, 0], at[n + 1, 1], at[n + 1, 2],
            at[n + 1, 3], at[n + 1, 4], at[n + 1, 5], bottom, pull,
        )  # fmt: skip
        if kinds[n] != CABLE:
            write_clamp(
                clamps[case], clamp_of_load[firsts[n]], at[n, 0], at[n, 1], at[n, 2],
                max(size_of(at[n, 3], at[n, 4], at[n, 5]),
                    size_of(at[n + 1, 3], at[n + 1, 4], at[n + 1, 5])),
                tilt_of(axis[n, 0], axis[n, 1], -axis[n, 2]),
            )  # fmt: skip
    for p in range(piece_length.size):
        x = pieces[case, EAST, p] - bottom[p, 0]
        y = pieces[case, NORTH, p] - bottom[p, 1]
        z = -pieces[case, DEPTH, p] - bottom[p, 2]
        if piece_length[p] > 0.0:
            pieces[case, TILT, p] = tilt_of(x, y, z)
        else:
            pieces[case, TILT, p] = tilt_of(
                pull[p, 0] + pull[p, 3], pull[p, 1] + pull[p, 4], pull[p, 2] + pull[p, 5]
            )
    if lengths[0] > 0.0:
        lean = tilt_of(at[0, 0] - at[1, 0], at[0, 1] - at[1, 1], at[0, 2] - at[1, 2])
        for p in range(head):
            pieces[case, TILT, p] = lean
    ends[case, 0] = -at[0, 2]
    ends[case, 1] = at[stages, 5]
    ends[case, 2] = hypot(at[stages, 3], at[stages, 4])
    ends[case, 3] = used
    ends[case, 4] = error


@compiled
def write_top(pieces, p, x, y, z, fx, fy, fz, pull):
    """The upper end of a piece."""
    pieces[DEPTH, p], pieces[EAST, p], pieces[NORTH, p] = -z, x, y
    pieces[TENSION_TOP, p] = size_of(fx, fy, fz)
    pull[p, 0], pull[p, 1], pull[p, 2] = fx, fy, fz


@compiled
def write_bottom(pieces, p, x, y, z, fx, fy, fz, bottom, pull):
    """The lower end of a piece."""
    bottom[p, 0], bottom[p, 1], bottom[p, 2] = x, y, z
    pieces[TENSION_BOTTOM, p] = size_of(fx, fy, fz)
    pull[p, 3], pull[p, 4], pull[p, 5] = fx, fy, fz


@compiled
def write_clamp(clamps, m, x, y, z, tension, tilt):
    """A clamped instrument."""
    clamps[0, m], clamps[1, m], clamps[2, m] = -z, x, y
    clamps[3, m], clamps[4, m] = tension, tilt


@compiled
def walk_rod(
    upper, lower, length, first, count, loads, force, piece_of_load, clamp_of_load, piece_length,
    pieces, clamps, bottom, pull,
):  # fmt: skip
    """Down a rod piece by piece; a piece's own load counts as spread along it, a clamp's not."""
    x, y, z, fx, fy, fz = upper[0], upper[1], upper[2], upper[3], upper[4], upper[5]
    tx = ty = tz = 0.0
    if length > 0.0:
        tx, ty, tz = (lower[0] - x) / length, (lower[1] - y) / length, (lower[2] - z) / length
    start = 0.0
    j = first
    while j < first + count:
        p, own = piece_of_load[j], j
        write_top(pieces, p, x, y, z, fx, fy, fz, pull)
        reached = start
        j += 1
        while True:
            clamp = j < first + count and clamp_of_load[j] >= 0
            at = loads[j, 0] if clamp else start + piece_length[p]
            step = at - reached
            share = step / piece_length[p] if piece_length[p] > 0.0 else (0.0 if clamp else 1.0)
            x, y, z = x + step * tx, y + step * ty, z + step * tz
            fx += share * force[own, 0]
            fy += share * force[own, 1]
            fz += share * force[own, 2]
            if not clamp:
                break
            before = size_of(fx, fy, fz)
            fx, fy, fz = fx + force[j, 0], fy + force[j, 1], fz + force[j, 2]
            write_clamp(
                clamps, clamp_of_load[j], x, y, z,
                max(before, size_of(fx, fy, fz)), tilt_of(-tx, -ty, -tz),
            )  # fmt: skip
            reached = at
            j += 1
        start += piece_length[p]
        write_bottom(pieces, p, x, y, z, fx, fy, fz, bottom, pull)
