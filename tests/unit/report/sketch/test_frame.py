import pytest

from calm.drawing.graph import number
from calm.drawing.graph import round_numbers as ticks
from calm.drawing.sketch.canvas import Canvas, CellScale, PlotFrame, levels


def frame(width: int = 12, height: int = 7) -> PlotFrame:
    canvas = Canvas(width, height)
    columns, rows = width - 4, height - 2
    return PlotFrame(
        canvas,
        4,
        0,
        columns,
        rows,
        CellScale(0.0, 30.0, 2 * columns),
        CellScale(0.0, 100.0, 4 * rows),
    )


@pytest.mark.parametrize(
    ("low", "high", "most", "expected"),
    [
        (0.0, 4200.0, 5, [0, 1000, 2000, 3000, 4000]),
        (0.0, 20.0, 4, [0, 5, 10, 15, 20]),
        (-31.0, 12.0, 3, [-20, 0]),
        (-20.0, 30.0, 1, [0, 25]),
        (0.0, 0.83, 2, [0, 0.5]),
        (-2e-9, 3e-9, 4, [-2e-9, 0, 2e-9]),
    ],
)
def test_ticks_are_round(low: float, high: float, most: int, expected: list[float]) -> None:
    assert ticks(low, high, most) == pytest.approx(expected, abs=1e-15)


def test_high_scales_have_more_ticks() -> None:
    assert len(levels(0.0, 1000.0, 4)) < len(levels(0.0, 1000.0, 20))


def test_numbers_are_short() -> None:
    assert [number(value) for value in (0.0, -0.0, 0.5, 4200.0, 2e6)] == [
        "0",
        "0",
        "0.5",
        "4200",
        "2000000",
    ]


def test_the_ends_of_a_range_are_the_first_and_the_last_dot() -> None:
    assert frame().point(0.0, 0.0) == (8, 0)
    assert frame().point(30.0, 100.0) == (23, 19)
    assert frame().cell(30.0, 100.0) == (11, 4)
    assert frame().cell(-99.0, 999.0) == (4, 4)


def test_scales_read_as_the_values_are() -> None:
    drawn = frame()
    drawn.scale_down([0.0, 50.0, 100.0], 3, "m")
    drawn.scale_across([0.0, 10.0, 20.0], "m east", "m")
    assert [row.plain for row in drawn.canvas.rows()] == [
        "  0┤        ",
        "   │        ",
        " 50┤        ",
        "   │        ",
        "100┤        ",
        "  m ┴ ┴  ┴  ",
        "    0   20 m",
    ]


def test_marks_that_would_cover_one_another_stand_side_by_side() -> None:
    drawn = frame(10, 3)
    for sign in "ABABC":
        drawn.mark(15.0, 0.0, sign, "")
    assert drawn.canvas.rows()[0].plain == "      CAB "
