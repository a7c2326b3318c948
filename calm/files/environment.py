"""Environment of a mooring or tow: water or air, depth, currents, wind, waves and seabed."""

from __future__ import annotations

import math
import os.path
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import BeforeValidator, Discriminator, Tag

from calm.errors import InputError, shown
from calm.files import definition, water
from calm.files.definition import DENSITY, Model, QuantityField, Text, described, optional
from calm.files.wave_keys import WaveKeys, read_waves
from calm.files.yaml_document import SourceMapping, validate
from calm.physics.line import Floats
from calm.records.current_terms import DEEPEST, Terms, TimeChoiceError, too_fast
from calm.records.grids import SeabedGrid
from calm.records.profile_doubts import direction_doubts, profile_doubts
from calm.records.profile_tables import CurrentTable, DepthTable, SeaWater, components, read_current
from calm.records.sea_states import SeaState
from calm.units import QuantityError

_SPEED = QuantityField("speed", at_least=0)
_WATER_DEPTH = QuantityField("length", above=0, at_most=DEEPEST)
_MAXIMUM_SPEED = 5.0


class Position(Model):
    """The geographic position of the mooring [degrees]."""

    latitude: Annotated[float, QuantityField("latitude", at_least=-90, at_most=90)] = described(
        "latitude, north positive, or in degrees and minutes: 48 18.0 N", "48.3 deg"
    )
    longitude: Annotated[float, QuantityField("longitude", at_least=-360, at_most=360)] = described(
        "longitude, east positive, or in degrees and minutes: 5 12.0 W", "-5.2 deg"
    )


class SeabedKeys(Model):
    """A plane, sloping seabed, given by its slope and the direction of deeper water [degrees]."""

    slope: Annotated[float, QuantityField("angle", at_least=0, at_most=45)] = described(
        "from the horizontal", "3 deg"
    )
    toward: water.Toward = described(
        "direction in which the water becomes deeper, clockwise from north", "120 deg"
    )

    def at(self, east: float, north: float) -> SeabedKeys:
        """Return this seabed for another reference point; a plane has the same slope everywhere."""
        return self

    @property
    def plane(self) -> tuple[float, float]:
        """Increase in water depth per metre to the east, and per metre to the north [-]."""
        azimuth, steep = math.radians(self.toward), math.tan(math.radians(self.slope))
        return steep * math.sin(azimuth), steep * math.cos(azimuth)

    def deeper(self, places: Floats) -> Floats:
        """Return the increase in water depth from the reference point to other positions (n,) [m].

        `places` (n, 2) are the other positions east and north of the reference point [m].
        """
        deeper: Floats = places @ np.array(self.plane)
        return deeper


class SeabedFile(Model):
    """File with gridded seabed depths."""

    file: Text = described(
        "NetCDF grid over latitude and longitude, such as GEBCO or EMODnet", "gebco.nc"
    )


def _bed_form(value: object) -> str:
    return "file" if isinstance(value, dict) and "file" in value else "plane"


Seabed = SeabedKeys | SeabedGrid
SeabedGiven = Annotated[
    Annotated[SeabedKeys, Tag("plane")] | Annotated[SeabedFile, Tag("file")],
    Discriminator(_bed_form),
]


@dataclass(frozen=True)
class Environment:
    """The water or air around a line, with currents, wind, waves and seabed.

    Attributes
    ----------
    name : name of the variant or environment file in use; None for the default environment
    fluid : "water"; "air" is possible in a tow only
    depth : water depth [m]; None if unknown, in a tow only
    density : density of the fluid [kg/m³], or temperature and salinity
    gravity : gravitational acceleration [m/s²]; None if not given
    depth_range : water depth at low and at high water [m]
    maximum_speed : current speed above which the file is rejected [m/s]; infinite in a tow
    seabed : slope of the seabed; None for a level seabed
    waves : keys of `waves:` as given in the file
    seas : sea states that `waves` describes
    doubts : warnings about values that are probably wrong
    """

    name: str | None
    fluid: Literal["water", "air"]
    depth: float | None
    density: float | DepthTable | SeaWater
    gravity: float | None
    current: CurrentTable
    wind: water.Wind | None
    position: Position | None
    depth_range: tuple[float, float] | None = None
    fouling: Fouling | None = None
    maximum_speed: float = math.inf
    waves: WaveKeys | None = None
    seas: tuple[SeaState, ...] = ()
    seabed: Seabed | None = None
    doubts: tuple[str, ...] = field(default=(), compare=False, repr=False)


class Fouling(Model):
    """Biofouling of all parts above a given depth [m], with its thickness [m] and density [kg/m³].

    Biofouling without a given density is neutrally buoyant.
    """

    depth: Annotated[float, definition.POSITIVE_LENGTH] = described(
        "depth down to which the growth extends", "50 m"
    )
    thickness: Annotated[float, QuantityField("length", usual_unit="mm", above=0, at_most=1)] = (
        described("thickness of the growth on all sides, e.g. 20 mm", "20 mm")
    )
    density: Annotated[float | None, DENSITY] = optional(
        "density of the growth; by default that of the water", "1025 kg/m^3"
    )


class UniformCurrent(Model):
    """A current with the same speed [m/s] and direction [degrees] at all depths."""

    speed: Annotated[float, _SPEED] = described("speed of the water", "0.5 m/s")
    toward: water.Toward = described(
        "direction towards which the water flows, clockwise from north, e.g. 90 deg", "90 deg"
    )
    w: Annotated[float, QuantityField("speed")] = described(
        "vertical speed, positive up", "0.01 m/s", default=0.0
    )


class CurrentFile(Model):
    """A measured or modelled current at one time, in a CSV or NetCDF file.

    `declination` [degrees, positive east] is the magnetic declination, which is given if the
    directions in the file are relative to magnetic north.
    """

    file: Text = described("CSV or CF NetCDF, in the folder of the mooring file", "adcp.nc")
    time: Text | None = optional("time of the profile, e.g. 2026-03-01T06:00", "2026-03-01T06:00")
    declination: Annotated[float | None, QuantityField("angle", at_least=-180, at_most=180)] = (
        optional(
            "magnetic declination, for directions from magnetic north; east positive", "12.5 deg"
        )
    )


def _current_form(value: object) -> str:
    if not isinstance(value, dict):
        return "uniform"
    if {"file", "time", "declination"} & set(value):
        return "file"
    return "table" if {"columns", "rows"} & set(value) else "uniform"


def _water_only(value: object) -> object:
    if value == "air":
        raise QuantityError("is only for tows; a mooring must be in water")
    return value


_Levels = tuple[Annotated[float, _WATER_DEPTH], Annotated[float, _WATER_DEPTH]]


def _two_depths(value: object) -> object:
    if not isinstance(value, list | tuple) or len(value) != 2:
        raise QuantityError("must be two depths, at low and at high water: [98 m, 104 m]")
    return value


class TowEnvironmentKeys(Model):
    """Keys of `environment:` in a tow file."""

    fluid: Literal["water", "air"] = described(
        "fluid around the line; a tow may be in air", "water", default="water"
    )
    depth: Annotated[float | None, _WATER_DEPTH] = optional("water depth, e.g. 1100 m", "1100 m")
    density: water.Density = described(
        "density of the water: a number, a table, or temperature and salinity",
        "1025 kg/m^3",
        default=water.USUAL_DENSITY["water"],
    )
    gravity: Annotated[float | None, QuantityField("acceleration", at_least=9.7, at_most=10)] = (
        optional("acceleration of gravity", "9.81 m/s^2")
    )
    current: Annotated[
        Annotated[water.TableKeys, Tag("table")]
        | Annotated[CurrentFile, Tag("file")]
        | Annotated[UniformCurrent, Tag("uniform")],
        Discriminator(_current_form),
    ] = described(
        "current: a table, one speed for all depths, or a file",
        {"speed": "0.5 m/s", "toward": "90 deg"},
        default=UniformCurrent.model_construct(speed=0.0, toward=0.0, w=0.0),
    )
    wind: water.Wind | None = optional(
        "wind over the water", {"speed": "12 m/s", "toward": "90 deg"}
    )


class EnvironmentKeys(TowEnvironmentKeys):
    """Keys of `environment:` in a mooring file, in which the water depth is required."""

    fluid: Annotated[Literal["water"], BeforeValidator(_water_only)] = described(
        "fluid around the line; a tow may be in air", "water", default="water"
    )
    depth: Annotated[float, _WATER_DEPTH] = described("water depth, e.g. 1100 m", "1100 m")
    maximum_speed: Annotated[float, QuantityField("speed", above=0)] = described(
        "current speed above which the file is rejected", "3 m/s", default=_MAXIMUM_SPEED
    )
    depth_range: Annotated[_Levels | None, BeforeValidator(_two_depths)] = optional(
        "water depth at low and at high water, e.g. [98 m, 104 m]", ["98 m", "104 m"]
    )
    fouling: Fouling | None = optional(
        "biofouling from the surface downwards, for the design check",
        {"depth": "50 m", "thickness": "20 mm"},
    )
    seabed: SeabedGiven | None = optional(
        "slope of the seabed below the anchors", {"slope": "3 deg", "toward": "120 deg"}
    )
    waves: WaveKeys | None = optional(
        "one sea state, or a table of sea states, for the design check",
        {"significant_height": "5 m", "peak_period": "8.4 s"},
    )


def read_environment(
    section: SourceMapping,
    name: str | None,
    notices: list[str],
    *,
    towed: bool = False,
    position: Position | None = None,
    open_files: bool = True,
) -> Environment | None:
    """Read an environment from a section of a file; return None if the section has mistakes.

    Parameters
    ----------
    name : name of the variant or environment file; None for the default environment
    notices : list to which remarks are added
    towed : whether air, or an unknown water depth, is allowed
    position : position used to select a current profile and to place a seabed grid
    open_files : whether to read other files; if False, an environment with a current file is only
        checked, and the result is None
    """
    keys = validate(TowEnvironmentKeys if towed else EnvironmentKeys, section)
    if keys is None:
        _check_tables(section)  # so that all mistakes are reported together
        return None
    before = len(section.problems)
    moored = keys if isinstance(keys, EnvironmentKeys) else None
    given = keys.density if "density" in keys.model_fields_set else water.USUAL_DENSITY[keys.fluid]
    density = water.read_density(given, keys.fluid, section)
    if isinstance(density, SeaWater) and keys.fluid == "air":
        section.refuse(
            ("density",), "temperature and salinity are for sea water; remove them for a tow in air"
        )
    _check_wind(keys, section)
    if moored and open_files:  # otherwise the depth may be in another section
        _check_depth_range(moored, section)
    where = None if position is None else (position.latitude, position.longitude)
    terms = Terms(
        water_depth=math.inf if keys.depth is None else keys.depth,
        place=where,
        maximum_speed=moored.maximum_speed if moored else math.inf,
    )
    current = _current(keys.current, terms, section, notices, open_files)
    seas = read_waves(moored.waves, section, open_files) if moored and moored.waves else ()
    seabed = None
    if moored and open_files:
        seabed = _seabed(moored.seabed, where, moored.depth, section, notices)
    if density is None or current is None or len(section.problems) > before:
        return None
    doubts: list[str] = []
    if keys.fluid == "water":
        doubts += _current_doubts(current, keys.depth)
        doubts += water.density_doubts(density, keys.depth)
        doubts += _wind_doubts(keys.wind)
    doubts += _tide_doubts(moored.depth_range) if moored and moored.depth_range else ()
    notices.extend(doubts)
    if isinstance(density, SeaWater) and position is None:
        notices.append(
            "Without a `position`, the density is computed from temperature and salinity for 45 "
            "degrees of latitude and the reference composition of sea water."
        )
    found = {"name": name, "density": density, "current": current, "position": position}
    more = {"seas": seas, "seabed": seabed, "doubts": tuple(doubts)}
    return Environment(**dict(keys) | found | more)


GREATEST_TIDE = 20.0
"""Largest plausible tidal range [m]: 17 m in Ungava Bay and the Bay of Fundy, plus a surge."""

STRONGEST_WIND = 75.0
"""Strongest 1 min mean wind measured at sea, rounded [m/s]."""


def _current_doubts(current: CurrentTable, depth: float | None) -> list[str]:
    if current.record is not None:  # the record reports its own remarks
        return []
    levels, u, v = (np.array(each) for each in (current.depth, current.u, current.v))
    water_depth = math.inf if depth is None else depth
    found = (*current.doubts, *profile_doubts(levels, u, v, water_depth))
    return [f"{doubt[0].upper()}{doubt[1:]}" + "." * (doubt[-1] != "?") for doubt in found]


def _wind_doubts(wind: water.Wind | None) -> list[str]:
    if wind is None or wind.speed <= STRONGEST_WIND:
        return []
    return [
        f"The wind of {wind.speed:g} m/s is stronger than any at sea: were km/h or knots meant?"
    ]


def _tide_doubts(levels: tuple[float, float]) -> list[str]:
    if (between := levels[1] - levels[0]) <= GREATEST_TIDE:
        return []
    return [
        f"`depth_range` spans {between:g} m, but the largest tides are 17 m: are these the depths "
        "at low and at high water, and is the unit right?"
    ]


def _seabed(
    given: SeabedKeys | SeabedFile | None,
    where: tuple[float, float] | None,
    depth: float | None,
    section: SourceMapping,
    notices: list[str],
) -> Seabed | None:
    """Return the seabed; a depth grid is read over the area that the mooring may reach.

    `where` is latitude and longitude [degrees]; `depth` is the water depth [m].
    """
    if not isinstance(given, SeabedFile):
        return given
    path, key = Path(section.home("seabed").document.path).parent / given.file, ("seabed", "file")
    if not path.is_file():
        section.refuse(key, f"`file: {shown(given.file)}`: no such file")
    elif where is None:
        section.refuse(key, "a grid needs the `position` of the mooring")
    elif depth is not None:
        try:
            grid = SeabedGrid.of_file(path, *where, 2000.0 + 3.0 * depth)
            if not 0.5 < grid.depth / depth < 2.0:
                notices.append(
                    f"The seabed of {given.file} is {grid.depth:.4g} m deep at the position of the "
                    f"mooring, but `depth` is {depth:.4g} m: check the unit and the position."
                )
            return grid
        except InputError as error:
            section.problems.extend(error.problems)
    return None


def _check_depth_range(keys: EnvironmentKeys, section: SourceMapping) -> None:
    depth, (low, high) = keys.depth, keys.depth_range or (keys.depth, keys.depth)
    if not low <= depth <= high:
        message = (
            f"`depth_range` must be the depths at low and at high water, with `depth`, {depth:g} "
            f"m, between them, e.g. [{depth - 2:g} m, {depth + 2:g} m]"
        )
        section.refuse(("depth_range",), message, key=True)


def _check_wind(keys: TowEnvironmentKeys, section: SourceMapping) -> None:
    if keys.wind is None:
        return
    if keys.fluid == "air":
        message = "a tow in air must not have a `wind`; set its wind as the `current`"
        section.refuse(("wind",), message, key=True)
    elif keys.wind.surface_drift and keys.wind.drift_depth is None and keys.depth is None:
        message = "`surface_drift` needs `drift_depth`, as `depth` is not given"
        section.refuse(("wind", "surface_drift"), message, key=True)


def _current(
    current: water.TableKeys | CurrentFile | UniformCurrent,
    terms: Terms,
    section: SourceMapping,
    notices: list[str],
    open_files: bool,
) -> CurrentTable | None:
    if isinstance(current, water.TableKeys):
        of_any_depth = Terms(maximum_speed=terms.maximum_speed)
        return read_current(water.quantity_table(current, section, "current"), of_any_depth)
    if isinstance(current, UniformCurrent):
        u, v = components(current.speed, current.toward)
        if reason := too_fast(u, v, current.w, terms.maximum_speed):
            section.refuse(("current", "speed"), reason)
            return None
        doubts = direction_doubts([current.toward] if current.speed else [], "toward")
        return CurrentTable((0.0,), (u,), (v,), (current.w,), doubts=tuple(doubts))
    path = Path(section.home("current").document.path).parent / current.file
    if not (os.path.isfile(path) or os.path.isdir(path)):
        section.refuse(("current", "file"), f"`file: {shown(current.file)}`: no such file")
        return None
    if not open_files:
        return None
    terms = replace(terms, declination=current.declination)
    try:
        from calm.records.current_file import read_current_file

        table, remarks = read_current_file(path, current.time, terms)
    except TimeChoiceError as error:
        section.refuse(("current", "time"), str(error))
    except InputError as error:
        section.problems.extend(error.problems)
    else:
        notices.extend(remarks)
        return table
    return None


def _check_tables(section: SourceMapping) -> None:
    water.check_density(section)
    table = water.table_of(section.data.get("current"))
    if table is not None:
        read_current(water.quantity_table(table, section, "current"))
