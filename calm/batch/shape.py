"""The shape of a line at fixed nodes, for every profile: `calm batch --shape`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import ceil

import numpy as np
from numpy.typing import NDArray

from calm.batch.profiles import Profiles
from calm.case import Mooring
from calm.case.parts import clamps_down
from calm.files import Clamp
from calm.files.rigid import Body
from calm.physics.line import Floats

PARTS = 64
"""Into so many parts, about, the nodes divide the cables and chains of a line."""

OF_NODE = ("depth", "x", "y", "tension")
"""What is known of a node; see `ShapeNodes.columns`."""


@dataclass(frozen=True)
class ShapeNodes:
    """The nodes of a line: the top of every piece, points on its cables, the top of the anchor.

    A node on a cable is a clamp that weighs nothing and takes no drag, so that what is solved for
    clamps is solved for it.

    Attributes
    ----------
    mooring : with the nodes among its clamps
    component : (s,) of every node, the index of the piece that it is on
    distance : (s,) unstretched, from the top of the line [m]
    """

    mooring: Mooring
    component: NDArray[np.int32]
    distance: Floats
    clamps: tuple[int, ...]
    order: NDArray[np.int64]
    own: tuple[int, ...]

    def columns(self, profiles: Profiles) -> Mapping[str, Floats]:
        """Depth and offsets [m], and tension [N], of the nodes: (n, s) each."""
        tops = (profiles.depth_top, profiles.x_top, profiles.y_top, profiles.tension_top)
        between = (
            profiles.clamp_depth,
            profiles.clamp_x,
            profiles.clamp_y,
            profiles.clamp_tension,
        )
        return {
            name: np.hstack([top, inner[:, list(self.own)]])[:, self.order]
            for name, top, inner in zip(OF_NODE, tops, between, strict=True)
        }


def nodes_of(mooring: Mooring) -> ShapeNodes:
    """Lay the nodes along the line of a mooring.

    Raises
    ------
    NoEquilibrium
        Where a piece is to be cut to fit, and no length does.
    """
    lengths, flexible = mooring.line.length, mooring.line.flexible
    part = float(lengths[flexible].sum()) / PARTS
    tops = np.concatenate([[0.0], np.cumsum(lengths)])
    nothing = Body.model_validate(
        {"kind": "body", "length": "0 m", "buoyancy": "0 N", "drag_area": "0 m^2", "cd": 0}
    )
    pieces = []
    component, distance = list(range(len(tops))), tops.tolist()
    for piece in mooring.file.pieces:
        index = piece.index
        clamps = piece.clamps
        if index < len(lengths) and flexible[index]:
            length = float(lengths[index])
            inner = np.linspace(0.0, length, max(ceil(length / part), 1) + 1)[1:-1]
            clamps += tuple(Clamp("", "", nothing, float(at), piece.place) for at in inner)
            component += [index] * len(inner)
            distance += (tops[index] + inner).tolist()
            piece = replace(piece, length=length, fit_top_depth=None, clamps=clamps)
        pieces.append(piece)
    order = np.lexsort((distance, component))
    own = np.array([clamp.use == "" for clamp in clamps_down(pieces)], bool)
    return ShapeNodes(
        mooring=Mooring(replace(mooring.file, pieces=tuple(pieces))),
        component=np.array(component, np.int32)[order],
        distance=np.array(distance)[order],
        clamps=tuple(np.flatnonzero(~own).tolist()),
        own=tuple(np.flatnonzero(own).tolist()),
        order=order,
    )
