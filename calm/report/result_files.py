"""Results as JSON, as CSV with a row for each piece and clamp, and as NetCDF.

The NetCDF variables have the same names as in batch files.
"""

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.case.columns import Output, shown_in, terms
from calm.case.design import Result
from calm.case.result_tables import (
    MOORED_ENDS,
    OF_ROWS,
    TOWED_ENDS,
    Clamps,
    Components,
    Shape,
    rows_down,
)
from calm.dataset import netcdf
from calm.dataset.netcdf import Attributes, labels, numbers
from calm.files.mooring_file import leg_numbers
from calm.records.delimited import table_csv


def header() -> tuple[str, ...]:
    """Return the column names of the CSV header, with units in brackets."""
    return ("mooring", "part", *(one.header for one in Components.columns(Output.CSV)))


def to_csv(results: Sequence[Result]) -> str:
    """Write the components of one or several moorings or tows as CSV text.

    The row of a clamped instrument follows the row of its piece. The row of a clamped instrument
    has equal values for the upper and the lower end, and no length. Unknown numbers are empty. With
    a net, the last column names the leg of the net. Lines end in LF.
    """
    rows = [row for result in results for row in _rows(result)]
    more = shown_in(OF_ROWS, Output.CSV)
    shown = len(header())
    used = [at for at in range(len(more)) if any(row[shown + at] is not None for row in rows)]
    heads = *header(), *(more[at].header for at in used)
    return table_csv(heads, ([*row[:shown], *(row[shown + at] for at in used)] for row in rows))


def _rows(result: Result) -> Iterator[list[object]]:
    own, more = Components.columns(Output.CSV), shown_in(OF_ROWS, Output.CSV)
    for component, clamps in rows_down(result):
        beside = [one.value(component, result.file) for one in more]
        figures = (getattr(component, one.name) for one in own)
        yield [result.name, "component", *figures, *beside]
        for clamp in clamps:
            # a clamp has one value where a component has one for each end
            names = (one.name.removesuffix("_top").removesuffix("_bottom") for one in own)
            figures = (getattr(clamp, name, None) for name in names)
            yield [result.name, "clamp", *figures, *beside]


_ACCURACY: dict[str, tuple[str, str, Attributes]] = {
    "accuracy_depth": ("m", "worst error expected of any depth or offset", {}),
    "accuracy_tension": ("N", "worst error expected of any tension", {}),
}


def result_netcdf(result: Result) -> bytes:
    """Create the NetCDF file of one mooring, tow or net, in double precision.

    Unknown values are NaN. For a net, ends and shape nodes are listed leg by leg.
    """
    file, pieces, clamps = result.file, result.components, result.clamps
    place = () if file.position is None else (file.position.latitude, file.position.longitude)
    of_station, where = netcdf.station(result.name or "mooring", place, "the anchor")
    lines = result.legs
    of_nodes = Shape.columns(Output.NETCDF)
    nodes = {
        one.variable: np.concatenate([getattr(line.shape, one.name) for line in lines])
        for one in of_nodes
    }
    sizes = {"component": len(pieces), "node": sum(len(line.shape.depth) for line in lines)}
    variables = [
        *of_station,
        labels("component_label", "component", pieces.label, netcdf.PIECES),
        *_table_variables("component", pieces, f"component_label depth_top{where}"),
    ]
    if len(clamps):
        sizes["clamp"] = len(clamps)
        variables.append(labels("clamp_label", "clamp", clamps.label, netcdf.CLAMPS))
        variables += _table_variables("clamp", clamps, f"clamp_label clamp_depth{where}")
    variables += numbers(("node",), terms(of_nodes), f"shape_depth{where}", _as_floats(nodes))
    accuracy = {f"accuracy_{name}": getattr(result.accuracy, name) for name in ("depth", "tension")}
    of_ends = shown_in(TOWED_ENDS if result.towed else MOORED_ENDS, Output.NETCDF)
    ends = {one.name: [one.found(line) for line in lines] for one in of_ends if one.found}
    along: tuple[str, ...] = ()
    if result.several:
        sizes["leg"], along = len(lines), ("leg",)
        own = leg_numbers(file)
        variables = netcdf.of_net(
            variables, [line.name for line in lines], own, [own[row.index] for row in clamps],
            [n for n, line in enumerate(lines) for _ in line.shape.depth],
        )  # fmt: skip
    else:
        ends = {name: column[0] for name, column in ends.items()}
    variables += numbers(along, terms(of_ends), where.strip(), _as_floats(ends))
    variables += numbers((), _ACCURACY, where.strip(), _as_floats(accuracy))
    variables += netcdf.down_the_line(sizes)
    attributes = {
        **netcdf.origin(file.path, result.name, file.description, "run"),
        "title": f"{result.name or Path(file.path).stem}: its equilibrium",
        "status": result.status,
        "notes": "\n".join(result.warnings),
    }
    known = {name: value for name, value in attributes.items() if value}
    return netcdf.netcdf_of(netcdf.ResultLayout(sizes, tuple(variables), known))


def _table_variables(
    dimension: str, table: Components | Clamps, beside: str
) -> list[netcdf.Variable]:
    """Create the NetCDF variables of a table.

    `beside` is the names of the coordinate variables.
    """
    columns = table.columns(Output.NETCDF)
    figures = _as_floats({one.variable: getattr(table, one.name) for one in columns})
    return numbers((dimension,), terms(columns), beside, figures)


def _as_floats(columns: Mapping[str, Any]) -> dict[str, NDArray[np.float64]]:
    return {name: np.asarray(column, np.float64) for name, column in columns.items()}


UNITS = {"length": "m", "force": "N", "angle": "deg", "mass": "kg", "speed": "m/s", "time": "s"}
"""Units in every JSON document."""


def to_json(documents: list[dict[str, Any]]) -> str:
    """Create JSON text: an object for one document, or an array for several documents.

    Documents with a key `calm` get a key `units`. Numbers that are not finite become null. The text
    is ASCII.
    """
    with_units = [{**each, "units": UNITS} if "calm" in each else each for each in documents]
    content = with_units[0] if len(with_units) == 1 else with_units
    return json.dumps(_finite_or_none(content), indent=2, allow_nan=False) + "\n"


def _finite_or_none(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _finite_or_none(member) for name, member in value.items()}
    if isinstance(value, list | tuple):
        return [_finite_or_none(member) for member in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def members(value: object, *names: str) -> dict[str, Any]:
    """Return the named attributes of an object as a dictionary."""
    return {name: getattr(value, name) for name in names}
