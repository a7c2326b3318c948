import json

import pytest

from calm.errors import NoEquilibrium
from calm.report.result_files import UNITS, to_json


def test_one_document_is_an_object_and_several_an_array():
    assert json.loads(to_json([{"a": 1}])) == {"a": 1}
    assert json.loads(to_json([{"a": 1}, {"b": 2}])) == [{"a": 1}, {"b": 2}]


def test_numbers_that_are_not_finite_become_null_at_any_depth():
    text = to_json([{"a": float("nan"), "b": [float("inf"), {"c": (-float("inf"), 1.5)}]}])
    assert json.loads(text) == {"a": None, "b": [None, {"c": [None, 1.5]}]}


def test_text_is_as_it_was():
    assert to_json([{"name": "Iroise – été", "miss": 1e-07, "shape": {"x": []}}]) == (
        '{\n  "name": "Iroise \\u2013 \\u00e9t\\u00e9",\n  "miss": 1e-07,\n'
        '  "shape": {\n    "x": []\n  }\n}\n'
    )


@pytest.mark.parametrize(
    "value",
    [
        {},
        [],
        {"a": []},
        [[], {}, [[]]],
        [1, 2.5, True, None, "a, b: {\n  []}"],
        {"a": {"b": [{"c": ["x,\n  y", -0.0]}, 1], "d": ()}, "é": "\u2028", "e": (1, (2,))},
    ],
)
def test_it_is_indented_as_the_library_does(value):
    assert to_json([value]) == json.dumps(value, indent=2) + "\n"


def test_a_result_says_its_units_once():
    result = {"calm": "1.0", "anchor": {"tension": 3.0}}
    told = json.loads(to_json([result, {"name": "m", "status": "slack"}]))
    assert told[0] == result | {"units": UNITS} and "units" not in told[1]
    assert {"length": "m", "force": "N", "angle": "deg"}.items() <= UNITS.items()


def test_failure_tells_status_message_and_advice():
    failure = NoEquilibrium("slack", "The line is slack.", "Shorten it.")
    assert failure.to_dict() == {
        "status": "slack",
        "message": "The line is slack.",
        "advice": "Shorten it.",
    }
