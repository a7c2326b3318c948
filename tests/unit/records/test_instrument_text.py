"""Files of one instrument in text: RODB of RAPID and OSNAP, and Sea-Bird's .cnv."""

from pathlib import Path

import numpy as np
import pytest

from calm.errors import InputError
from calm.motion.sensors import depth_of, read_sensors
from calm.records.current_file import open_record, read_current_file
from calm.records.current_terms import Terms
from calm.records.instrument_series import read_series
from calm.records.instrument_text import reader_of

HEAD = """Mooring              = wb1_12_2015
SerialNumber         = 6123
WaterDepth           = 1401
InstrDepth           = 800
Start_Date           = 2015/11/30
Latitude             = 26 29.920 N
Longitude            = 076 48.850 W
"""
USE = (
    HEAD
    + """Columns              = YY:MM:DD:HH:T:C:P
2015   11   30   23.00028   7.7556   36.4649  828.9
2015   12   01    0.00028   7.6805   36.3907  -9999
2016   02   29    1.50000   7.6567   36.3641  831.3
"""
)
RCM = (
    HEAD
    + """Columns = YY:MM:DD:HH:REF:U:V:T:C:P:TLT:MSS
2015 11 30 12.0 200 10.5 -20.0 7.7 36.4 828.9 3.0 12.0
2015 11 30 12.5 200 -9999 -9999 7.7 36.4 829.0 3.0 12.0
2015 11 30 13.0 200 12.0 0.0 7.7 36.4 -9999 3.0 12.0
"""
)
RBR = """// Creator: RBR Ltd.
// Instrument model firmware and serialID: RBRmaestro 12.03 80217
// Comment:

// timestamp(yyyy-mm-ddTHH:MM:ss.FFF),  temperature(°C),  pressure(dbar),  sea_pressure(dbar)
2015-09-19T08:32:16.000,    14.2,    12.64,    2.6
2015-09-19T08:32:26.500,    14.3,    nan,    nan
"""
CNV = """* Sea-Bird SBE37SM-RS232  Data File:
* Latitude = 65 28.5 N
# nquan = 4
# name 0 = prdM: Pressure, Strain Gauge [db]
# name 1 = tv290C: Temperature [ITS-90, deg C]
# name 2 = {}
# name 3 = flag:  0.000e+00
# start_time = Aug 12 2018 08:00:01 [Instrument's time stamp, first data scan]
# bad_flag = -9.990e-29
*END*
      100.065    20.2232 {}  0.000e+00
   -9.990e-29    20.2157 {}  0.000e+00
      102.000    20.2157 {}  1.000e+00
"""


def test_pressures_of_rodb(tmp_path: Path) -> None:
    path = tmp_path / "wb1_12_2015_6123.use"
    path.write_text(USE)
    (one,) = read_sensors([f"CTD={path}"], frozenset({1}), 26.5, 1401.0)
    assert (one.label, one.nominal, one.serial) == ("CTD", 800.0, "6123")
    expected = ["2015-11-30T23:00:01", "2015-12-01T00:00:01", "2016-02-29T01:30:00"]
    assert one.time.astype("M8[s]").astype(str).tolist() == expected
    depth = depth_of(np.array([828.9, np.nan, 831.3]), 26.5)
    assert one.value == pytest.approx(depth, abs=1e-9, nan_ok=True)


def test_currents_of_rodb_are_where_their_pressure_was(tmp_path: Path) -> None:
    path = tmp_path / "wb1_12_2015_449.rcm"
    path.write_text(RCM)
    with open_record(path, Terms(1401.0)) as record:
        depth, u, v, _ = record.profiles(0, record.count)
        assert record.time.astype("M8[m]").astype(str).tolist()[-1] == "2015-11-30T13:00"
    # at 26 deg 29.92 N, and the nominal depth where there is no pressure
    deep = depth_of(np.array([828.9, 829.0]), 26.0 + 29.92 / 60.0)
    assert depth[:, 0] == pytest.approx([*deep, 800.0], abs=1e-6)
    table, _ = read_current_file(path, "2015-11-30T12:00", Terms(water_depth=1401.0))
    assert (table.depth, table.u) == ((pytest.approx(deep[0]),), (0.105,))
    assert u[:, 0] == pytest.approx([0.105, np.nan, 0.12], nan_ok=True)
    assert v[:, 0] == pytest.approx([-0.2, np.nan, 0.0], nan_ok=True)


@pytest.mark.parametrize(
    ("name", "times", "first"),
    [
        ("timeJV2: Time, Instrument [julian days]", (224.333345, 224.5, 225),
         "2018-08-12T08:00:01"),
        ("timeK: Time, Instrument [seconds]", (587376001, 587376002, 587376003),
         "2018-08-12T08:00:01"),
        ("timeS: Time, Elapsed [seconds]", (0, 10, 20), "2018-08-12T08:00:01"),
        ("timeH: Time, Elapsed [hours]", (1, 2, 3), "2018-08-12T09:00:01"),
    ],
)  # fmt: skip
def test_pressures_of_sea_bird(tmp_path: Path, name: str, times: tuple, first: str) -> None:
    path = tmp_path / "a.cnv"
    path.write_text(CNV.format(name, *times))
    (one,) = read_sensors([f"CTD={path}"], frozenset({1}), 65.0, 900.0)
    assert one.time[0].astype("M8[s]").astype(str) == first
    # the second is missing, the third is flagged by Sea-Bird's own software
    expected = depth_of(np.array([100.065, np.nan, np.nan]), 65.0)
    assert one.value == pytest.approx(expected, abs=1e-6, nan_ok=True)


@pytest.mark.parametrize("sea", [True, False])
def test_a_table_of_rbrs_library_is_without_the_air(tmp_path: Path, sea: bool) -> None:
    path = tmp_path / "a.csv"
    path.write_text(RBR if sea else RBR.replace("sea_pressure", "x"))
    (one,) = read_sensors([f"CTD={path}"], frozenset({1}), 45.0, 900.0)
    assert (one.serial, str(one.time[1])) == ("80217", "2015-09-19T08:32:26.500000000")
    expected = depth_of(np.array([2.6, np.nan] if sea else [12.64 - 10.1325, np.nan]), 45.0)
    assert one.value == pytest.approx(expected, abs=1e-9, nan_ok=True)
    (warm,) = read_series([str(path)], ["temperature"], frozenset({1}), 900.0)["temperature"]
    assert warm.value.tolist() == [14.2, 14.3]


def test_mistakes_have_their_line(tmp_path: Path) -> None:
    path = tmp_path / "a.use"
    path.write_text(USE.replace("36.3907", "x"))
    with pytest.raises(InputError) as refused:
        read_sensors([f"CTD={path}"], frozenset({1}), 26.5, 1401.0)
    (one,) = refused.value.problems
    assert (one.line, one.message) == (10, "is not a row of numbers; the header names 7 columns")
    path.write_text(USE.replace("36.3907", "36.3907 1.0"))
    with pytest.raises(
        InputError, match=":10:1: the row has 8 numbers; the header names 7 columns"
    ):
        reader_of(path)(path)
    path.write_text(USE.replace("T:C:P", "T:C:P:U:V"))
    with pytest.raises(InputError) as refused:
        reader_of(path)(path)
    (one,) = refused.value.problems  # one, however many rows there are
    assert one.message == "the header names 9 columns, but every row has 7 numbers"
    path.write_text(CNV.format("depSM: Depth [salt water, m]", 1, 2, 3))
    with pytest.raises(InputError, match="has no times"):
        reader_of(path)(path)
    path.write_text(USE.replace("T:C:P", "T:C:X"))
    with pytest.raises(InputError, match=r"has no pressures: .* it holds TIME .* TEMP .* CNDC"):
        read_sensors([f"CTD={path}"], frozenset({1}), 26.5, 1401.0)
    path.write_text("time,a[dbar]\n2026-03-01,5\n")
    assert reader_of(path) is None
