import math

import pytest

from calm.quantities import QUANTITIES, say


def test_header_of_a_column_carries_the_unit_of_results():
    assert QUANTITIES["depth_top"].header == "depth_top[m]"
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


def test_every_quantity_has_a_meaning_and_is_found_by_its_own_name():
    for name, quantity in QUANTITIES.items():
        assert quantity.name == name
        assert quantity.heading
        assert quantity.meaning.endswith(".")
