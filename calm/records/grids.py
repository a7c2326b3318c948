"""Gridded data at a position: the nearest water column with a current, and the seabed depth.

Seabed depths may come from GEBCO, EMODnet or a survey.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.errors import refused
from calm.physics.line import Floats
from calm.positions import SEMI_MAJOR, Frame
from calm.records import cf_files
from calm.records.current_terms import Place

if TYPE_CHECKING:
    import xarray as xr

REACH = 8
"""Number of columns searched for water on each side of the nearest column."""

FAR = 5.0
"""Distance [km] above which CALM reports that the position of a record drifts during the record, or
is far from the mooring.
"""

_EARTH = 6371.0
_PLACES = {
    "latitude": ("lat", "latitude", "LATITUDE", "nav_lat", "Latitude", "LAT"),
    "longitude": ("lon", "longitude", "LONGITUDE", "nav_lon", "Longitude", "LON"),
}


@dataclass(frozen=True)
class GridColumn:
    """A water column in a gridded dataset.

    `index` is the index along each horizontal dimension. `place` is None if the file does not give
    the position. `notes` explain the choice of the column.
    """

    index: dict[str, int]
    place: Place | None
    notes: tuple[str, ...] = ()


def is_regular(dataset: xr.Dataset) -> bool:
    """Return whether latitude and longitude are grid axes, so that x is east and y is north."""
    latitudes, longitudes = (
        {dataset[name].dims for name in _named(dataset, coordinate)} for coordinate in _PLACES
    )
    alone = all(len(dims) == 1 for dims in latitudes | longitudes)
    return bool(latitudes and longitudes) and alone and latitudes != longitudes


def choose_column(
    dataset: xr.Dataset, velocity: tuple[str, str], time: str | None, wanted: Place | None
) -> GridColumn:
    """Select the nearest grid column with a current, or the only column.

    `velocity` has the names of the two velocity variables, and `time` is the name of the time
    dimension. `wanted` is the position (latitude, longitude), required if the dataset has several
    columns.

    Raise UnreadableError if the position is missing or outside the grid, if no column near the
    position has a current, or if the grid is staggered.
    """
    import xarray as xr

    dims = dataset[velocity[0]].dims
    pair = _position_variables(dataset, set(dims) - {time})
    if pair is None:
        return GridColumn({}, None, _drift_notices(dataset, time, wanted))
    latitude, longitude = pair
    horizontal = [str(dim) for dim in dims if dim in latitude.dims or dim in longitude.dims]
    if not all(set(horizontal) <= set(dataset[name].dims) for name in velocity):
        names = " and ".join(f"`{name}`" for name in velocity)
        raise cf_files.UnreadableError(f"{names} are on different points of a staggered grid")
    count = int(np.prod([dataset.sizes[dim] for dim in horizontal]))
    if count == 1:
        place = latitude.values.item(), _signed(longitude.values.item())
        return GridColumn({dim: 0 for dim in horizontal}, place, _far(place, wanted))
    if wanted is None:
        raise cf_files.UnreadableError(
            f"the file has {count} water columns, "
            f"{_span(latitude.values, longitude.values)}; select "
            "one with `--at LAT,LON` or the `position` of the mooring file"
        )
    box = _indices_around(latitude, longitude, horizontal, wanted)
    near = dataset[list(velocity)].isel(box)
    spread = xr.broadcast(*(near[str(one.name)] for one in pair))
    lat, lon = (one.transpose(*horizontal).values.astype(np.float64) for one in spread)
    distance = kilometres_from(lat, lon, wanted)
    nearest = np.unravel_index(np.nanargmin(distance), distance.shape)
    if len(horizontal) > 1 and distance[nearest] > _spacing(lat, lon, nearest):
        raise cf_files.UnreadableError(
            f"{written(wanted)} is outside the grid of the file, "
            f"{_span(latitude.values, longitude.values)}"
        )
    wet = _columns_with_current(near, velocity, time, horizontal)
    if not wet.any():
        raise cf_files.UnreadableError(
            f"no water column around {written(wanted)} contains a current (columns searched: "
            f"{distance.size})"
        )
    chosen = np.unravel_index(np.nanargmin(np.where(wet, distance, np.inf)), distance.shape)
    place = float(lat[chosen]), _signed(float(lon[chosen]))
    index = {dim: int(box[dim][i]) for dim, i in zip(horizontal, chosen, strict=True)}
    dry = "" if chosen == nearest else " with a current"
    note = (
        f"for {written(wanted)}, the nearest water column{dry} is at {written(place)}, "
        f"{distance[chosen]:.1f} km away"
    )
    return GridColumn(index, place, (note,))


def written(place: Place) -> str:
    """Format a place for display."""
    latitude, longitude = place[0], _signed(place[1])
    return (
        f"{abs(latitude):.6g}° {'S' if latitude < 0 else 'N'} "
        f"{abs(longitude):.6g}° {'W' if longitude < 0 else 'E'}"
    )


def _named(dataset: xr.Dataset, coordinate: str) -> list[str]:
    names = [*dataset.cf.coordinates.get(coordinate, []), *_PLACES[coordinate]]
    return cf_files.first_present(dataset, names)


def _position_variables(
    dataset: xr.Dataset, dims: set[Any]
) -> tuple[xr.DataArray, xr.DataArray] | None:
    found = []
    for coordinate in _PLACES:
        named = [dataset[name] for name in _named(dataset, coordinate)]
        numbers = [one for one in named if one.dtype.kind in "fiu"]
        fitting = [one for one in numbers if one.size == 1 or set(one.dims) <= dims]
        if not fitting:
            return None
        # a position that varies precedes a nominal one
        found.append(max(fitting, key=lambda one: one.size))
    return found[0], found[1]


def _indices_around(
    latitude: xr.DataArray, longitude: xr.DataArray, horizontal: list[str], wanted: Place
) -> dict[str, NDArray[Any]]:
    if len(horizontal) == 1:  # a list of places, in any order
        return {horizontal[0]: np.arange(latitude.sizes[horizontal[0]])}
    north = latitude.values.astype(np.float64) - wanted[0]
    east = _turned(longitude.values.astype(np.float64) - wanted[1])
    if latitude.dims != longitude.dims:
        return {
            str(one.dims[0]): _nearest(away) for one, away in ((latitude, north), (longitude, east))
        }
    away = north**2 + (east * np.cos(np.radians(wanted[0]))) ** 2
    centre = np.unravel_index(np.nanargmin(away), away.shape)
    return {
        str(dim): np.arange(max(i - REACH, 0), min(i + REACH + 1, latitude.sizes[dim]))
        for dim, i in zip(latitude.dims, map(int, centre), strict=True)
    }


def _nearest(away: Floats) -> NDArray[Any]:
    """Return the indices of the grid points nearest to a position along an axis.

    `away` has the signed distances of the grid points from the position [degrees]. At most
    ``2 REACH + 1`` indices are returned, in order of increasing signed distance. On a global axis
    of longitudes, the indices may come from both ends of the axis.
    """
    near = np.argsort(np.abs(away), kind="stable")[: 2 * REACH + 1]
    return near[np.argsort(away[near], kind="stable")]


def _columns_with_current(
    near: xr.Dataset, velocity: tuple[str, str], time: str | None, horizontal: list[str]
) -> NDArray[Any]:
    if time in near.dims:
        count = near.sizes[time]
        # any one time may be a gap
        near = near.isel({time: sorted({0, count // 2, count - 1})})
    near = near[list(velocity)].load()
    first, second = (near[name] for name in velocity)
    # some models have zeros on land
    moving = first.notnull() & second.notnull() & ((first != 0) | (second != 0))
    others = [dim for dim in moving.dims if dim not in horizontal]
    return np.asarray(moving.any(others).transpose(*horizontal).values)


def kilometres_from(latitude: Any, longitude: Any, place: Place) -> NDArray[Any]:
    """Return great-circle distances of points from a place [km].

    Parameters
    ----------
    latitude, longitude : coordinates of the points [degrees]
    place : latitude and longitude of the place [degrees]
    """
    first, second = np.radians(latitude), np.radians(place[0])
    east = np.radians(longitude - place[1])
    level = np.cos(first) * np.cos(second) * np.sin(east / 2) ** 2
    chord = np.sin((first - second) / 2) ** 2 + level
    return np.asarray(2 * _EARTH * np.arcsin(np.sqrt(np.clip(chord, 0, 1))))


def _spacing(latitude: NDArray[Any], longitude: NDArray[Any], at: tuple[Any, ...]) -> float:
    """Return the distance from a grid point to the farthest adjacent point [km]."""
    around = tuple(slice(max(i - 1, 0), i + 2) for i in at)
    place = float(latitude[at]), float(longitude[at])
    return float(np.nanmax(kilometres_from(latitude[around], longitude[around], place)))


def _drift_notices(dataset: xr.Dataset, time: str | None, wanted: Place | None) -> tuple[str, ...]:
    found = []
    for coordinate in _PLACES:
        moving = [name for name in _named(dataset, coordinate) if dataset[name].dims == (time,)]
        if not moving:
            return ()
        found.append(np.asarray(dataset[moving[0]].values, np.float64))
    known = np.isfinite(found[0]) & np.isfinite(found[1])
    if not known.any():
        return ()
    latitude, longitude = (values[known] for values in found)
    first = float(latitude[0]), float(longitude[0])
    away = float(kilometres_from(latitude, longitude, first).max())
    moved = (
        f"the position in the file changes with time, by up to {away:.0f} km; all profiles are used"
    )
    return (*([moved] if away > FAR else []), *_far(first, wanted))


def _far(place: Place, wanted: Place | None) -> tuple[str, ...]:
    if wanted is None:
        return ()
    distance = float(kilometres_from(np.array(place[0]), np.array(place[1]), wanted))
    if not distance > FAR:
        return ()
    return (
        f"the only position in the file, {written(place)}, is {distance:.0f} km from "
        f"{written(wanted)}",
    )


def _span(latitude: NDArray[Any], longitude: NDArray[Any]) -> str:
    south, north = float(np.nanmin(latitude)), float(np.nanmax(latitude))
    west, east = float(np.nanmin(longitude)), float(np.nanmax(longitude))
    return f"{written((south, west))} to {written((north, east))}"


def _turned(degrees: Any) -> Any:
    return (degrees + 180.0) % 360.0 - 180.0


def _signed(longitude: float) -> float:
    return longitude if -180.0 <= longitude <= 180.0 else float(_turned(longitude))


_UP, _DOWN = ("elevation", "z", "Band1", "topo"), ("depth", "deptho", "bathymetry")
_MOST = 1000  # most nodes read along a side; finer grids are thinned


@dataclass(frozen=True)
class SeabedGrid:
    """Seabed depths around a point, interpolated linearly; the file is read on first use.

    Attributes
    ----------
    latitude, longitude : origin of the mooring coordinates [degrees]
    reach : half the side length of the square of depths to read [m]; the origin is its centre
    east, north : distances of the point to the east and north of the origin [m]
    """

    path: str = field(compare=False)
    sha256: str
    latitude: float
    longitude: float
    reach: float
    east: float = 0.0
    north: float = 0.0

    @classmethod
    def of_file(cls, path: Path, latitude: float, longitude: float, reach: float) -> SeabedGrid:
        """Open a file with a grid of seabed depths around a position.

        Raise InputError if the file is unreadable, or has no positive depth at the position.
        """
        if path.suffix.lower() in (".tif", ".tiff"):
            turn = f"gdal_translate -of netCDF {path.name} {path.stem}.nc"
            raise refused(path, f"is a GeoTIFF, which is not read; convert it to NetCDF: `{turn}`")
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        grid = cls(str(path), digest, latitude, longitude, reach)
        with cf_files.reading(path):
            if np.isnan(grid.depth):
                raise cf_files.UnreadableError("has no depth at the position of the mooring")
            if grid.depth <= 0.0:
                raise cf_files.UnreadableError(
                    f"has land, {-grid.depth:.4g} m high, at the position of the mooring; if there "
                    "is water, set the attribute `positive` of the variable to `down` or `up`"
                )
        return grid

    def at(self, east: float, north: float) -> SeabedGrid:
        """Return a copy of the grid for another point.

        Parameters
        ----------
        east, north : distances of the new point to the east and north of the present point [m]
        """
        return replace(self, east=self.east + east, north=self.north + north)

    @property
    def depth(self) -> float:
        """Depth at the point [m]; NaN outside the grid and in gaps of the grid."""
        return float(self._depths(np.zeros((1, 2)))[0])

    def deeper(self, places: Floats) -> Floats:
        """Return the depths (n,) at several places minus the depth at the point [m].

        Parameters
        ----------
        places : (n, 2) distances east and north of the point [m]
        """
        return self._depths(places) - self.depth

    @property
    def slope(self) -> float:
        """Slope of the seabed at the point [degrees].

        The gradient along each axis is the steeper of the gradients on either side of the point.
        """
        across, along = np.abs(self._falls).max(axis=1)
        return float(np.degrees(np.arctan(np.hypot(across, along))))

    @property
    def plane(self) -> tuple[float, float]:
        """Depth gradient to the east and to the north at the point [-], by central differences."""
        east, north = self._falls.mean(axis=1).tolist()
        return east, north

    @property
    def _falls(self) -> Floats:
        """Depth gradients (2, 2) along the east and the north axis, on both sides of the point [-].

        Each gradient is a mean over one node spacing. Outside the grid, the gradient on the other
        side of the point is used.
        """
        step = float(np.diff(_nodes(self.at(-self.east, -self.north))[0]).mean())
        rises = self.deeper(step * np.array([(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)]))
        falls = rises.reshape(2, 2) * np.array([1.0, -1.0]) / step
        known: Floats = np.nan_to_num(np.where(np.isnan(falls), falls[:, ::-1], falls))
        return known

    def _depths(self, places: Floats) -> Floats:
        from scipy.interpolate import RegularGridInterpolator

        east, north, depth = _nodes(self.at(-self.east, -self.north))
        found = RegularGridInterpolator((north, east), depth, bounds_error=False)
        return np.asarray(found(places[:, ::-1] + [self.north, self.east]))


@lru_cache(maxsize=4)
def _nodes(grid: SeabedGrid) -> tuple[Floats, Floats, Floats]:
    """Return east (n,) and north (m,) coordinates of the nodes, and their depths (m, n) [m]."""
    latitude, longitude = grid.latitude, grid.longitude
    with cf_files.open_current(Path(grid.path)) as dataset:
        name = next((each for each in (*_UP, *_DOWN) if each in dataset.data_vars), None)
        axes = {str(each).lower()[:3]: str(each) for each in dataset.dims}
        lat, lon = axes.get("lat"), axes.get("lon")
        if name is None or lat is None or lon is None:
            wanted = f"{' or '.join((*_UP, *_DOWN))} with the dimensions latitude and longitude"
            holds = cf_files.holdings(dataset)
            raise cf_files.UnreadableError(f"has no variable {wanted}; it holds {holds}")
        turned = longitude + (dataset[lon] - longitude + 180.0) % 360.0 - 180.0
        whole = dataset[name].squeeze(drop=True).assign_coords({lon: turned}).sortby([lat, lon])
        high = np.degrees(grid.reach / SEMI_MAJOR)
        wide = high / np.cos(np.radians(latitude))
        rows = slice(latitude - high, latitude + high)
        here = whole.sel({lat: rows, lon: slice(longitude - wide, longitude + wide)})
        here = here.transpose(lat, lon)
        here = here[tuple(slice(None, None, -(-size // _MOST) or 1) for size in here.shape)]
        if min(here.shape) < 2:
            raise cf_files.UnreadableError(
                "has too few grid points near the position of the mooring"
            )
        north, east = (np.asarray(here[each].values, float) for each in (lat, lon))
        attributes = dataset[name].attrs
        down = attributes.get("positive", "up" if name in _UP else "down") == "down"
        metre = cf_files.factor_of(dataset[name], "length") if attributes.get("units") else 1.0
        depth = np.asarray(here.values, float) * (metre if down else -metre)
    frame = Frame(latitude, longitude)
    north = frame.place(north, np.full(len(north), longitude), 0.0 * north)[:, 1]
    east = frame.place(np.full(len(east), latitude), east, 0.0 * east)[:, 0]
    return east, north, depth
