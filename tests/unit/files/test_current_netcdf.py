"""Currents from CF NetCDF files, by standard names and by the names models and archives use."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from calm.errors import InputError
from calm.files import CurrentTable, MooringFile
from calm.records.current_file import read_current_file
from calm.records.current_terms import Terms, TimeChoiceError

from .conftest import GOOD

DEPTH = ("depth", [5.0, 50.0, 200.0], {"units": "m", "positive": "down", "axis": "Z"})
TIME = ("time", np.array(["2026-03-01T00", "2026-03-01T06"], dtype="datetime64[ns]"))
EAST = {"standard_name": "eastward_sea_water_velocity", "units": "m s-1"}
NORTH = {"standard_name": "northward_sea_water_velocity", "units": "m s-1"}
UP = {"standard_name": "upward_sea_water_velocity", "units": "m s-1"}

U = [0.5, 0.25, 0.125]
V = [-0.5, -0.25, 0.0]


def profile(**variables: Any) -> xr.Dataset:
    return xr.Dataset(
        {"uo": ("depth", U, EAST), "vo": ("depth", V, NORTH), **variables}, {"depth": DEPTH}
    )


def read(
    dataset: xr.Dataset, folder: Path, time: str | None = None, engine: str = "h5netcdf"
) -> tuple[CurrentTable, list[str]]:
    path = folder / "current.nc"
    dataset.to_netcdf(path, engine=engine)
    return read_current_file(path, time, Terms(220.0))


def problem(dataset: xr.Dataset, folder: Path) -> str:
    with pytest.raises(InputError) as caught:
        read(dataset, folder)
    [found] = caught.value.problems
    assert (found.path, found.line) == (str(folder / "current.nc"), 0)
    return found.message


@pytest.mark.parametrize("engine", ["h5netcdf", "scipy"])
def test_standard_names(tmp_path: Path, engine: str) -> None:
    dataset = profile(wo=("depth", [0.0, 0.01, 0.0], UP)).rename(uo="a", vo="b", wo="c")
    table, notices = read(dataset, tmp_path, engine=engine)
    assert table == CurrentTable((5.0, 50.0, 200.0), tuple(U), tuple(V), (0.0, 0.01, 0.0))
    assert notices == []


@pytest.mark.parametrize(
    "names", [("uo", "vo"), ("u", "v"), ("UCUR", "VCUR"), ("water_u", "water_v")]
)
def test_usual_names(tmp_path: Path, names: tuple[str, str]) -> None:
    dataset = profile().rename(uo=names[0], vo=names[1])
    for name in names:
        dataset[name].attrs = {"units": "cm/s"}
    table, _ = read(dataset, tmp_path)
    assert table.u == pytest.approx([u / 100 for u in U], rel=1e-15)


@pytest.mark.parametrize(
    ("standard_name", "sign"),
    [
        ("sea_water_velocity_to_direction", 1),
        ("direction_of_sea_water_velocity", 1),
        ("sea_water_velocity_from_direction", -1),
    ],
)
def test_speed_and_direction(tmp_path: Path, standard_name: str, sign: int) -> None:
    attributes = {"standard_name": standard_name, "units": "degree_true"}
    dataset = xr.Dataset(
        {
            "cspd": (
                "depth",
                [1.0, 1.0, 2.0],
                {"standard_name": "sea_water_speed", "units": "m/s"},
            ),
            "cdir": ("depth", [0.0, 90.0, 210.0], attributes),
        },
        {"depth": DEPTH},
    )
    table, _ = read(dataset, tmp_path)
    # Sines and cosines, to rounding.
    assert table.u == pytest.approx([0.0, sign * 1.0, sign * -1.0], abs=1e-15)
    assert table.v == pytest.approx([sign * 1.0, 0.0, sign * -(3**0.5)], abs=1e-15)


def record() -> xr.Dataset:
    """Two profiles at one position, as an archive holds them."""
    shape = ("time", "depth", "lat", "lon")
    u = np.stack([U, [2 * u for u in U]])[:, :, None, None]
    v = np.stack([V, [2 * v for v in V]])[:, :, None, None]
    return xr.Dataset(
        {"uo": (shape, u.astype("f4"), EAST), "vo": (shape, v.astype("f4"), NORTH)},
        {"time": TIME, "depth": DEPTH, "lat": [48.3], "lon": [-5.2]},
    )


def test_profile_of_a_time(tmp_path: Path) -> None:
    table, notices = read(record(), tmp_path, "2026-03-01T06:00")
    assert (table.u, notices) == ((1.0, 0.5, 0.25), [])
    table, notices = read(record(), tmp_path, "2026-03-01T02:00")
    assert table.u == tuple(U)
    assert notices == [
        "the file has no current at 2026-03-01T02:00; the current at 2026-03-01T00:00 is used"
    ]
    table, _ = read(record().isel(time=[1]), tmp_path)
    assert table.u == (1.0, 0.5, 0.25)


@pytest.mark.parametrize(
    ("time", "message"),
    [
        (
            None,
            "the file has 2 time steps, 2026-03-01T00:00 to 2026-03-01T06:00; choose one",
        ),
        ("2026-03-01T06:01", "is outside the record"),
        ("six", "`six` is not a time"),
    ],
)
def test_times_that_cannot_be_chosen(tmp_path: Path, time: str | None, message: str) -> None:
    with pytest.raises(TimeChoiceError, match=message):
        read(record(), tmp_path, time)
    with pytest.raises(TimeChoiceError, match="the file has no times"):
        read(profile(), tmp_path, "2026-03-01")


def test_a_time_that_occurs_twice_is_not_chosen(tmp_path: Path) -> None:
    twice = record().isel(time=[0, 1, 1])
    assert read(twice, tmp_path, "2026-03-01T00:00")[0].u == tuple(U)
    with pytest.raises(TimeChoiceError, match="have the time 2026-03-01T06:00; remove one"):
        read(twice, tmp_path, "2026-03-01T05:00")


def test_levels_without_a_value_are_left_out(tmp_path: Path) -> None:
    dataset = profile()
    dataset["uo"][1] = np.nan
    table, notices = read(dataset, tmp_path)
    assert table.depth == (5.0, 200.0)
    assert notices == ["1 level without a value excluded from the current"]


def test_levels_above_the_surface_are_left_out(tmp_path: Path) -> None:
    dataset = profile().assign_coords(depth=("depth", [-3.0, 4.0, 11.0], DEPTH[2]))
    table, notices = read(dataset, tmp_path)
    assert table.depth == (4.0, 11.0)
    assert notices[0] == "1 level above the surface excluded from the current"


@pytest.mark.parametrize(
    ("levels", "attributes", "depths", "deepest_first"),
    [
        ([-5.0, -50.0, -200.0], {"positive": "up"}, (5.0, 50.0, 200.0), False),
        ([-200.0, -50.0, -5.0], {"positive": "up"}, (5.0, 50.0, 200.0), True),
        ([0.005, 0.05, 0.2], {"units": "km", "positive": "down"}, (5.0, 50.0, 200.0), False),
        (
            [10.0, 20.0, 30.0],
            {"positive": "up", "standard_name": "height_above_sea_floor"},
            (190.0, 200.0, 210.0),
            True,
        ),
    ],
)
def test_levels_in_other_words(
    tmp_path: Path,
    levels: list[float],
    attributes: dict[str, str],
    depths: tuple[float, ...],
    deepest_first: bool,
) -> None:
    coordinate = ("level", levels, {"units": "m", **attributes})
    dataset = profile().rename(depth="level").assign_coords(level=coordinate)
    table, _ = read(dataset, tmp_path)
    assert table.depth == pytest.approx(depths, rel=1e-15)
    assert table.u == tuple(reversed(U) if deepest_first else U)


def test_one_current_meter_is_a_profile_of_one_level(tmp_path: Path) -> None:
    dataset = profile().isel(depth=1)
    table, _ = read(dataset, tmp_path)
    assert table == CurrentTable((50.0,), (0.25,), (-0.25,), (0.0,))


@pytest.mark.parametrize(("flags", "told", "left"), [
    ([1, 0, 4], {}, (5.0, 50.0)), ([9, 2, 8], {}, (50.0, 200.0)), ([1, 1, 3], {}, (5.0, 50.0)),
    ([48, 49, 52], {}, (5.0, 50.0)),
    (["1", "A", "4"], {"standard_name": "status_flag"}, (5.0, 50.0)),
    ([0, 1, 0], {"flag_values": [0, 1], "flag_meanings": "good bad"}, (5.0, 200.0)),
    ([3, 4, 9], {"flag_values": [3, 4, 9], "flag_meanings": "raw seen fine"}, (5.0, 50.0, 200.0)),
])  # fmt: skip
def test_currents_that_are_flagged_as_bad_are_left_out(tmp_path, flags, told, left) -> None:
    table, notices = read(profile(uo_QC=("depth", flags, told)), tmp_path)
    assert table.depth == left
    said = "1 of 3 currents were excluded, because `uo_QC` marks them as bad"
    assert (said in notices) == (len(left) < 3)


def test_no_current_in_the_file(tmp_path: Path) -> None:
    dataset = xr.Dataset({"temperature": ("depth", U)}, {"depth": DEPTH})
    assert problem(dataset, tmp_path) == (
        "holds no current: CALM searches for an eastward and a northward velocity, or for a speed "
        "and a direction, first by CF standard name, then by usual name; it holds "
        "temperature (depth 3); depth (depth 3) [m]"
    )


def test_files_that_cannot_be_understood(tmp_path: Path) -> None:
    attributes = {"units": "m", "positive": "down"}
    wide = profile().expand_dims(member=2)
    assert problem(wide, tmp_path).startswith(
        "`uo` is not a single profile; it has the dimensions member (2), depth (3); it holds "
    )
    unit = profile()
    unit["uo"].attrs["units"] = "kg"
    assert problem(unit, tmp_path).startswith("`uo`: its unit, `kg`, is a mass; a speed")
    unplaced = problem(profile().drop_vars("depth"), tmp_path)
    assert unplaced.startswith("the levels have no depth; it holds uo (depth 3) [m s-1] eastward")
    unclear = profile().rename(depth="z")
    unclear["z"].attrs = {"units": "m"}
    assert problem(unclear, tmp_path).startswith(
        "`z` does not say whether it is `positive` up or down; it holds "
    )
    empty = profile() * np.nan
    for name, source in (("uo", EAST), ("vo", NORTH)):
        empty[name].attrs = source
    assert problem(empty, tmp_path) == "no level below the surface has a value"
    twice = profile().assign_coords(depth=("depth", [5.0, 5.0, 9.0], attributes))
    assert problem(twice, tmp_path) == "two levels have the same depth"
    both = profile(u2=("depth", U, EAST))
    assert problem(both, tmp_path).startswith(
        "several variables have the standard name eastward_sea_water_velocity: u2, uo; it holds "
    )


def grid() -> xr.Dataset:
    return (
        profile()
        .expand_dims(lat=[48.2, 48.3], lon=[354.7, 354.8])
        .assign(uo=lambda wide: wide["uo"] * (1 + wide["lat"] - 48.2) * (1 + wide["lon"] - 354.7))
        .assign(uo=lambda wide: wide["uo"].assign_attrs(EAST))
    )


def test_column_of_a_place(tmp_path: Path) -> None:
    path = tmp_path / "current.nc"
    grid().to_netcdf(path, engine="h5netcdf")
    table, notices = read_current_file(path, None, Terms(220.0, (48.28, -5.31)))
    assert table.u == pytest.approx([1.1 * u for u in U])
    assert notices == [
        "for 48.28° N 5.31° W, the nearest water column is at 48.3° N 5.3° W, 2.3 km away"
    ]
    assert problem(grid(), tmp_path).startswith(
        "the file has 4 water columns, 48.2° N 5.3° W to 48.3° N 5.2°"
    )


def test_a_grid_is_read_at_the_position_of_the_mooring(
    read: Callable[..., MooringFile], tmp_path: Path
) -> None:
    grid().to_netcdf(tmp_path / "grid.nc", engine="h5netcdf")
    start, end = GOOD.index("  current:"), GOOD.index("line:")
    text = GOOD[:start] + "  current: {file: grid.nc}\n" + GOOD[end:]
    place = "position: {latitude: 48.19 deg, longitude: -5.2 deg}\n"
    assert read(place + text).environment.current.u == pytest.approx([1.1 * u for u in U])
    with pytest.raises(
        InputError, match=r"the file has 4 water columns, .* or the `position` of the mooring"
    ):
        read(text)


def test_a_zarr_folder_is_a_file_too(read: Callable[..., MooringFile], tmp_path: Path) -> None:
    profile().to_zarr(tmp_path / "current.zarr", zarr_format=2, consolidated=False)
    start, end = GOOD.index("  current:"), GOOD.index("line:")
    text = GOOD[:start] + "  current: {file: current.zarr}\n" + GOOD[end:]
    assert read(text).environment.current.u == tuple(U)
    (tmp_path / "folder").mkdir()
    with pytest.raises(InputError, match="folder: is a folder but not a zarr store"):
        read(text.replace("current.zarr", "folder"))


@pytest.mark.parametrize("signature", [b"\x89HDF\r\n\x1a\n", b"CDF\x01"])
def test_damaged_files(tmp_path: Path, signature: bytes) -> None:
    path = tmp_path / "current.nc"
    path.write_bytes(signature + b"nothing that makes sense" * 9)
    with pytest.raises(InputError, match=r"current.nc: cannot be read as NetCDF: "):
        read_current_file(path, None, Terms(220.0))
