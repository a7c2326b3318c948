"""Accessor `dataset.calm` for batch results in xarray, registered when this module is imported."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from calm.batch.finished import place_of
from calm.drawing.line_picture import LineKind, LinePicture, PictureMark, Polyline, along
from calm.drawing.plot import plot_elevation
from calm.errors import UsageError
from calm.quantities import QUANTITIES
from calm.report.batch_summary import when

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@xr.register_dataset_accessor("calm")  # type: ignore[no-untyped-call]
class BatchAccessor:
    """Access to batch results by the label of a component or clamp in the mooring file.

    The label ``top`` always means the first component. All methods raise UsageError for an unknown
    label.

    >>> dataset.calm.knockdown("adcp").max()  # doctest: +SKIP
    """

    def __init__(self, dataset: xr.Dataset) -> None:
        self._dataset = dataset

    def depth(self, label: str) -> xr.DataArray:
        """Return the depth of a clamp, or of the upper end of a component, over time [m]."""
        return self._variable(label, "depth", "depth_top")

    def knockdown(self, label: str) -> xr.DataArray:
        """Return the knockdown over time [m], relative to still water."""
        return self._variable(label, "knockdown", "knockdown")

    def tilt(self, label: str) -> xr.DataArray:
        """Return the tilt from the vertical of a component, or of the line at a clamp [degrees]."""
        return self._variable(label, "tilt", "tilt")

    def tension(self, label: str) -> xr.DataArray:
        """Return the tension over time [N].

        For a component, the larger of the tensions at its two ends is returned.
        """
        upper, lower = (
            self._variable(label, "tension", f"tension_{end}") for end in ("top", "bottom")
        )
        greater: xr.DataArray = upper.where(upper >= lower, lower)
        return greater

    def plot_shape(self, *, time: str | np.datetime64, ax: Axes | None = None) -> Axes:
        """Draw the line from the side on matplotlib axes, in the profile nearest to a given time.

        Without `ax`, a new figure is created. Raise UsageError without an equilibrium or without
        matplotlib.
        """
        axes = plot_elevation(shape_picture(self._dataset, time), ax)
        moment = when(_nearest(self._dataset, time)["time"].values)
        axes.set_title(
            f"{self._dataset.attrs.get('title', '')}\n{moment}".strip(), parse_math=False
        )
        return axes

    def _variable(self, label: str, quantity: str, of_component: str) -> xr.DataArray:
        prefix, index = place_of(self._dataset, label)
        variable = f"{prefix}{quantity}" if prefix else of_component
        dimension = "clamp" if prefix else "component"
        column = self._dataset[variable].isel({dimension: index}, drop=True).rename(quantity)
        return column.assign_attrs(column.attrs | {"long_name": f"{quantity} of {label}"})


def _nearest(dataset: xr.Dataset, time: str | np.datetime64) -> xr.Dataset:
    return dataset.sel(time=np.datetime64(time), method="nearest")


def shape_picture(dataset: xr.Dataset, time: str | np.datetime64) -> LinePicture:
    """Create the side view of the line in the profile nearest to a given time.

    The view is in the vertical plane through anchor and top, with straight lines between component
    ends. Raise UsageError if the profile has no equilibrium.
    """
    row = _nearest(dataset, time)
    names = ("depth_top", "x_top", "y_top")
    depth, x, y = (np.asarray(row[name].values, np.float64) for name in names)
    if np.isnan(depth).any():
        raise UsageError(
            f"the profile of {when(row['time'].values)} cannot be drawn: it has no equilibrium"
        )
    distance = float(np.hypot(x[0], y[0]))
    plane = np.array([x[0], y[0]]) / distance if distance > 0.0 else np.array([1.0, 0.0])
    height = float(np.ptp(depth))
    clamps = (
        zip(*(row[f"clamp_{name}"].values for name in ("x", "y", "depth")), strict=True)
        if ("clamp_depth" in row)
        else ()
    )
    margin = 0.05 * height
    return LinePicture(
        (Polyline(LineKind.LINE, along(x, y, plane), depth),),
        tuple(
            PictureMark(
                "", "", "instrument", float(along(east, north, plane)), float(deep), float(deep)
            )
            for east, north, deep in clamps
        ),
        across=QUANTITIES["offset"].label,
        up=QUANTITIES["depth"].label,
        top=min(0.0, float(depth.min())) - margin,
        bottom=float(depth.max()) + margin,
        height=height,
        surface=True,
    )
