"""What a batch result says of a mooring: its distributions, its limits, its extremes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import hypot
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from calm.batch.statistics.distribution import Distribution, distribution_of, envelope_of
from calm.batch.statistics.extremes import Fit, Refusal, return_levels, years_of
from calm.batch.statistics.judgement import RuleShare, shares_of
from calm.batch.statistics.limits import NOT_JUDGED, limits_of, top_offset
from calm.batch.statistics.series import Column, Series, Times
from calm.case import Mooring

if TYPE_CHECKING:
    from xarray import Dataset

WORST = 20
"""Profiles listed as the worst of a response."""

SOURCE = ("currents", "notes", "input_sha256")
"""Attributes of a result that a summary repeats: the record, the rules that were applied to it,
and the hash of all that the result was computed from."""

_GAPS = frozenset({"no-current", "levels-coincide"})


@dataclass(frozen=True)
class Part:
    """A component or a clamp: its distributions, None where nothing is known."""

    label: str
    clamped: bool
    knockdown: Distribution | None
    tilt: Distribution | None
    tension: Distribution | None


@dataclass(frozen=True)
class Response:
    """What is followed of the line as a whole, by its name in `RESPONSES`.

    Attributes
    ----------
    distribution : None where nothing is known
    begin, low, high : when each interval of time begins, its least and its greatest value, NaN
        where all of it is unknown
    return_levels : by GEV and by POT
    """

    name: str
    distribution: Distribution | None
    begin: Times
    low: Column
    high: Column
    return_levels: tuple[Fit | Refusal, Fit | Refusal]


@dataclass(frozen=True)
class Profile:
    """One profile and its responses; `leaning` is what tilts most."""

    time: np.datetime64
    knockdown: float
    anchor_tension: float
    tilt: float
    offset: float
    leaning: str


@dataclass(frozen=True)
class Summary:
    """All that is said of a batch result.

    Attributes
    ----------
    name : of the mooring
    count, solved : profiles, and those with an equilibrium
    without_equilibrium : profiles with a current in which the line does not stand
    statuses : profiles by status
    begin, end : times of the first and the last profile
    years : that the solved profiles stand for
    parts : the components in the order of the file, then the clamps
    responses : of `RESPONSES`
    worst : by the names in `RANKED`, the worst first
    rules : that can be judged in every profile
    not_judged : why others are not, by their names
    source : what the result says of where it comes from, by the names in `SOURCE`
    """

    name: str
    count: int
    solved: int
    without_equilibrium: int
    statuses: Mapping[str, int]
    begin: np.datetime64
    end: np.datetime64
    years: float
    parts: tuple[Part, ...]
    responses: tuple[Response, ...]
    worst: Mapping[str, tuple[Profile, ...]]
    rules: tuple[RuleShare, ...]
    not_judged: Mapping[str, str]
    source: Mapping[str, str]


def summarize(dataset: Dataset, mooring: Mooring, folder: Path | None = None) -> Summary:
    """Gather what a finished result says.

    Parameters
    ----------
    dataset : the result, opened without loading it
    mooring : that it was solved for: its limits are judged
    folder : for a temporary file of the size of the result without compression; the system's
        unless given

    Profiles that were not solved are left out, and counted. All shares are of profiles: shares of
    time where the record is even.

    Raises
    ------
    UsageError
        There is no room for the temporary file.
    """
    with Series(dataset, folder) as series:
        solved = int(np.count_nonzero(series.status == 0))
        statuses = _statuses(series)
        responses, worst = _responses(series)
        without_current = sum(count for name, count in statuses.items() if name in _GAPS)
        return Summary(
            name=mooring.file.name,
            count=len(series),
            solved=solved,
            without_equilibrium=len(series) - solved - without_current,
            statuses=statuses,
            begin=series.time[0],
            end=series.time[-1],
            years=years_of(series.time, solved),
            parts=tuple(_parts(series)),
            responses=responses,
            worst=worst,
            rules=tuple(shares_of(series, limits_of(mooring), solved)),
            not_judged=NOT_JUDGED,
            source={name: str(dataset.attrs[name]) for name in SOURCE if name in dataset.attrs},
        )


def _parts(series: Series) -> Iterator[Part]:
    def of(values: Column) -> Distribution | None:
        return distribution_of(values, series.time)

    for label in (*series.component_label, *series.clamp_label):
        yield Part(
            label,
            label in series.clamp_label,
            of(series.knockdown(label)),
            of(series.tilt(label)),
            of(series.tension(label)),
        )


def _top_knockdown(series: Series) -> Column:
    return series.column("knockdown", 0)


def _anchor_tension(series: Series) -> Column:
    return series.column("tension_top", -1)


def _greatest_tilt(series: Series) -> Column:
    greatest = np.full(len(series), np.nan, np.float32)
    for label in (*series.component_label, *series.clamp_label):
        np.fmax(greatest, series.tilt(label), out=greatest)
    return greatest


RESPONSES: Mapping[str, Callable[[Series], Column]] = {
    "knockdown": _top_knockdown,
    "anchor_tension": _anchor_tension,
    "tilt": _greatest_tilt,
    "offset": top_offset,
}
"""Knockdown of the top, tension at the anchor, greatest tilt of any part, offset of the top."""

RANKED = ("knockdown", "anchor_tension", "tilt")
"""The responses by which the worst profiles are told."""


def _responses(
    series: Series,
) -> tuple[tuple[Response, ...], Mapping[str, tuple[Profile, ...]]]:
    """One response in memory at a time."""
    responses, worst = [], {}
    for name, of in RESPONSES.items():
        values = of(series)
        responses.append(
            Response(
                name,
                distribution_of(values, series.time),
                *envelope_of(values, series.time),
                return_levels(series.time, values),
            )
        )
        if name in RANKED:
            worst[name] = tuple(_profile(series, one) for one in _greatest(values))
    return tuple(responses), worst


def _greatest(values: Column) -> list[int]:
    """Indices of the `WORST` greatest values, of like ones the first before the later."""
    known = values[np.isfinite(values)]
    least = -np.inf
    if len(known) > WORST:
        known.partition(len(known) - WORST)
        least = known[len(known) - WORST]
    reached = np.flatnonzero(values >= least)
    order = np.argsort(-values[reached], kind="stable")[:WORST]
    return [int(index) for index in reached[order]]


def _profile(series: Series, index: int) -> Profile:
    tilts = np.concatenate([series.at("tilt", index), series.at("clamp_tilt", index)])
    most = int(np.nanargmax(tilts))
    return Profile(
        time=series.time[index],
        knockdown=float(series.at("knockdown", index)[0]),
        anchor_tension=float(series.at("tension_top", index)[-1]),
        tilt=float(tilts[most]),
        offset=hypot(series.at("x_top", index)[0], series.at("y_top", index)[0]),
        leaning=(*series.component_label, *series.clamp_label)[most],
    )


def _statuses(series: Series) -> Mapping[str, int]:
    """Profiles by the meaning of their status, those that occur."""
    attributes = series.dataset["status"].attrs
    meanings = dict(
        zip(
            np.atleast_1d(attributes["flag_values"]).tolist(),
            attributes["flag_meanings"].split(),
            strict=True,
        )
    )
    values, counts = np.unique(series.status, return_counts=True)
    return {
        meanings[value]: count
        for value, count in zip(values.tolist(), counts.tolist(), strict=True)
    }
