"""Layout and writing of the gridded file: values, standard deviations and flags on levels."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.batch.dataset import laid_out, time_axis
from calm.dataset import netcdf
from calm.dataset.discovery import (
    ARCHIVED,
    GCMD,
    archive_id,
    coverage,
    in_capitals,
    kept,
    with_flags,
    written,
)
from calm.errors import UsageError
from calm.gridding.field import BLOCK, GriddedQuantity, estimate
from calm.gridding.samples import MooringDepths
from calm.quantities import QUANTITIES_MEASURED
from calm.records import delimited
from calm.records.card import ReadCard
from calm.units import QuantityError, parse_quantity
from calm.version import __version__

MOST_LEVELS = 5000
_KEYWORDS = ("OCEAN TEMPERATURE", "OCEAN CIRCULATION", "SALINITY/DENSITY")


def parse_levels(text: str) -> NDArray[np.float64]:
    """Parse levels [m] from ``first:step:last``, or from several levels separated by commas."""
    given, wanted = text[:40], "write FIRST:STEP:LAST in metres, such as 0:20:1500, or 50,100,250"
    by_step = text.count(":") == 2
    try:
        levels = np.array([_metres(part) for part in text.split(":" if by_step else ",")])
    except QuantityError:
        raise UsageError(f"--levels: `{given}` is not understood; {wanted}") from None
    if by_step:
        first, step, last = levels.tolist()
        if step <= 0.0 or last < first:
            raise UsageError(f"--levels: `{text}` does not increase; {wanted}")
        if (last - first) / step >= MOST_LEVELS:
            raise UsageError(f"--levels: `{text}` makes more than {MOST_LEVELS} levels")
        levels = first + step * np.arange(int((last - first) / step + 1e-9) + 1)
    return check_levels(levels)


def check_levels(given: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]:
    """Check that levels [m] increase from the sea surface, and return them as an array."""
    levels = np.asarray(given, np.float64)
    if levels.ndim != 1 or not levels.size or not (np.diff(levels, prepend=-np.inf) > 0.0).all():
        raise UsageError("--levels: the depths must increase, such as 50,100,250")
    if levels[0] < 0.0:
        raise UsageError(f"--levels: {levels[0]:g} m is above the sea surface")
    return levels


def _metres(part: str) -> float:
    plain = "" if delimited.NUMBER.fullmatch(part.strip()) is None else " m"
    return parse_quantity(f"{part}{plain}", "length", usual_unit="m")


def grid_layout(
    fields: Mapping[str, GriddedQuantity],
    levels: NDArray[np.float64],
    depths: MooringDepths,
    inputs: Sequence[str],
    names: Mapping[str, str],
    averaged: str | None,
    cards: Sequence[ReadCard] = (),
) -> netcdf.ResultLayout:
    """Return the layout of a gridded file.

    `inputs` are names and hashes of the input files. `names` are the names of the variables, by
    quantity. `averaged` is the averaging interval as text.
    """
    time = next(iter(fields.values())).samples.time
    title = str(depths.attributes.get("title", "mooring")).partition(": ")[0]
    of_station, where = netcdf.station(title, depths.place, "the anchor")
    variables = [
        time_axis(time, "time"),
        netcdf.Variable("depth", ("depth",), "<f8", {
            "standard_name": "depth", "long_name": "depth below the sea surface", "units": "m",
            "positive": "down", "axis": "Z", "reference": "sea_level",
        }, levels),
        *of_station,
    ]  # fmt: skip
    flagged = {}
    for name, field in fields.items():
        quantity, called = QUANTITIES_MEASURED[name], names[name]
        about: netcdf.Attributes = {
            "standard_name": quantity.standard_name, "long_name": quantity.long_name,
            "units": quantity.units, "coordinates": where.strip(),
            "coverage_content_type": "physicalMeasurement", "comment": method_sentence(field),
        }  # fmt: skip
        spread: netcdf.Attributes = {
            "standard_name": f"{quantity.standard_name} standard_error",
            "long_name": f"standard deviation of the {quantity.long_name}",
            "units": quantity.units, "coordinates": where.strip(),
            "coverage_content_type": "qualityInformation",
        }  # fmt: skip
        variables += [
            netcdf.Variable(called, ("time", "depth"), netcdf.NUMBER, about),
            netcdf.Variable(f"{called}_sd", ("time", "depth"), netcdf.NUMBER, spread),
        ]
        if name == "temperature":
            about["units_metadata"] = "temperature: on_scale"
            spread["units_metadata"] = "temperature: difference"
        flagged[called] = [f"{called}_sd"]
    means = "time: point" if averaged is None else f"time: mean (interval: {averaged})"
    before = [str(depths.attributes[key]) for key in ("history",) if key in depths.attributes]
    made = f"{written()} calm {__version__} grid: {', '.join(inputs)}"
    labels = list(dict.fromkeys(label for one in fields.values() for label in one.samples.label))
    attributes: netcdf.Attributes = {
        **ARCHIVED,
        **coverage(time, levels, depths.place),
        **kept(depths.attributes),
        "title": f"{title}: on fixed levels",
        "id": archive_id(title, time[0], "GRID"),
        "summary": (
            f"{', '.join(QUANTITIES_MEASURED[name].long_name for name in fields)} of the mooring "
            f"{title} on {len(levels)} fixed levels. The values were measured at the moving "
            f"depths of {len(labels)} instruments and mapped to the levels by a Gaussian process "
            "over depth and time. Each value has a standard deviation."
        ),
        "keywords": ", ".join(f"EARTH SCIENCE > OCEANS > {one}" for one in _KEYWORDS),
        "keywords_vocabulary": GCMD,
        "source": "subsurface mooring",
        "processing_level": "Data interpolated",
        "comment": "Flag 8: between instruments; 3: beyond the instruments, or poorly constrained; "
        "9: no value",
        "QC_indicator": "mixed",
        "instrument": ", ".join(labels),
        "calm": __version__,
        "date_created": written(),
        "date_modified": written(),
        "history": "\n".join([*before, made, *(card.sentence() for card in cards)]),
    }
    if depths.place:
        attributes["featureType"] = "timeSeriesProfile"
    sizes, whole = {"time": len(time), "depth": len(levels)}, with_flags(variables, flagged, means)
    layout = netcdf.ResultLayout(sizes, whole, attributes)
    return in_capitals(layout) if all(one.isupper() for one in names.values()) else layout


def method_sentence(field: GriddedQuantity) -> str:
    """Return a sentence that describes the gridding of a quantity, with the correlation scales."""
    scales = field.scales
    time = f" and {scales.time / 3600.0:.3g} h in time" * field.in_time
    return (
        "Gaussian process about the mean profile of the record, with a correlation scale of "
        f"{scales.depth:.3g} m in depth{time}; {100.0 * scales.share:.2g} % of the variance is "
        "uncorrelated"
    )


def write_grid(
    layout: netcdf.ResultLayout,
    fields: Mapping[str, GriddedQuantity],
    levels: NDArray[np.float64],
    names: Mapping[str, str],
    output: Path,
    shown: Callable[[Sequence[int]], Iterable[int]] = lambda each: each,
) -> None:
    """Write a gridded file block by block; `shown` wraps the iteration over the blocks."""
    time = next(iter(fields.values())).samples.time
    capitals = all(one.isupper() for one in names.values())
    deviation, flag = ("_SD", "_QC") if capitals else ("_sd", "_qc")

    def blocks() -> Iterator[netcdf.Chunks]:
        for start in shown(range(0, len(time), BLOCK)):
            times = np.arange(start, min(start + BLOCK, len(time)))
            columns: dict[str, NDArray[Any]] = {}
            for name, field in fields.items():
                found, called = estimate(field, levels, times), names[name]
                columns |= {called: found.value, called + deviation: found.deviation}
                columns[called + flag] = found.flag
            yield netcdf.packed(layout, BLOCK, laid_out(layout, time[times], columns))

    netcdf.write_netcdf(layout, BLOCK, blocks(), output)
