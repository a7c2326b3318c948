"""Graphs of the reports: where values stand, what is written at the ticks, what is left out."""

import re
from xml.etree import ElementTree

import numpy as np
import pytest

from calm.drawing.graph import (
    Graph,
    LegendEntry,
    Scale,
    Stroke,
    counts,
    covering,
    decades,
    moments,
    numbers,
    to_one_scale,
)

NAN = float("nan")
LINE = Stroke("black")


TEN, ONE = Scale(0.0, 10.0), Scale(0.0, 1.0)


def axes(across=TEN, up=ONE):
    """Axes of 100 by 50 points, ten points from the upper left corner."""
    return Graph(200.0, 100.0, "a graph", 7.0).axes(10.0, 10.0, 100.0, 50.0, across, up)


def drawn(graph):
    """Elements of a graph by their tags."""
    found = {}
    for element in ElementTree.fromstring(graph.svg()).iter():
        found.setdefault(element.tag.rpartition("}")[2], []).append(element)
    return found


def texts(ticks):
    return [tick.text for tick in ticks]


def test_a_scale_runs_either_way_and_by_decades():
    assert Scale(10.0, 20.0).share([10.0, 12.5, 20.0]).tolist() == [0.0, 0.25, 1.0]
    assert Scale(20.0, 10.0).share(12.5) == 0.75
    np.testing.assert_allclose(
        Scale(0.01, 100.0, logarithmic=True).share([0.01, 1.0, 100.0, 0.0]), [0.0, 0.5, 1.0, NAN]
    )


@pytest.mark.parametrize(
    ("values", "scale"),
    [
        ([0.0, 10.0, NAN], Scale(-0.5, 10.5)),
        ([4.0, 4.0], Scale(3.8, 4.2)),
        ([0.0], Scale(-0.05, 0.05)),
        ([NAN, np.inf], Scale(0.0, 1.0)),
        ([], Scale(0.0, 1.0)),
    ],
)
def test_a_range_holds_what_is_known(values, scale):
    assert covering(values) == scale


def test_axes_to_one_scale_widen_the_range_that_needs_less():
    across, up = to_one_scale(Scale(0.0, 10.0), Scale(30.0, 10.0), 100.0, 50.0)
    assert across == Scale(-15.0, 25.0)  # 40 over 100 points as 20 over 50
    assert up == Scale(30.0, 10.0)  # downward still


def test_clipped_axes_of_a_graph_have_names_of_their_own():
    page = Graph(100.0, 100.0, "two", 8.0)
    for left in (0.0, 50.0):
        scale = Scale(0.0, 1.0)
        axes = page.axes(left, 0.0, 50.0, 100.0, scale, scale, clipped=True)
        axes.line([-1.0, 2.0], [0.5, 0.5], Stroke("red"))
    svg = page.svg()
    names = re.findall(r'<clipPath id="([^"]+)"', svg)
    assert len(set(names)) == 2
    assert names == re.findall(r'clip-path="url\(#([^)]+)\)"', svg)


def test_ticks_are_round():
    assert texts(numbers(-7.0, 12.0, 5)) == ["\N{MINUS SIGN}5", "0", "5", "10"]
    assert numbers(12.0, -7.0, 5) == numbers(-7.0, 12.0, 5)
    assert texts(counts(1, 43, 8)) == ["10", "20", "30", "40"]
    assert texts(counts(3, 3, 8)) == ["3"]
    assert texts(decades(0.01, 100.0)) == ["0.01", "0.1", "1", "10", "100"]


@pytest.mark.parametrize(
    ("begin", "end", "written"),
    [
        ("1993-01-01", "1997-07-24", ["1993", "1994", "1995", "1996", "1997"]),
        ("1899-06-01", "2024-01-01", ["1900", "1920", "1940", "1960", "1980", "2000", "2020"]),
        ("2023-11-20", "2024-05-02", [f"{month}" for month in (
            "2023-12", "2024-01", "2024-02", "2024-03", "2024-04", "2024-05")]),
        ("2024-02-18", "2024-03-20", [
            "2024-02-21", "2024-02-26", "2024-03-01", "2024-03-06", "2024-03-11", "2024-03-16"]),
        ("2024-02-28 20:00", "2024-03-01 02:00", [
            "02-29 00:00", "02-29 06:00", "02-29 12:00", "02-29 18:00", "03-01 00:00"]),
        ("2024-02-28 20:03", "2024-02-28 20:31", ["20:05", "20:10", "20:15", "20:20", "20:25",
                                                  "20:30"]),
        ("2024-02-28 20:30", "2024-02-28 20:30", ["20:30"]),
    ],
)  # fmt: skip
def test_times_are_those_that_people_write(begin, end, written):
    ticks = moments(np.datetime64(begin), np.datetime64(end), 7)
    assert texts(ticks) == written
    first = np.datetime64(begin).astype("datetime64[s]").astype(np.int64)
    last = np.datetime64(end).astype("datetime64[s]").astype(np.int64)
    assert all(first <= tick.value <= last for tick in ticks)


def test_a_line_stands_where_its_values_are_and_ends_at_what_is_unknown():
    here = axes()
    here.line([0.0, 5.0, NAN, 10.0, 2.0], [0.0, 1.0, 1.0, 0.5, 0.25], LINE)
    (path,) = drawn(here.graph)["path"]
    assert path.get("d") == "M10.00 60.00L60.00 10.00M110.00 35.00L30.00 47.50"


def test_a_band_is_parted_where_an_edge_is_unknown():
    here = axes()
    here.band([0.0, 5.0, 6.0, 10.0], [0.0, 0.0, 0.0, 0.5], [1.0, 1.0, NAN, 1.0], "red")
    (path,) = drawn(here.graph)["path"]
    parts = re.findall("M[^M]*Z", path.get("d"))
    assert parts[0] == "M10.00 10.00L60.00 10.00L60.00 60.00L10.00 60.00Z"
    assert len(parts) == 2


def test_bars_stand_on_zero():
    here = axes(up=Scale(-1.0, 1.0))
    here.bars([2.0, 4.0, 6.0], [0.5, -0.5, NAN], 1.0, ["red", "blue", "green"])
    bars = [one for one in drawn(here.graph)["rect"] if one.get("fill") in ("red", "blue", "green")]
    assert [(one.get("x"), one.get("y"), one.get("height")) for one in bars] == [
        ("25", "22.5", "12.5"), ("45", "35", "12.5"),
    ]  # fmt: skip


def test_ticks_stand_at_their_values_and_titles_beside_them():
    here = axes()
    here.frame(numbers(0.0, 10.0, 2), numbers(0.0, 1.0, 2), below="speed", beside="one\ntwo")
    found = {one.text: one for one in drawn(here.graph)["text"]}
    assert [*found] == ["0", "5", "10", "0.5", "1", "speed", "two", "one"]
    assert found["5"].get("x") == "60"
    assert float(found["0.5"].get("y")) == pytest.approx(35.0 + 0.35 * 7.0)


def test_a_legend_shortens_what_is_too_long_and_any_sign_is_text():
    graph = Graph(200.0, 100.0, "a graph", 7.0)
    entries = [
        LegendEntry("a\tstorm <b>\x07 $x$", line=LINE),
        LegendEntry("long " * 20, sign=("o", 4, "red")),
    ]
    graph.legend(entries, (0.0, 0.0), 100.0, 10.0, columns=2)
    first, second = drawn(graph)["text"]
    assert "".join(first.itertext()) == "a storm <b>\ufffd $x$"
    assert "".join(second.itertext()).endswith("…")


def test_a_frame_and_a_curve_are_lines_and_hide_nothing():
    here = axes()
    here.line([0.0, 5.0, 10.0], [0.0, 1.0, 0.0], LINE)
    here.frame(numbers(0.0, 10.0, 2), numbers(0.0, 1.0, 2))
    root = ElementTree.fromstring(here.graph.svg())
    assert root.get("fill") == "none"
    stroked = [one for one in root.iter() if one.get("stroke") or one.tag.endswith("path")]
    assert stroked and not any(one.get("fill") for one in stroked)
