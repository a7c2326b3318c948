from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text

from calm.drawing.picture import check_format, image
from calm.drawing.plot import draw, draw_flow
from calm.errors import UsageError


def drawn_names(result):
    figure = draw(result)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    elevation = figure.axes[0]
    renderer = canvas.get_renderer()
    # the extent of the words alone, without the thin line to the part
    return [Text.get_window_extent(text, renderer) for text in elevation.texts]


def test_names_do_not_overlap(result):
    boxes = drawn_names(result)
    assert len(boxes) == 6
    assert not any(a.overlaps(b) for a, b in combinations(boxes, 2))


@pytest.mark.thorough
def test_many_names_at_one_depth_do_not_overlap(make_result):
    result = make_result()
    wire = result.design.file.pieces[2]
    for number in range(60):
        clamp = type(wire)(**vars(result.clamps[0]))
        clamp.label, clamp.depth = f"{number} °C", 120.0 + 0.01 * number
        result.clamps.append(clamp)
        wire.clamps += (type(wire)(label=clamp.label, component=wire.clamps[0].component),)
    boxes = drawn_names(result)
    assert len(boxes) == 66
    assert not any(a.overlaps(b) for a, b in combinations(boxes, 2))


def test_three_views_with_their_axes_named(result):
    elevation, current, plan = draw(result).axes
    assert elevation.get_xlabel() == "offset [m], towards 086°"
    assert elevation.get_ylabel() == "depth [m]"
    assert current.get_xlabel() == "current speed [m/s]"
    assert (plan.get_xlabel(), plan.get_ylabel()) == ("east [m]", "north [m]")
    upper, lower = sorted(elevation.get_ylim())
    assert upper <= 0.0
    assert lower >= 1100.0
    assert elevation.yaxis_inverted()


@pytest.mark.parametrize(
    ("turn", "names"),
    [
        (0.0, ["speed"]),
        (5.0, ["speed"]),  # cos 5° = 0.996
        (30.0, ["speed", "in the plane"]),
        (180.0, ["speed", "in the plane"]),
    ],
)
def test_no_two_lines_of_the_current_cover_each_other(turn, names):
    depth, speed = np.linspace(0.0, 100.0, 50), np.linspace(1.0, 0.0, 50)
    axes = Figure().subplots()
    turn = np.radians(turn)
    draw_flow(axes, depth, speed * np.cos(turn), speed * np.sin(turn), np.array([1.0, 0.0]))
    _, *lines = axes.lines  # beyond the line of no current
    assert [line.get_label() for line in lines] == names
    assert lines[0].get_xdata() == pytest.approx(speed)
    assert lines[-1].get_xdata() == pytest.approx(speed * (np.cos(turn) if lines[1:] else 1.0))


def test_still_line_is_dashed_and_may_be_missing(make_result):
    def styles(result):
        return [line.get_linestyle() for line in draw(result).axes[0].lines]

    assert "--" in styles(make_result())
    assert "--" not in styles(make_result(still_shape=None))


def test_line_without_excursion_is_drawn(make_result):
    result = make_result()
    result.top.x = result.top.y = 0.0
    result.shape.x = 0.0 * result.shape.x
    assert "towards 090°" in draw(result).axes[0].get_xlabel()


def test_png_and_svg(result):
    assert image(draw(result), ".png").startswith(b"\x89PNG")
    svg = image(draw(result), ".svg")
    texts = "".join(ElementTree.fromstring(svg).itertext())
    assert "current meter" in texts
    assert image(draw(result), ".SVG") == svg


@pytest.mark.thorough
def test_labels_are_no_formulas_and_need_no_glyph(make_result):
    result = make_result()
    result.components[0].label = "float $x^$ \U0001f6df"
    assert b"float $x^$" in image(draw(result), ".svg")
    assert image(draw(result), ".png").startswith(b"\x89PNG")


def test_unknown_format_names_the_allowed():
    check_format(Path("a.PNG"))
    with pytest.raises(UsageError, match=r"\.png or \.svg"):
        check_format(Path("a.pdf"))
