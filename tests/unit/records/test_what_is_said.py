"""What a record says of itself, or shows by its values, is said with a count or refused."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from calm.errors import InputError
from calm.records.current_file import open_record, read_current_file
from calm.records.current_terms import Terms
from calm.records.made_record import made_record
from calm.records.record import RULES

SEABED = 300.0
MANY = 7200
"""Currents of the record: 720 hours at ten levels."""


@pytest.fixture
def record(tmp_path: Path) -> xr.Dataset:
    """A record with nothing to be said of, to be made wrong."""
    (tmp_path / "made.nc").write_bytes(made_record())
    with xr.open_dataset(tmp_path / "made.nc", decode_times=False, engine="scipy") as file:
        dataset = file.load()
    for name in dataset.variables:
        dataset[name].encoding = {}
    dataset.attrs = {"title": "Mooring M1"}
    return dataset


def said(dataset: xr.Dataset, folder: Path, seabed: float = SEABED) -> list[str]:
    dataset.to_netcdf(folder / "r.nc", engine="h5netcdf")
    with open_record(folder / "r.nc", seabed=seabed, at=(48.3, -5.2)) as read:
        return [note for note in read.notes if note not in RULES]


def refusal(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        open_record(path, seabed=SEABED, at=(48.3, -5.2))
    return str(caught.value)


def test_a_good_record_is_not_spoken_of(record: xr.Dataset, tmp_path: Path) -> None:
    assert said(record, tmp_path) == []
    told = {
        "title": "Total currents of a tidal channel, with tides and residual circulation",
        "summary": "Pressure was low-pass filtered. The model was forced with tidal constituents.",
        "history": "converted from local time to UTC; spikes removed; averaged over 10 minutes",
        "comment": "Depths are relative to the ship. Not relative to the vessel.",
    }
    flags = ("time", "depth"), np.ones((720, 10), np.int8), {"standard_name": "status_flag"}
    assert said(record.assign(u_qc=flags).assign_attrs(told), tmp_path) == []


@pytest.mark.parametrize("words", [
    {"title": "Tidal currents predicted from harmonic constituents"},
    {"history": "t_tide prediction of 8 constituents"}, {"title": "Currents of TPXO9"},
    {"title": "95th percentiles of the current"}, {"title": "Standard deviation of currents"},
    {"summary": "Velocity anomalies"}, {"history": "cdo ymonmean in.nc out.nc"},
    {"comment": "Means over 1993 to 2016"}, {"history": "low-pass filtered, 40 h"},
    {"comment": "velocities are relative to the ship"}, {"summary": "glider-relative currents"},
    {"summary": "Currents (shear only)"}, {"summary": "rotated to along shore"},
])  # fmt: skip
def test_words_of_the_whole_file_refuse_it(record, tmp_path, words) -> None:
    record.assign_attrs(words).to_netcdf(tmp_path / "r.nc", engine="h5netcdf")
    (name,) = words
    assert f"by its {name}: {words[name]}" in refusal(tmp_path / "r.nc")


@pytest.mark.parametrize(("words", "meaning"), [
    ({"title": "Daily mean currents"}, "the peaks are higher than the means"),
    ({"history": "cdo daymean a.nc b.nc"}, "the peaks are higher than the means"),
    ({"summary": "100-year return values"}, "extremes by statistics are no currents of one time"),
    ({"title": "Tidal currents"}, "where it is the tide alone, the rest of the current is missing"),
])  # fmt: skip
def test_words_of_the_whole_file_that_are_said(record, tmp_path, words, meaning) -> None:
    ((name, text),) = words.items()
    assert said(record.assign_attrs(words), tmp_path) == [f"its {name} says `{text}`: {meaning}"]


def every_day(record: xr.Dataset) -> xr.Dataset:
    return record.isel(time=slice(None, None, 24))


def with_values(name: str, value: Callable[[xr.Dataset], Any]) -> Callable[[Any], xr.Dataset]:
    return lambda record: record.assign({name: record[name].copy(data=value(record))})


def of_attribute(name: str, attribute: str, value: Any) -> Callable[[xr.Dataset], xr.Dataset]:
    return lambda record: record.assign({name: record[name].assign_attrs({attribute: value})})


ZONE = "all 720 times are taken as they stand, in UTC"


@pytest.mark.parametrize(("make", "expected"), [
    (every_day, "its 30 profiles are 24 h apart, means or samples: tides and peaks between them"),
    (lambda one: one * 0 + one * 0, "7200 of 7200 currents are exactly 0"),
    (with_values("v", lambda one: -one["u"].values), "values: one of them is a copy of the other?"),
    (with_values("v", lambda one: 0 * one["u"].values), "are along one axis, their other compon"),
    (with_values("u", lambda one: one["u"].values[:1] + 0 * one["u"].values), None),
    (of_attribute("u", "valid_range", [-0.12, 0.12]), "values of `u` are left out, outside its v"),
    (of_attribute("time", "comment", "in local time"), f"`time` says `in local time`: {ZONE}"),
    (lambda one: one.assign_attrs(time_zone="CEST"), f"`time` says `CEST`: {ZONE}"),
    (lambda one: one.assign_attrs(comment="Times are local (UTC+2)"), ZONE),
    (lambda one: one.isel(depth=[0, 1, 2]), "the current is not given below 24.0 m: that of the"),
    (lambda one: one.isel(depth=[5, 9]), "the current is not given above 90.0 m: that of the near"),
])  # fmt: skip
def test_values_that_are_said(record, tmp_path, make, expected) -> None:
    dataset = make(record)
    for name in dataset.variables:
        dataset[name].attrs = {**record[name].attrs, **dataset[name].attrs}
    notes = said(dataset, tmp_path)
    assert (expected is None and notes == []) or any(expected in note for note in notes), notes


def test_records_that_stand_still_or_are_of_another_unit(record, tmp_path) -> None:
    still = record.copy(deep=True)
    for name in ("u", "v"):
        still[name][:] = record[name].values[:1]
    assert said(still, tmp_path) == ["719 of 720 profiles are the same as the one before"]
    for name in ("u", "v"):
        record[name].values[:] /= 100.0
    (weak,) = said(record, tmp_path)
    assert weak.startswith(f"the strongest of {MANY} currents is 0.00")


def test_flags_leave_out_what_is_bad_with_a_count(record, tmp_path) -> None:
    flags = np.ones((720, 10), np.int8)
    flags[100:300] = 4
    record["u"].values[100:300] = 3.0
    record["v_qc"] = ("time", "depth"), flags
    assert said(record, tmp_path) == [
        "2000 of 7200 currents are left out, as `v_qc` marks them as bad"
    ]
    with open_record(tmp_path / "r.nc", seabed=SEABED) as read:
        assert np.isnan(read.profiles(100, 101)[1]).all()
    with open_record(tmp_path / "r.nc", seabed=SEABED, on_the_line=True) as read:
        assert (read.profiles(100, 101)[1] == 3.0).all()


def test_distances_along_the_beam_are_no_heights(record, tmp_path) -> None:
    bins = record.rename(depth="bin").assign_coords(
        bin=(
            "bin",
            np.arange(10) * 8.0,
            {"units": "m", "long_name": "distance along the beam", "axis": "Z"},
        ),
        DEPTH=((), 100.0, {"units": "m", "positive": "down", "standard_name": "depth"}),
    )
    bins.to_netcdf(tmp_path / "r.nc", engine="h5netcdf")
    assert "`bin` is the distance along the beam, which is longer" in refusal(tmp_path / "r.nc")


NAMES = [
    ("U_320", "V_321"), ("LCEWAP01", "LCNSAP01"), ("LCEWZZ01", "LCNSZZ01"),
    ("vozocrtx", "vomecrty"), ("u_vel", "v_vel"), ("east_vel", "north_vel"), ("ucur", "vcur"),
]  # fmt: skip


@pytest.mark.parametrize("names", NAMES)
def test_names_that_archives_use(record, tmp_path, names) -> None:
    other = record.rename(u=names[0], v=names[1])
    for name in names:
        other[name].attrs = {"units": "METER/SEC"}
    notes = said(other, tmp_path)
    assert notes == [] or "vozocrtx" in names
    with open_record(tmp_path / "r.nc", seabed=SEABED) as read:
        assert np.array_equal(read.profiles(0, 720)[1], record["u"].values)


def test_a_grid_of_nemo_that_is_turned_is_refused(record, tmp_path) -> None:
    turned = record.rename(u="vozocrtx", v="vomecrty").drop_vars(["latitude", "longitude"])
    for name in ("vozocrtx", "vomecrty"):
        turned[name].attrs = {"units": "m/s"}
    turned = turned.expand_dims(y=2, x=2).assign_coords(
        nav_lat=(("y", "x"), [[48.0, 48.1], [48.2, 48.3]], {"units": "degrees_north"}),
        nav_lon=(("y", "x"), [[-5.0, -4.9], [-5.1, -5.2]], {"units": "degrees_east"}),
    )
    turned.to_netcdf(tmp_path / "r.nc", engine="h5netcdf")
    assert "`vozocrtx` is sea_water_x_velocity, which is not" in refusal(tmp_path / "r.nc")


@pytest.mark.parametrize(("begin", "kind"), [
    (b"MATLAB 5.0 MAT-file", "is a .mat file of MATLAB"), (b"GRIB\0\0\0\2", "is a GRIB file"),
    (b"MATLAB 7.3 MAT-file" + b"\0" * 493 + b"\x89HDF", "is a .mat file of MATLAB"),
    (b"PK\x03\x04", "a spreadsheet; unpack it"), (b"\x1f\x8b\x08", "is a packed file"),
    (b"\x7f\x7f\x01", "a raw file of a Teledyne ADCP"), (b"\xa5\x0a", "a raw file of a Nortek"),
    (b"\xd0\xcf\x11\xe0", "is a spreadsheet"), (b"\x0e\x03\x13\x01", "is an HDF 4 file"),
])  # fmt: skip
def test_files_of_other_kinds_are_refused_by_what_they_are(tmp_path, begin, kind) -> None:
    (tmp_path / "r.nc").write_bytes(begin + bytes(600))
    assert kind in refusal(tmp_path / "r.nc")
    with pytest.raises(InputError, match="NetCDF, zarr or CSV is read"):
        read_current_file(tmp_path / "r.nc", None, Terms())


def test_groups_are_named(record, tmp_path) -> None:
    record.to_netcdf(tmp_path / "r.nc", engine="h5netcdf", group="adcp")
    assert "and the groups adcp, which are not read: make one a fil" in refusal(tmp_path / "r.nc")


def test_letters_of_comments_may_be_of_any_encoding(tmp_path: Path) -> None:
    rows = "\n".join(f"2026-03-01T{hour:02d}:00,10,0.{hour}1,0.2" for hour in range(9))
    text = f"# Messger\xe4t Nr. 3\ntime,depth[m],u[m/s],v[m/s]\n{rows}\n"
    (tmp_path / "r.csv").write_bytes(text.encode("latin-1"))
    with open_record(tmp_path / "r.csv", seabed=11.0) as read:
        assert read.count == 9
    table, _ = read_current_file(tmp_path / "r.csv", "2026-03-01T03:00", Terms())
    assert table.u == (0.31,)
