"""Current and density tables."""

import math
from collections.abc import Sequence

import pytest

from calm.errors import Problem
from calm.records.profile_tables import (
    CurrentTable,
    DepthTable,
    QuantityTable,
    SeaWater,
    read_current,
    read_profile,
    read_water,
)


def report(location: Sequence[str | int], message: str) -> Problem:
    return Problem(".".join(map(str, location)), 0, 0, message)


def current(columns: list[str], *rows: list[str]) -> tuple[CurrentTable | None, list[str]]:
    problems: list[Problem] = []
    table = read_current(QuantityTable(columns, rows, report, problems))
    return table, [str(problem) for problem in problems]


def test_speed_and_direction_become_components() -> None:
    table, problems = current(
        ["toward deg", "depth m", "speed knot"],
        ["90", "0", "1"],
        ["180", "50", "2"],
        ["0", "60", "0"],
    )
    assert problems == []
    assert table is not None
    knot = 1852 / 3600
    assert table.depth == (0.0, 50.0, 60.0)
    # Sines and cosines of right angles are zero to 2e-16.
    assert table.u == pytest.approx((knot, 0.0, 0.0), abs=1e-15)
    assert table.v == pytest.approx((0.0, -2 * knot, 0.0), abs=1e-15)
    assert table.w == (0.0, 0.0, 0.0)


def test_three_components() -> None:
    table, _ = current(["depth[m]", "u[cm/s]", "v[m/s]", "w[mm/s]"], ["0", "12", "-0.3", "4"])
    assert table == CurrentTable((0.0,), (0.12,), (-0.3,), (0.004,))


def test_vertical_speed_beside_speed_and_direction() -> None:
    table, _ = current(["depth m", "speed m/s", "toward deg", "w m/s"], ["10", "0.5", "0", "-0.01"])
    assert table is not None
    assert (table.v, table.w) == ((0.5,), (-0.01,))


def test_values_with_a_unit_of_their_own() -> None:
    table, _ = current(["depth", "u m/s", "v"], ["100 ft", "1 knot", "0"])
    assert table is not None
    assert table.depth == pytest.approx((30.48,), rel=1e-15)
    assert table.u == pytest.approx((1852 / 3600,), rel=1e-15)


@pytest.mark.parametrize(
    ("columns", "row", "problem"),
    [
        (["u m/s", "v m/s"], ["1", "1"], "columns: the table has no `depth` column"),
        (
            ["depth m", "u m/s", "v m/s", "speed m/s"],
            ["0", "1", "1", "1"],
            "columns: give `u` and `v`, or `speed` and `toward`, not both",
        ),
        (
            ["depth m", "u m/s"],
            ["0", "1"],
            "columns: a current needs `u` and `v`, or `speed` and `toward`; "
            "the columns are depth, u",
        ),
        (["depth m", "u m/s", "u m/s"], ["0", "1", "1"], "columns.2: column `u` is given twice"),
        (
            ["depth m", "u m/s", "v ms"],
            ["0", "1", "1"],
            "columns.2: `v ms` is a time; a speed (m/s, cm/s, mm/s, knot, km/h, ft/s) is needed",
        ),
        (
            ["depth m", "u m/s", "v M/S"],
            ["0", "1", "1"],
            "columns.2: `v M/S` is not a speed (m/s, cm/s, mm/s, knot, km/h, ft/s); "
            "did you mean `v m/s`?",
        ),
        (
            ["depth m", "u m/s", "v m/s"],
            ["0", "1", "x"],
            "rows.0.2: `v: x` is not a speed (m/s, cm/s, mm/s, knot, km/h, ft/s)",
        ),
        (
            ["depth m", "u m/s", "v m/s"],
            ["0", "1", "0,5"],
            "rows.0.2: `v: 0,5` has a decimal comma; did you mean `v: 0.5 m/s`?",
        ),
        (
            ["depth m", "u m/s", "v m/s"],
            ["-5", "1", "1"],
            "rows.0.0: depth -5 m is above the surface",
        ),
    ],
)
def test_mistakes(columns: list[str], row: list[str], problem: str) -> None:
    assert current(columns, row) == (None, [problem])


def test_places_are_right_after_a_row_of_the_wrong_width() -> None:
    _, problems = current(
        ["depth m", "speed m/s", "toward deg"],
        ["0", "1"],
        ["20", "-1", "0"],
        ["10", "1", "0"],
        ["30", "1", "0", "0"],
    )
    assert problems == [
        "rows.0: the row has 2 values; 3 are needed",
        "rows.3: the row has 4 values; 3 are needed; is there a decimal comma? Write 0.8, not 0,8",
        "rows.1.1: `speed` -1 m/s is negative; reverse `toward` instead",
        "rows.2.0: depth 10 m comes after 20 m; depths must increase",
    ]


def test_density() -> None:
    table = read_water(
        QuantityTable(["depth m", "density g/cm^3"], [["0", "1.02"], ["9", "1.03"]], report, [])
    )
    assert table == DepthTable((0.0, 9.0), (1020.0, 1030.0))


def test_temperature_and_salinity() -> None:
    columns = ["salinity", "depth[m]", "temperature[degC]"]
    found = read_water(
        QuantityTable(columns, [["35", "0", "-1.5"], ["35.16504 g/kg", "9", "4"]], report, [])
    )
    assert isinstance(found, SeaWater)
    assert found.temperature == DepthTable((0.0, 9.0), (-1.5, 4.0))
    assert found.salinity.value == pytest.approx((35.0, 35.0), rel=1e-15)


@pytest.mark.parametrize(
    ("columns", "row", "problem"),
    [
        (
            ["depth m", "density kg/m^3"],
            ["0", "-3"],
            "rows.0.1: `density: -3` must be at least 900 kg/m^3",
        ),
        (
            ["depth m"],
            ["0"],
            "columns: a density needs `density`, or `temperature` and `salinity`; "
            "the columns are depth",
        ),
        (
            ["depth m", "temperature degC"],
            ["0", "9"],
            "columns: a density needs `density`, or `temperature` and `salinity`; "
            "the columns are depth, temperature",
        ),
        (
            ["depth m", "temperature degC", "salinity", "density kg/m^3"],
            ["0", "9", "35", "1027"],
            "columns: a density needs `density`, or `temperature` and `salinity`; "
            "the columns are depth, temperature, salinity, density",
        ),
        (["density kg/m^3"], ["1027"], "columns: the table has no `depth` column"),
        (
            ["depth m", "temperature degC", "salinity"],
            ["0", "-10", "35"],
            "rows.0.1: `temperature: -10` must be at least -6 degC",
        ),
        (
            ["depth m", "temperature degC", "salinity g/kg"],
            ["0", "10", "-35"],
            "rows.0.2: `salinity: -35` must be at least 0",
        ),
        (
            ["depth m", "temperature F", "salinity"],
            ["0", "10", "35"],
            "columns.1: `temperature F` is not a temperature in degC",
        ),
    ],
)
def test_mistakes_in_a_table_of_the_water(columns: list[str], row: list[str], problem: str) -> None:
    problems: list[Problem] = []
    assert read_water(QuantityTable(columns, [row], report, problems)) is None
    assert [str(problem) for problem in problems] == [problem]


def test_profile_of_one_quantity() -> None:
    table = read_profile(
        "salinity", QuantityTable(["depth m", "salinity PSU"], [["5", "35"]], report, [])
    )
    assert table == DepthTable((5.0,), (35.0,))
    problems: list[Problem] = []
    assert read_profile("salinity", QuantityTable(["depth m"], [["5"]], report, problems)) is None
    assert (
        read_profile(
            "salinity",
            QuantityTable(["depth m", "temperature degC"], [["5", "3"]], report, problems),
        )
        is None
    )
    assert [str(problem) for problem in problems] == [
        "columns: the table has no `salinity` column",
        "columns.1: no column is called `temperature`; allowed: depth, salinity",
    ]


def test_the_whole_circle_of_directions() -> None:
    for toward in range(-360, 361, 15):
        table, _ = current(["depth m", "speed m/s", "toward deg"], ["0", "2", str(toward)])
        assert table is not None
        # 2 m/s, to the rounding of sine and cosine.
        assert math.hypot(table.u[0], table.v[0]) == pytest.approx(2.0, rel=1e-15)
        assert math.sin(math.radians(toward)) * 2 == pytest.approx(table.u[0], abs=1e-15)
