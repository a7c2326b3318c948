"""The environment of a mooring: water depth, density, gravity, current and wind."""

from __future__ import annotations

import os.path
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BeforeValidator, Discriminator, Tag, ValidationError

from calm.errors import InputError, Problem
from calm.files.current_file import read_current_file
from calm.files.explain import shown, validate
from calm.files.fields import Model, Quantity, Text
from calm.files.section import Section
from calm.files.tables import (
    CurrentTable,
    DensityTable,
    Report,
    components,
    read_current,
    read_density,
)
from calm.files.times import TimeChoiceError
from calm.units import QuantityError

_DENSITY = Quantity("density", above=0)
_SPEED = Quantity("speed", at_least=0)
_DIRECTION = Quantity("angle")


@dataclass(frozen=True)
class Environment:
    """What the mooring stands in.

    Attributes
    ----------
    name : str or None
        Of the variant or environment file in use.
    depth : float
        Water depth [m].
    density : float or DensityTable
        Of the water [kg/m³].
    gravity : float or None
        [m/s²], where the file gives it.
    current : CurrentTable
    wind : Wind or None
    """

    name: str | None
    depth: float
    density: float | DensityTable
    gravity: float | None
    current: CurrentTable
    wind: Wind | None


class Wind(Model):
    """Wind over the water: speed [m/s], and where it blows to [degrees]."""

    speed: Annotated[float, _SPEED]
    toward: Annotated[float, _DIRECTION]


class Table(Model):
    """Columns, each a name and its unit, and rows of values."""

    columns: tuple[Text, ...]
    rows: tuple[tuple[Text | None, ...], ...]


class UniformCurrent(Model):
    """The same current at all depths [m/s, degrees]."""

    speed: Annotated[float, _SPEED]
    toward: Annotated[float, _DIRECTION]
    w: Annotated[float, Quantity("speed")] = 0.0


class CurrentFile(Model):
    """A current measured or modelled: a CSV or NetCDF file, and a time in it."""

    file: Text
    time: Text | None = None


def _current_form(value: object) -> str:
    if not isinstance(value, dict):
        return "uniform"
    if {"file", "time"} & set(value):
        return "file"
    return "table" if {"columns", "rows"} & set(value) else "uniform"


def _density_form(value: object) -> str:
    return "table" if isinstance(value, dict) else "constant"


def _no_sea_water_formula(value: object) -> object:
    if isinstance(value, dict) and {"temperature", "salinity"} & set(value):
        raise QuantityError(
            "from temperature and salinity is not available in this version; give a density"
        )
    return value


def _water_only(value: object) -> object:
    if value == "air":
        raise QuantityError("is not available in this version; a mooring stands in water")
    return value


class EnvironmentKeys(Model):
    """The keys of `environment:` as a person writes them."""

    fluid: Annotated[Literal["water"], BeforeValidator(_water_only)] = "water"
    depth: Annotated[float, Quantity("length", above=0)]
    density: Annotated[
        Annotated[Annotated[float, _DENSITY], Tag("constant")] | Annotated[Table, Tag("table")],
        Discriminator(_density_form),
        BeforeValidator(_no_sea_water_formula),
    ] = 1025.0
    gravity: Annotated[float | None, Quantity("acceleration", above=0)] = None
    current: Annotated[
        Annotated[Table, Tag("table")]
        | Annotated[CurrentFile, Tag("file")]
        | Annotated[UniformCurrent, Tag("uniform")],
        Discriminator(_current_form),
    ] = UniformCurrent.model_construct(speed=0.0, toward=0.0, w=0.0)
    wind: Wind | None = None


def read_environment(
    section: Section,
    name: str | None,
    problems: list[Problem],
    notices: list[str],
    *,
    open_files: bool = True,
) -> Environment | None:
    """The environment of a section; its mistakes are added to `problems`, and None returned.

    A current file is looked for beside the file that names it. With `open_files` false it is not
    read, and the environment returned is none.
    """
    keys = validate(EnvironmentKeys, section, problems)
    if keys is None:
        _check_profiles(section, problems)
        return None
    density: float | DensityTable | None
    if isinstance(keys.density, Table):
        report = _reporter(section, "density")
        density = read_density(keys.density.columns, keys.density.rows, report, problems)
    else:
        density = keys.density
    current = _current(keys, section, problems, notices, open_files)
    if density is None or current is None:
        return None
    return Environment(name, keys.depth, density, keys.gravity, current, keys.wind)


def _current(
    keys: EnvironmentKeys,
    section: Section,
    problems: list[Problem],
    notices: list[str],
    open_files: bool,
) -> CurrentTable | None:
    current = keys.current
    report = _reporter(section, "current")
    if isinstance(current, Table):
        return read_current(current.columns, current.rows, report, problems)
    if isinstance(current, UniformCurrent):
        u, v = components(current.speed, current.toward)
        return CurrentTable((0.0,), (u,), (v,), (current.w,))
    path = Path(section.home("current").document.path).parent / current.file
    if not os.path.isfile(path):
        problems.append(report(("file",), f"`file: {shown(current.file)}`: no such file"))
        return None
    if not open_files:
        return None
    try:
        table, told = read_current_file(path, current.time, keys.depth)
    except TimeChoiceError as error:
        problems.append(report(("time",), str(error)))
    except InputError as error:
        problems.extend(error.problems)
    else:
        notices.extend(told)
        return table
    return None


def _check_profiles(section: Section, problems: list[Problem]) -> None:
    """Look into the tables although other keys are wrong, so that all mistakes are told at once."""
    for key, read in (("current", read_current), ("density", read_density)):
        try:
            table = Table.model_validate(section.data.get(key))
        except ValidationError:
            continue
        read(table.columns, table.rows, _reporter(section, key), problems)


def _reporter(section: Section, key: str) -> Report:
    return lambda location, message: section.problem((key, *location), message)
