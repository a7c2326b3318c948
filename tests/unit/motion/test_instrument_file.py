"""Depths on a copy of a user's own file: what it must hold, and what the copy holds."""

import gsw
import h5netcdf
import numpy as np
import pytest
import xarray

from calm.dataset.discovery import mooring_in
from calm.errors import InputError, UsageError
from calm.motion.instrument_file import read_instruments, write_depths
from calm.motion.matching import LinePlaces

LABELS = ("upper", "middle", "float")  # two clamps, then a component
HOUR = np.timedelta64(1, "h")
START = np.datetime64("2026-03-01", "ns")
GAP = 2 * HOUR
LINE = LinePlaces("line", LABELS, ("21", "22", ""), 2, np.array([60.0, 150.0, 50.0]))


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
def test_the_copy_has_all_that_was_there_and_the_depths_at_its_own_times(tmp_path, engine):
    path = own(tmp_path / "own.nc", engine=engine)
    (read,), _ = read_instruments(path, LINE)
    assert (read.clock, read.dimension, read.along) == ("TIME", "TIME", "INSTRUMENT")
    lost = write_depths(read, result(), GAP, tmp_path / "copy.nc")
    assert lost == ["elsewhere"]
    with xarray.open_dataset(tmp_path / "copy.nc", engine="h5netcdf") as copy:
        nan = [np.nan] * 4
        depth = [[51.5, 50.0, np.nan, np.nan], nan, [151.5, 150.0, np.nan, np.nan]]
        spread = [[1.8, 0.3, np.nan, np.nan], nan, [1.7, 0.2, np.nan, np.nan]]
        for name, expected in (("depth", depth), ("depth_sd", spread)):
            assert copy[name].dims == ("TIME", "INSTRUMENT")
            assert copy[name].values == pytest.approx(np.array(expected).T, nan_ok=True)
        assert copy["depth"].attrs["ancillary_variables"] == "depth_sd depth_qc"
        assert copy["label"].values.tolist() == ["float", "elsewhere", "middle"]
        assert (copy["TEMP"].values == 4.5).all() and np.isnan(copy["raw"].values).all()
        assert copy["TEMP"].encoding["dtype"] == np.int16
        assert copy["TIME"].values.tolist() == read.time.tolist()
        assert copy.attrs["title"] == "mine"
    wide = write_depths(read, result(), 3 * HOUR, tmp_path / "wide.nc")
    assert wide == lost
    with xarray.open_dataset(tmp_path / "wide.nc", engine="h5netcdf") as copy:
        assert copy["depth"].values[:, 0] == pytest.approx([51.5, 50.0, 53.0 + 2.0 / 3.0, np.nan],
                                                           nan_ok=True)  # fmt: skip


def test_text_of_an_instrument_becomes_a_dataset(tmp_path):
    path = tmp_path / "a.use"
    path.write_text("SerialNumber = 22\nInstrDepth = 150\nColumns = YY:MM:DD:HH:T:C:P\n"
                    "2026 3 1 0.5 4.5 33.1 152.0\n2026 3 1 1.0 4.6 33.2 -9999\n")  # fmt: skip
    (read,), _ = read_instruments(path, LINE)
    assert not write_depths(read, result(), GAP, tmp_path / "copy.nc")
    with xarray.open_dataset(tmp_path / "copy.nc", engine="h5netcdf") as copy:
        assert copy["DEPTH"].values == pytest.approx([150.5, 151.0])
        assert copy["TIME"].values[1] == START + HOUR
        assert copy["PRES"].values == pytest.approx([152.0, np.nan], nan_ok=True)
        assert copy["CNDC"].attrs["units"] == "mS/cm" and float(copy["NOMINAL_DEPTH"]) == 150.0
        assert copy["CNDC"].attrs["long_name"] == "sea water electrical conductivity"
        assert copy["NOMINAL_DEPTH"].attrs["units"] == "m"
        # by the estimated depth where no pressure was measured
        pressure = [152.0, gsw.p_from_z(-151.0, 45.0)]
        expected = gsw.SP_from_C([33.1, 33.2], [4.5, 4.6], pressure)
        assert copy["PSAL"].values == pytest.approx(expected, abs=1e-9)
        assert copy.attrs["serial_number"] == "22" and "DEPTH estimated" in copy.attrs["history"]


MOORING = {
    "title": "M 1: motion of the mooring", "keywords": "of the motion", "creator_name": "A. Martin",
    "creator_email": "a.martin@example.org", "license": "CC-BY-4.0",
    "geospatial_lat_min": 48.0, "geospatial_lon_min": -10.0,
}  # fmt: skip


def test_a_copy_says_what_is_known_of_the_mooring_and_keeps_what_its_file_said(tmp_path):
    said = {"creator_name": "B. Other", "geospatial_vertical_max": 9.0}
    path = single(tmp_path / "a.nc", NOMINAL_DEPTH=((), 150.0, {"units": "m"}),
                  attrs={"instrument_serial_number": "22", **said})  # fmt: skip
    (read,), _ = read_instruments(path, LINE)
    write_depths(read, result().assign_attrs(MOORING), GAP, tmp_path / "copy.nc")
    with xarray.open_dataset(tmp_path / "copy.nc", engine="h5netcdf") as copy:
        about = copy.attrs
        assert "DEPTH" in copy["TEMP"].coords
    first, last = (f"{np.datetime_as_string(read.time[i], 's')}Z" for i in (0, -1))
    assert (about["time_coverage_start"], about["time_coverage_end"]) == (first, last)
    assert (about["geospatial_vertical_min"], about["geospatial_vertical_max"]) == (150.0, 152.0)
    assert about["geospatial_vertical_positive"] == "down"
    assert about["geospatial_bounds"] == "POINT (48.000000 -10.000000)"
    assert (about["title"], about["creator_name"], about["license"]) == (
        "mine", "B. Other", "CC-BY-4.0"
    )  # fmt: skip
    assert about["geospatial_lat_min"] == about["geospatial_lat_max"] == 48.0
    # neither a part of what the file says of its creator, nor what nobody said
    assert not {"creator_email", "Conventions", "keywords", "id", "project"} & {*about}


def test_a_copy_of_text_is_a_file_for_archives(tmp_path):
    path = tmp_path / "a_1.use"
    path.write_text("SerialNumber = 22\nInstrDepth = 150\nColumns = YY:MM:DD:HH:T:C\n"
                    "2026 3 1 0.5 4.5 33.1\n2026 3 1 1.0 4.6 33.2\n")  # fmt: skip
    (read,), _ = read_instruments(path, LINE)
    write_depths(read, result().assign_attrs(MOORING), GAP, tmp_path / "copy.nc")
    with xarray.open_dataset(tmp_path / "copy.nc", engine="h5netcdf", decode_coords=False) as copy:
        assert (float(copy["LATITUDE"]), float(copy["LONGITUDE"])) == (48.0, -10.0)
        assert copy["TEMP"].attrs["coordinates"] == "LATITUDE LONGITUDE STATION DEPTH"
        assert copy["DEPTH"].attrs["axis"] == "Z" and copy.attrs["featureType"] == "timeSeries"
        assert {"CF-1.11", "ACDD-1.3"} <= {*copy.attrs["Conventions"].split(", ")}
        assert copy.attrs["id"] == "OS_M-1_202603_D_a-1"
        assert copy.attrs["title"] == "M 1: a_1.use"
        assert copy.attrs["keywords"] == "sea_water_temperature, sea_water_electrical_conductivity"
        for name in ("TIME", "TEMP", "CNDC", "PSAL", "DEPTH"):
            assert {"standard_name", "long_name"} <= {*copy[name].attrs}, name


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
    ("file", "said"),
    [
        (lambda path: path, "no such file"),
        (text, "is not a NetCDF, RODB or .cnv file, nor a text table of RBR"),
        (without_times, "has no times"),
        (without_labels, "identifies no instrument: it has no label"),
        (grouped, "has groups (extra), which CALM cannot copy"),
        (counted, "`depth` is a dimension of"),
        (lambda path: own(path, there=("depth",)), "already has `depth`"),
        (lambda path: own(path, there=("depth_sd",)), "already has `depth_sd`"),
        (lambda path: own(path, labels=("a", "b")), "no instrument matches a part"),
    ],
)
def test_what_no_depths_can_be_added_to_is_refused(tmp_path, file, said):
    with pytest.raises((InputError, UsageError)) as refused:
        read_instruments(file(tmp_path / "own.nc"), LINE)
    assert said in str(refused.value)


def single(path, *, dims=("TIME",), attrs=None, **more):
    """A file of one instrument, as archives keep them."""
    time = START + np.array([0, 60, 120]) * np.timedelta64(1, "m")
    values = np.full((3,) + (1,) * (len(dims) - 1), 4.5)
    coords = {"TIME": time, **more}
    data = {"TEMP": (dims, values, {"units": "degree_Celsius"})}
    xarray.Dataset(data, coords, {"title": "mine", "history": "made", **(attrs or {})}).to_netcdf(
        path, engine="h5netcdf"
    )
    return path


def test_a_copy_keeps_to_cf_as_its_original(tmp_path):
    path = single(tmp_path / "a.nc", NOMINAL_DEPTH=((), 150.0, {"units": "m"}),
                  attrs={"instrument_serial_number": "22"})  # fmt: skip
    with xarray.open_dataset(path, engine="h5netcdf", decode_coords=False) as file:
        whole = file.load()
    whole["INSTRUMENT_DEPTH"] = ("TIME", [1.0, 2.0, 3.0], {"units": "m"})
    whole["TEMP"].attrs |= {"coordinates": "TIME NOMINAL_DEPTH INSTRUMENT_DEPTH",
                            "ancillary_variables": "DEPTH_quality_control"}  # fmt: skip
    whole["LATITUDE"] = ("LATITUDE", [48.0], {"units": "degrees_north"})
    whole["LATITUDE"].encoding["_FillValue"] = None
    for name in whole.variables:
        whole[name].encoding.pop("coordinates", None)
    whole.to_netcdf(path, engine="h5netcdf")
    (read,), _ = read_instruments(path, LINE)
    write_depths(read, result(), GAP, tmp_path / "copy.nc")
    with h5netcdf.File(tmp_path / "copy.nc") as copy:
        assert copy["TEMP"].attrs["coordinates"] == "TIME NOMINAL_DEPTH DEPTH"
        assert "coordinates" not in copy["TIME"].attrs
        assert "ancillary_variables" not in copy["TEMP"].attrs
        assert "_FillValue" not in copy["LATITUDE"].attrs
        assert "axis" not in copy["DEPTH"].attrs


NOMINAL = {"DEPTH": ("DEPTH", [152.0], {"units": "m", "axis": "Z"})}


def test_a_file_of_oceansites_has_its_depth_in_place_of_the_nominal_one(tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1790000000")
    attrs = {"instrument_serial_number": "22", "geospatial_vertical_min": 152.0}
    path = single(tmp_path / "OS.nc", dims=("TIME", "DEPTH"), **NOMINAL, attrs=attrs)
    (read,), _ = read_instruments(path, LINE)
    assert read.point == (1,)
    columns = result().assign(
        clamp_label=("clamp", ["upper", "middle"]), sensor_label=("sensor", ["middle"]),
        residual=(("time", "sensor"), np.array([[0.1], [np.nan], [0.0], [0.0], [0.0]])),
    )  # fmt: skip
    assert write_depths(read, columns, GAP, tmp_path / "copy.nc", ["a.nc sha256:12"]) == []
    with xarray.open_dataset(tmp_path / "copy.nc", engine="h5netcdf") as copy:
        assert copy["DEPTH"].dims == copy["TEMP"].dims == ("TIME",)
        assert copy["DEPTH"].values.tolist() == [150.0, 151.0, 152.0]
        assert copy["DEPTH"].attrs["ancillary_variables"] == "DEPTH_SD DEPTH_QC"
        assert copy["DEPTH_SD"].values.tolist() == [0.2, 1.2, 2.2]
        # its own pressure was used at the first and third hour; between them within the gap
        assert copy["DEPTH_QC"].values.tolist() == [1, 1, 1]
        assert copy["NOMINAL_DEPTH"].item() == 152.0
        assert copy.attrs["history"].startswith("made\n2026-09-21T14:13:20Z calm ")
        assert copy.attrs["history"].endswith("DEPTH estimated from a.nc sha256:12")
        assert copy.attrs["geospatial_vertical_min"] == 150.0


def test_a_file_of_imos_says_who_it_is_and_keeps_its_own_depth(tmp_path):
    own_depth = {"DEPTH": ("TIME", [1.0, 2.0, 3.0]), "NOMINAL_DEPTH": ((), 61.0, {"units": "m"}),
                 "DEPTH_quality_control": ("TIME", np.array([1, 1, 1], "i1"))}  # fmt: skip
    path = single(tmp_path / "IMOS.nc", attrs={"instrument_serial_number": "21"}, **own_depth)
    with pytest.raises(UsageError, match="already has `DEPTH`"):
        read_instruments(path, LINE)


def test_a_folder_is_matched_as_a_whole(tmp_path):
    for name, place in (("a", 70.0), ("b", 163.0)):
        single(tmp_path / f"{name}.nc", NOMINAL_DEPTH=((), place, {"units": "m"}))
    read, said = read_instruments(tmp_path, LINE)
    assert [one.point for one in read] == [(0,), (1,)]
    assert said == [
        "matched by nominal depth, from the top down: a.nc to `upper`; b.nc to `middle`"
    ]


@pytest.mark.parametrize("name", ["North", "Strait: north", ""])
def test_a_name_may_hold_a_colon(name):
    assert mooring_in(f"{name}: motion of the mooring" if name else "record") == (name or "record")
