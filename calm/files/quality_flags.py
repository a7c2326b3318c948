"""Quality flags that stand beside a variable, as OceanSITES and IMOS number them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    import xarray as xr
    from numpy.typing import NDArray

MISSING = 9
_ENDINGS = ("_qc", "_QC", "_quality_control", "_flag")


def flag_variable(dataset: xr.Dataset, name: str) -> xr.DataArray | None:
    """The flags of a variable: its ancillary variable, or the one that is called after it."""
    beside = str(dataset[name].attrs.get("ancillary_variables", "")).split()
    named = [*beside, *(f"{name}{ending}" for ending in _ENDINGS)]
    for other in named:
        if other not in dataset.variables or not _tells_flags(dataset[other]):
            continue
        if set(dataset[other].dims) <= set(dataset[name].dims):
            return dataset[other]
    return None


def _tells_flags(variable: xr.DataArray) -> bool:
    standard_name = str(variable.attrs.get("standard_name", ""))
    return (
        "status_flag" in standard_name
        or "flag_values" in variable.attrs
        or variable.dtype.kind in "iu"
    )


def flags_of(variable: xr.DataArray) -> NDArray[np.int8]:
    """The flags as numbers; one without a value is 9, missing."""
    import numpy as np

    values = np.asarray(variable.values)
    if values.dtype.kind in "SU":
        values = np.where(values.astype(str) == "", "9", values.astype(str)).astype(float)
    numbers = np.asarray(values, np.float64)
    return np.where(np.isfinite(numbers), numbers, MISSING).astype(np.int8)
