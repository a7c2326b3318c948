"""A batch result in xarray: `dataset.calm`, from when this module is imported."""

from __future__ import annotations

from typing import TYPE_CHECKING

import xarray as xr

from calm.batch.finished import place_of

if TYPE_CHECKING:
    import numpy as np
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
        from calm.report.batch_figures import draw_shape

        return draw_shape(self._dataset, time)

    def _of(self, label: str, quantity: str, of_component: str) -> xr.DataArray:
        """What a variable has for a component, or that of the same quantity for a clamp."""
        prefix, index = place_of(self._dataset, label)
        variable = f"{prefix}{quantity}" if prefix else of_component
        dimension = "clamp" if prefix else "component"
        column = self._dataset[variable].isel({dimension: index}, drop=True).rename(quantity)
        return column.assign_attrs(column.attrs | {"long_name": f"{quantity} of {label}"})
