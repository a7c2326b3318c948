"""A dataset of currents as arrays of depth, u, v and w: one profile or many, read as asked for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from calm.files.current_levels import Levels, find_levels
from calm.files.current_place import choose_column, is_regular
from calm.files.current_terms import Terms
from calm.files.current_times import find_times, read_times, zone_notices
from calm.files.current_values import known_values
from calm.files.current_variables import (
    UnreadableError,
    Velocity,
    factor_of,
    find_velocity,
    holdings,
    refuse_ragged,
)
from calm.files.current_vectors import with_components
from calm.files.quality_flags import flag_variable, flags_of

if TYPE_CHECKING:
    import numpy as np
    import xarray as xr
    from numpy.typing import NDArray

FLAGS = "the quality flags of the current are ignored"


@dataclass(frozen=True)
class CurrentArrays:
    """Currents of n profiles as they stand in a file, gaps as NaN, levels in the file's order.

    Attributes
    ----------
    depth : (k,), or (n, k) where levels move [m], positive down
    u, v : (n, k) to the east and to the north [m/s]; inf where the file has a negative speed or
        a direction outside -360 to 360°
    w : (n, k) upwards [m/s], None where the file has none
    """

    depth: NDArray[np.float64]
    u: NDArray[np.float64]
    v: NDArray[np.float64]
    w: NDArray[np.float64] | None


@dataclass(frozen=True)
class CurrentDataset:
    """A dataset whose current, levels, times and place have been found.

    Attributes
    ----------
    times : (n,) in the order of the file; None for a profile without a time
    notices : what a person should know before trusting it
    turned : angle by which a current relative to magnetic north was turned
    rules : what was understood beyond doubt, and how
    source : names of the variables, and the place
    """

    times: NDArray[np.datetime64] | None
    notices: tuple[str, ...]
    turned: tuple[str, ...]
    rules: tuple[str, ...]
    source: dict[str, str]
    _parts: tuple[tuple[xr.DataArray, float], ...]
    _flags: tuple[xr.DataArray, ...]
    _turn: float | None
    _declination: float
    _levels: Levels
    _time: str | None

    @property
    def moves(self) -> bool:
        """Whether the levels move with time."""
        return self._levels.vary_in(self._time)

    @property
    def chunk(self) -> int:
        """How many times the file decompresses together; 1 where it does not compress."""
        variable = self._parts[0][0]
        chunks: dict[str | None, int] = variable.encoding.get("preferred_chunks", {})
        return chunks.get(self._time, 1)

    @property
    def size(self) -> int:
        """Bytes of one profile as it is read."""
        variable = self._parts[0][0]
        levels: int = variable.size // max(variable.sizes.get(self._time, 1), 1)
        return 8 * levels * (len(self._parts) + self.moves)

    def read(self, index: slice | NDArray[np.intp]) -> CurrentArrays:
        """The profiles of some times, by their index; all profiles where there is no time."""
        import numpy as np

        first, second, *up = (
            self._values(variable, index) * factor for variable, factor in self._parts
        )
        if self._turn is not None:
            angle = np.radians(second + self._turn)
            impossible = (first < 0.0) | (np.abs(second) > 360.0)
            first, second = first * np.sin(angle), first * np.cos(angle)
            first[impossible] = second[impossible] = np.inf  # to be refused by whoever asked
        if self._declination:
            angle = np.radians(self._declination)
            with np.errstate(invalid="ignore"):  # of what is infinite
                first, second = (
                    first * np.cos(angle) + second * np.sin(angle),
                    second * np.cos(angle) - first * np.sin(angle),
                )
        depth = self._levels.depths(self._time, index)
        return CurrentArrays(depth, first, second, up[0] if up else None)

    def flags(self, index: slice | NDArray[np.intp]) -> NDArray[np.int8] | None:
        """(n, k) the worse quality flags of both components at some times; None without flags."""
        import numpy as np

        if self._time is None or not self._flags:
            return None
        first = self._parts[0][0].isel({self._time: index}).transpose(self._time, ...)
        worst = np.zeros(first.shape, np.int8)
        for variable in self._flags:
            own = variable.broadcast_like(self._parts[0][0]).isel({self._time: index})
            worst = np.maximum(worst, flags_of(own.transpose(*first.dims)))
        return worst.reshape(len(worst), -1)

    def _values(self, variable: xr.DataArray, index: Any) -> NDArray[np.float64]:
        """Times by levels, contiguous, so that equal values give equal results in any company."""
        if self._time is None:
            return known_values(variable).reshape(1, -1)
        values = known_values(variable.isel({self._time: index}).transpose(self._time, ...))
        return values.reshape(len(values), -1)


def understand(dataset: xr.Dataset, terms: Terms) -> CurrentDataset:
    """What a dataset holds, without reading its currents.

    Parameters
    ----------
    dataset : as it stands in the file, its times undecoded
    terms : how its currents are to be taken

    Raises
    ------
    UnreadableError
        It holds no current that can be understood: why, and what it holds.
    """
    try:
        return _understood(dataset, terms)
    except UnreadableError as error:
        raise UnreadableError(f"{error}; it holds {holdings(dataset)}") from None


def _understood(dataset: xr.Dataset, terms: Terms) -> CurrentDataset:
    dataset = with_components(dataset)
    velocity = find_velocity(dataset, regular=is_regular(dataset))
    refuse_ragged(dataset, velocity.names[0])
    turned = _turned(velocity, terms.declination)
    name_of_time = find_times(dataset, velocity.names[0])
    times = None if name_of_time is None else read_times(dataset, name_of_time)
    time = _dimension(dataset, name_of_time)
    column = choose_column(dataset, velocity.names, time, terms.place)
    level, dataset = _single_levels(dataset.isel(column.index), velocity, time)
    levels = find_levels(dataset, level, time, terms.water_depth)
    source = {"velocity": ", ".join(velocity.all_names), "levels": str(levels.variable.name)}
    if name_of_time is not None:
        source["time"] = name_of_time
    if column.place is not None:
        source |= zip(
            ("latitude", "longitude"), (f"{degrees:.6g}" for degrees in column.place), strict=True
        )
    notices = [*column.notes]
    if name_of_time is not None:
        notices += zone_notices(dataset, name_of_time)
    flags = (flag_variable(dataset, name) for name in velocity.names)
    flags_beside = tuple(one for one in flags if one is not None)
    if flags_beside:
        notices.append(FLAGS)
    return CurrentDataset(
        times=times,
        notices=tuple(notices),
        turned=turned,
        rules=(*velocity.notes, *levels.notes),
        source=source,
        _parts=tuple(_parts(dataset, velocity)),
        _flags=flags_beside,
        _turn=velocity.turn,
        _declination=terms.declination or 0.0,
        _levels=levels,
        _time=time,
    )


def _turned(velocity: Velocity, declination: float | None) -> tuple[str, ...]:
    """What is reported of a current that is relative to magnetic north."""
    counted = velocity.names if velocity.turn is None else velocity.names[1:]
    which = " and ".join(f"`{name}`" for name in counted)
    if velocity.magnetic and declination is None:
        raise UnreadableError(
            f"{which} are relative to magnetic north; give the `declination` there, positive "
            "to the "
            "east (beside `file:`, or `--declination`)"
        )
    if declination is not None and not velocity.magnetic:
        raise UnreadableError(
            f"{which} are not said to be relative to magnetic north, so no `declination` is "
            "applied; "
            "leave it out"
        )
    if declination is None:
        return ()
    return (f"{which} were relative to magnetic north, turned by {declination:g}°",)


def _dimension(dataset: xr.Dataset, time: str | None) -> str | None:
    """The dimension of the times, None where they have none."""
    return None if time is None else next(map(str, dataset[time].dims), None)


def _single_levels(
    dataset: xr.Dataset, velocity: Velocity, time: str | None
) -> tuple[str | None, xr.Dataset]:
    """The dimension of the levels, and the dataset without dimensions of one value."""
    name = velocity.names[0]
    single = [dim for dim, size in dataset.sizes.items() if size == 1 and dim != time]
    dataset = dataset.isel(dict.fromkeys(single, 0))
    for other in velocity.all_names[1:]:
        if set(dataset[other].dims) != set(dataset[name].dims):
            raise UnreadableError(
                f"`{name}` and `{other}` have different dimensions: "
                f"{_spread(dataset[name])}; {_spread(dataset[other])}"
            )
    levels = [str(dim) for dim in dataset[name].dims if dim != time]
    if len(levels) > 1:
        raise UnreadableError(
            f"`{name}` is not a single profile, but spreads over {_spread(dataset[name])}"
        )
    return (levels[0] if levels else None), dataset


def _parts(dataset: xr.Dataset, velocity: Velocity) -> list[tuple[xr.DataArray, float]]:
    """The variables of the current, each with its factor to SI (angles: degrees)."""
    dimensions = ("speed", "speed" if velocity.turn is None else "angle", "speed")
    return [
        (dataset[name], factor_of(dataset[name], dimension))
        for name, dimension in zip(velocity.all_names, dimensions, strict=False)
    ]


def _spread(variable: xr.DataArray) -> str:
    return ", ".join(f"{name} ({size})" for name, size in variable.sizes.items())
