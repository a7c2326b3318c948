"""How a tow is shown: in a terminal, in a notebook, as CSV and drawn."""

import csv
import io
import re
from pathlib import Path

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from calm.case.strumming import StrummingBand
from calm.drawing.picture import image
from calm.drawing.plot import draw
from calm.report.html import fragment
from calm.report.result_files import to_csv
from calm.report.sheet import result_part
from calm.report.terminal import shown

GOLDEN = Path(__file__).parent / "golden"


def text(result, width=80):
    from rich.console import Console

    stream = io.StringIO()
    Console(file=stream, width=width).print(shown(result_part(result)))
    return "\n".join(line.rstrip() for line in stream.getvalue().splitlines()) + "\n"


def test_table_is_as_it_was(tow_result):
    assert text(tow_result) == (GOLDEN / "tow-80.txt").read_text(encoding="utf-8")


def test_limits_are_marked(tow_result):
    shown = text(tow_result)
    assert "2.5!" in shown  # steel: 3
    assert "18.0!" in shown  # leans more than 15°
    assert "! fish is loose" in shown


def test_a_line_that_does_not_strum_does_not_say_so(make_tow_result):
    assert "trum" not in text(make_tow_result(strumming=None))


def test_a_body_in_the_air_is_told_by_its_height(make_tow_result):
    result = make_tow_result()
    result.body.depth = -2.0
    assert "Body 2.0 m in the air" in text(result)
    result.file.environment.fluid = "air"
    result.body.depth = 27.0
    assert "Body 30.0 m below the tow point" in text(result)


def test_a_line_that_pulls_the_ship_up_says_so(make_tow_result):
    result = make_tow_result()
    result.tow_point.vertical = -12.0
    assert "12 N up" in text(result)


def test_notebook_says_the_same(tow_result):
    shown = fragment(result_part(tow_result))
    assert "Survey: tow at 1.03 m/s towards 90°" in shown
    assert re.search(r"<th[^>]*>layback <small>m</small></th>", shown)
    assert "Strumming at 3.56 Hz, Cn from 1.250 to 3.000" in shown


def test_csv_has_tows_beside_moorings(result, tow_result):
    rows = list(csv.DictReader(io.StringIO(to_csv([result, tow_result]))))
    assert [row["label"] for row in rows if row["mooring"] == "Survey"] == [
        "tow wire",
        "sbe37",
        "fish",
    ]


def test_the_elevation_is_behind_the_ship_and_reaches_above_the_water(tow_result):
    elevation, flow, _ = draw(tow_result).axes
    assert elevation.get_xlabel() == "distance behind the tow point [m], heading 90°"
    left, right = elevation.get_xlim()
    assert left < 0.0 < 140.5 < right
    bottom, top = elevation.get_ylim()
    assert top < -3.0 and bottom > 121.5
    assert flow.get_xlabel() == "speed past the line [m/s]"


def test_the_speed_past_the_line_is_that_of_the_water_less_the_ships(tow_result):
    flow = draw(tow_result).axes[1]
    _, speed = flow.lines  # all of it in the plane of the tow
    # The water runs after the ship at the surface and stands still from 100 m down.
    assert speed.get_xdata()[0] == pytest.approx(1.0289 - 0.5)
    assert speed.get_xdata()[-1] == pytest.approx(1.0289)
    assert min(speed.get_ydata()) == 0.0


def test_plan_only_where_the_line_leaves_the_plane(make_tow_result):
    assert len(draw(make_tow_result()).axes) == 3
    straight = make_tow_result()
    straight.shape.y = 0.0 * straight.shape.y
    assert len(draw(straight).axes) == 2


def test_the_seabed_is_drawn_where_it_is_near(make_tow_result):
    def lower_edge(depth):
        result = make_tow_result()
        result.file.environment.depth = depth
        return draw(result).axes[0].get_ylim()[0]

    assert lower_edge(150.0) > 150.0
    assert lower_edge(3000.0) == lower_edge(None) < 150.0


def test_names_stand_beside_their_parts_and_need_no_formula(make_tow_result):
    result = make_tow_result()
    result.components[1].label = "fish $x^$"
    figure = draw(result)
    FigureCanvasAgg(figure).draw()
    assert [text.get_text() for text in figure.axes[0].texts] == ["sbe37", "fish $x^$"]
    assert b"fish $x^$" in image(draw(result), ".svg")


def test_a_bare_cable_is_drawn(make_tow_result):
    whole = make_tow_result()
    result = make_tow_result(components=type(whole.components)(whole.components[:1]), clamps=[])
    result.file.pieces = (result.file.pieces[0],)
    assert image(draw(result), ".png").startswith(b"\x89PNG")


def test_a_line_at_rest_is_drawn_plumb(make_tow_result):
    result = make_tow_result()
    shape = result.shape
    shape.x, shape.y = 0.0 * shape.x, 0.0 * shape.y
    left, right = draw(result).axes[0].get_xlim()
    # a tenth of the height at least, in 0.55 of the width
    height = shape.depth.max() - shape.depth.min()
    assert right == pytest.approx(0.1 * height / 0.55, rel=1e-12)
    assert left < 0.0


def test_what_strumming_would_do(make_tow_result):
    band = StrummingBand(1.5, "converged", 95.0, None, 2900.0)
    result = make_tow_result(strumming=None, strumming_band=band)
    told = "If the cables strum, Cn × 1.5: body 95.0 m deep, tow point 2900 N\n"
    assert told in text(result)
