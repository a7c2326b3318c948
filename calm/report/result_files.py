"""Results as files: JSON; CSV, a row for each piece and clamp; NetCDF with a batch's names."""

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.case import Result, TowResult
from calm.case.result import AnyResult, NetResult
from calm.case.result_tables import ClampRow, ComponentRow, Components, rows_down
from calm.dataset import netcdf
from calm.dataset.netcdf import CLAMPS, OF_CLAMP, OF_COMPONENT, OF_ENDS, Attributes, labels, numbers
from calm.files.mooring_file import leg_numbers
from calm.quantities import QUANTITIES
from calm.records.delimited import table_csv

_WORDS = ("mooring", "part", "index", "use", "label")
_WITHIN = {"tension", "least_tension", "reynolds"}
"""What is greatest or least within a piece: a row has the figures of its ends."""

_NUMBERS = tuple(name for name in Components.names() if name in QUANTITIES and name not in _WITHIN)
HEADER = (*_WORDS, *(QUANTITIES[name].header for name in _NUMBERS))
"""The first row: names, with the unit in brackets where there is one."""


def to_csv(results: Sequence[AnyResult]) -> str:
    """The components of one mooring or tow, or of several, as CSV text (UTF-8, comma, point, LF).

    `part` is ``component`` or ``clamp``; the rows of clamped instruments follow the piece they sit
    on, with equal figures for both ends and no length. A number that is unknown is left empty. With
    a net among them the last column is the leg.
    """
    rows = [row for result in results for row in _rows(result)]
    wide = max(map(len, rows), default=0)
    header = (*HEADER, "leg")[: max(wide, len(HEADER))]
    return table_csv(header, ([*row, *[""] * (wide - len(row))] for row in rows))


def _rows(result: AnyResult) -> Iterator[list[object]]:
    legs, own = result.file.legs, leg_numbers(result.file)
    for component, clamps in rows_down(result):
        leg = [legs[own[component.index]].name] if legs else []
        numbers = (getattr(component, name) for name in _NUMBERS)
        yield [*_words(result, "component", component), *numbers, *leg]
        for clamp in clamps:
            # a clamp has one figure where a component has one for each end
            names = (name.removesuffix("_top").removesuffix("_bottom") for name in _NUMBERS)
            numbers = (getattr(clamp, name, None) for name in names)
            yield [*_words(result, "clamp", clamp), *numbers, *leg]


def _words(result: AnyResult, part: str, row: ComponentRow | ClampRow) -> list[object]:
    return [result.name, part, row.index, row.use, row.label]


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


def result_netcdf(result: AnyResult) -> bytes:
    """The file of one mooring, tow or net, figures of 64 bits; what is unknown is NaN.

    A net has its ends leg by leg, and the nodes of its shape one leg after the other.
    """
    file, pieces, clamps = result.file, result.components, result.clamps
    ends = _ends(result)
    place = () if file.position is None else (file.position.latitude, file.position.longitude)
    of_station, where = netcdf.station(result.name or "mooring", place, "the anchor")
    lines = result.legs if isinstance(result, NetResult) else (result,)
    of_node = {
        f"shape_{name}": np.concatenate([getattr(line.shape, name) for line in lines])
        for name in vars(lines[0].shape)
    }
    sizes = {"component": len(pieces), "node": len(of_node["shape_depth"])}
    variables = [*of_station, labels("component_label", "component", pieces.label, netcdf.PIECES)]
    of_component = {name: getattr(pieces, name) for name in (*OF_COMPONENT, *_MORE)}
    of_clamp = {name: getattr(clamps, name.removeprefix("clamp_")) for name in OF_CLAMP}
    beside = f"component_label depth_top{where}"
    variables += numbers(("component",), {**OF_COMPONENT, **_MORE}, beside, _floats(of_component))
    if len(clamps):
        sizes["clamp"] = len(clamps)
        variables.append(labels("clamp_label", "clamp", clamps.label, CLAMPS))
        beside = f"clamp_label clamp_depth{where}"
        variables += numbers(("clamp",), OF_CLAMP, beside, _floats(of_clamp))
    variables += numbers(
        ("node",), {**netcdf.OF_NODE, **_TILT}, f"shape_depth{where}", _floats(of_node)
    )
    accuracy = {f"accuracy_{name}": getattr(result.accuracy, name) for name in ("depth", "tension")}
    of_ends = _OF_TOW if isinstance(result, TowResult) else OF_ENDS
    along: tuple[str, ...] = ()
    if isinstance(result, NetResult):
        sizes["leg"], along = len(lines), ("leg",)
        own = leg_numbers(file)
        variables = netcdf.of_net(
            variables, [line.name for line in lines], own, [own[row.index] for row in clamps],
            [n for n, line in enumerate(lines) for _ in line.shape.depth],
        )  # fmt: skip
    variables += numbers(along, of_ends, where.strip(), _floats(ends))
    variables += numbers((), _ACCURACY, where.strip(), _floats(accuracy))
    variables += netcdf.down_the_line(sizes)
    attributes = {
        **netcdf.origin(file.path, result.name, file.description, "run"),
        "title": f"{result.name or Path(file.path).stem}: its equilibrium",
        "status": result.status,
        "notes": "\n".join(result.warnings),
    }
    known = {name: value for name, value in attributes.items() if value}
    return netcdf.netcdf_of(netcdf.ResultLayout(sizes, tuple(variables), known))


def _ends(result: AnyResult) -> Mapping[str, object]:
    """Return what is known of the line as a whole, or of each leg."""
    if isinstance(result, NetResult):
        return result.ends
    if isinstance(result, Result):
        return {
            "top_depth": result.top.depth,
            "anchor_vertical": result.anchor.vertical,
            "anchor_horizontal": result.anchor.horizontal,
            "used_buoyancy": result.top.used_buoyancy,
            "other_used_buoyancy": result.other_used_buoyancy,
        }
    return {
        "speed": result.speed,
        "body_depth": result.body.depth,
        "layback": result.body.layback,
        "tow_tension": result.tow_point.tension,
    }


def _floats(columns: Mapping[str, Any]) -> dict[str, NDArray[np.float64]]:
    return {name: np.asarray(column, np.float64) for name, column in columns.items()}


UNITS = {"length": "m", "force": "N", "angle": "deg", "mass": "kg", "speed": "m/s", "time": "s"}
"""The units of every JSON document."""


def to_json(documents: list[dict[str, Any]]) -> str:
    """Return JSON text: one document as an object, several as an array in the order given.

    Results, which name the `calm` that made them, say their units. A number that is not finite
    becomes null, since JSON has none. The text is plain ASCII, so that no terminal or pipe can
    spoil it.
    """
    told = [{**each, "units": UNITS} if "calm" in each else each for each in documents]
    content = told[0] if len(told) == 1 else told
    return json.dumps(_finite(content), indent=2, allow_nan=False) + "\n"


def _finite(value: Any) -> Any:
    """Return a document with None in place of numbers that are not finite."""
    if isinstance(value, dict):
        return {name: _finite(member) for name, member in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(member) for member in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def members(value: object, *names: str) -> dict[str, Any]:
    """Return what a document tells of an object: some of its attributes by their names."""
    return {name: getattr(value, name) for name in names}
