import math

import pytest

from calm.quantities import QUANTITIES, SHOWN_UNITS, say, show_in, shown_units
from calm.units import unit_factor


def test_header_of_a_column_carries_the_unit_of_results():
    assert QUANTITIES["cut_length"].header == "cut_length[m]"
    assert QUANTITIES["tilt"].header == "tilt[deg]"
    assert QUANTITIES["safety_factor"].header == "safety_factor"


def test_label_of_an_axis_carries_the_unit_people_read():
    assert QUANTITIES["tilt"].label == "tilt [°]"
    assert QUANTITIES["diameter"].label == "diameter [mm]"
    assert QUANTITIES["safety_factor"].label == "safety factor"


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("depth", 113.249, "113.2"),
        ("tension", 7003.4, "7003"),
        ("knockdown", -0.04, "0.0"),
        ("knockdown", math.nan, "-"),
        ("knockdown", None, "-"),
        ("diameter", 0.0127, "12.7"),
    ],
)
def test_digits(name, value, text):
    assert QUANTITIES[name].format(value) == text


def test_sentences_and_data_sheets():
    assert say("depth", 113.249) == "113.2 m"
    assert say("angle", 11.74) == "11.7°"
    assert say("knockdown", None) == say("knockdown", math.nan) == "unknown"
    assert QUANTITIES["breaking_load"].figure(120e3) == "120 kN"
    assert QUANTITIES["buoyancy"].figure(-13729.3) == "-13730 N"
    assert QUANTITIES["weight"].figure(0.009807) == "0.009807 N"


@pytest.fixture
def shown_afterwards():
    before = shown_units()
    yield
    show_in(before)


def test_a_force_in_a_sentence_is_in_newtons_below_a_kilonewton(shown_afterwards):
    """Two values of a sentence share the unit of the larger one; a chosen unit always holds."""
    load = QUANTITIES["load"]
    assert [load.say(force) for force in (12_345.0, 1000.0, 999.4, 74.1, 3.061, -2400.0)] == [
        "12.35 kN", "1.00 kN", "999 N", "74 N", "3.06 N", "-2.40 kN",
    ]  # fmt: skip
    assert load.say(330.0, -2350.0) == "0.33 kN"
    assert load.number_and_unit(199.0, 500.0) == ("199", "N")
    assert load.format(199.0) == "0.20"
    show_in({"force": "kN"})
    assert load.say(199.0) == "0.20 kN"


def test_every_quantity_has_a_meaning_and_is_found_by_its_own_name():
    for name, quantity in QUANTITIES.items():
        assert quantity.name == name
        assert quantity.heading
        assert quantity.meaning.endswith(".")


@pytest.fixture
def shown():
    yield show_in
    show_in({})


# 1 kgf = 9.80665 N, 1 lbf = 4.4482216 N, 1 kn = 1852/3600 m/s, 1 lb = 0.45359237 kg
@pytest.mark.parametrize(
    ("dimension", "unit", "name", "value", "text"),
    [
        ("force", "kgf", "tension", 9806.65, "1000.0 kgf"),
        ("force", "kN", "tension", 4003.49, "4.003 kN"),
        ("force", "lbf", "tension", 4448.2216, "1000.0 lbf"),
        ("force", "kgf", "breaking_load", 98066.5, "10000 kgf"),
        ("force", "N", "breaking_load", 98066.5, "98.1 kN"),
        ("length", "ft", "depth", 304.8, "1000.0 ft"),
        ("length", "ft", "diameter", 0.0127, "12.7 mm"),
        ("speed", "kn", "speed", 1852 / 3600, "1.00 kn"),
        ("speed", "cm/s", "speed", 0.253, "25 cm/s"),
        ("mass", "lb", "dry_mass", 45.359237, "100.0 lb"),
        ("mass", "lb", "volume", 0.012, "12.0 l"),
        ("force", "kgf", "tilt", 11.74, "11.7°"),
    ],
)
def test_people_choose_their_units(shown, dimension, unit, name, value, text):
    shown({dimension: unit})
    assert say(name, value) == text


def test_programs_and_pictures_keep_theirs(shown):
    before = {name: (one.header, one.label) for name, one in QUANTITIES.items()}
    shown({"force": "lbf", "length": "ft", "speed": "kn", "mass": "lb"})
    assert {name: (one.header, one.label) for name, one in QUANTITIES.items()} == before
    assert shown_units() == {"force": "lbf", "length": "ft", "speed": "kn", "mass": "lb"}


def test_units_shown_are_as_long_as_those_read():
    for dimension, units in SHOWN_UNITS.items():
        for unit, factor in units.items():
            assert factor == pytest.approx(unit_factor(unit, dimension), rel=1e-12)


@pytest.mark.parametrize(
    "units", [{}, {name: next(iter(units)) for name, units in SHOWN_UNITS.items()}]
)
def test_the_units_of_results_are_the_usual_ones(shown, units):
    shown({"force": "kgf"})
    shown(units)
    assert shown_units() == {}
    assert say("tension", 7003.4) == "7003 N"
