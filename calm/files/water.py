"""Keys for the water and the wind: tables by depth, and density."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated

import numpy as np
from pydantic import Discriminator, Tag, ValidationError, model_validator

from calm.errors import Problem, about_quantity
from calm.files import definition
from calm.files.definition import DENSITY, Model, QuantityField, Text, described, optional
from calm.files.yaml_document import SourceMapping
from calm.physics import seawater
from calm.records import profile_tables
from calm.records.profile_tables import QuantityTable
from calm.records.value_tests import left_out
from calm.units import QuantityError, QuantityRange

USUAL_DENSITY = {"water": definition.CATALOGUE_DENSITY, "air": 1.225}
"""Default density of water, and of air for moorings in air [kg/m³]."""


def _form(value: object) -> str:
    if not isinstance(value, dict):
        return "constant"
    return "table" if {"columns", "rows"} & set(value) else "sea water"


def _table_or_constant(value: object) -> str:
    return "table" if isinstance(value, dict) else "constant"


class TableKeys(Model):
    """Keys of a table: columns with names and units, and rows of values."""

    columns: tuple[Text, ...] = described(
        "column names with units: depth m, speed m/s, toward deg; or u m/s, v m/s, w m/s",
        ["depth m", "speed m/s", "toward deg"],
    )
    rows: tuple[tuple[Text | None, ...], ...] = described(
        "values, top to bottom", [[0, 0.8, 90], [1100, 0.05, 60]]
    )


class SeaWaterKeys(Model):
    """Temperature [°C] and practical salinity of sea water, each constant or tabulated by depth."""

    temperature: Annotated[
        Annotated[float, QuantityField(**vars(profile_tables.TEMPERATURE)), Tag("constant")]
        | Annotated[TableKeys, Tag("table")],
        Discriminator(_table_or_constant),
    ] = described("in-situ temperature, a constant or a table", "10 degC")
    salinity: Annotated[
        Annotated[float, QuantityField(**vars(profile_tables.SALINITY)), Tag("constant")]
        | Annotated[TableKeys, Tag("table")],
        Discriminator(_table_or_constant),
    ] = described("practical salinity, a constant or a table", 35)


Density = Annotated[
    Annotated[float, DENSITY, Tag("constant")]
    | Annotated[TableKeys, Tag("table")]
    | Annotated[SeaWaterKeys, Tag("sea water")],
    Discriminator(_form),
]
"""Type of the value of `density:` in a file."""


_RANGES: Mapping[str, QuantityRange] = {"water": profile_tables.WATER_DENSITY, "air": DENSITY}
_FALL = 0.1
"""Largest plausible decrease of density with depth [kg/m³]; water with a larger decrease would
overturn.
"""
_RATIO = 0.05
"""Lowest plausible salinity of the sea.

A lower value is that of a lake, or a mass fraction that was written instead of g/kg.
"""
_WARMEST_BELOW = 30.0
"""Temperature of the deepest water [°C] above which temperature and salinity may be exchanged.

No sea is warmer than this below its surface, and few seas have a salinity below this number.
"""


def read_density(
    given: float | TableKeys | SeaWaterKeys, fluid: str, section: SourceMapping
) -> float | profile_tables.DepthTable | profile_tables.SeaWater | None:
    """Read the density of the fluid in an environment; return None if the value has mistakes.

    Parameters
    ----------
    given : value of `density:` in the model
    fluid : "water" or "air"
    section : the environment
    """
    density = _RANGES[fluid]
    if isinstance(given, TableKeys):
        return profile_tables.read_water(quantity_table(given, section, "density"), density)
    if not isinstance(given, SeaWaterKeys):
        try:
            return density.read(f"{given!r} kg/m^3")
        except QuantityError as error:
            message = about_quantity("density", f"{given:g} kg/m^3", error)
            section.refuse(("density",), message)
            return None
    temperature = _profile("temperature", given.temperature, section)
    salinity = _profile("salinity", given.salinity, section)
    return profile_tables.SeaWater(temperature, salinity) if temperature and salinity else None


def table_of(value: object) -> TableKeys | None:
    """Validate a value as a table; return None if it is invalid."""
    try:
        return TableKeys.model_validate(value)
    except ValidationError:
        return None


def quantity_table(table: TableKeys, section: SourceMapping, *place: str) -> QuantityTable:
    """Build a table of quantities that reports mistakes at their positions in the file.

    The keys in `place` lead from the mapping `section` to the table.
    """

    def problem(at: Sequence[str | int], message: str) -> Problem:
        return section.problem((*place, *at), message)

    return QuantityTable(table.columns, table.rows, problem, section.problems)


_LIGHTEST = 990.0
"""Density of fresh water at 45 °C, the lowest density of any mooring's water [kg/m³]."""
_HEAVIEST = 1040.0, 0.0047
"""Highest density of sea water: value at the surface [kg/m³], and increase with depth [kg/m⁴].

The first number is the density of the Red Sea in winter, 1030 kg/m³, plus a margin. The second
number is the effect of pressure, by which sea water has 1050 kg/m³ at 5000 m. Brines are denser.
"""


def density_doubts(
    density: float | profile_tables.DepthTable | profile_tables.SeaWater, depth: float | None
) -> Iterator[str]:
    """Yield a warning for each implausible density of the water.

    `depth` is the water depth [m]; None if unknown.
    """
    given: tuple[tuple[float, float], ...] = ()
    if isinstance(density, profile_tables.DepthTable):
        given = tuple(zip(density.depth, density.value, strict=True))
    elif isinstance(density, float):
        given = ((depth or 0.0, density),)
    at_surface, by_metre = _HEAVIEST
    for below, value in given:
        if not _LIGHTEST <= value <= at_surface + by_metre * below:
            what = "brine" if value > _LIGHTEST else "hot fresh water"
            yield (
                f"The density of {value:.5g} kg/m^3 is that of {what}: sea water has 1000 to 1030 "
                "kg/m^3 at the surface, and 4.5 kg/m^3 more for each 1000 m."
            )
            break
    if isinstance(density, profile_tables.SeaWater):
        profiles = {"temperature": density.temperature, "salinity": density.salinity}
        yield from _sea_water_notices(density)
    else:
        profiles = {"density": density} if isinstance(density, profile_tables.DepthTable) else {}
        for table in profiles.values():
            yield from _falls(table)
    for name, table in profiles.items():
        if table.depth != (0.0,):  # a single value applies to all depths
            ends = table.depth[0], table.depth[-1]
            missing = left_out(*ends, math.inf if depth is None else depth, name)
            if missing:
                yield f"{missing[0].upper()}{missing[1:]}."


def _sea_water_notices(water: profile_tables.SeaWater) -> Iterator[str]:
    warm, salt = water.temperature.value, water.salinity.value
    if max(salt) < _RATIO:
        yield (
            f"A salinity of {max(salt):g} is that of fresh water; write 35 for 35 g/kg, not 0.035."
        )
    elif warm[-1] > _WARMEST_BELOW and salt[-1] < warm[-1]:
        yield (
            f"The deepest water has {warm[-1]:g} °C and a salinity of {salt[-1]:g}: are "
            "temperature and salinity exchanged?"
        )
    given = (water.temperature, water.salinity)
    if all(len(each.depth) > 1 for each in given):
        depth = np.union1d(*(each.depth for each in given))
        warmth, saltiness = (np.interp(depth, each.depth, each.value) for each in given)
        raised = seawater.potential_density(warmth, saltiness, depth)
        yield from _falls(profile_tables.DepthTable(tuple(depth.tolist()), tuple(raised.tolist())))


def _falls(table: profile_tables.DepthTable) -> Iterator[str]:
    greatest, depth = table.value[0], table.depth[0]
    for below, value in zip(table.depth, table.value, strict=True):
        if value < greatest - _FALL:
            yield (
                f"The density falls from {greatest:.6g} kg/m^3 at {depth:g} m to {value:.6g} "
                f"kg/m^3 at {below:g} m: such a stratification is unstable."
            )
            return
        if value >= greatest:
            greatest, depth = value, below


def check_density(section: SourceMapping) -> None:
    """Record the mistakes in the tables of `density:`, even if other keys are wrong."""
    given = section.data.get("density")
    density = _RANGES["air" if section.data.get("fluid") == "air" else "water"]
    table = table_of(given)
    if table is not None:
        profile_tables.read_water(quantity_table(table, section, "density"), density)
    for name in SeaWaterKeys.model_fields:
        table = table_of(given.get(name)) if isinstance(given, dict) else None
        if table is not None:
            _profile(name, table, section)


def _profile(
    name: str, given: float | TableKeys, section: SourceMapping
) -> profile_tables.DepthTable | None:
    if isinstance(given, TableKeys):
        return profile_tables.read_profile(name, quantity_table(given, section, "density", name))
    return profile_tables.DepthTable((0.0,), (given,))


_SPEED = QuantityField("speed", at_least=0)
Toward = Annotated[float, QuantityField(**vars(profile_tables.DIRECTION))]


class Wind(Model):
    """Wind over the water: speed [m/s], and the direction toward which it blows [degrees].

    The wind drives the surface water at the fraction `surface_drift` of the wind speed. This drift
    decreases linearly to zero at `drift_depth` [m], which by default is the depth of the seabed.
    """

    speed: Annotated[float, _SPEED] = described("wind speed at the height of the float", "12 m/s")
    toward: Toward = described(
        "direction towards which the wind blows, clockwise from north", "90 deg"
    )
    surface_drift: Annotated[float, QuantityField("number", at_least=0, at_most=0.1)] = described(
        "drift of the surface water, as a share of the wind speed", "2 %", default=0.0
    )
    drift_depth: definition.PositiveLength = optional(
        "depth to which the wind drives the water", "50 m"
    )

    @model_validator(mode="after")
    def _depth_of_a_drift(self) -> Wind:
        if self.drift_depth is not None and "surface_drift" not in self.model_fields_set:
            raise ValueError("`drift_depth` needs `surface_drift`, a share of the wind's speed")
        return self
