"""What a solved case tells of its pieces and clamps."""

from __future__ import annotations

from math import atan2, pi, sqrt

from calm.batch.compiled import compiled
from calm.batch.kernel import AT, CLAMP, LANES, ROD, STATE, TX as FX_END

DEPTH, EAST, NORTH, TENSION_TOP, TENSION_BOTTOM, TILT = range(6)
OF_PIECE = ("depth_top", "x_top", "y_top", "tension_top", "tension_bottom", "tilt")
OF_CLAMP = ("depth", "x", "y", "tension", "tilt")
OF_ENDS = ("top_depth", "anchor_vertical", "anchor_horizontal", "used_buoyancy", "error")


@compiled
def tilt_of(x, y, z):
    """Angle of a vector from the vertical [degrees]; 0 for none."""
    return atan2(sqrt(x * x + y * y), z) * 180.0 / pi


@compiled
def size_of(x, y, z):
    """Size of a vector."""
    return sqrt(x * x + y * y + z * z)


@compiled
def blend(plan, old, new, old_forces, new_forces, joints, axes, forces):
    """What the shapes on cuts and on halved cuts lead to, in all lanes.

    Places and forces are of second order in the cuts, the axis of what ends at a joint of first.
    """
    kinds, loads = plan[0], plan[6]
    end = kinds.size * STATE * LANES
    for n in range(kinds.size + 1):
        base = n * STATE * LANES
        to = 6 * n * LANES
        for c in (0, LANES):
            for i in range(LANES):
                here = new[base + c + i] - new[end + c + i]
                before = old[base + c + i] - old[end + c + i]
                joints[to + c + i] = here + (here - before) / 3.0
        for k in range(2 * LANES, 6 * LANES):
            joints[to + k] = new[base + k] + (new[base + k] - old[base + k]) / 3.0
        for k in range(3 * LANES):
            axes[3 * n * LANES + k] = 2.0 * new[base + FX_END + k] - old[base + FX_END + k]
    for k in range(3 * loads.shape[0] * LANES):
        forces[k] = new_forces[k] + (new_forces[k] - old_forces[k]) / 3.0


@compiled
def write_case(plan, parts, joints, axes, forces, i, used, error, results, case, scratch):
    """Write a lane's case to its row."""
    kinds, firsts, counts, lengths = plan[0], plan[1], plan[2], plan[3]
    piece_of_stage, piece_of_load, clamp_of_load, piece_length, head = parts
    pieces, clamps, ends = results
    stages = kinds.size
    written = -1
    for n in range(stages):
        a, b = 6 * n * LANES + i, 6 * (n + 1) * LANES + i
        if kinds[n] == ROD and counts[n] > 1:
            written = walk_rod(plan, parts, joints, forces, i, n, pieces, clamps, case, scratch)
            continue
        p = piece_of_stage[n]
        fx, fy, fz = joints[a + 3 * LANES], joints[a + 4 * LANES], joints[a + 5 * LANES]
        gx, gy, gz = joints[b + 3 * LANES], joints[b + 4 * LANES], joints[b + 5 * LANES]
        upper, lower = size_of(fx, fy, fz), size_of(gx, gy, gz)
        if p > written:
            written = p
            scratch[0], scratch[1], scratch[2] = fx, fy, fz
            pieces[case, EAST, p], pieces[case, NORTH, p] = joints[a], joints[a + LANES]
            pieces[case, DEPTH, p] = -joints[a + 2 * LANES]
            pieces[case, TENSION_TOP, p] = upper
        pieces[case, TENSION_BOTTOM, p] = lower
        if kinds[n] == CLAMP:
            m = clamp_of_load[firsts[n]]
            clamps[case, 0, m] = -joints[a + 2 * LANES]
            clamps[case, 1, m], clamps[case, 2, m] = joints[a], joints[a + LANES]
            clamps[case, 3, m] = max(upper, lower)
            k = 3 * n * LANES + i
            clamps[case, 4, m] = tilt_of(axes[k], axes[k + LANES], -axes[k + 2 * LANES])
        if n + 1 == stages or piece_of_stage[n + 1] != p:
            if piece_length[p] > 0.0:
                pieces[case, TILT, p] = tilt_of(
                    pieces[case, EAST, p] - joints[b],
                    pieces[case, NORTH, p] - joints[b + LANES],
                    -pieces[case, DEPTH, p] - joints[b + 2 * LANES],
                )
            else:
                pieces[case, TILT, p] = tilt_of(scratch[0] + gx, scratch[1] + gy, scratch[2] + gz)
    a, b = i, 6 * LANES + i
    if lengths[0] > 0.0:
        lean = tilt_of(
            joints[a] - joints[b],
            joints[a + LANES] - joints[b + LANES],
            joints[a + 2 * LANES] - joints[b + 2 * LANES],
        )
        for p in range(head):
            pieces[case, TILT, p] = lean
    b = 6 * stages * LANES + i
    fx, fy = joints[b + 3 * LANES], joints[b + 4 * LANES]
    ends[case, 0] = -joints[i + 2 * LANES]
    ends[case, 1] = joints[b + 5 * LANES]
    ends[case, 2] = sqrt(fx * fx + fy * fy)
    ends[case, 3] = used
    ends[case, 4] = error


@compiled
def walk_rod(plan, parts, joints, forces, i, n, pieces, clamps, case, scratch):
    """Down a rod of several pieces or with clamps; returns its last piece.

    A piece's own load counts as spread along it, a clamp's not.
    """
    first, count, length, loads = plan[1][n], plan[2][n], plan[3][n], plan[6]
    _, piece_of_load, clamp_of_load, piece_length, _ = parts
    a, b = 6 * n * LANES + i, 6 * (n + 1) * LANES + i
    x, y, z = joints[a], joints[a + LANES], joints[a + 2 * LANES]
    fx, fy, fz = joints[a + 3 * LANES], joints[a + 4 * LANES], joints[a + 5 * LANES]
    tx = ty = tz = 0.0
    if length > 0.0:
        tx = (joints[b] - x) / length
        ty = (joints[b + LANES] - y) / length
        tz = (joints[b + 2 * LANES] - z) / length
    lean = tilt_of(-tx, -ty, -tz)
    start = 0.0
    p = 0
    j = first
    while j < first + count:
        p, own = piece_of_load[j], 3 * j * LANES + i
        pieces[case, DEPTH, p], pieces[case, EAST, p], pieces[case, NORTH, p] = -z, x, y
        pieces[case, TENSION_TOP, p] = size_of(fx, fy, fz)
        gx, gy, gz = fx, fy, fz
        reached = start
        j += 1
        while True:
            clamp = j < first + count and clamp_of_load[j] >= 0
            at = loads[j, AT] if clamp else start + piece_length[p]
            step = at - reached
            share = step / piece_length[p] if piece_length[p] > 0.0 else (0.0 if clamp else 1.0)
            x, y, z = x + step * tx, y + step * ty, z + step * tz
            fx += share * forces[own]
            fy += share * forces[own + LANES]
            fz += share * forces[own + 2 * LANES]
            if not clamp:
                break
            before = size_of(fx, fy, fz)
            k, m = 3 * j * LANES + i, clamp_of_load[j]
            fx, fy, fz = fx + forces[k], fy + forces[k + LANES], fz + forces[k + 2 * LANES]
            clamps[case, 0, m], clamps[case, 1, m], clamps[case, 2, m] = -z, x, y
            clamps[case, 3, m] = max(before, size_of(fx, fy, fz))
            clamps[case, 4, m] = lean
            reached = at
            j += 1
        start += piece_length[p]
        pieces[case, TENSION_BOTTOM, p] = size_of(fx, fy, fz)
        pieces[case, TILT, p] = lean
        if piece_length[p] == 0.0:
            pieces[case, TILT, p] = tilt_of(gx + fx, gy + fy, gz + fz)
    return p
