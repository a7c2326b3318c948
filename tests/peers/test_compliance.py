"""What CALM writes as NetCDF passes the CF tests of the IOOS compliance checker."""

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
import xarray

from calm.cli import main
from calm.dataset.discovery import ARCHIVED, coverage
from calm.motion.instrument_file import read_instruments, write_depths
from tests.cli.test_motion import WITHOUT_STANDARD_NAME
from tests.unit.motion.test_instrument_file import GAP, LINE, result

pytest.importorskip("compliance_checker", reason="needs the extra `peers`")
pytestmark = pytest.mark.peers

PEOPLE = {
    f"{who}_{what}": "a@example.org" if what == "email" else "https://example.org"
    for who in ("creator", "publisher") for what in ("name", "email", "url")
} | {name: "A" for name in ("institution", "license", "acknowledgement", "project")}  # fmt: skip
MOORING = Path(__file__).parents[2] / "lines" / "s1000.yaml"


def complaints(path, convention="cf:1.11"):
    """What the checker says of a file, without its heading."""
    strictness = "strict" if convention.startswith("cf") else "normal"
    command = ["compliance-checker", "-t", convention, "-c", strictness, str(path)]
    finished = subprocess.run(command, capture_output=True, text=True, check=False)
    return re.split(r"http\S+", finished.stdout, maxsplit=1)[1].strip("-\n ")


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
    time = np.datetime64("2026-03-01", "ns") + np.arange(12) * np.timedelta64(1, "h")
    whole = xarray.Dataset(attrs={
        **ARCHIVED, **coverage(time, np.array([150.0]), (48.0, -10.0)), **PEOPLE,
        "title": "mine", "history": "made", "featureType": "timeSeries", "summary": "all of it",
        "source": "mooring", "references": "none", "comment": "none", "keywords": "temperature",
        "id": "OS_M1", "processing_level": "raw", "date_created": "2026-11-01T00:00:00Z",
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
        about = {"standard_name": standard, "long_name": standard, "units": unit,
                 "coverage_content_type": "physicalMeasurement"} | where  # fmt: skip
        if name == "TEMP":
            about["units_metadata"] = "temperature: on_scale"
        whole[name] = "TIME", np.full(12, value), about
    for name in whole.variables:
        whole[name].encoding["_FillValue"] = None
    whole.to_netcdf(path, engine="h5netcdf")


def test_copies_pass_as_their_originals_do(tmp_path):
    one_instrument(tmp_path / "own.nc")
    (read,), _ = read_instruments(tmp_path / "own.nc", LINE)
    write_depths(read, result(), GAP, tmp_path / "copy.nc")
    with xarray.open_dataset(tmp_path / "copy.nc", engine="h5netcdf") as copy:
        assert {"DEPTH", "DEPTH_SD", "DEPTH_QC", "NOMINAL_DEPTH", "PSAL"} <= set(copy.variables)
    for name in ("own.nc", "copy.nc"):
        for convention in ("cf:1.11", "acdd:1.3"):
            assert complaints(tmp_path / name, convention) == "All tests passed!"


DOCUMENT = """
document: {author: A. Martin, institution: Institute, investigator: D. Ruiz, url: "https://example.org",
  email: a.martin@example.org, license: CC-BY-4.0, acknowledgement: Fund, project: Slope,
  site: EXAMPLE, platform: EXAMPLE-1}
"""
RODB = """SerialNumber = 575
InstrDepth = 245
Columns = YY:MM:DD:HH:T:C:P
2026 7 12 0.5 4.5 33.1 252.0
2026 7 12 1.5 4.6 33.2 -9999
"""


def test_files_of_a_recovered_mooring_pass(tmp_path, monkeypatch):
    field = Path(__file__).parents[2] / "docs" / "field" / "dune2"
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1790000000")
    monkeypatch.chdir(tmp_path)
    mooring = (field / "mooring.yaml").read_text().replace("label: solo 575", 'serial: "575"')
    (tmp_path / "m.yaml").write_text(mooring + DOCUMENT)
    (tmp_path / "own.use").write_text(RODB)
    main(["motion", "m.yaml", "--pressures", str(field / "pressures.nc"), "--currents",
          str(field / "currents.nc"), "--onto", "own.use", "-o", "copy.nc"])  # fmt: skip
    main(["grid", "copy.motion.nc", str(field / "temperatures.nc"), "-o", "grid.nc", "--levels",
          "100:50:700", "--step", "6 h", "--variables", "TEMP"])  # fmt: skip
    for name in ("copy.nc", "grid.nc"):
        for convention in ("cf:1.11", "acdd:1.3"):
            assert complaints(name, convention) == "All tests passed!"
    assert complaints("copy.motion.nc") == "All tests passed!"
    # CF has no names for these, and a variable must not have a wrong one
    said = complaints("copy.motion.nc", "acdd:1.3")
    assert {*re.findall(r'variable "(\w+)"', said)} == WITHOUT_STANDARD_NAME
    assert {*re.findall(r"(?m)^\* (.*)", said)} == {"standard_name"}
