"""Attributes that data archives require in addition to CF: ACDD 1.3 and OceanSITES 1.4.

Names and tables follow the OceanSITES Data Format Reference Manual 1.4 (2020) and the Attribute
Convention for Data Discovery 1.3.
"""

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.dataset.netcdf import Attributes, ResultLayout, Variable, source_date

ARCHIVED: Attributes = {
    "Conventions": "CF-1.11, ACDD-1.3, OceanSITES-1.4",
    "naming_authority": "OceanSITES",
    "data_type": "OceanSITES time-series data",
    "format_version": "1.4",
    "data_mode": "D",
    "cdm_data_type": "Station",
    "standard_name_vocabulary": "CF Standard Name Table v93",
}
"""Global attributes common to all files that are written for data archives."""
GCMD = "GCMD Science Keywords"
"""Name of the vocabulary from which the keywords of a file are taken."""
FLAGS: Mapping[int, str] = {
    0: "unknown", 1: "good_data", 2: "probably_good_data",
    3: "potentially_correctable_bad_data", 4: "bad_data", 7: "nominal_value",
    8: "interpolated_value", 9: "missing_value",
}  # fmt: skip
"""Meaning of each quality flag, from OceanSITES table 2."""
OF_FLAGS: Attributes = {
    "flag_values": list(FLAGS),
    "flag_meanings": " ".join(FLAGS.values()),
    "conventions": "OceanSITES QC Flags",
}

_KEPT = ("institution", "project", "license", "acknowledgement", "references", "keywords", "title",
         "water_depth")  # fmt: skip
_KEPT_BEGIN = ("creator_", "platform_", "site_", "principal_investigator", "publisher_", "wmo_")


def written() -> str:
    """Return the current time in ISO 8601 format, or the time in SOURCE_DATE_EPOCH if set."""
    return f"{source_date() or datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ}"


def hashed(path: Path) -> str:
    """Return the name of a file, followed by the SHA-256 hash of the file.

    For a folder, only the name is returned.
    """
    if not path.is_file():
        return path.name
    with path.open("rb") as file:
        return f"{path.name} sha256:{hashlib.file_digest(file, 'sha256').hexdigest()}"


def kept(attributes: Mapping[str, Any]) -> Attributes:
    """Return those attributes of an input file that also apply to results, such as the site."""
    return {
        name: value
        for name, value in attributes.items()
        if name in _KEPT or name.startswith(_KEPT_BEGIN)
    }


def coverage(
    time: NDArray[np.datetime64], depth: NDArray[np.floating[Any]], place: Sequence[float]
) -> Attributes:
    """Return the global attributes for the coverage in time, depth and position.

    Parameters
    ----------
    time : times, ascending
    depth : depths [m], of any shape; NaN if unknown
    place : latitude and longitude [degrees]; empty if unknown
    """
    first, last = (np.datetime_as_string(one, "s") + "Z" for one in (time[0], time[-1]))
    attributes: Attributes = {
        "time_coverage_start": first,
        "time_coverage_end": last,
        "time_coverage_duration": _duration(time[-1] - time[0]),
    }
    if len(time) > 1:
        attributes["time_coverage_resolution"] = _duration(np.median(np.diff(time)))
    attributes |= vertical_extent(depth)
    for axis, unit, value in zip(
        ("lat", "lon"), ("degrees_north", "degrees_east"), place, strict=False
    ):
        attributes |= {
            f"geospatial_{axis}_min": float(value),
            f"geospatial_{axis}_max": float(value),
            f"geospatial_{axis}_units": unit,
        }
    if len(place) == 2:
        latitude, longitude = place
        attributes |= {"geospatial_bounds": f"POINT ({latitude:.6f} {longitude:.6f})",
                 "geospatial_bounds_crs": "EPSG:4326",
                 "geospatial_bounds_vertical_crs": "EPSG:5831"}  # fmt: skip
    return attributes


def vertical_extent(depth: NDArray[np.floating[Any]]) -> Attributes:
    """Return the global attributes that describe the range of depths [m].

    The result is empty if all depths are NaN.
    """
    known = depth[np.isfinite(depth)]
    if not known.size:
        return {}
    return {
        "geospatial_vertical_min": float(known.min()),
        "geospatial_vertical_max": float(known.max()),
        "geospatial_vertical_positive": "down",
        "geospatial_vertical_units": "m",
    }


def mooring_in(title: str) -> str:
    """Return the name of the mooring in the title of a file; the title is ``NAME: CONTENTS``."""
    return title.rpartition(": ")[0] or title


def archive_id(name: str, start: np.datetime64, product: str) -> str:
    """Return an `id` in the OceanSITES form, which contains site, first month and product."""
    site = "".join(letter if letter.isalnum() else "-" for letter in name)
    return f"OS_{site}_{np.datetime_as_string(start, 'M').replace('-', '')}_D_{product}"


def _duration(span: np.timedelta64) -> str:
    seconds = int(span / np.timedelta64(1, "s"))
    days, rest = divmod(seconds, 86_400)
    hours, rest = divmod(rest, 3600)
    minutes, seconds = divmod(rest, 60)
    clock = "".join(f"{n}{u}" for n, u in ((hours, "H"), (minutes, "M"), (seconds, "S")) if n)
    return f"P{f'{days}D' if days else ''}{f'T{clock}' if clock else ''}" if seconds or minutes or (
        hours or days) else "PT0S"  # fmt: skip


def with_flags(
    variables: Iterable[Variable],
    names: Mapping[str, Sequence[str]],
    cell_methods: str = "time: point",
) -> tuple[Variable, ...]:
    """Insert a variable with quality flags after each flagged variable.

    Parameters
    ----------
    names : ancillary variables of each flagged variable, without the new quality flags; the keys
        are the names of the flagged variables
    cell_methods : CF attribute `cell_methods` of the flagged variables
    """
    found = []
    for one in variables:
        beside = names.get(one.name)
        if beside is None:
            found.append(one)
            continue
        flags = f"{one.name}_qc"
        more = {"ancillary_variables": " ".join([*beside, flags]), "cell_methods": cell_methods}
        about: Attributes = {
            "standard_name": "quality_flag",
            "long_name": f"quality flag of {one.attributes['long_name']}",
            **OF_FLAGS,
        }
        if "coordinates" in one.attributes:
            about["coordinates"] = one.attributes["coordinates"]
        found.append(replace(one, attributes={**one.attributes, **more}))
        found.append(Variable(flags, one.dimensions, "|i1", about))
    return tuple(found)


def in_capitals(layout: ResultLayout) -> ResultLayout:
    """Return a copy of a layout with all names in capitals, as in OceanSITES archives."""
    names = {one.name for one in layout.variables} | set(layout.sizes)

    def raised(attributes: Attributes) -> Attributes:
        changed = dict(attributes)
        for key in ("coordinates", "ancillary_variables", "cell_methods", "bounds"):
            if key in changed:
                words = str(changed[key]).split(" ")
                changed[key] = " ".join(
                    w.upper() if w in names or w.removesuffix(":") in names else w for w in words
                )
        return changed

    return ResultLayout(
        {name.upper(): size for name, size in layout.sizes.items()},
        tuple(
            replace(
                one,
                name=one.name.upper(),
                attributes=raised(one.attributes),
                dimensions=tuple(dim.upper() for dim in one.dimensions),
            )
            for one in layout.variables
        ),
        layout.attributes,
    )
