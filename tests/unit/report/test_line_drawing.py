"""A result as a drawing, read back from its SVG; the same on axes of matplotlib."""

import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure

import calm
from calm.drawing import plot
from calm.drawing.graph import Graph, Scale
from calm.drawing.line_drawing import LINE_COLOUR, WATER_COLOUR, draw_flow, line_drawing
from calm.drawing.line_picture import elevation_of, water_past
from calm.drawing.picture import FORMATS, check_format, image
from calm.errors import UsageError
from tests.drawings import assert_none_overlap, curves_of, texts_of, words_of

LINES = sorted((Path(__file__).resolve().parents[3] / "lines").glob("*.yaml"))


def test_no_text_covers_another_or_leaves_the_page(result):
    assert_none_overlap(line_drawing(result))


@pytest.mark.thorough
@pytest.mark.parametrize("path", LINES, ids=lambda path: path.stem)
def test_no_text_of_a_shipped_line_covers_another(path):
    assert_none_overlap(line_drawing(calm.load(path).solve()))


@pytest.mark.thorough
def test_many_names_at_one_depth_do_not_overlap(make_result):
    result = make_result()
    wire = result.design.file.pieces[2]
    for number in range(60):
        clamp = type(wire)(**vars(result.clamps[0]))
        clamp.label, clamp.depth = f"{number} °C", 120.0 + 0.01 * number
        result.clamps.append(clamp)
        wire.clamps += (type(wire)(label=clamp.label, component=wire.clamps[0].component),)
    svg = line_drawing(result)
    assert sum(word.endswith("°C") for word in words_of(svg)) == 60
    assert_none_overlap(svg)


def test_three_views_with_their_axes_named(result):
    svg = line_drawing(result)
    words = words_of(svg)
    assert {"offset [m], towards 086°", "depth [m]", "speed of the water [m/s]"} <= set(words)
    assert {"east [m]", "north [m]"} <= set(words)
    depths = {word: box for word, box in texts_of(svg) if box[2] < 45.0 and word.isdigit()}
    assert depths["0"][1] < depths["400"][1] < depths["1000"][1]


@pytest.mark.parametrize(
    ("turn", "lines"),
    [
        (0.0, ["solid"]),
        (5.0, ["solid"]),  # cos 5° = 0.996
        (30.0, ["solid", "dashed"]),
        (180.0, ["solid", "dashed"]),
    ],
)
def test_no_two_lines_of_the_current_cover_each_other(turn, lines):
    depth, speed = np.linspace(0.0, 100.0, 50), np.linspace(1.0, 0.0, 50)
    turn = np.radians(turn)
    page = Graph(100.0, 200.0, "flow", 8.0)
    flow = depth, speed * np.cos(turn), speed * np.sin(turn)
    draw_flow(
        page, (10.0, 10.0, 80.0, 100.0), flow, np.array([1.0, 0.0]), Scale(100.0, 0.0), "here"
    )
    drawn = curves_of(page.svg(), WATER_COLOUR)
    assert ["dashed" if dashed else "solid" for _, dashed in drawn] == lines
    # from the fastest, at the surface, to nothing, and each as long as its part in the plane
    reach = [points[0, 0] - points[-1, 0] for points, _ in drawn]
    assert reach[-1] / reach[0] == pytest.approx(np.cos(turn) if lines[1:] else 1.0, abs=1e-3)


def test_still_line_is_dashed_and_may_be_missing(make_result):
    def dashed(result):
        return [dashed for _, dashed in curves_of(line_drawing(result), "grey")]

    assert dashed(make_result()) == [True]
    assert dashed(make_result(still_shape=None)) == []
    assert "in still water" not in words_of(line_drawing(make_result(still_shape=None)))


def test_line_without_excursion_is_drawn(make_result):
    result = make_result()
    result.top.x = result.top.y = 0.0
    result.shape.x = 0.0 * result.shape.x
    assert "offset [m], towards 090°" in words_of(line_drawing(result))


def test_its_formats(result):
    svg = line_drawing(result)
    assert image(svg, ".png").startswith(b"\x89PNG")
    assert image(svg, ".pdf").startswith(b"%PDF")
    assert image(svg, ".SVG") == svg.encode()
    assert image(svg, ".PNG") == image(line_drawing(result), ".png")
    assert "current meter" in "".join(ElementTree.fromstring(svg).itertext())


@pytest.mark.thorough
def test_labels_are_no_formulas_and_need_no_glyph(make_result):
    result = make_result()
    result.components[0].label = "float $x^$ \U0001f6df"
    svg = line_drawing(result)
    assert "float $x^$ \U0001f6df" in words_of(svg)
    assert image(svg, ".png").startswith(b"\x89PNG")


def test_a_label_that_is_too_long_is_cut_and_whole_in_its_title(make_result):
    result = make_result()
    result.components[0].label = label = "the uppermost float, which is painted orange, " * 2
    svg = line_drawing(result)
    assert label in [title.text for title in ElementTree.fromstring(svg).iter() if title.text]
    assert_none_overlap(svg)


def test_unknown_format_names_the_allowed():
    for suffix in FORMATS:
        check_format(Path(f"a{suffix.upper()}"))
    with pytest.raises(UsageError, match=r"\.svg, \.png or \.pdf"):
        check_format(Path("a.jpg"))


def test_the_elevation_of_a_tow_is_behind_the_ship_and_reaches_above_the_water(tow_result):
    side = elevation_of(tow_result)
    assert side.top < -3.0 and side.bottom > 121.5
    svg = line_drawing(tow_result)
    words = words_of(svg)
    assert "distance behind the tow point [m], heading 90°" in words
    assert "speed past the line [m/s]" in words
    assert_none_overlap(svg)


def test_the_speed_past_the_line_is_that_of_the_water_less_the_ships(tow_result):
    depth, u, v = water_past(tow_result)
    # The water runs after the ship at the surface and stands still from 100 m down.
    assert np.hypot(u, v)[0] == pytest.approx(1.0289 - 0.5)
    assert np.hypot(u, v)[-1] == pytest.approx(1.0289)
    assert depth[0] == 0.0


def test_plan_only_where_the_line_leaves_the_plane(make_tow_result):
    assert "east [m]" in words_of(line_drawing(make_tow_result()))
    straight = make_tow_result()
    straight.shape.y = 0.0 * straight.shape.y
    svg = line_drawing(straight)
    assert "east [m]" not in words_of(svg)
    assert_none_overlap(svg)


def test_the_seabed_is_drawn_where_it_is_near(make_tow_result):
    def lower_edge(depth):
        result = make_tow_result()
        result.file.environment.depth = depth
        return elevation_of(result).bottom

    assert lower_edge(150.0) > 150.0
    assert lower_edge(3000.0) == lower_edge(None) < 150.0


def test_names_stand_beside_their_parts_and_need_no_formula(make_tow_result):
    result = make_tow_result()
    result.components[1].label = "fish $x^$"
    words = words_of(line_drawing(result))
    assert words.index("sbe37") < words.index("fish $x^$")


def test_a_bare_cable_is_drawn(make_tow_result):
    whole = make_tow_result()
    result = make_tow_result(components=type(whole.components)(whole.components[:1]), clamps=[])
    result.file.pieces = (result.file.pieces[0],)
    assert image(line_drawing(result), ".png").startswith(b"\x89PNG")


def test_a_line_at_rest_is_drawn_plumb(make_tow_result):
    result = make_tow_result()
    shape = result.shape
    shape.x, shape.y = 0.0 * shape.x, 0.0 * shape.y
    ((points, _),) = curves_of(line_drawing(result), LINE_COLOUR)
    assert np.ptp(points[:, 0]) == 0.0 < np.ptp(points[:, 1])


def test_a_result_is_plotted_on_given_axes(result):
    axes = Figure().subplots()
    assert plot.plot_elevation(elevation_of(result), axes) is axes
    assert axes.get_xlabel() == "offset [m], towards 086°"
    assert axes.yaxis_inverted()
    drawn = [line.get_ydata() for line in axes.lines]
    assert any(np.array_equal(each, result.shape.depth) for each in drawn)


def test_a_solved_mooring_plots_itself():
    axes = calm.load(LINES[0].with_name("s1000.yaml")).solve().plot()
    assert axes.get_ylabel() == "depth [m]"


def test_without_matplotlib_a_plot_says_what_to_type(result, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(UsageError, match="matplotlib is not installed; in the checkout"):
        calm.load("lines/s1000.yaml").solve().plot()
