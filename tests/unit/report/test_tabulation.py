"""A tow at several speeds, as a table, as data and drawn."""

import io

import pytest
from rich.console import Console

from calm.drawing.line_drawing import LINE_COLOUR
from calm.errors import NoEquilibrium
from calm.report.tabulation import (
    by_speed,
    sweep_drawing,
    tabulation_part,
    to_csv,
    to_document,
)
from calm.report.terminal import shown
from tests.drawings import assert_none_overlap, curves_of, words_of

NONE = NoEquilibrium("grounded", "It lies on the bed.", "Steam faster.")


def text(tabulation, width=80):
    stream = io.StringIO()
    Console(file=stream, width=width).print(shown(tabulation_part(tabulation)))
    return [line.rstrip() for line in stream.getvalue().splitlines()]


@pytest.fixture
def swept(make_tow_result):
    common = "fish is loose"
    results = [
        NONE,
        make_tow_result(),
        make_tow_result(warnings=(common, "too fast")),
    ]
    return by_speed(results[1].design, [0.5144, 1.0289, 2.0578], results)


def test_a_row_for_each_speed_in_both_units(swept):
    lines = text(swept)
    assert lines[0] == "Survey: tow at 3 speeds"
    assert lines[5].split() == ["0.51", "1.00", *["-"] * 6, "grounded"]
    assert lines[6].split() == ["1.03", "2.00", "120.0", "140.0", "3000", "35.26", "1500", "3.559"]
    assert lines[7].split()[-1] == "!"
    assert "! fish is loose" in lines
    assert not any("too fast" in line for line in lines)
    assert max(map(len, lines)) <= 80


def test_frequency_only_where_something_strums(make_tow_result):
    still = make_tow_result(strumming=None)
    tabulation = by_speed(still.design, [1.0], [still])
    assert "frequency" not in "".join(text(tabulation))
    assert "frequency" not in to_document(tabulation)["speeds"][0]


def test_a_small_tow_has_digits_enough(make_tow_result):
    small = make_tow_result()
    small.body.depth, small.tow_point.tension = 1.65294, 16.1298
    row = text(by_speed(small.design, [1.3], [small]))[5]
    assert "1.653" in row and "16.13" in row


def test_document(swept):
    document = to_document(swept)
    assert list(document) == ["calm", "name", "type", "speeds"]
    failed, converged, warned = document["speeds"]
    assert failed == {
        "speed": 0.5144, "status": "grounded", "depth": None, "layback": None, "tension": None,
        "angle": None, "body_tension": None, "frequency": None,
        "message": "It lies on the bed.", "advice": "Steam faster.",
    }  # fmt: skip
    assert (converged["angle"], converged["frequency"]) == (35.26, 3.559)
    assert warned["warnings"] == ["fish is loose", "too fast"]


def test_csv(swept):
    header, failed, converged, _ = to_csv([swept]).splitlines()
    assert header == (
        "tow,speed[m/s],status,depth[m],layback[m],tension[N],angle[deg],body_tension[N],"
        "frequency[Hz]"
    )
    assert failed == "Survey,0.5144,grounded,,,,,,"
    assert converged == "Survey,1.0289,converged,120,140,3000.4,35.26,1500,3.559"


def test_drawing_leaves_a_gap_where_there_is_no_equilibrium(swept):
    svg = sweep_drawing(swept)
    words = words_of(svg)
    assert {"depth [m]", "layback [m]", "tow point", "body", "speed [knot]"} <= set(words)
    (depth, _), *_ = curves_of(svg, LINE_COLOUR)
    assert len(depth) == 2  # of three speeds, the first of which has no equilibrium
    assert_none_overlap(svg)


def test_one_speed_can_be_drawn(make_tow_result):
    result = make_tow_result()
    tabulation = by_speed(result.design, [1.0], [result])
    assert tabulation.title == "Survey: tow at 1 speed"
    assert_none_overlap(sweep_drawing(tabulation))
