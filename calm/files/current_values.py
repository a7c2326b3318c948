"""The values of a variable: what is outside its own limits is a gap."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    import xarray as xr
    from numpy.typing import NDArray


def known_values(variable: xr.DataArray) -> NDArray[np.float64]:
    """The values of a variable as it stands in its file, NaN outside its valid range.

    `valid_range`, or `valid_min` and `valid_max`, are those of the NetCDF User Guide: of packed
    values where they are of the packed kind.
    """
    import numpy as np

    values = np.array(variable.values, np.float64)
    low, high = _valid_range(variable)
    if low > -inf or high < inf:
        values[(values < low) | (values > high)] = np.nan
    return values


def _valid_range(variable: xr.DataArray) -> tuple[float, float]:
    """The least and the greatest valid value, unpacked."""
    attributes = variable.attrs
    low, high = attributes.get("valid_min"), attributes.get("valid_max")
    both = attributes.get("valid_range")
    if both is not None and len(both) == 2:
        low, high = both
    least = _unpacked(low, variable, -inf)
    greatest = _unpacked(high, variable, inf)
    return min(least, greatest), max(least, greatest)


def _unpacked(limit: Any, variable: xr.DataArray, absent: float) -> float:
    import numpy as np

    try:
        value = float(absent if limit is None else limit)
    except (TypeError, ValueError):  # a text that is no number limits nothing
        return absent
    packed = np.dtype(variable.encoding.get("dtype", np.float64))
    if limit is None or not (packed.kind in "iu" and np.asarray(limit).dtype.kind in "iu"):
        return value
    scale, offset = (
        float(variable.encoding.get(name, default))
        for name, default in (("scale_factor", 1.0), ("add_offset", 0.0))
    )
    return value * scale + offset
