"""Variables of instruments: which dimension counts these, and what each is called."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from calm.files.current_values import known_values
from calm.files.current_variables import UnreadableError, factor_of
from calm.physics.line import Floats

if TYPE_CHECKING:
    import xarray as xr

_LABELS = ("instrument", "label", "instrument_label", "labels", "instruments")
_HEIGHTS = ("hab", "height_above_bottom", "height_above_seabed", "DIST_SEABED")
_DEPTHS = ("nominal_depth", "NOMINAL_DEPTH", "InstrDepth", "DEPTH", "depth", "instrument_depth")


def labels_along(dataset: xr.Dataset, dimension: str) -> tuple[str, ...] | None:
    """The labels of what a dimension counts; None where it has none."""
    for name in (*_LABELS, dimension):
        if name not in dataset.variables or dataset[name].dims != (dimension,):
            continue
        values = np.asarray(dataset[name].values)
        if values.dtype.kind in "SUO":
            texts = [one.decode() if isinstance(one, bytes) else str(one) for one in values]
            return tuple(text.strip() for text in texts)
    return None


def places_along(dataset: xr.Dataset, dimension: str | None, seabed: float) -> Floats | None:
    """Nominal depths of what a dimension counts [m]; of the one instrument without it.

    Heights above the bottom are counted from `seabed` [m].
    """
    dims = () if dimension is None else (dimension,)
    for names, sign, start in ((_HEIGHTS, -1.0, seabed), (_DEPTHS, 1.0, 0.0)):
        for name in names:
            if name in dataset.variables and dataset[name].dims == dims:
                try:
                    factor = factor_of(dataset[name], "length")
                except UnreadableError:
                    continue
                values = np.atleast_1d(known_values(dataset[name])) * factor
                return start + sign * values
    return None
