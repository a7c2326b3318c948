"""Depths of current levels.

A file may give depths, heights above the seabed, or distances from an instrument.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.records.attributes import words_in, words_of
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
_UPWARDS = re.compile(r"\b(z ?)?up(wards?)?\b")
_DOWNWARDS = re.compile(r"\b(z ?)?down(wards?)?\b")
_MODEL_COORDINATE = re.compile(r"ocean_\w*(sigma|s)_\w*coordinate\w*|ocean_sigma\w*")
_HEIGHTS = ("z", "z_rho")
_STANDARD_DEPTH = "depth"


@dataclass(frozen=True)
class LevelDepths:
    """Levels of a current at depths ``start + factor * variable``, positive down [m].

    If `instrument` is set, the depth of the instrument is added.

    Attributes
    ----------
    variable : level variable; its dimensions are dimensions of the velocity
    factor : signed factor to metres; negative if values increase upwards
    start : depth at which the values are zero [m]
    instrument : depth variable of an instrument, and the factor to metres; None for levels that are
        not relative to an instrument
    """

    variable: xr.DataArray
    factor: float
    start: float
    instrument: tuple[xr.DataArray, float] | None
    notes: tuple[str, ...]

    def vary_in(self, time: str | None) -> bool:
        """Return whether the depths of the levels change with time."""
        moving = [self.variable, *([self.instrument[0]] if self.instrument else [])]
        return any(time in one.dims for one in moving)

    def depths(self, time: str | None, index: Any) -> NDArray[Any]:
        """Return the depths (n, k) of the levels at the given time indices [m].

        If the levels never move, the shape is (k,).
        """

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
    """Find the depths of the levels of a velocity; moving levels take precedence over fixed ones.

    `level` and `time` are dimensions of the velocity, or None. `water_depth` [m] converts heights
    above the seabed. Raise UnreadableError if there are no levels, or if it is unclear whether
    values increase upwards or downwards.
    """
    standard, wanted = dataset.cf.standard_names, {level} - {None}
    names = [
        *dataset.cf.axes.get("Z", []),
        *dataset.cf.coordinates.get("vertical", []),
        *standard.get(_STANDARD_DEPTH, []),
        *standard.get("height_above_sea_floor", []),
        *_NAMES,
    ]
    fitting = [
        dataset[name]
        for name in first_present(dataset, names)
        if wanted <= set(dataset[name].dims) <= {level, time}
    ]
    unusable = []
    for variable in sorted(fitting, key=lambda one: time not in one.dims):
        try:
            factor = factor_of(variable, "length")
        except UnreadableError as error:
            unusable.append(error)
        else:
            return _Levels(dataset, variable, factor, time, water_depth).placed()
    raise (unusable or [UnreadableError("the levels have no depth")])[0]


@dataclass(frozen=True)
class _Levels:
    dataset: xr.Dataset
    variable: xr.DataArray
    factor: float
    time: str | None
    water_depth: float

    def placed(self) -> LevelDepths:
        levels, name = self.variable, self.variable.name
        if _MODEL_COORDINATE.fullmatch(str(levels.attrs.get("standard_name", ""))):
            raise UnreadableError(
                f"`{name}` is {levels.attrs['standard_name']}, a fraction of the water depth and "
                "not a depth; use the depths of the levels, such as ROMS' `z_rho`"
            )
        texts = words_of(levels, "standard_name", "long_name", "reference_datum")
        words = words_in(f"{name} {texts}")
        if _ABOVE_SEABED.search(words):
            return self._above_seabed()
        positive = str(levels.attrs.get("positive", "")).lower()
        datum = words_of(levels, "reference_datum")
        if _FROM_INSTRUMENT.search(words) or datum in ("sensor", "instrument", "transducer"):
            return self._from_instrument(positive or self._stated_orientation(words))
        if not positive and name in _HEIGHTS and self._sign < 0:
            positive = "up"
        elif not positive and "depth" in words:
            positive = "down"
        if positive not in ("up", "down"):
            raise UnreadableError(f"`{name}` does not say whether it is `positive` up or down")
        factor = self.factor if positive == "down" else -self.factor
        if self._sign * factor < 0:
            raise UnreadableError(
                f"`{name}` is positive {positive}, but all levels are above the surface: its "
                "sign or its `positive` is wrong"
            )
        return LevelDepths(levels, factor, 0.0, None, ())

    def _above_seabed(self) -> LevelDepths:
        note = (
            f"`{self.variable.name}` is the height above the seabed, which is at "
            f"{self.water_depth:g} m"
        )
        return LevelDepths(self.variable, -self.factor, self.water_depth, None, (note,))

    @property
    def _sign(self) -> int:
        """Common sign of all nonzero values at the first time, or 0 if the signs differ."""
        moving = self.time in self.variable.dims
        first = self.variable.isel({self.time: slice(1)}) if moving else self.variable
        values = known_values(first)
        return int((values > 0).any()) - int((values < 0).any())

    def _from_instrument(self, orientation: str) -> LevelDepths:
        name, factor = self.variable.name, self.factor if orientation == "down" else -self.factor
        if orientation not in ("up", "down"):
            raise UnreadableError(
                f"`{name}` is measured from the instrument, but the file does not say whether the "
                "instrument looks up or down; set the attribute `positive: up` of the variable, or "
                "`orientation: up` of the file (or `down`)"
            )
        instrument, water = self._instrument_and_water_depths()
        # MHKiT adds the height of the instrument above the seabed to `range` if the user supplies
        # this height. For an instrument that looks down, MHKiT adds the depth of the instrument
        # instead, and stores the water depth as `depth`. For Teledyne instruments, the offset is
        # the offset of the head.
        attributes = self.dataset.attrs
        by_hand = any(attributes.get(each) for each in ("range_offset", "h_deploy"))
        offset = by_hand and "rdi" not in str(attributes.get("inst_make", "")).lower()
        offset = offset and str(name).startswith("range")
        if offset and orientation == "down":
            note = f"`{name}` is measured from the surface, as it includes the instrument's depth"
            return LevelDepths(self.variable, factor, 0.0, None, (note,))
        zero, what = instrument, "the instrument"
        if offset and instrument is None:
            if water is None:
                return self._above_seabed()
            zero, what = water, "the seabed"
        if zero is None:
            but = f"; `{water[0].name}` is the water depth" if water is not None else ""
            raise UnreadableError(
                f"`{name}` is measured from the instrument, whose depth is not in the file{but}"
            )
        note = f"`{name}` is measured from {what}, whose depth is `{zero[0].name}`"
        return LevelDepths(self.variable, factor, 0.0, zero, (note,))

    def _stated_orientation(self, words: str) -> str:
        for word, orientation in (("above", "up"), ("below", "down")):
            if word in words.split():
                return orientation
        given = [one.attrs.get("orientation", "") for one in (self.variable, self.dataset)]
        looks = words_in(" ".join(map(str, given)))
        up, down = _UPWARDS.search(looks), _DOWNWARDS.search(looks)
        if bool(up) == bool(down):
            return ""
        return "up" if up else "down"

    def _instrument_and_water_depths(self) -> tuple[_Depth | None, _Depth | None]:
        found: dict[bool, _Depth] = {}
        standard = self.dataset.cf.standard_names.get(_STANDARD_DEPTH, [])
        for name in first_present(self.dataset, [*standard, *_NAMES, "depth_avg"]):
            depth = self.dataset[name]
            upwards = depth.attrs.get("positive") == "up"
            if name == self.variable.name or not set(depth.dims) <= {self.time} or upwards:
                continue
            of_the_water = bool(_OF_THE_WATER.search(words_of(depth, "long_name", "comment")))
            if of_the_water not in found:
                found[of_the_water] = depth, factor_of(depth, "length")
        return found.get(False), found.get(True)


_Depth = tuple[Any, float]
"""A variable with depths, and its factor to metres."""
