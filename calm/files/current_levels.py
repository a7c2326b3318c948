"""Where the levels of a current are: depths, heights, or distances from an instrument."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from calm.files.current_variables import UnreadableError, factor_of, first_present

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

_NAMES = (
    "depth", "DEPTH", "Depth", "depthu", "deptht", "lev", "z", "height", "HEIGHT", "bin_depths",
    "bindepth", "BIN_DEPTH", "HEIGHT_ABOVE_SENSOR", "DIST_SEABED", "height_above_seabed",
)  # fmt: skip
_ABOVE_SEABED = re.compile(r"above_?(the_?)?(sea_?(bed|floor)|bottom)|dist_seabed")
_FROM_INSTRUMENT = re.compile(r"(above|below|from|to)_?(the_?)?(sensor|transducer|instrument)")
_STANDARD_DEPTH = "depth"


@dataclass(frozen=True)
class Levels:
    """Levels at ``start + sign * values``, positive down, `values` in metres.

    Attributes
    ----------
    variable : its dimensions are those of the velocity, or fewer
    factor : to metres, with the sign: negative where values grow upwards
    start : depth of their zero [m]
    instrument : depth of the instrument they are counted from, and its factor to metres
    notes : what was taken for granted
    """

    variable: xr.DataArray
    factor: float
    start: float
    instrument: tuple[xr.DataArray, float] | None
    notes: tuple[str, ...]

    def vary_in(self, time: str | None) -> bool:
        """Whether the levels move with time."""
        moving = [self.variable, *([self.instrument[0]] if self.instrument else [])]
        return any(time in one.dims for one in moving)

    def depths(self, time: str | None, index: Any) -> NDArray[Any]:
        """The depths [m] at some times: times by levels, or levels only where they never move."""
        import numpy as np

        def values(variable: xr.DataArray) -> NDArray[Any]:
            chosen = variable.isel({time: index}) if time in variable.dims else variable
            order = [dim for dim in (time,) if dim in chosen.dims]
            return np.asarray(chosen.transpose(*order, ...).values, np.float64)

        depth = self.start + values(self.variable) * self.factor
        depth = depth.reshape(-1, 1) if self.variable.dims == (time,) else np.atleast_1d(depth)
        if self.instrument is not None:
            variable, factor = self.instrument
            depth = (values(variable) * factor).reshape(-1, 1) + depth
            depth = depth if self.vary_in(time) else depth[0]
        return depth


def find_levels(
    dataset: xr.Dataset, level: str | None, time: str | None, water_depth: float
) -> Levels:
    """The levels of a velocity that spreads over `level` and `time`, either of them None.

    Those that move with time come before those that do not; `water_depth` [m] places heights
    above the seabed.

    Raises
    ------
    UnreadableError
        There are none, or it does not say which way they grow.
    """
    candidates = _candidates(dataset, level, time)
    if not candidates:
        raise UnreadableError("its levels have no depth")
    unusable: list[UnreadableError] = []
    for variable in candidates:
        try:
            factor = factor_of(variable, "length")
        except UnreadableError as error:
            unusable.append(error)
        else:
            return _placed(dataset, variable, factor, time, water_depth)
    raise unusable[0]


def _candidates(dataset: xr.Dataset, level: str | None, time: str | None) -> list[xr.DataArray]:
    standard = dataset.cf.standard_names
    names = [
        *dataset.cf.axes.get("Z", []),
        *dataset.cf.coordinates.get("vertical", []),
        *standard.get(_STANDARD_DEPTH, []),
        *standard.get("height_above_sea_floor", []),
        *_NAMES,
    ]
    wanted = {level} - {None}
    fitting = [
        dataset[name]
        for name in first_present(dataset, names)
        if wanted <= set(dataset[name].dims) <= {level, time}
    ]
    return sorted(fitting, key=lambda variable: time not in variable.dims)


def _placed(
    dataset: xr.Dataset, levels: xr.DataArray, factor: float, time: str | None, water_depth: float
) -> Levels:
    told = " ".join(
        str(word)
        for word in (
            levels.name,
            levels.attrs.get("standard_name", ""),
            levels.attrs.get("long_name", ""),
            levels.attrs.get("reference_datum", ""),
        )
    )
    told = re.sub(r"\W+", "_", told.lower())
    if _ABOVE_SEABED.search(told):
        note = f"`{levels.name}` is the height above the seabed, at {water_depth:g} m"
        return Levels(levels, -factor, water_depth, None, (note,))
    positive = str(levels.attrs.get("positive", "")).lower()
    from_instrument = _FROM_INSTRUMENT.search(told) or str(
        levels.attrs.get("reference_datum", "")
    ).lower() in ("sensor", "instrument", "transducer")
    if not positive and "depth" in told and not from_instrument:
        positive = "down"
    if positive not in ("up", "down"):
        raise UnreadableError(f"`{levels.name}` does not say whether it is `positive` up or down")
    factor = factor if positive == "down" else -factor
    if not from_instrument and time not in levels.dims and _all_in_air(levels, factor):
        raise UnreadableError(
            f"`{levels.name}` is positive {positive}, and no level of it is below the surface: "
            "its sign or its `positive` is wrong"
        )
    if not from_instrument:
        return Levels(levels, factor, 0.0, None, ())
    instrument = _instrument(dataset, levels, time)
    note = f"`{levels.name}` counts from the instrument, whose depth is `{instrument[0].name}`"
    return Levels(levels, factor, 0.0, instrument, (note,))


def _all_in_air(levels: xr.DataArray, factor: float) -> bool:
    import numpy as np

    depth = np.asarray(levels.values, np.float64) * factor
    return bool((depth < 0).any() and not (depth > 0).any())


def _instrument(
    dataset: xr.Dataset, levels: xr.DataArray, time: str | None
) -> tuple[xr.DataArray, float]:
    """The depth of the instrument and its factor to metres."""
    names = [*dataset.cf.standard_names.get(_STANDARD_DEPTH, []), *_NAMES]
    for name in first_present(dataset, names):
        depth = dataset[name]
        upwards = depth.attrs.get("positive") == "up"
        if name != levels.name and set(depth.dims) <= {time} and not upwards:
            return depth, factor_of(depth, "length")
    raise UnreadableError(
        f"`{levels.name}` counts from the instrument, whose depth is not in the file"
    )
