"""`calm run -o FILE.nc`: the figures of the JSON, under the names of a batch's result."""

import json

import h5netcdf
import numpy as np
import pytest
import xarray

CLAMPED = """\
name: Clamped
position: {latitude: 48.3 deg, longitude: -5.2 deg}
environment: {depth: 100 m, current: {speed: 0.5 m/s, toward: 90 deg}}
line:
  - {use: ball, label: top é}
  - {use: rope, length: 60 m, clamps: [{use: logger, label: low, at: 40 m},
      {use: logger, label: high, at: 10 m}]}
  - {use: weight}
components:
  ball: {kind: sphere, role: float, diameter: 1 m, buoyancy: 2000 N}
  rope: {kind: cable, diameter: 10 mm, weight: 0.2 N/m, stiffness: 100 kN}
  logger: {kind: cylinder, diameter: 40 mm, length: 0.3 m, buoyancy: -5 N}
  weight: {kind: anchor, weight: 5000 N}
"""

TOW = """\
name: Tow
tow: {speed: 1 m/s, toward: 0 deg}
environment: {density: 1025 kg/m^3}
line: [{use: w, length: 100 m}, {use: b}]
components:
  w: {kind: cable, diameter: 10 mm, weight: 2 N/m, stiffness: 100 kN}
  b: {kind: body, length: 1 m, buoyancy: -400 N, drag_area: 0.1 m^2, cd: 1}
"""


def figures(dataset, name):
    return dataset[name].values


@pytest.mark.parametrize(("text", "clamped"), [(CLAMPED, True), (TOW, False)], ids=["line", "tow"])
def test_it_holds_what_the_json_holds(calm, folder, text, clamped):
    (folder / "m.yaml").write_text(text, encoding="utf-8")
    done = calm("run", "m.yaml", "-o", "r.nc", "--json", "-")
    assert done.code == 0, done.err
    told = json.loads(done.out)
    with xarray.open_dataset(folder / "r.nc", engine="h5netcdf") as result:
        assert result.attrs["Conventions"] == "CF-1.11"
        assert result.attrs["status"] == "converged"
        assert result.attrs["input"] == text
        pieces = told["components"]
        assert result["component_label"].values.tolist() == [one["label"] for one in pieces]
        for name in ("depth_top", "x_bottom", "tension_bottom", "tilt", "knockdown", "length",
                     "cut_length", "safety_factor", "utilisation"):  # fmt: skip
            wanted = [np.nan if one[name] is None else one[name] for one in pieces]
            np.testing.assert_array_equal(figures(result, name), wanted, err_msg=name)
        for name, column in told["shape"].items():
            np.testing.assert_array_equal(figures(result, f"shape_{name}"), column)
        assert float(result["accuracy_tension"]) == told["accuracy"]["tension"]
        assert ("clamp_label" in result) == clamped
        if clamped:
            labels = result["clamp_label"].values.tolist()
            assert labels == [one["label"] for one in told["clamps"]]
            for name in ("depth", "x", "tension", "tilt", "knockdown"):
                wanted = [one[name] for one in told["clamps"]]
                np.testing.assert_array_equal(figures(result, f"clamp_{name}"), wanted)
            assert float(result["anchor_vertical"]) == told["anchor"]["vertical"]
            assert float(result["latitude"]) == 48.3
        else:
            assert float(result["layback"]) == told["body"]["layback"]
    with h5netcdf.File(folder / "r.nc") as file:
        for name, variable in file.variables.items():
            assert variable.attrs["long_name"], name
            for other in variable.attrs.get("coordinates", "").split():
                assert set(file[other].dimensions) <= set(variable.dimensions), (name, other)


def test_the_same_input_gives_the_same_bytes_and_several_a_file_each(calm, folder, write_mooring):
    names = (write_mooring("a.yaml"), write_mooring("b.yaml"))
    for output in ("one.nc", "two.nc"):
        assert calm("run", *names, "-o", output).code == 0
    assert (folder / "one-a.nc").read_bytes() == (folder / "two-a.nc").read_bytes()
    assert (folder / "one-b.nc").exists()


def test_another_ending_and_no_equilibrium(calm, folder, heavy, write_mooring):
    refused = calm("run", write_mooring("a.yaml"), "-o", "r.txt")
    assert (refused.code, "must end in .json" in refused.err) == (2, True)
    assert calm("run", heavy, "-o", "r.nc").code == 3
    assert not (folder / "r.nc").exists()
