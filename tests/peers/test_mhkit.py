"""What MHKiT writes now is read: `pip install -e ".[dev,peers]"`, then `pytest -m peers`."""

from pathlib import Path

import numpy as np
import pytest

from calm.records.current_file import read_current_file
from calm.records.current_terms import Terms

pytestmark = [pytest.mark.peers, pytest.mark.filterwarnings("ignore")]

START = 1_772_323_200  # 2026-03-01T00:00 UTC in seconds since 1970
HEAD = 60.0


def written(folder: Path, *, height: float | None) -> Path:
    """Four hours of an ADCP that looks up from 60 dbar, 0.1 m/s more in every bin."""
    base = pytest.importorskip("mhkit.dolfyn.io.base")
    from mhkit.dolfyn import time
    from mhkit.dolfyn.adp import clean
    from mhkit.dolfyn.io.api import save
    from mhkit.dolfyn.rotate import base as rotate

    bins, hours = np.arange(5), np.arange(4)
    velocity = np.zeros((4, 5, 4), "f4")
    velocity[0] = 0.1 * (1 + bins)[:, np.newaxis]
    velocity[1] = -0.05 * (1 + bins)[:, np.newaxis]
    dataset = base._create_dataset(
        {
            "coords": {"time": START + 3600.0 * hours, "range": 2.0 + 4.0 * bins},
            "data_vars": {
                "vel": velocity,
                "pressure": np.full(4, HEAD, "f4"),
                "temp": np.full(4, 10.0, "f4"),
            },
            "attrs": {
                "n_beams": 4, "inst_make": "Nortek", "inst_model": "Signature500",
                "inst_type": "ADCP", "orientation": "up", "coord_sys": "earth",
                "rotate_vars": ["vel"], "has_imu": 0, "fs": 1,
            },
            "units": {"vel": "m s-1", "pressure": "dbar", "temp": "degree_C"},
            "long_name": {"vel": "Water Velocity", "pressure": "Pressure", "temp": "Temperature"},
            "standard_name": {"pressure": "sea_water_pressure"},
        }
    )  # fmt: skip
    dataset = rotate._set_coords(dataset, ref_frame="earth")
    moments = time.epoch2dt64(dataset["time"].values).astype("datetime64[ns]")
    dataset["time"] = ("time", moments, {"standard_name": "time"})
    if height is not None:
        clean.set_range_offset(dataset, height)
    clean.water_depth_from_pressure(dataset)
    path = folder / "adcp.nc"
    save(dataset, str(path))
    return path


@pytest.mark.parametrize("height", [None, 0.6])
def test_an_adcp_in_the_earths_coordinates(tmp_path: Path, height: float | None) -> None:
    """With the height above the seabed added by MHKiT to both, the levels are the same."""
    path = written(tmp_path, height=height)
    table, _ = read_current_file(path, "2026-03-01T02:00", Terms(100.0))
    head = 10_000 * HEAD / (9.81 * (1027 + 0.0045 * HEAD))  # its linear density, in metres
    assert table.depth == pytest.approx([head - above for above in (18, 14, 10, 6, 2)], abs=2e-4)
    assert table.u == pytest.approx([0.5, 0.4, 0.3, 0.2, 0.1], rel=1e-6)
