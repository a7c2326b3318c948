"""Attributes with a defined meaning: CF standard names, cell methods, coordinate frames and north.

Of the free text, only long names and comments about directions are interpreted.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

_FRAMES = re.compile(
    r"(?i)(velocity_?)?(coord(inate)?s?_?(sys(tem)?|frame|transform(ation)?)|(reference_?)?frame|"
    r"transform(ation)?)"
)
_TO_THE_EARTH = re.compile(r"earth|\benu\b|geographic|east|true")
_OTHER_FRAME = re.compile(r"beam|\binst|xyz|ship|head|vessel|body|vehicle|principal|stream|local")

_METHOD = re.compile(r"((?:\w+: )+)(\w+)((?: (?:within|over) (?:days|years))?)")
_SPREADS = ("maximum", "minimum", "range", "standard_deviation", "variance", "sum", "mid_range")
_VERTICAL = ("depth", "height", "altitude", "z", "lev", "level")

_MAGNETIC = re.compile(r"\bmag(netic)?\b")
_TRUE = re.compile(r"correct|appl(y|ied)|declination|\btrue\b")
_UNTURNED = re.compile(
    r"(?i)(magnetic_?)?(declination|variation|deviation)_?(is_?)?(applied|corrected)"
)
_DATUM = re.compile(r"(?i)(\w+_)?(north|datum|reference|coord\w*_?sys\w*)(_\w+)?")
_NORTH_IN = ("long_name", "standard_name", "units")
_NO = ("0", "0.0", "no", "false", "n", "none", "not applied")
_TOWARD = re.compile(r"\bto direction\b|\btowards?\b|\bflow(s|ing)? to\b|\bgoing to\b|\bset\b")
_FROM = re.compile(r"\bfrom direction\b|\bdirection from\b|\bcom(es|ing) from\b|\bfrom which\b")

_OF_SHIPS = ("vmdas", "winriver", "winriver2", "winriver ii", "uhdas", "uhdas+codas", "codas")
"""Programs that write files of ship-mounted ADCPs (`source_program`)."""
_PLATFORM = (
    "platform_speed_wrt_ground", "eastward_platform_velocity", "northward_platform_velocity",
)  # fmt: skip
_BOTTOM_TRACK = re.compile(r"(?i)vel_bt|bt_vel\w*|bottom_?track_?vel\w*|[uv]_?bt|uship|vship")
_MOVING = 0.1  # m/s over the ground: median speeds above this exclude a mooring


def words_in(text: str) -> str:
    """Return a text in lower case, with a single blank between its words and no punctuation."""
    return re.sub(r"[\W_]+", " ", text.lower()).strip()


def words_of(variable: xr.DataArray, *attributes: str) -> str:
    """Join the values of the named attributes of a variable, and simplify them with `words_in`."""
    return words_in(" ".join(str(variable.attrs.get(name, "")) for name in attributes))


def not_a_value(variable: xr.DataArray, layers: Collection[str] = ()) -> str | None:
    """Return the reason why values of a variable do not belong to one time and depth, or None.

    Reasons are cell methods (a spread, a climatology, a mean over depth) and a scale factor of
    zero. Means over the dimensions in `layers` are accepted.
    """
    methods = str(variable.attrs.get("cell_methods", ""))
    for dims, method, over in _METHOD.findall(methods):
        vertical = {dim.lower() for dim in dims.replace(":", "").split() if dim not in layers}
        averaged = method in ("mean", "median", "sum") and vertical & {*_VERTICAL}
        if method in _SPREADS or averaged or "over" in over:
            return f"has `cell_methods: {methods}`, so it is not a value at one time and depth"
    if variable.encoding.get("scale_factor") == 0:
        return "has `scale_factor: 0`, which makes every value the same"
    return None


def other_frame(attributes: Mapping[Any, Any]) -> str | None:
    """Return a message if velocities are not eastward and northward components, else None.

    Parameters
    ----------
    attributes : attributes of a dataset or a variable
    """
    for name in filter(_FRAMES.fullmatch, map(str, attributes)):
        frame = str(attributes[name]).lower()
        if _OTHER_FRAME.search(frame) and not _TO_THE_EARTH.search(frame):
            reason = f"has no east and north components (`{name}: {attributes[name]}`)"
            return f"{reason}; rotate it to earth coordinates first"
    return None


def moving_platform(dataset: xr.Dataset) -> str | None:
    """Return a message if a dataset comes from a moving ship, else None.

    Evidence is the attribute `source_program`, or a median speed over the ground that is too high
    for a mooring.
    """
    program = str(dataset.attrs.get("source_program", "")).strip()
    if program.lower() in _OF_SHIPS:
        return f"is from an ADCP on a ship (`source_program: {program}`), not from a mooring"
    for name, variable in dataset.variables.items():
        standard = str(variable.attrs.get("standard_name", ""))
        moves = standard in _PLATFORM or _BOTTOM_TRACK.fullmatch(str(name))
        if moves and variable.dtype.kind in "fiu":
            speed = np.abs(np.asarray(variable[:100_000], np.float64))
            typical = float(np.median(speed[np.isfinite(speed)])) if np.isfinite(speed).any() else 0
            if typical > _MOVING:
                return (
                    f"is from a platform that moves over the ground (`{name}`: {typical:.2g} m/s)"
                )
    return None


def is_magnetic(variable: xr.DataArray, dataset: Mapping[Any, Any] = MappingProxyType({})) -> bool:
    """Return whether a velocity or direction is relative to magnetic north.

    Evidence is in the name and the texts of the variable, or in an attribute such as
    `magnetic_declination_applied: no`.
    """
    own = f"{variable.name} {words_of(variable, *_NORTH_IN)}"
    return _is_magnetic_text(own) or "magnetic" in _stated_norths(variable, dataset)


def is_true(variable: xr.DataArray, dataset: Mapping[Any, Any] = MappingProxyType({})) -> bool:
    """Return whether attributes state that directions are relative to true north."""
    return "true" in _stated_norths(variable, dataset)


def _stated_norths(variable: xr.DataArray, dataset: Mapping[Any, Any]) -> Iterator[str]:
    for name, value in (*variable.attrs.items(), *dataset.items()):
        text = str(value)
        if _UNTURNED.fullmatch(str(name)):
            yield "magnetic" if text.strip().lower() in _NO else "true"
        elif _DATUM.fullmatch(str(name)) and _is_magnetic_text(text):
            yield "magnetic"
        elif _DATUM.fullmatch(str(name)) and re.search(r"(?i)\btrue\b", text):
            yield "true"


def _is_magnetic_text(text: str) -> bool:
    words = words_in(text)
    return bool(_MAGNETIC.search(words)) and not _TRUE.search(words)


def sense_of_direction(variable: xr.DataArray) -> str | None:
    """Return the convention of a direction variable.

    The convention is ``"to"`` for the direction in which a current flows, and ``"from"`` for the
    direction from which it comes. Return None if long name, standard name and comment are silent or
    contradictory.
    """
    own = words_of(variable, "long_name", "standard_name", "comment")
    toward, origin = _TOWARD.search(own), _FROM.search(own)
    if bool(toward) == bool(origin):
        return None
    return "to" if toward else "from"
