"""Geographic positions: notations of latitude and longitude, and the WGS 84 ellipsoid."""

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

HEMISPHERES: Mapping[str, str] = {"latitude": "NS", "longitude": "EW"}
"""Letters of the positive and the negative hemisphere."""

_POSITION = re.compile(
    r"""(?P<before>[NSEW])?\s*
    (?P<sign>[+-])?(?P<degrees>\d{1,3}(?:\.\d*)?)\s*(?:°|º|deg)?
    (?:[\s-]*(?P<minutes>\d{1,2}(?:\.\d*)?)\s*(?:'|′|’|min)?
      (?:[\s-]*(?P<seconds>\d{1,2}(?:\.\d*)?)\s*(?:"|″|”|''|sec)?)?
    )?\s*(?P<after>[NSEW])?""",
    re.VERBOSE | re.IGNORECASE,
)


def degrees_of(text: str, what: str) -> float | None:
    """Parse a latitude or longitude [degrees], negative for south and west.

    Texts such as ``57 28.84 N``, ``57°28.84'N``, ``57-28.84N``, ``-5 12 30`` or ``5.2 W`` are
    accepted. Return None for other texts, such as a plain number. `what` is ``latitude`` or
    ``longitude``.

    Raises
    ------
    ValueError
        The text has minutes or seconds of 60 or more, a fraction before the last part, a sign and a
        hemisphere, or a wrong hemisphere.
    """
    found = _POSITION.fullmatch(text.strip())
    if found is None:
        return None
    letter = (found["before"] or found["after"] or "").upper()
    if not letter and found["minutes"] is None:
        return None
    if found["before"] and found["after"]:
        raise ValueError("names two hemispheres")
    if letter and letter not in HEMISPHERES[what]:
        raise ValueError(f"is not a {what}; {' or '.join(HEMISPHERES[what])} is needed")
    if letter and found["sign"]:
        raise ValueError("has a sign and a hemisphere; remove one of them")
    parts = [found[name] for name in ("degrees", "minutes", "seconds") if found[name]]
    if any("." in part for part in parts[:-1]):
        raise ValueError(
            "has a decimal fraction before its last number; write 57 28.84 N or 57 28 50.4 N"
        )
    if any(float(part) >= 60.0 for part in parts[1:]):
        raise ValueError("has minutes or seconds of 60 or more")
    size = sum(float(part) / 60.0**power for power, part in enumerate(parts))
    return -size if found["sign"] == "-" or letter in ("S", "W") else size


def plain_degrees(text: str, what: str) -> float:
    """Parse a latitude or longitude [degrees]; a plain number is in degrees.

    `what` is ``latitude`` or ``longitude``. Raises ValueError as `degrees_of` does, or if the text
    is not a number.
    """
    placed = degrees_of(text, what)
    return float(text) if placed is None else placed


def read_as_minutes(degrees: float) -> float:
    """Convert a number to degrees, with its decimals read as minutes: 48.18 stands for 48°18'."""
    size = abs(degrees)
    whole = int(size)
    minutes = (size - whole) * 100.0
    return (whole + minutes / 60.0) * (1.0 if degrees >= 0.0 else -1.0)


SEMI_MAJOR = 6_378_137.0
FLATTENING = 1.0 / 298.257223563
_SQUARE = FLATTENING * (2.0 - FLATTENING)  # square of the eccentricity
_ROUNDS = 10


@dataclass(frozen=True)
class Frame:
    """Local coordinate frame with axes to the east, north and up.

    The origin, given by latitude and longitude [degrees], lies on the ellipsoid.
    """

    latitude: float
    longitude: float

    @property
    def _axes(self) -> Floats:
        """Unit vectors east, north and up in geocentric coordinates, shape (3, 3)."""
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
        """Convert positions [degrees] at depths [m] to local coordinates east, north and up [m],
        shape (n, 3).
        """
        origin = _from_centre(np.array(self.latitude), np.array(self.longitude), np.array(0.0))
        found: Floats = (_from_centre(latitude, longitude, depth) - origin) @ self._axes.T
        return found

    def position(self, place: Floats) -> tuple[float, float, float]:
        """Convert local coordinates [m], shape (3,), to latitude and longitude [degrees] and depth
        [m].
        """
        origin = _from_centre(np.array(self.latitude), np.array(self.longitude), np.array(0.0))
        x, y, z = (origin + place @ self._axes).tolist()
        across = float(np.hypot(x, y))
        latitude = float(np.arctan2(z, across * (1.0 - _SQUARE)))
        height = 0.0
        for _ in range(_ROUNDS):  # each iteration divides the error by about 300
            normal = SEMI_MAJOR / np.sqrt(1.0 - _SQUARE * np.sin(latitude) ** 2)
            height = across * np.cos(latitude) + z * np.sin(latitude) - SEMI_MAJOR**2 / normal
            latitude = np.arctan2(z, across * (1.0 - _SQUARE * normal / (normal + height)))
        longitude = np.degrees(np.arctan2(y, x))
        return float(np.degrees(latitude)), float(longitude), -float(height)


def _from_centre(latitude: Floats, longitude: Floats, depth: Floats) -> Floats:
    """Geocentric Cartesian coordinates [m] of positions [degrees] at depths [m] below the
    ellipsoid, shape (…, 3).
    """
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
