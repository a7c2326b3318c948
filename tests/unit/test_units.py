import math
import subprocess
import sys

import pint
import pytest

from calm import units
from calm.units import DIMENSIONS, QuantityError, parse_quantity, unit_factor

REGISTRY = pint.UnitRegistry()
TABLE = [
    (dimension, unit)
    for dimension, kind in DIMENSIONS.items()
    for unit in kind.units
    if unit and dimension != "salinity"  # of which pint knows nothing
]


OTHERWISE = {"fathom": (2.0, "yard")}
"""What pint has of the US survey foot; charts are in international feet."""


@pytest.mark.parametrize(("dimension", "unit"), TABLE)
def test_table_agrees_with_pint(dimension: str, unit: str) -> None:
    one = REGISTRY.Quantity(*OTHERWISE.get(unit, (1.0, unit)))
    expected = one.to(DIMENSIONS[dimension].unit).magnitude
    # pint reaches its factors through chains of definitions: a few rounding errors.
    assert unit_factor(unit, dimension) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("12 mm", "length", 0.012),
        ("12mm", "length", 0.012),
        (" 1.25  m ", "length", 1.25),
        ("1/2 in", "length", 0.0127),
        ("1 1/2 in", "length", 0.0381),
        ("-3 m", "length", -3.0),
        ("1e3 m", "length", 1000.0),
        (".5 m", "length", 0.5),
        ("5. m", "length", 5.0),
        ("3 metres", "length", 3.0),
        ("1.5 knot", "speed", 1.5 * 1852 / 3600),
        ("2 kt", "speed", 2 * 1852 / 3600),
        ("35 kgf", "force", 343.23275),
        ("10 lbf", "force", 44.482216152605),
        ("0.22 kgf/m", "force per length", 2.157463),
        ("1025 kg/m^3", "density", 1025.0),
        ("1025 kg/m3", "density", 1025.0),
        ("1025 kg m-3", "density", 1025.0),
        ("1025 kg·m⁻³", "density", 1025.0),
        ("1025 kg/m³", "density", 1025.0),
        ("1025 kg/m**3", "density", 1025.0),
        ("26.4 N/(m/s)^2", "drag", 26.4),
        ("2.69 kgf/(m/s)^2", "drag", 26.3798885),
        ("4 MN", "force", 4e6),
        ("2 t", "mass", 2000.0),
        ("30 deg", "angle", 30.0),
        ("30°", "angle", 30.0),
        ("1 rad", "angle", 180 / math.pi),
        ("-1.5 °C", "temperature", -1.5),
        ("10 degC", "temperature", 10.0),
        ("35", "salinity", 35.0),
        (34.7, "salinity", 34.7),
        ("35 psu", "salinity", 35.0),
        ("35.16504 g/kg", "salinity", 35.0),
        ("35.16504 g kg-1", "salinity", 35.0),
        ("0.5", "number", 0.5),
        ("1/4", "number", 0.25),
        ("10 %", "number", 0.1),
        (0.5, "number", 0.5),
        ("0", "force", 0.0),
        (0, "length", 0.0),
        ("0.0", "speed", 0.0),
    ],
)
def test_quantities(text: object, dimension: str, value: float) -> None:
    assert parse_quantity(text, dimension) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("2 furlong", "length", 402.336),
        ("10 dyn", "force", 1e-4),
        ("5 N*s^2/m^2", "drag", 5.0),
        ("3 kip", "force", 13344.6648),
        ("1 meter second^-1", "speed", 1.0),
        ("2 slug/ft^3", "density", 1030.7576),
    ],
)
def test_other_units_are_asked_of_pint(text: str, dimension: str, value: float) -> None:
    # Expected figures are rounded to eight digits; a US survey foot differs in the sixth.
    assert parse_quantity(text, dimension) == pytest.approx(value, rel=1e-5)


@pytest.mark.parametrize(
    ("text", "dimension", "complaint", "suggestion"),
    [
        ("1000", "length", "needs a unit", "1000 m"),
        (1000, "length", "needs a unit", "1000 m"),
        ("30", "angle", "needs a unit", "30 deg"),
        ("35 kg", "force", "is a mass; a force (N, kN,", "35 kgf"),
        ("77 lb", "force", "is a mass; a force", "77 lbf"),
        ("0.22 kg/m", "force per length", "is a mass per length", "0.22 kgf/m"),
        ("35 kgf", "mass", "is a force; a mass", "35 kg"),
        ("35 N", "mass", "is a force; a mass", None),
        ("35 m", "mass", "is a length; a mass", None),
        ("26 kg/m", "drag", "is a mass per length; a drag", None),
        ("5 N/(m/s)^2", "mass per length", "is a drag at unit speed", None),
        ("0,8 m/s", "speed", "has a decimal comma", "0.8 m/s"),
        ("0,125 m", "length", "has a decimal comma", "0.125 m"),
        ("5,000.0 N", "force", "has separators between thousands", "5000.0 N"),
        ("5.000,5 N", "force", "has separators between thousands", "5000.5 N"),
        ("-1,250,000 N", "force", "has separators between thousands", "-1250000 N"),
        ("1,000 m", "length", "has a comma; write `1000 m` or `1.000 m`", None),
        ("5 metr", "length", "has an unknown unit, `metr`", "5 metre"),
        ("5 KN", "force", "has an unknown unit, `KN`", "5 kN"),
        ("77 lbs", "force", "is a mass; a force", "77 lbf"),
        ("5 nm/h", "speed", "is in nanometres", "5 nmi/h"),
        ("5 nm", "length", "is in nanometres", "5 nmi"),
        ("5 fm", "length", "is ambiguous; write `fathom`", "5 fathom"),
        ("2 miles", "length", "may mean 1609 or 1852 m", None),
        ("2 ton", "mass", "may mean 907, 1000 or 1016 kg", None),
        ("2 tons", "force", "may mean 907, 1000 or 1016 kg", None),
        ("2 mt", "mass", "is in thousandths of a tonne", "2 t"),
        ("2 Mt", "mass", "is in millions of tonnes", "2 t"),
        ("1 250 m", "length", "has separators between thousands", "1250 m"),
        ("1\u202f250,5 m", "length", "has separators between thousands", "1250.5 m"),
        ("1'250 m", "length", "has separators between thousands", "1250 m"),
        ("nan m", "length", "is not a finite number", None),
        (".inf m", "length", "is not a finite number", None),
        ("-inf", "length", "is not a finite number", None),
        (float("nan"), "length", "is not a finite number", None),
        (float("inf"), "number", "is not a finite number", None),
        ("1e400 m", "length", "is too large a number", None),
        ("9" * 400 + " m", "length", "is too large a number", None),
        (10**400, "number", "is too large a number", None),
        ("1/0 in", "length", "is divided by zero", None),
        (True, "number", "is not a plain number", None),
        (None, "length", "is not a length", None),
        ("", "length", "is not a length", None),
        ("about 5 m", "length", "is not a length (m, mm,", None),
        ("0.5 m", "number", "is a length; a plain number", None),
        ("5 m/s", "length", "is a speed; a length", None),
        ("5 degC", "length", "is a temperature; a length", None),
        ("5 degF", "length", "is not a length", None),
        ("5 K", "temperature", "is not a temperature in degC", None),
        ("5 C", "temperature", "is not a temperature in degC", "5 degC"),
        ("5", "temperature", "needs a unit", "5 degC"),
        ("35 kg/kg", "salinity", "is not a salinity (practical, such as 35, or in g/kg)", None),
        ("35000 ppm", "salinity", "is not a salinity", None),
        ("3.5 %", "salinity", "is a plain number; a salinity", None),
        (
            "35 g/kg",
            "density",
            "is a salinity (practical, such as 35, or in g/kg); a density",
            None,
        ),
        ("5 s", "length", "is a time; a length", None),
        ("5 A", "length", "is not a length", None),
        ("1 000 m", "length", "has separators between thousands", "1000 m"),
        ("5 __import__('os')", "length", "cannot be read", None),
        ("5 m^9999", "length", "cannot be read", None),
        ("5 ((((m", "length", "has an unknown unit", None),
        ("5 " + "m*" * 100 + "m", "length", "cannot be read", None),
    ],
)
def test_mistakes(text: object, dimension: str, complaint: str, suggestion: str | None) -> None:
    with pytest.raises(QuantityError) as caught:
        parse_quantity(text, dimension)
    assert caught.value.complaint.startswith(complaint)
    assert caught.value.suggestion == suggestion


@pytest.mark.parametrize(("spelling", "unit"), units._SPELLINGS.items())
def test_spellings_agree_with_pint(spelling: str, unit: str) -> None:
    assert REGISTRY.parse_units(spelling.replace("°C", "degC")) == REGISTRY.parse_units(unit)


def test_usual_unit_is_offered() -> None:
    with pytest.raises(QuantityError) as caught:
        parse_quantity("12", "length", usual_unit="mm")
    assert caught.value.suggestion == "12 mm"


def test_everyday_units_do_without_pint() -> None:
    code = (
        "import sys; from calm.units import parse_quantity;"
        "parse_quantity('1/2 in', 'length'); parse_quantity('35 kgf', 'force');"
        "sys.exit('pint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


@pytest.mark.parametrize("unit", ["%" * 50 + " kN", "a" * 55 + "?", "m" * 30 + "²" * 9 + "!"])
def test_a_unit_of_many_letters_that_cannot_be_one_is_refused_at_once(unit: str) -> None:
    with pytest.raises(QuantityError):  # one that tries every way to part it never ends
        unit_factor(unit, "force")


def test_kilograms_of_what_is_usual_in_kilonewtons_may_be_either() -> None:
    with pytest.raises(QuantityError) as error:
        parse_quantity("49.8 kg", "force", usual_unit="kN")
    assert error.value.complaint.endswith("is needed; write `49.8 kgf` or `49.8 kN`")
    assert error.value.suggestion is None
    with pytest.raises(QuantityError) as error:
        parse_quantity("49.8 kg", "force", usual_unit="N")  # as of buoyancies, given in kilograms
    assert error.value.suggestion == "49.8 kgf"
