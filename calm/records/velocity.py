"""Velocity variables of a dataset and their flags, found by CF standard name or usual name."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.physics.line import Floats
from calm.records import attributes
from calm.records.cf_files import UnreadableError, factor_of, first_present

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class _Sought:
    standard: tuple[str, ...]
    usual: tuple[str, ...]


_EAST = _Sought(
    ("eastward_sea_water_velocity",),
    ("uo", "UCUR", "EWCT", "water_u", "u", "U", "u_eastward", "u_1205", "U_320", "LCEWAP01",
     "LCEWZZ01", "vozocrtx", "ucur", "u_vel", "east_vel", "UCUR_MAG"),
)  # fmt: skip
_NORTH = _Sought(
    ("northward_sea_water_velocity",),
    ("vo", "VCUR", "NSCT", "water_v", "v", "V", "v_northward", "v_1206", "V_321", "LCNSAP01",
     "LCNSZZ01", "vomecrty", "vcur", "v_vel", "north_vel", "VCUR_MAG"),
)  # fmt: skip
_UP = _Sought(
    ("upward_sea_water_velocity",),
    ("wo", "WCUR", "water_w", "w", "W", "w_1204", "LRZAAP01", "LRZAZZ01", "WCUR_MAG"),
)
_SPEED = _Sought(("sea_water_speed",), ("HCSP", "speed", "CSPD", "CS_300", "LCSAAP01"))
_TOWARD = _Sought(
    ("sea_water_velocity_to_direction", "direction_of_sea_water_velocity"),
    ("HCDT", "toward", "CD_310", "LCDAAP01"),
)
_SENSES = {"to": "flows to", "from": "comes from"}
_FROM = _Sought(("sea_water_velocity_from_direction",), ())

_ALONG_THE_GRID = {"sea_water_x_velocity": _EAST, "sea_water_y_velocity": _NORTH}
_OF_NEMO = {"vozocrtx": "sea_water_x_velocity", "vomecrty": "sea_water_y_velocity"}
_AMBIGUOUS = (
    "direction", "DIR", "dir", "CDIR", "current_direction", "cdir", "CDIR_MAG", "HCDT_MAG",
)  # fmt: skip


MISSING = 9
_ENDINGS = ("_qc", "_QC", "_quality_control", "_flag", "_SEADATANET_QC", "_FLAG_W", "_quality",
            "_quality_flag", "_QF", "_qf", "_flags")  # fmt: skip
_OF_ALL = ("quality", "quality_flag", "qc", "QC", "flag", "flags", "qc_flag", "status_flag")
_OF_VELOCITY = re.compile(
    r"(?i)(?=.*(velocity|current)).*(?<![a-z])(qc|flags?|quality)(?![a-z])(?!.*(temp|sal|pres))"
)
_BAD = re.compile(r"bad|fail|suspect|spike|erroneous|wrong|missing|reject|doubtful|invalid")


@dataclass(frozen=True)
class Velocity:
    """Names of the variables of a current.

    Attributes
    ----------
    names : eastward and northward velocity, or speed and direction
    up : upward velocity; None if missing
    turn : angle to add to the direction variable to obtain the direction of flow [degrees]; None if
        `names` are components
    magnetic, true : whether the file states that directions refer to magnetic or to true north
    """

    names: tuple[str, str]
    up: str | None
    turn: float | None
    magnetic: bool
    true: bool
    notes: tuple[str, ...]

    def components(self, first: Floats, second: Floats) -> tuple[Floats, Floats]:
        """Return the eastward and northward components of the current.

        Parameters
        ----------
        first, second : values of the two variables in `names`; directions are in degrees
        """
        if self.turn is None:
            return first, second
        angle = np.radians(second + self.turn)
        return first * np.sin(angle), first * np.cos(angle)

    @property
    def all_names(self) -> tuple[str, ...]:
        """Names of the two or three variables."""
        return self.names if self.up is None else (*self.names, self.up)


def find_velocity(dataset: xr.Dataset, *, regular: bool) -> Velocity:
    """Find the velocity variables of a dataset.

    If `regular`, the grid has axes of latitude and longitude, so that x is east and y is north.
    Raise UnreadableError unless there is exactly one current, with eastward and northward
    components.
    """
    reason = attributes.other_frame(dataset.attrs) or attributes.moving_platform(dataset)
    if reason is not None:
        raise UnreadableError(f"its current {reason}")
    notes: list[str] = []
    east, north, up = (_find_variable(dataset, one, regular, notes) for one in (_EAST, _NORTH, _UP))
    if east is not None and north is not None:
        magnetic = [
            name for name in (east, north) if attributes.is_magnetic(dataset[name], dataset.attrs)
        ]
        if len(magnetic) == 1:
            other = north if magnetic == [east] else east
            raise UnreadableError(
                f"`{magnetic[0]}` is relative to magnetic north, but `{other}` is not"
            )
        units = {factor_of(dataset[name], "speed"): name for name in (east, north)}
        if len(units) > 1:
            units_text = " and ".join(f"`{dataset[name].attrs['units']}`" for name in (east, north))
            notes.append(f"the velocity components have different units, {units_text}")
        true = attributes.is_true(dataset[east], dataset.attrs)
        return Velocity((east, north), up, None, bool(magnetic), true, tuple(notes))
    speed = _find_variable(dataset, _SPEED, regular, notes)
    direction, sense = _direction(dataset, regular, notes)
    if speed is None or direction is None:
        raise UnreadableError(
            "holds no current: CALM searches for an eastward and a northward velocity, or for a "
            "speed and a direction, first by CF standard name, then by usual name"
        )
    if sense is None:
        raise UnreadableError(
            f"`{direction}` is ambiguous: the current may flow to this direction or come from it; "
            f"its `standard_name` should be {_TOWARD.standard[0]} or {_FROM.standard[0]}"
        )
    notes.append(f"`{direction}` is the direction the current {_SENSES[sense]}")
    turn = 0.0 if sense == "to" else 180.0
    magnetic_north = attributes.is_magnetic(dataset[direction], dataset.attrs)
    true = attributes.is_true(dataset[direction], dataset.attrs)
    return Velocity((speed, direction), up, turn, magnetic_north, true, tuple(notes))


def _direction(
    dataset: xr.Dataset, regular: bool, notes: list[str]
) -> tuple[str | None, str | None]:
    """Find the direction variable and its sense: "to", "from", or None if unstated."""
    for sought, sense in ((_TOWARD, "to"), (_FROM, "from")):
        name = _find_variable(dataset, sought, regular, notes)
        if name is not None:
            return name, sense
    unclear = next((name for name in _AMBIGUOUS if name in dataset.data_vars), None)
    if unclear is None:
        return None, None
    return _checked(dataset, unclear), attributes.sense_of_direction(dataset[unclear])


def _find_variable(
    dataset: xr.Dataset, sought: _Sought, regular: bool, notes: list[str]
) -> str | None:
    for standard_name in sought.standard:
        found = [str(name) for name in dataset.cf.standard_names.get(standard_name, [])]
        found = [one for one in found if not any(one.startswith(f"{two}_") for two in found)]
        true = [name for name in found if not attributes.is_magnetic(dataset[name])]
        if len(true or found) > 1:
            listed = ", ".join(true or found)
            raise UnreadableError(
                f"several variables have the standard name {standard_name}: {listed}"
            )
        if found:
            return _checked(dataset, (true or found)[0])
    name = next((name for name in sought.usual if name in dataset.data_vars), None)
    if name is None:
        return None
    own = str(dataset[name].attrs.get("standard_name", ""))
    if name in _OF_NEMO and not own:
        own = _OF_NEMO[name]
        places = first_present(dataset, ("nav_lat", "lat", "latitude"))
        regular = regular or not any(dataset[one].ndim == 2 for one in places)
    if regular and _ALONG_THE_GRID.get(own) is sought:
        sense = "east" if sought is _EAST else "north"
        notes.append(
            f"`{name}`, with the standard name {own}, is used as {sense}ward velocity, because "
            "the grid is regular in latitude and longitude"
        )
    elif own and own not in sought.standard and not _is_magnetic_variant(own, sought):
        raise UnreadableError(
            f"`{name}` has the standard name {own} instead of {sought.standard[0]}"
        )
    return _checked(dataset, name)


def _is_magnetic_variant(own: str, sought: _Sought) -> bool:
    plain = re.sub(r"_?magnetic_?(north)?", "", own)
    return plain != own and plain in sought.standard


def _checked(dataset: xr.Dataset, name: str) -> str:
    layers = layers_of(dataset)
    variable = dataset[name]
    reason = attributes.not_a_value(variable, layers) or attributes.other_frame(variable.attrs)
    if reason is not None:
        raise UnreadableError(f"`{name}` {reason}")
    return name


def layers_of(dataset: xr.Dataset) -> set[str]:
    """Return the names of layer coordinates, and the names of their dimensions.

    A layer coordinate has the attribute `bounds`. A mean over a layer counts as a value.
    """
    bounded = [name for name, one in dataset.variables.items() if "bounds" in one.attrs]
    return {str(each) for name in bounded for each in (name, *dataset[name].dims)}


_WHOSE = re.compile(r"(?:sensor|instrument|platform|station|mooring|serial)", re.IGNORECASE)
"""Names of text variables that identify the instrument of each reading."""


def refuse_ragged(dataset: xr.Dataset, name: str) -> None:
    """Raise UnreadableError if a variable holds the readings of several instruments in sequence.

    The message names the variable that gives the instrument of each reading.
    """
    for index, variable in dataset.variables.items():
        many, counted = 0, variable.attrs.get("instance_dimension")
        if counted and variable.dims[:1] == dataset[name].dims[:1]:
            many = dataset.sizes.get(counted, 2)
        whose = "cf_role" in variable.attrs or _WHOSE.search(str(index))
        if whose and variable.dims == dataset[name].dims and variable.dtype.kind in "OSU":
            many = len({*variable.to_numpy().reshape(-1).tolist()})
        if many > 1:
            raise UnreadableError(
                f"`{name}` contains the readings of {many} instruments in sequence (`{index}` "
                "gives the instrument of each reading); use one file for each instrument"
            )


_COMPONENTS = {"east": ("E", "EAST"), "north": ("N", "NORTH"), "up": ("U", "UP", "U1")}
_NAMES = ("vel", "velocity", "vel_avg")
_DIRECTIONS = "dir"


def with_components(dataset: xr.Dataset) -> xr.Dataset:
    """Return the dataset with a velocity `vel (dir, ...)` split into components.

    The components have names such as ``vel[E]``, and CF standard names. Any other dataset is
    unchanged. Raise UnreadableError if the components are along beams or instrument axes.
    """
    vectors = [name for name in _NAMES if name in dataset.data_vars]
    name = next((name for name in vectors if _DIRECTIONS in dataset[name].dims), None)
    if name is None:
        return dataset
    vector = dataset[name]
    if (reason := attributes.other_frame(dataset.attrs)) is not None:
        raise UnreadableError(f"`{name}` {reason}")
    _checked(dataset, name)
    labels = [str(label).strip().upper() for label in vector[_DIRECTIONS].values.tolist()]
    units, parts = vector.attrs.get("units", ""), {}
    for sense, wanted in _COMPONENTS.items():
        label = next((label for label in wanted if label in labels), None)
        if label is not None:
            part = vector.isel({_DIRECTIONS: labels.index(label)}, drop=True)
            part.attrs = {"units": units, "standard_name": f"{sense}ward_sea_water_velocity"}
            parts[f"{name}[{label}]"] = part
        elif sense != "up":
            raise UnreadableError(
                f"`{name}` has the directions {', '.join(labels)}, not E and N; rotate it to earth "
                "coordinates first"
            )
    return dataset.assign(parts)


def flag_variable(dataset: xr.Dataset, name: str) -> xr.DataArray | None:
    """Return the flag variable of a velocity, or None if there is none.

    Ancillary variables of the velocity take precedence, followed by flags named after the velocity,
    and by flags for all variables.
    """
    beside = str(dataset[name].attrs.get("ancillary_variables", "")).split()
    meanings = (other for other in dataset.data_vars if _OF_VELOCITY.search(str(other)))
    named = [*beside, *(f"{name}{ending}" for ending in _ENDINGS), *_OF_ALL, *map(str, meanings)]
    for other in named:
        if other not in dataset.variables or not _holds_flags(dataset[other]):
            continue
        if set(dataset[other].dims) <= set(dataset[name].dims):
            return dataset[other]
    return None


def _holds_flags(variable: xr.DataArray) -> bool:
    named = "status_flag" in str(variable.attrs.get("standard_name", ""))
    return named or "flag_values" in variable.attrs or variable.dtype.kind in "iu"


def flags_of(variable: xr.DataArray) -> NDArray[np.int8]:
    """Return flags as integers, with 9 for a missing flag.

    A flag stored as bits becomes 4 if one of its bits marks a bad value, and 1 otherwise.
    """
    if "flag_masks" in variable.attrs:
        return np.where(marked_bad(variable), 4, 1).astype(np.int8)
    values = np.asarray(variable.values)
    if values.dtype.kind in "SU":
        values = np.where(values.astype(str) == "", "9", values.astype(str)).astype(float)
    numbers = np.asarray(values, np.float64)
    return np.where(np.isfinite(numbers), numbers, MISSING).astype(np.int8)


def marked_bad(variable: xr.DataArray) -> NDArray[np.bool_]:
    """Return a mask of the values that are flagged as bad.

    The meanings of the flags decide; without meanings, the flags 3, 4 and 9 mark bad values.
    """
    bad, meanings = ["3", "4", "9"], str(variable.attrs.get("flag_meanings", "")).lower().split()
    masks = np.atleast_1d(variable.attrs.get("flag_masks", [])).tolist()
    values = np.atleast_1d(variable.attrs.get("flag_values", masks)).tolist()
    if meanings and len(meanings) == len(masks) == len(values) and variable.dtype.kind in "iu":
        bits = zip(masks, values, meanings, strict=True)
        bad_bits = [(mask, value) for mask, value, meaning in bits if _BAD.search(meaning)]
        given = np.asarray(variable.values)
        found = [(given & mask) == value for mask, value in bad_bits if mask]
        bits_bad: NDArray[np.bool_] = np.logical_or.reduce([np.zeros(given.shape, bool), *found])
        return bits_bad
    if meanings and len(meanings) == len(values):
        pairs = zip(values, meanings, strict=True)
        bad = [_flag_text(value) for value, meaning in pairs if _BAD.search(meaning)]
    flags = np.asarray(variable.values)
    kinds, which = np.unique(flags.astype(object).astype(str), return_inverse=True)
    marks: NDArray[np.bool_] = np.array([_flag_text(kind) in bad for kind in kinds])
    return marks[which].reshape(flags.shape)


def _flag_text(value: Any) -> str:
    text = value.decode() if isinstance(value, bytes) else str(value)
    text = text.removeprefix("b'").removesuffix("'").removesuffix(".0")
    # some files store the character codes of 0 to 9, A, B and Q
    return chr(int(text)) if re.fullmatch(r"4[89]|5[0-7]|6[56]|81", text) else text


_GOOD_STANDARD = "proportion_of_acceptable_signal_returns_from_acoustic_instrument_in_sea_water"
_GOOD_NAMES = re.compile(r"(?i)(perg|pg|pgd|percent_?good|prcnt_gd|pct_good)_?[14]?")


def good_variables(dataset: xr.Dataset, name: str) -> list[xr.DataArray]:
    """Return the variables whose sum is the share of good pings for a velocity.

    If a variable has four values for four beams, only the first and the fourth value are returned:
    the shares of three-beam and of four-beam solutions in earth coordinates.
    """
    dims = set(dataset[name].dims)
    there = [
        str(other) for other, variable in dataset.data_vars.items()
        if variable.attrs.get("standard_name") == _GOOD_STANDARD
        or _GOOD_NAMES.fullmatch(str(other))
    ]  # fmt: skip
    found = []
    for variable in (dataset[other] for other in there):
        beams = [dim for dim in variable.dims if dim not in dims]
        if len(beams) == 1 and variable.sizes[beams[0]] == 4:
            found += [variable.isel({beams[0]: beam}, drop=True) for beam in (0, 3)]
        elif not beams:
            found.append(variable)
    return found
