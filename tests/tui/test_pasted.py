"""Rows of numbers out of what was copied elsewhere."""

import pytest

from calm.records.delimited import NoTableError, copied_table
from calm.tui.water_tables import (
    NoRows,
    Rows,
    UnknownColumns,
    check_of,
    offered_headings,
    rows_in,
)

COLUMNS = ("depth m", "speed m/s", "toward deg")
ROWS = (("0", "0.9", "70"), ("50", "1e-3", "60"))


def pasted(text: str, columns: tuple[str, ...] = COLUMNS) -> Rows:
    """As the grid takes it where the offered columns are confirmed."""
    copied = copied_table(text)
    return rows_in(columns, offered_headings(copied.headings, columns), copied.rows)


@pytest.mark.parametrize("between", ["\t", ";", ",", ", ", " ", "   ", " ; "])
@pytest.mark.parametrize("heading", ["", "depth{0}speed{0}toward\n"])
def test_each_way_to_separate_values(between, heading):
    lines = "\r\n".join(between.join(row) for row in ROWS)
    assert pasted(heading.format(between) + lines + "\n\n") == ROWS


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", "the text has no numbers"),
        ("depth,speed,toward", "the text has no numbers"),
        ("0,1,2\n1,2", "values, but the first"),
        ("n/a 0.9 70\n1 2 3", "row 1: `n/a` "),
        ("0\t1\t2\n\n3\tlost\t4\n5\t6\t7", "row 2: `lost` "),
        ("0;0,9;70\n1;0.9;70", "row 1: `0,9` "),
        ("0,1,2\nu,v,w", "row 2: `u` "),
    ],
)
def test_a_row_that_does_not_fit_refuses_all(text, complaint):
    with pytest.raises((NoRows, NoTableError)) as refused:
        pasted(text)
    assert complaint in str(refused.value)


def test_headings_are_read_as_those_of_files():
    # 1 knot is 1852 m an hour, a foot 0.3048 m; from the west is toward 90 deg
    text = "Depth (ft),Speed [knot],From deg\n0,1,270\n1000,0.5,180\n"
    assert pasted(text) == (("0", "0.514444444", "90"), ("304.8", "0.257222222", "0"))
    text = "depth m,u[cm/s],v[cm/s]\n0,50,0\n10,0,-20\n"
    assert pasted(text) == (("0", "0.5", "90"), ("10", "0.2", "180"))
    own_units = ("depth", "u", "v")
    assert pasted(text, own_units) == (("0 m", "0.5 m/s", "0 m/s"), ("10 m", "0 m/s", "-0.2 m/s"))
    water = "depth m,salinity,temperature degC\n0,35,4\n"
    assert pasted(water, ("depth m", "temperature degC", "salinity")) == (("0", "4", "35"),)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("depth m,speed m/s,direction deg\n0,1,90\n", "is ambiguous"),
        ("level,fast,way\n0,1,90\n", "no column is called `level`"),
        ("depth m,u m/s,v m/s,w m/s\n0,1,1,0.1\n", "the current has an upward speed `w`"),
        ("0,1\n5,2\n", "there is no column"),
    ],
)
def test_columns_that_are_not_known_are_asked_for(text, complaint):
    with pytest.raises((UnknownColumns, NoRows)) as refused:
        pasted(text)
    if complaint != "there is no column":
        assert isinstance(refused.value, UnknownColumns)
        assert complaint in str(refused.value)


@pytest.mark.parametrize(
    "column, good, bad",
    [
        ("density kg/m^3", "1025", "90"),
        ("density", "1025 kg/m^3", "90 kg/m^3"),
        ("speed m/s", "0.4", "-0.4"),
        ("u m/s", "-0.4", "1 m"),
        ("toward deg", "-90", "500"),
        ("temperature degC", "4", "90"),
    ],
)
def test_values_of_a_column_are_as_plausible_as_in_files(column, good, bad):
    check = check_of(column)
    assert check(good).is_good and not check(bad).is_good
