"""What a result holds: its dimensions, variables and attributes, by the CF conventions."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.batch.profiles import Profiles
from calm.batch.shape import Shape
from calm.batch.statuses import STATUSES
from calm.case import Mooring
from calm.case.measure import clamps_down
from calm.version import __version__

if TYPE_CHECKING:
    from calm.batch.records.record import Record

Attributes = dict[str, Any]

NUMBER = "<f4"
"""Of depths, offsets, forces and angles; a profile without equilibrium is NaN."""

_EAST, _NORTH = "offset to the east of the anchor", "offset to the north of the anchor"
_DOWN = {"standard_name": "depth", "axis": "Z", "positive": "down"}
_COMPONENT: dict[str, tuple[str, str, Attributes]] = {
    "depth_top": ("m", "depth of the upper end", _DOWN),
    "x_top": ("m", f"{_EAST}, of the upper end", {}),
    "y_top": ("m", f"{_NORTH}, of the upper end", {}),
    "tension_top": ("N", "tension at the upper end", {}),
    "tension_bottom": ("N", "tension at the lower end", {}),
    "tilt": ("degree", "angle of the chord from the vertical", {}),
    "knockdown": ("m", "depth of the upper end below that in still water", {}),
}
_CLAMP: dict[str, tuple[str, str, Attributes]] = {
    "clamp_depth": ("m", "depth of the clamped instrument", _DOWN),
    "clamp_x": ("m", f"{_EAST}, of the clamped instrument", {}),
    "clamp_y": ("m", f"{_NORTH}, of the clamped instrument", {}),
    "clamp_tension": ("N", "tension at the clamp", {}),
    "clamp_tilt": ("degree", "angle of the line at the clamp from the vertical", {}),
    "clamp_knockdown": ("m", "depth of the clamped instrument below that in still water", {}),
}
_ENDS: dict[str, tuple[str, str, Attributes]] = {
    "top_depth": ("m", "depth of the free end", {}),
    "anchor_vertical": ("N", "upward pull of the line on the anchor", {}),
    "anchor_horizontal": ("N", "horizontal pull of the line on the anchor", {}),
    "used_buoyancy": ("1", "share in use of the buoyancy that is at the surface", {}),
}
_NODE: dict[str, tuple[str, str, Attributes]] = {
    "shape_depth": ("m", "depth of the line", _DOWN),
    "shape_x": ("m", f"{_EAST}, of the line", {}),
    "shape_y": ("m", f"{_NORTH}, of the line", {}),
    "shape_tension": ("N", "tension of the line", {}),
}
_ALONG = {"component": _COMPONENT, "clamp": _CLAMP, "node": _NODE}
_PLACE = {"latitude": "degrees_north", "longitude": "degrees_east"}
_TIME_UNITS = (("seconds", 10**9), ("milliseconds", 10**6), ("nanoseconds", 1))


@dataclass(frozen=True)
class Variable:
    """A variable of a result; `values` is None where it goes with time, and comes in blocks."""

    name: str
    dimensions: tuple[str, ...]
    dtype: str
    attributes: Attributes = field(default_factory=dict)
    values: NDArray[Any] | None = None


@dataclass(frozen=True)
class Layout:
    """A result before it is solved.

    Attributes
    ----------
    sizes : of the dimensions
    variables : in the order of the result
    attributes : of the result as a whole
    nanoseconds : to a unit of its time
    """

    sizes: Mapping[str, int]
    variables: tuple[Variable, ...]
    attributes: Attributes
    nanoseconds: int

    def arrays(
        self, time: NDArray[np.datetime64], profiles: Profiles, shape: Shape | None
    ) -> dict[str, NDArray[Any]]:
        """The values of a block, by the names of the variables that go with time.

        Parameters
        ----------
        time : (n,) of the profiles
        profiles : (n) solved; those of `shape.mooring` where there is a shape
        """
        columns = dict(vars(profiles))
        if shape is not None:
            columns |= {name: columns[name][:, list(shape.clamps)] for name in _CLAMP}
            columns |= {f"shape_{name}": array for name, array in shape.columns(profiles).items()}
        since = time.astype("datetime64[ns]").astype(np.int64)
        columns["time"] = since // self.nanoseconds
        return {
            variable.name: np.ascontiguousarray(columns[variable.name], variable.dtype)
            for variable in self.variables
            if variable.values is None
        }


def layout_of(mooring: Mooring, record: Record, shape: Shape | None) -> Layout:
    """Lay out the result of a mooring in the profiles of a record."""
    pieces = mooring.file.pieces
    clamps = [clamp.label for clamp in clamps_down(pieces)]
    sizes = {"time": record.count, "component": len(pieces)}
    unit, nanoseconds = _time_unit(record.time)
    place, where = _place(mooring, record)
    variables = [
        Variable("time", ("time",), "<i8", {
            "standard_name": "time", "long_name": "time of the profile", "axis": "T",
            "units": f"{unit} since 1970-01-01 00:00:00", "calendar": "standard",
        }),
        *place,
        _labels("component", [piece.label for piece in pieces], "piece of the line, from its top"),
    ]  # fmt: skip
    if clamps:
        sizes["clamp"] = len(clamps)
        variables.append(_labels("clamp", clamps, "clamped instrument, down the line"))
    if shape is not None:
        sizes["node"] = len(shape.distance)
        variables += _nodes(shape)
    for dimension, quantities in _ALONG.items():
        if dimension in sizes:
            beside = f"{_LABELLED[dimension]} {next(iter(quantities))}{where}"
            variables += _numbers(("time", dimension), quantities, beside)
    variables += _numbers(("time",), _ENDS, where.strip())
    variables.append(
        Variable("status", ("time",), "|i1", {
            "standard_name": "status_flag", "long_name": "whether there is an equilibrium",
            "flag_values": list(range(len(STATUSES))), "flag_meanings": " ".join(STATUSES),
            "coordinates": where.strip(),
        })
    )  # fmt: skip
    attributes = _attributes(mooring, record)
    if any(variable.name in _PLACE for variable in place):
        attributes["featureType"] = "timeSeriesProfile"
    return Layout(sizes, tuple(variables), attributes, nanoseconds)


_LABELLED = {"component": "component_label", "clamp": "clamp_label", "node": "node_distance"}


def _numbers(
    dimensions: tuple[str, ...],
    quantities: Mapping[str, tuple[str, str, Attributes]],
    coordinates: str,
) -> list[Variable]:
    """Variables of numbers; a coordinate among them is not its own."""
    variables = []
    for name, (unit, meaning, more) in quantities.items():
        beside = [other for other in coordinates.split() if other != name]
        attributes: Attributes = {"units": unit, "long_name": meaning, **more}
        if beside:
            attributes["coordinates"] = " ".join(beside)
        variables.append(Variable(name, dimensions, NUMBER, attributes))
    return variables


def _labels(dimension: str, labels: list[str], meaning: str) -> Variable:
    values = np.array(labels, dtype=np.str_)
    name = _LABELLED[dimension]
    return Variable(name, (dimension,), values.dtype.str, {"long_name": meaning}, values)


def _nodes(shape: Shape) -> list[Variable]:
    distance = {"units": "m", "long_name": "unstretched length of line above the node"}
    component = {"units": "1", "long_name": "index of the component that the node is on, from 0"}
    return [
        Variable("node_distance", ("node",), "<f8", distance, shape.distance),
        Variable("node_component", ("node",), "<i4", component, shape.component),
    ]


def _place(mooring: Mooring, record: Record) -> tuple[list[Variable], str]:
    """The mooring as a station, and what variables say of it among their coordinates.

    Where the mooring file has no position, that is the place of the currents. Without either there
    is no feature in the sense of the conventions, which is at a place.
    """
    name = np.array(mooring.file.name or "mooring", dtype=np.str_)
    station: Attributes = {"long_name": "name of the mooring"}
    position = mooring.file.position
    if position is not None:
        degrees, what = [position.latitude, position.longitude], "the anchor"
    else:
        known = [record.source.get(name) for name in _PLACE]
        degrees, what = [float(value) for value in known if value], "the currents"
    if len(degrees) < len(_PLACE):
        return [Variable("station", (), name.dtype.str, station, name)], " station"
    station["cf_role"] = "timeseries_id"
    return [
        Variable("station", (), name.dtype.str, station, name),
        *(
            Variable(
                name, (), "<f8",
                {"standard_name": name, "long_name": f"{name} of {what}", "units": unit},
                np.array(value),
            )
            for (name, unit), value in zip(_PLACE.items(), degrees, strict=True)
        ),
    ], f" {' '.join(_PLACE)} station"  # fmt: skip


def _time_unit(time: NDArray[np.datetime64]) -> tuple[str, int]:
    """The coarsest unit in which every time is a whole number, and its nanoseconds."""
    since = time.astype("datetime64[ns]", copy=False).view(np.int64)
    parts = [since[start : start + 65536] for start in range(0, len(since), 65536)]
    return next(
        (unit, nanoseconds)
        for unit, nanoseconds in _TIME_UNITS
        if not any((part % nanoseconds).any() for part in parts)
    )


def _attributes(mooring: Mooring, record: Record) -> Attributes:
    name = mooring.file.name or Path(mooring.file.path).stem
    made = f"calm {__version__} batch"
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    if epoch:
        made = f"{datetime.fromtimestamp(int(epoch), UTC):%Y-%m-%dT%H:%M:%SZ} {made}"
    attributes: Attributes = {
        "Conventions": "CF-1.11",
        "title": f"{name}: the mooring in every current profile of a record",
        "summary": mooring.file.description,
        "source": f"static equilibrium by CALM {__version__}",
        "calm": __version__,
        "history": made,
        "input": Path(mooring.file.path).read_text(encoding="utf-8"),
        "currents": "; ".join(f"{key}: {value}" for key, value in record.source.items()),
        "notes": "\n".join(record.notes),
    }
    return {name: value for name, value in attributes.items() if value != ""}
