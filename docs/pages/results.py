"""The names in results: of JSON, CSV and NetCDF, with units, from results themselves."""

import io
from collections.abc import Iterator, Mapping
from typing import Any

import xarray as xr

import calm
from calm.batch.profiles import Profiles
from calm.case.columns import Output, ResultColumn, columns_of
from calm.case.result_tables import ENDS, NET_ENDS, OF_ROWS, Clamps, Components, Shape
from calm.motion.correction import OF_MOTION
from calm.quantities import QUANTITIES
from calm.report.result_files import result_netcdf
from calm.shipped import shipped_folder
from pages.markdown import code, plain, table

HEAD = """# Names in results

These are the names in the output of `calm run`, `calm batch` and `calm motion`. Values are in SI
units and degrees. x is east and y north of the anchor or the tow point; depths are positive
downwards. Unknown values are `null` in JSON, empty in CSV, NaN in NetCDF. The JSON of other
commands is on their pages:
[`calm check`](check.md#json), [`calm batch`](batch-statistics.md),
[`calm deck`](deck.md), [`calm locate`](locate.md),
[`calm diff`](diff.md).
"""
_MOORED, _TOWED = "fit-top-depth", "depressor-fit-depth"
_MEANINGS = {
    "calm": ("", "the version of CALM"),
    "name": ("", "the name of the mooring"),
    "type": ("", "`subsurface`, `surface` or `tow`"),
    "status": ("", "`converged`, or [another status](messages.md#statuses)"),
    "iterations": ("", "number of integrations along the line"),
    "segments": ("", "number of segments of the line"),
    "miss": ("m", "distance of the end of the line from its anchor"),
    "closure": ("", "remaining sum of the forces, as a share of the maximum"),
    "strumming": ("", "`frequency`, `cn_min` and `cn_max`, with a law of strumming"),
    "strumming_band": ("", "`null` with a law of strumming"),
    "strumming_band.factor": ("", "factor on the Cn of every cable"),
    "strumming_band.status": ("", "status of the line with that factor"),
    "other_equilibrium": (
        "",
        "depth of the free end, length on the seabed, share of the float's buoyancy in use, and "
        "anchor load in another equilibrium; `null` if none was found",
    ),
    "warnings": ("", "[sentences](messages.md#warnings)"),
    "toward": ("deg", "course of the ship, clockwise from north"),
    "cn_min": ("", "minimum Cn of the strumming cables"),
    "cn_max": ("", "maximum Cn of the strumming cables"),
}


def page() -> str:
    """The text of the page."""
    moored, towed = (
        calm.load(shipped_folder("lines") / f"{name}.yaml").solve() for name in (_MOORED, _TOWED)
    )
    parts = [HEAD]
    of_mooring = dict(_keys(moored.to_dict()))
    parts += ["## JSON of a mooring", table(("key", "unit", "meaning"), map(_json, of_mooring))]
    own = [key for key in _keys(towed.to_dict()) if key[0] not in of_mooring]
    parts += [
        "## JSON of a tow",
        "The keys of a mooring, with these in place of `top` and `anchor`:",
        table(("key", "unit", "meaning"), (_json(key) for key, _ in own)),
        "## JSON of a net of legs",
        "The keys of a mooring without `top` and `shape`. Pieces and clamps have the name of their "
        "`leg`; `anchor` is present only in a net with a single anchor. `held` has the keys of "
        "`anchors` up to `depth`. Each of `legs` has its `name`, `closure`, `used_buoyancy`, "
        "`reserve` and `shape`.",
        table(
            ("key", "unit", "meaning"),
            [_json(key) for key in _COLUMNS if key.startswith(("anchors[", "nodes["))],
        ),
        "## CSV",
        "A row for each piece and each clamped instrument:",
        table(("column", "meaning"), _csv()),
        "## NetCDF of one equilibrium",
        table(("variable", "dimensions", "unit", "meaning"), _netcdf(result_netcdf(moored))),
        "A tow has these values instead of the values at its ends:",
        table(
            ("variable", "dimensions", "unit", "meaning"),
            [row for row in _netcdf(result_netcdf(towed)) if "ship" in row[3] or "tow" in row[3]],
        ),
        "## NetCDF and zarr of a batch",
        table(("variable", "dimensions", "unit", "meaning"), _batch()),
        "## Further variables of `calm motion`",
        table(("variable", "dimensions", "unit", "meaning"), _motion()),
    ]
    return "\n\n".join(parts)


def _keys(document: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    """Paths of all values in a JSON object; a list of objects is described by its first item."""
    for key, value in document.items():
        if isinstance(value, dict):
            yield from _keys(value, f"{before}{key}.")
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            yield from _keys(value[0], f"{before}{key}[].")
        elif value != []:
            yield f"{before}{key}", value


_COLUMNS = {
    f"{part}{one.name}": one
    for part, columns in {
        "components[].": (*OF_ROWS, *Components.columns()),
        "clamps[].": (*OF_ROWS, *Clamps.columns()),
        "shape.": Shape.columns(),
        **{f"{end}.": columns_of(record) for end, record in ENDS.items()},
        **{f"{ends}[].": columns_of(record) for ends, record in NET_ENDS.items()},
    }.items()
    for one in columns
}
"""The columns of results by the keys of JSON."""


def _json(key: str) -> tuple[str, str, str]:
    last = key.rpartition(".")[2]
    if key in _COLUMNS:
        return code(key), _COLUMNS[key].unit, plain(_COLUMNS[key].description)
    if key in _MEANINGS or last in _MEANINGS:
        unit, meaning = _MEANINGS.get(key) or _MEANINGS[last]
        return code(key), unit, meaning
    quantity = QUANTITIES[last]
    return code(key), quantity.unit, plain(quantity.meaning)


def _csv() -> Iterator[tuple[str, str]]:
    yield code("mooring"), "its name"
    yield code("part"), "`component` or `clamp`"
    for one in Components.columns(Output.CSV):
        yield code(one.header), plain(one.description)


def _netcdf(content: bytes) -> list[tuple[str, str, str, str]]:
    with xr.open_dataset(io.BytesIO(content), engine="h5netcdf") as dataset:
        return [
            _variable(str(name), map(str, one.dims), one.attrs)
            for name, one in dataset.variables.items()
        ]


def _variable(name: str, dimensions: Any, attributes: Mapping[str, Any]) -> tuple[str, ...]:
    unit = attributes.get("units", "")
    return code(name), ", ".join(dimensions), unit, plain(attributes.get("long_name", ""))


def _batch() -> Iterator[tuple[str, ...]]:
    yield code("time"), "time", "", "time of the profile"
    entered: dict[str, list[ResultColumn]] = {
        **Profiles.columns(),
        "node": Shape.columns(Output.BATCH),
    }
    for dimension, columns in entered.items():
        for one in columns:
            yield _variable(one.variable, filter(None, ("time", dimension)), one.described)
    yield (
        code("status"),
        "time",
        "",
        "0 if there is an equilibrium; `flag_meanings` explains the other values",
    )


def _motion() -> Iterator[tuple[str, ...]]:
    for name, (dimensions, (unit, meaning, _)) in OF_MOTION.items():
        yield _variable(name, ("time", *dimensions), {"units": unit, "long_name": meaning})
