"""Quality flags of what was measured, as OceanSITES and IMOS number them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from calm.errors import UsageError

if TYPE_CHECKING:
    import xarray as xr

GOOD = frozenset({1, 2})
"""Good and probably good: what is taken unless something else is asked for."""
INTERPOLATED = 8
"""Never a measurement."""
MISSING = 9
_ENDINGS = ("_qc", "_QC", "_quality_control", "_flag")


def parse_flags(text: str) -> frozenset[int]:
    """The flags of a text such as ``1,2``.

    Raises
    ------
    UsageError
        They are no flags, or 8 is among them: what was interpolated is no measurement.
    """
    try:
        flags = frozenset(int(part) for part in text.split(","))
    except ValueError:
        raise UsageError(f"--flags: `{text[:40]}` is no list of flags; write 1,2") from None
    if INTERPOLATED in flags:
        raise UsageError("--flags: 8 marks what was interpolated, which is never a measurement")
    if not flags <= set(range(MISSING)):
        raise UsageError(f"--flags: `{text[:40]}`: flags are from 0 to 8")
    return flags


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
    told = str(variable.attrs.get("standard_name", ""))
    return "status_flag" in told or "flag_values" in variable.attrs or variable.dtype.kind in "iu"


def flags_of(variable: xr.DataArray) -> NDArray[np.int8]:
    """The flags as numbers; one without a value is 9, missing."""
    values = np.asarray(variable.values)
    if values.dtype.kind in "SU":
        values = np.where(values.astype(str) == "", "9", values.astype(str)).astype(float)
    numbers = np.asarray(values, np.float64)
    return np.where(np.isfinite(numbers), numbers, MISSING).astype(np.int8)
