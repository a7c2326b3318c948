"""Depths on a copy of a user's own file: what it must hold, and what the copy holds."""

import h5netcdf
import numpy as np
import pytest
import xarray

from calm.errors import InputError, UsageError
from calm.motion.instrument_file import read_instruments, write_depths

LABELS = ("upper", "middle", "float")  # two clamps, then a component
HOUR = np.timedelta64(1, "h")
START = np.datetime64("2026-03-01", "ns")
GAP = 2 * HOUR


def own(path, labels=("float", "elsewhere", "middle"), engine="h5netcdf", **more):
    """A file of instruments: one time between hours, one in a long gap, one outside."""
    time = START + np.array([90, 0, 420, 3000]) * np.timedelta64(1, "m")
    shape = len(time), len(labels)
    dataset = xarray.Dataset(
        {
            "TEMP": (("TIME", "INSTRUMENT"), np.full(shape, 4.5), {"units": "degC"}),
            "raw": (("TIME", "INSTRUMENT"), np.full(shape, np.nan)),
            "instrument": ("TIME", ["one", "on", "each", "time"]),
            **{name: (("TIME", "INSTRUMENT"), np.zeros(shape)) for name in more.pop("there", ())},
        },
        {"TIME": time, "label": ("INSTRUMENT", list(labels))},
        {"title": "mine"},
    )
    packed = {"dtype": "i2", "scale_factor": 0.01, "_FillValue": np.int16(-999)}
    dataset.to_netcdf(path, engine=engine, encoding={"TEMP": packed, "raw": packed})
    return path


def result():
    """Depths at hours 0, 1, 2, 5 and 8."""
    time = START + np.array([0, 1, 2, 5, 8]) * HOUR
    steps = np.arange(5.0)
    columns = {
        "clamp_depth": (("time", "clamp"), np.stack([60.0 + steps, 150.0 + steps], 1)),
        "clamp_depth_sd": (("time", "clamp"), np.stack([0.1 + steps, 0.2 + steps], 1)),
        "depth_top": (("time", "component"), 50.0 + steps[:, None]),
        "depth_sd": (("time", "component"), 0.3 + steps[:, None]),
    }
    return xarray.Dataset(columns, {"time": time})


@pytest.mark.parametrize("engine", ["h5netcdf", "scipy"])
@pytest.mark.parametrize("there", [(), ("depth", "depth_sd")])
def test_the_copy_has_all_that_was_there_and_the_depths_at_its_own_times(tmp_path, engine, there):
    path = own(tmp_path / "own.nc", engine=engine, there=there)
    read = read_instruments(path, LABELS, replace=bool(there))
    assert (read.clock, read.dimension, read.along) == ("TIME", "TIME", "INSTRUMENT")
    lost = write_depths(read, result(), LABELS, GAP, tmp_path / "copy.nc")
    assert lost == ["elsewhere"]
    with xarray.open_dataset(tmp_path / "copy.nc", engine="h5netcdf") as copy:
        nan = [np.nan] * 4
        depth = [[51.5, 50.0, np.nan, np.nan], nan, [151.5, 150.0, np.nan, np.nan]]
        spread = [[1.8, 0.3, np.nan, np.nan], nan, [1.7, 0.2, np.nan, np.nan]]
        for name, expected in (("depth", depth), ("depth_sd", spread)):
            assert copy[name].dims == ("TIME", "INSTRUMENT")
            assert copy[name].values == pytest.approx(np.array(expected).T, nan_ok=True)
        assert copy["depth"].attrs["ancillary_variables"] == "depth_sd"
        assert copy["label"].values.tolist() == ["float", "elsewhere", "middle"]
        assert (copy["TEMP"].values == 4.5).all() and np.isnan(copy["raw"].values).all()
        assert copy["TEMP"].encoding["dtype"] == np.int16
        assert copy["TIME"].values.tolist() == read.time.tolist()
        assert copy.attrs["title"] == "mine"
    wide = write_depths(read, result(), LABELS, 3 * HOUR, tmp_path / "wide.nc")
    assert wide == lost
    with xarray.open_dataset(tmp_path / "wide.nc", engine="h5netcdf") as copy:
        assert copy["depth"].values[:, 0] == pytest.approx([51.5, 50.0, 53.0 + 2.0 / 3.0, np.nan],
                                                           nan_ok=True)  # fmt: skip


def without_times(path):
    xarray.open_dataset(own(path)).drop_vars("TIME").to_netcdf(path.with_name("b.nc"))
    return path.with_name("b.nc")


def without_labels(path):
    xarray.open_dataset(own(path)).drop_vars("label").to_netcdf(path.with_name("b.nc"))
    return path.with_name("b.nc")


def counted(path):
    xarray.open_dataset(own(path)).rename(INSTRUMENT="depth").to_netcdf(path.with_name("b.nc"))
    return path.with_name("b.nc")


def grouped(path):
    with h5netcdf.File(own(path), "a") as file:
        file.create_group("extra")
    return path


def text(path):
    path.write_text("time,depth\n")
    return path


@pytest.mark.parametrize(
    ("file", "replace", "said"),
    [
        (lambda path: path, False, "no such file"),
        (text, False, "is not a NetCDF file"),
        (without_times, False, "has no times"),
        (without_labels, False, "has no labels of instruments"),
        (grouped, False, "has groups, which a copy would lack: extra"),
        (counted, True, "`depth` is a dimension of"),
        (lambda path: own(path, there=("depth",)), False, "has `depth` already"),
        (lambda path: own(path, there=("depth_sd",)), False, "has `depth_sd` already"),
        (lambda path: own(path, labels=("a", "b")), False, "no instrument of"),
    ],
)
def test_what_no_depths_can_be_added_to_is_refused(tmp_path, file, replace, said):
    with pytest.raises((InputError, UsageError)) as refused:
        read_instruments(file(tmp_path / "own.nc"), LABELS, replace=replace)
    assert said in str(refused.value)
