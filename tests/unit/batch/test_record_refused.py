"""Records that cannot be understood are refused with the reason and with what they hold."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from calm.errors import InputError
from calm.records.current_file import open_record
from calm.records.current_terms import Terms
from tests.unit.batch.records import HERE, SEABED, adcp, adcp_by_distance, curvilinear, glorys


def refusal(dataset: xr.Dataset, folder: Path, at: tuple[float, float] | None = HERE) -> str:
    path = folder / "record.nc"
    dataset.to_netcdf(path, engine="h5netcdf")
    with pytest.raises(InputError) as caught:
        open_record(path, Terms(SEABED, place=at))
    [problem] = caught.value.problems
    assert problem.path == str(path)
    return problem.message


def test_what_it_holds_is_listed(tmp_path: Path) -> None:
    dataset = adcp().drop_vars("v")
    assert refusal(dataset, tmp_path) == (
        "holds no current: CALM searches for an eastward and a northward velocity, or for a speed "
        "and a direction, first by CF standard name, then by usual name; it holds "
        "u (time 7, bin 5) [mm s-1] eastward_sea_water_velocity; "
        "w (time 7, bin 5) [mm s-1] upward_sea_water_velocity; "
        "bin_depths (time 7, bin 5) [m]; time (time 7) [seconds since 2026-03-01] time; bin (bin 5)"
    )


def test_a_long_list_is_cut_short(tmp_path: Path) -> None:
    dataset = xr.Dataset({f"t{i}": ("n", [0.0]) for i in range(40)})
    message = refusal(dataset, tmp_path)
    assert message.endswith(
        "; it holds t0 (n 1); t1 (n 1); t2 (n 1); t3 (n 1); t4 (n 1); and 35 more"
    )


def staggered() -> xr.Dataset:
    return curvilinear().assign(b=curvilinear()["b"].rename(x="xv"))


def direction_of_no_convention() -> xr.Dataset:
    dataset = adcp().drop_vars(["u", "v"]).rename(w="speed")
    dataset["speed"].attrs = {"units": "m/s"}
    return dataset.assign(direction=dataset["speed"].assign_attrs(units="degree"))


def along_a_turned_grid() -> xr.Dataset:
    dataset = curvilinear().rename(a="uo", b="vo")
    dataset["uo"].attrs["standard_name"] = "sea_water_x_velocity"
    return dataset


def with_attributes(dataset: xr.Dataset, name: str, **attributes: str) -> xr.Dataset:
    dataset[name].attrs |= attributes
    return dataset


@pytest.mark.parametrize(
    ("make", "reason"),
    [
        (staggered, "`a` and `b` are on different points of a staggered grid"),
        (
            direction_of_no_convention,
            "`direction` is ambiguous: the current may flow to this direction or come from it; "
            "its `standard_name` should be sea_water_velocity_to_direction or "
            "sea_water_velocity_from_direction",
        ),
        (
            along_a_turned_grid,
            "`uo` has the standard name sea_water_x_velocity instead of eastward_sea_",
        ),
        (
            lambda: with_attributes(adcp(), "u", standard_name="eastward_wind"),
            "`u` has the standard name eastward_wind instead of eastward_sea_water_velocity",
        ),
        (
            lambda: with_attributes(adcp(), "time", units="months since 2026-03-01"),
            "the times in `time` cannot be read: their unit, `months since 2026-03-01`, is none of "
            "seconds, minutes, hours or days since a date",
        ),
        (
            lambda: glorys().assign_coords(depth=-glorys()["depth"].assign_attrs(positive="down")),
            "`depth` is positive down, but all levels are above the surface: its sign or its",
        ),
        (lambda: with_attributes(adcp(), "u", units="kg"), "`u`: its unit, `kg`, is a mass; a spe"),
        (lambda: with_attributes(adcp(), "u", units=""), "`u` has no `units`"),
        (lambda: adcp().drop_vars("bin_depths"), "the levels have no depth"),
        (
            lambda: with_attributes(adcp(), "bin_depths", units="dbar"),
            "`bin_depths`: its unit, `dbar`, is a pressure; a length",
        ),
        (
            lambda: adcp_by_distance().drop_vars("DEPTH"),
            "`HEIGHT_ABOVE_SENSOR` is measured from the instrument, whose depth is not in the file",
        ),
        (
            lambda: adcp().expand_dims(member=3),
            "`u` is not a single profile; it has the dimensions member (3), time (7), bin (5)",
        ),
        (lambda: adcp().isel(time=0).drop_vars("time"), "has no times: it is one profile, for"),
        (
            lambda: glorys().assign_coords(latitude=glorys()["latitude"] + 9),
            "outside the grid of the file",
        ),
        (
            lambda: glorys().where(glorys()["latitude"] < 0),
            "no water column around 48.3° N 5.2° W contains a current (columns searched: 12)",
        ),
        (
            lambda: with_attributes(adcp(), "time", calendar="noleap"),
            "the times in `time` follow the calendar `noleap`, which CALM cannot convert "
            "to real dates; the supported calendars are standard, gregorian, proleptic_gregorian",
        ),
        (
            lambda: adcp().assign_coords(time=adcp()["time"].where(adcp()["time"] > 900.0)),
            "2 of the 7 times in `time` have no value",
        ),
        (
            lambda: adcp().assign_coords(time=adcp()["time"].where(adcp()["time"] > 1e9)),
            "7 of the 7 times in `time` have no value",
        ),
        (
            lambda: adcp().assign_coords(time=adcp()["time"] // 2000),
            "has two profiles at 2026-03-01T00:00, and at 4 more times; remove the duplicates",
        ),
    ],
)
def test_reasons(tmp_path: Path, make: Callable[[], xr.Dataset], reason: str) -> None:
    assert reason in refusal(make(), tmp_path)


def test_several_columns_and_no_place(tmp_path: Path) -> None:
    assert refusal(glorys(), tmp_path, None).startswith(
        "the file has 12 water columns, 48.22° N 5.29° W to 48.38° N 5.04° W; select one "
        "with `--at LAT,LON` or the `position` of the mooring file; it holds uo (time 7, depth "
        "5, latitude 3, "
    )


def test_x_is_east_along_latitudes(tmp_path: Path) -> None:
    path = tmp_path / "regular.nc"
    dataset = glorys()
    dataset["uo"].attrs["standard_name"] = "sea_water_x_velocity"
    dataset.to_netcdf(path, engine="h5netcdf")
    with open_record(path, Terms(SEABED, place=HERE)) as record:
        note = (
            "`uo`, with the standard name sea_water_x_velocity, is used as eastward velocity, "
            "because the grid is regular in latitude and longitude"
        )
        assert note in record.notes


def test_a_single_place_far_away_is_told(tmp_path: Path) -> None:
    path = tmp_path / "point.nc"
    dataset = adcp().assign_coords(lat=((), 49.0), lon=((), -5.2))
    dataset.to_netcdf(path, engine="h5netcdf")
    with open_record(path, Terms(SEABED, place=HERE)) as record:
        # 0.7 degrees of 111.2 km
        assert (
            record.notes[0]
            == "the only position in the file, 49° N 5.2° W, is 78 km from 48.3° N 5.2° W"
        )


def test_land_of_zeros_is_land(tmp_path: Path) -> None:
    path = tmp_path / "zeros.nc"
    glorys().fillna(0.0).to_netcdf(path, engine="h5netcdf")
    with open_record(path, Terms(SEABED, place=HERE)) as record:
        assert record.source["longitude"] == "-5.12"


@pytest.mark.parametrize("signature", [b"\x89HDF\r\n\x1a\n", b"CDF\x01"])
def test_damaged_files(tmp_path: Path, signature: bytes) -> None:
    path = tmp_path / "record.nc"
    path.write_bytes(signature + b"nothing that makes sense" * 9)
    with pytest.raises(InputError, match=r"record.nc: cannot be read as NetCDF: "):
        open_record(path, Terms(SEABED))


def test_a_record_without_a_profile(tmp_path: Path) -> None:
    assert "has no times" in refusal(adcp().isel(time=np.array([], int)), tmp_path)


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("ODF_HEADER,\n EVENT_HEADER,\n  DATA_TYPE='MCM',\n -- DATA --\n", "an ODF file"),
        ("*2020/01/01 12:00:00.00\n*IOS HEADER VERSION 2.0\n*FILE\n", "an IOS Shell file"),
    ],
)
def test_texts_of_archives_are_named(text: str, kind: str, tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text(text)
    with pytest.raises(InputError, match=f"is {kind}"):
        open_record(path, Terms(SEABED))
