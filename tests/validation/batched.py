"""A mooring of plain arrays, or a net, as one of many profiles: by the search of `calm batch`."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from calm.batch.profiles import Batch, Profiles, unsolved
from calm.batch.solving import OF_CLAMP, OF_ENDS, OF_PIECE, Results
from calm.batch.statuses import STATUSES, status_of
from calm.case import Design
from calm.physics.line import Integers, Line, Water
from calm.solve import Settings
from calm.solve.problem import MANY_ROOM
from tests.validation.agreement import Ends

COMPANY = (0.3, -1.2, 0.0, 1.0, 2.0)
"""The current of the profiles in one batch, as shares of that in question; one is that itself."""


class Unlike(AssertionError):
    """A profile is solved otherwise in company than alone."""


def in_company(line: Line, water: Water, settings: Settings) -> tuple[str, Ends]:
    """The status of a profile among others, and its ends.

    Raises
    ------
    Unlike
        Alone it is not the same to the last bit.
    """
    batch = _batch(line, water, settings)
    alone, (ending,) = _solved(batch, water, (1.0,))
    together, endings = _solved(batch, water, COMPANY)
    own = COMPANY.index(1.0)
    same = all(
        one[0].tobytes() == many[own].tobytes()
        for one, many in zip(alone, together, strict=True)
    )  # fmt: skip
    if ending != endings[own] or not same:
        raise Unlike("alone it is not what it is in company")
    pieces, clamps, ends, _ = (rows[own] for rows in together)
    of = {name: pieces[i] for i, name in enumerate(OF_PIECE)}
    place = np.column_stack([of["x_top"], of["y_top"], -of["depth_top"]])
    down = np.lexsort((line.clamp_at, line.clamp_piece))  # in this order they are in the rows
    at_clamps = np.empty((len(down), 3))
    x, y, depth = (clamps[OF_CLAMP.index(name)] for name in ("x", "y", "depth"))
    at_clamps[down] = np.column_stack([x, y, -depth])
    foot = [[0.0, 0.0, -ends[OF_ENDS.index("end_depth")]]]
    places = np.concatenate([place, place[1:], foot, at_clamps])
    tensions = np.concatenate([of["tension_top"], of["tension_bottom"]])
    return STATUSES[status_of(batch.mooring, int(ending))], (places, tensions)


def net_in_company(net: Design) -> tuple[str, Ends]:
    """The same of a net: places (p, 3) at the tops of all pieces and tensions (2p).

    Raises
    ------
    Unlike
        Alone it is not the same to the last bit.
    """
    water, own = net.water, COMPANY.index(1.0)
    batch = Batch(net)

    def solved(shares: tuple[float, ...]) -> Profiles:
        current = [np.outer(shares, column) for column in (water.u, water.v, water.w)]
        return batch.solve(current[0], current[1], water.level, current[2], workers=1)

    alone, together = solved((1.0,)), solved(COMPANY)
    ends = _net_ends(together, own)
    if alone.status[0] != together.status[own] or not all(
        np.array_equal(one, many, equal_nan=True)
        for one, many in zip(_net_ends(alone, 0), ends, strict=True)
    ):
        raise Unlike("alone it is not what it is in company")
    return STATUSES[together.status[own]], ends


def net_run(net: Design) -> Ends:
    """Those ends by a run."""
    return _net_ends(net.solve().components, ...)


def _net_ends(found: Any, row: Any) -> Ends:
    places = found.x_top[row], found.y_top[row], -found.depth_top[row]
    return np.column_stack(places), np.concatenate(
        [found.tension_top[row], found.tension_bottom[row]]
    )


def _batch(line: Line, water: Water, settings: Settings) -> Batch:
    """Stand in for one of a file: anything may lie on the seabed, whatever it is made of."""
    may_lie = SimpleNamespace(component=SimpleNamespace(kind="chain"))
    file = SimpleNamespace(pieces=[may_lie] * (len(line.length) + 1))
    mooring: Any = SimpleNamespace(line=line, water=water, settings=settings, file=file)
    mooring.moored = mooring
    batch = Batch(mooring)
    vars(batch)["water"] = water.still()
    return batch


def _solved(batch: Batch, water: Water, shares: tuple[float, ...]) -> tuple[Results, Integers]:
    line, count = batch.mooring.line, len(shares)
    current = [np.outer(shares, column) for column in (water.u, water.v, water.w)]
    rows = unsolved(line, count)
    endings = np.zeros(count, np.int64)
    mooring: Any = batch.mooring
    batch._solve_rows(mooring, (water.level[None].copy(), *current), rows, endings, MANY_ROOM)
    return rows, endings
