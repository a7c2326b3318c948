"""Results as files: JSON; CSV, a row for each piece and clamp; NetCDF with a batch's names."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.case import Result, TowResult
from calm.case.net import AnyResult
from calm.case.result_tables import ClampRow, ComponentRow, Components, rows_down
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
    on, with equal figures for both ends and no length. A number that is unknown is left empty.
    """
    return table_csv(HEADER, (row for result in results for row in _rows(result)))


def _rows(result: AnyResult) -> Iterator[list[object]]:
    for component, clamps in rows_down(result):
        numbers = (getattr(component, name) for name in _NUMBERS)
        yield [*_words(result, "component", component), *numbers]
        for clamp in clamps:
            # a clamp has one figure where a component has one for each end
            names = (name.removesuffix("_top").removesuffix("_bottom") for name in _NUMBERS)
            numbers = (getattr(clamp, name, None) for name in names)
            yield [*_words(result, "clamp", clamp), *numbers]


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


UNITS = {
    "length": "m",
    "force": "N",
    "angle": "deg",
    "mass": "kg",
    "speed": "m/s",
    "time": "s",
}
"""The units of every JSON document."""


def to_json(documents: list[dict[str, Any]]) -> str:
    """Return JSON text: one document as an object, several as an array in the order given.

    Results, which name the `calm` that made them, say their units. A number that is not finite
    becomes null, since JSON has none. The text is plain ASCII, so that no terminal or pipe can
    spoil it.
    """
    told = [{**each, "units": UNITS} if "calm" in each else each for each in documents]
    content = told[0] if len(told) == 1 else told
    return _indented(content, "\n") + "\n"


def _indented(value: Any, line: str) -> str:
    """Return what `json.dumps` writes with an indent of two; `line` begins a line at this depth.

    Its encoder is fast only without an indent: so it writes all that has no further level in it.
    """
    if not isinstance(value, _NESTED) or not value:
        return _encoder(",")(_finite(value))
    below = line + "  "
    members = [*value.values()] if isinstance(value, dict) else value
    if not any(isinstance(member, _NESTED) for member in members):
        finite = [*map(_finite, members)]
        flat = dict(zip(value, finite, strict=True)) if isinstance(value, dict) else finite
        text = _encoder("," + below)(flat)
        return text[0] + below + text[1:-1] + line + text[-1]
    texts = [_indented(member, below) for member in members]
    if isinstance(value, dict):
        named = (f"{json.dumps(name)}: {text}" for name, text in zip(value, texts, strict=True))
        return "{" + below + f",{below}".join(named) + line + "}"
    return "[" + below + f",{below}".join(texts) + line + "]"


@cache
def _encoder(between: str) -> Callable[[Any], str]:
    return json.JSONEncoder(separators=(between, ": "), allow_nan=False).encode


def _finite(value: Any) -> Any:
    """Return None in place of a number that is not finite."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


_NESTED = (dict, list, tuple)


def members(value: object, *names: str) -> dict[str, Any]:
    """Return what a document tells of an object: some of its attributes by their names."""
    return {name: getattr(value, name) for name in names}
