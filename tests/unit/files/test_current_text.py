"""Tables out of the clipboard, and what their headings say."""

import pytest

from calm.errors import Problem
from calm.records.current_terms import Terms
from calm.records.delimited import CopiedTable, NoTableError, copied_table
from calm.records.profile_tables import CurrentTable, QuantityTable, read_current


def read(text: str, terms: Terms = Terms()) -> tuple[CurrentTable | None, list[str]]:  # noqa: B008
    copied = copied_table(text)
    assert copied.headings is not None
    problems: list[Problem] = []
    given = QuantityTable(
        copied.headings, copied.rows, lambda _, message: Problem("", 0, 0, message), problems
    )
    table = read_current(given, terms)
    return table, [problem.message for problem in problems]


@pytest.mark.parametrize("separator", ["\t", ";", ",", "   ", ", "])
def test_cells_between_any_separator(separator: str) -> None:
    lines = ["0 0.8 90", "", "# storm", "200 0.35 80"]
    text = "\n".join(separator.join(line.split()) if "#" not in line else line for line in lines)
    rows = (("0", "0.8", "90"), ("200", "0.35", "80"))
    assert copied_table(text) == CopiedTable(None, rows)
    headed = separator.join(("depth", "speed", "toward")) + "\n" + text
    assert copied_table(headed) == CopiedTable(("depth", "speed", "toward"), rows)


def test_headings_give_columns_units_and_the_way() -> None:
    table, _ = read("Depth (ft)\tSpeed [knot]\tFrom deg\n0\t1.0\t270\n328.084\t0.5\t180\n")
    assert table is not None
    # a foot is 0.3048 m, a knot 1852 m an hour; from the west is to the east
    assert table.depth == pytest.approx((0.0, 100.0), abs=1e-4)
    assert table.u == pytest.approx((1852 / 3600, 0.0), abs=1e-12)
    assert table.v == pytest.approx((0.0, 926 / 3600), abs=1e-12)
    table, _ = read("depth[m];u[cm/s];v[cm/s]\n0;50;-10\n")
    assert table == CurrentTable((0.0,), (0.5,), (-0.1,), (0.0,))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("depth m,speed m/s,direction deg\n0,1,90\n", "is ambiguous: call the column `toward`"),
        ("depth m,sped m/s,toward deg\n0,1,90\n", "no column is called `sped`; did you mean `spe"),
        ("depth m,speed m/s,toward deg,from deg\n0,1,90,270\n", "give either `toward`, the d"),
        (
            "depth m,speed m/s,toward deg magnetic\n0,1,90\n",
            "is relative to magnetic north; set the",
        ),
        (
            "depth m,u m/s magnetic,v m/s\n0,1,1\n",
            "`u` is relative to magnetic north, but `v` is not",
        ),
        ("depth m,speed m/s,toward deg\n0,1,400\n", "`toward: 400` must be at most 360 deg"),
        (
            "depth m,speed m/s,toward deg\n-5,1,4\n-9,1,4\n",
            "the depths are negative; depths must be po",
        ),
        (
            "depth m,speed m/s,toward deg\n5,1,4\n12000,1,4\n",
            "depth 12000 m exceeds the greatest depth",
        ),
        (
            "depth m,speed m/s,toward deg\n5,99.99,4\n",
            "99.99 m/s is faster than `max",
        ),
    ],
)
def test_mistakes(text: str, message: str) -> None:
    _, found = read(text, Terms(maximum_speed=5.0))
    assert message in found[0]


def test_columns_from_magnetic_north_are_turned() -> None:
    text = "depth m,speed m/s,toward deg magnetic\n0,1,80\n"
    table, _ = read(text, Terms(declination=10.0))
    assert table is not None
    assert (table.u[0], table.v[0]) == pytest.approx((1.0, 0.0), abs=1e-15)
    table, _ = read("depth m,u[m/s magnetic],v[m/s magnetic]\n0,0,1\n", Terms(declination=90.0))
    assert table is not None
    assert (table.u[0], table.v[0]) == pytest.approx((1.0, 0.0), abs=1e-15)
    _, found = read("depth m,u m/s,v m/s\n0,0,1\n", Terms(declination=90.0))
    assert "remove `declination`, or correct the heading" in found[0]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the text has no numbers"),
        ("depth,u,v\n", "the text has no numbers"),
        ("0,1,2\n3,4\n5,6,7", "line 2 of the file has 2 values, but the first line has 3"),
    ],
)
def test_texts_that_are_no_table(text: str, message: str) -> None:
    with pytest.raises(NoTableError, match=message):
        copied_table(text)
