"""What a record says of itself, or shows by its values, is said with a count or refused."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import xarray as xr

from calm.errors import InputError
from calm.records.current_file import open_record, read_current_file
from calm.records.current_terms import Terms
from calm.records.instrument_series import read_series
from calm.records.record import RULES, made_record

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
    with open_record(folder / "r.nc", Terms(seabed, place=(48.3, -5.2))) as read:
        return [note for note in read.notes if note not in RULES]


def refusal(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        open_record(path, Terms(SEABED, place=(48.3, -5.2)))
    return str(caught.value)


def test_a_good_record_is_not_spoken_of(record: xr.Dataset, tmp_path: Path) -> None:
    assert said(record, tmp_path) == []
    told = {
        "title": "Total currents of a tidal channel, with tides and residual circulation",
        "summary": "Pressure was low-pass filtered. The model was forced with tidal constituents.",
        "history": "converted from local time to UTC; spikes removed; averaged over 10 minutes",
        "comment": "Depths are relative to the ship. Not relative to the vessel. Tides are strong. "
        "Mean current 0.2 m/s. Turned from beam coordinates to the earth.",
        "keywords": "ADCP, tides, EARTH SCIENCE > OCEANS",
    }
    flags = ("time", "depth"), np.ones((720, 10), np.int8), {"standard_name": "status_flag"}
    assert said(record.assign(u_qc=flags).assign_attrs(told), tmp_path) == []


def every_day(record: xr.Dataset) -> xr.Dataset:
    return record.isel(time=slice(None, None, 24))


def with_values(name: str, value: Callable[[xr.Dataset], Any]) -> Callable[[Any], xr.Dataset]:
    return lambda record: record.assign({name: record[name].copy(data=value(record))})


def of_attribute(name: str, attribute: str, value: Any) -> Callable[[xr.Dataset], xr.Dataset]:
    return lambda record: record.assign({name: record[name].assign_attrs({attribute: value})})


def copied(record: xr.Dataset) -> xr.Dataset:
    """The readings of four days stand once more, ten days later."""
    for name in ("u", "v"):
        record[name].values[300:400] = record[name].values[50:150]
    return record


def poor(record: xr.Dataset) -> xr.Dataset:
    """Three of ten levels have one good ping in thirty."""
    share = np.where(np.arange(10) < 3, 3.0, 95.0) + np.zeros((720, 1))
    return record.assign(PERG=(("time", "depth"), share, {"units": "percent"}))


@pytest.mark.parametrize(("make", "expected"), [
    (every_day, "the 30 profiles are 24 h apart, so tides and peaks between them"),
    (lambda one: one * 0 + one * 0, "10 of 10 levels do not change for a tenth of the record"),
    (with_values("u", lambda one: one["u"].values[:1] + 0 * one["u"].values), None),
    (of_attribute("u", "valid_range", [-0.12, 0.12]), "values of `u` were excluded, because they"),
    (lambda one: one.assign_attrs(time_zone="CEST"), "`time_zone` is `CEST`, but CALM reads"),
    (of_attribute("u", "units", "kn"), "have different units, `kn` and `m s-1`"),
    (lambda one: one.where(one["depth"] != 40.0, 0.1), "1 of 10 levels do not change for a tenth"),
    (lambda one: one.where(one["time"] > 80, one.isel(time=0)), "at 4 m has 81 readings, from 202"),
    (lambda one: one.where(one["time"].values[:, None] % 2 > 0, 0.4 - one), "10 of 10 series app"),
    (copied, "100 readings from 2026-03-13T12:00 are the same as those from 2026-03-03T02:00"),
    (lambda one: one.sel(time=(one["time"] < 300) | (one["time"] > 500)), "1 gap in time: the lo"),
    (of_attribute("time", "units", "hours since 1949-12-31T20:00"), "4 of 720 times are before 1"),
    (of_attribute("time", "units", "hours since 2126-03-01"), "720 of 720 times are before 1950"),
    (poor, "for 2160 of 7200 currents, less than half of the pings are good"),
    (lambda one: one.where(one["time"].values[:, None] % 9 > 0, -2.0), "800 of 7200 eastward comp"),
    (lambda one: one.isel(depth=[0, 1, 2]), "has no level below 24.0 m, so the value of the"),
    (lambda one: one.isel(depth=[5, 9]), "has no level above 90.0 m, so the value of the near"),
])  # fmt: skip
def test_values_that_are_said(record, tmp_path, make, expected) -> None:
    dataset = make(record)
    for name in record.variables:
        dataset[name].attrs = {**record[name].attrs, **dataset[name].attrs}
    notes = said(dataset, tmp_path)
    assert (expected is None and notes == []) or any(expected in note for note in notes), notes


def test_records_that_stand_still_or_are_of_another_unit(record, tmp_path) -> None:
    still = record.copy(deep=True)
    for name in ("u", "v"):
        still[name][:] = record[name].values[:1]
    assert said(still, tmp_path) == [
        "10 of 10 levels do not change for a tenth of the record, or between most readings: the "
        "longest run of equal values at 4 m has 720 readings, from 2026-03-01T00:00 to "
        "2026-03-30T23:00"
    ]
    for name in ("u", "v"):
        record[name].values[:] /= 100.0
    (weak,) = said(record, tmp_path)
    assert weak.startswith(f"the strongest of {MANY} currents is 0.00")
    assert weak.endswith("in the declared unit, m s-1")


def test_flags_leave_out_what_is_bad_with_a_count(record, tmp_path) -> None:
    flags = np.ones((720, 10), np.int8)
    flags[100:300] = 4
    record["u"].values[100:300] = 3.0
    record["v_qc"] = ("time", "depth"), flags
    assert said(record, tmp_path) == [
        "2000 of 7200 currents were excluded, because `v_qc` marks them as bad"
    ]
    with open_record(tmp_path / "r.nc", Terms(SEABED)) as read:
        assert np.isnan(read.profiles(100, 101)[1]).all()
    with open_record(tmp_path / "r.nc", Terms(SEABED, on_the_line=True)) as read:
        assert (read.profiles(100, 101)[1] == 3.0).all()


@pytest.mark.parametrize("name", ["u_FLAG_W", "u_quality", "quality_flag", "QC_velocity"])
def test_flags_are_found_by_their_names(record, tmp_path, name) -> None:
    flags = np.where(np.arange(7200).reshape(720, 10) % 4, 1, 4).astype(np.int8)
    record[name] = ("time", "depth"), flags
    assert (
        f"1800 of 7200 currents were excluded, because `{name}` marks" in said(record, tmp_path)[0]
    )


def test_flags_of_another_variable_are_not_those_of_the_current(record, tmp_path) -> None:
    record["temperature_qc"] = ("time", "depth"), np.full((720, 10), 4, np.int8)
    assert said(record, tmp_path) == []


def test_flags_may_be_bits(record, tmp_path) -> None:
    bits = np.array([0, 1, 2, 10], np.int8)[np.arange(7200).reshape(720, 10) % 4]
    meanings = {"flag_masks": np.array([1, 2, 8], np.int8), "flag_meanings": "warm bad suspect"}
    record["u_qc"] = ("time", "depth"), bits, meanings
    assert said(record, tmp_path) == [
        "3600 of 7200 currents were excluded, because `u_qc` marks them as bad"
    ]
    with open_record(tmp_path / "r.nc", Terms(SEABED)) as read:
        assert read.flags(0, 1)[0, :4].tolist() == [1, 1, 4, 4]


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
    with open_record(tmp_path / "r.nc", Terms(SEABED)) as read:
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
    assert "`vozocrtx` has the standard name sea_water_x_velocity instead of" in refusal(
        tmp_path / "r.nc"
    )


@pytest.mark.parametrize(("begin", "kind"), [
    (b"MATLAB 5.0 MAT-file", "is a .mat file of MATLAB"), (b"GRIB\0\0\0\2", "is a GRIB file"),
    (b"MATLAB 7.3 MAT-file" + b"\0" * 493 + b"\x89HDF", "is a .mat file of MATLAB"),
    (b"PK\x03\x04", "a spreadsheet; unpack it"), (b"\x1f\x8b\x08", "is a packed file"),
    (b"\x7f\x7f\x01", "a raw Teledyne ADCP file"), (b"\xa5\x0a", "a raw Nortek file"),
    (b"\xd0\xcf\x11\xe0", "is a spreadsheet"), (b"\x0e\x03\x13\x01", "is an HDF 4 file"),
])  # fmt: skip
def test_files_of_other_kinds_are_refused_by_what_they_are(tmp_path, begin, kind) -> None:
    (tmp_path / "r.nc").write_bytes(begin + bytes(600))
    assert kind in refusal(tmp_path / "r.nc")
    with pytest.raises(InputError, match="CALM reads NetCDF, zarr and CSV"):
        read_current_file(tmp_path / "r.nc", None, Terms())


def test_groups_are_named(record, tmp_path) -> None:
    record.to_netcdf(tmp_path / "r.nc", engine="h5netcdf", group="adcp")
    assert "and the groups adcp, which are not read; extract one" in refusal(tmp_path / "r.nc")


def test_letters_of_comments_may_be_of_any_encoding(tmp_path: Path) -> None:
    rows = "\n".join(f"2026-03-01T{hour:02d}:00,10,0.{hour}1,0.2" for hour in range(9))
    text = f"# Messger\xe4t Nr. 3\ntime,depth[m],u[m/s],v[m/s]\n{rows}\n"
    (tmp_path / "r.csv").write_bytes(text.encode("latin-1"))
    with open_record(tmp_path / "r.csv", Terms(11.0)) as read:
        assert read.count == 9
    table, _ = read_current_file(tmp_path / "r.csv", "2026-03-01T03:00", Terms())
    assert table.u == (0.31,)


def table(head: str, row: Callable[[int, int], str], above: str = "") -> str:
    rows = (f"2026-03-0{1 + i // 24}T{i % 24:02d}:00,{z},{row(i, z)}" for i in range(72)
            for z in (10, 290))  # fmt: skip
    return "\n".join((*([above] if above else []), f"time,depth[m],{head}", *rows, ""))


def components_of(i: int, z: int) -> str:
    return f"{0.3 * np.cos(i / 2):.4f},{0.2 * np.sin(i / 2) + z / 5000:.4f}"


def notes_of(path: Path) -> list[str]:
    with open_record(path, Terms(SEABED)) as read:
        notes = [note for note in read.notes if note not in RULES]
    _, profile = read_current_file(path, "2026-03-01T05:00", Terms(water_depth=SEABED))
    assert profile == []
    return notes


@pytest.mark.parametrize(("turn", "told"), [(np.radians, True), (float, False)])
def test_directions_in_radians_are_said(tmp_path, turn, told) -> None:
    text = table("speed[m/s],toward[deg]", lambda i, z: f"0.3,{turn(5 * i + z / 100):.4f}")
    (tmp_path / "r.csv").write_text(text)
    assert [
        note.endswith("is the direction in radians, or in tens of degrees?")
        for note in notes_of(tmp_path / "r.csv")
    ] == [True] * told


def test_more_values_than_are_read_at_once_are_refused_before_reading(record, tmp_path) -> None:
    record.to_netcdf(tmp_path / "r.nc", engine="h5netcdf")
    with h5py.File(tmp_path / "r.nc", "a") as file:
        file.create_dataset("burst", (2_000_000_000,), "f8", chunks=(1_000_000,))
    assert (tmp_path / "r.nc").stat().st_size < 1_000_000
    assert "`burst` has 2,000,000,000 values, more than" in refusal(tmp_path / "r.nc")
    with h5py.File(tmp_path / "r.nc", "a") as file:
        del file["burst"]
        file.create_dataset("wide", (10**5, 10**5), "f4", chunks=(10**5, 10**3))
    assert "`wide` has 100,000,000 values" in refusal(tmp_path / "r.nc")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes with a name")
def test_a_pipe_is_no_regular_file(tmp_path) -> None:
    os.mkfifo(tmp_path / "p.nc")
    assert "is not a regular file" in refusal(tmp_path / "p.nc")
    with pytest.raises(InputError, match="is not a regular file"):
        read_series([str(tmp_path / "p.nc")], ["temperature"], frozenset({1}), SEABED)
    with pytest.raises(InputError, match="is not a regular file"):
        read_current_file(tmp_path / "p.nc", None, Terms())


def test_a_nominal_depth_that_fills_a_gap_is_none(tmp_path) -> None:
    rows = "\n".join(f"2026 3 {1 + i // 24} {i % 24}.0 {20 + i} {i}" for i in range(48))
    text = f"InstrDepth = -999\nColumns = YY:MM:DD:HH:U:V\n{rows}\n"
    (tmp_path / "m.use").write_text(text)
    told = "all level depths in `INSTRUMENT_DEPTH` are missing"
    assert told in refusal(tmp_path / "m.use")
    (tmp_path / "m.use").write_text(text.replace("-999", "120"))
    with open_record(tmp_path / "m.use", Terms(SEABED)) as read:
        assert np.ravel(read.profiles(0, 1)[0]).tolist() == [120.0]
