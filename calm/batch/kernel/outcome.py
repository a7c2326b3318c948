"""What a solved case tells of its pieces and clamps."""

from __future__ import annotations

from math import atan2, pi, sqrt

from calm.batch.kernel.lane import STATE
from calm.batch.kernel.layout import Results, Way
from calm.physics.line import Floats
from calm.physics.track import CABLE, CLAMP, ROD, Course

DEPTH, EAST, NORTH, TENSION_TOP, TENSION_BOTTOM, TILT = range(6)
OF_PIECE = ("depth_top", "x_top", "y_top", "tension_top", "tension_bottom", "tilt")
OF_CLAMP = ("depth", "x", "y", "tension", "tilt")
OF_ENDS = ("top_depth", "anchor_vertical", "anchor_horizontal", "used_buoyancy", "end_depth")


def tilt_of(x: float, y: float, z: float) -> float:
    """Angle of a vector from the vertical [degrees]; 0 for none."""
    return atan2(sqrt(x * x + y * y), z) * 180.0 / pi


def size_of(x: float, y: float, z: float) -> float:
    """Size of a vector."""
    return sqrt(x * x + y * y + z * z)


def blend(stages: int, old: Floats, new: Floats, blended: Floats) -> None:
    """What the shapes on cuts and on halved cuts lead to.

    Places and forces are of second order in the cuts, the axis of what ends at a joint of first.
    """
    end = stages * STATE
    for n in range(stages + 1):
        base = n * STATE
        for c in range(2):
            here, before = new[base + c] - new[end + c], old[base + c] - old[end + c]
            blended[base + c] = here + (here - before) / 3.0
        for c in range(2, 6):
            blended[base + c] = new[base + c] + (new[base + c] - old[base + c]) / 3.0
        for c in range(6, 9):
            blended[base + c] = 2.0 * new[base + c] - old[base + c]
    for k in range(end + STATE, new.size):
        blended[k] = new[k] + (new[k] - old[k]) / 3.0
    blended[end], blended[end + 1] = 0.0, 0.0


def greatest_change(old: Floats, new: Floats, stages: int, span: float) -> tuple[float, float]:
    """What halving the cuts changed: of places, by the span, and of tensions, by themselves."""
    end = stages * STATE
    place = tension = greatest = 0.0
    for n in range(stages + 1):
        at = n * STATE
        greatest = max(greatest, new[at + 3] ** 2 + new[at + 4] ** 2 + new[at + 5] ** 2)
    floor = max(1e-3 * sqrt(greatest), 1e-300)
    for n in range(stages + 1):
        at = n * STATE
        for c in range(2):
            place = max(place, abs(new[at + c] - new[end + c] - old[at + c] + old[end + c]))
        place = max(place, abs(new[at + 2] - old[at + 2]))
        pull = size_of(new[at + 3], new[at + 4], new[at + 5])
        before = size_of(old[at + 3], old[at + 4], old[at + 5])
        tension = max(tension, abs(pull - before) / max(pull, floor))
    return place / span, tension


def piece_of(course: Course, stage: int) -> int:
    """The piece that a stage is, or sits on; of several pieces the first."""
    here = course.stages[stage]
    if here.kind == CABLE:
        return int(course.cables[here.first].piece)
    return int(course.loads[here.first].piece)


def write_case(way: Way, shape: Floats, used: float, results: Results, case: int) -> None:
    """Write a case's shape to its row of the results."""
    course, piece_length = way.course, way.lengths
    pieces, clamps, ends = results
    stages = len(course.stages)
    written = -1
    ox = oy = oz = 0.0
    for n in range(stages):
        a, b = n * STATE, (n + 1) * STATE
        here = course.stages[n]
        if here.kind == ROD and here.size > 1:
            written = walk_rod(way, shape, n, results, case)
            continue
        p = piece_of(course, n)
        fx, fy, fz = shape[a + 3], shape[a + 4], shape[a + 5]
        gx, gy, gz = shape[b + 3], shape[b + 4], shape[b + 5]
        upper, lower = size_of(fx, fy, fz), size_of(gx, gy, gz)
        if p > written:
            written = p
            ox, oy, oz = fx, fy, fz
            pieces[case, DEPTH, p] = -shape[a + 2]
            pieces[case, EAST, p], pieces[case, NORTH, p] = shape[a], shape[a + 1]
            pieces[case, TENSION_TOP, p] = upper
        pieces[case, TENSION_BOTTOM, p] = lower
        if here.kind == CLAMP:
            m = way.clamp_row[here.first]
            clamps[case, 0, m] = -shape[a + 2]
            clamps[case, 1, m], clamps[case, 2, m] = shape[a], shape[a + 1]
            clamps[case, 3, m] = max(upper, lower)
            clamps[case, 4, m] = tilt_of(fx + gx, fy + gy, fz + gz)
        if n + 1 == stages or piece_of(course, n + 1) != p:
            if piece_length[p] > 0.0:
                pieces[case, TILT, p] = tilt_of(
                    pieces[case, EAST, p] - shape[b],
                    pieces[case, NORTH, p] - shape[b + 1],
                    -pieces[case, DEPTH, p] - shape[b + 2],
                )
            else:
                pieces[case, TILT, p] = tilt_of(ox + gx, oy + gy, oz + gz)
    if course.stages[0].length > 0.0:
        lean = tilt_of(
            shape[0] - shape[STATE], shape[1] - shape[STATE + 1], shape[2] - shape[STATE + 2]
        )
        for p in range(way.head):
            pieces[case, TILT, p] = lean
    b = stages * STATE
    ends[case, 0] = -shape[2]
    ends[case, 1] = shape[b + 5]
    ends[case, 2] = sqrt(shape[b + 3] ** 2 + shape[b + 4] ** 2)
    ends[case, 3] = used
    ends[case, 4] = -shape[b + 2]


def walk_rod(way: Way, shape: Floats, n: int, results: Results, case: int) -> int:
    """Down a rod of several pieces or with clamps; returns its last piece.

    A piece's own load counts as spread along it, a clamp's not.
    """
    course, piece_length = way.course, way.lengths
    pieces, clamps, _ = results
    rod, loads = course.stages[n], course.loads
    end, length = rod.first + rod.size, rod.length
    a, b = n * STATE, (n + 1) * STATE
    forces = (len(course.stages) + 1) * STATE
    x, y, z = shape[a], shape[a + 1], shape[a + 2]
    fx, fy, fz = shape[a + 3], shape[a + 4], shape[a + 5]
    tx = ty = tz = 0.0
    if length > 0.0:
        tx = (shape[b] - x) / length
        ty = (shape[b + 1] - y) / length
        tz = (shape[b + 2] - z) / length
    lean = tilt_of(-tx, -ty, -tz)
    start = 0.0
    p = 0
    j = rod.first
    while j < end:
        p, own = loads[j].piece, forces + 3 * j
        pieces[case, DEPTH, p], pieces[case, EAST, p], pieces[case, NORTH, p] = -z, x, y
        pieces[case, TENSION_TOP, p] = size_of(fx, fy, fz)
        gx, gy, gz = fx, fy, fz
        reached = start
        j += 1
        while True:
            clamp = j < end and loads[j].clamp >= 0
            at = loads[j].at if clamp else start + piece_length[p]
            step = at - reached
            share = step / piece_length[p] if piece_length[p] > 0.0 else (0.0 if clamp else 1.0)
            x, y, z = x + step * tx, y + step * ty, z + step * tz
            fx += share * shape[own]
            fy += share * shape[own + 1]
            fz += share * shape[own + 2]
            if not clamp:
                break
            before = size_of(fx, fy, fz)
            k, m = forces + 3 * j, way.clamp_row[j]
            fx, fy, fz = fx + shape[k], fy + shape[k + 1], fz + shape[k + 2]
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
