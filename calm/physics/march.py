"""The top-down march: from the free end to the anchor, one element after another.

The march knows where the free end is and that nothing pulls it from above; it returns where the
other end comes out and with what force. What is unknown, and how the end is brought to the
anchor, is the business of `calm.solve`.

A cable or chain is marched in straight segments. Where no cuts are given the march chooses them:
each turns by about the angle step and is short against the water depth, and none straddles a
level of the current profile. Given cuts are taken as they are, which makes the end of the line a
smooth function of its start.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from math import inf, sqrt

from calm.physics.element import axis_along, drag_force, drag_share
from calm.physics.line import REFERENCE_DENSITY, Line, Water

Cuts = list[list[float]]
"""For every cable of a `Track`, the unstretched lengths of its segments [m]."""

MOST_SEGMENTS = 50_000
_PASSES = 200


class MarchError(ArithmeticError):
    """The march cannot go on: an element has no balance, or the line needs endless segments."""


@dataclass(frozen=True)
class Load:
    """A rigid piece or a clamped instrument at `at` metres below the top of its rod.

    `lever` is 1 - at/length, the share of the load that turns the rod; ½ for a rod of no length.
    """

    piece: int
    clamp: int
    at: float
    lever: float
    buoyancy: float
    volume: float
    normal_drag: float
    tangential_drag: float
    directional: bool


@dataclass(frozen=True)
class Rod:
    """One rigid body: a piece, or the pieces above the first float together with it."""

    pieces: tuple[int, ...]
    lengths: tuple[float, ...]
    loads: tuple[Load, ...]

    @property
    def length(self) -> float:
        return sum(self.lengths)


@dataclass(frozen=True)
class Cable:
    """A stretch of cable or chain without clamps: a whole piece, or the part between two clamps."""

    piece: int
    length: float
    buoyancy: float
    volume: float
    normal_drag: float
    tangential_drag: float
    compliance: float
    thinning: float


Stage = Rod | Cable | Load


@dataclass(frozen=True)
class Track:
    """A `Line` laid out for the march: its stages from the free end to the anchor."""

    stages: tuple[Stage, ...]

    @staticmethod
    def of(line: Line) -> Track:
        """Lay out a line; its head (see `head_count`) becomes one rod."""
        head = head_count(line)
        stages: list[Stage] = [_rod(line, range(head))] if head else []
        for piece in range(head, len(line.length)):
            if line.flexible[piece]:
                stages.extend(_cable_stages(line, piece))
            else:
                stages.append(_rod(line, range(piece, piece + 1)))
        return Track(tuple(stages))


def head_count(line: Line) -> int:
    """How many pieces at the free end make one rigid body: down to the first buoyant piece.

    Pieces without buoyancy listed above the first buoyant one (a beacon, ballast) are rigid with
    it; where a cable lies between, or nothing is buoyant, the first piece stands alone.
    """
    for piece in range(len(line.length)):
        if line.flexible[piece]:
            break
        if line.buoyancy[piece] > 0:
            return piece + 1
    return 0


def _clamps_of(line: Line, piece: int) -> list[int]:
    clamps = [m for m in range(len(line.clamp_piece)) if line.clamp_piece[m] == piece]
    return sorted(clamps, key=lambda m: float(line.clamp_at[m]))


def _clamp_load(line: Line, m: int, at: float = 0.0, lever: float = 0.5) -> Load:
    return Load(
        piece=int(line.clamp_piece[m]),
        clamp=m,
        at=at,
        lever=lever,
        buoyancy=float(line.clamp_buoyancy[m]),
        volume=float(line.clamp_volume[m]),
        normal_drag=float(line.clamp_drag[m]),
        tangential_drag=0.0,
        directional=False,
    )


def _rod(line: Line, pieces: range) -> Rod:
    lengths = tuple(float(line.length[p]) for p in pieces)
    total = sum(lengths)
    loads, top = [], 0.0

    def lever(at: float) -> float:
        return 1.0 - at / total if total > 0.0 else 0.5

    for piece, length in zip(pieces, lengths, strict=True):
        middle = top + 0.5 * length
        loads.append(
            Load(
                piece=piece,
                clamp=-1,
                at=middle,
                lever=lever(middle),
                buoyancy=float(line.buoyancy[piece]),
                volume=float(line.volume[piece]),
                normal_drag=float(line.normal_drag[piece]),
                tangential_drag=float(line.tangential_drag[piece]),
                directional=bool(line.directional[piece]),
            )
        )
        for m in _clamps_of(line, piece):
            at = top + float(line.clamp_at[m])
            loads.append(_clamp_load(line, m, at, lever(at)))
        top += length
    return Rod(tuple(pieces), lengths, tuple(loads))


def _cable_stages(line: Line, piece: int) -> Iterable[Stage]:
    def stretch(length: float) -> Cable:
        return Cable(
            piece=piece,
            length=length,
            buoyancy=float(line.buoyancy[piece]),
            volume=float(line.volume[piece]),
            normal_drag=float(line.normal_drag[piece]),
            tangential_drag=float(line.tangential_drag[piece]),
            compliance=float(line.compliance[piece]),
            thinning=float(line.thinning[piece]),
        )

    start, end = 0.0, float(line.length[piece])
    for m in _clamps_of(line, piece):
        at = float(line.clamp_at[m])
        if at > start:
            yield stretch(at - start)
            start = at
        yield _clamp_load(line, m)
    if end > start or end == 0.0:
        yield stretch(end - start)


class Profile:
    """Current and density by level as plain lists, extended beyond the first and last level."""

    def __init__(self, water: Water) -> None:
        self.depth = [-inf, *map(float, water.level), inf]
        self.gravity = water.gravity
        rows = []
        for values in (water.u, water.v, water.w, water.density):
            value = [float(values[0]), *map(float, values)]
            gaps = [self.depth[i + 1] - self.depth[i] for i in range(len(value))]
            slope = [
                0.0 if gap == inf else (value[i + 1] - value[i]) / gap for i, gap in enumerate(gaps)
            ]
            rows.append((value, slope))
        # one row per interval: origin depth, then value and slope of u, v, w and density
        self.rows = [
            (
                0.0 if i == 0 else self.depth[i],
                *(number for value, slope in rows for number in (value[i], slope[i])),
            )
            for i in range(len(self.depth) - 1)
        ]

    def interval(self, depth: float, i: int) -> int:
        """Index of the interval that holds `depth`, searched from interval `i`."""
        levels = self.depth
        while depth >= levels[i + 1]:
            i += 1
        while depth < levels[i]:
            i -= 1
        return i


@dataclass
class Trace:
    """What a recorded march leaves: nodes and the elements between them, free end first."""

    x: list[float] = field(default_factory=list)
    y: list[float] = field(default_factory=list)
    z: list[float] = field(default_factory=list)
    force: list[tuple[float, float, float]] = field(default_factory=list)
    piece: list[int] = field(default_factory=list)
    clamp: list[int] = field(default_factory=list)
    cut: list[float] = field(default_factory=list)
    strain: list[float] = field(default_factory=list)

    def node(self, x: float, y: float, z: float, force: tuple[float, float, float]) -> None:
        self.x.append(x)
        self.y.append(y)
        self.z.append(z)
        self.force.append(force)

    def element(self, piece: int, clamp: int, cut: float, strain: float) -> None:
        self.piece.append(piece)
        self.clamp.append(clamp)
        self.cut.append(cut)
        self.strain.append(strain)


@dataclass(frozen=True)
class End:
    """Where and how a march ended."""

    x: float
    y: float
    z: float
    force: tuple[float, float, float]
    cuts: Cuts
    segments: int


def march(
    track: Track,
    profile: Profile,
    depth: float,
    *,
    angle_step: float,
    reach: float,
    cuts: Cuts | None = None,
    trace: Trace | None = None,
) -> End:
    """March down the line from a free end at `depth`.

    Parameters
    ----------
    depth : of the free end [m]
    angle_step : how much a segment may turn [rad]
    reach : the longest a segment may be [m]
    cuts : the segments to use; None lets the march choose them
    trace : filled with every node and element when given

    Raises
    ------
    MarchError
        An element finds no balance or the line would need more than 50 000 segments.
    """
    x = y = 0.0
    z = -depth
    fx = fy = fz = 0.0
    tz = -1.0
    level = profile.interval(depth, 0)
    used: Cuts = []
    segments = 0
    if trace is not None:
        trace.node(x, y, z, (fx, fy, fz))
    for stage in track.stages:
        if isinstance(stage, Cable):
            given = cuts[len(used)] if cuts is not None else None
            x, y, z, fx, fy, fz, tz, level, taken = _march_cable(
                stage, profile, x, y, z, fx, fy, fz, tz, level, angle_step, reach, given, trace
            )
            used.append(taken)
            segments += len(taken)
            if segments > MOST_SEGMENTS:
                raise MarchError(f"the line would need more than {MOST_SEGMENTS} segments")
        elif isinstance(stage, Rod):
            x, y, z, fx, fy, fz, tz, level = _pass_rod(
                stage, profile, x, y, z, fx, fy, fz, tz, level, trace
            )
            segments += 1
        else:
            qx, qy, qz, level = _load_force(stage, profile, -z, level, 0.0, 0.0, tz)
            fx, fy, fz = fx + qx, fy + qy, fz + qz
            if trace is not None:
                trace.element(stage.piece, stage.clamp, 0.0, 0.0)
                trace.node(x, y, z, (fx, fy, fz))
    return End(x, y, z, (fx, fy, fz), used, segments)


def _march_cable(
    cable: Cable,
    profile: Profile,
    x: float,
    y: float,
    z: float,
    fx: float,
    fy: float,
    fz: float,
    tz: float,
    level: int,
    angle_step: float,
    reach: float,
    given: list[float] | None,
    trace: Trace | None,
) -> tuple[float, float, float, float, float, float, float, int, list[float]]:
    kn, kt = cable.normal_drag, cable.tangential_drag
    compliance, thinning = cable.compliance, cable.thinning
    rows, gravity = profile.rows, profile.gravity
    taken: list[float] = []
    done, position = 0.0, 0
    rise = tz
    while True:
        if given is None:
            left = cable.length - done
            if left <= 1e-12 * cable.length and taken:
                break
            cut = min(
                left,
                _segment_length(cable, profile, -z, rise, fx, fy, fz, level, angle_step, reach),
            )
            if left - cut < 0.01 * cut:
                cut = left
            if len(taken) > MOST_SEGMENTS:
                break
        else:
            if position == len(given):
                break
            cut = given[position]
            position += 1
        half = 0.5 * cut
        strain = compliance * sqrt(fx * fx + fy * fy + fz * fz)
        earlier = inf
        for _ in range(_PASSES):
            depth = -z - half * rise
            if not profile.depth[level] <= depth < profile.depth[level + 1]:
                level = profile.interval(depth, level)
            origin, u, du, v, dv, w, dw, rho, drho = rows[level]
            below = depth - origin
            u, v, w, rho = u + du * below, v + dv * below, w + dw * below, rho + drho * below
            area = cut * rho / REFERENCE_DENSITY
            if strain:
                area *= (1.0 + strain) ** thinning
            lift = cut * (cable.buoyancy + (rho - REFERENCE_DENSITY) * gravity * cable.volume)
            az = fz + 0.5 * lift
            c = drag_share(fx, fy, az, 0.5 * kn * area, u, v, w)
            tx, ty, tz = axis_along(fx, fy, az, c, u, v, w)
            qx, qy, qz = drag_force(kn * area, kt * area, u, v, w, tx, ty, tz)
            hx, hy, hz = fx + 0.5 * qx, fy + 0.5 * qy, az + 0.5 * qz
            if hx * tx + hy * ty + hz * tz > 0.0:
                tx, ty, tz = -tx, -ty, -tz
            strain = compliance * sqrt(hx * hx + hy * hy + hz * hz)
            change = abs(tz * (1.0 + strain) - rise)
            rise = tz * (1.0 + strain)
            # the passes contract: the next change would be about change²/earlier
            if change < 1e-12 or change * change < 1e-12 * earlier < inf:
                break
            earlier = change
        else:
            raise MarchError("a segment finds no balance")
        stretched = cut * (1.0 + strain)
        x, y, z = x + stretched * tx, y + stretched * ty, z + stretched * tz
        fx, fy, fz = fx + qx, fy + qy, fz + qz + lift
        taken.append(cut)
        done += cut
        if trace is not None:
            trace.element(cable.piece, -1, cut, strain)
            trace.node(x, y, z, (fx, fy, fz))
    return x, y, z, fx, fy, fz, tz, level, taken


def _segment_length(
    cable: Cable,
    profile: Profile,
    depth: float,
    rise: float,
    fx: float,
    fy: float,
    fz: float,
    level: int,
    angle_step: float,
    reach: float,
) -> float:
    """How long the next segment may be [m]: by turning, by depth, and to the next level."""
    tension = sqrt(fx * fx + fy * fy + fz * fz)
    level = profile.interval(depth, level)
    origin, u, du, v, dv, w, dw, rho, drho = profile.rows[level]
    below = depth - origin
    u, v, w, rho = u + du * below, v + dv * below, w + dw * below, rho + drho * below
    lift = cable.buoyancy + (rho - REFERENCE_DENSITY) * profile.gravity * cable.volume
    if tension > 0.0:
        tx, ty, tz = -fx / tension, -fy / tension, -fz / tension
    else:
        tx, ty, tz = 0.0, 0.0, -1.0
    scale = rho / REFERENCE_DENSITY
    qx, qy, qz = drag_force(scale * cable.normal_drag, 0.0, u, v, w, tx, ty, tz)
    along = lift * tz
    qx, qy, qz = qx - along * tx, qy - along * ty, qz + lift - along * tz
    turning = sqrt(qx * qx + qy * qy + qz * qz)
    # where a slack line hangs on little more than its own weight it may turn within one segment,
    # so the tension may not fall by more than half in it
    rate = max(turning / angle_step, 2.0 * along) if tension > 0.0 else turning / angle_step
    length = reach
    if rate > 0.0:
        # near a free end the tension vanishes: the floor keeps the count finite
        length = min(length, max(tension / rate, 1e-5 * reach))
    if rise < 0.0:
        gap = (profile.depth[level + 1] - depth) / -rise
    elif rise > 0.0:
        gap = (depth - profile.depth[level]) / rise
    else:
        gap = inf
    # a level closer than a hundredth of the segment is as good as reached
    return gap if 0.01 * length < gap < length else length


def _load_force(
    load: Load, profile: Profile, depth: float, level: int, tx: float, ty: float, tz: float
) -> tuple[float, float, float, int]:
    """Buoyancy and drag of a rigid piece or clamp at a depth, and the profile interval used."""
    level = profile.interval(depth, level)
    origin, u, du, v, dv, w, dw, rho, drho = profile.rows[level]
    below = depth - origin
    u, v, w, rho = u + du * below, v + dv * below, w + dw * below, rho + drho * below
    scale = rho / REFERENCE_DENSITY
    lift = load.buoyancy + (rho - REFERENCE_DENSITY) * profile.gravity * load.volume
    if load.directional:
        qx, qy, qz = drag_force(
            scale * load.normal_drag, scale * load.tangential_drag, u, v, w, tx, ty, tz
        )
    else:
        drag = scale * load.normal_drag * sqrt(u * u + v * v + w * w)
        qx, qy, qz = drag * u, drag * v, drag * w
    return qx, qy, qz + lift, level


def _pass_rod(
    rod: Rod,
    profile: Profile,
    x: float,
    y: float,
    z: float,
    fx: float,
    fy: float,
    fz: float,
    tz: float,
    level: int,
    trace: Trace | None,
) -> tuple[float, float, float, float, float, float, float, int]:
    tx, ty, tz = _rod_axis(rod, profile, z, fx, fy, fz, tz, level)
    forces = []
    for load in rod.loads:
        qx, qy, qz, level = _load_force(load, profile, -z - load.at * tz, level, tx, ty, tz)
        forces.append((qx, qy, qz))
    if trace is not None:
        _trace_rod(rod, forces, trace, (x, y, z), (fx, fy, fz), (tx, ty, tz))
    length = rod.length
    return (
        x + length * tx,
        y + length * ty,
        z + length * tz,
        fx + sum(force[0] for force in forces),
        fy + sum(force[1] for force in forces),
        fz + sum(force[2] for force in forces),
        tz,
        level,
    )


def _rod_axis(
    rod: Rod, profile: Profile, z: float, fx: float, fy: float, fz: float, tz: float, level: int
) -> tuple[float, float, float]:
    """Axis for which the moments about the rod's middle vanish.

    With several loads q_i at distances a_i from the top the rule of one load becomes
    t ∥ F + Σ (1 - a_i/L) q_i. The normal drags are gathered into one current and one coefficient
    that reproduce their sum at the present axis, so each pass solves a single element exactly and
    only shear along the rod is left to the passes.
    """
    tx = ty = 0.0
    pace, earlier = 1.0, inf
    for _ in range(_PASSES):
        ax, ay, az = fx, fy, fz
        weight = gx = gy = gz = 0.0
        normals = []
        for load in rod.loads:
            depth = -z - load.at * tz
            level = profile.interval(depth, level)
            origin, u, du, v, dv, w, dw, rho, drho = profile.rows[level]
            below = depth - origin
            u, v, w, rho = u + du * below, v + dv * below, w + dw * below, rho + drho * below
            scale = load.lever * rho / REFERENCE_DENSITY
            az += load.lever * (
                load.buoyancy + (rho - REFERENCE_DENSITY) * profile.gravity * load.volume
            )
            if load.directional:
                normals.append((scale * load.normal_drag, u, v, w))
            else:
                drag = scale * load.normal_drag * sqrt(u * u + v * v + w * w)
                ax, ay, az = ax + drag * u, ay + drag * v, az + drag * w
        if len(normals) == 1:
            weight, gx, gy, gz = normals[0]
        elif normals:
            weight, gx, gy, gz = _gather(normals, tx, ty, tz)
        c = drag_share(ax, ay, az, weight, gx, gy, gz)
        nx, ny, nz = axis_along(ax, ay, az, c, gx, gy, gz)
        mx, my, mz = fx, fy, fz
        for load in rod.loads:
            qx, qy, qz, level = _load_force(load, profile, -z - load.at * nz, level, nx, ny, nz)
            mx, my, mz = mx + load.lever * qx, my + load.lever * qy, mz + load.lever * qz
        if mx * nx + my * ny + mz * nz > 0.0:
            nx, ny, nz = -nx, -ny, -nz
        change = abs(nx - tx) + abs(ny - ty) + abs(nz - tz)
        if change < 1e-12:
            return nx, ny, nz
        if change > 0.7 * earlier:
            pace *= 0.5
        earlier = change
        if pace < 1.0:
            nx, ny, nz = tx + pace * (nx - tx), ty + pace * (ny - ty), tz + pace * (nz - tz)
            size = sqrt(nx * nx + ny * ny + nz * nz)
            if size == 0.0:
                raise MarchError("a rigid piece finds no balance")
            nx, ny, nz = nx / size, ny / size, nz / size
        tx, ty, tz = nx, ny, nz
    raise MarchError("a rigid piece finds no balance")


def _gather(
    normals: list[tuple[float, float, float, float]], tx: float, ty: float, tz: float
) -> tuple[float, float, float, float]:
    """One coefficient K and current V with K|V × t|V = Σ K_i|V_i × t|V_i at the axis t."""
    total = gx = gy = gz = 0.0
    for k, u, v, w in normals:
        cx, cy, cz = v * tz - w * ty, w * tx - u * tz, u * ty - v * tx
        share = k * sqrt(cx * cx + cy * cy + cz * cz)
        total += share
        gx, gy, gz = gx + share * u, gy + share * v, gz + share * w
    if total == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    gx, gy, gz = gx / total, gy / total, gz / total
    cx, cy, cz = gy * tz - gz * ty, gz * tx - gx * tz, gx * ty - gy * tx
    across = sqrt(cx * cx + cy * cy + cz * cz)
    return (total / across if across > 0.0 else 0.0), gx, gy, gz


def _trace_rod(
    rod: Rod,
    forces: list[tuple[float, float, float]],
    trace: Trace,
    top: tuple[float, float, float],
    force: tuple[float, float, float],
    axis: tuple[float, float, float],
) -> None:
    """Record a rod piece by piece; a piece's own load counts as spread along it, a clamp's not."""
    x, y, z = top
    fx, fy, fz = force
    start = 0.0
    for piece, length in zip(rod.pieces, rod.lengths, strict=True):
        own = next(
            q
            for q, load in zip(forces, rod.loads, strict=True)
            if load.piece == piece and load.clamp < 0
        )
        marks = [
            (load, q)
            for q, load in zip(forces, rod.loads, strict=True)
            if load.piece == piece and load.clamp >= 0
        ]
        reached = start
        for load, q in [*marks, (None, (0.0, 0.0, 0.0))]:
            end = start + length if load is None else load.at
            step = end - reached
            share = step / length if length > 0.0 else (1.0 if load is None else 0.0)
            x, y, z = x + step * axis[0], y + step * axis[1], z + step * axis[2]
            fx, fy, fz = fx + share * own[0], fy + share * own[1], fz + share * own[2]
            trace.element(piece, -1, step, 0.0)
            trace.node(x, y, z, (fx, fy, fz))
            if load is not None:
                fx, fy, fz = fx + q[0], fy + q[1], fz + q[2]
                trace.element(piece, load.clamp, 0.0, 0.0)
                trace.node(x, y, z, (fx, fy, fz))
            reached = end
        start += length
