import json
import re

import h5netcdf
import numpy as np
import pytest
import xarray

from calm.batch.dataset import layout_of
from calm.batch.profiles import STATUSES
from calm.batch.run import run_batch
from tests.unit.batch.made import MOORING, MadeRecord, made_mooring

PLAIN = MOORING.replace("position: {latitude: 48.3 deg, longitude: -5.2 deg}\n", "").replace(
    ", clamps: [{use: logger, label: Logger é, at: 10 m}]", ""
)


@pytest.fixture
def file(tmp_path):
    run_batch(made_mooring(tmp_path), MadeRecord(), tmp_path / "r.nc", block=16, shape=True)
    with h5netcdf.File(tmp_path / "r.nc") as opened:
        yield opened


def test_it_is_a_time_series_of_profiles_by_the_conventions(file):
    assert file.attrs["Conventions"] == "CF-1.11"
    assert file.attrs["featureType"] == "timeSeriesProfile"
    assert file["station"].attrs["cf_role"] == "timeseries_id"
    assert file["station"][()] in ("Test", b"Test")
    assert file["latitude"][()] == 48.3
    assert file["time"].attrs["units"] == "seconds since 1970-01-01 00:00:00"
    assert file["depth_top"].attrs["positive"] == "down"
    assert "depth_top" in file["tilt"].attrs["coordinates"].split()
    assert "depth_top" not in file["depth_top"].attrs["coordinates"].split()
    assert "clamp_depth" in file["clamp_tilt"].attrs["coordinates"].split()
    for name, variable in file.variables.items():
        assert variable.attrs["long_name"], name
        for other in variable.attrs.get("coordinates", "").split():
            assert set(file[other].dimensions) <= set(variable.dimensions), (name, other)
        if variable.dtype.kind == "f":
            assert variable.attrs["units"], name


def test_statuses_have_meanings(file):
    status = file["status"]
    assert status.dtype == np.int8
    assert status.attrs["flag_values"].dtype == np.int8
    assert status.attrs["flag_values"].tolist() == list(range(len(STATUSES)))
    words = status.attrs["flag_meanings"].split()
    assert words == list(STATUSES)
    # the signs that the conventions allow in the words of a flag
    assert all(re.fullmatch(r"[A-Za-z0-9_.+@-]+", word) for word in words)


def test_the_whole_input_is_in_the_result(file):
    assert file.attrs["input"] == MOORING
    resolved = json.loads(file.attrs["input_resolved"])
    assert resolved["mooring"]["pieces"][0]["component"]["buoyancy"] == 2000.0
    assert len(file.attrs["input_sha256"]) == 64
    assert file.attrs["notes"] == "made for a test"
    assert file.attrs["currents"] == "file: made"


def test_numbers_are_compressed_in_chunks_that_go_with_time(file):
    for name in ("depth_top", "clamp_x", "anchor_vertical", "shape_depth"):
        assert file[name].dtype == np.float32
        assert file[name].chunks[0] == 16
        assert file[name].compression == "gzip"


def test_an_input_of_any_length_has_room(tmp_path):
    text = MOORING + "# and so on\n" * 20_000
    run_batch(made_mooring(tmp_path, text), MadeRecord(8), tmp_path / "r.nc")
    with xarray.open_dataset(tmp_path / "r.nc", engine="h5netcdf") as result:
        assert result.attrs["input"] == text


def test_without_clamps_and_position_their_variables_are_left_out(tmp_path):
    run_batch(made_mooring(tmp_path, PLAIN), MadeRecord(8), tmp_path / "r.nc")
    with xarray.open_dataset(tmp_path / "r.nc", engine="h5netcdf") as result:
        assert set(result.sizes) == {"time", "component"}
        assert not {"latitude", "clamp_depth", "clamp_label"} & set(result.variables)
        assert result["tilt"].encoding["coordinates"] == "component_label depth_top station"


@pytest.mark.parametrize(
    ("step", "unit"), [("1s", "seconds"), ("1500ms", "milliseconds"), ("1000000007ns", "nano")]
)
def test_times_are_whole_numbers_of_a_unit(tmp_path, step, unit):
    number, name = re.fullmatch(r"(\d+)(\w+)", step).groups()
    record = MadeRecord(8)
    record.time = record.time[0] + np.arange(8) * np.timedelta64(int(number), name)
    run_batch(made_mooring(tmp_path), record, tmp_path / "r.nc")
    with xarray.open_dataset(tmp_path / "r.nc", engine="h5netcdf") as result:
        assert result["time"].encoding["units"].startswith(unit)
        assert (result["time"].values == record.time).all()


def test_history_has_a_date_only_where_it_is_given(tmp_path, monkeypatch):
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    mooring, record = made_mooring(tmp_path), MadeRecord(8)
    assert re.fullmatch(r"calm \S+ batch", layout_of(mooring, record, None).attributes["history"])
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    dated = layout_of(mooring, record, None).attributes["history"]
    assert dated.startswith("1970-01-02T00:00:00Z calm ")
