"""Quantities that instruments of a mooring measure and that go onto levels, and their units."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from calm.errors import UsageError, unknown
from calm.records.cf_files import UnreadableError

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Measured:
    """A quantity that is put on levels.

    Attributes
    ----------
    archive : its name in files of OceanSITES
    standard_name, long_name, units : of what is written
    dimension : of its unit, in the sense of `calm.units`
    sought, usual : CF standard names, and usual names, by which it is found
    noise : standard deviation of a good sensor that a user has not told otherwise
    """

    archive: str
    standard_name: str
    long_name: str
    units: str
    dimension: str
    sought: tuple[str, ...]
    usual: tuple[str, ...]
    noise: float


QUANTITIES_MEASURED = {
    "temperature": Measured(
        "TEMP", "sea_water_temperature", "temperature of the sea water", "degree_Celsius",
        "temperature", ("sea_water_temperature",),
        ("TEMP", "temperature", "temp", "Temperature"), 0.002,
    ),
    "salinity": Measured(
        "PSAL", "sea_water_practical_salinity", "practical salinity", "1", "salinity",
        ("sea_water_practical_salinity", "sea_water_salinity"),
        ("PSAL", "salinity", "psal", "Salinity"), 0.003,
    ),
    "u": Measured(
        "UCUR", "eastward_sea_water_velocity", "velocity of the water to the east", "m s-1",
        "speed", ("eastward_sea_water_velocity",), (), 0.01,
    ),
    "v": Measured(
        "VCUR", "northward_sea_water_velocity", "velocity of the water to the north", "m s-1",
        "speed", ("northward_sea_water_velocity",), (), 0.01,
    ),
}  # fmt: skip
"""By the names that commands take; noise: what makers state of the usual instruments."""


def chosen_quantities(text: str | None) -> tuple[str, ...]:
    """Return the names of a text such as ``temperature,salinity``; without one, all.

    UsageError: a name is none of `QUANTITIES_MEASURED`, neither there nor in the archive.
    """
    archived = {one.archive: name for name, one in QUANTITIES_MEASURED.items()}
    wanted = [part.strip() for part in (text or ",".join(QUANTITIES_MEASURED)).split(",")]
    for name in wanted:
        if name not in QUANTITIES_MEASURED and name not in archived:
            known = (*QUANTITIES_MEASURED, *archived)
            raise UsageError(unknown(f"--variables: `{name}` is not gridded", name, known))
    return tuple(dict.fromkeys(archived.get(name, name) for name in wanted))


_CELSIUS = ("degree_celsius", "degrees_celsius", "celsius", "degc", "deg_c", "°c", "degree_c", "c",
            "degrees celsius", "degree celsius", "degrees_c", "deg c")  # fmt: skip
_KELVIN = ("k", "kelvin", "degree_kelvin", "degrees_kelvin")


def celsius_zero(variable: xr.DataArray) -> float:
    """Return what is taken from a temperature to have it in °C."""
    unit = str(variable.attrs.get("units", "")).strip()
    if unit.rpartition(",")[2].strip().lower() in _CELSIUS:  # `ITS-90, deg C`
        return 0.0
    if unit.lower() in _KELVIN:
        return 273.15
    said = f"`{unit}`, is not degree_Celsius or K" if unit else "is missing: degree_Celsius or K"
    raise UnreadableError(f"`{variable.name}`: its unit, {said}")


_PRACTICAL = ("", "1", "psu", "pss", "pss-78", "pss78", "1e-3", "0.001", "ppt", "psal")


def practical_factor(variable: xr.DataArray) -> float:
    """Return 1 for a practical salinity, by whatever name its unit goes."""
    unit = str(variable.attrs.get("units", "")).strip()
    if unit.lower() not in _PRACTICAL:
        raise UnreadableError(f"`{variable.name}`: its unit, `{unit}`, is not that of a practical "
                              "salinity: 1 (or PSU)")  # fmt: skip
    return 1.0
