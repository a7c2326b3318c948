"""Rows of numbers out of what was copied elsewhere."""

import pytest

from calm.files.fields import Quantity
from calm.tui.checking import number, quantity
from calm.tui.water.columns import check_of
from calm.tui.water.pasted import NoRows, pasted_rows

NUMBERS = (number, number, number)
ROWS = (("0", "0.9", "70"), ("50", "-1e-3", "60"))


@pytest.mark.parametrize("between", ["\t", ";", ",", ", ", " ", "   ", " ; "])
@pytest.mark.parametrize("heading", ["", "depth m{0}speed m/s{0}toward\n", "of the ADCP\n\n"])
def test_each_way_to_separate_values(between, heading):
    lines = "\r\n".join(between.join(row) for row in ROWS)
    assert pasted_rows(heading.format(between) + lines + "\n\n", NUMBERS) == ROWS


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", "there are no numbers"),
        ("depth,speed,toward", "there are no numbers"),
        ("0,1,2\n1,2", "row 2 has 2 values, and the table 3 columns"),
        ("7", "row 1 has 1 value, and the table 3 columns"),
        ("n/a 0.9 70\n1 2 3", "row 1: `n/a` "),
        ("0\t1\t2\n\n3\tlost\t4\n5\t6\t7", "row 3: `lost` "),
        ("0;0,9;70", "row 1: `0,9` "),
        ("0,1,2\nu,v,w", "row 2: `u` "),
    ],
)
def test_a_row_that_does_not_fit_refuses_all(text, complaint):
    with pytest.raises(NoRows) as refused:
        pasted_rows(text, NUMBERS)
    assert complaint in str(refused.value)


def test_values_of_a_column_without_a_unit_have_their_own():
    assert pasted_rows("0 2\n9 3", (number, quantity(Quantity("speed")))) == (
        ("0", "2 m/s"),
        ("9", "3 m/s"),
    )


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
