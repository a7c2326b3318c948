"""How a tow is shown: in a terminal, in a notebook, and as CSV."""

import csv
import io
import re
from pathlib import Path

from calm.case.strumming import StrummingBand
from calm.report.html import fragment
from calm.report.result_files import to_csv
from calm.report.sheet import result_part
from calm.report.terminal import shown

GOLDEN = Path(__file__).parent / "golden"


def text(result, width=80):
    from rich.console import Console

    stream = io.StringIO()
    Console(file=stream, width=width).print(shown(result_part(result)))
    return "\n".join(line.rstrip() for line in stream.getvalue().splitlines()) + "\n"


def test_table_is_as_it_was(tow_result):
    assert text(tow_result) == (GOLDEN / "tow-80.txt").read_text(encoding="utf-8")


def test_limits_are_marked(tow_result):
    shown = text(tow_result)
    assert "2.5!" in shown  # steel: 3
    assert "18.0!" in shown  # leans more than 15°
    assert "! fish is loose" in shown


def test_a_line_that_does_not_strum_does_not_say_so(make_tow_result):
    assert "trum" not in text(make_tow_result(strumming=None))


def test_a_body_in_the_air_is_told_by_its_height(make_tow_result):
    result = make_tow_result()
    result.body.depth = -2.0
    assert re.search("Body +2.0 m in the air", text(result))
    result.file.environment.fluid = "air"
    result.body.depth = 27.0
    assert re.search("Body +30.0 m below the tow point", text(result))


def test_a_line_that_pulls_the_ship_up_says_so(make_tow_result):
    result = make_tow_result()
    result.tow_point.vertical = -12.0
    assert "12 N up" in text(result)


def test_notebook_says_the_same(tow_result):
    shown = fragment(result_part(tow_result))
    assert "Survey: tow at 1.03 m/s towards 90°" in shown
    assert re.search(r"<th[^>]*>layback <small>m</small></th>", shown)
    assert "strumming at 3.56 Hz, Cn from 1.250 to 3.000" in shown


def test_csv_has_tows_beside_moorings(result, tow_result):
    rows = list(csv.DictReader(io.StringIO(to_csv([result, tow_result]))))
    assert [row["label"] for row in rows if row["mooring"] == "Survey"] == [
        "tow wire",
        "sbe37",
        "fish",
    ]


def test_what_strumming_would_do(make_tow_result):
    band = StrummingBand(1.5, "converged", 95.0, None, 2900.0)
    result = make_tow_result(strumming=None, strumming_band=band)
    told = "with strumming (normal drag of the cables × 1.5): body 95.0 m deep, tow point 2900 N"
    assert told in " ".join(text(result).split())
