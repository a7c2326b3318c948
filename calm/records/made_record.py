"""A small record to begin with: thirty days of a made tide, a mean flow and a storm surge."""

from __future__ import annotations

from typing import Any

import numpy as np

DAYS = 30
DEPTHS = (4.0, 12.0, 24.0, 40.0, 60.0, 90.0, 130.0, 180.0, 230.0, 290.0)
"""Of the levels [m], for water of 300 m."""

START = "2026-03-01T00:00:00"
LATITUDE, LONGITUDE = 48.3, -5.2

RESOLUTION = 1e-3
"""Steps of the currents [m/s], which the last digits of a sine do not pass."""

_SEABED = 300.0
# period [h], to the east and to the north [m/s], phase [degrees]; M2, S2, K1
_TIDE = ((12.4206, 0.17, 0.05, 40.0), (12.0, 0.06, 0.02, 75.0), (23.9345, 0.03, 0.02, 10.0))
_MEAN = (0.12, 0.05, 120.0)  # to the east and to the north at the surface [m/s], fading in [m]
_SURGE = (0.40, -0.15, 150.0)
_SURGE_DAY, _SURGE_LENGTH = 18.5, 0.8  # its middle and its width [days]
_MISSING = -32767


def made_record() -> bytes:
    """Return the record as a classic NetCDF file: the same bytes wherever it is made."""
    import xarray as xr

    hours = np.arange(24 * DAYS)
    currents = [
        (
            ("time", "depth"),
            np.rint(values / RESOLUTION).astype(np.int16),
            {
                "standard_name": f"{way}ward_sea_water_velocity",
                "long_name": f"{way}ward velocity of the current",
                "units": "m s-1",
                "scale_factor": RESOLUTION,
                "_FillValue": np.int16(_MISSING),
                "coordinates": "latitude longitude",
            },
        )
        for way, values in zip(("east", "north"), _currents(hours), strict=True)
    ]
    dataset = xr.Dataset(
        {"u": currents[0], "v": currents[1]},
        {
            "time": ("time", hours.astype(np.int32), _named("time", f"hours since {START}", "T")),
            "depth": ("depth", np.array(DEPTHS), {**_named("depth", "m", "Z"), "positive": "down"}),
            "latitude": ((), LATITUDE, _named("latitude", "degrees_north")),
            "longitude": ((), LONGITUDE, _named("longitude", "degrees_east")),
        },
        {
            "Conventions": "CF-1.11",
            "title": "A made record of currents: a tide, a mean flow and a storm surge",
            "comment": "Made by a formula, not measured.",
        },
    )
    dataset["time"].attrs["calendar"] = "standard"
    for name in ("depth", "latitude", "longitude"):
        dataset[name].encoding["_FillValue"] = None
    return bytes(dataset.to_netcdf(engine="scipy"))


def _currents(hours: Any) -> tuple[Any, Any]:
    """To the east and to the north [m/s], times by levels."""
    hours = hours[:, np.newaxis].astype(np.float64)
    depth = np.array(DEPTHS)
    # slower near the seabed, as the seventh power of the height has it
    friction = ((_SEABED - depth) / _SEABED) ** (1 / 7)
    east, north = (speed * np.exp(-depth / _MEAN[2]) for speed in _MEAN[:2])
    surge = np.exp(-(((hours / 24 - _SURGE_DAY) / _SURGE_LENGTH) ** 2) / 2 - depth / _SURGE[2])
    east, north = east + _SURGE[0] * surge, north + _SURGE[1] * surge
    for period, major, minor, phase in _TIDE:
        angle = 2 * np.pi * hours / period - np.radians(phase)
        east = east + major * friction * np.cos(angle)
        north = north + minor * friction * np.sin(angle)
    return east, north


def _named(standard_name: str, units: str, axis: str | None = None) -> dict[str, str]:
    named = {"standard_name": standard_name, "units": units}
    return named if axis is None else {**named, "axis": axis}
