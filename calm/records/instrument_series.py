"""Time series from the instruments of a mooring: temperature, salinity, velocity.

A file holds a single instrument, or several instruments along a dimension. An instrument has a
label, a serial number or a nominal depth.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem, UsageError
from calm.physics.line import Floats
from calm.physics.seawater import pressure_at
from calm.quantities import QUANTITIES_MEASURED, MeasuredQuantity
from calm.records import attributes, cf_files, instrument_text, velocity
from calm.records.card import (
    ReadCard,
    VariableSummary,
    card_of_instruments,
    description_of,
    joined_cards,
    texts_in,
)
from calm.records.cf_files import UnreadableError, factor_of, first_present, known_values
from calm.records.level_depths import find_levels
from calm.records.value_tests import WATER, impossible_values, series_doubts

if TYPE_CHECKING:
    import xarray as xr

_ENDINGS = (".nc", ".cnv", ".use", ".microcat", ".rcm")
_SAID = f"{', '.join(_ENDINGS[:-1])} or {_ENDINGS[-1]}"

INTERPOLATED = 8
"""Quality flag of interpolated values; CALM does not accept these values as measurements."""

_SERIALS = (
    "serial", "serial_number", "SERIAL", "instrument_serial", "instrument_serial_number",
    "sensor_serial_number", "instrument_id",
)  # fmt: skip
_ONE_PLACE = ("instrument_nominal_depth", "nominal_depth", "sensor_depth")


@dataclass(frozen=True)
class Identity:
    """Identity of an instrument, as stated in its file.

    A missing label or serial number is empty. `nominal` is the nominal depth [m], NaN if missing.
    `source` is the file name.
    """

    label: str
    serial: str
    nominal: float
    source: str

    @property
    def known(self) -> bool:
        """True if the file states a label, a serial number or a nominal depth."""
        return bool(self.label or self.serial) or np.isfinite(self.nominal)

    @property
    def named(self) -> str:
        """Label, or else serial number, or else file name of the instrument."""
        return self.label or self.serial or self.source


@dataclass(frozen=True)
class InstrumentSeries(Identity):
    """Time series of a quantity from one instrument.

    Attributes
    ----------
    time : (n,) increasing times
    value : (n,) values in the unit of the quantity; NaN if missing or rejected
    dropped : number of readings rejected by their flags
    below : distance of a profiler's bin below the profiler [m]; 0 for other instruments
    note : doubts and assumptions
    pressure : median pressure in the file [dbar], or NaN
    called : label stated in the file, even if the user gives another label
    """

    time: NDArray[np.datetime64]
    value: Floats
    dropped: int = 0
    below: float = 0.0
    note: str = ""
    card: ReadCard | None = None
    pressure: float = float("nan")
    called: str = ""

    def checked(self, quantity: str, variable: str, notes: Sequence[str] = ()) -> InstrumentSeries:
        """Return the series with impossible values set to NaN and doubts added to `note`.

        `variable` is the name in the file. Raise UnreadableError if most values are impossible for
        sea water.
        """
        value, remarks = self.value, [*notes]
        if quantity in WATER:
            wrong, doubt, most = impossible_values(quantity, value)
            if most:
                raise UnreadableError(f"`{variable}`: {doubt}")
            remarks += [f"`{variable}`: {doubt}"] if doubt else []
            value = np.where(wrong, np.nan, value)
            known = value[np.isfinite(value)]
            if known.size >= _FEWEST and not known.any():
                remarks.append(f"`{variable}`: all {known.size} values are 0 and were excluded")
                value = np.full_like(value, np.nan)
        doubts = series_doubts(value[:, np.newaxis, np.newaxis], self.time)
        remarks += [f"`{variable}`: {doubt}" for doubt in doubts]
        return replace(self, value=value, note="; ".join(filter(None, (self.note, *remarks))))


def read_series(
    given: Sequence[str],
    names: Sequence[str],
    flags: frozenset[int],
    seabed: float,
    usual: Mapping[str, float] = MappingProxyType({}),
) -> dict[str, list[InstrumentSeries]]:
    """Read time series from files; return the series by quantity name.

    Parameters
    ----------
    given : paths of files, ``LABEL=PATH`` for a file of one instrument, or folders
    names : keys of `QUANTITIES_MEASURED`
    flags : accepted quality flags; flag 8 is never accepted
    seabed : water depth [m], to convert heights above the seabed; NaN if unknown
    usual : depth [m] by label, for files with neither pressures nor a nominal depth

    Raises
    ------
    InputError
        A file is missing or unreadable, has none of the quantities, or lacks a unit.
    UsageError
        A label is given for a file of several instruments.
    """
    found: dict[str, list[InstrumentSeries]] = {name: [] for name in names}
    problems: list[Problem] = []
    for label, path in files_given(given):
        try:
            mine = _of_file(path, names, flags, seabed, usual.get(label, np.nan))
        except InputError as error:
            problems += error.problems
            continue
        for name, series in mine.items():
            if label and len(series) > len({one.below for one in series}):
                raise UsageError(
                    f"{path} holds {len(series)} instruments; `{label}=` needs a file with only one"
                )
            found[name] += [replace(one, label=label or one.label) for one in series]
    if problems:
        raise InputError(problems)
    return found


def files_given(given: Sequence[str]) -> list[tuple[str, Path]]:
    """Return the label and the path of each file given; the label may be empty.

    A folder stands for the data files in the folder. Raise InputError if there is no file.
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
            problems.append(
                Problem(str(path), 0, 0, f"the folder has no file with the ending {_SAID}")
            )
        else:
            found += [(label, one) for one in inside]
    if problems:
        raise InputError(problems)
    return found


def split_label(text: str) -> tuple[str, Path]:
    """Split ``LABEL=PATH`` into label and path; the label is empty if only a path is given."""
    label, equals, path = text.partition("=")
    if equals and not Path(text).exists():
        return label.strip(), Path(path)
    return "", Path(text)


def _of_file(
    path: Path, names: Sequence[str], flags: frozenset[int], seabed: float, nominal: float
) -> dict[str, list[InstrumentSeries]]:
    found: list[tuple[str, InstrumentSeries]] = []
    with _opened(path) as dataset:
        for part in instruments_apart(velocity.with_components(dataset)):
            file = _SeriesFile(part, path.name, flags, seabed, nominal)
            mine = [(name, one) for name in names for one in file.series(name)]
            if cards := [one.card for _, one in mine if one.card is not None]:
                whole = joined_cards(cards)
                found += [(name, replace(one, card=whole)) for name, one in mine]
        if not found:
            raise UnreadableError(f"holds no {' or '.join(names)}")
    series = with_one_card([one for _, one in found])
    quantities = [name for name, _ in found]
    return {
        name: [one for one, own in zip(series, quantities, strict=True) if own == name]
        for name in names
    }


def with_one_card(series: Sequence[InstrumentSeries]) -> list[InstrumentSeries]:
    """Return the series of a file with a common card that covers all instruments."""
    cards = [*{id(one.card): one.card for one in series if one.card is not None}.values()]
    if len(cards) < 2:
        return [*series]
    whole = card_of_instruments(cards)
    return [replace(one, card=whole) for one in series]


@contextmanager
def _opened(path: Path) -> Iterator[xr.Dataset]:
    if cf_files.holds_arrays(path):
        with cf_files.opened(path) as dataset:
            yield dataset
    else:
        with cf_files.reading(path):
            yield instrument_text.read_plain_table(path)


def instruments_apart(dataset: xr.Dataset) -> list[xr.Dataset]:
    """Split a dataset of several instruments into one dataset per instrument.

    Only a ragged array of CF, indexed (`instance_dimension`) or contiguous (`sample_dimension`), is
    split. Readings without an instrument are excluded. Raise UnreadableError if the array is
    inconsistent.
    """
    for name, index in dataset.variables.items():
        instances = index.attrs.get("instance_dimension")
        readings = index.attrs.get("sample_dimension")
        if index.ndim != 1 or not {instances, readings} & {*dataset.dims}:
            continue
        whose = np.nan_to_num(np.asarray(index.values, np.float64), nan=-1.0)
        if readings in dataset.dims:
            instances = index.dims[0]
            whose = np.repeat(np.arange(whose.size), np.maximum(whose, 0.0).astype(np.int64))
        else:
            readings = index.dims[0]
        count = dataset.sizes[instances]
        if whose.size != dataset.sizes[readings] or whose.max(initial=0.0) >= count:
            raise UnreadableError(
                f"for each of the {dataset.sizes[readings]} readings, `{name}` must hold the "
                f"number of the instrument, from 0 to {count - 1}"
            )
        return [
            dataset.drop_vars([name]).isel({readings: whose == i, instances: i})
            for i in range(count)
            if (whose == i).any()
        ]
    return [dataset]


CONDUCTIVITY = ("sea_water_electrical_conductivity",), ("CNDC", "conductivity", "COND", "cond")
PRESSURE = (
    ("sea_water_pressure_due_to_sea_water", "sea_water_pressure"),
    ("PRES_REL", "PRES", "pressure", "pres"),
)
"""Standard names and usual names of pressure variables."""
PASCALS_PER_DBAR = 1e4
_LATITUDE = 45.0  # default; it changes the pressure at a depth by 0.3 % at most
_FEWEST = 6  # a series of zeros alone is a fault from this length on


@dataclass(frozen=True)
class _SeriesFile:
    dataset: xr.Dataset
    name: str
    flags: frozenset[int]
    seabed: float
    usual: float

    def series(self, name: str) -> list[InstrumentSeries]:
        dataset, quantity = self.dataset, QUANTITIES_MEASURED[name]
        current = self._velocity(quantity) if quantity.dimension == "speed" else None
        if current is not None:
            meanings = ("east", "north") if current.turn is None else ("speed", "direction")
            taken = dict(zip(meanings, current.names, strict=True))
        else:
            sought = () if quantity.dimension == "speed" else quantity.sought
            taken = dict(zip([name], named(dataset, sought, quantity.usual), strict=False))
        if name == "salinity" and not taken:
            taken = conductivity_in(dataset)
        if not taken:
            return []
        for one in taken.values():
            if reason := attributes.not_a_value(dataset[one], velocity.layers_of(dataset)):
                raise UnreadableError(f"`{one}` {reason}")
        found = readings(dataset, [*taken.values()], self.flags)
        who = who_along(dataset, found.along, self.seabed, self.name)
        below = np.zeros(len(who))
        if found.along is not None and not any(one.known for one in who):
            below = self._bins(found.along, found.axis)
            who = who_along(dataset, None, self.seabed, self.name) * len(who)
        value, notes = self._value(name, taken, found, who, current)
        value = np.where(found.dropped, np.nan, value)
        card = card_of(dataset, self.name, taken, found)
        called = str(dataset.attrs.get("instrument", "")) if found.along is None else ""
        pressure, variable = self._median_pressure(found), next(iter(taken.values()))
        return [
            replace(
                one, below=float(deep), card=card, pressure=pressure, called=one.label or called
            ).checked(name, variable, notes)
            for one, deep in zip(found.series(value, who), below, strict=True)
        ]

    def _value(
        self,
        name: str,
        taken: Mapping[str, str],
        found: Readings,
        who: Sequence[Identity],
        current: velocity.Velocity | None,
    ) -> tuple[Floats, list[str]]:
        """Return values (n, k) in the unit of the quantity, and notes on how they were computed."""
        first = self.dataset[next(iter(taken.values()))]
        if current is not None:
            dimensions = ("speed", "speed" if current.turn is None else "angle")
            names = zip(current.names, dimensions, strict=True)
            factors = (factor_of(self.dataset[one], dimension) for one, dimension in names)
            parts = (each * factor for each, factor in zip(found.values, factors, strict=True))
            return current.components(*parts)[0 if name == "u" else 1], []
        if "conductivity" in taken:
            nominal = np.array([one.nominal for one in who])
            nominal = np.where(np.isfinite(nominal), nominal, self.usual)
            salinity = practical_salinity(self.dataset, taken, found.values, nominal)
            return salinity, [*_salinity_notes(salinity, taken)]
        if name == "temperature":
            return cf_files.converted(first, found.values[0], "degC"), []
        cf_files.refuse_other_salinity(first)
        return found.values[0], []

    def _median_pressure(self, found: Readings) -> float:
        names = named(self.dataset, *PRESSURE)[:1]
        if found.along is not None or not names:
            return float("nan")
        known = known_values(self.dataset[names[0]])
        known = _decibars(self.dataset[names[0]], known[np.isfinite(known)])
        return float(np.median(known)) if known.size else float("nan")

    def _velocity(self, quantity: MeasuredQuantity) -> velocity.Velocity | None:
        try:
            current = velocity.find_velocity(self.dataset, regular=False)
        except UnreadableError:
            sought = quantity.sought
            if first_present(self.dataset, sought) or _standard(self.dataset, sought):
                raise
            return None
        if current.magnetic:
            raise UnreadableError(
                f"`{current.names[-1]}` is relative to magnetic north; rotate it to true north "
                "before you grid it"
            )
        return current

    def _bins(self, along: str, time: str) -> Floats:
        """Return the depths of a profiler's bins relative to the instrument [m], positive below."""
        levels = find_levels(self.dataset, along, time, self.seabed)
        if levels.instrument is None or time in levels.variable.dims:
            raise UnreadableError(
                f"the dimension `{along}` holds neither instruments nor profiler bins"
            )
        return np.asarray(known_values(levels.variable) * levels.factor)


def conductivity_in(dataset: xr.Dataset) -> dict[str, str]:
    """Return the names of the variables for computing salinity, by quantity name.

    The quantities are conductivity, temperature and, optionally, pressure. Without conductivity or
    temperature, the result is empty.
    """
    temperature = QUANTITIES_MEASURED["temperature"]
    sought = {
        "conductivity": CONDUCTIVITY,
        "temperature": (temperature.sought, temperature.usual),
        "pressure": PRESSURE,
    }
    found = {taken: named(dataset, *names)[:1] for taken, names in sought.items()}
    taken = {taken: names[0] for taken, names in found.items() if names}
    return taken if {"conductivity", "temperature"} <= taken.keys() else {}


def practical_salinity(
    dataset: xr.Dataset, taken: Mapping[str, str], values: Sequence[Floats], depth: Floats
) -> Floats:
    """Compute practical salinity (PSS-78) from conductivity with the TEOS-10 library.

    Parameters
    ----------
    taken : variables as returned by `conductivity_in`
    values : values of these variables, in the units of the file and with equal shapes
    depth : depth used if a pressure is missing [m]
    """
    import gsw

    convert = {
        "conductivity": lambda one, found: cf_files.converted(one, found, "mS/cm"),
        "temperature": lambda one, found: cf_files.converted(one, found, "degC"),
        "pressure": _decibars,
    }
    parts = {
        each: convert[each](dataset[one], found)
        for (each, one), found in zip(taken.items(), values, strict=True)
    }
    pressure = parts.get("pressure", np.full_like(parts["temperature"], np.nan))
    known = np.isfinite(pressure)
    # a depth error of 10 m changes salinity by 0.004
    pressure = np.where(known, pressure, pressure_at(depth, _LATITUDE))
    with np.errstate(invalid="ignore"):
        salinity: Floats = gsw.SP_from_C(parts["conductivity"], parts["temperature"], pressure)
    return salinity


_FRESH = 5.0


def _salinity_notes(salinity: Floats, taken: Mapping[str, str]) -> Iterator[str]:
    if not np.isfinite(salinity).any():
        yield "salinity is not computed, because there is neither a pressure nor a nominal depth"
        return
    yield f"salinity is computed from {', '.join(taken)}"
    if (middle := float(np.nanmedian(salinity))) < _FRESH:
        yield (
            f"the median of the salinity is {middle:.2g}: is `{taken['conductivity']}` "
            "in another unit?"
        )


def _decibars(variable: xr.DataArray, values: Floats) -> Floats:
    return values * (factor_of(variable, "pressure") / PASCALS_PER_DBAR)


def named(dataset: xr.Dataset, sought: Sequence[str], usual: Sequence[str]) -> list[str]:
    """Return the names of the variables of a quantity.

    `sought` lists standard names, the preferred name first. The variables with the first standard
    name that occurs in the dataset are returned. If no standard name occurs, the variables with the
    names in `usual` are returned. If several variables have the same standard name, only those with
    a name in `usual` are returned.

    Raise UnreadableError if several variables have the same standard name, and none has a name in
    `usual`. Raise UnreadableError also if the first variable found by a usual name has another
    standard name.
    """
    there = _standard(dataset, sought)
    known = [one for one in usual if one in (there or dataset.data_vars)]
    if len(there) > 1 and not known:
        standard = dataset[there[0]].attrs["standard_name"]
        raise UnreadableError(
            f"several variables have the standard name {standard}: {', '.join(there)}"
        )
    for name in known[:1]:
        standard = str(dataset[name].attrs.get("standard_name", ""))
        if standard and standard not in sought:
            raise UnreadableError(
                f"`{name}` has the standard name {standard} instead of {sought[0]}"
            )
    return known or there


def _standard(dataset: xr.Dataset, sought: Sequence[str]) -> list[str]:
    names = dataset.cf.standard_names
    return next((list(map(str, names[one])) for one in sought if one in names), [])


@dataclass(frozen=True)
class Readings:
    """Values of several variables for k instruments at n increasing times.

    Attributes
    ----------
    axis, along : dimensions of the times and of the instruments; `along` is None for one instrument
    values : (n, k) values of each variable, in the units of the file
    dropped : (n, k) mask of readings rejected by a flag of any variable
    clock : name and unit of the time variable
    flags : number of readings that each flag variable rejected
    """

    time: NDArray[np.datetime64]
    axis: str
    along: str | None
    values: list[Floats]
    dropped: NDArray[np.bool_]
    clock: tuple[str, str]
    flags: dict[str, int]

    def series(self, value: Floats, who: Sequence[Identity]) -> list[InstrumentSeries]:
        """Build one series per instrument from values (n, k) derived from these readings."""
        counts = self.dropped.sum(axis=0).tolist()
        return [
            InstrumentSeries(**vars(one), time=self.time, value=column, dropped=count)
            for one, column, count in zip(who, value.T, counts, strict=True)
        ]


def readings(dataset: xr.Dataset, names: Sequence[str], flags: frozenset[int]) -> Readings:
    """Read several variables that have the same dimensions.

    Parameters
    ----------
    flags : accepted quality flags; flag 8 is never accepted

    Raises
    ------
    UnreadableError
        The variables have no times, or dimensions other than times and instruments.
    """
    first = dataset[names[0]]
    clock = cf_files.find_times(dataset, names[0])
    if clock is None or dataset[clock].ndim != 1:
        raise UnreadableError(f"`{first.name}` has no times")
    velocity.refuse_ragged(dataset, names[0])
    time = str(dataset[clock].dims[0])
    others = [str(dim) for dim, size in first.sizes.items() if dim != time and size > 1]
    if len(others) > 1 or time not in first.dims:
        raise UnreadableError(
            f"`{first.name}` must have a time and an instrument dimension; it has {first.dims}"
        )
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
    clock_unit = clock, str(dataset[clock].attrs.get("units", ""))
    return Readings(times[order], time, along, parts, dropped, clock_unit, removed)


def card_of(
    dataset: xr.Dataset, source: str, taken: Mapping[str, str], found: Readings
) -> ReadCard:
    """Return the card that summarises readings.

    Parameters
    ----------
    source : name of the file
    taken : names of the variables by role, such as temperature, in the order of `found.values`
    found : values of these variables
    """
    summaries = {}
    for (meaning, name), values in zip(taken.items(), found.values, strict=True):
        variable_attributes = dataset[name].attrs
        unit = str(variable_attributes.get("units", ""))
        summaries[meaning] = VariableSummary.of(
            name, unit, values, description_of(variable_attributes)
        )
    return ReadCard(
        source, texts_in(dataset.attrs), summaries, found.dropped.shape[1], found.time,
        found.clock, found.flags,
    )  # fmt: skip


def who_along(dataset: xr.Dataset, along: str | None, seabed: float, source: str) -> list[Identity]:
    """Identify the instruments along a dimension, or the only instrument if `along` is None.

    `seabed` is the water depth [m], to convert heights above the seabed.
    """
    if along is None:
        single = [str(dim) for dim, size in dataset.sizes.items() if size == 1]
        labels = next(filter(None, (cf_files.labels_along(dataset, dim) for dim in single)), ("",))
        tried = (cf_files.places_along(dataset, dim, seabed) for dim in (None, *single))
        place = next((float(one[0]) for one in tried if one is not None), _number(dataset.attrs))
        known = (_serials(dataset, dims) for dims in ((), *((dim,) for dim in single)))
        serial_text = next((dataset.attrs[name] for name in _SERIALS if name in dataset.attrs), "")
        serial = next(filter(None, known), [str(serial_text).strip()])[0]
        return [Identity(labels[0], serial, place, source)]
    count = dataset.sizes[along]
    labels = cf_files.labels_along(dataset, along) or ("",) * count
    serials = _serials(dataset, (along,)) or [""] * count
    places = cf_files.places_along(dataset, along, seabed)
    nominal = [float("nan")] * count if places is None else places.tolist()
    return [Identity(*one, source) for one in zip(labels, serials, nominal, strict=True)]


def _serials(dataset: xr.Dataset, dims: tuple[str, ...]) -> list[str]:
    for name in first_present(dataset, _SERIALS):
        if dataset[name].dims == dims:
            # IMOS has `deployment; model; serial number` in `instrument_id`
            texts = (text.rpartition(";")[2].strip() for text in cf_files.texts_of(dataset[name]))
            return [text.rstrip("*") for text in texts]
    return []


def _number(attributes: Any) -> float:
    for name in _ONE_PLACE:
        try:
            return float(attributes[name])
        except (KeyError, TypeError, ValueError):
            continue
    return float("nan")
