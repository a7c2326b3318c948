"""Places on and below the WGS 84 ellipsoid in a local frame, exactly.

Positions go by way of Cartesian coordinates from the centre of the Earth, so that a straight line
between two of them is one, whatever lies between. No series is cut off.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calm.physics.line import Floats

SEMI_MAJOR = 6_378_137.0
FLATTENING = 1.0 / 298.257223563
_SQUARE = FLATTENING * (2.0 - FLATTENING)  # of the eccentricity
_ROUNDS = 10


@dataclass(frozen=True)
class Frame:
    """East, north and up at a point of the ellipsoid [degrees]; the origin is that point."""

    latitude: float
    longitude: float

    @property
    def _axes(self) -> Floats:
        """(3, 3) rows east, north, up in coordinates from the centre."""
        phi, lam = np.radians([self.latitude, self.longitude])
        sin_phi, cos_phi, sin_lam, cos_lam = np.sin(phi), np.cos(phi), np.sin(lam), np.cos(lam)
        return np.array(
            [
                [-sin_lam, cos_lam, 0.0],
                [-sin_phi * cos_lam, -sin_phi * sin_lam, cos_phi],
                [cos_phi * cos_lam, cos_phi * sin_lam, sin_phi],
            ]
        )

    def place(self, latitude: Floats, longitude: Floats, depth: Floats) -> Floats:
        """(n, 3) east, north and up [m] of positions [degrees] at depths [m]."""
        origin = _from_centre(np.array(self.latitude), np.array(self.longitude), np.array(0.0))
        found: Floats = (_from_centre(latitude, longitude, depth) - origin) @ self._axes.T
        return found

    def position(self, place: Floats) -> tuple[float, float, float]:
        """Latitude, longitude [degrees] and depth [m] of a place (3,) [m]."""
        origin = _from_centre(np.array(self.latitude), np.array(self.longitude), np.array(0.0))
        x, y, z = (origin + place @ self._axes).tolist()
        across = float(np.hypot(x, y))
        latitude = float(np.arctan2(z, across * (1.0 - _SQUARE)))
        height = 0.0
        for _ in range(_ROUNDS):  # each makes the error some three hundred times less
            normal = SEMI_MAJOR / np.sqrt(1.0 - _SQUARE * np.sin(latitude) ** 2)
            height = across * np.cos(latitude) + z * np.sin(latitude) - SEMI_MAJOR**2 / normal
            latitude = np.arctan2(z, across * (1.0 - _SQUARE * normal / (normal + height)))
        longitude = np.degrees(np.arctan2(y, x))
        return float(np.degrees(latitude)), float(longitude), -float(height)


def _from_centre(latitude: Floats, longitude: Floats, depth: Floats) -> Floats:
    """(…, 3) Cartesian coordinates [m] of positions [degrees] below the ellipsoid [m]."""
    phi, lam = np.radians(latitude), np.radians(longitude)
    normal = SEMI_MAJOR / np.sqrt(1.0 - _SQUARE * np.sin(phi) ** 2)
    across = (normal - depth) * np.cos(phi)
    return np.stack(
        [
            across * np.cos(lam),
            across * np.sin(lam),
            (normal * (1.0 - _SQUARE) - depth) * np.sin(phi),
        ],
        axis=-1,
    )
