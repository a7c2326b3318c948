"""Where the levels of a current are: depths, heights, or distances from an instrument."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.records.attributes import words_of
from calm.records.cf_files import UnreadableError, factor_of, first_present, known_values

if TYPE_CHECKING:
    import xarray as xr

_NAMES = (
    "depth", "DEPTH", "Depth", "depthu", "deptht", "lev", "z", "z_rho", "height", "HEIGHT",
    "bin_depths", "bindepth", "BIN_DEPTH", "HEIGHT_ABOVE_SENSOR", "DIST_SEABED",
    "height_above_seabed", "hab", "height_above_bottom", "range", "range_avg",
)  # fmt: skip
_ABOVE_SEABED = re.compile(r"above (the )?(sea ?(bed|floor)|bottom)|dist seabed")
_HEAD = r"(adcp|adp|sensor|transducers?|instrument|head|profiler|device)"
_FROM_INSTRUMENT = re.compile(
    rf"\b(above|below|from|to) (the )?(\w+ )?{_HEAD}\b|\b(profile|bin) range\b|^range( avg)?\b"
)
_OF_THE_WATER = re.compile(r"\b(water|bottom|sea ?(bed|floor)) ?depth\b|\bsea floor\b|\bseabed\b")
_COUNTED = re.compile(
    r"\b(bin|cell|layer|level|grid) (number|index|count)\b|"
    r"\b(number|index) of (the )?(bin|cell|layer|level)s?\b"
)
_ALONG_BEAM = re.compile(r"\balong (\w+ ){0,2}beams?\b|\bslant (range|distance)|\bbeam range\b")
_UPWARDS = re.compile(r"\b(z ?)?up(wards?)?\b")
_DOWNWARDS = re.compile(r"\b(z ?)?down(wards?)?\b")
_MODEL_COORDINATE = re.compile(r"ocean_\w*(sigma|s)_\w*coordinate\w*|ocean_sigma\w*")
_HEIGHTS = ("z", "z_rho")
_STANDARD_DEPTH = "depth"


@dataclass(frozen=True)
class LevelDepths:
    """Levels at ``start + sign * values``, positive down, `values` in metres.

    Attributes
    ----------
    variable : its dimensions are those of the velocity, or fewer
    factor : to metres, with the sign: negative where values grow upwards
    start : depth of their zero [m]
    instrument : depth of the instrument they are counted from, and its factor to metres
    notes : what was assumed
    """

    variable: xr.DataArray
    factor: float
    start: float
    instrument: tuple[xr.DataArray, float] | None
    notes: tuple[str, ...]

    def vary_in(self, time: str | None) -> bool:
        """Return whether the levels move with time."""
        moving = [self.variable, *([self.instrument[0]] if self.instrument else [])]
        return any(time in one.dims for one in moving)

    def depths(self, time: str | None, index: Any) -> NDArray[Any]:
        """Return the depths [m], times by levels; levels alone where they never move."""

        def values(variable: xr.DataArray) -> NDArray[Any]:
            chosen = variable.isel({time: index}) if time in variable.dims else variable
            order = [dim for dim in (time,) if dim in chosen.dims]
            return known_values(chosen.transpose(*order, ...))

        depth = self.start + values(self.variable) * self.factor
        depth = depth.reshape(-1, 1) if self.variable.dims == (time,) else np.atleast_1d(depth)
        if self.instrument is not None:
            variable, factor = self.instrument
            depth = (values(variable) * factor).reshape(-1, 1) + depth
            depth = depth if self.vary_in(time) else depth[0]
        return depth


def find_levels(
    dataset: xr.Dataset, level: str | None, time: str | None, water_depth: float
) -> LevelDepths:
    """Return the levels of a velocity that spreads over `level` and `time`, either of them None.

    Those that move with time come before those that do not; `water_depth` [m] places heights
    above the seabed.

    Parameters
    ----------
    dataset : of the velocity
    level : its dimension of levels, None where it has none
    time : its dimension of times, None where it has none
    water_depth : where heights above the seabed begin [m]

    Raises
    ------
    UnreadableError
        There are none, or the file does not say which way they grow.
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
) -> LevelDepths:
    if _MODEL_COORDINATE.fullmatch(str(levels.attrs.get("standard_name", ""))):
        raise UnreadableError(
            f"`{levels.name}` is {levels.attrs['standard_name']}, a share of the water depth, "
            "whatever its unit; give the depths of the levels, such as ROMS' `z_rho`"
        )
    words = f"{levels.name} " + words_of(levels, "standard_name", "long_name", "reference_datum")
    words = re.sub(r"[\W_]+", " ", words.lower())
    if _COUNTED.search(words):
        said = levels.attrs.get("long_name", levels.name)
        raise UnreadableError(
            f"`{levels.name}` counts its levels (`{said}`) and does not say how deep they are"
        )
    if _ALONG_BEAM.search(f"{words} {words_of(levels, 'comment')}"):
        raise UnreadableError(
            f"`{levels.name}` is the distance along the beam, which is longer than the height: "
            "multiply it by the cosine of the beam's angle, 20° or 25° for most instruments"
        )
    if _ABOVE_SEABED.search(words):
        return _above_seabed(levels, factor, water_depth)
    positive = str(levels.attrs.get("positive", "")).lower()
    if _FROM_INSTRUMENT.search(words) or words_of(levels, "reference_datum") in (
        "sensor",
        "instrument",
        "transducer",
    ):
        way = positive or _way_it_looks(dataset, levels, words)
        return _from_instrument(dataset, levels, factor, way, time, water_depth)
    if not positive and levels.name in _HEIGHTS and _sign(levels, time) < 0:
        positive = "up"
    elif not positive and "depth" in words:
        positive = "down"
    if positive not in ("up", "down"):
        raise UnreadableError(f"`{levels.name}` does not say whether it is `positive` up or down")
    factor = factor if positive == "down" else -factor
    if _sign(levels, time) * factor < 0:
        raise UnreadableError(
            f"`{levels.name}` is positive {positive}, and no level of it is below the surface: "
            "its sign or its `positive` is wrong"
        )
    return LevelDepths(levels, factor, 0.0, None, ())


def _above_seabed(levels: xr.DataArray, factor: float, water_depth: float) -> LevelDepths:
    note = f"`{levels.name}` is the height above the seabed, at {water_depth:g} m"
    return LevelDepths(levels, -factor, water_depth, None, (note,))


def _sign(levels: xr.DataArray, time: str | None) -> int:
    """Return 1 or -1 where all values other than zero have that sign, else 0; of the first time."""

    first = levels.isel({time: slice(1)}) if time in levels.dims else levels
    values = known_values(first)
    if (values > 0).any() == (values < 0).any():
        return 0
    return 1 if (values > 0).any() else -1


def _from_instrument(
    dataset: xr.Dataset,
    levels: xr.DataArray,
    factor: float,
    way: str,
    time: str | None,
    water_depth: float,
) -> LevelDepths:
    """Return levels counted from an instrument that looks up or down.

    MHKiT adds the height of the instrument above the seabed to `range` where a person gives it, or
    the instrument's depth where it looks down, and then calls the depth of the water `depth`.
    """
    if way not in ("up", "down"):
        raise UnreadableError(
            f"`{levels.name}` is measured from the instrument, and the file does not say "
            "whether that "
            "looks up or down (`positive: up` of the variable, or `orientation: up` of the file)"
        )
    instrument, water = _depths(dataset, levels, time)
    offset = str(levels.name).startswith("range") and _offset_by_hand(dataset)
    if offset and way == "down":
        note = f"`{levels.name}` is measured from the surface, as its offset is added already"
        return LevelDepths(levels, factor, 0.0, None, (note,))
    if offset and instrument is None:
        if water is None:
            return _above_seabed(levels, factor, water_depth)
        note = f"`{levels.name}` is measured from the seabed, whose depth is `{water[0].name}`"
        return LevelDepths(levels, -factor, 0.0, water, (note,))
    if instrument is None:
        but = f"; `{water[0].name}` is that of the water" if water is not None else ""
        raise UnreadableError(
            f"`{levels.name}` is measured from the instrument, whose depth is not in the file{but}"
        )
    note = f"`{levels.name}` is measured from the instrument, whose depth is `{instrument[0].name}`"
    signed = factor if way == "down" else -factor
    return LevelDepths(levels, signed, 0.0, instrument, (note,))


def _offset_by_hand(dataset: xr.Dataset) -> bool:
    """Return whether MHKiT was given the instrument's place; Teledyne's offsets are of its head."""
    given = any(dataset.attrs.get(name) for name in ("range_offset", "h_deploy"))
    return given and "rdi" not in str(dataset.attrs.get("inst_make", "")).lower()


def _way_it_looks(dataset: xr.Dataset, levels: xr.DataArray, words: str) -> str:
    """Return whether an instrument looks ``"up"`` or ``"down"``; empty where nothing says so."""
    for word, way in (("above", "up"), ("below", "down")):
        if word in words.split():
            return way
    given = [one.attrs.get("orientation", "") for one in (levels, dataset)]
    looks = re.sub(r"[\W_]+", " ", " ".join(map(str, given)).lower())
    up, down = _UPWARDS.search(looks), _DOWNWARDS.search(looks)
    if bool(up) == bool(down):
        return ""
    return "up" if up else "down"


Depth = tuple[Any, float]
"""A variable with depths, and its factor to metres."""


def _depths(
    dataset: xr.Dataset, levels: xr.DataArray, time: str | None
) -> tuple[Depth | None, Depth | None]:
    """Return the depth of the instrument and that of the water, None where the file has none."""
    instrument: Depth | None = None
    water: Depth | None = None
    names = [*dataset.cf.standard_names.get(_STANDARD_DEPTH, []), *_NAMES, "depth_avg"]
    for name in first_present(dataset, names):
        depth = dataset[name]
        upwards = depth.attrs.get("positive") == "up"
        if name == levels.name or not set(depth.dims) <= {time} or upwards:
            continue
        of_the_water = _OF_THE_WATER.search(words_of(depth, "long_name", "comment"))
        if of_the_water and water is None:
            water = depth, factor_of(depth, "length")
        elif not of_the_water and instrument is None:
            instrument = depth, factor_of(depth, "length")
    return instrument, water
