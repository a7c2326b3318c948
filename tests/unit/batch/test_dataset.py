import json
import re
import shutil
import subprocess

import h5netcdf
import numpy as np
import pytest
import xarray

from calm.batch.dataset import layout_of
from calm.batch.run import run_batch
from calm.batch.statuses import STATUSES
from tests.unit.batch.made import MOORING, PLAIN, MadeRecord, made_mooring


@pytest.fixture
def file(tmp_path):
    run_batch(made_mooring(tmp_path), MadeRecord(), tmp_path / "r.nc", block=16)
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
    for name in ("depth_top", "clamp_x", "anchor_vertical"):
        assert file[name].dtype == np.float32
        assert file[name].chunks[0] == 16
        assert file[name].compression == "gzip"


def test_an_input_of_any_length_has_room(tmp_path):
    text = MOORING + "# and so on\n" * 20_000
    run_batch(made_mooring(tmp_path, text), MadeRecord(8), tmp_path / "r.nc")
    with xarray.open_dataset(tmp_path / "r.nc", engine="h5netcdf") as result:
        assert result.attrs["input"] == text


APPENDIX_A = {
    "_FillValue": "NCD", "axis": "SC", "calendar": "SC", "cf_role": "SC", "Conventions": "SG",
    "coordinates": "SD", "featureType": "SG", "flag_meanings": "SD", "flag_values": "DD",
    "history": "SG", "long_name": "SCD", "positive": "SCD", "source": "SGD",
    "standard_name": "SCD", "title": "SG", "units": "SCD", "units_metadata": "SCD",
}  # fmt: skip
"""Attributes of the conventions, by their appendix A: S text, N a number, D of the type of the
variable; then where they may stand, G globally, C with coordinates, D with other variables.
Auxiliary coordinates, such as `depth_top`, are variables of both kinds."""

OWN = {"summary", "calm", "input", "currents", "notes", "read", "input_resolved", "input_sha256"}
"""Attributes that the conventions leave to everybody."""


def test_attributes_are_of_the_types_and_in_the_places_of_the_conventions(tmp_path):
    run_batch(made_mooring(tmp_path), MadeRecord(8), tmp_path / "r.nc")
    with xarray.open_dataset(tmp_path / "r.nc", engine="h5netcdf", decode_cf=False) as result:
        assert set(result.attrs) <= {*APPENDIX_A, *OWN}
        for name, value in result.attrs.items():
            assert isinstance(value, str)
            assert name in OWN or "G" in APPENDIX_A[name][1:], name
        for name, variable in result.variables.items():
            coordinate = any(
                name in (*other.dims, *other.attrs.get("coordinates", "").split())
                for other in result.variables.values()
            )
            for key, value in variable.attrs.items():
                if key == "coverage_content_type":  # of ACDD 1.3
                    assert value in ("modelResult", "coordinate", "qualityInformation")
                    continue
                kind, *uses = APPENDIX_A[key]
                assert {"C", "D"} & set(uses), (name, key)
                assert "D" in uses or coordinate, (name, key)
                assert isinstance(value, str) == (kind == "S"), (name, key)
                assert kind == "S" or np.asarray(value).dtype == variable.dtype, (name, key)
            # one coordinate for each axis
            beside = variable.attrs.get("coordinates", "").split()
            axes = [result[other].attrs.get("axis") for other in beside]
            known = [axis for axis in axes if axis]
            assert len(known) == len(set(known)), name


@pytest.mark.skipif(shutil.which("ncdump") is None, reason="ncdump is not installed")
def test_ncdump_reads_it(tmp_path):
    run_batch(made_mooring(tmp_path), MadeRecord(8), tmp_path / "r.nc")
    done = subprocess.run(
        ["ncdump", "-t", tmp_path / "r.nc"], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    for words in (
        ':featureType = "timeSeriesProfile" ;', "string station ;", "byte status(time) ;",
        "float clamp_depth(time, clamp) ;", 'component_label = "top float", "rope',
        'time = "2024-01-01", "2024-01-01 01"', "tilt =", "top_depth:_FillValue = NaNf ;",
    ):  # fmt: skip
        assert words in done.stdout, words


def test_without_clamps_and_a_place_their_variables_are_left_out(tmp_path):
    run_batch(made_mooring(tmp_path, PLAIN), MadeRecord(8), tmp_path / "r.nc")
    with xarray.open_dataset(tmp_path / "r.nc", engine="h5netcdf") as result:
        assert set(result.sizes) == {"time", "component"}
        assert not {"latitude", "clamp_depth", "clamp_label"} & set(result.variables)
        assert result["tilt"].encoding["coordinates"] == "component_label depth_top station"
        # a feature is at a place, by section 9.1 of the conventions
        assert "featureType" not in result.attrs
        assert "cf_role" not in result["station"].attrs


def test_without_a_position_the_mooring_is_where_the_currents_are(tmp_path):
    record = MadeRecord(8)
    record.source = {"file": "made", "latitude": "48.25", "longitude": "0"}
    run_batch(made_mooring(tmp_path, PLAIN), record, tmp_path / "r.nc")
    with xarray.open_dataset(tmp_path / "r.nc", engine="h5netcdf") as result:
        assert (float(result["latitude"]), float(result["longitude"])) == (48.25, 0.0)
        assert result["latitude"].attrs["long_name"] == "latitude of the currents"
        assert result.attrs["featureType"] == "timeSeriesProfile"
        assert result["station"].attrs["cf_role"] == "timeseries_id"


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
    assert re.fullmatch(r"calm \S+ batch", layout_of(mooring, record).attributes["history"])
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    dated = layout_of(mooring, record).attributes["history"]
    assert dated.startswith("1970-01-02T00:00:00Z calm ")
