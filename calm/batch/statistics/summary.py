"""Summary of a batch result: distributions, limits and extremes for a mooring."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import hypot, nan
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.batch.statistics import limits
from calm.batch.statistics.extremes import Fit, LevelsRefused, median_step, return_levels, years_of
from calm.batch.statistics.series import Column, LegColumns, PartNumber, ResultColumns, Times
from calm.batch.statuses import Ending, endings
from calm.case import Design
from calm.case.profilers import profilers_in
from calm.checks.criterion import limits_used
from calm.checks.posture import reaches_the_surface
from calm.files import Profiler
from calm.files.check_limits import LimitKey
from calm.physics.seawater import MID_LATITUDE, pressure_at

if TYPE_CHECKING:
    from xarray import Dataset

WORST = 20
"""Number of worst profiles listed for a response."""

SOURCE = ("currents", "notes", "input_sha256")
"""Attributes that a summary copies from a result: the record, the rules applied to the record, and
the hash of the complete input.
"""


@dataclass(frozen=True)
class PartDistributions:
    """Distributions of the quantities of a component or a clamp; None for a quantity without
    values.
    """

    label: str
    clamped: bool
    knockdown: Distribution | None
    tilt: Distribution | None
    tension: Distribution | None


@dataclass(frozen=True)
class StopDepths:
    """Depths [m] and pressures [dbar] of a profiler's stop, at the percentiles `STOP_SHARES`."""

    profiler: str
    stop: str
    depths: tuple[float, ...]
    pressures: tuple[float, ...]


STOP_SHARES = (1.0, 50.0, 99.0)
"""Percentiles at which the depth of a profiler's stop is reported."""


@dataclass(frozen=True)
class Response:
    """Statistics of one of the `RESPONSES`, which are quantities of the whole line.

    Attributes
    ----------
    distribution : distribution over the profiles; None if there are no values
    begin : start of each time interval in the plot
    low, high : minimum and maximum in each interval; NaN if the interval has no values
    return_levels : return levels by GEV and by POT
    """

    name: str
    distribution: Distribution | None
    begin: Times
    low: Column
    high: Column
    return_levels: tuple[Fit | LevelsRefused, Fit | LevelsRefused]


@dataclass(frozen=True)
class WorstProfile:
    """Responses of one of the worst profiles. `leaning` is the label of the part with the largest
    tilt.
    """

    time: np.datetime64
    knockdown: float
    anchor_tension: float
    tilt: float
    offset: float
    leaning: str


@dataclass(frozen=True)
class Summary:
    """Content of the report on a batch result.

    Attributes
    ----------
    count : number of profiles
    endings, statuses : number of profiles by category of status, and by status
    begin, end : times of the first and the last profile
    years : years represented by the solved profiles
    parts : the components in the order of the file, then the clamps
    worst : worst profiles, the worst first, for each response in `RANKED`
    rules : the equilibrium rule, and the rules that can be evaluated in every profile
    not_judged : reason why each remaining rule is not evaluated
    source : attributes of the result named in `SOURCE`
    read : descriptions of the input files of the result
    stops : stops of the profilers, down the line
    """

    name: str
    count: int
    endings: Mapping[Ending, int]
    statuses: Mapping[str, int]
    begin: np.datetime64
    end: np.datetime64
    years: float
    parts: tuple[PartDistributions, ...]
    responses: tuple[Response, ...]
    worst: Mapping[str, tuple[WorstProfile, ...]]
    rules: tuple[limits.RuleShare, ...]
    not_judged: Mapping[str, str]
    source: Mapping[str, str]
    read: Sequence[Mapping[str, Any]]
    limits_used: tuple[LimitKey, ...] = ()
    stops: tuple[StopDepths, ...] = ()

    @property
    def known_responses(self) -> Sequence[Response]:
        """Responses with a value in at least one profile, or all responses if no response has a
        value.

        Most nets, for example, have no offset.
        """
        return [one for one in self.responses if one.distribution is not None] or self.responses

    @property
    def solved(self) -> int:
        """Number of solved profiles, on which all statistics are based."""
        return self.endings[Ending.SOLVED]

    @property
    def unsolved(self) -> int:
        """Number of profiles that have a current but no solution, because no solution exists or
        none was found.
        """
        return self.count - self.solved - self.endings[Ending.NO_DATA]


def summarize(
    dataset: Dataset,
    mooring: Design,
    folder: Path | None = None,
    source: Path = Path("the result"),
) -> Summary:
    """Build the summary of a finished result.

    Statistics exclude unsolved profiles. Memory use is about 35 bytes per profile.

    Parameters
    ----------
    dataset : the result, opened without loading it
    mooring : mooring of the result, whose limits are evaluated
    folder : folder for a temporary file of the size of the uncompressed result; by default the
        temporary folder of the system
    source : the file of the result, for messages

    Raises
    ------
    UsageError
        The dataset is not a result of `calm batch` or cannot be read, or the disk space is too
        small.
    """
    with ResultColumns(dataset, folder, source) as series:
        ended = endings(series.statuses)
        equilibrium = limits.equilibrium_share(ended)
        unsolved = ended[Ending.NO_EQUILIBRIUM] + ended[Ending.NOT_CONVERGED]
        step = median_step(series.time)
        responses, worst = _responses(series, _columns_of(series, mooring), step)
        return Summary(
            name=mooring.file.name,
            count=len(series),
            endings=ended,
            statuses=series.statuses,
            begin=series.time[0],
            end=series.time[-1],
            years=years_of(step, ended[Ending.SOLVED]),
            parts=tuple(_parts(series)),
            responses=responses,
            worst=worst,
            rules=(equilibrium, *limits.shares_of(series, limits.limits_of(mooring), unsolved)),
            not_judged=limits.NOT_JUDGED,
            source={name: str(dataset.attrs[name]) for name in SOURCE if name in dataset.attrs},
            read=json.loads(dataset.attrs.get("read", "[]")),
            limits_used=tuple(
                dict.fromkeys(
                    key
                    for leg in mooring.typed_legs
                    for key in limits_used(leg.file, reaches_the_surface(leg))
                )
            ),
            stops=tuple(_stops(series, mooring)),
        )


def _parts(series: ResultColumns) -> Iterator[PartDistributions]:
    def of(values: Column) -> Distribution | None:
        return distribution_of(values, series.time)

    for part in series.parts:
        yield PartDistributions(
            series.label(part),
            part.clamped,
            of(series.of_part("knockdown", part)),
            of(series.of_part("tilt", part)),
            of(series.greatest_tension([part])),
        )


def _stops(series: ResultColumns, mooring: Design) -> Iterator[StopDepths]:
    parts = {series.label(part): part for part in series.parts}
    position = mooring.file.environment.position or mooring.file.position
    latitude = MID_LATITUDE if position is None else position.latitude
    for profiler in (one for leg in mooring.legs for one in profilers_in(leg)):
        assert isinstance(profiler.component, Profiler)
        for stop, label in zip(("upper", "lower"), profiler.component.between or (), strict=True):
            part = parts[label]
            # a rigid upper stop ends where the next piece begins
            if stop == "upper" and not part.clamped:
                part = PartNumber(part.number + 1)
            depths = np.nanpercentile(series.depth(part), STOP_SHARES)
            pressures = pressure_at(depths, latitude)
            yield StopDepths(
                profiler.label, stop, tuple(depths.tolist()), tuple(pressures.tolist())
            )


def _greatest_tilt(series: ResultColumns) -> Column:
    greatest = np.full(len(series), np.nan, np.float32)
    for part in series.parts:
        np.fmax(greatest, series.of_part("tilt", part), out=greatest)
    return greatest


RESPONSES: Mapping[str, Callable[[ResultColumns], Column]] = {
    "knockdown": limits.top_knockdown,
    "anchor_tension": lambda series: series.column("tension_top", -1),
    "tilt": _greatest_tilt,
    "offset": limits.top_offset,
}
"""Responses of the line: knockdown of the top, tension at the anchor, largest tilt of any part,
offset of the top.
"""

RANKED = ("knockdown", "anchor_tension", "tilt")
"""Responses for which the worst profiles are listed."""


_LegColumns = Mapping[str, Sequence[ResultColumns]]
"""For each response, the columns of a line or of the legs of a net. The response of a net is the
maximum over the legs.
"""


def _columns_of(series: ResultColumns, mooring: Design) -> _LegColumns:
    """Select the columns from which each response is computed.

    For a net, these are the columns of the legs with a free end or an anchor.
    """
    if not mooring.several:
        return dict.fromkeys(RESPONSES, (series,))
    keys, columns = mooring.file.legs, LegColumns.of_file(mooring.file)
    legs = [series.of_leg(each) for each in columns]
    free = [leg for one, leg in zip(keys, legs, strict=True) if one.top.free]
    anchored = [leg for one, leg in zip(keys, legs, strict=True) if one.bottom.anchor is not None]
    both = [leg for leg in free if leg in anchored]
    return {"knockdown": free, "anchor_tension": anchored, "tilt": [series], "offset": both}


def _responses(
    series: ResultColumns, legs: _LegColumns, step: np.timedelta64
) -> tuple[tuple[Response, ...], Mapping[str, tuple[WorstProfile, ...]]]:
    responses, worst = [], {}
    for name, of in RESPONSES.items():
        # only the values of one response are in memory at a time
        values = np.full(len(series), np.nan, np.float32)
        for leg in legs[name]:
            np.fmax(values, of(leg), out=values)
        responses.append(
            Response(
                name,
                distribution_of(values, series.time),
                *envelope_of(values, series.time),
                return_levels(series.time, values, series.statuses, step),
            )
        )
        if name in RANKED:
            worst[name] = tuple(_profile(series, legs, one) for one in _greatest(values))
    return tuple(responses), worst


def _greatest(values: Column) -> list[int]:
    known = values[np.isfinite(values)]
    if not len(known):
        return []
    least = known.min()
    if len(known) > WORST:
        known.partition(len(known) - WORST)
        least = known[len(known) - WORST]
    above = np.flatnonzero(values > least)  # fewer than `WORST`, even if many are equal
    above = above[np.argsort(-values[above], kind="stable")]
    ties = np.flatnonzero(values == least)[: WORST - len(above)]
    return [int(index) for index in (*above, *ties)]


def _profile(series: ResultColumns, legs: _LegColumns, index: int) -> WorstProfile:
    def greatest(name: str, of: Callable[[ResultColumns], float]) -> float:
        return float(max((of(leg) for leg in legs[name]), default=nan))

    def across(leg: ResultColumns, name: str) -> float:
        ends = leg.at(name, index)
        return float(ends[0] - ends[-1])

    tilts = np.concatenate([series.at("tilt", index), series.at("clamp_tilt", index)])
    most = int(np.nanargmax(tilts))
    return WorstProfile(
        time=series.time[index],
        knockdown=greatest("knockdown", lambda leg: leg.at("knockdown", index)[0]),
        anchor_tension=greatest("anchor_tension", lambda leg: leg.at("tension_top", index)[-1]),
        tilt=float(tilts[most]),
        offset=greatest("offset", lambda leg: hypot(across(leg, "x_top"), across(leg, "y_top"))),
        leaning=series.label(series.parts[most]),
    )


Floats = NDArray[np.float64]

PERCENTILES = (50.0, 90.0, 99.0, 99.9)

SHARES = np.geomspace(1.0, 1e-7, 57)
"""Fractions of the profiles at the points of an exceedance curve, eight per decade."""

MOST_INTERVALS = 1000
"""Largest number of time intervals in the drawing of a series."""


@dataclass(frozen=True)
class Distribution:
    """Distribution of a quantity over the n profiles that have a value.

    Attributes
    ----------
    percentiles : values at `PERCENTILES`; the p quantile has the rank 1 + (n - 1) p (definition 7
        of Hyndman and Fan 1996)
    maximum, time : the maximum, and its first time
    share, value : points of the exceedance curve; in a fraction `share` of the profiles, the
        quantity reaches or exceeds `value`. The shares are 1/n, and all `SHARES` above 1/n
    """

    count: int
    mean: float
    percentiles: tuple[float, ...]
    maximum: float
    time: np.datetime64
    share: Floats
    value: Floats


def distribution_of(values: Column, time: Times) -> Distribution | None:
    """Compute the distribution of the values that are not NaN; return None if all (n,) values are
    NaN.
    """
    known = values[np.isfinite(values)]
    known.sort()
    count = len(known)
    if not count:
        return None
    greatest = int(np.argmax(values == known[-1]))  # the first of equal values
    share = np.append(SHARES[SHARES * count > 1.0], 1.0 / count)
    rank = (count - 1) * np.concatenate([np.array(PERCENTILES) / 100.0, 1.0 - share])
    rank[-1] = count - 1  # the rarest value is the maximum
    below = np.floor(rank).astype(np.int64)
    above = np.minimum(below + 1, count - 1)
    low, high = known[below].astype(np.float64), known[above].astype(np.float64)
    quantiles = low + (rank - below) * (high - low)
    return Distribution(
        count=count,
        mean=float(known.mean(dtype=np.float64)),
        percentiles=tuple(quantiles[: len(PERCENTILES)].tolist()),
        maximum=float(known[-1]),
        time=time[greatest],
        share=share,
        value=quantiles[len(PERCENTILES) :],
    )


def envelope_of(values: Column, time: Times) -> tuple[Times, Column, Column]:
    """Divide the record into `MOST_INTERVALS` intervals with equal numbers of profiles.

    If the record has fewer profiles, each profile is an interval. Return the start time, the
    minimum and the maximum of each interval.
    """
    count = min(len(values), MOST_INTERVALS)
    begin = np.unique(np.linspace(0, len(values), count, endpoint=False).astype(np.int64))
    return time[begin], np.fmin.reduceat(values, begin), np.fmax.reduceat(values, begin)
