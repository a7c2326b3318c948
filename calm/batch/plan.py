"""A mooring laid out for the kernel: its stages, loads and cuts as arrays."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from calm.case.mooring import Mooring
from calm.physics.friction import Friction
from calm.physics.profile import Profile
from calm.physics.state import MarchError
from calm.physics.track import Cable, Load, Rod, Track, head_count
from calm.solve.closing import Closing
from calm.solve.locate import SHARES, _upright

SEGMENTS = 50


SOFT = 0.3

def cuts_of(track: Track, depth: float, count: int) -> list[np.ndarray]:
    """Base cuts: short where the line stands near the surface, where currents shear."""
    import os
    soft = float(os.environ.get("SOFT", SOFT)) * depth
    below = sum(s.length for s in track.stages if not isinstance(s, Load))
    spans = []
    for s in track.stages:
        if isinstance(s, Load):
            continue
        top = max(depth - below, 0.0)
        below -= s.length
        if isinstance(s, Cable):
            spans.append((np.log(top + soft), np.log(top + s.length + soft), s.length, top))
    total = sum(b - a for a, b, *_ in spans)
    cuts = []
    for a, b, length, top in spans:
        n = max(round(count * (b - a) / total), 1)
        edges = np.exp(np.linspace(a, b, n + 1)) - soft - top
        edges[0], edges[-1] = 0.0, length
        cuts.append(np.diff(edges))
    return cuts


class Plan:
    def __init__(self, mooring: Mooring, segments: int = SEGMENTS, first_grid: int = 2):
        line, water = mooring.line, mooring.water
        closing = Closing(line, water, mooring.settings)
        unknown = closing.whole(False)
        track = unknown.track
        kinds, firsts, counts, lengths, cables, cuts, loads = [], [], [], [], [], [], []
        stage_piece, load_piece, load_clamp = [], [], []
        afloat = closing.floats[0] if closing.floats else -1
        all_cuts = iter(cuts_of(track, water.depth, segments))
        rank = 0
        for n, stage in enumerate(track.stages):
            if isinstance(stage, Cable):
                c = next(all_cuts)
                kinds.append(1); firsts.append(len(cuts)); counts.append(len(c)); lengths.append(stage.length)
                cuts.extend(c)
                cables.append([stage.buoyancy, stage.volume, stage.normal_drag, stage.tangential_drag, stage.compliance, 2*stage.thinning])
                stage_piece.append(stage.piece)
                continue
            mine = stage.loads if isinstance(stage, Rod) else (stage,)
            kinds.append(0 if isinstance(stage, Rod) else 2)
            firsts.append(len(loads)); counts.append(len(mine)); lengths.append(stage.length if isinstance(stage, Rod) else 0.0)
            stage_piece.append(mine[0].piece)
            for l in mine:
                role = 0.0
                if n == 0 and afloat in (stage.pieces if isinstance(stage, Rod) else ()):
                    role = 1.0 if l.piece == afloat and l.clamp < 0 else 2.0 if l.piece < afloat else 0.0
                    if line.floating is None and role == 2.0: role = 0.0
                loads.append([l.at, l.lever, l.buoyancy, l.volume, l.normal_drag, l.tangential_drag, l.lift, float(l.directional), role])
                load_piece.append(l.piece)
                load_clamp.append(rank if l.clamp >= 0 else -1)
                rank += l.clamp >= 0
        I = lambda x: np.array(x, np.int64)
        F = lambda x, w: np.array(x, float).reshape(-1, w)
        self.track = track
        self.plan = (I(kinds), I(firsts), I(counts), np.array(lengths, float), F(cables, 6), np.array(cuts, float), F(loads, 9), water.gravity, 2e-6 * water.depth, track.landing)
        self.clamps = rank
        self.parts = (I(stage_piece), I(load_piece), I(load_clamp), line.length.copy(), head_count(line))
        head = track.stages[0]
        in_head = isinstance(head, Rod) and afloat in head.pieces
        self.upright = _upright(closing, unknown)
        self.rigid = (0.0, 0.0)
        n = 1024
        self.riding = np.tile([0.0, 0.0, 1.0, 0.0, 0.0], (2, 1))
        if line.floating is not None and in_head:
            *above, own = head.lengths[: head.pieces.index(afloat) + 1]
            self.rigid = (sum(above), own)
            rows = []
            for tau in np.linspace(0, 1, n + 1):
                r = line.floating.riding(1.0 - (1.0 - tau) ** 2)
                rows.append([r.standing, r.above, r.drag, *r.push])
            self.riding = np.array(rows)
        H = water.depth
        self.mooring = (H, line.anchor_height - H, self.upright, in_head, line.floating is not None, line.anchor_height, bool(line.length.sum() > H), first_grid)
        self.floating = (self.riding, self.rigid)
        self.chances = (np.array(SHARES), falls_of(closing, unknown, self.upright))
        lev = water.level
        self.fixed = np.column_stack([lev, 0*lev, 0*lev, water.density])
        self.pieces = len(line.length)


def falls_of(closing, unknown, top):
    """Knockdown in even currents, every 0.05 m/s up to 4 m/s."""
    step, falls = 0.05, []
    water = closing.water
    for n in range(81):
        zero = np.zeros_like(water.u)
        even = Profile(replace(water, u=zero + step * n, v=zero, w=zero))
        try:
            z = closing.run(unknown, top, closing.coarse_step, profile=even).z
        except MarchError:
            z = 0.0
        falls.append(max(z - unknown.goal, closing.allowed))
    return np.array([*falls, step])
