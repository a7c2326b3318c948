"""The quantities CALM reports: one table of names, symbols, units and meanings.

Table headings, CSV headers, plot labels and the manual all read it, so that a quantity is called
the same and carries the same unit wherever it is shown. A second one has what instruments measure.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from math import atan2, ceil, degrees, floor, log10

from calm.errors import UsageError, unknown


@dataclass(frozen=True)
class Quantity:
    """One reported quantity.

    Parameters
    ----------
    name : str
        The name in results and files, e.g. ``"depth_top"``.
    heading : str
        Short title of a column or an axis, without the unit.
    unit : str
        Unit of the number in results (SI, and degrees); empty for a pure number.
    meaning : str
        One sentence for the manual.
    decimals : int
        Digits after the point, in the unit displayed, that mean something to a reader.
    symbol : str
        The letter of formulas, where there is one.
    display : str
        The unit people usually read, where it is another: a key of `_USUAL`.
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
        """The unit people read: that chosen by `show_in`, else the usual one."""
        return _layout(self.unit, self.display, self.decimals)[0]

    @property
    def usual_unit(self) -> str:
        """The unit people read where they choose none, and that of pictures."""
        return self.display or self.unit

    @property
    def usual_scale(self) -> float:
        """Return how many of the usual unit make one `unit`."""
        return _USUAL.get(self.display, 1.0)

    @property
    def scale(self) -> float:
        """Return how many of the unit displayed make one `unit`."""
        return _layout(self.unit, self.display, self.decimals)[1]

    @property
    def header(self) -> str:
        """Name and unit as the head of a column that programs read, e.g. ``depth_top[m]``."""
        return f"{self.name}[{self.unit}]" if self.unit else self.name

    @property
    def label(self) -> str:
        """Title and usual unit as the label of an axis, e.g. ``depth [m]``."""
        return f"{self.heading} [{self.usual_unit}]" if self.usual_unit else self.heading

    def format(self, value: float | None) -> str:
        """Digits of a value [`unit`] in the unit displayed; a dash when unknown.

        A value that rounds to nothing never shows a minus sign.
        """
        if value is None or value != value:
            return "-"
        _, scale, places = _layout(self.unit, self.display, self.decimals)
        return f"{value * scale:z.{places}f}"

    def say(self, value: float | None) -> str:
        """A value [`unit`] with the unit displayed, for a sentence, e.g. ``113.2 m``."""
        if value is None or value != value:
            return "unknown"
        return self._with_unit(self.format(value))

    def figure(self, value: float) -> str:
        """A value [`unit`] to four significant digits with the unit displayed, for data sheets."""
        return self._with_unit(f"{float(f'{value * self.scale:.4g}'):.10g}")

    def _with_unit(self, text: str) -> str:
        unit = self.display_unit
        return f"{text}{'' if unit in ('', '°') else ' '}{unit}"


_USUAL = {
    **{"": 1.0, "°": 1.0, "mm": 1e3, "l": 1e3, "kN": 1e-3, "knot": 1.0 / (1852 / 3600)},
    "years": 1.0 / (365.25 * 86_400.0),
}
"""How many of a unit that people usually read make one of that of results."""

_TABLE = (
    Quantity("depth", "depth", "m", "Depth below the still-water surface."),
    Quantity("planned_depth", "planned", "m", "Depth planned in still water."),
    Quantity("height", "height", "m", "Height above the seabed."),
    Quantity("offset", "offset", "m", "Horizontal distance from the anchor."),
    Quantity("layback", "layback", "m", "Horizontal distance behind the tow point."),
    Quantity("x", "east", "m", "Distance east of the anchor or the tow point.", 1, "x"),
    Quantity("y", "north", "m", "Distance north of the anchor or the tow point.", 1, "y"),
    Quantity("length", "length", "m",
             "Length along the line; in results, as stretched by its load.", 2, "L"),
    Quantity("cut_length", "cut length", "m", "Length before any load.", 2),
    Quantity("tension", "tension", "N", "Pull in the line.", 0, "T"),
    Quantity("tilt", "tilt", "deg", "Angle of the axis from the vertical, 0 upright.", 1, "", "°"),
    Quantity("knockdown", "knockdown", "m", "How much deeper than in still water."),
    Quantity("safety_factor", "safety factor", "", "Breaking load over the greatest tension."),
    Quantity("utilisation", "utilisation", "", "Greatest tension over the working load.", 2),
    Quantity("used_buoyancy", "used buoyancy", "",
             "Share of the buoyancy of a float at the surface that is in use.", 3),
    Quantity("reserve", "reserve", "N", "Buoyancy of the surface float that is not in use.", 0),
    Quantity("draft", "draft", "m", "How deep a floating hull is immersed.", 2),
    Quantity("freeboard", "freeboard", "m", "How far a floating hull stands out.", 2),
    Quantity("vertical", "vertical pull", "N",
             "Upward pull on the anchor, downward pull on the tow point.", 0, "V"),
    Quantity("horizontal", "horizontal pull", "N",
             "Sideways pull on the anchor or the tow point.", 0, "H"),
    Quantity("angle", "angle", "deg",
             "Angle of the pull: on an anchor from the vertical, in a tow from the horizontal.",
             1, "", "°"),
    Quantity("potential", "potential", "V", "Difference of two metals in sea water.", 2),
    Quantity("life", "life in waves", "s", "Until fatigue in waves breaks it.", 1, "", "years"),
    Quantity("body_tension", "tension at the body", "N", "Pull on the towed body.", 0),
    Quantity("frequency", "frequency", "Hz", "Frequency at which the cable vibrates.", 2),
    Quantity("required_weight", "required weight", "N", "Weight in water the anchor needs.", 0),
    Quantity("scope", "scope", "", "Cut length of the line over the water depth.", 3),
    Quantity("grounded_length", "grounded length", "m", "Cut length that lies on the seabed."),
    Quantity("speed", "speed", "m/s", "Speed of the water, or of the ship.", 2),
    Quantity("diameter", "diameter", "m", "Outside diameter; of a chain, its bar.", 1, "", "mm"),
    Quantity("mass", "mass", "kg", "Mass in air.", 2),
    Quantity("buoyancy", "buoyancy", "N", "Net force in sea water of 1025 kg/m³, upward.", 2, "B"),
    Quantity("weight", "weight in water", "N",
             "Net force in sea water of 1025 kg/m³, downward.", 2),
    Quantity("net_buoyancy", "net force in water", "N",
             "Net force in sea water of 1025 kg/m³, upward, by weight or by mass and volume.", 0),
    Quantity("dry_mass", "mass in air", "kg", "Mass of a piece as it lies on the deck."),
    Quantity("wet_weight", "weight in water", "N", "Net force of a piece, downward.", 0),
    Quantity("lift_mass", "mass of the lift", "kg", "Mass of a piece with its clamps."),
    Quantity("force", "force", "N", "Force measured.", 0),
    Quantity("at", "at", "m", "Where a clamp sits, from the top of its piece.", 2),
    Quantity("volume", "volume", "m³", "Volume of water displaced.", 1, "", "l"),
    Quantity("density", "density", "kg/m³", "Density of the material.", 0),
    Quantity("stiffness", "stiffness", "N", "Pull over strain, EA.", 0, "EA", "kN"),
    Quantity("breaking_load", "breaking load", "N", "Load at which it breaks.", 1, "", "kN"),
    Quantity("working_load", "working load", "N", "Load it is made for.", 1, "", "kN"),
    Quantity("depth_rating", "depth rating", "m", "Greatest depth it stands.", 0),
    Quantity("max_tilt", "greatest tilt", "deg",
             "Tilt beyond which it is not to be trusted.", 0, "", "°"),
    Quantity("warn_tilt", "tilt of warning", "deg",
             "Tilt from which its data need a look.", 0, "", "°"),
    Quantity("kn", "normal drag", "N/(m/s)²", "Drag across its axis at 1 m/s.", 2, "Kn"),
    Quantity("kt", "axial drag", "N/(m/s)²", "Drag along its axis at 1 m/s.", 2, "Kt"),
    Quantity("k_surface", "drag afloat", "N/(m/s)²", "Drag at 1 m/s when it floats.", 2),
    Quantity("lift", "lift", "N/(m/s)²", "Lift at 1 m/s.", 2),
    Quantity("drag_area", "drag area", "m²", "Area to which its drag coefficient belongs.", 4),
    Quantity("cd_area", "Cd × area", "m²", "Drag coefficient times area.", 4),
    Quantity("wind_area", "wind area", "m²", "Area on which the wind blows.", 2),
    Quantity("cx", "Cx", "", "Drag coefficient of a sphere.", 3),
    Quantity("cn", "Cn", "", "Drag coefficient across the axis.", 3),
    Quantity("ct", "Ct", "", "Drag coefficient along the axis.", 4),
    Quantity("cd", "Cd", "", "Drag coefficient.", 3),
    Quantity("wind_cd", "Cd in the wind", "", "Drag coefficient of the part in the air.", 2),
    Quantity("friction", "friction", "", "Coefficient of friction on the seabed.", 2),
)  # fmt: skip

QUANTITIES = {quantity.name: quantity for quantity in _TABLE}
"""Every quantity by its name."""


SHOWN_UNITS = {
    "force": {"N": 1.0, "kN": 1e3, "kgf": 9.80665, "lbf": 4.4482216152605},
    "length": {"m": 1.0, "ft": 0.3048},
    "speed": {"m/s": 1.0, "cm/s": 0.01, "kn": 1852 / 3600},
    "mass": {"kg": 1.0, "lb": 0.45359237},
}
"""The units in which people may have each dimension shown, and how many of the first they are;
that is the unit of results."""

_CHOICES = {next(iter(units)): dimension for dimension, units in SHOWN_UNITS.items()}
_shown: dict[str, str] = {}


@cache
def _layout(unit: str, display: str, decimals: int) -> tuple[str, float, int]:
    """Return the unit that people read, how many of it make one of results, and digits.

    What has a small unit of its own keeps it; a unit that is chosen has digits that mean as much as
    the usual ones, feet as many as metres.
    """
    dimension, usual = _CHOICES.get(unit, ""), _USUAL.get(display, 1.0)
    chosen = "" if display and dimension != "force" else _shown.get(dimension, "")
    if not chosen:
        return display or unit, usual, decimals
    scale = 1.0 / SHOWN_UNITS[dimension][chosen]
    return chosen, scale, max(0, decimals - round(log10(0.95 * scale / usual)))


def show_in(units: Mapping[str, str]) -> None:
    """Show quantities to people in these units from now on, in this process.

    Files for programs stay in SI. Quantities with a small unit of their own (diameters in mm) keep
    that.

    Parameters
    ----------
    units : by dimension of `SHOWN_UNITS`, one of its units; what is not named is shown as usual
    """
    _shown.clear()
    _layout.cache_clear()
    _shown.update({name: unit for name, unit in units.items() if unit not in _CHOICES})


def shown_units() -> dict[str, str]:
    """The units chosen by `show_in`, where they are not the usual ones."""
    return dict(_shown)


def say(name: str, value: float | None) -> str:
    """A value of a quantity with its unit, for a sentence, e.g. ``113.2 m``."""
    return QUANTITIES[name].say(value)


def rounded(value: float, digits: int, *, up: bool) -> float:
    """A value of so many digits that is not less, or not more, than another."""
    if value == 0.0:
        return 0.0
    step = 10.0 ** (floor(log10(abs(value))) - digits + 1)
    return float(f"{step * (ceil if up else floor)(value / step):.12g}")


def bearing_of(east: float, north: float) -> float:
    """Direction of a vector [degrees] clockwise from north, 0 to 360."""
    return degrees(atan2(east, north)) % 360.0


def bearing_text(bearing: float) -> str:
    """A direction [degrees] as people write it: ``068°``."""
    return f"{round(bearing) % 360:03d}°"


def duration(seconds: float) -> str:
    """Return a time in the unit that fits."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60:02d} min"


@dataclass(frozen=True)
class MeasuredQuantity:
    """A quantity that instruments of a mooring measure and that is put on levels.

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
