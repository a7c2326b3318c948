"""A stretch of cable in the lanes: the laws of `calm.physics.cable`, all lanes at once.

The load of the last segment gives the lean of the next, to the order that its current needs.
Where a law is not made for all lanes at once each takes the segment by itself.
"""

from __future__ import annotations

from math import sqrt

from calm.batch.kernel import lane
from calm.batch.kernel.lane import (
    LANES,
    SINGLY,
    Tables,
    exact_shares,
    look_up,
    lost,
    state_of,
    take,
)
from calm.physics.cable import pass_segment, segment_area, segment_drag, segment_lift
from calm.physics.element import axis_against, few_steps_share
from calm.physics.friction import BERTEAUX
from calm.physics.line import Floats
from calm.physics.track import Cable, Course

PASSES = 2
"""Of a lane by itself: the second knows the stretch and the middle of the segment."""


def is_packed(course: Course, stage: int) -> bool:
    """Whether the law of a stretch of cable is made for all lanes at once."""
    cable = course.cables[course.stages[stage].first]
    plain = cable.friction == BERTEAUX and cable.first_knot == cable.end_knot
    return stage > 0 and plain and cable.beat == 0.0 and cable.normal_drag > 0.0


def set_cut(s: Floats, i: int, cut: float) -> None:
    """Give a lane the length of its next segment [m]."""
    s[lane.CUT + i], s[lane.PER_METRE + i] = cut, 1.0 / cut


def pass_cable(
    s: Floats, water: Tables, course: Course, stage: int, cuts: Floats, halvings: int
) -> None:
    """Take all lanes down a stretch of cable; each cut is halved so many times."""
    packed, cable = is_packed(course, stage), cable_of(course, stage)
    parts = 1 << halvings
    for j in range(cuts.size):
        for i in range(LANES):
            set_cut(s, i, cuts[j] / parts)
        if packed:
            pass_packed(s, water, cable, parts)
        elif SINGLY:
            for _ in range(parts):
                pass_singly(s, water, course, stage)


def cable_of(course: Course, stage: int) -> Cable:
    """The cable of a stage, out of the way of what is written."""
    here = course.cables[course.stages[stage].first]
    return Cable(
        here.piece, here.length, here.buoyancy, here.volume, here.normal_drag,
        here.tangential_drag, here.compliance, here.thinning, BERTEAUX, 0, 0, 0.0,
    )  # fmt: skip


def pass_packed(s: Floats, water: Tables, cable: Cable, times: int) -> None:
    """Take all lanes down so many segments of their own lengths."""
    for _ in range(times):
        for i in range(LANES):
            half = 0.5 * s[lane.CUT + i]
            gx = s[lane.FX + i] + half * s[lane.QX + i]
            gy = s[lane.FY + i] + half * s[lane.QY + i]
            gz = s[lane.FZ + i] + half * s[lane.QZ + i]
            pull = sqrt(gx * gx + gy * gy + gz * gz)
            strain = cable.compliance * pull
            s[lane.PULL + i] = pull
            s[lane.DEPTH + i] = -s[lane.Z + i] + half * (1.0 + strain) * gz / pull
        look_up(s, water)
        for i in range(LANES):
            u, v, w = s[lane.U + i], s[lane.V + i], s[lane.W + i]
            density, pull, cut = s[lane.DENSITY + i], s[lane.PULL + i], s[lane.CUT + i]
            area = segment_area(cable, cut, density, cable.compliance * pull)
            lift = segment_lift(cable, cut, density, water.sea.gravity)
            ax, ay, az = s[lane.FX + i], s[lane.FY + i], s[lane.FZ + i] + 0.5 * lift
            k = 0.5 * cable.normal_drag * area
            c, doubt = few_steps_share(ax, ay, az, k, pull, u, v, w, 1)
            s[lane.AX + i], s[lane.AY + i], s[lane.AZ + i] = ax, ay, az
            s[lane.K + i], s[lane.C + i], s[lane.DOUBT + i], s[lane.AREA + i] = k, c, doubt, area
            s[lane.GX + i], s[lane.GY + i], s[lane.GZ + i] = u, v, w
        exact_shares(s)
        for i in range(LANES):
            u, v, w = s[lane.GX + i], s[lane.GY + i], s[lane.GZ + i]
            area, cut, each = s[lane.AREA + i], s[lane.CUT + i], s[lane.PER_METRE + i]
            fx, fy, fz = s[lane.FX + i], s[lane.FY + i], s[lane.FZ + i]
            az, c = s[lane.AZ + i], s[lane.C + i]
            tx, ty, tz = axis_against(s[lane.AX + i] + c * u, s[lane.AY + i] + c * v, az + c * w)
            kn, kt = cable.normal_drag * area, cable.tangential_drag * area
            qx, qy, qz = segment_drag(BERTEAUX, kn, kt, u, v, w, tx, ty, tz)
            qz += 2.0 * (az - fz)
            pull = -((fx + 0.5 * qx) * tx + (fy + 0.5 * qy) * ty + (fz + 0.5 * qz) * tz)
            stretched = cut * (1.0 + cable.compliance * pull)
            least = s[lane.LEAST_PULL + i]
            s[lane.LEAST_PULL + i] = pull if pull < least else least
            s[lane.X + i] += stretched * tx
            s[lane.Y + i] += stretched * ty
            z = s[lane.Z + i] + stretched * tz
            s[lane.Z + i] = z
            s[lane.LOWEST + i] = z if z < s[lane.LOWEST + i] else s[lane.LOWEST + i]
            s[lane.HIGHEST + i] = z if z > s[lane.HIGHEST + i] else s[lane.HIGHEST + i]
            s[lane.FX + i], s[lane.FY + i], s[lane.FZ + i] = fx + qx, fy + qy, fz + qz
            s[lane.TX + i], s[lane.TY + i], s[lane.TZ + i] = tx, ty, tz
            s[lane.QX + i], s[lane.QY + i], s[lane.QZ + i] = qx * each, qy * each, qz * each


def pass_singly(s: Floats, water: Tables, course: Course, stage: int) -> None:
    """Take each lane that has a case down a segment of its own length, as the plain march does."""
    cable = course.cables[course.stages[stage].first]
    for i in range(LANES):
        if s[lane.BUSY + i] == 0.0 or lost(s, i):
            continue
        state = state_of(s, water, i)
        x, y, z, fx, fy, fz, _, _ = state
        cut, each = s[lane.CUT + i], s[lane.PER_METRE + i]
        below, strain = pass_segment(
            cable, course.knots, course.vibration, water.sea, state, cut, PASSES
        )
        take(s, water, i, below)
        per = each / (1.0 + strain)
        s[lane.TX + i], s[lane.TY + i] = per * (s[lane.X + i] - x), per * (s[lane.Y + i] - y)
        s[lane.TZ + i] = per * (s[lane.Z + i] - z)
        s[lane.QX + i] = each * (s[lane.FX + i] - fx)
        s[lane.QY + i] = each * (s[lane.FY + i] - fy)
        s[lane.QZ + i] = each * (s[lane.FZ + i] - fz)
