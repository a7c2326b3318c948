"""Names, symbols, units and meanings of the quantities that CALM reports.

All outputs and the manual use this table. A second table lists the quantities that instruments
measure.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from math import atan2, ceil, degrees, floor, log10

from calm.errors import UsageError, unknown


@dataclass(frozen=True)
class Quantity:
    """A reported quantity.

    Parameters
    ----------
    name : str
        The name in results and files, e.g. ``"depth_top"``.
    heading : str
        Short title of a column or an axis, without the unit.
    unit : str
        Unit in results: an SI unit or degrees; empty for a pure number.
    meaning : str
        Meaning as one sentence, for the manual.
    decimals : int
        Number of decimals shown, in the displayed unit.
    display : str
        Usual display unit (a key of `_USUAL`), if this differs from `unit`.
    """

    name: str
    heading: str
    unit: str
    meaning: str
    decimals: int = 1
    symbol: str = ""
    display: str = ""

    @property
    def display_unit(self) -> str:
        """Display unit set by `show_in`, or the usual unit if none is set."""
        return _layout(self.unit, self.display, self.decimals)[0]

    @property
    def usual_unit(self) -> str:
        """Default display unit, which plots always use."""
        return self.display or self.unit

    @property
    def usual_scale(self) -> float:
        """Factor that converts a value from `unit` to the usual unit."""
        return _USUAL.get(self.display, 1.0)

    @property
    def scale(self) -> float:
        """Factor that converts a value from `unit` to the display unit."""
        return _layout(self.unit, self.display, self.decimals)[1]

    @property
    def header(self) -> str:
        """Name and unit as a column header of a data file, such as ``depth_top[m]``."""
        return f"{self.name}[{self.unit}]" if self.unit else self.name

    @property
    def label(self) -> str:
        """Heading and usual unit as the label of an axis, such as ``depth [m]``."""
        return f"{self.heading} [{self.usual_unit}]" if self.usual_unit else self.heading

    def format(self, value: float | None) -> str:
        """Format a value, given in `unit`, as a number in the display unit; an unknown value
        becomes a dash.

        A value that rounds to zero has no minus sign.
        """
        if value is None or value != value:
            return "-"
        _, scale, places = _layout(self.unit, self.display, self.decimals)
        return f"{value * scale:z.{places}f}"

    def say(self, value: float | None, *beside: float | None) -> str:
        """Format a value as a number with its display unit, such as ``113.2 m``.

        A force whose usual unit is kN is shown in N if the force and all values in `beside` are
        below 1 kN.
        """
        if value is None or value != value:
            return "unknown"
        number, unit = self.number_and_unit(value, *beside)
        return _with_unit(number, unit)

    def number_and_unit(self, value: float, *beside: float | None) -> tuple[str, str]:
        """Return the displayed number and the display unit of a value, as two texts.

        The value is given in `unit`. For `beside`, see `say`.
        """
        unit = self.display_unit
        if unit == "kN" and "force" not in _shown:
            largest = max(abs(one) for one in (value, *beside) if one is not None)
            if largest < 999.5:
                return f"{value:z.{2 if largest < 9.95 else 0}f}", "N"
        return self.format(value), unit

    def figure(self, value: float) -> str:
        """Format a value, given in `unit`, to four significant digits with its display unit, for
        data sheets.
        """
        return _with_unit(f"{float(f'{value * self.scale:.4g}'):.10g}", self.display_unit)


def _with_unit(text: str, unit: str) -> str:
    return f"{text}{'' if unit in ('', '°') else ' '}{unit}"


_USUAL = {
    **{"": 1.0, "°": 1.0, "mm": 1e3, "l": 1e3, "kN": 1e-3, "knot": 1.0 / (1852 / 3600)},
    "years": 1.0 / (365.25 * 86_400.0),
}
"""Factors from the unit of results to the usual unit of display."""

_TABLE = (
    Quantity("depth", "depth", "m", "Depth below the still-water surface."),
    Quantity("planned_depth", "planned", "m", "Depth planned in still water."),
    Quantity("height", "height", "m", "Height above the seabed."),
    Quantity("offset", "offset", "m", "Horizontal distance from the anchor."),
    Quantity("layback", "layback", "m", "Horizontal distance behind the tow point."),
    Quantity("x", "east", "m", "Distance east of the anchor or the tow point.", 1, "x"),
    Quantity("y", "north", "m", "Distance north of the anchor or the tow point.", 1, "y"),
    Quantity("length", "length", "m",
             "Length along the line; results give the stretched length.", 2, "L"),
    Quantity("cut_length", "cut length", "m", "Length without load.", 2),
    Quantity("tension", "tension", "N", "Tension in the line.", 0, "T"),
    Quantity("load", "load", "N", "Force on a part in the design check.", 2, "", "kN"),
    Quantity("tilt", "tilt", "deg", "Angle between the axis and the vertical.", 1, "", "°"),
    Quantity("knockdown", "knockdown", "m", "Increase of depth relative to still water."),
    Quantity("safety_factor", "safety factor", "", "Breaking load divided by the maximum tension."),
    Quantity("utilisation", "utilisation", "", "Maximum tension divided by the working load.", 2),
    Quantity("used_buoyancy", "used buoyancy", "",
             "Share of a surface float's buoyancy that is in use.", 3),
    Quantity("reserve", "reserve", "N", "Buoyancy of a surface float that is not in use.", 0),
    Quantity("draft", "draft", "m", "Immersed height of a floating hull.", 2),
    Quantity("freeboard", "freeboard", "m", "Height of a floating hull above the water.", 2),
    Quantity("vertical", "vertical pull", "N",
             "Vertical load, upward on the anchor, downward on the tow point.", 0, "V"),
    Quantity("horizontal", "horizontal pull", "N",
             "Horizontal load on the anchor or the tow point.", 0, "H"),
    Quantity("angle", "angle", "deg",
             "Angle of the load: from the vertical for an anchor, from the horizontal for a tow.",
             1, "", "°"),
    Quantity("potential", "potential", "V", (
        "Galvanic potential between two metals in sea water."
    ), 2),
    Quantity("life", "life in waves", "s", "Fatigue life in waves.", 1, "", "years"),
    Quantity("body_tension", "tension at the body", "N", "Tension at the towed body.", 0),
    Quantity("frequency", "frequency", "Hz", "Frequency at which the cable vibrates.", 2),
    Quantity("required_weight", "required weight", "N", (
        "Required weight of the anchor in water."
    ), 0),
    Quantity("scope", "scope", "", "Cut length of the line divided by the water depth.", 3),
    Quantity("grounded_length", "grounded length", "m", "Cut length that lies on the seabed."),
    Quantity("speed", "speed", "m/s", "Speed of the water, or of the ship.", 2),
    Quantity("diameter", "diameter", "m", (
        "Outside diameter; for a chain, bar diameter."
    ), 1, "", "mm"),
    Quantity("mass", "mass", "kg", "Mass in air.", 2),
    Quantity("buoyancy", "buoyancy", "N", "Net force in sea water of 1025 kg/m³, upward.", 2, "B"),
    Quantity("weight", "weight in water", "N",
             "Net force in sea water of 1025 kg/m³, downward.", 2),
    Quantity("net_buoyancy", "net force in water", "N",
             "Net force in sea water of 1025 kg/m³, positive up.", 0),
    Quantity("dry_mass", "mass in air", "kg", "Mass of a piece in air."),
    Quantity("wet_weight", "weight in water", "N", "Net force of a piece, downward.", 0),
    Quantity("lift_mass", "lifted mass", "kg", "Mass of a piece with its clamps."),
    Quantity("force", "force", "N", "Measured force.", 0),
    Quantity("at", "at", "m", "Distance of a clamp from the top of its piece.", 2),
    Quantity("volume", "volume", "m³", "Volume of water displaced.", 1, "", "l"),
    Quantity("density", "density", "kg/m³", "Density of the material.", 0),
    Quantity("stiffness", "stiffness", "N", "Tension divided by strain, EA.", 0, "EA", "kN"),
    Quantity("breaking_load", "breaking load", "N", "Load at which the part breaks.", 1, "", "kN"),
    Quantity("working_load", "working load", "N",
             "Load for which the part is designed.", 1, "", "kN"),
    Quantity("depth_rating", "depth rating", "m", "Maximum depth of use.", 0),
    Quantity("max_tilt", "maximum tilt", "deg",
             "Tilt above which the data of the part are not reliable.", 0, "", "°"),
    Quantity("warn_tilt", "warning tilt", "deg",
             "Tilt above which the data of the part should be checked.", 0, "", "°"),
    Quantity("kn", "normal drag", "N/(m/s)²",
             "Drag of the part across its axis at 1 m/s.", 2, "Kn"),
    Quantity("kt", "axial drag", "N/(m/s)²", "Drag of the part along its axis at 1 m/s.", 2, "Kt"),
    Quantity("k_surface", "drag at the surface", "N/(m/s)²", (
        "Drag of a float at the surface at 1 m/s."
    ), 2),
    Quantity("lift", "lift", "N/(m/s)²", "Lift at 1 m/s.", 2),
    Quantity("drag_area", "drag area", "m²", "Area to which the drag coefficient refers.", 4),
    Quantity("cd_area", "Cd × area", "m²", "Drag coefficient times area.", 4),
    Quantity("wind_area", "wind area", "m²", "Area exposed to the wind.", 2),
    Quantity("cx", "Cx", "", "Drag coefficient of a sphere.", 3),
    Quantity("cn", "Cn", "", "Drag coefficient across the axis.", 3),
    Quantity("ct", "Ct", "", "Drag coefficient along the axis.", 4),
    Quantity("cd", "Cd", "", "Drag coefficient.", 3),
    Quantity("wind_cd", "Cd in the wind", "", "Drag coefficient of the part in air.", 2),
    Quantity("friction", "friction", "", "Coefficient of friction on the seabed.", 2),
)  # fmt: skip

QUANTITIES = {quantity.name: quantity for quantity in _TABLE}
"""All quantities by name."""


SHOWN_UNITS = {
    "force": {"N": 1.0, "kN": 1e3, "kgf": 9.80665, "lbf": 4.4482216152605},
    "length": {"m": 1.0, "ft": 0.3048},
    "speed": {"m/s": 1.0, "cm/s": 0.01, "kn": 1852 / 3600},
    "mass": {"kg": 1.0, "lb": 0.45359237},
}
"""Allowed display units for each dimension, and their sizes relative to the unit of results, which
is first.
"""

_CHOICES = {next(iter(units)): dimension for dimension, units in SHOWN_UNITS.items()}
_shown: dict[str, str] = {}


@cache
def _layout(unit: str, display: str, decimals: int) -> tuple[str, float, int]:
    """Return the display unit of a quantity, the factor for conversion, and the number of decimals.

    The factor converts from the unit of results to the display unit. In the display unit, the
    number of decimals gives about the same resolution as `decimals` in the usual unit.
    """
    dimension, usual = _CHOICES.get(unit, ""), _USUAL.get(display, 1.0)
    chosen = "" if display and dimension != "force" else _shown.get(dimension, "")
    if not chosen:
        return display or unit, usual, decimals
    scale = 1.0 / SHOWN_UNITS[dimension][chosen]
    return chosen, scale, max(0, decimals - round(log10(0.95 * scale / usual)))


def show_in(units: Mapping[str, str]) -> None:
    """Set the display units for this process. Data files remain in SI units.

    The keys of `units` are dimensions in `SHOWN_UNITS`; other dimensions keep their usual units. A
    quantity in mm, such as a diameter, also keeps its unit.
    """
    _shown.clear()
    _layout.cache_clear()
    _shown.update({name: unit for name, unit in units.items() if unit not in _CHOICES})


def shown_units() -> dict[str, str]:
    """Return the display units set by `show_in`, by dimension."""
    return dict(_shown)


def say(name: str, value: float | None) -> str:
    """Format a value of a named quantity with its unit for a sentence, such as ``113.2 m``."""
    return QUANTITIES[name].say(value)


def rounded(value: float, digits: int, *, up: bool) -> float:
    """Round a value up or down to a number of significant digits."""
    if value == 0.0:
        return 0.0
    step = 10.0 ** (floor(log10(abs(value))) - digits + 1)
    return float(f"{step * (ceil if up else floor)(value / step):.12g}")


def bearing_of(east: float, north: float) -> float:
    """Return the direction of a vector, measured clockwise from north, 0 to 360 [degrees]."""
    return degrees(atan2(east, north)) % 360.0


def bearing_text(bearing: float) -> str:
    """Format a direction [degrees] with three digits: ``068°``."""
    return f"{round(bearing) % 360:03d}°"


def duration(seconds: float) -> str:
    """Format a time [s] in seconds, minutes or hours."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60:02d} min"


@dataclass(frozen=True)
class MeasuredQuantity:
    """A quantity that moored instruments measure and that can be interpolated to fixed levels.

    Attributes
    ----------
    archive : name in OceanSITES files
    standard_name, long_name, units : attributes of the variable in files written by CALM
    dimension : dimension of the unit, as in `calm.units`
    sought, usual : CF standard names, and common variable names, in input files
    noise : default standard deviation of the error of a good sensor
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
    "temperature": MeasuredQuantity(
        "TEMP", "sea_water_temperature", "temperature of the sea water", "degree_Celsius",
        "temperature", ("sea_water_temperature",),
        ("TEMP", "temperature", "temp", "Temperature"), 0.002,
    ),
    "salinity": MeasuredQuantity(
        "PSAL", "sea_water_practical_salinity", "practical salinity", "1", "salinity",
        ("sea_water_practical_salinity", "sea_water_salinity"),
        ("PSAL", "salinity", "psal", "Salinity"), 0.003,
    ),
    "u": MeasuredQuantity(
        "UCUR", "eastward_sea_water_velocity", "velocity of the water to the east", "m s-1",
        "speed", ("eastward_sea_water_velocity",), (), 0.01,
    ),
    "v": MeasuredQuantity(
        "VCUR", "northward_sea_water_velocity", "velocity of the water to the north", "m s-1",
        "speed", ("northward_sea_water_velocity",), (), 0.01,
    ),
}  # fmt: skip
"""Measured quantities by their names in commands; `noise` is the usual accuracy stated by
manufacturers.
"""


def chosen_quantities(text: str | None) -> tuple[str, ...]:
    """Split a text such as ``temperature,salinity`` into names; None selects all quantities.

    The names used in OceanSITES files are also accepted. Raises UsageError if a name is unknown.
    """
    archived = {one.archive: name for name, one in QUANTITIES_MEASURED.items()}
    wanted = [part.strip() for part in (text or ",".join(QUANTITIES_MEASURED)).split(",")]
    for name in wanted:
        if name not in QUANTITIES_MEASURED and name not in archived:
            known = (*QUANTITIES_MEASURED, *archived)
            raise UsageError(unknown(f"--variables: `{name}` cannot be gridded", name, known))
    return tuple(dict.fromkeys(archived.get(name, name) for name in wanted))
