"""What CALM writes as NetCDF passes the CF tests of the IOOS compliance checker."""

import subprocess
from pathlib import Path

import numpy as np
import pytest
import xarray

from calm.cli import main
from calm.motion.instrument_file import read_instruments, write_depths
from tests.unit.motion.test_instrument_file import GAP, LINE, result

pytest.importorskip("compliance_checker", reason="needs the extra `peers`")
pytestmark = pytest.mark.peers

MOORING = Path(__file__).parents[2] / "lines" / "s1000.yaml"


def complaints(path):
    """What the checker says of a file, without its heading."""
    command = ["compliance-checker", "-t", "cf:1.11", "-c", "strict", str(path)]
    finished = subprocess.run(command, capture_output=True, text=True, check=False)
    return finished.stdout.partition("conventions.html")[2].strip("-\n ")


@pytest.mark.parametrize("command", ["run", "batch"])
def test_results_pass(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    if command == "run":
        main(["run", str(MOORING), "-o", "out.nc"])
    else:
        main(["new", "--record", "-o", "record.nc"])
        main(["batch", str(MOORING), "--currents", "record.nc", "-o", "out.nc"])
    assert complaints("out.nc") == "All tests passed!"


def one_instrument(path):
    """A file of one instrument, as OceanSITES keeps it: nominal depth, flags, coordinates."""
    whole = xarray.Dataset(attrs={
        "Conventions": "CF-1.11", "title": "mine", "history": "made", "featureType": "timeSeries",
        "institution": "A", "source": "mooring", "references": "none", "comment": "none",
        "instrument_serial_number": "22",
    })  # fmt: skip
    told = {
        "standard_name": "time",
        "long_name": "time",
        "axis": "T",
        "calendar": "standard",
        "units": "days since 1970-01-01 00:00:00",
        "units_metadata": "leap_seconds: none",
    }
    whole["TIME"] = "TIME", 20513.0 + np.arange(12) / 24.0, told
    for name, value, unit in (("latitude", 48.0, "north"), ("longitude", -10.0, "east")):
        whole[name.upper()] = (), value, {"standard_name": name, "long_name": name,
                                          "units": f"degrees_{unit}"}  # fmt: skip
    whole["STATION"] = (), "M1", {"cf_role": "timeseries_id", "long_name": "station"}
    whole["DEPTH"] = (), 150.0, {"standard_name": "depth", "long_name": "nominal depth",
                                 "units": "m", "positive": "down", "axis": "Z"}  # fmt: skip
    where = {"coordinates": "LATITUDE LONGITUDE STATION DEPTH"}
    for name, standard, unit, value in (
        ("TEMP", "sea_water_temperature", "degree_Celsius", 5.0),
        ("CNDC", "sea_water_electrical_conductivity", "S m-1", 3.3),
        ("PRES", "sea_water_pressure", "dbar", 152.0),
    ):
        about = {"standard_name": standard, "long_name": standard, "units": unit} | where
        if name == "TEMP":
            about["units_metadata"] = "temperature: on_scale"
        whole[name] = "TIME", np.full(12, value), about
    for name in whole.variables:
        whole[name].encoding["_FillValue"] = None
    whole.to_netcdf(path, engine="h5netcdf")


def test_copies_pass_as_their_originals_do(tmp_path):
    one_instrument(tmp_path / "own.nc")
    assert complaints(tmp_path / "own.nc") == "All tests passed!"
    (read,), _ = read_instruments(tmp_path / "own.nc", LINE)
    write_depths(read, result(), GAP, tmp_path / "copy.nc")
    with xarray.open_dataset(tmp_path / "copy.nc", engine="h5netcdf") as copy:
        assert {"DEPTH", "DEPTH_SD", "DEPTH_QC", "NOMINAL_DEPTH", "PSAL"} <= set(copy.variables)
    assert complaints(tmp_path / "copy.nc") == "All tests passed!"
