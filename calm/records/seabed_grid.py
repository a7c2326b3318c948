"""The depth of the seabed about a place, out of a grid in NetCDF: GEBCO, EMODnet, a survey."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from calm.errors import refused
from calm.positions import SEMI_MAJOR, Frame
from calm.records.cf_files import UnreadableError, factor_of, holdings, open_current, reading

Floats = NDArray[np.float64]
_UP, _DOWN = ("elevation", "z", "Band1", "topo"), ("depth", "deptho", "bathymetry")
_MOST = 1000  # nodes that are read along a side; of a finer grid not every one


@dataclass(frozen=True)
class SeabedGrid:
    """Depths about a point, linear between nodes; the file is read when they are asked for.

    Attributes
    ----------
    path, sha256 : of the file
    latitude, longitude : of the origin of the mooring's places [degrees]
    reach : how far from it nodes count, east and north [m]
    east, north : of the point, from the origin [m]
    """

    path: str
    sha256: str
    latitude: float
    longitude: float
    reach: float
    east: float = 0.0
    north: float = 0.0

    @classmethod
    def of_file(cls, path: Path, latitude: float, longitude: float, reach: float) -> SeabedGrid:
        """Return that of a file at a position; InputError where it cannot be understood."""
        if path.suffix.lower() in (".tif", ".tiff"):
            turn = f"gdal_translate -of netCDF {path.name} {path.stem}.nc"
            raise refused(path, f"is a GeoTIFF, which is not read; turn it into NetCDF: `{turn}`")
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        grid = cls(str(path), digest, latitude, longitude, reach)
        with reading(path):
            if np.isnan(grid.depth):
                raise UnreadableError("has no depth at the position of the mooring")
            if grid.depth <= 0.0:
                raise UnreadableError(
                    f"has land, {-grid.depth:.4g} m high, at the position of the mooring; if that "
                    "is water, let `positive` of its variable say `down`, or `up`"
                )
        return grid

    def at(self, east: float, north: float) -> SeabedGrid:
        """Return the same about another point, by its distance from this one [m]."""
        return replace(self, east=self.east + east, north=self.north + north)

    @property
    def depth(self) -> float:
        """Depth at the point [m]; NaN outside the grid, and where it has none."""
        return float(self._depths(np.zeros((1, 2)))[0])

    def deeper(self, places: Floats) -> Floats:
        """Return how much deeper it is (n,) at places (n, 2) east and north of the point [m]."""
        return self._depths(places) - self.depth

    @property
    def slope(self) -> float:
        """The steepest slope to a node's distance from the point [degrees]."""
        across, along = np.abs(self._falls).max(axis=1)
        return float(np.degrees(np.arctan(np.hypot(across, along))))

    @property
    def plane(self) -> tuple[float, float]:
        """How much deeper it is per metre to the east and to the north [-]: the mean over a node's
        distance to either side."""
        east, north = self._falls.mean(axis=1).tolist()
        return east, north

    @property
    def _falls(self) -> Floats:
        """How much deeper it is per metre along east (2,) and north (2,), on either side [-]."""
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
    """East (n,) and north (m,) of the nodes from the origin, and the depths (m, n) there [m]."""
    latitude, longitude = grid.latitude, grid.longitude
    with open_current(Path(grid.path)) as dataset:
        name = next((each for each in (*_UP, *_DOWN) if each in dataset.data_vars), None)
        axes = {str(each).lower()[:3]: str(each) for each in dataset.dims}
        lat, lon = axes.get("lat"), axes.get("lon")
        if name is None or lat is None or lon is None:
            wanted = f"none of {', '.join((*_UP, *_DOWN))} over latitude and longitude"
            raise UnreadableError(f"has {wanted}; it holds {holdings(dataset)}")
        turned = longitude + (dataset[lon] - longitude + 180.0) % 360.0 - 180.0
        whole = dataset[name].squeeze(drop=True).assign_coords({lon: turned}).sortby([lat, lon])
        high = np.degrees(grid.reach / SEMI_MAJOR)
        wide = high / np.cos(np.radians(latitude))
        rows = slice(latitude - high, latitude + high)
        here = whole.sel({lat: rows, lon: slice(longitude - wide, longitude + wide)})
        here = here.transpose(lat, lon)
        here = here[tuple(slice(None, None, -(-size // _MOST) or 1) for size in here.shape)]
        if min(here.shape) < 2:
            raise UnreadableError("has too few nodes about the position of the mooring")
        north, east = (np.asarray(here[each].values, float) for each in (lat, lon))
        attributes = dataset[name].attrs
        down = attributes.get("positive", "up" if name in _UP else "down") == "down"
        metre = factor_of(dataset[name], "length") if attributes.get("units") else 1.0
        depth = np.asarray(here.values, float) * (metre if down else -metre)
    frame = Frame(latitude, longitude)
    north = frame.place(north, np.full(len(north), longitude), 0.0 * north)[:, 1]
    east = frame.place(np.full(len(east), latitude), east, 0.0 * east)[:, 0]
    return east, north, depth
