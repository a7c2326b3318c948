"""What a result holds: its dimensions, variables and attributes, by the CF conventions."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.version import __version__

Attributes = dict[str, Any]

PIECES, CLAMPS = "piece of the line, from its top", "clamped instrument, down the line"
"""What the labels along `component` and `clamp` name."""

NUMBER = "<f4"
"""Of depths, offsets, forces and angles of many profiles; without equilibrium they are NaN."""

_EAST, _NORTH = "offset to the east of the anchor", "offset to the north of the anchor"
_PLACE = {"latitude": "degrees_north", "longitude": "degrees_east"}
_DOWN = {"standard_name": "depth", "axis": "Z", "positive": "down"}

OF_COMPONENT: Mapping[str, tuple[str, str, Attributes]] = {
    "depth_top": ("m", "depth of the upper end", _DOWN),
    "x_top": ("m", f"{_EAST}, of the upper end", {}),
    "y_top": ("m", f"{_NORTH}, of the upper end", {}),
    "tension_top": ("N", "tension at the upper end", {}),
    "tension_bottom": ("N", "tension at the lower end", {}),
    "tilt": ("degree", "angle of the chord from the vertical", {}),
    "knockdown": ("m", "depth of the upper end below that in still water", {}),
}
"""Unit, meaning and further attributes of the variables of a piece of the line."""

OF_CLAMP: Mapping[str, tuple[str, str, Attributes]] = {
    "clamp_depth": ("m", "depth of the clamped instrument", _DOWN),
    "clamp_x": ("m", f"{_EAST}, of the clamped instrument", {}),
    "clamp_y": ("m", f"{_NORTH}, of the clamped instrument", {}),
    "clamp_tension": ("N", "tension at the clamp", {}),
    "clamp_tilt": ("degree", "angle of the line at the clamp from the vertical", {}),
    "clamp_knockdown": ("m", "depth of the clamped instrument below that in still water", {}),
}
"""The same of a clamped instrument."""

OF_ENDS: Mapping[str, tuple[str, str, Attributes]] = {
    "top_depth": ("m", "depth of the free end", {}),
    "anchor_vertical": ("N", "upward pull of the line on the anchor", {}),
    "anchor_horizontal": ("N", "horizontal pull of the line on the anchor", {}),
    "used_buoyancy": ("1", "share in use of the buoyancy that is at the surface", {}),
}
"""The same of the line as a whole."""

OF_NODE: Mapping[str, tuple[str, str, Attributes]] = {
    "shape_depth": ("m", "depth of the line", _DOWN),
    "shape_x": ("m", f"{_EAST}, of the line", {}),
    "shape_y": ("m", f"{_NORTH}, of the line", {}),
    "shape_tension": ("N", "tension of the line", {}),
}
"""The same of a node of the line."""


@dataclass(frozen=True)
class Variable:
    """A variable of a result; `values` is None where it goes with time, and comes in blocks."""

    name: str
    dimensions: tuple[str, ...]
    dtype: str
    attributes: Attributes = field(default_factory=dict)
    values: NDArray[Any] | None = None


@dataclass(frozen=True)
class ResultLayout:
    """A result before its variables that go with time are known.

    Attributes
    ----------
    sizes : of the dimensions
    variables : in the order of the result
    attributes : of the result as a whole
    """

    sizes: Mapping[str, int]
    variables: tuple[Variable, ...]
    attributes: Attributes

    @property
    def in_blocks(self) -> list[Variable]:
        """The variables that go with time."""
        return [variable for variable in self.variables if variable.values is None]


def numbers(
    dimensions: tuple[str, ...],
    quantities: Mapping[str, tuple[str, str, Attributes]],
    coordinates: str,
    values: Mapping[str, NDArray[Any]] | None = None,
) -> list[Variable]:
    """Variables of numbers; a coordinate among them is not its own.

    Parameters
    ----------
    coordinates : names of those that go with the variables
    values : by name; those that go with time have none yet
    """
    variables = []
    for name, (unit, meaning, more) in quantities.items():
        beside = [other for other in coordinates.split() if other != name]
        attributes: Attributes = {"units": unit, "long_name": meaning, **more}
        if beside:
            attributes["coordinates"] = " ".join(beside)
        if values is None:
            variables.append(Variable(name, dimensions, NUMBER, attributes))
        else:
            variables.append(Variable(name, dimensions, "<f8", attributes, values[name]))
    return variables


def labels(name: str, dimension: str, texts: Iterable[str], meaning: str) -> Variable:
    """Return a variable of names along a dimension.

    Parameters
    ----------
    name, dimension : of the variable
    texts : the names
    meaning : what they name
    """
    values = np.array(list(texts), dtype=np.str_)
    return Variable(name, (dimension,), values.dtype.str, {"long_name": meaning}, values)


def station(name: str, place: Sequence[float], of_what: str) -> tuple[list[Variable], str]:
    """A mooring as a station, and what variables say of it among their coordinates.

    Parameters
    ----------
    place : latitude and longitude [degrees north, degrees east]; without them there is no feature
        in the sense of the conventions, which is at a place
    of_what : is there
    """
    said = np.array(name, dtype=np.str_)
    attributes: Attributes = {"long_name": "name of the mooring"}
    if len(place) < len(_PLACE):
        return [Variable("station", (), said.dtype.str, attributes, said)], " station"
    attributes["cf_role"] = "timeseries_id"
    return [
        Variable("station", (), said.dtype.str, attributes, said),
        *(
            Variable(
                axis, (), "<f8",
                {"standard_name": axis, "long_name": f"{axis} of {of_what}", "units": unit},
                np.array(value),
            )
            for (axis, unit), value in zip(_PLACE.items(), place, strict=True)
        ),
    ], f" {' '.join(_PLACE)} station"  # fmt: skip


def origin(path: str, name: str, description: str, command: str) -> Attributes:
    """The attributes of a result that tell where it comes from; what is not known is empty.

    The only date is that of `SOURCE_DATE_EPOCH`, so that the same input gives the same bytes.

    Parameters
    ----------
    path, name, description : of the mooring file
    command : of CALM
    """
    made = f"calm {__version__} {command}"
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    if epoch:
        made = f"{datetime.fromtimestamp(int(epoch), UTC):%Y-%m-%dT%H:%M:%SZ} {made}"
    return {
        "Conventions": "CF-1.11",
        "title": name or Path(path).stem,
        "summary": description,
        "source": f"static equilibrium by CALM {__version__}",
        "calm": __version__,
        "history": made,
        "input": Path(path).read_text(encoding="utf-8"),
    }
