"""Results as CF datasets: their dimensions, variables and NetCDF 4 files."""

from __future__ import annotations

import os
import zlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.errors import UsageError
from calm.version import __version__
from calm.whole_file import beside, flush_to_disk, sweep

if TYPE_CHECKING:
    import h5netcdf

LEVEL = 1
"""Compression level. Higher levels take twice the time and save 3 % of the space."""

Chunks = Mapping[str, bytes]
"""Compressed bytes of one block, by name of the time-dependent variable."""

# bytes of metadata that HDF5 needs at most for a chunk and for a variable
_OF_A_CHUNK, _OF_A_VARIABLE = 512, 65_536
_LONG = 4096  # all attributes of a variable have 64 kB unless they are strings
_ZEROS = bytes(1 << 20)


def netcdf_of(layout: ResultLayout, block: int = 0) -> bytes:
    """Return the content of a new NetCDF file, in which time-dependent variables are empty.

    Time-dependent variables are divided into chunks of `block` times.
    """
    import h5netcdf

    image = BytesIO()
    with h5netcdf.File(image, "w") as file:
        file.dimensions = dict(layout.sizes)
        for name, value in sorted(layout.attributes.items()):
            file.attrs[name] = _text(value)
        for variable in layout.variables:
            _define(file, layout, variable, block)
    return image.getvalue()


def packed(layout: ResultLayout, block: int, arrays: Mapping[str, NDArray[Any]]) -> Chunks:
    """Compress the values of one block of times; return one HDF5 chunk for each variable.

    `block` is the number of times in a chunk. `arrays` contains the values by variable name. The
    first dimension of each array is time, with at most `block` times.
    """
    chunks = {}
    for variable in layout.in_blocks:
        values, kind = arrays[variable.name], np.dtype(variable.dtype)
        nothing = np.nan if kind.kind == "f" else 0
        chunk = np.full(chunk_shape(layout, variable, block), nothing, kind)
        chunk[: len(values)] = values
        shuffled = chunk.reshape(-1).view(np.uint8).reshape(-1, kind.itemsize).T
        chunks[variable.name] = zlib.compress(shuffled.tobytes(), LEVEL)
    return chunks


def write_netcdf(
    layout: ResultLayout,
    block: int,
    blocks: Iterable[Chunks],
    path: Path,
    last: Callable[[], Attributes] = dict,
) -> None:
    """Write a NetCDF file in blocks of times.

    Parameters
    ----------
    block : number of times in a block
    blocks : results of `packed`, in order
    last : function that returns the attributes known only after the last block; the layout
        contains placeholders for these attributes: numbers, or texts of the final length

    Raises
    ------
    UsageError
        The file cannot be written, for example because the disk is full; an older file is kept.
    """
    import h5py

    sweep(path.parent, path.name)
    image = netcdf_of(layout, block)
    changing = layout.in_blocks
    count = -(-layout.sizes[changing[0].dimensions[0]] // block)
    room = len(image) + (_OF_A_CHUNK * count + _OF_A_VARIABLE) * len(changing)
    try:
        with beside(path) as part:
            with part.open("r+b") as stream:
                stream.write(image)
                stream.flush()
                # HDF5 aborts the process if a write fails, so the space is reserved first
                _take_room(stream.fileno(), room)
                with h5py.File(part, "r+") as file:
                    for number, chunks in enumerate(blocks):
                        room += sum(map(len, chunks.values()))
                        _take_room(stream.fileno(), room)
                        for name, content in chunks.items():
                            begin = number * block, *(0 for _ in file[name].shape[1:])
                            file[name].id.write_direct_chunk(begin, content)
                    for name, value in last().items():
                        file.attrs.modify(name, _text(value))
                    file.flush()
                    size = file.id.get_filesize()
            os.truncate(part, size)
            flush_to_disk([part])
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror or error}") from None


def _take_room(handle: int, size: int) -> None:
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(handle, 0, size)
        return
    while (missing := size - os.lseek(handle, 0, os.SEEK_END)) > 0:
        os.write(handle, _ZEROS[:missing])


def chunk_shape(layout: ResultLayout, variable: Variable, block: int) -> tuple[int, ...]:
    """Return the chunk shape of a time-dependent variable.

    `block` is the largest number of times in a chunk. An incomplete last chunk has the same shape.
    """
    length = min(block, layout.sizes[variable.dimensions[0]])
    return length, *(layout.sizes[name] for name in variable.dimensions[1:])


def _define(file: h5netcdf.File, layout: ResultLayout, variable: Variable, block: int) -> None:
    import h5py

    kind = np.dtype(variable.dtype)
    settings: dict[str, Any] = {}
    if variable.values is None:
        settings = {
            "chunks": chunk_shape(layout, variable, block),
            "compression": "gzip",
            "compression_opts": LEVEL,
            "shuffle": kind.itemsize > 1,
        }
    if kind.kind == "f" and variable.values is None:
        settings["fillvalue"] = kind.type(np.nan)
    defined = file.create_variable(
        variable.name,
        variable.dimensions,
        h5py.string_dtype() if kind.kind == "U" else kind,
        **settings,
    )
    for name, value in sorted(variable.described.items()):
        defined.attrs[name] = np.array(value, kind) if isinstance(value, list) else _text(value)
    if variable.values is not None:
        defined[...] = variable.values.astype(object) if kind.kind == "U" else variable.values


def _text(value: str | float) -> str | float | np.bytes_:
    if isinstance(value, float):
        return value
    # every tool can read characters; long texts and other alphabets need a string
    return np.bytes_(value) if value.isascii() and len(value) < _LONG else value


Attributes = dict[str, Any]

PIECES = "piece of the line, in order from the top"
"""Description of the labels along the dimension `component`."""

CLAMPS = "clamped instrument, in order from the top"
"""Description of the labels along the dimension `clamp`."""

NUMBER = "<f4"
"""Data type of time-dependent depths, offsets, forces and angles.

These values are NaN at times without an equilibrium.
"""

_PLACE = {"latitude": "degrees_north", "longitude": "degrees_east"}


def of_net(
    variables: Iterable[Variable],
    names: Iterable[str],
    components: Iterable[int],
    clamps: Iterable[int],
    nodes: Iterable[int] = (),
) -> list[Variable]:
    """Adapt the variables of a single line to a net.

    In the descriptions of offsets, the anchor is replaced by the origin of the net. Variables with
    the leg names and leg indices are added.

    Parameters
    ----------
    names : names of the legs
    components, clamps, nodes : index of the leg of each component, clamp and node
    """
    found = []
    for one in variables:
        text = str(one.attributes.get("long_name", "")).replace("of the anchor,", "of the origin,")
        found.append(replace(one, attributes={**one.attributes, "long_name": text}))
    meaning = "name of the leg; the parts of a leg are in order from its upper end"
    found.append(labels("leg_label", "leg", names, meaning))
    for part, legs in (("component", components), ("clamp", clamps), ("node", nodes)):
        index_attributes = {
            "units": "1",
            "long_name": f"index of the leg that contains the {part} (the first is 0)",
        }
        values = np.array([*legs], np.int32)
        if len(values):
            found.append(Variable(f"{part}_leg", (part,), "<i4", index_attributes, values))
    return found


@dataclass(frozen=True)
class Variable:
    """NetCDF variable; `values` is None for a time-dependent variable."""

    name: str
    dimensions: tuple[str, ...]
    dtype: str
    attributes: Attributes = field(default_factory=dict)
    values: NDArray[Any] | None = None

    @property
    def described(self) -> Attributes:
        """Attributes, with the ACDD attribute `coverage_content_type` for a numeric variable."""
        if "units" not in self.attributes and "flag_meanings" not in self.attributes:
            return self.attributes
        content = "modelResult"
        if "axis" in self.attributes or self.name in _PLACE:
            content = "coordinate"
        elif "flag_meanings" in self.attributes or self.name.endswith("_sd"):
            content = "qualityInformation"
        return {"coverage_content_type": content, **self.attributes}


@dataclass(frozen=True)
class ResultLayout:
    """Variables, dimensions and attributes of a result, without time-dependent values.

    Attributes
    ----------
    sizes : sizes of the dimensions
    attributes : global attributes
    """

    sizes: Mapping[str, int]
    variables: tuple[Variable, ...]
    attributes: Attributes

    @property
    def in_blocks(self) -> list[Variable]:
        """Time-dependent variables, which are written in blocks."""
        return [variable for variable in self.variables if variable.values is None]


def numbers(
    dimensions: tuple[str, ...],
    quantities: Mapping[str, tuple[str, str, Attributes]],
    coordinates: str,
    values: Mapping[str, NDArray[Any]] | None = None,
) -> list[Variable]:
    """Create numeric variables with their coordinates.

    Parameters
    ----------
    coordinates : names of the coordinates, separated by blanks
    values : values by name; None for time-dependent variables
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
    """Create a variable of labels along a dimension.

    `meaning` is the description of the labels, for the attribute `long_name`.
    """
    values = np.array(list(texts), dtype=np.str_)
    return Variable(name, (dimension,), values.dtype.str, {"long_name": meaning}, values)


def down_the_line(sizes: Mapping[str, int]) -> list[Variable]:
    """Create the index coordinates of the pieces, clamps, nodes, sensors and levels.

    The indices begin with 0 at the top. In the CF conventions, they are dimensionless vertical
    coordinates.
    """
    # depths vary in time, and adjacent parts may have equal depths
    return [
        Variable(
            name, (name,), "<i4",
            {"long_name": f"number of the {name}, counted down the line (the first is 0)",
             "units": "1", "axis": "Z", "positive": "down"},
            np.arange(sizes[name], dtype=np.int32),
        )
        for name in ("component", "clamp", "node", "sensor", "level")
        if sizes.get(name)
    ]  # fmt: skip


def station(name: str, place: Sequence[float], of_what: str) -> tuple[list[Variable], str]:
    """Create the CF station variables of a mooring; also return their names as text.

    The text is to be appended to the attribute `coordinates` of other variables.

    Parameters
    ----------
    place : latitude and longitude [degrees north, degrees east]; if empty, the station has a name
        only, and the dataset does not follow the CF rules for stations
    of_what : object at this position, for the attribute `long_name`
    """
    label = np.array(name, dtype=np.str_)
    attributes: Attributes = {"long_name": "name of the mooring"}
    if len(place) < len(_PLACE):
        return [Variable("station", (), label.dtype.str, attributes, label)], " station"
    attributes["cf_role"] = "timeseries_id"
    return [
        Variable("station", (), label.dtype.str, attributes, label),
        *(
            Variable(
                axis, (), "<f8",
                {"standard_name": axis, "long_name": f"{axis} of {of_what}", "units": unit},
                np.array(value),
            )
            for (axis, unit), value in zip(_PLACE.items(), place, strict=True)
        ),
    ], f" {' '.join(_PLACE)} station"  # fmt: skip


def source_date() -> datetime | None:
    """Return the time given by SOURCE_DATE_EPOCH, in UTC, or None if it is not set."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    return datetime.fromtimestamp(int(epoch), UTC) if epoch.isdigit() else None


def origin(path: str, name: str, description: str, command: str) -> Attributes:
    """Return global attributes about the origin of a result; unknown attributes are empty.

    A date is written only if `SOURCE_DATE_EPOCH` is set. Therefore, the same input gives an
    identical file.

    `path`, `name` and `description` are those of the mooring file.
    """
    made = f"calm {__version__} {command}"
    if date := source_date():
        made = f"{date:%Y-%m-%dT%H:%M:%SZ} {made}"
    return {
        "Conventions": "CF-1.11",
        "title": name or Path(path).stem,
        "summary": description,
        "source": f"static equilibrium by CALM {__version__}",
        "calm": __version__,
        "history": made,
        "input": Path(path).read_text(encoding="utf-8"),
    }
