import pytest

from calm.drawing.sketch.canvas import Canvas


def plain(canvas: Canvas) -> list[str]:
    return [row.plain for row in canvas.rows()]


@pytest.mark.parametrize(
    ("x", "y", "sign"),
    [(0, 0, "⠁"), (1, 0, "⠈"), (0, 1, "⠂"), (1, 2, "⠠"), (0, 3, "⡀"), (1, 3, "⢀")],
)
def test_a_dot_is_where_braille_has_it(x: int, y: int, sign: str) -> None:
    canvas = Canvas(1, 1)
    canvas.dot(x, y, "red")
    assert plain(canvas) == [sign]


def test_a_line_joins_its_ends_without_gaps() -> None:
    canvas = Canvas(2, 1)
    canvas.line([(0, 0), (3, 3)], "cyan")
    assert plain(canvas) == ["⠑⢄"]


def test_a_dashed_line_leaves_dots_out() -> None:
    canvas = Canvas(3, 1)
    canvas.line([(0, 0), (5, 0)], "", dash=1, gap=2)
    assert plain(canvas) == ["⠁⠈ "]


def test_what_is_outside_is_left_out() -> None:
    canvas = Canvas(2, 2)
    canvas.line([(-9, 2), (30, 2)], "")
    canvas.text(-1, 1, "abcd")
    canvas.text(0, 7, "lost")
    canvas.dot(0, -1, "")
    assert plain(canvas) == ["⠤⠤", "bc"]


def test_a_line_through_what_is_unknown_is_interrupted() -> None:
    canvas = Canvas(3, 1)
    canvas.line([(0, 0), (1, 0), (float("nan"), 0), (4, 0), (5, 0)], "")
    assert plain(canvas) == ["⠉ ⠉"]


def test_signs_stand_over_dots_and_keep_their_style() -> None:
    canvas = Canvas(2, 1)
    canvas.text(0, 0, "●", "yellow")
    canvas.line([(0, 1), (3, 1)], "cyan")
    (row,) = canvas.rows()
    assert row.plain == "●⠒"
    assert [str(span.style) for span in row.spans] == ["yellow", "cyan"]


def test_wide_signs_take_two_cells_and_are_cut_at_the_edge() -> None:
    canvas = Canvas(3, 1)
    canvas.text(0, 0, "浮標")
    (row,) = canvas.rows()
    assert row.cell_len == 3 and row.plain == "浮 "
