"""Matching of sensors to points of a line, by label, serial number or order down the line."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from calm.case import Design
from calm.errors import UsageError, nearest
from calm.files.pieces import clamps_down
from calm.motion import line_response
from calm.motion.measurements import CurrentMeasurements, MooringMeasurements
from calm.physics.line import Floats
from calm.records import cf_files
from calm.records.current_terms import parse_time
from calm.records.instrument_series import Identity, who_along


@dataclass(frozen=True)
class LinePlaces:
    """The p points of a line to which instruments may be matched."""

    name: str  # path of the mooring file
    label: tuple[str, ...]  # (p,) labels of clamps and pieces
    serial: tuple[str, ...]  # (p,) serial numbers; empty if unknown
    clamps: int  # number of clamps, which precede the other points
    still: Floats  # (p,) depths in still water [m]


def places_of(mooring: Design) -> LinePlaces:
    """Return the points of a mooring, with the serial numbers of the deployed parts."""
    return LinePlaces(
        mooring.file.path, line_response.labels_of(mooring), serials_of(mooring),
        len(clamps_down(mooring.file.pieces)), line_response.Forward(mooring, {}).still,
    )  # fmt: skip


def serials_of(mooring: Design) -> tuple[str, ...]:
    """Return the serial number of each deployed clamp and piece; empty if unknown."""
    file = mooring.file
    deployed = {} if file.deployed is None else file.deployed.serials
    given = {label: ", ".join(serials) for label, serials in deployed.items()}
    parts = [(one.label, one.serial) for one in clamps_down(file.pieces)]
    parts += [(one.label, one.serial) for one in file.pieces]
    return tuple(str(given.get(label) or serial or "") for label, serial in parts)


def without(measured: MooringMeasurements, labels: Sequence[str]) -> MooringMeasurements:
    """Return the measurements without the sensors that have the given labels."""
    kept = [i for i, label in enumerate(measured.label) if label not in labels]
    return replace(
        measured,
        label=tuple(measured.label[i] for i in kept),
        point=measured.point[kept],
        depth=measured.depth[:, kept],
    )


@dataclass(frozen=True)
class Clock:
    """Clock error of an instrument, which grows linearly from zero."""

    since: np.datetime64  # time at which the clock was set
    checked: np.datetime64  # time at which the clock was compared with the true time
    late: float  # lag of the clock at the time `checked` [s]; positive if the clock was behind

    def true_times(self, time: NDArray[np.datetime64]) -> NDArray[np.datetime64]:
        """Correct the times (n,) of readings for the error of the clock."""
        share = (time - self.since) / (self.checked - self.since)
        late = np.round(self.late * 1e9 * np.maximum(share, 0.0)).astype("m8[ns]")
        return np.asarray(time + late)

    @property
    def sentence(self) -> str:
        """Sentence that describes the clock error."""
        sign = "behind" if self.late > 0.0 else "ahead"
        when = np.datetime_as_string(self.checked, "m")
        return f"its clock was {abs(self.late):g} s {sign} at {when}; its times were corrected"


def clocks_of(mooring: Design, first: np.datetime64) -> dict[str, Clock]:
    """Return the measured clock errors of the deployed instruments, by label.

    If the deployment has no date, the errors grow from zero at the time `first`.
    """
    deployed = mooring.file.deployed
    found = {}
    for item in () if deployed is None else deployed.items:
        if item.clock is None or deployed is None:
            continue
        since = first if deployed.date is None else parse_time(deployed.date)
        checked = parse_time(item.clock.checked)
        if checked <= since:
            raise UsageError(
                f"deployed: the clock of `{item.label}` was checked at {item.clock.checked}, which "
                "is not after the deployment"
            )
        found[item.label] = Clock(since, checked, item.clock.late)
    return found


def currents_on_line(
    one: CurrentMeasurements, path: Path, line: LinePlaces, seabed: float
) -> tuple[CurrentMeasurements, list[str]]:
    """Match the instruments of a current file to the line by serial number or nominal depth.

    The levels of matched instruments get the labels of parts of the line and move with the line.
    Also return notes.
    """
    if any(one.label) or path.is_dir() or not cf_files.holds_arrays(path):
        return one, []
    with cf_files.opened(path) as dataset:
        levels = one.u.shape[1]
        sized = [str(dim) for dim, size in dataset.sizes.items() if size == levels]
        along: Sequence[str | None] = sized if levels > 1 else [None]
        each_way = [who_along(dataset, dim, seabed, path.name) for dim in along]
    who = next((who for who in each_way if any(each.serial or each.label for each in who)), [])
    if len(who) != levels:
        return one, []
    place = np.array([each.nominal for each in who])
    own = np.nanmedian(np.where(np.isfinite(one.depth), one.depth, np.nan), axis=0)
    if not np.nanmax(np.abs(own - place), initial=0.0) < CERTAIN:
        return one, []
    try:
        points, sentences = points_of(who, line)
    except UsageError:
        return one, []
    label = tuple(line.label[points[i]] if i in points else "" for i in range(levels))
    on_line = np.array([bool(each) for each in label])
    moved = replace(one, label=label, depth=np.where(on_line, np.nan, one.depth))
    named = ", ".join(filter(None, label))
    return moved, [
        *sentences,
        f"{one.source}: the currents of {named} are used at estimated depths, which move with the "
        "line, not at nominal depths",
    ]


CERTAIN = 2.0  # a match is unique if the second-best order of sensors costs this much more [m]


def matched_by_place(
    given: Sequence[Identity], line: LinePlaces, places: Sequence[int]
) -> tuple[dict[int, int], list[str]]:
    """Match sensors to instruments by nominal depth, in order down the line.

    `places` are the points that are instruments. Return the point for each sensor index, and notes.
    Raise UsageError if a nominal depth is missing, if there are more sensors than instruments, or
    if the match is ambiguous.
    """
    lacking = [one.named for one in given if not np.isfinite(one.nominal)]
    if lacking:
        raise UsageError(f"--match: no nominal height or depth is given for {', '.join(lacking)}")
    if len(given) > len(places):
        raise UsageError(
            f"--match: there are {len(given)} sensors, but the line has {len(places)} instruments"
        )
    try:
        points, _ = in_order(given, line, places, 1.0, 0.0, CERTAIN)
    except UsageError as error:
        raise UsageError(f"--match: {error}") from None
    return points, [
        f"the sensor at {given[i].nominal:.1f} m in {given[i].source} matches `{line.label[at]}`"
        for i, at in points.items()
    ]


CLEAR = 10.0  # a match is unique if the second-best order of instruments costs this much more [m]


def points_of(series: Sequence[Identity], line: LinePlaces) -> tuple[dict[int, int], list[str]]:
    """Match series to points by label, serial number or nominal depth.

    A series without a label or a matching serial number is matched by nominal depth, in order down
    the line. Return the point for each index of a matched series, and notes. Raise UsageError if no
    series matches a point, or if the match by nominal depth is ambiguous.
    """
    who = [(one.label, one.serial, one.nominal, one.source) for one in series]
    first = [who.index(one) for one in who]  # the bins of a profiler are one instrument
    found, sentences, lost, placed = dict[int, int](), list[str](), list[str](), list[int]()
    for i in sorted(set(first)):
        at = named_point(series[i], line)
        if at is not None:
            found[i] = at
        elif not series[i].label and np.isfinite(series[i].nominal):
            placed.append(i)
        else:
            lost.append(_nowhere(series[i], line))
    if placed:
        taken, parts = {*found.values()}, range(line.clamps or len(line.label))
        free = [at for at in parts if at not in taken]
        order, left = in_order([series[i] for i in placed], line, free, 0.01, 1.0, CLEAR)
        order = {placed[i]: at for i, at in order.items()}
        found |= order
        lost += [
            f"{series[placed[i]].named}, with a nominal depth of {series[placed[i]].nominal:.0f} "
            f"m, matches no part of {line.name}"
            for i in left
        ]
        each = [f"{series[i].named} to `{line.label[at]}`" for i, at in sorted(order.items())]
        if each:
            sentences.append(f"matched by nominal depth, from the top down: {'; '.join(each)}")
    if not found:
        raise UsageError(
            "no instrument matches a part of the line: " + "; ".join(lost[:8])
            + "; if a file holds one instrument, name its part with LABEL=FILE"
        )  # fmt: skip
    return {i: found[one] for i, one in enumerate(first) if one in found}, sentences + lost


def named_point(one: Identity, line: LinePlaces) -> int | None:
    """Return the only point with the label of an instrument, or else with its serial number."""
    at = _index(one.label, line.label)
    if at is None:
        at = _index(one.serial.lstrip("0"), [serial.lstrip("0") for serial in line.serial])
    return at


def _index(text: str, among: Sequence[str]) -> int | None:
    for written in (str, str.casefold):
        known = [written(one) for one in among]
        if text and known.count(written(text)) == 1:
            return known.index(written(text))
    return None


def _nowhere(one: Identity, line: LinePlaces) -> str:
    name = one.label or one.serial
    if not name:
        return f"{one.named} has no label, serial number or nominal depth"
    near = nearest(name, line.label)
    hint = f"; did you mean `{near}`?" if near else ""
    return f"`{name}` of {one.source} matches no part of {line.name}{hint}"


def in_order(
    series: Sequence[Identity], line: LinePlaces, points: Sequence[int],
    depths: float, spacings: float, clear: float,
) -> tuple[dict[int, int], list[int]]:  # fmt: skip
    """Match series to points by nominal depth, in order down the line.

    Return the index of the point for each index of a matched series, and the indices of unmatched
    series. Series are unmatched only if there are more series than points. Raise UsageError unless
    the second-best match costs at least `clear` more.

    Parameters
    ----------
    depths : cost of each metre between nominal depth and depth of the point
    spacings : cost of each metre between the nominal and the actual distance of two neighbours
    """
    down = sorted(points, key=lambda at: line.still[at])
    rows = sorted(range(len(series)), key=lambda i: series[i].nominal)
    one, other = np.array([series[i].nominal for i in rows]), line.still[down]
    few, many = (one, other) if len(one) <= len(other) else (other, one)
    if not len(few):
        return {}, rows
    best, second = aligned(few, many, depths, spacings)
    if second is not None and second[0] - best[0] < clear:
        differs = next(k for k in range(len(few)) if best[1][k] != second[1][k])
        row, may_be = best[1][differs], "more than one part of the line"
        if few is one:
            row = differs
            may_be = " or ".join(f"`{line.label[down[match[1][row]]]}`" for match in (best, second))
        raise UsageError(
            f"{series[rows[row]].named}, with a nominal depth of {one[row]:.0f} m, could be "
            f"{may_be}, because the mooring file contains neither the label nor the serial number "
            "of this instrument. Set serial numbers in the mooring file, or name the part of each "
            "file with LABEL=FILE"
        )
    pairs = enumerate(best[1]) if few is one else ((j, i) for i, j in enumerate(best[1]))
    found = {rows[row]: down[at] for row, at in pairs}
    return found, [i for i in rows if i not in found]


def aligned(
    few: Floats, many: Floats, depths: float, spacings: float
) -> tuple[tuple[float, list[int]], tuple[float, list[int]] | None]:
    """Find the cheapest and the second-cheapest way to match each of `few` depths to one of `many`.

    Depths [m] increase, and matches preserve their order. Costs are as in `in_order`. A match is
    its cost and a list of indices in `many`. The second match is None if only one match is
    possible.
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
