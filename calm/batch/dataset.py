"""The result of a batch before it is solved, its blocks as arrays, and the nodes of a shape."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import ceil
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.batch.profiles import Profiles
from calm.batch.statuses import STATUSES
from calm.case import Mooring
from calm.case.columns import Output, terms
from calm.case.net import Net
from calm.case.result_tables import Shape
from calm.dataset import netcdf
from calm.dataset.netcdf import CLAMPS, ResultLayout, Variable, labels, numbers, station
from calm.files import Clamp
from calm.files.legs import leg_numbers
from calm.files.mooring_file import clamps_down
from calm.files.rigid import Body
from calm.physics.line import Floats
from calm.records.record import Record

_BESIDE = {
    "component": "component_label depth_top",
    "clamp": "clamp_label clamp_depth",
    "node": "node_distance shape_depth",
}
"""Label and depth of what goes along a dimension, the coordinates of its variables."""
_TIME_UNITS = (("seconds", 10**9), ("milliseconds", 10**6), ("nanoseconds", 1))


def arrays_of(
    layout: ResultLayout, time: NDArray[np.datetime64], profiles: Profiles, shape: ShapeNodes | None
) -> dict[str, NDArray[Any]]:
    """The values of some profiles, by the names of the variables that go with time.

    Parameters
    ----------
    time : (n,) of the profiles
    profiles : (n) solved; those of `shape.mooring` where there is a shape
    """
    columns = dict(vars(profiles))
    if shape is not None:
        held = (one.variable for one in profiles.columns()["clamp"])
        columns |= {name: columns[name][:, list(shape.clamps)] for name in held}
        columns |= {f"shape_{name}": array for name, array in shape.columns(profiles).items()}
    return laid_out(layout, time, columns)


def laid_out(
    layout: ResultLayout, time: NDArray[np.datetime64], columns: Mapping[str, NDArray[Any]]
) -> dict[str, NDArray[Any]]:
    """The values of some times, by name, as the variables of a layout that go with time."""
    unit = str(layout.variables[0].attributes["units"]).partition(" ")[0]
    since = time.astype("datetime64[ns]").astype(np.int64)
    known = {**columns, layout.variables[0].name: since // dict(_TIME_UNITS)[unit]}
    return {
        variable.name: np.ascontiguousarray(known[variable.name], variable.dtype)
        for variable in layout.in_blocks
    }


def layout_of(mooring: Mooring | Net, record: Record, shape: ShapeNodes | None) -> ResultLayout:
    """Lay out the result of a mooring in the profiles of a record."""
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
    if shape is not None:
        sizes["node"] = len(shape.distance)
        variables += _nodes(shape)
    entered = {**Profiles.columns(), "node": Shape.columns(Output.BATCH)}
    for dimension, beside in _BESIDE.items():
        if dimension in sizes:
            columns = terms(entered[dimension])
            variables += numbers(("time", dimension), columns, f"{beside}{where}")
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
    }
    if len(of_station) > 1:
        attributes["featureType"] = "timeSeriesProfile"
    known = {name: value for name, value in attributes.items() if value}
    return ResultLayout(sizes, tuple(variables), known)


def time_axis(time: NDArray[np.datetime64], meaning: str) -> Variable:
    """Return the variable of some times, in the coarsest unit in which each is a whole number."""
    return Variable("time", ("time",), "<i8", {
        "standard_name": "time", "long_name": meaning, "axis": "T",
        "units": f"{_time_unit(time)} since 1970-01-01 00:00:00", "calendar": "standard",
        "units_metadata": "leap_seconds: none",
    })  # fmt: skip


def _nodes(shape: ShapeNodes) -> list[Variable]:
    distance = {"units": "m", "long_name": "unstretched length of line above the node"}
    component = {"units": "1", "long_name": "index of the component that the node is on, from 0"}
    return [
        Variable("node_distance", ("node",), "<f8", distance, shape.distance),
        Variable("node_component", ("node",), "<i4", component, shape.component),
    ]


def _station(mooring: Mooring | Net, record: Record) -> tuple[list[Variable], str]:
    """The mooring as a station: at the place of the currents where its file has no position."""
    name, position = mooring.file.name or "mooring", mooring.file.position
    if position is not None:
        return station(name, (position.latitude, position.longitude), "the anchor")
    known = [record.source.get(axis) for axis in ("latitude", "longitude")]
    place = tuple(float(value) for value in known if value)
    return station(name, place, "the currents")


def _time_unit(time: NDArray[np.datetime64]) -> str:
    """The coarsest unit in which every time is a whole number."""
    since = time.astype("datetime64[ns]", copy=False).view(np.int64)
    parts = [since[start : start + 65536] for start in range(0, len(since), 65536)]
    return next(
        unit
        for unit, nanoseconds in _TIME_UNITS
        if not any((part % nanoseconds).any() for part in parts)
    )


_AT_A_NODE = ("depth", "x", "y", "tension")
PARTS = 64
"""Into so many parts, about, the nodes divide the cables and chains of a line."""


@dataclass(frozen=True)
class ShapeNodes:
    """The nodes of a line: the top of every piece, points on its cables, the top of the anchor.

    A node on a cable is a clamp that weighs nothing and takes no drag, so that what is solved for
    clamps is solved for it.

    Attributes
    ----------
    mooring : with the nodes among its clamps
    component : (s,) of every node, the index of the piece that it is on
    distance : (s,) unstretched, from the top of the line [m]
    """

    mooring: Mooring
    component: NDArray[np.int32]
    distance: Floats
    clamps: tuple[int, ...]
    order: NDArray[np.int64]
    own: tuple[int, ...]

    def columns(self, profiles: Profiles) -> Mapping[str, Floats]:
        """Depth and offsets [m], and tension [N], of the nodes: (n, s) each."""
        tops = (profiles.depth_top, profiles.x_top, profiles.y_top, profiles.tension_top)
        between = (profiles.clamp_depth, profiles.clamp_x, profiles.clamp_y, profiles.clamp_tension)
        return {
            name: np.hstack([top, inner[:, list(self.own)]])[:, self.order]
            for name, top, inner in zip(_AT_A_NODE, tops, between, strict=True)
        }


def nodes_of(mooring: Mooring) -> ShapeNodes:
    """Lay the nodes along the line of a mooring.

    NoEquilibrium: where a piece is to be cut to fit, and no length does.
    """
    lengths, flexible = mooring.line.length, mooring.line.flexible
    part = float(lengths[flexible].sum()) / PARTS
    tops = np.concatenate([[0.0], np.cumsum(lengths)])
    nothing = Body.model_validate(
        {"kind": "body", "length": "0 m", "buoyancy": "0 N", "drag_area": "0 m^2", "cd": 0}
    )
    pieces = []
    component, distance = list(range(len(tops))), tops.tolist()
    for piece in mooring.file.pieces:
        index = piece.index
        clamps = piece.clamps
        if index < len(lengths) and flexible[index]:
            length = float(lengths[index])
            inner = np.linspace(0.0, length, max(ceil(length / part), 1) + 1)[1:-1]
            clamps += tuple(Clamp("", "", nothing, float(at), piece.place) for at in inner)
            component += [index] * len(inner)
            distance += (tops[index] + inner).tolist()
            piece = replace(piece, length=length, fit_top_depth=None, clamps=clamps)
        pieces.append(piece)
    order = np.lexsort((distance, component))
    own = np.array([clamp.use == "" for clamp in clamps_down(pieces)], bool)
    return ShapeNodes(
        mooring=Mooring(replace(mooring.file, pieces=tuple(pieces))),
        component=np.array(component, np.int32)[order],
        distance=np.array(distance)[order],
        clamps=tuple(np.flatnonzero(~own).tolist()),
        own=tuple(np.flatnonzero(own).tolist()),
        order=order,
    )
