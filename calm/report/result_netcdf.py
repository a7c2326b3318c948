"""A result as NetCDF, with the names that the results of `calm batch` have, without their time."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.case import Result
from calm.dataset.netcdf import (
    CLAMPS,
    OF_CLAMP,
    OF_COMPONENT,
    OF_ENDS,
    OF_NODE,
    PIECES,
    Attributes,
    ResultLayout,
    labels,
    netcdf_of,
    numbers,
    origin,
    station,
)

if TYPE_CHECKING:
    from calm.case import TowResult

_MORE: dict[str, tuple[str, str, Attributes]] = {
    "depth_bottom": ("m", "depth of the lower end", {"standard_name": "depth", "positive": "down"}),
    "x_bottom": ("m", "offset to the east, of the lower end", {}),
    "y_bottom": ("m", "offset to the north, of the lower end", {}),
    "length": ("m", "length, stretched", {}),
    "cut_length": ("m", "length before any load", {}),
    "safety_factor": ("1", "breaking load over the greatest tension", {}),
    "utilisation": ("1", "greatest tension over the working load", {}),
}
_TILT: dict[str, tuple[str, str, Attributes]] = {
    "shape_tilt": ("degree", "angle of the segment that ends there from the vertical", {})
}
_ACCURACY: dict[str, tuple[str, str, Attributes]] = {
    "accuracy_depth": ("m", "worst error expected of any depth or offset", {}),
    "accuracy_tension": ("N", "worst error expected of any tension", {}),
}
_OF_TOW: dict[str, tuple[str, str, Attributes]] = {
    "speed": ("m s-1", "speed of the ship over the ground", {}),
    "body_depth": ("m", "depth of the towed body", {}),
    "layback": ("m", "horizontal distance of the towed body behind the tow point", {}),
    "tow_tension": ("N", "tension at the tow point", {}),
}


def result_netcdf(result: Result | TowResult) -> bytes:
    """The file of one mooring or tow, figures of 64 bits; what is unknown is NaN."""
    file, pieces, clamps = result.file, result.components, result.clamps
    ends = _ends(result)
    place = () if file.position is None else (file.position.latitude, file.position.longitude)
    of_station, where = station(result.name or "mooring", place, "the anchor")
    sizes = {"component": len(pieces), "node": len(result.shape.depth)}
    variables = [*of_station, labels("component_label", "component", pieces.label, PIECES)]
    of_component = {name: getattr(pieces, name) for name in (*OF_COMPONENT, *_MORE)}
    of_clamp = {name: getattr(clamps, name.removeprefix("clamp_")) for name in OF_CLAMP}
    of_node = {f"shape_{name}": column for name, column in vars(result.shape).items()}
    beside = f"component_label depth_top{where}"
    variables += numbers(("component",), {**OF_COMPONENT, **_MORE}, beside, _floats(of_component))
    if len(clamps):
        sizes["clamp"] = len(clamps)
        variables.append(labels("clamp_label", "clamp", clamps.label, CLAMPS))
        beside = f"clamp_label clamp_depth{where}"
        variables += numbers(("clamp",), OF_CLAMP, beside, _floats(of_clamp))
    variables += numbers(("node",), {**OF_NODE, **_TILT}, f"shape_depth{where}", _floats(of_node))
    accuracy = {f"accuracy_{name}": getattr(result.accuracy, name) for name in ("depth", "tension")}
    variables += numbers(
        (), {**(OF_ENDS if isinstance(result, Result) else _OF_TOW), **_ACCURACY},
        where.strip(), _floats({**ends, **accuracy}),
    )  # fmt: skip
    attributes = {
        **origin(file.path, result.name, file.description, "run"),
        "title": f"{result.name or Path(file.path).stem}: its equilibrium",
        "status": result.status,
        "notes": "\n".join(result.warnings),
    }
    known = {name: value for name, value in attributes.items() if value}
    return netcdf_of(ResultLayout(sizes, tuple(variables), known))


def _ends(result: Result | TowResult) -> dict[str, float]:
    """Return what is known of the line as a whole."""
    if isinstance(result, Result):
        return {
            "top_depth": result.top.depth,
            "anchor_vertical": result.anchor.vertical,
            "anchor_horizontal": result.anchor.horizontal,
            "used_buoyancy": result.top.used_buoyancy,
        }
    return {
        "speed": result.speed,
        "body_depth": result.body.depth,
        "layback": result.body.layback,
        "tow_tension": result.tow_point.tension,
    }


def _floats(columns: Mapping[str, Any]) -> dict[str, NDArray[np.float64]]:
    return {name: np.asarray(column, np.float64) for name, column in columns.items()}
