"""The charts as a reader sees them: texts that do not meet, loci where they belong."""

import itertools
import re

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from calm.analytic.chart_branch import curve
from calm.drawing.picture import image
from calm.drawing.plot import figure_svg
from calm.report.chart_page import draw_chart

PLATES = [(0.0, "below-90"), (0.15, "below-90"), (0.6, "below-90")]
PLATES += [(2.4, "below-90"), (2.4, "above-90")]
BLUE, GREEN, RED = "#0b5fa5", "#1a7f37", "#b3261e"


@pytest.fixture(scope="module", params=[*PLATES, (100.0, "below-90")], ids=str)
def plate(request: pytest.FixtureRequest) -> Figure:
    figure = draw_chart(*request.param)
    figure.canvas.draw()
    return figure


def shown_texts(figure: Figure) -> list[tuple[str, Bbox]]:
    axes = figure.axes[0]
    beyond = [
        label
        for axis, limits in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim()))
        for place, label in zip(axis.get_ticklocs(), axis.get_ticklabels(), strict=True)
        if not limits[0] <= place <= limits[1]
    ]
    texts = figure.findobj(lambda artist: isinstance(artist, Text) and artist.get_visible())
    return [
        (text.get_text(), text.get_window_extent())
        for text in texts
        if text.get_text() and text not in beyond
    ]


@pytest.mark.thorough
def test_no_text_covers_another(plate: Figure) -> None:
    texts = shown_texts(plate)
    assert len(texts) > 60
    meeting = [
        (one, other)
        for (one, box), (other, other_box) in itertools.combinations(texts, 2)
        if box.overlaps(other_box)
    ]
    assert not meeting


@pytest.mark.thorough
def test_every_text_is_on_the_page(plate: Figure) -> None:
    page = plate.bbox
    for text, box in shown_texts(plate):
        assert page.x0 <= box.x0 and box.x1 <= page.x1, text
        assert page.y0 <= box.y0 and box.y1 <= page.y1, text


@pytest.mark.thorough
def test_the_page_is_a4(plate: Figure) -> None:
    assert plate.get_size_inches() == pytest.approx((8.27, 11.69))


def line_labelled(figure: Figure, text: str, colour: str) -> np.ndarray:
    """Points of the locus on which the label of this colour lies."""
    axes = figure.axes[0]
    (label,) = (one for one in axes.texts if (one.get_text(), one.get_color()) == (text, colour))
    place = np.array(label.get_position())
    lines = [line.get_xydata() for line in axes.lines if line.get_color() == colour]
    return min(lines, key=lambda line: np.hypot(*(line - place).T).min())


@pytest.mark.parametrize(
    ("text", "colour", "value"), [("1.3", BLUE, 1.3), ("0.6", GREEN, 0.6), ("1.5", RED, 1.5)]
)
@pytest.mark.thorough
def test_a_locus_holds_the_points_of_its_ratio(text: str, colour: str, value: float) -> None:
    locus = line_labelled(draw_chart(0.6), text, colour)
    phi = np.radians(np.linspace(0.0, 100.0, 20001))
    points = curve(0.6, phi)
    rising = phi <= np.pi / 2
    for y_a, z_b in locus[5:-5:25]:
        a = np.interp(y_a, points.distance[rising], np.arange(phi.size)[rising])
        b = np.interp(z_b, points.height, np.arange(phi.size))
        start, end = (
            {
                name: np.interp(index, np.arange(phi.size), getattr(points, name))
                for name in ("arc", "distance", "height", "tension")
            }
            for index in (a, b)
        )
        height = end["height"] - start["height"]
        ratio = {
            BLUE: (end["arc"] - start["arc"]) / height,
            GREEN: (end["distance"] - start["distance"]) / height,
            RED: start["tension"] / height,
        }[colour]
        # Contours are straight between points a five-hundredth of the page apart.
        assert ratio == pytest.approx(value, abs=0.01)


def test_negative_ratios_carry_their_sign() -> None:
    assert line_labelled(draw_chart(2.4, "above-90"), "−0.8", GREEN).size


@pytest.mark.parametrize(("suffix", "head"), [(".PNG", b"\x89PNG"), (".pdf", b"%PDF")])
@pytest.mark.thorough
def test_formats(suffix: str, head: bytes) -> None:
    assert image(figure_svg(draw_chart(0.15)), suffix).startswith(head)


@pytest.mark.thorough
def test_a_drawing_is_the_same_file_each_time_and_its_texts_are_texts() -> None:
    drawing = figure_svg(draw_chart(0.6))
    assert re.search(r"<text[^>]*>45°</text>", drawing)
    assert drawing == figure_svg(draw_chart(0.6))
