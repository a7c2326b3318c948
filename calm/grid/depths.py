"""Where the instruments were: a result of `calm motion`, and whose series is whose."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem, UsageError
from calm.records.cf_files import UnreadableError, is_netcdf, open_current, read_times, reading
from calm.records.instrument_series import InstrumentSeries
from calm.suggestions import nearest

if TYPE_CHECKING:
    from xarray import Dataset

    Floats = NDArray[np.float64]

_POINTS = (
    ("clamp", "clamp_depth", "clamp_depth_sd"),
    ("component", "depth_top", "depth_sd"),
)
CLEAR = 10.0
"""An order of instruments is the only one where any other is off by so much more [m]."""


@dataclass(frozen=True)
class MooringDepths:
    """Depths of p points of a line over n times.

    Attributes
    ----------
    time : (n,) to the nanosecond, rising
    label, serial : (p,) of clamps and pieces; serials are empty where not known
    clamps : how many of the points are clamps, which come first
    depth, deviation : (n, p) and standard deviation [m]
    place : latitude and longitude [degrees]; empty where not known
    seabed : depth of the last piece, the anchor [m]; NaN where not known
    attributes : of the file
    """

    path: Path
    time: NDArray[np.datetime64]
    label: tuple[str, ...]
    serial: tuple[str, ...]
    clamps: int
    depth: Floats
    deviation: Floats
    place: tuple[float, ...]
    seabed: float
    attributes: Mapping[str, Any]

    @property
    def still(self) -> Floats:
        """Return (p,) depths in the calmest hours [m]: a twentieth of the times is less deep."""
        known = np.where(np.isfinite(self.depth).any(axis=0), self.depth, 0.0)
        return np.asarray(np.nanpercentile(known, 5.0, axis=0), np.float64)


def read_depths(path: Path) -> MooringDepths:
    """Return the depths of a result of `calm motion`.

    Raises
    ------
    InputError
        It is not such a result, or has no time at which a depth is known.
    """
    if not path.exists():
        raise InputError([Problem(str(path), 0, 0, "no such file")])
    if not path.is_dir() and not is_netcdf(path):
        raise InputError([Problem(str(path), 0, 0, "is not a result of calm motion")])
    with reading(path), open_current(path) as dataset:
        return _understood(dataset, path)


def _understood(dataset: Dataset, path: Path) -> MooringDepths:
    labels: list[str] = []
    serials: list[str] = []
    depth, deviation, clamps = [], [], 0
    for dimension, name, spread in _POINTS:
        if f"{dimension}_label" not in dataset.variables:
            continue
        if name not in dataset.variables or spread not in dataset.variables:
            raise UnreadableError(
                f"has no `{spread}`: the depths of a result of calm motion are wanted, which have "
                "their uncertainty"
            )
        mine = [str(one) for one in dataset[f"{dimension}_label"].values.tolist()]
        labels += mine
        known = dataset.variables.get(f"{dimension}_serial")
        serials += [""] * len(mine) if known is None else [str(one) for one in known.values]
        depth.append(np.asarray(dataset[name].values, np.float64))
        deviation.append(np.asarray(dataset[spread].values, np.float64))
        clamps = len(mine) if dimension == "clamp" else clamps
    if not depth or "time" not in dataset.variables:
        raise UnreadableError("is not a result of calm motion: it has no depths with their labels")
    time = read_times(dataset, "time")
    whole = np.hstack(depth)
    if len(time) < 2 or not np.isfinite(whole).any():
        raise UnreadableError("has no depths: none of its times is solved")
    place = [float(dataset[a].values) for a in ("latitude", "longitude") if a in dataset.variables]
    seabed = float(np.nanmedian(whole[:, -1])) if np.isfinite(whole[:, -1]).any() else np.nan
    return MooringDepths(
        path, time, tuple(labels), tuple(serials), clamps, whole, np.hstack(deviation),
        tuple(place) if len(place) == 2 else (), seabed, dict(dataset.attrs),
    )  # fmt: skip


def points_of(
    series: Sequence[InstrumentSeries], depths: MooringDepths
) -> tuple[dict[int, int], list[str]]:
    """Return the point of each series, and what is said of how it was found, or not.

    By its label; else by its serial number; else, where none of its file has either, by nominal
    depths, in their order down the line.

    Raises
    ------
    UsageError
        No series is of any point, or two are of the same, or their order is not the only one.
    """
    found: dict[int, int] = {}
    said, lost, placed = [], [], []
    for i, one in enumerate(series):
        at = _index(one.label, depths.label)
        if at is None:
            at = _index(one.serial, depths.serial)
        if at is not None:
            found[i] = at
        elif one.label:
            near = nearest(one.label, depths.label)
            hint = f"; did you mean `{near}`?" if near else ""
            lost.append(f"`{one.label}` of {one.source} is not in {depths.path.name}{hint}")
        elif np.isfinite(one.nominal):
            placed.append(i)
        else:
            lost.append(f"{one.named}: neither label, serial number nor nominal depth is known")
    if placed:
        order, more = _by_place(placed, series, depths, set(found.values()))
        found |= order
        lost += more
        each = (f"{series[i].named} is `{depths.label[at]}`" for i, at in sorted(order.items()))
        said.append(f"by nominal depths, in their order: {'; '.join(each)}")
    if not found:
        raise UsageError(
            "no instrument is a part of the line: " + "; ".join(lost[:8])
            + "; name a file of one instrument by LABEL=FILE"
        )  # fmt: skip
    taken = list(found.values())
    twice = sorted({depths.label[at] for at in taken if taken.count(at) > 1})
    if twice:
        who = ", ".join(series[i].source for i, at in found.items() if depths.label[at] == twice[0])
        raise UsageError(f"two series are of `{twice[0]}`: {who}; leave one out")
    return found, said + lost


def _index(text: str, among: Sequence[str]) -> int | None:
    if not text:
        return None
    known = [one.casefold() for one in among]
    return known.index(text.casefold()) if known.count(text.casefold()) == 1 else None


def _by_place(
    which: Sequence[int],
    series: Sequence[InstrumentSeries],
    depths: MooringDepths,
    taken: set[int],
) -> tuple[dict[int, int], list[str]]:
    """Match in the order down the line; of two lists, what the longer one has more is left out.

    What is compared is the distance to the neighbours: nominal depths of a whole line are often off
    together.
    """
    still = depths.still
    free = range(depths.clamps) if depths.clamps else range(len(depths.label))
    points = sorted((at for at in free if at not in taken), key=lambda at: still[at])
    rows = sorted(which, key=lambda i: series[i].nominal)
    one = np.array([series[i].nominal for i in rows])
    other = still[points]
    few, many = (one, other) if len(one) <= len(other) else (other, one)
    if not len(few):
        return {}, [f"{series[i].named} is at no free place of the line" for i in rows]
    best, second = _aligned(few, many)
    if second is not None and second[0] - best[0] < CLEAR:
        differs = next(k for k in range(len(few)) if best[1][k] != second[1][k])
        row = differs if few is one else best[1][differs]
        raise UsageError(
            f"{series[rows[row]].named}, nominally at {one[row]:.0f} m, may be one or another "
            "part of the line: its file has no label or serial number that the depths have. Give "
            "serial numbers in the mooring file, or a file each as LABEL=FILE"
        )
    pairs = enumerate(best[1]) if few is one else ((j, i) for i, j in enumerate(best[1]))
    found = {rows[row]: points[at] for row, at in pairs}
    left = [i for i in rows if i not in found]
    return found, [f"{series[i].named}, nominally at {series[i].nominal:.0f} m, is at no place of "
                   f"{depths.path.name}" for i in left]  # fmt: skip


def _aligned(
    few: Floats, many: Floats
) -> tuple[tuple[float, list[int]], tuple[float, list[int]] | None]:
    """Return the cheapest way to set few depths on many in their order, and the next best.

    Its cost: the sum of how far each spacing between neighbours is off, and a hundredth of how far
    the depths are, which tells apart what the spacings cannot [m].
    """
    count, places = len(few), len(many)

    def solved(forbidden: tuple[int, int] | None) -> tuple[float, list[int]]:
        off = 0.01 * np.abs(few[:, None] - many[None, :])
        if forbidden is not None:
            off[forbidden] = np.inf
        cost, back = off[0].copy(), []
        for i in range(1, count):
            step = np.abs((few[i] - few[i - 1]) - (many[None, :] - many[:, None]))
            whole = np.where(np.tri(places, dtype=bool), np.inf, cost[:, None] + step)
            back.append(whole.argmin(axis=0))
            cost = whole.min(axis=0) + off[i]
        chosen = [int(cost.argmin())]
        for table in reversed(back):
            chosen.append(int(table[chosen[-1]]))
        return float(cost.min()), chosen[::-1]

    best = solved(None)
    others = [solved((i, best[1][i])) for i in range(count)] if places > count or count > 1 else []
    real = [one for one in others
            if np.isfinite(one[0]) and all(a < b for a, b in pairwise(one[1]))]  # fmt: skip
    return best, min(real, key=lambda one: one[0], default=None)
