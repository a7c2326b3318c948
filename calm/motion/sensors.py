"""Pressures of instruments on a mooring, turned into depths, and the height of the sea surface."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem, UsageError
from calm.physics.line import Floats
from calm.records import cf_files, instrument_series
from calm.records.attributes import words_of
from calm.records.cf_files import UnreadableError, factor_of, find_times
from calm.records.headings import read_time_columns
from calm.records.velocity import MISSING, flag_variable

if TYPE_CHECKING:
    import xarray as xr

PASCALS_PER_DBAR = 1e4

_PRESSURES = ("sea_water_pressure_due_to_sea_water", "sea_water_pressure")
_USUAL = ("PRES_REL", "PRES", "pressure", "pres")
_NOT_MEASURED = re.compile(
    r"\binferred\b|\binterpolated (from|between|using)\b|\bneighbou?r(s|ing)?\b|\bby calm\b"
)


@dataclass(frozen=True)
class Sensor:
    """Hold what one sensor measured.

    Attributes
    ----------
    label : what it is called; empty where its file does not say
    time : (n,) to the nanosecond, rising
    depth : (n,) below the surface [m]; NaN where nothing was measured, or the flag is not wanted
    source : its file
    nominal : depth where it was meant to hang [m]; NaN where its file does not say
    dropped : readings that were left out for their flag
    note : what a person should know before trusting it
    serial : number of the instrument; empty where its file does not say
    """

    label: str
    time: NDArray[np.datetime64]
    depth: Floats
    source: str
    nominal: float = float("nan")
    dropped: int = 0
    note: str = ""
    serial: str = ""


def read_sensors(
    given: Sequence[str], flags: frozenset[int], latitude: float, seabed: float
) -> list[Sensor]:
    """Return the sensors of some files, each given by its path, or as ``LABEL=PATH`` where it has
    one.

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
        label, path = instrument_series.split_label(text)
        if not path.exists():
            raise InputError([Problem(str(path), 0, 0, "no such file")])
        if cf_files.holds_arrays(path):
            with cf_files.opened(path) as dataset:
                mine = _from_arrays(dataset, path, flags, latitude, seabed)
        else:
            mine = _from_csv(path, latitude)
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


def depth_of(dbar: Floats, latitude: float) -> Floats:
    """Return depths [m] of pressures above that of the air [dbar], by TEOS-10; NaN of infinite
    ones.
    """
    import gsw

    known = np.where(np.isfinite(dbar), dbar, np.nan)
    depths: Floats = -np.asarray(gsw.z_from_p(known, latitude), np.float64)
    return depths


def _from_arrays(
    dataset: xr.Dataset, path: Path, flags: frozenset[int], latitude: float, seabed: float
) -> list[Sensor]:
    name, is_pressure = _find(dataset)
    variable = dataset[name]
    found = instrument_series.readings(dataset, [name], flags)
    words, note = words_of(variable, "long_name", "comment"), ""
    if _NOT_MEASURED.search(words):
        flagged = flag_variable(dataset, name)
        if flagged is None or not {found.axis} < set(flagged.dims):
            raise UnreadableError(f"`{name}` is not a measurement by its attributes: {words[:120]}")
        # attributes of several instruments in one variable are those of any of them
        note = (
            f"`{name}` says `{words[:80]}` of one instrument or more: what counts is by its flags"
        )
    unit = "pressure" if is_pressure else "length"
    factor = factor_of(variable, unit) / (PASCALS_PER_DBAR if is_pressure else 1.0)
    values = np.where(found.dropped, np.nan, found.values[0] * factor)
    depth = depth_of(values, latitude) if is_pressure else values
    return [
        Sensor(
            **vars(who),
            time=found.time,
            depth=depth[:, j],
            dropped=int(found.dropped[:, j].sum()),
            note=note,
        )
        for j, who in enumerate(
            instrument_series.who_along(dataset, found.along, seabed, path.name)
        )
        if not note or np.isfinite(depth[:, j]).any()
    ]


def _find(dataset: xr.Dataset) -> tuple[str, bool]:
    """Return the variable of the pressures, or else of the depths; whether it is the former."""
    if found := instrument_series.named(dataset, _PRESSURES, _USUAL):
        return found[0], True
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
    """Return a table ``time,LABEL[dbar],…``; a label may come with a unit of length instead."""
    table = read_time_columns(path, ("pressure", "length"), "LABEL[dbar]")
    return [
        Sensor(
            label,
            table.time,
            depth_of(values / PASCALS_PER_DBAR, latitude) if dimension == "pressure" else values,
            path.name,
        )
        for label, dimension, values in zip(
            table.names, table.dimensions, table.values.T, strict=True
        )
    ]


def parse_flags(text: str) -> frozenset[int]:
    """Return the flags of a text such as ``1,2``.

    UsageError: they are no flags, or 8 is among them: what was interpolated is no measurement.
    """
    try:
        flags = frozenset(int(part) for part in text.split(","))
    except ValueError:
        raise UsageError(f"--flags: `{text[:40]}` is not a list of flags; write 1,2") from None
    if instrument_series.INTERPOLATED in flags:
        raise UsageError("--flags: 8 marks what was interpolated, which is never a measurement")
    if not flags <= set(range(MISSING)):
        raise UsageError(f"--flags: `{text[:40]}`: flags are from 0 to 8")
    return flags


FURTHEST = 20.0
"""A height of the sea surface is this far from the others at most [m]: no tide has half of it."""

_STANDARD = (
    "sea_surface_height_above_mean_sea_level",
    "sea_surface_height_above_geoid",
    "sea_surface_height_above_geopotential_datum",
    "tidal_sea_surface_height_above_mean_sea_level",
    "water_surface_height_above_reference_datum",
)


def read_sea_level(path: Path) -> tuple[NDArray[np.datetime64], Floats]:
    """Return times, rising, and the height of the sea surface above a datum [m].

    InputError: the file cannot be read, or holds no height with its unit, or one that cannot be.
    """
    if not path.exists():
        raise InputError([Problem(str(path), 0, 0, "no such file")])
    if not cf_files.holds_arrays(path):
        table = read_time_columns(path, ("length",), "level[m]")
        if len(table.names) != 1:
            message = "has several columns; the sea level is one: `time,level[m]`"
            raise InputError([Problem(str(path), 1, 1, message)])
        _refuse_far(path, table.time, table.values[:, 0])
        return table.time, table.values[:, 0]
    with cf_files.opened(path) as dataset:
        for standard in _STANDARD:
            for name in map(str, dataset.cf.standard_names.get(standard, [])):
                clock = find_times(dataset, name)
                variable = dataset[name].squeeze()
                if clock is None or variable.ndim != 1:
                    continue
                times = cf_files.read_times(dataset, clock)
                order = np.argsort(times, kind="stable")
                level = cf_files.known_values(variable) * factor_of(variable, "length")
                _refuse_far(path, times, level)
                return times[order], level[order]
        raise UnreadableError("holds no height of the sea surface")


def _refuse_far(path: Path, time: NDArray[np.datetime64], level: Floats) -> None:
    known = level[np.isfinite(level)]
    far = np.abs(level - (np.median(known) if known.size else 0.0)) > FURTHEST
    if far.any():
        at = int(far.argmax())
        message = (
            f"is {level[at]:g} m at {np.datetime_as_string(time[at], 's')}: no height of the sea "
            f"surface is more than {FURTHEST:g} m from the others; leave empty what was not "
            "measured"
        )
        raise InputError([Problem(str(path), 0, 0, message)])
