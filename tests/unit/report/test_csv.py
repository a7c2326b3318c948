import csv
import io
from pathlib import Path

from calm.report.result_files import header, to_csv

GOLDEN = Path(__file__).parent / "golden" / "components.csv"


def test_csv_is_as_it_was(result):
    assert to_csv([result]) == GOLDEN.read_text(encoding="utf-8")


def test_header_names_the_units():
    heads = header()
    assert heads[:5] == ("mooring", "part", "index", "use", "label")
    assert heads[5:8] == ("length[m]", "cut_length[m]", "depth_top[m]")
    assert "tension_top[N]" in heads
    assert "tilt[deg]" in heads
    assert "safety_factor" in heads


def test_rows_read_back_with_clamps_below_their_piece(result):
    rows = list(csv.DictReader(io.StringIO(to_csv([result]))))
    assert [row["part"] for row in rows[2:6]] == ["component", "clamp", "clamp", "component"]
    assert float(rows[2]["tension_top[N]"]) == 7002.0
    clamp = rows[3]
    assert float(clamp["depth_top[m]"]) == float(clamp["depth_bottom[m]"]) == 134.5
    assert clamp["length[m]"] == clamp["safety_factor"] == ""


def test_unknown_numbers_are_empty(result):
    assert "nan" not in to_csv([result]).lower()


def test_labels_with_commas_and_quotes_survive(make_result):
    result = make_result()
    result.components[0].label = 'top, "the" float'
    rows = list(csv.DictReader(io.StringIO(to_csv([result]))))
    assert rows[0]["label"] == 'top, "the" float'


def test_several_moorings_share_one_header(make_result):
    both = to_csv([make_result(name="a"), make_result(name="b")])
    rows = list(csv.DictReader(io.StringIO(both)))
    assert {row["mooring"] for row in rows} == {"a", "b"}
    assert both.count("mooring,") == 1


def test_no_result_leaves_the_header():
    assert to_csv([]) == ",".join(header()) + "\n"
