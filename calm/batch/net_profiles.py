"""Many current profiles of a net of legs, each sought from where the net is in still water."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.batch.solving import read_profile
from calm.batch.statuses import STATUSES
from calm.case.net import Net, net_result
from calm.case.net_result import NetResult
from calm.dataset.netcdf import OF_CLAMP, OF_COMPONENT, OF_ENDS
from calm.errors import NoEquilibrium
from calm.files import CurrentTable
from calm.physics.line import Floats
from calm.solve import expect_many
from calm.solve.net import NetSolution


@dataclass(frozen=True)
class NetProfiles:
    """A net made ready for many profiles."""

    net: Net

    @cached_property
    def still(self) -> NetSolution | None:
        """The net in still water; None where it does not stand there."""
        expect_many(inf)
        try:
            return self.net.equilibrium(self.net.water.still())
        except NoEquilibrium:
            return None

    def solve(self, current: tuple[Floats, ...], status: NDArray[np.int8]) -> dict[str, Floats]:
        """The columns of profiles, by name; how each ends goes to `status` where that is 0.

        Parameters
        ----------
        current : depth (1 or n, k) of levels [m], and u, v, w (n, k) there [m/s]
        status : (n,) index in `STATUSES`
        """
        net, (depth, u, v, w), still = self.net, current, self.still
        pieces, legs = net.file.pieces, len(net.file.legs)
        clamps = sum(len(piece.clamps) for piece in pieces)
        sizes = dict.fromkeys(OF_COMPONENT, len(pieces)) | dict.fromkeys(OF_CLAMP, clamps)
        sizes |= dict.fromkeys(OF_ENDS, legs)
        columns = {name: np.full((len(status), size), np.nan) for name, size in sizes.items()}
        read = np.zeros((depth.shape[1], 4))
        for case in np.flatnonzero(status == 0).tolist():
            levels = depth[case if len(depth) > 1 else 0]
            count = read_profile(levels, u[case], v[case], w[case], read)
            if count <= 0:
                status[case] = STATUSES.index("no-current" if count == 0 else "levels-coincide")
                continue
            table = CurrentTable(*(tuple(column) for column in read[:count].T.tolist()))
            water = net.water_of(replace(net.file.environment, current=table))
            try:
                solution = net.equilibrium(water, still)
                before: Any = [None] * legs if still is None else still.legs
                result = net_result(net, solution, before)
            except NoEquilibrium as failure:
                status[case] = STATUSES.index(failure.status)
                continue
            for name, column in _columns(result).items():
                columns[name][case] = column
        return columns


def _columns(result: NetResult) -> dict[str, Any]:
    return {
        **{name: getattr(result.components, name) for name in OF_COMPONENT},
        **{name: getattr(result.clamps, name.removeprefix("clamp_")) for name in OF_CLAMP},
        **result.ends,
    }
