"""The density of the water: a constant, a table, or from temperature and salinity."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

from pydantic import Discriminator, Field, Tag, ValidationError

from calm.errors import Problem
from calm.files.definition import CATALOGUE_DENSITY, DENSITY
from calm.files.fields import Model, QuantityField, Text
from calm.files.yaml_document import SourceMapping
from calm.records.profile_tables import (
    SALINITY,
    TEMPERATURE,
    WATER_DENSITY,
    DepthTable,
    Report,
    SeaWater,
    read_profile,
    read_water,
)
from calm.suggestions import about_quantity
from calm.units import QuantityError, QuantityRange

USUAL_DENSITY = {"water": CATALOGUE_DENSITY, "air": 1.225}
"""Where a file gives none [kg/m³]; that of air is the standard atmosphere's at sea level."""


def _form(value: object) -> str:
    if not isinstance(value, dict):
        return "constant"
    return "table" if {"columns", "rows"} & set(value) else "sea water"


def _table_or_constant(value: object) -> str:
    return "table" if isinstance(value, dict) else "constant"


class TableKeys(Model):
    """Columns, each a name and its unit, and rows of values."""

    columns: tuple[Text, ...] = Field(
        description="each a name and its unit: depth m, speed m/s, toward deg; or u m/s, v m/s, "
        "w m/s",
        examples=[["depth m", "speed m/s", "toward deg"]],
    )
    rows: tuple[tuple[Text | None, ...], ...] = Field(
        description="values, top to bottom", examples=[[[0, 0.8, 90], [1100, 0.05, 60]]]
    )


class SeaWaterKeys(Model):
    """Temperature [°C] and practical salinity, each a constant or a table by depth."""

    temperature: Annotated[
        Annotated[float, QuantityField(**vars(TEMPERATURE)), Tag("constant")]
        | Annotated[TableKeys, Tag("table")],
        Discriminator(_table_or_constant),
    ] = Field(description="in situ, a constant or a table", examples=["10 degC"])
    salinity: Annotated[
        Annotated[float, QuantityField(**vars(SALINITY)), Tag("constant")]
        | Annotated[TableKeys, Tag("table")],
        Discriminator(_table_or_constant),
    ] = Field(description="practical, a constant or a table", examples=[35])


Density = Annotated[
    Annotated[float, DENSITY, Tag("constant")]
    | Annotated[TableKeys, Tag("table")]
    | Annotated[SeaWaterKeys, Tag("sea water")],
    Discriminator(_form),
]
"""The value of `density:` as a person writes it."""


_RANGES: Mapping[str, QuantityRange] = {"water": WATER_DENSITY, "air": DENSITY}
_FALL = 0.1
"""Water that gets lighter by more than this with depth turns over [kg/m³]."""


def read_density(
    given: float | TableKeys | SeaWaterKeys,
    fluid: str,
    section: SourceMapping,
    problems: list[Problem],
    notices: list[str],
) -> float | DepthTable | SeaWater | None:
    """Read the density of an environment; None where it has mistakes.

    Parameters
    ----------
    given : as the model has it
    fluid : "water" or "air"
    section : the environment
    problems, notices : what is wrong, and worth knowing, is added to them
    """
    density = _RANGES[fluid]
    if isinstance(given, TableKeys):
        report = report_at(section, "density")
        table = read_water(given.columns, given.rows, report, problems, density)
        if isinstance(table, DepthTable):
            notices.extend(_falls(table))
        return table
    if not isinstance(given, SeaWaterKeys):
        try:
            return density.read(f"{given!r} kg/m^3")
        except QuantityError as error:
            message = about_quantity("density", f"{given:g} kg/m^3", error)
            problems.append(section.problem(("density",), message))
            return None
    temperature = _profile("temperature", given.temperature, section, problems)
    salinity = _profile("salinity", given.salinity, section, problems)
    return SeaWater(temperature, salinity) if temperature and salinity else None


def table_of(value: object) -> TableKeys | None:
    """Return the table that a value of a file is, None where it is none."""
    try:
        return TableKeys.model_validate(value)
    except ValidationError:
        return None


def report_at(section: SourceMapping, *place: str) -> Report:
    """Return what makes problems at places below a key of a mapping, or a key under that."""
    return lambda location, message: section.problem((*place, *location), message)


def _falls(table: DepthTable) -> list[str]:
    """Return a notice where the density falls with depth."""
    greatest, depth = table.value[0], table.depth[0]
    for below, value in zip(table.depth, table.value, strict=True):
        if value < greatest - _FALL:
            return [
                f"The density falls from {greatest:g} kg/m^3 at {depth:g} m to {value:g} kg/m^3 "
                f"at {below:g} m: heavy water over light does not stay."
            ]
        if value >= greatest:
            greatest, depth = value, below
    return []


def check_density(section: SourceMapping, problems: list[Problem]) -> None:
    """Report the mistakes in the tables below `density:`, whatever else is wrong with it."""
    given = section.data.get("density")
    density = _RANGES["air" if section.data.get("fluid") == "air" else "water"]
    table = table_of(given)
    if table is not None:
        read_water(table.columns, table.rows, report_at(section, "density"), problems, density)
    for name in SeaWaterKeys.model_fields:
        table = table_of(given.get(name)) if isinstance(given, dict) else None
        if table is not None:
            _profile(name, table, section, problems)


def _profile(
    name: str, given: float | TableKeys, section: SourceMapping, problems: list[Problem]
) -> DepthTable | None:
    if isinstance(given, TableKeys):
        report = report_at(section, "density", name)
        return read_profile(name, given.columns, given.rows, report, problems)
    return DepthTable((0.0,), (given,))
