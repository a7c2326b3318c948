"""Every way to write a table in text, read by every reader of columns."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from calm.errors import InputError
from calm.exchange.table.cells import read_sheets
from calm.motion.measurements import read_currents
from calm.motion.sensors import depth_of, read_sea_level, read_sensors
from calm.ranging.ranges import read_ranges, read_sound
from calm.records.current_file import open_record, read_current_file
from calm.records.current_terms import Terms
from calm.records.delimited import copied_table
from calm.records.headings import heading
from calm.tui.water_tables import offered_headings, rows_in

Table = list[list[str]]


def quoted(cell: str) -> str:
    return f'"{cell}"'


def joined(table: Table, between: str) -> str:
    return "".join(between.join(row) + "\n" for row in table)


def decimal_commas(table: Table) -> Table:
    return [table[0], *([cell.replace(".", ",") for cell in row] for row in table[1:])]


def by_r(table: Table) -> str:
    """R's `write.csv`, which numbers the rows and quotes all words."""
    rows = [["", *table[0]], *([str(i), *row] for i, row in enumerate(table[1:], 1))]
    return joined([[cell if is_plain(cell) else quoted(cell) for cell in row] for row in rows], ",")


def is_plain(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


DIALECTS: dict[str, Callable[[Table], str]] = {
    "comma": lambda table: joined(table, ","),
    "comma and blank": lambda table: joined(table, ", "),
    "semicolon": lambda table: joined(table, ";"),
    "tab": lambda table: joined(table, "\t"),
    "blanks": lambda table: joined(
        [[quoted(cell) if " " in cell else cell for cell in row] for row in table], "  "
    ),
    "headings in quotes": lambda table: joined([list(map(quoted, table[0])), *table[1:]], ","),
    "all in quotes": lambda table: joined([list(map(quoted, row)) for row in table], ";"),
    "decimal comma, semicolon": lambda table: joined(decimal_commas(table), ";"),
    "decimal comma, tab": lambda table: joined(decimal_commas(table), "\t"),
    "decimal comma, quotes": lambda table: joined(
        [list(map(quoted, row)) for row in decimal_commas(table)], ","
    ),
    "by R": by_r,
    "units in parentheses": lambda table: joined(
        [[cell.replace("[", " (").replace("]", ")") for cell in table[0]], *table[1:]], ";"
    ),
    "units behind a blank": lambda table: joined(
        [[cell.replace("[", " ").replace("]", "") for cell in table[0]], *table[1:]], "\t"
    ),
    "a heading of two lines": lambda table: joined(
        [[quoted(cell.replace("[", "\n[")) for cell in table[0]], *table[1:]], ","
    ),
    "comments, Windows": lambda table: (
        "# by hand\r\n\r\n" + joined(table, ";").replace("\n", "\r\n")
    ),
}
TIMES = ["2026-03-01T00:00", "2026-03-01T01:00"]
PROFILE = [["depth[m]", "speed[cm/s]", "toward[deg]"], ["0", "50.5", "90"], ["100.5", "20", "90"]]
RECORD = [
    ["time", "depth[m]", "u[m/s]", "v[m/s]"],
    *([time, depth, u, "0.125"] for time in TIMES for depth, u in (("0", "0.5"), ("50.5", "0.25"))),
]
SENSORS = [
    ["time", "top[dbar]", "deep CTD[dbar]"],
    [TIMES[0], "50.5", "90"],
    [TIMES[1], "51", "NA"],
]
LEVEL = [["time", "level[cm]"], [TIMES[0], "50.5"], [TIMES[1], "-20"]]
RANGES = [["latitude[deg]", "longitude[deg]", "range[m]"], ["48.3", "-5.25", "2000.5"]]
SOUND = [["depth[m]", "sound_speed[m/s]"], ["0", "1500.5"], ["100", "1490"]]

each_dialect = pytest.mark.parametrize("written", DIALECTS.values(), ids=DIALECTS.keys())


@pytest.fixture
def write(tmp_path: Path, written: Callable[[Table], str]) -> Callable[[Table], Path]:
    def write(table: Table) -> Path:
        path = tmp_path / "a.csv"
        path.write_bytes(written(table).encode())
        return path

    return write


@each_dialect
def test_the_current_of_a_mooring(write: Callable[[Table], Path]) -> None:
    table, _ = read_current_file(write(PROFILE), None, Terms())
    assert table.depth == (0.0, 100.5)
    assert table.u == pytest.approx((0.505, 0.2))
    at_a_time, _ = read_current_file(write(RECORD), TIMES[1], Terms())
    assert (at_a_time.depth, at_a_time.u, at_a_time.v) == ((0.0, 50.5), (0.5, 0.25), (0.125, 0.125))


@each_dialect
def test_records_of_batch_and_motion(write: Callable[[Table], Path]) -> None:
    path = write(RECORD)
    with open_record(path, Terms(100.0)) as record:
        depth, u, v, _ = record.profiles(0, 2)
    assert depth.tolist() == [[0.0, 50.5]] * 2
    assert (u.tolist(), v.tolist()) == ([[0.5, 0.25]] * 2, [[0.125, 0.125]] * 2)
    (currents,) = read_currents([path], 100.0, None, None, 5.0)
    assert np.array_equal(currents.u, u)


@each_dialect
def test_pressures_and_the_sea_level(write: Callable[[Table], Path]) -> None:
    top, deep = read_sensors([str(write(SENSORS))], frozenset({1}), 48.0, 300.0)
    assert (top.label, deep.label) == ("top", "deep CTD")
    assert top.value == pytest.approx(depth_of(np.array([50.5, 51.0]), 48.0))
    assert np.isnan(deep.value).tolist() == [False, True]
    time, level = read_sea_level(write(LEVEL))
    assert level == pytest.approx([0.505, -0.2])
    assert time[1] == np.datetime64(TIMES[1])


@each_dialect
def test_ranges_and_the_speed_of_sound(write: Callable[[Table], Path]) -> None:
    survey = read_ranges(write(RANGES))
    assert (survey.latitude[0], survey.longitude[0], survey.measured[0]) == (48.3, -5.25, 2000.5)
    sound = read_sound(write(SOUND))
    assert (sound.depth.tolist(), sound.speed.tolist()) == ([0.0, 100.0], [1500.5, 1490.0])


@pytest.mark.parametrize(
    "written", [each for name, each in DIALECTS.items() if name != "by R"],
    ids=[name for name in DIALECTS if name != "by R"],
)  # fmt: skip
def test_texts_that_are_pasted(written: Callable[[Table], str]) -> None:
    columns = ("depth m", "speed cm/s", "toward deg")
    copied = copied_table(written(PROFILE))
    rows = rows_in(columns, offered_headings(copied.headings, columns), copied.rows)
    assert rows == (("0", "50.5", "90"), ("100.5", "20", "90"))


@pytest.mark.parametrize("name", [one for one in DIALECTS if one not in ("blanks", "by R")])
def test_lists_of_pieces_are_cut_alike(name: str, tmp_path: Path) -> None:
    path = tmp_path / "list.csv"
    path.write_bytes(DIALECTS[name]([["item", "length[m]"], ["8 mm wire", "50.5"]]).encode())
    (rows,) = read_sheets(path).rows.values()
    assert (rows[0][0], rows[1][0]) == ("item", "8 mm wire")
    assert rows[1][1].replace(",", ".") == "50.5"


WRONG = {
    "run": lambda path: read_current_file(path, None, Terms()),
    "batch": lambda path: open_record(path, Terms(100.0)),
    "motion": lambda path: read_sensors([str(path)], frozenset({1}), 48.0, 300.0),
    "locate": read_ranges,
}
HEADS = {
    "run": "depth[m]{0}u[m/s]{0}v[m/s]\n0{0}{1}{0}0\n5{0}0{0}\n",
    "batch": "time{0}depth[m]{0}u[m/s]{0}v[m/s]\n2026-03-01{0}0{0}{1}{0}0\n2026-03-01{0}5{0}0\n",
    "motion": "time{0}a[dbar]{0}b[dbar]\n2026-03-01{0}{1}{0}0\n2026-03-01{0}5\n",
    "locate": "latitude[deg]{0}longitude[deg]{0}range[m]\n48{0}{1}{0}9\n48{0}5\n",
}


@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize("reader", WRONG)
def test_mistakes_have_line_and_column_and_all_are_told(
    reader: str, separator: str, tmp_path: Path
) -> None:
    path = tmp_path / "a.csv"
    text = HEADS[reader].format(separator, "lost")
    path.write_text(text)
    with pytest.raises(InputError) as refused:
        WRONG[reader](path)
    first, second = refused.value.problems
    line = text.splitlines()[1]
    assert (first.line, first.column) == (2, line.index("lost") + 1)
    assert "lost" in first.message
    assert second.line == 3


@pytest.mark.parametrize("reader", WRONG)
def test_a_header_is_asked_for(reader: str, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    for text, said in (("", "is empty"), ("1;2;3\n", "there is no header; did you mean `")):
        path.write_text(text)
        with pytest.raises(InputError, match=said):
            WRONG[reader](path)


def test_a_comma_among_decimal_points_is_no_number(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("depth[m];u[m/s];v[m/s]\n0;0.5;0\n5;0,5;0\n")
    with pytest.raises(InputError, match=r":3:3: `u: 0,5` has a decimal comma; did you"):
        read_current_file(path, None, Terms())


def test_a_point_after_many_decimal_commas_is_not_taken_for_one(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    rows = [f"2026-03-{1 + i // 24:02d}T{i % 24:02d}:00;5;0,5;0,25\n" for i in range(300)]
    path.write_text("time;depth[m];u[m/s];v[m/s]\n" + "".join(rows) + "2026-04-01;5;1.234;0\n")
    with pytest.raises(InputError, match=r":302:14: `1.234` has a decimal point, but earlier"):
        open_record(path, Terms(100.0))
    path.write_text("time;depth[m];u[m/s];v[m/s]\n" + "".join(rows))
    with open_record(path, Terms(100.0)) as record:
        assert record.profiles(299, 300)[1].tolist() == [[0.5]]


def test_thousands_that_could_be_decimals_are_not_guessed(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("depth[m]\tu[m/s]\tv[m/s]\n0\t1\t1\n1,100\t1\t1\n")
    with pytest.raises(InputError, match=r"`depth: 1,100` has a comma; write"):
        read_current_file(path, None, Terms())


@pytest.mark.parametrize(
    ("column", "named"),
    [
        ("depth[m]", ("depth", "m")),
        ("Depth (m)", ("Depth", "m")),
        ("depth m", ("depth", "m")),
        ("drag [N/(m/s)^2]", ("drag", "N/(m/s)^2")),
        ("toward[deg magnetic]", ("toward", "deg magnetic")),
        ("time (UTC)", ("time", "UTC")),
        ("sound speed [m/s]", ("sound speed", "m/s")),
        ("depth", ("depth", "")),
    ],
)
def test_headings_are_a_name_and_a_unit(column: str, named: tuple[str, str]) -> None:
    assert heading(column) == named


@pytest.mark.parametrize(
    ("column", "named"),
    [
        ("top dbar", ("top", "dbar")),
        ("deep CTD 37 dbar", ("deep CTD 37", "dbar")),
        ("upper knot", ("upper", "knot")),
        ("m", ("m", "")),
        ("top float", ("top float", "")),
    ],
)
def test_labels_end_where_a_unit_begins(column: str, named: tuple[str, str]) -> None:
    assert heading(column, ("pressure", "length")) == named
