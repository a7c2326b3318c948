"""Which variables of a dataset are a current: by CF standard name, then by usual name."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from calm.records.attributes import (
    another_way,
    is_magnetic,
    not_a_current,
    other_frame,
    part_in_texts,
    way_of,
)
from calm.records.cf_files import UnreadableError, first_present

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class _Sought:
    """A quantity: its standard names, and the names that programs and archives use for it."""

    standard: tuple[str, ...]
    usual: tuple[str, ...]
    way: str = ""


_EAST = _Sought(
    ("eastward_sea_water_velocity",),
    ("uo", "UCUR", "EWCT", "water_u", "u", "U", "u_eastward", "u_1205", "U_320", "LCEWAP01",
     "LCEWZZ01", "vozocrtx", "ucur", "u_vel", "east_vel", "UCUR_MAG"),
    "east",
)  # fmt: skip
_NORTH = _Sought(
    ("northward_sea_water_velocity",),
    ("vo", "VCUR", "NSCT", "water_v", "v", "V", "v_northward", "v_1206", "V_321", "LCNSAP01",
     "LCNSZZ01", "vomecrty", "vcur", "v_vel", "north_vel", "VCUR_MAG"),
    "north",
)  # fmt: skip
_UP = _Sought(
    ("upward_sea_water_velocity",),
    ("wo", "WCUR", "water_w", "w", "W", "w_1204", "LRZAAP01", "LRZAZZ01", "WCUR_MAG"),
    "up",
)
_SPEED = _Sought(("sea_water_speed",), ("HCSP", "speed", "CSPD", "CS_300", "LCSAAP01"))
_TOWARD = _Sought(
    ("sea_water_velocity_to_direction", "direction_of_sea_water_velocity"),
    ("HCDT", "toward", "CD_310", "LCDAAP01"),
)
_FROM = _Sought(("sea_water_velocity_from_direction",), ())

_ALONG_THE_GRID = {"sea_water_x_velocity": _EAST, "sea_water_y_velocity": _NORTH}
_OF_NEMO = {"vozocrtx": "sea_water_x_velocity", "vomecrty": "sea_water_y_velocity"}
_AMBIGUOUS = (
    "direction", "DIR", "dir", "CDIR", "current_direction", "cdir", "CDIR_MAG", "HCDT_MAG",
)  # fmt: skip


@dataclass(frozen=True)
class Velocity:
    """Names of the variables that make a current.

    Attributes
    ----------
    names : eastward and northward velocity, or speed and direction
    up : upward velocity, None where there is none
    turn : what is added to a direction to have it flow toward [degrees]; None for components
    magnetic : whether it is relative to magnetic north
    notes : what had to be assumed
    """

    names: tuple[str, str]
    up: str | None
    turn: float | None
    magnetic: bool
    notes: tuple[str, ...]

    @property
    def all_names(self) -> tuple[str, ...]:
        """Name the two variables or three."""
        return self.names if self.up is None else (*self.names, self.up)


def find_velocity(dataset: xr.Dataset, *, regular: bool) -> Velocity:
    """Return the current of a dataset; `regular` where its grid runs along latitudes and
    longitudes.

    Raises
    ------
    UnreadableError
        There is none, there are several, or what is there is not a current to the east and north.
    """
    if (reason := other_frame(dataset.attrs) or part_in_texts(dataset.attrs)) is not None:
        raise UnreadableError(f"its current {reason}")
    notes: list[str] = []
    east, north, up = (_find(dataset, one, regular, notes) for one in (_EAST, _NORTH, _UP))
    if east is not None and north is not None:
        magnetic = [name for name in (east, north) if is_magnetic(dataset[name], dataset.attrs)]
        if len(magnetic) == 1:
            other = north if magnetic == [east] else east
            raise UnreadableError(f"`{magnetic[0]}` is to magnetic north, `{other}` is not")
        return Velocity((east, north), up, None, bool(magnetic), tuple(notes))
    speed = _find(dataset, _SPEED, regular, notes)
    direction, way = _direction(dataset, regular, notes)
    if speed is not None and direction is not None and way is not None:
        flows = "the current flows to" if way == "to" else "the current comes from"
        notes.append(f"`{direction}` is the direction {flows}")
        turn = 0.0 if way == "to" else 180.0
        magnetic_north = is_magnetic(dataset[direction], dataset.attrs)
        return Velocity((speed, direction), up, turn, magnetic_north, tuple(notes))
    if speed is not None and direction is not None:
        raise UnreadableError(
            f"`{direction}` does not say whether it is where the current flows to or where it "
            f"comes from; its `standard_name` should be {_TOWARD.standard[0]} or "
            f"{_FROM.standard[0]}"
        )
    raise UnreadableError(
        "holds no current: eastward and northward velocity, or speed and direction to or from, "
        "are looked for by CF standard name, then by usual name"
    )


def _direction(
    dataset: xr.Dataset, regular: bool, notes: list[str]
) -> tuple[str | None, str | None]:
    """Return the variable of a direction, and which way it is: None where the file does not say."""
    for sought, way in ((_TOWARD, "to"), (_FROM, "from")):
        name = _find(dataset, sought, regular, notes)
        if name is not None:
            stated = way_of(dataset[name], "long_name", "comment")
            if stated not in (way, None):
                said = dataset[name].attrs.get("long_name") or dataset[name].attrs.get("comment")
                raise UnreadableError(
                    f"`{name}` contradicts itself: by its name it is the direction the current "
                    f"{'flows to' if way == 'to' else 'comes from'}, and it says `{said}`"
                )
            return name, way
    unclear = next((name for name in _AMBIGUOUS if name in dataset.data_vars), None)
    if unclear is None:
        return None, None
    return _believed(dataset, unclear, _TOWARD), way_of(dataset[unclear])


def _find(dataset: xr.Dataset, sought: _Sought, regular: bool, notes: list[str]) -> str | None:
    """Return the variable of a standard name, else of a usual name; one to true north before
    another.

    Raises
    ------
    UnreadableError
        Several have the standard name, or what the variable says of itself is something else.
    """
    for standard_name in sought.standard:
        found = [str(name) for name in dataset.cf.standard_names.get(standard_name, [])]
        true = [name for name in found if not is_magnetic(dataset[name])]
        if len(true or found) > 1:
            listed = ", ".join(true or found)
            raise UnreadableError(f"several variables are {standard_name}: {listed}")
        if found:
            return _believed(dataset, (true or found)[0], sought)
    name = next((name for name in sought.usual if name in dataset.data_vars), None)
    if name is None:
        return None
    own = str(dataset[name].attrs.get("standard_name", ""))
    if name in _OF_NEMO and not own:
        own = _OF_NEMO[name]
        places = first_present(dataset, ("nav_lat", "lat", "latitude"))
        regular = regular or not any(dataset[one].ndim == 2 for one in places)
    if regular and _ALONG_THE_GRID.get(own) is sought:
        way = "east" if sought is _EAST else "north"
        notes.append(f"`{name}`, {own}, is {way}ward: the grid runs along latitudes")
    elif own and own not in sought.standard and not _only_marked(own, sought):
        raise UnreadableError(f"`{name}` is {own}, which is not {sought.standard[0]}")
    return _believed(dataset, name, sought)


def _only_marked(own: str, sought: _Sought) -> bool:
    """Return whether a standard name is one of those sought but for a word on its north."""
    plain = re.sub(r"_?magnetic_?(north)?", "", own)
    return plain != own and plain in sought.standard


def _believed(dataset: xr.Dataset, name: str, sought: _Sought) -> str:
    """Return the name of a variable whose own words do not speak against it."""
    reason = not_a_current(dataset[name])
    if reason is None and sought.way:
        reason = another_way(dataset[name], sought.way)
    if reason is not None:
        raise UnreadableError(f"`{name}` {reason}")
    return name


def refuse_ragged(dataset: xr.Dataset, name: str) -> None:
    """Refuse what has the readings of several instruments one after the other.

    Raises
    ------
    UnreadableError
        With the index that says which reading is whose.
    """
    for index, variable in dataset.variables.items():
        counted = variable.attrs.get("instance_dimension")
        if counted and variable.dims[:1] == dataset[name].dims[:1]:
            many = dataset.sizes.get(counted, 2)
            if many > 1:
                raise UnreadableError(
                    f"`{name}` has {many} instruments one after the other (`{index}` says whose a "
                    "reading is): give the file of each instrument"
                )


_WAYS = {"east": ("E", "EAST"), "north": ("N", "NORTH"), "up": ("U", "UP", "U1")}
_NAMES = ("vel", "velocity", "vel_avg")
_DIRECTIONS = "dir"


def with_components(dataset: xr.Dataset) -> xr.Dataset:
    """Return the dataset with the velocity `vel (dir, ...)` taken apart into its components.

    The components are called ``vel[E]`` and so on, with the standard names of velocities to the
    east, north and up. A dataset without such a variable is returned as it is.

    Raises
    ------
    UnreadableError
        Its directions are those of the beams or of the instrument.
    """
    name = next(
        (
            name
            for name in _NAMES
            if name in dataset.data_vars and _DIRECTIONS in dataset[name].dims
        ),
        None,
    )
    if name is None:
        return dataset
    vector = dataset[name]
    for attributes in (dataset.attrs, vector.attrs):
        if (reason := other_frame(attributes)) is not None:
            raise UnreadableError(f"`{name}` {reason}")
    if (reason := not_a_current(vector)) is not None:
        raise UnreadableError(f"`{name}` {reason}")
    labels = [str(label).strip().upper() for label in vector[_DIRECTIONS].values.tolist()]
    places = {
        way: next((labels.index(label) for label in wanted if label in labels), None)
        for way, wanted in _WAYS.items()
    }
    if places["east"] is None or places["north"] is None:
        raise UnreadableError(
            f"`{name}` has the directions {', '.join(labels)}, not E and N: rotate it to the "
            "earth's coordinates first"
        )
    parts = {}
    for way, place in places.items():
        if place is not None:
            part = vector.isel({_DIRECTIONS: place}, drop=True)
            units = vector.attrs.get("units", "")
            part.attrs = {"units": units, "standard_name": f"{way}ward_sea_water_velocity"}
            parts[f"{name}[{labels[place]}]"] = part
    return dataset.assign(parts)
