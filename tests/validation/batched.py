"""A mooring of plain arrays solved as one of many profiles: by the search of `calm batch`."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from calm.batch.profiles import Batch
from calm.batch.solving import DEPTH, EAST, NORTH, TENSION_BOTTOM, TENSION_TOP, Results
from calm.batch.statuses import STATUSES, status_of
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
    pieces, clamps, ends = (rows[own] for rows in together)
    place = pieces[[EAST, NORTH, DEPTH]].T * [1.0, 1.0, -1.0]
    down = np.lexsort((line.clamp_at, line.clamp_piece))  # in this order they are in the rows
    at_clamps = np.empty((len(down), 3))
    at_clamps[down] = clamps[[1, 2, 0]].T * [1.0, 1.0, -1.0]
    places = np.concatenate([place, place[1:], [[0.0, 0.0, -ends[4]]], at_clamps])
    tensions = np.concatenate([pieces[TENSION_TOP], pieces[TENSION_BOTTOM]])
    return STATUSES[status_of(batch.mooring, int(ending))], (places, tensions)


def _batch(line: Line, water: Water, settings: Settings) -> Batch:
    """Stand in for one of a file: anything may lie on the seabed, whatever it is made of."""
    may_lie = SimpleNamespace(component=SimpleNamespace(kind="chain"))
    file = SimpleNamespace(pieces=[may_lie] * (len(line.length) + 1))
    mooring: Any = SimpleNamespace(line=line, water=water, settings=settings, file=file)
    batch = Batch(mooring)
    vars(batch)["water"] = water.still()
    return batch


def _solved(batch: Batch, water: Water, shares: tuple[float, ...]) -> tuple[Results, Integers]:
    line, count = batch.mooring.line, len(shares)
    current = [np.outer(shares, column) for column in (water.u, water.v, water.w)]
    rows = Results(
        np.full((count, 6, len(line.length)), np.nan),
        np.full((count, 5, len(line.clamp_piece)), np.nan),
        np.full((count, 5), np.nan),
    )
    endings = np.zeros(count, np.int64)
    mooring: Any = batch.mooring
    for block in (slice(0, 0), slice(0, count)):  # the first makes its starts
        few = Results(*(array[block] for array in rows))
        parts = [np.ascontiguousarray(part[block]) for part in current]
        batch._solve_rows(
            mooring, (water.level[None].copy(), *parts), few, endings[block], MANY_ROOM
        )
    return rows, endings
