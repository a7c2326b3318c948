"""Files as IMOS and OceanSITES lay them out: pressures, and the flags of currents."""

import numpy as np
import pytest
import xarray

from calm.errors import InputError, UsageError
from calm.motion.measurements import read_currents
from calm.motion.sensors import depth_of, read_sensors
from calm.records.instrument_series import read_series
from calm.records.velocity import find_velocity

TIMES = 6
DAYS = 25182.0 + np.arange(TIMES) / 24.0  # 2018-12-13
SINCE = {"standard_name": "time", "units": "days since 1950-01-01 00:00:00 UTC", "axis": "T"}
DBAR = np.linspace(43.4, 43.9, TIMES)
FLAG_VALUES = np.arange(10, dtype=np.float32)
IMOS = "sea_water_pressure_due_to_sea_water"


def instrument(name="PRES_REL", standard=IMOS, units="dbar", values=DBAR, **more):
    """One instrument's file, its flags in a variable of their own."""
    flags = np.ones(TIMES, np.float32)
    flags[2], flags[3] = 4, 8
    told = {
        "standard_name": standard,
        "units": units,
        "ancillary_variables": f"{name}_quality_control",
    }
    return xarray.Dataset(
        {
            name: ("TIME", np.float32(values), {**told, **more}),
            f"{name}_quality_control": ("TIME", flags, {"flag_values": FLAG_VALUES}),
            "NOMINAL_DEPTH": ((), 44.0, {"standard_name": "depth", "units": "m"}),
        },
        {"TIME": ("TIME", DAYS, SINCE)},
    )


def read(path, dataset, flags=(1, 2)):
    dataset.to_netcdf(path / "a.nc", engine="h5netcdf")
    return read_sensors([f"ADCP={path / 'a.nc'}"], frozenset(flags), -32.0, 61.0)


def test_an_instrument_of_imos(tmp_path):
    (one,) = read(tmp_path, instrument())
    assert one.label == "ADCP" and one.nominal == 44.0 and one.dropped == 2
    depth = np.where(np.isin(np.arange(TIMES), (2, 3)), np.nan, depth_of(DBAR, -32.0))
    assert one.value == pytest.approx(depth, abs=1e-5, nan_ok=True)
    (wide,) = read(tmp_path, instrument(), (1, 2, 4))
    assert wide.dropped == 1


def test_of_several_pressures_the_usual_one_counts(tmp_path):
    many = instrument()
    for name, by in (("PRES", 10.1325), ("PRES_REL_max", 3.0), ("PRES_HR", 5.0)):
        many[name] = ("TIME", np.float32(DBAR + by), dict(many["PRES_REL"].attrs))
    (one,) = read(tmp_path, many)
    assert one.value[0] == pytest.approx(depth_of(DBAR, -32.0)[0], abs=1e-4)


def test_an_instrument_of_oceansites(tmp_path):
    one = xarray.Dataset(
        {
            "PRES": (("TIME", "DEPTH", "LATITUDE", "LONGITUDE"), DBAR.reshape(-1, 1, 1, 1),
                     {"standard_name": "sea_water_pressure", "units": "decibar"}),
            "PRES_QC": (("TIME", "DEPTH", "LATITUDE", "LONGITUDE"),
                        np.array([1, 2, 3, 9, 8, 1], np.int8).reshape(-1, 1, 1, 1)),
        },
        {
            "TIME": ("TIME", DAYS, {**SINCE, "units": "days since 1950-01-01T00:00:00Z"}),
            "DEPTH": ("DEPTH", [44.0], {"standard_name": "depth", "units": "meters"}),
            "LATITUDE": ("LATITUDE", [-32.0]), "LONGITUDE": ("LONGITUDE", [115.0]),
        },
    )  # fmt: skip
    (found,) = read(tmp_path, one)
    assert found.nominal == 44.0
    assert np.isfinite(found.value).tolist() == [True, True, False, False, False, True]


INFERRED = "depthPP: Depth inferred from 2 neighbouring pressure sensors SBE37 @24m and WQM @55m."


def ragged():
    whole = instrument().drop_vars(["NOMINAL_DEPTH", "PRES_REL_quality_control"])
    whole = whole.rename_dims(TIME="OBSERVATION")
    index = np.repeat([0, 1], TIMES // 2)
    whole["instrument_index"] = ("OBSERVATION", index, {"instance_dimension": "INSTRUMENT"})
    whole["NOMINAL_DEPTH"] = ("INSTRUMENT", [20.0, 50.0], {"units": "m"})
    return whole


def with_ids():
    one = instrument()
    one["sensor_id"] = ("TIME", np.array(["SBE37", "SBE16"] * (TIMES // 2), object))
    return one


def out_of_time():
    one = instrument()
    one["TIME"] = ("TIME", np.where(np.arange(TIMES) == 3, -712224.4, DAYS), SINCE)
    return one


@pytest.mark.parametrize(("dataset", "said"), [
    (lambda: instrument("DEPTH", "depth", "m", comment=INFERRED), "is not a measurement"),
    (lambda: instrument("DEPTH", "depth", "m", long_name="depth estimated by CALM"), "by calm"),
    (with_ids, "the readings of 2 instruments in sequence (`sensor_id` gives the instrument"),
    (out_of_time, "contains the value -712224.4"),
    (lambda: instrument(units=""), "unit"),
    (lambda: instrument(units="degC"), "unit"),
    (lambda: instrument("TEMP", "sea_water_temperature"), "has no pressures"),
])  # fmt: skip
def test_what_is_no_pressure_of_one_instrument_is_refused(tmp_path, dataset, said):
    with pytest.raises(InputError) as refused:
        read(tmp_path, dataset())
    assert said in str(refused.value)


def test_instruments_one_after_the_other_are_split(tmp_path):
    whole = ragged()
    whole["instrument_id"] = ("INSTRUMENT", np.array(["M1; SBE37; 101", "M1; SBE37; 102"], object))
    whole.to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    found = read_sensors([str(tmp_path / "a.nc")], frozenset({1, 2}), -32.0, 60.0)
    assert [(one.nominal, one.serial, len(one.time)) for one in found] == [
        (20.0, "101", TIMES // 2), (50.0, "102", TIMES // 2)
    ]  # fmt: skip
    assert found[0].card is found[1].card and found[0].card.levels == 2
    assert np.concatenate([one.value for one in found]) == pytest.approx(
        depth_of(np.asarray(whole["PRES_REL"]), -32.0), nan_ok=True
    )


@pytest.mark.parametrize(("unit", "factor"), [("dbar", 1.0), ("bar", 0.1), ("kPa", 10.0)])
def test_declared_units_of_netcdf_convert(tmp_path, unit, factor):
    (one,) = read(tmp_path, instrument(units=unit, values=DBAR * factor))
    assert one.value[0] == pytest.approx(depth_of(DBAR, -32.0)[0], abs=1e-4)


def test_the_worse_flag_of_both_components_of_a_profile_counts(tmp_path):
    u_flag = np.ones((TIMES, 3), np.float32)
    v_flag = u_flag.copy()
    u_flag[1, 0], v_flag[1, 0], v_flag[4, 2] = 3, 4, 2
    variables = {"DEPTH": ("TIME", np.full(TIMES, 44.0), {"standard_name": "depth", "units": "m"})}
    for name, way, flags in (("UCUR", "east", u_flag), ("VCUR", "north", v_flag)):
        variables[name] = (("TIME", "HEIGHT_ABOVE_SENSOR"), np.full((TIMES, 3), 0.2), {
            "standard_name": f"{way}ward_sea_water_velocity", "units": "m s-1",
            "ancillary_variables": f"{name}_quality_control",
        })  # fmt: skip
        variables[f"{name}_quality_control"] = (
            ("TIME", "HEIGHT_ABOVE_SENSOR"), flags, {"flag_values": FLAG_VALUES},
        )  # fmt: skip
    places = [3.0, 5.0, 7.0]
    height = {"standard_name": "height", "units": "m", "positive": "up", "axis": "Z",
              "long_name": "height_above_sensor", "reference_datum": "sensor"}  # fmt: skip
    coordinates = {"TIME": ("TIME", DAYS, SINCE),
                   "HEIGHT_ABOVE_SENSOR": ("HEIGHT_ABOVE_SENSOR", places, height)}  # fmt: skip
    xarray.Dataset(variables, coordinates).to_netcdf(tmp_path / "c.nc", engine="h5netcdf")
    (found,) = read_currents([tmp_path / "c.nc"], 61.0, None, None, 5.0)
    assert found.flag.tolist() == np.maximum(u_flag, v_flag).tolist()
    assert found.depth[0] == pytest.approx([41.0, 39.0, 37.0])


def two(**more):
    """Two instruments in one variable, neither their times nor their flags in order."""
    values = np.stack([DBAR, 100.0 + 2.0 * np.arange(TIMES)], 1)[::-1]
    values[1, 1] = np.nan
    flags = np.ones(values.shape, np.int8)
    flags[0, 1], flags[1, 1], flags[2, 1], flags[5, 0] = 4, 4, 8, 3
    attributes = {"standard_name": "sea_water_pressure", "units": "dbar"}
    place = {"units": "m", "positive": "down"}
    return xarray.Dataset(
        {
            "p": (("time", "instrument"), values, attributes),
            "p_qc": (("time", "instrument"), flags),
            "nominal_depth": ("instrument", [44.0, 104.0], place),
            **more,
        },
        {"time": ("time", DAYS[::-1], SINCE), "instrument": ["a", "b"]},
    )


def test_each_instrument_has_its_own_depths_flags_and_place_in_the_order_of_time(tmp_path):
    two().to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    for latitude, flags in ((-32.0, {1, 2}), (70.0, {1, 2, 8})):  # 8 is never a measurement
        a, b = read_sensors([str(tmp_path / "a.nc")], frozenset(flags), latitude, 300.0)
        assert (a.label, a.nominal, a.dropped) == ("a", 44.0, 1)
        assert (b.label, b.nominal, b.dropped) == ("b", 104.0, 2)  # what is NaN is not left out
        expected = depth_of(DBAR, latitude)
        expected[0] = np.nan
        assert a.value == pytest.approx(expected, abs=1e-9, nan_ok=True)
        expected = depth_of(100.0 + 2.0 * np.arange(TIMES), latitude)
        expected[[3, 4, 5]] = np.nan
        assert b.value == pytest.approx(expected, abs=1e-9, nan_ok=True)
        assert (np.diff(a.time) > np.timedelta64(0)).all()
    # 9.8 N/kg at 32 degrees, 9.83 at 70: a third of a per cent
    assert depth_of(np.array([1000.0]), 70.0) == pytest.approx(
        0.9969 * depth_of(np.array([1000.0]), -32.0), rel=1e-4
    )


def test_depths_over_time_are_taken_as_they_are(tmp_path):
    one = instrument("DEPTH", "depth", "cm", values=100.0 * DBAR)
    (found,) = read(tmp_path, one)
    assert found.value[0] == pytest.approx(DBAR[0], abs=1e-4)
    (found,) = read(tmp_path, instrument().isel(TIME=[0]))  # of one time
    assert found.value == pytest.approx(depth_of(DBAR[:1], -32.0), abs=1e-4)


def test_columns_of_a_table_are_pressures_or_depths_each_in_its_unit(tmp_path):
    path = tmp_path / "a=b.csv"
    rows = "2026-03-01T01:00,6,2000,\n2026-03-01T00:00,5,1000,inf\n"
    path.write_text("time,a[bar],b [cm],c[dbar]\n" + rows)
    found = read_sensors([str(path)], frozenset({1}), 48.0, 300.0)
    assert [one.label for one in found] == ["a", "b", "c"]
    assert found[0].value == pytest.approx(depth_of(np.array([50.0, 60.0]), 48.0))
    assert found[1].value == pytest.approx([10.0, 20.0])
    assert np.isnan(found[2].value).all()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["x=two.nc"], "holds 2 sensors; `x=` needs a file with one sensor"),
        (["a=one.nc", "two.nc"], "two sensors are called `a`"),
        (["wide.nc"], "must have a time and an instrument dimension"),
    ],
)
def test_labels_name_one_sensor_each(tmp_path, monkeypatch, given, said):
    monkeypatch.chdir(tmp_path)
    two().to_netcdf("two.nc", engine="h5netcdf")
    instrument().to_netcdf("one.nc", engine="h5netcdf")
    wide = two()[["p"]].expand_dims(station=2).drop_vars("instrument")
    wide.to_netcdf("wide.nc", engine="h5netcdf")
    with pytest.raises((InputError, UsageError)) as refused:
        read_sensors(given, frozenset({1, 2}), 48.0, 300.0)
    assert said in str(refused.value)
    # without labels several are matched by their places
    nameless = read_sensors(["one.nc", "one.nc"], frozenset({1, 2}), 48.0, 300.0)
    assert [one.label for one in nameless] == ["", ""]


def test_a_comment_that_merging_left_condemns_no_instrument_whose_flags_are_good(tmp_path):
    stack = two(c=("instrument", [1.0, 2.0]))
    stack["p"].attrs["comment"] = "interpolated from neighbouring instrument(s)"
    invented = stack.isel(instrument=[0, 1, 1]).assign_coords(instrument=["a", "b", "c"])
    invented["p_qc"][:, 2] = 8
    invented.to_netcdf(tmp_path / "stack.nc", engine="h5netcdf")
    a, b = read_sensors([str(tmp_path / "stack.nc")], frozenset({1, 2}), -32.0, 300.0)
    assert (a.label, b.label, a.dropped, b.dropped) == ("a", "b", 1, 2)
    assert "values that have an accepted flag" in a.note and a.note == b.note
    invented.drop_vars("p_qc").to_netcdf(tmp_path / "bare.nc", engine="h5netcdf")
    with pytest.raises(InputError, match="is not a measurement"):
        read_sensors([str(tmp_path / "bare.nc")], frozenset({1, 2}), -32.0, 300.0)


def test_an_instrument_as_oceanarray_writes_it(tmp_path):
    times = ("time", np.arange(3) * 3600, {"units": "seconds since 2018-08-13"})
    units = {"pressure": "db", "temperature": "ITS-90, deg C"}
    one = xarray.Dataset(
        {
            **{name: ("time", np.float32([10.0, 11.0, 12.0]),
                      {"units": unit, "standard_name": f"sea_water_{name}"})
               for name, unit in units.items()},
            "serial_number": 7518, "InstrDepth": 100,
        },
        {"time": times},
    )  # fmt: skip
    (found,) = read(tmp_path, one)
    assert (found.serial, found.nominal) == ("7518", 100.0)
    assert found.value == pytest.approx(depth_of(np.array([10.0, 11.0, 12.0]), -32.0), abs=1e-4)
    path = [str(tmp_path / "a.nc")]
    (warm,) = read_series(path, ["temperature"], frozenset({1}), 900.0)["temperature"]
    assert warm.value.tolist() == [10.0, 11.0, 12.0]


def test_the_greatest_speed_beside_a_mean_is_no_second_current():
    east = {"units": "m s-1", "standard_name": "eastward_sea_water_velocity"}
    north = {"units": "m s-1", "standard_name": "northward_sea_water_velocity"}
    dataset = xarray.Dataset({name: ("TIME", np.zeros(3), about) for name, about in (
        ("UCUR", east), ("UCUR_max", east), ("VCUR", north), ("VCUR_std", north))})  # fmt: skip
    assert find_velocity(dataset, regular=False).names == ("UCUR", "VCUR")
