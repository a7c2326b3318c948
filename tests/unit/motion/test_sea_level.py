"""The height of the sea surface: read from tables and arrays, and what is refused."""

import numpy as np
import pytest
import xarray

from calm.errors import InputError
from calm.motion.sensors import read_sea_level

TIME = np.array(["2026-03-01T00", "2026-03-01T01", "2026-03-01T02"], "M8[ns]")


def test_a_table_is_read_in_its_unit_and_in_order(tmp_path):
    path = tmp_path / "level.csv"
    path.write_text(
        "time,level[cm]\n2026-03-01T02:00,30\n2026-03-01T00:00,-10\n2026-03-01T01:00,\n"
    )
    time, level = read_sea_level(path)
    assert time.tolist() == TIME.tolist()
    assert level == pytest.approx([-0.1, np.nan, 0.3], nan_ok=True)


def test_arrays_are_found_by_their_standard_name_and_unit(tmp_path):
    path = tmp_path / "level.nc"
    xarray.Dataset(
        {
            "temp": ("time", [4.0, 4.1, 4.2], {"units": "degC"}),
            "slev": (
                ("time", "station"),
                [[200.0], [np.nan], [-50.0]],
                {"units": "mm", "standard_name": "water_surface_height_above_reference_datum"},
            ),
        },
        {"time": TIME[::-1]},
    ).to_netcdf(path, engine="h5netcdf")
    time, level = read_sea_level(path)
    assert time.tolist() == TIME.tolist()
    assert level == pytest.approx([-0.05, np.nan, 0.2], nan_ok=True)


FAR = "time,level[m]\n" + "".join(
    f"2026-03-01T0{hour}:00,{level}\n"
    for hour, level in enumerate(("20.1", "", "9999", "0.1", "0.2"))
)


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("a.csv", "time,level\n2026-03-01T00:00,1\n", "needs a unit"),
        (
            "b.csv",
            "time,level[dbar]\n2026-03-01T00:00,1\n",
            "`level[dbar]` is a pressure; a length",
        ),
        ("c.csv", "time,a[m],b[m]\n2026-03-01T00:00,1,2\n", "has several data columns"),
        (
            "d.csv",
            "time,level[m]\nyesterday,1\n2026-03-01T00:00,x\n",
            "3:18: `level: x` is not a length",
        ),
        ("e.csv", None, "no such file"),
        ("f.csv", FAR, "is 9999 m at 2026-03-01T02:00:00, more than 20 m"),
    ],
)
def test_what_is_no_sea_level_is_refused(tmp_path, name, text, said):
    if text is not None:
        (tmp_path / name).write_text(text)
    with pytest.raises(InputError) as refused:
        read_sea_level(tmp_path / name)
    assert said in str(refused.value)


def test_arrays_without_a_height_are_refused(tmp_path):
    path = tmp_path / "t.nc"
    xarray.Dataset({"temp": ("time", [4.0, 4.1, 4.2])}, {"time": TIME}).to_netcdf(
        path, engine="h5netcdf"
    )
    with pytest.raises(InputError, match="has no sea-surface height"):
        read_sea_level(path)
