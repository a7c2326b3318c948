"""A batch result in xarray: `dataset.calm`, from when this module is imported; a profile drawn."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from calm.batch.finished import place_of
from calm.drawing import plot
from calm.drawing.line_picture import LineKind, LinePicture, PictureMark, Polyline, along
from calm.drawing.picture import empty_figure
from calm.errors import UsageError
from calm.quantities import QUANTITIES
from calm.report.batch_summary import when

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@xr.register_dataset_accessor("calm")  # type: ignore[no-untyped-call]
class BatchAccessor:
    """Give what a batch result has for a part of the line, by its label in the mooring file.

    ``top`` is the first component, even where another part is labelled so. Nothing is loaded
    before it is asked for.

    >>> dataset.calm.knockdown("adcp").max()  # doctest: +SKIP
    """

    def __init__(self, dataset: xr.Dataset) -> None:
        self._dataset = dataset

    def depth(self, label: str) -> xr.DataArray:
        """(time) depth of a clamp, or of the upper end of a component [m].

        UsageError: no part of the line is called so, here and below.
        """
        return self._of(label, "depth", "depth_top")

    def knockdown(self, label: str) -> xr.DataArray:
        """(time) how much deeper than in still water [m]."""
        return self._of(label, "knockdown", "knockdown")

    def tilt(self, label: str) -> xr.DataArray:
        """(time) of a component, or of the line at a clamp, from the vertical [degrees]."""
        return self._of(label, "tilt", "tilt")

    def tension(self, label: str) -> xr.DataArray:
        """(time) at a clamp, or the greater of those at both ends of a component [N]."""
        upper, lower = (self._of(label, "tension", f"tension_{end}") for end in ("top", "bottom"))
        greater: xr.DataArray = upper.where(upper >= lower, lower)
        return greater

    def plot_shape(self, *, time: str | np.datetime64) -> Figure:
        """Draw the line at the time of the profile nearest to one.

        UsageError: the profile has no equilibrium.
        """
        return draw_shape(self._dataset, time)

    def _of(self, label: str, quantity: str, of_component: str) -> xr.DataArray:
        """Return what a variable has for a component, or that of the same quantity for a clamp."""
        prefix, index = place_of(self._dataset, label)
        variable = f"{prefix}{quantity}" if prefix else of_component
        dimension = "clamp" if prefix else "component"
        column = self._dataset[variable].isel({dimension: index}, drop=True).rename(quantity)
        return column.assign_attrs(column.attrs | {"long_name": f"{quantity} of {label}"})


_HEIGHT = 6.5  # inches


def draw_shape(dataset: xr.Dataset, time: str | np.datetime64) -> Figure:
    """Elevation and plan of the line in the profile nearest to a time.

    The line is drawn straight from the upper end of one component to that of the next. The
    elevation is in the vertical plane of the anchor and the top. UsageError: the profile has no
    equilibrium.
    """
    row = dataset.sel(time=np.datetime64(time), method="nearest")
    names = ("depth_top", "x_top", "y_top")
    depth, x, y = (np.asarray(row[name].values, np.float64) for name in names)
    moment = when(row["time"].values)
    if np.isnan(depth).any():
        raise UsageError(f"the profile of {moment} has no equilibrium to draw")
    distance = float(np.hypot(x[0], y[0]))
    plane = np.array([x[0], y[0]]) / distance if distance > 0.0 else np.array([1.0, 0.0])
    height = float(np.ptp(depth))
    marks: tuple[PictureMark, ...] = ()
    if "clamp_depth" in row:
        clamps = zip(*(row[f"clamp_{name}"].values for name in ("x", "y", "depth")), strict=True)
        marks = tuple(PictureMark("", "", "instrument", *map(float, each)) for each in clamps)
    above = LinePicture(
        (Polyline(LineKind.LINE, x, y),), marks, QUANTITIES["x"].label, QUANTITIES["y"].label
    )
    margin = 0.05 * height
    side = LinePicture(
        (Polyline(LineKind.LINE, along(x, y, plane), depth),),
        tuple(replace(one, x=float(along(one.x, one.y, plane)), y=one.depth) for one in marks),
        across=QUANTITIES["offset"].label,
        up=QUANTITIES["depth"].label,
        top=min(0.0, float(depth.min())) - margin,
        bottom=float(depth.max()) + margin,
        height=height,
        surface=True,
    )
    figure = empty_figure(plot.WIDTH, _HEIGHT, layout="constrained")
    elevation, plan = figure.subplots(1, 2)
    figure.suptitle(f"{dataset.attrs.get('title', '')}\n{moment}".strip(), parse_math=False)
    plot.draw_elevation(elevation, side)
    plot.draw_plan(plan, above)
    return figure
