"""Which part of a line an instrument is: by label, serial number, or order down the line."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from calm.case import Mooring
from calm.errors import UsageError, nearest
from calm.files.mooring_file import clamps_down
from calm.motion.line_response import Forward, labels_of
from calm.motion.measurements import MooringMeasurements
from calm.physics.line import Floats
from calm.records.instrument_series import Identity

CLEAR = 10.0
"""An order of instruments is the only one where any other is off by so much more [m]."""

STRETCHED, AMISS = 1.25, 20.0
"""How many times as long as it was cut a line is at most; how far off pressures may be [m]."""


@dataclass(frozen=True)
class LinePlaces:
    """The p points of a line where an instrument may be.

    Attributes
    ----------
    name : of the file that they are from
    label, serial : (p,) of clamps and pieces; serials are empty where not known
    clamps : how many of the points are clamps, which come first
    still : (p,) depths in calm water [m]
    """

    name: str
    label: tuple[str, ...]
    serial: tuple[str, ...]
    clamps: int
    still: Floats


def places_of(mooring: Mooring) -> LinePlaces:
    """Return the points of a mooring, with the serial numbers of what was deployed."""
    return LinePlaces(
        mooring.file.path, labels_of(mooring), serials_of(mooring),
        len(clamps_down(mooring.file.pieces)), Forward(mooring, {}).still,
    )  # fmt: skip


def serials_of(mooring: Mooring) -> tuple[str, ...]:
    """Return the serial number of each clamp and piece, as deployed; empty where not known."""
    file = mooring.file
    deployed = () if file.deployed is None else file.deployed.items
    given = {item.label: item.serial for item in deployed if item.serial}
    parts = [(one.label, one.serial) for one in clamps_down(file.pieces)]
    parts += [(one.label, one.serial) for one in file.pieces]
    return tuple(str(given.get(label) or serial or "") for label, serial in parts)


def distances_of(mooring: Mooring) -> Floats:
    """Return how far each clamp and piece is from the top along the line as cut (p,) [m]."""
    pieces = mooring.file.pieces
    tops = np.cumsum([0.0, *mooring.line.length.tolist()])[: len(pieces)]
    clamps = [
        top + clamp.at
        for top, piece in zip(tops, pieces, strict=True)
        for clamp in clamps_down([piece])
    ]
    return np.array([*clamps, *tops])


def torn(measured: MooringMeasurements, distance: Floats) -> tuple[MooringMeasurements, list[str]]:
    """Return what was measured without depths farther apart than the line between two sensors is
    long, and what is said of them.

    Of the two the one is wrong that is farther from its median. Where most of a sensor's depths
    are, they stay.

    Parameters
    ----------
    distance : (p,) of the points along the line [m]
    """
    depth, place = measured.depth, distance[measured.point]
    away = np.abs(depth - np.nanmedian(depth, axis=0))
    wrong = np.zeros(depth.shape, bool)
    for i, j in combinations(range(len(place)), 2):
        reach = STRETCHED * abs(place[i] - place[j]) + AMISS
        apart = np.abs(depth[:, i] - depth[:, j]) > reach
        wrong[:, i] |= apart & (away[:, i] > away[:, j])
        wrong[:, j] |= apart & (away[:, i] <= away[:, j])
    wrong &= 2 * wrong.sum(axis=0) < np.isfinite(depth).sum(axis=0)
    notes = [
        f"{measured.label[j]}: {wrong[:, j].sum()} of its readings are farther from those of "
        f"others than the line is long, and are left out: the first is {depth[at, j]:.1f} m, at "
        f"{np.datetime_as_string(measured.time[at], 's')}"
        for j, at in enumerate(wrong.argmax(axis=0).tolist())
        if wrong[at, j]
    ]
    return replace(measured, depth=np.where(wrong, np.nan, depth)), notes


def points_of(series: Sequence[Identity], line: LinePlaces) -> tuple[dict[int, int], list[str]]:
    """Return the point of each series, and what is said of how it was found, or not.

    By its label; else by its serial number; else, where none of its file has either, by nominal
    depths, in their order down the line.

    UsageError: no series is of any point, or their order is not the only one.
    """
    found: dict[int, int] = {}
    said, lost, placed = [], [], []
    who = [(one.label, one.serial, one.nominal, one.source) for one in series]
    first = [who.index(one) for one in who]  # the bins of a profiler are one instrument
    for i in sorted(set(first)):
        one = series[i]
        at = _index(one.label, line.label)
        if at is None:
            at = _index(one.serial, line.serial)
        if at is not None:
            found[i] = at
        elif one.label:
            near = nearest(one.label, line.label)
            hint = f"; did you mean `{near}`?" if near else ""
            lost.append(f"`{one.label}` of {one.source} is not in {line.name}{hint}")
        elif np.isfinite(one.nominal):
            placed.append(i)
        else:
            lost.append(f"{one.named}: neither label, serial number nor nominal depth is known")
    if placed:
        order, more = _by_place(placed, series, line, set(found.values()))
        found |= order
        lost += more
        each = (f"{series[i].named} is `{line.label[at]}`" for i, at in sorted(order.items()))
        said.append(f"by nominal depths, in their order: {'; '.join(each)}")
    if not found:
        raise UsageError(
            "no instrument is a part of the line: " + "; ".join(lost[:8])
            + "; name a file of one instrument by LABEL=FILE"
        )  # fmt: skip
    return {i: found[one] for i, one in enumerate(first) if one in found}, said + lost


def _index(text: str, among: Sequence[str]) -> int | None:
    if not text:
        return None
    known = [one.casefold() for one in among]
    return known.index(text.casefold()) if known.count(text.casefold()) == 1 else None


def _by_place(
    which: Sequence[int], series: Sequence[Identity], line: LinePlaces, taken: set[int]
) -> tuple[dict[int, int], list[str]]:
    """Match in the order down the line; of two lists, what the longer one has more is left out.

    What is compared is the distance to the neighbours: nominal depths of a whole line are often off
    together.
    """
    still = line.still
    free = range(line.clamps) if line.clamps else range(len(line.label))
    points = sorted((at for at in free if at not in taken), key=lambda at: still[at])
    rows = sorted(which, key=lambda i: series[i].nominal)
    one = np.array([series[i].nominal for i in rows])
    other = still[points]
    few, many = (one, other) if len(one) <= len(other) else (other, one)
    if not len(few):
        return {}, [f"{series[i].named} is at no free place of the line" for i in rows]
    best, second = aligned(few, many, 0.01, 1.0)
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
                   f"{line.name}" for i in left]  # fmt: skip


def aligned(
    few: Floats, many: Floats, depths: float, spacings: float
) -> tuple[tuple[float, list[int]], tuple[float, list[int]] | None]:
    """Return the cheapest way to set few depths on many in their order, and the next best.

    Parameters
    ----------
    few, many : rising [m]
    depths, spacings : what a metre costs by which a depth is off, and a spacing between neighbours
    """
    places = len(many)

    def solved(forbidden: tuple[int, int] | None) -> tuple[float, list[int]]:
        off = depths * np.abs(few[:, None] - many[None, :])
        if forbidden is not None:
            off[forbidden] = np.inf
        cost, back = off[0].copy(), []
        for i in range(1, len(few)):
            step = np.abs((few[i] - few[i - 1]) - (many[None, :] - many[:, None]))
            down = np.tri(places, dtype=bool)
            whole = np.where(down, np.inf, cost[:, None] + spacings * step)
            back.append(whole.argmin(axis=0))
            cost = whole.min(axis=0) + off[i]
        chosen = [int(cost.argmin())]
        for table in reversed(back):
            chosen.append(int(table[chosen[-1]]))
        return float(cost.min()), chosen[::-1]

    best = solved(None)
    others = [solved(pair) for pair in enumerate(best[1])]
    real = [one for one in others if np.isfinite(one[0])]
    return best, min(real, key=lambda one: one[0], default=None)
