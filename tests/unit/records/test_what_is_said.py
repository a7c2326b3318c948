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


@pytest.mark.parametrize("words", [
    {"title": "Tidal currents predicted from harmonic constituents"},
    {"history": "t_tide prediction of 8 constituents"}, {"title": "Currents of TPXO9"},
    {"title": "95th percentiles of the current"}, {"title": "Standard deviation of currents"},
    {"summary": "Velocity anomalies"}, {"history": "cdo ymonmean in.nc out.nc"},
    {"comment": "Means over 1993 to 2016"}, {"history": "low-pass filtered, 40 h"},
    {"comment": "velocities are relative to the ship"}, {"summary": "glider-relative currents"},
    {"summary": "Currents (shear only)"}, {"summary": "rotated to along shore"},
    {"source": "detided with t_tide"}, {"comment": "25-hour running mean"},
    {"history": "subtracted the 1993-2012 mean"}, {"title": "Baroclinic profiles"},
    {"comment": "velocities in beam coordinates"},
])  # fmt: skip
def test_words_of_the_whole_file_refuse_it(record, tmp_path, words) -> None:
    record.assign_attrs(words).to_netcdf(tmp_path / "r.nc", engine="h5netcdf")
    (name,) = words
    assert f"by its {name}: {words[name]}" in refusal(tmp_path / "r.nc")


@pytest.mark.parametrize(("words", "meaning"), [
    ({"title": "Daily mean currents"}, "the peaks are higher than the means"),
    ({"history": "cdo daymean a.nc b.nc"}, "the peaks are higher than the means"),
    ({"summary": "100-year return values"}, "extremes by statistics are no currents of one time"),
    ({"comment": "Daily means"}, "the peaks are higher than the means"),
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
    (with_values("v", lambda one: -one["u"].values), "values: is one a copy of the other?"),
    (with_values("v", lambda one: 0 * one["u"].values), "are along one axis, their other compon"),
    (with_values("u", lambda one: one["u"].values[:1] + 0 * one["u"].values), None),
    (of_attribute("u", "valid_range", [-0.12, 0.12]), "values of `u` are left out, outside its v"),
    (of_attribute("time", "comment", "in local time"), f"`time` says `in local time`: {ZONE}"),
    (lambda one: one.assign_attrs(time_zone="CEST"), f"`time` says `CEST`: {ZONE}"),
    (lambda one: one.assign_attrs(comment="Times are local (UTC+2)"), ZONE),
    (of_attribute("time", "long_name", "time, Eastern Daylight Time"), ZONE),
    (of_attribute("time", "comment", "clock of the logger, CEST"), ZONE),
    (lambda one: one.assign_attrs(keywords="FES2014, barotropic tide"), "its keywords say `FES201"),
    (of_attribute("u", "units", "kn"), "have different units, `kn` and `m s-1`"),
    (lambda one: one.where(one["depth"] != 40.0, 0.1), "levels have the same current throughout"),
    (lambda one: one.where(one["time"].values[:, None] % 3 > 0, 0.0), "2400 of 7200 currents are"),
    (lambda one: one.where(one["time"].values[:, None] % 9 > 0, -2.0), "800 of 7200 currents to"),
    (lambda one: one.isel(depth=[0, 1, 2]), "is not given below 24.0 m: the value of the"),
    (lambda one: one.isel(depth=[5, 9]), "is not given above 90.0 m: the value of the near"),
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
    with open_record(tmp_path / "r.nc", Terms(SEABED)) as read:
        assert np.isnan(read.profiles(100, 101)[1]).all()
    with open_record(tmp_path / "r.nc", Terms(SEABED, on_the_line=True)) as read:
        assert (read.profiles(100, 101)[1] == 3.0).all()


@pytest.mark.parametrize("name", ["u_FLAG_W", "u_quality", "quality_flag", "QC_velocity"])
def test_flags_are_found_by_their_names(record, tmp_path, name) -> None:
    flags = np.where(np.arange(7200).reshape(720, 10) % 4, 1, 4).astype(np.int8)
    record[name] = ("time", "depth"), flags
    assert f"1800 of 7200 currents are left out, as `{name}` marks" in said(record, tmp_path)[0]


def test_flags_of_another_variable_are_not_those_of_the_current(record, tmp_path) -> None:
    record["temperature_qc"] = ("time", "depth"), np.full((720, 10), 4, np.int8)
    assert said(record, tmp_path) == []


def test_flags_may_be_bits(record, tmp_path) -> None:
    bits = np.array([0, 1, 2, 10], np.int8)[np.arange(7200).reshape(720, 10) % 4]
    meanings = {"flag_masks": np.array([1, 2, 8], np.int8), "flag_meanings": "warm bad suspect"}
    record["u_qc"] = ("time", "depth"), bits, meanings
    assert said(record, tmp_path) == [
        "3600 of 7200 currents are left out, as `u_qc` marks them as bad"
    ]
    with open_record(tmp_path / "r.nc", Terms(SEABED)) as read:
        assert read.flags(0, 1)[0, :4].tolist() == [1, 1, 4, 4]


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
    assert [note for note in notes if note.startswith("its comment")] == profile
    return notes


@pytest.mark.parametrize(("comment", "said_of_it"), [
    ("# daily means", "`daily means`: the peaks are higher than the means"),
    ("# times in CET", "`times in CET`: the times are taken as UTC"),
    ("# Time: UTC+2", "`Time: UTC+2`: the times are taken as UTC"),
    ("# depth is height above the seabed", "`depth is height above the seabed`: the depths are"),
    ("# ADCP, true north, converted from CET to UTC, depths below the surface", None),
])  # fmt: skip
def test_comments_above_a_table_are_said(tmp_path, comment, said_of_it) -> None:
    (tmp_path / "r.csv").write_text(table("u[m/s],v[m/s]", components_of, comment))
    notes = notes_of(tmp_path / "r.csv")
    assert len(notes) == (said_of_it is not None)
    assert all(said_of_it in note for note in notes)


@pytest.mark.parametrize("comment", [
    "# barotropic tide only", "# low-pass filtered, 40 h", "# ADCP velocities in beam coordinates",
    "# compass: magnetic, declination not applied",
])  # fmt: skip
def test_comments_above_a_table_refuse_it(tmp_path, comment) -> None:
    (tmp_path / "r.csv").write_text(table("u[m/s],v[m/s]", components_of, comment))
    assert "by its comment" in refusal(tmp_path / "r.csv")


@pytest.mark.parametrize(("turn", "told"), [(np.radians, True), (float, False)])
def test_directions_in_radians_are_said(tmp_path, turn, told) -> None:
    text = table("speed[m/s],toward[deg]", lambda i, z: f"0.3,{turn(5 * i + z / 100):.4f}")
    (tmp_path / "r.csv").write_text(text)
    assert [note.endswith("radians read as degrees?") for note in notes_of(tmp_path / "r.csv")] == [
        True
    ] * told
