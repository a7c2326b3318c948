"""Convert text such as `12 mm` to SI numbers.

A mass is never accepted as a force: `35 kg` must be `35 kgf`. One kilogram-force is 9.80665 N at
every location. Pint converts units that are not in the table below.
"""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from calm.positions import HEMISPHERES, degrees_of

if TYPE_CHECKING:
    import pint

KILOGRAM_FORCE = 9.80665
_POUND = 0.45359237
_POUND_FORCE = _POUND * KILOGRAM_FORCE
_FOOT = 0.3048
_INCH = 0.0254
KNOT = 1852 / 3600


@dataclass(frozen=True)
class Dimension:
    """A physical dimension: its name in messages, its SI unit and its common units."""

    noun: str
    unit: str
    units: Mapping[str, float]


DIMENSIONS: Mapping[str, Dimension] = {
    "number": Dimension("a plain number", "", {"": 1.0, "%": 0.01}),
    "length": Dimension("a length", "m",
        {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "km": 1e3, "in": _INCH, "ft": _FOOT, "yd": 3 * _FOOT,
         "fathom": 6 * _FOOT, "nmi": 1852.0}),
    "speed": Dimension("a speed", "m/s",
        {"m/s": 1.0, "cm/s": 1e-2, "mm/s": 1e-3, "knot": KNOT, "km/h": 1 / 3.6, "ft/s": _FOOT}),
    "acceleration": Dimension("an acceleration", "m/s^2", {"m/s^2": 1.0, "ft/s^2": _FOOT}),
    "mass": Dimension("a mass", "kg", {"kg": 1.0, "g": 1e-3, "t": 1e3, "lb": _POUND}),
    "force": Dimension("a force", "N",
        {"N": 1.0, "kN": 1e3, "kgf": KILOGRAM_FORCE, "lbf": _POUND_FORCE, "daN": 10.0, "MN": 1e6,
         "gf": KILOGRAM_FORCE / 1e3, "tf": KILOGRAM_FORCE * 1e3}),
    "mass per length": Dimension("a mass per length", "kg/m",
        {"kg/m": 1.0, "g/m": 1e-3, "kg/km": 1e-3, "lb/ft": _POUND / _FOOT}),
    "force per length": Dimension("a force per length", "N/m",
        {"N/m": 1.0, "kN/m": 1e3, "N/km": 1e-3, "kgf/m": KILOGRAM_FORCE,
         "gf/m": KILOGRAM_FORCE / 1e3, "kgf/km": KILOGRAM_FORCE / 1e3,
         "lbf/ft": _POUND_FORCE / _FOOT}),
    "density": Dimension("a density", "kg/m^3",
        {"kg/m^3": 1.0, "g/cm^3": 1e3, "kg/L": 1e3, "t/m^3": 1e3, "lb/ft^3": _POUND / _FOOT**3}),
    "area": Dimension("an area", "m^2", {"m^2": 1.0, "cm^2": 1e-4, "mm^2": 1e-6, "ft^2": _FOOT**2}),
    "volume": Dimension("a volume", "m^3",
        {"m^3": 1.0, "L": 1e-3, "dm^3": 1e-3, "cm^3": 1e-6, "ft^3": _FOOT**3}),
    "drag": Dimension("a drag at unit speed", "N/(m/s)^2",
        {"N/(m/s)^2": 1.0, "kgf/(m/s)^2": KILOGRAM_FORCE, "lbf/(ft/s)^2": _POUND_FORCE / _FOOT**2}),
    "temperature": Dimension("a temperature", "degC", {"degC": 1.0}),
    "salinity": Dimension("a salinity (practical, such as 35, or in g/kg)", "",
        {"": 1.0, "PSU": 1.0, "psu": 1.0, "g/kg": 35 / 35.16504}),
    "pressure": Dimension("a pressure", "Pa",
        {"Pa": 1.0, "hPa": 1e2, "kPa": 1e3, "MPa": 1e6, "dbar": 1e4, "mbar": 1e2, "bar": 1e5}),
    "time": Dimension("a time", "s",
        {"s": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0, "d": 86400.0}),
    "angle": Dimension("an angle", "deg", {"deg": 1.0, "rad": 180 / math.pi}),
    "latitude": Dimension("a latitude", "deg", {"deg": 1.0}),
    "longitude": Dimension("a longitude", "deg", {"deg": 1.0}),
}  # fmt: skip
"""All dimensions by name. Angles are in degrees and temperatures in degrees Celsius. Salinities are
practical salinities; a mass fraction is converted with the factor of reference sea water (Millero
et al. 2008, Deep-Sea Research I 55, 50-72).
"""

_SPELLINGS = {
    **dict.fromkeys(("metre", "metres", "meter", "meters"), "m"),
    **dict.fromkeys(("inch", "inches"), "in"),
    **dict.fromkeys(("foot", "feet"), "ft"),
    **dict.fromkeys(("knots", "kt", "kts", "kn"), "knot"),
    **dict.fromkeys(("kilogram", "kilograms"), "kg"),
    **dict.fromkeys(("tonne", "tonnes"), "t"),
    **dict.fromkeys(("pound", "pounds", "lbs"), "lb"),
    **dict.fromkeys(("newton", "newtons"), "N"),
    **dict.fromkeys(("degree", "degrees", "°"), "deg"),
    **dict.fromkeys(("°C", "celsius"), "degC"),
    "l": "L",
    "m*s^-1": "m/s",
    "cm*s^-1": "cm/s",
    "g*kg^-1": "g/kg",
}

_MASS_AND_FORCE = {"kg": "kgf", "g": "gf", "t": "tf", "lb": "lbf", "kg/m": "kgf/m", "g/m": "gf/m"}
_MASS_AND_FORCE |= {"kg/km": "kgf/km", "lb/ft": "lbf/ft"}
_TWINS = _MASS_AND_FORCE | {force: mass for mass, force in _MASS_AND_FORCE.items()}

_FATHOM = ("is ambiguous; write `fathom` for a fathom", "fathom")
_TON = ("may mean 907, 1000 or 1016 kg; write `t` for a tonne, or `tf` for its weight", None)
_MILE = ("may mean 1609 or 1852 m; write `mi` or `nmi`", None)
_MISTAKEN: Mapping[str, tuple[str, str | None]] = {
    "nm": ("is in nanometres; a nautical mile is `nmi`", "nmi"),
    **dict.fromkeys(("fm", "fth"), _FATHOM),
    **dict.fromkeys(("ton", "tons", "ton_force"), _TON),
    **dict.fromkeys(("mile", "miles"), _MILE),
    "mt": ("is in thousandths of a tonne; a metric ton is `t`", "t"),
    "Mt": ("is in millions of tonnes; a metric ton is `t`", "t"),
}
"""Units known to pint that are mistakes in a mooring file, with a message and the unit probably
meant.
"""

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,4}(?![\d.]))?")
_FRACTION = re.compile(r"([+-]?)(?:(\d+)\s+)?(\d+)\s*/\s*(\d+)(?![\d.])")
_COMMA = re.compile(r"([+-]?\d+),(\d+)(?=$|[^\d,.])")
_THOUSANDS = re.compile(  # `1,250,000`, `1 250`, `1,250.0` and `1.250,0`
    r"([+-]?\d{1,3}(?:(?:[ '’\u00a0\u202f]\d{3})+"
    r"|([,.])\d{3}(?:\2\d{3})+|(?:,\d{3})+(?=\.\d)|(?:\.\d{3})+(?=,\d)))"
    r"(?:[.,](\d+))?(?![\d.,])"
)
# a word must end here: otherwise the number of ways to split a text doubles with each letter
_UNIT = re.compile(r"(?:[A-Za-zµ°%][A-Za-z_µ°%]*(?![A-Za-z_µ°%])|[*/()]|\^-?[1-4](?!\d)|1(?=/))+")
_SUPERSCRIPTS = str.maketrans("⁻¹²³⁴", "-1234")
_LONGEST = 60
_LARGEST = 1e30  # limit that keeps products of a few values finite


_POINTS = (
    *("N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE"),
    *("S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW"),
)
_COMPASS = {name: 22.5 * number for number, name in enumerate(_POINTS)}
_COMPASS |= {"NORTH": 0.0, "EAST": 90.0, "SOUTH": 180.0, "WEST": 270.0}
"""Compass points and their angles [deg], suggested in messages."""


class QuantityError(ValueError):
    """A text is not a valid quantity of the required dimension.

    Attributes
    ----------
    complaint : str
        The fault, worded to follow the invalid text, such as "needs a unit".
    suggestion : str or None
        The corrected text, if known.
    is_other : bool
        Whether the text is a quantity of another dimension.
    """

    def __init__(
        self, complaint: str, suggestion: str | None = None, *, is_other: bool = False
    ) -> None:
        self.complaint = complaint
        self.suggestion = suggestion
        self.is_other = is_other
        super().__init__(f"{complaint}: `{suggestion}`?" if suggestion else complaint)


def parse_quantity(text: object, dimension: str, *, usual_unit: str | None = None) -> float:
    """Parse a number with its unit, and return the value in SI units, degrees or degC.

    Parameters
    ----------
    text : str or float
        A text such as ``"12 mm"``, ``"1/2 in"`` or ``"1.5e3 N"``. Zero, and values of the dimension
        ``number``, need no unit. For latitudes and longitudes, see `calm.positions`.
    dimension : str
        A key of `DIMENSIONS`.
    usual_unit : str, optional
        The unit to suggest if the text has no unit; by default the SI unit.

    Raises
    ------
    QuantityError
        The text is not a finite number with a unit of this dimension.
    """
    if isinstance(text, bool) or not isinstance(text, (str, int, float)):
        raise QuantityError(f"is not {_described(DIMENSIONS[dimension])}")
    return _parse_stripped(str(text).strip(), dimension, usual_unit)


@functools.lru_cache(maxsize=4096)
def _parse_stripped(text: str, dimension: str, usual_unit: str | None) -> float:
    wanted = DIMENSIONS[dimension]
    if dimension in HEMISPHERES:
        try:
            placed = degrees_of(text, dimension)
        except ValueError as error:
            raise QuantityError(str(error)) from None
        if placed is not None:
            return placed
    number, unit = _split_number_and_unit(text, wanted)
    if unit:
        try:
            value = number * unit_factor(unit, dimension)
        except QuantityError as error:
            if error.suggestion is None:
                raise
            corrected = text.removesuffix(unit) + error.suggestion
            if error.is_other and usual_unit not in (None, wanted.unit, error.suggestion):
                # kilograms, if the usual unit is kN, mean kilograms-force or are a mistaken unit
                usual = f"{text.removesuffix(unit)}{usual_unit}"
                raise QuantityError(
                    f"{error.complaint}; write `{corrected}` or `{usual}`"
                ) from None
            raise QuantityError(error.complaint, corrected) from None
    elif number == 0 or not wanted.unit:
        value = number
    else:
        raise QuantityError("needs a unit", f"{text} {usual_unit or wanted.unit}")
    if not abs(value) <= _LARGEST:
        raise QuantityError("is too large a number")
    return value


@dataclass(frozen=True)
class QuantityRange:
    """Dimension and allowed range of a quantity; the limits are in SI units or degrees."""

    dimension: str
    usual_unit: str | None = None
    above: float = -math.inf
    at_least: float = -math.inf
    at_most: float = math.inf

    def read(self, text: object) -> float:
        """Parse a number with its unit, and return the value in SI units.

        Raises
        ------
        QuantityError
            The text is not a quantity of this dimension, or the value is outside the limits.
        """
        if text is None:
            raise QuantityError("has no value")
        value = parse_quantity(text, self.dimension, usual_unit=self.usual_unit)
        unit = DIMENSIONS[self.dimension].unit
        if value <= self.above:
            raise QuantityError(f"must be more than {self.above:g} {unit}".rstrip())
        if value < self.at_least:
            raise QuantityError(f"must be at least {self.at_least:g} {unit}".rstrip())
        if value > self.at_most:
            raise QuantityError(f"must be at most {self.at_most:g} {unit}".rstrip())
        return value


def with_unit(value: float, unit: str) -> str:
    """Format a value to six significant digits with its unit."""
    return f"{value:.6g} {unit}".rstrip()


@functools.lru_cache(maxsize=1024)
def unit_factor(text: str, dimension: str) -> float:
    """Return the factor that converts a unit to the SI unit, to degrees or to degC.

    Raises
    ------
    QuantityError
        The unit is unknown or has another dimension; `suggestion` is a valid unit or None.
    """
    wanted = DIMENSIONS[dimension]
    unit = _tidy(text)
    if unit in wanted.units:
        return wanted.units[unit]
    for other in DIMENSIONS.values():
        if unit in other.units:
            twin = _TWINS.get(unit)
            raise QuantityError(
                f"is {other.noun}; {_described(wanted)} is needed",
                twin if twin in wanted.units else None,
                is_other=True,
            )
    words = re.findall(r"[A-Za-z_]+", unit)
    for word, (complaint, meant) in _MISTAKEN.items():
        if word in words:
            offer = re.sub(rf"\b{word}\b", meant, unit) if meant else None
            raise QuantityError(complaint, offer)
    if wanted.unit == "degC":
        # Other scales have other zeros, which no factor can express.
        raise QuantityError("is not a temperature in degC", "degC" if unit == "C" else None)
    if dimension == "salinity":
        # Pint converts any ratio to a plain number, which would pass for a practical salinity.
        raise QuantityError(f"is not {_described(wanted)}")
    if len(unit) > _LONGEST or not _UNIT.fullmatch(unit):
        raise QuantityError(f"cannot be read; {_described(wanted)} is needed")
    return _factor_by_pint(unit, wanted)


def unit_line(text: str, wanted: str) -> tuple[float, float]:
    """Return the factor and offset that convert a value x to another unit: ``factor * x + offset``.

    `text` is the unit of x, such as ``"K"`` or ``"S m-1"``. `wanted` is the name of the other unit
    in pint. Temperature scales are allowed. Raises QuantityError if the unit of x is unknown or has
    another dimension than `wanted`.
    """
    registry = _registry()
    plain = text.rpartition(",")[2].strip()  # `ITS-90, deg C`
    plain = _SCALES.get(re.sub(r"[\W_]", "", plain.lower()), _tidy(plain))
    try:
        ends = [float(registry.Quantity(x, plain).to(wanted).magnitude) for x in (0.0, 1.0)]
    except Exception:  # pint raises many types for bad units
        raise QuantityError(f"cannot be converted to {wanted}") from None
    return ends[1] - ends[0], ends[0]


_SCALES = {
    **dict.fromkeys(("degreecelsius", "degreescelsius", "celsius", "degc", "degreec", "degreesc",
                     "c"), "degC"),
    **dict.fromkeys(("degreekelvin", "degreeskelvin", "kelvin", "degk", "k"), "K"),
    **dict.fromkeys(("degreefahrenheit", "degreesfahrenheit", "fahrenheit", "degf", "f"), "degF"),
}  # fmt: skip
"""Names of temperature units, letters only, and their names in pint."""


def _split_number_and_unit(text: str, wanted: Dimension) -> tuple[float, str]:
    fraction = _FRACTION.match(text)
    if fraction:
        sign, whole, numerator, denominator = fraction.groups()
        if float(denominator) == 0:
            raise QuantityError("is divided by zero")
        size = float(whole or 0) + float(numerator) / float(denominator)
        return (-size if sign == "-" else size), text[fraction.end() :].strip()
    marked = _THOUSANDS.match(text)
    if marked:
        plain = re.sub("[^+0-9-]", "", marked[1]) + (f".{marked[3]}" if marked[3] else "")
        raise QuantityError("has separators between thousands", plain + text[marked.end() :])
    comma = _COMMA.match(text)
    if comma:
        unit = text[comma.end() :]
        if len(comma[2]) == 3 and float(comma[1]) != 0:
            choice = f"`{comma[1]}{comma[2]}{unit}` or `{comma[1]}.{comma[2]}{unit}`"
            raise QuantityError(f"has a comma; write {choice}")
        raise QuantityError("has a decimal comma", f"{comma[1]}.{comma[2]}{unit}")
    number = _NUMBER.match(text)
    if not number:
        if re.match(r"[+-]?\.?(nan|inf)", text, re.IGNORECASE):
            raise QuantityError("is not a finite number")
        bearing = _COMPASS.get(text.upper()) if wanted.unit == "deg" else None
        raise QuantityError(
            f"is not {_described(wanted)}", None if bearing is None else f"{bearing:g} deg"
        )
    return float(number[0]), text[number.end() :].strip()


def _tidy(unit: str) -> str:
    """Convert all spellings of a unit to one spelling; `m s-1`, `m.s^-1` and `m·s⁻¹` are
    examples.
    """
    unit = unit.strip().replace("**", "^").replace("·", "*")
    unit = re.sub("[⁻¹²³⁴]+", lambda power: "^" + power[0].translate(_SUPERSCRIPTS), unit)
    unit = re.sub(r"\s*([*/^()])\s*", r"\1", unit)
    unit = re.sub(r"(?<=[A-Za-z)])(?=-?[1-4](?:\W|$))", "^", unit)
    unit = re.sub(r"(?<=[A-Za-z0-9])(?:\s+|\.)(?=[A-Za-z])", "*", unit)
    return _SPELLINGS.get(unit, unit)


def _described(dimension: Dimension) -> str:
    """Return a description of valid input, such as "a length (m, mm, cm, km, in …)"."""
    units = [unit for unit in dimension.units if unit]
    listed = ", ".join(units[:6]) + (" …" if len(units) > 6 else "")
    return dimension.noun if dimension.unit == "" else f"{dimension.noun} ({listed})"


@functools.cache
def _registry() -> pint.UnitRegistry[float]:
    import pint

    return pint.UnitRegistry()


def _factor_by_pint(unit: str, wanted: Dimension) -> float:
    import difflib

    import pint

    registry = _registry()
    near = [known for known in wanted.units if known.lower() == unit.lower()]
    # Pint raises many kinds of exceptions for other units and for texts that are not units.
    try:
        quantity = registry.Quantity(1.0, registry.parse_units(unit))
        return float(quantity.to(wanted.unit).magnitude)
    except pint.DimensionalityError:
        complaint = f"is not {_described(wanted)}"
        raise QuantityError(complaint, near[0] if near else None) from None
    except Exception:
        near.extend(difflib.get_close_matches(unit, [*wanted.units, *_SPELLINGS], 1))
        complaint = f"has an unknown unit, `{unit}`; {_described(wanted)} is needed"
        raise QuantityError(complaint, near[0] if near else None) from None
