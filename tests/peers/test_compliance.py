"""What CALM writes as NetCDF passes the CF tests of the IOOS compliance checker."""

import subprocess
from pathlib import Path

import pytest

from calm.cli import main

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
        main(["run", str(MOORING), "--netcdf", "out.nc"])
    else:
        main(["new", "--record", "-o", "record.nc"])
        main(["batch", str(MOORING), "--currents", "record.nc", "-o", "out.nc"])
    assert complaints("out.nc") == "All tests passed!"
