"""Records in CSV; that each profile is that of `calm run` is in `test_record`."""

from pathlib import Path

import numpy as np
import pytest

from calm.errors import InputError
from calm.records import current_file
from calm.records.current_file import open_record
from calm.records.current_terms import Terms
from calm.records.delimited import MOST_PROBLEMS
from tests.unit.batch.records import COUNT, SEABED, write

HEAD = "time,depth[m],u[m/s],v[m/s]\n"


@pytest.fixture
def csv(tmp_path: Path) -> Path:
    return tmp_path / "record.csv"


def problems(path: Path, text: str) -> list[tuple[int, int, str]]:
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        open_record(path, Terms(SEABED))
    return [(one.line, one.column, one.message) for one in caught.value.problems]


def test_profiles_of_unlike_levels(csv: Path) -> None:
    csv.write_text(
        HEAD + "2026-03-01T00:00,0,0.5,0.1\n2026-03-01T00:00,50,,0.2\n"
        "# a comment\n\n2026-03-01T01:00, 10 ,0.25,nan\n"
        "2026-03-01T02:00,0,1,2\n2026-03-01T02:00,20,3,4\n2026-03-01T02:00,40,5,6\n"
    )
    with open_record(csv, Terms(SEABED)) as record:
        depth, u, v, w = record.profiles(0, 3)
        nan = np.nan
        np.testing.assert_array_equal(depth, [[0, 50, nan], [10, nan, nan], [0, 20, 40]])
        np.testing.assert_array_equal(u, [[0.5, nan, nan], [0.25, nan, nan], [1, 3, 5]])
        np.testing.assert_array_equal(v, [[0.1, 0.2, nan], [nan, nan, nan], [2, 4, 6]])
        assert w is None
        assert record.source == {"file": "record.csv", "columns": "depth[m], u[m/s], v[m/s]"}
        assert record.time[1] == np.datetime64("2026-03-01T01:00")


def test_cells_with_units_of_their_own(csv: Path) -> None:
    csv.write_text(
        "time,depth,u[m/s],v[m/s],w[cm/s]\n2026-03-01,5 m,50 cm/s,0,1\n2026-03-02,1 km,1,2,\n"
    )
    with open_record(csv, Terms(SEABED)) as record:
        depth, u, _, w = record.profiles(0, 2)
        assert depth[:, 0].tolist()[:1] == [5.0]
        assert np.isnan(u[1, 0])
        assert w is not None
        assert (u[0, 0], w[0, 0]) == (0.5, 0.01)


def test_a_column_without_a_unit_is_one_mistake(csv: Path) -> None:
    rows = [f"2026-03-01,{depth},0.1,0" for depth in range(0, 900, 5)]
    csv.write_text("\n".join(["time,depth,u,v[m/s]", *rows]))
    assert problems(csv, csv.read_text()) == [
        (1, 6, "column `depth` needs a unit; did you mean `depth[m]`?"),
        (1, 12, "column `u` needs a unit; did you mean `u[m/s]`?"),
    ]


@pytest.mark.parametrize("name", ["csv", "csv-speed"])
def test_how_much_is_read_together_does_not_matter(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    path = write(name, tmp_path, "csv")
    with open_record(path, Terms(SEABED)) as record:
        whole = record.profiles(0, COUNT)
    monkeypatch.setattr(current_file, "AT_ONCE", 3)
    with open_record(path, Terms(SEABED)) as record:
        for got, expected in zip(record.profiles(0, COUNT), whole, strict=True):
            assert got is expected is None or np.array_equal(got, expected, equal_nan=True)


def test_mistakes_are_all_told_with_their_place(csv: Path) -> None:
    text = HEAD + (
        "2026-03-01,0,0.5,x\n2026-03-01,-5,0,0\n2026-03-02,0,1\n2026-03-03,9,1,1\n"
        "2026-03-03,9,1,1\nnoon,0,0,0\n2026-03-04,0,0,8,1\n2026-03-05,,0,1\n"
    )
    assert problems(csv, text) == [
        (2, 18, "`v: x` is not a speed (m/s, cm/s, mm/s, knot, km/h, ft/s)"),
        (3, 12, "the depths are negative; depths must be positive down, so remove the signs"),
        (4, 1, "the row has 2 values; 3 are needed"),
        (6, 12, "depth 9 m repeats 9 m; depths must increase"),
        (7, 1, "`noon` is not a time; write 2026-03-01T06:00"),
        (8, 1, "the row has 4 values; 3 are needed; is there a decimal comma? Write 0.8, not 0,8"),
        (9, 12, "`depth` has no value"),
    ]


def test_thousands_of_the_same_mistake_are_cut_short(csv: Path) -> None:
    found = problems(
        csv, HEAD + "".join(f"2026-03-01T{i % 24:02d}:00,0,a,1\n" for i in range(3000))
    )
    assert len(found) == MOST_PROBLEMS + 1
    assert found[-1] == (0, 0, "and 2980 more mistakes")


def test_a_negative_speed_is_a_mistake(csv: Path) -> None:
    [place] = problems(csv, "time,depth[m],speed[m/s],toward[deg]\n2026-03-01,0,-1,90\n")
    assert place == (2, 14, "`speed` -1 m/s is negative; reverse `toward` instead")


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("", (0, 0, "is empty")),
        (HEAD, (0, 0, "has no times")),
        ("depth[m],u[m/s],v[m/s]\n0,1,1\n", (1, 1, "has no column `time`: it is one profile, for")),
        ("time,depth[m],u[m/s]\n2026-03-01,0,1\n", (1, 1, "a current needs `u` and `v`, or `spee")),
        ("time,depth[m],u[m/s],v[kg]\n2026-03-01,0,1,1\n2026-03-02,0,1,1\n", (1, 22, "`v[kg]` is")),
        ("a;b\n", (1, 1, "has no column `time`: it is one profile, for")),
        ("time\n", (1, 1, "`time` is not a header such as `time,depth[m],u[m/s],v[m/s]`")),
        (
            HEAD + "2026-03-01,0,1,1\n2026-03-02,0,1,1\n2026-03-01,5,1,1\n",
            (0, 0, "has two profiles at 2026-03-01T00:00; remove the duplicates"),
        ),
    ],
)
def test_files_that_are_no_record(csv: Path, text: str, place: tuple[int, int, str]) -> None:
    [(line, column, message)] = problems(csv, text)
    assert (line, column) == place[:2]
    assert message.startswith(place[2])


def test_text_that_is_not_utf_8(csv: Path) -> None:
    csv.write_bytes(HEAD.encode() + b"2026-03-01,0,1,\xff\n")
    with pytest.raises(InputError, match="is not UTF-8 text"):
        open_record(csv, Terms(SEABED))
