"""Datasets of currents, read lazily as arrays of depth, u, v and w for one or many profiles."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.errors import refused
from calm.physics.line import Floats
from calm.records import cf_files, velocity
from calm.records.card import ReadCard, VariableSummary, description_of, texts_in
from calm.records.current_terms import Terms
from calm.records.grids import GridColumn, choose_column, is_regular
from calm.records.level_depths import find_levels
from calm.records.profile_tables import turned_by
from calm.records.record import RULES, Index, Levels, Period, Record, choose_profiles, part
from calm.records.value_tests import CurrentValues, current_doubts, step_doubts

if TYPE_CHECKING:
    import xarray as xr

READ_AHEAD = 16_000_000
"""Maximum size of profiles that are read together because they share a compressed chunk [bytes]."""

SAMPLED = 64_000_000
"""Sample size for tests of doubtful values, spread evenly over the record [bytes]."""


class CurrentDataset:
    """A dataset of currents with identified velocity, levels, times and position.

    The constructor raises UnreadableError if the file has no usable current. Values are read later.

    Attributes
    ----------
    times : (n,) times in file order; None for a profile without a time
    turned : notice of a rotation from magnetic to true north, or empty
    rules : rules by which the file was read
    source : names of the variables, and the position of the grid column
    labels : parts of a line that carry the instruments, if the levels have no depths; else empty
    """

    def __init__(self, dataset: xr.Dataset, terms: Terms) -> None:
        with cf_files.saying_what_it_holds(dataset):
            self._understand(velocity.with_components(dataset), terms)

    def _understand(self, dataset: xr.Dataset, terms: Terms) -> None:
        self._terms = terms
        self._velocity = current = velocity.find_velocity(dataset, regular=is_regular(dataset))
        velocity.refuse_ragged(dataset, current.names[0])
        self.turned = _rotation_notice(current, terms.declination)
        clock = cf_files.find_times(dataset, current.names[0])
        self.times = None if clock is None else cf_files.read_times(dataset, clock)
        self._time = None if clock is None else next(map(str, dataset[clock].dims), None)
        column, self._levels, self.labels = GridColumn({}, None), None, tuple[str, ...]()
        along = [str(dim) for dim in dataset[current.names[0]].dims if dim != self._time]
        if terms.on_the_line and len(along) == 1:  # levels may be labels of parts of a line
            self.labels = cf_files.labels_along(dataset, along[0]) or ()
        if not self.labels:
            column = choose_column(dataset, current.names, self._time, terms.place)
            level, dataset = _level_dimension(dataset.isel(column.index), current, self._time)
            self._levels = find_levels(dataset, level, self._time, terms.water_depth)
        self.source, notices = {"velocity": ", ".join(current.all_names)}, [*column.notes]
        if self._levels is not None:
            self.source["levels"] = str(self._levels.variable.name)
        if clock is not None:
            self.source["time"] = clock
            notices += cf_files.zone_notices(dataset, clock)
        if column.place is not None:
            latitude, longitude = (f"{degrees:.6g}" for degrees in column.place)
            self.source |= {"latitude": latitude, "longitude": longitude}
        self.notices = tuple(notices)
        self._texts, self._clock = texts_in(dataset.attrs), ("", "")
        if clock is not None:
            self._clock = clock, str(dataset[clock].attrs.get("units", ""))
        self._good = velocity.good_variables(dataset, current.names[0])
        self.rules = (*current.notes, *(() if self._levels is None else self._levels.notes))
        found = (velocity.flag_variable(dataset, name) for name in current.names)
        self._flags = [*{str(one.name): one for one in found if one is not None}.values()]
        dimensions = ("speed", "speed" if current.turn is None else "angle", "speed")
        self._parts = [
            (dataset[name], cf_files.factor_of(dataset[name], dimension))
            for name, dimension in zip(current.all_names, dimensions, strict=False)
        ]

    @property
    def moves(self) -> bool:
        """Whether the depths of the levels change with time."""
        return self._levels is not None and self._levels.vary_in(self._time)

    @property
    def chunk(self) -> int:
        """Number of times in a chunk of the file; 1 if the file has no chunks."""
        variable = self._parts[0][0]
        chunks: dict[str | None, int] = variable.encoding.get("preferred_chunks", {})
        return chunks.get(self._time, 1)

    @property
    def size(self) -> int:
        """Size of one profile in memory [bytes]."""
        variable = self._parts[0][0]
        levels: int = variable.size // max(variable.sizes.get(self._time, 1), 1)
        return 8 * levels * (len(self._parts) + self.moves)

    def read(self, index: Index) -> Levels:
        """Read the profiles at the given time indices, or the only profile.

        Return depths (k,) [m], or (n, k) if the levels move, and components u, v and w (n, k)
        [m/s]. w is None without vertical velocity. u and v are inf if the speed is negative, or the
        direction beyond ±360°.
        """
        first, second, *up = (
            self._along(variable, index, cf_files.known_values) * factor
            for variable, factor in self._parts
        )
        if not self._terms.on_the_line:
            for variable in self._flags:
                bad = self._along(variable, index, velocity.marked_bad)
                first[bad] = second[bad] = np.nan
        if self._velocity.turn is not None:
            impossible = (first < 0.0) | (np.abs(second) > 360.0)
            first, second = self._velocity.components(first, second)
            first[impossible] = second[impossible] = np.inf  # callers reject infinite currents
        if self._terms.declination:
            with np.errstate(invalid="ignore"):  # inf from above
                first, second = turned_by(self._terms.declination, first, second)
        none, levels = np.full(first.shape[1], np.nan), self._levels
        depth = none if levels is None else levels.depths(self._time, index)
        return depth, first, second, up[0] if up else None

    def flags(self, index: Index) -> NDArray[np.int8] | None:
        """Return quality flags (n, k) of the currents; None if the file has no flags.

        The flag of a current is the worse of the flags of its two components.
        """
        if not self._flags:
            return None
        every = [self._along(one, index, velocity.flags_of) for one in self._flags]
        return np.asarray(np.maximum.reduce(every), np.int8)

    def inspected(self, file: str, index: Index) -> tuple[ReadCard, list[str]]:
        """Return the summary card of the profiles at given times, and doubts about the values.

        In a large record, a sample of evenly spaced profiles is used. The indices of the times must
        increase.
        """
        every, times = self.times, None
        notes: list[str] = []
        if every is not None:
            every = every[index]
            sparse = max(len(every) * self.size // SAMPLED, 1)
            if isinstance(index, slice):
                index = slice(index.start, index.stop, (index.step or 1) * sparse)
            else:
                index = index[::sparse]
            times = every[::sparse]
        summaries = {}
        for taken, (variable, _) in zip(self._roles, self._parts, strict=False):
            values = self._along(variable, index, lambda one: one.values.astype(np.float64))
            low, high = cf_files.valid_range(variable)
            outside = (values < low) | (values > high)
            if outside.any():
                notes.append(
                    f"{outside.sum()} of {np.isfinite(values).sum()} values of `{variable.name}` "
                    f"were excluded, because they are outside its valid range, {low:g} to {high:g}"
                )
                values[outside] = np.nan
            units = str(variable.attrs.get("units", ""))
            description = description_of(variable.attrs)
            summaries[taken] = VariableSummary.of(str(variable.name), units, values, description)
        depth, u, v, _ = self.read(index)
        if self._levels is not None:
            variable = self._levels.variable
            if not (self._terms.on_the_line or np.isfinite(depth).any()):
                raise cf_files.UnreadableError(f"all level depths in `{variable.name}` are missing")
            description = description_of(variable.attrs)
            summaries["depth"] = VariableSummary.of(str(variable.name), "m", depth, description)
        removed = {}
        for variable in () if self._terms.on_the_line else self._flags:
            bad = self._along(variable, index, velocity.marked_bad)
            removed[str(variable.name)] = int(bad.sum())
            if bad.any():
                notes.append(
                    f"{bad.sum()} of {bad.size} currents were excluded, because `{variable.name}` "
                    "marks them as bad"
                )
        good = [
            share_of(self._along(one, index, cf_files.known_values))
            for one in self._good
            if set(one.dims) <= set(self._parts[0][0].dims)
        ]
        card = ReadCard(
            file, self._texts, summaries, u.shape[1], np.empty(0, "M8[ns]") if every is None else
            every, self._clock, removed, self._terms.declination,
        )  # fmt: skip
        variable, factor = self._parts[0]
        values = CurrentValues(
            depth, u, v, times, self._terms.water_depth, str(variable.attrs.get("units", "m/s")),
            factor, np.sum(good, axis=0) if good else None,
        )  # fmt: skip
        return card, [*notes, *current_doubts(values)]

    @property
    def _roles(self) -> tuple[str, ...]:
        components = self._velocity.turn is None
        return ("east", "north", "up") if components else ("speed", "direction", "up")

    def _along(
        self, variable: xr.DataArray, index: Any, read: Callable[[xr.DataArray], Any]
    ) -> Any:
        """Read a variable as a contiguous array (times, levels)."""
        like = self._parts[0][0]
        if set(variable.dims) != set(like.dims):
            variable = variable.broadcast_like(like)
        if self._time is None:
            return read(variable).reshape(1, -1)
        levels = [dim for dim in like.dims if dim != self._time]
        values = read(variable.isel({self._time: index}).transpose(self._time, *levels))
        # contiguous, so that sums over equal values are equal to the last bit
        return values.reshape(len(values), -1)


def share_of(good: Floats) -> Floats:
    """Return shares of good pings as fractions; shares are percentages if a value is above 1."""
    return good / 100.0 if np.nanmax(good, initial=0.0) > 1.0 else good


def _rotation_notice(current: velocity.Velocity, declination: float | None) -> tuple[str, ...]:
    counted = current.names if current.turn is None else current.names[1:]
    which = " and ".join(f"`{name}`" for name in counted)
    if current.magnetic and declination is None:
        raise cf_files.UnreadableError(
            f"{which} are relative to magnetic north; set the `declination` of the site (positive "
            "to the east) next to `file:`, or with `--declination`"
        )
    if declination is not None and current.true:
        raise cf_files.UnreadableError(
            f"{which} are relative to true north according to their attributes; remove "
            "`declination`"
        )
    if declination is None:
        return ()
    unstated = "" if current.magnetic else ", as specified by the user, not by the file"
    return (
        f"{which} were relative to magnetic north{unstated}, and were rotated by {declination:g}°",
    )


def _level_dimension(
    dataset: xr.Dataset, current: velocity.Velocity, time: str | None
) -> tuple[str | None, xr.Dataset]:
    """Return the level dimension, and the dataset without dimensions of length one."""
    name = current.names[0]
    single = [dim for dim, size in dataset.sizes.items() if size == 1 and dim != time]
    dataset = dataset.isel(dict.fromkeys(single, 0))
    for other in current.all_names[1:]:
        if set(dataset[other].dims) != set(dataset[name].dims):
            raise cf_files.UnreadableError(
                f"`{name}` and `{other}` have different dimensions: "
                f"{_spread(dataset[name])}; {_spread(dataset[other])}"
            )
    levels = [str(dim) for dim in dataset[name].dims if dim != time]
    if len(levels) > 1:
        raise cf_files.UnreadableError(
            f"`{name}` is not a single profile; it has the dimensions {_spread(dataset[name])}"
        )
    return (levels[0] if levels else None), dataset


def _spread(variable: xr.DataArray) -> str:
    return ", ".join(f"{name} ({size})" for name, size in variable.sizes.items())


class ArrayRecord(Record):
    """A record of profiles in NetCDF or zarr, read by the same rules as a single profile.

    For the parameters and errors, see `open_record`.
    """

    def __init__(self, path: Path, terms: Terms, period: Period | None, every: int) -> None:
        self._path = path
        with cf_files.reading(path):
            self._dataset = cf_files.open_current(path)
            try:
                self._current = found = CurrentDataset(self._dataset, terms)
                if found.times is None:
                    raise refused(path, "has no times: it is one profile, for `calm run`")
                self._index, chosen = choose_profiles(found.times, period, every, path)
                whole, _ = choose_profiles(found.times, period, 1, path)
                card, doubts = found.inspected(path.name, whole)
            except BaseException:
                self._dataset.close()
                raise
        self.cards = (card,)
        self.time, self.labels = found.times[self._index], found.labels
        doubts += step_doubts(self.time)
        self.notes = (*chosen, *found.notices, *found.turned, *doubts, *found.rules, *RULES)
        self.source = {"file": path.name, **found.source}
        self._ahead: tuple[int, int, Levels] | None = None

    def profiles(self, start: int, stop: int) -> Levels:
        """Return the levels of profiles `start` to `stop`; see `Record.profiles`."""
        first, _, (depth, u, v, w) = self._window(start, stop)
        mine = slice(start - first, stop - first)
        depth = depth[mine] if self._current.moves else depth
        return depth, u[mine], v[mine], None if w is None else w[mine]

    def flags(self, start: int, stop: int) -> NDArray[np.int8] | None:
        """Return the quality flags of profiles `start` to `stop`; see `Record.flags`."""
        with cf_files.reading(self._path):
            return self._current.flags(part(self._index, start, stop))

    def _window(self, start: int, stop: int) -> tuple[int, int, Levels]:
        """Return start, end and values of a range of profiles that includes `start` to `stop`.

        The range extends to the end of a compressed chunk, so that each chunk is decompressed only
        once.
        """
        if self._ahead is not None and self._ahead[0] <= start and stop <= self._ahead[1]:
            return self._ahead
        self._ahead = None
        end = min(max(stop, self._end_of_chunk(start)), self.count)
        with cf_files.reading(self._path):
            window = start, end, self._current.read(part(self._index, start, end))
        if end > stop:
            self._ahead = window
        return window

    def _end_of_chunk(self, start: int) -> int:
        chunk = self._current.chunk
        if isinstance(self._index, slice):
            position = self._index.start + start * self._index.step
            chunk = -(-(chunk - position % chunk) // int(self._index.step))
        return start + min(chunk, READ_AHEAD // max(self._current.size, 1))

    def close(self) -> None:
        """Close the dataset."""
        self._dataset.close()
