"""dune2: a real mooring in the Denmark Strait overflow, whose pressures at five levels are hidden.

Figures and files in docs/field/dune2, by way of oceanarray 0.5.1 (MIT, © 2025 Eleanor
Frajka-Williams). Given the pressures at 626 and 26 m above the bottom, the depths of the five
instruments between must be closer to what was measured than interpolation, the bands must hold.
"""

import json
from pathlib import Path

import numpy as np
import pytest
import xarray

from calm.cli import main

FIELD = Path(__file__).parents[2] / "docs" / "field" / "dune2"
HIDDEN = tuple(f"Aquadopp {height}" for height in (526, 426, 326, 226, 126))


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    folder = tmp_path_factory.mktemp("dune2")
    code = main(
        ["motion", str(FIELD / "mooring.yaml"), "--currents", str(FIELD / "currents.nc"),
         "--pressures", str(FIELD / "pressures.nc"), "--hold-out", ",".join(HIDDEN),
         "-o", str(folder / "d.nc"), "--json", str(folder / "d.json")]
    )  # fmt: skip
    assert code == 0
    return folder / "d.nc", json.loads((folder / "d.json").read_text())


def test_hidden_depths_are_better_than_interpolated(found):
    held = found[1]["held_out"]
    assert tuple(one["label"] for one in held) == HIDDEN
    mean, linear = (np.mean([one[key] for one in held]) for key in ("rms", "linear_rms"))
    assert mean <= 0.55 * linear
    assert all(one["rms"] <= 0.75 * one["linear_rms"] for one in held)


def test_bands_hold_what_was_measured(found):
    path, said = found
    assert 0.88 <= np.mean([one["coverage_95"] for one in said["held_out"]]) <= 0.99
    with (
        xarray.open_dataset(path, engine="h5netcdf") as result,
        xarray.open_dataset(FIELD / "pressures.nc", engine="h5netcdf") as measured,
    ):
        import gsw

        depth = -gsw.z_from_p(measured["pressure"].values, 65.732)
        labels = measured["instrument"].values.tolist()
        clamps = result["clamp_label"].values.tolist()
        top = depth[:, labels.index("Aquadopp 626")]
        strong = top - np.nanmin(top) > 50.0
        inside = []
        for label in HIDDEN:
            own, column = depth[:, labels.index(label)], clamps.index(label)
            off = result["clamp_depth"].values[:, column] - own
            off -= np.nanmean(off[top < np.nanquantile(top, 0.1)])
            spread = result["clamp_depth_sd"].values[:, column]
            known = strong & np.isfinite(off)
            inside.append((np.abs(off) <= 1.96 * spread)[known].mean())
    assert np.mean(inside) >= 0.80
