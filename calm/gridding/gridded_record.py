"""Computation of ``calm grid``: read the files of a recovered mooring and grid them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.batch.finished import open_result
from calm.dataset.discovery import hashed
from calm.dataset.netcdf import ResultLayout
from calm.errors import UsageError, not_among
from calm.gridding.field import DOUBTFUL, GriddedQuantity, field_of
from calm.gridding.product import check_levels, grid_layout, parse_levels, write_grid
from calm.gridding.samples import (
    ANOTHER_PLACE,
    MooringDepths,
    Samples,
    common_times,
    gather,
    read_depths,
)
from calm.motion.matching import points_of
from calm.motion.sensors import parse_flags
from calm.motion.study import MotionEstimate
from calm.physics.line import Floats
from calm.quantities import QUANTITIES_MEASURED, chosen_quantities
from calm.records.card import ReadCard
from calm.records.given import as_files
from calm.records.instrument_series import InstrumentSeries, files_given, read_series
from calm.records.value_tests import exchanged_pair

if TYPE_CHECKING:
    from xarray import Dataset

    from calm.records.given import Given

METHODS = ("depth-time", "depth")
COLOURS = {"temperature": "RdYlBu_r", "salinity": "viridis", "u": "PuOr_r", "v": "PuOr_r"}
"""Colour map of each quantity."""


@dataclass(frozen=True, repr=False)
class GriddedRecord:
    """Temperature, salinity and velocity from a mooring, gridded on fixed levels.

    Attributes
    ----------
    fields, names : samples with fitted field, and variable in the dataset, for each quantity
    levels : (k,) depths of the levels [m]
    cards, notes : summary of each file that was read, and sentences on oddities in the input
    layout : layout of the gridded file
    """

    fields: Mapping[str, GriddedQuantity]
    names: Mapping[str, str]
    levels: Floats
    cards: tuple[ReadCard, ...]
    notes: tuple[str, ...]
    layout: ResultLayout

    def write(
        self, output: str | Path,
        progress: Callable[[Sequence[int]], Iterable[int]] = lambda each: each,
    ) -> None:  # fmt: skip
        """Compute the values and write them to a NetCDF file, as ``calm grid -o`` does.

        `progress` wraps the iteration over blocks of times.
        """
        write_grid(self.layout, self.fields, self.levels, self.names, Path(output), progress)

    def to_xarray(self) -> Dataset:
        """Compute values, standard deviations and flags as a dataset with labels and units."""
        with TemporaryDirectory() as folder:
            output = Path(folder) / "gridded.nc"
            self.write(output)
            with open_result(output) as kept:
                return kept.load()

    def plot(self, quantity: str | None = None, ax: Any = None) -> Any:
        """Draw a section of a quantity over time and depth with matplotlib, and return the axes.

        Lines show the depths of the instruments; doubtful values are pale. The default quantity is
        the first.
        """
        if ax is None:
            from matplotlib.figure import Figure

            ax = Figure(figsize=(9.0, 4.0)).add_subplot()
        name = quantity or next(iter(self.fields))
        dataset, called = self.to_xarray(), self.names[name]
        flag = dataset[called + ("_QC" if called.isupper() else "_qc")]
        mesh = draw_section(
            ax, self.fields[name].samples, self.levels, dataset[called].values, flag.values,
            COLOURS[name],
        )  # fmt: skip
        ax.figure.colorbar(mesh, ax=ax, label=f"{name} [{dataset[called].attrs['units']}]")
        return ax

    def __repr__(self) -> str:
        time = next(iter(self.fields.values())).samples.time
        span = f"{str(time[0])[:16]} to {str(time[-1])[:16]}"
        lines = [f"{len(time)} times, {span}; {len(self.levels)} levels"]
        for name, field in self.fields.items():
            hours = f", {field.scales.time / 3600.0:.3g} h" if field.in_time else ""
            count = len(field.samples.label)
            lines.append(f"{name}: {count} instruments, scales {field.scales.depth:.3g} m{hours}")
        return "\n".join([*lines, *([f"{len(self.notes)} notes"] if self.notes else [])])


MOST_DRAWN = 600  # maximum number of times drawn in a section; longer records are subsampled


def draw_section(
    axes: Any, samples: Samples, levels: Floats, values: Any, flags: Any, colours: str
) -> Any:
    """Draw values (n, k) over time and depth, with the depths of the instruments as lines.

    Doubtful values are pale. Return the mesh of matplotlib.
    """
    every = max(len(values) // MOST_DRAWN, 1)
    time = samples.time[::every].astype("datetime64[s]").astype(object)
    mesh = axes.pcolormesh(
        time, levels, np.ma.masked_invalid(values[::every].T), cmap=colours, shading="nearest",
        alpha=np.where(flags[::every].T == DOUBTFUL, 0.35, 1.0), rasterized=True,
    )  # fmt: skip
    axes.plot(time, samples.depth[::every], color="#111111", linewidth=0.3)
    axes.set_ylim(levels[-1], levels[0])
    axes.set_ylabel("depth [m]")
    return mesh


def grid(
    depths: Given | MotionEstimate,
    values: Given | Sequence[Given] | Mapping[str, Given],
    levels: str | Sequence[float],
    *,
    step: float | None = None,
    variables: Sequence[str] = (),
    method: str = METHODS[0],
    flags: Sequence[int] = (1, 2),
) -> GriddedRecord:
    """Interpolate measurements at moving depths to fixed levels, as ``calm grid`` does.

    Parameters
    ----------
    depths : result of `calm.estimate_motion`, its `xarray.Dataset`, or the path of a file from
        ``calm motion``
    values : records of the instruments. A record is a path, a text ``LABEL=PATH``, an
        `xarray.Dataset` with the contents of an instrument file, or a `pandas.DataFrame` of one
        instrument with an index of times and columns such as ``temperature[degC]``. A mapping from
        labels to records is also accepted
    levels : depths of the levels [m], or a text such as ``0:20:1500``
    step : interval over which values are averaged [s]; by default, values are averaged around the
        times of `depths`
    variables : `temperature`, `salinity`, `u` or `v`; all by default. Names in capitals, such as
        `TEMP`, give names in capitals in the dataset
    method : `depth-time`, or `depth` to treat each time separately
    flags : quality flags of the values that are used

    Raises
    ------
    InputError, UsageError
        A file cannot be read or does not belong to the mooring, or too few instruments remain.
    """
    if isinstance(depths, MotionEstimate):
        depths = depths.dataset
    width = None if step is None else np.timedelta64(round(step * 1e9), "ns")
    with TemporaryDirectory() as name:
        folder = Path(name)
        return read_gridded(
            Path(as_files(depths, folder, "depths")[0]),
            as_files(values, folder, "values"),
            parse_levels(levels) if isinstance(levels, str) else check_levels(levels),
            step=width,
            averaged=None if step is None else f"{step:g} s",
            variables=",".join(variables) or None,
            method=method,
            flags=",".join(map(str, flags)),
        )


def read_gridded(
    depths: Path,
    values: Sequence[str],
    levels: Floats,
    *,
    step: np.timedelta64 | None,
    averaged: str | None,
    variables: str | None,
    method: str,
    flags: str,
    report: Callable[[str], None] = lambda _: None,
    show: Callable[[ReadCard], None] = lambda _: None,
) -> GriddedRecord:
    """Read the files of a mooring and fit the field of each quantity.

    Arguments are as in `grid`, in the form of the command line. `averaged` is the step as text.
    `report` is called with each note, and `show` with each summary card.
    """
    if method not in METHODS:
        raise UsageError(not_among("--method", method, METHODS))
    wanted, notes = chosen_quantities(variables), list[str]()

    def note(text: str) -> None:
        if text not in notes:
            notes.append(text)
            report(text)

    places = read_depths(depths)
    usual = dict(zip(places.places.label, places.places.still.tolist(), strict=True))
    series = read_series(values, wanted, parse_flags(flags), places.seabed, usual)
    every = [one for each in series.values() for one in each]
    cards = tuple({id(one.card): one.card for one in every if one.card is not None}.values())
    for card in cards:
        show(card)
    for text in dict.fromkeys(f"{one.source}: {one.note}" for one in every if one.note):
        note(text)
    if variables is not None and (lacking := [name for name in wanted if not series[name]]):
        raise UsageError(f"--variables: no file holds {lacking[0]}")
    fields = fields_of(places, series, step, note, in_time=method == METHODS[0])
    archived = variables is not None and variables.isupper()
    names = {one: QUANTITIES_MEASURED[one].archive if archived else one for one in fields}
    inputs = [hashed(depths), *(hashed(path) for _, path in files_given(values))]
    layout = grid_layout(fields, levels, places, inputs, names, averaged, cards)
    return GriddedRecord(fields, names, levels, cards, tuple(notes), layout)


def fields_of(
    places: MooringDepths,
    series: Mapping[str, Sequence[InstrumentSeries]],
    step: np.timedelta64 | None,
    note: Callable[[str], None],
    *,
    in_time: bool,
) -> dict[str, GriddedQuantity]:
    """Fit a field to each quantity, and return the fields by the name of the quantity.

    A quantity with too few instruments is omitted, and `note` is called with the reason.
    """
    matched = {name: points_of(each, places.places) for name, each in series.items() if each}
    for text in dict.fromkeys(text for _, texts in matched.values() for text in texts):
        note(text)
    used = [series[name][i] for name, (points, _) in matched.items() for i in points]
    time = common_times(places, used, step)
    fields, reasons = {}, []
    for name, (points, _) in matched.items():
        samples = gather(places, series[name], points, time)
        for text in sample_notes(places, samples, name, series[name], points):
            note(text)
        try:
            fields[name] = field_of(samples, QUANTITIES_MEASURED[name].noise, in_time=in_time)
        except UsageError as error:
            reasons.append(f"{name}: {error}")
    if not fields:
        raise UsageError("; ".join(reasons))
    for reason in reasons:
        note(f"{reason}; the quantity is omitted")
    return fields


def sample_notes(
    places: MooringDepths,
    samples: Samples,
    name: str,
    series: Sequence[InstrumentSeries],
    points: Mapping[int, int],
) -> Iterator[str]:
    """Yield sentences about problems in the samples of a quantity.

    Examples are pressures that contradict the depth of an instrument, mean temperatures that
    suggest exchanged files, and instruments without good values.
    """
    labels = places.places.label
    for i, at in points.items():
        usual = float(np.nanmedian(places.depth[:, at]))
        one, here = series[i], f"`{labels[at]}` was at {usual:.0f} m"
        if abs(one.pressure - usual) > max(ANOTHER_PLACE, 0.1 * usual):
            yield (
                f"{one.source}: the median of its pressures is {one.pressure:.0f} dbar, but "
                f"{here}; check for exchanged files or a wrong unit"
            )
        if one.called in labels and one.called != labels[at]:
            yield (
                f"{one.source} is assigned to `{labels[at]}`, but names its instrument "
                f"`{one.called}`"
            )
    if name == "temperature":
        known = [column[np.isfinite(column)] for column in samples.value.T]
        means = np.array([column.mean() if column.size else np.nan for column in known])
        if pair := exchanged_pair(means):
            upper, lower = (samples.label[i] for i in pair)
            yield (
                f"{name}: the means of all {len(means)} instruments would fall or rise steadily "
                f"with depth if `{upper}` and `{lower}` were exchanged; check for exchanged files"
            )
    if dropped := sum(series[i].dropped for i in points):
        yield f"{name}: {dropped} values excluded because of their flag"
    for i, at in points.items():
        one, column = series[i], samples.label.index(labels[at])
        measured = one.dropped or np.isfinite(one.value).any()
        if measured and not np.isfinite(samples.value[:, column]).any():
            yield f"{name}: {labels[at]} has no good value at any time step"
