"""Pressures of instruments on a mooring: read, and turned into depths."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem, UsageError
from calm.files.current_file import holds_arrays
from calm.files.current_netcdf import open_current, reading
from calm.files.current_times import find_times, read_times
from calm.files.current_values import known_values
from calm.files.current_variables import UnreadableError, factor_of, holdings
from calm.files.times import TimeChoiceError, parse_time
from calm.motion.flags import INTERPOLATED, flag_variable, flags_of
from calm.motion.labelled import labels_along, places_along
from calm.physics.line import Floats
from calm.units import QuantityError, unit_factor

if TYPE_CHECKING:
    import xarray as xr

PASCALS_PER_DBAR = 1e4

_PRESSURES = ("sea_water_pressure_due_to_sea_water", "sea_water_pressure")
_USUAL = ("PRES_REL", "PRES", "pressure", "pres")
_MOST_PROBLEMS = 20
_HEADED = re.compile(r"(.*?)\s*[\[(]([^\])]*)[\])]\s*")


@dataclass(frozen=True)
class Sensor:
    """What one sensor measured.

    Attributes
    ----------
    label : what it is called; empty where its file does not say
    time : (n,) to the nanosecond, rising
    depth : (n,) below the surface [m]; NaN where nothing was measured, or the flag is not wanted
    source : its file
    nominal : depth where it was meant to hang [m]; NaN where its file does not say
    dropped : readings that were left out for their flag
    """

    label: str
    time: NDArray[np.datetime64]
    depth: Floats
    source: str
    nominal: float = float("nan")
    dropped: int = 0


def read_sensors(
    given: Sequence[str], flags: frozenset[int], latitude: float, seabed: float
) -> list[Sensor]:
    """The sensors of some files, each given by its path, or as ``LABEL=PATH`` where it has one.

    Pressures are turned into depths by TEOS-10.

    Parameters
    ----------
    flags : quality flags of what counts as measured, where there are any
    latitude : [degrees]
    seabed : depth of the water [m], for nominal heights above it

    Raises
    ------
    InputError
        A file cannot be read, or holds no pressures with their unit.
    UsageError
        A label is given for a file of several sensors; two sensors are called the same.
    """
    found: list[Sensor] = []
    for text in given:
        label, path = _split(text)
        if not path.exists():
            raise InputError([Problem(str(path), 0, 0, "no such file")])
        mine = (
            _from_arrays(path, flags, latitude, seabed)
            if holds_arrays(path)
            else _from_csv(path, latitude)
        )
        if label:
            if len(mine) > 1:
                raise UsageError(f"{path} holds {len(mine)} sensors; `{label}=` names only one")
            mine = [replace(mine[0], label=label)]
        found += mine
    labels = [one.label for one in found if one.label]
    twice = sorted({label for label in labels if labels.count(label) > 1})
    if twice:
        raise UsageError(f"--pressures: two sensors are called `{twice[0]}`")
    return found


def _split(text: str) -> tuple[str, Path]:
    label, equals, path = text.partition("=")
    if equals and not Path(text).exists():
        return label.strip(), Path(path)
    return "", Path(text)


def depth_of(dbar: Floats, latitude: float) -> Floats:
    """Depths [m] of pressures above that of the air [dbar], by TEOS-10."""
    import gsw

    depths: Floats = -np.asarray(gsw.z_from_p(dbar, latitude), np.float64)
    return depths


def _from_arrays(path: Path, flags: frozenset[int], latitude: float, seabed: float) -> list[Sensor]:
    with reading(path), open_current(path) as dataset:
        try:
            return _understood(dataset, path, flags, latitude, seabed)
        except UnreadableError as error:
            raise UnreadableError(f"{error}; it holds {holdings(dataset)}") from None


def _understood(
    dataset: xr.Dataset, path: Path, flags: frozenset[int], latitude: float, seabed: float
) -> list[Sensor]:
    name, is_pressure = _find(dataset)
    variable = dataset[name]
    clock = find_times(dataset, name)
    if clock is None or dataset[clock].ndim != 1:
        raise UnreadableError(f"`{name}` has no times")
    time = str(dataset[clock].dims[0])
    single = [dim for dim, size in variable.sizes.items() if size == 1 and dim != time]
    others = [str(dim) for dim in variable.dims if dim != time and dim not in single]
    if len(others) > 1:
        raise UnreadableError(f"`{name}` is not of times and instruments: {variable.dims}")
    along = others[0] if others else None
    if along is None:  # one instrument, which still may say what or where it is
        along = next((str(dim) for dim in single if _tells(dataset, str(dim), seabed)), None)
    unit = "pressure" if is_pressure else "length"
    factor = factor_of(variable, unit) / (PASCALS_PER_DBAR if is_pressure else 1.0)
    squeezed = [dim for dim in single if dim != along]

    def rows(one: xr.DataArray) -> xr.DataArray:
        flat = one.isel({dim: 0 for dim in squeezed if dim in one.dims})
        return flat.transpose(time, ...)

    values = known_values(rows(variable)) * factor
    flagged = flag_variable(dataset, name)
    dropped = np.zeros(values.shape, bool)
    if flagged is not None:
        marks = np.broadcast_to(
            flags_of(rows(flagged)).reshape(
                values.shape if flagged.ndim == variable.ndim else (-1, *[1] * (values.ndim - 1))
            ),
            values.shape,
        )
        dropped = ~np.isin(marks, sorted(flags - {INTERPOLATED})) & np.isfinite(values)
    values = np.where(dropped, np.nan, values).reshape(len(values), -1)
    dropped = dropped.reshape(values.shape)
    times = read_times(dataset, clock)
    order = np.argsort(times, kind="stable")
    depth = depth_of(values, latitude) if is_pressure else values
    labels = None if along is None else labels_along(dataset, along)
    places = places_along(dataset, along, seabed)
    return [
        Sensor(
            "" if labels is None else labels[j],
            times[order],
            depth[order, j],
            path.name,
            float("nan") if places is None else float(places[j]),
            int(dropped[:, j].sum()),
        )
        for j in range(values.shape[1])
    ]


def _tells(dataset: xr.Dataset, dimension: str, seabed: float) -> bool:
    places = places_along(dataset, dimension, seabed)
    return labels_along(dataset, dimension) is not None or places is not None


def _find(dataset: xr.Dataset) -> tuple[str, bool]:
    """The variable of the pressures, or else of the depths; whether it is the former."""
    for standard in _PRESSURES:
        found = [str(name) for name in dataset.cf.standard_names.get(standard, [])]
        if len(found) > 1:
            raise UnreadableError(f"several variables are {standard}: {', '.join(found)}")
        if found:
            return found[0], True
    for name in _USUAL:
        if name in dataset.data_vars:
            return name, True
    for name in map(str, dataset.cf.standard_names.get("depth", [])):
        clock = find_times(dataset, name)
        if (
            clock is not None
            and dataset[clock].dims
            and set(dataset[clock].dims) <= set(dataset[name].dims)
        ):
            return name, False
    raise UnreadableError(
        "holds no pressures: a variable of standard name sea_water_pressure is looked for, then "
        "one of depths over time"
    )


def _from_csv(path: Path, latitude: float) -> list[Sensor]:
    """A table ``time,LABEL[dbar],…``; a label may come with a unit of length instead."""
    time, columns, values = read_table(path, ("pressure", "length"), "LABEL[dbar]")
    return [
        Sensor(
            label,
            time,
            depth_of(values[:, j] / PASCALS_PER_DBAR, latitude)
            if dimension == "pressure"
            else values[:, j],
            path.name,
        )
        for j, (label, dimension) in enumerate(columns)
    ]


def read_table(
    path: Path, dimensions: Sequence[str], example: str
) -> tuple[NDArray[np.datetime64], list[tuple[str, str]], Floats]:
    """A CSV table of times and quantities, each column headed by its name and its unit.

    Parameters
    ----------
    dimensions : what the columns may be, of `calm.units.DIMENSIONS`
    example : of a heading

    Returns
    -------
    (n,) times, rising; of each column its name and what it is; (n, c) values in SI, NaN in gaps.

    Raises
    ------
    InputError
        With every mistake.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            lines = [(i, row) for i, row in enumerate(csv.reader(file), 1) if any(row)]
    except UnicodeDecodeError:
        raise InputError([Problem(str(path), 0, 0, "is not UTF-8 text")]) from None
    except (OSError, csv.Error) as error:
        raise InputError([Problem(str(path), 0, 0, f"cannot be read: {error}")]) from None
    lines = [(i, row) for i, row in lines if not row[0].lstrip().startswith("#")]
    if len(lines) < 2:
        raise InputError([Problem(str(path), 0, 0, "is empty")])
    (number, head), *body = lines
    if head[0].strip().lower() != "time" or len(head) < 2:
        message = f"is no table over time; its heading should be `time,{example}`"
        raise InputError([Problem(str(path), number, 1, message)])
    problems: list[Problem] = []
    columns, factors = [], []
    for j, text in enumerate(head[1:], 2):
        try:
            label, dimension, factor = _column(text.strip(), dimensions, example)
        except ValueError as error:
            problems.append(Problem(str(path), number, j, str(error)))
        else:
            columns.append((label, dimension))
            factors.append(factor)
    times = np.full(len(body), np.datetime64("NaT"), "M8[ns]")
    values = np.full((len(body), len(head) - 1), np.nan)
    for i, (line, row) in enumerate(body):
        try:
            times[i] = np.datetime64(parse_time(row[0]).replace(tzinfo=None), "ns")
        except TimeChoiceError as error:
            problems.append(Problem(str(path), line, 1, str(error)))
        if len(row) != len(head):
            message = f"has {len(row)} cells under a heading of {len(head)}"
            problems.append(Problem(str(path), line, 1, message))
            continue
        for j, cell in enumerate(row[1:]):
            try:
                values[i, j] = float(cell) if cell.strip() else np.nan
            except ValueError:
                problems.append(Problem(str(path), line, j + 2, f"`{cell[:40]}` is no number"))
    if problems:
        raise InputError(problems[:_MOST_PROBLEMS])
    order = np.argsort(times, kind="stable")
    return times[order], columns, values[order] * factors


def _column(text: str, dimensions: Sequence[str], example: str) -> tuple[str, str, float]:
    """Name of a column, what it is, and its factor to SI.

    Raises
    ------
    ValueError
        It has no unit, or that of something else.
    """
    headed = _HEADED.fullmatch(text)
    if headed is None:
        raise ValueError(f"`{text}` needs a unit, as in `{example}`")
    for dimension in dimensions:
        try:
            return headed[1], dimension, unit_factor(headed[2].strip(), dimension)
        except QuantityError:
            continue
    raise ValueError(f"`{headed[2]}` is no unit for it; write it as in `{example}`")
