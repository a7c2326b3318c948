"""Read levels, densities and currents from a file of Mooring Design & Dynamics."""

import numpy as np

from calm.exchange import model
from calm.exchange.current_record import CurrentRecord
from calm.exchange.mat_file import MatVariables, RealArray

_MATLAB_EPOCH = 719529.0  # datenum of 1 January 1970
_EARLIEST, _LATEST = 500_000.0, 1_000_000.0  # datenums that are dates of this age


def read_water(
    variables: MatVariables, towed: bool, guessed: list[model.Remark]
) -> tuple[model.ImportedWater | None, CurrentRecord | None]:
    """Read the environment of a file, and the current record if the file has several profiles.

    The variable `z` holds heights above the seabed up to the surface, or depths if `towed`. The
    environment has the first current profile. Raise ValueError if `z` is negative or incomplete, or
    if variables have gaps or different sizes.
    """
    levels = variables.reals("z").ravel()
    if not np.any(levels > 0.0):
        return None, None
    if not np.all(np.isfinite(levels)) or np.any(levels < 0.0):
        raise ValueError("the heights in `z` must be zero or more")
    seabed = float(levels.max())
    profiles = [_profiles(variables, name, levels.size) for name in "UVW"]
    if profiles[0] is None and profiles[1] is None:
        return None, None
    times = max(each.shape[1] for each in profiles if each is not None)
    u, v, w = (
        _filled(each, name, levels.size, times) for each, name in zip(profiles, "UVW", strict=True)
    )
    densities = _profiles(variables, "rho", levels.size)
    density = np.zeros(0) if densities is None else densities[:, 0]
    if densities is not None and densities.shape[1] > 1:
        if not np.all(np.isfinite(density)):
            raise ValueError("`rho` has gaps in its first profile")
        what = f"the first of {densities.shape[1]} profiles; a mooring has only one density profile"
        guessed.append(model.Remark("environment.density", what))
    order = np.arange(levels.size) if towed else np.argsort(seabed - levels, kind="stable")
    depth = np.sort(levels) if towed else (seabed - levels)[order]
    u, v, w = u[order], v[order], w[order]
    keep = np.append(True, np.diff(depth) > 0.0)
    water = model.ImportedWater(None if towed else seabed)
    if density.size:
        rows = list(zip(depth[keep].tolist(), density[order][keep].tolist(), strict=True))
        uniform = all(row[1] == rows[0][1] for row in rows)
        water.density = rows[0][1] if uniform else tuple(rows)
    first = np.column_stack([depth, u[:, 0], v[:, 0], w[:, 0]])[keep]
    if np.any(first[:, 1:]) or times > 1:
        water.current = tuple((float(d), float(e), float(n), float(up)) for d, e, n, up in first)
    if times == 1:
        return water, None
    days, epoch = _days(variables.reals("time").ravel(), times, guessed)
    return water, CurrentRecord(days, epoch, depth[keep], u[keep].T, v[keep].T, w[keep].T)


def _profiles(variables: MatVariables, name: str, levels: int) -> RealArray | None:
    """Return profiles as an array (levels, times).

    In the file, either dimension may come first.
    """
    values = variables.reals(name)
    if values.size == 0:
        return None
    values = np.atleast_2d(values)
    if values.ndim == 2 and values.shape[0] == levels:
        return values
    if values.ndim == 2 and values.shape[1] == levels:
        return values.T
    shape = "×".join(str(length) for length in values.shape)
    raise ValueError(
        f"`{name}` has the size {shape}, which does not match the {levels} values of `z`"
    )


def _filled(values: RealArray | None, name: str, levels: int, times: int) -> RealArray:
    if values is None:
        return np.zeros((levels, times))
    if values.shape[1] not in (1, times):
        raise ValueError(
            f"`{name}` has {values.shape[1]} profiles, but the other variables have {times}"
        )
    if not np.all(np.isfinite(values[:, 0])):
        raise ValueError(f"`{name}` has gaps in its first profile")
    return np.broadcast_to(values, (levels, times))


def _days(time: RealArray, times: int, guessed: list[model.Remark]) -> tuple[RealArray, str]:
    """Return the times of the profiles in days, and the date of day 0."""
    if time.size != times:
        guessed.append(
            model.Remark(
                "record.time",
                "the file has no time for each profile; hourly profiles from 2000-01-01 are "
                "assumed",
            )
        )
        return np.arange(times) / 24.0, "2000-01-01"
    if np.all((time > _EARLIEST) & (time < _LATEST)):
        return time - _MATLAB_EPOCH, "1970-01-01"
    guessed.append(
        model.Remark(
            "record.time", "the times are not dates and were read as days since 2000-01-01"
        )
    )
    return time - time[0], "2000-01-01"
