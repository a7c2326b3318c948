"""Series of the instruments of a mooring: temperature, salinity, velocity over time.

A file holds several instruments along a dimension, as `calm motion` takes them, or one, as archives
keep them (OceanSITES, IMOS). Who an instrument is, its file says by a label, a serial number or a
nominal place.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem, UsageError
from calm.physics.line import Floats
from calm.quantities import QUANTITIES_MEASURED, MeasuredQuantity
from calm.records import cf_files, velocity
from calm.records.card import ReadCard, VariableSummary, said_of, texts_in
from calm.records.cf_files import UnreadableError, factor_of, first_present, known_values
from calm.records.level_depths import find_levels

if TYPE_CHECKING:
    import xarray as xr

_ENDINGS = (".nc", ".cnv", ".use", ".microcat", ".rcm")
_SAID = ", ".join(_ENDINGS)

INTERPOLATED = 8
"""The flag of what was interpolated, which is no measurement."""

_SERIALS = (
    "serial", "serial_number", "SERIAL", "instrument_serial", "instrument_serial_number",
    "sensor_serial_number",
)  # fmt: skip
_ONE_PLACE = ("instrument_nominal_depth", "nominal_depth", "sensor_depth")


@dataclass(frozen=True)
class Identity:
    """Tell who an instrument is, as its file says.

    Attributes
    ----------
    label, serial : empty where its file does not say
    nominal : its nominal depth [m]; NaN where its file does not say
    source : name of its file
    """

    label: str
    serial: str
    nominal: float
    source: str

    @property
    def known(self) -> bool:
        """Return whether its file says anything of it."""
        return bool(self.label or self.serial) or np.isfinite(self.nominal)

    @property
    def named(self) -> str:
        """Return what a person calls it."""
        return self.label or self.serial or self.source


@dataclass(frozen=True)
class InstrumentSeries(Identity):
    """Hold what one instrument measured of one quantity.

    Attributes
    ----------
    time : (n,) to the nanosecond, rising
    value : (n,) in the unit of its quantity; NaN where not measured, or the flag is not wanted
    dropped : readings that were left out for their flag
    below : depth of what is measured below the instrument, a profiler's [m]
    note : what a person should know before trusting it
    card : what was read from its file
    """

    time: NDArray[np.datetime64]
    value: Floats
    dropped: int = 0
    below: float = 0.0
    note: str = ""
    card: ReadCard | None = None


def read_series(
    given: Sequence[str], names: Sequence[str], flags: frozenset[int], seabed: float
) -> dict[str, list[InstrumentSeries]]:
    """Return what files hold of some quantities, by the name of these.

    Parameters
    ----------
    given : a path each, or ``LABEL=PATH`` of a file of one instrument, or a folder of such files
    names : of `QUANTITIES_MEASURED`
    flags : quality flags of what counts as measured, where there are any; 8 never does
    seabed : depth of the water, for nominal heights above it [m]; NaN where not known

    Raises
    ------
    InputError
        A file is none, cannot be read, or has none of the quantities, or one without its unit.
    UsageError
        A label is given for a file of several instruments.
    """
    found: dict[str, list[InstrumentSeries]] = {name: [] for name in names}
    problems: list[Problem] = []
    for label, path in files_given(given):
        try:
            mine = _of_file(path, names, flags, seabed)
        except InputError as error:
            problems += error.problems
            continue
        for name, series in mine.items():
            if label and len(series) > len({one.below for one in series}):
                raise UsageError(f"{path} holds {len(series)} instruments; `{label}=` names one")
            found[name] += [replace(one, label=label or one.label) for one in series]
    if problems:
        raise InputError(problems)
    return found


def files_given(given: Sequence[str]) -> list[tuple[str, Path]]:
    """Return the files of some arguments, each with the label that is given for it, or ``""``.

    InputError: there is no such file, or a folder has no NetCDF files.
    """
    found: list[tuple[str, Path]] = []
    problems = []
    for text in given:
        label, path = split_label(text)
        inside = [path]
        if path.is_dir() and not cf_files.is_zarr(path):
            inside = sorted(one for one in path.iterdir() if one.suffix in _ENDINGS)
        if not path.exists():
            problems.append(Problem(str(path), 0, 0, "no such file"))
        elif not inside:
            problems.append(Problem(str(path), 0, 0, f"the folder has no files in {_SAID}"))
        else:
            found += [(label, one) for one in inside]
    if problems:
        raise InputError(problems)
    return found


def split_label(text: str) -> tuple[str, Path]:
    """Return label and path of ``LABEL=PATH``; an empty label of a path alone."""
    label, equals, path = text.partition("=")
    if equals and not Path(text).exists():
        return label.strip(), Path(path)
    return "", Path(text)


def _of_file(
    path: Path, names: Sequence[str], flags: frozenset[int], seabed: float
) -> dict[str, list[InstrumentSeries]]:
    with cf_files.opened(path) as dataset:
        file = _SeriesFile(velocity.with_components(dataset), path.name, flags, seabed)
        found = {name: series for name in names if (series := file.series(name))}
        if not found:
            raise UnreadableError(f"holds no {' or '.join(names)}")
    return found


@dataclass(frozen=True)
class _SeriesFile:
    """A dataset of instruments, the name of its file, and how it is read; see `read_series`."""

    dataset: xr.Dataset
    name: str
    flags: frozenset[int]
    seabed: float

    def series(self, name: str) -> list[InstrumentSeries]:
        """Return what the instruments measured of a quantity; nothing where they did not."""
        dataset, quantity = self.dataset, QUANTITIES_MEASURED[name]
        moving = quantity.dimension == "speed"
        current = self._velocity(quantity) if moving else None
        variables: Sequence[str] = current.names if current else ()
        if not moving:
            variables = named(dataset, quantity.sought, quantity.usual)[:1]
        if not variables:
            return []
        found = readings(dataset, variables, self.flags)
        first, values = dataset[variables[0]], found.values
        if current is not None:
            dimensions = ("speed", "speed" if current.turn is None else "angle")
            pairs = zip(variables, dimensions, strict=True)
            factors = (factor_of(dataset[one], dimension) for one, dimension in pairs)
            parts = (each * factor for each, factor in zip(values, factors, strict=True))
            value = current.components(*parts)[0 if name == "u" else 1]
        elif name == "temperature":
            value = values[0] - cf_files.celsius_zero(first)
        else:
            cf_files.refuse_other_salinity(first)
            value = values[0]
        value = np.where(found.dropped, np.nan, value)
        who = who_along(dataset, found.along, self.seabed, self.name)
        below = np.zeros(len(who))
        if found.along is not None and not any(one.known for one in who):
            below = self._bins(found.along, found.axis)
            who = who_along(dataset, None, self.seabed, self.name) * len(who)
        each = found.series(value, who)
        return [replace(one, below=float(deep)) for one, deep in zip(each, below, strict=True)]

    def _velocity(self, quantity: MeasuredQuantity) -> velocity.Velocity | None:
        """Return the velocity of the file; None where it has none."""
        try:
            current = velocity.find_velocity(self.dataset, regular=False)
        except UnreadableError:
            sought = quantity.sought
            if first_present(self.dataset, sought) or _standard(self.dataset, sought):
                raise
            return None
        if current.magnetic:
            raise UnreadableError(
                f"`{current.names[-1]}` is relative to magnetic north; turn it to true north "
                "before it is gridded"
            )
        return current

    def _bins(self, along: str, time: str) -> Floats:
        """Return how far the bins of a profiler are below it [m]; nowhere else are they known."""
        levels = find_levels(self.dataset, along, time, self.seabed)
        if levels.instrument is None or time in levels.variable.dims:
            raise UnreadableError(f"`{along}` counts neither instruments nor bins of a profiler")
        return np.asarray(known_values(levels.variable) * levels.factor)


def named(dataset: xr.Dataset, sought: Sequence[str], usual: Sequence[str]) -> list[str]:
    """Return the variables of the first standard name that any has, or else of a usual name.

    UnreadableError: there are several, and none is called as usual.
    """
    there = _standard(dataset, sought)
    known = [one for one in usual if one in (there or dataset.data_vars)]
    if len(there) > 1 and not known:
        standard = dataset[there[0]].attrs["standard_name"]
        raise UnreadableError(f"several variables are {standard}: {', '.join(there)}")
    return known or there


def _standard(dataset: xr.Dataset, sought: Sequence[str]) -> list[str]:
    names = dataset.cf.standard_names
    return next((list(map(str, names[one])) for one in sought if one in names), [])


@dataclass(frozen=True)
class Readings:
    """Hold what variables say of k instruments at n times.

    Attributes
    ----------
    time : (n,) rising
    axis, along : dimension of the times, and of the instruments; None of a single one
    values : (n, k) of each variable, as they stand
    dropped : (n, k) which are left out for the flag of any
    clock : name and unit of the times
    flags : readings that are left out, by the variable of flags
    """

    time: NDArray[np.datetime64]
    axis: str
    along: str | None
    values: list[Floats]
    dropped: NDArray[np.bool_]
    clock: tuple[str, str]
    flags: dict[str, int]

    def series(self, value: Floats, who: Sequence[Identity]) -> list[InstrumentSeries]:
        """Return what each instrument measured, by values (n, k) that were made of these."""
        counts = self.dropped.sum(axis=0).tolist()
        return [
            InstrumentSeries(**vars(one), time=self.time, value=column, dropped=count)
            for one, column, count in zip(who, value.T, counts, strict=True)
        ]


def readings(dataset: xr.Dataset, names: Sequence[str], flags: frozenset[int]) -> Readings:
    """Return the readings of some variables of the same dimensions.

    Parameters
    ----------
    names : of the variables
    flags : of what counts as measured; 8 never does

    Raises
    ------
    UnreadableError
        They have no times, or are not of times and instruments alone.
    """
    first = dataset[names[0]]
    clock = cf_files.find_times(dataset, names[0])
    if clock is None or dataset[clock].ndim != 1:
        raise UnreadableError(f"`{first.name}` has no times")
    velocity.refuse_ragged(dataset, names[0])
    time = str(dataset[clock].dims[0])
    others = [str(dim) for dim, size in first.sizes.items() if dim != time and size > 1]
    if len(others) > 1 or time not in first.dims:
        raise UnreadableError(f"`{first.name}` is not of times and instruments: {first.dims}")
    along = others[0] if others else None
    times = cf_files.read_times(dataset, clock)
    order = np.argsort(times, kind="stable")

    def table(one: xr.DataArray, values: NDArray[Any]) -> NDArray[Any]:
        axes = [str(dim) for dim in one.dims]
        kept = [axis for axis in (time, along) if axis in axes]
        moved = values.transpose(*(axes.index(a) for a in kept),
                                 *(i for i, a in enumerate(axes) if a not in kept))  # fmt: skip
        return moved.reshape(len(moved), -1)[order]

    parts = [table(dataset[name], known_values(dataset[name])) for name in names]
    dropped, removed = np.zeros(parts[0].shape, bool), dict[str, int]()
    for name, values in zip(names, parts, strict=True):
        if (marks := velocity.flag_variable(dataset, name)) is not None:
            given = np.broadcast_to(table(marks, velocity.flags_of(marks)), values.shape)
            bad = ~np.isin(given, sorted(flags - {INTERPOLATED})) & np.isfinite(values)
            removed[str(marks.name)] = int(bad.sum())
            dropped |= bad
    said = clock, str(dataset[clock].attrs.get("units", ""))
    return Readings(times[order], time, along, parts, dropped, said, removed)


def card_of(
    dataset: xr.Dataset, source: str, taken: Mapping[str, str], found: Readings
) -> ReadCard:
    """Return the card of readings.

    Parameters
    ----------
    source : name of the file
    taken : names of the variables, by what each was taken for, in the order of the readings
    """
    summaries = {}
    for (meaning, name), values in zip(taken.items(), found.values, strict=True):
        told = dataset[name].attrs
        unit = str(told.get("units", ""))
        summaries[meaning] = VariableSummary.of(name, unit, values, said_of(told))
    return ReadCard(
        source, texts_in(dataset.attrs), summaries, found.dropped.shape[1], found.time,
        found.clock, found.flags,
    )  # fmt: skip


def who_along(dataset: xr.Dataset, along: str | None, seabed: float, source: str) -> list[Identity]:
    """Return who the instruments along a dimension are.

    Parameters
    ----------
    along : None for the one instrument of a file
    seabed : depth of the water, for heights above it [m]
    source : name of the file
    """
    if along is None:
        single = [str(dim) for dim, size in dataset.sizes.items() if size == 1]
        labels = next(filter(None, (cf_files.labels_along(dataset, dim) for dim in single)), ("",))
        tried = (cf_files.places_along(dataset, dim, seabed) for dim in (None, *single))
        place = next((float(one[0]) for one in tried if one is not None), _number(dataset.attrs))
        known = (_serials(dataset, dims) for dims in ((), *((dim,) for dim in single)))
        told = next((dataset.attrs[name] for name in _SERIALS if name in dataset.attrs), "")
        serial = next(filter(None, known), [str(told).strip()])[0]
        return [Identity(labels[0], serial, place, source)]
    count = dataset.sizes[along]
    labels = cf_files.labels_along(dataset, along) or ("",) * count
    serials = _serials(dataset, (along,)) or [""] * count
    places = cf_files.places_along(dataset, along, seabed)
    nominal = [float("nan")] * count if places is None else places.tolist()
    return [Identity(*one, source) for one in zip(labels, serials, nominal, strict=True)]


def _serials(dataset: xr.Dataset, dims: tuple[str, ...]) -> list[str]:
    """Return the serial numbers over some dimensions; none where the file has none."""
    for name in first_present(dataset, _SERIALS):
        if dataset[name].dims == dims:
            return [text.rstrip("*") for text in cf_files.texts_of(dataset[name])]
    return []


def _number(attributes: Any) -> float:
    for name in _ONE_PLACE:
        try:
            return float(attributes[name])
        except (KeyError, TypeError, ValueError):
            continue
    return float("nan")
