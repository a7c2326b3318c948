"""Which variables of a dataset are a current: by CF standard name, then by usual name."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from calm.units import QuantityError, unit_factor

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class _Sought:
    """A quantity: its standard names, its usual names, and the sense of a standard name."""

    standard: tuple[str, ...]
    usual: tuple[str, ...]
    sense: str


_EAST = _Sought(
    ("eastward_sea_water_velocity",),
    ("uo", "UCUR", "EWCT", "water_u", "u", "U", "u_eastward", "u_1205"),
    "east",
)
_NORTH = _Sought(
    ("northward_sea_water_velocity",),
    ("vo", "VCUR", "NSCT", "water_v", "v", "V", "v_northward", "v_1206"),
    "north",
)
_UP = _Sought(
    ("upward_sea_water_velocity",), ("wo", "WCUR", "water_w", "w", "W", "w_1204"), "upward"
)
_SPEED = _Sought(("sea_water_speed",), ("HCSP", "speed"), "speed")
_TOWARD = _Sought(
    ("sea_water_velocity_to_direction", "direction_of_sea_water_velocity"),
    ("HCDT", "toward"),
    "direction",
)
_FROM = _Sought(("sea_water_velocity_from_direction",), (), "direction")

_ALONG_THE_GRID = {"east": "sea_water_x_velocity", "north": "sea_water_y_velocity"}
_AMBIGUOUS = ("direction", "DIR", "dir", "CDIR", "current_direction", "cdir")
_MOST_LISTED = 24


class UnreadableError(Exception):
    """The file does not hold a current that can be understood; the text says why."""


@dataclass(frozen=True)
class Velocity:
    """Names of the variables that make a current.

    Attributes
    ----------
    names : eastward and northward velocity, or speed and direction
    up : upward velocity, None where there is none
    turn : what is added to a direction to have it flow toward [degrees]; None for components
    notes : what had to be taken for granted
    """

    names: tuple[str, str]
    up: str | None
    turn: float | None
    notes: tuple[str, ...]

    @property
    def all_names(self) -> tuple[str, ...]:
        """Of two variables or three."""
        return self.names if self.up is None else (*self.names, self.up)


def find_velocity(dataset: xr.Dataset, *, regular: bool) -> Velocity:
    """The current of a dataset; `regular` where its grid runs along latitudes and longitudes.

    Raises
    ------
    UnreadableError
        There is none, there are several, or what is there is no current to the east and north.
    """
    notes: list[str] = []
    east, north, up = (_find(dataset, one, regular, notes) for one in (_EAST, _NORTH, _UP))
    if east is not None and north is not None:
        return Velocity((east, north), up, None, tuple(notes))
    speed, toward, origin = (
        _find(dataset, one, regular, notes) for one in (_SPEED, _TOWARD, _FROM)
    )
    direction = toward or origin
    if speed is not None and direction is not None:
        turn = 0.0 if toward is not None else 180.0
        way = "the current flows to" if toward is not None else "the current comes from"
        notes.append(f"`{direction}` is the direction {way}")
        return Velocity((speed, direction), up, turn, tuple(notes))
    unclear = [name for name in _AMBIGUOUS if name in dataset.data_vars]
    if speed is not None and unclear:
        raise UnreadableError(
            f"`{unclear[0]}` does not say whether it is where the current flows to or where it "
            f"comes from; its `standard_name` should be {_TOWARD.standard[0]} or "
            f"{_FROM.standard[0]}"
        )
    raise UnreadableError(
        "holds no current: eastward and northward velocity, or speed and direction to or from, "
        "are looked for by CF standard name, then by usual name"
    )


def holdings(dataset: xr.Dataset) -> str:
    """The variables of a dataset with their dimensions, units and standard names, as text."""
    listed = []
    for name, variable in dataset.variables.items():
        sizes = ", ".join(f"{dim} {size}" for dim, size in variable.sizes.items())
        words = [f"{name} ({sizes})" if sizes else str(name)]
        if "units" in variable.attrs:
            words.append(f"[{variable.attrs['units']}]")
        if "standard_name" in variable.attrs:
            words.append(str(variable.attrs["standard_name"]))
        listed.append(" ".join(words)[:120])
    hidden = len(listed) - _MOST_LISTED
    more = [f"and {hidden} more"] if hidden > 0 else []
    return "; ".join([*listed[:_MOST_LISTED], *more]) or "nothing"


def factor_of(variable: xr.DataArray, dimension: str) -> float:
    """What turns a variable into SI (angles: degrees).

    Raises
    ------
    UnreadableError
        It has no unit, or that of something else.
    """
    unit = str(variable.attrs.get("units", ""))
    plain = re.sub(r"(?i)[ _](true|t)$|\s*\(?clockwise from (true )?north\)?$", "", unit.strip())
    if not plain:
        raise UnreadableError(f"`{variable.name}` has no `units`")
    if plain.istitle() and len(plain) > 1:  # `Meter`
        plain = plain.lower()
    try:
        return unit_factor(plain, dimension)
    except QuantityError as error:
        message = f"`{variable.name}`: its unit, `{unit}`, {error.complaint}"
        raise UnreadableError(message) from None


def first_present(dataset: xr.Dataset, names: Iterable[str]) -> list[str]:
    """Those of the names that the dataset has, each once."""
    return [name for name in dict.fromkeys(names) if name in dataset.variables]


def _find(dataset: xr.Dataset, sought: _Sought, regular: bool, notes: list[str]) -> str | None:
    """The variable of a standard name, else of a usual name."""
    for standard_name in sought.standard:
        found = dataset.cf.standard_names.get(standard_name, [])
        if len(found) > 1:
            raise UnreadableError(f"several variables are {standard_name}: {', '.join(found)}")
        if found:
            return str(found[0])
    name = next((name for name in sought.usual if name in dataset.data_vars), None)
    if name is None:
        return None
    own = str(dataset[name].attrs.get("standard_name", ""))
    told = str(dataset[name].attrs.get("long_name", ""))
    if not own and re.search(r"(?i)\bwind\b", told):
        raise UnreadableError(f"`{name}` is `{told}`, which is no current")
    if regular and own and own == _ALONG_THE_GRID.get(sought.sense):
        notes.append(f"`{name}`, {own}, is {sought.sense}ward: the grid runs along latitudes")
    elif own and not (sought.sense in own and ("water" in own or "current" in own)):
        raise UnreadableError(f"`{name}` is {own}, which is not {sought.standard[0]}")
    return name
