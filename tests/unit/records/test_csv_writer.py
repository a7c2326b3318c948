"""Tables that machines and spreadsheets read."""

import csv
import io
import math

import pytest

from calm.records.delimited import table_csv


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.071 + 1e-17, "0.071"),
        (0.07100000000000001, "0.071"),
        (480.0, "480"),
        (-0.0, "0"),
        (1 / 3, "0.333333333333"),
        (1.5e-9, "1.5e-09"),
        (-7, "-7"),
        (None, ""),
        (math.nan, ""),
        (True, "True"),
    ],
)
def test_numbers_have_no_noise_and_the_unknown_is_empty(value, text):
    assert table_csv(["a"], [[value, "x"]]) == f"a\n{text},x\n"


@pytest.mark.parametrize("text", ["=1+1", "+1", "-x", "@SUM(A1)", "\t=1", "\r=1", "\n=1"])
def test_no_text_is_a_formula_in_rows_or_headings(text):
    rows = list(csv.reader(io.StringIO(table_csv([text], [[text]]), newline="")))
    assert rows == [[f"'{text}".replace("\r", "\n")]] * 2
