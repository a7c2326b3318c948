"""Layout of the result file of a batch, and conversion of solved blocks to arrays.

The layout is known before the profiles are solved.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.batch.profiles import Profiles
from calm.batch.statuses import STATUSES
from calm.case import Design
from calm.case.columns import terms
from calm.dataset import netcdf
from calm.dataset.netcdf import CLAMPS, ResultLayout, Variable, labels, numbers, station
from calm.files.mooring_file import leg_numbers
from calm.files.pieces import clamps_down
from calm.records.record import Record

_COORDINATES = {"component": "component_label depth_top", "clamp": "clamp_label clamp_depth"}
"""Value of the attribute `coordinates` for the variables of each dimension: the names of the label
variable and the depth variable.
"""
_TIME_UNITS = (("seconds", 10**9), ("milliseconds", 10**6), ("nanoseconds", 1))


def laid_out(
    layout: ResultLayout, time: NDArray[np.datetime64], columns: Mapping[str, NDArray[Any]]
) -> dict[str, NDArray[Any]]:
    """Return the arrays of all time-dependent variables of a layout, by name.

    `time` lists the times of some profiles, and `columns` has the results of these profiles.
    """
    unit = str(layout.variables[0].attributes["units"]).partition(" ")[0]
    since = time.astype("datetime64[ns]").astype(np.int64)
    known = {**columns, layout.variables[0].name: since // dict(_TIME_UNITS)[unit]}
    return {
        variable.name: np.ascontiguousarray(known[variable.name], variable.dtype)
        for variable in layout.in_blocks
    }


def layout_of(mooring: Design, record: Record) -> ResultLayout:
    """Create the layout of the result file for a mooring and a record."""
    pieces = mooring.file.pieces
    clamps = [clamp.label for clamp in clamps_down(pieces)]
    sizes = {"time": record.count, "component": len(pieces)}
    of_station, where = _station(mooring, record)
    variables = [
        time_axis(record.time, "time of the profile"),
        *of_station,
        labels("component_label", "component", [piece.label for piece in pieces], netcdf.PIECES),
    ]  # fmt: skip
    if clamps:
        sizes["clamp"] = len(clamps)
        variables.append(labels("clamp_label", "clamp", clamps, CLAMPS))
    entered = Profiles.columns()
    for dimension, coordinates in _COORDINATES.items():
        if dimension in sizes:
            columns = terms(entered[dimension])
            variables += numbers(("time", dimension), columns, f"{coordinates}{where}")
    legs = mooring.file.legs
    along = ("time", "leg") if legs else ("time",)
    variables += numbers(along, terms(entered[""]), where.strip())
    if legs:
        sizes["leg"], own = len(legs), leg_numbers(mooring.file)
        of_clamps = [own[piece.index] for piece in pieces for _ in piece.clamps]
        variables = netcdf.of_net(variables, [leg.name for leg in legs], own, of_clamps)
    variables.append(
        Variable("status", ("time",), "|i1", {
            "standard_name": "status_flag", "long_name": "whether there is an equilibrium",
            "flag_values": list(range(len(STATUSES))), "flag_meanings": " ".join(STATUSES),
            "coordinates": where.strip(),
        })
    )  # fmt: skip
    variables += netcdf.down_the_line(sizes)
    file = mooring.file
    attributes: netcdf.Attributes = {
        **netcdf.origin(file.path, file.name, file.description, "batch"),
        "title": f"{file.name or Path(file.path).stem}: the mooring in every current profile of a "
        "record",
        "currents": "; ".join(f"{key}: {value}" for key, value in record.source.items()),
        "notes": "\n".join(record.notes),
        "read": json.dumps([card.to_dict() for card in record.cards], ensure_ascii=False),
    }
    sentences = [card.sentence() for card in record.cards]
    attributes["history"] = "\n".join([str(attributes["history"]), *sentences])
    if len(of_station) > 1:
        attributes["featureType"] = "timeSeriesProfile"
    known = {name: value for name, value in attributes.items() if value}
    return ResultLayout(sizes, tuple(variables), known)


def time_axis(time: NDArray[np.datetime64], meaning: str) -> Variable:
    """Create the time variable, in the largest unit in which all times are whole numbers."""
    return Variable("time", ("time",), "<i8", {
        "standard_name": "time", "long_name": meaning, "axis": "T",
        "units": f"{_time_unit(time)} since 1970-01-01 00:00:00", "calendar": "standard",
        "units_metadata": "leap_seconds: none",
    })  # fmt: skip


def _station(mooring: Design, record: Record) -> tuple[list[Variable], str]:
    name, position = mooring.file.name or "mooring", mooring.file.position
    if position is not None:
        return station(name, (position.latitude, position.longitude), "the anchor")
    known = [record.source.get(axis) for axis in ("latitude", "longitude")]
    place = tuple(float(value) for value in known if value)
    return station(name, place, "the currents")


def _time_unit(time: NDArray[np.datetime64]) -> str:
    since = time.astype("datetime64[ns]", copy=False).view(np.int64)
    parts = [since[start : start + 65536] for start in range(0, len(since), 65536)]
    return next(
        unit
        for unit, nanoseconds in _TIME_UNITS
        if not any((part % nanoseconds).any() for part in parts)
    )
