"""Records are read as `calm run` reads one time of them, whatever their layout."""

import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from calm.errors import InputError, UsageError, how_to_install
from calm.files import CurrentTable
from calm.records.current_file import open_record, read_current_file
from calm.records.current_terms import Terms
from calm.records.record import Record, parse_period, time_text
from tests.unit.batch.records import ARRAYS, COUNT, HERE, SEABED, adcp, glorys, hycom, write

TERMS = Terms(SEABED, HERE)
LAYOUTS = [
    *((name, "nc") for name in ARRAYS),
    ("glorys", "zarr"),
    ("adcp", "zarr"),
    ("hycom", "cdf"),
    ("csv", "csv"),
    ("csv-speed", "csv"),
]


def opened(path: Path, *, declination=None, **choice) -> Record:
    return open_record(path, Terms(SEABED, HERE, declination), **choice)


def table(record: Record, i: int) -> CurrentTable:
    """A profile of a record by the rules of its notes."""
    depth, u, v, w = record.profiles(i, i + 1)
    w = np.zeros_like(u) if w is None else w
    levels = np.stack([depth.reshape(-1, u.shape[1])[0], u[0], v[0], w[0]])
    levels = levels[:, np.isfinite(levels).all(axis=0) & (levels[0] >= 0)]
    return CurrentTable(*(tuple(row) for row in levels[:, np.argsort(levels[0])].tolist()))


@pytest.mark.parametrize(("name", "ending"), LAYOUTS)
@pytest.mark.thorough
def test_every_profile_is_that_of_calm_run(tmp_path: Path, name: str, ending: str) -> None:
    path = write(name, tmp_path, ending)
    with opened(path) as record:
        assert record.count == COUNT
        for i, time in enumerate(record.time):
            alone, _ = read_current_file(path, str(time.astype("datetime64[us]")), TERMS)
            # sines and cosines may differ in their last digit between one and many
            found = vars(table(record, i))
            assert len(alone.depth) > 0
            assert alone.record == (path, TERMS)
            for name_of_part in ("depth", "u", "v", "w"):
                expected = getattr(alone, name_of_part)
                assert found[name_of_part] == pytest.approx(expected, rel=1e-14, abs=1e-15)


@pytest.mark.parametrize(("name", "ending"), LAYOUTS)
@pytest.mark.thorough
def test_blocks_are_bit_for_bit_parts_of_the_whole(tmp_path: Path, name: str, ending: str) -> None:
    path = write(name, tmp_path, ending)
    with opened(path) as record:
        whole = record.profiles(0, COUNT)
        for start, stop in ((0, 1), (1, 3), (3, COUNT)):
            for part, all_of_it in zip(record.profiles(start, stop), whole, strict=True):
                if all_of_it is None or all_of_it.ndim == 1:
                    assert np.array_equal(part, all_of_it) or part is all_of_it
                else:
                    assert np.array_equal(part, all_of_it[start:stop], equal_nan=True)


def test_the_nearest_column_with_water_is_taken(tmp_path: Path) -> None:
    with opened(write("glorys", tmp_path)) as record:
        depth, u, v, w = record.profiles(0, COUNT)
        assert (record.source["latitude"], record.source["longitude"]) == ("48.3", "-5.12")
        assert record.notes[0] == (
            "for 48.3° N 5.2° W, the nearest water column with a current is at 48.3° N 5.12° W, "
            "5.9 km away"
        )
    column = glorys().isel(latitude=1, longitude=2)
    # half a step of the packed integers
    assert u == pytest.approx(column["uo"].values, abs=0.00031, nan_ok=True)
    assert v == pytest.approx(column["vo"].values, abs=0.00031, nan_ok=True)
    assert depth == pytest.approx(column["depth"].values)
    assert w is None
    assert time_text(record.time[0]) == "2026-02-02T16:00"


@pytest.mark.parametrize("longitude", [-5.2, 354.8])
def test_longitudes_begin_where_they_like(tmp_path: Path, longitude: float) -> None:
    path = write("hycom", tmp_path)
    with open_record(path, Terms(SEABED, place=(48.29, longitude))) as record:
        assert (record.source["latitude"], record.source["longitude"]) == ("48.28", "-5.2")
        u = record.profiles(0, COUNT)[1]
    assert u == pytest.approx(hycom()["water_u"].isel(lat=1, lon=1).values, abs=1e-9)


def test_a_grid_round_the_earth_has_no_seam(tmp_path: Path) -> None:
    longitude = np.arange(0.0, 360.0, 0.5)
    u = np.full((1, 1, 1, 720), np.nan)
    u[..., [3, 717]] = 0.1, 0.2  # 1.5° E and 1.5° W have water
    shape = ("time", "depth", "lat", "lon")
    path = tmp_path / "earth.nc"
    xr.Dataset(
        {name: (shape, u, {"units": "m/s"}) for name in ("uo", "vo")},
        {"time": ("time", [0], {"units": "days since 2020-01-01"}), "lat": [0.0],
         "lon": longitude, "depth": ("depth", [10.0], {"units": "m", "positive": "down"})},
    ).to_netcdf(path, engine="h5netcdf")  # fmt: skip
    for wanted, found, east in ((359.9, "-1.5", 0.2), (0.1, "1.5", 0.1), (-0.1, "-1.5", 0.2)):
        with open_record(path, Terms(SEABED, place=(0.0, wanted))) as record:
            assert record.source["longitude"] == found
            assert record.profiles(0, 1)[1].item() == east


def test_a_place_that_drifts_is_told(tmp_path: Path) -> None:
    dataset = adcp().assign_coords(
        lat=("time", 48.0 + 0.1 * np.arange(COUNT)), lon=("time", np.full(COUNT, -5.0))
    )
    path = tmp_path / "ship.nc"
    dataset.to_netcdf(path, engine="h5netcdf")
    with opened(path) as record:
        # 0.6 degrees of latitude are 66.7 km
        assert record.notes[0] == (
            "the position in the file changes with time, by up to 67 km; all profiles are used"
        )


def test_times_that_count_from_long_ago(tmp_path: Path) -> None:
    path = tmp_path / "old.nc"
    dataset = adcp()
    for units in ("days since 0001-01-01", "days since 1-1-1 00:00"):
        # 737791 days after the first of year 1 of the mixed calendar is 2020-12-31
        dataset["time"] = ("time", 737_791.0 + np.arange(COUNT), {"units": units})
        dataset.to_netcdf(path, engine="h5netcdf")
        with opened(path) as record:
            assert time_text(record.time[0]) == "2020-12-31T00:00"
            assert (np.diff(record.time) == np.timedelta64(1, "D")).all()


def test_the_nearest_column_of_a_turned_grid(tmp_path: Path) -> None:
    path = write("curvilinear", tmp_path)
    dataset = ARRAYS["curvilinear"]()
    away = np.hypot(
        dataset.nav_lat - HERE[0], (dataset.nav_lon - HERE[1]) * np.cos(np.radians(HERE[0]))
    )
    y, x = np.unravel_index(np.argmin(away.values), away.shape)
    with opened(path) as record:
        depth, u, *_ = record.profiles(0, COUNT)
    assert u == pytest.approx(dataset["a"].isel(y=y, x=x).values, abs=1e-12)
    assert depth.tolist() == [200.0, 100.0, 5.0]


def test_bins_move_with_the_instrument(tmp_path: Path) -> None:
    with opened(write("adcp", tmp_path)) as record:
        depth, _, _, w = record.profiles(0, COUNT)
    assert depth == pytest.approx(adcp()["bin_depths"].values, rel=1e-14)
    assert depth.min() < 0  # out of the water: the rules leave it out
    assert w == pytest.approx(adcp()["w"].values / 1e3)
    with opened(write("adcp-by-distance", tmp_path)) as record:
        assert record.profiles(0, COUNT)[0] == pytest.approx(depth, rel=1e-14)
        assert (
            "`HEIGHT_ABOVE_SENSOR` is measured from the instrument, whose depth is `DEPTH`"
            in record.notes
        )


def test_heights_above_the_seabed(tmp_path: Path) -> None:
    with opened(write("adcp-on-the-seabed", tmp_path)) as record:
        assert record.profiles(0, 2)[0].tolist() == [296.0, 246.0, 196.0, 146.0]
        assert "`level` is the height above the seabed, which is at 300 m" in record.notes


def test_directions_say_their_way(tmp_path: Path) -> None:
    with opened(write("speed-and-direction", tmp_path)) as record:
        depth, u, _, _ = record.profiles(0, COUNT)
        assert "`cdir` is the direction the current comes from" in record.notes
    dataset = ARRAYS["speed-and-direction"]()
    expected = -dataset["cspd"] * np.sin(np.radians(dataset["cdir"]))
    assert u[:, 0] == pytest.approx(expected.values, abs=1e-14)
    assert depth.tolist() == [80.0]


def test_notes_tell_the_rules(tmp_path: Path) -> None:
    with opened(write("oceansites", tmp_path)) as record:
        assert record.notes == (
            "the current has no level above 40.0 m or below 250.0 m, so the value of the nearest "
            "level is used there; the water depth is 300.0 m",
            "the strongest of 20 currents is 0.0092 m/s in the declared unit, cm/s; are they in "
            "m/s or kn?",
            "levels without a current or a depth are excluded from their profile",
            "levels above the surface are excluded",
            "levels below the seabed that have a value are used to interpolate the current at the "
            "seabed",
            "the current is linear in depth between levels, and constant above the first and below "
            "the last",
        )
        assert record.source == {
            "file": "oceansites.nc",
            "velocity": "UCUR, VCUR",
            "levels": "DEPTH",
            "time": "TIME",
            "latitude": "48.3",
            "longitude": "-5.2",
        }


def test_period_and_every(tmp_path: Path) -> None:
    path = write("adcp", tmp_path)
    with opened(path) as record:
        whole = record.profiles(0, COUNT)[1]
    with opened(path, time=parse_period("2026-03-01T00:10/2026-03-01T00:50"), every=2) as record:
        assert [time_text(time)[-5:] for time in record.time] == ["00:10", "00:30", "00:50"]
        assert np.array_equal(record.profiles(0, 3)[1], whole[1:6:2])
        assert np.array_equal(record.profiles(2, 3)[1], whole[5:6])
        assert record.notes[:2] == (
            "5 of the 7 profiles are in the requested period",
            "one profile in 2 is used, beginning with the first",
        )
    with pytest.raises(
        UsageError, match=r"in this period: the profiles are from 2026-03-01T00:00 to"
    ):
        opened(path, time=parse_period("2027/"))
    with pytest.raises(UsageError, match="at least 1"):
        opened(path, every=0)


def test_profiles_out_of_order_are_put_in_it(tmp_path: Path) -> None:
    order = [3, 0, 1, 6, 2, 5, 4]
    path = tmp_path / "mixed.nc"
    adcp().isel(time=order).to_netcdf(path, engine="h5netcdf")
    with opened(path) as mixed, opened(write("adcp", tmp_path)) as record:
        assert np.array_equal(mixed.time, record.time)
        for start, stop in ((0, 4), (4, COUNT)):
            for got, expected in zip(
                mixed.profiles(start, stop), record.profiles(start, stop), strict=True
            ):
                assert np.array_equal(got, expected)
        assert mixed.notes[0] == "the profiles were not in the order of time, and have been sorted"


@pytest.mark.parametrize(
    ("choice", "windows"),
    [
        ({}, [slice(0, 4, 1), slice(4, 7, 1)]),
        # 00:00 to 01:00 by ten minutes, four to a chunk of the file
        ({"time": parse_period("2026-03-01T00:10/")}, [slice(1, 4, 1), slice(4, 7, 1)]),
        ({"every": 2}, [slice(0, 4, 2), slice(4, 8, 2)]),
    ],
)
@pytest.mark.thorough
def test_what_is_compressed_together_is_read_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, choice: dict, windows: list[slice]
) -> None:
    from calm.records.current_dataset import CurrentDataset

    path = tmp_path / "packed.nc"
    packing = {"zlib": True, "chunksizes": (4, 5)}
    adcp().to_netcdf(path, engine="h5netcdf", encoding={"u": packing, "v": packing})
    reads = []
    read = CurrentDataset.read
    monkeypatch.setattr(
        CurrentDataset, "read", lambda self, index: reads.append(index) or read(self, index)
    )
    with opened(path, **choice) as record, opened(write("adcp", tmp_path), **choice) as plain:
        reads.clear()  # of the part that is looked at for what is odd
        for start in range(record.count):
            for got, expected in zip(
                record.profiles(start, start + 1), plain.profiles(start, start + 1), strict=True
            ):
                assert np.array_equal(got, expected)
    assert [index for index in reads if index.stop - index.start > index.step] == windows


def test_a_block_that_is_damaged_names_the_file(tmp_path: Path) -> None:
    path = write("glorys", tmp_path, "zarr")
    with opened(path) as record:
        for chunk in (path / "uo").glob("[0-9]*"):
            chunk.write_bytes(b"nothing that makes sense")
        with pytest.raises(InputError, match=r"glorys.zarr: cannot be read as zarr: "):
            record.profiles(0, 2)


@pytest.mark.parametrize("name", ["nowhere.nc", "folder"])
def test_no_record_at_all(tmp_path: Path, name: str) -> None:
    (tmp_path / "folder").mkdir()
    with pytest.raises(InputError, match=r"no such file|is a folder but not a zarr store"):
        opened(tmp_path / name)


def test_zarr_that_is_not_installed_is_named(tmp_path: Path, monkeypatch) -> None:
    path = write("glorys", tmp_path, "zarr")
    monkeypatch.setitem(sys.modules, "zarr", None)
    with pytest.raises(ModuleNotFoundError) as caught:
        opened(path)
    assert how_to_install(caught.value) == (
        "zarr is not installed; in the checkout of CALM, run pip install '.[cluster]'"
    )
