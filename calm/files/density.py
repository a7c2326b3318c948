"""The density of the water: a constant, a table, or what temperature and salinity make of it."""

from __future__ import annotations

from typing import Annotated

from pydantic import Discriminator, Tag

from calm.errors import Problem
from calm.files.definition import CATALOGUE_DENSITY, DENSITY
from calm.files.fields import Model
from calm.files.section import Section
from calm.files.tables import (
    SALINITY,
    TEMPERATURE,
    DepthTable,
    SeaWater,
    Table,
    read_profile,
    read_water,
    report_at,
    table_of,
)

USUAL_DENSITY = {"water": CATALOGUE_DENSITY, "air": 1.225}
"""Where a file gives none [kg/m³]; that of air is the standard atmosphere's at sea level."""


def _form(value: object) -> str:
    if not isinstance(value, dict):
        return "constant"
    return "table" if {"columns", "rows"} & set(value) else "sea water"


def _table_or_constant(value: object) -> str:
    return "table" if isinstance(value, dict) else "constant"


class SeaWaterKeys(Model):
    """Temperature [°C] and practical salinity, each a constant or a table by depth."""

    temperature: Annotated[
        Annotated[float, TEMPERATURE, Tag("constant")] | Annotated[Table, Tag("table")],
        Discriminator(_table_or_constant),
    ]
    salinity: Annotated[
        Annotated[float, SALINITY, Tag("constant")] | Annotated[Table, Tag("table")],
        Discriminator(_table_or_constant),
    ]


Density = Annotated[
    Annotated[float, DENSITY, Tag("constant")]
    | Annotated[Table, Tag("table")]
    | Annotated[SeaWaterKeys, Tag("sea water")],
    Discriminator(_form),
]
"""The value of `density:` as a person writes it."""


def read_density(
    given: float | Table | SeaWaterKeys, section: Section, problems: list[Problem]
) -> float | DepthTable | SeaWater | None:
    """The density of a section's `density:`; None, with its mistakes told, when it has any."""
    if isinstance(given, Table):
        return read_water(given.columns, given.rows, report_at(section, "density"), problems)
    if not isinstance(given, SeaWaterKeys):
        return given
    temperature = _profile("temperature", given.temperature, section, problems)
    salinity = _profile("salinity", given.salinity, section, problems)
    return SeaWater(temperature, salinity) if temperature and salinity else None


def check_density(section: Section, problems: list[Problem]) -> None:
    """Tell the mistakes in the tables below `density:`, whatever else is wrong with it."""
    given = section.data.get("density")
    table = table_of(given)
    if table is not None:
        read_water(table.columns, table.rows, report_at(section, "density"), problems)
    for name in SeaWaterKeys.model_fields:
        table = table_of(given.get(name)) if isinstance(given, dict) else None
        if table is not None:
            _profile(name, table, section, problems)


def _profile(
    name: str, given: float | Table, section: Section, problems: list[Problem]
) -> DepthTable | None:
    if isinstance(given, Table):
        report = report_at(section, "density", name)
        return read_profile(name, given.columns, given.rows, report, problems)
    return DepthTable((0.0,), (given,))
