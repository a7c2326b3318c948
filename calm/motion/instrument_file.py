"""Copies of users' instrument files to which the estimated depths are added."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from calm.batch.finished import labels_of
from calm.dataset.discovery import (
    ARCHIVED,
    FLAGS,
    OF_FLAGS,
    archive_id,
    coverage,
    kept,
    mooring_in,
    vertical_extent,
    written,
)
from calm.dataset.netcdf import station
from calm.errors import UsageError, refused
from calm.motion.correction import ESTIMATED, MEASURED, MISSING
from calm.motion.matching import LinePlaces, points_of
from calm.motion.measurements import interpolated
from calm.motion.study import depths_at
from calm.quantities import QUANTITIES_MEASURED
from calm.records import cf_files
from calm.records.instrument_series import (
    Identity,
    conductivity_in,
    files_given,
    named,
    practical_salinity,
    who_along,
)
from calm.version import __version__
from calm.whole_file import beside

if TYPE_CHECKING:
    from xarray import Dataset

SEVERAL = ("depth", "depth_sd", "depth_qc")  # variables added to a file of several instruments
ONE = tuple(name.upper() for name in SEVERAL)  # the same for a single instrument
_OF_OLD = ("DEPTH_quality_control", "DEPTH_UNCERTAINTY", "INSTRUMENT_DEPTH")
NOMINAL = "NOMINAL_DEPTH"  # new name of the nominal depth `DEPTH` of a single instrument
_TIMES = ("time", "TIME", "Time")
_OF_MOTION = ("title", "keywords", "references")  # attributes that describe a motion file itself


@dataclass(frozen=True)
class Instruments:
    """A file of one or more instruments, which receives the estimated depths."""

    path: Path
    clock: str  # name of the time variable
    dimension: str  # name of the time dimension
    along: str | None  # name of the dimension of the instruments; None for a single instrument
    time: NDArray[np.datetime64]
    who: tuple[Identity, ...]  # the instruments
    # point of the line for each instrument; None for an unmatched instrument
    point: tuple[int | None, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the added variables."""
        return ONE if self.along is None else SEVERAL


def read_instruments(given: Path, line: LinePlaces) -> tuple[list[Instruments], list[str]]:
    """Read the instruments of a file or folder, and match them to points of the line.

    Also return notes on the matches.
    """
    seabed = float(line.still[-1])
    found = [_read(path, seabed) for _, path in files_given([str(given)])]
    everyone = [one for file in found for one in file.who]
    try:
        points, notes = points_of(everyone, line)
    except UsageError as error:
        raise UsageError(f"--onto: {given}: {error}") from None
    each = iter(range(len(everyone)))
    matched = [tuple(points.get(next(each)) for _ in file.who) for file in found]
    return [replace(one, point=point) for one, point in zip(found, matched, strict=True)], notes


def _read(path: Path, seabed: float) -> Instruments:
    if path.is_dir():
        raise refused(path, "is not a NetCDF, RODB or .cnv file, nor a text table of RBR")
    with cf_files.opened(path) as dataset:
        if groups := cf_files.groups_of(path):
            raise cf_files.UnreadableError(
                f"has groups ({', '.join(groups)}), which CALM cannot copy; save the variables of "
                "the instruments in a file without groups"
            )
        clock = next((name for name in _TIMES if name in dataset.variables), None)
        if clock is None or dataset[clock].ndim != 1:
            raise cf_files.UnreadableError("has no times")
        dimension = str(dataset[clock].dims[0])
        along, who = _who(dataset, dimension, seabed, path)
        _refuse_depths(dataset, path, dimension, along)
        times = cf_files.read_times(dataset, clock)
        return Instruments(path, clock, dimension, along, times, who, ())


def _who(
    dataset: Dataset, time: str, seabed: float, path: Path
) -> tuple[str | None, tuple[Identity, ...]]:
    """Return the instrument dimension, None for one instrument, and each instrument's identity."""
    others = [str(dim) for dim in dataset.sizes if dim != time]
    for dim in sorted(others, key=lambda dim: cf_files.labels_along(dataset, dim) is None):
        if dataset.sizes[dim] > 1 or cf_files.labels_along(dataset, dim) is not None:
            who = who_along(dataset, dim, seabed, path.name)
            if any(one.label or one.serial for one in who) or dim == "N_LEVELS":
                return dim, tuple(who)
    alone = who_along(dataset, None, seabed, path.name)
    if not alone[0].known:
        raise cf_files.UnreadableError(
            "identifies no instrument: it has no label (`instrument` or `label`), no serial number "
            "and no nominal depth"
        )
    return None, tuple(alone)


def _refuse_depths(dataset: Dataset, path: Path, time: str, along: str | None) -> None:
    names = ONE if along is None else SEVERAL
    counted = [name for name in names if dataset.sizes.get(name, 1) > 1 or name == along]
    if counted:
        raise UsageError(
            f"--onto: `{counted[0]}` is a dimension of {path}; rename it, because a variable with "
            "two dimensions cannot have the name of one of them"
        )
    for name in names:
        if name in dataset.variables and (along is not None or time in dataset[name].dims):
            raise UsageError(f"--onto: {path} already has `{name}`; rename that variable")


def write_depths(
    instruments: Instruments,
    result: Dataset,
    gap: np.timedelta64,
    output: Path,
    inputs: Sequence[str] = (),
) -> list[str]:
    """Write a copy of an instrument file with depths, standard deviations and flags added.

    Return the names of the instruments that match no point of the line. `result` is a dataset of
    `calm motion`. Depths are interpolated over gaps of at most `gap`. `inputs` are names and hashes
    of the source files, for the history.
    """
    import xarray as xr

    shape = len(instruments.time), len(instruments.who)
    depth, spread = np.full((2, *shape), np.nan)
    flag = np.full(shape, MISSING, np.int8)
    for j, at in enumerate(instruments.point):
        if at is not None:
            depth[:, j], spread[:, j], flag[:, j] = at_own_times(result, at, instruments.time, gap)
    # read raw values, but join the characters of texts, which xarray splits again to write them
    if engine := cf_files.engine_of(instruments.path):
        with xr.open_dataset(
            instruments.path, engine=engine, mask_and_scale=False, decode_times=False,
            decode_coords=False,
        ) as own:  # fmt: skip
            copy = own.load()
    else:
        copy = cf_files.open_current(instruments.path)
    one = instruments.along is None
    copy = _without_depths(copy, instruments)
    if not engine:
        _archived(copy, instruments, result)
    for variable in copy.variables.values():  # stop xarray from adding fill values
        if "_FillValue" not in variable.attrs and variable.dtype.kind == "f":
            variable.encoding.setdefault("_FillValue", None)
    name, deviation, mark = instruments.names
    dims = (instruments.dimension,) if one else (instruments.dimension, str(instruments.along))
    tables = [table[:, 0] if one else table for table in (depth, spread, flag)]
    copy[name] = xr.Variable(dims, tables[0], {
        "units": "m", "positive": "down", "standard_name": "depth",
        "long_name": "depth estimated by CALM", "ancillary_variables": f"{deviation} {mark}",
        **({"reference": "sea_level"} if one else {}),
        # CF allows `axis` on auxiliary coordinates only in discrete sampling geometries
        **({"axis": "Z"} if one and "featureType" in copy.attrs else {}),
    })  # fmt: skip
    copy[deviation] = xr.Variable(dims, tables[1], {
        "units": "m", "standard_name": "depth standard_error",
        "long_name": "standard deviation of the depth",
        "coverage_content_type": "qualityInformation",
    })  # fmt: skip
    copy[mark] = xr.Variable(dims, tables[2], {
        "standard_name": "quality_flag", "long_name": "quality flag of the depth",
        **OF_FLAGS, "flag_values": np.array(list(FLAGS), np.int8),
    })  # fmt: skip
    _add_salinity(copy, instruments, depth)
    _drop_references(copy)
    _at_depths(copy, name, instruments)
    _describe(copy, instruments, inputs, result)
    with beside(output) as part:
        copy.to_netcdf(part, engine="h5netcdf")
    pairs = zip(instruments.who, instruments.point, strict=True)
    return [who.named for who, point in pairs if point is None]


def at_own_times(
    result: Dataset, point: int, time: NDArray[np.datetime64], gap: np.timedelta64
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int8]]:
    """Interpolate depth, standard deviation and flag of a point to the times (n,) of an instrument.

    The flag is "measured" if the pressure of the instrument was used, "interpolated" for other
    depths, and "missing" without a depth, as in gaps longer than `gap`.
    """
    known = result["time"].values
    depth, spread = (interpolated(known, one, time, gap) for one in depths_at(result, point))
    clamps = result.sizes.get("clamp", 0)
    names = ("clamp_label", point) if point < clamps else ("component_label", point - clamps)
    label = str(result[names[0]].values[names[1]]) if names[0] in result else ""
    sensors = labels_of(result, "sensor_label")
    flag = np.where(np.isfinite(depth), ESTIMATED, MISSING).astype(np.int8)
    if label in sensors:
        own = np.asarray(result["residual"].values[:, sensors.index(label)], np.float64)
        here = np.isfinite(interpolated(known, own, time, gap)) & np.isfinite(depth)
        flag[here] = MEASURED
    return depth, spread, flag


def _drop_references(copy: Dataset) -> None:
    """Remove references to deleted variables from all attributes."""
    for variable in copy.variables.values():
        for attribute in ("coordinates", "ancillary_variables"):
            for place in (variable.attrs, variable.encoding):
                named = str(place.get(attribute, "")).split()
                there = [name for name in named if name in copy.variables]
                if there and there != named:
                    place[attribute] = " ".join(there)
                elif named and not there:
                    del place[attribute]


def _without_depths(copy: Dataset, instruments: Instruments) -> Dataset:
    """Remove old depth variables from a file of one instrument, and rename its nominal depth."""
    if instruments.along is not None:
        return copy
    nominal = None
    if "DEPTH" in copy.variables and instruments.dimension not in copy["DEPTH"].dims:
        nominal = copy["DEPTH"].squeeze(drop=True).variable
    if "DEPTH" in copy.dims:
        copy = copy.isel(DEPTH=0, drop=True)
    copy = copy.drop_vars([name for name in (*ONE, *_OF_OLD) if name in copy.variables])
    if nominal is not None and NOMINAL not in copy.variables:
        attributes = {key: value for key, value in nominal.attrs.items() if key != "axis"}
        copy[NOMINAL] = nominal.copy(deep=False)
        metres = {"units": "m", "positive": "down", "standard_name": "depth"}
        copy[NOMINAL].attrs = {**metres, **attributes, "long_name": "nominal depth"}
    return copy


def _add_salinity(copy: Dataset, instruments: Instruments, depth: NDArray[np.float64]) -> None:
    import xarray as xr

    salinity = QUANTITIES_MEASURED["salinity"]
    with cf_files.opened(instruments.path) as dataset:
        single = [str(dim) for dim, size in dataset.sizes.items() if size == 1]
        dataset = dataset.isel({dim: 0 for dim in single if dim != instruments.dimension})
        if named(dataset, salinity.sought, salinity.usual):
            return
        taken = conductivity_in(dataset)
        axes = (instruments.dimension, *filter(None, [instruments.along]))
        if not taken or any({*dataset[name].dims} != {*axes} for name in taken.values()):
            return
        parts = [cf_files.known_values(dataset[name].transpose(*axes)) for name in taken.values()]
        place = depth[:, 0] if instruments.along is None else depth
        values = practical_salinity(dataset, taken, parts, place)
    name = salinity.archive if instruments.along is None else "salinity"
    copy[name] = xr.Variable(axes, values, {
        "standard_name": salinity.standard_name, "long_name": salinity.long_name,
        "units": salinity.units, "coverage_content_type": "physicalMeasurement",
        "comment": "computed by CALM from conductivity, temperature and pressure (TEOS-10)",
    })  # fmt: skip


def _archived(copy: Dataset, instruments: Instruments, result: Dataset) -> None:
    import xarray as xr

    stations, where = station(_mooring(result), _place(copy, result), "the anchor")
    for one in stations:
        copy[one.name.upper()] = xr.Variable((), one.values, one.described)
    measured = [str(name) for name in copy.data_vars if copy[name].dims == (instruments.dimension,)]
    coordinates = " ".join(where.upper().split())
    for name in measured:
        copy[name].attrs |= {
            "coordinates": coordinates, "coverage_content_type": "physicalMeasurement"
        }  # fmt: skip
    product = "".join(c if c.isalnum() else "-" for c in instruments.path.stem)
    copy.attrs |= {
        **ARCHIVED,
        "id": archive_id(_mooring(result), instruments.time[0], product),
        "keywords": ", ".join(copy[name].attrs["standard_name"] for name in measured),
        "keywords_vocabulary": ARCHIVED["standard_name_vocabulary"],
        "processing_level": "Instrument data that has been converted to geophysical values",
    }
    if len(stations) > 1:
        copy.attrs["featureType"] = "timeSeries"


def _mooring(result: Dataset) -> str:
    return mooring_in(str(result.attrs.get("title", "mooring")))


def _at_depths(copy: Dataset, depth: str, instruments: Instruments) -> None:
    """Add the depth variable to the attribute `coordinates` of the measurements."""
    others = {*instruments.names, instruments.clock, *copy.dims}
    for name, variable in copy.variables.items():
        along = {*copy[depth].dims} <= {*variable.dims}
        if name in others or not along or "units" not in variable.attrs:
            continue
        attributes = variable.encoding if "coordinates" in variable.encoding else variable.attrs
        named = str(attributes.get("coordinates", "")).split()
        attributes["coordinates"] = " ".join(dict.fromkeys([*named, depth]))


def _describe(
    copy: Dataset, instruments: Instruments, inputs: Sequence[str], result: Dataset
) -> None:
    """Add global attributes on depths and mooring, and a line in the history.

    Original attributes are kept, except for the range of depths. An attribute is not added if an
    original attribute begins with the same word, such as `creator` in `creator_name`.
    """
    name, _, mark = instruments.names
    mooring = _mooring(result)
    time = np.sort(instruments.time[~np.isnat(instruments.time)])
    known = {
        **{key: value for key, value in kept(result.attrs).items() if key not in _OF_MOTION},
        **(coverage(time, copy[name].values, _place(copy, result)) if time.size else {}),
        "title": f"{mooring}: {instruments.path.name}",
        "summary": f"Contents of {instruments.path.name}. CALM added depths that it estimated from "
        f"the statics of the mooring {mooring}.",
        "comment": f"{mark} 1: {name} from the pressure of the instrument; 8: estimated; 9: none",
        "date_created": written(),
    }
    extent = vertical_extent(copy[name].values)
    there = {key.partition("_")[0] for key in copy.attrs if key not in extent}
    added = {key: value for key, value in known.items() if key.partition("_")[0] not in there}
    copy.attrs = {**added, **copy.attrs, **extent}
    line = f"{written()} calm {__version__} motion --onto: {name} estimated"
    line += f" from {', '.join(inputs)}" if inputs else ""
    copy.attrs["history"] = "\n".join([*filter(None, [copy.attrs.get("history")]), line])
    copy.attrs["date_modified"] = written()


def _place(copy: Dataset, result: Dataset) -> list[float]:
    """Return latitude and longitude [degrees] from the file or the mooring; empty if unknown."""
    found = []
    for axis in ("latitude", "longitude"):
        own = [one for one in copy.variables.values() if one.attrs.get("standard_name") == axis]
        if len(own) == 1 and own[0].size == 1:
            found.append(float(own[0].values.item()))
        elif f"geospatial_{axis[:3]}_min" in result.attrs:
            found.append(float(result.attrs[f"geospatial_{axis[:3]}_min"]))
    return found if len(found) == 2 else []
