"""Currents from CSV files."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from calm.errors import InputError
from calm.files import CurrentTable, MooringFile
from calm.records.current_file import CsvRecord, read_current_file
from calm.records.current_terms import Terms, TimeChoiceError, parse_time
from calm.records.delimited import MOST_PROBLEMS

from .conftest import GOOD, Place

RECORD = """\
# a record of two profiles
time,depth[m],u[m/s],v[m/s]
2026-03-01T06:00,0,0.5,0.1
2026-03-01T06:00,50,0.3,0.0
2026-03-01T12:00:00Z,0,-0.5,0.1
2026-03-01T12:00:00Z,50,-0.3,0.0
"""


@pytest.fixture
def csv(tmp_path: Path) -> Path:
    return tmp_path / "current.csv"


def profile(path: Path, text: str, time: str | None = None) -> tuple[CurrentTable, list[str]]:
    path.write_text(text)
    return read_current_file(path, time, Terms(60.0))


def problems(path: Path, text: str) -> list[Place]:
    with pytest.raises(InputError) as caught:
        profile(path, text)
    return [(one.line, one.column, one.message) for one in caught.value.problems]


def test_components(csv: Path) -> None:
    table, notices = profile(csv, "depth[m],u[cm/s],v[m/s],w[m/s]\n0, 50 ,0.1,0\n\n100,20,0,-.01\n")
    assert table == CurrentTable((0.0, 100.0), (0.5, 0.2), (0.1, 0.0), (0.0, -0.01))
    assert notices == [
        "1 of 2 levels with values are deeper than the water, 60.0 m: the deepest is at 100.0 m "
        "(30.5 m, if these are feet)"
    ]


def test_speed_and_direction(csv: Path) -> None:
    table, _ = profile(csv, "depth[m],speed[m/s],toward[deg]\n0,0.5,180\n")
    assert table.v == (-0.5,)


def test_profile_of_a_time(csv: Path) -> None:
    table, notices = profile(csv, RECORD, "2026-03-01T06:00")
    assert (table.u, notices) == ((0.5, 0.3), [])
    table, notices = profile(csv, RECORD, "2026-03-01T10:00+00:00")
    assert table.u == (-0.5, -0.3)
    assert notices == [
        "the file has no current at 2026-03-01T10:00; the current at 2026-03-01T12:00 is used"
    ]


def test_levels_of_a_record_without_a_value_are_left_out(csv: Path) -> None:
    text = RECORD.replace("50,0.3,0.0", "50,,0.0").replace("0,-0.5,0.1", "0,-0.5, NaN")
    table, notices = profile(csv, text, "2026-03-01T06:00")
    assert (table.depth, notices[0]) == (
        (0.0,),
        "1 level without a value excluded from the current",
    )
    assert profile(csv, text, "2026-03-01T12:00")[0].depth == (50.0,)
    gap = text.replace("0,0.5,0.1", "0,,")
    with pytest.raises(InputError, match=r"current.csv:3:1: no level has a value"):
        profile(csv, gap, "2026-03-01T06:00")


def test_record_of_one_time_needs_no_choice(csv: Path) -> None:
    table, _ = profile(csv, "".join(RECORD.splitlines(keepends=True)[:4]))
    assert table.u == (0.5, 0.3)


@pytest.mark.parametrize(
    ("time", "message"),
    [
        (
            None,
            "the file has 2 time steps, 2026-03-01T06:00 to 2026-03-01T12:00; choose one with "
            "`time:`",
        ),
        (
            "2026-03-02",
            "2026-03-02T00:00 is outside the record, 2026-03-01T06:00 to 2026-03-01T12:00",
        ),
        ("noon", "`noon` is not a time; write 2026-03-01T06:00"),
        # nanoseconds cannot count these: they would become another year
        ("9999-12-31T00:00", "`9999-12-31T00:00` is not in the years 1678 to 2261"),
        ("0001-01-01T00:00+05:00", "`0001-01-01T00:00+05:00` is not in the years 1678 to 2261"),
        ("2026-03-01T06.30", "`2026-03-01T06.30` is not a time; write 2026-03-01T06:00"),
        ("2026-03-01T06:30.5", "`2026-03-01T06:30.5` is not a time; write 2026-03-01T06:00"),
        ("20260301T06,5+02:00", "`20260301T06,5+02:00` is not a time; write 2026-03-01T06:00"),
    ],
)
def test_times_that_cannot_be_chosen(csv: Path, time: str | None, message: str) -> None:
    with pytest.raises(TimeChoiceError) as caught:
        profile(csv, RECORD, time)
    assert str(caught.value) == message


def test_times_of_a_record_that_nanoseconds_cannot_count(csv: Path) -> None:
    csv.write_text("time,depth[m],u[m/s],v[m/s]\n2026-03-01T00:00,0,1,1\n9999-12-31,0,1,1\n")
    with pytest.raises(InputError, match=r"csv:3:1: `9999-12-31` is not in the years"):
        CsvRecord(csv, Terms(60.0), None, 1)


@pytest.mark.parametrize(
    "text", ["2026-03-01T06:00:15.5", "2026-03-01 060015,5", "20260301T060015.5Z"]
)
def test_parts_of_a_second(text: str) -> None:
    assert parse_time(text) == np.datetime64("2026-03-01T06:00:15.5")


def test_time_where_there_is_none(csv: Path) -> None:
    with pytest.raises(TimeChoiceError, match="the file has no column `time`"):
        profile(csv, "depth[m],u[m/s],v[m/s]\n0,1,1\n", "2026-03-01")


def test_mistakes_have_their_place(csv: Path) -> None:
    text = "depth[m],u[m/s],v[m/s]\n0,  1 knt,2\n10,1,nan\n10,1\n5,1,\n"
    assert problems(csv, text) == [
        (
            2,
            5,
            "`u: 1 knt` has an unknown unit, `knt`; a speed (m/s, cm/s, mm/s, knot, km/h, ft/s) is "
            "needed; did you mean `u: 1 knot`?",
        ),
        (3, 6, "`v: nan` is not a finite number"),
        (4, 1, "the row has 2 values; 3 are needed"),
        (5, 5, "`v` has no value"),
    ]


def test_column_of_a_record_with_a_mistake(csv: Path) -> None:
    assert problems(csv, "time,depth[m],u[m/s],v[m/s]\n2026-03-01,0,1,x\n") == [
        (2, 16, "`v: x` is not a speed (m/s, cm/s, mm/s, knot, km/h, ft/s)")
    ]
    [place] = problems(csv, "time,depth[m],u[m/s],v[m]\n2026-03-01,0,1,1\n")
    assert place[:2] == (1, 22)


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("", (0, 0, "is empty")),
        ("depth[m],u[m/s],v[m/s]\n", (1, 1, "the table has no rows")),
        (
            "depth[m]\n0\n",
            (1, 1, "`depth[m]` is not a header such as `depth[m],u[m/s],v[m/s]`"),
        ),
        ("0,1,1\n", (1, 1, "there is no header; did you mean `depth[m],u[m/s],v[m/s]`?")),
        (
            "time,depth[m],u[m/s],v[m/s]\nnoon,0,1,1\n",
            (2, 1, "`noon` is not a time; write 2026-03-01T06:00"),
        ),
        (
            "depth[m],speed[m/s]\n0,1\n",
            (
                1,
                1,
                "a current needs `u` and `v`, or `speed` and `toward`; "
                "the columns are depth, speed",
            ),
        ),
    ],
)
def test_files_that_are_no_current(csv: Path, text: str, place: Place) -> None:
    assert problems(csv, text) == [place]


def test_names_of_columns_in_capitals(csv: Path) -> None:
    text = "Time,DEPTH[m],U[m/s],v[m/s]\n2026-03-01T06:00,0,0.5,0.1\n"
    assert profile(csv, text)[0] == CurrentTable((0.0,), (0.5,), (0.1,), (0.0,))


def test_a_comma_at_every_lines_end_is_named_for_what_it_is(csv: Path) -> None:
    place = (1, 23, "the line ends in a comma; remove it from every line")
    assert problems(csv, "depth[m],u[m/s],v[m/s],\n0,1,1,\n10,1,1,\n") == [place]


def test_thousands_of_the_same_mistake_are_cut_short(csv: Path) -> None:
    found = problems(csv, "depth[m],u[m/s],v[m/s]\n" + "a,1,1\n" * 3000)
    assert len(found) == MOST_PROBLEMS + 1
    assert found[-1] == (0, 0, "and 2980 more mistakes")


def test_file_named_by_a_mooring(read: Callable[..., MooringFile], csv: Path) -> None:
    csv.write_text(RECORD)
    start, end = GOOD.index("  current:"), GOOD.index("line:")
    current = '  current: {file: current.csv, time: "2026-03-01T05:00"}\n'
    with pytest.raises(InputError) as caught:
        read(GOOD[:start] + current + GOOD[end:])
    [problem] = caught.value.problems
    assert (problem.line, problem.column) == (4, 38)
    assert "is outside the record" in problem.message
    mooring = read(GOOD[:start] + current.replace("05:00", "07:30") + GOOD[end:])
    assert mooring.environment.current.u == (0.5, 0.3)
    assert mooring.notices == (
        "the file has no current at 2026-03-01T07:30; the current at 2026-03-01T06:00 is used",
        "the current has no level below 50.0 m, so the value of the nearest level is used there; "
        "the water depth is 1100.0 m",
    )


def test_file_that_is_not_there(
    read: Callable[..., MooringFile], mistakes: Callable[..., list[Place]]
) -> None:
    start, end = GOOD.index("  current:"), GOOD.index("line:")
    text = GOOD[:start] + "  current: {file: nowhere.csv}\n" + GOOD[end:]
    assert mistakes(text) == [(4, 19, "`file: nowhere.csv`: no such file")]


def test_variant_with_a_file_is_read_when_chosen(
    read: Callable[..., MooringFile], csv: Path
) -> None:
    csv.write_text("depth[m],u[m/s],v[m/s]\n0,oops,1\n")
    text = GOOD + "environments:\n  measured: {current: {file: current.csv}}\n"
    assert read(text)
    with pytest.raises(InputError, match=r"current.csv:2:3: `u: oops` is not a speed"):
        read(text, "measured")


@pytest.mark.parametrize("zone", ["EST", "local", "UTC+2", "s"])
def test_a_column_of_times_of_another_zone(csv: Path, zone: str) -> None:
    csv.write_text(f"time[{zone}],depth[m],u[m/s],v[m/s]\n2026-03-01,5,0.4,0.1\n")
    with pytest.raises(InputError) as caught:
        read_current_file(csv, None, Terms())
    [problem] = caught.value.problems
    assert problem.message.startswith(f"`time[{zone}]`: times must be in UTC")
    csv.write_text("time[UTC],depth[m],u[m/s],v[m/s]\n2026-03-01,5,0.4,0.1\n")
    assert read_current_file(csv, None, Terms())[0].u == (0.4,)
