"""Velocities kept as one variable with a dimension of directions, as ADCP toolboxes write them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from calm.files.current_variables import UnreadableError
from calm.files.current_words import not_a_current, other_frame

if TYPE_CHECKING:
    import xarray as xr

_WAYS = {"east": ("E", "EAST"), "north": ("N", "NORTH"), "up": ("U", "UP", "U1")}
_NAMES = ("vel", "velocity", "vel_avg")
_DIRECTIONS = "dir"


def with_components(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset with the velocity `vel (dir, ...)` taken apart into its components.

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
